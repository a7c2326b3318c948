"""The drawings of a batch: responses in time, exceedances, the line in one profile."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import floor, log10
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from calm.batch.statistics.summary import (
    RESPONSES,
    Distribution,
    PartDistributions,
    Response,
    Summary,
)
from calm.drawing import graph
from calm.drawing.graph import Graph, LegendEntry, Scale, Stroke, covering, decades, seconds
from calm.drawing.line_picture import LineKind, LinePicture, PictureMark, Polyline, along
from calm.drawing.plot import LINE_STYLE, WIDTH, draw_elevation, draw_plan
from calm.errors import UsageError
from calm.quantities import QUANTITIES
from calm.report.batch_summary import QUANTITY, TITLES, when

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from xarray import Dataset


_WIDTH = 533.0  # points: an A4 page between its margins
_SIZE = 7.0  # points, of the letters
_LEFT, _RIGHT, _BELOW, _GAP = 60.0, 6.0, 30.0, 14.0  # points: room around axes, and between them
_MOST_NAMED = 7
_LINE = str(LINE_STYLE["color"])
_LIMIT = Stroke("#b3261e", 1.0, (4.0, 2.0))
_COLOURS = ("#0b3c5d", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#a6761d", "#332288")


def series_figure(summary: Summary) -> str:
    """Least and greatest value of every response in each interval of time, as SVG."""
    tall = 108.0
    page = Graph(_WIDTH, len(RESPONSES) * (tall + _GAP) + 20.0, "responses through time", _SIZE)
    begin = summary.responses[0].begin
    across = covering(seconds(begin))
    ticks = graph.moments(begin[0], begin[-1], 7)
    for number, response in enumerate(summary.responses):
        quantity, limit = QUANTITIES[QUANTITY[response.name]], _limit_of(summary, response)
        low, high = (quantity.scale * edge for edge in (response.low, response.high))
        up = covering(low, high, [limit or np.nan])
        top = 6.0 + number * (tall + _GAP)
        axes = page.axes(_LEFT, top, _WIDTH - _LEFT - _RIGHT, tall, across, up)
        if np.array_equal(low, high, equal_nan=True):
            axes.line(seconds(begin), high, Stroke(_LINE, 0.8))
        else:
            axes.band(seconds(begin), low, high, _LINE)
        if limit is not None:
            axes.level(limit, _LIMIT)
        axes.frame(
            ticks, 5,
            beside=f"{TITLES[response.name]}\n[{quantity.display_unit}]",
            grid=True, numbered=(number == len(RESPONSES) - 1, True),
        )  # fmt: skip
    return page.svg()


class _Curve(NamedTuple):
    """An exceedance curve, and how it is drawn."""

    distribution: Distribution
    stroke: Stroke
    label: str = ""


class _Shares(NamedTuple):
    """A panel: what its curves show, of which quantity, and the limit on it."""

    title: str
    name: str
    curves: Sequence[_Curve]
    limit: float | None = None


def exceedance_figure(summary: Summary) -> str:
    """Share of the profiles beyond each value: of the responses, as SVG."""
    panels = []
    for response in summary.responses:
        one, line = response.distribution, Stroke(_LINE, float(LINE_STYLE["linewidth"]))
        curves = [] if one is None else [_Curve(one, line)]
        limit = _limit_of(summary, response)
        panels.append(_Shares(TITLES[response.name], QUANTITY[response.name], curves, limit))
    return _shares("how often values are exceeded", panels, 150.0)


def parts_figure(parts: list[PartDistributions]) -> str:
    """Return the same of the knockdown and the tilt of some parts, those that move most, as SVG."""
    panels = []
    for name in ("knockdown", "tilt"):
        known = [(part.label, getattr(part, name)) for part in parts]
        curves = [(label, one) for label, one in known if one is not None]
        curves.sort(key=lambda curve: -curve[1].maximum)
        drawn = [
            _Curve(one, Stroke(colour), label)
            for (label, one), colour in zip(curves[:_MOST_NAMED], _COLOURS, strict=False)
        ]
        panels.append(_Shares(name, name, drawn))
    return _shares("how often parts exceed values", panels, 200.0)


def _shares(title: str, panels: Sequence[_Shares], tall: float) -> str:
    """Panels two by two, with one scale of shares."""
    rows, wide = -(-len(panels) // 2), (_WIDTH - _LEFT - _RIGHT - _GAP) / 2
    page = Graph(_WIDTH, rows * (tall + _BELOW) + 6.0, title, _SIZE)
    least = min([0.1, *(each.distribution.share[-1] for one in panels for each in one.curves)])
    up = Scale(100.0 * 10.0 ** floor(log10(least) + 1e-9), 100.0, logarithmic=True)
    for number, panel in enumerate(panels):
        row, column = divmod(number, 2)
        quantity = QUANTITIES[panel.name]
        values = [each.distribution.value * quantity.scale for each in panel.curves]
        across = covering(*values, [np.nan if panel.limit is None else panel.limit])
        left, top = _LEFT + column * (wide + _GAP), 6.0 + row * (tall + _BELOW)
        axes = page.axes(left, top, wide, tall, across, up)
        for value, each in zip(values, panel.curves, strict=True):
            axes.line(value, 100.0 * each.distribution.share, each.stroke)
        if panel.limit is not None:
            axes.plumb(panel.limit, _LIMIT)
        axes.frame(
            6, decades(up.low, up.high),
            below=f"{panel.title} [{quantity.display_unit}]",
            beside="" if column else "reached or exceeded in [% of profiles]",
            grid=True, numbered=(True, not column),
        )  # fmt: skip
        named = [LegendEntry(each.label, line=each.stroke) for each in panel.curves if each.label]
        page.legend(named, (left + 0.6 * wide, top + 4.0), 0.4 * wide, 10.0)
    return page.svg()


def _limit_of(summary: Summary, response: Response) -> float | None:
    """The limit of the design on a response, as it is shown; None where it gives none."""
    wanted = {"knockdown": "knockdown", "offset": "excursion"}.get(response.name)
    for rule in summary.rules:
        if rule.name == wanted:
            limit = rule.exceedances[0].limit.criterion.limit
            return (limit or 0.0) * QUANTITIES[QUANTITY[response.name]].scale
    return None


_HEIGHT = 6.5  # inches


def draw_shape(dataset: Dataset, time: str | np.datetime64) -> Figure:
    """Elevation and plan of the line in the profile nearest to a time.

    The line is drawn through the nodes of a result that has them (`--shape`), else straight from
    the upper end of one component to that of the next. The elevation is in the vertical plane of
    the anchor and the top. UsageError: the profile has no equilibrium.
    """
    from matplotlib.figure import Figure

    row = dataset.sel(time=np.datetime64(time), method="nearest")
    prefix, end = ("shape_", "") if "shape_depth" in row else ("", "_top")
    names = (f"{prefix}{name}{end}" for name in ("depth", "x", "y"))
    depth, x, y = (np.asarray(row[name].values, np.float64) for name in names)
    moment = when(row["time"].values)
    if np.isnan(depth).any():
        raise UsageError(f"the profile of {moment} has no equilibrium to draw")
    distance = float(np.hypot(x[0], y[0]))
    plane = np.array([x[0], y[0]]) / distance if distance > 0.0 else np.array([1.0, 0.0])
    height = float(np.ptp(depth))
    marks: tuple[PictureMark, ...] = ()
    if "clamp_depth" in row:
        clamps = zip(*(row[f"clamp_{name}"].values for name in ("x", "y", "depth")), strict=True)
        marks = tuple(PictureMark("", "", "instrument", *map(float, each)) for each in clamps)
    above = LinePicture(
        (Polyline(LineKind.LINE, x, y),), marks, QUANTITIES["x"].label, QUANTITIES["y"].label
    )
    margin = 0.05 * height
    side = LinePicture(
        (Polyline(LineKind.LINE, along(x, y, plane), depth),),
        tuple(replace(one, x=float(along(one.x, one.y, plane)), y=one.depth) for one in marks),
        across=QUANTITIES["offset"].label,
        up=QUANTITIES["depth"].label,
        top=min(0.0, float(depth.min())) - margin,
        bottom=float(depth.max()) + margin,
        height=height,
        surface=True,
    )
    figure = Figure(figsize=(WIDTH, _HEIGHT), layout="constrained")
    elevation, plan = figure.subplots(1, 2)
    figure.suptitle(f"{dataset.attrs.get('title', '')}\n{moment}".strip(), parse_math=False)
    draw_elevation(elevation, side)
    draw_plan(plan, above)
    return figure
