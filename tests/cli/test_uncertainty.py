"""`calm run --uncertainty`: what is printed, written and refused."""

import json

import pytest

from calm.case.draws import CAUSES

DRAWS = ("--uncertainty", "--samples", "64")


def test_the_table_and_the_json_say_the_same(calm, write_mooring):
    file = write_mooring()
    document = json.loads(calm("run", file, *DRAWS, "--json", "-").out)
    said = document["uncertainty"]
    assert (said["samples"], said["seed"], said["failed"]) == (64, 0, 0)
    assert [one["index"] for one in said["components"]] == [0, 1, 2]
    for one in said["components"]:
        for name in ("depth_top", "knockdown", "tilt", "tension"):
            assert one[name] == sorted(one[name])
    top = said["components"][0]
    assert top["depth_top"][0] < document["top"]["depth"] < top["depth_top"][2]
    assert set(said["anchor"]) == {"tension", "required_weight"}
    assert said["contributions"] == []  # too few samples for a fit
    shown = calm("run", file, *DRAWS).out
    assert "Uncertainty of these values" in shown
    for figure in top["depth_top"]:
        assert f"{figure:.1f}" in shown


def test_the_table_is_in_the_units_asked_for(calm, write_mooring):
    file = write_mooring()
    (top, *_) = json.loads(calm("run", file, *DRAWS, "--json", "-").out)["uncertainty"][
        "components"
    ]
    shown = calm("run", file, *DRAWS, "--units", "length=ft,force=kN").out
    spread = shown[shown.index("Uncertainty of these values") :]
    assert " ft" in spread and " kN" in spread
    for figure in top["depth_top"]:
        assert f"{figure / 0.3048:.1f}" in spread


@pytest.mark.thorough
def test_contributions_are_of_every_cause(calm, write_mooring):
    done = calm("run", write_mooring(), "--uncertainty", "--samples", "512", "--json", "-")
    found = json.loads(done.out)["uncertainty"]["contributions"]
    assert {one["cause"] for one in found} == set(CAUSES)
    assert {one["quantity"] for one in found} == {"knockdown"}
    assert sum(one["first"] for one in found) <= 1.0 + 1e-9
    assert all(one["first"] <= one["total"] + 1e-12 for one in found)
    totals = [one["total"] for one in found]
    assert totals == sorted(totals, reverse=True)


def test_the_same_file_gives_the_same_bytes(calm, write_mooring):
    file = write_mooring()
    once = calm("run", file, *DRAWS, "--json", "-").out
    assert calm("run", file, *DRAWS, "--json", "-").out == once


def test_the_band_is_drawn_and_reported(calm, write_mooring, folder):
    calm("run", write_mooring(), *DRAWS, "-o", "band.svg", "-o", "sure.html")
    assert "5 to 95 %" in (folder / "band.svg").read_text(encoding="utf-8")
    page = (folder / "sure.html").read_text(encoding="utf-8")
    assert "Uncertainty of these values" in page


def test_what_cannot_be_drawn_is_refused(calm, write_mooring, heavy):
    file = write_mooring()
    done = calm("run", file, "--uncertainty", "--samples", "1000")
    assert (done.code, done.out) == (2, "")
    assert "1000 is not a power of two" in done.err
    assert "use 1024" in done.err
    assert calm("run", heavy, *DRAWS).code == 3


@pytest.mark.thorough
def test_every_finding_of_a_check_has_its_probability(calm, write_mooring):
    file = write_mooring()
    options = ("--allow-unknown", *DRAWS, "--json", "-")
    findings = json.loads(calm("check", file, *options).out)["findings"]
    assert all("probability" in one for one in findings)
    counted = [one["probability"] for one in findings if one["limit"] is not None]
    assert counted
    assert all(0.0 <= one <= 1.0 for one in counted)
    plain = json.loads(calm("check", file, "--allow-unknown", "--json", "-").out)["findings"]
    assert not any("probability" in one for one in plain)
    assert [one | {"probability": None} for one in plain] == [
        one | {"probability": None} for one in findings
    ]


@pytest.mark.thorough
def test_designs_are_listed_by_their_probability(calm, write_mooring, folder):
    safe = write_mooring()
    text = (folder / safe).read_text(encoding="utf-8")
    (folder / "shaky.yaml").write_text(
        text.replace("name: Test", "name: Shaky") + "checks: {minimum_top_depth: 50 m}\n",
        encoding="utf-8",
    )
    done = calm("check", safe, "shaky.yaml", "--allow-unknown", *DRAWS, "--report", "out")
    said = done.out[done.out.index("Probability of exceeding a limit") :]
    assert said.index("Shaky") < said.index("Test")
    header, *rows = (folder / "out" / "checks.csv").read_text(encoding="utf-8").splitlines()
    assert header.endswith(",reason,probability")
    assert any(row.rpartition(",")[2] for row in rows)
    assert "Probability of exceeding a limit" in (folder / "out" / "report.html").read_text("utf-8")


def test_a_check_refuses_samples_that_are_no_power_of_two(calm, write_mooring):
    done = calm("check", write_mooring(), "--uncertainty", "--samples", "99")
    assert done.code == 2
    assert "99 is not a power of two" in done.err


def test_samples_without_uncertainty_are_refused(calm, write_mooring):
    path = write_mooring()
    for command in ("run", "check"):
        done = calm(command, path, "--samples", 64)
        assert done.code == 2 and "--samples: 64 needs --uncertainty" in done.err
