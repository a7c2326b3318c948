"""Each profile of a batch against the same profile solved by `calm run`."""

from dataclasses import replace

import numpy as np
import pytest

from calm.batch.kernel.plan import plan_of
from calm.batch.profiles import Profiles, solve_profiles
from calm.batch.statuses import STATUSES
from calm.case import Mooring, Result, load
from calm.errors import NoEquilibrium
from calm.files import CurrentTable
from calm.shipped import shipped_folder
from tests.unit.batch.drawn_profiles import CHARACTERS, drawn

PLACE, TENSION = 1e-4, 2e-4
"""What is promised, as shares of the water depth and of the tension."""
TILT = 0.1
"""Degrees; of a piece, whose ends are off by 1e-4 of the water depth at most."""
CLAMP_TILT = 1.0
"""Degrees; `calm run` gives that of the segment above, which turns by a degree."""
LINES = [
    "braconnot-buoy", "cdms-1", "chain-and-rope-surface", "deep-current-meters", "fit-top-depth",
    "receiver-line", "s1000", "sediment-trap-undercurrent", "taut-nylon-surface",
    "thermistor-string", "tidal-adcp", "upward-adcp-300m", "veering-current",
]  # fmt: skip


def shipped(name: str) -> Mooring:
    mooring = load(shipped_folder("lines") / f"{name}.yaml")
    assert isinstance(mooring, Mooring)
    return mooring


def in_profile(mooring: Mooring, *columns: np.ndarray) -> Mooring:
    current = CurrentTable(*(tuple(column.tolist()) for column in columns))
    environment = replace(mooring.file.environment, current=current)
    return Mooring(replace(mooring.file, environment=environment))


def assert_alike(found: Profiles, case: int, result: Result) -> None:
    depth = result.mooring.water.depth
    parts = result.components
    for name in ("depth_top", "x_top", "y_top", "knockdown"):
        expected = getattr(parts, name)
        np.testing.assert_allclose(
            getattr(found, name)[case], expected, rtol=0.0, atol=PLACE * depth, err_msg=name
        )
    floor = 1e-3 * parts.tension_bottom.max()  # a slack end of no tension has no relative error
    for name in ("tension_top", "tension_bottom"):
        expected = getattr(parts, name)
        np.testing.assert_array_less(
            np.abs(getattr(found, name)[case] - expected), TENSION * np.maximum(expected, floor)
        )
    np.testing.assert_allclose(found.tilt[case], parts.tilt, rtol=0.0, atol=TILT)
    clamps = result.clamps
    for name in ("depth", "x", "y", "knockdown"):
        np.testing.assert_allclose(
            getattr(found, f"clamp_{name}")[case], getattr(clamps, name), rtol=0.0,
            atol=PLACE * depth, err_msg=name,
        )  # fmt: skip
    np.testing.assert_allclose(found.clamp_tension[case], clamps.tension, rtol=TENSION)
    np.testing.assert_allclose(found.clamp_tilt[case], clamps.tilt, rtol=0.0, atol=CLAMP_TILT)
    assert found.top_depth[case] == pytest.approx(result.top.depth, abs=PLACE * depth)
    pull = TENSION * result.anchor.tension
    assert found.anchor_vertical[case] == pytest.approx(result.anchor.vertical, abs=pull)
    assert found.anchor_horizontal[case] == pytest.approx(result.anchor.horizontal, abs=pull)
    # the share in use comes from the tension below the float
    assert found.used_buoyancy[case] == pytest.approx(result.top.used_buoyancy, abs=TENSION)


@pytest.mark.parametrize("name", LINES)
def test_every_profile_equals_a_run_in_it(name: str) -> None:
    mooring = shipped(name)
    depth, u, v, w = drawn(7, 2 * CHARACTERS, mooring.water.depth)
    found = solve_profiles(mooring, u, v, depth, w)
    for case in range(len(u)):
        status = STATUSES[found.status[case]]
        try:
            result = in_profile(mooring, depth, u[case], v[case], w[case]).solve()
        except NoEquilibrium as refusal:
            assert status == refusal.status
            assert np.isnan(found.depth_top[case]).all()
            continue
        assert status == "converged"
        assert_alike(found, case, result)
    assert found.component_label == tuple(piece.label for piece in mooring.file.pieces)
    assert found.clamp_label == tuple(result.clamps.label)


@pytest.mark.parametrize("name", ["cdms-1", "deep-current-meters", "sediment-trap-undercurrent"])
def test_the_lanes_solve_sub_surface_lines(name: str) -> None:
    mooring = shipped(name)
    depth, u, v, w = drawn(8, 20 * CHARACTERS, mooring.water.depth)
    assert not solve_profiles(mooring, u, v, depth, w).alone.any()


def test_the_lanes_solve_a_float_that_rides_or_is_pulled_under() -> None:
    mooring = shipped("taut-nylon-surface")
    depth, u, v, w = drawn(8, 20 * CHARACTERS, mooring.water.depth)
    found = solve_profiles(mooring, u, v, depth, w)
    assert found.alone.mean() < 0.05
    riding = (found.used_buoyancy < 1.0) & ~found.alone
    assert riding.any()
    assert (~riding & (found.top_depth > 0.0) & ~found.alone).any()


def test_where_roots_are_near_each_other_the_run_decides() -> None:
    # 476 m is a root, too, which the coarse cuts take for the highest
    mooring = shipped("upward-adcp-300m")
    depth, u, v, w = (a if a.ndim == 1 else a[46:47] for a in drawn(11, 47, mooring.water.depth))
    found = solve_profiles(mooring, u, v, depth, w)
    assert found.alone.all()
    assert_alike(found, 0, in_profile(mooring, depth, u[0], v[0], w[0]).solve())


def test_an_anchor_that_would_lift_is_a_status() -> None:
    mooring = shipped("s1000")
    pieces = mooring.file.pieces
    light = pieces[-1].component.model_copy(update={"weight": 1000.0})
    file = replace(mooring.file, pieces=(*pieces[:-1], replace(pieces[-1], component=light)))
    depth, u, v, w = drawn(1, 1, mooring.water.depth)
    found = solve_profiles(Mooring(file), u, v, depth, w)
    assert STATUSES[found.status[0]] == "anchor-lifts"
    assert np.isnan(found.tension_top[0]).all()


def test_what_the_lanes_do_not_know_is_solved_alone() -> None:
    mooring = shipped("s1000")
    solver = mooring.file.solver.model_copy(update={"friction": "hoerner"})
    mooring = Mooring(replace(mooring.file, solver=solver))
    assert plan_of(mooring) is None
    depth, u, v, w = drawn(2, 2, mooring.water.depth)
    found = solve_profiles(mooring, u, v, depth, w)
    assert found.alone.all()
    result = in_profile(mooring, depth, u[0], v[0], w[0]).solve()
    assert_alike(found, 0, result)
