"""Utilisation, the governing finding, and what all findings of a mooring come to."""

from math import inf, isfinite

import pytest
from hypothesis import given
from hypothesis import strategies as st

from calm.checks.finding import (
    Conclusion,
    Finding,
    State,
    conclusion_of,
    governing,
    governing_of_each_rule,
    percent_used,
    worst_of,
    worst_state,
)

FIGURES = st.one_of(st.none(), st.floats(-1e6, 1e6))


@st.composite
def findings(draw: st.DrawFn) -> Finding:
    """A finding of any state and figures."""
    limit = draw(FIGURES)
    state = draw(st.sampled_from(State))
    return Finding(
        component=draw(st.sampled_from(["wire", "rope", None])),
        value=draw(FIGURES),
        limit=limit,
        sense=None if limit is None else draw(st.sampled_from(["<=", ">="])),
        state=state,
        message="",
        mooring="m",
        environment="own",
        rule=draw(st.sampled_from(["strength", "slack", "metals", "freeboard"])),
        unaccepted=draw(st.sampled_from([State.FAIL, State.UNKNOWN]))
        if state is State.ACCEPTED
        else None,
    )


@given(findings())
def test_a_value_beyond_its_limit_is_used_by_more_than_all(found: Finding) -> None:
    used, margin = found.utilisation, found.margin
    if used is not None:
        assert margin is not None and used >= 0.0
        if found.limit is not None and found.limit > 0.0:
            assert (used > 1.0) == (margin < 0.0) or used == pytest.approx(1.0)
    else:
        assert margin is None or found.limit == 0.0 or found.rule == "metals"


@given(st.lists(findings(), min_size=1))
def test_the_governing_use_is_the_greatest_of_all(found: list[Finding]) -> None:
    known = [one.utilisation for one in found if one.utilisation is not None]
    first = governing(found)
    assert first in found
    assert first.utilisation == (max(known) if known else None)
    if not known:
        assert first.state is worst_of(found).state
    for one in governing_of_each_rule(found):
        same = [each for each in found if each.rule == one.rule]
        assert one.utilisation == governing(same).utilisation


@given(st.lists(findings()))
def test_the_conclusion_is_that_of_the_gravest_state(found: list[Finding]) -> None:
    worst, conclusion = worst_state(one.state for one in found), conclusion_of(found)
    assert (conclusion is Conclusion.FAILS) == (worst is State.FAIL)
    assert (conclusion is Conclusion.INCOMPLETE) == (worst is State.UNKNOWN)
    if worst is State.NOT_JUDGED or not found:
        assert conclusion is Conclusion.PASSES
    accepted = [one for one in found if one.state is State.ACCEPTED]
    if any(one.unaccepted is State.FAIL or (one.utilisation or 0.0) > 1.0 for one in accepted):
        assert conclusion not in (Conclusion.PASSES, Conclusion.OPEN_ITEMS)


def _found(value: float, sense: str, limit: float, rule: str = "strength") -> Finding:
    return Finding(
        component="wire", value=value, limit=limit, sense=sense, state=State.PASS, message="",
        mooring="m", environment="own", rule=rule,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("found", "used", "percent"),
    [
        (_found(5311.0, "<=", 8830.0), 5311.0 / 8830.0, 61.0),  # demand is the value
        (_found(901.0, ">=", 1000.0), 1000.0 / 901.0, 111.0),  # demand is the limit
        (_found(100.0, "<=", 100.0), 1.0, 100.0),
        (_found(100.01, "<=", 100.0), 1.0001, 101.0),  # rounded up
        (_found(-20.0, "<=", 100.0), 0.0, 0.0),  # pulls the other way
        (_found(-20.0, ">=", 250.0), inf, inf),  # no capacity at all
        (_found(3.0, "<=", -1.0), inf, inf),
    ],
)
def test_utilisation_is_demand_over_capacity(found: Finding, used: float, percent: float) -> None:
    assert found.utilisation == pytest.approx(used)
    assert percent_used(found.utilisation or 0.0) == percent
    assert found.to_dict()["utilisation"] == (pytest.approx(used) if isfinite(used) else None)


def test_unlike_quantities_have_no_utilisation() -> None:
    assert _found(0.4, "<=", 0.2, "metals").utilisation is None
    assert _found(0.4, ">=", 0.0, "freeboard").utilisation is None


def test_order_of_the_states() -> None:
    order = [State.PASS, State.NOT_JUDGED, State.ACCEPTED, State.ESTIMATED, State.WARN,
             State.UNKNOWN, State.FAIL]  # fmt: skip
    assert sorted(State, key=lambda state: state.severity) == order
