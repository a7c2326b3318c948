"""Chart of cables in a uniform current for one value of K, on an A4 page.

K is the drag parameter from `calm.analytic.chart_branch`. The chart has one main curve, with ticks
at values of the angle φ and of the arc length s′. Any piece of the main curve is the shape of a
cable, with the lower end A and the upper end B.

Each cable is also a point P in the chart. The coordinates of P are y′ of A and z′ of B. Further
curves connect points P that have the same ratio L/H, D/H or T_A/(wH). L is the length of the cable.
D is the horizontal distance and H the vertical distance from A to B. T_A is the tension at A, and w
the weight per metre.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.analytic.chart_branch import CurvePoints, critical_angle, curve
from calm.drawing.plot import empty_figure
from calm.errors import UsageError
from calm.physics.line import Floats
from calm.report.blocks import Field, Note, ReportPart, number, table_of, words
from calm.report.result_files import members

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.text import Text
    from matplotlib.transforms import Bbox
    from numpy.typing import NDArray

    from calm.analytic.chart import ChartAnswer, ChartSolution

_PAGE = (8.27, 11.69)  # inches, A4
_RIGHT = np.pi / 2
_POINTS = 500  # grid points along the curve and up the page, to contour the loci
_FINE = 2000  # points along the curve, to draw and graduate it
_HIGHEST = 3.0


@dataclass(frozen=True)
class Family:
    """Family of curves of constant ratio: name of the ratio, colour, and values to draw."""

    name: str
    colour: str
    values: tuple[float, ...]


_FAMILIES = (
    Family("L/H", "#0b5fa5", (1.005, 1.01, 1.02, 1.05, 1.1, 1.15, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8,
                              2, 2.5, 3, 4, 6)),
    Family("D/H", "#1a7f37", (-8, -6, -4, -3, -2.5, -2, -1.8, -1.6, -1.4, -1.2, -1, -0.8, -0.6,
                              -0.4, -0.2, 0, 0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1, 1.25, 1.5, 2, 3, 4)),
    Family("T_A/(wH)", "#b3261e", (0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1, 1.25, 1.5, 2, 2.5, 3, 4, 6, 10,
                                   20, 30, 50, 100)),
)  # fmt: skip


def draw_chart(k: float, lower_end: str = "below-90") -> Figure:
    """Draw the chart for one value of K (0 to 100) on an A4 page.

    `lower_end` is ``below-90`` or ``above-90``, for angles [degrees] at the lower ends of the
    cables. Raise UsageError if K is out of range, or if K is 0 and angles are above 90°.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    points = _curve_points(k)
    above = lower_end == "above-90"
    if above and k == 0.0:
        raise UsageError("for K = 0 all angles are below 90°, so there is no chart above 90°")
    figure = empty_figure(*_PAGE)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.1, 0.1, 0.85, 0.8))
    _set_limits(axes, points, above)
    axes.plot(points.distance, points.height, color="black", linewidth=1.6, zorder=3)
    labels = Labels(axes)
    labels.avoid(points.distance, points.height)
    _graduate(axes, labels, points)
    starts = points.phi >= _RIGHT if above else points.phi <= _RIGHT
    for family in _FAMILIES:
        _draw_family(axes, labels, family, points, starts)
    _write_frame(figure, axes, k, above)
    return figure


def _curve_points(k: float) -> CurvePoints:
    """Compute points of the curve from its apex to the upper edge of the page.

    The spacing of the points decreases towards the critical angle φ_c.
    """
    critical = float(critical_angle(k))
    upright = float(curve(k, _RIGHT).height) if k > 0.0 else np.inf
    highest = min(_HIGHEST, 4.0 * upright)
    left = np.concatenate([np.linspace(1.0, 0.02, _FINE), np.geomspace(0.02, 1e-11, _FINE)[1:]])
    dense = curve(k, critical * (1.0 - left))
    shown = dense.height <= highest
    return CurvePoints(*(getattr(dense, name)[shown] for name in _COORDINATES))


_COORDINATES = ("phi", "arc", "distance", "height", "tension")


def _set_limits(axes: Axes, points: CurvePoints, above: bool) -> None:
    left = float(points.distance[points.phi >= _RIGHT].min()) if above else 0.0
    right = float(points.distance.max())
    low = float(points.height[points.phi >= _RIGHT].min()) if above else 0.0
    high = float(points.height.max())
    width, height = right - left, high - low
    # room for the graduations on both sides of the curve
    across = left - 0.02 * width, right + 0.12 * width
    axes.set(xlim=across, ylim=(low - 0.05 * height, high))


def _graduate(axes: Axes, labels: Labels, points: CurvePoints) -> None:
    """Draw the ticks of φ on the outer side of the curve, and the ticks of s′ on its inner side."""
    degrees = np.degrees(points.phi)
    for value in range(0, 180, 1):
        if value <= degrees[-1]:
            long = value % 5 == 0
            size = 7.0 if value % 10 == 0 else 5.0 if long else 3.0
            place = _point_at(points, degrees, value)
            labels.tick(*place, size, "black")
            if long:
                labels.beside(f"{value}°", *place, size + 2.0, "black", 8.5)
    size = float(points.arc[-1]) / 20.0
    decade = 10.0 ** np.floor(np.log10(size))
    step = float(next(each * decade for each in (1.0, 2.0, 5.0, 10.0) if each * decade >= size))
    for count in range(1, int(points.arc[-1] / (step / 5.0)) + 1):
        place = _point_at(points, points.arc, count * step / 5.0)
        size = -6.0 if count % 5 == 0 else -3.0
        labels.tick(*place, size, "#7a4b00")
        if count % 5 == 0:
            labels.beside(f"{count * step / 5.0:.4g}", *place, size - 2.0, "#7a4b00", 7.0)


def _point_at(points: CurvePoints, scale: Floats, value: float) -> tuple[float, float, float]:
    at = (float(np.interp(value, scale, getattr(points, name))) for name in _COORDINATES)
    phi, _, distance, height, _ = at
    return distance, height, phi


def _draw_family(
    axes: Axes, labels: Labels, family: Family, points: CurvePoints, starts: NDArray[np.bool_]
) -> None:
    """Draw a family of curves. Each curve connects the points P with the same ratio.

    The curves are contour lines of the ratio, as a function of y′ of A and z′ of B.
    """
    # Equal steps in φ are small steps in y′ where the curve turns back; contours need rising y′.
    angles = np.linspace(points.phi[starts][0], points.phi[starts][-1], _POINTS)
    lower = [np.interp(angles, points.phi, getattr(points, name)) for name in _COORDINATES]
    if lower[2][0] > lower[2][-1]:
        lower = [values[::-1] for values in lower]
    levels = np.linspace(*axes.get_ylim(), _POINTS)
    upper = [np.interp(levels, points.height, getattr(points, name)) for name in _COORDINATES]
    _, arc_a, distance_a, height_a, tension_a = lower
    _, arc_b, distance_b, height_b, _ = (values[:, None] for values in upper)
    height = height_b - height_a
    height = np.where(height > 1e-9, height, np.nan)
    ratio = {
        "L/H": (arc_b - arc_a) / height,
        "D/H": (distance_b - distance_a) / height,
        "T_A/(wH)": tension_a / height,
    }[family.name]
    reached = np.nanmin(ratio), np.nanmax(ratio)
    values = [value for value in family.values if reached[0] < value < reached[1]]
    if not values:
        return
    loci = axes.contour(distance_a, levels, ratio, levels=values)
    loci.remove()
    for value, segments in zip(values, loci.allsegs, strict=True):
        for segment in segments:
            # A line without a label would be confusing, so it is not drawn.
            if labels.along(f"{value:g}".replace("-", "−"), segment, family.colour, 7.0):
                axes.plot(*segment.T, color=family.colour, linewidth=0.6)


def _write_frame(figure: Figure, axes: Axes, k: float, above: bool) -> None:
    side = "above" if above else "below"
    axes.set(xlabel="y′ = y/H₀, downstream", ylabel="z′ = z/H₀, up;  T = wH₀ (1 + z′)")
    axes.grid(color="#dddddd", linewidth=0.4)
    axes.set_axisbelow(True)
    figure.text(0.1, 0.965, f"Cable in a uniform current, K = {k:g}", fontsize=14, weight="bold")
    figure.text(0.1, 0.945, f"Lower end A at an angle {side} 90° to the current", fontsize=10)
    for x, family in zip((0.1, 0.27, 0.44), _FAMILIES, strict=True):
        figure.text(x, 0.918, family.name.replace("T_A", "$T_A$"), color=family.colour, fontsize=11)
    figure.text(0.61, 0.918, "on the curve: φ in degrees, ", fontsize=9)
    figure.text(0.83, 0.918, "arc s′", fontsize=9, color="#7a4b00")
    figure.text(0.1, 0.03, _LOCI, fontsize=8)


_LOCI = (
    "The loci are for the point P. P has the y′ of the lower end A and the z′ of the upper end B."
    "\nA and B lie on the curve. H is their difference in height, D their distance, and L the "
    "length of cable between them."
)
_MARGIN = 1.5  # free margin around a label [pt]
_SHORTEST = 40.0  # length of the shortest locus with a label [pt]
_TRIALS = 41


class Labels:
    """Ticks and labels that do not overlap.

    A label without a free position is omitted. The axes must have their final limits, and the
    figure must have a canvas.
    """

    def __init__(self, axes: Axes) -> None:
        self.axes = axes
        self.boxes: list[Bbox] = []
        self._points = axes.figure.dpi / 72.0

    def avoid(self, x: Floats, y: Floats) -> None:
        """Keep later labels clear of a curve."""
        from matplotlib.transforms import Bbox

        line = self.axes.transData.transform(np.column_stack([x, y]))
        lengths = _arc_lengths(line)
        half = self._points  # one typographic point, in pixels
        for at in np.arange(0.0, lengths[-1], half):
            place = [np.interp(at, lengths, line[:, axis]) for axis in (0, 1)]
            self.boxes.append(Bbox([np.subtract(place, half), np.add(place, half)]))

    def tick(self, x: float, y: float, angle: float, size: float, colour: str) -> None:
        """Draw a tick at a point of a curve.

        `angle` is the direction of the curve at this point [rad]. Seen in this direction, the tick
        is on the right of the curve. If `size` [pt] is negative, the tick is on the left.
        """
        place, right = self._pixel_and_normal(x, y, angle)
        ends = np.array([place, place + right * size * self._points])
        across = self.axes.transData.inverted().transform(ends)
        self.axes.plot(*across.T, color=colour, linewidth=0.7, zorder=3)

    def beside(
        self, text: str, x: float, y: float, angle: float, size: float, colour: str, font: float
    ) -> None:
        """Write a label beyond the end of a tick.

        The arguments that describe the tick are as in `tick`.
        """
        place, right = self._pixel_and_normal(x, y, angle)
        side = right * np.sign(size)
        label = self._text(text, place, 0.0, colour, font)
        extent = label.get_window_extent()
        reach = 0.5 * (abs(side[0]) * extent.width + abs(side[1]) * extent.height)
        self._move(label, place + side * (abs(size) * self._points + reach))
        self._keep_if_free(label)

    def along(self, text: str, path: Floats, colour: str, font: float) -> bool:
        """Write a text along a line of points (n, 2); return whether the text was written.

        The text is omitted if no position along the line is free.
        """
        line = self.axes.transData.transform(path)
        lengths = _arc_lengths(line)
        if lengths[-1] < _SHORTEST * self._points:
            return False
        # Try positions from the middle outwards.
        offsets = np.linspace(0.0, 0.46, _TRIALS // 2 + 1)
        shares = np.unique(np.concatenate([0.5 - offsets, 0.5 + offsets]))
        for share in sorted(shares, key=lambda share: abs(share - 0.5)):
            at = share * lengths[-1]
            reach = 8.0 * self._points
            before, place, after = (
                np.array([np.interp(spot, lengths, line[:, axis]) for axis in (0, 1)])
                for spot in (at - reach, at, at + reach)
            )
            slope = after - before
            turned = (np.degrees(np.arctan2(slope[1], slope[0])) + 90.0) % 180.0 - 90.0
            label = self._text(text, place, turned, colour, font)
            if self._keep_if_free(label):
                return True
        return False

    def _pixel_and_normal(self, x: float, y: float, angle: float) -> tuple[Floats, Floats]:
        """Return a point in pixels, and the unit vector to the right of a curve at this point."""
        step = 1e-6
        here = np.array([x, y])
        ahead = here + step * np.array([np.cos(angle), np.sin(angle)])
        place, onward = self.axes.transData.transform(np.array([here, ahead]))
        direction = (onward - place) / np.hypot(*(onward - place))
        return place, np.array([direction[1], -direction[0]])

    def _text(self, text: str, place: Floats, turned: float, colour: str, font: float) -> Text:
        label = self.axes.text(
            0.0, 0.0, text, color=colour, fontsize=font, rotation=turned, zorder=4,
            horizontalalignment="center", verticalalignment="center",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.4},
        )  # fmt: skip
        self._move(label, place)
        return label

    def _move(self, label: Text, place: Floats) -> None:
        label.set_position(tuple(self.axes.transData.inverted().transform(place)))

    def _keep_if_free(self, label: Text) -> bool:
        box = label.get_window_extent().padded(_MARGIN * self._points)
        frame = self.axes.get_window_extent()
        inside = (
            frame.x0 <= box.x0 and box.x1 <= frame.x1 and frame.y0 <= box.y0 and box.y1 <= frame.y1
        )
        if inside and not any(box.overlaps(other) for other in self.boxes):
            self.boxes.append(box)
            return True
        label.remove()
        return False


def _arc_lengths(line: Floats) -> Floats:
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])


_ROWS = (
    ("phi_a", "angle at A", "°", 3),
    ("phi_b", "angle at B", "°", 3),
    ("tension_a", "tension at A", "N", 2),
    ("tension_b", "tension at B", "N", 2),
    ("height", "height H", "m", 3),
    ("distance", "distance D", "m", 3),
    ("length", "length L", "m", 3),
    ("h0", "H₀ of the chart", "m", 3),
)
_NOTE = (
    "A is the lower end, B the upper end. D is positive if B is downstream of A. Angles are "
    "measured from the current."
)


def answer_document(answer: ChartAnswer) -> dict[str, Any]:
    """Return the JSON object: `status`, `k`, and `solutions` (SI, degrees) or a reason."""
    found = {"solutions": [_figures(solution) for solution in answer.solutions]}
    reason = () if answer.solutions else ("message", "advice")
    return members(answer, "status", "k") | found | members(answer, *reason)


def answer_part(answer: ChartAnswer) -> ReportPart:
    """Build a table of the solutions, with one column per cable."""
    figures = [_figures(solution) for solution in answer.solutions]
    several = len(figures) > 1

    def cable(at: int) -> Field:
        def text(row: tuple[str, str, str, int]) -> str:
            name, _, _, decimals = row
            return f"{figures[at][name]:z.{decimals}f}"

        return number(str(at + 1) if several else "", text)

    table = table_of("", _ROWS, words("", 1), words("", 2, 0.0), *map(cable, range(len(figures))))
    notes = [_NOTE]
    if several:
        notes.append("Each of these cables fits the input.")
    if any(min(each["phi_a"], each["phi_b"]) < 0.0 for each in figures):
        notes.append(
            "A negative angle at an end means that the cable dips below this end; a buoyant cable "
            "rises above it."
        )
    return ReportPart(f"Uniform current, K = {answer.k:.6g}", (table, Note(tuple(notes))))


def _figures(solution: ChartSolution) -> dict[str, float]:
    return {
        name: math.degrees(value) if name.startswith("phi") else value
        for name, value in vars(solution).items()
    }
