import json

import pytest

TARGET = ("--target", "knockdown(top) <= 5 cm", "--change", "top float.buoyancy")


def test_what_to_change(calm, write_mooring):
    done = calm("size", write_mooring(), *TARGET)
    assert done.code == 0
    assert done.err == ""
    lines = done.out.splitlines()
    assert lines[0] == "Test: knockdown(top) <= 5 cm"
    assert lines[2].startswith("top float.buoyancy: 2000 N → ")
    for row in ("knockdown of the top", "anchor load", "anchor weight required"):
        assert f"\n{row}" in done.out
    assert "size, drag and mass do not" in done.out
    assert max(map(len, lines)) <= 80


def test_json_holds_before_and_after(calm, write_mooring):
    done = calm("size", write_mooring(), *TARGET, "--json", "-")
    document = json.loads(done.out)
    assert document["status"] == "met"
    assert document["target"]["limit"] == 0.05
    assert document["before"]["value"] == 2000.0
    assert document["before"]["measured"] > 0.05 >= document["after"]["measured"]
    assert document["after"]["measured"] == document["after"]["knockdown"]
    # the file with the answer in it gives the same
    file = write_mooring("answer.yaml", buoyancy=f"{document['after']['value']!r} N")
    there = json.loads(calm("run", file, "--json", "-").out)
    assert there["top"]["knockdown"] == pytest.approx(document["after"]["knockdown"], rel=1e-9)
    assert there["anchor"]["tension"] == pytest.approx(document["after"]["tension"], rel=1e-9)


def test_json_goes_to_a_file_beside_the_table(calm, write_mooring, folder):
    done = calm("size", write_mooring(), *TARGET, "--json", "answer.json")
    assert done.out.startswith("Test: ")
    assert json.loads((folder / "answer.json").read_text())["status"] == "met"


def test_nothing_to_change(calm, write_mooring):
    done = calm("size", write_mooring(), "--target", "knockdown(top) <= 50 m", *TARGET[2:])
    assert done.code == 0
    assert "No change needed: the present top float.buoyancy meets the target." in done.out


def test_a_target_that_cannot_be_met(calm, write_mooring):
    words = ("--target", "knockdown(top) <= 1 mm", *TARGET[2:])
    done = calm("size", write_mooring(), *words)
    assert done.code == 3
    assert done.out == ""
    assert done.err.startswith("m.yaml: knockdown(top) <= 1 mm is not met. ")
    assert " The closest result is " in done.err
    assert "anchor-lifts" in done.err
    assert len(done.err.splitlines()) == 1
    document = json.loads(calm("size", "m.yaml", *words, "--json", "-").out)
    assert document["status"] == "not-met"
    assert document["after"] is None
    assert "anchor-lifts" in document["message"]
    assert document["advice"]


def test_range_and_environment(calm, write_mooring, folder):
    file = write_mooring()
    done = calm("size", file, *TARGET, "--between", "2000 N", "2001 N")
    assert done.code == 3
    assert "tried from 2000 N to 2001 N" in done.err
    with (folder / file).open("a") as stream:
        stream.write("environments: {still: {current: {speed: 0 m/s, toward: 0 deg}}}\n")
    done = calm("size", file, *TARGET, "--environment", "still")
    assert "No change needed" in done.out


def test_new_warnings_are_shown(calm, write_mooring):
    done = calm("size", write_mooring(), "--target", "tilt(rope) <= 1.3 deg", *TARGET[2:])
    assert done.code == 0
    assert "! Anchor weight in water is 5000 N; " in done.out


def test_all_mistakes_at_once(calm, write_mooring, folder):
    done = calm("size", write_mooring(), "--target", "tilt(rope) <= 2 m", "--change", "rop.length")
    assert done.code == 2
    assert done.out == ""
    assert done.err.splitlines() == [
        "calm: --target: `2 m` is a length; an angle (deg, rad) is needed",
        "  tilt(rope) <= 2 m",
        "                ^",
        "calm: --change: no part of the line has the label `rop`; did you mean `rope`?",
        "  rop.length",
        "  ^",
    ]


def test_a_broken_file_is_told_as_ever(calm, broken):
    done = calm("size", broken, *TARGET)
    assert done.code == 2
    assert len(done.err.splitlines()) == 2


def test_the_mooring_file_is_not_overwritten(calm, write_mooring):
    done = calm("size", write_mooring(), *TARGET, "--json", "m.yaml")
    assert done.code == 2
    assert "m.yaml is a mooring file and was not overwritten" in done.err


def test_tows_are_refused(calm, folder):
    (folder / "tow.yaml").write_text(
        "environment: {}\n"
        "tow: {speed: 2 knot, toward: 90 deg}\n"
        "line: [{use: rope, length: 50 m}, {use: ball}]\n"
        "components:\n"
        "  rope: {kind: cable, diameter: 10 mm, weight: 1 N/m}\n"
        "  ball: {kind: sphere, diameter: 0.2 m, buoyancy: -200 N}\n"
    )
    done = calm("size", "tow.yaml", *TARGET)
    assert done.code == 2
    assert done.err == "calm: tow.yaml is a tow; only a mooring can be used here\n"
