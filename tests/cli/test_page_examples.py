"""The commands and the programs of the README and of the pages that show no output run.

`tests/architecture/test_pages.py` holds the pages that do. Here every page is given the files that
its examples name; what is left out asks a person (`calm build`), or `.ci/run` itself runs it.
"""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import openpyxl
import pytest
import yaml

from calm.cli.outputs import ExitCode
from calm.shipped import shipped_folder

ROOT = Path(__file__).resolve().parents[2]
BLOCK = re.compile(
    r"^(?:<!-- (exit: \d|not run)[^\n]*-->\n+)?```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL
)
ELSEWHERE = ("calm build", "python3 -m venv")
DEPLOYED = "\ndeployed: {date: 2027-03-02, items: [{label: wire, length: 481 m}]}\n"
METRES = 111_195.0  # of a degree of latitude


def blocks(page: Path, language: str) -> list[tuple[str, int]]:
    """The blocks of one language to be run, and the exit code that each ends with."""
    text = page.read_text(encoding="utf-8")
    return [
        (block, int(order[-1:] or 0))
        for order, of, block in BLOCK.findall(text)
        if of == language and order != "not run"
    ]


def pages(language: str) -> list[Path]:
    """The pages that are not run as a whole, and have blocks of a language."""
    found = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    return [
        page
        for page in found
        if "<!-- runs -->" not in page.read_text(encoding="utf-8") and blocks(page, language)
    ]


def ranges(head: str, per_metre: float) -> str:
    """Ranges to an anchor in 1000 m of water from a ship that goes around it."""
    rows = [f"latitude[deg],longitude[deg],{head}"]
    for north, east in ((900, 0), (300, 800), (-700, 500), (-700, -500), (300, -800), (100, 50)):
        slant = (north**2 + east**2 + 995.0**2) ** 0.5
        longitude = -5.2 + east / METRES / 0.6652
        rows.append(f"{48.3 + north / METRES:.7f},{longitude:.7f},{slant * per_metre:.5f}")
    return "\n".join(rows) + "\n"


@pytest.fixture
def files(folder, calm):
    """The files that examples name."""
    (folder / "lines").symlink_to(ROOT / "lines")
    (folder / "docs").symlink_to(ROOT / "docs")
    line = (shipped_folder("lines") / "fit-top-depth.yaml").read_text(encoding="utf-8")
    for name in ("mooring", "north", "south", "shallow", "design-A", "design-B"):
        text = re.sub(r"^name: .*$", f"name: {name}", line, flags=re.MULTILINE)
        (folder / f"{name}.yaml").write_text(text + DEPLOYED, encoding="utf-8")
    for name, speed in (("storm", 0.9), ("neap", 0.2)):
        (folder / f"{name}.yaml").write_text(
            f"name: {name}\nenvironment:\n  depth: 1100 m\n"
            f"  current: {{speed: {speed} m/s, toward: 90 deg}}\n"
        )
    (folder / "site.yaml").write_text("name: site\nenvironment: {depth: 300 m}\n")
    (folder / "ranges.csv").write_text(ranges("range[m]", 1.0))
    (folder / "times.csv").write_text(ranges("time[s]", 2.0 / 1500.0))
    (folder / "profile.csv").write_text("depth[m],sound_speed[m/s]\n0,1510\n1000,1490\n")
    (folder / "moordyn").mkdir()
    assert calm("new", "--record", "-o", "record.nc").code == 0
    book = openpyxl.Workbook()
    sheet = book.active
    for row in (
        ("Gear", "L1", "W", "diameter [m]"), ("Float", 1.0, -50, 1.0), ("Rope", 200, 5, 0.01),
        ("Weight", 0.5, 900, 0.5),
    ):  # fmt: skip
        sheet.append(row)
    book.save(folder / "list.xlsx")
    return folder


def give_a_week(folder: Path) -> None:
    """The mooring and the records of `calm motion`."""
    field = shipped_folder("docs") / "field" / "dune2"
    names = {"mooring.yaml": "mooring.yaml", "meters.nc": "currents.nc"}
    for name, source in {**names, "pressures.nc": "pressures.nc"}.items():
        (folder / name).write_bytes((field / source).read_bytes())


@pytest.mark.thorough
@pytest.mark.parametrize("page", pages("sh"), ids=lambda page: page.stem)
def test_the_commands_of_a_page_run(page, files, calm):
    for block, code in blocks(page, "sh"):
        if block.startswith("#!"):
            subprocess.run(["bash", "-n", "-c", block], check=True)
            continue
        for command in block.replace("\\\n", " ").splitlines():
            if not command.strip() or command.startswith(ELSEWHERE):
                continue
            if command.startswith("calm motion mooring.yaml"):
                give_a_week(files)
            program, *words = shlex.split(command, comments=True)
            assert program == "calm"
            if words[0] == "new":
                (files / words[-1]).unlink(missing_ok=True)
            done = calm(*words)
            assert done.code in (code, ExitCode.FINDING), f"{command}\n{done.err}"


@pytest.mark.thorough
@pytest.mark.parametrize("page", pages("python"), ids=lambda page: page.stem)
def test_the_programs_of_a_page_run(page, files, calm):
    for words in (
        "run mooring.yaml -o result.nc -o result.json",
        "batch mooring.yaml --currents record.nc -o moved.nc",
        "batch mooring.yaml --currents record.nc -o hindcast.nc",
        "batch mooring.yaml --currents record.nc --time 2026-03-01/2026-03-02 -o 1993.nc",
        "batch mooring.yaml --currents record.nc --time 2026-03-03/2026-03-04 -o 1994.nc",
    ):
        assert calm(*words.split()).code == 0
    program = "\n".join(block for block, _ in blocks(page, "python"))
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", program], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("page", pages("yaml"), ids=lambda page: page.stem)
def test_the_files_of_a_page_are_yaml(page):
    for block, _ in blocks(page, "yaml"):
        assert list(yaml.safe_load_all(block))
