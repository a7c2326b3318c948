"""Names that look like markup: every command prints them as they are."""

import io
import json
import sys
from pathlib import Path

import pytest

from calm.cli import main

pytestmark = pytest.mark.thorough

HOSTILE = (
    "top [/x]",
    "ADCP [a]",
    "[bold red]CTD[/]",
    "<b>wire</b> & $x$",
    "[link=x]anchor",
    "=1+1",
)
TOP, ADCP, CTD, WIRE, ANCHOR, GLASS = HOSTILE

MOORING = f"""\
name: "M [/y] <i>"
description: "see [red]the file[/red]"
environment: {{depth: 500 m, current: {{speed: 0.3 m/s, toward: 90 deg}}}}
environments: {{"storm [/z]": {{current: {{speed: 0.5 m/s, toward: 90 deg}}}}}}
line:
  - {{use: sphere-steel-1250, label: "{TOP}"}}
  - use: wire-jacketed-8
    label: "{WIRE}"
    length: 300 m
    clamps: [{{use: sbe37, label: "{CTD}", at: 10 m}}, {{use: sbe37, label: "{ADCP}", at: 20 m}}]
  - {{use: glass-17in, label: "{GLASS}"}}
  - {{use: anchor-wheels-4, label: "{ANCHOR}"}}
"""

TOW = f"""\
name: "T [/y]"
tow: {{speed: 2 knot, toward: 90 deg}}
environment: {{depth: 500 m}}
solver: {{strumming: bourget-marichal}}
line:
  - use: wire-jacketed-8
    label: "{WIRE}"
    length: 100 m
    clamps: [{{use: sbe37, label: "{CTD}", at: 10 m}}]
  - {{use: sphere-steel-1250, label: "{TOP}", buoyancy: -1000 N}}
"""


CATALOGUE = """\
"x-[/b]":
  kind: sphere
  name: "[red]float[/red]"
  diameter: 300 mm
  mass: 10 kg
  buoyancy: 30 N
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.setenv("CALM_CATALOG_DIR", str(tmp_path / "mine"))
    Path("m.yaml").write_text(MOORING)
    Path("t.yaml").write_text(TOW)
    Path("mine").mkdir()
    Path("mine/own.yaml").write_text(CATALOGUE)
    return tmp_path


COMMANDS = {
    "run": (["run", "m.yaml"], ("M [/y] <i>", *HOSTILE)),
    "schematic": (["run", "m.yaml", "--schematic"], ("M [/y] <i>", *HOSTILE)),
    "explain": (["run", "m.yaml", "--explain"], (TOP, CTD, WIRE)),
    "environment": (["run", "m.yaml", "--environment", "storm [/z]"], HOSTILE),
    "tow": (["run", "t.yaml", "--schematic"], ("T [/y]", WIRE, CTD, TOP)),
    "speeds": (["run", "t.yaml", "--speeds", "1 knot:2 knot:1 knot"], ("T [/y]",)),
    "check": (["check", "m.yaml"], ("M [/y] <i>", "storm [/z]", TOP, ANCHOR)),
    "size": (
        ["size", "m.yaml", "--target", f"depth({CTD}) <= 211 m", "--change", f"{TOP}.buoyancy"],
        ("M [/y] <i>", TOP, CTD),
    ),
    "catalog list": (["catalog", "list", "--kind", "sphere"], ("x-[/b]", "[red]float[/red]")),
    "catalog list, words": (["catalog", "list", "[/b]"], ("x-[/b]", "[red]float[/red]")),
    "catalog show": (["catalog", "show", "x-[/b]"], ("x-[/b]", "[red]float[/red]")),
}


@pytest.mark.parametrize("command", COMMANDS)
def test_names_are_printed_as_they_are(command, folder, capsys):
    words, names = COMMANDS[command]
    assert main(words) in (0, 1)
    printed = capsys.readouterr().out
    for name in names:
        assert name in printed, name


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["run", "m.yaml", "--environment", "[/w]"], "[/w]"),
        (["run", "m.yaml", "[/none].yaml"], "[/none].yaml"),
        (["run", "[none].yaml"], "[none].yaml: no such file"),
        (["size", "m.yaml", "--target", "tilt([/no]) <= 1 deg", "--change", "x.count"], "[/no]"),
        (["catalog", "show", "[/c]"], "[/c]"),
        (["catalog", "list", "[/none]"], "[/none]"),
        (["verify", "[/none]"], "[/none]"),
        (["chart", "solve", "--weight", "[/5 N]"], "[/5 N]"),
        (["new", "-o", "m.yaml"], "m.yaml"),
    ],
)  # fmt: skip
def test_mistakes_are_told_in_the_words_of_the_person(words, told, folder, capsys):
    assert main(words) in (0, 2)
    assert told in capsys.readouterr().err


def test_a_batch_prints_them_too(folder, capsys):
    assert main(["new", "--record", "-o", "r.nc"]) == 0
    words = ["batch", "m.yaml", "--currents", "r.nc", "-o", "o.nc", "--every", "40"]
    assert main(words) == 0
    printed = capsys.readouterr().out
    page = Path("o.summary.html").read_text()
    for name in ("M [/y] <i>", TOP, CTD, WIRE, ANCHOR):
        assert name in printed, name
    assert "<i>" not in page and "&lt;b&gt;wire&lt;/b&gt;" in page


def test_reports_escape_them(folder, capsys):
    words = ["check", "m.yaml", "--report", "out", "--environment", "storm [/z]"]
    assert main([*words, "--workers", "1"]) in (0, 1)
    page = Path("out/report.html").read_text()
    assert "&lt;b&gt;wire&lt;/b&gt; &amp; $x$" in page and "<b>wire" not in page
    assert Path("out/report.pdf").read_bytes().startswith(b"%PDF")
    found = json.loads(Path("out/report.json").read_text())["findings"]
    assert {TOP, ADCP, CTD} <= {each["component"] for each in found}


def test_where_there_is_ascii_only_signs_are_written_out(folder, monkeypatch, tmp_path):
    """The degree sign is not lost: 27° is 27 deg."""
    screen = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(screen, encoding="ascii"))
    assert main(["run", "m.yaml"]) == 0
    sys.stdout.flush()
    printed = screen.getvalue().decode("ascii")
    assert "?" not in printed
    assert " deg from the vertical" in printed and "cables x 1.5" in printed
    units = next(line.split() for line in printed.splitlines() if " deg " in line)
    assert units == ["m", "m", "m", "m", "m", "deg", "N"]
