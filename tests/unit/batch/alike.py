"""A profile of a batch against the same profile solved by `calm run`."""

from dataclasses import replace

import numpy as np
import pytest

from calm.batch.profiles import STATUSES, Profiles
from calm.case import Design, Result, load
from calm.errors import NoEquilibrium
from calm.files import CurrentTable
from calm.shipped import shipped_folder

PLACE, TENSION = 1e-4, 2e-4
"""What is promised, as shares of the water depth and of the tension."""
TILT = 0.1
"""Degrees; of a piece, whose ends are off by 1e-4 of the water depth at most."""
CLAMP_TILT = np.degrees(TENSION)
"""Degrees; of the pull in the line, whose direction is as good as its size."""


def shipped(name: str) -> Design:
    mooring = load(shipped_folder("lines") / f"{name}.yaml")
    return mooring


def in_profile(mooring: Design, *columns: np.ndarray) -> Design:
    current = CurrentTable(*(tuple(column.tolist()) for column in columns))
    environment = replace(mooring.file.environment, current=current)
    return Design(replace(mooring.file, environment=environment))


def assert_alike(found: Profiles, case: int, result: Result) -> None:
    depth = result.design.water.depth
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


def assert_as_run(found: Profiles, mooring: Design, *columns: np.ndarray) -> None:
    """Every profile of a batch: its figures, or its status."""
    depth, *currents = columns
    for case in range(len(currents[0])):
        status = STATUSES[found.status[case]]
        try:
            result = in_profile(mooring, depth, *(part[case] for part in currents)).solve()
        except NoEquilibrium as refusal:
            assert status == refusal.status
            assert np.isnan(found.depth_top[case]).all()
            continue
        assert status == "converged"
        assert_alike(found, case, result)
