"""Read a MoorDyn or MoorPy file as a design: a single line, or a net of legs."""

from __future__ import annotations

import math
import re
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

from calm.exchange.design import (
    MOST_PIECES,
    Design,
    FigureOrWord,
    ImportedComponent,
    ImportedPiece,
    ImportedWater,
    Remark,
    is_chain,
    refused,
    refused_at,
)
from calm.files.definition import CATALOGUE_DENSITY, STANDARD_GRAVITY
from calm.whole_file import read_text

_FREE = ("free", "connect", "point")
_CURRENTS = "current_profile.txt"
_STEADY = ("1", "3")  # of `Currents`; the others vary in time
_NEAR, _NEAR_AT_LEAST = 0.05, 2.0
"""Share of the depth, and metres: an upper end so near the surface hangs under a float."""

_ABOVE = 0.01  # m: what is higher is held above the water

_NOTE = "cn and ct are its Cd and CdAx, defined alike. See `calm docs import-moordyn`."

_SECTIONS = (
    ("types", r"line (types|dictionary)"),
    ("points", r"(node|connection|point) properties|^points?( list)?$|connections"),
    ("lines", r"line properties|^lines?( list)?$"),
    ("bodies", r"bod(y|ies)"),
    ("rods", r"^rods?\b(?!.*types)"),
    ("rod types", r"rod (types|dictionary)"),
    ("options", r"options"),
    ("outputs", r"outputs?"),
)
_COLUMNS = {
    "typename": "name", "name": "name", "linetype": "type", "type": "attachment",
    "attachment": "attachment", "diam": "diameter", "mass/m": "mass", "massden": "mass",
    "massdeninair": "mass", "massperlength": "mass", "mass/length": "mass", "ea": "ea",
    "cd": "cd", "cdn": "cd", "cdax": "cdt", "cdt": "cdt", "id": "id", "node": "id", "line": "id",
    "x": "x", "y": "y", "z": "z", "m": "mass", "mass": "mass", "v": "volume", "volume": "volume",
    "cda": "cda", "fx": "fx", "fy": "fy", "fz": "fz", "unstrlen": "length", "nodeanch": "a",
    "nodefair": "b", "nodea": "a", "nodeb": "b", "attacha": "a", "attachb": "b",
}  # fmt: skip


@dataclass(frozen=True)
class MoorDynFile:
    """Hold the tables of a file: points and line types by name, lines, and the design begun.

    Attributes
    ----------
    points, types, lines : rows
    at : the lines that meet in each point
    design : its water, and what is left out
    """

    points: dict[str, SectionRow]
    types: dict[str, SectionRow]
    lines: list[SectionRow]
    at: dict[str, list[SectionRow]]
    design: Design

    @property
    def water(self) -> ImportedWater:
        """The water, whose depth and gravity are known."""
        assert self.design.water is not None
        return self.design.water

    def piece(self, line: SectionRow) -> ImportedPiece:
        """Return a line as a piece (InputError: it has no type, or no length)."""
        kind = self.types.get(line.words.get("type", ""))
        if kind is None:
            raise line.refuse(f"line type `{line.words.get('type')}` is defined nowhere")
        length = line.number("length")
        if length <= 0.0:
            raise line.refuse("a line has no length")
        assert self.water.gravity is not None
        return ImportedPiece(_cable(kind, self.water.gravity), length)


def read_moordyn(path: Path) -> Design:
    """Read a file: a single line from an anchor up to a float, or a net of legs.

    InputError: it cannot be read, or holds a body or a rod.
    """
    tables, options = _read_sections(path)
    for name in ("bodies", "rods"):
        for row in tables[name]:
            raise row.refuse(f"{name}: CALM has moorings without bodies and rods of MoorDyn")
    points = {row.words.get("id", ""): row for row in tables["points"]}
    lines = tables["lines"]
    if not points or not lines:
        raise refused(path, f"has {len(points)} points and {len(lines)} lines")
    if len(lines) > MOST_PIECES:
        raise refused(path, f"has {len(lines)} lines; more than {MOST_PIECES} are not read")
    at: dict[str, list[SectionRow]] = {}
    for line in lines:
        for name in ends_of(line):
            if name not in points:
                raise line.refuse(f"its end `{name}` is not a point of the file")
            at.setdefault(name, []).append(line)
    design = Design("MoorDyn", path.stem, [], None, notes=[_NOTE])
    design.water = _water(options, points, path, design.dropped)
    types = {row.words.get("name", ""): row for row in tables["types"]}
    file = MoorDynFile(points, types, lines, at, design)
    design.dropped.append(Remark("line types", "damping, bending stiffness, added mass"))
    chain = _from_the_anchor(file)
    if chain is None:
        from calm.exchange.moordyn_net import lay_net

        lay_net(file, path)
        return design
    items = []
    for name, line in chain:
        if name != chain[0][0] and (there := point_of(points[name])) is not None:
            items.append(there)
        items.append(file.piece(line))
    anchor = ImportedPiece(anchor_of(points[chain[0][0]], file.water))
    top = points[other_end(chain[-1][1], chain[-1][0])]
    design.items = [_upper_end(top), *items[::-1], anchor]
    return design


def _from_the_anchor(file: MoorDynFile) -> list[tuple[str, SectionRow]] | None:
    """Return the lines of a single line from its anchor up, each with the point at its lower end;
    None where it is a net.
    """
    points = file.points
    ends = [name for name, met in file.at.items() if len(met) == 1]
    if len(ends) != 2 or any(len(met) > 2 for met in file.at.values()):
        return None
    ends.sort(key=lambda name: points[name].number("z"))
    lower, upper = (points[name] for name in ends)
    joints = [points[name] for name in file.at if name not in ends]
    if not is_held(lower) or any(is_held(joint) for joint in joints) or not _floats(upper, file):
        return None
    chain: list[tuple[str, SectionRow]] = []
    here, left = ends[0], list(file.lines)
    while met := [each for each in left if here in ends_of(each)]:
        chain.append((here, met[0]))
        left.remove(met[0])
        here = other_end(met[0], here)
    return None if left else chain


def _floats(top: SectionRow, file: MoorDynFile) -> bool:
    """Return whether an upper end is free, or a float that is held where it would float."""
    if not is_held(top):
        return True
    assert file.water.depth is not None
    depth, figures = 0.0 - top.number("z"), _figures(top)
    near = -_ABOVE <= depth <= max(_NEAR * file.water.depth, _NEAR_AT_LEAST)
    return near and _lift(figures) > 0.0


def _lift(figures: dict[str, FigureOrWord]) -> float:
    """What a point lifts, as a mass [kg]."""
    return CATALOGUE_DENSITY * float(figures["volume"]) - float(figures["mass"])


def ends_of(line: SectionRow) -> tuple[str, str]:
    """Return the names of the points at the ends of a line."""
    return line.words.get("a", ""), line.words.get("b", "")


def other_end(line: SectionRow, name: str) -> str:
    """Return the name of the point at the other end of a line."""
    a, b = ends_of(line)
    return b if a == name else a


def is_held(point: SectionRow) -> bool:
    """Return whether a point is fixed, or moves with a vessel."""
    return not point.words.get("attachment", "").lower().startswith(_FREE)


def _water(
    options: dict[str, str], points: dict[str, SectionRow], path: Path, dropped: list[Remark]
) -> ImportedWater:
    lowest = min(point.number("z") for point in points.values())
    depth = _option(options, "wtrdpth", "depth", default=-lowest)
    if depth <= 0.0:
        raise refused(path, "gives no depth of the water (`WtrDpth`)")
    water = ImportedWater(depth)
    water.density = _option(options, "wtrdnsty", "rhow", "rho", default=CATALOGUE_DENSITY)
    water.gravity = _option(options, "g", "gravity", default=STANDARD_GRAVITY)  # its own
    kind, beside = options.get("currents", "0"), path.with_name(_CURRENTS)
    if kind in _STEADY and beside.is_file():
        water.current = _currents(beside)
    elif kind not in ("0", "none"):
        lacks = f"without {_CURRENTS} beside the file" if kind in _STEADY else "which vary in time"
        dropped.append(Remark("current", f"`Currents` {kind}, {lacks}: the water is still"))
    if options.get("wavekin", "0") not in ("0", "none"):
        dropped.append(Remark("waves", f"`WaveKin` {options['wavekin']}"))
    return water


def _option(options: dict[str, str], *names: str, default: float) -> float:
    for name in names:
        try:
            return abs(float(options[name]))
        except (KeyError, ValueError):
            continue
    return default


def _currents(path: Path) -> tuple[tuple[float, float, float, float], ...]:
    rows = []
    for line in read_text(path).splitlines():
        try:
            z, u, v, w = (float(word) for word in line.split()[:4])
        except ValueError:
            continue  # its head
        if z <= 0.0:
            rows.append((0.0 - z, u, v, w))
    return tuple(sorted(rows))


def _cable(kind: SectionRow, gravity: float) -> ImportedComponent:
    """Return a line type; its weight in water follows from its mass and the water it displaces."""
    across = kind.number("diameter")
    if across <= 0.0:
        raise kind.refuse("a line type has no diameter")
    mass = kind.number("mass")
    volume = math.pi / 4.0 * across**2
    wet = (mass - CATALOGUE_DENSITY * volume) * gravity
    figures: dict[str, FigureOrWord] = {
        "diameter": across, "cn": kind.number("cd", 0.0), "ct": kind.number("cdt", 0.0),
    }  # fmt: skip
    name = kind.words["name"]
    component = ImportedComponent.of_line(name, wet, figures, chain=is_chain(name))
    component.figures["mass"] = mass
    stiffness = kind.number("ea", 0.0)
    if stiffness > 0.0:
        component.figures["stiffness"] = stiffness
    return component


def point_of(point: SectionRow) -> ImportedPiece | None:
    """Return what is at a free point; None where it has neither weight nor drag."""
    figures = _figures(point)
    if not any(figures[key] for key in ("mass", "volume", "drag_area")):
        return None
    figures["role"] = "float" if _lift(figures) > 0.0 else "instrument"
    return ImportedPiece(ImportedComponent(f"point {point.words['id']}", "body", figures))


def _figures(point: SectionRow) -> dict[str, FigureOrWord]:
    for key in ("fx", "fy", "fz"):
        if point.number(key, 0.0) != 0.0:
            raise point.refuse(f"`{key}` pulls at the line from outside")
    return {
        "length": 0.0, "drag_area": point.number("cda", 0.0), "cd": 1.0,
        "mass": point.number("mass", 0.0), "volume": point.number("volume", 0.0),
    }  # fmt: skip


def _upper_end(top: SectionRow) -> ImportedPiece:
    """Return the float: a free point, or one that is held at the surface and would float there."""
    figures, guess = _figures(top), {}
    if _lift(figures) <= 0.0:
        raise top.refuse("the upper end is free, and does not float")
    if is_held(top):
        guess["volume"] = "the file holds the upper end; here a float of its point, free to move"
    name = f"point {top.words['id']}"
    return ImportedPiece(ImportedComponent(name, "body", {**figures, "role": "float"}, guess))


def anchor_of(point: SectionRow, water: ImportedWater) -> ImportedComponent:
    """Return an anchor as high as its point stands above the seabed."""
    assert water.depth is not None
    height = water.depth + point.number("z")
    return ImportedComponent("anchor", "anchor", {"length": height} if height > 1e-6 else {})


@dataclass(frozen=True)
class SectionRow:
    """Hold a row of a table: its words by heading, and its place in the file."""

    path: str
    line: int
    words: dict[str, str]

    def number(self, key: str, default: float | None = None) -> float:
        """Return a word as a number (InputError: it is missing, or no number)."""
        text = self.words.get(key)
        if text is None and default is not None:
            return default
        try:
            value = float((text or "").split("|")[0])
        except ValueError:
            raise self.refuse(f"`{key}` is `{text or ''}`, no number") from None
        if abs(value) > 1e15 or value != value:
            raise self.refuse(f"`{key}` is {value:g}")
        return value

    def refuse(self, message: str) -> Exception:
        """Return a problem in this row."""
        return refused_at(self.path, self.line, 1, message)


def is_moordyn(content: bytes) -> bool:
    """Return whether a file has the sections that each such file must have."""
    text = content.decode("latin-1").lower()
    found = {_section(line) for line in text.splitlines() if line.strip().startswith("---")}
    return b"\0" not in content and {"types", "lines"} <= found


def _read_sections(path: Path) -> tuple[dict[str, list[SectionRow]], dict[str, str]]:
    """Return the tables of a file, none with a row of too few words, and its options."""
    tables, options = defaultdict[str, list[SectionRow]](list), dict[str, str]()
    current, headings, skip = "", list[str](), 0
    for number, text in enumerate(read_text(path).splitlines(), 1):
        line = text.split("#")[0] if not text.lstrip().startswith("(") else text
        if line.strip().startswith("---"):
            current, headings, skip = _section(line.lower()) or "", [], 2
        elif not line.strip() or not current or current == "outputs":
            continue
        elif current == "options":
            words = line.split()
            if len(words) >= 2:
                options.setdefault(words[1].lower(), words[0])
        elif skip:
            skip -= 1
            if skip == 1:
                headings = [_heading(word, current) for word in line.split()]
        else:
            words = line.split()
            if len(words) < min(len(headings), 4):
                raise refused_at(str(path), number, 1, f"the row has {len(words)} words")
            kept = dict(zip(headings, words, strict=False))
            tables[current].append(SectionRow(str(path), number, kept))
    return tables, options


def _section(line: str) -> str | None:
    title = line.strip().strip("-").strip()
    return next((name for name, pattern in _SECTIONS if re.search(pattern, title)), None)


def _heading(word: str, section: str) -> str:
    plain = word.lower().strip("()#*")
    if section == "types" and plain in ("linetype", "type", "name", "typename"):
        return "name"
    return _COLUMNS.get(plain, plain)
