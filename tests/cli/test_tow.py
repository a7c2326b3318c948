"""`calm run` of tows, and with `--speeds`, as a user runs it."""

import csv
import io
import json
import math
import sys

import pytest

from calm.cli.progress import progress

TOW = """\
name: Test tow
tow: {{speed: {speed}, toward: 90 deg}}
environment: {{density: 1025 kg/m^3{environment}}}
line:
  - {{use: wire, {length}}}
  - {{use: fish}}
solver: {{strumming: {strumming}}}
components:
  wire: {{kind: cable, diameter: 10 mm, weight: 2.5 N/m, cn: 1.2, ct: 0, breaking_load: 40 kN}}
  fish: {{kind: body, length: 1 m, buoyancy: -1000 N, drag_area: 0.05 m^2, cd: 1}}
"""


@pytest.fixture
def write_tow(folder):
    def write(file="t.yaml", *, speed="1 m/s", length="length: 100 m", strumming="none",
              environment=""):  # fmt: skip
        text = TOW.format(speed=speed, length=length, strumming=strumming, environment=environment)
        (folder / file).write_text(text, encoding="utf-8")
        return file

    return write


def test_table_tells_both_ends_of_the_line(calm, write_tow):
    done = calm("run", write_tow())
    assert (done.code, done.err) == (0, "")
    assert done.out.startswith("Test tow: tow at 1.00 m/s towards 90°\n")
    for words in ("\nwire ", "\nfish ", "Tow point  load", "N astern", "Body ", "layback"):
        assert words in done.out
    assert done.out.index("\nwire ") < done.out.index("\nfish ")
    assert "Strumming" not in done.out


def test_tows_beside_moorings_are_as_alone(calm, write_tow, write_mooring):
    alone = calm("run", write_tow(), "--json", "-")
    both = calm("run", write_mooring(), "t.yaml", "--json", "-")
    assert both.code == 0
    mooring, tow = json.loads(both.out)
    assert mooring["type"] == "subsurface"
    assert tow == json.loads(alone.out)
    assert tow["type"] == "tow"
    assert [component["label"] for component in tow["components"]] == ["wire", "fish"]


def test_every_output_of_run_takes_a_tow(calm, write_tow, write_mooring, folder):
    outputs = ("-o", "c.csv", "-o", "p.svg")
    assert calm("run", write_mooring(), write_tow(), *outputs).code == 0
    rows = list(csv.DictReader(io.StringIO((folder / "c.csv").read_text(encoding="utf-8"))))
    assert [row["label"] for row in rows if row["mooring"] == "Test tow"] == ["wire", "fish"]
    assert "distance behind the tow point" in (folder / "p-t.svg").read_text(encoding="utf-8")


def test_moorings_have_no_speeds(calm, write_tow, write_mooring):
    done = calm("run", write_tow(), write_mooring(), "--speeds", "1 m/s:2 m/s:1 m/s")
    assert (done.code, done.out) == (2, "")
    assert done.err == "calm: --speeds is only for tows; these are moorings: m.yaml\n"


@pytest.mark.parametrize(
    "options",
    [["--schematic"], ["--explain", "--uncertainty"], ["-o", "x.html"], ["-o", "x.nc"]],
)
def test_options_that_show_one_speed_are_rejected(calm, write_tow, folder, options):
    done = calm("run", write_tow(), "--speeds", "1 m/s:2 m/s:1 m/s", *options)
    assert (done.code, done.out) == (2, "")
    if options[0] == "-o":
        allowed = "its name must end in .json, .csv, .svg, .png or .pdf"
        assert done.err == f"calm: cannot write {options[1]}: {allowed}\n"
    else:
        assert done.err == f"calm: {', '.join(options)} cannot be combined with --speeds\n"
    assert [path.name for path in folder.iterdir()] == ["t.yaml"]


def test_the_message_about_calm_tow_names_calm_run(calm, write_tow):
    done = calm("tow", write_tow())
    assert (done.code, done.out) == (2, "")
    assert done.err.startswith('calm: Unknown command "tow". Did you mean "run"?')
    assert len(done.err.splitlines()) == 1


def test_strumming_is_told(calm, write_tow):
    file = write_tow(strumming="bourget-marichal")
    found = json.loads(calm("run", file, "--json", "-").out)["strumming"]
    cn = f"Cn from {found['cn_min']:.3f} to {found['cn_max']:.3f}"
    told = f"strumming at {found['frequency']:.2f} Hz, {cn}"
    assert told in calm("run", file).out


def test_speeds_have_both_ends_and_what_a_tow_at_that_speed_has(calm, write_tow):
    done = calm("run", write_tow(), "--speeds", "1 knot:2 m/s:0.5 m/s", "--json", "-")
    assert done.code == 0
    document = json.loads(done.out)
    assert list(document) == ["calm", "name", "type", "speeds", "units"]
    assert document["units"]["speed"] == "m/s"
    assert (document["name"], document["type"]) == ("Test tow", "tow")
    speeds = [row["speed"] for row in document["speeds"]]
    knot = 1852.0 / 3600.0
    assert speeds == pytest.approx([knot, knot + 0.5, knot + 1.0, 2.0], rel=1e-12)
    alone = json.loads(calm("run", write_tow(speed="2 m/s"), "--json", "-").out)
    last = document["speeds"][-1]
    assert last["status"] == "converged"
    assert "frequency" not in last
    assert last["depth"] == alone["body"]["depth"]
    assert last["layback"] == alone["body"]["layback"]
    assert last["tension"] == alone["tow_point"]["tension"]
    assert last["angle"] == alone["tow_point"]["angle"]
    assert last["body_tension"] == alone["body"]["tension"]


def test_csv_has_the_same_rows(calm, write_tow, folder):
    words = ("run", write_tow(strumming="bourget-marichal"), "--speeds", "1 m/s:2 m/s:1 m/s")
    document = json.loads(calm(*words, "--json", "-").out)
    assert calm(*words, "-o", "c.csv").code == 0
    rows = list(csv.DictReader(io.StringIO((folder / "c.csv").read_text(encoding="utf-8"))))
    assert [row["tow"] for row in rows] == ["Test tow"] * 2
    for row, same in zip(rows, document["speeds"], strict=True):
        assert float(row["speed[m/s]"]) == same["speed"]
        assert row["status"] == same["status"]
        # twelve digits are written
        assert float(row["depth[m]"]) == pytest.approx(same["depth"], rel=1e-11)
        assert float(row["frequency[Hz]"]) == pytest.approx(same["frequency"], rel=1e-11)


def test_a_speed_without_equilibrium_is_a_row_and_the_sweep_goes_on(calm, write_tow):
    # At 0.2 m/s the line hangs 99 m deep, below a bed of 90 m; at 1.6 and 3 m/s it is above.
    file = write_tow(environment=", depth: 90 m")
    done = calm("run", file, "--speeds", "0.2 m/s:3 m/s:1.4 m/s", "--json", "-")
    assert done.code == 3
    slow, _, fast = json.loads(done.out)["speeds"]
    assert (slow["status"], slow["depth"], slow["tension"]) == ("grounded", None, None)
    assert slow["message"] and slow["advice"]
    assert (fast["status"], "message" in fast) == ("converged", False)
    assert len(done.err.splitlines()) == 1
    assert "no equilibrium at 1 of 3 speeds; at 0.2 m/s, grounded" in done.err
    table = calm("run", file, "--speeds", "0.2 m/s:3 m/s:1.4 m/s")
    assert table.code == 3
    assert "grounded" in table.out.splitlines()[5]


def test_a_sweep_is_drawn(calm, write_tow, folder):
    words = ("--speeds", "1 m/s:2 m/s:0.5 m/s", "-o")
    assert calm("run", write_tow(), *words, "s.png").code == 0
    assert (folder / "s.png").read_bytes().startswith(b"\x89PNG")
    assert calm("run", "t.yaml", *words, "s.svg").code == 0
    drawing = (folder / "s.svg").read_text(encoding="utf-8")
    for label in ("depth [m]", "layback [m]", "tension [N]", "speed [m/s]", "speed [knot]"):
        assert label in drawing


@pytest.mark.parametrize(
    ("speeds", "told"),
    [
        ("1 knot:2 knot", "is not A:B:STEP"),
        ("1:2 knot:0.5 knot", "`1` needs a unit: `1 m/s`?"),
        ("1 knot:2 kg:0.5", "`0.5` needs a unit"),
        ("1 knot:2 knot:0 knot", "step of 0 m/s"),
        ("1 knot:2 knot:-1 knot", "must be above 0"),
        ("2 knot:1 knot:0.5 knot", "below its first speed"),
        ("0 knot:1 knot:0.5 knot", "a speed above 0"),
        ("-1 knot:1 knot:0.5 knot", "a speed above 0"),
        ("1 m/s:2 m/s:0.0001 m/s", "more than 10000 speeds"),
    ],
)
def test_wrong_speeds_are_refused_before_anything_is_read(calm, speeds, told, folder):
    done = calm("run", "missing.yaml", "--speeds", speeds, "-o", "x.json")
    assert (done.code, done.out) == (2, "")
    assert len(done.err.splitlines()) == 1
    assert told in done.err
    assert not list(folder.iterdir())


def test_ten_thousand_speeds_are_not_too_many():
    from calm.cli.tow_speeds import speed_range

    assert len(speed_range("1 m/s:10.999 m/s:0.001 m/s")) == 10_000
    assert speed_range("3 m/s:3 m/s:1 knot") == [3.0]


def test_where_no_length_reaches_the_depth_there_is_nothing_to_tabulate(calm, write_tow, folder):
    file = write_tow(speed="5 m/s", length="weight: -2.5 N/m, length: fit, body_depth: 5 km")
    words = ("run", write_tow("good.yaml"), file, "--speeds", "1 m/s:2 m/s:1 m/s")
    done = calm(*words, "--json", "-")
    assert done.code == 3
    good, none = json.loads(done.out)
    assert len(good["speeds"]) == 2
    assert set(none) == {"name", "status", "message", "advice"}
    assert done.err.startswith("t.yaml: ")
    calm(*words, "-o", "c.csv")
    assert len((folder / "c.csv").read_text(encoding="utf-8").splitlines()) == 1 + 2


def test_progress_is_told_to_a_terminal_only_when_it_takes_long(capsys, monkeypatch):
    assert list(progress([1, 2, 3], "speeds")) == [1, 2, 3]
    assert capsys.readouterr().err == ""
    times = iter([0.0, 0.5, 1.5, 1.5, 1.55])
    monkeypatch.setattr("calm.cli.progress.monotonic", lambda: next(times, math.inf))
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    assert list(progress([1, 2, 3], "speeds")) == [1, 2, 3]
    assert capsys.readouterr().err == "\r\x1b[K1 of 3 speeds\r\x1b[K"
