"""Shares of the drags, on lines whose shape is known in closed form; changes, by changed files."""

import json
from math import atan2, cos, hypot, pi
from pathlib import Path

import pytest

import calm
from calm.case.explain import explain
from calm.errors import UsageError

LINES = Path(__file__).parents[3] / "lines"

PLUMB = """
environment: {{depth: 200 m, current: {{speed: {speed}, toward: 90 deg}}}}
line:
  - {{use: ball, label: top float, buoyancy: {buoyancy}, kn: {top}}}
  - {{use: thread, length: 60 m}}
  - {{use: ball, label: meter, buoyancy: 0 N, kn: {meter}}}
  - {{use: thread, length: 40 m}}
  - {{use: block}}
components:
  ball: {{kind: body, length: 0 m, buoyancy: 0 N, kn: 1 N/(m/s)^2, inclination: insensitive}}
  thread: {{kind: cable, diameter: 1 mm, weight: 0 N/m, cn: 0, ct: 0}}
  block: {{kind: anchor, weight: {anchor}}}
"""
"""A float and a body on a line without mass or drag: two straight stretches."""

STREAM = """
environment:
  depth: 300 m
  current:
    columns: [depth m, speed m/s, toward deg]
    rows: [[0, {factor}, 90], [300, {slow}, 90]]
line:
  - {{use: ball}}
  - {{use: rope, length: 120 m, clamps: [{{use: logger, at: 30 m}}]}}
  - {{use: rope, length: 80 m}}
  - {{use: block}}
components:
  ball: {{kind: sphere, diameter: 1 m, buoyancy: {buoyancy} N, cx: {cx}}}
  rope: {{kind: cable, diameter: 12 mm, weight: 0.5 N/m, cn: {cn}, ct: {ct}, stiffness: 200 kN}}
  logger: {{kind: body, length: 0 m, buoyancy: -20 N, kn: {kn} N/(m/s)^2, inclination: insensitive}}
  block: {{kind: anchor, weight: 9 kN}}
"""


@pytest.fixture
def solve(tmp_path):
    def solved(text):
        path = tmp_path / "m.yaml"
        path.write_text(text)
        return calm.load(path).solve()

    return solved


def plumb(**given):
    usual = {
        "speed": "1 m/s", "buoyancy": "1000 N", "anchor": "9 kN",
        "top": "200 N/(m/s)^2", "meter": "100 N/(m/s)^2",
    }  # fmt: skip
    return PLUMB.format(**usual | given)


def stream(speed=1.0, buoyancy=1.0, drag=1.0):
    return STREAM.format(
        factor=0.8 * speed, slow=0.2 * speed, buoyancy=2000.0 * buoyancy,
        cx=0.5 * drag, cn=1.3 * drag, ct=0.01 * drag, kn=30.0 * drag,
    )  # fmt: skip


def test_shares_in_closed_form(solve):
    # tan(theta) = D/B above the meter, (D + d)/B below it; drop = L (1 - cos(theta)). The upper
    # stretch is the float's alone; of the lower one each has the share of its drag.
    explanation = explain(solve(plumb()))
    upper = 60.0 * (1.0 - cos(atan2(200.0, 1000.0)))
    lower = 40.0 * (1.0 - cos(atan2(300.0, 1000.0)))
    causes = explanation.causes
    assert causes.label == ["top float", "meter"]
    # four Gauss points on a smooth curve: 1e-5 of the whole
    expected = [upper + lower * 2.0 / 3.0, lower / 3.0]
    assert causes.knockdown == pytest.approx(expected, abs=1e-5 * (upper + lower))
    assert causes.drag == pytest.approx([200.0, 100.0])
    assert explanation.quantities == ("knockdown", "excursion")
    assert explanation.without_drag == {"knockdown": 0.0, "excursion": 0.0}


def test_equal_drags_in_one_place_have_equal_shares(solve):
    text = plumb().replace("  - {use: thread, length: 60 m}\n", "").replace("100 N/(", "200 N/(")
    causes = explain(solve(text)).causes
    assert causes.label == ["top float", "meter"]
    # the same number twice, but for the rounding of two differences
    assert causes.knockdown[0] == pytest.approx(causes.knockdown[1], rel=1e-6)
    assert causes.excursion[0] == pytest.approx(causes.excursion[1], rel=1e-6)


def test_shares_add_up_to_the_whole(solve):
    result = solve(stream())
    causes = explain(result).causes
    assert causes.knockdown.sum() == pytest.approx(result.top.knockdown, rel=1e-6)
    assert causes.excursion.sum() == pytest.approx(hypot(result.top.x, result.top.y), rel=1e-6)
    # a current in one direction: the drags add up to the pull on the anchor
    assert causes.drag.sum() == pytest.approx(result.anchor.horizontal, rel=1e-6)


@pytest.mark.parametrize("name", ["deep-current-meters", "upward-adcp-300m", "thermistor-string"])
def test_sums_hit_the_whole_before_they_are_scaled(name):
    result = calm.load(LINES / f"{name}.yaml").solve()
    explanation = explain(result)
    assert explanation.causes.knockdown.sum() == pytest.approx(result.top.knockdown, rel=1e-6)
    # what four points and long segments lack; beyond a hundredth it would be told
    assert explanation.miss < 0.01
    assert explanation.notes == ()


def test_a_share_does_not_depend_on_how_the_line_is_divided(solve):
    whole = explain(solve(stream())).causes
    rope = "  - {use: rope, length: 80 m}\n"
    halves = explain(solve(stream().replace(rope, 2 * rope.replace("80", "40")))).causes
    lower = [halves.knockdown[i] for i, label in enumerate(halves.label) if label != "rope 1"]
    assert whole.label == ["ball", "rope 1", "logger", "rope 2"]
    # the truncation error of coarse segments, scaled away only in sum
    tolerance = 1e-3 * whole.knockdown.sum()
    assert halves.knockdown[:3] == pytest.approx(whole.knockdown[:3], abs=tolerance)
    assert lower[-2] + lower[-1] == pytest.approx(whole.knockdown[3], abs=tolerance)


def test_shares_are_integrals_of_whole_solves(solve):
    # the float's share by Gauss points of central differences of independent fine solves
    points = [(0.06943184420297371, 0.17392742256872693), (0.33000947820757187, 0.3260725774312731)]
    points += [(1.0 - t, weight) for t, weight in points]
    fine = "solver: {angle_step: 0.1 deg, tolerance: 1e-9}\n"
    share = 0.0
    for t, weight in points:
        depths = []
        for cx in (0.51, 0.49):
            text = stream(drag=t * t).replace(f"cx: {0.5 * t * t}", f"cx: {cx * t * t}")
            depths.append(solve(text + fine).top.depth)
        share += weight * 2.0 / t * (depths[0] - depths[1]) / 0.04
    causes = explain(solve(stream())).causes
    # the coarse segments of the shares are good to a few thousandths
    assert causes.knockdown[0] == pytest.approx(share, rel=5e-3)


@pytest.mark.parametrize(
    ("name", "changed"),
    [
        ("buoyancy +10 %", {"buoyancy": 1.1}),
        ("drag −10 %", {"drag": 0.9}),
        ("current +10 %", {"speed": 1.1}),
        ("current −10 %", {"speed": 0.9}),
    ],
)
def test_changes_are_those_of_a_changed_file(solve, name, changed):
    what_if = next(one for one in explain(solve(stream())).changes if one.name == name)
    there = solve(stream(**changed))
    figures = what_if.figures
    # the same solve, but for rounding in the numbers of the file
    assert figures.knockdown == pytest.approx(there.top.knockdown, rel=1e-6)
    assert figures.excursion == pytest.approx(there.top.x, rel=1e-6)
    assert figures.tension == pytest.approx(there.anchor.tension, rel=1e-6)
    assert figures.vertical == pytest.approx(there.anchor.vertical, rel=1e-6)
    assert figures.horizontal == pytest.approx(there.anchor.horizontal, rel=1e-6)
    assert figures.required_weight == pytest.approx(there.anchor.required_weight, rel=1e-6)


def test_a_change_that_leads_nowhere_says_so(solve):
    # 1000 N of buoyancy under 1050 N of anchor: a tenth more lifts it
    document = explain(solve(plumb(anchor="1050 N"))).to_dict()
    more, less, *_ = document["changes"]
    assert more["change"] == "buoyancy +10 %"
    assert more["status"] == "anchor-lifts"
    assert "1100 N" in more["message"]
    assert less["status"] == "converged"


def test_another_part_can_be_explained(solve):
    result = solve(stream())
    explanation = explain(result, "logger")
    assert explanation.figures.knockdown == result.clamps[0].knockdown
    assert explanation.causes.knockdown.sum() == pytest.approx(result.clamps[0].knockdown, rel=1e-6)
    # what pulls on the rope below the logger moves it less than the top
    assert explanation.figures.knockdown < result.top.knockdown


def test_a_part_that_is_not_there(solve):
    with pytest.raises(UsageError, match="did you mean `logger`"):
        explain(solve(stream()), "loger")
    with pytest.raises(UsageError, match="no part of the line has the label `block`"):
        explain(solve(stream()), "block")


def test_a_surface_mooring_is_explained_by_its_excursion():
    result = calm.load(LINES / "taut-nylon-surface.yaml").solve()
    explanation = explain(result)
    assert explanation.quantities == ("excursion", "used_buoyancy")
    assert "has no knockdown" in explanation.notes[0]
    causes, start = explanation.causes, explanation.without_drag
    total = start["excursion"] + causes.excursion.sum()
    assert total == pytest.approx(hypot(result.top.x, result.top.y), rel=1e-9)
    used = start["used_buoyancy"] + causes.used_buoyancy.sum()
    assert used == pytest.approx(result.top.used_buoyancy, rel=1e-9)


def test_a_slack_line_has_an_excursion_without_drag():
    # 28.467 m of line in 20 m of water, on the seabed without friction: 8.467 m when hardly pulled
    result = calm.load(LINES / "braconnot-buoy.yaml").solve()
    explanation = explain(result)
    slack = result.components.cut_length.sum() - 20.0
    # at a thousandth of the drag the hanging part already leans a little
    assert explanation.without_drag["excursion"] == pytest.approx(slack, rel=0.05)


def test_still_water_has_nothing_to_explain(solve):
    explanation = explain(solve(plumb(speed="0 m/s")))
    assert "There is no current, so there is no drag." in explanation.notes
    assert explanation.causes.knockdown == pytest.approx([0.0, 0.0])


def test_the_document_is_plain_json(solve):
    document = explain(solve(stream())).to_dict()
    assert json.loads(json.dumps(document, allow_nan=False)) == document
    assert set(document["causes"][0]) == {
        "index", "label", "clamped", "drag", "knockdown", "excursion",
    }  # fmt: skip
    assert [cause["clamped"] for cause in document["causes"]] == [False, False, True, False]
    assert [cause["index"] for cause in document["causes"]] == [0, 1, 1, 2]


def test_drag_of_a_sphere_is_what_it_says(solve):
    # 1/2 rho Cx pi D^2/4 V^2 at its own depth
    result = solve(stream())
    depth = result.components.depth_top[0] + 0.5
    speed = 0.8 - 0.6 * depth / 300.0
    drag = 0.5 * 1025.0 * 0.5 * pi / 4.0 * speed**2
    # the sphere's middle hangs a little aside of its upper end's vertical
    assert explain(result).causes.drag[0] == pytest.approx(drag, rel=1e-3)


AFLOAT = """
environment: {{depth: 50 m, current: {{speed: {speed} m/s, toward: 90 deg}}}}
line:
  - {{use: ball}}
  - {{use: rope, length: 60 m}}
  - {{use: block}}
components:
  ball: {{kind: sphere, diameter: 1 m, buoyancy: {buoyancy} N, mass: 100 kg}}
  rope: {{kind: cable, diameter: 12 mm, weight: 1 N/m, cn: 1.3, ct: 0.01}}
  block: {{kind: anchor, weight: 9 kN}}
"""


@pytest.mark.parametrize(
    ("name", "changed"),
    [
        ("buoyancy +10 %", {"buoyancy": 4400, "speed": 0.5}),
        ("current +10 %", {"buoyancy": 4000, "speed": 0.55}),
    ],
)
def test_a_float_at_its_draft_is_changed_as_in_a_file(solve, name, changed):
    explanation = explain(solve(AFLOAT.format(buoyancy=4000, speed=0.5)))
    figures = next(one.figures for one in explanation.changes if one.name == name)
    there = solve(AFLOAT.format(**changed))
    assert there.type == "surface"
    # the same solve, but for rounding in the numbers of the file
    assert figures.used_buoyancy == pytest.approx(there.top.used_buoyancy, rel=1e-6)
    assert figures.excursion == pytest.approx(there.top.x, rel=1e-6)
    assert figures.tension == pytest.approx(there.anchor.tension, rel=1e-6)
