"""The file as text: what is not typed over stays byte for byte, and nothing in it is obeyed."""

import pytest
from textual.widgets import TextArea

from calm.tui.text_screen import TextScreen
from tests.tui.conftest import MOORING

HEAD = "name: Small\r\n# one\u2028# two\n"
UGLY = MOORING.replace("name: Small\n", HEAD)


@pytest.fixture
def ugly(small):
    small.write_bytes(UGLY.encode())
    return small


def test_one_key_changes_one_line_and_undo_gives_it_back(drive, ugly):
    async def story(driver):
        await driver.press("t", "ctrl+home", "down", "end", "space")
        assert driver.text == UGLY.replace("name: Small\r\n", "name: Small \r\n")
        await driver.press("down", "end", "x")
        typed = UGLY.replace("Small\r\n", "Small \r\n")
        assert driver.text == typed.replace("one\u2028", "onex\u2028")
        await driver.press("ctrl+z", "ctrl+z", "ctrl+z")
        assert driver.text == UGLY
        await driver.press("escape", "u")
        assert driver.text == UGLY

    drive(story, ugly)


def test_lines_are_added_and_taken_out_between_others(drive, ugly):
    async def story(driver):
        await driver.press("t", "ctrl+home", "end", "enter", "number_sign", "enter")
        first = UGLY.index("\n") + 1
        assert driver.text == UGLY[: first - 1] + "\n#\n" + UGLY[first - 1 :]
        await driver.press("ctrl+shift+k", "up", "ctrl+shift+k")
        assert driver.text == UGLY
        area = driver.app.screen.text_area
        area.move_cursor(area.document.end)
        await driver.press("enter", "number_sign")
        assert driver.text == UGLY + "\n#"

    drive(story, ugly)


def test_the_next_mistake_is_found_where_the_editor_has_more_lines(drive, ugly):
    ugly.write_bytes(UGLY.replace("60 m", "60 kg").encode())

    async def story(driver):
        assert isinstance(driver.app.screen, TextScreen)
        area = driver.app.screen.text_area
        await driver.press("f8")
        row, _ = area.cursor_location
        assert "60 kg" in area.document.lines[row]

    drive(story, ugly)


def test_what_a_file_says_is_no_markup(drive, small):
    small.write_text(MOORING.replace("label: deep logger", "'[/][bold': x, '[$error]': y"))

    async def story(driver):
        assert isinstance(driver.app.screen, TextScreen)
        assert "[/][bold" in driver.screen.rpartition("!")[2] or "[$error]" in driver.screen
        assert "2 mistakes" in driver.screen

    drive(story, small)


def test_a_draft_that_is_replaced_is_shown(drive, small):
    async def story(driver):
        await driver.press("t", "ctrl+home", "down", "number_sign")
        screen = driver.app.screen
        theirs = MOORING.replace("100 m", "150 m").replace("\n", "\r\n")
        driver.session.write(theirs)
        screen.replaced()
        await driver.settle()
        assert driver.text == theirs
        assert not screen.is_typing
        await driver.press("home", "number_sign")
        assert driver.text == theirs.replace("name:", "#name:")
        await driver.press("ctrl+z")
        assert driver.text == theirs

    drive(story, small)


def test_text_that_was_just_typed_is_taken(drive, small):
    async def story(driver):
        await driver.press("t", "ctrl+home")
        screen = driver.app.screen
        screen.text_area.insert("# mine\n", (0, 0))
        assert screen.is_typing
        assert screen.settle() and not screen.is_typing
        assert driver.text == "# mine\n" + MOORING

    drive(story, small)


def test_a_line_that_was_typed_is_taken_back(drive, small):
    async def story(driver):
        await driver.press("t", "ctrl+home")
        area = driver.app.screen.text_area
        await driver.press("end", "enter", "x", "ctrl+z", "y", "ctrl+z")
        await driver.settle()
        assert driver.text == MOORING
        assert area.wrapped_document.height == area.document.line_count
        await driver.press("ctrl+y")
        assert area.wrapped_document.height == area.document.line_count
        assert driver.text == MOORING.replace("logue.\n", "logue.\ny\n")

    drive(story, small)


def test_the_text_goes_to_its_ends(drive, small):
    async def story(driver):
        await driver.press("t", "ctrl+home")
        area = driver.app.screen.text_area
        await driver.press("ctrl+end")
        assert area.cursor_location == area.document.end
        await driver.press("ctrl+home")
        assert area.cursor_location == (0, 0)

    drive(story, small)


def test_the_text_opens_at_the_piece_and_finds_words(drive, small):
    async def story(driver):
        await driver.press("end", "up", "t")
        area = driver.app.screen.query_one(TextArea)
        row, _ = area.cursor_location
        assert area.document.lines[row].strip() == "- {use: releaser}"
        await driver.press("f3")
        assert "Press Ctrl+F" in driver.screen
        await driver.press("ctrl+f")
        await driver.type("LOGGER")
        await driver.press("enter")
        assert area.selected_text == "logger" and area.cursor_location[0] > row
        found = [area.cursor_location]
        for _ in range(4):
            await driver.press("f3")
            found.append(area.cursor_location)
        assert len(set(found[:4])) == 4 and found[4] == found[0]  # it begins again from the top
        await driver.press("ctrl+f")
        await driver.type("nowhere")
        await driver.press("enter")
        assert "nowhere: not found" in driver.screen
        assert driver.text == small.read_text()

    drive(story, small)


@pytest.mark.parametrize("text", ["", " \n\n", "\ufeff"])
def test_a_file_without_anything_offers_a_start(drive, folder, text):
    path = folder / "touched.yaml"
    path.write_text(text, encoding="utf-8")

    async def story(driver):
        assert "b   starts from a template" in driver.screen
        await driver.press("b", "1", "ctrl+s")
        await driver.settle()
        assert path.read_text(encoding="utf-8").startswith("# A sub-surface mooring")

    drive(story, path)
