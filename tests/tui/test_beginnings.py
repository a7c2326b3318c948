"""Starts, assemblies of one's own, the history, and components changed in their form."""

import pytest

from calm.checks.finding import State
from calm.files.editing import Draft, EditError
from calm.shipped import TEMPLATES, template
from calm.tui.line_rows import table_rows
from calm.tui.live import judge, judge_fully
from calm.tui.session import Place
from calm.tui.start import open_session
from tests.tui.conftest import MOORING


@pytest.mark.parametrize("number", [1, 6])
def test_an_empty_line_begins_with_a_mooring(drive, number):
    kind = list(TEMPLATES)[number - 1]

    async def story(driver):
        assert "b   begins with a mooring" in driver.screen
        await driver.press("b", str(number))
        assert driver.text == template(kind)
        await driver.settle()
        assert driver.view.result is not None
        await driver.press("b")
        assert "There is a line already" in driver.screen
        await driver.press("u")
        assert driver.session.draft.items == ()

    drive(story)


def test_marked_rows_become_an_assembly_with_their_comments(drive, small):
    async def story(driver):
        await driver.press("down", "shift+down")  # the rope and its first clamp
        await driver.press("down", "down", "space", "k")
        await driver.type("lower-part")
        await driver.press("enter")
        await driver.settle()
        assert driver.uses == ["ball", "lower-part", "weight"]
        assert "  # the release is ours" in driver.text
        assert [row.length for row in driver.view.rows][:2] == [1.0, pytest.approx(60.0)]
        await driver.press("u")
        assert driver.text == MOORING

    drive(story, small)


def test_an_assembly_means_the_same_as_its_pieces(small):
    session, _ = open_session(small)
    before = judge(MOORING).result
    assert session.assemble([Place(1), Place(2)], "lower-part") == Place(1)
    after = judge(session.draft.text).result
    assert after.anchor.tension == pytest.approx(before.anchor.tension, rel=1e-12)
    assert [row.use for row in after.components] == [row.use for row in before.components]
    with pytest.raises(EditError, match="follow one another"):
        session.assemble([Place(0), Place(2)], "apart")


def test_the_history_goes_back_to_before_any_change(drive, small):
    async def story(driver):
        await driver.press("h")
        assert "There is nothing to undo yet" in driver.screen
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
        assert "is not of this file" in driver.screen

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


def test_another_file_is_compared_and_drawn_beside(drive, small):
    other = small.with_name("other [b].yaml")
    other.write_text(MOORING.replace("length: 60 m", "length: 40 m"), encoding="utf-8")
    broken = small.with_name("broken.yaml")
    broken.write_text("line: [", encoding="utf-8")

    async def story(driver):
        driver.app.judging.ask_fully()
        await driver.settle()
        before = driver.screen
        await driver.press("C")
        driver.app.screen.query_one("Input").value = other.name
        await driver.press("enter")
        await driver.settle()
        assert "top 57.6 m → 37.5 m" in " ".join(driver.screen.split())
        assert "+    length: 60 m" in driver.screen
        await driver.press("escape")
        assert "dashed: other [b].yaml" in driver.screen
        await driver.press("C", "enter")
        assert driver.screen == before
        for name in ("nowhere.yaml", "broken.yaml"):
            await driver.press("C")
            driver.app.screen.query_one("Input").value = name
            await driver.press("enter")
            await driver.settle()
            await driver.press("escape")
        assert driver.text == MOORING

    drive(story, small)


def test_all_environments_are_drawn_in_one_picture(drive, folder):
    storm = "environments: {storm: {current: {speed: 1 m/s, toward: 0 deg}}}\n"
    path = folder / "two.yaml"
    path.write_text(MOORING + storm, encoding="utf-8")

    async def story(driver):
        driver.app.judging.ask_fully()
        await driver.settle()
        alone = driver.screen
        await driver.press("0")
        assert "dashed: all environments" in driver.screen
        await driver.press("2")
        assert "dashed: all environments" in driver.screen
        await driver.press("1", "0", "down", "up")
        assert driver.screen == alone

    drive(story, path)
