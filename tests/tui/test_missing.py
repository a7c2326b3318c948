"""The figures that are not known, as a form: what is asked for, and where it is written."""

import pytest
import yaml

from calm.checks.finding import State
from calm.checks.missing import alternatives
from calm.files.editing import Draft
from calm.report.missing_block import missing_block
from calm.tui.live import judge, judge_fully
from calm.tui.mooring_sheet import figures_sheet, missing_figures, with_figures
from tests.tui.conftest import MOORING

UNKNOWN = MOORING.replace(", depth_rating: 300 m", "")


def missing_by_use(text):
    return {each.use: each for each in missing_figures(judge(text), Draft(text))}


def test_each_component_is_asked_for_once_with_the_rows_that_use_it():
    found = missing_by_use(UNKNOWN)
    assert [field.key for field in found["ball"].fields] == ["depth_rating"]
    keys = ["depth_rating", "working_load", "breaking_load", "max_tilt"]
    assert {field.key for field in found["releaser"].fields} == set(keys)
    assert list(found["releaser"].labels) == ["releaser"]
    targets = found["releaser"].targets
    assert [list(targets[key]) for key in keys] == [[("components", "releaser")]] * 4
    assert list(found["logger"].labels) == ["logger", "deep logger"]
    assert set(found) == {"ball", "logger", "releaser"}  # the anchor is pulled at one end only


def test_of_a_component_of_the_catalogue_the_rows_that_lack_it_get_the_figure():
    clamped = "- {use: aanderaa-thermistor-recorder, at: 10 m}"
    text = MOORING.replace("- {use: logger, at: 10 m}", clamped).replace(
        "  - {use: weight}", "  - {use: aanderaa-thermistor-recorder, count: 2}\n  - {use: weight}"
    )
    found = missing_by_use(text)["aanderaa-thermistor-recorder"]
    rows = {key: list(targets) for key, targets in found.targets.items()}
    assert rows["depth_rating"] == [("line", 1, "clamps", 0), ("line", 3)]
    assert rows["breaking_load"] == [("line", 3)]  # a clamp's would be taken for its grip
    missing = missing_figures(judge(text), Draft(text))
    figures = {
        "aanderaa-thermistor-recorder.depth_rating": "2000 m",
        "aanderaa-thermistor-recorder.working_load": "20 kN",
    }
    made = with_figures(Draft(text), missing, figures, "")
    assert "- {use: aanderaa-thermistor-recorder, at: 10 m, depth_rating: 2000 m}" in made.text
    assert (
        "- {use: aanderaa-thermistor-recorder, count: 2, depth_rating: 2000 m, working_load: 20 kN}"
        in made.text
    )
    assert "aanderaa-thermistor-recorder" not in missing_by_use(made.text)


def test_what_is_filled_in_is_known_then_with_its_source():
    draft = Draft(UNKNOWN)
    missing = missing_figures(judge(UNKNOWN), draft)
    texts = {"ball.depth_rating": "500 m", "releaser.breaking_load": "90 kN"}
    made = with_figures(draft, missing, texts, "test certificate 12")
    assert "depth_rating: 500 m" in made.text and "# carries all" in made.text
    view = judge(made.text)
    component = next(each.component for each in view.file.pieces if each.use == "ball")
    assert component.depth_rating == pytest.approx(500.0)
    assert component.sources == {"depth_rating": "test certificate 12"}
    release = next(each.component for each in view.file.pieces if each.use == "releaser")
    assert release.sources == {"breaking_load": "test certificate 12"}
    known = (("top float", "depth-rating"), ("releaser", "strength"))
    found = [e.state for e in view.findings if (e.component, e.rule) in known]
    assert len(found) >= 2 and State.UNKNOWN not in found


def test_the_form_writes_what_was_typed_and_refuses_what_is_no_figure(drive, folder):
    path = folder / "unknown.yaml"
    path.write_text(UNKNOWN, encoding="utf-8")

    async def story(driver):
        await driver.press("f")
        assert "ball: top float" in driver.screen and "depth rating" in driver.screen
        await driver.type("5 kg")
        await driver.press("ctrl+s")
        assert driver.text == UNKNOWN
        await driver.press("ctrl+u")
        await driver.type("500 m")
        await driver.press("ctrl+s")
        await driver.settle()
        assert "buoyancy: 2000 N, depth_rating: 500 m" in driver.text
        assert "1 value filled in" in driver.screen
        await driver.press("u")
        assert driver.text == UNKNOWN

    drive(story, path)


def test_where_nothing_is_missing_that_is_said(drive, folder):
    known = MOORING
    for old, new in (
        ("diameter: 1 m,", "breaking_load: 90 kN"),
        ("role: release,", "working_load: 50 kN, opening_load: 50 kN"),
        ("role: release,", "max_tilt: 45 deg, depth_rating: 300 m"),
        ("length: 0.3 m,", "max_tilt: 45 deg, depth_rating: 300 m"),
        ("kind: anchor,", "breaking_load: 90 kN"),
    ):
        known = known.replace(old, f"{old} {new},")
    path = folder / "known.yaml"
    path.write_text(known, encoding="utf-8")

    async def story(driver):
        await driver.press("f")
        assert "All component values are present" in driver.screen

    drive(story, path)


def test_the_form_shows_the_class_estimate_of_a_figure():
    estimate = "estimate: {quantity: working_load, value: 20 kN, low: 1 N, source: its like}"
    text = UNKNOWN.replace("role: release,", f"role: release, {estimate},")
    (found,) = (one for one in missing_figures(judge(text), Draft(text)) if one.use == "releaser")
    assert found.estimates == {"working_load": "estimated: at least 1.00 N, probably 20.00 kN"}
    takes = {each.key: each.takes for each in figures_sheet([found])._form_fields}
    assert takes["releaser.working_load"] == "estimated: at least 1.00 N, probably 20.00 kN"


def test_the_form_asks_for_what_the_block_asks_for():
    """Both name the figure that is missing and those that would do in its place."""
    view = judge_fully(judge(UNKNOWN))
    block = yaml.safe_load(missing_block(view.findings, {}))["components"]
    missing_by_use = {each.use: each for each in missing_figures(view, Draft(UNKNOWN))}
    assert missing_by_use.keys() == block.keys()
    for use, keys in block.items():
        assert {field.key for field in missing_by_use[use].fields} == {
            instead for key in keys for instead in alternatives(key)
        }


def test_a_part_of_an_assembly_gets_its_figure_in_the_row_of_that():
    recorder = "aanderaa-thermistor-recorder"
    frame = f"  frame: {{kind: assembly, parts: [{{use: {recorder}, label: recorder}}]}}\n"
    text = MOORING.replace("  - {use: weight}", "  - {use: frame}\n  - {use: weight}") + frame
    missing = missing_figures(judge(text), Draft(text))
    (found,) = (one for one in missing if one.use == recorder)
    assert list(found.targets["depth_rating"]) == [("line", 3)]
    made = with_figures(Draft(text), missing, {f"{recorder}.depth_rating": "500 m"}, "sheet 7")
    assert "- {use: frame, depth_rating: 500 m, sources: {depth_rating: sheet 7}}" in made.text
    found = next(each.component for each in judge(made.text).file.pieces if each.use == recorder)
    assert found.depth_rating == pytest.approx(500.0)
    assert found.sources["depth_rating"] == "sheet 7"
