"""What `calm check` prints on a terminal: its order, its length, its signs, and the matrix."""

import io
import re
from functools import cache

import pytest
from rich.console import Console

from calm import check, load
from calm.checks.assessment import Assessment
from calm.checks.finding import Conclusion, State, governing_of_each_rule, percent_used
from calm.report.check_summary import MOST_LINES, check_part
from calm.report.terminal import bar_text, shown
from tests.judged import LINES

NAMES = [
    "upward-adcp-300m",
    "chain-and-rope-surface",
    "thermistor-string",
    "tidal-adcp",
    *(pytest.param(name, marks=pytest.mark.slow) for name in (
        "compact-adcp", "deep-current-meters", "fit-top-depth", "profiler-mooring",
        "receiver-line", "s-tether", "s1000", "sediment-trap-undercurrent", "tall-array-mooring",
        "taut-nylon-surface", "veering-current",
    )),
]  # fmt: skip


@cache
def _judged(name: str) -> Assessment:
    return check(load(LINES / f"{name}.yaml"))


def _text(*assessments: Assessment, plain: bool = False) -> list[str]:
    stream = io.StringIO()
    part = check_part(assessments)
    Console(file=stream, width=80, highlight=False).print(shown(part, plain=plain))
    return [line.rstrip() for line in stream.getvalue().splitlines()]


@pytest.mark.parametrize("name", NAMES)
def test_where_nothing_fails_it_fits_a_screen(name: str) -> None:
    assessment = _judged(name)
    lines = _text(assessment)
    assert assessment.verdict not in (Conclusion.FAILS, Conclusion.INCOMPLETE)
    assert len(lines) <= MOST_LINES and max(map(len, lines)) <= 80
    order = ["load case", "case, where", "Open items", "Not covered: "]
    places = [next(at for at, line in enumerate(lines) if text in line) for text in order]
    assert places == sorted(places)
    assert assessment.verdict.words.upper() in lines[1]
    assert ("DRAFT" in lines[1]) == assessment.draft


@pytest.mark.parametrize("name", NAMES)
def test_what_uses_more_than_half_of_its_limit_has_a_row(name: str) -> None:
    """The governing finding, with its sign, use and case; the rest is told by its greatest."""
    every = [*_judged(name).every_finding()]
    leads = [one for one in governing_of_each_rule(every) if one.utilisation is not None]
    lines = _text(_judged(name))
    uses = [one.utilisation or 0.0 for one in leads]
    bars = (re.search(r" (>?\d+) [█▒]* *\|", line) for line in lines)
    printed = [float(found[1].lstrip(">")) for found in bars if found]
    assert printed == sorted(printed, reverse=True)
    for one in leads:
        if (one.utilisation or 0.0) > 1.0:
            percent = min(percent_used(one.utilisation or 0.0), 999.0)
            assert percent in printed
    assert printed[0] == min(percent_used(max(uses)), 999.0)


def test_signs_of_ascii_stand_for_those_that_a_terminal_lacks() -> None:
    text = "\n".join(_text(_judged("upward-adcp-300m"), plain=True))
    assert text.isascii()
    assert "::::::::::|:::" in text and "########  |" in text and "<= 15.0 deg" in text


def test_bars_end_at_their_limit() -> None:
    assert bar_text(0.0, State.PASS) == "          |"
    assert bar_text(0.61, State.PASS) == "███████   |"
    assert bar_text(1.0, State.ESTIMATED) == "██████████|"
    assert bar_text(1.01, State.WARN) == "▒▒▒▒▒▒▒▒▒▒|▒"
    assert bar_text(9.0, State.FAIL) == "██████████|███"


def test_many_moorings_are_a_matrix() -> None:
    two = _judged("upward-adcp-300m"), _judged("tidal-adcp")
    lines = _text(*two)
    assert lines[0] == "DESIGN CHECK OF 2 MOORINGS IN 1 ENVIRONMENT: NOTHING FAILS"
    rows = {line[:18]: line.split()[-2:] for line in lines if "ADCP" in line}
    assert rows["Slope ADCP at 300 "] == ["73", "126~"]
    assert "! fails  ~ over 100, a warning or accepted  ? unknown" in lines
