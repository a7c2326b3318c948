"""Warnings that a person should know before trusting a result: a small function for each doubt."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import hypot
from typing import Protocol

import numpy as np

from calm.case.leg import Leg
from calm.case.parts import below_the_seabed
from calm.case.result_tables import AnchorLoad, Clamps, ComponentRow, Components, Shape
from calm.case.strumming import Strumming
from calm.files import Cable, Component, MooringFile
from calm.files.pieces import clamps_in, parts_of
from calm.physics.line import Water
from calm.physics.materials import fibre_of, published_stiffnesses
from calm.quantities import say
from calm.solve import Solution
from calm.solve.audit import flow_across
from calm.solve.finish import doubted_depth

LARGEST_REYNOLDS = 2e5
"""Above it a constant drag coefficient of a smooth sphere or cylinder no longer holds."""
LARGEST_STRAIN = 0.25
"""New nylon fails near it; no linear stiffness holds so far."""


def is_synthetic(component: Component) -> bool:
    """Return whether a component is a rope of a synthetic fibre, by its `material`.

    Steel in a jacket of plastic is none.
    """
    return component.kind == "cable" and fibre_of(component.material) is not None


def counted_working_load(component: Component) -> float | None:
    """Return the working load by which a component is judged [N], None without one.

    Tables of synthetic ropes print a working load for lifting, a twelfth to a seventh of the
    breaking load. A rope that gives its breaking load is judged by that alone.
    """
    if is_synthetic(component) and component.breaking_load is not None:
        return None
    return component.working_load


class _Measured(Protocol):
    """The figures of a `LegResult` that lead to warnings."""

    @property
    def leg(self) -> Leg: ...
    @property
    def solution(self) -> Solution: ...
    @property
    def name(self) -> str: ...
    @property
    def file(self) -> MooringFile: ...
    @property
    def water(self) -> Water: ...
    @property
    def anchor_load(self) -> AnchorLoad: ...
    @property
    def components(self) -> Components: ...
    @property
    def clamps(self) -> Clamps: ...
    @property
    def shape(self) -> Shape: ...
    @property
    def still_shape(self) -> Shape | None: ...
    @property
    def strumming(self) -> Strumming | None: ...


def warnings_of(result: _Measured) -> tuple[str, ...]:
    """Return every warning of the result of a leg, the file's own notices first."""
    # a leg that is marched from its other end is no tow
    doubts = (*_OF_ANY, *(_OF_A_TOW if result.leg.towed else _OF_A_MOORING))
    found = [warning for doubt in doubts for warning in doubt(result, result.solution)]
    return (*result.file.notices, *found)


def _overloaded(result: _Measured, _: Solution) -> Iterator[str]:
    for row in result.components:
        if row.safety_factor < 1.0:
            pull = say("tension", row.tension)
            yield f"{row.label} breaks: {pull} is above its breaking load."
        elif row.utilisation > 1.0 and counted_working_load(row.part.component) is not None:
            pull = say("tension", row.tension)
            yield f"{row.label} is overloaded: {pull} is above its working load."


def _same_serial(result: _Measured, _: Solution) -> Iterator[str]:
    seen: dict[tuple[str, str], str] = {}
    for part in parts_of(result.file.pieces):
        if part.serial is not None:
            other = seen.setdefault((part.use, part.serial), part.label)
            if other != part.label:
                yield f"{other} and {part.label} have the same serial number, {part.serial}."


def _anchor_too_light(result: _Measured, _: Solution) -> Iterator[str]:
    anchor = result.anchor_load
    if anchor.weight < anchor.required_weight:
        of = f" of leg {result.name}" if result.leg.of_several else ""
        yield (
            f"The anchor{of} weighs {say('wet_weight', anchor.weight)} in water; "
            f"{say('required_weight', anchor.required_weight)} is required to hold the line."
        )


def _anchor_of_unknown_material(result: _Measured, _: Solution) -> Iterator[str]:
    if not result.file.anchor.material_known:
        yield (
            f"{result.file.pieces[-1].label} gives only its mass and is taken as steel, 7850 "
            "kg/m³; concrete of that mass would weigh two thirds as much in water."
        )


def _tilted(result: _Measured, _: Solution) -> Iterator[str]:
    for row in (*result.components, *result.clamps):
        component, leans = row.part.component, f"{row.label} leans {row.tilt:.1f} degrees"
        limit, warned = component.max_tilt, component.warn_tilt
        if limit is not None and row.tilt > limit:
            yield f"{leans}, beyond its limit of {limit:g}."
        elif warned is not None and row.tilt > warned:
            yield f"{leans}, above its warning limit of {warned:g}."


def _stiffness_unknown(result: _Measured, _: Solution) -> Iterator[str]:
    for piece, tension in zip(result.file.pieces, result.components.tension, strict=True):
        strains = unknown_stretch(piece.component, tension)
        if strains is not None:
            yield (
                f"{piece.label} is {piece.component.material} of unknown stiffness, taken as "
                f"inextensible: {_published(strains)}"
            )


def unknown_stretch(component: Component, tension: float) -> list[float] | None:
    """Return the strains that published stiffnesses give a synthetic rope, the greatest first [-].

    None where it is no synthetic rope, or gives its own stiffness; empty where none is published.
    """
    if not isinstance(component, Cable) or not is_synthetic(component):
        return None
    if component.stiffness is not None or component.elongation is not None:
        return None
    published = published_stiffnesses(component.material, component.diameter)
    return [tension / stiffness for stiffness in published]


def _published(strains: list[float]) -> str:
    """Return what the published stiffnesses of such ropes say of a stretch; the greatest strain
    first.
    """
    if not strains:
        return "no stiffness of such a rope is published."
    if len(strains) == 1:
        return f"by the one published stiffness it would stretch by {_percent(strains[0])} %."
    return (
        "the published stiffnesses of such ropes differ by a factor of "
        f"{strains[0] / strains[-1]:.2g}; at its tension it could stretch by "
        f"{_percent(strains[-1])} to {_percent(strains[0])} %."
    )


def _percent(share: float) -> str:
    """Write a share in two digits."""
    return f"{100 * share:.2g}" if share < 0.995 else f"{100 * share:.0f}"


def _overstretched(result: _Measured, solution: Solution) -> Iterator[str]:
    line, greatest = solution.line, np.zeros(len(solution.line.length))
    linear = line.compliance[solution.element_piece] > 0.0
    np.maximum.at(greatest, solution.element_piece, np.where(linear, solution.strain, 0.0))
    ahead = greatest[::-1] if line.towed else greatest
    for label, strain in zip(result.components.label, ahead, strict=False):
        if strain > LARGEST_STRAIN:
            yield f"{label} stretches by {100 * strain:.0f} %: beyond any linear stiffness."


def _beyond_the_table(result: _Measured, solution: Solution) -> Iterator[str]:
    line = solution.line.reversed() if solution.line.towed else solution.line
    for row, curve in zip(result.components, line.elongation, strict=False):
        if curve is not None and row.tension > curve.limit:
            yield (
                f"{row.label} is loaded beyond its elongation table: "
                f"{say('tension', row.tension)}; the table is valid up to "
                f"{say('tension', curve.limit)}."
            )


def _fast_flow(result: _Measured, _: Solution) -> Iterator[str]:
    """Of a tow, which no design check judges."""
    fast = fast_pieces(result)
    if fast:
        row, limit = fast[0]
        others = f" and {len(fast) - 1} more" if len(fast) > 1 else ""
        yield (
            f"Reynolds number above {power_text(limit)} ({row.label}: "
            f"{power_text(row.reynolds)}{others}): check the drag coefficient."
        )


def fast_pieces(result: _Measured) -> list[tuple[ComponentRow, float]]:
    """Spheres and cylinders with a greater Reynolds number than their drag coefficient holds for.

    Each has the limit; the farthest beyond comes first.
    """
    curves = [*result.leg.line.drag_curve, None]
    rows = [
        (row, LARGEST_REYNOLDS if curve is None else curve.largest_reynolds)
        for row, curve in zip(result.components, curves, strict=False)
        if row.kind in ("sphere", "cylinder")
    ]
    fast = [(row, limit) for row, limit in rows if row.reynolds > limit]
    return sorted(fast, key=lambda entry: -entry[0].reynolds / entry[1])


def power_text(number: float) -> str:
    """Write a number in two digits, as 2e5."""
    return f"{number:.2g}".replace("e+0", "e")


def _bight(result: _Measured, solution: Solution) -> Iterator[str]:
    if result.leg.of_several:  # which hang as their ends are held
        return
    water, (east, north, up) = solution.water, solution.force[1:].T
    if solution.landed:  # as the seabed leads up so does the line above it
        up = up + water.deeper_east * east + water.deeper_north * north
    bights = (up < 0.0) & (solution.element_clamp < 0)
    hanging = solution.element_piece[: solution.hanging - solution.landed]
    hanging = hanging[bights[: len(hanging)]]
    if len(hanging):
        yield (
            f"The line hangs in a bight: at {result.components.label[hanging[0]]} it rises "
            "towards the anchor."
        )


def _on_the_seabed(result: _Measured, solution: Solution) -> Iterator[str]:
    lying = solution.element_piece[solution.hanging :]
    rigid = [p for p in dict.fromkeys(lying.tolist()) if not solution.line.flexible[p]]
    clamps = [m for m in solution.element_clamp[solution.hanging :].tolist() if m >= 0]
    known = [clamp.label for clamp in clamps_in(result.file.pieces)]
    names = [result.components.label[p] for p in rigid] + [known[m] for m in clamps]
    if names:
        yield f"On the seabed: {', '.join(names)}."
    if solution.landed and result.file.environment.seabed is not None:
        depth = result.water.depth  # of a leg at its anchor
        off = below_the_seabed(result.file, solution, depth)[solution.hanging :]
        worst = float(np.nan_to_num(np.abs(off)).max())
        if worst > solution.depth_error + 1e-3:
            yield (
                f"{say('grounded_length', solution.grounded_length)} of line lies on the plane of "
                f"the seabed about its anchor, where the grid is up to {worst:.2f} m off it."
            )
    if solution.landed and result.still_shape is result.shape and not solution.pulled:
        yield "In still water the line on the seabed may lie any way: the offset is the greatest."


def _slack(result: _Measured, solution: Solution) -> Iterator[str]:
    if solution.slack > 0.0:
        pieces = result.file.pieces
        lying = {pieces[p].component.kind for p in solution.element_piece[solution.hanging :]}
        yield (
            f"Leg {result.name} is slack: {say('grounded_length', solution.slack)} more "
            f"{'chain' if 'chain' in lying else 'line'} lies on the seabed than leads to its "
            "anchor."
        )


def _far_too_long(result: _Measured, solution: Solution) -> Iterator[str]:
    line, depth, pieces = solution.line, solution.water.depth, result.file.pieces
    times = float(line.length.sum()) / depth
    lying = solution.element_piece[solution.hanging :].tolist()
    ropes = [pieces[p].label for p in lying if isinstance(pieces[p].component, Cable)]
    if solution.surface and not result.leg.of_several and times > 2.0 and ropes:
        yield (
            f"The line is {times:.1f} times as long as the water is deep, and {ropes[0]} lies on "
            f"the seabed.{doubted_depth(depth)}"
        )


def _other_equilibrium(_: _Measured, solution: Solution) -> Iterator[str]:
    other = solution.other
    if other is None:
        return
    if solution.surface and other.used_buoyancy < 1.0:
        pull = say("force", hypot(other.anchor_vertical, other.anchor_horizontal))
        yield (
            f"Another equilibrium exists, with {other.used_buoyancy:.1%} of the float's buoyancy "
            f"in use and an anchor load of {pull}."
        )
        return
    both = other.grounded_length != solution.grounded_length
    on_the_bed = f" and {other.grounded_length:.1f} m of line on the seabed" if both else ""
    yield (
        "Another equilibrium exists, with the free end at a depth of "
        f"{other.depth:.1f} m{on_the_bed}."
    )


def _hull_unknown(result: _Measured, solution: Solution) -> Iterator[str]:
    """A float of unknown draft is taken as just immersed, or dragged by its `k_surface`."""
    riding, immersed = solution.riding, result.file.solver.buoy_drag == "immersed"
    if solution.surface and immersed and (riding is None or np.isnan(riding.draft)):
        afloat = [result.components.label[piece] for piece in solution.afloat]
        reason = (
            "gives no hull, or no mass or volume for one"
            if len(afloat) == 1
            else "are several floats at the surface"
        )
        taken = "just immersed" if riding is None else "dragged by its `k_surface`"
        yield f"{', '.join(afloat)} {reason}: {taken}, without a draft."


def _wind_ignored(result: _Measured, solution: Solution) -> Iterator[str]:
    wind = result.file.environment.wind
    floating = solution.line.floating
    felt = floating is not None and (floating.hull is not None or floating.wind_area is not None)
    if wind is not None and solution.surface and not (solution.riding is not None and felt):
        yield "Wind on the float is neglected: its area above the water is not known."


def _below_the_sea(result: _Measured, _: Solution) -> Iterator[str]:
    lowest = float(result.shape.depth.max())
    towing = result.leg.towing
    if towing.in_air and towing.height > 0.0 and lowest > 0.0:
        yield (
            f"The line reaches {lowest:.1f} m below the surface, but all of it is taken as in air."
        )


def _strums_along_the_flow(result: _Measured, solution: Solution) -> Iterator[str]:
    law = solution.line.strumming
    if law is None or result.strumming is None:
        return
    current = solution.water.current_at(-solution.position[:-1, 2])
    speed = np.linalg.norm(current, axis=1)
    sine = np.divide(flow_across(solution), speed, out=np.ones(len(speed)), where=speed > 0)
    cables = solution.line.diameter[solution.element_piece] > 0.0
    least = np.degrees(np.arcsin(np.min(sine[cables & (solution.cut > 0.0)], initial=1.0)))
    claimed = np.degrees(law.LEAST_ANGLE)
    if least < claimed:
        yield (
            f"The cable comes within {least:.1f} degrees of the flow: its drag coefficient at "
            f"rest, C0 = {law.rest:g}, is valid only above {claimed:.0f} degrees."
        )


_OF_ANY: tuple[Callable[[_Measured, Solution], Iterator[str]], ...] = (
    _same_serial, _overloaded, _tilted, _stiffness_unknown, _overstretched, _beyond_the_table,
    _other_equilibrium,
)  # fmt: skip
_OF_A_MOORING: tuple[Callable[[_Measured, Solution], Iterator[str]], ...] = (
    _anchor_too_light, _anchor_of_unknown_material, _bight, _on_the_seabed, _slack,
    _far_too_long, _hull_unknown, _wind_ignored,
)  # fmt: skip
_OF_A_TOW: tuple[Callable[[_Measured, Solution], Iterator[str]], ...] = (
    _below_the_sea,
    _fast_flow,
    _strums_along_the_flow,
)
