"""Elements of an SVG picture; every text and attribute is escaped as the picture is written."""

from __future__ import annotations

from xml.etree import ElementTree

from calm.report.schematic.sign import Symbol
from calm.report.schematic.text_layout import shortened

INK, SOFT, FAINT = "#1b2733", "#5a6672", "#c3ccd4"
"""Colours of what is to be read first, next, and last."""


class Pen:
    """Draws into an element of a picture.

    Parameters
    ----------
    element : xml.etree.ElementTree.Element
        What it draws is added to it.
    """

    def __init__(self, element: ElementTree.Element) -> None:
        self.element = element

    def draw(self, tag: str, **attributes: float | str) -> Pen:
        """A new element; of an attribute's name ``_`` stands for ``-``. Gives a pen for it."""
        written = {name.replace("_", "-"): _text(value) for name, value in attributes.items()}
        return Pen(ElementTree.SubElement(self.element, tag, written))

    def group(self, x: float, y: float, scale: float = 1.0, **attributes: float | str) -> Pen:
        """A group with its own origin."""
        transform = f"translate({_text(x)} {_text(y)})"
        if scale != 1.0:
            transform += f" scale({_text(scale)})"
        return self.draw("g", transform=transform, **attributes)

    def title(self, text: str) -> None:
        """The text a reader sees who points at the element."""
        self.draw("title").element.text = text

    def line(self, x1: float, y1: float, x2: float, y2: float, **attributes: float | str) -> None:
        """A straight line."""
        self.draw("line", x1=x1, y1=y1, x2=x2, y2=y2, **attributes)

    def circle(self, x: float, y: float, radius: float, **attributes: float | str) -> None:
        """A circle about a point."""
        self.draw("circle", cx=x, cy=y, r=radius, **attributes)

    def box(
        self, x: float, y: float, width: float, height: float, **attributes: float | str
    ) -> None:
        """A rectangle centred at a point."""
        left, top = x - width / 2, y - height / 2
        self.draw("rect", x=left, y=top, width=width, height=height, **attributes)

    def path(self, d: str, **attributes: float | str) -> None:
        """A path."""
        self.draw("path", d=d, **attributes)

    def write(
        self,
        x: float,
        y: float,
        text: str,
        width: float,
        *,
        size: float,
        colour: str = INK,
        bold: bool = False,
        anchor: str = "start",
    ) -> None:
        """A text in a width, its middle at `y`; one that is cut has the whole for its title."""
        shown = shortened(text, width, size, bold=bold)
        pen = self.letters(x, y, shown, size=size, colour=colour, bold=bold, anchor=anchor)
        if shown != text:
            pen.element.text = None
            pen.title(text)
            pen.element[-1].tail = shown

    def letters(
        self,
        x: float,
        y: float,
        text: str,
        *,
        size: float,
        colour: str = INK,
        bold: bool = False,
        anchor: str = "start",
    ) -> Pen:
        """A text whole, its middle at `y`; nothing is drawn of an empty one."""
        if not text:
            return self
        weight = {"font_weight": "bold"} if bold else {}
        pen = self.draw(
            "text",
            x=x,
            y=y + 0.35 * size,
            font_size=size,
            fill=colour,
            text_anchor=anchor,
            **weight,
        )
        pen.element.text = text
        return pen


def _text(value: float | str) -> str:
    return value if isinstance(value, str) else f"{round(value, 2) + 0.0:g}"


_WATER, _SURFACE, _SAND, _HULL = "#eff6fb", "#2f7fb5", "#e3d6b8", "#5b6b7a"
_ROPE = "#f3e7c4"
_STRAND = 4.6
_SEABED = 22.0
_LINK = 7.0
_WAVE = 9.0


def draw_cable(pen: Pen, symbol: Symbol, x: float, top: float, bottom: float) -> None:
    """A wire as a solid line, a rope as a laid one, a chain by its links."""
    if symbol is Symbol.WIRE:
        pen.line(x, top, x, bottom, stroke_width=2.4)
    elif symbol is Symbol.ROPE:
        pen.line(x, top, x, bottom, stroke_width=5.6)
        pen.line(x, top, x, bottom, stroke=_ROPE, stroke_width=3.6)
        count = max(1, round((bottom - top) / _STRAND))
        pitch = (bottom - top) / count
        strands = (f"M{x - 1.8:g} {top + n * pitch + 3.8:.2f}l3.6 -3" for n in range(count))
        pen.path("".join(strands), fill="none", stroke_width=1.1)
    else:
        _draw_chain(pen, x, top, bottom)


def _draw_chain(pen: Pen, x: float, top: float, bottom: float) -> None:
    """Links in turn seen from the front and from the side."""
    count = max(3, round((bottom - top) / _LINK))
    pitch = (bottom - top) / count
    for number in range(count):
        y = top + (number + 0.5) * pitch
        if number % 2:
            pen.line(x, y - 0.75 * pitch, x, y + 0.75 * pitch, stroke_width=2.4)
    for number in range(0, count, 2):
        y = top + (number + 0.5) * pitch
        pen.draw("ellipse", cx=x, cy=y, rx=3.2, ry=0.62 * pitch, fill="none", stroke_width=1.7)


def draw_water(pen: Pen, width: float, top: float, bottom: float) -> None:
    """The water behind the line."""
    height = bottom - top
    pen.box(width / 2, (top + bottom) / 2, width, height, fill=_WATER, stroke="none")


def draw_surface(pen: Pen, width: float, y: float) -> None:
    """The waves of the sea surface."""
    waves = int(width / _WAVE / 2)
    step = width / waves / 2
    path = f"M0 {y:g}" + f"q{step / 2:.3g} -4 {step:.3g} 0t{step:.3g} 0" * waves
    pen.path(path, fill="none", stroke=_SURFACE, stroke_width=1.3)


def draw_seabed(pen: Pen, width: float, y: float) -> None:
    """The seabed, hatched."""
    pen.box(width / 2, y + _SEABED / 2, width, _SEABED, fill=_SAND, stroke="none")
    for number in range(int(width / 10)):
        x = 10.0 * number + 9.0
        pen.line(x, y, x - 7.0, y + 8.0, stroke_width=0.7)
    pen.line(0.0, y, width, y, stroke_width=1.6)


def draw_ship(pen: Pen) -> None:
    """A ship that tows from its A-frame, whose sheave is at the origin; 26 above the water."""
    pen.path("M-62 16L-14 16L-12 32Q-36 36 -56 32Z", fill=_HULL)
    pen.path("M-50 16L-50 3L-30 3L-30 16Z", fill="white")
    pen.path("M-46 7L-34 7", stroke_width=2.2)
    pen.path("M-42 3L-42 -8M-45 -4L-39 -4", fill="none")
    pen.path("M-16 16L0 0M-24 16L0 0", fill="none", stroke_width=1.8)
    pen.circle(0.0, 0.0, 3.0, fill="white", stroke_width=1.6)


def draw_helicopter(pen: Pen) -> None:
    """A helicopter whose hook is at the origin."""
    pen.path("M-40 -26L-8 -22L-8 -17L-40 -23Z", fill=_HULL)
    pen.path("M-40 -33L-40 -19", fill="none", stroke_width=2.0)
    pen.path("M-14 -24Q-8 -31 4 -31Q20 -30 22 -19Q20 -11 8 -9L-6 -9Q-14 -11 -14 -24Z", fill=_HULL)
    pen.path("M8 -27Q17 -26 18 -19L8 -19Z", fill="white", stroke_width=0.9)
    pen.path("M2 -31L2 -37M-30 -37L34 -37", fill="none", stroke_width=2.0)
    pen.path("M-12 -3L16 -3M-5 -9L-6 -3M9 -9L10 -3", fill="none")
    pen.line(0.0, -9.0, 0.0, 0.0)


def draw_leader(pen: Pen, start: float, end: float, y: float) -> None:
    """A thin line from a symbol to its text."""
    pen.line(start, y, end, y, stroke=FAINT, stroke_width=0.8)


def draw_clamp(pen: Pen, reach: float) -> None:
    """What holds an instrument beside the line, which is at the origin."""
    for y in (-3.5, 3.5):
        pen.line(0.0, y, reach, y, stroke=INK, stroke_width=1.6)
