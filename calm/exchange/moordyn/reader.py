"""Read a MoorDyn or MoorPy file as a design: a single line, or a net of legs."""

from __future__ import annotations

import math
import re
from collections import defaultdict
from collections.abc import Collection
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from calm.errors import refused
from calm.exchange import model
from calm.files.definition import CATALOGUE_DENSITY, STANDARD_GRAVITY
from calm.whole_file import read_text

_FREE = ("free", "connect", "point")
_CURRENTS = "current_profile.txt"
_STEADY = ("1", "3")  # values of `Currents` for a steady current
_NEAR, _NEAR_AT_LEAST = 0.05, 2.0
"""Maximum depth of an upper end that is treated as attached to a float: a share of the water depth,
or a depth [m], whichever is greater.
"""

_ABOVE = 0.01  # m: a point higher than this is held above the water

_NOTE = "cn and ct are Cd and CdAx of MoorDyn, without conversion. See `calm docs import-moordyn`."

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
class _File:
    """Contents of a MoorDyn file: points and line types by name, and lines.

    `at` has the lines that meet at each point, by point name. `depth` is the water depth [m].
    Pieces are added to `design`.
    """

    points: dict[str, _Row]
    types: dict[str, _Row]
    lines: list[_Row]
    at: dict[str, list[_Row]]
    depth: float
    gravity: float
    design: model.ImportedDesign

    def piece(self, line: _Row) -> model.ImportedPiece:
        kind = self.types.get(line.words.get("type", ""))
        if kind is None:
            raise line.refuse(f"line type `{line.words.get('type')}` is not defined in the file")
        length = line.number("length")
        if length <= 0.0:
            raise line.refuse("a line has no length")
        return model.ImportedPiece(_cable(kind, self.gravity), length)

    def walk(
        self, start: str, left: list[_Row], breaks: Collection[str]
    ) -> tuple[list[str], list[_Row]]:
        """Follow lines from the point `start` to the next point in `breaks`, or to the last point.

        Only lines in `left` are followed. Return the points and lines on the path, and remove these
        lines from `left`.
        """
        names, lines = [start], list[_Row]()
        while not lines or names[-1] not in breaks:
            line = next((line for line in self.at[names[-1]] if line in left), None)
            if line is None:
                break
            lines.append(line)
            left.remove(line)
            a, b = line.ends
            names.append(b if a == names[-1] else a)
        return names, lines

    def along(
        self, names: list[str], lines: list[_Row], placed: set[str]
    ) -> list[model.ImportedPiece]:
        """Convert successive lines, and the buoys or weights at their points, to pieces in order.

        `names` are the points along these lines. Points in `placed` are already converted and give
        no piece. All points in `names` are added to `placed`.
        """
        items: list[model.ImportedPiece] = []
        for at, line in zip(names, [*lines, None], strict=True):
            if not _is_held(self.points[at]) and at not in placed:
                there = _piece_at(self.points[at])
                items += [] if there is None else [there]
            placed.add(at)
            items += [] if line is None else [self.piece(line)]
        return items


def read_moordyn(path: Path) -> model.ImportedDesign:
    """Read a MoorDyn file with one line from anchor to float, or with a net of legs.

    Raises
    ------
    InputError
        The file cannot be read, or contains a body or a rod.
    """
    tables, options = _read_sections(path)
    for name in ("bodies", "rods"):
        for row in tables[name]:
            raise row.refuse(f"{name}: CALM does not support the bodies and rods of MoorDyn")
    points = {row.words.get("id", ""): row for row in tables["points"]}
    lines = tables["lines"]
    if not points or not lines:
        raise refused(path, f"has {len(points)} points and {len(lines)} lines; it needs both")
    if len(lines) > model.MOST_PIECES:
        raise refused(path, f"has {len(lines)} lines; more than {model.MOST_PIECES} cannot be read")
    at: dict[str, list[_Row]] = {}
    for line in lines:
        for name in line.ends:
            if name not in points:
                raise line.refuse(f"the end `{name}` of this line is not a point of the file")
            at.setdefault(name, []).append(line)
    lowest = min(point.number("z") for point in points.values())
    depth = _option(options, "wtrdpth", "depth", default=-lowest)
    if depth <= 0.0:
        raise refused(path, "has no water depth (`WtrDpth`)")
    density = _option(options, "wtrdnsty", "rhow", "rho", default=CATALOGUE_DENSITY)
    gravity = _option(options, "g", "gravity", default=STANDARD_GRAVITY)  # MoorDyn's default
    kind, beside = options.get("currents", "0"), path.with_name(_CURRENTS)
    current = _currents(beside) if kind in _STEADY and beside.is_file() else ()
    water = model.ImportedWater(depth, density, gravity, current)
    design = model.ImportedDesign("MoorDyn", path.stem, [], water, notes=[_NOTE])
    if kind not in ("0", "none") and not current:
        lacks = (
            f"but {_CURRENTS} is missing" if kind in _STEADY else "for currents that vary in time"
        )
        design.dropped.append(
            model.Remark("current", f"`Currents` is {kind}, {lacks}; still water is assumed")
        )
    if options.get("wavekin", "0") not in ("0", "none"):
        design.dropped.append(model.Remark("waves", f"`WaveKin` {options['wavekin']}"))
    types = {row.words.get("name", ""): row for row in tables["types"]}
    file = _File(points, types, lines, at, depth, gravity, design)
    design.dropped.append(model.Remark("line types", "damping, bending stiffness, added mass"))
    single = _single_line(file)
    if single is None:
        _lay_net(file, path)
        return design
    names, down = single
    items = file.along(names, down, {names[0], names[-1]})
    anchor = model.ImportedPiece(_anchor_of(points[names[-1]], depth))
    design.items = [_upper_float(points[names[0]]), *items, anchor]
    return design


def _single_line(file: _File) -> tuple[list[str], list[_Row]] | None:
    """Return points and lines of a single line from the top down; return None for a net."""
    points, ends = file.points, [name for name, met in file.at.items() if len(met) == 1]
    if len(ends) != 2 or any(len(met) > 2 for met in file.at.values()):
        return None
    ends.sort(key=lambda name: points[name].number("z"))
    held = [name for name, point in points.items() if name in file.at and _is_held(point)]
    top = points[ends[1]]
    near = -_ABOVE <= 0.0 - top.number("z") <= max(_NEAR * file.depth, _NEAR_AT_LEAST)
    floats = not _is_held(top) or (near and _lift(_figures(top)) > 0.0)
    if ends[0] not in held or {*held} - {*ends} or not floats:
        return None
    left = list(file.lines)
    found = file.walk(ends[1], left, ())
    return None if left else found


def _lift(figures: dict[str, model.FigureOrWord]) -> float:
    """Return the net buoyancy of a point in water as a mass [kg]."""
    return CATALOGUE_DENSITY * float(figures["volume"]) - float(figures["mass"])


def _is_held(point: _Row) -> bool:
    # other points are fixed, or move with a vessel
    return not point.words.get("attachment", "").lower().startswith(_FREE)


def _option(options: dict[str, str], *names: str, default: float) -> float:
    for name in names:
        with suppress(KeyError, ValueError):
            return abs(float(options[name]))
    return default


def _currents(path: Path) -> tuple[tuple[float, float, float, float], ...]:
    rows = []
    for line in read_text(path).splitlines():
        try:
            z, u, v, w = (float(word) for word in line.split()[:4])
        except ValueError:
            continue  # a line of the header
        if z <= 0.0:
            rows.append((0.0 - z, u, v, w))
    return tuple(sorted(rows))


def _cable(kind: _Row, gravity: float) -> model.ImportedComponent:
    across = kind.number("diameter")
    if across <= 0.0:
        raise kind.refuse("a line type has no diameter")
    mass = kind.number("mass")
    wet = (mass - CATALOGUE_DENSITY * (math.pi / 4.0 * across**2)) * gravity
    figures: dict[str, model.FigureOrWord] = {
        "diameter": across, "cn": kind.number("cd", 0.0), "ct": kind.number("cdt", 0.0),
    }  # fmt: skip
    name = kind.words["name"]
    component = model.ImportedComponent.of_line(name, wet, figures)
    component.figures["mass"] = mass
    if (stiffness := kind.number("ea", 0.0)) > 0.0:
        component.figures["stiffness"] = stiffness
    return component


def _piece_at(point: _Row) -> model.ImportedPiece | None:
    figures = _figures(point)
    if not any(figures[key] for key in ("mass", "volume", "drag_area")):
        return None
    figures["role"] = "float" if _lift(figures) > 0.0 else "instrument"
    return model.ImportedPiece(
        model.ImportedComponent(f"point {point.words['id']}", "body", figures)
    )


def _figures(point: _Row) -> dict[str, model.FigureOrWord]:
    for key in ("fx", "fy", "fz"):
        if point.number(key, 0.0) != 0.0:
            raise point.refuse(f"`{key}` is an external force, which CALM does not support")
    return {
        "length": 0.0, "drag_area": point.number("cda", 0.0), "cd": 1.0,
        "mass": point.number("mass", 0.0), "volume": point.number("volume", 0.0),
    }  # fmt: skip


def _upper_float(top: _Row) -> model.ImportedPiece:
    figures = _figures(top)
    if _lift(figures) <= 0.0:
        raise top.refuse("the upper end is free but not buoyant")
    reason = "the upper end is fixed in the file; in CALM it is a float that is free to move"
    guess = {"volume": reason} if _is_held(top) else {}
    name = f"point {top.words['id']}"
    return model.ImportedPiece(
        model.ImportedComponent(name, "body", {**figures, "role": "float"}, guess)
    )


def _anchor_of(point: _Row, depth: float) -> model.ImportedComponent:
    height = depth + point.number("z")
    return model.ImportedComponent("anchor", "anchor", {"length": height} if height > 1e-6 else {})


@dataclass(frozen=True)
class _Row:
    path: str
    line: int
    words: dict[str, str]  # by heading; common headings are replaced by `_COLUMNS`

    @property
    def ends(self) -> tuple[str, str]:
        return self.words.get("a", ""), self.words.get("b", "")

    def number(self, key: str, default: float | None = None) -> float:
        text = self.words.get(key)
        if text is None and default is not None:
            return default
        try:
            value = float((text or "").split("|")[0])
        except ValueError:
            raise self.refuse(f"`{key}` is `{text or ''}`, which is not a number") from None
        if abs(value) > 1e15 or value != value:
            raise self.refuse(f"`{key}` is {value:g}")
        return value

    def refuse(self, message: str) -> Exception:
        return refused(self.path, message, line=self.line)


def is_moordyn(content: bytes) -> bool:
    """True if a file has sections for line types and lines, which every MoorDyn file needs."""
    text = content.decode("latin-1").lower()
    found = {_section(line) for line in text.splitlines() if line.strip().startswith("---")}
    return b"\0" not in content and {"types", "lines"} <= found


def _read_sections(path: Path) -> tuple[dict[str, list[_Row]], dict[str, str]]:
    tables, options = defaultdict[str, list[_Row]](list), dict[str, str]()
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
                raise refused(path, f"the row has only {len(words)} values", line=number)
            kept = dict(zip(headings, words, strict=False))
            tables[current].append(_Row(str(path), number, kept))
    return tables, options


def _section(line: str) -> str | None:
    title = line.strip().strip("-").strip()
    return next((name for name, pattern in _SECTIONS if re.search(pattern, title)), None)


def _heading(word: str, section: str) -> str:
    plain = word.lower().strip("()#*")
    if section == "types" and plain in ("linetype", "type", "name", "typename"):
        return "name"
    return _COLUMNS.get(plain, plain)


_ON_THE_BED = 0.05
"""Height above the seabed, relative to the water depth, up to which a fixed point is an anchor."""


def _lay_net(file: _File, path: Path) -> None:
    """Divide the lines into legs.

    A leg ends at a point that is held, that is a free end, or that joins three or more lines.
    """
    breaks = [name for name, met in file.at.items() if len(met) != 2 or _is_held(file.points[name])]
    left, placed = list(file.lines), set[str]()
    for start in breaks:
        while any(line in left for line in file.at[start]):
            names, lines = file.walk(start, left, breaks)
            anchored = [_is_anchor(file, names[end]) for end in (0, -1)]
            rise = file.points[names[-1]].number("z") - file.points[names[0]].number("z")
            if all(anchored):
                if len(lines) == 1:
                    raise lines[0].refuse(
                        "both ends are anchors, but a leg has only one, at its lower end"
                    )
                top = max(names[1:-1], key=lambda name: file.points[name].number("z"))
                k = names.index(top)
                halves = [(names[k::-1], lines[:k][::-1]), (names[k:], lines[k:])]
            elif anchored[0] or (not anchored[1] and rise > 0.0):  # it leads up
                halves = [(names[::-1], lines[::-1])]
            else:
                halves = [(names, lines)]
            for half in halves:
                _lay_leg(file, *half, placed)
    if left or not breaks:
        raise refused(path, "has lines that form a ring without a fixed point")


def _is_anchor(file: _File, name: str) -> bool:
    point = file.points[name]
    fixed = _is_held(point) and point.words["attachment"].lower().startswith(("fix", "anchor"))
    return fixed and point.number("z") <= -(1.0 - _ON_THE_BED) * file.depth


def _lay_leg(file: _File, names: list[str], lines: list[_Row], placed: set[str]) -> None:
    # a part at a point belongs to the first leg that reaches the point
    items = file.along(names, lines, placed)
    upper, lower = (_connection(file, at) for at in (names[0], names[-1]))
    if _is_anchor(file, names[-1]):
        point = file.points[names[-1]]
        items.append(model.ImportedPiece(_anchor_of(point, file.depth)))
        depth = 0.0 - point.number("z")
        deeper = depth if depth > file.depth else None
        lower = model.anchored_at(point.number("x"), point.number("y"), deeper)
    file.design.lay(items, upper, lower)


def _connection(file: _File, name: str) -> str:
    point = file.points[name]
    if _is_held(point):
        east, north, up = (point.number(axis) for axis in "xyz")
        return model.held_at(0.0 - up, east, north)
    return model.joined_at(f"point-{name}") if len(file.at[name]) > 1 else "free"
