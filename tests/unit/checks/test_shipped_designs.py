"""The moorings that ship, those of the literature apart, stand the design check."""

from collections import Counter

import pytest

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
LITERATURE = ("bourget-marichal-sphere", "braconnot-buoy", "cdms-1", "s1000")


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
    assert all(
        finding.accept.reason for finding in assessment.findings if finding.accept is not None
    )
    # every accept is needed
    assert not [notice for notice in assessment.notices if "not needed" in notice]
