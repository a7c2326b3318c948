"""Sizing, on a float on a line without mass or drag: tan(theta) = D/B, the rest follows."""

import json
from math import acos, asin, ceil, radians, sqrt, tan

import pytest

import calm
from calm.case.size import size
from calm.errors import UsageError

DRAG = 300.0
LENGTH = 100.0

FILE = """
environment: {{depth: 200 m, current: {{speed: 1 m/s, toward: 90 deg}}}}
line:
  - {{use: ball, label: float, buoyancy: {buoyancy}, kn: 300 N/(m/s)^2}}
  - {{use: ball, label: glass, count: {count}, buoyancy: 50 N}}
  - {{use: thread, length: {length}, clamps: [{{use: ball, label: CTD, at: 30 m}}]}}
  - {{use: block}}
components:
  ball: {{kind: body, length: 0 m, buoyancy: 0 N, kn: 0 N/(m/s)^2, inclination: insensitive}}
  thread: {{kind: cable, diameter: 1 mm, weight: 0 N/m, cn: 0, ct: 0}}
  block: {{kind: anchor, weight: {anchor}}}
"""


@pytest.fixture
def mooring(tmp_path):
    def load(
        buoyancy="800 N", count=2, length="100 m", anchor="9 kN", change=("", ""), components=""
    ):
        path = tmp_path / "m.yaml"
        text = FILE.format(buoyancy=buoyancy, count=count, length=length, anchor=anchor)
        path.write_text(text.replace(*change) + components)
        return calm.load(path)

    return load


def test_buoyancy_for_a_knockdown(mooring):
    sizing = size(mooring(), "knockdown(top) <= 2 m", "float.buoyancy")
    # L (1 - cos(theta)) = 2 m; 100 N are the glass's
    exact = DRAG / tan(acos(1.0 - 2.0 / LENGTH)) - 100.0
    assert sizing.status == "met"
    assert sizing.before.value == 800.0
    # rounded away from the start to six digits
    assert exact * (1.0 - 1e-7) <= sizing.after.value <= exact * (1.0 + 1e-5)
    assert sizing.after.measured <= 2.0
    assert sizing.after.measured == pytest.approx(2.0, rel=1e-4)
    assert sizing.steady


def test_the_answer_holds_in_a_changed_file(mooring):
    sizing = size(mooring(), "excursion(top) <= 20 m", "float.buoyancy")
    there = mooring(buoyancy=f"{sizing.after.value!r} N").solve()
    assert there.top.x <= 20.0
    assert there.top.x == pytest.approx(sizing.after.measured, rel=1e-9)
    assert there.anchor.tension == pytest.approx(sizing.after.figures.tension, rel=1e-9)


@pytest.mark.parametrize(
    ("target", "change", "exact"),
    [
        ("tilt(thread) <= 10 deg", "float.buoyancy", DRAG / tan(radians(10)) - 100.0),
        ("tension(block) <= 600 N", "float.buoyancy", sqrt(600.0**2 - DRAG**2) - 100.0),
        ("required_weight <= 1500 N", "float.buoyancy", 1500.0 / 1.5 - DRAG / 0.6 - 100.0),
        ("excursion <= 20 m", "thread.length", 20.0 * sqrt(900.0**2 + DRAG**2) / DRAG),
        ("depth(top) <= 90 m", "thread.length", 110.0 * sqrt(900.0**2 + DRAG**2) / 900.0),
        ("tilt(thread) <= 10 deg", "glass.buoyancy", 0.5 * (DRAG / tan(radians(10)) - 800.0)),
        ("tension(block) >= 2 kN", "CTD.buoyancy", sqrt(2000.0**2 - DRAG**2) - 900.0),
    ],
)
def test_targets_and_changes_in_closed_form(mooring, target, change, exact):
    between = ("0 N", "5 kN") if change.startswith("CTD") else None
    sizing = size(mooring(), target, change, between)
    assert sizing.status == "met"
    # six digits, and 1e-7 of the depth from the solver
    assert sizing.after.value == pytest.approx(exact, rel=2e-5)


def test_equality_from_either_side(mooring):
    for buoyancy in ("500 N", "3 kN"):
        sizing = size(mooring(buoyancy=buoyancy), "depth(CTD) = 131 m", "float.buoyancy")
        assert sizing.status == "met"
        assert sizing.after.measured == pytest.approx(131.0, abs=1e-5)
        # 70 m of line below the CTD rise to 69 m
        exact = DRAG / tan(acos(69.0 / 70.0)) - 100.0
        assert sizing.after.value == pytest.approx(exact, rel=1e-5)


def test_count_is_the_least_whole_number(mooring):
    sizing = size(mooring(), "tilt(thread) <= 8 deg", "glass.count")
    exact = (DRAG / tan(radians(8)) - 800.0) / 50.0
    assert sizing.after.value == ceil(exact)
    labels = sizing.after.result.components.label
    assert labels[:3] == ["float", "glass 1", "glass 2"]
    assert labels.count("thread") == 1
    assert len(labels) == ceil(exact) + 3
    there = mooring(count=int(sizing.after.value)).solve()
    assert there.components.label == labels
    assert there.anchor.tension == pytest.approx(sizing.after.figures.tension, rel=1e-9)


def test_one_of_several_may_be_changed(mooring):
    both = size(mooring(), "tilt(thread) <= 17 deg", "glass.buoyancy")
    one = size(mooring(), "tilt(thread) <= 17 deg", "glass 2.buoyancy")
    assert one.after.value - 50.0 == pytest.approx(2.0 * (both.after.value - 50.0), rel=1e-3)
    assert both.change.labels == ("glass 1", "glass 2")


def test_fewer_of_a_kind_end_without_a_number(mooring):
    sizing = size(mooring(count=30), "required_weight <= 2 kN", "glass.count")
    # 2 kN = 1.5 (800 N + n 50 N + D/0.6): two thirds of one
    assert sizing.status == "not-met"
    assert sizing.message.startswith("glass.count was tried from 1 to 1000. ")
    assert "with glass.count at 1." in sizing.message
    kept = size(mooring(count=30), "required_weight <= 2100 N", "glass.count")
    assert kept.after.value == 2.0
    single = size(mooring(count=30), "required_weight <= 2030 N", "glass.count")
    assert single.after.result.components.label[:3] == ["float", "glass", "thread"]


def test_nothing_to_change(mooring):
    sizing = size(mooring(), "knockdown(top) <= 50 m", "float.buoyancy")
    assert sizing.status == "met-already"
    assert sizing.after.value == sizing.before.value
    assert sizing.solves == 1
    assert sizing.notes == ()


def test_a_target_beyond_the_anchor(mooring):
    sizing = size(mooring(anchor="2 kN"), "knockdown(top) <= 1 m", "float.buoyancy")
    assert sizing.status == "not-met"
    assert sizing.after is None
    # 2 kN under the line, 100 N of them held by the glass; found to 1e-7 of the range of 80 kN
    best = DRAG / 2000.0
    nearest = LENGTH * (1.0 - 1.0 / sqrt(1.0 + best**2))
    assert f"The closest result is {nearest:.4g}" in sizing.message
    assert "float.buoyancy at 1900 N" in sizing.message or "1899.9" in sizing.message
    assert " N: anchor-lifts: The vertical load of the line is" in sizing.message
    assert ". Above 1" in sizing.message
    assert "--between" in sizing.advice


def test_a_range_that_ends_too_soon(mooring):
    sizing = size(mooring(), "knockdown(top) <= 1 m", "float.buoyancy", ("800 N", "1 kN"))
    assert sizing.status == "not-met"
    assert sizing.message.startswith(
        "float.buoyancy was tried from 800 N to 1000 N. The closest result is "
    )
    assert "with float.buoyancy at 1000 N." in sizing.message


def test_a_change_that_does_nothing(mooring):
    sizing = size(mooring(), "tension(block) >= 2 kN", "thread.length")
    assert sizing.status == "not-met"
    assert "The present value gives the closest result, 948.683 N." in sizing.message


def test_a_mooring_without_equilibrium_can_be_mended(mooring):
    sinking = ("label: CTD, at: 30 m", "label: CTD, at: 30 m, buoyancy: -2 kN")
    sizing = size(mooring(change=sinking), "tilt(thread) <= 30 deg", "float.buoyancy")
    assert sizing.before.failure.status == "no-equilibrium"
    assert sizing.status == "met"
    assert sizing.after.measured <= 30.0
    with pytest.raises(UsageError, match="write <= or >="):
        size(mooring(change=sinking), "tilt(thread) = 30 deg", "float.buoyancy")


def test_a_quantity_that_goes_up_and_down_is_told(mooring):
    # the current is fastest where the float is: shorter or longer, it leans less
    current = (
        "{speed: 1 m/s, toward: 90 deg}",
        "{columns: [depth m, u m/s, v m/s], rows: [[0, 0, 0], [100, 1, 0], [200, 0, 0]]}",
    )
    sizing = size(mooring(change=current), "tilt(thread) <= 14 deg", "thread.length")
    assert sizing.status == "met"
    assert not sizing.steady
    assert "other values may meet the target too" in sizing.notes[-1]


def test_a_piece_cut_to_fit_is_cut_anew(mooring):
    fit = ("length: 100 m", "length: fit, top_depth: 100 m")
    sizing = size(mooring(change=fit), "knockdown(top) <= 2 m", "float.buoyancy")
    exact = DRAG / tan(acos(1.0 - 2.0 / LENGTH)) - 100.0
    assert sizing.after.value == pytest.approx(exact, rel=2e-5)


def test_the_drag_stays_and_that_is_said(mooring):
    sizing = size(mooring(), "knockdown(top) <= 2 m", "float.buoyancy")
    assert "size, drag and mass do not" in sizing.notes[0]
    assert sizing.after.figures.horizontal == pytest.approx(DRAG, rel=1e-9)


def test_top_is_the_first_piece_whatever_is_counted(mooring):
    upside = (
        "  - {use: ball, label: float, buoyancy: 800 N, kn: 300 N/(m/s)^2}\n"
        "  - {use: ball, label: glass, count: 2, buoyancy: 50 N}\n",
        "  - {use: ball, label: glass, count: 2, buoyancy: 50 N}\n"
        "  - {use: ball, label: float, buoyancy: 800 N, kn: 300 N/(m/s)^2}\n",
    )
    sizing = size(mooring(change=upside), "excursion(top) <= 20 m", "glass.count")
    assert sizing.after.value == ceil((DRAG / tan(asin(0.2)) - 800.0) / 50.0)


def test_the_document_is_plain_json(mooring):
    for limit in ("2 m", "50 m", "0.0001 m"):
        document = size(mooring(), f"knockdown(top) <= {limit}", "float.buoyancy").to_dict()
        assert json.loads(json.dumps(document, allow_nan=False)) == document
    assert set(document) >= {"status", "target", "change", "before", "after", "message", "advice"}
    assert document["status"] == "not-met"
    assert document["after"] is None
    assert document["before"]["value"] == 800.0


@pytest.mark.parametrize(
    ("target", "change", "between", "told"),
    [
        ("knokdown(top) <= 2 m", "float.buoyancy", None, "did you mean `knockdown`?"),
        ("<= 2 m", "float.buoyancy", None, "the quantity is missing; allowed: depth, "),
        (
            "knockdown(top) 2 m",
            "float.buoyancy",
            None,
            "the relation is missing; write <=, >= or =",
        ),
        (
            "knockdown(top) < 2 m",
            "float.buoyancy",
            None,
            "`<` is not a relation; write <=, >= or =",
        ),
        ("knockdown(top) <=", "float.buoyancy", None, "the limit is missing"),
        ("knockdown(top) <= 2", "float.buoyancy", None, "`2` needs a unit: `2 m`?"),
        ("knockdown(top) <= 2 kg", "float.buoyancy", None, "`2 kg` is a mass; a length"),
        ("tilt(CDT) <= 2 deg", "float.buoyancy", None, "did you mean `CTD`?"),
        ("tilt(glass) <= 2 deg", "float.buoyancy", None, "2 parts have the label `glass`"),
        ("required_weight(top) <= 2 N", "float.buoyancy", None, "omit the brackets"),
        (
            "tilt <= 2 deg",
            "float",
            None,
            "the field to change is missing; allowed: buoyancy, count",
        ),
        ("tilt <= 2 deg", "float.bouyancy", None, "did you mean `buoyancy`?"),
        ("tilt <= 2 deg", "flaot.buoyancy", None, "did you mean `float`?"),
        ("tilt <= 2 deg", "block.buoyancy", None, "an anchor has a weight instead of a buoyancy"),
        (
            "tilt <= 2 deg",
            "float.length",
            None,
            "only the length of cables and chains can be changed",
        ),
        ("tilt <= 2 deg", "CTD.count", None, "clamped instruments have no count"),
        ("tilt <= 2 deg", "block.count", None, "a line has exactly one anchor"),
        ("tilt <= 2 deg", "CTD.buoyancy", None, "CTD.buoyancy is 0; set its range with --between"),
        ("tilt(glass 1) <= 2 deg", "glass.count", None, "set the target for another part"),
        ("tilt(thread) = 2 deg", "glass.count", None, "glass.count changes in steps"),
        ("tilt <= 2 deg", "float.buoyancy", ("1 m", "2 N"), "`1 m` is a length; a force"),
        ("tilt <= 2 deg", "float.buoyancy", ("3 N", "2 N"), "3 N must be below 2 N"),
        ("tilt <= 2 deg", "thread.length", ("20 m", "90 m"), "`20 m` must be at least 30 m"),
        ("tilt <= 2 deg", "glass.count", ("1", "2.5"), "a count must be a whole number"),
    ],
)
def test_mistakes(mooring, target, change, between, told):
    with pytest.raises(UsageError) as caught:
        size(mooring(), target, change, between)
    assert told in str(caught.value)


def test_a_caret_stands_under_each_mistake(mooring):
    with pytest.raises(UsageError) as caught:
        size(mooring(), "tilt(CDT) <= 2 deg", "float.bouyancy")
    assert str(caught.value).splitlines() == [
        "--target: no part of the line has the label `CDT`; did you mean `CTD`?",
        "  tilt(CDT) <= 2 deg",
        "       ^",
        "--change: unknown field `bouyancy`; did you mean `buoyancy`?",
        "  float.bouyancy",
        "        ^",
    ]


PAIR = """\
  pair: {kind: assembly, parts: [{use: ball, label: upper, buoyancy: BUOYANCY}, {use: ball}]}
"""
GLASS = "{use: ball, label: glass, count: 2, buoyancy: 50 N}"


@pytest.mark.parametrize(
    ("item", "change", "told"),
    [
        ("{use: pair}", "ball.count", "give the assembly a `label` in the file"),
        ("{use: pair, label: glass}", "glass ball.count", "change `glass.count`"),
        ("{use: pair, label: glass, count: 3}", "glass ball 2.count", "change `glass.count`"),
        ("{use: pair, label: glass, count: 3}", "glass.length",
         "an assembly has no length; change its count, or change one of the parts `glass upper`, "
         "`glass ball`"),
    ],
)  # fmt: skip
def test_an_assembly_is_counted_as_a_whole(mooring, item, change, told):
    loaded = mooring(change=(GLASS, item), components=PAIR.replace("BUOYANCY", "9 N"))
    with pytest.raises(UsageError) as caught:
        size(loaded, "tilt(thread) <= 2 deg", change)
    assert told in str(caught.value)


@pytest.mark.parametrize("count", [1, 3])
def test_the_count_of_an_assembly_is_found_by_the_label_of_its_item(mooring, count):
    """As many pairs of 50 N as reduce the tilt of a float of 800 N, like single floats of 50 N."""

    def pairs(count):
        item = f"{{use: pair, label: glass, count: {count}}}"
        components = PAIR.replace("BUOYANCY", "50 N")
        return mooring(change=(GLASS, item), components=components)

    sizing = size(pairs(count), "tilt(thread) <= 15 deg", "glass.count")
    single = size(mooring(), "tilt(thread) <= 15 deg", "glass.count")
    assert sizing.before.value == count and sizing.status == "met"
    assert sizing.after.value == single.after.value > 3
    there = pairs(int(sizing.after.value)).solve()
    labels = [row.label for row in sizing.after.result.components]
    assert labels == [row.label for row in there.components]
    assert sizing.after.measured == pytest.approx(
        next(row.tilt for row in there.components if row.label == "thread")
    )


@pytest.mark.parametrize("change", ["block.weight", "anchor.weight", "block.buoyancy"])
def test_the_weight_of_an_anchor_follows_from_its_load(mooring, change):
    with pytest.raises(UsageError, match="`calm run` prints this weight for one environment"):
        size(mooring(), "tilt(thread) <= 2 deg", change)


def test_a_word_of_a_label_is_enough_for_its_suggestion(mooring):
    labelled = mooring(change=("label: CTD", "label: CTD 450 m"))
    with pytest.raises(UsageError, match="did you mean `CTD 450 m`"):
        size(labelled, "tilt(CTD) <= 2 deg", "float.buoyancy")


def test_a_piece_cut_to_fit_has_no_length_to_change(mooring):
    fit = mooring(change=("length: 100 m", "length: fit, top_depth: 100 m"))
    with pytest.raises(UsageError, match="set a length in the file first"):
        size(fit, "tilt(thread) <= 2 deg", "thread.length")
