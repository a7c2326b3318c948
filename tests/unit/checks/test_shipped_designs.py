"""The moorings that ship, those of the literature apart, stand the design check."""

from collections import Counter

import pytest

from calm.checks.finding import State
from tests.judged import LINES, judged

QUICK = ("receiver-line", "chain-and-rope-surface", "thermistor-string", "compact-adcp")
LONG = (
    "deep-current-meters",
    "fit-top-depth",
    "profiler-mooring",
    "s-tether",
    "sediment-trap-undercurrent",
    "tall-array-mooring",
    "taut-nylon-surface",
    "tidal-adcp",
    "upward-adcp-300m",
    "veering-current",
)
LITERATURE = ("braconnot-buoy", "cdms-1", "s1000")


def test_every_mooring_is_judged_here() -> None:
    files = sorted(LINES.glob("*.yaml"))
    moorings = [path.stem for path in files if "\ntow:" not in path.read_text(encoding="utf-8")]
    assert set(moorings) <= {*QUICK, *LONG, *LITERATURE}


@pytest.mark.parametrize(
    "name", [*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in LONG)]
)
def test_nothing_fails_and_nothing_is_unknown(name: str) -> None:
    environments = {"fit-top-depth": ("still", "storm"), "tidal-adcp": ("ebb", "neaps")}
    assessment = judged(LINES / f"{name}.yaml", *environments.get(name, ()))
    states = Counter(finding.state.value for finding in assessment.findings)
    assert states["fail"] == 0
    assert states["unknown"] == 0
    assert states["accepted"] + states["estimated"] >= 1
    accepts = [one.accept for one in assessment.accepted_findings() if one.accept is not None]
    assert {one.by for one in accepts} <= {"EXAMPLE"}
    # every accept is needed
    assert not [notice for notice in assessment.notices if "not needed" in notice]


# Published cases give no loads or ratings, and CDMS-1 an anchor lighter than CALM asks for.
@pytest.mark.parametrize("name", LITERATURE)
def test_what_a_published_case_leaves_open_is_accepted_as_an_example(name: str) -> None:
    assessment = judged(LINES / f"{name}.yaml")
    assert not any(one.state is State.UNKNOWN for one in assessment.all_findings())
    assert {one.accept.by for one in assessment.accepted_findings() if one.accept} == {"EXAMPLE"}
