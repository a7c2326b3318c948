"""Saving, leaving, and what is kept when a session ends early."""

import os
import signal

from calm.tui.dialogs import Question
from calm.tui.launch import open_session


def kept(path):
    return path.with_name(f".{path.name}.calm-autosave")


async def rename(driver, label="top"):
    await driver.press("n")
    await driver.type(label)
    await driver.press("enter")
    await driver.settle()


def test_save_writes_the_file_and_nothing_else_of_it_changes(drive, small):
    before = small.read_bytes()

    async def story(driver):
        await rename(driver)
        assert small.read_bytes() == before
        await driver.press("ctrl+s")
        assert "small.yaml saved" in driver.screen
        assert small.read_bytes() == before.replace(b"top float", b"top")
        assert not driver.session.changed
        assert not kept(small).exists()

    drive(story, small)


def test_a_new_line_is_asked_for_its_name(drive, folder):
    async def story(driver):
        await driver.press("s")
        await driver.type("iroise")
        await driver.press("enter")
        assert (folder / "iroise.yaml").read_text() == driver.text
        assert driver.session.name == "iroise.yaml"

    drive(story)


def test_save_as_asks_before_it_overwrites(drive, small, folder):
    (folder / "other.yaml").write_text("something")

    async def story(driver):
        await driver.press("S", "ctrl+u")
        await driver.type("other.yaml")
        await driver.press("enter")
        assert isinstance(driver.app.screen, Question)
        await driver.press("escape")
        assert (folder / "other.yaml").read_text() == "something"
        await driver.press("S", "ctrl+u")
        await driver.type("other.yaml")
        await driver.press("enter", "o")
        assert (folder / "other.yaml").read_text() == driver.text

    drive(story, small)


def test_a_folder_that_is_not_there_is_told(drive, small):
    async def story(driver):
        await driver.press("S", "ctrl+u")
        await driver.type("nowhere/a.yaml")
        await driver.press("enter")
        assert "there is no folder nowhere" in driver.screen

    drive(story, small)


def test_leave_at_once_when_all_is_saved(drive, small):
    async def story(driver):
        await driver.press("q")
        assert driver.app._exit

    drive(story, small)


def test_leaving_asks_about_unsaved_work(drive, small):
    before = small.read_text()

    async def story(driver):
        await rename(driver)
        await driver.press("q")
        assert isinstance(driver.app.screen, Question)
        await driver.press("escape")
        assert driver.app.screen is driver.builder
        await driver.press("ctrl+q", "d")
        assert driver.app._exit
        assert small.read_text() == before
        assert not kept(small).exists()

    drive(story, small)


def test_save_and_leave(drive, small):
    async def story(driver):
        await rename(driver)
        await driver.press("q", "s")
        assert driver.app._exit
        assert "label: top}" in small.read_text()

    drive(story, small)


def test_unsaved_work_is_kept_beside_the_file_and_offered(drive, small):
    async def first(driver):
        await rename(driver)
        await driver.pilot.pause(0.5)  # it is kept a moment after the change
        assert kept(small).read_text() == driver.text

    drive(first, small)  # ends without leaving, as a crash does

    async def second(driver):
        assert isinstance(driver.app.screen, Question)
        await driver.press("escape")  # it must be answered
        assert isinstance(driver.app.screen, Question)
        await driver.press("r")
        await driver.settle()
        assert driver.session.draft.items[0].values["label"] == "top"
        assert driver.session.changed
        await driver.press("u")
        assert driver.session.draft.items[0].values["label"] == "top float"

    drive(second, small)


def test_what_was_kept_can_be_thrown_away(drive, small):
    kept(small).write_text(small.read_text() + "# more\n")

    async def story(driver):
        await driver.press("d")
        assert not kept(small).exists()
        assert not driver.session.changed

    drive(story, small)


def test_a_signal_keeps_the_work(drive, small):
    async def story(driver):
        await rename(driver)
        kept(small).unlink(missing_ok=True)
        os.kill(os.getpid(), signal.SIGTERM)
        await driver.pilot.pause()
        assert driver.app._exit
        assert kept(small).read_text() == driver.text

    drive(story, small)


def test_a_file_changed_by_another_program_is_read_again(drive, small):
    async def story(driver):
        small.write_text(small.read_text().replace("60 m", "55 m"))
        driver.app.look_at_disk()
        await driver.settle()
        assert driver.session.draft.items[1].values["length"] == "55 m"
        assert "another program has changed it" in driver.screen

    drive(story, small)


def test_a_changed_file_is_not_overwritten_unasked(drive, small):
    async def story(driver):
        await rename(driver)
        theirs = small.read_text().replace("60 m", "55 m")
        small.write_text(theirs)
        driver.app.look_at_disk()
        await driver.pilot.pause()
        assert "changed by another program" in driver.screen
        await driver.press("ctrl+s")
        assert isinstance(driver.app.screen, Question)
        await driver.press("t")
        assert small.read_text() == theirs == driver.text
        await driver.press("u", "ctrl+s")
        assert "label: top}" in small.read_text()

    drive(story, small)


def test_a_file_that_cannot_be_written_is_told(drive, small, monkeypatch):
    def refuse(*_):
        raise OSError(28, "No space left on device")

    async def story(driver):
        await rename(driver)
        await driver.pilot.pause(0.5)  # the change is kept meanwhile
        monkeypatch.setattr(os, "replace", refuse)
        await driver.press("ctrl+s")
        assert "No space left" in driver.screen
        assert driver.session.changed

    drive(story, small)


def test_open_a_file_that_is_not_there_yet(folder):
    session, recovered = open_session(folder / "new.yaml")
    assert session.name == "new.yaml"
    assert recovered is None
    assert session.draft.items == ()
