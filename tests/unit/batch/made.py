"""A small mooring, and records of currents that stand in memory."""

from pathlib import Path

import numpy as np

import calm

MOORING = """\
name: Test
position: {latitude: 48.3 deg, longitude: -5.2 deg}
environment:
  depth: 100 m
  current: {speed: 0.5 m/s, toward: 90 deg}
line:
  - {use: ball, label: top float}
  - {use: rope, length: 40 m, clamps: [{use: logger, label: Logger é, at: 10 m}]}
  - {use: rope, length: 20 m}
  - {use: weight}
components:
  ball: {kind: sphere, role: float, diameter: 1 m, buoyancy: 2000 N}
  rope: {kind: cable, diameter: 10 mm, weight: 0.2 N/m}
  logger: {kind: cylinder, diameter: 40 mm, length: 0.3 m, buoyancy: -5 N}
  weight: {kind: anchor, weight: 5000 N}
"""

PLAIN = MOORING.replace("position: {latitude: 48.3 deg, longitude: -5.2 deg}\n", "").replace(
    ", clamps: [{use: logger, label: Logger é, at: 10 m}]", ""
)
"""Without what a mooring may be without."""


class MadeRecord:
    """Profiles in memory; where there are more than four, the fifth has no current."""

    notes = ("made for a test",)
    cards = ()
    source = {"file": "made"}  # noqa: RUF012

    def __init__(self, count=40, seed=1):
        random = np.random.default_rng(seed)
        self.depth = np.array([0.0, 30.0, 60.0, 100.0])
        shear = np.array([1.0, 0.7, 0.4, 0.2])
        self.u = random.normal(0.0, 0.4, (count, 1)) * shear
        self.v = random.normal(0.0, 0.4, (count, 1)) * shear
        self.u[4:5] = np.nan
        hours = np.arange(count) * np.timedelta64(3600, "s")
        self.time = np.datetime64("2024-01-01T00:00:00", "ns") + hours

    @property
    def count(self):
        return len(self.u)

    def profiles(self, start, stop):
        return self.depth, self.u[start:stop], self.v[start:stop], None


def made_mooring(folder: Path, text: str = MOORING):
    """The mooring, from a file in a folder."""
    file = folder / "m.yaml"
    file.write_text(text, encoding="utf-8")
    return calm.load(file)
