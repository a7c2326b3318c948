"""What a piece may bear, and which piece is the weak link, by hand."""

from pathlib import Path

import pytest

import calm
from calm.checks.finding import State
from calm.checks.strength import allowable_load, governing_load, passes_load_on, strength_steps
from calm.errors import InputError
from calm.files import Cable, SafetyFactors

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
  ball: {kind: sphere, role: float, diameter: 1 m, buoyancy: 5 kN}
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
    (verdict,) = strength_steps.judge(mooring.solve().leg)
    assert (verdict.component, verdict.limit, verdict.state) == ("link", limit, state)


@pytest.mark.parametrize(
    ("length", "buoyancy", "asked"),
    [("0 m", "-0.01 N", False), ("0 m", "-5 N", True), ("0.1 m", "-0.01 N", True)],
)
def test_a_hinge_of_another_programs_design_is_asked_no_load(
    length: str, buoyancy: str, asked: bool, tmp_path: Path
) -> None:
    text = (
        LINE.replace("UPPER", "60 kN").replace("LOWER", "60 kN").replace(", working_load: LINK", "")
    )
    text = text.replace("length: 0.1 m, buoyancy: -5 N", f"length: {length}, buoyancy: {buoyancy}")
    (tmp_path / "m.yaml").write_text(text, encoding="utf-8")
    mooring = calm.load(tmp_path / "m.yaml")
    assert passes_load_on(mooring.file, 2) is asked


@pytest.mark.parametrize(
    ("loads", "working_factor", "factor", "limit"),
    [
        ({"working_load": "10 kN", "breaking_load": "60 kN"}, 1.0, 3.0, 10e3),
        ({"working_load": "25 kN", "breaking_load": "60 kN"}, 1.0, 3.0, 20e3),
        ({"working_load": "10 kN", "breaking_load": "60 kN"}, 1.5, 2.0, 15e3),
        ({"working_load": "25 kN", "breaking_load": "60 kN"}, 1.5, 2.0, 30e3),
        ({"working_load": "10 kN"}, 1.5, 2.0, 15e3),
        ({"breaking_load": "60 kN"}, 1.5, 2.0, 30e3),
        ({}, 1.0, 3.0, None),
    ],
)
def test_the_lesser_of_working_load_and_breaking_load_over_the_factor(
    loads: dict[str, str], working_factor: float, factor: float, limit: float | None
) -> None:
    rope = Cable.model_validate({"kind": "cable", "diameter": "20 mm", "weight": "1 N/m"} | loads)
    assert governing_load(rope, working_factor, factor)[0] == limit


@pytest.mark.parametrize(
    ("material", "surface", "limit"),
    [("steel", False, 20e3), ("nylon", False, 15e3), ("steel", True, 12e3), ("nylon", True, 12e3)],
)
def test_the_factor_of_a_surface_mooring_is_never_bypassed(
    material: str, surface: bool, limit: float
) -> None:
    keys = {"kind": "cable", "diameter": "20 mm", "weight": "1 N/m", "material": material}
    rope = Cable.model_validate(keys | {"working_load": "30 kN", "breaking_load": "60 kN"})
    factors = SafetyFactors(steel=3.0, synthetic=4.0, surface=5.0)
    assert allowable_load(rope, factors, surface) == limit


def test_a_working_load_above_the_breaking_load_is_a_mistake(tmp_path: Path) -> None:
    text = LINE.replace("UPPER", "20 kN, breaking_load: 19 kN").replace("LINK", "9 kN")
    path = tmp_path / "m.yaml"
    path.write_text(text.replace("LOWER", "20 kN"), encoding="utf-8")
    with pytest.raises(InputError, match="20000 N, above the `breaking_load` of 19000 N"):
        calm.load(path)


def test_a_synthetic_rope_is_judged_by_its_breaking_load() -> None:
    """Polyester of 14 mm: the table's 2390 N are for lifting, a twelfth of its 28.6 kN."""
    keys = {"kind": "cable", "diameter": "14 mm", "weight": "0.4 N/m", "material": "polyester"}
    both = Cable.model_validate(keys | {"working_load": "2390 N", "breaking_load": "28.6 kN"})
    factors = SafetyFactors()
    assert allowable_load(both, factors, surface=False) == pytest.approx(28_600.0 / 5.0)
    assert governing_load(both, 1.0, 2.0)[0] == pytest.approx(14_300.0)
    alone = Cable.model_validate(keys | {"working_load": "2390 N"})
    assert allowable_load(alone, factors, surface=False) == pytest.approx(2390.0)
    steel = Cable.model_validate(
        keys | {"material": "steel", "working_load": "2390 N", "breaking_load": "28.6 kN"}
    )
    assert allowable_load(steel, factors, surface=False) == pytest.approx(2390.0)


def test_what_bears_less_than_half_of_its_load_is_no_weak_link(tmp_path: Path) -> None:
    """The ball pulls with some 5 kN, less than half of what the link is good for."""
    text = LINE.replace("UPPER", "60 kN").replace("LINK", "11 kN").replace("LOWER", "60 kN")
    (tmp_path / "m.yaml").write_text(text, encoding="utf-8")
    found = list(strength_steps.judge(calm.load(tmp_path / "m.yaml").solve().leg))
    assert not [one for one in found if one.state is State.WARN]
