"""A line drawn as it stands in one profile of a batch."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from calm.errors import UsageError
from calm.quantities import QUANTITIES
from calm.report.batch.labels import when
from calm.report.drawing import LINE_STYLE, WATER_COLOUR, WIDTH, along, set_span

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray
    from xarray import Dataset

    Floats = NDArray[np.float64]

_HEIGHT = 6.5  # inches
_CLAMP = {"linestyle": "none", "marker": "s", "color": "#cc3311", "markersize": 4.0}


def draw_shape(dataset: Dataset, time: str | np.datetime64) -> Figure:
    """Elevation and plan of the line in the profile nearest to a time.

    The line is drawn through the nodes of a result that has them (`--shape`), else straight from
    the upper end of one component to that of the next. The elevation is in the vertical plane of
    the anchor and the top.

    Raises
    ------
    UsageError
        The profile has no equilibrium.
    """
    from matplotlib.figure import Figure

    row = dataset.sel(time=np.datetime64(time), method="nearest")
    names = ("shape_depth", "shape_x", "shape_y")
    if "shape_depth" not in row:
        names = ("depth_top", "x_top", "y_top")
    depth, x, y = (np.asarray(row[name].values, np.float64) for name in names)
    moment = when(row["time"].values)
    if np.isnan(depth).any():
        raise UsageError(f"the profile of {moment} has no equilibrium to draw")
    figure = Figure(figsize=(WIDTH, _HEIGHT), layout="constrained")
    elevation, plan = figure.subplots(1, 2)
    figure.suptitle(f"{dataset.attrs.get('title', '')}\n{moment}".strip(), parse_math=False)
    plane = _plane(x[0], y[0])
    elevation.axhline(0.0, color=WATER_COLOUR, linewidth=1)
    reached = along(x, y, plane)
    elevation.plot(reached, depth, **LINE_STYLE)
    plan.plot(x, y, **LINE_STYLE)
    if "clamp_depth" in row:
        at, east, north = (row[name].values for name in ("clamp_depth", "clamp_x", "clamp_y"))
        elevation.plot(along(east, north, plane), at, **_CLAMP)
        plan.plot(east, north, **_CLAMP)
    set_span(elevation, min(0.0, reached.min()), max(0.0, reached.max()), float(np.ptp(depth)))
    elevation.invert_yaxis()
    elevation.set_xlabel(QUANTITIES["offset"].label)
    elevation.set_ylabel(QUANTITIES["depth"].label)
    plan.set_aspect("equal", adjustable="datalim")
    plan.set_xlabel(QUANTITIES["x"].label)
    plan.set_ylabel(QUANTITIES["y"].label)
    return figure


def _plane(x: float, y: float) -> Floats:
    """(2,) direction from the anchor to the top; east where it stands upright."""
    distance = float(np.hypot(x, y))
    return np.array([x, y]) / distance if distance > 0.0 else np.array([1.0, 0.0])
