"""Derivatives of the depths by the currents, against differences between solved lines."""

from pathlib import Path

import numpy as np
import pytest

from calm.batch.profiles import Batch
from tests.unit.batch import test_afloat
from tests.unit.batch.made import MOORING, made_mooring

STEP = 0.02  # m/s
LEVELS = np.array([0.0, 25.0, 50.0, 100.0])
U = np.array([[0.5, 0.4, 0.3, 0.1], [0.2, -0.1, 0.15, 0.1], [np.nan, 0.3, 0.3, 0.3]])
V = np.array([[0.1, 0.1, 0.0, -0.1], [0.3, 0.2, 0.1, 0.0], [0.1, 0.1, 0.1, 0.1]])


def afloat(name: str) -> str:
    line, hull, solver = test_afloat.LINES[name]
    return (
        test_afloat.MOORING.replace("LINE", line)
        .replace("    HULL\n", f"    {hull}\n" if hull else "")
        .replace("SOLVER", solver)
    )


@pytest.mark.parametrize(
    ("text", "faster"),
    [
        pytest.param(MOORING, 6.0, id="below the surface"),
        pytest.param(afloat("two"), 1.0, id="two floats at the surface"),
        pytest.param(afloat("on the seabed"), 1.0, id="on the seabed"),
    ],
)
def test_slopes_are_differences_between_solved_lines(
    tmp_path: Path, text: str, faster: float
) -> None:
    u, v = faster * U, faster * V
    batch, flow = Batch(made_mooring(tmp_path, text)), np.hstack([u, v])

    def depths(flow: np.ndarray) -> np.ndarray:
        found = batch.solve(*np.split(flow, 2, axis=1), LEVELS, workers=1)
        return np.hstack([found.clamp_depth, found.depth_top])

    base, slopes = batch.slopes(u, v, LEVELS)
    whole = depths(flow)
    assert np.array_equal(np.hstack([base.clamp_depth, base.depth_top]), whole)
    steps = STEP * np.eye(flow.shape[1])
    ahead, behind = (np.stack([depths(flow + d * one) for one in steps], 2) for d in (1, -1))
    expected = (ahead - behind) / (2.0 * STEP)
    # lines are solved to a millionth of the depth, 1e-4 m
    largest = np.abs(expected).max(axis=(1, 2), keepdims=True)
    assert (np.abs(slopes - expected) < 0.02 * largest + 0.02).all()
    assert (largest > 0.3).all()


def test_without_an_equilibrium_there_are_no_slopes(tmp_path: Path) -> None:
    batch = Batch(made_mooring(tmp_path))
    nothing = np.full_like(U, np.nan)
    _, slopes = batch.slopes(nothing, nothing, LEVELS)
    assert np.isnan(slopes[:, :2]).all()
