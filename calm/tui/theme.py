"""The colours: a dark one and a light one, or those of a terminal that has but sixteen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rich.terminal_theme import TerminalTheme
from textual.theme import Theme

from calm.checks.finding import State


def _bars(ground: str, bar: str, lit: str) -> dict[str, str]:
    """Scroll bars that do not shout."""
    return {
        "scrollbar": bar,
        "scrollbar-hover": lit,
        "scrollbar-active": lit,
        "scrollbar-background": ground,
        "scrollbar-background-hover": ground,
        "scrollbar-background-active": ground,
        "scrollbar-corner-color": ground,
    }


DARK = Theme(
    name="calm-dark",
    primary="#5aa9d6",
    secondary="#3b7ea1",
    accent="#7fd1c7",
    warning="#e0b050",
    error="#e5746b",
    success="#7cc58a",
    foreground="#d6dee4",
    background="#10171d",
    surface="#1b2730",
    panel="#1f2d38",
    dark=True,
    variables=_bars("#10171d", "#33475a", "#45617a"),
)
LIGHT = Theme(
    name="calm-light",
    primary="#1f6f9c",
    secondary="#3b7ea1",
    accent="#0c7a70",
    warning="#8a6100",
    error="#b3261e",
    success="#1e7d34",
    foreground="#16222b",
    background="#f7f9fa",
    surface="#e6ecf0",
    panel="#dbe4ea",
    dark=False,
    variables=_bars("#f7f9fa", "#b9c8d3", "#9db2c1"),
)

_MANY = frozenset({"truecolor", "24bit", "256"})
_LIGHT_GROUNDS = frozenset({"7", *map(str, range(9, 16))})


PICTURE_DARK = TerminalTheme(
    (0x10, 0x17, 0x1D),
    (0xD6, 0xDE, 0xE4),
    [
        (0x10, 0x17, 0x1D),
        (0xE5, 0x74, 0x6B),
        (0x7C, 0xC5, 0x8A),
        (0xC9, 0xA2, 0x5C),
        (0x5A, 0x8F, 0xD6),
        (0xB3, 0x9D, 0xDB),
        (0x7F, 0xD1, 0xC7),
        (0xD6, 0xDE, 0xE4),
    ],
)
PICTURE_LIGHT = TerminalTheme(
    (0xF7, 0xF9, 0xFA),
    (0x16, 0x22, 0x2B),
    [
        (0x16, 0x22, 0x2B),
        (0xB3, 0x26, 0x1E),
        (0x1E, 0x7D, 0x34),
        (0x8A, 0x61, 0x00),
        (0x1F, 0x56, 0xA8),
        (0x6A, 0x3F, 0xA0),
        (0x0C, 0x7A, 0x70),
        (0xE6, 0xEC, 0xF0),
    ],
)
"""What the eight colours of the pictures and of the verdict are in these themes."""


def themes() -> tuple[Theme, ...]:
    """Return those of the application."""
    return DARK, LIGHT


def choose_theme(environ: Mapping[str, str]) -> str:
    """The name of the theme for a terminal.

    One that reports 256 colours or more gets those of the application; another one keeps its own
    sixteen, which its owner has chosen to be legible. The ground is light where `COLORFGBG`, which
    many terminals set, names a light colour as the last of its two or three.
    """
    announced = (environ.get("COLORTERM"), environ.get("TEXTUAL_COLOR_SYSTEM"))
    many = "256" in environ.get("TERM", "") or not _MANY.isdisjoint(announced)
    if environ.get("COLORFGBG", "").rpartition(";")[2] in _LIGHT_GROUNDS:
        return LIGHT.name if many else "ansi-light"
    return DARK.name if many else "ansi-dark"


@dataclass(frozen=True)
class Look:
    """The sign and the word of a state, and the style of rich that goes with them."""

    sign: str
    word: str
    style: str


LOOKS = {
    State.FAIL: Look("!", "FAIL", "bold red"),
    State.WARN: Look("~", "warning", "yellow"),
    State.UNKNOWN: Look("?", "unknown", "dim"),
    State.ESTIMATED: Look("≈", "estimated", "green"),
    State.ACCEPTED: Look("·", "accepted", "dim"),
    State.PASS: Look("✓", "pass", "green"),
}
"""As in the reports of the design check."""

ROLES = {
    "float": "o",
    "instrument": "▪",
    "release": "R",
    "connector": "·",
    "line": "│",
    "anchor": "█",
}
"""What stands for a component in front of its row."""

UNKNOWN_ROLE = "?"
UNKNOWN_MARGIN = "?"
CLAMP = "├"
CURSOR = "▸"
MARK = "*"
FAVOURITE = "★"
ELLIPSIS = "…"


def worst(states: list[State]) -> State | None:
    """The gravest of some states; None of none."""
    return max(states, key=lambda state: state.severity, default=None)
