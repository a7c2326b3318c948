"""A tow at several speeds drawn: depth, layback and tension against speed."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from calm.quantities import QUANTITIES
from calm.report.drawing import LINE_STYLE, WATER_COLOUR, WIDTH
from calm.units import KNOT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from calm.report.tabulation import Tabulation

_HEIGHT = 4.5  # inches
_MOST_MARKED = 60  # points that can still be told apart


def draw_sweep(tabulation: Tabulation) -> Figure:
    """A figure of three panels against the speed, which belongs to no window.

    Depth of the body, its layback, and the tension at the tow point and at the body. A speed
    without equilibrium is a gap.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH, _HEIGHT), layout="constrained")
    depth, layback, tension = figure.subplots(1, 3)
    figure.suptitle(tabulation.name, parse_math=False)
    _draw(depth, tabulation, "depth")
    depth.axhline(0.0, color=WATER_COLOUR, linewidth=1)
    depth.invert_yaxis()
    _draw(layback, tabulation, "layback")
    _draw(tension, tabulation, "tension", label="at the tow point")
    _draw(tension, tabulation, "body_tension", "--", label="at the body")
    tension.set_ylabel(QUANTITIES["tension"].label)
    tension.set_ylim(bottom=0.0)
    tension.legend(frameon=False)
    return figure


def _draw(
    axes: Axes, tabulation: Tabulation, name: str, dashes: str = "-", label: str = ""
) -> None:
    from matplotlib.ticker import MaxNLocator

    speeds = [float(row.chosen["speed"]) for row in tabulation.rows]
    figures = [row.figures[name] for row in tabulation.rows]
    values = [float("nan") if value is None else value for value in figures]
    marker = "." if dashes == "-" and len(speeds) <= _MOST_MARKED else ""
    axes.plot(speeds, values, linestyle=dashes, marker=marker, label=label, **LINE_STYLE)
    margin = 0.04 * (speeds[-1] - speeds[0]) or speeds[0]
    axes.set_xlim(speeds[0] - margin, speeds[-1] + margin)
    axes.set_xlabel(QUANTITIES["speed"].label)
    axes.set_ylabel(QUANTITIES[name].label)
    axes.grid(alpha=0.3)
    if not axes.child_axes:
        to_knots, from_knots = partial(np.multiply, 1.0 / KNOT), partial(np.multiply, KNOT)
        knots = axes.secondary_xaxis("top", functions=(to_knots, from_knots))
        knots.set_xlabel("speed [knot]")
        knots.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
