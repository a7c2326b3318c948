"""The design check of nets: a leg is judged as the line that it is, and a net by what it holds."""

from __future__ import annotations

from pathlib import Path

import pytest

from calm.case import Design, load
from calm.checks.assessment import Assessment
from calm.checks.design_check import assessment_of, environments_checked
from calm.checks.finding import State
from calm.checks.leg_graph import LegGraph

WATER = """\
name: n
environment:
  depth: 300 m
  current: {speed: 0.3 m/s, toward: 90 deg}
  fouling: {depth: 100 m, thickness: 5 mm, density: 1300 kg/m^3}
"""
UPPER = """\
{pad}- {{use: sphere-steel-1250}}
{pad}- {{use: shackle-13}}
{pad}- {{use: wire-jacketed-8, length: 80 m, clamps: [{{use: sbe37, at: 20 m}}]}}
{pad}- {{use: glass-17in, count: 4}}
{pad}- {{use: chain-g80-13, length: 1 m}}
"""
LOWER = """\
{pad}- {{use: wire-jacketed-8, length: 60 m}}
{pad}- {{use: glass-17in, count: 3}}
{pad}- {{use: release-ar861}}
{pad}- {{use: chain-g80-13, length: 5 m}}
{pad}- {{use: anchor-wheels-4}}
"""
LINE = WATER + "line:\n" + (UPPER + LOWER).format(pad="  ")
ONE_LEG = WATER + "legs:\n  all:\n    line:\n" + (UPPER + LOWER).format(pad="      ")
TWO_LEGS = (
    WATER + "legs:\n  upper:\n    line:\n" + UPPER.format(pad="      ") + "    bottom: {join: A}\n"
    "  lower:\n    line:\n" + LOWER.format(pad="      ") + "    top: {join: A}\n"
)  # fmt: skip


def line(text: str) -> Design:
    found = load(Path("line.yaml"), text=text)
    return found


def judged(net: Design) -> Assessment:
    return assessment_of("n", environments_checked(net, "n"))


@pytest.mark.parametrize("text", [ONE_LEG, TWO_LEGS])
def test_a_line_cut_into_legs_is_judged_as_the_line(text: str) -> None:
    """Every situation and rule; 1e-3 is what the stated errors of both allow of a tension."""
    single, net = line(LINE), judged(load(Path("net.yaml"), text=text))
    whole = assessment_of("n", environments_checked(single, "n"))
    # what runs from piece to piece is seen within a leg alone
    of_neighbours = {"strength-steps", "swivel", "metals", "release-present"}
    handled = {"launch-strength", "launch-speed", "recovery", "tangling", "missing"}
    expected = {
        (each.rule, each.component, each.situation): each
        for each in whole.all_findings()
        if each.rule not in of_neighbours | handled and "launch" not in each.situation
    }
    found = {(each.rule, each.component, each.situation): each for each in net.all_findings()}
    assert expected.keys() <= found.keys()
    for key, each in expected.items():
        other = found[key]
        assert other.state == each.state, key
        for its, expected_value in ((other.limit, each.limit), (other.value, each.value)):
            known = expected_value is not None
            assert its == (pytest.approx(expected_value, rel=1e-3, abs=1e-3) if known else None), (
                key
            )


@pytest.mark.parametrize("text", [ONE_LEG, TWO_LEGS])
def test_its_breaks_and_losses_are_those_of_the_line(text: str) -> None:
    """Lifts are taken where the line stands, not upright: a metre of depth is 1e-5 of them."""
    single, net = line(LINE), judged(load(Path("net.yaml"), text=text))
    leg, graph = single.leg, LegGraph.upright(single.leg)
    for mine, its in ((graph.breaks(leg), net.backup), (graph.losses(leg), net.losses)):
        assert [each.label for each in mine] == [each.label for each in its]
        for one, other in zip(mine, its, strict=True):
            for name in ("margin", "weight_lifted", "required", "judged", "loose"):
                if hasattr(one, name):
                    expected = pytest.approx(getattr(one, name), rel=1e-3, abs=0.5)
                    assert getattr(other, name) == expected, (one.label, name)


Y = """\
name: Y
environment: {depth: 300 m, current: {speed: 0.2 m/s, toward: 90 deg}}
legs:
  main:
    line:
      - {use: sphere-steel-1250, label: top}
      - {use: wire-jacketed-8, length: 100 m, label: upper wire}
    bottom: {join: A}
  west:
    line:
      - {use: wire-jacketed-8, length: 130 m, label: west wire}
      - {use: release-ar861, label: west release}
      - {use: chain-g80-13, length: 5 m, label: west chain}
      - {use: anchor-wheels-4, label: west anchor}
    top: {join: A}
    bottom: {anchor: {at: [-40 m, 0 m]}}
  east:
    line:
      - {use: wire-jacketed-8, length: 130 m, label: east wire}
      - {use: release-ar861, label: east release}
      - {use: chain-g80-13, length: 5 m, label: east chain}
      - {use: anchor-wheels-4, label: east anchor}
    top: {join: A}
    bottom: {anchor: {at: [40 m, 0 m]}}
"""


@pytest.fixture(scope="module")
def y() -> Assessment:
    return judged(load(Path("y.yaml"), text=Y))


def test_each_anchor_is_judged_by_its_own_rules(y: Assessment) -> None:
    for rule in ("anchor-weight", "anchor-uplift", "anchor-sliding"):
        found = {each.component for each in y.all_findings() if each.rule == rule}
        assert found == {"west anchor", "east anchor"}
    # of the legs only the one whose upper end is free has a top
    tops = {each.component for each in y.all_findings() if each.rule == "top-depth"}
    assert tops == {"top"}


def test_a_break_of_any_leg_says_what_is_left_and_what_drifts(y: Assessment) -> None:
    result = load(Path("y.yaml"), text=Y).solve()
    graph = LegGraph.in_equilibrium(result.legs)
    lift = dict(zip([piece.label for piece in graph.pieces], graph.lifts.tolist(), strict=True))
    breaks = {each.label: each for each in y.backup}
    assert list(breaks) == ["top", "upper wire", "west wire", "east wire"]
    # the float drifts alone, and what is left cannot rise
    assert breaks["top"].loose == pytest.approx(lift["top"])
    rest = sum(lift[f"{side} {what}"] for side in ("west", "east") for what in ("wire", "release"))
    assert breaks["top"].margin == pytest.approx(rest + lift["upper wire"])
    # nothing comes off where the other leg holds; then the release below the break is alone
    assert breaks["west wire"].loose == 0.0
    assert breaks["west wire"].margin == pytest.approx(lift["west release"])
    backup = [each for each in y.findings if each.rule == "backup"]
    assert [each.state for each in backup] == [State.FAIL]


def test_what_no_release_frees_is_unknown() -> None:
    text = Y.replace("      - {use: release-ar861, label: east release}\n", "")
    found = [
        each
        for each in judged(load(Path("y.yaml"), text=text)).findings
        if each.rule == "release-present"
    ]
    assert [(each.state, each.component) for each in found] == [(State.UNKNOWN, "top")]
    assert "No release lies between top and an anchor" in found[0].message


def test_a_net_that_does_not_stand_is_a_failure_with_its_reason() -> None:
    text = Y.replace("length: 130 m", "length: 10 m")  # its anchors are 80 m apart
    found = judged(load(Path("y.yaml"), text=text))
    assert [each.rule for each in found.in_environments[0].findings] == ["equilibrium"]
    assert found.state is State.FAIL


def test_a_hanging_instrument_bears_itself_alone() -> None:
    """It is pulled at one end, as a top float is: without a load of its own it is not unknown."""
    text = Y.replace(
        "  west:\n",
        "  pennant:\n    line:\n      - {use: wire-jacketed-8, length: 5 m, slack: allowed}\n"
        "      - {use: aanderaa-tide-gauge}\n    top: {join: A}\n    bottom: free\n  west:\n",
    )
    found = judged(load(Path("y.yaml"), text=text))
    assert not [
        each for each in found.all_findings()
        if each.rule == "strength" and each.component == "aanderaa-tide-gauge"
    ]  # fmt: skip
