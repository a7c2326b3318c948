"""Lines that no sea has are refused at once, with the reason."""

from pathlib import Path

import pytest

import calm
from calm.errors import NoEquilibrium

MOORING = """\
name: absurd
environment: {{depth: {depth} m, current: {{speed: 0.3 m/s, toward: 90 deg}}}}
line: [{line}, {{use: weight}}]
components:
  ball: {{kind: sphere, role: float, diameter: 1 m, buoyancy: 2000 N}}
  small: {{kind: sphere, role: float, diameter: 0.3 m, buoyancy: 20 N}}
  rope: {{kind: cable, diameter: 10 mm, weight: 2 N/m}}
  weight: {{kind: anchor, weight: 50000 N}}
"""
LONG = "{use: ball}, {use: rope, length: 4200 m}"
STACK = "{use: small, count: 1000}, {use: rope, length: 20 m}"


@pytest.mark.parametrize(
    ("depth", "line", "status", "why"),
    [
        (1, LONG, "not-converged", "The line is 4201 m long, 4201 times the water depth"),
        (8, LONG, "not-converged", "525 times the water depth; the limit is 500 times"),
        (100, STACK, "above-surface", "More than 16 consecutive floats would lie at the surface"),
    ],
)
def test_it_is_refused(tmp_path: Path, depth: int, line: str, status: str, why: str) -> None:
    (tmp_path / "m.yaml").write_text(MOORING.format(depth=depth, line=line))
    with pytest.raises(NoEquilibrium, match=why) as caught:
        calm.load(tmp_path / "m.yaml").solve()
    assert caught.value.status == status


def test_a_line_105_times_as_long_as_the_water_is_deep_is_solved(tmp_path: Path) -> None:
    """Nearly all of it lies on the seabed."""
    (tmp_path / "m.yaml").write_text(MOORING.format(depth=40, line=LONG))
    result = calm.load(tmp_path / "m.yaml").solve()
    assert result.anchor.grounded_length > 4000.0
