"""Pictures of the manual in which the point is seen.

Horizontal distances of the pictures in space are drawn larger than depths, which their axes say.
"""

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.axes3d import Axes3D
from numpy.typing import NDArray

import calm
from calm.drawing.graph import Graph, Scale, Stroke
from calm.drawing.line_drawing import SIGNS
from calm.drawing.line_picture import along, levels_of, named_parts
from calm.shipped import shipped_folder

Floats = NDArray[np.float64]

LINE, STILL, WATER, SEABED = "#0b3c5d", "#8a8f94", "#3399cc", "#d9c7a3"
_MARKERS = {
    "float": ("o", "#e69f00", 70),
    "instrument": ("s", "#cc3311", 34),
    "release": ("D", "#009e73", 40),
    "anchor": ("v", "black", 60),
}
_NAMED = ("top float", "meter 150 m", "CTD 250 m", "meter 350 m", "meter 700 m", "release")
_YEAR_OF = "upward-adcp-300m"


def hero() -> Figure:
    """A mooring in space in a current that turns with depth, with its instruments."""
    result = _moored("veering-current").solve()
    shape, water = result.shape, result.design.water
    figure = Figure(figsize=(8.0, 8.5))
    axes = figure.add_axes((-0.08, -0.02, 1.12, 1.06), projection="3d", computed_zorder=False)
    assert isinstance(axes, Axes3D)
    bed = water.depth
    for depth, colour in ((0.0, WATER), (bed, SEABED)):
        corners = np.meshgrid([-45.0, 45.0], [-65.0, 25.0])
        level = np.full((2, 2), depth)
        axes.plot_surface(*corners, level, color=colour, alpha=0.25 if depth else 0.12)
    axes.plot(shape.x, shape.y, np.full_like(shape.x, bed), color="#a58a55", linewidth=2.2)
    _current(axes, water.level, water.u, water.v)
    axes.plot(shape.x, shape.y, shape.depth, color=LINE, linewidth=2.2)
    for role, (marker, colour, size) in _MARKERS.items():
        parts = [part for part in named_parts(result) if part.role == role]
        place = [[part.x for part in parts], [part.y for part in parts]]
        depth = [part.depth for part in parts]
        axes.scatter(
            *place, depth, marker=marker, color=colour, s=size, label=role, depthshade=False
        )
    for part in named_parts(result):
        if part.text in _NAMED:
            axes.text(part.x + 4, part.y, part.depth, part.text, fontsize=9, parse_math=False)
    axes.set(xlim=(-45, 45), ylim=(-65, 25), zlim=(bed, 0))
    axes.set(xlabel="east [m]", ylabel="north [m]", zlabel="depth [m]")
    axes.set_box_aspect((1, 1, 1.45), zoom=0.93)
    axes.view_init(elev=16, azim=-60)
    axes.legend(loc="upper left", bbox_to_anchor=(0.1, 0.8), frameon=False)
    return figure


def _current(axes: Axes3D, level: Floats, u: Floats, v: Floats) -> None:
    """Arrows of the current at several depths, on a mast next to the line."""
    depth = np.linspace(0.0, 860.0, 15)
    east, north = (np.interp(depth, level, speed) for speed in (u, v))
    mast = np.full_like(depth, 22.0), np.full_like(depth, 10.0)
    axes.plot(*mast, depth, color=WATER, linewidth=0.8)
    scale = 38.0
    axes.quiver(
        *mast, depth, scale * east, scale * north, np.zeros_like(depth),
        color=WATER, linewidth=1.6, arrow_length_ratio=0.35,
    )  # fmt: skip
    axes.text(mast[0][0] - 14, mast[1][0], -25.0, "current", color=WATER, fontsize=10)


def thumbnail(result: calm.Result) -> str:
    """A line without words, in the plane of its excursion; its width fills the picture."""
    shape, environment = result.shape, result.file.environment
    far = int(np.argmax(np.hypot(shape.x, shape.y)))
    bearing = np.arctan2(shape.y[far], shape.x[far])
    plane = np.array([np.cos(bearing), np.sin(bearing)])
    if result.towed:
        top, bottom = levels_of(result)
    else:
        top, bottom = -0.08 * environment.depth, 1.08 * environment.depth
    offset = along(shape.x, shape.y, plane)
    reach = max(float(np.ptp(offset)), 0.1 * (bottom - top))
    middle = (float(offset.min()) + float(offset.max())) / 2
    across = Scale(middle - 0.7 * reach, middle + 0.7 * reach)
    page = Graph(122.0, 122.0, result.name, 8.0)
    axes = page.axes(0.0, 0.0, 122.0, 122.0, across, Scale(bottom, top))
    if environment.fluid == "water":
        axes.strip(0.0, bottom, "#e0f0f8")
    if environment.depth is not None:
        axes.strip(environment.depth, max(bottom, environment.depth), SEABED)
    axes.line(offset, shape.depth, Stroke(LINE, 1.5))
    for part in named_parts(result):
        axes.mark(float(along(part.x, part.y, plane)), part.depth, *SIGNS[part.role])
    return page.svg()


def veering_plan() -> Figure:
    """The line and the current, both seen from above."""
    result = _moored("veering-current").solve()
    shape, water = result.shape, result.design.water
    figure = Figure(figsize=(10, 5), layout="constrained")
    plan, hodograph = figure.subplots(1, 2)
    _coloured(plan, shape.x, shape.y, shape.depth, water.depth)
    for part in named_parts(result):
        marker, colour, size = _MARKERS[part.role]
        plan.scatter(part.x, part.y, marker=marker, color=colour, s=0.6 * size, zorder=3)
    for depth in (100, 250, 450, 700, 890):
        nearest = int(np.argmin(np.abs(shape.depth - depth)))
        place = (shape.x[nearest], shape.y[nearest])
        plan.annotate(f"{depth} m", place, (8, 0), textcoords="offset points", va="center")
    plan.set(xlabel="east [m]", ylabel="north [m]", title="the line from above")
    plan.set_aspect("equal", adjustable="datalim")
    depth = np.linspace(0.0, water.depth, 300)
    u, v = np.interp(depth, water.level, water.u), np.interp(depth, water.level, water.v)
    drawn = _coloured(hodograph, u, v, depth, water.depth)
    for level in (0, 120, 250, 450, 700, 900):
        place = (float(np.interp(level, depth, u)), float(np.interp(level, depth, v)))
        hodograph.annotate(f"{level} m", place, (8, 0), textcoords="offset points", va="center")
    hodograph.axhline(0.0, color=STILL, linewidth=0.5)
    hodograph.axvline(0.0, color=STILL, linewidth=0.5)
    hodograph.set(xlabel="to the east [m/s]", ylabel="to the north [m/s]", title="the current")
    hodograph.set_aspect("equal", adjustable="datalim")
    bar = figure.colorbar(drawn, ax=[plan, hodograph], label="depth [m]", pad=0.01)
    bar.ax.invert_yaxis()
    return figure


def _coloured(axes: Axes, x: Floats, y: Floats, depth: Floats, bed: float):
    """A curve in the colours of its depths."""
    from matplotlib.collections import LineCollection

    points = np.column_stack([x, y])
    segments = np.stack([points[:-1], points[1:]], axis=1)
    curve = LineCollection(segments, cmap="viridis_r", linewidth=2.5)
    curve.set_array((depth[:-1] + depth[1:]) / 2)
    curve.set_clim(0.0, bed)
    axes.add_collection(curve)
    axes.autoscale_view()
    return curve


def year() -> Figure:
    """Depth of the top of a mooring in every hour of a year, and its distribution."""
    mooring = _moored(_YEAR_OF)
    time, depth, u, v = made_year(mooring.water.depth)
    solved = calm.solve_profiles(mooring, u, v, depth)
    standing = mooring.solve()
    still = standing.top.depth - (standing.top.knockdown or 0.0)
    top = solved.top_depth
    figure = Figure(figsize=(10, 5), layout="constrained")
    (speed, _), (course, often) = figure.subplots(
        2, 2, width_ratios=(5, 1), height_ratios=(1, 2), sharex="col"
    )
    figure.delaxes(_)
    days = time / 24.0
    speed.plot(days, np.hypot(u[:, 0], v[:, 0]), color=WATER, linewidth=0.4)
    speed.set_ylabel("current at the\nsurface [m/s]")
    course.plot(days, top, color=LINE, linewidth=0.4)
    course.axhline(still, color=STILL, linestyle="--", linewidth=1)
    course.annotate("in still water", (days[0], still), (4, -14), textcoords="offset points")
    worst = int(np.nanargmax(top))
    course.annotate(
        f"deepest: {top[worst]:.0f} m, day {days[worst]:.0f}",
        (days[worst], top[worst]), (-10, 12), textcoords="offset points", ha="right",
        arrowprops={"arrowstyle": "-", "color": STILL},
    )  # fmt: skip
    course.set(xlabel="day of the year", ylabel="depth of the ADCP float [m]")
    course.invert_yaxis()
    often.hist(top, bins=60, orientation="horizontal", color=LINE)
    often.set(ylim=course.get_ylim(), xlabel="hours", xscale="log")
    often.tick_params(labelleft=False)
    return figure


def made_year(bed: float) -> tuple[Floats, Floats, Floats, Floats]:
    """A synthetic year of hourly currents: tides, a mean flow, and eddies that last weeks.

    Parameters
    ----------
    bed : depth of the water [m]

    Returns
    -------
    time (n,) [hours], depth (m,) [m], u, v (n, m) [m/s]
    """
    time, depth = np.arange(365 * 24.0), np.linspace(0.0, bed, 9)
    tide = [
        (0.09, 12.4206, 0.0, 0.5), (0.04, 12.0, 0.9, 0.5), (0.02, 25.8193, 0.3, 0.8),
    ]  # fmt: skip
    phase = [2 * np.pi * time / period + start for _, period, start, _ in tide]
    along = sum(size * np.cos(angle) for (size, *_), angle in zip(tide, phase, strict=True))
    across = sum(
        ratio * size * np.sin(angle) for (size, _, _, ratio), angle in zip(tide, phase, strict=True)
    )
    generator = np.random.default_rng(2026)
    passing = np.zeros((2, len(time)))
    for _ in range(14):
        middle, width = generator.uniform(0.0, time[-1]), generator.uniform(100.0, 300.0)
        size, bearing = generator.uniform(0.15, 0.55), generator.uniform(0.0, 2 * np.pi)
        swell = size * np.exp(-0.5 * ((time - middle) / width) ** 2)
        turning = bearing + (time - middle) / width
        passing += swell * np.array([np.cos(turning), np.sin(turning)])
    decay = np.exp(-depth / 500.0)
    u = along[:, None] + (0.08 + passing[0])[:, None] * decay
    v = across[:, None] + passing[1][:, None] * decay
    return time, depth, u, v


def out_and_back() -> Figure:
    """The same tow out with the current and back against it, by the same speed over the ground."""
    tow = calm.load(shipped_folder("lines") / "a-frame-sheared-tow.yaml")
    given = tow.file.tow
    course = given.toward
    figure = Figure(figsize=(10, 4.6), layout="constrained")
    elevation, plan = figure.subplots(1, 2, width_ratios=(3, 2))
    for name, toward, colour in (("out", course, LINE), ("back", course + 180.0, "#cc3311")):
        keys = given.model_copy(update={"toward": toward % 360.0})
        result = calm.Design(replace(tow.file, tow=keys)).solve()
        angle = np.radians(toward)
        ahead = np.array([np.sin(angle), np.cos(angle)])
        behind = -(result.shape.x * ahead[0] + result.shape.y * ahead[1])
        beside = result.shape.x * ahead[1] - result.shape.y * ahead[0]
        label = f"{name}, towards {toward % 360.0:.0f}°: {result.body.depth:.0f} m deep"
        elevation.plot(behind, result.shape.depth, color=colour, linewidth=1.8, label=label)
        plan.plot(beside, -behind, color=colour, linewidth=1.8)
        for part in named_parts(result):
            marker, _, size = _MARKERS[part.role]
            far = -(part.x * ahead[0] + part.y * ahead[1])
            aside = part.x * ahead[1] - part.y * ahead[0]
            elevation.scatter(far, part.depth, marker=marker, color=colour, s=size)
            plan.scatter(aside, -far, marker=marker, color=colour, s=size)
    elevation.axhline(0.0, color=WATER, linewidth=1)
    elevation.invert_yaxis()
    elevation.set(xlabel="behind the ship [m]", ylabel="depth [m]")
    elevation.legend(loc="lower left", frameon=False)
    plan.axvline(0.0, color=STILL, linewidth=0.5)
    plan.set(xlabel="to starboard of the wake [m]", ylabel="along the course [m]")
    return figure


def _moored(name: str) -> calm.Design:
    return calm.load(shipped_folder("lines") / f"{name}.yaml")
