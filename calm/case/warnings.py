"""Warnings about doubtful results; each warning has its own function."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import hypot
from typing import Protocol

import numpy as np

from calm.case.leg import Leg
from calm.case.parts import below_the_seabed
from calm.case.result_tables import AnchorLoad, Clamps, ComponentRow, Components, Shape
from calm.case.strumming import Strumming
from calm.files import Cable, Clamp, Component, MooringFile, Piece, Rigid
from calm.files.definition import CATALOGUE_DENSITY
from calm.files.pieces import clamps_in, parts_of
from calm.physics.line import Water
from calm.physics.materials import fibre_of, published_stiffnesses
from calm.quantities import say
from calm.solve import Solution
from calm.solve.audit import flow_across
from calm.solve.finish import doubted_depth

LARGEST_REYNOLDS = 2e5
"""Largest Reynolds number for which the constant drag coefficient of a smooth sphere or cylinder is
valid.
"""
BRACKISH = 1010.0
"""Water density [kg/m³] below which a float has noticeably less buoyancy than in sea water."""
LARGEST_STRAIN = 0.25
"""Strain near which new nylon fails, and above which no linear stiffness is valid."""


def is_synthetic(component: Component) -> bool:
    """Return whether a component is a rope of synthetic fibre, according to its `material`.

    Steel with a plastic jacket does not count.
    """
    return component.kind == "cable" and fibre_of(component.material) is not None


def counted_working_load(component: Component) -> float | None:
    """Return the working load used to check a component [N], or None.

    For a synthetic rope with a known breaking load, the result is None. Working loads in rope
    tables are for lifting and are not used.
    """
    if is_synthetic(component) and component.breaking_load is not None:
        return None
    return component.working_load


class _Measured(Protocol):
    """Values of a `LegResult` that the warnings use."""

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
    """Collect all warnings about the result of a leg, beginning with the notices of the file."""
    # a leg that is marched from its other end is not a tow
    doubts = (*_OF_ANY, *(_OF_A_TOW if result.leg.towed else _OF_A_MOORING))
    found = [warning for doubt in doubts for warning in doubt(result, result.solution)]
    return (*result.file.notices, *found)


def _overloaded(result: _Measured, _: Solution) -> Iterator[str]:
    for row in result.components:
        if row.safety_factor < 1.0:
            pull = say("tension", row.tension)
            yield f"{row.label} breaks: its tension of {pull} exceeds its breaking load."
        elif row.utilisation > 1.0 and counted_working_load(row.part.component) is not None:
            pull = say("tension", row.tension)
            yield f"{row.label} is overloaded: its tension of {pull} exceeds its working load."


def _same_serial(result: _Measured, _: Solution) -> Iterator[str]:
    seen: dict[tuple[str, str], str] = {}
    for part in parts_of(result.file.pieces):
        for serial in part.serials:
            other = seen.setdefault((part.use, serial), part.label)
            if other != part.label:
                yield f"{other} and {part.label} have the same serial number, {serial}."


def _anchor_too_light(result: _Measured, _: Solution) -> Iterator[str]:
    anchor = result.anchor_load
    if anchor.weight < anchor.required_weight:
        of = f" of leg {result.name}" if result.leg.of_several else ""
        yield (
            f"Anchor weight in water{of} is {say('wet_weight', anchor.weight)}; at least "
            f"{say('required_weight', anchor.required_weight)} is required to hold the mooring."
        )


def _anchor_of_unknown_material(result: _Measured, _: Solution) -> Iterator[str]:
    if not result.file.anchor.material_known:
        yield (
            f"{result.file.pieces[-1].label} has only a mass and is assumed to be steel (7850 "
            "kg/m³); a concrete anchor of the same mass would weigh two thirds as much in water."
        )


def _tilted(result: _Measured, _: Solution) -> Iterator[str]:
    for row in (*result.components, *result.clamps):
        component, tilts = row.part.component, f"{row.label} tilts by {row.tilt:.1f} degrees"
        limit, warned = component.max_tilt, component.warn_tilt
        if limit is not None and row.tilt > limit:
            yield f"{tilts}; its limit is {limit:g} degrees."
        elif warned is not None and row.tilt > warned:
            yield f"{tilts}; its warning limit is {warned:g} degrees."


def _stiffness_unknown(result: _Measured, _: Solution) -> Iterator[str]:
    for piece, tension in zip(result.file.pieces, result.components.tension, strict=True):
        strains = unknown_stretch(piece.component, tension)
        if strains is not None:
            yield (
                f"{piece.label} ({piece.component.material}) has no stiffness and is assumed "
                f"inextensible; {_published(strains)}"
            )


def unknown_stretch(component: Component, tension: float) -> list[float] | None:
    """Return the possible strains [-] of a synthetic rope with unknown stiffness at a tension.

    There is one strain for each published stiffness, the largest strain first. Return None if the
    component is not a synthetic rope, or if its definition specifies a stiffness.
    """
    if not isinstance(component, Cable) or not is_synthetic(component):
        return None
    if component.stiffness is not None or component.elongation is not None:
        return None
    published = published_stiffnesses(component.material, component.diameter)
    return [tension / stiffness for stiffness in published]


def _published(strains: list[float]) -> str:
    """Describe the stretch for the published stiffnesses; `strains` are in decreasing order."""
    if not strains:
        return "no stiffness of such ropes has been published."
    if len(strains) == 1:
        return f"the single published value gives a stretch of {_percent(strains[0])} %."
    return (
        f"published values differ by a factor of {strains[0] / strains[-1]:.2g}; at this "
        f"tension they give a stretch of {_percent(strains[-1])} to {_percent(strains[0])} %."
    )


def _percent(share: float) -> str:
    return f"{100 * share:.2g}" if share < 0.995 else f"{100 * share:.0f}"


def _overstretched(result: _Measured, solution: Solution) -> Iterator[str]:
    line, greatest = solution.line, np.zeros(len(solution.line.length))
    linear = line.compliance[solution.element_piece] > 0.0
    np.maximum.at(greatest, solution.element_piece, np.where(linear, solution.strain, 0.0))
    ahead = greatest[::-1] if line.towed else greatest
    for label, strain in zip(result.components.label, ahead, strict=False):
        if strain > LARGEST_STRAIN:
            yield (
                f"{label} stretches by {100 * strain:.0f} %; a linear stiffness is not valid for "
                "such a large stretch."
            )


def _beyond_the_table(result: _Measured, solution: Solution) -> Iterator[str]:
    line = solution.line.reversed() if solution.line.towed else solution.line
    for row, curve in zip(result.components, line.elongation, strict=False):
        if curve is not None and row.tension > curve.limit:
            yield (
                f"Tension in {row.label} is {say('tension', row.tension)}; its elongation table is "
                f"valid up to {say('tension', curve.limit)}."
            )


def _fast_flow(result: _Measured, _: Solution) -> Iterator[str]:
    fast = fast_pieces(result)
    if fast:
        yield f"{fast_text(fast)} Check the coefficient."


def fast_pieces(result: _Measured) -> list[tuple[ComponentRow, float]]:
    """List spheres and cylinders whose Reynolds number is above the range of the drag coefficient.

    An item is the row of the piece, and the largest valid Reynolds number. The piece with the
    largest ratio of the two numbers is first.
    """
    curves = [*result.leg.line.drag_curve, None]
    rows = [
        (row, LARGEST_REYNOLDS if curve is None else curve.largest_reynolds)
        for row, curve in zip(result.components, curves, strict=False)
        if row.kind in ("sphere", "cylinder")
    ]
    fast = [(row, limit) for row, limit in rows if row.reynolds > limit]
    return sorted(fast, key=lambda entry: -entry[0].reynolds / entry[1])


def fast_text(fast: Sequence[tuple[ComponentRow, float]]) -> str:
    """Describe the first of the pieces from `fast_pieces`, and the number of these pieces."""
    row, limit = fast[0]
    count = f" ({len(fast)} pieces exceed the limits of their drag coefficients)"
    return (
        f"The Reynolds number of {row.label} is {power_text(row.reynolds)}; the drag coefficient "
        f"is valid up to {power_text(limit)}{count if len(fast) > 1 else ''}."
    )


def power_text(number: float) -> str:
    """Format a number with two significant digits, such as 2e5."""
    return f"{number:.2g}".replace("e+0", "e")


def _bight(result: _Measured, solution: Solution) -> Iterator[str]:
    if result.leg.of_several:  # legs of a net hang according to their ends
        return
    water, (east, north, up) = solution.water, solution.force[1:].T
    if solution.landed:  # where the seabed rises, the line above it rises as well
        up = up + water.deeper_east * east + water.deeper_north * north
    bights = (up < 0.0) & (solution.element_clamp < 0)
    hanging = solution.element_piece[: solution.hanging - solution.landed]
    hanging = hanging[bights[: len(hanging)]]
    if len(hanging):
        yield (
            f"The line forms a bight: at {result.components.label[hanging[0]]} it rises towards "
            "the anchor."
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
        depth = result.water.depth  # for a leg, the depth at its anchor
        off = below_the_seabed(result.file, solution, depth)[solution.hanging :]
        worst = float(np.nan_to_num(np.abs(off)).max())
        if worst > solution.depth_error + 1e-3:
            lying_length = say("grounded_length", solution.grounded_length)
            yield (
                f"{lying_length} of line lies on the seabed. CALM treats the seabed as a plane "
                "around the anchor; along this line, the depth grid differs from the plane by up "
                f"to {worst:.2f} m."
            )
    if solution.landed and result.still_shape is result.shape and not solution.pulled:
        yield (
            "In still water the line on the seabed can lie in any direction; the offset given "
            "is the maximum."
        )


def _slack(result: _Measured, solution: Solution) -> Iterator[str]:
    if solution.slack > 0.0:
        pieces = result.file.pieces
        lying = {pieces[p].component.kind for p in solution.element_piece[solution.hanging :]}
        yield (
            f"Leg {result.name} is slack: the {'chain' if 'chain' in lying else 'line'} on the "
            f"seabed is {say('grounded_length', solution.slack)} longer than the distance from the "
            "touchdown point to the anchor."
        )


def _far_too_long(result: _Measured, solution: Solution) -> Iterator[str]:
    line, depth, pieces = solution.line, solution.water.depth, result.file.pieces
    times = float(line.length.sum()) / depth
    lying = solution.element_piece[solution.hanging :].tolist()
    ropes = [pieces[p].label for p in lying if isinstance(pieces[p].component, Cable)]
    if solution.surface and not result.leg.of_several and times > 2.0 and ropes:
        yield (
            f"Scope (line length over water depth) is {times:.1f}, and {ropes[0]} lies on the "
            f"seabed.{doubted_depth(depth)}"
        )


def _other_equilibrium(_: _Measured, solution: Solution) -> Iterator[str]:
    other = solution.other
    if other is None:
        return
    both = other.grounded_length != solution.grounded_length
    lying = f"{other.grounded_length:.1f} m of line on the seabed" if both else ""
    if solution.surface and other.used_buoyancy < 1.0:
        pull = say("force", hypot(other.anchor_vertical, other.anchor_horizontal))
        yield (
            f"Another equilibrium exists, with {other.used_buoyancy:.1%} of the float's buoyancy "
            f"in use{', ' * both}{lying} and an anchor load of {pull}."
        )
        return
    yield (
        "Another equilibrium exists, with the free end at a depth of "
        f"{other.depth:.1f} m{' and ' * both}{lying}."
    )


def _hull_unknown(result: _Measured, solution: Solution) -> Iterator[str]:
    riding, immersed = solution.riding, result.file.solver.buoy_drag == "immersed"
    if solution.surface and immersed and (riding is None or np.isnan(riding.draft)):
        afloat = [result.components.label[piece] for piece in solution.afloat]
        reason, floats = "has no hull, or neither mass nor volume", "the float is"
        if len(afloat) > 1:
            reason, floats = "are at the surface together", "the floats are"
        state = (
            f"{floats} treated as just immersed"
            if riding is None
            else "the drag is that of `k_surface`"
        )
        yield f"The draft is unknown, because {', '.join(afloat)} {reason}; {state}."


def buoyancy_of_sea_water(leg: Leg) -> tuple[Piece | Clamp, str] | None:
    """Return the first float with too high a buoyancy in fresh water, and a warning; else None.

    Catalogue values of buoyancy are for sea water. If the displaced volume of a float is unknown,
    CALM does not reduce the buoyancy of the float in fresh or brackish water.
    """
    density = float(np.max(leg.water.density))  # at the surface alone, water may be fresher
    if density >= BRACKISH:
        return None
    floats = [
        part for part in parts_of(leg.file.pieces)
        if isinstance(part.component, Rigid) and part.component.net_buoyancy > 0.0
        and part.component.displaced_volume is None
    ]  # fmt: skip
    if not floats:
        return None
    lost = 100.0 * (1.0 - density / CATALOGUE_DENSITY)
    others = len(floats) - 1
    which = floats[0].label + (f" and {others} other part{'s' * (others > 1)}" if others else "")
    return floats[0], (
        f"The buoyancy of {which} is valid for water of {CATALOGUE_DENSITY:g} kg/m³. CALM does not "
        "reduce this buoyancy, because neither `mass` nor `volume` is set. In water of "
        f"{density:.0f} kg/m³, the displaced water weighs {lost:.1f} % less."
    )


def _buoyancy_too_high(result: _Measured, _: Solution) -> Iterator[str]:
    if (found := buoyancy_of_sea_water(result.leg)) is not None:
        yield found[1]


def _wind_ignored(result: _Measured, solution: Solution) -> Iterator[str]:
    wind = result.file.environment.wind
    floating = solution.line.floating
    has_wind_load = floating is not None and (
        floating.hull is not None or floating.wind_area is not None
    )
    if (
        wind is not None
        and solution.surface
        and not (solution.riding is not None and has_wind_load)
    ):
        yield "Wind on the float is neglected: its area above the water is unknown."


def _below_the_sea(result: _Measured, _: Solution) -> Iterator[str]:
    lowest = float(result.shape.depth.max())
    towing = result.leg.towing
    if towing.in_air and towing.height > 0.0 and lowest > 0.0:
        yield (
            f"The line extends to {lowest:.1f} m below the surface although `fluid: air` "
            "treats the whole line as being in air."
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
            f"The smallest angle between cable and flow is {least:.1f} degrees; the drag "
            f"coefficient at rest, C0 = {law.rest:g}, is valid only above {claimed:.0f} degrees."
        )


_OF_ANY: tuple[Callable[[_Measured, Solution], Iterator[str]], ...] = (
    _same_serial, _overloaded, _tilted, _stiffness_unknown, _overstretched, _beyond_the_table,
    _other_equilibrium,
)  # fmt: skip
_OF_A_MOORING: tuple[Callable[[_Measured, Solution], Iterator[str]], ...] = (
    _anchor_too_light, _anchor_of_unknown_material, _bight, _on_the_seabed, _slack,
    _far_too_long, _hull_unknown, _wind_ignored, _buoyancy_too_high,
)  # fmt: skip
_OF_A_TOW: tuple[Callable[[_Measured, Solution], Iterator[str]], ...] = (
    _below_the_sea,
    _fast_flow,  # the design check reports fast flow, but does not cover tows
    _strums_along_the_flow,
)
