"""Keys at random: nothing is raised, and the file can always be read."""

import asyncio
import random

import pytest
from textual import events

from calm.files.editing import Draft
from tests.tui.conftest import driven

KEYS = [
    "up", "down", "left", "right", "home", "end", "pageup", "pagedown", "enter", "escape", "tab",
    "shift+tab", "space", "shift+up", "shift+down", "delete", "backspace", "insert", "alt+up",
    "alt+down", "ctrl+a", "ctrl+x", "ctrl+c", "ctrl+v", "ctrl+z", "ctrl+y", "ctrl+e", "ctrl+n",
    "ctrl+k", "ctrl+t", "ctrl+o", "f1", "f2", "question_mark", "slash",
    *"aAiduUrlnvVxcewmoz1234", *"0123456789", "full_stop", "minus", *"mkfis",
]  # fmt: skip
CHARACTERS = {
    "space": " ", "minus": "-", "full_stop": ".", "slash": "/", "question_mark": "?",
    "colon": ":", "left_curly_bracket": "{", "number_sign": "#",
}  # fmt: skip
PARCEL = 20
SIZES = [(120, 36), (80, 24), (40, 12), (20, 6), (200, 60)]


async def press_at_random(driver, chance, keys, count, check):
    for number in range(count // PARCEL):
        pressed = chance.choices(keys, k=PARCEL)
        for key in pressed:
            driver.app.post_message(events.Key(key, _character(key)))
        if number % 7 == 0:
            await driver.pilot.resize_terminal(*chance.choice(SIZES))
        if number % 5 == 0:
            driver.app.screen.post_message(events.Paste("0\t0.5\t90\n50\t0.2\t80"))
        while driver.app.has_keys_waiting:
            await driver.pilot.pause()
        assert driver.app.is_running, f"ended after {pressed}"
        check(f"after {pressed}, the {number}th")


def _character(key):
    return CHARACTERS.get(key, key if len(key) == 1 else None)


@pytest.mark.parametrize("seed", [7, 2026])
def test_a_thousand_keys_at_random_leave_a_file_that_can_be_read(small, seed):
    async def play():
        async with driven(small) as driver:

            def check(when):
                assert not driver.session.draft.problems, when

            await press_at_random(driver, random.Random(seed), KEYS, 1000, check)
            await driver.settle()
            driver.session.save()
            assert Draft(small.read_text(encoding="utf-8")).text == driver.text

    asyncio.run(play())


def test_keys_at_random_in_the_text_raise_nothing(small):
    keys = [*KEYS, "t", "t", "colon", "left_curly_bracket", "number_sign", "f8"]

    async def play():
        async with driven(small) as driver:
            await press_at_random(driver, random.Random(3), keys, 300, lambda when: None)
            await driver.settle()

    asyncio.run(play())
