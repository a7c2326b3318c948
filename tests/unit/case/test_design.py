"""One kind of design: its legs, what holds their ends, and what only a single leg has."""

import pickle

import pytest

import calm
from calm.case.leg import Leg
from calm.shipped import shipped_folder

LINES = shipped_folder("lines")
NET = """\
name: Y
environment: {depth: 500 m, current: {speed: 0.4 m/s, toward: 90 deg}}
legs:
  main: {line: [{use: sphere-steel-1250}, {use: wire-jacketed-8, length: 150 m}], bottom: {join: A}}
  low: {line: [{use: wire-jacketed-8, length: 10 m}, {use: rcm11}], top: {join: A}, bottom: free}
  stem: {line: [{use: wire-jacketed-8, length: 200 m}, {use: anchor-wheels-4}], top: {join: A}}
"""


@pytest.fixture(scope="module")
def net() -> calm.Design:
    return calm.load("net.yaml", text=NET)


def held_by(leg: Leg) -> list[str]:
    """What holds its upper and its lower end."""
    return [next(iter(end.model_dump(exclude_none=True)), "free") for end in (leg.top, leg.bottom)]


def test_legs_say_what_holds_their_ends(net: calm.Design) -> None:
    mooring = calm.load(LINES / "s1000.yaml")
    tow = calm.load(LINES / "a-frame-sheared-tow.yaml")
    assert [held_by(leg) for leg in mooring.legs] == [["free", "anchor"]]
    assert [held_by(leg) for leg in tow.legs] == [["held", "free"]]
    assert tow.leg.top.held is not None and tow.leg.top.held.depth == -6.0
    assert [held_by(leg) for leg in net.legs] == [
        ["free", "join"], ["join", "free"], ["join", "anchor"],
    ]  # fmt: skip
    assert [one.towed for one in (mooring, tow, net)] == [False, True, False]


def test_a_mooring_bears_on_its_anchor_and_a_tow_on_the_ship() -> None:
    result = calm.load(LINES / "s1000.yaml").solve()
    (anchor,) = result.anchors
    assert not result.held and not result.nodes
    assert (anchor.vertical, anchor.required_weight) == (
        result.anchor.vertical, result.anchor.required_weight,
    )  # fmt: skip
    tow = calm.load(LINES / "a-frame-sheared-tow.yaml").solve()
    (ship,) = tow.held
    assert not tow.anchors and tow.leg.anchor is None
    assert ship.vertical == -tow.tow_point.vertical  # the line pulls the ship down
    assert ship.horizontal == pytest.approx(tow.tow_point.horizontal, rel=1e-15)
    assert ship.angle == pytest.approx(90.0 + tow.tow_point.angle, rel=1e-12)
    assert ship.depth == pytest.approx(-6.0, abs=1e-6)


def test_what_a_single_leg_has_is_that_of_the_design() -> None:
    result = calm.load(LINES / "s1000.yaml").solve()
    (leg,) = result.legs
    assert result.leg is leg and result.top is leg.top and result.components is leg.components
    assert result.design.leg is leg.leg and leg.leg.file is result.design.file


def test_several_legs_are_asked_one_by_one(net: calm.Design) -> None:
    with pytest.raises(calm.UsageError, match=r"^net.yaml: .*a single line with one free end"):
        _ = net.line
    result = net.solve()
    for name in ("top", "anchor", "shape", "strumming", "body"):
        with pytest.raises(calm.UsageError, match="Y has several legs"):
            getattr(result, name)
    assert [leg.name for leg in result.legs] == ["main", "low", "stem"]
    assert list(result.components.label) == [piece.label for piece in net.file.pieces]
    assert [len(leg.leg.pieces) for leg in result.legs] == [2, 2, 2]


@pytest.mark.parametrize("name", ["s1000", "depressor-fit-depth", "fit-top-depth"])
def test_another_process_gets_what_was_cut_and_changed(name: str) -> None:
    design = calm.load(LINES / f"{name}.yaml")
    longer = design.with_length(2 if name == "fit-top-depth" else 1, 77.0)
    there = pickle.loads(pickle.dumps(longer))
    assert there.line.length.tolist() == longer.line.length.tolist()
    assert there.origin == longer.origin


def test_the_legs_of_a_net_go_to_another_process_with_their_changes(net: calm.Design) -> None:
    longer = net.with_length(1, 160.0)
    there = pickle.loads(pickle.dumps(longer))
    assert there.solve().nodes == longer.solve().nodes != net.solve().nodes


def test_what_is_not_towed_has_no_tow_point(net: calm.Design) -> None:
    result = calm.load(LINES / "s1000.yaml").solve()
    for end in ("tow_point", "body"):
        with pytest.raises(calm.UsageError, match="is not towed"):
            getattr(result, end)
