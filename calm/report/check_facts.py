"""Key figures of a design check for its JSON document."""

from dataclasses import dataclass
from math import hypot
from typing import Any

import numpy as np

from calm.checks.assessment import Assessment
from calm.checks.finding import State, governing
from calm.report import check_tables, provenance
from calm.report.result_files import members


@dataclass(frozen=True)
class StrongestCurrent:
    """Strongest current in all environments, and a warning if the strongest current is weak."""

    speed: float
    depth: float
    environment: str
    weak: str


@dataclass(frozen=True)
class LeastFactor:
    """Minimum safety factor over all environments, and the piece with this factor.

    The safety factor is the breaking load divided by the tension. `unknown` is the number of pieces
    without a breaking load.
    """

    factor: float
    component: str
    environment: str
    situation: str
    unknown: int


def key_figures(assessment: Assessment) -> dict[str, Any]:
    """Return the key figures as a JSON object, in SI units; unknown values are None."""
    every = [*assessment.every_finding()]
    anchors = [one for one in every if one.rule == "anchor-weight" and one.value is not None]
    anchor = None
    if anchors:
        worst = governing(anchors)
        names = "component", "environment", "situation", "case", "margin", "utilisation"
        anchor = members(worst, *names)
        anchor |= {"weight": worst.value, "required_weight": worst.limit}
    counts, factor = check_tables.counted_states(every), least_factor(assessment)
    return {
        "verdict": assessment.verdict,
        "draft": assessment.draft,
        "sha256": provenance.input_hash([one.leg.file for one in assessment.in_environments]),
        "strongest_current": vars(strongest_current(assessment)),
        "anchor": anchor,
        "least_safety_factor": factor and vars(factor),
        "counts": {state.value: counts[state] for state in State},
        "departures": [key.name for key in assessment.limits if key.departs],
    }


def strongest_current(assessment: Assessment) -> StrongestCurrent:
    """Find the strongest current in all environments."""
    found = []
    for checked in assessment.in_environments:
        water = checked.leg.water
        level = int(np.hypot(water.u, water.v).argmax())
        speed = hypot(water.u[level], water.v[level])
        found.append((speed, float(water.level[level]), checked.environment))
    currents = (one for one in assessment.all_findings() if one.rule == "current")
    weak = [one.message for one in currents if one.state is State.WARN and one.limit is not None]
    return StrongestCurrent(*max(found, key=lambda each: each[0]), " ".join(weak))


def least_factor(assessment: Assessment) -> LeastFactor | None:
    """Find the minimum safety factor over all situations; None if no piece has a breaking load."""
    found = []
    for checked, situation in (
        (one, each) for one in assessment.in_environments for each in one.situations
    ):
        if situation.result is None:
            continue
        pieces = situation.result.components
        factors = np.asarray(pieces.safety_factor, np.float64)
        if not np.isnan(factors).all():
            row, unknown = int(np.nanargmin(factors)), int(np.isnan(factors[:-1]).sum())
            at = pieces.label[row], checked.environment, situation.name
            found.append(LeastFactor(float(factors[row]), *at, unknown))
    return min(found, key=lambda each: each.factor, default=None)
