"""The list of keys: what is bound is in the help, once, and does what it says."""

import pytest

from calm.tui.builder import BuilderScreen
from calm.tui.catalogue_pane import CataloguePane
from calm.tui.cell_editor import CellEditor
from calm.tui.component_screen import ComponentScreen
from calm.tui.dialogs import InputSheet, LongText, Question
from calm.tui.field import Cycle
from calm.tui.key_table import ACTIONS, PLACES, shown_key, shown_keys
from calm.tui.line_pane import LinePane
from calm.tui.table_field import Grid
from calm.tui.text_screen import TextScreen, YamlArea
from calm.tui.verdict_pane import VerdictPane
from calm.tui.water_form import FormChoice
from calm.tui.water_screen import WaterScreen

OWNERS = {
    "line": LinePane,
    "verdict": VerdictPane,
    "anywhere": BuilderScreen,
    "cell": CellEditor,
    "catalogue": CataloguePane,
    "water": WaterScreen,
    "grid": Grid,
    "text": TextScreen,
    "form": ComponentScreen,
    "choice": Cycle,
    "given": FormChoice,
    "area": YamlArea,
    "sheet": InputSheet,
    "question": Question,
    "help": LongText,
}


@pytest.mark.parametrize("place", PLACES)
def test_every_action_is_there_and_no_key_has_two(place):
    taken = {}
    for action in ACTIONS[place]:
        name = action.name.partition("(")[0]
        if not name.startswith("app."):
            owner = BuilderScreen if name.startswith("screen.") else OWNERS[place]
            assert hasattr(owner, f"action_{name.removeprefix('screen.')}"), name
        for key in action.keys.split(","):
            assert key not in taken, (key, action.name, taken[key])
            taken[key] = action.name


def test_the_keys_of_the_line_and_of_its_screen_are_apart():
    line = {key for action in ACTIONS["line"] for key in action.keys.split(",")}
    screen = {key for action in ACTIONS["anywhere"] for key in action.keys.split(",")}
    assert not line & screen


OPENED = {
    "line": ([], []),
    "cell": (["l"], ["escape"]),
    "catalogue": (["a"], ["escape"]),
    "picture": (["tab"], ["shift+tab"]),
    "verdict": (["tab", "tab"], ["shift+tab", "shift+tab"]),
    "water": (["w"], ["escape"]),
    "choice": (["w", "tab"], ["escape"]),
    "form": (["o"], ["escape"]),
    "text": (["t"], ["escape"]),
    "sheet": (["m"], ["escape"]),
    "question": (["d", "q"], ["escape", "u"]),
    "help": (["question_mark"], ["escape"]),
}
"""The keys that lead there, and back."""


async def help_of(driver):
    """The help by its headings, each with its keys and their meanings."""
    await driver.press("question_mark")
    assert isinstance(driver.app.screen, LongText)
    found, heading = {}, ""
    for line in driver.screen.splitlines():
        line = line[9:92]  # within its frame, in the middle
        keys, meaning = line[2:22].strip(), line[22:].strip()
        if not line.strip():
            heading = ""
        elif not heading:
            heading = line.strip()
            found[heading] = []
        elif keys:
            found[heading].append((keys, meaning))
    await driver.press("escape")
    assert driver.app.screen is driver.builder
    return found


def test_the_help_has_every_key_with_its_meaning(drive, small):
    async def story(driver):
        told = await help_of(driver)
        for place, heading in PLACES.items():
            for action in ACTIONS[place]:
                first = shown_keys(action.keys)[:16].rstrip()
                begin = action.meaning[:30].rstrip()
                assert any(
                    keys.startswith(first) and meaning.startswith(begin)
                    for keys, meaning in told[heading]
                ), (heading, action)

    drive(story, small, size=(100, 320))


@pytest.mark.thorough
def test_the_help_has_every_key_that_is_bound(drive, small):
    async def story(driver):
        told = {key for rows in (await help_of(driver)).values() for keys, _ in rows
                for key in keys.split()}  # fmt: skip
        await driver.pilot.resize_terminal(100, 30)
        for place, (there, back) in OPENED.items():
            await driver.press(*there)
            bound = {shown_key(key) for key in driver.app.screen.active_bindings}
            assert bound and bound <= told, (place, bound - told)
            await driver.press(*back)
            assert driver.app.focused is driver.table

    drive(story, small, size=(100, 320))


def test_keys_typed_ahead_of_a_command_of_the_palette_go_where_it_leads(drive, small):
    async def story(driver):
        await driver.press("down", "down", "ctrl+p", *"serial", "enter", *"5101", "ctrl+s")
        assert "serial: 5101" in driver.text

    drive(story, small)


def test_few_keys_of_the_first_screen_differ_only_by_case():
    single = {key for place in ("line", "anywhere") for action in ACTIONS[place]
              for key in action.keys.split(",") if len(key) == 1}  # fmt: skip
    pairs = {key for key in single if key.isupper() and key.lower() in single}
    assert pairs == {"A", "M", "N", "O", "S", "T", "U", "V"}
