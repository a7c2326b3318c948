"""Graphs as SVG: scales, axes and legends.

Lengths are in points (1/72 inch). The origin is the upper left corner of the graph.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, copysign, floor, isfinite, log10
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np
from numpy.typing import ArrayLike, NDArray

from calm.drawing.picture import within_xml
from calm.drawing.schematic.pen import INK, Pen, picture, text_width
from calm.physics.line import Floats

COLOURS = ("#0b3c5d", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#a6761d", "#332288")
"""Colours of the lines in a graph, in order of use."""

_MARGIN = 0.05  # share of the range, on either side


@dataclass(frozen=True)
class Scale:
    """A linear or logarithmic range of values along an axis.

    `low` is the value at the left or lower edge, and may be larger than `high`. On a logarithmic
    scale, `low` and `high` are positive.
    """

    low: float
    high: float
    logarithmic: bool = False

    def share(self, value: ArrayLike) -> Floats:
        """Return the positions of values along the axis, as fractions: 0 at `low`, 1 at `high`.

        On a logarithmic scale, zero and negative values give NaN.
        """
        given: Any = np.asarray(value, dtype=np.float64)
        if not self.logarithmic:
            return np.asarray((given - self.low) / (self.high - self.low))
        known = np.where(given > 0.0, given, np.nan)
        return np.asarray(np.log(known / self.low) / np.log(self.high / self.low))


def covering(*values: ArrayLike, margin: float = _MARGIN) -> Scale:
    """Return a linear scale that covers all finite values, with a margin.

    Without finite values, the scale is from 0 to 1.
    """
    every = np.concatenate([np.ravel(np.asarray(each, dtype=np.float64)) for each in values])
    every = every[np.isfinite(every)]
    if not every.size:
        return Scale(0.0, 1.0)
    low, high = float(every.min()), float(every.max())
    spare = margin * (high - low) or margin * abs(low) or margin
    return Scale(low - spare, high + spare)


def to_one_scale(across: Scale, up: Scale, width: float, height: float) -> tuple[Scale, Scale]:
    """Return both scales, with equal lengths per point; the range that is too short is widened.

    The middle of the range does not change.

    Parameters
    ----------
    width, height : width and height of the axes [pt]
    """
    unit = max(abs(across.high - across.low) / width, abs(up.high - up.low) / height)
    return _widened(across, unit * width), _widened(up, unit * height)


def _widened(scale: Scale, extent: float) -> Scale:
    middle = (scale.low + scale.high) / 2
    half = copysign(extent / 2, scale.high - scale.low)
    return Scale(middle - half, middle + half)


_STEPS = (1.0, 2.0, 5.0, 10.0)
# time steps: unit, number of units, range of characters in ISO 8601, approximate duration in
# seconds
_TIMES = (
    *(("m", count, (11, 16), 60.0 * count) for count in (1, 2, 5, 10, 30)),
    *(("h", count, (5, 16), 3600.0 * count) for count in (1, 3, 6, 12)),
    *(("D", count, (0, 10), 86400.0 * count) for count in (1, 2, 5, 10)),
    *(("M", count, (0, 7), 2629746.0 * count) for count in (1, 2, 3, 6)),
    *(("Y", count, (0, 4), 31556952.0 * count) for count in (1, 2, 5, 10, 20, 50, 100)),
)


class Tick(NamedTuple):
    """A tick of an axis: value and text."""

    value: float
    text: str


def numbers(low: float, high: float, most: int) -> list[Tick]:
    """Return about `most` ticks at round numbers between `low` and `high`.

    `low` may be larger than `high`.
    """
    low, high = min(low, high), max(low, high)
    values = round_numbers(low, high, most)
    return [Tick(value, number(value).replace("-", "\N{MINUS SIGN}")) for value in values]


def counts(first: int, last: int, most: int) -> list[Tick]:
    """Return ticks at whole numbers from `first` to `last`, in at most `most` equal round steps."""
    wanted = max((last - first) / max(most, 1), 1.0)
    power = 10 ** floor(log10(wanted))
    step = next(int(each) * power for each in _STEPS if each * power >= wanted)
    return [
        Tick(float(value), str(value)) for value in range(-(-first // step) * step, last + 1, step)
    ]


def decades(low: float, high: float) -> list[Tick]:
    """Return ticks at the powers of ten between two positive values."""
    powers = range(ceil(log10(low) - 1e-9), floor(log10(high) + 1e-9) + 1)
    return [Tick(10.0**power, f"{10.0**power:g}") for power in powers]


def moments(begin: np.datetime64, end: np.datetime64, most: int) -> list[Tick]:
    """Return ticks at round times, with values in seconds since 1970.

    `most` is the approximate maximum number of ticks.
    """
    edges = np.array([begin, end])
    first, last = seconds(edges)
    wanted = (last - first) / max(most, 1)
    unit, count, (start, stop), _ = next((each for each in _TIMES if each[3] >= wanted), _TIMES[-1])
    since, until = (
        int(each) for each in np.array([begin, end], f"datetime64[{unit}]").astype("i8")
    )
    if unit == "D" and count > 1:
        times = _days_of_months(edges.astype("datetime64[M]"), count)
    else:
        base = 1970 if unit == "Y" else 0  # years are counted from then
        whole = np.arange((since + base) // count * count, until + base + 1, count) - base
        times = whole.astype(f"datetime64[{unit}]")
    texts = np.datetime_as_string(times.astype("datetime64[s]"))
    return [
        Tick(float(second), str(text)[start:stop].replace("T", " "))
        for second, text in zip(seconds(times), texts, strict=True)
        if first <= second <= last
    ]


def seconds(times: Any) -> NDArray[np.float64]:
    """Convert (n,) times to seconds since 1970."""
    return np.asarray(times.astype("datetime64[ms]").astype("i8") / 1e3)


def _days_of_months(months: Any, step: int) -> Any:
    """Return the first day of each month, and every `step`-th day after the first day.

    The last of these days is omitted if the next month begins soon after it.
    """
    each = np.arange(months[0], months[1] + 1).astype("datetime64[D]")
    return (each[:, None] + np.arange(0, 29 - step // 2, step)).ravel()


def round_numbers(low: float, high: float, most: int) -> list[float]:
    """Return about `most` round numbers between `low` and `high`, but at least two."""
    raw = (high - low) / max(most, 1)
    power = 10.0 ** floor(log10(raw))
    step = next(power * each for each in _STEPS if power * each >= raw * (1.0 - 1e-9))
    values = _multiples(step, low, high)
    return values if len(values) > 1 else _multiples(step / 2.0, low, high)


def _multiples(step: float, low: float, high: float) -> list[float]:
    first, last = ceil(low / step - 1e-9), floor(high / step + 1e-9)
    return [count * step for count in range(first, last + 1)]


def number(value: float) -> str:
    """Format a number for the axis of a graph."""
    return f"{value:z.6g}" if abs(value) < 1e6 else f"{value:.0f}"


class Stroke(NamedTuple):
    """Colour, width [pt] and dashes of a line.

    `dashes` are the lengths of dashes and gaps [pt], or empty for a solid line. If `square` is
    true, the line extends beyond each end by half of its width.
    """

    colour: str
    width: float = 1.2
    dashes: tuple[float, ...] = ()
    square: bool = False

    def attributes(self) -> dict[str, float | str]:
        """Return the SVG attributes of a line with this stroke."""
        written: dict[str, float | str] = {"stroke": self.colour, "stroke_width": self.width}
        if self.dashes:
            written["stroke_dasharray"] = " ".join(f"{each:g}" for each in self.dashes)
        if self.square:
            written["stroke_linecap"] = "square"
        return written


_FRAME, _GRID = Stroke(INK, 0.7), Stroke("#e3e6ea", 0.6)
_TICK = 3.0  # points
_NEAREST = 0.05  # points; a point closer to the previous one is not drawn


_SAMPLE, _GAP = 16.0, 5.0  # points: length of the line next to a text, and the gap between them


class LegendEntry(NamedTuple):
    """Legend entry: text, and a line or a mark (symbol, width [pt], colour)."""

    text: str
    line: Stroke | None = None
    sign: tuple[str, float, str] | None = None


class Graph:
    """An SVG graph with a white background; width and height are in points."""

    def __init__(self, width: float, height: float, title: str, size: float) -> None:
        self.pen, self.size = picture(width, height, title), size
        self.pen.element.set("fill", "none")  # curves and frames are not filled

    def svg(self) -> str:
        """Return the graph as an SVG element, for a file or for embedding in a page."""
        return within_xml(ElementTree.tostring(self.pen.element, encoding="unicode"))

    def axes(
        self,
        left: float,
        top: float,
        width: float,
        height: float,
        across: Scale,
        up: Scale,
        *,
        clipped: bool = False,
    ) -> Axes:
        """Add axes to the graph, with position and size in points.

        `across` and `up` are the horizontal and the vertical scale. If `clipped` is true, lines end
        at the frame.
        """
        return Axes(self, (left, top, width, height), across, up, clipped)

    def legend(
        self,
        entries: Sequence[LegendEntry],
        place: tuple[float, float],
        across: float,
        row: float,
        columns: int = 1,
    ) -> None:
        """Draw the legend row by row in columns; long texts are shortened.

        Parameters
        ----------
        place : upper left corner [pt]
        across, row : width of a column, and height of a row [pt]
        """
        for number, entry in enumerate(entries):
            x = place[0] + number % columns * across
            y = place[1] + (number // columns + 0.5) * row
            if entry.line is not None:
                self.pen.line(x, y, x + _SAMPLE, y, **entry.line.attributes())
            if entry.sign is not None:
                draw_mark(self.pen, x + _SAMPLE / 2, y, *entry.sign)
            text, room = " ".join(entry.text.split()), across - _SAMPLE - 2 * _GAP
            self.pen.write(x + _SAMPLE + _GAP, y, text, room, size=self.size)


class Axes:
    """Drawing area with two scales. Call `frame` last."""

    def __init__(
        self,
        graph: Graph,
        place: tuple[float, float, float, float],
        across: Scale,
        up: Scale,
        clipped: bool = False,
    ) -> None:
        self.graph, self.across, self.up = graph, across, up
        self.left, self.top, self.width, self.height = place
        self._grid = graph.pen.draw("g", **_GRID.attributes())
        self.drawn = graph.pen.draw("g")
        if clipped:
            name = f"axes-{len(graph.pen.element)}"
            left, top, width, height = place
            frame = graph.pen.draw("clipPath", id=name)
            frame.draw("rect", x=left, y=top, width=width, height=height)
            self.drawn = graph.pen.draw("g", clip_path=f"url(#{name})")

    def x(self, value: ArrayLike) -> Floats:
        """Return the distances [pt] of values from the left edge of the graph."""
        return np.asarray(self.left + self.width * self.across.share(value))

    def y(self, value: ArrayLike) -> Floats:
        """Return the distances [pt] of values from the upper edge of the graph."""
        return np.asarray(self.top + self.height * (1.0 - self.up.share(value)))

    def line(self, x: ArrayLike, y: ArrayLike, stroke: Stroke) -> None:
        """Draw a polyline, interrupted at NaN."""
        path = _path(self.x(x), self.y(y))
        if path:
            self.drawn.path(path, **stroke.attributes())

    def lines(self, x: ArrayLike, y: ArrayLike, stroke: Stroke) -> None:
        """Draw n separate line segments; segments with NaN are skipped.

        Parameters
        ----------
        x, y : (2, n) coordinates of the two ends of each segment
        """
        (x1, x2), (y1, y2) = np.broadcast_arrays(self.x(x), self.y(y))
        for ends in zip(x1.tolist(), y1.tolist(), x2.tolist(), y2.tolist(), strict=True):
            if all(map(isfinite, ends)):
                left, top, right, bottom = ends
                self.drawn.line(left, top, right, bottom, **stroke.attributes())

    def level(self, value: float, stroke: Stroke) -> None:
        """Draw a horizontal line at a value of the vertical axis."""
        y = float(self.y(value))
        self.drawn.line(self.left, y, self.left + self.width, y, **stroke.attributes())

    def plumb(self, value: float, stroke: Stroke) -> None:
        """Draw a vertical line at a value of the horizontal axis."""
        x = float(self.x(value))
        self.drawn.line(x, self.top, x, self.top + self.height, **stroke.attributes())

    def strip(self, low: float, high: float, colour: str) -> None:
        """Fill the strip between two values of the vertical axis."""
        y = sorted(map(float, self.y([low, high])))
        self.drawn.draw(
            "rect", x=self.left, y=y[0], width=self.width, height=y[1] - y[0], fill=colour
        )

    def band(self, x: ArrayLike, low: ArrayLike, high: ArrayLike, colour: str) -> None:
        """Fill the area between two curves, interrupted at NaN."""
        across, bottom, top = self.x(x), self.y(low), self.y(high)
        known = np.isfinite(bottom) & np.isfinite(top)
        ends = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]])))
        path = "".join(
            _path(
                np.append(across[known], across[known][::-1]),
                np.append(top[known], bottom[known][::-1]),
            )
            + "Z"
            for known in map(slice, ends[::2], ends[1::2])
        )
        if path:
            self.drawn.path(path, fill=colour, stroke=colour, stroke_width=0.4)

    def area(self, x: ArrayLike, y: ArrayLike, colour: str) -> None:
        """Fill a polygon with a transparent colour."""
        self.drawn.path(f"{_path(self.x(x), self.y(y))}Z", fill=colour, fill_opacity=0.2)

    def words(
        self,
        x: float,
        y: float,
        text: str,
        *,
        shift: tuple[float, float] = (4.0, -4.0),
        anchor: str = "start",
        colour: str = INK,
    ) -> None:
        """Write a text next to a point, shifted to the right and down by `shift` [pt]."""
        at = float(self.x(x)) + shift[0], float(self.y(y)) + shift[1]
        self.drawn.letters(*at, text, size=self.graph.size, anchor=anchor, colour=colour)

    def title(self, text: str) -> None:
        """Write a title above the left end of the frame; a long title is shortened."""
        size = self.graph.size
        self.graph.pen.write(self.left, self.top - 0.8 * size, text, self.width, size=size)

    def bars(self, at: ArrayLike, value: ArrayLike, width: float, colours: Sequence[str]) -> None:
        """Draw vertical bars from zero to the given values.

        `width` is in units of the horizontal axis.
        """
        centres = np.asarray(at, dtype=np.float64)
        edges = self.x(centres - width / 2), self.x(centres + width / 2)
        ends, zero = self.y(value), float(self.y(0.0))
        for left, right, end, colour in zip(*edges, ends, colours, strict=True):
            if np.isfinite(end):
                self.drawn.draw(
                    "rect", x=float(left), y=min(float(end), zero), width=float(right - left),
                    height=abs(float(end) - zero), fill=colour,
                )  # fmt: skip

    def mark(self, x: float, y: float, sign: str, size: float, colour: str) -> None:
        """Draw a mark at a point; the arguments are as in `draw_mark`."""
        draw_mark(self.drawn, float(self.x(x)), float(self.y(y)), sign, size, colour)

    def frame(
        self,
        across: Sequence[Tick] | int,
        up: Sequence[Tick] | int,
        *,
        below: str = "",
        beside: str = "",
        grid: bool = False,
        numbered: tuple[bool, bool] = (True, True),
    ) -> None:
        """Draw the frame and its ticks; call this after everything inside the frame has been drawn.

        Parameters
        ----------
        across, up : ticks, or approximate number of ticks at round numbers
        below, beside : axis labels, which may have several lines
        grid : whether to draw thin grid lines
        numbered : whether the horizontal and the vertical axis have numbers
        """
        pen, size = self.graph.pen, self.graph.size
        across, up = (
            numbers(scale.low, scale.high, ticks) if isinstance(ticks, int) else ticks
            for ticks, scale in ((across, self.across), (up, self.up))
        )
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
        lines_beside = beside.split("\n") if beside else []
        for number, text in enumerate(reversed(lines_beside)):
            x = self.left - room - (0.8 + 1.2 * number) * size
            turned = f"translate({x:.2f} {self.top + self.height / 2:.2f}) rotate(-90)"
            pen.draw("g", transform=turned).letters(0.0, 0.0, text, size=size, anchor="middle")

    def scale_above(self, ticks: Sequence[Tick], label: str) -> None:
        """Draw a second scale above the frame, with ticks at values of the horizontal axis."""
        pen, size = self.graph.pen, self.graph.size
        for tick in ticks:
            x = float(self.x(tick.value))
            pen.line(x, self.top - _TICK, x, self.top, **_FRAME.attributes())
            at = self.top - _TICK - 0.8 * size
            pen.letters(x, at, tick.text, size=size, anchor="middle")
        at = self.top - _TICK - 2.3 * size
        pen.letters(self.left + self.width / 2, at, label, size=size, anchor="middle")


def _path(x: Floats, y: Floats) -> str:
    parts: list[str] = []
    last: tuple[float, float] | None = None
    for here in zip(x.tolist(), y.tolist(), strict=True):
        if here[0] != here[0] or here[1] != here[1]:
            last = None
        elif last is None or abs(here[0] - last[0]) + abs(here[1] - last[1]) >= _NEAREST:
            parts.append(f"{'M' if last is None else 'L'}{here[0]:.2f} {here[1]:.2f}")
            last = here
    return "".join(parts)


def draw_mark(pen: Pen, x: float, y: float, sign: str, size: float, colour: str) -> None:
    """Draw a mark of a given width [pt] at a point.

    `sign` is o (circle), s (square), D (diamond), v or ^ (triangle), + (cross) or | (vertical
    line).
    """
    half = size / 2
    if sign == "o":
        pen.circle(x, y, half, fill=colour)
    elif sign == "s":
        pen.box(x, y, size, size, fill=colour)
    elif sign in "+|":
        ends = {"+": ((half, 0.0), (0.0, half)), "|": ((0.0, half),)}[sign]
        for across, up in ends:
            pen.line(x - across, y - up, x + across, y + up, stroke=colour, stroke_width=1.2)
    else:
        corners = {
            "D": ((0, -1.2), (1.2, 0), (0, 1.2), (-1.2, 0)),
            "v": ((-1, -0.9), (1, -0.9), (0, 1)),
            "^": ((-1, 0.9), (1, 0.9), (0, -1)),
        }[sign]
        points = " ".join(f"{x + half * u:.2f},{y + half * v:.2f}" for u, v in corners)
        pen.draw("polygon", points=points, fill=colour)
