"""Instruments clamped on an anchor: their weight adds to its own, and they stand with it."""

from pathlib import Path

import numpy as np
import pytest

from calm.batch.profiles import solve_profiles
from calm.case import Design
from calm.checks.criterion import parts_of
from calm.checks.inventory import inventory_of
from calm.drawing.schematic.shown_parts import levels_of
from calm.files import read_mooring

FILE = """
name: lander
environment:
  depth: 100 m
  density: 1035 kg/m^3
  current: {speed: 0.5 m/s, toward: 90 deg}
components:
  ball: {kind: sphere, diameter: 1 m, buoyancy: 2000 N, cx: 0.5}
  rope: {kind: cable, diameter: 10 mm, weight: 0 N/m, cn: 1.2}
  block: {kind: anchor, length: 0.5 m, weight: 5000 N}
  logger: {kind: body, length: 0.3 m, mass: 20 kg, volume: 0.01 m^3, drag_area: 5 m^2, cd: 1}
line:
  - {use: ball}
  - {use: rope, length: 50 m, clamps: [{use: logger, at: 10 m, label: upper}]}
  - {use: block%s}
"""
ON_IT = """, clamps: [
      {use: logger, at: 500 mm, label: foot}, {use: logger, at: 0, label: lid, volume: 15 L}]"""


def mooring(folder: Path, clamps: str) -> Design:
    path = folder / "mooring.yaml"
    path.write_text(FILE % clamps)
    return Design(read_mooring(path))


def test_by_hand(tmp_path: Path) -> None:
    """(m - 1025 V) g of each, less 10 V g where the water is 1035 kg/m³; nothing of their drag."""
    bare, whole = mooring(tmp_path, "").solve(), mooring(tmp_path, ON_IT).solve()
    added = ((20 - 1025 * 0.01) + (20 - 1025 * 0.015)) * 9.80665
    assert whole.anchor.weight - bare.anchor.weight == pytest.approx(
        added - 10 * (0.01 + 0.015) * 9.80665, abs=1e-9
    )
    assert whole.anchor.tension == bare.anchor.tension
    assert whole.anchor.required_weight == bare.anchor.required_weight
    upper, lid, foot = whole.to_dict()["clamps"]
    assert upper == bare.to_dict()["clamps"][0]
    pull = whole.anchor.tension
    still = {"index": 2, "use": "logger", "x": 0, "y": 0, "tilt": 0, "knockdown": 0}
    assert lid == {**still, "label": "lid", "depth": pytest.approx(99.5), "tension": pull}
    assert foot == {**still, "label": "foot", "depth": pytest.approx(100.0), "tension": pull}


def test_what_else_knows_them(tmp_path: Path) -> None:
    whole = mooring(tmp_path, ON_IT)
    result = whole.solve()
    assert [(item.label, item.clamped_on) for item in inventory_of(whole.leg)][-3:] == [
        ("block", None),
        ("foot", "block"),
        ("lid", "block"),
    ]
    assert [part.label for part in parts_of(whole)] == ["ball", "rope", "upper", "lid", "foot"]
    assert list(result.clamps.label) == ["upper", "lid", "foot"]
    for found in (result, None):
        levels = levels_of(whole.file, found).clamps.values()
        assert sorted(levels)[-2:] == pytest.approx([99.5, 100.0])


def test_in_a_batch(tmp_path: Path) -> None:
    whole = mooring(tmp_path, ON_IT)
    result = whole.solve()
    u, depth = np.array([[0.5, 0.5], [np.nan, np.nan]]), np.array([0.0, 100.0])
    found = solve_profiles(whole, u, 0.0 * u, depth)
    assert found.clamp_label == ("upper", "lid", "foot")
    for name in ("depth", "x", "y", "tension", "tilt", "knockdown"):
        values = getattr(found, f"clamp_{name}")
        expected = getattr(result.clamps, name)[1:]
        assert values[0, 1:] == pytest.approx(expected, abs=1e-3), name
        assert np.isnan(values[1]).all()
