"""Whether the line stays taut."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan
from typing import TYPE_CHECKING

from calm.case.warnings import is_synthetic
from calm.checks.finding import Verdict, at_least, rule
from calm.files import Cable
from calm.quantities import say

if TYPE_CHECKING:
    from calm.case import Result


@rule("slack")
def slack(result: Result) -> Iterator[Verdict]:
    """The least tension in every wire and rope above the release; of the whole line without one.

    A line that falls slack wears, kinks and snatches. Mooring groups ask for some 500 to 1000 N
    above the release at slack water; no rule is published, so 500 N of wire and 300 N of rope are
    the defaults. A piece with ``slack: allowed`` is not judged, nor what lies on the seabed.
    """
    file = result.file
    lowest = len(file.pieces) - 1 if file.release is None else file.release
    limits = file.checks.minimum_tension
    for row, piece in zip(result.components, file.pieces[:lowest], strict=False):
        if not isinstance(piece.component, Cable) or piece.component.slack == "allowed":
            continue
        if isnan(row.least_tension):
            continue
        rope = is_synthetic(piece.component)
        limit = limits.rope if rope else limits.wire
        yield at_least(
            row,
            row.least_tension,
            limit,
            f"{row.label} bears no more than {say('tension', row.least_tension)} at its slackest; "
            f"{say('tension', limit)} keep a {'rope' if rope else 'wire'} taut.",
            "Add buoyancy above it, or take weight off; `slack: allowed` exempts a piece.",
        )
