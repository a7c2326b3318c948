"""Graphs of the depths of a mooring over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.drawing.picture import figure_svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from calm.motion.study import SensorSeries

_WIDTH = 7.4  # inches: an A4 page between its margins
_FONT_SIZE = 7.0  # points
_MEASURED: dict[str, Any] = {"color": "#111111", "linewidth": 0.8}
_ESTIMATED: dict[str, Any] = {"color": "#0b3c5d", "linewidth": 0.9}
_ALONE: dict[str, Any] = {"color": "#d55e00", "linewidth": 0.7, "linestyle": "--"}


def overview_figure(series: Sequence[SensorSeries]) -> str:
    """Depths of all instruments over time, with their bands: where and when the line went down."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_WIDTH, 3.6))
    figure.subplots_adjust(0.1, 0.09, 0.99, 0.98)
    axes = figure.subplots()
    for one in series:
        time, style = one.time.astype("datetime64[s]"), "--" if one.hidden else "-"
        low, high = one.estimated - 1.96 * one.spread, one.estimated + 1.96 * one.spread
        axes.fill_between(time, low, high, color="#9ecae1", linewidth=0.0)
        axes.plot(time, one.estimated, color=_ESTIMATED["color"], linewidth=0.6, linestyle=style)
    axes.invert_yaxis()
    axes.set_ylabel("depth [m]", fontsize=_FONT_SIZE)
    axes.tick_params(labelsize=_FONT_SIZE)
    axes.grid(alpha=0.3)
    return figure_svg(figure)


def depth_figure(series: Sequence[SensorSeries]) -> str:
    """Depths of each sensor over time: measured, estimated with its band, by the currents alone."""
    figure, panels = _panels(series)
    for axes, one in zip(panels, series, strict=True):
        time = one.time.astype("datetime64[s]")
        low, high = one.estimated - 1.96 * one.spread, one.estimated + 1.96 * one.spread
        axes.fill_between(time, low, high, color="#9ecae1", linewidth=0.0)
        if one.plain is not None:
            axes.plot(time, one.plain, **_ALONE)
        axes.plot(time, one.estimated, **_ESTIMATED)
        axes.plot(time, one.measured, **_MEASURED)
        axes.invert_yaxis()
        _name(axes, one, "depth [m]")
    return figure_svg(figure)


def false_figure(time: Any, false: Mapping[str, Any]) -> str:
    """A row of marks for each level whose current looks false at some of the times (n,)."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_WIDTH, 0.2 * len(false) + 0.5))
    figure.subplots_adjust(0.2, 0.3 / (0.2 * len(false) + 0.5), 0.99, 0.97)
    axes = figure.subplots()
    for row, when in enumerate(false.values()):
        axes.plot(when.astype("datetime64[s]"), np.full(len(when), row), "|", color="#d55e00")
    axes.set_yticks(range(len(false)), list(false), parse_math=False)
    axes.set(xlim=tuple(time[[0, -1]].astype("datetime64[s]")), ylim=(len(false) - 0.5, -0.5))
    axes.tick_params(labelsize=_FONT_SIZE)
    return figure_svg(figure)


def _panels(series: Sequence[SensorSeries]) -> tuple[Any, Any]:
    from matplotlib.figure import Figure

    count = len(series)
    figure = Figure(figsize=(_WIDTH, 1.25 * count + 0.4))
    figure.subplots_adjust(0.1, 0.25 / (1.25 * count + 0.4), 0.99, 0.98, hspace=0.25)
    return figure, figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]


def _name(axes: Axes, one: SensorSeries, quantity: str) -> None:
    title = f"{one.label}{', hidden' if one.hidden else ''}"
    axes.set_title(title, fontsize=_FONT_SIZE, loc="left", pad=2, parse_math=False)
    axes.set_ylabel(quantity, fontsize=_FONT_SIZE)
    axes.tick_params(labelsize=_FONT_SIZE)
    axes.grid(alpha=0.3)
