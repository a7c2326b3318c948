import json

import pytest


def test_explanation_follows_the_table(calm, write_mooring):
    done = calm("run", write_mooring(), "--explain")
    assert done.code == 0
    assert done.err == ""
    table, explanation = done.out.split("\n\nCauses of the knockdown ")
    assert "horizontal" in table
    assert "excursion" in explanation.splitlines()[0]
    present = "present design "
    for row in ("top float ", "rope ", "all ", present, "buoyancy +10 % ", "current −10 % "):
        assert f"\n{row}" in explanation


def test_explanation_is_in_the_json(calm, write_mooring):
    done = calm("run", write_mooring(), "--explain", "--json", "-")
    document = json.loads(done.out)
    explain = document["explain"]
    assert [cause["label"] for cause in explain["causes"]] == ["top float", "rope", "logger"]
    total = sum(cause["knockdown"] for cause in explain["causes"])
    # scaled to the whole, so equal but for rounding
    assert total == pytest.approx(document["top"]["knockdown"], rel=1e-9)
    assert [change["change"] for change in explain["changes"]] == [
        "buoyancy +10 %", "drag −10 %", "current +10 %", "current −10 %",
    ]  # fmt: skip
    assert explain["changes"][0]["knockdown"] < document["top"]["knockdown"]
    assert "explain" not in json.loads(calm("run", "m.yaml", "--json", "-").out)


def test_small_drags_share_a_row(calm, write_mooring, folder):
    file = write_mooring()
    text = (folder / file).read_text()
    tiny = "{use: logger, at: 10 m}, {use: logger, at: 20 m, cn: 0.001}, "
    tiny += "{use: logger, at: 30 m, cn: 0.001}"
    (folder / file).write_text(text.replace("{use: logger, at: 10 m}", tiny))
    done = calm("run", file, "--explain")
    assert "\n2 others" in done.out


def test_a_failure_has_nothing_to_explain(calm, heavy, write_mooring):
    done = calm("run", heavy, write_mooring(), "--explain", "--json", "-")
    assert done.code == 3
    first, second = json.loads(done.out)
    assert "explain" not in first
    assert "explain" in second


def test_a_change_that_leads_nowhere_is_told(calm, write_mooring, folder):
    file = write_mooring(buoyancy="4990 N")  # the anchor weighs 5000 N
    done = calm("run", file, "--explain")
    assert done.code == 0
    assert "\nbuoyancy +10 %  anchor-lifts" in done.out
    assert "! buoyancy +10 %: anchor-lifts: The vertical load of the line is" in done.out


def test_tows_are_refused(calm, folder, write_mooring):
    (folder / "tow.yaml").write_text(
        "environment: {}\n"
        "tow: {speed: 2 knot, toward: 90 deg}\n"
        "line: [{use: rope, length: 50 m}, {use: ball}]\n"
        "components:\n"
        "  rope: {kind: cable, diameter: 10 mm, weight: 1 N/m}\n"
        "  ball: {kind: sphere, diameter: 0.2 m, buoyancy: -200 N}\n"
    )
    done = calm("run", write_mooring(), "tow.yaml", "--explain")
    assert done.code == 2
    assert done.out == ""
    assert done.err == "calm: --explain is only for moorings; these are tows: tow.yaml\n"


def test_columns_fit_a_terminal(calm, write_mooring):
    done = calm("run", write_mooring(), "--explain")
    assert max(map(len, done.out.splitlines())) <= 80
