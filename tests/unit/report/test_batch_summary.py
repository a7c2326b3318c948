"""The statistics of a batch as JSON, as a table and as a page."""

import io
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

import calm
from calm.batch.statistics.summary import RANKED, RESPONSES, summarize
from calm.case import Design
from calm.errors import UsageError
from calm.report import folder
from calm.report.batch_page import summary_html, summary_part, summary_paths, write_summary
from calm.report.batch_summary import percent, summary_document
from calm.report.result_files import to_json
from calm.report.terminal import shown
from calm.shipped import shipped_folder
from tests.judged import hostile_file
from tests.unit.batch.made_result import make_result, stormy

DAYS = round(12 * 365.25)


@pytest.fixture(scope="module")
def mooring():
    return calm.load(shipped_folder("lines") / "upward-adcp-300m.yaml")


@pytest.fixture(scope="module")
def made(mooring):
    return stormy(mooring, DAYS, step="24h", status=3 * (np.arange(DAYS) % 101 == 3))


@pytest.fixture(scope="module")
def summary(mooring, made):
    return summarize(made, mooring)


@pytest.fixture(scope="module")
def fallen(mooring):
    """One in ten profiles has no equilibrium."""
    return summarize(stormy(mooring, 200, status=np.arange(200) % 10 == 3), mooring)


@pytest.fixture(scope="module")
def short(mooring):
    return summarize(stormy(mooring, 50), mooring)


@pytest.fixture(scope="module")
def nothing(mooring):
    labels = tuple(piece.label for piece in mooring.file.pieces)
    clamps = tuple(clamp.label for piece in mooring.file.pieces for clamp in piece.clamps)
    return summarize(make_result(4, status=[1] * 4, labels=labels, clamps=clamps), mooring)


def table(summary, width=80):
    stream = io.StringIO()
    Console(file=stream, width=width).print(shown(summary_part(summary)))
    return stream.getvalue()


def test_the_document_is_strict_json_and_says_all(summary):
    text = to_json([summary_document(summary)])
    said = json.loads(text, parse_constant=pytest.fail)
    assert said["calm"] == calm.__version__
    assert said["input_sha256"] == "0" * 64
    lost = sum(day % 101 == 3 for day in range(DAYS))
    assert said["profiles"]["statuses"] == {"converged": DAYS - lost, "no-current": lost}
    assert (said["profiles"]["solved"], said["profiles"]["no_data"]) == (DAYS - lost, lost)
    assert said["profiles"]["no_equilibrium"] == said["profiles"]["not_converged"] == 0
    assert said["profiles"]["begin"] == "2001-01-01T00:00:00Z"
    first = said["components"][0]
    assert first["knockdown"].keys() == {
        "count", "mean", "p50", "p90", "p99", "p99.9", "maximum", "time"
    }  # fmt: skip
    assert first["knockdown"]["p50"] < first["knockdown"]["p99.9"] < first["knockdown"]["maximum"]
    assert [part["label"] for part in said["clamps"]][:1] == ["CTD 295 m"]
    assert said["responses"].keys() == RESPONSES.keys()
    assert tuple(said["worst"]) == RANKED
    assert {len(profiles) for profiles in said["worst"].values()} == {20}
    levels = said["responses"]["knockdown"]["return_levels"]["gev"]
    assert [level["period"] for level in levels["levels"]] == [2, 10]
    assert all(level["low"] < level["level"] < level["high"] for level in levels["levels"])
    curve = said["responses"]["tilt"]["exceedance"]
    assert len(curve["share"]) == len(curve["value"]) > 20
    assert {limit["bound"] for limit in said["limits"]} == {"at least", "at most"}
    named = {rule["rule"] for rule in said["rules"]}
    assert {limit["rule"] for limit in said["limits"]} | {"equilibrium"} == named
    assert "backup" in said["not_judged"]
    used = {limit["name"]: limit for limit in said["limits_used"]}
    assert used["anchor_factor"]["default"] == 1.5
    assert {"value", "source", "departs"} <= used["safety_factor.steel"].keys()


def test_the_document_is_that_of_the_docs(made, mooring):
    page = Path(__file__).parents[3] / "docs" / "reference" / "batch-statistics.md"
    shown = json.loads(re.search(r"```json\n(.*?)```", page.read_text(encoding="utf-8"), re.S)[1])
    said = summary_document(summarize(made.assign_attrs(currents="a record"), mooring))
    assert said.keys() == shown.keys()
    assert said["profiles"].keys() == shown["profiles"].keys()
    for name in ("components", "rules", "limits"):
        assert said[name][0].keys() == shown[name][0].keys()
    levels, of = said["responses"]["knockdown"], shown["responses"]["knockdown"]
    assert levels.keys() == of.keys()
    assert levels["return_levels"]["gev"].keys() == of["return_levels"]["gev"].keys()
    assert said["worst"]["knockdown"][0].keys() == shown["worst"]["knockdown"][0].keys()


def test_a_refusal_is_said_in_place_of_levels(short):
    levels = summary_document(short)["responses"]["tilt"]["return_levels"]
    assert "10 whole years" in levels["gev"]["refused"]
    assert "2 days" in levels["pot"]["refused"]
    assert "levels" not in levels["gev"]


def test_the_table_fits_a_terminal(summary, fallen, short, nothing):
    for one in (summary, fallen, short, nothing):
        assert max(map(len, table(one).splitlines())) <= 80


def test_the_table_says_what_matters(summary):
    text = table(summary)
    assert "no-current" in text
    assert "not solved" not in text
    row = next(line for line in text.splitlines() if line.startswith("ADCP float"))
    one = summary.parts[0].knockdown
    assert f"{one.percentiles[2]:.1f}" in row and f"{one.maximum:.1f}" in row
    assert "Equilibrium" in text and "Anchor weight" in text
    assert "knockdown of the top [m], GEV" in text
    assert "–" in text


def test_what_is_left_out_is_said_beside_the_figures(fallen):
    said = "20 of 200 profiles with a current (10.00 %) have no solution"
    assert said in " ".join(table(fallen).split())
    assert summary_html(fallen).count(said) == 3  # with the rules, the curves and the percentiles
    rules = summary_document(fallen)["rules"]
    assert rules[0] == {
        "rule": "equilibrium", "judged": 200, "fails": 0.1, "fails_at_most": 0.1, "warns": 0.0,
        "limits": 0, "unknown": 0,
    }  # fmt: skip
    strength = next(rule for rule in rules if rule["rule"] == "strength")
    assert (strength["fails"], strength["fails_at_most"]) == (0.0, 0.1)
    row = next(line for line in table(fallen).splitlines() if line.startswith("Strength"))
    assert row.split()[1:4] == ["0.00", "10.00", "0.00"]


def test_least_tension_is_not_said_to_include_the_clamps(summary):
    said = " ".join(summary_html(summary).split())
    assert "minimum tension is judged at the ends." in said


def test_the_table_gives_each_reason_once(short):
    text = " ".join(table(short).split())
    assert text.count("10 whole years are needed") == 1
    assert "! no return levels by GEV: annual maxima of 10 whole years are needed" in text


def test_a_response_that_is_known_in_no_profile_is_neither_drawn_nor_excused(short, nothing):
    """As the offset of a net whose free end hangs from a node."""
    responses = [
        one if one.name != "offset" else replace(absent, name="offset")
        for one, absent in zip(short.responses, nothing.responses, strict=True)
    ]
    without = replace(short, responses=tuple(responses))
    assert [one.name for one in without.known_responses] == ["knockdown", "anchor_tension", "tilt"]
    assert "there are too few values" not in table(without)
    drawn = [page.count("offset of the top [") for page in map(summary_html, (short, without))]
    assert drawn[0] > drawn[1] == 0


def test_nothing_solved_can_be_shown(nothing):
    text = table(nothing)
    assert "4 no-equilibrium" in text
    assert "100.00" in text
    row = next(line for line in text.splitlines() if line.startswith("Strength"))
    assert row.split()[1:4] == ["-", "-", "-"]
    assert "unknown in all profiles" in summary_html(nothing)
    json.loads(to_json([summary_document(nothing)]), parse_constant=pytest.fail)


def test_a_label_is_shown_as_it_is_written(mooring):
    first, *others = mooring.file.pieces
    pieces = (replace(first, label="[red]top[/red]"), *others)
    marked = Design(replace(mooring.file, pieces=pieces))
    assert "[red]top[/red]" in table(summarize(stormy(marked, 5), marked))


def test_what_is_rare_is_not_said_to_be_nothing():
    assert percent(0.0) == "0.00"
    assert percent(1e-6) == "<0.01"
    assert percent(0.12345) == "12.35"
    assert percent(None) == "-"


def test_the_page_needs_nothing_else(summary):
    html = summary_html(summary)
    assert not re.findall(r'(?:src|href|url)\s*[=(]\s*["\']?(?:https?:)?//', html)
    assert "<link" not in html and "<img" not in html and "@import" not in html
    # what the drawings carry besides are names of their own languages
    places = set(re.findall(r"https?://[^\"'\s<)]+", html))
    assert places <= {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"}
    assert html.count("<svg") == 3


def test_the_page_says_all(summary):
    html = summary_html(summary)
    for heading in (
        "Failure rates", "Through time", "Responses of the line", "Return levels",
        "The 20 worst profiles by knockdown of the top", "Limits", "Distributions",
        "Not covered by this check", "Clamped instruments, or components", "Input sha256",
    ):  # fmt: skip
        assert heading in html, heading
    assert "GEV of annual maxima: location" in html
    assert "Ferro and Segers" in html


@pytest.mark.thorough
def test_the_same_result_makes_the_same_page(made, mooring, summary):
    again = summarize(made, mooring)
    assert summary_html(again) == summary_html(summary)
    assert summary_document(again) == summary_document(summary)


def test_names_that_mean_harm_are_shown_as_text(tmp_path):
    mooring = calm.load(hostile_file(tmp_path))
    html = summary_html(summarize(stormy(mooring, 60), mooring))
    assert "<script>alert" not in html
    assert html.count("</body>") == 1


@pytest.mark.thorough
def test_the_files_stand_beside_the_result(made, mooring, tmp_path):
    result = tmp_path / "north.2001.nc"
    made.isel(time=slice(0, 200)).to_netcdf(result, engine="h5netcdf")
    summary = write_summary(result, mooring)
    document, page = summary_paths(result)
    assert (document.name, page.name) == ("north.2001.summary.json", "north.2001.summary.html")
    assert {path.name for path in tmp_path.iterdir()} == {result.name, document.name, page.name}
    assert json.loads(document.read_text()) == json.loads(to_json([summary_document(summary)]))
    assert page.read_text(encoding="utf-8") == summary_html(summary)


def test_a_full_disk_leaves_no_part_of_a_file(made, mooring, tmp_path, monkeypatch):
    result = tmp_path / "result.nc"
    made.isel(time=slice(0, 50)).to_netcdf(result, engine="h5netcdf")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(folder.os, "replace", full)
    with pytest.raises(UsageError, match="No space left"):
        write_summary(result, mooring)
    assert [path.name for path in tmp_path.iterdir()] == [result.name]
