"""Colour themes: dark, light, or the sixteen colours of the terminal."""

from collections.abc import Mapping
from functools import lru_cache

from rich.color import Color as Ink
from rich.color import ColorSystem, blend_rgb
from rich.color_triplet import ColorTriplet
from rich.segment import Segment
from rich.style import Style
from rich.terminal_theme import TerminalTheme
from textual.color import Color
from textual.filter import LineFilter
from textual.theme import Theme

from calm.checks.finding import State


def _bars(ground: str, bar: str, lit: str) -> dict[str, str]:
    grounds = ("background", "background-hover", "background-active", "corner-color")
    bars = {"scrollbar": bar, "scrollbar-hover": lit, "scrollbar-active": lit}
    return bars | {f"scrollbar-{each}": ground for each in grounds}


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


def _palette(ground: str, text: str, colours: str) -> TerminalTheme:
    """Build a palette from a background, a text colour and eight colours in hexadecimal RGB."""
    own, ink, *eight = (tuple(bytes.fromhex(each)) for each in (ground, text, *colours.split()))
    return TerminalTheme(own, ink, eight)  # type: ignore[arg-type]


PICTURE_DARK = _palette(
    "10171d", "d6dee4", "10171d e5746b 7cc58a c9a25c 5a8fd6 b39ddb 7fd1c7 d6dee4"
)
PICTURE_LIGHT = _palette(
    "f7f9fa", "16222b", "16222b b3261e 1e7d34 8a6100 1f56a8 6a3fa0 0c7a70 e6ecf0"
)
"""Colours of the pictures and of the verdict in the light theme."""


def choose_theme(environ: Mapping[str, str]) -> str:
    """Choose the theme for a terminal, and return its name.

    A terminal with fewer than 256 colours keeps its own sixteen colours. The background counts as
    light if the last field of the variable `COLORFGBG` is a light colour.
    """
    announced = (environ.get("COLORTERM"), environ.get("TEXTUAL_COLOR_SYSTEM"))
    many = "256" in environ.get("TERM", "") or not _MANY.isdisjoint(announced)
    if environ.get("COLORFGBG", "").rpartition(";")[2] in _LIGHT_GROUNDS:
        return LIGHT.name if many else "ansi-light"
    return DARK.name if many else "ansi-dark"


_LEAST_CONTRAST = 4.5
"""Minimum contrast of text (WCAG 2.2, success criterion 1.4.3)."""
_OWN = Ink.default()
_ON_DARK = {1: 9, 2: 2, 3: 11, 4: 6, 6: 6, 7: 7, 9: 9, 10: 10, 11: 11, 12: 6, 14: 14, 15: 15}
_ON_LIGHT = {0: 0, 1: 1, 4: 4}
"""Replacements of the sixteen terminal colours on a light background.

A colour that is not listed becomes the text colour of the terminal. The replacements also suit a
terminal with eight colours, which has no bright colours.
"""


class Legible(LineFilter):
    """Line filter that makes text legible on its background.

    `dark` is true if the background is dark. If `sixteen` is true, the terminal uses its own
    colours, and the exact background is unknown.
    """

    def __init__(self, *, dark: bool, sixteen: bool) -> None:
        super().__init__()
        self._dark, self._sixteen = dark, sixteen

    def apply(self, segments: list[Segment], background: Color) -> list[Segment]:
        ground = background.rich_color

        def style(given: Style) -> Style:
            return (
                _of_sixteen(given, self._dark) if self._sixteen else _with_contrast(given, ground)
            )

        return [
            each
            if each.style is None or each.text.isspace()
            else Segment(each.text, style(each.style), each.control)
            for each in segments
        ]


@lru_cache(4)
def legible(dark: bool, sixteen: bool) -> Legible:
    """Return the filter for a dark or light background.

    Equal arguments always return the same filter object.
    """
    # cached, because Textual caches the filtered lines by filter
    return Legible(dark=dark, sixteen=sixteen)


@lru_cache(1024)
def _of_sixteen(style: Style, dark: bool) -> Style:
    """Convert a style to the terminal's own colours; a background becomes reverse video."""
    ink = style.color or _OWN
    if style.bgcolor is not None and not style.bgcolor.is_default:
        return style + Style(color=_OWN, bgcolor=_OWN, reverse=True, dim=False)
    number = (_ON_DARK if dark else _ON_LIGHT).get(-1 if ink.number is None else ink.number)
    return style + Style(color=_OWN if number is None else Ink.from_ansi(number), dim=False)


@lru_cache(4096)
def _with_contrast(style: Style, ground: Ink) -> Style:
    on, ink = (style.bgcolor or ground).triplet, style.color and style.color.triplet
    if on is None or ink is None or _is_legible(ink, on):
        return style
    black, white = ColorTriplet(0, 0, 0), ColorTriplet(255, 255, 255)
    end = max((black, white), key=lambda each: contrast(each, on))
    steps = (blend_rgb(ink, end, tenth / 10) for tenth in range(1, 11))
    moved = next((each for each in steps if _is_legible(each, on)), end)
    return style + Style(color=Ink.from_triplet(moved))


def _is_legible(ink: ColorTriplet, on: ColorTriplet) -> bool:
    pair = map(Ink.from_triplet, (ink, on))
    few = (each.downgrade(ColorSystem.EIGHT_BIT).get_truecolor() for each in pair)
    return min(contrast(ink, on), contrast(*few)) >= _LEAST_CONTRAST


def contrast(one: ColorTriplet, other: ColorTriplet) -> float:
    """Return the contrast ratio of two colours, from 1 to 21 (WCAG 2.2)."""
    less, more = sorted(map(_luminance, (one, other)))
    return (more + 0.05) / (less + 0.05)


def _luminance(colour: ColorTriplet) -> float:
    """Return the relative luminance of a colour (WCAG 2.2)."""
    red, green, blue = (
        part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4
        for part in colour.normalized
    )
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


LOOKS = {
    State.FAIL: "bold red",
    State.WARN: "yellow",
    State.UNKNOWN: "bold",
    State.ESTIMATED: "green",
    State.ACCEPTED: "dim",
    State.NOT_JUDGED: "dim",
    State.PASS: "green",
}
"""Rich style of the sign for each state."""

ROLES = {
    "float": "o",
    "instrument": "▪",
    "release": "R",
    "connector": "·",
    "line": "│",
    "anchor": "█",
}
"""Sign in front of a row, by role of the component."""

UNKNOWN_ROLE = "?"
UNKNOWN_USE = "?"
CLAMP = "├"
CURSOR = "▸"
MARK = "*"
FAVOURITE = "★"
ELLIPSIS = "…"
