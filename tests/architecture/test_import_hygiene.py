"""What each entrance loads, seen in a fresh process: a static graph cannot show that a deferred
import stays deferred."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
HEAVY = {"scipy", "pint", "xarray", "matplotlib", "pandas", "numba", "textual", "gsw"}

COMMAND = """
import contextlib, io, json, sys
sys.argv = ["calm", *{arguments}]
from calm.cli import main
code = 0
with contextlib.redirect_stdout(io.StringIO()):
    try:
        code = main()
    except SystemExit as leaving:
        code = leaving.code
assert not code, code
print(json.dumps(sorted(sys.modules)))
"""


def loaded(program: str) -> set[str]:
    """Names of the modules in memory after `program`, which prints them as JSON."""
    environment = {name: value for name, value in os.environ.items() if name != "CALM_COMPILED"}
    finished = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False,
        env=environment,
    )  # fmt: skip
    assert finished.returncode == 0, finished.stderr
    return set(json.loads(finished.stdout.splitlines()[-1]))


def loaded_by_import(module: str) -> set[str]:
    return loaded(f"import json, sys, {module}; print(json.dumps(sorted(sys.modules)))")


def test_the_package_itself_loads_nothing_it_may_not_need() -> None:
    unwanted = HEAVY | {"pydantic", "yaml", "rich", "cyclopts"}
    assert not unwanted & loaded_by_import("calm")


@pytest.mark.parametrize("module", ["calm.physics", "calm.solve"])
def test_the_numbers_know_only_arrays(module: str) -> None:
    unwanted = HEAVY | {"pydantic", "yaml", "rich", "cyclopts"}
    modules = loaded_by_import(module)
    assert not unwanted & modules
    above = {"calm.files", "calm.units", "calm.shipped", "calm.case", "calm.report", "calm.cli"}
    assert not above & modules


def test_reading_files_loads_no_heavy_library() -> None:
    assert not HEAVY & loaded_by_import("calm.files")


@pytest.mark.parametrize(
    "arguments",
    [
        ["--help"],
        ["run", "--help"],
        ["run", "lines/deep-current-meters.yaml"],
        ["run", "lines/deep-current-meters.yaml", "--json", "-"],
        ["catalog", "list"],
        ["catalog", "list", "sphere"],
    ],
    ids=" ".join,
)
def test_everyday_commands_load_no_heavy_library(arguments: list[str]) -> None:
    modules = loaded(COMMAND.format(arguments=arguments))
    assert not HEAVY & modules
    assert not [name for name in modules if name.startswith("calm.exchange")]  # file formats


def test_random_draws_load_no_statistics() -> None:
    words = ["run", "lines/s1000.yaml", "--uncertainty", "--samples", "64"]
    assert not {"scipy.stats", "scipy.special"} & loaded(COMMAND.format(arguments=words))


def test_help_reads_no_files() -> None:
    assert not {"pydantic", "yaml", "calm.files"} & loaded(COMMAND.format(arguments=["--help"]))


RANGES = """latitude[deg],longitude[deg],range[m]
48.3135,-5.2000,2497
48.2933,-5.1825,2497
48.2933,-5.2175,2497
"""


@pytest.mark.parametrize(
    "arguments",
    [
        ["check", "lines/s1000.yaml", "--allow-unknown", "--report", "{to}/check"],
        ["run", "lines/s1000.yaml", "-o", "{to}/line.png", "-o", "{to}/line.pdf"],
        ["deck", "lines/fit-top-depth.yaml", "-o", "{to}/deck"],
        ["locate", "{to}/ranges.csv", "--depth", "2000 m", "--plot", "{to}/ranges.pdf"],
    ],
    ids=lambda arguments: arguments[0],
)
def test_drawings_need_no_plotting_library(arguments: list[str], tmp_path: Path) -> None:
    (tmp_path / "ranges.csv").write_text(RANGES, encoding="utf-8")
    modules = loaded(COMMAND.format(arguments=[each.format(to=tmp_path) for each in arguments]))
    assert "calm.drawing.graph" in modules
    assert not {"matplotlib", "matplotlib.figure"} & modules
