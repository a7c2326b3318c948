"""Many profiles of a net: each as it is alone, in any order and company."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from calm.batch.net_profiles import NetProfiles
from calm.batch.profiles import Batch
from calm.batch.solving import lay_profile, levels_for, read_profile
from calm.batch.statuses import STATUSES
from calm.case import load
from calm.physics.line import Water
from calm.solve.leg_closing import newton_step

NET = """\
name: Two anchors
environment: {depth: 300 m, current: {speed: 0.3 m/s, toward: 90 deg}}
legs:
  left:
    line:
      - {use: sphere-steel-1250}
      - {use: wire-jacketed-8, length: 170 m,
         clamps: [{use: sbe37, at: 20 m}, {use: rcm11, at: 5 m}]}
    bottom: {join: A}
  pennant:
    line:
      - {use: wire-jacketed-8, length: 10 m, clamps: [{use: sbe37, at: 4 m}]}
      - {use: rcm11}
    top: {join: A}
    bottom: free
  west:
    line:
      - {use: wire-jacketed-8, length: 90 m}
      - {use: anchor-wheels-4, clamps: [{use: sbe37, at: 0.2 m}]}
    top: {join: A}
  east:
    line:
      - {use: wire-jacketed-8, length: 110 m}
      - {use: anchor-wheels-4}
    top: {join: A}
    bottom: {anchor: {at: [100 m, 20 m], depth: 310 m}}
"""


SLOPING = NET.replace("90 deg}}", "90 deg}, seabed: {slope: 8 deg, toward: 60 deg}}").replace(
    "{use: wire-jacketed-8, length: 90 m}",
    "{use: wire-jacketed-8, length: 60 m}\n      - {use: chain-buoy-16, length: 60 m}",
)
IN_AIR = """\
name: From a pier
environment: {depth: 300 m, current: {speed: 0.3 m/s, toward: 90 deg}}
legs:
  span:
    line: [{use: wire-jacketed-8, length: 130 m}]
    top: {held: {depth: -2 m, at: [-60 m, 0 m]}}
    bottom: {held: {depth: 60 m, at: [40 m, 0 m]}}
"""


@pytest.mark.thorough  # its laws are compiled first
@pytest.mark.parametrize("text", [NET, SLOPING, IN_AIR])
def test_profiles_of_a_net_are_what_each_is_alone(tmp_path: Path, text: str) -> None:
    """By the compiled search from still water, on its own segments, and by the solver of `calm
    run`, audited: to half of the 1e-4 of the depth and 2e-4 of the tension that is promised.
    Neither order nor threads change a bit.
    """
    net = load(tmp_path / "net.yaml", text=text)
    rng, depth = np.random.default_rng(2), np.array([0.0, 80.0, 300.0])
    u, v = (rng.normal(0.0, 0.5, (6, 3)) * [1.0, 0.6, 0.2] for _ in range(2))
    u[4] = np.nan
    u[5] = 2.4
    many = Batch(net).solve(u, v, depth, workers=1)
    assert [STATUSES[each] for each in many.status[[0, 1, 2, 3, 4]]] == [
        *["converged"] * 4, "no-current",
    ]  # fmt: skip
    order = [5, 3, 0, 4, 1, 2]
    others = Batch(net).solve(u[order], v[order], depth, workers=2)
    alone = NetProfiles(net)
    vars(alone)["slopes"] = None  # as of a net that is not to be searched compiled
    status = np.zeros(4, np.int8)
    flows = depth[None], u[:4], v[:4], np.zeros((4, 3))
    expected = alone.solve(flows, status, 1)
    assert set(expected) == set(vars(many)) - {"component_label", "clamp_label", "status"}
    for name, column in expected.items():
        found = getattr(many, name)
        assert np.array_equal(getattr(others, name), found[order], equal_nan=True), name
        near = 0.05 if "tension" in name or "anchor" in name else 0.01  # N; m and degrees
        assert found[:4] == pytest.approx(column, rel=4e-5, abs=near, nan_ok=True), name


SLACK = """\
name: Slack where nothing moves
environment: {depth: 60 m, current: {speed: 0.5 m/s, toward: 60 deg}}
legs:
  float: {line: [{use: sphere-steel-1250}, {use: wire-jacketed-8, length: 30 m}], bottom: {join: A}}
  west:
    line: [{use: wire-jacketed-8, length: 60 m}, {use: chain-buoy-16, length: 20 m},
           {use: anchor-wheels-4}]
    top: {join: A}
    bottom: {anchor: {at: [-50 m, 0 m]}}
  east:
    line: [{use: wire-jacketed-8, length: 60 m}, {use: chain-buoy-16, length: 20 m},
           {use: anchor-wheels-4}]
    top: {join: A}
    bottom: {anchor: {at: [50 m, 0 m]}}
"""


@pytest.mark.thorough
def test_a_net_that_is_slack_in_still_water_is_sought_from_its_own_current(tmp_path: Path) -> None:
    net = load(tmp_path / "slack.yaml", text=SLACK)
    profiles = NetProfiles(net)
    assert profiles.still is None
    assert profiles.base is not None
    status = np.zeros(2, np.int8)
    u, v, w = np.array([[0.6, 0.5], [0.5, 0.45]]), np.array([[0.3, 0.3], [0.3, 0.25]]), np.zeros(2)
    found = profiles.solve((np.array([[0.0, 60.0]]), u, v, np.tile(w, (2, 1))), status, 1)
    assert not status.any()
    sunk = found["knockdown"]
    assert np.isnan(sunk[:, [0, 1, 2, 3, 5, 6]]).all()
    assert not sunk[:, [4, 7]].any()  # the anchors
    for case in range(2):
        water = profiles.water((0.0, 60.0), tuple(u[case]), tuple(v[case]), (0.0, 0.0))
        alone = net.together(water)
        top = [-leg.position[0, 2] for leg in alone.legs]
        assert found["depth_top"][case, [0, 2, 5]] == pytest.approx(top, abs=6e-3)


def test_no_current_is_in_the_air() -> None:
    """A profile goes on to the surface, where levels above that begin; their own u is kept."""
    water = Water(50.0, [-1e-3, 0.0, 50.0], [0.0, 0.1, 0.0], [0.0] * 3, [0.0] * 3, [1.2, 1e3, 1e3])
    on = levels_for(2, water)
    count = read_profile(*np.array([[10.0, 40.0], [0.5, 0.3], [0.2, 0.2], [0.1, 0.0]]), on.read)
    total = lay_profile(on.read, count, on.fixed, on.levels, on.intervals, on.joined)
    expected = [
        [-1e-3, 0.0, 0.0, 0.0, 1.2],
        [0.0, 0.6, 0.2, 0.1, 1e3],
        [10.0, 0.58, 0.2, 0.1, 1e3],
        [40.0, 0.32, 0.2, 0.0, 1e3],
        [50.0, 0.3, 0.2, 0.0, 1e3],
    ]
    assert np.allclose(on.joined[:total], expected)


@pytest.mark.parametrize("size", [1, 4, 9])
def test_a_step_solves_its_equations(size: int) -> None:
    rng = np.random.default_rng(size)
    slopes, found = rng.normal(size=(size, size)), rng.normal(size=size)
    slopes[0, 0] = 0.0 if size > 1 else 2.0
    net: Any = SimpleNamespace(
        slopes=slopes.tolist(), matrix=np.zeros((size, size + 1)).tolist(), order=[0] * size,
        update=[0.0] * size,
    )  # fmt: skip
    most = newton_step(net, found.tolist())
    assert net.update == pytest.approx(-np.linalg.solve(slopes, found), rel=1e-9)
    assert most == pytest.approx(np.linalg.norm(net.update))


def test_an_unknown_of_which_the_slopes_say_nothing_stays() -> None:
    net: Any = SimpleNamespace(
        slopes=[[2.0, 0.0], [0.0, 0.0]],
        matrix=[[0.0] * 3, [0.0] * 3],
        order=[0, 0],
        update=[9.0, 9.0],
    )
    assert newton_step(net, [4.0, 0.0]) == 2.0
    assert net.update == [-2.0, 0.0]
