"""Keys at random: nothing is raised, and of the file no more becomes another than was asked for."""

import asyncio
import random
from collections import Counter

import pytest
from textual import events

from calm.files.editing import History, NotWritten
from calm.tui.app import BuildApp
from calm.tui.session import Session
from tests.tui.conftest import MOORING, driven

pytestmark = [pytest.mark.thorough, pytest.mark.usefixtures("painted")]

KEYS = [
    "up", "down", "left", "right", "home", "end", "pageup", "pagedown", "enter", "escape", "tab",
    "shift+tab", "space", "shift+up", "shift+down", "delete", "backspace", "insert", "alt+up",
    "alt+down", "ctrl+a", "ctrl+x", "ctrl+c", "ctrl+v", "ctrl+z", "ctrl+y", "ctrl+e", "ctrl+n",
    "ctrl+k", "ctrl+t", "ctrl+o", "f1", "f2", "f5", "f6", "f7", "question_mark", "slash",
    *"aAiduUrlnvVxcewmoTz1234", *"0123456789", "full_stop", "minus", *"mkfis",
]  # fmt: skip
TEXT_KEYS = [*KEYS, "t", "t", "colon", "left_curly_bracket", "number_sign", "f8"]
DISK_KEYS = [*KEYS, "ctrl+s", "ctrl+q", "slash", "tilde", "colon", "full_stop"]
VERBS = [verb.split() for verb in (
    "d", "alt+up", "alt+down", "x", "c", "v", "V", "delete", "u", "u u u", "U", "down down", "home",
    "end up", "space down space", "n m e enter", "n x", "l 5 5 enter", "l 7 tab",
    "equals_sign 2 enter",
    "a enter 7 enter", "i enter 3 enter", "i enter 3 enter x", "r enter", "e", "m x enter enter",
    "w ctrl+u 9 5 enter", "w ctrl+u 9 7", "w ctrl+t 3", "w tab right enter", "w tab left enter",
    "w tab tab tab right enter", "w tab tab right enter tab 2 enter a 4 enter delete", "w f5",
    "w ctrl+n x y enter 3 tab", "w f5 f7", "w ctrl+z", "w shift+tab 4 5 enter",
    "w shift+tab shift+tab 9 enter 8 0 enter",
)]  # fmt: skip
"""What people press, so that much of the file is changed."""
DISK_VERBS = [*VERBS, *(verb.split() for verb in (
    "S enter", "S ctrl+u b enter", "S ctrl+u slash x", "S ctrl+u tilde x enter", "s", "ctrl+s o",
    "ctrl+s t", "ctrl+s n enter", "q d", "q s", "q escape", "t x", "t ctrl+z", "t ctrl+z ctrl+z",
    "n x ctrl+s", "w ctrl+u 8 ctrl+s",
))]  # fmt: skip
CHARACTERS = {
    "space": " ", "minus": "-", "full_stop": ".", "slash": "/", "question_mark": "?",
    "colon": ":", "left_curly_bracket": "{", "number_sign": "#", "tilde": "~",
}  # fmt: skip
PARCEL = 20
SIZES = [(80, 24), (60, 15), (40, 12), (20, 6), (30, 40)]
PASTES = ["0\t0.5\t90\n50\t0.2\t80", "depth,speed,toward\n0,1,90\n70,n/a,80", "~/x\n", "1;2"]

UGLY = (
    MOORING.replace("name: Small\n", "name:   'Small'   # as it is\r\n")
    .replace("  current:", "  # from the ADCP\n  density: \"1026 kg/m^3\"\n  current:")
    .replace("      - {use: logger, at: 10 m}\n", "      # borrowed\n      - use: logger   # 12\n"
             "        at: '10 m'\n")
    .replace("\ncomponents", "\n# named\nenvironments:\n  storm:   # of 1987\n"
             "    current:\n      columns: [depth m, speed m/s, toward deg]\n"
             "      rows:\n        - [0, '1.5', 90]   # at the top\n        - [100, 0.2, 80]\n"
             "# ours\ncomponents")
)  # fmt: skip

OF_THE_LINE = ("add ", "clamp ", "use ", "delete ", "duplicate ", "move ", "paste ", "change ")
OF_A_TABLE = ("add a row", "delete a row")
ELSEWHERE = ("edit the text", "reload the file", "recover")


class Steps:
    """Changes to the file, as the history was told of it."""

    def __init__(self, monkeypatch):
        self.done = []
        do = History.do

        def noted(history, draft, label):
            self.done.append((label, history.draft, draft))
            do(history, draft, label)

        monkeypatch.setattr(History, "do", noted)

    def check(self):
        """Look at those since the last look."""
        for label, before, after in self.done:
            if not before.problems and not after.problems:
                check_step(label, before, after)
        self.done.clear()


def check_step(label, before, after):
    """Of each step, that what it was not about is as it was, byte for byte."""
    items = Counter(item.text for item in before.items)
    now = Counter(item.text for item in after.items)
    if label.startswith(OF_THE_LINE) and label not in OF_A_TABLE:
        if before.items and after.items:  # an emptied list is written in another way
            assert around(before) == around(after), label
        if label.startswith("move ") and items.total() == now.total():
            lines = [sorted(one.text.splitlines(keepends=True)) for one in (before, after)]
            assert lines[0] == lines[1], label
        elif label.startswith("delete "):
            assert now.total() <= items.total()
        else:
            assert (items - now).total() <= 1, label
    elif not label.startswith(ELSEWHERE):
        assert items == now, label
        lost = Counter(comments(before)) - Counter(comments(after))
        is_whole = label.startswith(("current", "a preset", "density", "drop"))
        is_emptied = len(after.text.splitlines()) < len(before.text.splitlines())
        assert not lost or is_whole or is_emptied, (label, lost)


def around(draft):
    """The text but for the items of the line."""
    text = draft.text
    for item in draft.items:
        text = text.replace(item.text, "", 1)
    return text


def comments(draft):
    return [line.partition("#")[2] for line in draft.text.splitlines(keepends=True) if "#" in line]


def parcel(chance, keys, verbs):
    """A key anywhere, or what people press on the first screen."""
    pressed = []
    while len(pressed) < PARCEL:
        if verbs and chance.random() < 0.6:
            pressed += ["escape", "escape", "escape", *chance.choice(verbs)]
        else:
            pressed.append(chance.choice(keys))
    return pressed


async def press_at_random(driver, chance, keys, verbs, count, check, meanwhile=lambda _: None):
    for number in range(count // PARCEL):
        pressed = parcel(chance, keys, verbs)
        for key in pressed:
            driver.app.post_message(events.Key(key, _character(key)))
        if number % 7 == 0:
            await driver.pilot.resize_terminal(*chance.choice(SIZES))
        if number % 5 == 0:
            driver.app.post_message(events.Paste(chance.choice(PASTES)))
        meanwhile(number)
        await driver.pilot.pause()
        while driver.app.has_keys_waiting:
            await driver.pilot.pause()
        assert driver.app.is_running, f"ended after {pressed}"
        try:
            check()
        except AssertionError as error:
            raise AssertionError(f"after {pressed}, the {number}th") from error


def _character(key):
    return CHARACTERS.get(key, key if len(key) == 1 else None)


def undone(driver):
    """The text when all is undone."""
    driver.app.draft_screens()[-1].settle()
    while driver.session.history.undo():
        pass
    return driver.text


async def first_screen(driver):
    for _ in range(8):
        if driver.app.screen is not driver.builder:
            await driver.press("escape")
    await driver.settle()
    assert driver.app.screen is driver.builder


@pytest.mark.parametrize("count", [60, pytest.param(1000, marks=pytest.mark.slow)])
@pytest.mark.parametrize(("seed", "text"), [(7, MOORING), (2026, UGLY)])
def test_keys_at_random_change_what_they_are_about(small, monkeypatch, seed, text, count):
    small.write_bytes(text.encode())
    steps = Steps(monkeypatch)

    async def play():
        async with driven(small, SIZES[0]) as driver:

            def check():
                assert not driver.session.draft.problems
                steps.check()

            await press_at_random(driver, random.Random(seed), KEYS, VERBS, count, check)
            await first_screen(driver)
            driver.session.save()
            assert small.read_bytes().decode() == driver.text
            assert undone(driver) == text

    asyncio.run(play())


def test_keys_at_random_in_the_text_are_undone(small, monkeypatch):
    small.write_bytes(UGLY.encode())
    steps = Steps(monkeypatch)

    async def play():
        async with driven(small, SIZES[0]) as driver:
            await press_at_random(driver, random.Random(3), TEXT_KEYS, [], 200, steps.check)
            await driver.settle()
            assert undone(driver) == UGLY

    asyncio.run(play())


@pytest.mark.parametrize(
    ("seed", "count"), [(1, 60), *(pytest.param(n, 400, marks=pytest.mark.slow) for n in (1, 2))]
)
def test_keys_at_random_while_another_program_writes_the_file(
    small, folder, monkeypatch, seed, count
):
    """Saving anywhere, leaving, and a file that changes, breaks and goes away on the disk."""
    small.write_bytes(UGLY.encode())
    steps, chance = Steps(monkeypatch), random.Random(seed)
    save_as = Session.save_as

    def save_here(session, path, *arguments, **options):
        if not path.resolve().is_relative_to(folder):
            raise NotWritten("nothing is written outside the folder of the test")
        return save_as(session, path, *arguments, **options)

    monkeypatch.setattr(Session, "save_as", save_here)
    monkeypatch.setattr(BuildApp, "exit", lambda app, *_: None)  # stay, and press on

    async def play():
        async with driven(small, SIZES[0], environment="storm") as driver:

            def write(number):
                if number % 3 == 0:
                    theirs = chance.choice([UGLY, MOORING, "line: [", UGLY.replace("60 m", "5 m")])
                    small.write_bytes(theirs.encode())
                elif number % 11 == 0:
                    small.unlink(missing_ok=True)
                driver.app.saving.check_external_change()

            keys = chance, DISK_KEYS, DISK_VERBS
            await press_at_random(driver, *keys, count, steps.check, write)
            await driver.settle()

    asyncio.run(play())
