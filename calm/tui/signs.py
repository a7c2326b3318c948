"""How a state looks: a sign and a word that tell it without colour, and a colour besides."""

from __future__ import annotations

from dataclasses import dataclass

from calm.checks.finding import State


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
