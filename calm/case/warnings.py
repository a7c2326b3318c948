"""What a person should know of a result before trusting it: one small function per worry."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from calm.case.measure import clamps_in
from calm.files import Cable, Component
from calm.solve import Solution
from calm.solve.audit import flow_across

if TYPE_CHECKING:
    from calm.case.result import Result
    from calm.case.tow import TowResult

LARGEST_REYNOLDS = 2e5
"""Above it a constant drag coefficient of a smooth sphere or cylinder no longer holds."""
LARGEST_STRAIN = 0.25
"""New nylon fails near it; no linear stiffness holds so far."""
SYNTHETICS = (
    "nylon", "polyamide", "polyester", "dacron", "polypropylene", "polyethylene", "polyolefin",
    "hmpe", "dyneema", "spectra", "aramid", "kevlar", "vectran", "perlon",
)  # fmt: skip


def is_synthetic(component: Component) -> bool:
    """Whether a component is a rope of a synthetic fibre, by its `material`."""
    material = (component.material or "").lower()
    return component.kind == "cable" and any(fibre in material for fibre in SYNTHETICS)


def warnings_of(result: Result, solution: Solution) -> tuple[str, ...]:
    """Every warning of a mooring's result, the file's own notices first."""
    of_any = [warning for worry in _WORRIES for warning in worry(result, solution)]
    own = [warning for worry in _MOORING_WORRIES for warning in worry(result, solution)]
    return (*result.file.notices, *of_any, *own)


def tow_warnings_of(result: TowResult, solution: Solution) -> tuple[str, ...]:
    """Every warning of a tow's result, the file's own notices first."""
    of_any = [warning for worry in _WORRIES for warning in worry(result, solution)]
    own = [warning for worry in _TOW_WORRIES for warning in worry(result, solution)]
    return (*result.file.notices, *of_any, *own)


def _overloaded(result: Result | TowResult, _: Solution) -> Iterator[str]:
    for row in result.components:
        if row.safety_factor < 1.0:
            yield f"{row.label} breaks: {row.tension:.0f} N is above its breaking load."
        elif row.utilisation > 1.0:
            yield f"{row.label} is overloaded: {row.tension:.0f} N is above its working load."


def _anchor_too_light(result: Result, _: Solution) -> Iterator[str]:
    anchor = result.anchor
    if anchor.weight < anchor.required_weight:
        yield (
            f"The anchor weighs {anchor.weight:.0f} N in water; {anchor.required_weight:.0f} N "
            "are required to hold the line."
        )


def _tilted(result: Result | TowResult, _: Solution) -> Iterator[str]:
    leaning = [
        (row.label, row.tilt, result.file.pieces[row.index].component) for row in result.components
    ]
    clamped = {clamp.label: clamp.component for clamp in clamps_in(result.file.pieces)}
    leaning += [(row.label, row.tilt, clamped[row.label]) for row in result.clamps]
    for label, tilt, component in leaning:
        limit, warned = component.max_tilt, component.warn_tilt
        if limit is not None and tilt > limit:
            yield f"{label} leans {tilt:.1f} degrees: not to be trusted beyond {limit:g}."
        elif warned is not None and tilt > warned:
            yield f"{label} leans {tilt:.1f} degrees, more than the {warned:g} it should."


def _stiffness_unknown(result: Result | TowResult, _: Solution) -> Iterator[str]:
    for piece in result.file.pieces:
        component = piece.component
        if isinstance(component, Cable) and is_synthetic(component) and component.stiffness is None:
            yield (
                f"{piece.label} is {component.material} of unknown stiffness: "
                "it is taken as inextensible."
            )


def _overstretched(result: Result | TowResult, solution: Solution) -> Iterator[str]:
    greatest = np.zeros(len(solution.line.length))
    np.maximum.at(greatest, solution.element_piece, solution.strain)
    for index in np.flatnonzero(greatest > LARGEST_STRAIN):
        label = result.components.label[index]
        yield f"{label} stretches by {100 * greatest[index]:.0f} %: beyond any linear stiffness."


def _fast_flow(result: Result | TowResult, _: Solution) -> Iterator[str]:
    fast = [
        row for row in result.components
        if row.kind in ("sphere", "cylinder") and row.reynolds > LARGEST_REYNOLDS
    ]  # fmt: skip
    if fast:
        row = max(fast, key=lambda row: row.reynolds)
        others = f" and {len(fast) - 1} more" if len(fast) > 1 else ""
        yield (
            f"Reynolds number above 2e5 ({row.label}: {row.reynolds:.1e}{others}): "
            "the drag coefficient needs a look."
        )


def _bight(result: Result, solution: Solution) -> Iterator[str]:
    pieces, force = solution.element_piece, solution.force[1:, 2]
    hanging = pieces[(force < 0.0) & (solution.element_clamp < 0)]
    if len(hanging):
        yield (
            f"The line hangs in a bight: at {result.components.label[hanging[0]]} it rises "
            "towards the anchor."
        )


def _on_the_seabed(result: Result, solution: Solution) -> Iterator[str]:
    lying = solution.element_piece[solution.hanging :]
    rigid = [p for p in dict.fromkeys(lying.tolist()) if not solution.line.flexible[p]]
    clamps = [m for m in solution.element_clamp[solution.hanging :].tolist() if m >= 0]
    known = [clamp.label for clamp in clamps_in(result.file.pieces)]
    names = [result.components.label[p] for p in rigid] + [known[m] for m in clamps]
    if names:
        yield f"On the seabed: {', '.join(names)}."
    if solution.landed and result.still_shape is result.shape:
        yield "In still water the part on the seabed has no direction: the offset is its greatest."


def _other_equilibrium(_: Result | TowResult, solution: Solution) -> Iterator[str]:
    if solution.other_depth is not None:
        yield (
            "Another equilibrium exists with the free end near "
            f"{solution.other_depth:.0f} m: the current changes with depth."
        )


def _hull_unknown(result: Result, solution: Solution) -> Iterator[str]:
    """A float that has no draft is taken as just immersed, or dragged as its `k_surface` has it."""
    riding, told = solution.riding, result.file.solver.buoy_drag == "immersed"
    if solution.surface and told and (riding is None or np.isnan(riding.draft)):
        afloat = [result.components.label[piece] for piece in solution.afloat]
        reason = (
            "gives no hull, or no mass or volume for one"
            if len(afloat) == 1
            else "are several floats at the surface"
        )
        taken = "just immersed" if riding is None else "dragged by its `k_surface`"
        yield f"{', '.join(afloat)} {reason}: {taken}, without a draft."


def _wind_ignored(result: Result, solution: Solution) -> Iterator[str]:
    wind = result.file.environment.wind
    if wind is not None and solution.surface and solution.riding is None:
        yield "The wind on the float is not taken into account: it is taken as just immersed."


def _below_the_sea(result: TowResult, _: Solution) -> Iterator[str]:
    lowest = float(result.shape.depth.max())
    tow = result.tow
    if tow.towing.in_air and tow.towing.height > 0.0 and lowest > 0.0:
        yield f"The line reaches {lowest:.1f} m below the sea, but all of it is taken as in air."


def _strums_along_the_flow(result: TowResult, solution: Solution) -> Iterator[str]:
    law = solution.line.strumming
    if law is None or result.strumming is None:
        return
    current, _ = solution.water.at(-solution.position[:-1, 2])
    speed = np.linalg.norm(current, axis=1)
    sine = np.divide(flow_across(solution), speed, out=np.ones(len(speed)), where=speed > 0)
    cables = solution.line.diameter[solution.element_piece] > 0.0
    least = np.degrees(np.arcsin(np.min(sine[cables & (solution.cut > 0.0)], initial=1.0)))
    if least < np.degrees(law.LEAST_ANGLE):
        yield (
            f"The cable comes within {least:.1f} degrees of the flow: its drag at rest, "
            f"C0 = {law.rest:g}, is only claimed above 15 degrees."
        )


_WORRIES: tuple[Callable[[Result | TowResult, Solution], Iterator[str]], ...] = (
    _overloaded,
    _tilted,
    _stiffness_unknown,
    _overstretched,
    _fast_flow,
    _other_equilibrium,
)
_MOORING_WORRIES: tuple[Callable[[Result, Solution], Iterator[str]], ...] = (
    _anchor_too_light,
    _bight,
    _on_the_seabed,
    _hull_unknown,
    _wind_ignored,
)
_TOW_WORRIES: tuple[Callable[[TowResult, Solution], Iterator[str]], ...] = (
    _below_the_sea,
    _strums_along_the_flow,
)
