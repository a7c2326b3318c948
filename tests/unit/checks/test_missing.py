"""A missing figure is reported once for each component id, whatever asks for it and how often."""

from pathlib import Path

import calm
from calm.checks.assessment import Assessment
from calm.checks.design_check import check
from calm.checks.finding import State

CLAMPS = "\n".join(f"      - {{use: logger, label: T {at}, at: {at} m}}" for at in (5, 15, 25, 35))
LINE = f"""\
name: clamps
environment:
  depth: 300 m
  current: {{speed: 0.4 m/s, toward: 90 deg}}
environments:
  storm: {{current: {{speed: 0.8 m/s, toward: 90 deg}}}}
line:
  - {{use: ball}}
  - use: rope
    length: 40 m
    clamps:
{CLAMPS}
  - {{use: link, count: 2}}
  - {{use: rope, length: 40 m}}
  - {{use: weight}}
components:
  ball: {{kind: sphere, role: float, diameter: 1 m, buoyancy: 3 kN, depth_rating: 500 m}}
  rope: {{kind: cable, diameter: 8 mm, weight: 1.6 N/m, stiffness: 3000 kN, working_load: 20 kN}}
  logger: {{kind: body, role: instrument, length: 0.2 m, buoyancy: -2 N, kn: 1 N/(m/s)^2,
           inclination: insensitive, max_tilt: 90 deg}}
  link: {{kind: body, role: connector, length: 0.1 m, buoyancy: -5 N, kn: 1 N/(m/s)^2,
         inclination: insensitive}}
  weight: {{kind: anchor, weight: 20 kN, kt: 500 N/(m/s)^2, friction: 0.6}}
"""


def judged(tmp_path: Path, text: str = LINE) -> Assessment:
    path = tmp_path / "m.yaml"
    path.write_text(text, encoding="utf-8")
    return check(*(calm.load(path, environment=name) for name in (None, "storm")))


def test_one_finding_for_each_component_and_figure(tmp_path: Path) -> None:
    found = [one.to_dict() for one in judged(tmp_path).all_findings() if one.missing is not None]
    asked = {(one["component_id"], one["quantity"]): one for one in found}
    assert len(asked) == len(found) == 2
    rating = asked["logger", "depth_rating"]
    assert rating["pieces"] == ["T 5", "T 15", "T 25", "T 35"]
    assert rating["needed_by"] == ["depth-rating"]
    assert rating["component"] == "T 35"  # the deepest
    assert "Also affected: T 5, T 15 and T 25" in rating["message"]
    assert rating["remedy"] == "Set the `depth_rating` of logger."
    load = asked["link", "working_load"]
    assert load["needed_by"] == ["strength", "launch-strength"]
    assert load["pieces"] == ["link 1", "link 2"]
    assert (load["rule"], load["state"], load["class_estimate"]) == ("missing", "unknown", None)


def test_no_rule_adds_an_unknown_finding_for_a_piece(tmp_path: Path) -> None:
    unknown = [one for one in judged(tmp_path).all_findings() if one.state is State.UNKNOWN]
    assert {one.rule for one in unknown} == {"missing", "backup", "release-present"}


def test_a_missing_figure_is_accepted_with_all_rules_that_need_it(tmp_path: Path) -> None:
    accept = "checks: {accept: [{rule: missing, component: link *, reason: pulled at 9 kN}]}"
    assessment = judged(tmp_path, f"{LINE}{accept}\n")
    missing = [one.missing for one in assessment.all_findings() if one.missing is not None]
    assert {one.component_id for one in missing} == {"logger"}
    accepted = assessment.accepted_findings()
    assert {(one.rule, one.component) for one in accepted} == {
        (rule, label) for rule in ("strength", "launch-strength") for label in ("link 1", "link 2")
    }
    assert not [one for one in assessment.notices if "not needed" in one]
