"""How sure the figures are: against closed forms, and against samples that are solved in full."""

from dataclasses import replace
from math import cos, log, radians, sin, sqrt
from pathlib import Path

import numpy as np
import pytest

import calm
from calm.case.draws import (
    CAUSES,
    Draw,
    drawn,
    drawn_line,
    drawn_water,
    draws_of,
    normals_of,
)
from calm.case.uncertain import sobol_indices, uncertain
from calm.errors import NoEquilibrium, UsageError
from calm.files import Spread, Uncertainty
from calm.physics.stretch import ElongationCurve
from calm.solve import solve_mooring

LINES = Path(__file__).parents[3] / "lines"
AT_95 = 1.6448536269514722

PLUMB = """
environment: {depth: 500 m}
line:
  - {use: ball, label: top float}
  - {use: thread, length: 400 m}
  - {use: block}
uncertainty: {UNSURE}
components:
  ball: {kind: sphere, diameter: 1 m, buoyancy: 4 kN}
  thread: {kind: cable, diameter: 8 mm, weight: 1 N/m, stiffness: 200 kN}
  block: {kind: anchor, weight: 20 kN}
"""
SURE = dict.fromkeys(CAUSES, "0")


def plumb(text=PLUMB, **unsure):
    """A line in still water; nothing is unsure but what is named."""
    said = "{" + ", ".join(f"{name}: {value}" for name, value in (SURE | unsure).items()) + "}"
    return calm.load("plumb.yaml", text=text.replace("{UNSURE}", said))


def test_a_deviation_is_one_of_a_normal_and_a_pair_its_5_and_95_percent():
    given = Uncertainty.model_validate(
        {"current": "10 %", "direction": "6 deg", "cable_drag": ["-15 %", "30 %"]}
    )
    normals = np.zeros((3, len(CAUSES)))
    normals[1], normals[2] = -AT_95, AT_95
    middle, low, high = draws_of(given, normals)
    assert (middle.current, middle.direction, middle.length) == (1.0, 0.0, 1.0)
    assert middle.cable_drag == pytest.approx(sqrt(0.85 * 1.30))
    assert [low.cable_drag, high.cable_drag] == pytest.approx([0.85, 1.30])
    assert [low.current, high.current] == pytest.approx([1 - 0.1 * AT_95, 1 + 0.1 * AT_95])
    assert [low.direction, high.direction] == pytest.approx([-6 * AT_95, 6 * AT_95])
    turned = Uncertainty.model_validate({"direction": ["-10 deg", "30 deg"]})
    assert [one.direction for one in draws_of(turned, normals)] == pytest.approx([10, -10, 30])


def test_a_factor_stays_positive():
    given = Uncertainty.model_validate({"current": "25 %"})
    (draw,) = draws_of(given, np.full((1, len(CAUSES)), -7.0))
    assert draw.current == 0.01


def test_the_draws_are_normal_and_those_of_their_seed():
    normals = normals_of(1024, 3)
    assert np.percentile(normals, 95.0, axis=0) == pytest.approx(AT_95, abs=0.02)
    assert np.corrcoef(normals.T) == pytest.approx(np.eye(len(CAUSES)), abs=0.05)
    assert (normals_of(1024, 3) == normals).all()
    assert (normals_of(1024, 4) != normals).any()


def test_each_factor_is_of_what_it_says():
    mooring = calm.load(LINES / "deep-current-meters.yaml")
    given, cable = mooring.line, mooring.line.flexible
    rises = ~cable & (given.buoyancy > 0.0)

    def changed(**factors):
        return drawn_line(given, Draw(**factors))

    drag = changed(cable_drag=1.3)
    assert drag.normal_drag[cable] == pytest.approx(1.3 * given.normal_drag[cable])
    assert drag.tangential_drag[cable] == pytest.approx(1.3 * given.tangential_drag[cable])
    assert (drag.normal_drag[~cable] == given.normal_drag[~cable]).all()
    assert (drag.clamp_drag == given.clamp_drag).all()
    rigid = changed(rigid_drag=1.2)
    assert rigid.normal_drag[~cable] == pytest.approx(1.2 * given.normal_drag[~cable])
    assert rigid.clamp_drag == pytest.approx(1.2 * given.clamp_drag)
    assert (rigid.normal_drag[cable] == given.normal_drag[cable]).all()
    buoyant = changed(buoyancy=1.1)
    assert buoyant.buoyancy[rises] == pytest.approx(1.1 * given.buoyancy[rises])
    assert (buoyant.buoyancy[~rises] == given.buoyancy[~rises]).all()
    heavy = changed(cable_weight=1.05)
    assert heavy.buoyancy[cable] == pytest.approx(1.05 * given.buoyancy[cable])
    assert (heavy.buoyancy[~cable] == given.buoyancy[~cable]).all()
    long = changed(length=1.01)
    assert long.length[cable] == pytest.approx(1.01 * given.length[cable])
    assert (long.length[~cable] == given.length[~cable]).all()
    assert long.clamp_at == pytest.approx(1.01 * given.clamp_at)
    assert changed(stiffness=1.25).compliance == pytest.approx(given.compliance / 1.25)


def test_what_lifts_on_a_clamp_is_buoyant_and_what_weighs_is_not():
    clamps = "clamps: [{use: ball, at: 10 m}, {use: bar, at: 20 m}]"
    text = PLUMB.replace("length: 400 m", f"length: 400 m, {clamps}").replace("{UNSURE}", "{}")
    bar = "  bar: {kind: cylinder, diameter: 0.1 m, length: 1 m, buoyancy: -50 N}\n"
    line = calm.load("plumb.yaml", text=text + bar).line
    assert drawn_line(line, Draw(buoyancy=1.1)).clamp_buoyancy == pytest.approx([4400.0, -50.0])


def test_a_float_afloat_that_lifts_more_weighs_less_and_displaces_the_same():
    line = calm.load(LINES / "taut-nylon-surface.yaml").line
    given, drawn = line.floating, drawn_line(line, Draw(buoyancy=1.1)).floating
    assert drawn.lift - given.lift == pytest.approx(0.1 * line.buoyancy[0])
    assert drawn.lift + drawn.weight == pytest.approx(given.lift + given.weight)
    assert drawn.lift > given.lift


def test_a_stiffer_rope_stretches_less_by_its_table():
    curve = ElongationCurve([(0.1, 0.03), (0.3, 0.08), (0.7, 0.14)], 60e3, permanent=0.02)
    line = calm.load(LINES / "s1000.yaml").line
    line = replace(line, elongation=(None, curve, *(None,) * (len(line.length) - 2)))
    stiffer = drawn_line(line, Draw(stiffness=1.6)).elongation[1]
    for share in (0.05, 0.2, 0.5, 0.9):
        assert stiffer.strain(share * 60e3) == pytest.approx(curve.strain(share * 60e3) / 1.6)
    assert (stiffer.limit, stiffer.breaking_load) == (curve.limit, 60e3)


def test_the_current_grows_and_turns_clockwise():
    water = calm.load(LINES / "veering-current.yaml").water
    turned = drawn_water(water, Draw(current=1.5, direction=30.0, depth=1.02))
    speed, angle = np.hypot(water.u, water.v), np.arctan2(water.u, water.v)
    assert turned.u == pytest.approx(1.5 * speed * np.sin(angle + radians(30.0)))
    assert turned.v == pytest.approx(1.5 * speed * np.cos(angle + radians(30.0)))
    assert turned.depth == pytest.approx(1.02 * water.depth)
    assert (turned.level == water.level).all()
    rising = replace(water, w=np.full(len(water.u), 0.02))
    assert drawn_water(rising, Draw(current=1.5)).w == pytest.approx(np.full(len(water.u), 0.03))
    east = drawn_water(water, Draw(direction=90.0))
    assert east.u == pytest.approx(water.u * cos(radians(90)) + water.v * sin(radians(90)))


def test_an_unsure_depth_is_that_of_the_top():
    # upright: the top is as high above the seabed whatever the depth
    found = uncertain(plumb(depth="1 %").solve(), 512)
    given = found.result.top.depth
    assert found.depth_top[:, 0] == pytest.approx(
        [given - AT_95 * 5.0, given, given + AT_95 * 5.0], abs=0.05
    )  # of the percentiles of 512 points of a Sobol' sequence
    assert found.tension[:, 0] == pytest.approx(3996.0, rel=0.02)
    assert np.ptp(found.tension, axis=0) == pytest.approx(0.0, abs=1e-6)


def test_an_unsure_length_is_that_of_the_cable():
    dotted = PLUMB.replace("400 m}", "400 m, clamps: [{use: dot, label: dot, at: 300 m}]}")
    dotted += "  dot: {kind: cylinder, diameter: 1 mm, length: 1 mm, buoyancy: 0 N}\n"
    found = uncertain(plumb(dotted, length="1 %").solve(), 512)
    spread = found.depth_top[2, 0] - found.depth_top[0, 0]
    # the stretch grows with the length: N/EA = (4000 - 200)/200 000 on the average
    assert spread == pytest.approx(2 * AT_95 * 4.0 * 1.019, rel=0.01)
    (dot,) = found.to_dict()["clamps"]
    # a quarter of the cable is below it, which pulls with 3600 to 3700 N
    assert dot["depth"][2] - dot["depth"][0] == pytest.approx(2 * AT_95 * 1.01825, rel=0.01)
    assert dot["tension"][1] == pytest.approx(3700.0, rel=1e-3)
    assert (dot["index"], dot["label"]) == (1, "dot")


def test_an_unsure_buoyancy_pulls_at_the_anchor():
    found = uncertain(plumb(buoyancy="[-10 %, 20 %]").solve(), 256)
    weight = 400.0
    pull = [0.9 * 4000 - weight, 4000 * sqrt(0.9 * 1.2) - weight, 1.2 * 4000 - weight]
    assert found.anchor_tension == pytest.approx(pull, rel=2e-3)
    assert found.required_weight == pytest.approx([1.5 * one for one in pull], rel=2e-3)


def test_an_unsure_weight_of_cable_is_lifted():
    found = uncertain(plumb(cable_weight="10 %").solve(), 256)
    pull = [3600 - AT_95 * 40, 3600, 3600 + AT_95 * 40]
    assert found.anchor_tension == pytest.approx(pull, rel=1e-3)


def test_an_unsure_stiffness_is_that_of_the_stretch():
    found = uncertain(plumb(stiffness="[-20 %, 25 %]").solve(), 512)
    stretch = 400 * 3800 / 200e3
    upper, lower = found.depth_top[0, 0], found.depth_top[2, 0]
    assert lower - upper == pytest.approx(stretch / 0.8 - stretch / 1.25, rel=0.01)


def test_nothing_unsure_is_no_spread():
    found = uncertain(plumb().solve(), 64)
    assert np.ptp(found.depth_top, axis=0).max() < 1e-9
    assert found.contributions == ()


def test_offsets_are_those_the_way_the_free_end_is_off():
    """In a current that goes neither along the north nor the east."""
    text = PLUMB.replace("500 m}", "500 m, current: {speed: 0.4 m/s, toward: 215 deg}}", 1)
    said = "{" + ", ".join(f"{name}: 0" for name in CAUSES) + "}"
    result = calm.load("plumb.yaml", text=text.replace("{UNSURE}", said)).solve()
    found = uncertain(result, 64)
    off = sqrt(result.top.x**2 + result.top.y**2)
    # the result is extrapolated, the draws are not
    assert found.offset[:, 0] == pytest.approx([off] * 3, abs=2.0 * result.accuracy.depth)
    assert off > 10.0
    assert (np.diff(found.offset[1]) < 0.0).all()  # down the line, to the anchor


def test_the_knockdown_of_a_sphere_follows_the_square_of_the_current():
    # a float on a line without drag: knockdown = L (1 - cos(atan(K U²/B)))
    text = """
environment: {depth: 200 m, current: {speed: 1 m/s, toward: 90 deg}}
line:
  - {use: ball}
  - {use: thread, length: 100 m}
  - {use: block}
uncertainty: {current: [-20 %, 20 %], direction: 0, cable_drag: 0, rigid_drag: 0, buoyancy: 0,
  cable_weight: 0, length: 0, stiffness: 0, depth: 0}
components:
  ball: {kind: body, length: 0 m, buoyancy: 1 kN, kn: 400 N/(m/s)^2, inclination: insensitive}
  thread: {kind: cable, diameter: 1 mm, weight: 0 N/m, cn: 0, ct: 0}
  block: {kind: anchor, weight: 20 kN}
"""
    found = uncertain(calm.load("sphere.yaml", text=text).solve(), 256)
    speeds = np.array([0.8, sqrt(0.8 * 1.2), 1.2])
    knockdown = 100.0 * (1.0 - np.cos(np.arctan(0.4 * speeds**2)))
    assert found.knockdown[:, 0] == pytest.approx(knockdown, rel=0.01)
    assert found.contributions[0].cause == "current"
    assert found.contributions[0].first == pytest.approx(1.0, abs=0.01)
    assert found.contributions[0].quantity == "knockdown"


@pytest.mark.parametrize(
    "name", ["s1000", "tidal-adcp", "chain-and-rope-surface", "taut-nylon-surface"]
)
def test_a_sample_is_what_a_full_solution_gives(name):
    """Its cuts are those of the mooring as given; the promise of 5e-5 of the depth holds."""
    mooring = calm.load(LINES / f"{name}.yaml")
    draws = draws_of(mooring.file.uncertainty, normals_of(64, 1))[:6]
    for one in drawn(mooring.leg, draws):
        try:
            quick = one.equilibrium()
        except NoEquilibrium as failure:
            with pytest.raises(NoEquilibrium) as again:
                solve_mooring(one.line, one.water, one.settings)
            assert again.value.status == failure.status
            continue
        full = solve_mooring(one.line, one.water, one.settings)
        assert quick.position[0] == pytest.approx(full.position[0], abs=1e-4 * one.water.depth)
        assert quick.tension[-1] == pytest.approx(full.tension[-1], rel=4e-4)
        assert quick.landed == full.landed


def test_samples_without_equilibrium_are_counted_and_left_out():
    text = PLUMB.replace("weight: 20 kN", "weight: 3.8 kN").replace("{UNSURE}", "{buoyancy: 10 %}")
    found = uncertain(calm.load("light.yaml", text=text).solve(), 256)
    assert found.failures.keys() == {"anchor-lifts"}
    # lifted where 4000 b - 400 > 3800, at b > 1.05, half a deviation; other causes are small
    assert found.failed / 256 == pytest.approx(0.31, abs=0.02)
    assert found.anchor_tension[2] <= 3800.0


def test_no_sample_stands():
    text = PLUMB.replace("weight: 20 kN", "weight: 3.61 kN")
    text = text.replace("{UNSURE}", "{buoyancy: [20 %, 30 %]}")
    with pytest.raises(NoEquilibrium, match="vertical load"):
        uncertain(calm.load("light.yaml", text=text).solve(), 64)


@pytest.mark.thorough
def test_the_figures_are_those_of_their_seed_however_they_are_shared_out():
    result = calm.load(LINES / "s1000.yaml").solve()
    once = uncertain(result, 64, seed=5).to_dict()
    assert (
        uncertain(result, 64, 5, lambda function, tasks: [function(one) for one in tasks]).to_dict()
        == once
    )
    assert uncertain(result, 64, seed=6).to_dict() != once


@pytest.mark.parametrize(
    ("samples", "near"), [(1000, 1024), (0, 64), (-5, 64), (63, 64), (2**21, 2**20)]
)
def test_samples_are_a_power_of_two(samples, near):
    with pytest.raises(UsageError, match=f"{samples} is not a power of two .* use {near}"):
        uncertain(calm.load(LINES / "s1000.yaml").solve(), samples)


def test_the_pairs_are_of_logarithms():
    assert Spread(between=(-0.15, 0.3)) == Uncertainty().cable_drag
    assert log(1.3) - log(0.85) == pytest.approx(0.4249, abs=1e-4)


def test_shares_of_a_polynomial_are_those_of_its_squared_coefficients():
    """y = 3 z₁ + 0.5 (z₁³ - 3 z₁) + 2 z₁ z₂ + (z₂² - 1): the variances of the terms are 9, 6/4, 4
    and 2, and their sum is 16.5. With z₁⁴ - 6 z₁² + 3, at a right angle to all terms, 24 more are
    not explained.

    Tolerance: the square root of the number of samples.
    """
    normals = np.random.default_rng(3).standard_normal((200_000, 2))
    one, two = normals.T
    values = 3.0 * one + 0.5 * (one**3 - 3.0 * one) + 2.0 * one * two + two**2 - 1.0
    found = sobol_indices(normals, values)
    assert found.first == pytest.approx([10.5 / 16.5, 2.0 / 16.5], abs=0.01)
    assert found.total == pytest.approx([14.5 / 16.5, 6.0 / 16.5], abs=0.01)
    assert found.unexplained == pytest.approx(0.0, abs=1e-12)
    fourth = one**4 - 6.0 * one**2 + 3.0
    more = sobol_indices(normals, values + fourth)
    assert more.unexplained == pytest.approx(24.0 / 40.5, abs=0.02)
    assert more.first == pytest.approx([10.5 / 40.5, 2.0 / 40.5], abs=0.02)
