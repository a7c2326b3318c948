"""What an anchor weighs in water, and what is said where that is not known."""

import pytest

import calm
from calm.checks.design_check import check
from calm.checks.finding import State
from calm.quantities import say
from calm.report.open_items import limit_text, open_items

FILE = """
name: By hand
environment: {depth: 200 m, current: {speed: 0.3 m/s, toward: 90 deg}}
line:
  - {use: ball, label: top}
  - {use: thin, label: wire, length: 100 m}
  - {use: block}
components:
  ball: {kind: sphere, diameter: 1 m, role: float, buoyancy: 3000 N}
  thin: {kind: cable, diameter: 8 mm, weight: 1 N/m, ct: 0}
  block: {kind: anchor, mass: 1000 kg, FIGURES}
"""
G = 9.80665
RULES = ("anchor-weight", "anchor-uplift", "anchor-sliding")


@pytest.fixture
def load(tmp_path):
    def of(figures):
        path = tmp_path / "m.yaml"
        path.write_text(FILE.replace(", FIGURES", figures), encoding="utf-8")
        return calm.load(path)

    return of


@pytest.mark.parametrize(
    ("figures", "density", "known"),
    [
        ("", 7850.0, False),
        (", material: granite", 7850.0, False),
        (", material: steel and concrete", 7850.0, False),
        (", material: steel", 7850.0, True),
        (", material: Concrete", 2400.0, True),
        (", material: cast iron", 7200.0, True),
        (", density: 2600 kg/m^3", 2600.0, True),
        (", density: 2600 kg/m^3, material: steel", 2600.0, True),
        (", weight: 5000 N", None, True),
    ],
)
def test_an_anchor_is_judged_where_what_it_weighs_in_water_is_known(load, figures, density, known):
    mooring = load(figures)
    weight = 5000.0 if density is None else 1000.0 * G * (1.0 - 1025.0 / density)
    assert mooring.leg.anchor_weight == pytest.approx(weight)
    result = mooring.solve()
    warned = [each for each in result.warnings if "is assumed to be steel (7850 kg/m³)" in each]
    assert len(warned) == (not known)
    assessment = check(mooring)
    found = {one.rule: one for one in assessment.in_environments[0].findings if one.rule in RULES}
    missing = [one.missing for one in assessment.findings if one.missing is not None]
    needed = {one.quantity: set(one.needed_by) for one in missing}
    assert set(found) == (set(RULES) if known else set())
    assert needed.get("weight", set()) == (set() if known else set(RULES))
    for finding in found.values():
        assert finding.state != "unknown"
        assert finding.limit is not None
    if known:
        anchor = result.anchor
        assert found["anchor-weight"].value == pytest.approx(weight)
        assert found["anchor-weight"].limit == pytest.approx(anchor.required_weight)
        assert found["anchor-sliding"].limit == pytest.approx(
            0.6 * (weight / 1.5 - anchor.vertical)
        )


@pytest.mark.parametrize(("share", "state"), [(0.999, "fail"), (1.001, "pass")])
def test_an_anchor_slides_below_the_weight_that_holds_both_pulls(load, share, state):
    """Dewey's rule: 1.5 (V + H / 0.6) in water, H and V the pulls on the anchor."""
    pulls = load(", weight: 5000 N").solve().anchor
    needed = 1.5 * (pulls.vertical + pulls.horizontal / 0.6)
    in_environments = check(load(f", weight: {share * needed} N")).in_environments[0]
    found = {one.rule: one for one in in_environments.findings if one.situation == "as given"}
    assert found["anchor-sliding"].state == found["anchor-weight"].state == state


def test_every_rule_asks_for_the_one_weight_that_satisfies_all(tmp_path):
    """The largest weight of all situations and environments, in each remedy on the anchor."""
    text = FILE.replace("mass: 1000 kg, FIGURES", "weight: 2500 N").replace("3000 N", "2400 N")
    storm = "\nenvironments: {storm: {current: {speed: 0.9 m/s, toward: 90 deg}}}\nline:"
    text, path = text.replace("\nline:", storm), tmp_path / "m.yaml"

    def judged(text):
        path.write_text(text, "utf-8")
        assessment = check(calm.load(path), calm.load(path, environment="storm"))
        every = (*assessment.all_findings(), *assessment.tighter_findings())
        return [each for each in every if each.rule in RULES]

    findings = judged(text)
    failing = [each for each in findings if each.remedy is not None]
    assert {each.rule for each in failing} == {*RULES}
    assert len({(each.environment, each.situation) for each in failing}) > 1
    needed = max(each.limit for each in findings if each.rule == "anchor-weight")
    (remedy,) = {each.remedy for each in failing}
    assert f"at least {say('load', needed)} in water" in remedy
    heavier = judged(text.replace("weight: 2500 N", f"weight: {needed + 1.0:.0f} N"))
    assert {each.state for each in heavier} == {State.PASS}


def test_an_anchor_without_holding_is_described_without_a_negative_limit(load):
    assessment = check(load(", weight: 3000 N"))
    findings = assessment.in_environments[0].findings
    (slides,) = (one for one in findings if one.rule == "anchor-sliding")
    assert slides.limit is not None and slides.limit < 0.0
    assert (
        "the vertical load times 1.5 exceeds the anchor's weight in water, so friction cannot hold "
        "the anchor" in slides.message
    )
    assert limit_text(slides) == "none left"
    (item,) = (one for one in open_items(assessment) if one.head.startswith("Anchor sliding"))
    assert "friction cannot hold the anchor" in item.text and "−" not in item.text
