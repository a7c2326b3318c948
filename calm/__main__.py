"""``python -m calm``, the same as the command ``calm``."""

import sys

from calm.cli import main

sys.exit(main())
