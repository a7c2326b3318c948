"""Pictures of three screens, compared with those that were looked at when they were kept.

After a change that is meant, `CALM_SNAPSHOTS=keep pytest tests/tui/test_snapshots.py` keeps the new
ones; look at them. No figure of them may stand between two that are printed, as the depth of an
anchor 0.55 m high does in water of whole metres: the last bit of a processor would decide.
"""

import os
import re
from pathlib import Path

import pytest

from calm.shipped import shipped_folder

pytestmark = pytest.mark.usefixtures("painted")

KEPT = Path(__file__).parent / "snapshots"
STORIES = {
    "line": ((140, 40), "upward-adcp-300m", ["down", "down", "down"]),
    "catalogue": ((80, 24), "s1000", ["a", *"wire", "space", *"jack"]),
    "water": ((120, 32), "s1000", ["w"]),
}


def normal(svg):
    """Without the number that rich gives to every picture, and the fonts that it would fetch."""
    svg = re.sub(r"\s*@font-face \{.*?\}", "", svg, flags=re.DOTALL)
    svg = re.sub(r"\s*<!-- Generated .*?-->", "", svg)
    return re.sub(r"terminal-\d+", "terminal", svg)


@pytest.mark.parametrize("name", STORIES)
def test_the_screen_looks_as_it_was_kept(drive, name):
    size, file, keys = STORIES[name]

    async def story(driver):
        await driver.press(*keys)
        driver.app.judging.ask_fully()
        await driver.settle()
        driver.app.screen.query("Input").set(disabled=True)  # no blinking cursor
        await driver.settle()
        svg = normal(driver.app.export_screenshot(simplify=True))
        kept = KEPT / f"{name}.svg"
        if os.environ.get("CALM_SNAPSHOTS") == "keep":
            KEPT.mkdir(exist_ok=True)
            kept.write_text(svg, encoding="utf-8")
        assert svg == kept.read_text(encoding="utf-8")

    drive(story, shipped_folder("lines") / f"{file}.yaml", size=size)
