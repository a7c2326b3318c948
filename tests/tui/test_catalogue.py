"""The catalogue beside the line: what is chosen, replaced and defined."""

import pytest

from calm.assemble.catalogue_search import Index
from calm.files.catalogue import Catalogue
from calm.files.editing.user_state import Remembered
from calm.tui.catalogue_pane import ComponentList
from calm.tui.component_screen import ComponentScreen
from calm.tui.field import Field
from tests.tui.conftest import MOORING


def test_what_a_person_wrote_is_no_markup(drive, small):
    """The card tells what is wrong with a definition, and its figures, as they are written."""
    broken = "  ball: {kind: sphere, diameter: '[/] m [b', buoyancy: '[red]1 N'}"
    odd = "  odd: {kind: anchor, weight: 5000 N, name: '[/] of [b]steel', note: '[@click=quit]'}"
    small.write_text(MOORING.replace("  weight: {kind", f"{odd}\n  weight: {{kind"))

    async def story(driver):
        await driver.press("a")
        await driver.type("odd")
        await driver.settle()
        assert "[/] of [b]steel" in driver.screen
        assert "[@click=quit]" in driver.screen
        text = driver.text.replace(MOORING[MOORING.index("  ball:") :].splitlines()[0], broken)
        driver.session.write(text)
        driver.builder.show_draft()
        await driver.settle()
        await driver.press("ctrl+u")
        await driver.type("ball")
        await driver.settle()
        assert "[/] m [b" in driver.screen

    drive(story, small, size=(140, 40))


def test_what_stays_of_the_component_before_is_told(drive, small):
    small.write_text(
        MOORING.replace("    length: 60 m\n", "    length: 60 m\n    breaking_load: 15 kN\n")
    )

    async def replace(driver, id):
        await driver.press("r", "ctrl+u")
        await driver.type(id)
        await driver.press("enter")
        return driver.screen.splitlines()[-1]

    async def story(driver):
        await driver.press("down")
        told = await replace(driver, "weight")
        assert (
            "now weight; kept from the previous component: length 60 m, breaking_load 15 kN" in told
        )
        await driver.press("home")
        told = await replace(driver, "releaser")
        assert "now releaser" in told and "kept" not in told
        await driver.press("down", "down")
        told = await replace(driver, "ball")
        assert "now ball" in told and "kept" not in told

    drive(story, small)


def test_an_id_of_the_file_is_not_defined_again(drive, small):
    async def story(driver):
        before = driver.text
        await driver.press("o")
        await driver.settle()
        form = driver.app.screen
        assert isinstance(form, ComponentScreen)
        for key, text in {
            "id": "logger", "diameter": "1 m", "length": "1 m", "buoyancy": "1 N",
        }.items():  # fmt: skip
            next(field for field in form.query(Field) if field.key == key).input.value = text
        await driver.pilot.pause()
        assert "logger is defined in this file already" in driver.screen
        assert "The component is valid" not in driver.screen
        await driver.press("ctrl+s")
        assert driver.app.screen is form
        next(field for field in form.query(Field) if field.key == "id").input.value = "sbe37"
        await driver.pilot.pause()
        assert "sbe37 exists in the catalogue" in driver.screen
        assert "The component is valid" in driver.screen
        await driver.press("escape")
        assert driver.text == before

    drive(story, small)


def test_the_index_of_a_text_that_cannot_be_read_is_that_of_the_catalogue():
    catalogue = Catalogue.shipped()
    assert Index.of(catalogue, MOORING).get("ball").own
    assert Index.of(catalogue, "name: [").get("ball") is None
    assert Index.of(catalogue, "name: [").get("sbe37") is not None


def test_favourites_and_what_was_taken_come_first_in_every_file(drive, tmp_path):
    async def mark(driver):
        await driver.press("a")
        await driver.type("chain")
        await driver.press("down", "down")
        chosen.append(driver.app.builder.query_one(ComponentList).chosen.id)
        await driver.press("f3")
        assert f"{chosen[0]} is a favourite now" in driver.screen
        assert f"★│ {chosen[0]}" in driver.screen
        await driver.type(" ")
        await driver.press("escape", "a")
        await driver.type("shackle 19")
        await driver.press("enter")

    async def look(driver):
        await driver.press("a")
        rows = driver.app.builder.query_one(ComponentList).rows
        others = [each.id for each in rows[1:] if each.role != "float"]
        assert rows[0].id == chosen[0] and others[0] == "shackle-19"
        assert rows[1].role == "float"  # the top of a line
        await driver.press("f3")
        assert f"{chosen[0]} is no longer a favourite" in driver.screen

    async def later(driver):
        await driver.press("a")
        await driver.type("sh")
        assert driver.app.builder.query_one(ComponentList).chosen.id == "shackle-19"

    chosen = []
    drive(mark)
    drive(look, tmp_path / "another.yaml")
    drive(later, tmp_path / "another.yaml")
    (tmp_path / "state" / "calm" / "catalogue.json").write_text('{"recent": [1')
    assert Remembered().favourites == [] == Remembered().recent


@pytest.mark.parametrize(
    "keys, role",
    [
        (["down", "down", "i"], "instrument"),
        (["down", "r"], "line"),
        pytest.param(["A"], "float", marks=pytest.mark.thorough),
        pytest.param(["r"], "float", marks=pytest.mark.thorough),
        pytest.param(["end", "delete", "end", "a"], "anchor", marks=pytest.mark.thorough),
    ],
)
def test_the_catalogue_knows_where_it_is_opened_and_begins_without_words(drive, small, keys, role):
    async def story(driver):
        await driver.press("a", *"wire", "escape", "home", *keys)
        listing = driver.app.builder.query_one(ComponentList)
        assert listing.chosen.role == role
        await driver.type("chain")
        assert "chain" in listing.chosen.searched

    drive(story, small)


def test_the_keys_stay_beside_what_was_added(drive, small):
    async def story(driver):
        await driver.press("a", *"sbe37", "enter")
        last = driver.screen.splitlines()[-1]
        assert last.split("  ")[-1].strip() == "sbe37 added"
        for words in ("Enter insert", "F4 sort", "F3 favourite", "Esc close"):
            assert words in last

    drive(story, small)
