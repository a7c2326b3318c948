"""What each entrance loads, seen in a fresh process: a static graph cannot show that a deferred
import stays deferred."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
HEAVY = {"scipy", "pint", "xarray", "matplotlib", "pandas", "llvmlite", "textual", "gsw"}

COMMAND = """
import contextlib, io, json, sys
from calm.cli import main
for words in {commands}:
    code = 0
    with contextlib.redirect_stdout(io.StringIO()):
        try:
            code = main(words)
        except SystemExit as leaving:
            code = leaving.code
    assert not code, (words, code)
print(json.dumps(sorted(sys.modules)))
"""


def loaded(program: str, **variables: str) -> set[str]:
    """Names of the modules in memory after `program`, which prints them as JSON."""
    environment = {name: value for name, value in os.environ.items() if name != "CALM_COMPILED"}
    environment |= variables
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


@pytest.mark.parametrize(
    "commands",
    [
        [["--help"], ["run", "--help"], ["catalog", "list"], ["catalog", "list", "sphere"]],
        [["run", "lines/deep-current-meters.yaml"]],
        [["run", "lines/deep-current-meters.yaml", "--json", "-"]],
    ],
    ids=["help and catalogue", "run", "run as JSON"],
)
def test_everyday_commands_load_no_heavy_library(commands: list[list[str]]) -> None:
    modules = loaded(COMMAND.format(commands=commands))
    assert not HEAVY & modules
    assert not [name for name in modules if name.startswith("calm.exchange")]  # file formats


def test_help_reads_no_files() -> None:
    assert not {"pydantic", "yaml", "calm.files"} & loaded(COMMAND.format(commands=[["--help"]]))


RANGES = """latitude[deg],longitude[deg],range[m]
48.3135,-5.2000,2497
48.2933,-5.1825,2497
48.2933,-5.2175,2497
"""


def test_drawings_need_no_plotting_library(tmp_path: Path) -> None:
    (tmp_path / "ranges.csv").write_text(RANGES, encoding="utf-8")
    commands = [
        ["check", "lines/s1000.yaml", "--allow-unknown", "--report", f"{tmp_path}/check"],
        ["run", "lines/s1000.yaml", "-o", f"{tmp_path}/line.png", "-o", f"{tmp_path}/line.pdf"],
        ["deck", "lines/fit-top-depth.yaml", "-o", f"{tmp_path}/deck"],
        ["locate", f"{tmp_path}/ranges.csv", "--depth", "2000 m", "--plot",
         f"{tmp_path}/ranges.pdf"],
    ]  # fmt: skip
    modules = loaded(COMMAND.format(commands=commands), CALM_COMPILED="never")
    drawn = [path for path in tmp_path.rglob("*.pdf")]
    assert {path.name for path in drawn} >= {"line.pdf", "ranges.pdf"}
    assert {path.parent.name for path in drawn} >= {"check", "deck"}
    assert not {"matplotlib", "matplotlib.figure"} & modules
