"""The statistics of a batch as JSON."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.batch.statistics.extremes import Fit, LevelsRefused
from calm.batch.statistics.summary import PERCENTILES
from calm.report.check.document import limit_document

if TYPE_CHECKING:
    from calm.batch.statistics.limits import Exceedance, RuleShare
    from calm.batch.statistics.summary import (
        Distribution,
        PartDistributions,
        Response,
        Summary,
        WorstProfile,
    )


def summary_document(summary: Summary) -> dict[str, Any]:
    """The JSON object of a summary: SI and degrees, times in UTC, shares of 1; null is unknown.

    Returns
    -------
    dict
        `profiles`, how many and how they ended; `components` and `clamps` with their
        distributions; `rules` and `limits`, how often each is broken, and `limits_used`, by which
        they judge; `responses` of the line as a whole with their exceedance curves and return
        levels; `worst` profiles of each response.
    """
    from calm.version import __version__

    parts = [(part.clamped, _part(part)) for part in summary.parts]
    return {
        "calm": __version__,
        "name": summary.name,
        **summary.source,
        "profiles": {
            "count": summary.count,
            **{ending.name.lower(): count for ending, count in summary.endings.items()},
            "statuses": dict(summary.statuses),
            "begin": _time(summary.begin),
            "end": _time(summary.end),
            "years": summary.years,
        },
        "components": [said for clamped, said in parts if not clamped],
        "clamps": [said for clamped, said in parts if clamped],
        "rules": [_rule(rule) for rule in summary.rules],
        "limits": [_limit(rule, one) for rule in summary.rules for one in rule.exceedances],
        "limits_used": [limit_document(key) for key in summary.limits_used],
        "not_judged": dict(summary.not_judged),
        "responses": {response.name: _response(response) for response in summary.responses},
        "worst": {
            name: [_profile(profile) for profile in profiles]
            for name, profiles in summary.worst.items()
        },
    }


def _part(part: PartDistributions) -> dict[str, Any]:
    return {
        "label": part.label,
        "knockdown": _distribution(part.knockdown),
        "tilt": _distribution(part.tilt),
        "tension": _distribution(part.tension),
    }


def _distribution(one: Distribution | None) -> dict[str, Any] | None:
    if one is None:
        return None
    percentiles = zip(PERCENTILES, one.percentiles, strict=True)
    return {
        "count": one.count,
        "mean": one.mean,
        **{f"p{percentile:g}": value for percentile, value in percentiles},
        "maximum": one.maximum,
        "time": _time(one.time),
    }


def _response(response: Response) -> dict[str, Any]:
    one = response.distribution
    return {
        "distribution": _distribution(one),
        "exceedance": None
        if one is None
        else {"share": one.share.tolist(), "value": one.value.tolist()},
        "return_levels": {fit.method: _fit(fit) for fit in response.return_levels},
    }


def _fit(fit: Fit | LevelsRefused) -> dict[str, Any]:
    said = asdict(fit)
    del said["method"]
    return {"refused": said["reason"]} if isinstance(fit, LevelsRefused) else said


def _rule(rule: RuleShare) -> dict[str, Any]:
    return {
        "rule": rule.name,
        "judged": rule.judged,
        "fails": rule.fails,
        "fails_at_most": rule.fails_at_most,
        "warns": rule.warns,
        "limits": len(rule.exceedances),
        "unknown": rule.unknown,
    }


def _limit(rule: RuleShare, one: Exceedance) -> dict[str, Any]:
    limit = one.limit
    return {
        "rule": rule.name,
        "component": limit.component,
        "quantity": limit.quantity,
        "limit": limit.limit,
        "bound": "at least" if limit.least else "at most",
        "beyond": limit.beyond.value,
        "judged": one.count,
        "share": one.share,
        "worst": one.worst,
        "time": _time(one.time),
    }


def _profile(profile: WorstProfile) -> dict[str, Any]:
    return asdict(profile) | {"time": _time(profile.time)}


def _time(time: np.datetime64 | None) -> str | None:
    return None if time is None else f"{np.datetime_as_string(time, unit='s')}Z"
