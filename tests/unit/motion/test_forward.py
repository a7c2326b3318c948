"""The line that is asked for its depths is that of the batch, with its factors."""

import numpy as np
import pytest

import calm
from calm.motion.line_response import Forward, points

MOORING = """\
name: Small
environment: {depth: 300 m, current: {speed: 0.5 m/s, toward: 90 deg}}
line:
  - {use: ball}
  - {use: rope, length: 250 m, clamps: [{use: logger, at: 10 m}, {use: logger, at: 200 m}]}
  - {use: weight}
components:
  ball: {kind: sphere, role: float, diameter: 1 m, buoyancy: 2000 N}
  rope: {kind: cable, diameter: 10 mm, weight: 0.2 N/m, stiffness: 1 MN}
  logger: {kind: cylinder, diameter: 40 mm, length: 0.3 m, buoyancy: -5 N}
  weight: {kind: anchor, weight: 9000 N}
"""


def test_the_line_is_that_of_the_batch_with_its_factors(tmp_path):
    (tmp_path / "m.yaml").write_text(MOORING)
    mooring = calm.load(tmp_path / "m.yaml")
    u, v, level = np.array([[0.6, 0.2]]), np.array([[-0.1, 0.3]]), np.array([[0.0, 300.0]])
    plain, found = calm.solve_profiles(mooring, u, v, level[0]), Forward(mooring, {})
    solved = found.solve(level, u, v)
    for name in ("clamp_depth", "depth_top", "x_top", "y_top"):
        assert getattr(solved, name) == pytest.approx(getattr(plain, name))
    depths = np.concatenate([plain.clamp_depth[0], plain.depth_top[0]])
    assert found.depths(level, u, v)[0] == pytest.approx(depths)
    assert points(solved)[0] == pytest.approx(depths)
    still = calm.solve_profiles(mooring, 0.0 * u, 0.0 * v, level[0])
    assert found.still == pytest.approx(points(still)[0], abs=1e-9)
    # drag on all of it goes with the square of the current
    both = Forward(mooring, {"cable_drag": 1.21, "rigid_drag": 1.21})
    assert both.depths(level, u, v)[0] == pytest.approx(found.depths(level, 1.1 * u, 1.1 * v)[0])
