"""`calm run --uncertainty`: what is printed, written and refused."""

import json

from calm.case.uncertain import CAUSES

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
    assert "How sure these figures are" in shown
    for figure in top["depth_top"]:
        assert f"{figure:.1f}" in shown


def test_contributions_are_of_every_cause(calm, write_mooring):
    done = calm("run", write_mooring(), "--uncertainty", "--samples", "512", "--json", "-")
    found = json.loads(done.out)["uncertainty"]["contributions"]
    assert {one["cause"] for one in found} == set(CAUSES)
    assert {one["quantity"] for one in found} == {"knockdown"}
    assert sum(one["first"] for one in found) <= 1.0 + 1e-9
    assert all(one["first"] <= one["total"] + 1e-12 for one in found)
    totals = [one["total"] for one in found]
    assert totals == sorted(totals, reverse=True)


def test_the_same_seed_gives_the_same_bytes(calm, write_mooring):
    file = write_mooring()
    once = calm("run", file, *DRAWS, "--seed", "7", "--json", "-").out
    assert calm("run", file, *DRAWS, "--seed", "7", "--json", "-").out == once
    assert calm("run", file, *DRAWS, "--seed", "8", "--json", "-").out != once


def test_the_band_is_drawn_and_reported(calm, write_mooring, folder):
    calm("run", write_mooring(), *DRAWS, "--plot", "band.svg", "--html", "sure.html")
    assert "5 to 95 %" in (folder / "band.svg").read_text(encoding="utf-8")
    page = (folder / "sure.html").read_text(encoding="utf-8")
    assert "How sure these figures are" in page


def test_what_cannot_be_drawn_is_refused(calm, write_mooring, heavy):
    file = write_mooring()
    done = calm("run", file, "--uncertainty", "--samples", "1000")
    assert (done.code, done.out) == (2, "")
    assert "1000 is no power of two" in done.err
    assert "take 1024" in done.err
    assert calm("run", file, "--uncertainty", "--seed", "-1").code == 2
    assert calm("run", heavy, *DRAWS).code == 3
