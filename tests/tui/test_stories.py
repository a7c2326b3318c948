"""Whole moorings from nothing, key by key: how many it takes, and that they are what was meant.

A sign of a story is a key: `⏎` Enter, `⎋` Esc, `⑥` F6, any other one itself. What stands between
`«` and `»` is pasted, each of its signs, its ends of lines too, counted as a key. There is no file
to begin with, none that is read, and none of the moorings that the builder offers.
"""

import re

import pytest
import yaml
from textual.events import Paste

from calm.case import Design
from calm.files import read_mooring
from tests.tui.conftest import NAMES

KEYS = NAMES | {"⏎": "enter", "⎋": "escape", "⑥": "f6", "=": "equals_sign"}
PASTED = re.compile("«(.*?)»", re.DOTALL)

DEEP = (
    "w4000⏎"
    "«0 .6 70\n300 .4 70\n700 .25 70\n1200 .15 65\n2500 .08 60\n4000 .05 60»⏎"
    "⑥storm⏎«0 1 80\n300 .6 80\n700 .35 75\n1200 .2 70\n2500 .1 60\n4000 .08 60»⏎⎋"
    "aore 41⏎sh-19⏎r-c21⏎sh-16⏎rcm11⏎sh-13⏎jacketed-8-5⏎680⏎w1⏎⎋"
    "isbe37⏎50⏎T1⏎⏎150⏎T2⏎⏎400⏎T3⏎⎋"
    "ash⏎clus 4⏎rcm⏎sh⏎paraf k⏎490⏎r1⏎⎋isb⏎100⏎T4⏎⏎300⏎T5⏎⏎450⏎T6⏎⎋"
    "ash⏎cl⏎rcm⏎sh⏎par⏎990⏎r2⏎sh⏎cl⏎rcm⏎sh⏎par⏎1300⏎r3⏎sh⏎rcm⏎sh⏎par⏎350⏎r4⏎cl⏎⎋=3⏎"
    "asw⏎pair ar⏎poly 19-d⏎20⏎⏎g30-13⏎5⏎⏎sh-19⏎wheels 4⏎⎋"
    "sdeep⏎"
)
DEEP_MEANT = """\
environment:
  depth: 4000 m
  current: [[0, .6, 70], [300, .4, 70], [700, .25, 70], [1200, .15, 65], [2500, .08, 60],
    [4000, .05, 60]]
storm: [[0, 1, 80], [300, .6, 80], [700, .35, 75], [1200, .2, 70], [2500, .1, 60], [4000, .08, 60]]
line:
  - {use: sphere-ore-41in}
  - {use: shackle-19}
  - {use: swivel-miller-c212}
  - {use: shackle-16}
  - {use: rcm11}
  - {use: shackle-13}
  - {use: wire-jacketed-8-5, length: 680 m, label: w1, clamps: [
      {use: sbe37, at: 50 m, label: T1}, {use: sbe37, at: 150 m, label: T2},
      {use: sbe37, at: 400 m, label: T3}]}
  - {use: shackle-13}
  - {use: glass-cluster-4}
  - {use: rcm11}
  - {use: shackle-13}
  - {use: parafil-kevlar-8-5, length: 490 m, label: r1, clamps: [
      {use: sbe37, at: 100 m, label: T4}, {use: sbe37, at: 300 m, label: T5},
      {use: sbe37, at: 450 m, label: T6}]}
  - {use: shackle-13}
  - {use: glass-cluster-4}
  - {use: rcm11}
  - {use: shackle-13}
  - {use: parafil-kevlar-8-5, length: 990 m, label: r2}
  - {use: shackle-13}
  - {use: glass-cluster-4}
  - {use: rcm11}
  - {use: shackle-13}
  - {use: parafil-kevlar-8-5, length: 1300 m, label: r3}
  - {use: shackle-13}
  - {use: rcm11}
  - {use: shackle-13}
  - {use: parafil-kevlar-8-5, length: 350 m, label: r4}
  - {use: glass-cluster-4, count: 3}
  - {use: swivel-miller-c212}
  - {use: release-pair-ar861}
  - {use: polyester-19-dewey, length: 20 m}
  - {use: chain-short-g30-13, length: 5 m}
  - {use: shackle-19}
  - {use: anchor-wheels-4}
"""

SURFACE = (
    "w60⏎«0 .7 80\n30 .6 80\n60 .2 75»⏎⎋"
    "aore 41⏎sh-19⏎swivel-19⏎sh-16⏎buoy-13⏎8⏎⏎sh⏎lene-22⏎38⏎⏎sh⏎buo⏎14⏎⏎sh-19⏎els 2⏎⎋sbuoy⏎"
)
SURFACE_MEANT = """\
environment:
  depth: 60 m
  current: [[0, .7, 80], [30, .6, 80], [60, .2, 75]]
line:
  - {use: sphere-ore-41in}
  - {use: shackle-19}
  - {use: swivel-19}
  - {use: shackle-16}
  - {use: chain-buoy-13, length: 8 m}
  - {use: shackle-16}
  - {use: polypropylene-22, length: 38 m}
  - {use: shackle-16}
  - {use: chain-buoy-13, length: 14 m}
  - {use: shackle-19}
  - {use: anchor-wheels-2}
"""


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


def assert_file_is(path, expected):
    """That the file says what was meant, and nothing else but a name and a density."""
    data, expected = yaml.safe_load(path.read_text(encoding="utf-8")), yaml.safe_load(expected)
    columns = ["depth m", "speed m/s", "toward deg"]
    assert data["line"] == expected["line"]
    assert data["environment"] == {
        "depth": expected["environment"]["depth"],
        "density": "1025 kg/m^3",
        "current": {"columns": columns, "rows": expected["environment"]["current"]},
    }
    if "storm" in expected:
        storm = {"current": {"columns": columns, "rows": expected["storm"]}}
        assert data["environments"] == {"storm": storm}
    assert set(data) == {"name", "environment", "line"} | ({"environments"} & set(data))


@pytest.mark.thorough
def test_a_deep_mooring_from_nothing_in_five_hundred_keys(drive, folder):
    counts = []

    async def story(driver):
        counts.append(await play(driver, DEEP))

    drive(story)
    assert counts[0] <= 500
    assert_file_is(folder / "deep.yaml", DEEP_MEANT)
    line = yaml.safe_load(DEEP_MEANT)["line"]
    assert len(line) == 33 and sum(len(piece.get("clamps", ())) for piece in line) == 6
    for environment, top in ((None, 172.6), ("storm", 266.8)):
        file = read_mooring(folder / "deep.yaml", environment=environment)
        assert abs(Design(file).solve().top.depth - top) < 0.5


def test_a_surface_mooring_from_nothing_in_a_hundred_and_twenty_keys(drive, folder):
    counts = []

    async def story(driver):
        counts.append(await play(driver, SURFACE))

    drive(story)
    assert counts[0] <= 120
    assert_file_is(folder / "buoy.yaml", SURFACE_MEANT)
    result = Design(read_mooring(folder / "buoy.yaml")).solve()
    assert result.type == "surface" and len(result.file.pieces) == 11
