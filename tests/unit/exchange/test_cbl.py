"""Problems of WHOI Cable: the grammar, the macros, the drag, and its own solutions."""

from math import exp, pi
from pathlib import Path

import numpy as np
import pytest
import yaml

from calm.case import load
from calm.errors import InputError, UsageError
from calm.exchange.cbl.formulas import constant
from calm.exchange.importing import import_file
from calm.exchange.model import ImportOptions

PROBLEMS = Path(__file__).parent / "problems"

SMALL = """\
Problem Description
    title = "Small"
    type = subsurface
Environment
    rho = 1025   gravity = 9.81   depth = 100
    x-current = 0.5
Buoys
    ball  type = sphere  d = 1.0  m = 200  Cdn = 0.5
Anchors
    clump  wet = 5000
Connectors
    meter  d = 0.2  wet = 50  m = 10  Cdn = 1.0
Materials
    rope  EA = 1e6  m = 0.3  wet = 2.0  d = 0.01  Cdn = 1.5  Cdt = 0.01
Layout
    terminal = { anchor = clump }
    segment = { length = 50  material = rope  nodes = (51, 1.0) }
    terminal = { buoy = ball }
End
"""


def imported(tmp_path, text, name="m.cbl", **options):
    path = tmp_path / name
    path.write_text(text)
    return import_file(path, tmp_path / "m.yaml", options=ImportOptions(**options))


def solved(tmp_path, made):
    return load(tmp_path / "m.yaml", text=made.text).solve().to_dict()


def mooring(tmp_path, text, **options):
    made = imported(tmp_path, text, **options)
    return load(tmp_path / "m.yaml", text=made.text).file


def refusal(tmp_path, text, **options):
    with pytest.raises(InputError) as error:
        imported(tmp_path, text, **options)
    return str(error.value)


def row(answer, label):
    return next(each for each in answer["components"] if each["label"] == label)


# What WHOI Cable 3.12 finds for the problems in `problems/`: its static relaxation; of the tow, its
# shooting. It prints heights of 1e-5 m; its nodes are 0.25 to 2 m apart.


def test_a_subsurface_mooring_stands_as_there(tmp_path):
    made = import_file(PROBLEMS / "subsurface.cbl", tmp_path / "m.yaml")
    answer = solved(tmp_path, made)
    top, shackle, release = (row(answer, label) for label in ("float", "shackle", "release"))
    assert 300 - top["depth_bottom"] == pytest.approx(245.10111, abs=0.01)
    assert top["x_bottom"] == pytest.approx(8.02705, abs=0.01)
    assert top["tension_bottom"] == pytest.approx(3505.892, abs=0.5)
    assert 300 - shackle["depth_bottom"] == pytest.approx(205.07005, abs=0.01)
    assert shackle["tension_top"] == pytest.approx(3367.929, abs=0.5)
    assert release["tension_top"] == pytest.approx(3056.115, abs=0.5)
    assert answer["anchor"]["tension"] == pytest.approx(2548.557, abs=0.5)
    assert [each["where"] for each in map(vars, made.guessed)] == ["components.clump.weight"]
    loggers = [clamp["depth"] for clamp in answer["clamps"]]
    assert len(loggers) == 5


def test_a_surface_mooring_floats_as_there(tmp_path):
    """The line is 1 m longer than the water is deep: its tension hangs on the last centimetre."""
    answer = solved(tmp_path, import_file(PROBLEMS / "surface.cbl", tmp_path / "m.yaml"))
    assert answer["top"]["draft"] == pytest.approx(200 - 199.46715, abs=0.002)
    assert row(answer, "discus")["x_bottom"] == pytest.approx(23.73253, abs=0.02)
    assert row(answer, "discus")["tension_bottom"] == pytest.approx(2643.12, rel=0.004)
    assert row(answer, "wire")["depth_bottom"] == pytest.approx(200 - 19.46585, abs=0.01)


def test_a_tow_trails_as_there(tmp_path):
    made = import_file(PROBLEMS / "tow.cbl", tmp_path / "m.yaml")
    file = load(tmp_path / "m.yaml", text=made.text)
    assert [piece.use for piece in file.file.pieces] == ["cable", "sled"]
    answer = file.solve().to_dict()
    assert row(answer, "cable")["depth_bottom"] == pytest.approx(302.97874, abs=0.02)
    assert -row(answer, "cable")["x_bottom"] == pytest.approx(377.04588, abs=0.02)
    assert row(answer, "cable")["tension_bottom"] == pytest.approx(6723.909, abs=0.5)
    assert row(answer, "cable")["tension_top"] == pytest.approx(9771.724, abs=0.5)


FORMULAS = {
    "6*0.0254": 0.1524,
    "2 + 3*4 - 1": 13.0,
    "-2*-3": 6.0,
    "2*(3 + 4)": 14.0,
    "8/4/2": 1.0,
    "10 - 4 - 3": 3.0,
    "7 % 4": 3.0,
    "1 + 2 < 4 && 0 || 1": 1.0,
    "1 ? 2 : 3": 2.0,
    "0 ? 1 : 0 ? 2 : 3": 3.0,
    "1 | 2 ^ 2": 1.0,
    "1 << 3 >> 1": 4.0,
    "!0 + !5": 1.0,
    "~0": -1.0,
    "pow(2, 10)": 1024.0,
    "exp(-0.055*10)": exp(-0.55),
    "hypot(3, 4) + fabs(-1)": 6.0,
    "floor(2.7) + ceil(2.1) + fmod(7, 4)": 8.0,
    "PI": pi,
    "1.5e3 + .5": 1500.5,
    "3 == 3": 1.0,
    "3 != 3 || 2 >= 3": 0.0,
}


@pytest.mark.parametrize("formula", FORMULAS)
def test_formulas_bind_as_they_do_there(formula):
    assert constant(formula) == pytest.approx(FORMULAS[formula], rel=1e-12)


@pytest.mark.parametrize(
    "formula", ["1/0", "sqrt(-1)", "pow(10, 1000)", "sin()", "sin(1, 2)", "(1", "1 +", "1 2"]
)
def test_formulas_without_a_value_are_refused(formula):
    with pytest.raises(InputError):
        constant(formula)


@pytest.mark.parametrize(
    ("formula", "says"),
    [
        ("(" * 5000 + "1" + ")" * 5000, "parentheses are nested too deeply"),
        ("-" * 9000 + "1", "too many consecutive signs"),
    ],
)
@pytest.mark.thorough
def test_towers_of_signs_are_refused(formula, says):
    with pytest.raises(InputError, match=says):
        constant(formula)


def test_a_long_sum_does_no_harm():
    with pytest.raises(InputError, match="no value"):
        constant("+".join(["1"] * 20_000))


def test_figures_are_those_of_the_file(tmp_path):
    rope = mooring(tmp_path, SMALL).pieces[1].component
    assert (rope.diameter, rope.cn, rope.ct) == (0.01, 1.5, 0.01)
    assert rope.weight == pytest.approx(2.0)
    assert rope.stiffness == 1e6


def test_a_weight_that_is_missing_follows_from_the_mass(tmp_path):
    rope = mooring(tmp_path, SMALL.replace("wet = 2.0", "")).pieces[1].component
    assert rope.weight == pytest.approx(0.3 * 9.81 - pi / 4 * 0.01**2 * 1025 * 9.81, rel=1e-6)


def test_a_modulus_stands_for_ea(tmp_path):
    text = SMALL.replace("EA = 1e6", "E = 1e10 id = 0.005")
    rope = mooring(tmp_path, text).pieces[1].component
    assert rope.stiffness == pytest.approx(1e10 * pi / 4 * (0.01**2 - 0.005**2), rel=1e-6)


def test_weights_count_in_the_water_of_the_file(tmp_path):
    """Whatever the density, what is in the file is what pulls."""
    light = imported(tmp_path, SMALL.replace("m = 200", "m = 100").replace("1025", "1000"))
    answer = solved(tmp_path, light)
    lift = (1000 * pi / 6 - 100) * 9.81
    top = row(answer, "ball")["tension_bottom"]
    assert top == pytest.approx(
        (lift**2 + (0.5 * 1000 * 0.5 * pi / 4 * 0.25) ** 2) ** 0.5, rel=1e-6
    )
    assert answer["anchor"]["vertical"] == pytest.approx(lift - 2.0 * 50, rel=2e-3)


def test_a_current_by_a_formula_is_a_table_close_enough(tmp_path):
    text = SMALL.replace("x-current = 0.5", "x-current = 0.8*exp(-0.05*H)  y-current = 0.1")
    rows = np.array(
        [yaml.safe_load(line)[0] for line in imported(tmp_path, text).text.splitlines()
         if line.startswith("      - [")]
    )  # fmt: skip
    depth = np.linspace(0.0, 100.0, 301)
    assert np.interp(depth, rows[:, 0], rows[:, 1]) == pytest.approx(
        0.8 * np.exp(-0.05 * depth), abs=2e-4
    )
    assert rows[:, 2] == pytest.approx(0.1)
    assert len(rows) < 100


def test_a_table_goes_on_beyond_its_ends(tmp_path):
    """That program prolongs the last line of a table; one value alone holds at all depths."""
    text = SMALL.replace("x-current = 0.5", 'x-current = {"TIDE"} (20, 0.4) (60, 0.2)')
    made = imported(tmp_path, text).text
    assert "- [0, 0.5, 0]" in made
    assert "- [20, 0.4, 0]" in made
    assert "- [100, 0, 0]" in made


def test_scales_modulations_and_turns_of_a_current(tmp_path):
    text = SMALL.replace(
        "x-current = 0.5",
        "x-current = 0.5 current-scale = 2 current-rotation = pi/2\n"
        "x-current-modulation = t < 10 ? 0.5 : 0",
    )
    assert "- [0, 0, 0.5]" in imported(tmp_path, text).text


def test_attachments_hang_at_their_nodes(tmp_path):
    text = SMALL.replace(
        "nodes = (51, 1.0)",
        "nodes = (11, 0.5) (26, 0.5) attachments = meter : (1 6, 36), meter:[11, 5, 21]",
    )
    (rope,) = (piece for piece in mooring(tmp_path, text).pieces if piece.use == "rope")
    heights = sorted(50.0 - clamp.at for clamp in rope.clamps)
    assert heights == pytest.approx([0.0, 12.5, 25.0, 30.0, 35.0, 50.0])


def test_a_drag_that_changes_with_depth_cuts_the_segment(tmp_path):
    made = imported(tmp_path, SMALL.replace("Cdn = 1.5", "Cdn = (0, 2.0) (100, 1.0)"))
    ropes = [
        piece
        for piece in load("m.yaml", text=made.text).file.pieces
        if piece.component.kind == "cable"
    ]
    assert sum(piece.length for piece in ropes) == pytest.approx(50.0)
    middle = 50.0
    for piece in ropes:  # from the top, which stands at 50 m
        assert piece.component.cn == pytest.approx(
            2.0 - (middle + piece.length / 2) / 100, abs=0.02
        )
        middle += piece.length
    assert len(ropes) == 12
    assert all(
        "guessed: the drag was computed for the depth" in each
        for each in made.text.splitlines()
        if "use: rope" in each
    )


@pytest.mark.parametrize("shape", ["cylinder h = 2.0", "capsule h = 3.0"])
def test_hulls_displace_what_they_do_there(shape, tmp_path):
    text = SMALL.replace("subsurface", "surface").replace("type = sphere", f"type = {shape}")
    text = text.replace("length = 50", "length = 110")
    ball = mooring(tmp_path, text).pieces[0].component
    volume = pi / 4 * 2 if "cylinder" in shape else pi / 6 + pi / 4 * 2
    assert ball.volume == pytest.approx(volume, rel=1e-6)


def test_towed_lines_turn_round_and_ships_at_rest_move(tmp_path):
    text = (PROBLEMS / "tow.cbl").read_text()
    text = text.replace("x-speed = 0.514*4", "x-speed = 0").replace(
        "gravity = 9.81", "gravity = 9.81 x-current = (0, -2.0) (600, -1.0)"
    )
    made = imported(tmp_path, text)
    assert "tow: {speed: 2 m/s, toward: 90 deg}" in made.text
    assert "- [0, 0, 0]" in made.text
    assert "- [500, 0.833333333, 0]" in made.text


@pytest.mark.parametrize("anchor", ["wet = 50", "m = 20", "wet = 50 m = 20", "color = red"])
def test_an_anchor_that_would_be_lifted_holds(anchor, tmp_path):
    made = imported(tmp_path, SMALL.replace("wet = 5000", anchor))
    answer = solved(tmp_path, made)
    assert answer["anchor"]["weight"] >= answer["anchor"]["required_weight"]
    assert [each.where for each in made.guessed] == ["components.clump.weight"]


def test_a_rope_in_inches_is_pointed_out(tmp_path):
    made = imported(tmp_path, SMALL.replace("d = 0.01", "d = 0.375"))
    assert "contradicts mass and weight: one metre" in made.guessed[0].what
    short = SMALL.replace("length = 50", "length = 5").replace("d = 0.01", "d = 0.375")
    assert imported(tmp_path, short).guessed == ()


def test_what_has_no_use_is_listed(tmp_path):
    text = SMALL.replace("EA = 1e6", "EA = 1e6 EI = 20 GJ = 5 am = 0.08")
    text = text.replace("depth = 100", "depth = 100 x-wave = (1, 8, 0) bottom-stiffness = 100")
    told = "\n".join(str(each) for each in imported(tmp_path, text).dropped)
    for word in ("x-wave", "bottom-stiffness", "EI, GJ, am"):
        assert word in told


REFUSED = {
    "branch": (
        "segment = { length = 50",
        "branch = { segment = { length = 5 } } segment = { length = 50",
        "the layout has no `terminal` at the end of a line",
    ),
    "both ends anchored": ("{ buoy = ball }", "{ anchor = clump }", "this line has no segment"),
    "horizontal": ("subsurface", "horizontal", "`type = horizontal`"),
    "drifter": ("subsurface", "drifter", "`type = drifter`"),
    "horizontal drifter": ("subsurface", "horizontal-drifter", "`type = horizontal-drifter`"),
    "deployment": ("subsurface", "deployment", "being laid"),
    "riser": ("subsurface", "riser", "`type = riser`"),
    "platform": ("type = sphere", "type = platform", "platform"),
    "thrust": (
        "{ buoy = ball }",
        "{ buoy = ball x-thrust = 100 }",
        "`x-thrust` is an external force",
    ),
    "loop": ("{ buoy = ball }", "{ buoy = ball node = 5 }", "a loop"),
    "no material": ("material = rope", "material = hemp", "`hemp` is not defined"),
    "no such node": ("(51, 1.0)", "(51, 1.0) attachments = meter : (99)", "nodes 1 to 51"),
    "twice defined": ("Anchors", "spare wet = 1 ball d = 2 Anchors", "`ball` is defined twice"),
    "no depth": ("depth = 100", "", "no `depth`"),
    "an unknown name": ("d = 0.01", "d = DIAMETER", "-D DIAMETER="),
    "an odd sign": ("length = 50", "length = 50 @", "`@` is not allowed"),
    "no end of a block": ("{ buoy = ball }", "{ buoy = ball", "missing before `End`"),
    "no gravity": ("gravity = 9.81", "gravity = 0", "its gravity is 0"),
    "a light sea": ("rho = 1025", "rho = -1", "its density is -1"),
    "no end of a comment": ("Layout", "/* Layout", "a comment is not closed"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_calm_does_not_do_is_refused_by_name(case, tmp_path):
    old, new, message = REFUSED[case]
    told = refusal(tmp_path, SMALL.replace(old, new, 1))
    assert message in told
    assert "m.cbl:" in told


def test_all_macros_that_are_missing_are_named_at_once(tmp_path):
    text = SMALL.replace("d = 0.01", "d = WIDE").replace("length = 50", "length = 2*LONG + MORE")
    told = refusal(tmp_path, text.replace("wet = 2.0", "wet = HEAVY"))
    for name in ("WIDE", "LONG", "MORE", "HEAVY"):
        assert told.count(f"define it by -D {name}=") == 1
    assert len(told.splitlines()) == 4
    given = {"WIDE": "0.01", "LONG": "20", "MORE": "10", "HEAVY": "2.0"}
    made = imported(tmp_path, text.replace("wet = 2.0", "wet = HEAVY"), defines=given)
    assert made.text == imported(tmp_path, SMALL).text


def test_a_macro_without_a_number_ends_the_search_for_others(tmp_path):
    told = refusal(tmp_path, SMALL.replace("d = 0.01", "d = ON"), defines={"ON": "OFF"})
    assert told.count("define it by -D OFF=") == 1


def test_macros_come_from_the_file_and_from_outside(tmp_path):
    text = "#define TWICE(x) (2*(x))\n#ifndef LENGTH\n#define LENGTH 30\n#endif\n" + SMALL.replace(
        "length = 50", "length = TWICE(LENGTH) - 10"
    )
    assert "length: 50 m" in imported(tmp_path, text).text
    assert "length: 70 m" in imported(tmp_path, text, defines={"LENGTH": "40"}).text


def test_conditions_choose(tmp_path):
    text = SMALL.replace(
        "    x-current = 0.5\n",
        "#if defined(STORM) && STORM > 1\n x-current = 1.5\n#elif 0\n x-current = 9\n#else\n"
        " x-current = 0.25\n#endif\n#if 0\n nonsense ( here\n#endif\n",
    )
    assert "- [0, 0.25, 0]" in imported(tmp_path, text).text
    assert "- [0, 1.5, 0]" in imported(tmp_path, text, defines={"STORM": "2"}).text


def test_files_are_included_from_the_folder(tmp_path):
    body, materials = SMALL.split("Materials")
    materials, layout = materials.split("Layout")
    guarded = f"#ifndef ROPES\n#define ROPES\nMaterials{materials}#endif\n"
    (tmp_path / "ropes.inc").write_text(guarded)
    text = f'#include "ropes.inc"\n#include "ropes.inc"\n{body}Layout{layout}'
    assert imported(tmp_path, text).text.count("kind: cable") == 1


def test_files_from_elsewhere_need_leave(tmp_path):
    inside = tmp_path / "inside"
    inside.mkdir()
    (tmp_path / "ropes.inc").write_text("/* nothing */\n")
    text = '#include "../ropes.inc"\n' + SMALL
    assert "lies outside the folder" in refusal(inside, text)
    assert imported(inside, text, allow_include=True).text
    (inside / "link.inc").symlink_to(tmp_path / "ropes.inc")
    assert "lies outside" in refusal(inside, text.replace("../ropes", "link"))


GRID = "1 0 2  20 0 6  100 -50 2  100 -50 2\n"
"""Steps, starts and counts of time, depth, x and y: 2 times, 6 depths, 2 by 2 places."""


def gridded(tmp_path, count=2 * 2 * 2 * 6, head=GRID):
    """Currents that grow by 1 m/s to the east in a time step, fall by 0.1 m/s in 20 m of depth, and
    differ to the north by 0.2 m/s between the two places to the north; upward 0.01 m/s."""
    rows = [
        f"{0.5 - 0.1 * level + time} {0.1 * (2 * north - 1)} 0.01"
        for time in range(2) for north in range(2) for _ in range(2) for level in range(6)
    ]  # fmt: skip
    (tmp_path / "flow.dat").write_text(head + "\n".join(rows[:count]))
    return SMALL.replace("x-current = 0.5", "current-file = flow.dat  x-current-scale = 2")


def test_currents_of_a_file_are_those_at_the_anchor_now(tmp_path):
    made = imported(tmp_path, gridded(tmp_path))
    rows = yaml.safe_load(made.text)["environment"]["current"]["rows"]
    assert rows == [
        [pytest.approx(each) for each in (depth, 2 * (0.5 - 0.005 * depth), 0.0, 0.01)]
        for depth in (0, 20, 40, 60, 80, 100)
    ]
    told = "\n".join(str(each) for each in made.dropped)
    assert "currents after the first time" in told
    assert "horizontal variation" in told
    assert made.guessed == ()


def test_currents_of_a_file_that_is_missing_are_guessed(tmp_path):
    text = gridded(tmp_path)
    (tmp_path / "flow.dat").unlink()
    (guess,) = imported(tmp_path, text).guessed
    assert guess.where == "environment.current"
    assert "`flow.dat` is missing" in guess.what


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"count": 40}, "has 120 speeds, not 144"),
        ({"head": "0 0 2 " + GRID[6:]}, "step, start and count"),
        ({"head": GRID.replace("6", "900000000")}, "more than 2000000 speeds"),
        ({"head": "a b c"}, "contains text"),
        ({"head": GRID + "nan "}, "contains NaN"),
    ],
)
def test_a_file_of_currents_that_makes_no_sense_is_refused(change, message, tmp_path):
    assert message in refusal(tmp_path, gridded(tmp_path, **change))


def test_currents_from_elsewhere_need_leave(tmp_path):
    inside = tmp_path / "inside"
    inside.mkdir()
    text = gridded(tmp_path).replace("flow.dat", '"../flow.dat"')
    assert "lies outside the folder" in refusal(inside, text)
    assert imported(inside, text, allow_include=True).guessed == ()


HOSTILE = {
    "a bomb of macros": "\n".join(
        ["#define A0 1+1", *(f"#define A{i} A{i - 1} A{i - 1} A{i - 1}" for i in range(1, 30))]
    ),
    "a macro of itself": "#define A B\n#define B A",
    "an include of itself": '#include "m.cbl"',
    "an endless condition": "#if 1",
    "conditions within each other": "#if 1\n" * 100,
    "a stray end": "#endif",
}


@pytest.mark.parametrize("case", HOSTILE)
def test_hostile_files_are_refused_at_once(case, tmp_path):
    text = HOSTILE[case] + "\n" + SMALL.replace("length = 50", "length = A29 A")
    assert "Traceback" not in refusal(tmp_path, text)


def test_a_binary_file_is_refused(tmp_path):
    path = tmp_path / "m.cbl"
    path.write_bytes(SMALL.encode() + b"\0\1")
    with pytest.raises(InputError, match="binary"):
        import_file(path, tmp_path / "m.yaml", format="cbl")


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8, 0.95])
def test_a_truncated_file_is_refused(share, tmp_path):
    refusal(tmp_path, SMALL[: int(share * len(SMALL))])


def test_a_macro_needs_a_name(tmp_path):
    with pytest.raises(UsageError):
        imported(tmp_path, SMALL, defines={"2X": "1"})
