"""Anchor sheets: plan of the anchor drop, and anchor position from acoustic ranges."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from calm.checks.finding import State, grouped_by
from calm.drawing.graph import Axes, Graph, LegendEntry, Scale, Stroke, covering, to_one_scale
from calm.drop import DropPlan
from calm.drop.fall_record import DepthReached
from calm.files.pieces import holds_instrument
from calm.physics.line import Floats
from calm.quantities import QUANTITIES, bearing_text, duration, say
from calm.report import blocks
from calm.report.blocks import Cell, Figure, Prose, ReportPart, Table, number, quantity, table_of
from calm.report.provenance import degrees_text, position_text
from calm.units import KNOT

if TYPE_CHECKING:
    from calm.ranging import Located


_ROWS = 6
"""Number of rows in the table of the anchor's descent."""
_DEEPER = 0.5
"""Minimum extra depth for which the drop plan lists a component without an instrument [m].

The extra depth is the maximum depth during the descent minus the depth in equilibrium. A component
that sinks below its depth rating is always listed.
"""
_REPRESENTED = 0.02
"""Initial fraction of the fall time in which the fall speed is not drawn.

In this time, inertia limits the speed.
"""


def drop_part(plan: DropPlan) -> ReportPart:
    """Build the sheet of the anchor drop plan."""
    shown: tuple[blocks.Block, ...] = (
        _instructions(plan),
        *blocks.warned(plan.warnings),
        blocks.Pairs(_figures(plan)),
        blocks.Note(_notes(plan)),
        Figure("Anchor drop", drop_figure(plan)),
        _fall_table(plan),
        *_depths_table(plan),
    )
    return ReportPart("Anchor drop plan", shown)


def _instructions(plan: DropPlan) -> Prose:
    beyond = "beyond" if plan.tow_past >= 0.0 else "before"
    speed = say("speed", plan.ship_speed)
    if QUANTITIES["speed"].display_unit != "kn":
        speed += f" ({plan.ship_speed / KNOT:.1f} kn)"
    sentences = [
        f"Steam towards {bearing_text(plan.course)} true at {speed} over the ground, and pay out "
        "the line, float first."
    ]
    if plan.start is not None:
        behind = "before" if plan.start.distance >= 0.0 else "beyond"
        start = _distance(abs(plan.start.distance))
        sentences.append(
            f"Deploy the top float {start} {behind} the target; the run takes about "
            f"{duration(plan.start.time)}."
        )
    sentences.append(
        f"Release the anchor {_distance(abs(plan.tow_past))} {beyond} the target, with the top "
        f"float {_distance(plan.streamed)} astern."
    )
    return Prose(tuple(sentences))


def _figures(plan: DropPlan) -> tuple[tuple[str, str], ...]:
    early, late = plan.fall_time_band
    near, far = plan.fall_back_band
    cube = "assumed (cube of equal volume, because `kt` is not set)"
    given = "as specified" if plan.drag_known else cube
    side = "right" if plan.aside >= 0.0 else "left"
    pull = max(plan.pulls, key=lambda each: each.tension)
    halved = "with half and twice the drag of the anchor"
    error, back = max(ceil(plan.time_error), 1), _distance(max(ceil(plan.distance_error), 1))
    figures = {
        "Fall time": f"{plan.fall_time:.0f} s ± {error} s; {early:.0f} to {late:.0f} s {halved}",
        "Fallback towards the float": f"{_distance(plan.fall_back)} ± {back}; "
        f"{_distance(near)} to {_distance(far)} {halved}",
        "Lateral offset": f"{_distance(abs(plan.aside))} to the {side}, looking from the release "
        "point towards the float",
        "Float astern at anchor release": f"{_distance(plan.streamed)}, towards "
        f"{bearing_text(plan.astern)} true",
        "Release point, from the target": offset_from_target(plan, plan.let_go),
        "Start of the run, from the target": "unknown"
        if plan.start is None
        else offset_from_target(plan, plan.start.place),
        "Speed at touchdown": say("speed", plan.touchdown_speed),
        "Maximum tension in descent": f"{say('tension', pull.tension)} in {pull.part.label}, "
        f"after {pull.time:.0f} s",
        "Drag of the anchor at 1 m/s": f"{say('tension', plan.anchor_drag)}, {given}",
    }
    return tuple(figures.items())


def _fall_table(plan: DropPlan) -> Table:
    path = plan.path
    depths = np.linspace(path.anchor_depth[0], path.anchor_depth[-1], _ROWS)
    deepest = np.maximum.accumulate(path.anchor_depth)

    def column(
        heading: str, name: str, values: Floats, decimals: int = 0, first: int = 0
    ) -> blocks.Field:
        shown = QUANTITIES.get(name)
        unit, scale = (shown.display_unit, shown.scale) if shown else (name, 1.0)
        at = scale * np.interp(depths, deepest, values)
        return number(heading, lambda n: f"{at[n]:.{decimals}f}" if n >= first else "-", unit)

    return table_of(
        "Descent",
        range(_ROWS),
        column("anchor depth", "depth", deepest),
        column("time", "s", path.time),
        column("speed", "speed", path.anchor_speed, 2, first=1),
        column("towards float", "offset", path.anchor_x),
        column("tension at anchor", "tension", path.anchor_tension, first=1),
        column("float at", "offset", path.float_x),
        column("float depth", "depth", np.maximum(path.float_depth, 0.0)),
        note="Distances are measured from the release point towards the float.",
    )


def _depths_table(plan: DropPlan) -> list[Table]:
    listed = [
        each
        for each in plan.depths
        if holds_instrument(each.part) or each.beyond or each.greatest > each.rest + _DEEPER
    ]
    # components of equal rating share a row; those that sink below their rating are separate
    runs = grouped_by(listed, lambda one: one.label if one.beyond else (one.part.use, one.rating))
    rows = [(max(run, key=lambda one: one.greatest), run) for run in runs.values()]
    depth = QUANTITIES["depth"]

    def label(row: tuple[DepthReached, Sequence[DepthReached]]) -> str:
        return row[0].label + (f" (deepest of {len(row[1])})" if len(row[1]) > 1 else "")

    def greatest(row: tuple[DepthReached, Sequence[DepthReached]]) -> Cell:
        beyond = any(one.beyond for one in row[1])
        deepest = row[0].rest if row[0].time is None else row[0].greatest
        return Cell(depth.format(deepest), state=State.FAIL if beyond else None)

    def after(row: tuple[DepthReached, Sequence[DepthReached]]) -> str:
        return "at rest" if row[0].time is None else f"after {row[0].time:.0f} s"

    table = table_of(
        "Depths during the drop",
        rows,
        blocks.words("piece or clamp", label),
        number("maximum depth", greatest, depth.display_unit),
        number("reached", after),
        quantity("depth", lambda row: row[0].rest, "at rest"),
        quantity("depth", lambda row: row[1][0].rating, "rated to"),
        note="Depths are at the upper end; a rating is exceeded if the deeper end exceeds it.",
    )
    return [table] if listed else []


def _notes(plan: DropPlan) -> tuple[str, ...]:
    notes = [
        "Inertia is neglected, so the first 20 s, the touchdown transient and waves are not "
        "represented.",
        "± is the numerical error. CALM also computes the drop with segments of twice the "
        "length, and with time steps of twice the length. ± is twice the sum of both changes. The "
        "current and the drag of the anchor are less certain.",
    ]
    if plan.rest_difference is not None:
        notes.append(
            f"The final position is within {plan.rest_difference:.2f} m of the static equilibrium."
        )
    return tuple(notes)


def _distance(distance: float) -> str:
    one = QUANTITIES["offset"]
    return f"{distance * one.scale:.0f} {one.display_unit}"


def offset_from_target(plan: DropPlan, place: tuple[float, float]) -> str:
    """Format the position of a point relative to the target, north and east.

    The latitude and longitude are added if known. `place` is the distance to the east and the
    distance to the north of the target [m].
    """
    east, north = place
    position = plan.position(place)
    return (
        f"{_distance(abs(north))} {'north' if north >= 0.0 else 'south'}, "
        f"{_distance(abs(east))} {'east' if east >= 0.0 else 'west'}"
        + ("" if position is None else f"; {position_text(position)}")
    )


_WIDTH, _SIZE = 510.0, 8.0  # text width of an A4 page, and font size [pt]
_HEIGHT = 216.0
_LEFT, _BELOW = 42.0, 30.0  # room for scales beside and below axes [pt]
_WATER, _SEABED, _PATH = "#2b7bba", "#b8a07e", "#d55e00"
_DASHES = ((), (6.0, 2.0), (4.0, 2.0, 1.0, 2.0), (1.0, 1.5), (2.0, 1.0))


def drop_figure(plan: DropPlan) -> str:
    """Draw the anchor drop as SVG.

    The left panel shows the path of the anchor and the line at several times, true to scale. The
    right panel shows the fall speed against depth.
    """
    greys = [round(255 * shade) for shade in np.linspace(0.65, 0.0, len(plan.moments))]
    moments = [
        (moment, Stroke(f"#{grey:02x}{grey:02x}{grey:02x}", 1.1, dashes))
        for moment, grey, dashes in zip(plan.moments, greys, cycle(_DASHES), strict=False)
    ]
    entries = [LegendEntry(moment.name, line=stroke) for moment, stroke in moments]
    entries.append(LegendEntry("path of the anchor", line=Stroke(_PATH, 1.4)))
    legend = ceil(len(entries) / 3) * 12.0 + 6.0
    page = Graph(_WIDTH, legend + _HEIGHT, "Anchor drop", _SIZE)
    page.legend(entries, (_LEFT, 2.0), (_WIDTH - _LEFT) / 3, 12.0, columns=3)
    top, tall = legend + 4.0, _HEIGHT - _BELOW - 4.0
    depth = plan.mooring.water.depth
    down = Scale(1.06 * depth, -0.04 * depth)
    wide = 342.0
    reach = covering(
        plan.path.anchor_x, [plan.fall_back], *(moment.x for moment, _ in moments), margin=0.03
    )
    across, up = to_one_scale(reach, down, wide, tall)
    shapes = page.axes(_LEFT, top, wide, tall, across, up, clipped=True)
    shapes.strip(depth, max(up.low, 1.06 * depth), _SEABED)
    shapes.level(0.0, Stroke(_WATER, 1.0))
    for moment, stroke in moments:
        shapes.line(moment.x, moment.depth, stroke)
        shapes.mark(moment.x[0], moment.depth[0], "o", 3.5, stroke.colour)
    shapes.line(plan.path.anchor_x, plan.path.anchor_depth, Stroke(_PATH, 1.4))
    shapes.mark(plan.fall_back, depth, "v", 6.0, _PATH)
    below = "distance from the release point towards the float [m]"
    shapes.frame(7, 6, below=below, beside="depth [m]", grid=True)
    _draw_speed(page, (_LEFT + wide + 12.0, top, _WIDTH - _LEFT - wide - 20.0, tall), plan, up)
    return page.svg()


def _draw_speed(
    page: Graph, place: tuple[float, float, float, float], plan: DropPlan, down: Scale
) -> None:
    path = plan.path
    drawn = path.time > _REPRESENTED * path.time[-1]
    fastest = float(np.max(path.anchor_speed[drawn]))
    axes = page.axes(*place, Scale(0.0, 1.1 * fastest), down, clipped=True)
    axes.line(path.anchor_speed[drawn], path.anchor_depth[drawn], Stroke("#111111", 1.2))
    falling = [one.time for one in plan.moments if 0.0 < one.time < path.time[-1]]
    for time in falling:
        at = float(np.interp(time, path.time, path.anchor_depth))
        value = float(np.interp(time, path.time, path.anchor_speed))
        axes.mark(value, at, "o", 3.0, "#111111")
        axes.words(value, at, f"{time:.0f} s", shift=(-4.0, -5.0), anchor="end")
    axes.frame(3, 6, below="fall speed [m/s]", grid=True, numbered=(True, False))


_CIRCLE, _LEFT_OUT, _PLACE = Stroke("#2b7bba", 0.8), Stroke("#999999", 0.8, (4.0, 2.5)), "#c0392b"
_ROUND = np.linspace(0.0, 2.0 * np.pi, 1441)


def located_part(located: Located, water_depth: float) -> ReportPart:
    """Report the anchor position, its uncertainty and the residual of each range.

    Parameters
    ----------
    water_depth : water depth [m]
    """
    outliers = [
        line for line, used in zip(located.survey.line, located.used, strict=True) if not used
    ]
    sentences = []
    if outliers:
        several = "lines" if len(outliers) > 1 else "line"
        lines = ", ".join(map(str, outliers))
        sentences.append(Prose((f"Rejected as outliers: {several} {lines}.",)))
    notes = [
        "Acoustic rays are assumed to be straight, and the sea surface is taken as the WGS 84 "
        "ellipsoid."
    ]
    if located.survey.timed:
        notes.append("Times are two-way travel times, without a transponder delay.")
    shown: tuple[blocks.Block, ...] = (
        blocks.Pairs(_located_figures(located, water_depth)),
        *blocks.warned(located.warnings),
        *sentences,
        _residuals_table(located),
        blocks.Note(tuple(notes)),
    )
    return ReportPart("Anchor position", shown)


def _located_figures(located: Located, water_depth: float) -> tuple[tuple[str, str], ...]:
    major, minor, bearing = located.ellipse
    within = "unknown"
    if np.isfinite(major):
        towards = f"{round(bearing) % 180:03d}°"
        within = f"{major:.1f} m by {minor:.1f} m, major axis towards {towards}"
    sure = f" ± {located.depth_95:.1f} m (95 %)" if np.isfinite(located.depth_95) else ""
    sure = ", as specified" if located.depth_given else sure
    latitude = degrees_text(located.latitude, "NS", 1)
    longitude = degrees_text(located.longitude, "EW", 1)
    pairs = [
        ("Latitude, longitude", f"{located.latitude:.6f}, {located.longitude:.6f}"),
        ("", f"{latitude}  {longitude}"),
        ("95 % ellipse", within),
        ("Depth", f"{water_depth:.1f} m{sure}"),
        ("Ranges used", f"{int(located.used.sum())} of {len(located.used)}"),
        ("Scatter", f"{located.rms:.2f} m" if np.isfinite(located.rms) else "unknown"),
    ]
    if located.survey.timed:
        pairs.append(("Speed of sound", f"{located.sound_speed:.1f} m/s, harmonic mean"))
    return tuple(pairs)


def _residuals_table(located: Located) -> Table:
    survey, used = located.survey, located.used
    decimals, measured = (4, ("time", "s")) if survey.timed else (1, ("range", "m"))

    def residual(at: int) -> Cell:
        return Cell(f"{located.residuals[at]:+.2f}", state=None if used[at] else State.FAIL)

    return table_of(
        "Ranges",
        range(len(survey.line)),
        number("line", lambda at: survey.line[at]),
        number("latitude", lambda at: f"{survey.latitude[at]:.5f}", "°"),
        number("longitude", lambda at: f"{survey.longitude[at]:.5f}", "°"),
        number(measured[0], lambda at: f"{survey.measured[at]:.{decimals}f}", measured[1]),
        number("residual", residual, "m"),
        blocks.words("", lambda at: None if used[at] else "not used", 0.0),
        note="The residual is the measured range minus the computed range.",
    )


_PANEL = 290.0


def located_figure(located: Located) -> str:
    """Draw an acoustic survey of the anchor as SVG, with a circle for each range.

    The circles are at the depth of the transponder; rejected ranges are dashed. The right panel
    shows the anchor position with a 95 % ellipse.
    """
    frame, survey = located.survey.frame, located.survey
    ships = frame.place(
        survey.latitude, survey.longitude, np.full(len(survey.line), survey.transducer)
    )
    ships = ships - located.place
    ranges = located.residuals + np.linalg.norm(ships, axis=1)
    across = np.sqrt(np.maximum(ranges**2 - ships[:, 2] ** 2, 0.0))
    reach = 1.15 * float(np.abs(ships[:, :2]).max())
    scatter = float(np.abs(located.residuals[located.used]).max())
    close = max(3.0 * np.nan_to_num(located.horizontal_95), 3.0 * scatter, 1.0)
    page = Graph(2 * _PANEL + 110.0, _PANEL + 52.0, "Position of the anchor by ranges", _SIZE)
    titles = (
        "all ranges, with their line numbers in the file",
        "the position, with its 95 % ellipse",
    )
    for panel, half in enumerate((max(reach, 2.0 * close), close)):
        left = 48.0 + panel * (_PANEL + 54.0)
        scale = Scale(-half, half)
        axes = page.axes(left, 18.0, _PANEL, _PANEL, scale, scale, clipped=True)
        for (x, y, _), radius, used in zip(ships, across, located.used, strict=True):
            stroke = _CIRCLE if used else _LEFT_OUT
            axes.line(x + radius * np.cos(_ROUND), y + radius * np.sin(_ROUND), stroke)
        if panel == 0:
            for line, (x, y, _) in zip(survey.line, ships.tolist(), strict=True):
                axes.mark(x, y, "^", 5.0, "#111111")
                axes.words(x, y, str(line))
        else:
            _draw_ellipse(axes, located)
        axes.mark(0.0, 0.0, "+", 10.0, _PLACE)
        axes.title(titles[panel])
        axes.frame(
            7, 7, below="east of the anchor [m]", beside="north of the anchor [m]", grid=True
        )
    return page.svg()


def _draw_ellipse(axes: Axes, located: Located) -> None:
    major, minor, bearing = located.ellipse
    if not np.isfinite(major):
        return
    east, north = np.sin(np.radians(bearing)), np.cos(np.radians(bearing))
    along, aside = major * np.cos(_ROUND), minor * np.sin(_ROUND)
    axes.area(along * east + aside * north, along * north - aside * east, _PLACE)
