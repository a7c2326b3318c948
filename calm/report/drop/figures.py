"""The picture of an anchor drop: shapes of the line on its way, and the speed of the anchor."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from calm.report.vector import figure_svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from calm.drop import DropPlan

_WIDTH, _HEIGHT = 7.4, 4.2  # inches: an A4 page between its margins
_FONT_SIZE = 7.5  # points
_WATER, _SEABED = "#2b7bba", "#b8a07e"
_DASHES = ("-", (0, (6, 2)), (0, (4, 2, 1, 2)), (0, (1, 1.5)), (0, (2, 1)), "-")


def drop_figure(plan: DropPlan) -> str:
    """The figure as SVG.

    Left, to one scale, the path of the anchor and the line at moments, each with its own dashes and
    named where it ends: it reads in black and white too. Right the fall speed over depth.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_WIDTH, _HEIGHT))
    figure.subplots_adjust(0.08, 0.11, 0.985, 0.97, wspace=0.06)
    shapes, speed = figure.subplots(1, 2, sharey=True, width_ratios=(3.2, 1.0))
    _draw_shapes(shapes, plan)
    _draw_speed(speed, plan)
    for axes in (shapes, speed):
        axes.tick_params(labelsize=_FONT_SIZE)
        axes.grid(alpha=0.3, linewidth=0.5)
    return figure_svg(figure)


def _draw_shapes(axes: Axes, plan: DropPlan) -> None:
    depth = plan.mooring.water.depth
    axes.axhline(0.0, color=_WATER, linewidth=1.0)
    axes.axhspan(depth, 1.06 * depth, color=_SEABED)
    shades = np.linspace(0.65, 0.0, len(plan.moments))
    for moment, dashes, shade in zip(plan.moments, _DASHES, shades, strict=False):
        axes.plot(
            moment.x, moment.depth, color=str(shade), linestyle=dashes, linewidth=1.1,
            label=moment.name,
        )  # fmt: skip
        axes.plot(moment.x[0], moment.depth[0], "o", color=str(shade), markersize=3.5)
    axes.plot(plan.path.anchor_x, plan.path.anchor_depth, color="#d55e00", linewidth=1.4,
              label="path of the anchor")  # fmt: skip
    axes.plot(plan.fall_back, depth, "v", color="#d55e00", markersize=6, clip_on=False)
    axes.set_xlabel("distance from where the anchor is let go, towards the float [m]",
                    fontsize=_FONT_SIZE)  # fmt: skip
    axes.set_ylabel("depth [m]", fontsize=_FONT_SIZE)
    axes.set_ylim(1.06 * depth, -0.04 * depth)
    axes.set_aspect("equal", adjustable="datalim")
    axes.legend(fontsize=_FONT_SIZE, loc="lower right", framealpha=0.9)


def _draw_speed(axes: Axes, plan: DropPlan) -> None:
    path = plan.path
    axes.plot(path.anchor_speed[1:], path.anchor_depth[1:], color="#111111", linewidth=1.2)
    axes.set_xlim(0.0, 1.1 * float(np.max(path.anchor_speed[path.time > 0.02 * path.time[-1]])))
    axes.set_xlabel("fall speed [m/s]", fontsize=_FONT_SIZE)
    for share in (0.25, 0.5, 0.75):
        time = share * path.time[-1]
        at = float(np.interp(time, path.time, path.anchor_depth))
        value = float(np.interp(time, path.time, path.anchor_speed))
        axes.plot(value, at, "o", color="#111111", markersize=3)
        axes.annotate(f"{time:.0f} s", (value, at), textcoords="offset points", xytext=(-4, 4),
                      ha="right", fontsize=_FONT_SIZE)  # fmt: skip
