"""What a piece may bear, and which piece is the weak link, by hand."""

from pathlib import Path

import pytest

import calm
from calm.checks.finding import State
from calm.checks.strength import strength_steps

LINE = """\
name: weak link
environment:
  depth: 500 m
  current: {speed: 0.2 m/s, toward: 90 deg}
line:
  - {use: ball}
  - {use: rope, label: upper, length: 100 m, working_load: UPPER}
  - {use: link, label: link, working_load: LINK}
  - {use: rope, label: lower, length: 100 m, working_load: LOWER}
  - {use: weight}
components:
  ball: {kind: sphere, role: float, diameter: 1 m, buoyancy: 3 kN}
  rope: {kind: cable, diameter: 8 mm, weight: 1.6 N/m, stiffness: 3000 kN}
  link: {kind: body, role: connector, length: 0.1 m, buoyancy: -5 N, kn: 1 N/(m/s)^2,
         inclination: insensitive}
  weight: {kind: anchor, weight: 20 kN}
"""


@pytest.mark.parametrize(
    ("upper", "link", "lower", "limit", "state"),
    [
        # half of the weaker cable, 10 kN, whichever side it is on
        ("60 kN", "11 kN", "20 kN", 10_000.0, State.PASS),
        ("20 kN", "11 kN", "60 kN", 10_000.0, State.PASS),
        ("60 kN", "9 kN", "20 kN", 10_000.0, State.WARN),
        ("20 kN", "9 kN", "60 kN", 10_000.0, State.WARN),
    ],
)
def test_a_weak_link_is_weak_beside_the_weaker_of_its_cables(
    upper: str, link: str, lower: str, limit: float, state: State, tmp_path: Path
) -> None:
    text = LINE.replace("UPPER", upper).replace("LINK", link).replace("LOWER", lower)
    path = tmp_path / "m.yaml"
    path.write_text(text, encoding="utf-8")
    mooring = calm.load(path)
    assert isinstance(mooring, calm.Mooring)
    (verdict,) = strength_steps.judge(mooring.solve())
    assert (verdict.component, verdict.limit, verdict.state) == ("link", limit, state)
