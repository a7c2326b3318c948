"""Smooth shapes and elongation tables, from the file to the figures and warnings of the result."""

from math import pi

import pytest

import calm
from calm.checks.finding import State

FILE = """
environment:
  depth: 300 m
  current: {speed: SPEED, toward: 90 deg}
line:
  - {use: ball, label: top}
  - {use: rope, length: 150 m}
  - {use: block}
components:
  ball: {kind: sphere, diameter: 1.2 m, buoyancy: 6 kN, surface: smooth}
  rope: {kind: cable, diameter: 19 mm, weight: 0.3 N/m, material: nylon, ROPE}
  block: {kind: anchor, weight: 20 kN}
solver: {drag: DRAG}
"""
TABLE = "breaking_load: 60 kN, elongation: [[0.05, 0.05], [0.2, 0.12]], permanent_elongation: 4 %"


@pytest.fixture
def solve(tmp_path):
    def solved(speed="0.5 m/s", drag="constant", rope=TABLE, text=FILE):
        path = tmp_path / "m.yaml"
        text = text.replace("SPEED", speed).replace("DRAG", drag)
        path.write_text(text.replace("ROPE", rope).replace(", }", "}"))
        return calm.load(path).solve()

    return solved


def test_a_smooth_float_in_its_drag_crisis_has_a_third_of_the_drag(solve):
    """1.2 m in 0.5 m/s: Re 4.4e5, where Cx is 0.09 and not 0.5."""
    constant, curve = solve(), solve(drag="reynolds")
    pulls = [result.components for result in (constant, curve)]
    assert pulls[0].reynolds[0] == pytest.approx(0.5 * 1.2 / 1.36e-6)
    drags = [result.design.line.normal_drag[0] for result in (constant, curve)]
    assert drags[0] == drags[1] == pytest.approx(512.5 * 0.5 * pi / 4 * 1.2**2)
    assert curve.top.x < constant.top.x
    assert not any("Reynolds" in text for text in (*constant.warnings, *curve.warnings))


def _of_drag(result):
    return [one for one in calm.check(result.design).all_findings()
            if one.rule == "drag-coefficient"]  # fmt: skip


def test_the_check_says_once_what_a_smooth_float_makes_of_the_knockdown(solve):
    """The effect is that of solving the same line with `drag: reynolds`."""
    constant, curve = solve(), solve(drag="reynolds")
    (found,) = _of_drag(constant)
    assert found.state is State.NOT_JUDGED and found.component == "top"  # less drag is no danger
    assert "The Reynolds number of top is 4.4e5; the drag coefficient is valid up to 2e5." in (
        found.message
    )
    then, now = (f"{each.top.knockdown:.1f} m" for each in (curve, constant))
    assert f"the knockdown would be {then} instead of {now}" in found.message
    assert _of_drag(curve) == []


def test_beyond_its_curve_a_smooth_float_is_not_judged_either(solve):
    (found,) = _of_drag(solve(speed="1.2 m/s", drag="reynolds"))
    assert found.message == (
        "The Reynolds number of top is 1.1e6; the drag coefficient is valid up to 1e6."
    )


def test_a_rope_beyond_its_table(solve):
    """20 % of 60 kN is more than the float lifts, 20 % of 20 kN is less."""
    assert not [text for text in solve().warnings if "elongation" in text]
    weak = solve(rope=TABLE.replace("60 kN", "20 kN"))
    [told] = [text for text in weak.warnings if "elongation" in text]
    assert told.startswith("Tension in rope is 60")
    assert told.endswith("N; its elongation table is valid up to 4000 N.")


def test_a_rope_stretches_by_its_table_and_thins(solve):
    """6 kN is a tenth of the breaking load: between 5 and 12 %, and 4 % that stay."""
    result = solve()
    strain = result.components.length[1] / 150.0 - 1.0
    assert 0.09 < strain < 0.16
    assert not [text for text in result.warnings if "stretches" in text or "stiffness" in text]


@pytest.mark.parametrize(
    ("material", "told"),
    [
        ("nylon", "published values differ by a factor of 9; at this "
         "tension they give a stretch of 1.6 to 14 %."),
        ("Dyneema", "published values differ by a factor of 2.4; at this "
         "tension they give a stretch of 0.021 to 0.05 %."),
        ("kevlar", "the single published value gives a stretch of 0.031 %."),
        ("vectran", "no stiffness of such ropes has been published."),
    ],
)  # fmt: skip
def test_an_unknown_stiffness_is_told_with_its_spread(solve, material, told):
    """19 mm under 6 kN, 612 kgf; 1000 kgf stretch the nylon by 23, 10 or 2.6 %, it is printed."""
    result = solve(rope="", text=FILE.replace("nylon", material))
    expected = f"rope ({material}) has no stiffness and is assumed inextensible; {told}"
    assert expected in result.warnings


def test_a_tow_names_the_cable_that_is_beyond_its_table(tmp_path):
    path = tmp_path / "tow.yaml"
    path.write_text(
        """
tow: {speed: 1 m/s, toward: 0 deg}
line:
  - {use: rope, label: upper, length: 20 m, breaking_load: 3 kN}
  - {use: rope, label: lower, length: 20 m}
  - {use: fish}
components:
  rope: {kind: cable, diameter: 10 mm, weight: 0.3 N/m, breaking_load: 30 kN,
    elongation: [[0.1, 0.02], [0.5, 0.04]]}
  fish: {kind: body, length: 1 m, buoyancy: -2 kN, drag_area: 0.1 m^2, cd: 1}
"""
    )
    [told] = [text for text in calm.load(path).solve().warnings if "elongation" in text]
    assert told.startswith("Tension in upper is ")


def test_a_rope_with_a_table_is_cut_to_fit_as_exactly_as_any(solve):
    """The still line is marched in long segments: a bend of the table in one costs micrometres."""
    text = FILE.replace("length: 150 m", "length: fit, top_depth: 80 m")
    text = text.replace("weight: 0.3 N/m", "weight: 12 N/m")
    result = solve(text=text)
    assert result.components.cut_length[1] < 200.0
    assert result.still_shape.depth[0] == pytest.approx(80.0, abs=1e-4)
