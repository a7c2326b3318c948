"""Whole moorings from nothing, key by key: how many it takes, and that they are what was meant.

A sign of a story is a key: `⏎` Enter, `⎋` Esc, `↓` `↑`, `⑥` F6, any other one itself. Lines
between `«` and `»` are pasted, each of their signs counted as a key.
"""

import re

import yaml
from textual.events import Paste

from calm.case import Mooring, Result
from calm.files import read_mooring
from tests.tui.conftest import NAMES

KEYS = NAMES | {
    "⏎": "enter", "⎋": "escape", "↓": "down", "↑": "up", "⑥": "f6", "⇩": "shift+down", "?": "question_mark",
}  # fmt: skip
PASTED = re.compile("«(.*?)»", re.DOTALL)


async def play(driver, story):
    """Press the keys of a story; how many there were."""
    parts = PASTED.split(story)
    for number, part in enumerate(parts):
        if number % 2:
            driver.app.post_message(Paste(part))
            await driver.pilot.pause()
        else:
            await driver.press(*(KEYS.get(sign, sign) for sign in part))
    return sum(map(len, parts))


DEEP = (
    "w4000⏎"
    "«0 .6 70\n300 .4 70\n700 .25 70\n1200 .15 65\n2500 .08 60\n4000 .05 60»⏎"
    "⑥storm⏎"
    "«0 1 80\n300 .6 80\n700 .35 75\n1200 .2 70\n2500 .1 60\n4000 .08 60»⏎⎋"
    "aore 41⏎sh-19⏎r-c21⏎sh-16⏎rcm11⏎le-13⏎jacketed-8-5⏎680⏎⏎"
)
MEANT = """
"""


def test_a_deep_mooring_from_nothing_takes_five_hundred_keys(drive, folder):
    async def story(driver):
        count = await play(driver, DEEP)
        print(count)
        print(driver.text)
        print(driver.screen)

    drive(story)
