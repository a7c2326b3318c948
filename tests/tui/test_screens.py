"""Palette, text, forms, pictures, sizes."""

import shutil
from pathlib import Path

import pytest

from calm.checks.finding import State
from calm.tui.component_screen import ComponentScreen
from calm.tui.field import Field
from calm.tui.mooring_sheet import settings
from calm.tui.table_field import GridCells
from calm.tui.text_screen import TextScreen
from tests.tui.conftest import MOORING

pytestmark = pytest.mark.usefixtures("painted")


def test_the_palette_finds_an_action_by_its_name(drive, small):
    async def story(driver):
        await driver.press("ctrl+p")
        await driver.type("duplic")
        for _ in range(10):
            await driver.pilot.pause(0.1)
        await driver.press("down", "enter")
        await driver.settle()
        assert driver.uses[:2] == ["ball", "ball"]

    drive(story, small)


def test_a_broken_file_opens_as_text_with_its_mistakes_and_is_mended(drive, small):
    small.write_text(MOORING.replace("name: Small", "name: [Small"))

    async def story(driver):
        await driver.settle()
        assert isinstance(driver.app.screen, TextScreen)
        assert "the `[` that begins here is not closed" in driver.screen
        await driver.press("escape")
        assert isinstance(driver.app.screen, TextScreen)
        area = driver.app.screen.text_area
        area.load_text(MOORING)
        await driver.settle()
        assert "The text is valid" in driver.screen
        await driver.press("escape")
        await driver.settle()
        assert driver.app.screen is driver.builder
        assert driver.view.result is not None

    drive(story, small)


def test_mistakes_are_listed_with_their_lines_and_gone_to(drive, small):
    small.write_text(MOORING.replace("60 m", "60 kg").replace("depth: 100 m", "depth: 100"))

    async def story(driver):
        assert isinstance(driver.app.screen, TextScreen)
        await driver.settle()
        assert "line 4:" in driver.screen
        assert "line 10:" in driver.screen
        area = driver.app.screen.text_area
        await driver.press("f8")
        first = area.cursor_location[0]
        await driver.press("f8")
        assert {first, area.cursor_location[0]} == {3, 9}
        await driver.press("escape")
        assert driver.table.rows[1].state is State.FAIL
        assert "2 mistakes" in driver.screen

    drive(story, small)


NOW = "depth[m],u[m/s],v[m/s]\n0,0.5,0\n100,{},0\n"


def test_a_mistake_in_another_file_is_told_with_its_name(drive, small, folder):
    small.write_text(MOORING.replace("{speed: 0.5 m/s, toward: 90 deg}", "{file: now.csv}"))
    (folder / "now.csv").write_text(NOW.format("x"))

    async def story(driver):
        screen = driver.app.screen
        assert isinstance(screen, TextScreen)
        assert "now.csv, line 3:5" in driver.screen
        assert "1 mistake in now.csv" in driver.screen.splitlines()[0]
        await driver.press("ctrl+home", "down", "f8")
        assert screen.text_area.cursor_location[0] == 1
        assert "small.yaml itself has no mistakes" in driver.screen.splitlines()[-1]
        await driver.press("escape")
        assert "now.csv, line 3:5" in driver.screen
        assert "1 mistake in now.csv" in driver.screen.splitlines()[0]
        assert all(row.state is not State.FAIL for row in driver.table.rows)
        (folder / "now.csv").write_text(NOW.format("0.1"))
        await driver.press("d")
        await driver.settle()
        assert driver.view.result is not None

    drive(story, small)


def test_mistakes_of_this_file_and_of_another_are_told_apart(drive, small, folder):
    (folder / "storm.yaml").write_text("environment: {depth: 90 m}\n")

    async def story(driver):
        (folder / "storm.yaml").write_text("environment: {depth: 90 kg}\n")
        await driver.press("t")
        area = driver.app.screen.text_area
        area.load_text(MOORING.replace("60 m", "60 kg"))
        await driver.settle()
        assert "line 10:" in driver.screen and "storm.yaml, line 1:" in driver.screen
        assert "2 mistakes in the file and others" in driver.screen.splitlines()[0]
        for _ in range(2):
            await driver.press("f8")
            assert area.cursor_location[0] == 9

    drive(story, small, environment="storm.yaml")


def test_what_is_typed_in_the_text_is_one_step_to_undo(drive, small):
    async def story(driver):
        before = driver.text
        await driver.press("t", "ctrl+home", "enter", "number_sign", "a", "b", "escape")
        assert driver.text == before.replace("# A", "\n#ab# A", 1)
        await driver.press("u")
        assert driver.text == before
        assert not driver.session.changed

    drive(story, small)


@pytest.mark.parametrize(
    "before, after",
    [
        pytest.param("\n", "\r\n", marks=pytest.mark.thorough),
        ("60 m\n", "60 m\r\n"),
        ("# A", "\ufeff# A"),
    ],
)
def test_to_look_at_the_text_changes_nothing_of_it(drive, small, before, after):
    small.write_bytes(MOORING.replace(before, after).encode())
    content = small.read_bytes()

    async def story(driver):
        await driver.press("t", "down", "escape")
        assert not driver.session.changed
        await driver.press("ctrl+s")
        assert small.read_bytes() == content

    drive(story, small)


def test_what_is_missing_is_said_and_the_last_picture_stays_dimmed(drive, small):
    async def story(driver):
        assert "last valid line" not in driver.screen
        await driver.press("home", "delete")
        await driver.settle()
        assert driver.view.missing
        assert driver.view.missing[0] in driver.screen
        assert "last valid line" in driver.screen
        await driver.press("u")
        await driver.settle()
        assert "last valid line" not in driver.screen

    drive(story, small)


def test_a_label_of_two_lines_keeps_to_its_row(drive, small):
    text = MOORING.replace("label: top float", 'label: "top\\nfloat\\t1"')
    small.write_text(text.replace("name: Small", 'name: "Sm\\nall"'))

    async def story(driver):
        assert "Sm all" in driver.screen.splitlines()[0]
        assert "top float 1" in driver.screen.splitlines()[2]
        assert len(driver.screen.splitlines()) == 36

    drive(story, small)


def test_the_verdict_gives_figures_with_signs(drive, small):
    async def story(driver):
        result = driver.view.result
        assert f"{result.anchor.tension:.0f} N" in driver.screen
        assert "needs" in driver.screen
        assert "Knockdown" in driver.screen

    drive(story, small)


@pytest.mark.parametrize(
    "key, words",
    [
        ("1", ["top float", "deep logger", "current, m/s", "▒"]),
        pytest.param("2", ["m east", "N"], marks=pytest.mark.thorough),
        pytest.param("3", ["at most", "2000 N"], marks=pytest.mark.thorough),
        ("4", ["├─[#]     deep logger", "sea surface"]),
    ],
)
def test_every_picture(drive, small, key, words):
    async def story(driver):
        await driver.press(key, "z")
        await driver.settle()
        assert not driver.table.is_on_screen
        for word in words:
            assert word in driver.screen

    drive(story, small)


@pytest.mark.parametrize("size", [(80, 24), (40, 12), (20, 5), (5, 3), (300, 100)])
@pytest.mark.thorough
def test_every_screen_at_every_size(drive, small, size):
    async def story(driver):
        for keys in (["a", "escape"], ["w", "escape"], ["o", "escape"], ["t", "escape"],
                     ["question_mark", "escape"], ["z", "z"], ["l", "escape"]):  # fmt: skip
            await driver.press(*keys)
        await driver.pilot.resize_terminal(100, 30)
        await driver.pilot.resize_terminal(*size)
        assert driver.app.screen is driver.builder

    drive(story, small, size=size)


@pytest.mark.thorough
def test_a_component_of_ones_own(drive, small):
    async def fill(driver, key, text):
        field = next(f for f in driver.app.screen.query(Field) if f.key == key)
        field.input.focus()
        await driver.pilot.pause()
        await driver.type(text)

    async def story(driver):
        await driver.press("o")
        await driver.settle()
        assert isinstance(driver.app.screen, ComponentScreen)
        await fill(driver, "id", "my-meter")
        await fill(driver, "diameter", "120 kg")
        assert "is a mass" in driver.screen
        await driver.press("ctrl+u")
        await driver.type("120")
        assert "= 120 mm" in driver.screen
        await fill(driver, "length", "0.5 m")
        assert "needs `buoyancy`" in driver.screen
        await fill(driver, "buoyancy", "-40 N")
        await driver.pilot.pause()
        assert "The component is valid" in driver.screen
        await driver.press("ctrl+s")
        await driver.settle()
        assert driver.session.draft.value(("components", "my-meter")) == {
            "kind": "cylinder", "diameter": "120 mm", "length": "0.5 m", "buoyancy": "-40 N",
        }  # fmt: skip
        assert driver.builder.catalogue.listing.chosen.id == "my-meter"
        await driver.press("enter")
        assert driver.uses[1] == "my-meter"

    drive(story, small)


def test_name_and_place(drive, small):
    async def story(driver):
        await driver.press("m", "ctrl+u")
        await driver.type("Iroise")
        await driver.press("enter", "enter")
        await driver.type("48.3")
        await driver.press("enter")
        await driver.type("-5.2")
        await driver.press("enter")
        await driver.settle()
        assert driver.session.draft.value(("name",)) == "Iroise"
        assert driver.session.draft.value(("position",)) == {
            "latitude": "48.3 deg", "longitude": "-5.2 deg",
        }  # fmt: skip
        assert "Iroise" in driver.screen

    drive(story, small)


@pytest.mark.thorough
def test_the_document_and_the_equipment_of_a_row(drive, small):
    async def story(driver):
        await driver.press("M")
        for text in ("M-17", "B", "soon"):
            await driver.type(text)
            await driver.press("enter")
        assert "is not a date; write it as 2027-06-30" in driver.screen
        await driver.press("ctrl+u")
        await driver.type("2027-06-30")
        await driver.press("ctrl+s")
        await driver.settle()
        document = {"id": "M-17", "revision": "B", "date": "2027-06-30"}
        assert driver.session.draft.value(("document",)) == document
        changed = {"revision": "B", "date": "2027-06-30", "change": "a longer rope"}
        await driver.press("M")
        driver.app.screen.query_one(GridCells).focus()
        await driver.press("a")
        for text in ("B", "2027-06-30", "", "a longer rope"):
            await driver.type(text)
            await driver.press("enter")
        await driver.press("escape", "ctrl+s")
        await driver.settle()
        assert driver.session.draft.value(("document",)) == document | {"history": [changed]}
        await driver.press("M")
        driver.app.screen.query_one(GridCells).focus()
        await driver.press("delete", "a")
        await driver.type("C")
        await driver.press("enter")
        await driver.type("of no day")
        await driver.press("enter")
        assert "is not a date" in driver.screen
        await driver.press("escape", "delete", "ctrl+s")
        await driver.settle()
        assert driver.session.draft.value(("document",)) == document
        await driver.press("=")
        await driver.type("2")
        await driver.press("enter", "N")
        await driver.type("T1, T2")
        for _ in range(6):
            await driver.press("enter")
        await driver.settle()
        spot = driver.builder.line.table.spot
        assert driver.session.draft.value(("line", spot.item, "serial")) == ["T1", "T2"]
        assert driver.session.draft.problems == ()
        await driver.press("N", "ctrl+u", *["enter"] * 6)
        await driver.settle()
        assert driver.session.draft.value(("line", spot.item, "serial")) is None

    drive(story, small)


def test_where_it_was_deployed(drive, small):
    async def story(driver):
        await driver.press("at")
        await driver.type("2027-06-30 14:05")
        await driver.press("enter")
        await driver.type("-5 m")
        await driver.press("enter")
        assert "must be more than 0 m" in driver.screen
        await driver.press("ctrl+u")
        for text in ("1187 m", "48.31 deg", "-5.2 deg"):
            await driver.type(text)
            await driver.press("enter")
        await driver.press("ctrl+s")
        await driver.settle()
        assert driver.session.draft.value(("deployed",)) == {
            "date": "2027-06-30 14:05",
            "position": {"latitude": "48.31 deg", "longitude": "-5.2 deg"},
            "depth": "1187 m",
        }
        assert driver.session.draft.problems == ()
        await driver.press("at")
        await driver.type("soon")
        await driver.press("enter")
        assert "is not a time" in driver.screen

    drive(story, small)


@pytest.mark.thorough
def test_what_was_deployed_at_a_row(drive, small):
    async def story(driver):
        await driver.settle()
        await driver.press("down", "at", *["enter"] * 4)
        for text in ("R7", "58.2 m", "cut on deck"):
            await driver.type(text)
            await driver.press("enter")
        await driver.press("ctrl+s")  # nothing about its clock
        await driver.settle()
        rope = {"label": "rope", "serial": "R7", "length": "58.2 m", "remark": "cut on deck"}
        assert driver.session.draft.value(("deployed", "items")) == [rope]
        await driver.press("down", "down", "at", *["enter"] * 5)
        await driver.type("frayed")
        await driver.press("ctrl+s")
        await driver.settle()
        deep = {"label": "deep logger", "remark": "frayed"}
        assert driver.session.draft.value(("deployed", "items")) == [rope, deep]
        await driver.press("down", "at", *["enter"] * 4)
        await driver.type("AR 7")
        driver.app.screen.query_one(GridCells).focus()
        await driver.press("a")
        for text in ("AR 7", "{arm: 0A1B, release: 0A55}"):
            await driver.type(text)
            await driver.press("enter")
        await driver.press("escape", "ctrl+s")
        await driver.settle()
        codes = {"serial": "AR 7", "codes": {"arm": "0A1B", "release": "0A55"}}
        assert driver.session.draft.value(("releases",)) == [codes]
        assert driver.session.draft.problems == ()
        await driver.press("up", "at", *["enter"] * 5, "ctrl+u", "ctrl+s")
        await driver.settle()
        labels = [one["label"] for one in driver.session.draft.value(("deployed", "items"))]
        assert labels == ["rope", "releaser"]

    drive(story, small)


@pytest.mark.thorough
def test_a_tow_is_edited_the_same_way(drive, folder):
    from calm.shipped import shipped_folder

    shipped = shipped_folder("lines") / "depressor-fit-depth.yaml"
    path = Path(shutil.copy(shipped, folder))

    async def story(driver):
        assert driver.view.result.type == "tow"
        assert "Tow point" in driver.screen
        await driver.press("l")
        assert driver.builder.line.editor.value == "fit 70 m"
        await driver.press("ctrl+u")
        await driver.type("fit 60 m")
        await driver.press("enter")
        await driver.settle()
        assert driver.session.draft.items[0].values["body_depth"] == "60 m"
        assert driver.view.rows[1].figures["depth"] == pytest.approx(60.0, abs=0.1)
        await driver.press("T", "ctrl+u")
        await driver.type("5 knot")
        await driver.press("ctrl+s")
        await driver.settle()
        assert driver.session.draft.value(("tow", "speed")) == "5 knot"

    drive(story, path)


@pytest.mark.thorough
def test_a_tow_is_built_from_nothing(drive, folder):
    async def story(driver):
        await driver.press("T")
        assert "has no anchor" in " ".join(driver.screen.replace("│", " ").split())
        for text in ("4 knot", "90", "3"):
            await driver.type(text)
            await driver.press("enter")
        assert driver.session.draft.value(("tow",)) == {
            "speed": "4 knot", "toward": "90 deg", "height": "3 m",
        }  # fmt: skip
        await driver.press("a")
        await driver.type("wire-jacketed-8")
        await driver.press("enter")
        await driver.type("200")
        await driver.press("enter", "enter", "ctrl+u")
        await driver.type("sbe37")
        await driver.press("enter", "escape")
        await driver.settle()
        assert driver.uses == ["wire-jacketed-8", "sbe37"]
        assert driver.view.result.type == "tow"
        assert "Tow point" in driver.screen

    drive(story, folder / "tow.yaml")


def test_settings_of_the_file_are_entered_in_their_forms(drive, small):
    async def story(driver):
        await driver.press("comma")
        assert "solver: numerical settings and drag laws" in driver.screen
        await driver.press(str(settings().index("checks") + 1))
        await driver.type("1.8")
        driver.app.screen.query_one(GridCells).focus()
        await driver.press("a")
        for text in ("knockdown", "it is a test", "", "A. Martin"):
            await driver.type(text)
            await driver.press("enter")
        await driver.press("escape", "ctrl+s")
        await driver.settle()
        accepted = {"rule": "knockdown", "reason": "it is a test", "by": "A. Martin"}
        checks = {"anchor_factor": "1.8", "accept": [accepted]}
        assert driver.session.draft.value(("checks",)) == checks
        assert driver.view.file.checks.anchor_factor == 1.8
        await driver.press("comma", str(settings().index("checks") + 1))
        driver.app.screen.query_one(GridCells).focus()
        await driver.press("a")
        await driver.type("tilt")
        await driver.press("ctrl+s")
        assert "row 2, reason *: a value is needed" in driver.screen

    drive(story, small)
