"""Saving, leaving, and what is kept when a session ends early."""

import os
import signal
import threading
import time

import pytest
from textual.events import Key, Paste
from textual.messages import ExitApp
from textual.widgets import Input, TextArea

from calm.files.editing import WorkingFile
from calm.tui import start
from calm.tui.dialogs import InputSheet, Question
from calm.tui.field import Field
from calm.tui.saving import chosen_path
from calm.tui.start import open_session
from calm.tui.text_screen import TextScreen
from calm.tui.water_screen import WaterScreen


def copies(path):
    return list(path.parent.glob(f".{path.name}.*.calm-autosave"))


def kept(path):
    """The text of the one copy that there is."""
    (copy,) = copies(path)
    return copy.read_text().partition("\n")[2]


async def until(driver, condition):
    for _ in range(1000):
        if condition():
            return
        await driver.pilot.pause(0.01)
    raise AssertionError("it has not come about")


async def theirs(driver, path, old="60 m", new="55 m"):
    """Another program changes the file, and the application looks."""
    text = path.read_text().replace(old, new)
    path.write_text(text)
    driver.app.saving.check_external_change()
    await driver.settle()
    return text


@pytest.fixture
def of_another(monkeypatch):
    """Leaves a copy of unsaved work as another process, or one of another machine, does."""

    def leave(path, text, *, runs=False, host=None):
        process = os.getpid() if runs else 2**30  # more than any system counts to
        with monkeypatch.context() as there:
            there.setattr(os, "getpid", lambda: process)
            if host:
                there.setattr("socket.gethostname", lambda: host)
            file = WorkingFile(path)
            if path is not None and path.exists():
                file.read()
            file.unsaved = text
            return file.keep()

    return leave


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
        assert not copies(small)

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
        assert not copies(small)

    drive(story, small)


def test_save_and_leave(drive, small):
    async def story(driver):
        await rename(driver)
        await driver.press("q", "s")
        assert driver.app._exit
        assert "label: top}" in small.read_text()

    drive(story, small)


def test_unsaved_work_is_kept_beside_the_file(drive, small):
    async def story(driver):
        await rename(driver)
        await until(driver, lambda: copies(small))  # a moment after the change
        assert kept(small) == driver.text
        await driver.press("u")
        await until(driver, lambda: not copies(small))  # nothing is unsaved any more

    drive(story, small)


def test_a_slow_disk_holds_up_no_key(drive, small, monkeypatch):
    going_on, begun = threading.Event(), threading.Event()
    really = WorkingFile.keep

    def slowly(file):
        if threading.current_thread() is not threading.main_thread():
            begun.set()
            assert going_on.wait(60)
        return really(file)

    async def story(driver):
        monkeypatch.setattr(WorkingFile, "keep", slowly)
        await driver.press("n", "a", "enter")
        await until(driver, begun.is_set)
        await driver.press("n", "b", "enter", "ctrl+s")
        going_on.set()
        await driver.settle()
        assert "label: b}" in small.read_text()
        assert not copies(small)  # what comes late keeps nothing that is saved

    drive(story, small)


def test_unsaved_work_is_offered(drive, small, of_another):
    text = small.read_text().replace("top float", "top")
    place = of_another(small, text)
    os.utime(place, (1e9, 1e9))
    shown = time.strftime("%Y-%m-%d at %H:%M", time.localtime(1e9))

    async def story(driver):
        assert isinstance(driver.app.screen, Question)
        assert shown in driver.screen and "changed" not in driver.screen
        await driver.press("escape")  # it must be answered
        assert isinstance(driver.app.screen, Question)
        await driver.press("r")
        await driver.settle()
        assert driver.text == text and driver.session.changed
        await driver.press("u")
        await driver.settle()
        assert driver.session.draft.items[0].values["label"] == "top float"
        await driver.press("q")
        assert driver.app._exit and place.exists()  # it was neither saved nor given up

    drive(story, small)

    async def saved(driver):
        await driver.press("r", "ctrl+s")
        assert small.read_text() == text and not place.exists()

    drive(saved, small)


def test_recovery_says_that_the_file_is_newer(drive, small, of_another):
    of_another(small, small.read_text().replace("top float", "top"))
    newer = small.read_text().replace("60 m", "55 m")
    small.write_text(newer)
    os.utime(small, (1e9, 1e9))
    shown = time.strftime("%Y-%m-%d at %H:%M", time.localtime(1e9))

    async def story(driver):
        assert f"was changed, {shown}" in " ".join(driver.screen.replace("▌", " ").split())
        await driver.press("r")
        await driver.settle()
        await driver.press("ctrl+s")
        assert isinstance(driver.app.screen, Question)  # as it would have been without the crash
        assert small.read_text() == newer
        await driver.press("t")
        assert driver.text == newer

    drive(story, small)


def test_recovery_says_that_the_file_is_gone(drive, small, of_another):
    text = small.read_text().replace("top float", "top")
    of_another(small, text)
    small.unlink()

    async def story(driver):
        assert "was deleted after that work began" in " ".join(
            driver.screen.replace("▌", " ").split()
        )
        await driver.press("r", "ctrl+s")
        assert small.read_text() == text

    drive(story, small)


def test_work_can_be_kept_for_later(drive, small, of_another):
    place = of_another(small, small.read_text() + "# more\n")

    async def story(driver):
        await driver.press("k")
        await rename(driver)
        await driver.press("ctrl+s", "q")
        assert driver.app._exit and place.exists()

    drive(story, small)


def test_throwing_away_is_confirmed(drive, small, of_another):
    place = of_another(small, small.read_text() + "# more\n")

    async def story(driver):
        await driver.press("d", "d", "d")  # typed ahead
        assert place.exists() and "discard permanently" in driver.screen
        await driver.press("escape")
        assert "keep for later" in driver.screen
        await driver.press("d", "y")
        assert not place.exists()
        assert not driver.session.changed

    drive(story, small)


def test_a_machine_that_cannot_be_asked_is_named(drive, small, of_another):
    of_another(small, small.read_text() + "# more\n", host="ship")

    async def story(driver):
        assert "on ship, where the file may still be open" in " ".join(
            driver.screen.replace("▌", " ").split()
        )

    drive(story, small)


def test_the_work_of_a_running_session_is_left_alone(drive, small, of_another):
    place = of_another(small, small.read_text() + "# more\n", runs=True)

    async def story(driver):
        assert driver.app.screen is driver.builder
        assert "small.yaml is open elsewhere" in driver.screen
        await rename(driver)
        await driver.press("q", "d")
        assert driver.app._exit and place.exists()

    drive(story, small)


@pytest.fixture
def not_kept_in_time(monkeypatch):
    """What ends a session comes before its work is kept."""
    monkeypatch.setattr("calm.tui.app._AUTOSAVE_DELAY", 1e6)


@pytest.fixture
def end(monkeypatch):
    """Ends an application as a signal does, in a terminal that is there or not."""
    done = []
    monkeypatch.setattr(os, "kill", lambda _, number: done.append(("killed", number)))
    monkeypatch.setattr(signal, "alarm", lambda seconds: done.append(("alarm", seconds)))

    def ended(app, number, *, terminal):
        done.clear()
        monkeypatch.setattr(os, "isatty", lambda _: terminal)
        start.end(app, number, None)
        return done

    return ended


@pytest.mark.usefixtures("not_kept_in_time")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_signal_keeps_the_work_at_once(drive, small, end, number):
    """Whatever the application waits for: its own loop is not asked."""

    async def story(driver):
        await rename(driver)
        assert not copies(small)
        assert end(driver.app, number, terminal=False) == [("killed", number)]
        assert kept(small) == driver.text and not driver.app._exit
        await driver.press("q", "d")
        end(driver.app, number, terminal=False)
        assert not copies(small)  # the work was given up

    drive(story, small)


def test_a_terminal_that_is_there_is_put_right_within_a_time(drive, small, end):
    async def story(driver):
        assert end(driver.app, signal.SIGTERM, terminal=True) == [("alarm", 3)]
        await until(driver, lambda: driver.app._exit)

    drive(story, small)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_signal_leaves_the_work_that_is_offered(drive, small, of_another, end, number):
    place = of_another(small, small.read_text() + "# more\n")

    async def story(driver):
        small.write_text(small.read_text() + "# theirs\n")
        driver.app.saving.check_external_change()
        await driver.settle()
        end(driver.app, number, terminal=True)
        await until(driver, lambda: driver.app._exit)

    drive(story, small)
    assert place.exists()


@pytest.mark.usefixtures("not_kept_in_time")
def test_a_closed_page_keeps_the_work(drive, small):
    async def story(driver):
        await rename(driver)
        driver.app.post_message(ExitApp())  # as the driver of a browser does

    drive(story, small)
    assert "label: top}" in kept(small)


@pytest.mark.usefixtures("not_kept_in_time")
def test_work_that_cannot_be_kept_is_told_at_the_end(drive, small, monkeypatch):
    def refuse(*_):
        raise OSError(28, "No space left on device")

    async def story(driver):
        await rename(driver)
        monkeypatch.setattr(os, "replace", refuse)
        driver.app.save_copy_on_exit()
        assert "No space left" in driver.app.not_kept

    drive(story, small)


def test_a_file_changed_by_another_program_is_read_again(drive, small):
    async def story(driver):
        await theirs(driver, small)
        assert driver.session.draft.items[1].values["length"] == "55 m"
        assert "the file was changed by another program" in driver.screen

    drive(story, small)


def test_the_text_view_shows_what_is_read_again(drive, small):
    async def story(driver):
        await driver.press("t", "ctrl+home")
        text = await theirs(driver, small)
        await driver.press("#")
        assert driver.text == "#" + text

    drive(story, small)


def test_the_water_shows_what_is_read_again(drive, small):
    async def story(driver):
        await driver.press("w")
        await theirs(driver, small, "100 m ", "90 m ")
        assert driver.app.screen.query_one("#depth", Field).text == "90 m"
        await driver.press("ctrl+u", "1", "2", "0", "enter", "ctrl+s")
        assert "depth: 120 m " in small.read_text() and "60 m" in small.read_text()

    drive(story, small)


def test_what_is_being_typed_is_not_replaced(drive, small):
    before = small.read_text()

    async def story(driver):
        await driver.press("n", "x")
        text = await theirs(driver, small)
        assert driver.text == before and "Another program changed the file" in driver.screen
        await driver.press("y", "ctrl+s")
        assert isinstance(driver.app.screen, Question) and small.read_text() == text
        assert "label: xy}" in driver.text

    drive(story, small)


def test_a_file_that_is_read_again_closes_the_editor_of_another_text(drive, small):
    """The row that was edited may be another piece, or gone."""

    async def story(driver):
        await driver.press("end", "n")  # nothing typed yet
        line = small.read_text().partition("line:")[0] + "line: []\n"
        small.write_text(line)
        driver.app.saving.check_external_change()
        await driver.settle()
        assert driver.text == line and not driver.builder.line.editor.is_open
        await driver.press("x", "enter")
        assert driver.text == line

    drive(story, small)


def test_a_change_is_told_once(drive, small):
    async def story(driver):
        await rename(driver)
        await theirs(driver, small)
        assert "Another program changed the file" in driver.screen
        await driver.press("down")
        driver.app.saving.check_external_change()
        await driver.settle()
        assert "Another program changed the file" not in driver.screen
        await theirs(driver, small, "55 m", "554 m")
        assert "Another program changed the file" in driver.screen

    drive(story, small)


def test_a_file_that_is_gone_is_not_saved_any_more(drive, small):
    before = small.read_text()

    async def story(driver):
        small.unlink()
        driver.app.saving.check_external_change()
        await driver.settle()
        assert "deleted from the disk" in driver.screen and "not saved" in driver.screen
        await driver.press("q")
        assert isinstance(driver.app.screen, Question)
        await driver.press("s")
        assert small.read_text() == before

    drive(story, small)


@pytest.mark.thorough
def test_the_last_copy_of_a_file_that_is_gone_is_kept(drive, small):
    before = small.read_text()

    async def story(driver):
        small.unlink()
        driver.app.saving.check_external_change()
        await driver.settle()
        await until(driver, lambda: copies(small))
        assert kept(small) == before
        await driver.press("q")
        assert "small.yaml was deleted from the disk" in driver.screen and not driver.app._exit
        await driver.press("escape", "ctrl+s")
        assert small.read_text() == before and not copies(small)
        await driver.press("q")
        assert driver.app._exit

    drive(story, small)


def test_their_broken_text_is_opened_as_text(drive, small):
    async def story(driver):
        await driver.press("w")
        assert isinstance(driver.app.screen, WaterScreen)
        await theirs(driver, small, "line:", "line: [")
        assert isinstance(driver.app.screen, TextScreen)
        assert "[" in driver.app.screen.query_one(TextArea).text
        await driver.press("ctrl+z")
        await theirs(driver, small, "line: [", "line:")
        await driver.press("escape")
        assert driver.app.screen is driver.builder

    drive(story, small)


def test_undo_to_a_broken_text_opens_it(drive, small):
    good = small.read_text()
    small.write_text(good.replace("line:", "line: ["))

    async def story(driver):
        assert isinstance(driver.app.screen, TextScreen)
        await theirs(driver, small, "line: [", "line:")
        await driver.press("escape")
        assert driver.app.screen is driver.builder
        await driver.press("w", "ctrl+z")
        await driver.settle()
        assert isinstance(driver.app.screen, TextScreen)

    drive(story, small)


def test_a_changed_file_is_not_overwritten_unasked(drive, small):
    async def story(driver):
        await rename(driver)
        theirs = small.read_text().replace("60 m", "55 m")
        small.write_text(theirs)
        driver.app.saving.check_external_change()
        await driver.pilot.pause()
        assert "Another program changed the file" in driver.screen
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
        await until(driver, lambda: copies(small))
        monkeypatch.setattr(os, "replace", refuse)
        await driver.press("ctrl+s")
        assert "No space left" in driver.screen
        assert driver.session.changed

    drive(story, small)


def test_open_a_file_that_is_not_there_yet(folder):
    session, offered = open_session(folder / "new.yaml")
    assert session.name == "new.yaml"
    assert offered is None
    assert session.draft.items == ()


def test_another_name_in_a_conflict_is_another_file(drive, small, folder):
    async def story(driver):
        await rename(driver)
        text = await theirs(driver, small)
        await driver.press("ctrl+s", "n")
        assert isinstance(driver.app.screen, InputSheet)
        assert driver.app.screen.query_one(Input).value.endswith("small-2.yaml")
        await driver.press("enter")
        assert small.read_text() == text
        assert "label: top}" in (folder / "small-2.yaml").read_text()
        assert driver.session.name == "small-2.yaml"

    drive(story, small)


def test_the_same_name_typed_in_a_conflict_asks_again(drive, small):
    async def story(driver):
        await rename(driver)
        text = await theirs(driver, small)
        await driver.press("ctrl+s", "n", "ctrl+u")
        await driver.type("../work/small")
        await driver.press("enter")
        assert isinstance(driver.app.screen, Question)
        assert "was changed by another program" in driver.screen
        assert small.read_text() == text

    drive(story, small)


def test_a_protected_file_is_asked_about(drive, small, monkeypatch):
    before = small.read_text()

    async def story(driver):
        await rename(driver)
        monkeypatch.setattr(os, "access", lambda *_: False)  # as of a person, not of root
        await driver.press("ctrl+s")
        assert "small.yaml is write-protected" in driver.screen
        await driver.press("escape")
        assert small.read_text() == before
        await driver.press("ctrl+s", "o")
        assert "label: top}" in small.read_text()

    drive(story, small)


def test_every_beginning_of_a_path_can_be_typed(drive, small):
    wholes = ["/a/x.yaml", "./x", "~x", "~/x", "../..", "a\0b"]
    begun = [whole[:end] for whole in wholes for end in range(1, len(whole) + 1)]

    async def story(driver):
        await driver.press("S")
        asked = driver.app.screen.query_one(Input)
        for text in [*begun, "n" * 300]:
            asked.value = text
            await driver.pilot.pause()
        assert isinstance(driver.app.screen, InputSheet)

    drive(story, small)


@pytest.mark.parametrize(
    ("typed", "told"),
    [("moorings", "is a folder"), ("a\0b", "a null character"), ("a\0b.yaml", "a null character")],
)
def test_a_name_that_cannot_be_one_is_told(drive, folder, typed, told):
    (folder / "moorings").mkdir()

    async def story(driver):
        await driver.press("S")
        driver.app.screen.query_one(Input).value = typed
        await driver.press("enter")
        assert isinstance(driver.app.screen, InputSheet) and told in driver.screen
        assert [each.name for each in folder.iterdir()] == ["moorings"]

    drive(story)


def test_the_suffix_is_added_to_names_only():
    assert str(chosen_path("a")) == "a.yaml"
    assert str(chosen_path("a.yml")) == "a.yml"
    assert str(chosen_path("/")) == "/"
    assert str(chosen_path("..")) == ".."
    assert str(chosen_path(".")) == "."


def test_what_is_being_typed_is_saved(drive, small):
    async def story(driver):
        await driver.press("n")
        await driver.type("mine")
        await driver.press("ctrl+s")
        assert "label: mine}" in small.read_text()
        await driver.press("w", "ctrl+u")
        await driver.type("120 m")
        await driver.press("ctrl+s")
        assert "depth: 120 m " in small.read_text()
        assert not driver.session.changed

    drive(story, small)


def test_what_is_being_typed_is_asked_about(drive, small):
    async def story(driver):
        await driver.press("w", "ctrl+u")
        await driver.type("120 m")
        await driver.press("ctrl+q")
        assert isinstance(driver.app.screen, Question) and not driver.app._exit

    drive(story, small)


def test_a_bad_value_is_not_saved_around(drive, small):
    before = small.read_text()

    async def story(driver):
        await driver.press("w", "ctrl+u")
        await driver.type("120 kg")
        for key in ("ctrl+s", "ctrl+q"):
            await driver.press(key)
            assert isinstance(driver.app.screen, WaterScreen) and not driver.app._exit
            assert small.read_text() == before

    drive(story, small)


def test_a_file_in_another_folder_is_judged_there(drive, small, folder):
    (folder / "now.csv").write_text("depth [m],u [m/s],v [m/s]\n0,0.5,0\n100,0.2,0\n")
    uniform = "{speed: 0.5 m/s, toward: 90 deg}"
    small.write_text(small.read_text().replace(uniform, "{file: now.csv}"))
    (folder / "other").mkdir()

    async def story(driver):
        assert not driver.view.problems
        await driver.press("S", "ctrl+u")
        await driver.type("other/small.yaml")
        await driver.press("enter")
        await driver.settle()
        assert driver.view.path.parent.name == "other"
        assert "now.csv" in driver.view.problems[0].message

    drive(story, small)


def test_an_edit_does_not_wait_for_the_full_check(drive, small, monkeypatch):
    from calm.tui import live

    going_on, begun = threading.Event(), threading.Event()
    really = live.judge_fully

    def slowly(view, catalogs):
        begun.set()
        assert going_on.wait(60)
        return really(view, catalogs)

    async def story(driver):
        monkeypatch.setattr(live, "judge_fully", slowly)
        await driver.press("n", "a", "enter")
        await until(driver, lambda: driver.view.text == driver.text)
        driver.app.judging.ask_fully()
        await until(driver, begun.is_set)
        await driver.press("n", "b", "enter")
        await until(driver, lambda: driver.view.text == driver.text)  # the check is under way
        going_on.set()
        await driver.settle()
        assert driver.view.text == driver.text and not driver.view.complete
        driver.app.judging.ask_fully()
        await driver.settle()
        assert driver.view.complete

    drive(story, small)


def test_a_paste_waits_for_the_keys_before_it(drive, small):
    async def story(driver):
        for event in (Key("n", "n"), Paste("pasted"), Key("enter", None), Key("down", None)):
            driver.app.post_message(event)
        await until(driver, lambda: not driver.app.has_keys_waiting and driver.session.changed)
        assert driver.session.draft.items[0].values["label"] == "pasted"

    drive(story, small)
