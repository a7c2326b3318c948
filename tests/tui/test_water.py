"""Depth, density, current, wind and environments."""

import pytest
from textual.events import Paste

from calm.tui.cells import Cells
from calm.tui.field import Field
from calm.tui.grid import Grid
from calm.tui.water_screen import WaterScreen

CURRENT = ("environment", "current")


def field(driver, id):
    return driver.app.screen.query_one(f"#{id}", Field)


async def enter(driver, id, text):
    chosen = field(driver, id)
    chosen.focus_input()
    await driver.pilot.pause()
    chosen.input.action_select_all()
    await driver.type(text)
    await driver.press("enter")


def cells(driver, id="current-table"):
    return driver.app.screen.query_one(f"#{id}", Grid).query_one(Cells)


async def turn(driver, id, key="right"):
    driver.app.screen.query_one(f"#{id}").focus()
    await driver.press(key)


def test_change_the_depth_and_see_it(drive, small):
    async def story(driver):
        await driver.press("w")
        assert isinstance(driver.app.screen, WaterScreen)
        await driver.press("ctrl+shift+a")
        await enter(driver, "depth", "120")
        await driver.settle()
        assert driver.session.draft.value(("environment", "depth")) == "120 m"
        assert "  depth: 120 m                        # at low water\n" in driver.text
        assert driver.view.file.environment.depth == 120.0
        await driver.press("escape")
        assert driver.app.screen is driver.builder

    drive(story, small)


def test_a_depth_that_is_none_is_not_taken(drive, small):
    async def story(driver):
        await driver.press("w")
        before = driver.text
        await enter(driver, "depth", "120 kg")
        assert "is a mass" in driver.screen
        await driver.press("escape")
        assert driver.text == before

    drive(story, small)


def test_a_uniform_current_becomes_a_table_whose_cells_are_edited(drive, small):
    async def story(driver):
        await driver.press("w")
        await turn(driver, "current-form")
        assert driver.session.draft.value((*CURRENT, "rows")) == [
            ["0", "0.5", "90"], ["100", "0.5", "90"],
        ]  # fmt: skip
        cells(driver).focus()
        await driver.press("right", "0", "full_stop", "8", "enter")
        await driver.settle()
        assert driver.session.draft.value((*CURRENT, "rows"))[0] == ["0", "0.8", "90"]
        assert driver.view.file.environment.current.u[0] == pytest.approx(0.8)
        await driver.press("a", "4", "0", "enter")
        assert driver.session.draft.value((*CURRENT, "rows"))[1] == ["40", "0.65", "90"]
        await driver.press("delete")
        assert len(driver.session.draft.value((*CURRENT, "rows"))) == 2

    drive(story, small)


def test_a_number_that_is_none_is_not_taken_in_a_table(drive, small):
    async def story(driver):
        await driver.press("w")
        await turn(driver, "current-form")
        cells(driver).focus()
        await driver.press("enter")
        await driver.type("5 x")
        await driver.press("enter", "escape")
        assert driver.session.draft.value((*CURRENT, "rows"))[0] == ["0", "0.5", "90"]

    drive(story, small)


def test_rows_of_a_spreadsheet_are_pasted(drive, small):
    async def story(driver):
        await driver.press("w")
        await turn(driver, "current-form")
        cells(driver).focus()
        await driver.pilot.pause()
        cells(driver).post_message(Paste("depth\tspeed\ttoward\n0\t0.9\t70\n100\t0.1\t60\n"))
        await driver.settle()
        assert driver.session.draft.value((*CURRENT, "rows")) == [
            ["0", "0.9", "70"], ["100", "0.1", "60"],
        ]  # fmt: skip

    drive(story, small)


def test_a_preset_current(drive, small):
    async def story(driver):
        await driver.press("w", "ctrl+t", "3")
        await driver.settle()
        rows = driver.session.draft.value((*CURRENT, "rows"))
        assert rows[0] == ["0", "0.8", "90"]
        assert rows[-1] == ["100", "0", "90"]
        assert driver.view.result is not None

    drive(story, small)


@pytest.mark.parametrize("how", ["refer", "copy"])
def test_a_current_of_a_csv_file(drive, small, how):
    table = "depth[m],speed[m/s],toward[deg]\n0,0.6,90\n100,0.2,80\n"
    small.with_name("adcp.csv").write_text(table)

    async def story(driver):
        await driver.press("w", "ctrl+o")
        await driver.type("adcp.csv")
        await driver.press("enter", "enter", "ctrl+u")
        await driver.type(how)
        await driver.press("enter")
        await driver.settle()
        if how == "refer":
            assert driver.session.draft.value(CURRENT) == {"file": "adcp.csv"}
        else:
            assert driver.session.draft.value((*CURRENT, "rows")) == [
                ["0", "0.6", "90"], ["100", "0.2", "80"],
            ]  # fmt: skip
        assert driver.view.file.environment.current.u[0] == pytest.approx(0.6)

    drive(story, small)


def test_a_file_of_current_that_is_not_there_is_told(drive, small):
    async def story(driver):
        before = driver.text
        await driver.press("w", "ctrl+o")
        await driver.type("none.nc")
        await driver.press("enter")
        assert "no such file" in driver.screen
        await driver.press("escape", "escape")
        assert driver.text == before

    drive(story, small)


def test_density_as_a_table(drive, small):
    async def story(driver):
        await driver.press("w")
        await turn(driver, "density-form")
        assert driver.session.draft.value(("environment", "density", "columns")) == [
            "depth m", "density kg/m^3",
        ]  # fmt: skip
        await turn(driver, "density-form")
        assert driver.session.draft.value(("environment", "density")) == "1025 kg/m^3"

    drive(story, small)


def test_wind_comes_and_goes(drive, small):
    async def story(driver):
        await driver.press("w")
        await enter(driver, "wind-speed", "12")
        wind = driver.session.draft.value(("environment", "wind"))
        assert wind == {"speed": "12 m/s", "toward": "0 deg"}
        field(driver, "wind-speed").focus_input()
        await driver.press("ctrl+u", "enter")
        assert driver.session.draft.value(("environment", "wind")) is None

    drive(story, small)


def test_named_environments_are_added_switched_and_dropped(drive, small):
    async def story(driver):
        await driver.press("w", "ctrl+n")
        await driver.type("storm")
        await driver.press("enter")
        await driver.settle()
        assert driver.session.environment == "storm"
        await enter(driver, "current-speed", "1.1 m/s")
        await driver.settle()
        assert driver.view.file.environment.name == "storm"
        stormy = ("environments", "storm", "current", "speed")
        assert driver.session.draft.value(stormy) == "1.1 m/s"
        assert driver.session.draft.value((*CURRENT, "speed")) == "0.5 m/s"
        in_storm = driver.view.result.top.knockdown
        await driver.press("escape", "e")
        await driver.settle()
        assert driver.session.environment is None
        assert driver.view.result.top.knockdown < in_storm
        await driver.press("e", "w", "f7")
        assert driver.session.draft.value(("environments",)) is None

    drive(story, small)


def test_undo_reaches_the_water(drive, small):
    async def story(driver):
        before = driver.text
        await driver.press("w")
        await enter(driver, "depth", "150 m")
        await driver.press("ctrl+z")
        assert driver.text == before
        assert field(driver, "depth").input.value == "100 m"

    drive(story, small)
