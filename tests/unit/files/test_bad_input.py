"""Every way a mooring file can be wrong: one line each, with its place and what to write."""

import re
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest

from calm.errors import InputError
from calm.files import read_mooring

from .conftest import GOOD, Place

Mistakes = Callable[..., list[Place]]

ANCHORED = "  - {use: deadweight}\n"


def changed(old: str, new: str) -> str:
    assert GOOD.count(old) == 1, old
    return GOOD.replace(old, new)


ONE_MISTAKE = {
    "unknown component": (
        changed("use: rope-12", "use: rop-12"),
        (11, 11, "`use: rop-12`: no such component; did you mean rope-12?"),
    ),
    "component like no other": (
        changed("use: rope-12", "use: zzz"),
        (11, 11, "`use: zzz`: no such component (`calm catalog list` shows all)"),
    ),
    "missing unit": (
        changed("depth: 1100 m", "depth: 1000"),
        (3, 10, "`depth: 1000` needs a unit; did you mean `depth: 1000 m`?"),
    ),
    "wrong unit": (
        changed("depth: 1100 m", "depth: 1000 m/s"),
        (3, 10, "`depth: 1000 m/s` is a speed; a length (m, mm, cm, km, in, ft …) is needed"),
    ),
    "mass for a force": (
        changed("label: top float", "buoyancy: 35 kg"),
        (
            10,
            27,
            "`buoyancy: 35 kg` is a mass; a force (N, kN, kgf, lbf, daN, MN …) is needed; "
            "did you mean `buoyancy: 35 kgf`?",
        ),
    ),
    "negative length": (
        changed("480 m", "-480 m"),
        (11, 28, "`length: -480 m` must be more than 0 m"),
    ),
    "length zero of a cable": (
        changed("480 m", "0"),
        (11, 28, "`length: 0` must be more than 0 m"),
    ),
    "not a number": (
        changed("0.35", ".nan"),
        (8, 15, "`speed: .nan` is not a finite number"),
    ),
    "not a number, as text": (
        changed("0.35", "nan"),
        (8, 15, "`speed: nan` is not a finite number"),
    ),
    "a depth that is not a number": (
        changed("[200, 0.35", "[nan, 0.35"),
        (8, 10, "`depth: nan` is not a finite number"),
    ),
    "infinity": (
        changed("1100 m", ".inf m"),
        (3, 10, "`depth: .inf m` is not a finite number"),
    ),
    "duplicate key": (
        changed("  depth: 1100 m\n", "  depth: 1100 m\n  depth: 900 m\n"),
        (4, 3, "`depth` is given twice (first on line 3)"),
    ),
    "unknown key": (
        changed("name:", "nmae:"),
        (1, 1, "unknown key `nmae`; did you mean `name`?"),
    ),
    "unknown field on the line": (
        changed("length: 480 m", "lenght: 480 m"),
        (11, 20, "unknown key `lenght` for kind cable; did you mean `length`?"),
    ),
    "required key misspelt": (
        changed("  depth:", "  dept:"),
        (3, 3, "unknown key `dept`; did you mean `depth`?"),
    ),
    "empty line": (GOOD[: GOOD.index("  - {use: ball")], (9, 1, "`line` is empty")),
    "line of no items": (
        GOOD[: GOOD.index("line:")] + "line: []\n",
        (9, 7, "`line` is empty"),
    ),
    "no line": (GOOD[: GOOD.index("line:")], (1, 1, "`line` is missing")),
    "no environment": (
        GOOD[GOOD.index("line:") :],
        (1, 1, "`environment` is missing"),
    ),
    "no anchor": (
        changed(ANCHORED, ""),
        (9, 1, "the line has no anchor; its last item must be one (`kind: anchor`)"),
    ),
    "anchor not last": (
        GOOD + "  - {use: plate}\n",
        (
            13,
            5,
            "anchor `deadweight` must be the last item; a line has only one anchor, at its end",
        ),
    ),
    "two anchors": (
        GOOD + ANCHORED,
        (
            13,
            5,
            "anchor `deadweight` must be the last item; a line has only one anchor, at its end",
        ),
    ),
    "nothing but an anchor": (
        GOOD[: GOOD.index("  - {use: ball")] + ANCHORED,
        (10, 5, "a line needs at least one piece above its anchor"),
    ),
    "two fits": (
        changed("480 m", "fit, top_depth: 90 m").replace(
            "  - {use: plate}", "  - {use: rope-16, length: fit, top_depth: 90 m}"
        ),
        (12, 5, "only one piece can be cut to fit; the file already has one, on its line 11"),
    ),
    "fit without a depth": (
        changed("480 m", "fit"),
        (11, 5, "`top_depth` is missing: `length: fit` needs a depth"),
    ),
    "depth without fit": (
        changed("480 m", "480 m, top_depth: 90 m"),
        (11, 35, "`top_depth` is only for `length: fit`"),
    ),
    "fit below the seabed": (
        changed("480 m", "fit, top_depth: 1100 m"),
        (11, 5, "`top_depth` must not be below the seabed, which is 1100 m deep"),
    ),
    "fit of a rigid piece": (
        changed("{use: plate}", "{use: plate, length: fit}"),
        (12, 26, "`length: fit` is not a length (m, mm, cm, km, in, ft …)"),
    ),
    "unsorted current": (
        changed("[200,", "[0.0,"),
        (8, 10, "depth 0 m repeats 0 m; depths must increase"),
    ),
    "empty current": (
        re.sub(r"    rows:\n(      - .*\n)+", "    rows: []\n", GOOD),
        (6, 11, "the table has no rows"),
    ),
    "current without rows": (
        re.sub(r"    rows:\n(      - .*\n)+", "    rows:\n", GOOD),
        (6, 5, "`rows` is empty"),
    ),
    "direction without speed": (
        changed("speed m/s", "w m/s"),
        (
            5,
            14,
            "a current needs `u` and `v`, or `speed` and `toward`; "
            "the columns are depth, w, toward",
        ),
    ),
    "uniform direction without speed": (
        re.sub(r"  current:\n(    .*\n)+", "  current: {toward: 90 deg}\n", GOOD),
        (4, 12, "`speed` is missing"),
    ),
    "uniform speed without direction": (
        re.sub(r"  current:\n(    .*\n)+", "  current: {speed: 1 knot}\n", GOOD),
        (4, 12, "`toward` is missing"),
    ),
    "negative speed": (
        changed("0.35", "-0.35"),
        (8, 15, "`speed` -0.35 m/s is negative; reverse `toward` instead"),
    ),
    "row too short": (
        changed("[200, 0.35, 80]", "[200, 0.35]"),
        (8, 9, "the row has 2 values; 3 are needed"),
    ),
    "decimal comma in a row": (
        changed("[200, 0.35, 80]", "[200, 0,35, 80]"),
        (8, 9, "the row has 4 values; 3 are needed; is there a decimal comma? Write 0.8, not 0,8"),
    ),
    "column of another unit": (
        changed("speed m/s", "speed kg"),
        (5, 24, "`speed kg` is a mass; a speed (m/s, cm/s, mm/s, knot, km/h, ft/s) is needed"),
    ),
    "unknown column": (
        changed("speed m/s", "sped m/s"),
        (5, 24, "no column is called `sped`; did you mean `speed`?"),
    ),
    "column without a unit": (
        changed("speed m/s", "speed").replace("0.80", "0.8 m/s"),
        (8, 15, "`speed: 0.35` needs a unit; did you mean `speed: 0.35 m/s`?"),
    ),
    "depth zero": (changed("1100 m", "0 m"), (3, 10, "`depth: 0 m` must be more than 0 m")),
    "depth empty": (changed(" 1100 m", ""), (3, 3, "`depth` has no value")),
    "no depth": (changed("  depth: 1100 m\n", ""), (3, 3, "`depth` is missing")),
    "density zero": (
        changed("1100 m\n", "1100 m\n  density: 0\n"),
        (4, 12, "`density: 0` must be more than 0 kg/m^3"),
    ),
    "cable without a length": (
        changed("length: 480 m, ", ""),
        (11, 5, "`length` is missing: every cable or chain needs a length"),
    ),
    "clamp beyond its piece": (
        changed("at: 20 m", "at: 481 m"),
        (11, 61, "`at: 481 m` is beyond the end of the piece, which is 480 m long"),
    ),
    "clamp above its piece": (
        changed("at: 20 m", "at: -1 m"),
        (11, 61, "`at: -1 m` must be at least 0 m"),
    ),
    "clamp without a place": (
        changed(", at: 20 m", ""),
        (11, 44, "`at` is missing: the distance from the top of the piece"),
    ),
    "clamped cable": (
        changed("use: meter", "use: rope-16"),
        (11, 50, "a component of kind cable cannot be clamped on a line"),
    ),
    "clamp below the anchor": (
        changed("{use: deadweight}", "{use: deadweight, clamps: [{use: meter, at: 9 m}]}"),
        (13, 49, "`at: 9 m` is beyond the end of the piece, which is 0.4 m long"),
    ),
    "clamp above the anchor": (
        changed("{use: deadweight}", "{use: deadweight, clamps: [{use: meter, at: -1 m}]}"),
        (13, 49, "`at: -1 m` must be at least 0 m"),
    ),
    "decimal comma": (
        changed("1100 m", "1100,5 m"),
        (3, 10, "`depth: 1100,5 m` has a decimal comma; did you mean `depth: 1100.5 m`?"),
    ),
    "decimal comma in braces": (
        re.sub(r"  current:\n(    .*\n)+", "  current: {speed: 0,8 m/s, toward: 9 deg}\n", GOOD),
        (4, 22, "`8 m/s` is not a key; is there a decimal comma? Write 0.8, not 0,8"),
    ),
    "tab": (changed("  depth:", "\tdepth:"), (3, 1, "a tab; YAML is indented with spaces")),
    "invalid YAML": (
        changed("[0, 0.80, 90]", "[0, 0.80, 90"),
        (7, 9, "the `[` that begins here is not closed"),
    ),
    "two documents": (
        GOOD + "---\nname: more\n",
        (
            14,
            1,
            "is not valid YAML: expected a single document in the stream from line 1, but found "
            "another document",
        ),
    ),
    "alias": (
        changed("[0, 0.80, 90]", "&row [0, 0.80, 90]").replace("- [200, 0.35, 80]", "- *row"),
        (7, 9, "YAML anchors (&) and aliases (*) are not supported; repeat the value"),
    ),
    "tag": (
        changed("1100 m", "!!python/name:os.system"),
        (3, 10, "tags (`tag:yaml.org,2002:python/name:os.system`) are not allowed"),
    ),
    "key that is a list": (changed("name:", "? [a]\n:"), (1, 3, "a key must be plain text")),
    "list for a mapping": (
        "- a\n- b\n",
        (1, 1, "must hold `key: value` lines at its top level"),
    ),
    "text for a mapping": (
        re.sub(r"environment:\n(  .*\n)+", "environment: deep\n", GOOD),
        (2, 14, "`environment` must hold `key: value` entries, as `environment: {depth: 1100 m}`"),
    ),
    "item that is text": (
        changed("{use: plate}", "plate"),
        (12, 5, "`plate` is not an item; write `{use: plate}`"),
    ),
    "count of none": (
        changed("{use: plate}", "{use: plate, count: 0}"),
        (12, 25, "`count: 0` must be at least 1"),
    ),
    "count of parts": (
        changed("{use: plate}", "{use: plate, count: 1.5}"),
        (12, 25, "`count: 1.5` must be a whole number"),
    ),
    "count of a thousand million": (
        changed("{use: plate}", "{use: plate, count: 1e9}"),
        (12, 25, "`count: 1e9` must be at most 10000"),
    ),
    "kind overridden": (
        changed("{use: plate}", "{use: plate, kind: sphere}"),
        (12, 18, "`kind` cannot be overridden; define a component of your own"),
    ),
    "override of an assembly": (
        changed("{use: plate}", "{use: pair, mass: 3 kg}"),
        (
            12,
            17,
            "`mass` cannot be set on an assembly; allowed: breaking_load, count, depth_rating, "
            "grip, label, max_tilt, opening_load, serial, source, sources, use, working_load",
        ),
    ),
    "drag misspelt": (
        GOOD + "solver: {drag: reynold}\n",
        (
            14,
            16,
            "`drag: reynold` must be one of constant, reynolds; did you mean `drag: reynolds`?",
        ),
    ),
    "friction misspelt": (
        GOOD + "solver: {friction: hörner}\n",
        (
            14,
            20,
            "`friction: hörner` must be one of berteaux, hoerner, constant; "
            "did you mean `friction: hoerner`?",
        ),
    ),
    "elongation without breaking load": (
        GOOD + "components:\n  own: {kind: cable, diameter: 8 mm, weight: 1 N/m, "
        "elongation: [[0.1, 0.02]]}\n",
        (
            15,
            8,
            "`elongation` needs `breaking_load`, because its loads are fractions of the breaking "
            "load",
        ),
    ),
    "elongation beside stiffness": (
        changed("length: 480 m", "length: 480 m, stiffness: 2 MN, elongation: [[0.1, 0.02]]"),
        (11, 5, "has both `stiffness` and `elongation`; give only one"),
    ),
    "elongation that stays, of nothing": (
        changed("length: 480 m", "length: 480 m, permanent_elongation: 4 %"),
        (11, 5, "`permanent_elongation` needs `elongation`"),
    ),
    "elongation that stays, in percent": (
        changed("length: 480 m", "length: 480 m, elongation: [[1, 0.2]], permanent_elongation: 4"),
        (11, 81, "`permanent_elongation: 4` must be at most 1"),
    ),
    "elongation that falls": (
        changed("length: 480 m", "length: 480 m, elongation: [[0.1, 0.02], [0.2, 0.01]]"),
        (11, 47, "`elongation`: point 2: the strain 0.01 is below that of the point before"),
    ),
    "elongation of loads that do not grow": (
        changed("length: 480 m", "length: 480 m, elongation: [[0.2, 0.02], [10 %, 0.03]]"),
        (11, 47, "`elongation`: point 2: the load 0.1 is not above that of the point before"),
    ),
    "elongation at no load": (
        changed("length: 480 m", "length: 480 m, elongation: [[0, 0.02], [0.2, 0.04]]"),
        (
            11,
            47,
            "`elongation`: the strain at no load must be 0; set a lasting strain as "
            "`permanent_elongation`",
        ),
    ),
    "elongation of no points": (
        changed("length: 480 m", "length: 480 m, elongation: []"),
        (11, 47, "`elongation`: an elongation curve needs at least one point with a load above 0"),
    ),
    "elongation by force": (
        changed("length: 480 m", "length: 480 m, elongation: [[5 kN, 0.02]]"),
        (11, 49, "`elongation: 5 kN` is a force; a plain number is needed"),
    ),
    "elongation beyond the breaking load": (
        changed("length: 480 m", "length: 480 m, elongation: [[20, 0.02]]"),
        (11, 49, "`elongation: 20` must be at most 1"),
    ),
    "elongation of three figures": (
        changed("length: 480 m", "length: 480 m, elongation: [[0.1, 0.02, 3]]"),
        (11, 48, "`elongation` has a row with too many values"),
    ),
    "elongation that is no table": (
        changed("length: 480 m", "length: 480 m, elongation: 3 %"),
        (11, 47, "`elongation` must be a list, as `elongation: [[0.05, 0.05]]`"),
    ),
    "elongation of a chain": (
        changed("use: rope-12", "use: chain-13").replace(
            "length: 480 m", "length: 480 m, elongation: [[0.1, 0.02]]"
        ),
        (11, 36, "unknown key `elongation` for kind chain"),
    ),
    "choice misspelt": (
        GOOD + "solver: {buoy_drag: ful}\n",
        (
            14,
            21,
            "`buoy_drag: ful` must be one of immersed, full; did you mean `buoy_drag: full`?",
        ),
    ),
    "angle step too wide": (
        GOOD + "solver: {angle_step: 11 deg}\n",
        (14, 22, "`angle_step: 11 deg` must be at most 10 deg"),
    ),
    "angle step of none": (
        GOOD + "solver: {angle_step: 0}\n",
        (14, 22, "`angle_step: 0` must be more than 0 deg"),
    ),
    "tolerance too wide": (
        GOOD + "solver: {tolerance: 3e-4}\n",
        (14, 21, "`tolerance: 3e-4` must be at most 0.0002"),
    ),
    "limit misspelt": (
        GOOD + "checks: {safety_factor: {steal: 3}}\n",
        (14, 26, "unknown key `steal`; did you mean `steel`?"),
    ),
    "cause misspelt": (
        GOOD + "uncertainty: {curent: 5 %}\n",
        (14, 15, "unknown key `curent`; did you mean `current`?"),
    ),
    "deviation too wide": (
        GOOD + "uncertainty: {current: 60 %}\n",
        (
            14,
            24,
            "`current: 60 %` is more than the maximum standard deviation of 25 %; set a "
            "pair of 5 and 95 % points instead",
        ),
    ),
    "deviation with a unit": (
        GOOD + "uncertainty: {depth: 5 m}\n",
        (
            14,
            22,
            "`depth: 5 m` is a length; a share of the value is needed, such as 0.4 % (5 m of "
            "1250 m)",
        ),
    ),
    "deviation without percent": (
        GOOD + "uncertainty: {length: 5}\n",
        (
            14,
            23,
            "`length: 5` is a share of 500 %, more than the maximum standard deviation of 25 %; "
            "set a pair of 5 and 95 % points instead; did you mean `length: 5 %`?",
        ),
    ),
    "deviation below nothing": (
        GOOD + "uncertainty: {depth: -1 %}\n",
        (14, 22, "`depth: -1 %` must be at least 0"),
    ),
    "direction of no unit": (
        GOOD + "uncertainty: {direction: 5}\n",
        (14, 26, "`direction: 5` needs a unit; did you mean `direction: 5 deg`?"),
    ),
    "pair the wrong way round": (
        GOOD + "uncertainty: {cable_drag: [30 %, -15 %]}\n",
        (14, 27, "`cable_drag: …` is a pair whose 5 % point is not below its 95 % point"),
    ),
    "pair of three": (
        GOOD + "uncertainty: {cable_drag: [1 %, 2 %, 3 %]}\n",
        (14, 27, "`cable_drag: …` is neither a standard deviation nor a pair of 5 and 95 % points"),
    ),
    "pair below nothing": (
        GOOD + "uncertainty: {cable_drag: [-150 %, 10 %]}\n",
        (14, 27, "`cable_drag: …` contains `-150 %`, which must be more than -1"),
    ),
}


@pytest.mark.parametrize(("text", "mistake"), ONE_MISTAKE.values(), ids=ONE_MISTAKE.keys())
def test_one_mistake(mistakes: Mistakes, text: str, mistake: Place) -> None:
    assert mistakes(text) == [mistake]


def test_all_mistakes_at_once(mistakes: Mistakes) -> None:
    text = """\
name: Many
position: {latitude: 48.3, longitude: -5.2 deg}
environment:
  depth: 1000
  current:
    columns: [depth m, speed m/s, toward deg]
    rows:
      - [0, 0,80, 90]
      - [200, .nan, 80]
      - [100, 0.05, 60]
line:
  - {use: bal, buoyancy: 35 kg, count: 0}
  - {use: rop-12, length: 480 m, clamps: [{use: metr, at: 20 m}, {use: meter}]}
  - {use: rope-12, clamps: [{use: meter, at: -20 m}]}
  - {use: own, length: -5 m}
components:
  own: {kind: cable, diameter: -8 mm, finish: smoth}
  unused: {kind: spere}
  empty:
environments:
  storm: {curent: {speed: 1 m/s, toward: 90 deg}}
solver: {angle_step: 20 deg, drag: reynold}
checks: {maximum_tilt: 30}
"""
    assert [place[:2] for place in mistakes(text)] == [
        (2, 22),
        (4, 10),
        (8, 9),
        (9, 15),
        (10, 10),
        (12, 11),
        (12, 40),
        (13, 11),
        (13, 49),
        (13, 66),
        (14, 5),
        (14, 46),
        (15, 24),
        (17, 32),
        (17, 47),
        (18, 18),
        (19, 3),
        (21, 11),
        (22, 22),
        (22, 36),
        (23, 24),
    ]


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("microcat", ["sbe37"]),
        ("microkat", ["sbe37"]),
        ("glass balls", ["glass-cluster-4", "glass-cluster-5"]),
        ("dual release", ["release-pair-ar861"]),
        ("wire", ["wire-jacketed-8"]),
        ("glas-cluster-4", ["glass-cluster-4"]),
        ("chain-g30-16", ["chain-short-g30-16"]),
        ("wire-jacketed-9", ["wire-jacketed-8"]),
    ],
)
def test_an_unknown_component_is_searched_by_its_words(
    mistakes: Mistakes, written: str, meant: list[str]
) -> None:
    text = changed("use: rope-12", f"use: {written}")
    ((_, _, message),) = mistakes(text)
    offered = message.partition("did you mean ")[2].rstrip("?").replace(" or ", ", ").split(", ")
    assert {*meant} <= {*offered} and len(offered) <= 3
    assert message.startswith(f"`use: {written}`: no such component; ")


@pytest.mark.parametrize(
    ("line", "messages"),
    [
        (
            "  - {use: nosuch, lenght: 3 m, length: 3 N, depth_rating: 4 kg}",
            ["no such component", "did you mean `length`?", "is a force", "is a mass"],
        ),
        ("  - {use: anchor}", ["anchors are anchor-"]),
        ("  - {use: shackles}", ["did you mean shackle-"]),
        ("  - {use: rope-12, length: 9 m, instruments: []}", ["did you mean `clamps`?"]),
        ("  - {use: rope-12, length: 9 m, wll: 3 kN}", ["did you mean `working_load`?"]),
    ],
)
def test_all_is_said_behind_what_is_not_known(
    mistakes: Mistakes, line: str, messages: list[str]
) -> None:
    text = GOOD.replace("line:\n", f"line:\n{line}\n", 1)
    found = [message for *_, message in mistakes(text)]
    assert len(found) == len(messages)
    assert all(any(part in message for message in found) for part in messages)


@pytest.mark.parametrize(
    ("line", "form"),
    [
        ("position: 48.5", "as `position: {latitude: 48.3 deg, longitude: -5.2 deg}`"),
        ("checks: [1]", "as `checks: {anchor_factor: 1.5, maximum_knockdown: 50 m}`"),
        ("releases: x", "as `releases: [{serial: 1729, codes: {enable: 0A51, release: 0A55}}]`"),
    ],
)
def test_a_message_shows_the_form_that_is_wanted(mistakes: Mistakes, line: str, form: str) -> None:
    assert mistakes(f"{GOOD}{line}\n")[0][2].endswith(form)


def test_tabs_are_all_shown(mistakes: Mistakes) -> None:
    text = GOOD.replace("      - [", "\t- [")
    assert [place[:2] for place in mistakes(text)] == [(7, 1), (8, 1)]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "is empty"),
        (b"# only a comment\n", "is empty"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "is a binary file; text is needed"),
        (b"a: " + b"[" * 1500, "is nested too deeply"),
        (b"a: \x07", "is not valid YAML: unacceptable character #x0007: special characters"),
    ],
)
def test_files_that_are_no_text(mistakes: Mistakes, content: bytes, message: str) -> None:
    [(line, column, found)] = mistakes(content)
    assert (line, column) == (0, 0)
    assert found.startswith(message)


def test_text_that_is_not_utf8(mistakes: Mistakes) -> None:
    text = GOOD.replace("plate}", "plate}  # à plat").encode("latin-1")
    assert mistakes(text) == [(12, 1, "is not UTF-8 text; save it as UTF-8")]


def test_utf8_with_a_byte_order_mark_is_read(read: Callable[..., object]) -> None:
    assert read(b"\xef\xbb\xbf" + GOOD.encode())


def test_alias_bomb_is_refused_at_once(mistakes: Mistakes) -> None:
    bomb = ["a: &a [lol, lol]"]
    bomb += [f"{b}: &{b} [{', '.join([f'*{a}'] * 9)}]" for a, b in pairwise("abcdefghi")]
    found = mistakes("\n".join(bomb))
    assert found[0] == (
        1,
        4,
        "YAML anchors (&) and aliases (*) are not supported; repeat the value",
    )
    assert len(found) == 9


def test_anchor_within_itself(mistakes: Mistakes) -> None:
    [(line, column, _)] = mistakes("line: &a [*a]\n")
    assert (line, column) == (1, 7)


@pytest.mark.thorough
def test_assembly_bomb_is_refused_at_once(mistakes: Mistakes) -> None:
    # Twice as many pieces at each of 40 levels: 10^12, were they made.
    levels = "".join(
        f"  a{i}: {{kind: assembly, parts: [{{use: a{i - 1}}}, {{use: a{i - 1}}}]}}\n"
        for i in range(1, 40)
    )
    text = GOOD.replace("{use: plate}", "{use: a39}") + "components:\n  a0: {kind: assembly, "
    found = mistakes(f"{text}parts: [{{use: plate}}]}}\n{levels}")
    assert found[0][2] == "the line has more than 10000 pieces"


def test_assembly_within_itself(mistakes: Mistakes) -> None:
    text = GOOD + "components:\n  a: {kind: assembly, parts: [{use: b}]}\n"
    text += "  b: {kind: assembly, parts: [{use: a}]}\n"
    assert mistakes(text) == [(16, 37, "assembly `a` contains itself")]


def test_file_of_100_megabytes_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "large.yaml"
    with path.open("wb") as file:
        file.truncate(100_000_000)
    with pytest.raises(InputError, match=r"large.yaml: has a size of 100.0 MB; the limit is 1 MB"):
        read_mooring(path)


def test_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere.yaml: no such file$"):
        read_mooring(tmp_path / "nowhere.yaml")


def test_folder_for_a_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"is a folder; a file is needed$"):
        read_mooring(tmp_path)


@pytest.mark.parametrize("name", ["nul\0.yaml", "long" * 1000])
def test_names_no_file_can_have(name: str) -> None:
    with pytest.raises(InputError, match=r"no such file|cannot be read"):
        read_mooring(name)


def test_device_is_no_file() -> None:
    with pytest.raises(InputError, match="is not a regular file"):
        read_mooring("/dev/null")
