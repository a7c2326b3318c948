"""How wide a text can be, whatever sans-serif font it is shown in; texts cut or wrapped to it."""

from __future__ import annotations

import unicodedata

from rich.cells import cell_len

ELLIPSIS = "…"

# Widths in ems, no less than those of Arial, Helvetica, Liberation Sans and DejaVu Sans.
_USUAL, _CAPITAL, _WIDE = 0.64, 0.79, 1.03
_CLASSES = {
    **dict.fromkeys("ijlIJ.,:;'|/\\ ", 0.36),
    **dict.fromkeys("frt!()[]-", 0.42),
    **dict.fromkeys("ckszvxyL?", 0.6),
    **dict.fromkeys("mwMWQ@%&#+=<>~^×–", _WIDE),
}
_BOLD = 1.19


def text_width(text: str, size: float, *, bold: bool = False) -> float:
    """An upper bound of the width of a text, in the unit of the font's size."""
    ems = sum(map(_ems, text))
    return size * ems * (_BOLD if bold else 1.0)


def shortened(text: str, width: float, size: float, *, bold: bool = False) -> str:
    """The text, or as much of its beginning as fits the width with an ellipsis at its end."""
    if text_width(text, size, bold=bold) <= width:
        return text
    room = width - text_width(ELLIPSIS, size, bold=bold)
    kept = 0
    for sign in text:
        room -= text_width(sign, size, bold=bold)
        if room < 0.0:
            break
        kept += 1
    return text[:kept].rstrip() + ELLIPSIS


def wrapped(text: str, width: float, size: float, *, bold: bool = False) -> list[str]:
    """The text in lines that fit the width; a word that is wider is parted. Nothing is cut off."""
    lines: list[str] = []
    line = ""
    for word in text.split():
        longer = f"{line} {word}" if line else word
        if text_width(longer, size, bold=bold) <= width:
            line = longer
            continue
        if line:
            lines.append(line)
        line = ""
        for sign in word:
            if line and text_width(line + sign, size, bold=bold) > width:
                lines.append(line)
                line = ""
            line += sign
    return [*lines, line] if line else lines


def _ems(sign: str) -> float:
    if sign in _CLASSES:
        return _CLASSES[sign]
    sign = unicodedata.normalize("NFD", sign)[0]
    if sign.isascii():
        return _CAPITAL if sign.isupper() else _USUAL
    if unicodedata.combining(sign) or cell_len(sign) == 0:
        return 0.0
    # Scripts of their own: a sign of one cell of a terminal is at most an em wide.
    return _WIDE * cell_len(sign)
