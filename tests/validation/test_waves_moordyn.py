"""A taut mooring heaved at its top, as MoorDyn 2 has it in the time domain."""

import numpy as np
import pytest

from calm.case import load
from calm.waves.lumped_line import lumped_line
from calm.waves.response import Waves, _axes, _deviations, _linearised, _pull, _solved, _undamped

COASTAL = """\
name: Coastal buoy
environment:
  depth: 80 m
  current: {speed: 0.3 m/s, toward: 90 deg}
line:
  - {use: buoy}
  - {use: upper-chain, length: 5 m}
  - {use: nylon, length: 60 m}
  - {use: ground-chain, length: 3 m}
  - {use: block}
components:
  buoy: {kind: cylinder, role: float, diameter: 1.6 m, length: 1.2 m, mass: 700 kg,
         volume: 2.4127 m^3, hull: cylinder}
  upper-chain: {kind: chain, diameter: 16 mm, mass: 5.6 kg/m, stiffness: 10 MN}
  nylon: {kind: cable, diameter: 20 mm, weight: 0.3 N/m, mass: 0.25 kg/m, material: nylon,
          stiffness: 12 kN}
  ground-chain: {kind: chain, diameter: 20 mm, mass: 8.8 kg/m, stiffness: 10 MN}
  block: {kind: anchor, weight: 30 kN}
"""

MOORDYN = {17.4: 18.869, 65.1: 20.933, 79.2: 21.020}
"""Amplitude of the tension [N] by depth [m], the top of the chain heaved by 0.1 m at 2 rad/s.

MoorDyn 2 of its wheel, this mooring as `calm export --to moordyn` writes it with 4 and 10 segments
a line, the end of the upper chain as a coupled point, RK4, internal damping 20 N s in nylon. Its
tension in the upper chain itself is not compared: a step of the motion given to it, 0.01 s, leaves
2e-5 m there, which chain answers with 160 N.
"""


def test_tensions_of_a_heaved_line():
    """Within 1 %: the segments of MoorDyn, 2 m of nylon, and the three digits of its mean."""
    mooring = load("coastal.yaml", text=COASTAL)
    line = lumped_line(mooring.leg, mooring.leg.equilibrium(), 0.5)
    omega = np.array([2.0])
    water = np.zeros((1, len(line.mass), 3), complex)
    held = np.diag([-4.0 * 1150.0, -4.0 * 1150.0, 1e10])[None], np.zeros((1, 3))  # of 1150 kg
    push = water.copy()
    push[0, 0, 2] = 1e10 * 0.1
    damping = _linearised(line, None, np.full((len(line.mass), 3), 1e-3))
    waves = Waves(omega, 90.0, 80.0, 1025.0, 9.80665)
    for _ in range(20):
        motion = _solved(_undamped(line), held, waves.omega, water, push, damping)
        flow = _deviations(_axes(line), water - 2j * motion, np.array([0.5]))
        damping = 0.5 * (damping + _linearised(line, None, flow))
    found = np.abs(_pull(line, motion)[0])
    depth = -0.5 * (line.position[1:, 2] + line.position[:-1, 2])
    at = np.interp(list(MOORDYN), depth, found)
    assert at == pytest.approx(list(MOORDYN.values()), rel=0.01)
