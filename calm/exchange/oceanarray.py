"""Read a mooring configuration of oceanarray, a file `NAME.mooring.yaml`.

The keys `inline` and `clamp` list pieces and clamped instruments, with heights above the seabed. An
element library or the catalogue supplies missing values. If no rope is listed between two pieces,
CALM inserts a rope of the required length.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from calm.assemble.catalogue_search import Index
from calm.errors import InputError, Problem, refused
from calm.exchange import model
from calm.exchange.part_names import is_called
from calm.exchange.registry import register_format
from calm.exchange.table.cells import number, unit_called
from calm.exchange.table.components import component_of
from calm.exchange.table.library import Library, complete_rows, key_of, read_library
from calm.exchange.table.rows import ListRow
from calm.files import Anchor, Catalogue
from calm.files.components import FLEXIBLE_KINDS, Component
from calm.files.yaml_document import Document, read_document
from calm.positions import plain_degrees

ROPE = "rope"
"""Name of the rope inserted between pieces."""
# keys that may name a component
_NAMES = ("component_id", "label", "hardware_type", "category", "instrument")
_CLOSE = 0.05  # m: maximum distance between pieces that touch
# relative and absolute [m] tolerance of heights, most of which are given in whole metres
_OFF, _ROUNDED = 0.02, 0.5
_MARKS = re.compile(rb"^(clamp|inline|instruments) *:", re.M)
# prefixes of the keys of a position, the most accurate first
_PLACES = ("seabed", "deployment", "planned", "")
_MASS = re.compile(r"(\d+(?:\.\d+)?) *kg\b")


def is_oceanarray(content: bytes) -> bool:
    """True if a file has the keys of an oceanarray configuration."""
    return re.search(rb"^waterdepth *:", content, re.M) is not None and bool(_MARKS.search(content))


def read_oceanarray(path: Path, options: model.ImportOptions) -> model.ImportedDesign:
    """Read a configuration of oceanarray as a design.

    Raises
    ------
    InputError
        The file describes no line, a height or length is missing or wrong, or a component is in
        neither library nor catalogue.
    """
    document, problems = read_document(path), list[Problem]()
    library = {} if options.elements is None else read_library(options.elements)
    reading = _Reading(document, problems)
    depth = reading.depth = reading.metres(document.data, (), "waterdepth")
    line = reading.entries("inline")
    beside = [*reading.entries("clamp"), *reading.entries("instruments")]
    if depth is None and not problems:
        reading.refuse((), "needs `waterdepth`")
    if not line:
        message = (
            f"lists {len(beside)} instruments but no line; list all parts of the line, including "
            "floats, releases and anchor, under `inline`, each with `hab` or `length` and a name "
            "in `label`"
        )
        reading.refuse((), message)
    if len(line) + len(beside) > model.MOST_PIECES:
        reading.refuse((), f"has more than {model.MOST_PIECES} pieces")
    if problems:
        raise InputError(problems)
    parts = _ComponentFinder(reading, options.defines, library)
    design = model.ImportedDesign(
        "oceanarray", str(document.data.get("name") or path.stem), [], None
    )
    _clamp_instruments(beside, _lay_line(line, parts, design), parts)
    design.water = model.ImportedWater(
        depth, guesses={"current": "the file has no current; still water is assumed"}
    )
    design.heading = _position_and_ship(reading)
    if problems:
        raise InputError(sorted(problems, key=lambda problem: problem.line))
    return design


def listed_instruments(path: Path) -> list[tuple[int, str, str, float, Mapping[str, Any]]]:
    """List the instruments of a file that have a serial number and a height.

    Each tuple has line number, label, serial number, height above the seabed [m], and the keys and
    values of the item in the file. The `recovery_time` of the file is added to these values. Raise
    InputError if the file is damaged.
    """
    document, problems = read_document(path), list[Problem]()
    reading = _Reading(document, problems)
    reading.depth = reading.metres(document.data, (), "waterdepth")
    entries = [one for key in ("inline", "clamp", "instruments") for one in reading.entries(key)]
    if problems:
        raise InputError(problems)
    return [
        (
            document.problem(one.place, "").line,
            one.label,
            one.serial,
            one.height,
            {"recovery_time": document.data.get("recovery_time"), **one.item},
        )
        for one in entries
        if one.serial and one.height is not None
    ]


_Location = tuple[str | int, ...]
"""Location of an item in the file: keys, and list indices."""

_Found = tuple[model.ImportedComponent, str]
"""Component found for a name, and a note on the guess; the note is empty without a guess."""


@dataclass(frozen=True)
class _Entry:
    """An item in the file; heights are above the seabed [m].

    `names` are names for finding the component, the most specific first. `instrument` is
    oceanarray's word for the kind of instrument.
    """

    place: _Location
    names: tuple[str, ...]
    instrument: str
    label: str
    serial: str
    length: float | None
    middle: float | None
    bottom: float | None
    top: float | None
    count: int
    item: Mapping[str, Any]

    @property
    def height(self) -> float | None:
        given = (self.middle, self.bottom, self.top)
        return next((one for one in given if one is not None), None)

    @property
    def is_anchor(self) -> bool:
        return is_called(" ".join(self.names), "anchor")

    def lower_end(self, extent: float) -> float | None:
        if self.is_anchor:
            return 0.0
        if self.bottom is not None:
            return self.bottom
        if self.top is not None:
            return self.top - extent
        return None if self.middle is None else self.middle - 0.5 * extent


@dataclass
class _Reading:
    document: Document
    problems: list[Problem]
    depth: float | None = None

    def refuse(self, place: _Location, message: str) -> None:
        self.problems.append(self.document.problem(place, message))

    def metres(self, item: Mapping[str, Any], place: _Location, key: str) -> float | None:
        if item.get(key) is None:
            return None
        found = number(str(item[key]))
        try:
            unit = unit_called(found.rest, "length")
            if found.value is None:
                raise ValueError(found.wrong or "is empty")
            return found.value * (unit.factor if unit else 1.0)
        except ValueError as error:
            self.refuse((*place, key), f"{key}: {error}")
            return None

    def entries(self, key: str) -> list[_Entry]:
        items: Any = self.document.data.get(key) or []
        if not isinstance(items, list):
            self.refuse((key,), f"`{key}` must be a list")
            return []
        read = (self._entry(item, (key, index)) for index, item in enumerate(items))
        found = [entry for entry in read if entry is not None]
        ends = [entry.height for entry in found if entry.height is not None]
        # return the items from the top down
        rising = len(ends) > 1 and ends[0] < ends[-1]
        return found[::-1] if rising or (found and found[0].is_anchor) else found

    def _entry(self, item: Any, place: _Location) -> _Entry | None:
        if not isinstance(item, dict):
            self.refuse(place, "a list item must have keys, such as `label`")
            return None
        words = [str(item[name]).strip() for name in _NAMES if item.get(name)]
        if not words:
            self.refuse(place, f"needs a name: one of {', '.join(_NAMES)}")
            return None
        keys = ("hab", "hab_bottom", "hab_top", "depth", "length", "repeat")
        middle, bottom, top, down, length, repeat = (self.metres(item, place, key) for key in keys)
        if middle is None and down is not None and self.depth is not None:
            middle = self.depth - down
        if not 1.0 <= (repeat or 1.0) <= model.MOST_PIECES:
            self.refuse((*place, "repeat"), f"`repeat` must be from 1 to {model.MOST_PIECES}")
            return None
        instrument = str(item.get("instrument") or "").strip()
        label = str(item.get("label") or words[0]).strip()
        serial = str(item.get("serial") or "").strip().rstrip("*")
        names, count = tuple(dict.fromkeys(words)), int(repeat or 1.0)
        return _Entry(
            place, names, instrument, label, serial, length, middle, bottom, top, count, item
        )


@dataclass
class _ComponentFinder:
    reading: _Reading
    stands_for: Mapping[str, str]
    library: Library
    catalogue: Catalogue = field(default_factory=Catalogue.load)
    _known: dict[tuple[str, ...], _Found | None] = field(default_factory=dict)

    def find(self, entry: _Entry) -> _Found | None:
        message = f"neither the library nor the catalogue has `{entry.names[0]}`"
        return self._named(entry.names, entry.instrument, entry.place, message)

    def find_rope(self, entry: _Entry, between: str) -> _Found | None:
        return self._named((ROPE,), "", entry.place, f"no line is listed {between}")

    def _named(
        self, names: tuple[str, ...], instrument: str, place: _Location, message: str
    ) -> _Found | None:
        if names not in self._known:
            self._known[names] = self._found(names, instrument)
            if self._known[names] is None:
                message += (
                    f'; add it to --elements FILE, or name a component: --define "{names[0]}=ID"'
                )
                self.reading.refuse(place, message)
        return self._known[names]

    def _found(self, names: tuple[str, ...], instrument: str) -> _Found | None:
        for name in names:
            if id := self.stands_for.get(name, ""):
                return self._entry(name, id), ""
        for name in names:
            if (element := self.library.get(key_of(name))) is not None:
                row = ListRow(1, name, figures={"length": 1.0} if element.line else {})
                complete_rows([row], self.library, "the library")
                component = component_of(row, anchor=row.is_anchor)
                reading = self.reading
                reading.problems += refused(reading.document.path, *row.problems).problems
                return component, ""
        if is_called(" ".join(names), "anchor"):
            return self._anchor(names), ""
        for name in names:
            if self.catalogue.entry(name) is not None:
                return self._entry(name, name), ""
        if found := instrument and Index(self.catalogue).search(instrument):
            guess = f"the first result of `calm catalog list {instrument}`"
            return self._entry(instrument, found[0].id), guess
        return None

    def _entry(self, name: str, id: str) -> model.ImportedComponent:
        definition = self.catalogue.get(id)
        length = getattr(definition, "length", None) or 0.0
        kind = definition.kind if isinstance(definition, Component) else "body"
        kind = "anchor" if isinstance(definition, Anchor) else kind
        return model.ImportedComponent(name, kind, {"length": float(length)}, entry=id)

    def _anchor(self, names: tuple[str, ...]) -> model.ImportedComponent:
        mass = _MASS.search(" ".join(names))
        anchor = model.ImportedComponent(names[0], "anchor", {"length": 0.0})
        if mass:
            anchor.figures["mass"] = float(mass[1])
            anchor.guesses["mass"] = "the mass is from the label; steel is assumed"
        return anchor


@dataclass(frozen=True)
class _LaidLine:
    """Pieces of a line from the anchor up, with heights of their lower ends [m].

    `nominal` are the heights in the file, and `height` are the heights computed from the lengths.
    """

    items: list[model.ImportedPiece]
    nominal: list[float]
    height: list[float]


def _lay_line(
    line: list[_Entry], parts: _ComponentFinder, design: model.ImportedDesign
) -> _LaidLine:
    items: list[model.ImportedPiece] = []
    nominal, height = [0.0], [0.0]  # lower ends; the last value is that of the next piece
    if not line[-1].is_anchor:
        items.append(
            model.ImportedPiece(model.ImportedComponent("anchor", "anchor", {"length": 0.0}))
        )
        nominal, height = [0.0, 0.0], [0.0, 0.0]
        design.guessed.append(model.Remark("line.anchor", "the file has no anchor; one is added"))
    below, roped = "the anchor", 0.0

    def add(item: model.ImportedPiece, at: float, extent: float) -> None:
        items.append(item)
        nominal[-1] = at
        nominal.append(at + extent)
        height.append(height[-1] + extent)

    for entry in reversed(line):
        found = parts.find(entry)
        if found is None:
            continue
        component, guess = found
        flexible = component.kind in FLEXIBLE_KINDS
        extent = entry.length if flexible else component.number("length")
        if extent is None:
            message = f"`{entry.label}` is a line and needs a `length`"
            parts.reading.refuse(entry.place, message)
            continue
        at = nominal[-1]
        lower = None if flexible else entry.lower_end(extent * entry.count)
        if lower is not None and items:
            gap = lower - nominal[-1]
            if gap > _CLOSE and not roped:
                between = f"in the gap of {gap:.6g} m between {below} and `{entry.label}`"
                if (rope := parts.find_rope(entry, between)) is not None:
                    piece = model.ImportedPiece(
                        rope[0], gap, guess="the length follows from the heights in the file"
                    )
                    add(piece, nominal[-1], gap)
            elif roped and abs(gap) > max(_OFF * roped, _ROUNDED):
                message = (
                    f"the lines below this piece are {roped:.6g} m long, but the height of the "
                    f"piece requires {roped + gap:.6g} m"
                )
                design.guessed.append(model.Remark(entry.label, message))
            elif gap < -_CLOSE:
                message = (
                    f"overlaps the piece below by {-gap:.3g} m, and is moved up to the top of that "
                    "piece"
                )
                design.guessed.append(model.Remark(entry.label, message))
                lower = nominal[-1]
            at, below, roped = lower, f"`{entry.label}`", 0.0
        elif flexible:
            roped += extent * entry.count
        for repeat in range(entry.count):
            piece = model.ImportedPiece(
                component, extent if flexible else None, guess=guess,
                label=entry.label if entry.count == 1 else "",
                serial=entry.serial if entry.count == 1 else "",
            )  # fmt: skip
            add(piece, at + repeat * extent, extent)
    labels = [item.label for item in items]
    for item in items:
        item.label *= labels.count(item.label) == 1
    design.items = items[::-1]
    return _LaidLine(items, nominal, height)


def _clamp_instruments(beside: list[_Entry], strung: _LaidLine, parts: _ComponentFinder) -> None:
    lines = [i for i, one in enumerate(strung.items) if one.component.kind in FLEXIBLE_KINDS]
    if beside and not lines and not parts.reading.problems:
        parts.reading.refuse(("inline",), "has no line to clamp instruments on")
    nominal, height = np.array(strung.nominal), np.array(strung.height)
    for entry in beside:
        found, wanted = parts.find(entry), entry.height
        if wanted is None:
            message = f"`{entry.label}` needs `hab`, its height above the bottom"
            parts.reading.refuse(entry.place, message)
        if found is None or wanted is None or not lines:
            continue
        top = float(np.interp(wanted, nominal, height)) + max(wanted - float(nominal[-1]), 0.0)
        own = min(lines, key=lambda i: max(height[i] - top, top - height[i + 1], 0.0))
        at = float(np.clip(height[own + 1] - top, 0.0, height[own + 1] - height[own]))
        off = abs(float(height[own + 1]) - at - top)
        guess = found[1]
        if off > _CLOSE:
            guess = f"{guess}; " * bool(guess) + f"moved by {off:.3g} m to the nearest line"
        host = strung.items[own]
        host.clamp(found[0], round(at, 3), guess, f"{entry.label} {wanted:g}", entry.serial)


def _position_and_ship(reading: _Reading) -> dict[str, str]:
    data, lines = reading.document.data, dict[str, str]()
    for name in _PLACES:
        keys = [f"{name}_{what}".lstrip("_") for what in ("latitude", "longitude")]
        if not all(data.get(key) for key in keys):
            continue
        found = []
        for key in keys:
            try:
                found.append(plain_degrees(str(data[key]), key.rpartition("_")[2]))
            except ValueError as error:
                reading.refuse((key,), f"{key}: `{data[key]}` {error}")
        if len(found) == 2:
            place = (f"{angle:.6f}".rstrip("0").rstrip(".") for angle in found)
            latitude, longitude = place
            lines["position"] = f"{{latitude: {latitude} deg, longitude: {longitude} deg}}"
        break
    renamed = {"ship": "deployment_ship", "cruise": "deployment_cruise"}
    known = {key: data.get(key) or data.get(other) for key, other in renamed.items()}
    if any(known.values()):
        from calm.exchange.design_writer import quoted

        text = ", ".join(f"{key}: {quoted(str(value))}" for key, value in known.items() if value)
        lines["document"] = f"{{{text}}}"
    return lines


register_format(
    "oceanarray", is_oceanarray, read_oceanarray, program="oceanarray", takes_elements=True
)
