"""The colours: a dark one and a light one, or those of a terminal that has but sixteen."""

from __future__ import annotations

from collections.abc import Mapping

from textual.theme import Theme


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


def themes() -> tuple[Theme, ...]:
    """Those of the application."""
    return DARK, LIGHT


def choose_theme(environ: Mapping[str, str]) -> str:
    """The name of the theme for a terminal.

    One that tells of 256 colours or more gets those of the application; another one keeps its own
    sixteen, which its owner has chosen to be legible.
    """
    told = (environ.get("COLORTERM"), environ.get("TEXTUAL_COLOR_SYSTEM"))
    many = "256" in environ.get("TERM", "") or not _MANY.isdisjoint(told)
    return DARK.name if many else "ansi-dark"
