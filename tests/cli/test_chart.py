"""`calm chart` as a user runs it."""

import json
import sys

import pytest

BUOY = ("--k", "2.4", "--weight", "5 N/m", "--phi-b", "75 deg", "--tension-b", "350 N",
        "--height", "20 m")  # fmt: skip
TENSIONS = ("--k", "2.4", "--weight", "5 N/m", "--tension-a", "250 N", "--tension-b", "350 N")


def test_the_table_gives_all_seven_quantities_of_every_cable(calm):
    done = calm("chart", "solve", *BUOY)
    assert (done.code, done.err) == (0, "")
    rows = dict(line.rsplit("  ", 1)[0].split("  ", 1) for line in done.out.splitlines()[4:11])
    assert "28.467" in done.out and "18.782" in done.out and "22.027" in done.out
    assert "63.298" in done.out and "-18.924" in done.out
    assert "the cable dips below this end" in done.out
    assert len(rows) == 7


def test_json_in_si_and_degrees(calm):
    done = calm("chart", "solve", *BUOY, "--json", "-")
    document = json.loads(done.out)
    assert done.code == 0
    assert (document["status"], document["k"]) == ("converged", 2.4)
    solution = document["solutions"][0]
    assert list(solution) == [
        "phi_a", "phi_b", "tension_a", "tension_b", "height", "distance", "length", "h0",
    ]  # fmt: skip
    # Printed to the digits of the published figures.
    assert solution["length"] == pytest.approx(28.467, abs=5e-4)
    assert solution["phi_a"] == pytest.approx(22.027, abs=5e-4)


def test_json_in_a_file_beside_the_table(calm, folder):
    done = calm("chart", "solve", *BUOY, "--json", "answer.json")
    assert done.code == 0
    assert "28.467" in done.out
    assert len(json.loads((folder / "answer.json").read_text())["solutions"]) == 2


def test_k_from_the_cable_and_the_current(calm):
    done = calm("chart", "solve", "--diameter", "10 mm", "--cd", "1.2", "--speed", "0.5 m/s",
                "--density", "1000 kg/m3", "--weight", "0.5 N/m", "--phi-a", "-20 deg",
                "--tension-a", "60 N", "--length", "200 m", "--json", "-")  # fmt: skip
    # K = 1000 × 1.2 × 0.01 × 0.5² / (2 × 0.5)
    assert json.loads(done.out)["k"] == pytest.approx(3.0, rel=1e-12)


def test_a_floating_cable_cannot_set_out_downwards(calm):
    done = calm("chart", "solve", "--k", "3", "--weight", "-0.5 N/m", "--phi-a", "-20 deg",
                "--distance", "-3 m", "--length", "100 m")  # fmt: skip
    assert (done.code, done.out) == (2, "")
    assert "from 0° to 180°" in done.err


@pytest.mark.parametrize(
    ("height", "status"), [("20 m", "one-parameter-family"), ("21 m", "inconsistent")]
)
def test_two_tensions_and_the_height(calm, height, status):
    done = calm("chart", "solve", *TENSIONS, "--height", height, "--json", "-")
    document = json.loads(done.out)
    assert done.code == 3
    assert (document["status"], document["solutions"]) == (status, [])
    assert document["message"] and document["advice"]
    assert status in done.err


def test_no_cable_fits(calm):
    done = calm("chart", "solve", "--k", "2.4", "--weight", "5 N/m", "--phi-a", "140 deg",
                "--phi-b", "150 deg", "--length", "10 m")  # fmt: skip
    assert (done.code, done.out) == (3, "")
    assert "critical angle, 144.404°" in done.err
    done = calm("chart", "solve", "--k", "2.4", "--weight", "-5 N/m", "--phi-a", "30 deg",
                "--phi-b", "40 deg", "--length", "10 m")  # fmt: skip
    assert "critical angle, 35.5964°" in done.err


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (TENSIONS, "three of"),
        ((*BUOY, "--length", "30 m"), "three of"),
        (("--k", "-1", *BUOY[2:]), "K is -1"),
        (("--k", "200", *BUOY[2:]), "K is 200"),
        ((*BUOY[:4], "--phi-b", "190 deg", *BUOY[6:]), "phi_b is 190°"),
        ((*BUOY[:4], "--phi-b", "75", *BUOY[6:]), "--phi-b: `75` needs a unit: `75 deg`?"),
        ((*BUOY, "--speed", "1 m/s"), "--k cannot be combined with --speed"),
        (("--cd", "1.2", *BUOY[2:]), "missing: --diameter, --speed; alternatively, set --k"),
        ((*BUOY[:2], "--weight", "0", *BUOY[4:]), "weight is 0"),
        ((*BUOY[:2], *BUOY[4:]), "weight"),
    ],
)
def test_bad_questions_are_refused_and_nothing_is_written(calm, folder, words, complaint):
    done = calm("chart", "solve", *words, "--json", "answer.json")
    assert (done.code, done.out) == (2, "")
    assert complaint in done.err
    assert not list(folder.iterdir())


def test_all_mistakes_are_told_at_once(calm):
    done = calm("chart", "solve", "--k", "2.4", "--weight", "5", "--phi-b", "75",
                "--tension-b", "350 kg", "--height", "20 m")  # fmt: skip
    assert done.code == 2
    for option in ("--weight", "--phi-b", "--tension-b"):
        assert option in done.err


@pytest.mark.parametrize("name", ["chart.svg", "chart.png", "chart.pdf"])
@pytest.mark.thorough
def test_draw(calm, folder, name):
    done = calm("chart", "draw", "--k", "2.4", "--lower-end", "above-90", "-o", name)
    assert (done.code, done.out, done.err) == (0, "", f"{name} written\n")
    assert (folder / name).stat().st_size > 10_000


@pytest.mark.parametrize(
    "words",
    [
        ("--k", "0.6", "-o", "chart.jpg"),
        ("--k", "-0.6", "-o", "chart.svg"),
        ("--k", "many", "-o", "chart.svg"),
        ("--k", "0.6", "-o", "missing/chart.svg"),
        ("--k", "0", "--lower-end", "above-90", "-o", "chart.svg"),
    ],
)
def test_a_chart_that_cannot_be_drawn_leaves_no_file(calm, folder, words):
    done = calm("chart", "draw", *words)
    assert (done.code, done.out) == (2, "")
    assert done.err.startswith("calm: ")
    assert not list(folder.iterdir())


def test_without_matplotlib_the_command_that_installs_it_is_named(calm, folder, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    done = calm("chart", "draw", "--k", "0.6", "-o", "chart.svg")
    assert (done.code, done.out) == (2, "")
    assert (
        done.err
        == "calm: matplotlib is not installed; in the checkout of CALM, run pip install '.[plot]'\n"
    )
    assert not list(folder.iterdir())
