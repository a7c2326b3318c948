"""Terminals of few colours, of a light ground, and of none."""

import pytest
from rich.color import ColorType

from calm.tui.theme import choose_theme

pytestmark = pytest.mark.thorough

SCREENS = ([], ["a"], ["escape", "w"], ["escape", "o"], ["escape", "t"],
           ["escape", "question_mark"], ["escape", "l"], ["escape", "3"], ["4"])  # fmt: skip
OWN = (ColorType.DEFAULT, ColorType.STANDARD)


def colours(driver):
    """Every colour of the screen, as it is sent to the terminal."""
    for strip in driver.app.screen._compositor.render_strips(driver.app.size):
        for segment in strip:
            if segment.style is not None:
                yield from (segment.style.color, segment.style.bgcolor)


@pytest.mark.parametrize("term, ground", [("xterm", ""), ("linux", "0;15")])
def test_terminals_of_sixteen_colours_keep_their_own(drive, small, term, ground):
    async def story(driver):
        for keys in SCREENS:
            await driver.press(*keys)
            await driver.settle()
            found = {colour for colour in colours(driver) if colour is not None}
            assert not {colour for colour in found if colour.type not in OWN}

    drive(story, small, environ={"TERM": term, "COLORFGBG": ground})


@pytest.mark.parametrize("term", ["xterm", "xterm-256color"])
def test_without_colours_none_is_sent_and_signs_tell_the_same(drive, small, monkeypatch, term):
    monkeypatch.setenv("NO_COLOR", "1")

    async def story(driver):
        driver.app.judging.ask_fully()
        await driver.settle()
        assert "✓ passes" in driver.screen or "! " in driver.screen
        for keys in (*SCREENS, ["ctrl+p"]):
            await driver.press(*keys)
            await driver.settle()
            assert all(colour is None or colour.is_default for colour in colours(driver))

    drive(story, small, environ={"TERM": term})


@pytest.mark.parametrize("keys", [[], ["w"], ["t"], ["l"], ["a"], ["ctrl+p"]])
def test_without_colours_the_cursor_is_seen(drive, small, monkeypatch, keys):
    monkeypatch.setenv("NO_COLOR", "1")

    async def story(driver):
        await driver.press(*keys)
        focused = driver.app.screen.focused
        if hasattr(focused, "cursor_blink"):
            focused.cursor_blink = False  # which half a second would show or not
        await driver.settle()
        strips = driver.app.screen._compositor.render_strips(driver.app.size)
        region = focused.region
        rows = [strip.crop(region.x, region.right) for strip in strips[region.y : region.bottom]]
        assert any(segment.style and segment.style.reverse for row in rows for segment in row)

    drive(story, small, environ={"TERM": "xterm-256color"})


def test_without_colours_what_is_dimmed_stays_so(drive, small, monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")

    async def story(driver):
        strips = driver.app.screen._compositor.render_strips(driver.app.size)
        assert any(segment.style.dim for strip in strips for segment in strip if segment.style)

    drive(story, small, environ={"TERM": "xterm-256color"})


@pytest.mark.parametrize(
    "environ, theme",
    [
        ({"TERM": "xterm"}, "ansi-dark"),
        ({"TERM": "xterm", "COLORFGBG": "15;0"}, "ansi-dark"),
        ({"TERM": "xterm", "COLORFGBG": "0;15"}, "ansi-light"),
        ({"TERM": "rxvt", "COLORFGBG": "0;default;7"}, "ansi-light"),
        ({"TERM": "rxvt", "COLORFGBG": "15;8"}, "ansi-dark"),
        ({"TERM": "xterm-256color"}, "calm-dark"),
        ({"TERM": "xterm-256color", "COLORFGBG": "0;15"}, "calm-light"),
        ({"TERM": "xterm", "COLORTERM": "truecolor", "COLORFGBG": "0;default;15"}, "calm-light"),
    ],
)
def test_the_theme_is_that_of_the_terminal(environ, theme):
    assert choose_theme(environ) == theme
