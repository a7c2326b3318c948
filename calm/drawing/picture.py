"""Writing of drawings to files, and replacement of characters that a drawing must not contain."""

from __future__ import annotations

import re
from pathlib import Path

from calm.errors import UsageError

FORMATS = (".svg", ".png", ".pdf")
"""Allowed file-name suffixes of pictures."""

_PAGE = b"""#set page(width: auto, height: auto, margin: 0pt)
#image(bytes(sys.inputs.svg), format: "svg")"""


def check_format(path: Path) -> None:
    """Raise UsageError unless a file name ends in a suffix from `FORMATS`.

    The message lists the allowed formats.
    """
    if path.suffix.lower() not in FORMATS:
        allowed = f"{', '.join(FORMATS[:-1])} or {FORMATS[-1]}"
        raise UsageError(f"cannot draw {path}: a picture's name ends in {allowed}")


def image(svg: str, suffix: str) -> bytes:
    """Convert a drawing to the content of an SVG, PNG or PDF file.

    The suffix is one of `FORMATS`, in upper or lower case. A PDF page has the size of the drawing.
    """
    kind = suffix.lower().removeprefix(".")
    if kind == "svg":
        return svg.encode()
    from calm.drawing.typesetting import legible, typeset

    return typeset(_PAGE, {"svg": legible(svg)}, "png" if kind == "png" else "pdf")


# patterns are compiled where they are first used: most commands use none
_IDENTIFIER = r'\b(id="|href="#|url\(#)'
_NOT_XML = "[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]"


def within_xml(text: str) -> str:
    """Replace characters that XML does not allow with �."""
    return re.sub(_NOT_XML, "\ufffd", text)


def set_apart(svg: str, prefix: str) -> str:
    """Add a prefix to the identifiers in a drawing, to make them unique on a page of drawings."""
    return re.sub(r"<[^<>]+>", lambda tag: re.sub(_IDENTIFIER, rf"\g<1>{prefix}-", tag[0]), svg)


# characters that XML does not allow, that control a terminal, or that reverse the text direction
_UNPRINTABLE = "[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]"
_IN_ASCII = str.maketrans({
    **dict(zip("–−×·₀₁✓◦≈█▒’“”\u00a0", "--x*01+o=#:'\"\" ", strict=True)),
    "°": "deg", "→": "->", "…": "...", "≤": "<=", "≥": ">=", "√": "sqrt", "²": "^2", "³": "^3",
    "\u2003": "  ",
})  # fmt: skip


def printable(text: str) -> str:
    """Replace characters that XML or a terminal cannot show with a replacement character."""
    return re.sub(_UNPRINTABLE, "\ufffd", text)


def in_ascii(text: str) -> str:
    """Replace the symbols of units and arithmetic with ASCII text, such as ``27°`` with ``27 deg``.

    Letters are not changed.
    """
    return re.sub(r"(?<=[0-9])°", " deg", text).translate(_IN_ASCII)


def encodable(encoding: str | None, signs: str) -> bool:
    """Return whether an output encoding can represent all the given characters."""
    try:
        signs.encode(encoding or "ascii")
    except (UnicodeEncodeError, LookupError):
        return False
    return True
