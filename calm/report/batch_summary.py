"""Statistics of a batch as JSON and as tables."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.batch.statistics import summary as statistics
from calm.batch.statistics.extremes import Fit, LevelsRefused
from calm.batch.statistics.limits import Exceedance, RuleShare
from calm.batch.statistics.summary import PERCENTILES, Distribution, Response, Summary, WorstProfile
from calm.checks.finding import State
from calm.report.blocks import Cell, Field, Table, number, quantity, table_of, words
from calm.report.check_files import limit_document
from calm.report.result_files import members
from calm.version import __version__


def summary_document(summary: Summary) -> dict[str, Any]:
    """Return the JSON object of a batch summary.

    Values are in SI units and degrees, times in UTC, and rates are fractions of 1. Unknown values
    are null. Less obvious keys are:

    - `components`, `clamps`: distributions of values
    - `rules`, `limits`: frequency of violations
    - `responses`: exceedance curves and return levels of the line as a whole
    """

    def part_documents(*, clamped: bool) -> list[dict[str, Any]]:
        return [
            {"label": part.label}
            | {
                name: _distribution(getattr(part, name))
                for name in ("knockdown", "tilt", "tension")
            }
            for part in summary.parts
            if part.clamped is clamped
        ]

    return {
        "calm": __version__,
        "name": summary.name,
        **summary.source,
        "read": list(summary.read),
        "profiles": {
            "count": summary.count,
            **{ending.name.lower(): count for ending, count in summary.endings.items()},
            "statuses": dict(summary.statuses),
            "begin": _time(summary.begin),
            "end": _time(summary.end),
            "years": summary.years,
        },
        "components": part_documents(clamped=False),
        "clamps": part_documents(clamped=True),
        **({"profiler_stops": [vars(one) for one in summary.stops]} if summary.stops else {}),
        "rules": [_rule(rule) for rule in summary.rules],
        "limits": [_limit(rule, one) for rule in summary.rules for one in rule.exceedances],
        "limits_used": [limit_document(key) for key in summary.limits_used],
        "not_judged": dict(summary.not_judged),
        "responses": {response.name: _response(response) for response in summary.responses},
        "worst": {
            name: [asdict(profile) | {"time": _time(profile.time)} for profile in profiles]
            for name, profiles in summary.worst.items()
        },
    }


def _distribution(one: Distribution | None) -> dict[str, Any] | None:
    if one is None:
        return None
    names = (f"p{percentile:g}" for percentile in PERCENTILES)
    percentiles = dict(zip(names, one.percentiles, strict=True))
    ends = {"maximum": one.maximum, "time": _time(one.time)}
    return {**members(one, "count", "mean"), **percentiles, **ends}


def _response(response: Response) -> dict[str, Any]:
    one = response.distribution
    curve = one and {"share": one.share.tolist(), "value": one.value.tolist()}
    return {
        "distribution": _distribution(one),
        "exceedance": curve,
        "return_levels": {fit.method: _fit(fit) for fit in response.return_levels},
    }


def _fit(fit: Fit | LevelsRefused) -> dict[str, Any]:
    message = asdict(fit)
    del message["method"]
    return {"refused": message["reason"]} if isinstance(fit, LevelsRefused) else message


def _rule(rule: RuleShare) -> dict[str, Any]:
    return {
        "rule": rule.name,
        **members(rule, "judged", "fails", "fails_at_most", "warns"),
        "limits": len(rule.exceedances),
        "unknown": rule.unknown,
    }


def _limit(rule: RuleShare, one: Exceedance) -> dict[str, Any]:
    criterion = one.limit.criterion
    return {
        "rule": rule.name,
        "component": criterion.part.label,
        "quantity": one.limit.rule.quantity,
        "limit": criterion.limit,
        "bound": "at least" if criterion.least else "at most",
        "beyond": criterion.beyond.value,
        "judged": one.count,
        **members(one, "share", "worst"),
        "time": _time(one.time),
    }


def _time(time: np.datetime64 | None) -> str | None:
    return None if time is None else f"{np.datetime_as_string(time, unit='s')}Z"


def rules_table(summary: Summary) -> Table:
    """Tabulate the fraction of profiles in which each rule fails or warns."""

    def broken(heading: str, name: str, state: State, unit: str = "%") -> Field:
        def cell(rule: RuleShare) -> Cell:
            share = getattr(rule, name)
            return Cell(percent(share), state=state if share else None)

        return number(heading, cell, unit)

    return table_of(
        "Failure rates",
        summary.rules,
        words("rule", "title"),
        number("judged in", lambda rule: grouped(rule.judged), "profiles", narrow=False),
        broken("fails", "fails", State.FAIL, "% of profiles"),
        broken("at most", "fails_at_most", State.FAIL),
        broken("warns", "warns", State.WARN),
        number("limits", lambda rule: len(rule.exceedances), narrow=False),
        words("most often exceeded by", _most_exceeded),
        note="Shares refer to the profiles in which a rule is judged. “At most” also counts every "
        "profile with a current that was not solved. A limit counts as unknown if it could not be "
        "judged in any profile.",
    )


def _most_exceeded(rule: RuleShare) -> str:
    most = max(rule.exceedances, key=lambda one: one.share or 0.0, default=None)
    worst = ""
    if most and most.share:
        worst = f"{most.limit.criterion.part.label}, {percent(most.share)} %"
    unknown = f"{rule.unknown} unknown" if rule.unknown else ""
    return "; ".join(filter(None, (worst, unknown)))


def profiles_table(title: str, profiles: Sequence[tuple[str, WorstProfile]]) -> Table:
    """Tabulate profiles with their responses.

    `profiles` are pairs of a text and a profile. The text is empty, or is the response for which
    the profile is the worst.
    """

    def response(name: str) -> Field:
        column, cell = quantity(QUANTITY[name], lambda row: getattr(row[1], name), TITLES[name])
        return replace(column, short=name.replace("_", " "), marked=False), cell

    return table_of(
        title,
        profiles,
        words("worst profile by", lambda row: row[0].replace("_", " ")),
        words("time", lambda row: when(row[1].time), 0.0),
        *map(response, TITLES),
        words("tilts most", lambda row: row[1].leaning, narrow=False),
    )


TITLES = {
    "knockdown": "knockdown of the top",
    "anchor_tension": "tension at the anchor",
    "tilt": "maximum tilt",
    "offset": "offset of the top",
}
"""Titles of the responses, by name."""

QUANTITY = {name: name for name in TITLES} | {"anchor_tension": "tension"}
"""Name of each response's quantity in `calm.quantities`."""

METHODS_IN_SHORT = {"gev": "GEV", "pot": "POT"}

DEFINITIONS = (
    "All profiles have the same weight, so shares of the profiles are shares of the time only if "
    "the record is evenly spaced. Means, percentiles, maxima and exceedance curves cover the "
    "solved profiles. Failure rates refer to the profiles in which a rule is judged; the upper "
    "bound (“at most”) also counts every profile with a current that was not solved.",
    "Percentiles are interpolated linearly between the sorted values: of n values, the p quantile "
    "has rank 1 + (n - 1) p. The tension of a component is the larger of the tensions at its two "
    "ends; its knockdown and depth are those of its upper end.",
)
"""Definitions of the statistics, printed with the tables."""


def when(time: np.datetime64 | NDArray[np.datetime64] | None) -> str:
    """Format a time to the minute; None becomes a dash."""
    return "-" if time is None else str(np.datetime_as_string(time, unit="m")).replace("T", " ")


def percent(share: float | None) -> str:
    """Format a fraction in percent; positive values are never shown as 0."""
    if share is None:
        return "-"
    if 0.0 < share < 5e-5:
        return "<0.01"
    return f"{100.0 * share:.2f}"


def grouped(count: int) -> str:
    """Format a number of profiles with a thousands separator."""
    return f"{count:,}".replace(",", "\u00a0")


def extent(summary: Summary) -> str:
    """Format the number of profiles, and their first and last time."""
    return (
        f"{grouped(summary.count)} profiles, {when(summary.begin)} to {when(summary.end)}, "
        f"{summary.years:.2f} years solved"
    )


def status_counts(summary: Summary) -> str:
    """Format the number of profiles for each status of the solver."""
    ended = (f"{grouped(count)} {status}" for status, count in summary.statuses.items())
    return ", ".join(ended)


def left_out(summary: Summary) -> str:
    """Return a sentence on profiles without a solution, which are excluded from all statistics."""
    if not summary.unsolved:
        return ""
    with_current = summary.solved + summary.unsolved
    return (
        f"{grouped(summary.unsolved)} of {grouped(with_current)} profiles with a current "
        f"({percent(summary.unsolved / with_current)} %) have no solution and are excluded from "
        "all statistics. If the strongest currents are among these profiles, the statistics are "
        "too low."
    )


def refusals(summary: Summary) -> Iterator[str]:
    """Yield a text for each reason why return levels are missing.

    The text begins with the names of the responses, unless the reason applies to all responses.
    """
    reasons: dict[str, list[str]] = {}
    for response in summary.known_responses:
        for fit in response.return_levels:
            if isinstance(fit, LevelsRefused):
                method = METHODS_IN_SHORT[fit.method]
                message = f"no return levels by {method}: {fit.reason}"
                reasons.setdefault(message, []).append(TITLES[response.name])
    for message, of in reasons.items():
        yield message if len(of) == len(summary.known_responses) else f"{', '.join(of)}: {message}"


def stops_tables(summary: Summary) -> Iterator[Table]:
    """Tabulate percentiles of pressure [dbar] and depth [m] at each stop of a profiler."""
    if not summary.stops:
        return
    shares = (*(f"{share:g} %\ndbar" for share in statistics.STOP_SHARES),
              *(f"{share:g} %\nm" for share in statistics.STOP_SHARES))  # fmt: skip
    yield table_of(
        "Stops of profilers",
        [
            (one.profiler, one.stop, *(f"{each:.1f}" for each in (*one.pressures, *one.depths)))
            for one in summary.stops
        ],
        words("profiler", 0),
        words("stop", 1),
        *(number(head, at) for at, head in enumerate(shares, 2)),
        note="Each heading gives a share of the profiles. In this share, the stop is at the "
        "tabulated pressure and depth, or shallower.",
    )
