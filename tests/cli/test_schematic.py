import json
import os
import subprocess
import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parents[2] / "docs"


def test_it_stands_above_the_table(calm, write_mooring):
    done = calm("run", write_mooring(), "--schematic")
    assert done.code == 0
    assert done.err == ""
    drawing, table = done.out.split("\n\nTest: sub-surface mooring")
    assert drawing.startswith("Test\n100.0 m of water\n")
    for sign in ("~~~~~~~~~~ sea surface", " (   )     top float", "   ├─[#]     logger"):
        assert f"\n{sign}" in drawing
    assert drawing.endswith("at the upper end of each part, as\nsolved in the current.")
    assert "horizontal" in table
    assert max(map(len, done.out.splitlines())) <= 80
    assert not any(line.endswith(" ") for line in done.out.splitlines())


def test_output_asked_for_elsewhere_stays_alone(calm, write_mooring):
    document = json.loads(calm("run", write_mooring(), "--schematic", "--json", "-").out)
    assert document["name"] == "Test"


def test_each_of_several_files_has_its_own(calm, write_mooring):
    write_mooring("a.yaml", name="First")
    write_mooring("b.yaml", name="Second")
    out = calm("run", "a.yaml", "b.yaml", "--schematic").out
    titles = ("First\n", "\nFirst: sub", "\nSecond\n", "\nSecond: sub")
    places = [out.index(title) for title in titles]
    assert places == sorted(places)


def test_a_line_without_equilibrium_is_drawn_all_the_same(calm, heavy):
    done = calm("run", heavy, "--schematic")
    assert done.code == 3
    assert "\n (   )     top float" in done.out
    assert "upright and unstretched" in done.out
    assert "horizontal" not in done.out
    assert done.err


def test_an_output_without_the_signs_gets_plain_ones(calm_process, write_mooring):
    environment = {**os.environ, "PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"}
    done = calm_process("run", write_mooring(), "--schematic", env=environment)
    assert done.returncode == 0
    drawing = done.stdout.partition("Test: ")[0]
    assert "   |-[#]     logger" in drawing
    assert "?" not in drawing


def test_it_is_as_wide_as_asked(calm, write_mooring, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    drawing = calm("run", write_mooring(), "--schematic").out.partition("\n\nTest: ")[0]
    assert max(map(len, drawing.splitlines())) <= 60


def test_tows(calm, folder):
    (folder / "tow.yaml").write_text(
        "environment: {}\n"
        "tow: {speed: 2 knot, toward: 90 deg}\n"
        "line: [{use: rope, length: 50 m}, {use: ball}]\n"
        "components:\n"
        "  rope: {kind: cable, diameter: 10 mm, weight: 1 N/m}\n"
        "  ball: {kind: sphere, diameter: 0.2 m, buoyancy: -200 N}\n"
    )
    assert "\n\\__|__/    ship" in calm("run", "tow.yaml", "--schematic").out


def test_the_page_of_the_manual_is_what_is_drawn():
    finished = subprocess.run(
        [sys.executable, DOCS / "generate_schematic.py", "--check"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert finished.returncode == 0, finished.stderr
