"""Where the component catalogue, the example lines and the field data that come with CALM are.

Once installed they stand inside the package; in a checkout, beside it.
"""

from __future__ import annotations

import importlib.resources
from pathlib import Path
from typing import Literal


def shipped_folder(name: Literal["catalog", "lines", "field"]) -> Path:
    """The folder of the shipped catalogue, lines or field data.

    Raises
    ------
    FileNotFoundError
        The installation is incomplete.
    """
    package = Path(str(importlib.resources.files("calm")))
    beside = package.parent / "docs" / name if name == "field" else package.parent / name
    for folder in (package / "_shipped" / name, beside):
        if folder.is_dir():
            return folder
    raise FileNotFoundError(f"CALM's folder `{name}` is missing; install CALM again")
