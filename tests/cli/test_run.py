import csv
import io
import json
import os

import pytest


def test_table_goes_to_the_standard_output(calm, write_mooring):
    done = calm("run", write_mooring())
    assert done.code == 0
    assert done.err == ""
    assert done.out.startswith("Test: sub-surface mooring, 100.0 m of water\n")
    for label in ("top float", "rope", "  logger", "weight"):
        assert f"\n{label} " in done.out
    assert "\nAnchor " in done.out and "horizontal" in done.out


def test_what_a_technician_asks_for_stands_below_the_table(calm, folder):
    (folder / "m.yaml").write_text(
        "name: Facts\nenvironment: {depth: 100 m, current: {speed: 0.3 m/s, toward: 90 deg}}\n"
        "line: [{use: ball}, {use: rope, length: 60 m, label: rope}, {use: weight}]\n"
        "components:\n"
        "  ball: {kind: sphere, role: float, diameter: 0.5 m, mass: 30 kg, buoyancy: 400 N}\n"
        "  rope: {kind: cable, diameter: 10 mm, weight: 0.5 N/m, mass: 0.1 kg/m}\n"
        "  weight: {kind: anchor, weight: 2 kN}\n"
    )
    lines = " ".join(calm("run", "m.yaml").out.split())
    # 30 kg + 60 m of 0.1 kg/m; 400 N less 60 m of 0.5 N/m; 0.5 m of float and 60 m in 100 m
    assert "Mass 36.0 kg in air without the anchor" in lines
    assert "Line 60.5 m under load, scope 0.605; largest tension " in lines
    assert "Recovery rises at " in lines and "top at the surface after " in lines
    assert "Numerical error" not in lines and "integrations" not in lines
    verbose = calm("run", "m.yaml", "-v").out
    assert "Numerical error" in verbose and "integrations over" in verbose


def test_json_dash_prints_json_only(calm, write_mooring):
    done = calm("run", write_mooring(), "--json", "-")
    assert done.code == 0
    document = json.loads(done.out)
    assert document["name"] == "Test"
    assert document["status"] == "converged"
    assert [component["label"] for component in document["components"]] == [
        "top float",
        "rope",
        "weight",
    ]
    assert calm("run", "m.yaml", "--json=-").out == done.out


def test_failure_is_json_too(calm, heavy):
    done = calm("run", heavy, "--json", "-")
    assert done.code == 3
    document = json.loads(done.out)
    assert set(document) == {"name", "status", "message", "advice"}
    assert document["name"] == "Heavy"
    assert document["advice"]


def test_failure_without_json_is_one_line_on_the_standard_error(calm, heavy):
    done = calm("run", heavy)
    assert done.code == 3
    assert done.out == ""
    assert len(done.err.splitlines()) == 1
    assert done.err.startswith("heavy.yaml: ")


def test_several_files_give_an_array_in_their_order(calm, write_mooring, heavy):
    done = calm("run", write_mooring(), heavy, "--json", "-")
    assert done.code == 3
    test, heavy = json.loads(done.out)
    assert (test["name"], test["status"]) == ("Test", "converged")
    assert (heavy["name"], "components" in heavy) == ("Heavy", False)


def test_several_tables_are_apart(calm, write_mooring):
    done = calm("run", write_mooring("a.yaml", name="A"), write_mooring("b.yaml", name="B"))
    assert "\n\nB: sub-surface mooring" in done.out


def test_bad_input_solves_and_writes_nothing(calm, write_mooring, broken, folder):
    before = sorted(os.listdir(folder))
    done = calm("run", write_mooring(), broken, "-o", "x.json", "-o", "x.png")
    assert done.code == 2
    assert done.out == ""
    lines = done.err.splitlines()
    assert len(lines) == 2
    assert all(line.startswith("broken.yaml:") for line in lines)
    assert all(line.split(":")[1].isdigit() and line.split(":")[2].isdigit() for line in lines)
    assert sorted(os.listdir(folder)) == sorted([*before, "m.yaml"])


def test_bad_input_outweighs_no_equilibrium(calm, heavy, broken):
    assert calm("run", heavy, broken, "--json", "-").code == 2


def test_mistakes_of_all_files_are_told_and_shared_ones_once(calm, write_mooring, folder):
    (folder / "mine.yaml").write_text("ball: 1\n")
    done = calm("run", write_mooring("a.yaml"), write_mooring("b.yaml"), "--catalog", "mine.yaml")
    assert done.code == 2
    assert len(done.err.splitlines()) == 1
    done = calm("run", "missing.yaml", "gone.yaml")
    assert [line.split(":")[0] for line in done.err.splitlines()] == ["missing.yaml", "gone.yaml"]


def test_files_are_written_beside_the_table(calm, write_mooring, folder):
    done = calm("run", write_mooring(), "-o", "r.json", "-o", "r.csv", "-o", "r.svg")
    assert done.code == 0
    assert done.err == "r.json written\nr.csv written\nr.svg written\n"
    assert "\nAnchor " in done.out and "horizontal" in done.out
    assert json.loads((folder / "r.json").read_text())["name"] == "Test"
    rows = list(csv.DictReader(io.StringIO((folder / "r.csv").read_text(encoding="utf-8"))))
    assert [row["label"] for row in rows] == ["top float", "rope", "logger", "weight"]
    assert "top float" in (folder / "r.svg").read_text(encoding="utf-8")
    assert sorted(os.listdir(folder)) == ["m.yaml", "r.csv", "r.json", "r.svg"]


def test_csv_and_json_agree_to_twelve_digits(calm, write_mooring, folder):
    document = json.loads(calm("run", write_mooring(), "--json", "-", "-o", "r.csv").out)
    rows = csv.DictReader(io.StringIO((folder / "r.csv").read_text(encoding="utf-8")))
    depths = [float(row["depth_top[m]"]) for row in rows if row["part"] == "component"]
    exact = [component["depth_top"] for component in document["components"]]
    assert depths == [float(f"{depth:.12g}") for depth in exact]


def test_warnings_are_in_the_table_and_in_json(calm, write_mooring):
    file = write_mooring(speed="2 m/s", buoyancy="4000 N")
    assert "! Anchor weight in water is" in calm("run", file).out
    done = calm("run", file, "--json", "-")
    warnings = json.loads(done.out)["warnings"]
    assert any(text.startswith("Anchor weight in water is") for text in warnings)
    assert done.err == ""


def test_each_of_several_moorings_has_its_picture(calm, write_mooring, heavy, folder):
    done = calm("run", write_mooring("a.yaml"), heavy, write_mooring("b.yaml"), "-o", "p.png")
    assert done.code == 3
    assert sorted(name for name in os.listdir(folder) if name.endswith(".png")) == [
        "p-a.png",
        "p-b.png",
    ]


def test_environment_by_name_and_by_file(calm, write_mooring, folder):
    file = write_mooring()
    with (folder / file).open("a") as stream:
        stream.write("environments: {calm sea: {current: {speed: 0 m/s, toward: 0 deg}}}\n")
    still = json.loads(calm("run", file, "--environment", "calm sea", "--json", "-").out)
    assert still["top"]["knockdown"] == pytest.approx(0.0, abs=1e-9)  # nothing moves it
    (folder / "fast.yaml").write_text(
        "name: fast\nenvironment:\n  depth: 100 m\n  current: {speed: 1 m/s, toward: 90 deg}\n"
    )
    fast = json.loads(calm("run", file, "--environment", "fast.yaml", "--json", "-").out)
    assert fast["top"]["knockdown"] > 1.0


def test_catalogue_of_ones_own(calm, write_mooring, folder):
    (folder / "mine.yaml").write_text(
        "float-of-mine: {kind: sphere, diameter: 1 m, buoyancy: 2500 N, source: me}\n"
    )
    file = write_mooring()
    text = (folder / file).read_text().replace("use: ball", "use: float-of-mine")
    (folder / file).write_text(text)
    assert calm("run", file).code == 2
    assert calm("run", file, "--catalog", "mine.yaml").code == 0


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["-o", "missing/x.json"], "there is no folder"),
        (["-o", "."], "its name must end in .json, .csv, .html, .pdf, .svg, .png or .nc"),
        (["-o", "x.jpg"], "cannot write x.jpg: its name must end in"),
        (["-o", "same.csv", "-o", "./same.csv"], "two outputs have the same path, same.csv"),
        (["-o", "-"], "cannot write -: its name must end in"),
        (["-o", "m.yaml"], "cannot write m.yaml: its name must end in"),
        (["-o", "--explain"], "a file name is expected, not the option --explain"),
        (["--json", "x.json"], "the value must be -, which prints the result"),
    ],
)
def test_hopeless_outputs_are_refused_before_solving(
    calm, write_mooring, folder, monkeypatch, options, told
):
    import calm as package

    monkeypatch.setattr(package, "load", lambda *_, **__: pytest.fail("read"), raising=False)
    done = calm("run", write_mooring(), *options)
    assert done.code == 2
    assert done.out == ""
    assert told in done.err
    assert len(done.err.splitlines()) == 1
    assert os.listdir(folder) == ["m.yaml"]


def test_pictures_of_one_name_are_refused(calm, write_mooring, folder):
    (folder / "other").mkdir()
    done = calm("run", write_mooring("a.yaml"), write_mooring("other/a.yaml"), "-o", "p.png")
    assert done.code == 2
    assert "two outputs have the same path, p-a.png" in done.err


def test_people_read_the_units_of_the_file_or_of_the_command(calm, write_mooring, folder):
    path = folder / write_mooring()
    plain, machine = calm("run", "m.yaml").out, calm("run", "m.yaml", "--json", "-").out
    pull = json.loads(machine)["anchor"]["vertical"]
    assert f"load {pull:.0f} N vertical" in plain
    path.write_text(path.read_text() + "units: {force: kgf}\n")
    assert f"load {pull / 9.80665:.1f} kgf vertical" in calm("run", "m.yaml").out
    feet = calm("run", "m.yaml", "--units", "length=ft, force=kN").out
    assert f"load {pull / 1e3:.3f} kN vertical" in feet
    assert "   ft" in feet
    assert calm("run", "m.yaml", "--json", "-").out == machine
    calm("run", "m.yaml", "-o", "r.csv")
    assert "[N]" in (folder / "r.csv").read_text(encoding="utf-8")


def test_files_that_ask_for_other_units_are_shown_in_the_usual_ones(calm, write_mooring, folder):
    for name, units in (("a.yaml", "kgf"), ("b.yaml", "lbf")):
        path = folder / write_mooring(name)
        path.write_text(path.read_text() + f"units: {{force: {units}}}\n")
    both = calm("run", "a.yaml", "b.yaml").out
    assert "kgf" not in both
    assert "lbf" not in both
    assert " N " in both


@pytest.mark.parametrize(
    ("units", "meant"),
    [("kgf", "force=kgf"), ("force=kg", "force=kgf"), ("weight=N", "force=N"),
     ("knots", "speed=kn"), ("length=kgf", "force=kgf"), ("length=m,feet", "length=ft")],
)  # fmt: skip
def test_the_unit_that_is_meant_is_offered(calm, write_mooring, folder, units, meant):
    done = calm("run", write_mooring(), "--units", units)
    assert done.code == 2
    assert f"for `{units.split(',')[-1]}` write `{meant}`" in done.err
    path = folder / write_mooring()
    path.write_text(path.read_text() + f"units: [{units.rpartition('=')[2].split(',')[-1]}]\n")
    dimension, _, unit = meant.partition("=")
    if units != "force=kg":  # a kilogram is one of mass
        assert f"write `units: {{{dimension}: {unit}}}`" in calm("run", path).err


@pytest.mark.parametrize("units", ["force", "force=kgf,,", "", "furlong"])
def test_units_that_are_none(calm, write_mooring, units):
    done = calm("run", write_mooring(), "--units", units)
    assert done.code == 2
    assert done.out == ""
    assert (
        "must be one of force=N|kN|kgf|lbf, length=m|ft, speed=m/s|cm/s|kn, mass=kg|lb" in done.err
    )


def test_units_of_a_file_that_are_none(calm, write_mooring, folder):
    path = folder / write_mooring()
    path.write_text(path.read_text() + "units: {force: kg, weight: N}\n")
    done = calm("run", "m.yaml")
    assert done.code == 2
    assert "`force: kg` must be one of N, kN, kgf, lbf" in done.err
    assert "unknown key `weight`" in done.err


def test_files_that_ask_for_different_units_are_shown_in_si_and_it_is_said(calm, write_mooring):
    for name, unit in (("a.yaml", "kgf"), ("b.yaml", "lbf")):
        path = write_mooring(name)
        with open(path, "a") as file:
            file.write(f"units: {{force: {unit}}}\n")
    done = calm("run", "a.yaml", "b.yaml")
    assert done.code == 0
    assert "the files set different units; results are in SI (use --units to choose)" in done.err
    assert "kgf" not in done.out
    alone = calm("run", "a.yaml")
    assert "kgf" in alone.out
    assert alone.err == ""
