"""Bill and totals on the screen; the report and the sheets written where asked."""

import subprocess

import pytest

from calm.tui import comparing


def test_the_bill_has_totals(drive, small):
    async def story(driver):
        await driver.press("f9", "b")
        screen = " ".join(driver.screen.split())
        assert "wire and rope 60.00 m" in screen
        assert "logger logger 2" in screen
        # 2000 N of the ball; 0.2 N/m of 60 m, 2 × 5 N, 200 N and 5000 N
        assert "buoyancy 2000 N" in screen and "weight in water 5222 N" in screen
        await driver.press("escape")
        assert driver.app.screen is driver.builder

    drive(story, small)


@pytest.mark.parametrize(("key", "command"), [("r", ["check", "--report"]), ("d", ["deck"])])
def test_papers_are_written_of_the_saved_file(drive, small, monkeypatch, key, command):
    asked = []

    def run(words, **_):
        asked.append(words[3:])
        return subprocess.CompletedProcess(words, 1, "", "first\nthe report is in there\n")

    monkeypatch.setattr(comparing.subprocess, "run", run)

    async def story(driver):
        await driver.press("n", "x", "enter")
        await driver.settle()
        await driver.press("f9", key)
        assert "Save the file first" in driver.screen and not asked
        await driver.press("u")
        await driver.settle()
        await driver.press("f9", key)
        await driver.press("enter")
        await driver.settle()
        assert "the report is in there" in driver.screen

    drive(story, small)
    (words,) = asked
    assert words[0] == command[0] and words[1] == str(small)
    assert words[3] == str(small.with_name(f"small-{'report' if key == 'r' else 'deck'}"))
