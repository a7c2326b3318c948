"""The environment that the line stands in, and what becomes of it when the file is another."""

import pytest

from calm.tui.start import open_session
from calm.tui.text_screen import TextScreen


@pytest.fixture
def stormy(small):
    text = small.read_text()
    small.write_text(text + "environments:\n  storm: {current: {speed: 1 m/s, toward: 0 deg}}\n")
    return small


def test_an_environment_that_is_undone_leaves_the_line_in_the_own_one(drive, small):
    async def story(driver):
        await driver.press("w", "f6")
        await driver.type("storm")
        await driver.press("enter", "escape")
        await driver.settle()
        assert driver.view.environment == "storm"
        await driver.press("u")
        await driver.settle()
        assert driver.view.environment is None and not driver.view.problems
        assert "Environment storm no longer exists; the default environment" in driver.screen
        await driver.press("U")
        await driver.settle()
        assert driver.view.environment == "storm"

    drive(story, small)


def test_an_environment_that_another_program_takes_out(drive, stormy):
    without = stormy.read_text().partition("environments:")[0]

    async def story(driver):
        await driver.press("w")
        stormy.write_text(without)
        driver.app.saving.check_external_change()
        await driver.settle()
        assert "[default]" in driver.screen
        assert "Environment storm no longer exists" in driver.screen
        assert driver.view.environment is None and not driver.view.problems

    drive(story, stormy, environment="storm")


def test_a_text_that_cannot_be_read_changes_no_environment(drive, stormy):
    async def story(driver):
        await driver.press("t")
        assert isinstance(driver.app.screen, TextScreen)
        await driver.press("[", "space")
        await driver.settle()
        assert driver.session.draft.problems and driver.session.choice.environment == "storm"

    drive(story, stormy, environment="storm")


def test_an_environment_file_stays(small, folder):
    (folder / "env.yaml").write_text("environment: {depth: 90 m}\n")
    session, _ = open_session(small, "env.yaml")
    assert session.choice.environment == "env.yaml" and session.choice.lost_environment is None
    session.choice.environment = None
    assert session.choice.environment is None
