"""A figure as a file, and the signs that stand in figures."""

from __future__ import annotations

import io
import re
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
    """Refuse a picture whose file name ends in none of the formats: UsageError, naming these."""
    if path.suffix.lower() not in formats:
        allowed = f"{', '.join(formats[:-1])} or {formats[-1]}"
        raise UsageError(f"cannot draw {path}: a picture's name ends in {allowed}")


def empty_figure(width: float, height: float, **options: Any) -> Figure:
    """A figure of a size [inches] that belongs to no window."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), **options)


def image(figure: Figure, suffix: str) -> bytes:
    """The figure as a file: PNG at 150 dots per inch, or vectors with their texts as text.

    The suffix is ``.png``, ``.svg`` or ``.pdf``, in any case.
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


# patterns are compiled where they are first used: most commands use none
_PROLOGUE = r"(?s)^.*?(?=<svg\b)"
_ASIDE = r"(?s)<metadata>.*?</metadata>|<style\b.*?</style>|<!--.*?-->\s*"
_IDENTIFIER = r'\b(id="|href="#|url\(#)'
_NOT_XML = "[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]"


def figure_svg(figure: Figure) -> str:
    """Return what matplotlib drew, without a prologue and what it says about itself.

    Its style sheet would hold for all of a page; the drawing carries what it says as attributes.
    """
    text = image(figure, ".svg").decode("utf-8")
    text = within_xml(re.sub(_ASIDE, "", re.sub(_PROLOGUE, "", text, count=1)))
    return text.replace("<svg ", '<svg stroke-linejoin="round" ', 1)


def within_xml(text: str) -> str:
    """A drawing whose texts may hold any sign, with � for those that XML does not know."""
    return re.sub(_NOT_XML, "\ufffd", text)


def set_apart(svg: str, prefix: str) -> str:
    """The drawing with its identifiers under a prefix: those of one page must differ."""
    return re.sub(r"<[^<>]+>", lambda tag: re.sub(_IDENTIFIER, rf"\g<1>{prefix}-", tag[0]), svg)


# Signs that XML has no place for, that command a terminal, or that turn other signs around.
_UNPRINTABLE = "[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]"
_IN_ASCII = str.maketrans({
    **dict(zip("–−×·₀₁✓\u00a0", "--x*01+ ", strict=True)),
    "°": "deg", "→": "->", "…": "...", "≤": "<=", "≥": ">=", "√": "sqrt", "²": "^2", "³": "^3",
    "\u2003": "  ",
})  # fmt: skip


def printable(text: str) -> str:
    """A text in which a mark stands for what XML or a terminal cannot carry."""
    return re.sub(_UNPRINTABLE, "\ufffd", text)


def in_ascii(text: str) -> str:
    """A text whose signs of units and of arithmetic are written out: ``27 deg`` for ``27°``.

    Letters stay as they are.
    """
    return re.sub(r"(?<=[0-9])°", " deg", text).translate(_IN_ASCII)


def encodable(encoding: str | None, signs: str) -> bool:
    """Return whether an output of this encoding has these signs."""
    try:
        signs.encode(encoding or "ascii")
    except (UnicodeEncodeError, LookupError):
        return False
    return True
