"""Rule `drag-coefficient`: drag coefficients that are used outside their Reynolds range."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import hypot

from calm.case.design import Design
from calm.case.leg_result import LegResult
from calm.case.profilers import held
from calm.case.warnings import fast_pieces, fast_text
from calm.checks.finding import State, Verdict, rule, verdict_on
from calm.errors import NoEquilibrium
from calm.files import Piece
from calm.quantities import say

NOTICED = 1.05
"""Ratio of knockdowns above which the rule warns.

The ratio is the knockdown (or offset) with the drag curve of a smooth shape, divided by the value
with the specified drag coefficients.
"""

_LegVerdict = tuple[LegResult, Verdict]


@rule("drag-coefficient")
def drag_coefficient(results: Sequence[LegResult]) -> Iterator[_LegVerdict]:
    """Check that drag coefficients of spheres and cylinders are valid at their Reynolds numbers.

    The only verdict is on the Reynolds number that exceeds its range most, in any environment. The
    verdict is a warning if the drag curve of a smooth shape would increase the knockdown or offset
    by more than 5 %.
    """
    fast = [(result, fast_pieces(result)) for result in results]
    found = [(rows[0], result, rows) for result, rows in fast if rows]
    if not found:
        return
    (row, _), result, rows = max(found, key=lambda one: one[0][0].reynolds / one[0][1])
    effect, worse = _effect(result, {one.index for one, _ in rows})
    remedy = "Check the drag coefficient of this part."
    state = State.WARN if worse else State.NOT_JUDGED
    yield result, verdict_on(row.part, state, f"{fast_text(rows)}{effect}", remedy)


def _effect(result: LegResult, fast: set[int]) -> tuple[str, bool]:
    """Describe how the drag curve of a smooth shape would change the knockdown of the mooring.

    The drag curve is applied to the pieces with an index in `fast`. For a surface mooring, the
    change of the offset is described instead. Return the text, and whether the rule must warn.
    """
    file = result.file
    if file.solver.drag == "reynolds" or result.leg.of_several:
        return "", False
    solver = file.solver.model_copy(update={"drag": "reynolds"})
    pieces = tuple(_smooth(piece) if piece.index in fast else piece for piece in file.pieces)
    # profilers stay at their upper stops, as for the knockdown of the result
    other = held(replace(file, solver=solver, pieces=pieces))
    try:
        smooth = Design(other, result.leg.for_surface).solve().leg
    except NoEquilibrium as failure:
        text = (
            f" With the drag curve of a smooth shape, CALM found no equilibrium: {failure.status}."
        )
        return text, True
    name, before, after = "offset", _offset(result), _offset(smooth)
    down, then = result.top.knockdown, smooth.top.knockdown
    if result.type != "surface" and down is not None and then is not None:
        name, before, after = "knockdown", down, then
    changed = f"{say(name, after)} instead of {say(name, before)}"
    effect = f" With the drag curve of a smooth shape, the {name} would be {changed}."
    return effect, after > NOTICED * before


def _smooth(piece: Piece) -> Piece:
    own = dict.fromkeys(("cx", "cn", "ct", "kn", "kt"))
    given = {name: None for name in own if hasattr(piece.component, name)}
    component = piece.component.model_copy(update={"surface": "smooth", **given})
    return replace(piece, component=component)


def _offset(result: LegResult) -> float:
    return hypot(result.top.x, result.top.y)
