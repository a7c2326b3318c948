"""Terminals that have no other signs than those of ASCII."""

from io import BytesIO, TextIOWrapper

import pytest

from calm.checks.finding import State
from calm.drawing.sketch.canvas import Canvas
from calm.tui.line_table import LineTable
from calm.tui.painted import plain, shows_all_signs
from calm.tui.theme import CLAMP, CURSOR, MARK, ROLES, UNKNOWN_ROLE
from tests.tui.conftest import MOORING
from tests.tui.test_terminals import SCREENS

C = {"TERM": "xterm-256color", "LANG": "C"}


@pytest.mark.thorough
def test_every_screen_has_only_signs_that_the_terminal_has(drive, small):
    text = MOORING.replace("label: top float", "label: Boué 浮標")
    small.write_text(text, encoding="utf-8")

    async def story(driver):
        for keys in (*SCREENS, ["z", "1"], ["2"], ["z", "a"], ["escape", "space"]):
            await driver.press(*keys)
            await driver.settle()
            assert driver.screen.isascii(), keys
        driver.app.judging.ask_fully()
        await driver.settle()
        assert "+ passes" in driver.screen or "! " in driver.screen
        assert "Boue ? ?" in driver.screen
        assert driver.text == text

    drive(story, small, environ=C)


def test_the_picture_and_the_water_are_drawn_with_signs_alike(drive, small):
    async def story(driver):
        assert "|" in driver.screen and "%%%" in driver.screen
        await driver.press("w")
        await driver.settle()
        assert "090d>" in driver.screen and "%%%" in driver.screen

    drive(story, small, environ=C)


def test_every_state_and_every_role_has_a_sign_of_its_own():
    states = [plain(state.sign) for state in State]
    assert len(set(states)) == len(states)
    roles = [plain(sign) for sign in (*ROLES.values(), UNKNOWN_ROLE)]
    assert len(set(roles)) == len(roles)
    assert all(sign.isascii() for sign in (*states, *roles))
    assert plain(f"{CURSOR}{MARK} {CLAMP} 12.3° × 4 ≥ 3…") == ">* + 12.3d x 4 > 3."


def test_a_line_of_dots_is_drawn_with_the_signs_most_like_it():
    canvas = Canvas(6, 2)
    canvas.line([(0, 0), (0, 7)], "")
    canvas.line([(2, 0), (3, 3)], "")
    canvas.line([(5, 4), (4, 7)], "")
    canvas.line([(6, 3), (7, 3)], "")
    canvas.line([(8, 0), (9, 0)], "")
    canvas.text(5, 1, "▒")
    assert [plain(row.plain) for row in canvas.rows()] == ["|\\ _- ", "| /  %"]


def test_with_all_signs_nothing_is_put_in_their_place(drive, small):
    async def story(driver):
        assert CURSOR in driver.screen
        assert driver.app.screen.query_one(LineTable)

    drive(story, small, environ={"TERM": "xterm-256color", "LANG": "C.UTF-8"})


@pytest.mark.parametrize(
    "environ, encoding, shown",
    [
        ({}, "utf-8", True),
        ({}, "ascii", False),
        ({}, "iso8859-1", False),
        ({"LANG": "C.UTF-8"}, "utf-8", True),
        ({"LANG": "de_DE.utf8"}, "utf-8", True),
        ({"LANG": "de_DE"}, "utf-8", True),
        ({"LANG": "C"}, "utf-8", False),
        ({"LANG": "de_DE.ISO-8859-1@euro"}, "utf-8", False),
        ({"LC_ALL": "POSIX", "LANG": "de_DE.UTF-8"}, "utf-8", False),
        ({"LC_ALL": "", "LC_CTYPE": "fr_FR.UTF-8", "LANG": "C"}, "utf-8", True),
        # as Python leaves them where the locale is C, and where there is none
        ({"LC_CTYPE": "C.UTF-8", "LANG": "C"}, "utf-8", False),
        ({"LC_CTYPE": "C.UTF-8"}, "utf-8", True),
        ({"LANG": "C", "TEXTUAL_DRIVER": "textual.drivers.web_driver:WebDriver"}, "ascii", True),
    ],
)
def test_the_locale_tells_which_signs_there_are(environ, encoding, shown):
    output = TextIOWrapper(BytesIO(), encoding=encoding)
    assert shows_all_signs(environ, output) is shown


def test_without_an_output_there_are_plain_signs():
    assert not shows_all_signs({}, None)
