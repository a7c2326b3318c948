"""Terminals that have no other signs than those of ASCII: the screen in these."""

from __future__ import annotations

import codecs
import unicodedata
from collections.abc import Mapping
from functools import lru_cache
from typing import TextIO

from rich.cells import cell_len
from rich.segment import Segment
from textual.color import Color
from textual.filter import LineFilter

_LOCALE = ("LC_ALL", "LC_CTYPE", "LANG")
_OF_PYTHON = frozenset({"c.utf-8", "c.utf8", "utf-8"})
_LIKE = {
    "✓": "+",
    "★": "*",
    "▸→›▶": ">",
    "‹←◀": "<",
    "↑▲▼": "^",
    "↓": "v",
    "↗↙": "/",
    "↘↖": "\\",
    "…·•": ".",
    "°": "d",
    "×": "x",
    "–": "-",
    "≤": "<",
    "≥": ">",
    "§▪■": "#",
    "█▉▊▋": "@",
    "●◦⭘": "o",
    "◆": "R",
    "▒": "%",
    "│┃║┊▌▍▎▏▐▕╵╷╹╻╎╏╽╿": "|",
    "─━═╴╶╸╺╌╍╼╾▁▂▔▀▄": "-",
}
_SIGNS = str.maketrans({sign: plain for signs, plain in _LIKE.items() for sign in signs})
_CROSSING = range(0x2500, 0x2580)  # what of the lines is not straight
_BRAILLE = range(0x2800, 0x2900)
_DOTS = ((0x01, 0x02, 0x04, 0x40), (0x08, 0x10, 0x20, 0x80))
"""The dots of the two columns of a cell, from the top."""


def shows_all_signs(environ: Mapping[str, str], output: TextIO | None) -> bool:
    """Whether a terminal can be taken to show more than ASCII.

    Parameters
    ----------
    environ : whose locale describes the terminal. Python puts a UTF-8 of its own into `LC_CTYPE`
        where the locale is ``C``, which says nothing; no locale at all says nothing either.
    output : where the screen is written to
    """
    if environ.get("TEXTUAL_DRIVER"):
        return True  # a page in a browser
    locales = [environ[name] for name in _LOCALE if environ.get(name)]
    if (
        len(locales) > 1
        and locales[0] == environ.get("LC_CTYPE")
        and locales[0].lower() in _OF_PYTHON
    ):
        locales.pop(0)
    name, _, coded = (locales[0] if locales else "").partition("@")[0].partition(".")
    if name in ("C", "POSIX") and not coded:
        return False
    return _is_utf(coded or "utf-8") and _is_utf(getattr(output, "encoding", None) or "ascii")


def _is_utf(encoding: str) -> bool:
    try:
        return codecs.lookup(encoding).name.startswith("utf")
    except LookupError:
        return False


class PlainSigns(LineFilter):
    """Puts signs of ASCII in place of all others, each as wide as what it stands for."""

    def apply(self, segments: list[Segment], background: Color) -> list[Segment]:
        """The same in signs of ASCII."""
        return [Segment(plain(text), style, control) for text, style, control in segments]


@lru_cache(4096)
def plain(text: str) -> str:
    """A text in signs of ASCII; letters lose their accents, unknown signs become ``?``."""
    if text.isascii():
        return text
    return "".join(sign if sign.isascii() else _plain(sign) for sign in text.translate(_SIGNS))


def _plain(sign: str) -> str:
    if ord(sign) in _BRAILLE:
        return _of_dots(ord(sign) - _BRAILLE.start)
    if ord(sign) in _CROSSING:
        return "+"
    width = cell_len(sign)
    base = unicodedata.normalize("NFKD", sign)[0]
    return (base if base.isascii() and base.isprintable() else "?").ljust(width)[:width]


def _of_dots(bits: int) -> str:
    """The sign most like some dots of braille."""
    left, right = ([y for y, dot in enumerate(column) if bits & dot] for column in _DOTS)
    if not left or not right:
        rows = left or right
        if len(rows) > 2:
            return "|"
        return (":" if len(rows) == 2 else "'" if rows[0] < 2 else ".") if rows else " "
    fall = sum(right) / len(right) - sum(left) / len(left)
    if abs(fall) > 0.7:
        return "\\" if fall > 0.0 else "/"
    if len(left) + len(right) > 4:
        return "|"
    return "-" if sum(left + right) / len(left + right) < 2.5 else "_"
