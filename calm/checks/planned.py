"""Rule that compares the depths of instruments in still water with their planned depths."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import isnan

import numpy as np

from calm.case.leg_result import LegResult
from calm.case.result_tables import ClampRow, ComponentRow
from calm.checks.assessment import Handling
from calm.checks.criterion import cited
from calm.checks.finding import State, Verdict, at_most, rule, verdict_on
from calm.files import MooringFile
from calm.quantities import say

SHARE_OF_THE_PLAN = 0.02
"""Depth error always allowed for stretch and sounding, as a fraction of the planned depth."""


@dataclass(frozen=True)
class PlannedPart:
    """Piece or clamp with a planned depth [m].

    `least` and `most` are bounds on the depth in still water. The bounds differ only if the line is
    slack in still water. Then `least` is the depth in the current, and `most` the depth on a line
    that hangs straight down from the surface.
    """

    row: ComponentRow | ClampRow
    planned: float
    least: float
    most: float

    @property
    def off(self) -> float:
        """Depth error [m], positive if too deep; 0 if `planned` is between `least` and `most`."""
        return min(max(self.planned, self.least), self.most) - self.planned


def _judge(handling: Handling) -> Iterator[Verdict]:
    if handling.result is None:
        return
    parts, found = _judged(handling.result)
    if not parts:
        message = "No piece or clamp has a planned depth."
        remedy = "Set a `planned_depth`, or put the depth in the label, such as `meter 200 m`."
        yield verdict_on(None, State.NOT_JUDGED, message, remedy)
    elif _off_alike(handling.result, parts, found):
        # a single wrong value explains all errors, so the parts share one finding
        yield _common_verdict(handling.result, parts, min(found, key=lambda one: one.rank))
    else:
        yield from found


def _counted(handling: Handling) -> Iterator[Verdict]:
    if handling.result is not None:
        # both are needed: in a sample, the parts may be off by the same amount when those of the
        # design are not, and vice versa
        yield from _judged(handling.result)[1]
        yield from (one for one in _judge(handling) if one.place is None)


planned_depth = replace(rule("planned-depth", once=True, case="0")(_judge), counted=_counted)


def _judged(result: LegResult) -> tuple[list[PlannedPart], list[Verdict]]:
    parts = planned_parts(result)
    return parts, [
        _verdict(result.file, part, _remedy(result, parts, number))
        for number, part in enumerate(parts)
    ]


def _off_alike(result: LegResult, parts: list[PlannedPart], found: list[Verdict]) -> bool:
    amounts = [part.off for part in parts]
    alike = max(amounts) - min(amounts) <= result.file.checks.planned_depth_warning
    return len(parts) > 1 and alike and any(one.state is not State.PASS for one in found)


def planned_parts(result: LegResult) -> list[PlannedPart]:
    """Return the pieces and clamps that have a planned depth, from the top down."""
    length = result.components.length
    above = np.cumsum(length) - length
    found = []
    for row in (*result.components, *result.clamps):
        planned = row.part.planned_depth
        if planned is None:
            continue
        depth = row.upper[0]
        still = depth - row.knockdown
        if not isnan(still):
            found.append(PlannedPart(row, planned, still, still))
        else:
            straight = depth
            if result.type == "surface":
                at = row.part.at if isinstance(row, ClampRow) else 0.0
                straight = max(depth, float(above[row.index]) + at)
            found.append(PlannedPart(row, planned, depth, straight))
    return sorted(found, key=lambda part: (part.row.index, part.row.upper[0]))


def _verdict(file: MooringFile, part: PlannedPart, remedy: str) -> Verdict:
    checks, off = file.checks, part.off
    allowed = max(checks.planned_depth_warning, SHARE_OF_THE_PLAN * part.planned)
    limit = max(allowed, checks.planned_depth_limit * part.planned)
    beyond, most = (State.FAIL, limit) if abs(off) > limit else (State.WARN, allowed)
    where = say("depth", part.planned + off)
    planned = say("depth", part.planned)
    message = f"{part.row.label} is at {where} in still water; its planned depth is {planned}"
    if abs(off) > allowed:
        message += f" ({_amount(off, off)})"
    source = cited(file, "planned_depth_warning", "planned_depth_limit")
    return at_most(part.row, abs(off), most, f"{message}.", remedy, beyond, source)


def _common_verdict(result: LegResult, parts: Sequence[PlannedPart], worst: Verdict) -> Verdict:
    amounts = sorted((part.off for part in parts), key=abs)
    message = f"All {len(parts)} parts with a planned depth are "
    message += f"{_amount(amounts[0], amounts[-1])} in still water."
    remedy = f"Check `depth`, and the lengths below {parts[-1].row.label}."
    if {_hangs_from_above(result, part) for part in parts} == {True}:
        remedy = f"Check the lengths above {parts[0].row.label}, and `top_depth` if it is set."
    return verdict_on(
        None, worst.state, message, remedy, worst.value, worst.limit, worst.sense, worst.source
    )


def _amount(least: float, most: float) -> str:
    direction = "too deep" if most > 0.0 else "too shallow"
    shown = dict.fromkeys(say("depth", abs(each)) for each in (least, most))
    return f"{' to '.join(shown)} {direction}"


def _remedy(result: LegResult, parts: Sequence[PlannedPart], number: int) -> str:
    """Name the lengths to check for a part that is off its planned depth.

    The other parts are compared one by one, from this part towards the anchor or the surface. The
    lengths to check lie between the first two neighbours whose depth errors differ.
    """
    above, allowed = (
        _hangs_from_above(result, parts[number]), result.file.checks.planned_depth_warning
    )  # fmt: skip
    last = parts[number]
    for part in reversed(parts[:number]) if above else parts[number + 1 :]:
        if abs(part.off - parts[number].off) > allowed:
            first, second = (part, last) if above else (last, part)
            clamps = any(isinstance(one.row, ClampRow) for one in (first, second))
            what = "lengths and clamp positions" if clamps else "lengths"
            return f"Check the {what} between {first.row.label} and {second.row.label}."
        last = part
    if above:
        return f"Check the planned depth of {last.row.label}, and the lengths above it."
    return f"Check `depth`, the planned depth of {last.row.label}, and the lengths below it."


def _hangs_from_above(result: LegResult, part: PlannedPart) -> bool:
    """Return whether the lengths above a part determine its depth.

    This is so below a float at the surface, and above a piece that is cut to fit the top depth.
    """
    if result.type == "surface":
        return True
    fitted = [one.index for one in result.file.pieces if one.fit_top_depth is not None]
    return any(part.row.index <= index for index in fitted)
