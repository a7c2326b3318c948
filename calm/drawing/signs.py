"""Signs that an output can carry: none that steers a terminal, and ASCII where there is no more."""

from __future__ import annotations

import re

# Signs that XML has no place for, that command a terminal, or that turn other signs around.
_UNPRINTABLE = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]"
)
_DEGREES = re.compile(r"(?<=[0-9])°")
_IN_ASCII = str.maketrans(
    {
        "°": "deg",
        "–": "-",
        "−": "-",
        "×": "x",
        "·": "*",
        "→": "->",
        "…": "...",
        "≤": "<=",
        "≥": ">=",
        "√": "sqrt",
        "²": "^2",
        "³": "^3",
        "₀": "0",
        "₁": "1",
        "✓": "+",
        "\u00a0": " ",
        "\u2003": "  ",
    }
)


def printable(text: str) -> str:
    """A text in which a mark stands for what XML or a terminal cannot carry."""
    return _UNPRINTABLE.sub("\ufffd", text)


def in_ascii(text: str) -> str:
    """A text whose signs of units and of arithmetic are written out: ``27 deg`` for ``27°``.

    Letters stay as they are.
    """
    return _DEGREES.sub(" deg", text).translate(_IN_ASCII)


def encodable(encoding: str | None, signs: str) -> bool:
    """Return whether an output of this encoding has these signs."""
    try:
        signs.encode(encoding or "ascii")
    except (UnicodeEncodeError, LookupError):
        return False
    return True
