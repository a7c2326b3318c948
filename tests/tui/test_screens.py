"""Help, palette, text, forms, sizes, terminals."""

import pytest

from calm.checks.finding import State
from calm.tui.actions import ACTIONS, PLACES, actions_in
from calm.tui.builder import BuilderScreen
from calm.tui.catalogue_pane import CataloguePane
from calm.tui.cell_editor import CellEditor
from calm.tui.cells import Cells
from calm.tui.component_screen import ComponentScreen
from calm.tui.field import Field
from calm.tui.help_screen import HelpScreen
from calm.tui.pictures import Pictures
from calm.tui.text_screen import TextScreen
from calm.tui.water_screen import WaterScreen
from tests.tui.conftest import MOORING

OWNERS = {
    "line": BuilderScreen,
    "anywhere": BuilderScreen,
    "cell": CellEditor,
    "catalogue": CataloguePane,
    "water": WaterScreen,
    "grid": Cells,
    "text": TextScreen,
    "form": ComponentScreen,
}


@pytest.mark.parametrize("place", PLACES)
def test_every_action_is_there_and_no_key_has_two(place):
    taken = {}
    for action in actions_in(place):
        name = action.name.partition("(")[0]
        if not name.startswith("app."):
            assert hasattr(OWNERS[place], f"action_{name}"), name
        for key in action.keys.split(","):
            assert key not in taken, (key, action.name, taken[key])
            taken[key] = action.name


def test_the_keys_of_the_line_and_of_its_screen_are_apart():
    line = {key for action in actions_in("line") for key in action.keys.split(",")}
    screen = {key for action in actions_in("anywhere") for key in action.keys.split(",")}
    assert not line & screen


def test_the_help_lists_every_key(drive, small):
    async def story(driver):
        await driver.press("question_mark")
        assert isinstance(driver.app.screen, HelpScreen)
        scroll = driver.app.screen.query_one("VerticalScroll")
        seen = ""
        for _ in range(12):
            seen += driver.screen + "\n"
            scroll.scroll_relative(y=20, animate=False)
            await driver.pilot.pause()
        for action in ACTIONS:
            first = action.meaning.split()[0]
            assert action.shown_keys.split("  ")[0] in seen
            assert first in seen
        await driver.press("escape")
        assert driver.app.screen is driver.builder

    drive(story, small, size=(100, 40))


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
        assert "is not valid YAML" in driver.screen
        await driver.press("escape")
        assert isinstance(driver.app.screen, TextScreen)
        area = driver.app.screen.text_area
        area.load_text(MOORING)
        await driver.settle()
        assert "The text can be read" in driver.screen
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


def test_what_is_typed_in_the_text_is_one_step_to_undo(drive, small):
    async def story(driver):
        before = driver.text
        await driver.press("t", "enter", "number_sign", "a", "b", "escape")
        assert driver.text == before.replace("# A", "\n#ab# A", 1)
        await driver.press("u")
        assert driver.text == before
        assert not driver.session.changed

    drive(story, small)


@pytest.mark.parametrize(
    "before, after", [("\n", "\r\n"), ("60 m\n", "60 m\r\n"), ("# A", "\ufeff# A")]
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
        pictures = driver.builder.query_one(Pictures)
        assert "as it last stood" not in driver.screen
        await driver.press("home", "delete")
        await driver.settle()
        assert driver.view.missing
        assert driver.view.missing[0] in driver.screen
        assert "as it last stood" in driver.screen
        assert pictures._old
        await driver.press("u")
        await driver.settle()
        assert "as it last stood" not in driver.screen

    drive(story, small)


def test_the_verdict_gives_figures_with_signs(drive, small):
    async def story(driver):
        result = driver.view.result
        assert f"{result.anchor.tension:.0f} N" in driver.screen
        assert "needs" in driver.screen
        assert "Knockdown" in driver.screen

    drive(story, small)


@pytest.mark.parametrize("key, word", [("1", "depth"), ("2", "north"), ("3", "N"), ("4", "sea")])
def test_every_picture(drive, small, key, word):
    async def story(driver):
        await driver.press(key, "z")
        await driver.settle()
        assert len(driver.screen.strip()) > 200

    drive(story, small)


@pytest.mark.parametrize("size", [(80, 24), (40, 12), (20, 5), (5, 3), (300, 100)])
def test_every_screen_at_every_size(drive, small, size):
    async def story(driver):
        for keys in (["a", "escape"], ["w", "escape"], ["o", "escape"], ["t", "escape"],
                     ["question_mark", "escape"], ["z", "z"], ["l", "escape"]):  # fmt: skip
            await driver.press(*keys)
        await driver.pilot.resize_terminal(100, 30)
        await driver.pilot.resize_terminal(*size)
        assert driver.app.screen is driver.builder

    drive(story, small, size=size)


@pytest.mark.parametrize("environ", [{"TERM": "xterm"}, {"TERM": "linux"}, {"TERM": "vt100"}])
def test_terminals_of_sixteen_colours_keep_their_own(drive, small, environ):
    async def story(driver):
        assert driver.app.theme == "ansi-dark"
        await driver.press("down", "a", "escape", "w", "escape")

    drive(story, small, environ=environ)


def test_without_colour_every_state_has_its_sign(drive, small, monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")

    async def story(driver):
        assert driver.app.no_color
        assert "✓" in driver.screen or "!" in driver.screen
        screen = driver.app.screen
        grey, ground = driver.app._filters[-1], screen.background_colors[1]
        colours = {
            (segment.style.color, segment.style.bgcolor)
            for strip in screen._compositor.render_strips(driver.app.size)
            for segment in strip.apply_filter(grey, ground)
            if segment.style
        }
        for pair in colours:
            for colour in pair:
                if colour is not None and colour.triplet is not None:
                    assert colour.triplet.red == colour.triplet.green == colour.triplet.blue

    drive(story, small)


def test_a_component_of_ones_own(drive, small):
    async def fill(driver, key, text):
        field = next(f for f in driver.app.screen.query(Field) if f.key == key)
        field.focus_input()
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
        assert "It can be used" in driver.screen
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


def test_a_tow_is_built_the_same_way(drive):
    from calm.shipped import shipped_folder

    async def story(driver):
        assert driver.view.result.type == "tow"
        assert "Tow point" in driver.screen
        await driver.press("l")
        assert "body_depth" in driver.text
        await driver.press("escape", "w", "escape")

    drive(story, shipped_folder("lines") / "depressor-fit-depth.yaml")
