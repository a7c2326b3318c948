"""Write a design as a mooring file, with a comment for each guessed value."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from itertools import groupby
from textwrap import wrap

from calm.errors import one_line
from calm.exchange import model
from calm.exchange.component_ids import ids_of
from calm.files import Catalogue
from calm.files.components import FLEXIBLE_KINDS
from calm.files.editing.writing import written
from calm.units import KILOGRAM_FORCE
from calm.version import __version__

_WIDTH = 100
_UNITS = {
    "diameter": "m", "length": "m", "volume": "m^3", "drag_area": "m^2", "wind_area": "m^2",
    "kn": "N/(m/s)^2", "kt": "N/(m/s)^2", "k_surface": "N/(m/s)^2", "lift": "N/(m/s)^2",
    "stiffness": "kN", "breaking_load": "kN", "working_load": "kN", "density": "kg/m^3",
    "depth_rating": "m",
}  # fmt: skip
_FORCES = {"buoyancy", "weight"}


@dataclass
class _Page:
    lines: list[str] = field(default_factory=list)
    guessed: list[model.Remark] = field(default_factory=list)

    def add(self, line: str = "", guess: str = "", where: str = "", comment: str = "") -> None:
        if guess:
            guess = one_line(guess)
            self.guessed.append(model.Remark(where, guess))
            line += f"  # guessed: {guess}"
        elif comment:
            line += f"  # {comment}"
        self.lines.append(line)

    def remark(self, text: str, indent: str = "") -> None:
        self.lines += [f"{indent}# {line}" for line in wrap(text, _WIDTH - len(indent) - 2)]


def mooring_text(design: model.ImportedDesign, source: str) -> tuple[str, list[model.Remark]]:
    """Write a design as the text of a mooring file; also return the guesses in this file."""
    page, of = _Page(), f"{one_line(source)}, a design of {design.program}"
    page.remark(
        f"CALM {__version__} imported this design from {of}. The values are from that file."
    )
    for note in design.notes:
        page.remark(one_line(note))
    if design.dropped:
        page.add("# Omitted:")
        for remark in design.dropped:
            page.remark(f"- {one_line(str(remark))}")
    page.add()
    page.add(f"name: {quoted(design.name)}")
    if design.description:
        page.add(f"description: {quoted(design.description)}")
    page.lines += [f"{key}: {value}" for key, value in design.heading.items()]
    page.add()
    if design.tow is not None:
        height = f", height: {_number(design.tow.height)} m" if design.tow.height else ""
        toward = f"toward: {_number(design.tow.toward)} deg"
        page.add(f"tow: {{speed: {_number(design.tow.speed)} m/s, {toward}{height}}}")
        page.add()
    if design.environment:
        page.lines += design.environment
        page.add()
    elif design.water is not None:
        _write_water(page, design.water)
    ids = ids_of(design.components(), Catalogue.load().ids())
    if design.legs:
        page.add("legs:  # each from its upper to its lower end")
    else:
        page.add("line:" + (" # from the ship down" if design.tow else " # top to bottom"))
        for item in _combine_repeated(design.items):
            _write_item(page, item, ids)
    for leg in design.legs:
        page.lines += [f"  {leg.name}:", "    line:"]
        own = _Page(guessed=page.guessed)
        for item in _combine_repeated(leg.items):
            _write_item(own, item, ids)
        page.lines += [f"    {line}" for line in own.lines]
        ends = (("top", leg.top), ("bottom", leg.bottom))
        page.lines += [f"    {name}: {end}" for name, end in ends if end]
    page.add()
    if design.solver:
        page.add("solver:")
        for key, (value, comment) in design.solver.items():
            shown = _number(value) if isinstance(value, float) else value
            page.add(f"  {key}: {shown}", comment=comment)
        page.add()
    defined = {ids[id(each)]: each for each in design.components() if not each.entry}
    if defined:
        page.add("components:")
    for id_, component in defined.items():
        _write_component(page, component, id_, design.in_kilograms)
    return "\n".join(page.lines) + "\n", page.guessed


def _number(value: float) -> str:
    return f"{value:.9g}"


def quoted(text: str) -> str:
    """Format a text as a YAML scalar on a single line, without quotes if possible."""
    return written(one_line(text), flow=True)


def _write_water(page: _Page, water: model.ImportedWater) -> None:
    page.add("environment:")
    if water.depth is not None:
        _keyed(page, "depth", f"{_number(water.depth)} m", water)
    if isinstance(water.density, tuple):
        page.add("  density:")
        _write_rows(page, "depth m, density kg/m^3", water.density)
    elif water.density is not None:
        _keyed(page, "density", f"{_number(water.density)} kg/m^3", water)
    if water.gravity is not None:
        _keyed(page, "gravity", f"{_number(water.gravity)} m/s^2", water)
    if water.current:
        page.add("  current:", water.guesses.get("current", ""), "environment.current")
        if any(row[3] for row in water.current):
            _write_rows(page, "depth m, u m/s, v m/s, w m/s", water.current)
        else:
            _write_rows(page, "depth m, u m/s, v m/s", [row[:3] for row in water.current])
    elif "current" in water.guesses:
        _keyed(page, "current", "{speed: 0 m/s, toward: 0 deg}", water)
    if water.wind is not None:
        speed, toward = water.wind
        page.add(f"  wind: {{speed: {_number(speed)} m/s, toward: {_number(toward)} deg}}")
    page.add()


def _write_rows(page: _Page, columns: str, rows: Iterable[Iterable[float]]) -> None:
    page.lines += [f"    columns: [{columns}]", "    rows:"]
    page.lines += [f"      - [{', '.join(map(_number, row))}]" for row in rows]


def _keyed(page: _Page, key: str, value: str, water: model.ImportedWater) -> None:
    page.add(f"  {key}: {value}", water.guesses.get(key, ""), f"environment.{key}")


def _combine_repeated(items: list[model.ImportedPiece]) -> list[model.ImportedPiece]:
    def what(item: model.ImportedPiece) -> object:
        if item.clamps or item.guess or _label_keys(item):
            return id(item)
        return item.component.identity(), item.length, item.component.entry

    groups = ([*group] for _, group in groupby(items, what))
    return [replace(group[0], count=sum(each.count for each in group)) for group in groups]


def _write_item(page: _Page, item: model.ImportedPiece, ids: dict[int, str]) -> None:
    use = ids[id(item.component)]
    pairs = [f"use: {use}"]
    if item.length is not None:
        pairs.append(f"length: {_number(item.length)} m")
    if item.count > 1:
        pairs.append(f"count: {item.count}")
    pairs += _label_keys(item)
    where = f"line.{item.label or use}"
    if not item.clamps:
        page.add(f"  - {{{', '.join(pairs)}}}", item.guess, where)
        return
    page.add(f"  - {pairs[0]}", item.guess, where)
    page.lines += [*(f"    {pair}" for pair in pairs[1:]), "    clamps:"]
    for clamp in item.clamps:
        clamped = ids[id(clamp.component)]
        pairs = [f"use: {clamped}", f"at: {_number(clamp.at)} m", *_label_keys(clamp)]
        where_clamped = f"{where}.clamps.{clamp.label or clamped}"
        page.add(f"      - {{{', '.join(pairs)}}}", clamp.guess, where_clamped)


def _label_keys(item: model.ImportedPiece | model.ImportedClamp) -> list[str]:
    named = (("label", item.label), ("serial", item.serial))
    planned = item.planned_depth
    depth = [] if planned is None else [f"planned_depth: {_number(planned)} m"]
    return [f"{key}: {quoted(text)}" for key, text in named if text] + depth


def _write_component(
    page: _Page, component: model.ImportedComponent, id_: str, in_kilograms: bool
) -> None:
    page.add(f"  {id_}:")
    if component.comment:
        page.remark(one_line(component.comment), "    ")
    page.add(f"    kind: {component.kind}")
    name = one_line(component.name)
    if name and name != id_:
        page.add(f"    name: {quoted(name)}")
    per_metre = component.kind in FLEXIBLE_KINDS
    for key, value in component.figures.items():
        text = figure_text(key, value, per_metre=per_metre, in_kilograms=in_kilograms)
        guess = component.guesses.get(key, "")
        page.add(f"    {key}: {text}", guess, f"components.{id_}.{key}")
    if component.hull:
        guess = component.guesses.get("hull", "")
        page.add("    hull:", guess, f"components.{id_}.hull")
        page.add("      displacement:")
        for draft, volume, area in component.hull:
            row = f"[{_number(draft)} m, {_number(volume)} m^3, {_number(area)} m^2]"
            page.add(f"        - {row}")


def figure_text(key: str, value: model.FigureOrWord, *, per_metre: bool, in_kilograms: bool) -> str:
    """Format a value of a component for the mooring file.

    `value` is in SI units, or a word. `per_metre` applies to forces and masses, `in_kilograms`
    (kilograms-force) to forces.
    """
    if isinstance(value, str):
        return quoted(value)
    if key in _FORCES:
        unit = "kgf" if in_kilograms else "N"
        shown = _number(value / KILOGRAM_FORCE if in_kilograms else value)
        return f"{shown} {unit}{'/m' if per_metre else ''}"
    if key == "mass":
        return f"{_number(value)} kg{'/m' if per_metre else ''}"
    unit = _UNITS.get(key, "")
    if unit == "kN":
        value /= 1000.0
    if key == "diameter" and value < 0.1:
        value, unit = value * 1000.0, "mm"
    return f"{_number(value)} {unit}".rstrip()
