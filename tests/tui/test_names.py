"""Labels that the file names elsewhere, and files that nothing could open."""

import subprocess
import sys

import pytest

from calm.files import read_mooring
from tests.tui.conftest import MOORING

NAMING = (
    MOORING
    + """\
checks:
  accept:
    - {rule: knockdown, component: top float, reason: agreed}
    - {rule: working, component: 'logger*', reason: no maker prints one}
deployed:
  items:
    - {label: deep logger, serial: 4711}
"""
)


@pytest.fixture
def naming(folder):
    path = folder / "naming.yaml"
    path.write_text(NAMING.replace("rule: working", "rule: tilt"), encoding="utf-8")
    read_mooring(path)
    return path


def opens(driver):
    """What the draft accepts and what was deployed, read as every command reads it."""
    file = read_mooring("line.yaml", text=driver.text)
    return [each.component for each in file.accepts], [i.label for i in file.deployed.items]


def test_a_renamed_label_is_followed_where_the_file_names_it(drive, naming):
    async def story(driver):
        await driver.press("n", "ctrl+u")
        await driver.type("buoy")
        await driver.press("enter")
        assert opens(driver) == (["buoy", "logger*"], ["deep logger"])
        assert "checks: accept now refers to buoy" in driver.screen
        await driver.press("down", "down", "down", "n", "ctrl+u")
        await driver.type("old one")
        await driver.press("enter")
        assert opens(driver) == (["buoy", "logger*"], ["old one"])
        await driver.press("u", "u")
        assert driver.text == naming.read_text(encoding="utf-8")

    drive(story, naming)


def test_a_piece_without_a_label_is_followed_by_its_component_and_its_number(drive, naming):
    text = naming.read_text(encoding="utf-8").replace("component: top float", "component: releaser")
    naming.write_text(text, encoding="utf-8")

    async def story(driver):
        await driver.press("down", "down", "down", "down", "n")
        await driver.type("lower")
        await driver.press("enter")
        assert opens(driver)[0][0] == "lower"
        await driver.press("c", "v")  # two of them: they are numbered
        assert opens(driver)[0][0] == "lower 1"
        await driver.press("up", "V")  # one above: the one that was meant is the second
        assert opens(driver)[0][0] == "lower 2"

    drive(story, naming)


@pytest.mark.parametrize("answer, named", [("o", "top float 1"), ("b", "top float *")])
def test_to_duplicate_what_is_named_asks(drive, naming, answer, named):
    async def story(driver):
        await driver.press("d")
        assert "checks: accept refers to top float" in driver.screen
        await driver.press("escape")
        assert driver.uses[:2] == ["ball", "rope"]
        await driver.press("d", answer)
        assert driver.uses[:2] == ["ball", "ball"]
        assert named in opens(driver)[0]

    drive(story, naming)


def test_what_names_a_piece_that_is_deleted_is_told_and_saving_says_it_again(drive, naming):
    async def story(driver):
        await driver.press("down", "down", "down", "delete")
        assert (
            "deployed: items still refers to `deep logger`, which no longer exists" in driver.screen
        )
        await driver.press("ctrl+s")
        assert "saved, but the file cannot be opened: line" in driver.screen
        assert "no piece or clamp is called" in driver.screen
        await driver.press("u", "ctrl+s")
        assert driver.screen.splitlines()[-1].strip() == "naming.yaml saved"
        assert "cannot be opened" not in driver.screen

    drive(story, naming, size=(160, 30))


def test_leaving_with_a_file_that_cannot_be_opened_stays_to_say_so(drive, naming):
    async def story(driver):
        await driver.press("down", "down", "down", "delete", "q", "s")
        assert driver.app.is_running and not driver.app._exit
        assert "the file cannot be opened" in driver.screen
        await driver.press("q")
        assert driver.app._exit

    drive(story, naming, size=(160, 30))


def test_a_line_that_is_not_complete_yet_is_saved_without_a_word(drive, folder):
    async def story(driver):
        await driver.press("ctrl+s")
        await driver.settle()
        assert "cannot be opened" not in driver.screen

    path = folder / "new.yaml"
    path.write_text(MOORING.replace("  - {use: weight}\n", ""), encoding="utf-8")
    drive(story, path)


def test_a_second_builder_on_the_same_file_says_so(drive, small, tmp_path):
    hold = (
        "import sys, time\nfrom pathlib import Path\n"
        "from calm.files.editing.user_state import Presence\n"
        "Presence().announce(Path(sys.argv[1]))\nprint('open', flush=True)\ntime.sleep(60)\n"
    )
    other = subprocess.Popen(
        [sys.executable, "-c", hold, str(small)], stdout=subprocess.PIPE, text=True
    )
    try:
        assert other.stdout.readline() == "open\n"

        async def story(driver):
            assert f"is open elsewhere (process {other.pid}), in another builder" in driver.screen

        drive(story, small, size=(120, 30))
    finally:
        other.kill()
        other.communicate()

    async def alone(driver):
        assert "open elsewhere" not in driver.screen

    drive(alone, small)
    assert not list((tmp_path / "state" / "calm").glob("open-*"))  # neither its own nor the dead


@pytest.mark.parametrize(
    "height", [3, *(pytest.param(height, marks=pytest.mark.thorough) for height in (4, 24))]
)
def test_the_palette_lives_in_a_terminal_of_four_lines(drive, small, height):
    async def story(driver):
        await driver.press("ctrl+p", "pagedown", "pageup", "s", "pagedown", "down", "up")
        await driver.pilot.resize_terminal(80, 4)
        await driver.press("pagedown", "pageup", "end", "home", "backspace", "pagedown")
        assert driver.app._exception is None
        await driver.press("escape")
        assert driver.app.screen is driver.builder

    drive(story, small, size=(80, height))


def test_keys_run_through_their_own_palette(drive, small):
    async def story(driver):
        await driver.press("ctrl+p")
        await driver.type("zoom")
        await driver.settle()
        await driver.press("enter")
        await driver.settle()
        assert driver.builder.has_class("-zoomed")

    drive(story, small)
