"""Many profiles of a net: each as it is alone, in any order and company."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from calm.batch.net_profiles import NetProfiles
from calm.batch.profiles import Batch
from calm.batch.statuses import STATUSES
from calm.case.net import Net, load
from calm.solve.net_closing import find_way

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


@pytest.mark.thorough  # its laws are compiled first
def test_profiles_of_a_net_are_what_each_is_alone(tmp_path: Path) -> None:
    """By the compiled search from still water and by the solver of `calm run`, audited: to the
    1e-6 of 200 m and of 6 kN that the former leaves, or some times that.
    Neither order nor threads change a bit.
    """
    net = load(tmp_path / "net.yaml", text=NET)
    assert isinstance(net, Net)
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
        assert found[:4] == pytest.approx(column, rel=1e-5, abs=6e-3, nan_ok=True), name


@pytest.mark.parametrize("size", [1, 4, 9])
def test_a_step_solves_its_equations(size: int) -> None:
    rng = np.random.default_rng(size)
    slopes, found = rng.normal(size=(size, size)), rng.normal(size=size)
    slopes[0, 0] = 0.0 if size > 1 else 2.0
    net: Any = SimpleNamespace(
        slopes=slopes.tolist(), paper=np.zeros((size, size + 1)).tolist(), order=[0] * size,
        way=[0.0] * size,
    )  # fmt: skip
    most = find_way(net, found.tolist())
    assert net.way == pytest.approx(-np.linalg.solve(slopes, found), rel=1e-9)
    assert most == max(map(abs, net.way))


def test_an_unknown_of_which_the_slopes_say_nothing_stays() -> None:
    net: Any = SimpleNamespace(
        slopes=[[2.0, 0.0], [0.0, 0.0]], paper=[[0.0] * 3, [0.0] * 3], order=[0, 0], way=[9.0, 9.0]
    )
    assert find_way(net, [4.0, 0.0]) == 2.0
    assert net.way == [-2.0, 0.0]
