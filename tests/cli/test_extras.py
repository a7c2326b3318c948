"""A default installation, as if the libraries of the extras were not there.

All commands run in one process, in which `None` stands for a missing library: to import it is then
a ModuleNotFoundError, and `find_spec` finds nothing.
"""

import json
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from calm.errors import EXTRAS, how_to_install

ROOT = Path(__file__).resolve().parents[2]
LIBRARIES = [library for libraries in EXTRAS.values() for library in libraries]

PROGRAM = """
import contextlib, io, json, sys
for library in {missing!r}:
    sys.modules[library] = None
from calm.cli import main
found = []
for words in json.load(sys.stdin):
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            code = main(words)
        except SystemExit as leaving:
            code = leaving.code or 0
    found.append([int(code), err.getvalue()])
print(json.dumps(found))
"""

RANGES = (
    "latitude[deg],longitude[deg],range[m]\n"
    "48.3135,-5.2000,2497\n48.2933,-5.1825,2497\n48.2933,-5.2175,2497\n"
)
LIST = [
    ["item", "length", "diameter", "weight", "buoyancy", "drag"],
    ["Float", "1 m", "1 m", "", "2000 N", 0.6],
    ["Rope", "60 m", "10 mm", "", "-20 N", 1.2],
]

DESIGN = """
new | new -o new.yaml | run m.yaml | run m.yaml --explain -o r.json -o r.csv
run m.yaml -o p.png -o r.html -o r.pdf --schematic
run m.yaml --uncertainty --samples 64
run t.yaml --speeds 1knot:3knot:1knot -o s.svg
check m.yaml --report check --json c.json | check m.yaml --missing | deck m.yaml -o deck
size m.yaml --target knockdown(top)<=5m --change rope.length | diff m.yaml new.yaml
waves w.yaml --hs 2m --tp 8s | export m.yaml --to mdd -o m.mat | export m.yaml --to csv -o m.csv
import m.mat -o from-mat.yaml | import list.xlsx -o list.yaml --environment e.yaml
import m.csv -o from-csv.yaml --environment e.yaml
catalog list sphere | catalog show glass-17in | schema
locate ranges.csv --depth 2000m --plot ranges.pdf | verify cdms | docs | completion bash
chart solve --k 2.4 --weight 5N/m --phi-b 75deg --tension-b 350N --height 20m
"""

RECORDS = {
    "new --record -o record.nc": "records",
    "batch m.yaml --currents record.nc -o out.nc": "records",
    "run m.yaml -o out.nc": "records",
    "run n.yaml": "records",
    "check n.yaml": "records",
    "motion m.yaml --currents record.nc --pressures record.nc -o motion.nc": "records",
    "grid record.nc record.nc --levels 10m:90m:10m -o grid.nc": "records",
    "chart draw --k 0.6 -o chart.svg": "plot",
}


def outcomes(missing, commands):
    """Exit code and standard error of each command, in one process."""
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM.format(missing=missing)],
        input=json.dumps([command.split() for command in commands]),
        capture_output=True,
        text=True,
        check=False,
        env=None,
    )
    assert done.returncode == 0, done.stderr
    return dict(zip(commands, json.loads(done.stdout.splitlines()[-1]), strict=True))


@pytest.fixture
def designs(folder, write_mooring, march_as_it_stands):
    """What the commands read."""
    import xlsxwriter

    write_mooring()
    text = (folder / "m.yaml").read_text(encoding="utf-8")
    current = "{speed: 0.5 m/s, toward: 90 deg}"
    (folder / "n.yaml").write_text(text.replace(current, "{file: record.nc}"), encoding="utf-8")
    water = f"environment: {{depth: 100 m, current: {current}}}"
    (folder / "e.yaml").write_text(water, encoding="utf-8")
    (folder / "t.yaml").write_bytes((ROOT / "calm/templates/tow.yaml").read_bytes())
    (folder / "w.yaml").write_bytes((ROOT / "lines/taut-nylon-surface.yaml").read_bytes())
    (folder / "ranges.csv").write_text(RANGES, encoding="utf-8")
    (folder / "record.nc").write_bytes(b"CDF\x01" + bytes(60))
    with xlsxwriter.Workbook(folder / "list.xlsx") as book:
        sheet = book.add_worksheet()
        for number, row in enumerate(LIST):
            sheet.write_row(number, 0, row)


@pytest.mark.thorough
@pytest.mark.usefixtures("designs")
def test_every_design_command_runs_without_the_extras():
    commands = [each.strip() for each in DESIGN.replace("\n", "|").split("|") if each.strip()]
    found = outcomes(LIBRARIES, commands)
    # what a check finds is no failure
    wrong = {each: told for each, (code, told) in found.items() if code not in (0, 1)}
    assert not wrong
    assert not {each: told for each, (_, told) in found.items() if "is not installed" in told}


@pytest.mark.usefixtures("designs")
def test_a_command_that_needs_an_extra_says_so_in_one_line():
    found = outcomes(LIBRARIES, list(RECORDS))
    for command, extra in RECORDS.items():
        code, told = found[command]
        assert code == 2, (command, told)
        *_, last = told.splitlines()
        assert " is not installed; in the checkout of CALM, run " in last, (command, told)
        assert last.endswith(f"pip install '.[{extra}]'"), (command, told)


@pytest.mark.thorough
@pytest.mark.usefixtures("designs")
def test_check_and_deck_run_without_scipy():
    """With a launch, a streamed line and a surface float in waves."""
    commands = [
        "check m.yaml --report check",
        "check w.yaml --allow-unknown",
        "deck m.yaml -o deck",
        "deck m.yaml -o anchor --order anchor-first",
        "deck m.yaml -o towed --ship-speed 1knot",
    ]
    found = outcomes([*LIBRARIES, "scipy"], commands)
    assert not {each: told for each, (code, told) in found.items() if code not in (0, 1)}


def test_the_builder_runs_without_the_extras(designs):
    program = f"""
import asyncio, sys
from pathlib import Path
for library in {[*LIBRARIES, "scipy", "typst", "python_calamine"]!r}:
    sys.modules[library] = None
from calm.tui.app import BuildApp
from calm.tui.start import open_session

async def judged():
    session, kept = open_session(Path("m.yaml"))
    app = BuildApp(session, kept=kept)
    async with app.run_test(size=(120, 40)) as pilot:
        while not app.is_idle:
            await pilot.pause(0.02)
        return app.workspace.view

view = asyncio.run(judged())
print(view.failure, len(view.problems))
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert done.stdout.split() == ["None", "0"], done.stderr


def test_the_extras_of_the_package_hold_the_libraries_that_are_named():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    indirect = {"pandas", "dask"}  # of xarray, and of distributed
    for extra, libraries in EXTRAS.items():
        wanted = {each.partition(">=")[0] for each in extras[extra] if ">=" in each}
        assert wanted == set(libraries) - indirect
    assert extras["all"] == [f"calm-mooring[{','.join(EXTRAS)}]"]
    assert "calm-mooring[all]" in extras["dev"]


@pytest.mark.parametrize(
    ("name", "advice"),
    [
        (
            "xarray.core",
            "xarray is not installed; in the checkout of CALM, run pip install '.[records]'",
        ),
        ("scipy", "scipy is not installed; run pip install scipy"),
        ("calm.lost", None),
        (None, None),
    ],
)
def test_a_missing_library_is_named_with_its_command(name, advice):
    assert how_to_install(ModuleNotFoundError("missing", name=name)) == advice
