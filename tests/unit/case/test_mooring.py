"""From a file to its result: every figure of the result format, on a line done by hand."""

import json
from math import hypot, inf

import numpy as np
import pytest

import calm
from calm.checks.posture import watch_circle

FILE = """
name: By hand
environment:
  depth: 200 m
  current: {speed: SPEED, toward: 90 deg}
line:
  - {use: ball, label: top}
  - {use: thin, length: 80 m, clamps: [{use: logger, at: 30 m}]}
  - {use: meter}
  - {use: thin, length: 40 m, breaking_load: 20 kN}
  - {use: block}
components:
  ball: {kind: sphere, diameter: 1 m, buoyancy: 3000 N, cx: 0.6, source: test}
  thin: {kind: cable, diameter: 8 mm, weight: 1 N/m, working_load: 10 kN, source: test}
  meter: {kind: cylinder, diameter: 0.1 m, length: 1 m, buoyancy: -100 N, max_tilt: 3 deg}
  logger: {kind: cylinder, diameter: 50 mm, length: 0.3 m, buoyancy: -20 N, source: test}
  block: {kind: anchor, weight: 6 kN, length: 0.5 m, source: test}
"""


@pytest.fixture
def solve(tmp_path):
    def solved(text=FILE, speed="0.6 m/s", **kwargs):
        path = tmp_path / "m.yaml"
        path.write_text(text.replace("SPEED", speed))
        return calm.load(path, **kwargs).solve()

    return solved


def test_still_water_by_hand(solve):
    result = solve(speed="0 m/s")
    c = result.components
    assert c.depth_top == pytest.approx([77.5, 78.5, 158.5, 159.5, 199.5])
    assert c.depth_bottom == pytest.approx([78.5, 158.5, 159.5, 199.5, 200])
    assert c.tension_top == pytest.approx([0, 3000, 2900, 2800, 2760])
    assert c.tension_bottom == pytest.approx([3000, 2900, 2800, 2760, 2760])
    assert c.knockdown == pytest.approx([0] * 5)
    assert c.tilt == pytest.approx([0] * 5)
    assert result.clamps[0].depth == pytest.approx(108.5)
    assert result.clamps[0].tension == pytest.approx(2970)
    assert result.anchor.vertical == pytest.approx(2760)
    assert result.anchor.horizontal == pytest.approx(0)


def test_figures_hang_together_in_a_current(solve):
    result = solve()
    c, top, anchor = result.components, result.top, result.anchor
    assert (top.depth, top.x, top.y) == (c.depth_top[0], c.x_top[0], c.y_top[0])
    logger = result.clamps[0]  # 108.5 m deep in still water
    assert logger.knockdown == pytest.approx(logger.depth - 108.5, abs=1e-4)
    assert logger.knockdown > 0.1
    assert top.x > 5
    assert abs(top.y) < 1e-9
    assert c.knockdown[0] == pytest.approx(c.depth_top[0] - 77.5, abs=1e-4)
    assert (c.depth_bottom[:-1] == c.depth_top[1:]).all()
    assert (c.x_bottom[:-1] == c.x_top[1:]).all()
    assert c.tension == pytest.approx(np.maximum(c.tension_top, c.tension_bottom))
    assert np.isnan(c.safety_factor[[0, 1, 2, 4]]).all()
    assert c.safety_factor[3] == pytest.approx(20000 / c.tension[3])
    assert c.utilisation[1] == pytest.approx(c.tension[1] / 10000)
    chord = np.hypot(c.x_top - c.x_bottom, c.y_top - c.y_bottom)
    lean = np.degrees(np.arctan2(chord, c.depth_bottom - c.depth_top))
    assert c.tilt == pytest.approx(lean)
    assert anchor.tension == pytest.approx(hypot(anchor.vertical, anchor.horizontal))
    assert anchor.required_weight == pytest.approx(
        1.5 * (anchor.vertical + anchor.horizontal / 0.6)
    )
    assert result.shape.depth[0] == top.depth
    assert result.shape.depth[-1] == pytest.approx(199.5, abs=2e-5)
    assert (np.diff(np.flatnonzero(np.diff(result.shape.depth) == 0)) >= 0).all()
    assert result.still_shape is not None
    assert result.still_shape.depth[0] == pytest.approx(77.5, abs=1e-4)


def test_the_result_is_plain_json(solve):
    data = solve().to_dict()
    again = json.loads(json.dumps(data, allow_nan=False))
    assert again == data
    assert data["status"] == "converged"
    assert data["type"] == "subsurface"
    assert data["components"][0]["safety_factor"] is None
    assert set(data["components"][0]) >= {
        "index", "use", "label", "length", "depth_top", "depth_bottom", "x_top", "y_top",
        "x_bottom", "y_bottom", "tension_top", "tension_bottom", "tilt", "knockdown",
        "cut_length", "safety_factor", "utilisation",
    }  # fmt: skip
    assert set(data["clamps"][0]) == {
        "index", "use", "label", "depth", "planned_depth", "x", "y", "tension", "tilt", "knockdown",
    }  # fmt: skip
    assert set(data["top"]) == {
        "depth", "x", "y", "knockdown", "used_buoyancy", "reserve", "draft", "freeboard",
    }  # fmt: skip
    assert set(data["anchor"]) >= {
        "tension", "vertical", "horizontal", "angle", "required_weight", "grounded_length",
    }  # fmt: skip
    assert set(data["shape"]) == {"depth", "x", "y", "tension", "tilt"}
    assert len({len(column) for column in data["shape"].values()}) == 1


def test_tables_as_records_and_data_frame(solve):
    result = solve()
    assert [row.label for row in result.components][:2] == ["top", "thin 1"]
    frame = result.to_pandas()
    assert list(frame.label) == result.components.label
    assert frame.depth_top.to_numpy() == pytest.approx(result.components.depth_top)
    assert len(result.clamps.to_pandas()) == 1
    assert list(result.shape.to_pandas().depth) == list(result.shape.depth)
    tension = result.components.to_xarray().tension.sel(label="thin 1")
    assert (float(tension), tension.units) == (result.components["thin 1"].tension, "N")
    assert result.shape.to_xarray().depth.values.tolist() == result.shape.depth.tolist()
    assert "<table" in result._repr_html_()


def test_what_python_shows_of_a_result_is_short(solve):
    result = solve()
    shown = repr(result).splitlines()
    assert len(shown) == 4 and shown[1].startswith(f"top: depth {result.top.depth:.6g}, x ")
    assessment = calm.check(result.design)
    assert repr(assessment).startswith(f"{assessment.name}: {assessment.state} (")
    assert max(len(repr(row.part)) for row in result.components) < 800


def test_warnings_tell_what_to_look_at(solve):
    told = " ".join(solve(speed="1.2 m/s").warnings)
    assert "meter tilts by" in told
    assert "is required to hold the mooring" in told


@pytest.mark.parametrize(("depth", "told"), [("40 m", True), ("70 m", False)])
def test_a_line_that_is_far_too_long_for_its_water_is_doubted(solve, depth, told):
    """Of 122 m of line at the surface, wire lies in 40 m of water; in 70 m it may be meant."""
    text = FILE.replace("depth: 200 m", f"depth: {depth}").replace("weight: 1 N/m", "weight: 9 N/m")
    text = FILE.replace("depth: 200 m", f"depth: {depth}").replace("weight: 1 N/m", "weight: 9 N/m")
    warnings = " ".join(solve(text).warnings)
    assert ("Scope (line length over water depth) is 3.0, and thin" in warnings) is told
    assert ("check `depth` and its unit" in warnings) is told


def test_an_anchor_that_is_too_light_is_lifted(solve):
    with pytest.raises(calm.NoEquilibrium) as caught:
        solve(FILE.replace("6 kN", "2 kN"))
    assert caught.value.status == "anchor-lifts"
    assert "2000 N" in caught.value.message


SHALLOW = FILE.replace("depth: 200 m", "depth: 121.5 m")
WEIGHED = SHALLOW.replace("buoyancy: 3000 N", "buoyancy: 3000 N, mass: 100 kg")
WINDY = "  wind: {speed: 15 m/s, toward: 90 deg}\nline:"


def test_a_float_at_the_surface_sits_at_its_draft(solve):
    result = solve(WEIGHED)
    assert result.type == "surface"
    top = result.top
    assert top.draft + top.freeboard == pytest.approx(1)
    # 100 kg and what the line pulls, of 100 kg and 3000 N
    weight, used = 100 * 9.80665, 3000 - top.reserve
    draft = top.draft
    assert draft**2 * (3 - 2 * draft) == pytest.approx((weight + used) / (weight + 3000))
    lean = np.cos(np.radians(result.components.tilt[0]))
    assert top.depth == pytest.approx(-top.freeboard * lean, abs=1e-9)
    assert result.top.knockdown is None
    assert not any("draft" in warning for warning in result.warnings)
    assert result.to_dict()["top"]["draft"] == draft


def test_wind_takes_it_further(solve):
    still, windy = solve(WEIGHED), solve(WEIGHED.replace("line:", WINDY))
    assert windy.top.x > still.top.x + 0.01
    assert windy.anchor.horizontal > still.anchor.horizontal
    assert not any("wind" in warning for warning in windy.warnings)


def test_full_drag_knows_no_draft_and_no_wind(solve):
    full = "solver: {buoy_drag: full}\n"
    result = solve(WEIGHED.replace("line:", WINDY) + full)
    assert (result.top.depth, result.top.draft, result.top.freeboard) == (0, None, None)
    assert result.top.x == solve(WEIGHED + full).top.x
    assert any("Wind on the float" in warning for warning in result.warnings)


def test_a_float_without_mass_or_volume_is_taken_as_just_immersed(solve):
    result, full = solve(SHALLOW), solve(SHALLOW + "solver: {buoy_drag: full}\n")
    (told,) = set(result.warnings) - set(full.warnings)
    assert "because top has no hull, or neither mass nor volume; the float is treated" in told
    assert result.top.depth == 0
    assert (result.shape.depth == full.shape.depth).all()
    assert (result.shape.tension == full.shape.tension).all()


def test_a_drag_afloat_needs_no_hull(solve):
    result = solve(SHALLOW.replace("cx: 0.6,", "cx: 0.6, k_surface: 60 N/(m/s)^2,"))
    full = solve(SHALLOW + "solver: {buoy_drag: full}\n")
    assert result.top.draft is None
    assert result.anchor.horizontal < full.anchor.horizontal
    assert any("k_surface" in warning for warning in result.warnings)


def test_several_floats_at_the_surface_are_told_to_have_no_draft(solve):
    two = WEIGHED.replace("{use: thin, length: 80 m", "{use: thin, length: 20 m")
    two = two.replace(
        "  - {use: meter}", "  - {use: ball, label: second}\n  - {use: thin, length: 110 m}"
    )
    two = two.replace("{use: thin, length: 20 m", "{use: thin, weight: 20 N/m, length: 20 m")
    result = solve(two.replace("clamps: [{use: logger, at: 30 m}]", "clamps: []"))
    assert result.top.draft is None
    assert any("are at the surface together" in warning for warning in result.warnings)


def test_a_slack_line_at_rest_tells_its_watch_circle(solve):
    """Scope 2 in 540 m of water: a circle of √(1080² − 540²) = 935 m."""
    slack = FILE.replace("depth: 200 m", "depth: 540 m").replace("80 m", "959 m")
    slack = slack.replace("length: 40 m", "length: 119 m").replace("length: 0.5 m", "length: 0 m")
    slack = slack.replace("weight: 1 N/m", "weight: 0.1 N/m")
    with pytest.raises(calm.NoEquilibrium) as caught:
        solve(slack, speed="0 m/s")
    assert caught.value.status == "slack"
    assert "935 m" in caught.value.message
    assert caught.value.advice


def test_the_watch_circle_is_that_of_the_line_above_the_anchor(solve):
    """100.2 m of line on an anchor 1 m high in 100 m: √(100.2² − 99²) = 15.46 m, not 6.3 m."""
    text = (
        "environment: {depth: 100 m, current: {speed: SPEED, toward: 90 deg}}\n"
        "line: [{use: ball}, {use: rope, length: 99.2 m}, {use: block}]\n"
        "components:\n"
        "  ball: {kind: sphere, diameter: 1 m, buoyancy: 3000 N, cx: 0.6, role: float}\n"
        "  rope: {kind: cable, diameter: 12 mm, weight: 0.5 N/m}\n"
        "  block: {kind: anchor, weight: 9 kN, length: 1 m}\n"
    )
    with pytest.raises(calm.NoEquilibrium) as caught:
        solve(text, speed="0 m/s")
    assert "watch circle has a radius of 15.5 m" in caught.value.message
    verdict = next(watch_circle.judge(solve(text, speed="0.3 m/s").leg))
    assert verdict.value == pytest.approx((100.2**2 - 99.0**2) ** 0.5, abs=0.02)


def test_a_refusal_names_the_piece(solve):
    folded = FILE.replace("buoyancy: -100 N", "buoyancy: -3100 N")
    folded = folded.replace("  - {use: block}", "  - {use: ball}\n  - {use: block}")
    with pytest.raises(calm.NoEquilibrium) as caught:
        solve(folded, speed="0 m/s")
    assert caught.value.status == "slack"
    assert "meter (piece 3)" in caught.value.message


def test_fit_cuts_the_piece_once_for_every_current(solve):
    fit = FILE.replace("length: 40 m", "length: fit, top_depth: 50 m")
    weak, strong = solve(fit, speed="0.1 m/s"), solve(fit, speed="0.5 m/s")
    assert weak.components.cut_length[3] == pytest.approx(200 - 0.5 - 50 - 82, abs=1e-5)
    assert strong.components.cut_length[3] == weak.components.cut_length[3]
    assert strong.still_shape.depth[0] == pytest.approx(50, abs=2e-5)


def test_a_named_environment_takes_the_place_of_the_keys_it_gives(solve):
    named = FILE + "environments: {storm: {current: {speed: 1 m/s, toward: 0 deg}}}\n"
    calm_day, storm = solve(named), solve(named, environment="storm")
    assert storm.top.y > calm_day.top.x > 0
    assert storm.components.depth_bottom[-1] == 200


def test_density_and_current_levels_are_merged(solve):
    layered = FILE.replace(
        "  current:",
        "  density: {columns: [depth m, density kg/m^3], rows: [[0, 1020], [100, 1030]]}\n"
        "  current:",
    )
    result = solve(layered)
    water = result.design.water
    assert water.level.tolist() == [0, 100]
    assert water.density.tolist() == [1020, 1030]
    assert np.hypot(water.u, water.v) == pytest.approx([0.6, 0.6])
    assert result.closure < 1e-6 < inf


def test_only_chain_may_lie_on_the_seabed_below_a_sub_surface_float(solve):
    weak = FILE.replace("buoyancy: 3000 N", "buoyancy: 200 N")
    with pytest.raises(calm.NoEquilibrium) as caught:
        solve(weak, speed="0.1 m/s")
    assert caught.value.status == "no-equilibrium"
    assert "too little buoyancy" in caught.value.message
    chained = FILE.replace("length: 40 m", "length: 40 m}\n  - {use: chain, length: 60 m")
    chained = chained.replace(
        "components:", "components:\n  chain: {kind: chain, diameter: 20 mm, source: test}"
    )
    result = solve(chained, speed="0.3 m/s")
    assert result.type == "subsurface"
    assert 0 < result.anchor.grounded_length < 60
    assert result.anchor.vertical == 0
    assert result.components.tilt[4] > 10
