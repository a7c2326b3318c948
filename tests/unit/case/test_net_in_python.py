"""A net of legs in Python: read, varied, judged and shown as a mooring is."""

import pytest

import calm
from calm.report.sheet import quality_of, summary_of
from calm.shipped import shipped_folder

NET = """\
name: Y
environment: {depth: 100 m, current: {speed: 0.3 m/s, toward: 90 deg}}
environments:
  still: {current: {speed: 0 m/s, toward: 90 deg}}
legs:
  stem:
    line: [{use: ball, label: top}, {use: rope, length: 40 m}]
    bottom: {join: A}
  west:
    line: [{use: rope, length: 50 m, label: west rope}, {use: block}]
    top: {join: A}
  east:
    line: [{use: rope, length: 50 m}, {use: block}]
    top: {join: A}
    bottom: {anchor: {at: [40 m, 0 m]}}
components:
  ball: {kind: sphere, diameter: 1 m, buoyancy: 3 kN}
  rope: {kind: cable, diameter: 12 mm, weight: 0.3 N/m, stiffness: 500 kN}
  block: {kind: anchor, weight: 10 kN}
"""


@pytest.fixture
def net(tmp_path):
    (tmp_path / "net.yaml").write_text(NET)
    return calm.load(tmp_path / "net.yaml")


def test_a_net_is_read_and_varied_as_a_mooring_is(net):
    still = net.solve("still")
    assert still.nodes[0].x == pytest.approx(20.0, abs=1e-6)  # halfway between equal arms
    assert net.solve().nodes[0].x > 20.01
    longer = net.with_("west rope", length="55 m").solve("still")
    assert longer.nodes[0].x > 21.0
    with pytest.raises(calm.InputError, match="no environment is called `storm`"):
        net.solve("storm")


def test_its_result_is_shown_in_a_few_lines_and_as_a_dataset(net):
    result = net.solve()
    assert repr(result).splitlines()[0] == "Y: net of 3 legs, converged"
    assert len(repr(result).splitlines()) <= 10
    assert "west: node A to anchor" in result._repr_html_()
    assert result.to_xarray().sizes["component"] == len(result.to_pandas()) == 6


def test_of_a_leg_only_what_it_has_is_said(net):
    """No anchor's load where it has no anchor; no strumming, as it does not stand alone."""
    said = {leg.name: str((summary_of(leg), quality_of(leg))) for leg in net.solve().legs}
    assert "unknown" not in "".join(said.values())
    assert "nchor" not in said["stem"] and "position at the lower end" in said["stem"]
    assert "horizontal" in said["west"] and "position at the anchor" in said["west"]
    assert all(leg.strumming_band is None for leg in net.solve().legs)


def test_it_is_judged_and_its_launch_is_refused(net):
    assert {stand.environment for stand in calm.check(net).in_environments} >= {
        "own: stem",
        "own: east",
    }
    with pytest.raises(calm.UsageError, match="a single line with one free end"):
        calm.drop_plan(net)
    with pytest.raises(calm.UsageError, match="is a tow; only a mooring can be used here"):
        calm.check(calm.load(shipped_folder("lines") / "helicopter-bird.yaml"))


def test_a_leg_without_an_anchor_has_no_load_on_one(net):
    anchors = {leg.name: leg.anchor for leg in net.solve().legs}
    assert anchors["stem"] is None
    assert anchors["west"].tension > 0.0


def test_a_tow_has_no_anchor():
    tow = calm.load(shipped_folder("lines") / "helicopter-bird.yaml").solve()
    assert tow.leg.anchor is None
    with pytest.raises(calm.UsageError, match="has no anchor"):
        tow.anchor  # noqa: B018
