"""``calm build``: the line builder in a terminal."""

import os
import sys
from pathlib import Path

from calm.cli import options
from calm.cli.outputs import ExitCode
from calm.errors import UsageError

_NO_TERMINAL = (
    "calm build needs a terminal and a keyboard; `calm page` writes the builder as a web page, and "
    "`calm run FILE --schematic` prints the line"
)

_REDIRECTED = "calm build draws its screen on standard error, which is redirected here; omit `2>`"


def build(
    file: Path | None = None,
    /,
    *,
    environment: str | None = None,
    catalog: options.CatalogFiles = None,
) -> ExitCode:
    """Edit a mooring or tow interactively, with live results.

    The line is shown as a table next to its drawing and the design check.
    Comments, order and units in the file are preserved; only the values that you
    edit change. Unsaved work is stored next to the file, and can be recovered
    after a closed terminal, a crash or a power failure. Press ? for all keys.

    Parameters
    ----------
    file
        A mooring file, existing or new. Without FILE, you choose a name when you save.
    environment
        Environment at the start: a name from the file, or an environment file.

    Examples
    --------
      calm build
      calm build mooring.yaml
      calm build mooring.yaml --environment storm
    """
    # the builder needs a terminal, or the driver in TEXTUAL_DRIVER
    terminal = all(stream is not None and stream.isatty() for stream in (sys.stdin, sys.stderr))
    if not (terminal or os.environ.get("TEXTUAL_DRIVER")):
        raise UsageError(_REDIRECTED if _stdin_and_stdout_are_terminals() else _NO_TERMINAL)
    from calm.tui.start import build

    return ExitCode(build(file, environment, catalog or []))


def _stdin_and_stdout_are_terminals() -> bool:
    return all(stream is not None and stream.isatty() for stream in (sys.stdin, sys.stdout))
