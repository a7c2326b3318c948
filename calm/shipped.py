"""Where the component catalogue, the example lines and the manual that come with CALM are.

Once installed they stand inside the package; in a checkout, beside it.
"""

import importlib.resources
from pathlib import Path
from typing import Literal


def shipped_folder(name: Literal["catalog", "lines", "docs"]) -> Path:
    """Return the folder of the shipped catalogue, lines or manual.

    Raises
    ------
    FileNotFoundError
        The installation is incomplete.
    """
    package = Path(str(importlib.resources.files("calm")))
    for folder in (package / "_shipped" / name, package.parent / name):
        if folder.is_dir():
            return folder
    raise FileNotFoundError(f"CALM's folder `{name}` is missing; install CALM again")
