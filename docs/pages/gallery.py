"""The gallery: one generated page per file of `lines/`."""

import contextlib
import io
import os
import re
import shlex
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure

import calm
from calm.cli.main import main
from calm.cli.outputs import ExitCode
from calm.drawing.line_drawing import line_drawing
from calm.drawing.plot import figure_svg
from calm.drawing.schematic import schematic_svg
from calm.shipped import shipped_folder
from pages import pictures

HEAD = """# Gallery

The moorings and tows of the folder `lines/`, each with its file, shape, schematic, results, and
a command to try. These pages are generated from the files. In the
small pictures the horizontal scale is larger than the vertical scale.
"""

LEADING = ("tall-array-mooring", "compact-adcp", "s-tether", "profiler-mooring")
"""Common designs, which come first."""

CASES = ("bourget-marichal-sphere", "braconnot-buoy", "cdms-1", "s1000")
"""Cases published in articles or solved by other programs; not designs to copy."""


@dataclass(frozen=True)
class Try:
    """An example to try: its purpose, the commands, and the interesting part of their output."""

    why: str
    commands: tuple[str, ...]
    start: str = ""
    picture: Callable[[], Figure] | None = None
    seen: str = ""


_SPEEDS = "calm run {file} --speeds"
TRIES = {
    "a-frame-sheared-tow": Try(
        "The drag depends on the speed of the water relative to the line. Tow it faster:",
        (f'{_SPEEDS} "1 knot:4 knot:1 knot"',),
        picture=pictures.out_and_back,
        seen="Out with the current and back against it at the same speed over the ground: the net "
        "runs at another depth, on the other side of the wake.",
    ),
    "bourget-marichal-sphere": Try(
        "The article gives the depth of the sphere at several speeds. Compare:",
        ("calm verify bourget",),
    ),
    "braconnot-buoy": Try(
        "CALM also draws the charts from which the example comes. Compare:",
        ("calm verify braconnot buoy",),
    ),
    "cdms-1": Try(
        "Tensions of this line by two other programs are published. Compare:",
        ("calm verify cdms tension",),
    ),
    "chain-and-rope-surface": Try(
        "How uncertain are the results? Current, drag and depth are not known exactly:",
        ("calm run {file} --uncertainty --samples 256",),
        start="Uncertainty of",
    ),
    "deep-current-meters": Try(
        "Which part of the line causes most of the knockdown?",
        ("calm run {file} --explain",),
        start="What causes",
    ),
    "compact-adcp": Try(
        "The mooring is lifted as a whole. Print the parts list, the logs and other deck sheets:",
        ("calm deck {file} -o deck",),
    ),
    "depressor-fit-depth": Try(
        "The length of wire is right for one speed. How deep is the sonar at other speeds?",
        (f'{_SPEEDS} "3 knot:8 knot:1 knot"',),
    ),
    "fit-top-depth": Try(
        "The rope is cut for still water. How deep is the top in a storm?",
        ("calm run {file} --environment storm",),
        start="Top ",
    ),
    "helicopter-bird": Try(
        "How fast may the helicopter fly before the bird trails too far behind?",
        (f'{_SPEEDS} "20 knot:80 knot:20 knot"',),
    ),
    "profiler-mooring": Try(
        "The load of the profiler moves along the wire. Where is the tilt of the wire largest?",
        ("calm run {file}",),
        start="Profilers ",
    ),
    "receiver-line": Try(
        "A short line moves little. Which part causes its excursion?",
        ("calm run {file} --explain",),
        start="What causes",
    ),
    "s-tether": Try(
        "A longer tether increases the excursion of the buoy. How long may it be for 65 m?",
        ('calm size {file} --target "excursion(top) <= 65 m" --change "upper tether.length"',),
    ),
    "s1000": Try(
        "The continuous solution is known. How large is the error of CALM at each angle step?",
        ("calm verify s1000",),
    ),
    "sediment-trap-undercurrent": Try(
        "Traps do not sample beyond 10° of tilt. What causes the knockdown?",
        ("calm run {file} --explain",),
        start="What causes",
    ),
    "tall-array-mooring": Try(
        "What causes its knockdown?",
        ("calm run {file} --explain",),
        start="What causes",
    ),
    "taut-nylon-surface": Try(
        "How large is the effect of the stiffness of the nylon?",
        ("calm run {file} --uncertainty --samples 256",),
        start="Uncertainty of",
    ),
    "thermistor-string": Try(
        "How much buoyancy keeps the recorders within a metre of their depths?",
        ('calm size {file} --target "knockdown(top) <= 1 m" --change "top float.buoyancy"',),
    ),
    "tidal-adcp": Try(
        "Solve it in the ebb:",
        ("calm run {file} --environment ebb",),
        start="Top ",
    ),
    "upward-adcp-300m": Try(
        "Solve it in every profile of a record:",
        (
            "calm new --record -o record.nc",
            "calm batch {file} --currents record.nc -o moved.nc",
        ),
        picture=pictures.year,
        seen="Every hour of a synthetic year, 8760 profiles: tides move the float little, but a "
        "passing eddy knocks it down. Solved by `calm.solve_profiles` in less than a second.",
    ),
    "veering-current": Try(
        "Draw it; the plan shows how the line follows the current:",
        ("calm run {file} -o veering.png",),
        start="Top ",
        picture=pictures.veering_plan,
        seen="The line from above, coloured by depth, next to the current in the same colours: "
        "the line bends at the depths at which the current turns.",
    ),
}


def pages() -> dict[str, str | bytes]:
    """The pages and their pictures, by path in the gallery.

    Raises
    ------
    KeyError
        A file of `lines/` has nothing to try.
    """
    made: dict[str, str | bytes] = {}
    entries, groups = [], dict[str, list[str]]()
    for group, file in _in_groups(shipped_folder("lines").glob("*.yaml")):
        solved = calm.load(file).solve()
        made[f"{file.stem}.md"] = _page(file, solved.name, made)
        made[f"{file.stem}.svg"] = line_drawing(solved).encode()
        made[f"{file.stem}-schematic.svg"] = schematic_svg(solved.file, solved).encode()
        made[f"{file.stem}-small.svg"] = pictures.thumbnail(solved).encode()
        link = f"{file.stem}.md"
        small = f"[![{solved.name}]({file.stem}-small.svg)]({link})"
        row = f"| {small} | **[{solved.name}]({link})**: {solved.file.description} |"
        groups.setdefault(group, []).append(row)
        entries.append(file.stem)
    listing = "\n\n".join(
        "\n".join((f"## {group}\n", "| | |", "| --- | --- |", *rows))
        for group, rows in groups.items()
    )
    contents = "\n".join(entries)
    made["index.md"] = f"{HEAD}\n{listing}\n\n```{{toctree}}\n:hidden:\n\n{contents}\n```\n"
    return made


def _in_groups(files: Iterable[Path]) -> list[tuple[str, Path]]:
    """The files with their groups: designs, those of `LEADING` first, tows, cases."""
    groups = ("Designs", "Tows", "Cases of the literature")

    def place(file: Path) -> tuple[int, int, str]:
        towed = "\ntow:" in file.read_text(encoding="utf-8")
        group = 2 if file.stem in CASES else 1 if towed else 0
        lead = LEADING.index(file.stem) if file.stem in LEADING else len(LEADING)
        return group, lead, file.stem

    return [(groups[place(file)[0]], file) for file in sorted(files, key=place)]


def _page(file: Path, name: str, made: dict[str, str | bytes]) -> str:
    tried = TRIES[file.stem]
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / file.name
        copy.write_bytes(file.read_bytes())
        with contextlib.chdir(folder):
            table = _printed(f"calm run {file.name}")
            towed = "\ntow:" in file.read_text(encoding="utf-8")
            verdict = "" if towed else _printed(f"calm check {file.name} --allow-unknown")
            commands = [command.format(file=file.name) for command in tried.commands]
            outcome = [_printed(command) for command in commands][-1]
    outcome = outcome[outcome.find(tried.start) :] if tried.start in outcome else outcome
    parts = [
        f"# {name}",
        _comment(file),
        f"## Its shape\n\n![The shape of {name}]({file.stem}.svg)",
        f"```text\n{table}\n```",
    ]
    if verdict:
        command = f"calm check {file.name}"
        parts.append(f"## The verdict\n\n`{command}` prints:\n\n```text\n{verdict}\n```")
    parts.append(f"## One thing to try\n\n{tried.why}\n\n```sh\n" + "\n".join(commands) + "\n```")
    parts.append(f"```text\n{outcome}\n```")
    if tried.picture is not None:
        picture = f"{file.stem}-seen.svg"
        made[picture] = figure_svg(tried.picture()).encode()
        parts.append(f"![Picture]({picture})\n\n{tried.seen}")
    text = file.read_text(encoding="utf-8").rstrip()
    parts.append(f"## The file\n\n`lines/{file.name}`:\n\n```yaml\n{text}\n```")
    parts.append(f"## Its schematic\n\n![The schematic of {name}]({file.stem}-schematic.svg)")
    return "\n\n".join(parts) + "\n"


def _comment(file: Path) -> str:
    """Comment at the head of a file; indented lines become a listing."""
    lines = []
    for line in file.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        lines.append(line[1:].removeprefix(" "))
    text = "\n".join(lines).strip() + "\n"
    return re.sub(r"\n*((?:\n {2,}.+)+)\n*", r"\n\n```text\1\n```\n\n", text).strip()


def _printed(command: str) -> str:
    """Output of a command on a page of 100 columns, without trailing blanks.

    Raises
    ------
    RuntimeError
        The command fails.
    """
    os.environ.update(COLUMNS="100", NO_COLOR="1", TERM="dumb")
    printed, narrated = (io.TextIOWrapper(io.BytesIO(), "utf-8") for _ in range(2))
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(narrated):
        code = main(shlex.split(command)[1:])
    if code not in (ExitCode.DONE, ExitCode.FINDING):
        raise RuntimeError(f"{command}: exit code {int(code)}\n{_text(narrated)}")
    text = _text(printed) or _text(narrated)
    return re.sub(r" +$", "", text.strip("\n"), flags=re.MULTILINE)


def _text(stream: io.TextIOWrapper) -> str:
    """Text written to a stream."""
    stream.seek(0)
    return stream.read()
