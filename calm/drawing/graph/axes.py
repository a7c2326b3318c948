"""Axes of a graph, what is drawn between them, and what its lines and signs mean."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np
from numpy.typing import ArrayLike

from calm.drawing.graph.scale import Scale, Tick
from calm.drawing.picture import within_xml
from calm.drawing.schematic.pen import INK, Pen, picture, text_width
from calm.physics.line import Floats


class Stroke(NamedTuple):
    """A line's colour and width [pt].

    `dashes` are the lengths [pt] of dashes and gaps, of which an unbroken line has none; a `square`
    one goes on by half its width at both ends, so that the shortest is seen.
    """

    colour: str
    width: float = 1.2
    dashes: tuple[float, ...] = ()
    square: bool = False

    def attributes(self) -> dict[str, float | str]:
        """As a pen takes them."""
        written: dict[str, float | str] = {"stroke": self.colour, "stroke_width": self.width}
        if self.dashes:
            written["stroke_dasharray"] = " ".join(f"{each:g}" for each in self.dashes)
        if self.square:
            written["stroke_linecap"] = "square"
        return written


_FRAME = Stroke(INK, 0.7)
_GRID = Stroke("#e3e6ea", 0.6)
_TICK = 3.0  # points
_NEAREST = 0.05  # points: of two that are nearer one is drawn


class Graph:
    """An empty white graph of a width and height [pt]."""

    def __init__(self, width: float, height: float, title: str, size: float) -> None:
        self.pen, self.size = picture(width, height, title), size

    def svg(self) -> str:
        """The graph as text that can stand inside a page."""
        return within_xml(ElementTree.tostring(self.pen.element, encoding="unicode"))

    def axes(
        self, left: float, top: float, width: float, height: float, across: Scale, up: Scale
    ) -> Axes:
        """Axes at a place [pt] of the graph, their ranges from left to right and upward."""
        return Axes(self, (left, top, width, height), across, up)


class Axes:
    """Two scales, and a frame that `frame` draws around what was drawn between them."""

    def __init__(
        self, graph: Graph, place: tuple[float, float, float, float], across: Scale, up: Scale
    ) -> None:
        self.graph, self.across, self.up = graph, across, up
        self.left, self.top, self.width, self.height = place
        self._grid = graph.pen.draw("g", **_GRID.attributes())
        self._drawn = graph.pen.draw("g")

    def x(self, value: ArrayLike) -> Floats:
        """Points from the left edge of the graph."""
        return np.asarray(self.left + self.width * self.across.share(value))

    def y(self, value: ArrayLike) -> Floats:
        """Points from the upper edge of the graph."""
        return np.asarray(self.top + self.height * (1.0 - self.up.share(value)))

    def line(self, x: ArrayLike, y: ArrayLike, stroke: Stroke) -> None:
        """A line from point to point, interrupted where one is not known."""
        path = _path(self.x(x), self.y(y))
        if path:
            self._drawn.path(path, **stroke.attributes())

    def lines(self, x: ArrayLike, y: ArrayLike, stroke: Stroke) -> None:
        """Lines apart, (2, n) ends of each; what is not known is left out."""
        (x1, x2), (y1, y2) = np.broadcast_arrays(self.x(x), self.y(y))
        for ends in zip(x1.tolist(), y1.tolist(), x2.tolist(), y2.tolist(), strict=True):
            if all(map(isfinite, ends)):
                left, top, right, bottom = ends
                self._drawn.line(left, top, right, bottom, **stroke.attributes())

    def level(self, value: float, stroke: Stroke) -> None:
        """A line across at a value of the upward axis."""
        y = float(self.y(value))
        self._drawn.line(self.left, y, self.left + self.width, y, **stroke.attributes())

    def plumb(self, value: float, stroke: Stroke) -> None:
        """A line up and down at a value of the axis across."""
        x = float(self.x(value))
        self._drawn.line(x, self.top, x, self.top + self.height, **stroke.attributes())

    def strip(self, low: float, high: float, colour: str) -> None:
        """Do what lies between two values of the upward axis, filled."""
        y = sorted(map(float, self.y([low, high])))
        self._drawn.draw(
            "rect", x=self.left, y=y[0], width=self.width, height=y[1] - y[0], fill=colour
        )

    def band(self, x: ArrayLike, low: ArrayLike, high: ArrayLike, colour: str) -> None:
        """Do what lies between two curves, filled; parted where one is not known."""
        across, bottom, top = self.x(x), self.y(low), self.y(high)
        known = np.isfinite(bottom) & np.isfinite(top)
        ends = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]])))
        path = "".join(
            _path(_there(across[known]), np.append(top[known], bottom[known][::-1])) + "Z"
            for known in map(slice, ends[::2], ends[1::2])
        )
        if path:
            self._drawn.path(path, fill=colour, stroke=colour, stroke_width=0.4)

    def bars(self, at: ArrayLike, value: ArrayLike, width: float, colours: Sequence[str]) -> None:
        """Bars from zero to values, `width` wide on the axis across."""
        centres = np.asarray(at, dtype=np.float64)
        edges = self.x(centres - width / 2), self.x(centres + width / 2)
        ends, zero = self.y(value), float(self.y(0.0))
        for left, right, end, colour in zip(*edges, ends, colours, strict=True):
            if np.isfinite(end):
                self._drawn.draw(
                    "rect", x=float(left), y=min(float(end), zero), width=float(right - left),
                    height=abs(float(end) - zero), fill=colour,
                )  # fmt: skip

    def mark(self, x: float, y: float, sign: str, size: float, colour: str) -> None:
        """A sign at a point, as `calm.drawing.graph.draw_mark` draws it."""
        draw_mark(self._drawn, float(self.x(x)), float(self.y(y)), sign, size, colour)

    def frame(
        self,
        across: Sequence[Tick],
        up: Sequence[Tick],
        *,
        below: str = "",
        beside: str = "",
        grid: bool = False,
        numbered: tuple[bool, bool] = (True, True),
    ) -> None:
        """The frame with its ticks; to be drawn last.

        Parameters
        ----------
        below, beside : what the axis across and the upward one show; lines apart by line feeds
        grid : whether ticks go on as thin lines behind what is drawn
        numbered : whether the axis across, and the upward one, have their texts
        """
        pen, size = self.graph.pen, self.graph.size
        right, bottom = self.left + self.width, self.top + self.height
        for tick in across:
            x = float(self.x(tick.value))
            pen.line(x, bottom, x, bottom + _TICK, **_FRAME.attributes())
            if grid:
                self._grid.line(x, self.top, x, bottom)
            if numbered[0]:
                pen.letters(x, bottom + _TICK + 0.8 * size, tick.text, size=size, anchor="middle")
        for tick in up:
            y = float(self.y(tick.value))
            pen.line(self.left - _TICK, y, self.left, y, **_FRAME.attributes())
            if grid:
                self._grid.line(self.left, y, right, y)
            if numbered[1]:
                pen.letters(self.left - _TICK - 2.0, y, tick.text, size=size, anchor="end")
        pen.draw(
            "rect", x=self.left, y=self.top, width=self.width, height=self.height,
            **_FRAME.attributes(),
        )  # fmt: skip
        if below:
            at = bottom + _TICK + (2.3 if numbered[0] else 1.0) * size
            pen.letters(self.left + self.width / 2, at, below, size=size, anchor="middle")
        widest = max((text_width(each.text, size) for each in up), default=0.0)
        room = _TICK + 2.0 + (widest if numbered[1] else 0.0)
        said = beside.split("\n") if beside else []
        for number, text in enumerate(reversed(said)):
            x = self.left - room - (0.8 + 1.2 * number) * size
            turned = f"translate({x:.2f} {self.top + self.height / 2:.2f}) rotate(-90)"
            pen.draw("g", transform=turned).letters(0.0, 0.0, text, size=size, anchor="middle")


def _there(across: Floats) -> Floats:
    """There and back."""
    return np.append(across, across[::-1])


def _path(x: Floats, y: Floats) -> str:
    """Straight lines through points; a new one begins after what is not known."""
    parts: list[str] = []
    last: tuple[float, float] | None = None
    for point in zip(x.tolist(), y.tolist(), strict=True):
        if point[0] != point[0] or point[1] != point[1]:
            last = None
        elif last is None:
            parts.append(f"M{point[0]:.2f} {point[1]:.2f}")
            last = point
        elif abs(point[0] - last[0]) + abs(point[1] - last[1]) >= _NEAREST:
            parts.append(f"L{point[0]:.2f} {point[1]:.2f}")
            last = point
    return "".join(parts)


_SAMPLE, _GAP = 16.0, 5.0  # points: the line beside a text, and what is between them


class LegendEntry(NamedTuple):
    """A text with its line, or its sign: form, width [pt] and colour."""

    text: str
    line: Stroke | None = None
    sign: tuple[str, float, str] | None = None


def write_legend(
    pen: Pen,
    entries: Sequence[LegendEntry],
    left: float,
    top: float,
    *,
    width: float,
    row: float,
    columns: int,
    size: float,
) -> None:
    """Entries row by row in columns that share a width; a text that is too long is cut short."""
    across = width / columns
    for number, entry in enumerate(entries):
        x, y = left + number % columns * across, top + (number // columns + 0.5) * row
        if entry.line is not None:
            pen.line(x, y, x + _SAMPLE, y, **entry.line.attributes())
        if entry.sign is not None:
            draw_mark(pen, x + _SAMPLE / 2, y, *entry.sign)
        room = across - _SAMPLE - 2 * _GAP
        pen.write(x + _SAMPLE + _GAP, y, " ".join(entry.text.split()), room, size=size)


def draw_mark(pen: Pen, x: float, y: float, sign: str, size: float, colour: str) -> None:
    """A filled sign of some width [pt] at a point: o, s (square), D (diamond) or v (downward)."""
    half = size / 2
    if sign == "o":
        pen.circle(x, y, half, fill=colour)
    elif sign == "s":
        pen.box(x, y, size, size, fill=colour)
    else:
        corners = {
            "D": ((0, -1.2), (1.2, 0), (0, 1.2), (-1.2, 0)),
            "v": ((-1, -0.9), (1, -0.9), (0, 1)),
        }[sign]
        points = " ".join(f"{x + half * u:.2f},{y + half * v:.2f}" for u, v in corners)
        pen.draw("polygon", points=points, fill=colour)
