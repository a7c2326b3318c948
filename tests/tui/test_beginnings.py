"""Starts, the history, and components changed in their form."""

import pytest

from calm.checks.finding import State
from calm.files.editing import Draft
from calm.shipped import TEMPLATES, template
from calm.tui.line_rows import table_rows
from calm.tui.live import judge, judge_fully
from tests.tui.conftest import MOORING


@pytest.mark.parametrize("number", [1, 6])
def test_an_empty_line_begins_with_a_mooring(drive, number):
    kind = list(TEMPLATES)[number - 1]

    async def story(driver):
        assert "b   starts from a template" in driver.screen
        await driver.press("b", str(number))
        assert driver.text == template(kind)
        await driver.settle()
        assert driver.view.result is not None
        await driver.press("b")
        assert "The line is not empty" in driver.screen
        await driver.press("u")
        assert driver.session.draft.items == ()

    drive(story)


def test_the_history_goes_back_to_before_any_change(drive, small):
    async def story(driver):
        await driver.press("h")
        assert "No changes to undo yet" in driver.screen
        await driver.press("d", "delete", "d")
        done = driver.text
        await driver.press("h")
        assert "before: duplicate top float" in driver.screen
        await driver.press("3")
        assert driver.text == MOORING
        await driver.press("U", "U", "U")
        assert driver.text == done

    drive(story, small)


def test_a_component_of_the_file_is_changed_in_its_form(drive, small):
    async def story(driver):
        await driver.press("O")
        assert "ball, a sphere" in driver.screen and "2000 N" in driver.screen
        for _ in range(20):
            if driver.app.focused.parent.key == "buoyancy":
                break
            await driver.press("tab")
        await driver.press("ctrl+u")
        await driver.type("2100 N")
        await driver.press("ctrl+s")
        await driver.settle()
        assert driver.text == MOORING.replace("buoyancy: 2000 N", "buoyancy: 2100 N")

    drive(story, small)


def test_figures_that_the_form_does_not_show_stay(drive, folder):
    text = MOORING.replace(
        "stiffness: 200 kN}", "elongation: [[0, 0], [50 %, 10 %]], note: as cut}"
    )
    path = folder / "nested.yaml"
    path.write_text(text, encoding="utf-8")

    async def story(driver):
        await driver.press("down", "O")
        await driver.type("Braided rope")
        await driver.press("ctrl+s")
        assert "name: Braided rope" in driver.text
        assert "elongation: [[0, 0], [50 %, 10 %]]" in driver.text

    drive(story, path)


def test_a_component_of_the_catalogue_is_not_changed(drive, folder):
    path = folder / "listed.yaml"
    path.write_text(MOORING.replace("{use: releaser}", "{use: release-ar861}"), encoding="utf-8")

    async def story(driver):
        await driver.press("end", "up", "O")
        assert "is not defined in this file" in driver.screen

    drive(story, path)


def test_a_fitted_rope_shows_what_it_is_cut_to():
    text = MOORING.replace("length: 60 m", "length: fit\n    top_depth: 30 m")
    view = judge(text)
    row = table_rows(Draft(text), view, None)[1]
    cut = view.result.components[1].cut_length
    assert row.texts["length"] == f"fit: {cut:.2f} m"


def test_what_is_complete_stays_so_with_each_start():
    view = judge_fully(judge(template("slack-surface")))
    assert State.FAIL not in {each.state for each in view.findings}
