"""Finding in the line, columns of several rows, and rows repeated and pasted again."""

import pytest
from textual import events

from calm.checks.strength import strength
from calm.shipped import shipped_folder
from tests.tui.conftest import MOORING, NAMES


def labels(driver):
    return [row.texts.get("label", "") for row in driver.table.rows]


def chain(count):
    """The small mooring with some loggers clamped on its rope."""
    clamps = "".join(f"      - {{use: logger, at: {2 * n + 1} m}}\n" for n in range(count))
    begin, rest = MOORING.split("    clamps:\n")
    return begin + "    clamps:\n" + clamps + rest[rest.index("  # the release") :]


@pytest.mark.thorough
def test_twenty_serial_numbers_of_four_digits_take_130_keys(drive, folder):
    path = folder / "chain.yaml"
    path.write_text(chain(20), encoding="utf-8")
    keys = ["down", "down", "number_sign", "s"]
    for number in range(20):
        keys += [*str(4700 + number), "enter"]

    async def story(driver):
        await driver.press(*keys)
        clamps = driver.session.draft.items[1].clamps
        assert [each.values["serial"] for each in clamps] == [str(4700 + n) for n in range(20)]
        assert len(driver.session.history.steps) == 1

    assert len(keys) <= 130
    drive(story, path, size=(80, 24))


def test_a_list_that_is_pasted_fills_the_column_downwards(drive, folder):
    path = folder / "chain.yaml"
    path.write_text(chain(6), encoding="utf-8")

    async def story(driver):
        await driver.press("down", "down", "number_sign", "n", "down")
        driver.app.post_message(events.Paste("two\tx\nthree\nfour\n"))
        await driver.settle()
        assert "three" in driver.screen
        await driver.press("ctrl+s")
        values = [each.values.get("label", "") for each in driver.session.draft.items[1].clamps]
        assert values == ["", "two", "three", "four", "", ""]

    drive(story, path)


def test_a_column_of_lengths_judges_each_and_leaves_out_what_has_none(drive, small):
    async def story(driver):
        await driver.press("ctrl+a", "number_sign", "l")
        assert len(driver.app.screen.query("Field")) == 1
        await driver.press("ctrl+u", "5", "5", "enter")
        assert driver.session.draft.items[1].values["length"] == "55 m"
        assert driver.text.count("m") == MOORING.count("m")

    drive(story, small)


def test_codes_are_those_of_releases_that_have_serial_numbers(drive, small):
    async def story(driver):
        await driver.press("ctrl+a", "number_sign", "c")
        assert "These rows cannot have such a value" in driver.screen
        await driver.press("ctrl+a", "end", "up", "number_sign", "s", *"917", "enter")
        await driver.press("number_sign", "c", *"0A1B", "enter")
        assert driver.session.draft.value(("releases",)) == [{"serial": "917", "codes": "0A1B"}]

    drive(story, small)


def test_what_is_pasted_twice_stands_below_what_was_pasted_first(drive, small):
    async def story(driver):
        await driver.press("space", "down", "down", "down", "down", "space", "c", "end", "up")
        await driver.press("v", "v")
        assert driver.uses[3:] == ["  logger", *["releaser"], *["ball", "releaser"] * 2, "weight"]
        await driver.press("u", "u")
        assert driver.text == MOORING

    drive(story, small)


BELOW = ["releaser", "weight"]


@pytest.mark.parametrize(
    "keys, wanted",
    [
        (["plus", *"12", "enter"], ["ball"] * 13 + ["rope", "  logger", "  logger", *BELOW]),
        (["down"] * 3 + ["plus", "3", "enter"], ["ball", "rope", *["  logger"] * 5, *BELOW]),
        (["end", "shift+up", "plus", "2", "enter"], ["ball", "rope", "  logger", "  logger"]
         + BELOW * 3),
    ],
)  # fmt: skip
def test_a_count_repeats(drive, small, keys, wanted):
    async def story(driver):
        await driver.press(*keys)
        assert driver.uses == wanted
        assert len(driver.session.history.steps) == 1

    drive(story, small)


def test_words_are_found_in_ids_labels_serials_and_makers(drive):
    async def story(driver):
        async def find(words):
            await driver.press("slash", "ctrl+u", *(NAMES.get(sign, sign) for sign in words))
            await driver.press("enter")
            return driver.table.cursor

        await find("release")
        uses = [row.texts["component"] for row in driver.table.rows]
        index = driver.app.workspace.index
        assert "release" in index.get(driver.table.row.texts["component"].split()[-1]).searched
        here = driver.table.cursor
        await driver.press("greater_than_sign")
        await driver.press("less_than_sign")
        assert driver.table.cursor == here
        nowhere = await find("zzz")
        assert nowhere == here and "No row of the line contains `zzz`" in driver.screen
        makers = {driver.app.workspace.index.get(use.split()[-1]).maker for use in uses}
        maker = next(each for each in sorted(makers) if each)
        await find(maker)
        assert index.get(driver.table.row.texts["component"].split()[-1]).maker == maker
        assert f" {maker}" in driver.screen.splitlines()[-1]

    drive(story, shipped_folder("lines") / "deep-current-meters.yaml")


def test_the_weakest_piece_is_found(drive):
    async def story(driver):
        driver.app.judging.ask_fully()
        await driver.settle()
        await driver.press("percent_sign")
        strengths = [
            (each.utilisation, each.place.row)
            for each in (*driver.view.findings, *driver.view.tighter)
            if each.rule == strength.name and each.utilisation is not None
        ]
        assert driver.table.spot == max(strengths)[1]
        assert "Highest utilisation of strength" in driver.screen

    drive(story, shipped_folder("lines") / "deep-current-meters.yaml")


def test_the_catalogue_has_a_key_of_its_own(drive, small):
    async def story(driver):
        await driver.press("f7")
        assert driver.builder.has_class("-searching")

    drive(story, small)


def test_the_releases_of_an_assembly_have_serial_numbers(drive, folder):
    path = folder / "pack.yaml"
    path.write_text(
        MOORING.replace("{use: releaser}", "{use: pack}")
        + "  pack: {kind: assembly, parts: [{use: releaser}, {use: releaser}]}\n",
        encoding="utf-8",
    )

    async def story(driver):
        await driver.press("end", "up", "N")
        await driver.press(*"17, 18", "ctrl+s")
        assert "serial: [17, 18]" in driver.text

    drive(story, path)
