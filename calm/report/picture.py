"""A figure as a file."""

from __future__ import annotations

import io
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from calm.errors import UsageError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS = (".png", ".svg")
"""The endings a picture's file name may have."""

_METADATA: dict[str, dict[str, Any]] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}


def check_format(path: Path, formats: Sequence[str] = FORMATS) -> None:
    """Refuse a picture whose file name does not end in one of the formats.

    Raises
    ------
    UsageError
        Naming the endings that are allowed.
    """
    if path.suffix.lower() not in formats:
        allowed = f"{', '.join(formats[:-1])} or {formats[-1]}"
        raise UsageError(f"cannot draw {path}: a picture's name ends in {allowed}")


def image(figure: Figure, suffix: str) -> bytes:
    """The figure as a file: PNG at 150 dots per inch, or vectors with their texts as text.

    Parameters
    ----------
    figure : Figure
        What was drawn.
    suffix : str
        ``.png``, ``.svg`` or ``.pdf``, in any case.
    """
    import matplotlib

    content = io.BytesIO()
    kind = suffix.lower().removeprefix(".")
    with (
        matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "calm"}),
        warnings.catch_warnings(),
    ):
        # A label may hold signs that the font lacks; they show as boxes.
        warnings.filterwarnings("ignore", message="Glyph")
        figure.savefig(content, format=kind, dpi=150, metadata=_METADATA.get(kind, {}))
    return content.getvalue()
