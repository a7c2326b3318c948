"""Every verb of the line, by its keys."""

import re

import pytest

from tests.tui.conftest import MOORING

WIRE = "wire-jacketed-8"


def test_the_rows_show_what_the_file_says_and_what_was_found(drive, small):
    async def story(driver):
        rows = driver.table.rows
        assert [row.texts["component"] for row in rows] == [
            "ball", "rope", "├ logger", "├ logger", "releaser", "weight",
        ]  # fmt: skip
        assert [row.texts["length"] for row in rows][1:4] == ["60 m", "at 10 m", "at 20 m"]
        top = driver.view.result.components[0]
        assert rows[0].texts["depth"] == f"{top.depth_top:.1f}"
        assert rows[1].texts["tension"] == f"{driver.view.result.components[1].tension:.0f}"
        assert [row.sign for row in rows] == ["o", "│", "▪", "▪", "R", "█"]

    drive(story, small)


def test_add_a_cable_below_with_its_length_and_label(drive, small):
    async def story(driver):
        await driver.press("a")
        await driver.type("jacketed-8")
        assert driver.builder.catalogue.listing.chosen.id == WIRE
        await driver.press("enter")
        await driver.type("25")
        await driver.press("tab")
        await driver.type("first wire")
        await driver.press("enter")
        await driver.settle()
        assert driver.uses[:2] == ["ball", WIRE]
        assert driver.session.draft.items[1].values == {
            "use": WIRE, "length": "25 m", "label": "first wire",
        }  # fmt: skip
        assert driver.table.spot.item == 1
        assert "Add below first wire" in driver.screen
        await driver.press("escape")
        assert driver.table.has_focus

    drive(story, small)


@pytest.mark.parametrize(
    ("typed", "keys"),
    [
        ("fit 60", {"length": "fit", "top_depth": "60 m"}),
        ("25 at 2", {"length_at": {"load": "2 kN", "length": "25 m"}}),
    ],
)
def test_the_form_of_a_new_cable_takes_what_its_cell_takes(drive, small, typed, keys):
    async def story(driver):
        await driver.press("a")
        await driver.type(WIRE)
        await driver.press("enter")
        await driver.type(typed)
        await driver.press("enter", "enter", "escape")
        await driver.settle()
        assert driver.session.draft.value(("line", 1)) == {"use": WIRE, **keys}
        assert not driver.view.problems

    drive(story, small)


@pytest.mark.parametrize("width", [80, 120])
def test_hints_below_an_empty_line_are_not_cut(drive, folder, width):
    async def story(driver):
        lines = driver.screen.splitlines()
        pane = " ".join(line[: driver.table.size.width].strip() for line in lines)
        assert "adds the first piece, from the catalogue" in " ".join(pane.split())
        assert "ADCP, taut or slack surface, or tow" in " ".join(pane.split())

    drive(story, folder / "new.yaml", size=(width, 36))


def test_the_cursor_goes_on_where_the_line_is_longer_than_the_screen(drive, small):
    """What a table scrolls by where it overflows would take these keys."""

    async def story(driver):
        await driver.press(*["d"] * 40)
        rows = len(driver.table.rows)
        assert rows > driver.table.size.height
        await driver.press("home")
        assert driver.table.cursor == 0
        await driver.press("down", "down", "up")
        assert driver.table.cursor == 1
        await driver.press("end")
        assert driver.table.cursor == rows - 1
        await driver.press("pageup")
        assert driver.table.cursor == rows - 1 - (driver.table.size.height - 2)

    drive(story, small)


def test_add_above_and_go_on_below(drive, small):
    async def story(driver):
        await driver.press("A")
        await driver.type("shackle-19")
        await driver.press("enter", "enter")
        assert driver.uses[:3] == ["shackle-19", "shackle-19", "ball"]

    drive(story, small)


def test_the_search_holds_every_word_wherever_it_stands(drive, small):
    async def story(driver):
        await driver.press("f7")
        await driver.type("teledyne adcp")
        found = driver.builder.catalogue.listing.rows
        assert found
        assert all("Teledyne" in each.maker and "adcp" in each.searched for each in found)
        await driver.press("ctrl+u")
        await driver.type("no such thing")
        assert "No component matches all words" in driver.screen
        await driver.press("enter")
        assert len(driver.session.draft.items) == 4

    drive(story, small)


def test_the_files_own_components_come_first_with_a_card(drive, small):
    async def story(driver):
        await driver.press("f7")
        assert driver.builder.catalogue.listing.rows[0].own
        await driver.type("releaser")
        assert driver.builder.catalogue.listing.rows[0].id == "releaser"
        await driver.settle()
        assert "-200 N" in driver.screen

    drive(story, small)


def test_clamp_an_instrument_on_a_piece(drive, small):
    async def story(driver):
        await driver.press("down", "i")
        assert {each.kind for each in driver.builder.catalogue.listing.rows} <= {
            "sphere", "cylinder", "body", "profiler",
        }  # fmt: skip
        await driver.type("sbe37")
        await driver.press("enter")
        await driver.type("5")
        await driver.press("enter")
        await driver.press("enter")  # no label
        clamps = driver.session.draft.items[1].clamps
        assert clamps[2].values == {"use": "sbe37", "at": "5 m"}

    drive(story, small)


def test_replace_a_component_and_keep_the_rest(drive, small):
    async def story(driver):
        await driver.press("down", "r")
        await driver.type(WIRE)
        await driver.press("enter")
        item = driver.session.draft.items[1]
        assert item.values == {"use": WIRE, "length": "60 m"}
        assert len(item.clamps) == 2
        assert driver.table.has_focus

    drive(story, small)


def test_edit_a_length_in_place_and_let_it_have_its_unit(drive, small):
    async def story(driver):
        await driver.press("down", "l")
        await driver.type("75")
        assert "= 75 m" in driver.screen
        before = driver.view.result.top.depth
        await driver.press("enter")
        await driver.settle()
        assert driver.session.draft.items[1].values["length"] == "75 m"
        assert "    length: 75 m\n" in driver.text
        # 15 m more of a rope that hangs some degrees from the vertical
        assert driver.view.result.top.depth == pytest.approx(before - 15.0, abs=1.0)

    drive(story, small)


def test_the_unit_of_before_is_the_one_that_is_added(drive, small):
    small.write_text(small.read_text().replace("60 m", "200 ft"))

    async def story(driver):
        await driver.press("down", "l")
        await driver.type("210")
        await driver.press("enter")
        assert driver.session.draft.items[1].values["length"] == "210 ft"

    drive(story, small)


def test_a_text_that_is_no_length_is_not_taken(drive, small):
    async def story(driver):
        before = driver.text
        await driver.press("down", "l")
        await driver.type("60 kg")
        await driver.press("enter")
        assert driver.builder.line.editor.is_open
        assert "is a mass" in driver.screen
        await driver.press("escape")
        assert driver.text == before

    drive(story, small)


def test_a_decimal_comma_is_corrected_first_and_taken_then(drive, small):
    async def story(driver):
        await driver.press("down", "l")
        await driver.type("60,5 m")
        await driver.press("enter")
        assert driver.builder.line.editor.value == "60.5 m"
        await driver.press("enter")
        assert driver.session.draft.items[1].values["length"] == "60.5 m"

    drive(story, small)


def test_cut_a_piece_to_fit_a_depth(drive, small):
    async def story(driver):
        await driver.press("down", "l")
        await driver.type("fit 30")
        await driver.press("enter")
        await driver.settle()
        values = driver.session.draft.items[1].values
        assert (values["length"], values["top_depth"]) == ("fit", "30 m")
        assert driver.table.rows[1].texts["length"] == "fit: 67.33 m"
        await driver.press("l")
        await driver.type("60 m")
        await driver.press("enter")
        assert "top_depth" not in driver.session.draft.items[1].values

    drive(story, small)


def test_edit_labels_and_counts_and_go_on_with_tab(drive, small):
    async def story(driver):
        await driver.press("n")
        await driver.type("upper float")
        await driver.press("tab")
        await driver.type("2")
        await driver.press("enter")
        values = driver.session.draft.items[0].values
        assert (values["label"], values["count"]) == ("upper float", "2")
        await driver.press("equals_sign")
        await driver.type("1")
        await driver.press("enter")
        assert "count" not in driver.session.draft.items[0].values

    drive(story, small)


def test_move_a_clamp_along_its_piece(drive, small):
    async def story(driver):
        await driver.press("down", "down", "l")
        await driver.type("12 m")
        await driver.press("enter")
        assert driver.session.draft.items[1].clamps[0].values["at"] == "12 m"
        await driver.press("equals_sign")
        assert not driver.builder.line.editor.is_open

    drive(story, small)


def test_delete_undo_and_redo_without_limit(drive, small):
    async def story(driver):
        before = driver.text
        for _ in range(4):
            await driver.press("delete")
        await driver.settle()
        assert driver.session.draft.items == ()
        for _ in range(4):
            await driver.press("u")
        assert driver.text == before
        await driver.press("u")
        assert "No changes left to be undone" in driver.screen
        for _ in range(4):
            await driver.press("U")
        assert driver.session.draft.items == ()

    drive(story, small)


def test_duplicate_and_move(drive, small):
    async def story(driver):
        await driver.press("end", "up", "d")
        assert driver.uses[-3:] == ["releaser", "releaser", "weight"]
        await driver.press("alt+up", "alt+up")
        assert driver.uses == [
            "ball", "releaser", "rope", "  logger", "  logger", "releaser", "weight",
        ]  # fmt: skip
        assert driver.table.spot.item == 1
        await driver.press("J")
        assert driver.uses[1] == "rope"

    drive(story, small)


@pytest.mark.thorough
def test_a_piece_at_the_end_of_the_line_stays_there(drive, small):
    async def story(driver):
        before = driver.text
        await driver.press("alt+up", "end", "alt+down")
        assert driver.text == before
        assert not driver.session.changed

    drive(story, small)


def test_cut_and_paste_with_the_comment_that_belongs_to_it(drive, small):
    async def story(driver):
        await driver.press("end", "up", "x")
        assert driver.uses == ["ball", "rope", "  logger", "  logger", "weight"]
        await driver.press("home", "v")
        assert driver.uses[:2] == ["ball", "releaser"]
        assert "  # the release is ours\n  - {use: releaser}\n" in driver.text
        await driver.press("V")
        assert driver.uses[:3] == ["ball", "releaser", "releaser"]

    drive(story, small)


def test_copy_marked_rows_and_clamps(drive, small):
    async def story(driver):
        await driver.press("shift+down", "c", "end", "V")
        assert driver.uses.count("rope") == 2
        assert driver.uses.count("  logger") == 4
        await driver.press("u", "home", "down", "down", "c", "end", "up", "v")
        assert driver.uses[-2:] == ["  logger", "weight"]
        assert driver.session.draft.items[2].clamps[0].values == {"use": "logger", "at": "10 m"}

    drive(story, small)


@pytest.mark.parametrize("key", ["c", "alt+up"])
def test_pieces_with_clamps_of_others_are_not_copied_nor_moved(drive, small, key):
    async def story(driver):
        before = driver.text
        await driver.press("c", "down", "down", "down", "space", "down", "space", key)
        assert driver.text == before
        assert "Pieces and clamps on other pieces are both marked" in driver.screen
        assert len(driver.table.marked) == 2
        await driver.press("delete")
        assert driver.uses == ["ball", "rope", "  logger", "weight"]
        await driver.press("v")
        assert driver.uses.count("ball") == 2

    drive(story, small)


def test_mark_and_delete_several(drive, small):
    async def story(driver):
        await driver.press("space", "end", "space", "delete")
        assert driver.uses == ["rope", "  logger", "  logger", "releaser"]
        await driver.press("u", "ctrl+a", "delete")
        assert driver.session.draft.items == ()

    drive(story, small)


def test_what_is_not_touched_stays_as_it_was_written(drive, small):
    async def story(driver):
        before = driver.text.splitlines()
        await driver.press("n")
        await driver.type("top")
        await driver.press("enter")
        changed = [(a, b) for a, b in zip(before, driver.text.splitlines(), strict=True) if a != b]
        assert changed == [
            (
                "  - {use: ball, label: top float}     # carries all",
                "  - {use: ball, label: top}     # carries all",
            )
        ]

    drive(story, small)


def test_the_mouse_goes_to_a_cell_and_edits_it_at_the_second_press(drive, small):
    async def story(driver):
        start = next(each.start for each in driver.table.columns if each.name == "label")
        await driver.pilot.click("#line", offset=(start + 1, 2))
        assert (driver.table.cursor, driver.table.editable[driver.table.column]) == (1, "label")
        await driver.pilot.click("#line", offset=(start + 1, 2))
        assert driver.builder.line.editor.is_open

    drive(story, small)


def test_begin_with_nothing(drive):
    async def story(driver):
        assert driver.table.rows == ()
        await driver.press("delete", "d", "alt+up", "x", "v", "space", "l", "escape", "a")
        await driver.type("sphere-ore-41in")
        await driver.press("enter", "escape")
        assert driver.uses == ["sphere-ore-41in"]

    drive(story)


WORDED = """\
    clamps:
      # borrowed
      - use: logger   # serial 1234
        at: '10 m'
        drag_measurements: [[0.1, 1.2]]
      - {use: logger, at: 20 m, label: "deep logger"}
"""
CLAMPS = MOORING[MOORING.index("    clamps:") : MOORING.index("  # the release")]
FIRST, SECOND = re.findall(r"      #.*?\]\]\n|      - {.*\n", WORDED, re.DOTALL)


@pytest.fixture
def worded(small):
    """A clamp with nested figures, a comment and quotes."""
    small.write_text(MOORING.replace(CLAMPS, WORDED))
    return small


def test_a_clamp_is_moved_duplicated_and_copied_word_for_word(drive, worded):
    before = worded.read_text()

    async def story(driver):
        await driver.press("escape", "down", "down", "alt+down")
        assert driver.text == before.replace(FIRST + SECOND, SECOND + FIRST)
        await driver.press("alt+up")
        assert driver.text == before
        await driver.press("d")
        assert driver.text == before.replace(FIRST, FIRST + FIRST)
        await driver.press("u", "up", "c", "down", "v")
        assert driver.text == before.replace(SECOND, SECOND + FIRST)
        await driver.press("u", "home", "down", "down", "x", "V")
        assert driver.text == before
        await driver.press("end", "v")
        assert "use: weight\n    clamps:" not in driver.text
        assert driver.session.draft.items[-1].clamps[0].values["at"] == "10 m"

    drive(story, worded)


def test_marks_go_with_the_rows_they_were_on(drive, small):
    async def story(driver):
        before = driver.text
        await driver.press("d", "end", "space", "u")
        assert driver.text == before
        assert driver.table.marked == frozenset()
        await driver.press("home", "space")
        driver.session.write(driver.text.replace("  - {use: ball, label: top float} ", "  #"))
        driver.builder.replaced()
        assert driver.table.marked == frozenset()
        assert driver.uses[0] == "rope"

    drive(story, small)


def test_a_value_left_with_the_mouse_is_taken_if_it_is_good(drive, small):
    async def story(driver):
        await driver.press("n")
        await driver.type("upper")
        await driver.pilot.click("#line", offset=(6, 3))
        await driver.settle()
        assert driver.session.draft.items[0].values["label"] == "upper"
        assert not driver.builder.line.editor.is_open and driver.table.cursor == 2
        await driver.press("up", "l")
        await driver.type("80 kg")
        await driver.pilot.click("#line", offset=(6, 1))
        await driver.settle()
        assert driver.session.draft.items[1].values["length"] == "60 m"
        assert not driver.builder.line.editor.is_open
        assert "`80 kg` was not accepted: is a mass" in driver.screen

    drive(story, small)


def test_what_is_being_typed_is_taken_before_anything_else(drive, small):
    async def story(driver):
        screen = driver.builder
        await driver.press("n")
        assert not screen.is_typing
        await driver.type("upper")
        assert screen.is_typing and screen.settle() and not screen.is_typing
        assert driver.session.draft.items[0].values["label"] == "upper"
        await driver.press("n")
        await driver.type("lower")
        await driver.press("ctrl+z")
        assert driver.session.draft.items[0].values["label"] == "upper"
        await driver.press("down", "l")
        await driver.type("80 kg")
        assert not screen.settle() and screen.is_typing
        await driver.press("ctrl+z")
        assert "Not accepted yet" in driver.screen and screen.line.editor.is_open
        assert driver.session.draft.items[0].values["label"] == "upper"

    drive(story, small)


@pytest.mark.parametrize("change", ["shorter", "longer"])
def test_a_draft_that_is_replaced_while_a_value_is_edited_is_left_alone(drive, small, change):
    ball = "  - {use: ball, label: top float}     # carries all\n"
    theirs = MOORING.replace(ball, "" if change == "shorter" else ball * 2)

    async def story(driver):
        await driver.press("end", "n")
        await driver.type("mine")
        driver.session.write(theirs)
        driver.builder.replaced()
        await driver.press("enter", "escape")
        assert driver.text == theirs

    drive(story, small)


def test_a_value_that_is_opened_and_left_stays_byte_for_byte(drive, small):
    before = MOORING.replace("label: top float", "label: 'top   float', count: 01").replace(
        "length: 60 m", "length:  60   m"
    )
    small.write_text(before)

    async def story(driver):
        await driver.press("n", "tab", "enter", "n", "enter", "down", "l", "enter")
        await driver.press("up", "n")
        await driver.pilot.click("#line", offset=(6, 3))
        await driver.settle()
        assert driver.text == before

    drive(story, small)


def test_a_control_character_in_a_label_is_refused_as_such(drive, small):
    async def story(driver):
        before = driver.text
        await driver.press("n")
        driver.builder.line.editor.value = "top\x1b[31m"
        await driver.press("enter")
        assert "a control character cannot be written into the file" in driver.screen
        assert driver.text == before

    drive(story, small)
