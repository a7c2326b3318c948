"""Governing checks in the moorings of `lines/`: utilisation, sense, load case and conclusion."""

import re
from dataclasses import fields, replace
from functools import cache
from pathlib import Path

import pytest

from calm import check, load
from calm.checks.assessment import EXAMPLE, Assessment
from calm.checks.finding import Conclusion, Finding, State, governing
from calm.errors import InputError
from calm.files.rule_texts import RULES

LINES = Path(__file__).resolve().parents[3] / "lines"
NAMES = ["upward-adcp-300m", "taut-nylon-surface", "profiler-mooring", "tidal-adcp"]


@cache
def _judged(name: str) -> Assessment:
    return check(load(LINES / f"{name}.yaml"))


@pytest.mark.parametrize("name", NAMES)
def test_every_limit_has_a_sense_and_every_finding_in_an_environment_a_case(name: str) -> None:
    for one in _judged(name).every_finding():
        assert (one.sense is None) == (one.limit is None), one
        if one.case is None:
            assert RULES[one.rule].quantity in ("", "potential"), one
        else:
            assert re.fullmatch(r"0l?|L|R|B|d|\d+[sghldpqw]?", one.case), one


@pytest.mark.parametrize("name", NAMES)
def test_governing_use_is_that_of_every_situation_solved(name: str) -> None:
    """Every piece in every situation, from the results and not from the findings."""
    found = [one for one in _judged(name).every_finding() if one.rule == "tilt"]
    every = [
        (row.tilt, limit)
        for stand in _judged(name).in_environments
        for situation in stand.situations
        if situation.result is not None
        for row in (*situation.result.components, *situation.result.clamps)
        if row.part.component.role in ("instrument", "release") or row.part.component.max_tilt
        for limit in (
            row.part.component.max_tilt,
            row.part.component.warn_tilt,
            situation.result.file.checks.maximum_tilt,
        )
        if limit is not None
    ]
    expected = max(tilt / limit for tilt, limit in every)
    assert governing(found).utilisation == pytest.approx(expected)


def test_a_changed_copy_is_that_of_dataclasses_and_has_a_utilisation_of_its_own() -> None:
    found = next(one for one in _judged("tidal-adcp").every_finding() if one.rule == "tilt")
    assert found.value is not None and found.utilisation is not None
    copy = found.but(value=2.0 * found.value, case="9w")
    assert copy == replace(found, value=2.0 * found.value, case="9w")
    assert copy.utilisation == pytest.approx(2.0 * found.utilisation)


def test_a_rule_sets_every_field_of_its_finding() -> None:
    for one in _judged("tidal-adcp").every_finding():
        assert {*vars(one)} - {"utilisation"} == {each.name for each in fields(Finding)}


def test_the_governing_finding_is_not_that_of_the_least_margin() -> None:
    """Figures of `deep-current-meters`: a release pair with 3.7 kN left, a rope with 7.1 kN."""

    def strength(component: str, tension: float, limit: float) -> Finding:
        return Finding(
            component=component, value=tension, limit=limit, sense="<=", state=State.PASS,
            message="", mooring="m", environment="own", rule="strength",
        )  # fmt: skip

    pair, rope = strength("releases", 5129.0, 8830.0), strength("parafil", 12870.0, 20000.0)
    assert (pair.margin or 0.0) < (rope.margin or 0.0)
    assert governing([pair, rope]) is rope


def test_a_rule_without_a_limit_is_not_judged() -> None:
    found = [*_judged("upward-adcp-300m").all_findings()]
    grips = [one for one in found if one.rule == "clamp-grip"]
    assert {one.state for one in grips} == {State.NOT_JUDGED}
    assert all(one.limit is one.utilisation is None and one.value for one in grips)
    surface = [*_judged("taut-nylon-surface").all_findings()]
    assert {one.state for one in surface if one.rule in ("scope", "watch-circle")} == {
        State.NOT_JUDGED
    }


_LINE = """
name: Proof load
environment: {depth: 100 m, current: {speed: 0.3 m/s, toward: 90 deg}}
components:
  frame: {kind: body, role: instrument, length: 1 m, mass: 20 kg, buoyancy: -100 N,
    drag_area: 0.1 m^2, cd: 1, depth_rating: 500 m, max_tilt: 30 deg, source: test}
line:
  - {use: sphere-steel-1250}
  - {use: frame, label: frame}
  - {use: wire-jacketed-8, length: 60 m}
  - {use: glass-17in, count: 6, length: 0.5 m}
  - {use: release-ar861}
  - {use: anchor-wheels-4}
"""


def _accepting(folder: Path, accept: str) -> tuple[Assessment, Finding]:
    path = folder / "line.yaml"
    path.write_text(_LINE + f"checks:\n  accept:\n    - {accept}\n", encoding="utf-8")
    judged = check(load(path))
    (found,) = [
        one
        for one in judged.all_findings()
        if one.component == "frame"
        and "strength" in (one.rule, *(one.missing.needed_by if one.missing else ()))
    ]
    return judged, found


def test_an_accepted_load_is_the_limit_of_what_has_none(tmp_path: Path) -> None:
    accept = "{rule: strength, component: frame, reason: proof-loaded, by: EXAMPLE, load: 25 kN}"
    judged, found = _accepting(tmp_path, accept)
    assert found.state is State.ACCEPTED and found.unaccepted is State.UNKNOWN
    assert found.limit == 25e3 and found.sense == "<="
    assert found.utilisation == pytest.approx((found.value or 0.0) / 25e3)
    assert judged.draft and found.accept is not None and found.accept.by == EXAMPLE
    _, plain = _accepting(tmp_path, accept.replace(", load: 25 kN", ""))
    assert plain.state is State.ACCEPTED and plain.utilisation is None
    signed, _ = _accepting(tmp_path, accept.replace("EXAMPLE", "A. Martin"))
    assert not signed.draft


def test_a_tension_beyond_the_accepted_load_is_not_accepted(tmp_path: Path) -> None:
    accept = "{rule: missing, component: frame, reason: proof-loaded, by: EXAMPLE, load: 1 kN}"
    _, found = _accepting(tmp_path, accept)
    assert found.state is State.UNKNOWN
    assert "of the file allows at most 1.00 kN" in found.message


def test_an_accepted_failure_passes_by_acceptance(tmp_path: Path) -> None:
    path = tmp_path / "line.yaml"
    text = (LINES / "upward-adcp-300m.yaml").read_text(encoding="utf-8")
    assert _judged("tidal-adcp").verdict is Conclusion.OPEN_ITEMS
    # a swivel that bears 126 % of its load by an estimate, which is accepted
    assert _judged("upward-adcp-300m").verdict is Conclusion.BY_ACCEPTANCE
    tight = text.replace("maximum_knockdown: 25 m", "maximum_knockdown: 1 m")
    path.write_text(tight, encoding="utf-8")
    assert check(load(path)).verdict is Conclusion.FAILS
    accept = "  accept:\n    - {rule: knockdown, reason: tried, by: A. Martin}\n"
    path.write_text(tight.replace("  accept:\n", accept), encoding="utf-8")
    judged = check(load(path))
    assert judged.verdict is Conclusion.BY_ACCEPTANCE
    (found,) = [one for one in judged.accepted_findings() if one.rule == "knockdown"]
    assert found.unaccepted is State.FAIL and (found.utilisation or 0.0) > 10.0


def test_a_load_is_refused_where_no_tension_is_judged(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="`load` is a tension, but the rule `tilt` does not"):
        _accepting(tmp_path, "{rule: tilt, reason: tried, load: 1 kN}")
