"""How many findings a verdict counts: a cluster of equal floats is one, unlike pieces are not."""

from dataclasses import replace

import pytest

from calm.checks.finding import Finding, State, governing
from calm.files import Place
from calm.report.check_tables import counted_states
from calm.report.open_items import _extreme, verdict_of


def _finding(component: str, place: Place, state: State = State.FAIL, **others: str) -> Finding:
    return Finding(
        component=component, place=place, state=state, value=983.2, limit=400.0, sense="<=",
        **({"message": "", "mooring": "m", "environment": "own", "rule": "depth-rating"} | others),
    )  # fmt: skip


CLUSTER = [_finding(f"glass {i}", Place(3, repeat=i // 4, part=i % 4)) for i in range(12)]


def test_a_cluster_is_one_finding() -> None:
    verdict = verdict_of(CLUSTER, {})
    assert (verdict.state, verdict.text) == (State.FAIL, "fails: 1 failure")


@pytest.mark.parametrize(
    "other",
    [
        _finding("shackle", Place(3, part=5)),
        _finding("glass 13", Place(4)),
        _finding("glass 1", Place(3), rule="strength"),
        _finding("glass 1", Place(3), mooring="n"),
    ],
)
def test_what_is_unlike_is_counted_apart(other: Finding) -> None:
    assert counted_states([*CLUSTER, other])[State.FAIL] == 2


def test_floats_of_a_cluster_that_pass_are_counted_each() -> None:
    passing = [_finding(each.component or "", Place(7, repeat=i), State.PASS)
               for i, each in enumerate(CLUSTER)]  # fmt: skip
    assert counted_states([*CLUSTER, *passing]) == {State.FAIL: 1, State.PASS: 12}


def test_an_anchor_that_slides_is_one_failure_with_and_without_capacity() -> None:
    sliding = _finding("anchor", Place(9), rule="anchor-sliding", message="friction holds 8 N")
    nothing = _finding("anchor", Place(9), rule="anchor-sliding", message="nothing holds it")
    weight = _finding("anchor", Place(9), rule="anchor-weight", message="it is too light")
    assert verdict_of([sliding, nothing, weight], {}).text == "fails: 2 failures"


def test_the_least_tension_governs_where_no_utilisation_does() -> None:
    slack = [
        replace(_finding(label, Place(i), rule="wave-slack"), value=value, limit=0.0, sense=">=")
        for i, (label, value) in enumerate({"buoy": -936.0, "shackle": -2210.0, "w": -9.0}.items())
    ]
    assert governing(slack).component == "shackle"
    assert max(slack, key=_extreme).component == "shackle"
