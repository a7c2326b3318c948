"""`calm import`: exit codes, what is written and what is said."""

import json

import numpy as np
import pytest

from tests.unit.exchange.mat_files import mooring, write_matlab

SITE = """\
name: site
environment:
  depth: 150 m
  current: {columns: [depth m, u m/s, v m/s], rows: [[0, 0.4, -0.1], [150, 0, 0]]}
"""


@pytest.fixture
def design(folder):
    def write(name="a.mat", **changes):
        write_matlab(folder / name, mooring(**changes))
        return name

    return write


def test_a_design_becomes_a_mooring_that_runs(calm, folder, design):
    done = calm("import", design(), "-o", "a.yaml")
    assert (done.code, done.out) == (0, "")
    assert "calm run a.yaml" in done.err
    assert json.loads(calm("run", "a.yaml", "--json", "-").out)["status"] == "converged"


def test_guesses_are_comments_lines_and_json(calm, folder, design):
    lift = mooring()["B"].copy()
    lift[0, -1] = 20.0
    done = calm("import", design(B=lift), "-o", "a.yaml", "--json", "-")
    (guess,) = json.loads(done.out)["guessed"]
    assert guess["where"] == "components.two-wheels.weight"
    assert f"guessed: {guess['where']}: {guess['what']}" in done.err
    assert f"# guessed: {guess['what']}" in (folder / "a.yaml").read_text()


def test_strict_refuses_guesses_and_writes_nothing(calm, folder, design):
    lift = mooring()["B"].copy()
    lift[0, -1] = 20.0
    done = calm("import", design(B=lift), "-o", "a.yaml", "--strict")
    assert done.code == 2
    assert "--strict" in done.err
    assert not (folder / "a.yaml").exists()
    assert calm("import", design(), "-o", "a.yaml", "--strict").code == 0


def test_several_files_become_several_or_none(calm, folder, design):
    design("b.mat", H=None)
    done = calm("import", design("a.mat"), "b.mat", "-o", "out/")
    assert done.code == 2
    assert "b.mat: contains neither a mooring" in done.err
    assert not (folder / "out").exists()
    done = calm("import", "a.mat", design("c.mat"), "-o", "out/", "--json", "-")
    assert sorted(path.name for path in (folder / "out").iterdir()) == ["a.yaml", "c.yaml"]
    assert [each["file"] for each in json.loads(done.out)] == ["a.mat", "c.mat"]


def test_an_environment_is_needed_and_may_be_given(calm, folder, design):
    design("a.mat", U=None, V=None, W=None, z=None, rho=None)
    assert "--environment" in calm("import", "a.mat", "-o", "a.yaml").err
    assert not (folder / "a.yaml").exists()
    (folder / "site.yaml").write_text(SITE)
    assert calm("import", "a.mat", "-o", "a.yaml", "--environment", "site.yaml").code == 0
    result = json.loads(calm("run", "a.yaml", "--json", "-").out)
    assert result["top"]["y"] < 0.0 < result["top"]["x"]
    assert result["components"][-1]["depth_bottom"] == pytest.approx(150.0)


def test_an_environment_keeps_its_files(calm, folder, design):
    (folder / "site").mkdir()
    (folder / "site" / "flow.csv").write_text("depth[m],u[m/s],v[m/s]\n0,0.3,0\n150,0,0\n")
    site = "environment:\n  depth: 150 m\n  current: {file: flow.csv}\n"
    (folder / "site" / "site.yaml").write_text(site)
    (folder / "out").mkdir()
    done = calm("import", design(), "-o", "out/a.yaml", "--environment", "site/site.yaml")
    assert done.code == 0, done.err
    assert "omitted: environment" in done.err
    assert json.loads(calm("run", "out/a.yaml", "--json", "-").out)["top"]["x"] > 0.0


def test_a_record_is_written_beside_and_batches(calm, folder, design):
    u = np.outer([0.8, 0.3, 0.0], [1.0, 0.5, 0.2])
    design(U=u, V=0 * u, W=0 * u, time=730486.0 + np.arange(3) / 24)
    done = calm("import", "a.mat", "-o", "a.yaml", "--json", "-")
    record = json.loads(done.out)["record"]
    assert record == "a-currents.nc"
    import xarray as xr

    with xr.open_dataset(folder / record) as dataset:
        assert str(dataset.time.values[1])[:16] == "2000-01-01T01:00"
        assert dataset.u.sel(depth=90.0).values == pytest.approx([0.3, 0.15, 0.06])


def test_the_catalogue_takes_the_place_of_what_agrees(calm, folder, design):
    names = ["37in ORE", *mooring()["moorele"][1:]]
    design(moorele=names)
    done = calm("import", "a.mat", "-o", "a.yaml", "--match-catalogue", "--json", "-")
    matched = {each["name"]: each["entry"] for each in json.loads(done.out)["matched"]}
    assert matched["37in ORE"] == "sphere-ore-37in"
    assert "37in ORE is replaced by sphere-ore-37in of the catalogue" in done.err
    assert "use: sphere-ore-37in" in (folder / "a.yaml").read_text()
    assert calm("run", "a.yaml").code == 0


def test_a_name_alone_is_no_match(calm, folder, design):
    lift = mooring()["B"].copy()
    lift[0, 0] = 200.0
    done = calm(
        "import", design(B=lift, moorele=["37in ORE"]), "-o", "a.yaml", "--match-catalogue",
        "--json", "-",
    )  # fmt: skip
    assert "37in ORE" not in {each["name"] for each in json.loads(done.out)["matched"]}


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--format", "orca"], "`orca` is none of mdd, cbl"),
        (["-D", "DEPTH"], "`DEPTH` is not NAME=VALUE"),
    ],
)
def test_options_that_make_no_sense_are_refused(calm, folder, design, words, message):
    done = calm("import", design(), "-o", "a.yaml", *words)
    assert done.code == 2
    assert message in done.err


def test_a_file_never_takes_the_place_of_its_source(calm, folder, design):
    before = (folder / design()).read_bytes()
    assert calm("import", "a.mat", "-o", "a.mat").code == 2
    assert (folder / "a.mat").read_bytes() == before


LIST = "Item,Length (m),Diameter (mm),Wet weight (kg),\x1b[31mColour [/x]\n"
LIST += "Ball \x1b[31m,1,1000,-400,\n8 mm wire,100,8,24,\n"
LIST += "Total \x1b[31m[red],1,1,1,\nAnchor,0.4,,900,\n"


def test_no_sign_of_a_file_rules_the_terminal(calm, folder):
    (folder / "a.csv").write_text(LIST)
    (folder / "b.csv").write_text(LIST.replace("24,", "\x1b[31mheavy,"))
    (folder / "site.yaml").write_text(SITE)
    good = calm("import", "a.csv", "-o", "a.yaml", "--environment", "site.yaml")
    bad = calm("import", "b.csv", "-o", "b.yaml", "--environment", "site.yaml")
    assert (good.code, bad.code) == (0, 2)
    assert "Colour [/x]" in good.err
    assert "heavy` is not a number" in bad.err
    assert "\x1b" not in good.err + bad.err + (folder / "a.yaml").read_text()


def test_names_take_figures_from_a_library(calm, folder):
    (folder / "names.csv").write_text("name,length\nBall,\nRope,90\nSinker,\n")
    (folder / "elements.csv").write_text(
        "name,buoyancy,length,diameter,cd\nball,300,1,1,0.65\nrope,-0.2,1,0.01,1.3\n"
        "sinker,-900,0.5,1,1.3\n"
    )
    (folder / "site.yaml").write_text(SITE)
    words = ["import", "names.csv", "-o", "a.yaml", "--environment", "site.yaml"]
    assert "weight in water" in calm(*words).err
    assert calm(*words, "--elements", "elements.csv", "--strict").code == 0
    assert calm("run", "a.yaml").code == 0


def test_a_file_of_no_program_is_refused(calm, folder):
    (folder / "x.bin").write_bytes(bytes(range(256)))
    done = calm("import", "x.bin", "missing.mat", "-o", "out/")
    assert done.code == 2
    assert "x.bin: is not in a format that CALM reads" in done.err
    assert "missing.mat" in done.err
    assert "Traceback" not in done.err


def test_export_writes_and_tells_what_is_lost(calm, folder, write_mooring):
    done = calm("export", write_mooring(), "--to", "cbl", "-o", "m.cbl")
    assert (done.code, done.out) == (0, "")
    assert "m.cbl: not exported: limits of the design check" in done.err
    assert calm("import", "m.cbl", "-o", "back.yaml").code == 0
    one, other = (
        json.loads(calm("run", each, "--json", "-").out) for each in ("m.yaml", "back.yaml")
    )
    assert other["top"]["depth"] == pytest.approx(one["top"]["depth"], abs=0.01)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["m.yaml", "--to", "orca", "-o", "m.out"], "`orca` is not a format"),
        (["m.yaml", "--to", "mdd", "-o", "m.yaml"], "m.yaml is the input file"),
        (["m.yaml", "--to", "mdd", "-o", "m.txt"], "cannot write m.txt: its name must end in .mat"),
        (["m.yaml", "--to", "moordyn", "-o", "m.cbl"], "must end in .txt or .dat"),
        (["none.yaml", "--to", "mdd", "-o", "m.mat"], "none.yaml"),
        (["m.yaml", "--to", "mdd", "-o", "none/m.mat"], "there is no folder"),
    ],
)
def test_export_refuses(calm, folder, write_mooring, words, message):
    write_mooring()
    done = calm("export", *words)
    assert done.code == 2
    assert message in done.err
    assert sorted(path.name for path in folder.iterdir()) == ["m.yaml"]
