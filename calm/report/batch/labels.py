"""Names, times and shares as the reports of a batch write them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from calm.batch.statistics.extremes import LevelsRefused
from calm.batch.statistics.summary import Summary

TITLES = {
    "knockdown": "knockdown of the top",
    "anchor_tension": "tension at the anchor",
    "tilt": "greatest tilt",
    "offset": "offset of the top",
}
"""Of the responses, by their names."""

QUANTITY = {
    "knockdown": "knockdown",
    "anchor_tension": "tension",
    "tilt": "tilt",
    "offset": "offset",
}
"""Of a response, in `calm.quantities`."""

METHODS_IN_SHORT = {"gev": "GEV", "pot": "POT"}

DEFINITIONS = (
    "Every profile counts alike: a share of the profiles is a share of the time where the record "
    "is even. Means, percentiles, maxima and exceedance curves are of the profiles solved. A rule "
    "fails in a share of the profiles in which it is judged; at most in that share which counts as "
    "failing every profile with a current that was not solved.",
    "Percentiles: linear between the order statistics; the value of rank 1 + (n - 1) p of n is "
    "the p quantile. Tension of a component: the greater of those at its ends. Knockdown and "
    "depth of a component: of its upper end.",
)
"""What must be known to read the figures."""


def when(time: np.datetime64 | NDArray[np.datetime64] | None) -> str:
    """A time to the minute, in words; a dash where there is none."""
    return "-" if time is None else str(np.datetime_as_string(time, unit="m")).replace("T", " ")


def percent(share: float | None) -> str:
    """A share in percent; one above zero is not written as 0."""
    if share is None:
        return "-"
    if 0.0 < share < 5e-5:
        return "<0.01"
    return f"{100.0 * share:.2f}"


def grouped(count: int) -> str:
    """A number of profiles, its thousands apart."""
    return f"{count:,}".replace(",", "\u00a0")


def extent(summary: Summary) -> str:
    """How many profiles there are, and from when to when."""
    return (
        f"{grouped(summary.count)} profiles, {when(summary.begin)} to {when(summary.end)}, "
        f"{summary.years:.2f} years solved"
    )


def standing(summary: Summary) -> str:
    """How the profiles ended, by their status."""
    ended = (f"{grouped(count)} {status}" for status, count in summary.statuses.items())
    return ", ".join(ended)


def left_out(summary: Summary) -> str:
    """How many profiles with a current were not solved, and what that does to figures, if any."""
    if not summary.unsolved:
        return ""
    with_current = summary.solved + summary.unsolved
    return (
        f"{grouped(summary.unsolved)} of {grouped(with_current)} profiles with a current "
        f"({percent(summary.unsolved / with_current)} %) were not solved. They are in none of the "
        "means, percentiles, maxima and curves; where they are the strongest currents, these are "
        "too low."
    )


def refusals(summary: Summary) -> Iterator[str]:
    """Why there are no return levels: each reason once, with the responses that it holds for."""
    reasons: dict[str, list[str]] = {}
    for response in summary.responses:
        for fit in response.return_levels:
            if isinstance(fit, LevelsRefused):
                said = f"no return levels by {METHODS_IN_SHORT[fit.method]}: {fit.reason}"
                reasons.setdefault(said, []).append(TITLES[response.name])
    for said, of in reasons.items():
        yield said if len(of) == len(summary.responses) else f"{', '.join(of)}: {said}"
