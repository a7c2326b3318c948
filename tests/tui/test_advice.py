"""Advice by key: what is offered, what it would do, and what is written when it is taken."""

import pytest

from calm.checks.finding import State
from calm.checks.strength import ANCHOR_RULES
from calm.errors import UsageError
from calm.files import Catalogue
from calm.files.editing import Draft
from calm.quantities import say
from calm.tui.advice import differences, offers, sized
from calm.tui.comparing import changed_lines
from calm.tui.live import judge, judge_fully
from calm.tui.verdict_text import verdict_lines
from tests.tui.conftest import MOORING

LIGHT = MOORING.replace("weight: 5000 N", "weight: 2500 N")
CATALOGUE = Catalogue.load()


def fully(text):
    return judge_fully(judge(text))


def states(view, rule):
    return {each.state for each in view.findings if each.rule == rule}


def test_a_line_that_lifts_its_anchor_is_told_what_holds_it():
    lifted = MOORING.replace("weight: 5000 N", "weight: 900 N")
    view = judge(lifted)
    assert view.result is None
    for offer in offers(view, CATALOGUE):
        after = fully(offer.make(Draft(lifted)).text)
        assert after.result is not None and State.FAIL not in states(after, "anchor-weight")
    assert len(offers(view, CATALOGUE)) == 2


@pytest.mark.parametrize("begin", ["anchor: weight with", "anchor: "])
def test_an_anchor_is_made_what_all_findings_need(begin):
    view = fully(LIGHT)
    assert State.FAIL in states(view, "anchor-weight")
    offer = next(e for e in offers(view, CATALOGUE) if e.title.startswith(begin))
    made = offer.make(Draft(LIGHT))
    after = fully(made.text)
    for rule in ANCHOR_RULES:
        assert states(after, rule) == {State.PASS}
    told = differences(view, after)
    assert any(each.startswith("anchor weighs 2500 N →") for each in told)
    assert any(each.startswith("failures") for each in told)
    assert "# carries all" in made.text


TWO_WATERS = LIGHT.replace(
    "\nline:", "\nenvironments: {storm: {current: {speed: 0.8 m/s, toward: 90 deg}}}\n\nline:"
)


@pytest.mark.parametrize("text", [LIGHT, TWO_WATERS, TWO_WATERS.replace("  - {use: weight}\n", "")])
def test_the_anchor_holds_in_every_environment_and_with_strumming_cables(text):
    """The weight offered is the largest that any situation requires, and no more."""
    view = fully(text)
    for offer in offers(view, CATALOGUE)[:2]:
        after = fully(offer.make(Draft(text)).text)
        found = [e for e in (*after.findings, *after.tighter) if e.rule in ANCHOR_RULES]
        assert {each.state for each in found} == {State.PASS}
        worst = max((e for e in found if e.rule == "anchor-weight"), key=lambda each: each.limit)
        assert worst.situation == "strumming" and "strumming)" in offer.title
        assert worst.environment == ("own" if text == LIGHT else "storm")
        assert say("tension", worst.limit) in offer.title
        if "with a weight" in offer.title:  # three digits
            assert worst.limit <= worst.value <= 1.01 * worst.limit


def test_a_line_without_an_anchor_gets_the_lightest_that_holds():
    text = MOORING.replace("  - {use: weight}\n", "")
    view = fully(text)
    assert not view.anchored
    (offer,) = offers(view, CATALOGUE)
    (told,) = (each.text for each in verdict_lines(view) if each.text.startswith("needs "))
    needs, _, when = told.removeprefix("needs ").removesuffix(" in water").partition(" (")
    assert when == "strumming)" and offer.title.endswith(f"{needs} needed ({when}")
    made = offer.make(Draft(text))
    assert len(made.items) == len(Draft(text).items) + 1
    chosen = CATALOGUE.get(made.items[-1].values["use"])
    needed = max(
        e.limit
        for e in (*fully(made.text).findings, *fully(made.text).tighter)
        if e.rule == "anchor-weight"
    )
    lighter = [
        -each.net_buoyancy
        for each in map(CATALOGUE.get, CATALOGUE.ids())
        if each.kind == "anchor" and -each.net_buoyancy < -chosen.net_buoyancy
    ]
    assert max(lighter) < needed <= -chosen.net_buoyancy
    told = differences(view, fully(made.text))
    assert not any("anchor weighs" in each for each in told)


def test_a_weight_is_offered_only_for_an_anchor_that_the_catalogue_does_not_define():
    listed = LIGHT.replace("{use: weight}", "{use: anchor-wheels-1}")
    titles = [each.title for each in offers(fully(listed), CATALOGUE)]
    assert not any("with a weight" in each for each in titles)
    own = [each.title for each in offers(fully(LIGHT), CATALOGUE)]
    assert any(each.startswith("anchor: weight with a weight") for each in own)


def test_no_anchor_of_the_catalogue_may_hold():
    heavy = MOORING.replace("2000 N", "60 kN").replace("diameter: 1 m", "diameter: 3 m")
    view = fully(heavy.replace("  - {use: weight}\n", ""))
    (offer,) = offers(view, CATALOGUE)
    assert "none in the catalogue is heavy enough" in offer.title
    with pytest.raises(UsageError, match="Define one"):
        offer.make(Draft(view.text))


def test_the_catalogue_gives_the_lightest_anchor_that_holds():
    view = fully(LIGHT)
    offer = next(e for e in offers(view, CATALOGUE) if "needed" in e.title)
    chosen = offer.make(Draft(LIGHT)).items[-1].values["use"]
    found = (*view.findings, *view.tighter)
    limit = max(e.limit for e in found if e.rule == "anchor-weight")
    weights = sorted(
        -found.net_buoyancy
        for id in CATALOGUE.ids()
        if (found := CATALOGUE.get(id)) is not None and getattr(found, "kind", "") == "anchor"
    )
    lightest = next(each for each in weights if each >= limit)
    assert -CATALOGUE.get(chosen).net_buoyancy == lightest


def test_floats_for_back_up_are_as_many_as_bring_it_up():
    text = MOORING.replace(
        "  # the release is ours\n", "  - {use: glass-17in, count: 1}\n  # the release is ours\n"
    ).replace("releaser: {kind: cylinder, role: release, diameter: 0.2 m, length: 1 m, buoyancy: "
              "-200 N}", "releaser: {kind: cylinder, role: release, diameter: 0.2 m, length: 1 m, "
              "buoyancy: -600 N}")  # fmt: skip
    view = fully(text)
    assert State.FAIL in states(view, "backup")
    offer = next(e for e in offers(view, CATALOGUE) if e.title.startswith("back-up"))
    made = offer.make(Draft(text))
    assert State.FAIL not in states(fully(made.text), "backup")
    count = int(made.items[2].values["count"])
    fewer = Draft(text).put(2, "count", str(count - 1))
    assert State.FAIL in states(fully(fewer.text), "backup")


def test_buoyancy_for_a_knockdown_is_found_by_solving():
    limit = judge(MOORING).result.top.knockdown / 2
    text = MOORING + f"checks: {{maximum_knockdown: {limit:.3f} m}}\n"
    view = fully(text)
    assert State.FAIL in states(view, "knockdown")
    offer = next(e for e in offers(view, CATALOGUE) if "knockdown" in e.title)
    made = offer.make(Draft(text))
    assert made.items[0].values["buoyancy"].endswith(" N")
    after = judge(made.text)
    assert after.result.top.knockdown <= limit + 1e-3


def test_a_length_for_a_depth_of_the_top():
    view = judge(MOORING)
    made = sized(view.result.design, "depth(top) = 50 m", "rope.length").make(Draft(MOORING))
    assert judge(made.text).result.top.depth == pytest.approx(50.0, abs=0.1)


def test_what_cannot_be_met_is_said():
    view = judge(MOORING)
    with pytest.raises(UsageError):
        sized(view.result.design, "depth(top) = 5 km", "rope.length").make(Draft(MOORING))
    with pytest.raises(UsageError):
        sized(view.result.design, "depth(top) = 5", "rope.length")


def test_advice_is_shown_and_taken_by_key(drive, folder):
    path = folder / "light.yaml"
    path.write_text(LIGHT, encoding="utf-8")

    async def story(driver):
        driver.app.judging.ask_fully()
        await driver.settle()
        before = driver.text
        await driver.press("p")
        await driver.settle()
        assert "Advice" in driver.screen and "anchor" in driver.screen
        await driver.press("2")
        await driver.settle()
        assert "anchor weighs 2500 N →" in driver.screen and driver.text == before
        await driver.press("escape")
        assert driver.text == before
        await driver.press("p")
        await driver.settle()
        await driver.press("2")
        await driver.settle()
        await driver.press("y")
        assert driver.session.draft.items[-1].values["weight"].endswith(" N")
        await driver.press("u")
        assert driver.text == before

    drive(story, path)


def test_what_changed_since_the_file_was_saved(drive, folder, painted):
    path = folder / "light.yaml"
    path.write_text(LIGHT, encoding="utf-8")

    async def story(driver):
        await driver.press("ctrl+d")
        assert "There are no changes since" in driver.screen
        await driver.press("down", "l")
        await driver.type("50")
        await driver.press("enter")
        await driver.settle()
        await driver.press("ctrl+d")
        await driver.settle()
        assert "Compared with the saved file" in driver.screen
        assert "-    length: 60 m" in driver.screen and "+    length: 50 m" in driver.screen
        assert "top 39" in driver.screen or "top 4" in driver.screen
        await driver.press("b")
        assert driver.table.has_focus

    drive(story, path)


def test_many_changed_lines_are_counted():
    before = "\n".join(map(str, range(40)))
    told = changed_lines(before, "")
    assert len(told) == 25 and told[-1] == "and 16 more lines"
    assert changed_lines(before, before) == []


def test_what_does_not_stand_is_not_judged_and_not_without_warnings():
    stands = judge(MOORING)
    sinks = judge(MOORING.replace("buoyancy: 2000 N", "buoyancy: 5 N"))
    assert stands.result is not None and sinks.result is None
    assert differences(stands, sinks)[-1] == "findings: not judged now (no equilibrium)"
    assert differences(sinks, stands)[-1] == "findings: not judged before (no equilibrium)"
    assert not any("→" in each for each in differences(stands, sinks))
