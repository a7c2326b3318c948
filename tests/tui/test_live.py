"""The figures while a file is edited are those of `calm run` and `calm check` of the same text."""

from pathlib import Path

import pytest

import calm
from calm.case import Design, Result
from calm.checks.assess import RULES
from calm.checks.design_check import assessment_of, environments_checked
from calm.checks.finding import AS_GIVEN, State
from calm.checks.wave_rules import IN_WAVES
from calm.cli.reading import read_designs
from calm.errors import NoEquilibrium
from calm.files import Place
from calm.tui.live import judge, judge_fully

LINES = Path(__file__).resolve().parents[2] / "lines"
MOORINGS = ("deep-current-meters", "fit-top-depth", "taut-nylon-surface", "s1000")
ENVIRONMENT = "environment: {depth: 500 m, current: {speed: 0.4 m/s, toward: 90 deg}}\n"
FLOAT = "  - {use: sphere-steel-1250, label: top}\n"
WIRE = "  - {use: wire-jacketed-8, label: wire, length: 300 m, clamps: [{use: sbe37, at: 10 m}]}\n"
GLASS = "  - {use: glass-17in, count: 2}\n"
ANCHOR = "  - {use: anchor-wheels-4}\n"


def line(*items: str) -> str:
    return f"{ENVIRONMENT}line:\n{''.join(items)}"


WHOLE = line(FLOAT, WIRE, GLASS, ANCHOR)


def text_of(name: str) -> str:
    return (LINES / f"{name}.yaml").read_text(encoding="utf-8")


def figures(result) -> dict[str, tuple[float, ...]]:
    found = {
        row.label: (row.cut_length, row.depth_top, row.tension, row.tilt)
        for row in result.components
    }
    return found | {row.label: (None, row.depth, row.tension, row.tilt) for row in result.clamps}


@pytest.mark.parametrize(
    "name",
    [
        *MOORINGS,
        pytest.param("a-frame-sheared-tow", marks=pytest.mark.thorough),
        "helicopter-bird",
    ],
)
def test_rows_are_those_of_run(name: str) -> None:
    path = LINES / f"{name}.yaml"
    view, result = judge(text_of(name), path), calm.load(path).solve()
    assert view.problems == () and view.missing == () and view.failure is None
    assert view.anchored
    shown = ("depth", "tension", "tilt")
    rows = {row.label: (row.length, *(row.figures[name] for name in shown)) for row in view.rows}
    # the same path is taken, so to the last digit
    assert rows == figures(result)


@pytest.mark.parametrize(
    "name",
    [MOORINGS[0], *(pytest.param(name, marks=pytest.mark.thorough) for name in MOORINGS[1:])],
)
def test_findings_are_those_of_check(name: str) -> None:
    path = LINES / f"{name}.yaml"
    view, mooring = judge(text_of(name), path), calm.load(path)
    (stand,) = environments_checked(mooring, mooring.file.name)
    in_waves = {rule.name for rule in IN_WAVES}  # with the whole check alone: a sea takes seconds
    assert view.findings == tuple(
        each for each in stand.findings if each.situation == AS_GIVEN and each.rule not in in_waves
    )
    assert not view.complete
    fully = judge_fully(view)
    (design,), _ = read_designs([path], None, [], 1)  # in each of its environments
    stands = [one for each in design.moorings for one in environments_checked(each, design.name)]
    assessment = assessment_of(design.name, stands)
    assert [each.environment for each in fully.cases] == [each.environment for each in stands]
    assert fully.complete and fully.findings == tuple(assessment.all_findings())
    assert judge_fully(fully) is fully


def test_a_row_has_the_gravest_state_and_the_greatest_use_of_its_findings() -> None:
    view = judge(text_of("deep-current-meters"))
    for row in view.rows:
        own = [finding for finding in view.findings if finding.component == row.label]
        assert row.state == max((f.state for f in own), key=lambda s: s.severity, default=None)
        uses = [f.utilisation for f in own if f.utilisation is not None]
        assert row.use == max(uses, default=None)
    assert any(row.state is State.PASS and row.use is not None for row in view.rows)
    assert any(row.state is None for row in view.rows) or len(view.findings) > len(view.rows)


def test_rows_know_their_item_and_clamp() -> None:
    view = judge(WHOLE)
    assert [(row.place, row.label) for row in view.rows] == [
        (Place(0), "top"),
        (Place(1), "wire"),
        (Place(1, clamp=0), "sbe37"),
        (Place(2), "glass-17in 1"),
        (Place(2, repeat=1), "glass-17in 2"),
        (Place(3), "anchor-wheels-4"),
    ]


def test_an_assembly_is_one_item() -> None:
    own = "components:\n  pack: {kind: assembly, parts: [{use: glass-17in}, {use: shackle-13}]}\n"
    view = judge(line(FLOAT, WIRE, "  - {use: pack, count: 2}\n", ANCHOR) + own)
    assert [row.place.row.item for row in view.rows] == [0, 1, 1, 2, 2, 2, 2, 3]
    pieces = [(row.place.repeat, row.place.part) for row in view.rows if row.place.item == 2]
    assert pieces == [(0, 0), (0, 1), (1, 0), (1, 1)]


def test_a_named_environment_is_that_of_run() -> None:
    text = WHOLE + "environments: {storm: {current: {speed: 0.9 m/s, toward: 45 deg}}, calm: {}}\n"
    own, storm = judge(text), judge(text, environment="storm")
    assert own.environments == storm.environments == ("storm", "calm")
    assert storm.result.top.knockdown > 2.0 * own.result.top.knockdown
    assert {finding.environment for finding in storm.findings} == {"storm"}
    assert "no environment is called `stom`" in judge(text, environment="stom").problems[0].message


def test_what_the_file_names_is_looked_for_beside_it(tmp_path: Path) -> None:
    (tmp_path / "now.csv").write_text("depth[m],u[m/s],v[m/s]\n0,0.5,0\n500,0.1,0\n")
    text = WHOLE.replace("{speed: 0.4 m/s, toward: 90 deg}", "{file: now.csv}")
    path = tmp_path / "mooring.yaml"
    assert judge(text, path).result is not None
    assert "no such file" in judge(text, tmp_path / "sub" / "m.yaml").problems[0].message
    path.write_text(text)
    assert figures(judge(text, path).result) == figures(calm.load(path).solve())


@pytest.mark.parametrize(
    ("text", "missing"),
    [
        ("name: new\n", ("no line", "no environment")),
        (f"{ENVIRONMENT}line:\n", ("no line",)),
        (f"{ENVIRONMENT}line: []\n", ("no line",)),
        ("line:\n" + FLOAT + WIRE + ANCHOR, ("no environment",)),
        ("environment: {}\nline:\n" + FLOAT + WIRE + ANCHOR, ("no depth",)),
        (line(FLOAT, "  - {use: wire-jacketed-8}\n", ANCHOR), ("no length on wire-jacketed-8",)),
        (line(FLOAT, "  - {use: polyester-14, label: rope, length: }\n", ANCHOR),
         ("no length on rope",)),
        (line(FLOAT, "  - {use: polyester-14, length: fit}\n", ANCHOR),
         ("no top depth on polyester-14",)),
        (line(FLOAT, WIRE.replace(", at: 10 m", ""), ANCHOR), ("no place on sbe37",)),
        (line(FLOAT, "  - {label: new}\n", ANCHOR), ("no component chosen",)),
        (line(ANCHOR), ("nothing above the anchor",)),
        (line(FLOAT, WIRE), ("no anchor",)),
        (line(WIRE, ANCHOR), ("no float",)),
        (line(WIRE), ("no float", "no anchor")),
        ("tow: {speed: 2 m/s}\nline: [{use: wire-jacketed-8, length: 9 m}]\n", ("no toward",)),
    ],
)  # fmt: skip
def test_what_is_missing_is_said_in_plain_words(text: str, missing: tuple[str, ...]) -> None:
    view = judge(text)
    assert view.problems == ()
    assert set(view.missing) == set(missing)
    assert (view.result is None) == (missing != ("no anchor",))


def test_a_line_without_an_anchor_stands_on_one_that_holds_anything() -> None:
    without, whole = judge(line(FLOAT, WIRE, GLASS)), judge(WHOLE)
    assert not without.anchored and without.missing == ("no anchor",)
    # an anchor without height: the line stands as much lower
    height = calm.files.Catalogue.shipped().get("anchor-wheels-4").length
    assert [row.label for row in without.rows] == [row.label for row in whole.rows[:-1]]
    for row, with_anchor in zip(without.rows, whole.rows, strict=False):
        mine, other = row.figures, with_anchor.figures
        assert mine["depth"] == pytest.approx(other["depth"] + height, abs=0.02)
        assert mine["tension"] == pytest.approx(other["tension"], rel=1e-3)
    rules = {finding.rule for finding in without.findings}
    assert "strength" in rules and not {rule for rule in rules if RULES[rule].of_anchor}
    assert {rule for rule in RULES if RULES[rule].of_anchor} == {
        "anchor-weight", "anchor-uplift", "anchor-sliding",
    }  # fmt: skip
    assert {finding.component for finding in without.findings} <= {
        None, *(row.label for row in without.rows),
    }  # fmt: skip
    assert without.result.anchor.required_weight == pytest.approx(
        whole.result.anchor.required_weight, rel=1e-3
    )
    fully = judge_fully(without)
    assert fully.findings == without.findings and not fully.complete
    assert {each.when for each in fully.held} == {"", "still water", "strumming"}
    assert max(each.needed(without.file.anchor) for each in fully.held) == pytest.approx(
        max(each.limit for each in judge_fully(whole).tighter if each.rule == "anchor-weight"),
        rel=1e-3,
    )


def test_a_line_without_a_float_has_its_rows_without_figures() -> None:
    view = judge(line(WIRE, ANCHOR))
    assert [(row.label, row.length, row.figures) for row in view.rows[:2]] == [
        ("wire", 300.0, {}),
        ("sbe37", None, {}),
    ]


def test_what_is_wrong_stands_apart_from_what_is_missing() -> None:
    view = judge(
        line("  - {use: sphere-stel-1250}\n", "  - {use: wire-jacketed-8}\n", ANCHOR), "m.yaml"
    )
    assert [(p.line, "did you mean" in p.message) for p in view.problems] == [(3, True)]
    assert view.missing == ("no length on wire-jacketed-8",)
    assert view.rows == () and view.result is None


@pytest.mark.parametrize(
    "text", ["", "\n", "a: [", "- 1", "\t", "\0", "name: &a x", "line: 3", "{"]
)
def test_a_broken_text_has_problems_or_lacks_something(text: str) -> None:
    view = judge(text)
    assert view.problems or view.missing


def test_a_line_that_does_not_stand_tells_why() -> None:
    view = judge(line(FLOAT, WIRE, ANCHOR.replace("4}", "4, mass: 1 kg}")))
    assert isinstance(view.failure, NoEquilibrium)
    assert [finding.rule for finding in view.findings] == ["equilibrium"]
    assert [row.figures for row in view.rows] == [{}] * 4


def test_a_failure_of_calm_itself_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(self: Design) -> Result:
        raise ZeroDivisionError("so")

    monkeypatch.setattr(Design, "solve", broken)
    assert judge(WHOLE).failure.status == "internal-error"


@pytest.mark.usefixtures("own_memory")
def test_what_has_not_changed_is_not_solved_again(monkeypatch: pytest.MonkeyPatch) -> None:
    import calm.case.leg as case

    solved = []
    solve = case.solve_mooring

    def counted(line, water, settings):
        solved.append(water.moving)
        return solve(line, water, settings)

    monkeypatch.setattr(case, "solve_mooring", counted)
    view = judge(WHOLE)
    assert solved == [True, False]
    solved.clear()
    view = judge(WHOLE.replace("label: top", "label: big float"), keep=view)
    assert view.rows[0].label == "big float" and "depth" in view.rows[0].figures
    assert solved == []
    stronger = judge(WHOLE.replace("0.4 m/s", "0.5 m/s"), keep=view)
    assert solved == [True]  # still water is as it was
    assert figures(stronger.result) == figures(judge(stronger.text).result)
    solved.clear()
    assert judge(WHOLE, keep=stronger).rows == judge(WHOLE).rows
    assert solved == [True, False]  # those of the last, which kept nothing


def test_live_needs_no_screen() -> None:
    import subprocess
    import sys

    code = "import sys, calm.tui.live; sys.exit('textual' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
