"""Which signs the fonts of a PDF lack."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from pathlib import Path


def font_folder() -> Path:
    """The fonts that are always there: those that matplotlib brings."""
    import matplotlib

    return Path(matplotlib.get_data_path(), "fonts", "ttf")


def lacking(texts: Iterable[str]) -> str:
    """The signs of some texts that no font of a PDF has, each once, in order."""
    held, known = list(texts), _signs()
    unknown = {sign for sign in set().union(*held) if sign.isprintable() and ord(sign) not in known}
    if not unknown:  # as nearly always: a report has millions of signs
        return ""
    return "".join(dict.fromkeys(sign for text in held for sign in text if sign in unknown))


def legible(text: str) -> str:
    """A text for a PDF: a sign that no font has is a question mark in a lozenge.

    A single one would otherwise have all of a drawing's label shown in boxes.
    """
    unknown = lacking([text])
    return text.translate(dict.fromkeys(map(ord, unknown), "\ufffd")) if unknown else text


@cache
def _signs() -> frozenset[int]:
    from matplotlib.ft2font import FT2Font

    fonts = sorted(font_folder().glob("DejaVuSans*.ttf"))
    return frozenset(code for font in fonts for code in FT2Font(str(font)).get_charmap())
