"""Read the points and lines of a MoorDyn or MoorPy file as a net of legs."""

from __future__ import annotations

from pathlib import Path

from calm.exchange.design import ImportedLeg, ImportedPiece, refused
from calm.exchange.moordyn_reader import (
    MoorDynFile,
    SectionRow,
    anchor_of,
    is_held,
    other_end,
    point_of,
)

_ON_THE_BED = 0.05
"""Share of the depth: a fixed point no higher above the seabed is an anchor."""


def lay_net(file: MoorDynFile, path: Path) -> None:
    """Lay the lines as legs between points that are held, end freely, or join three and more.

    InputError: lines go round in a ring that nothing holds.
    """
    breaks = [name for name, met in file.at.items() if len(met) != 2 or is_held(file.points[name])]
    left, told = list(file.lines), set[str]()
    for start in breaks:
        while met := [line for line in file.at[start] if line in left]:
            names, lines = [start], list[SectionRow]()
            while met and (not lines or names[-1] not in breaks):
                lines.append(met[0])
                left.remove(met[0])
                names.append(other_end(met[0], names[-1]))
                met = [line for line in file.at[names[-1]] if line in left]
            if all(_is_anchor(file, file.points[end]) for end in (names[0], names[-1])):
                if len(lines) == 1:
                    raise lines[0].refuse("both ends are anchors: a leg has one, at its lower end")
                top = max(names[1:-1], key=lambda name: file.points[name].number("z"))
                k = names.index(top)
                halves = [(names[k::-1], lines[:k][::-1]), (names[k:], lines[k:])]
            elif _is_upright(file, names):
                halves = [(names[::-1], lines[::-1])]
            else:
                halves = [(names, lines)]
            file.design.legs += [
                _leg(file, f"leg-{len(file.design.legs) + n}", *half, told)
                for n, half in enumerate(halves, 1)
            ]
    if left or not breaks:
        raise refused(path, "lines go round in a ring that nothing holds")
    file.design.items = [item for leg in file.design.legs for item in leg.items]


def _is_upright(file: MoorDynFile, names: list[str]) -> bool:
    """Return whether a chain of points leads up: an anchor is below, whatever else is."""
    first, last = file.points[names[0]], file.points[names[-1]]
    if _is_anchor(file, first) != _is_anchor(file, last):
        return _is_anchor(file, first)
    return first.number("z") < last.number("z")


def _is_anchor(file: MoorDynFile, point: SectionRow) -> bool:
    assert file.water.depth is not None
    fixed = is_held(point) and point.words["attachment"].lower().startswith(("fix", "anchor"))
    return fixed and point.number("z") <= -(1.0 - _ON_THE_BED) * file.water.depth


def _leg(
    file: MoorDynFile, name: str, names: list[str], lines: list[SectionRow], told: set[str]
) -> ImportedLeg:
    """Return a leg from its upper end; what is at a point goes to the first leg that has it."""
    items: list[ImportedPiece] = []
    for at, line in zip(names, [*lines, None], strict=True):
        point = file.points[at]
        if not is_held(point) and at not in told:
            told.add(at)
            there = point_of(point)
            items += [] if there is None else [there]
        items += [] if line is None else [file.piece(line)]
    upper, lower = (_end(file, at) for at in (names[0], names[-1]))
    if _is_anchor(file, file.points[names[-1]]):
        point = file.points[names[-1]]
        items.append(ImportedPiece(anchor_of(point, file.water)))
        depth = 0.0 - point.number("z")
        assert file.water.depth is not None
        deeper = f", depth: {depth:.9g} m" if depth > file.water.depth else ""
        lower = f"{{anchor: {{at: {_at(point)}{deeper}}}}}"
    return ImportedLeg(name, items, upper, lower)


def _end(file: MoorDynFile, name: str) -> str:
    point = file.points[name]
    if is_held(point):
        return f"{{held: {{depth: {0.0 - point.number('z'):.9g} m, at: {_at(point)}}}}}"
    return f"{{join: point-{name}}}" if len(file.at[name]) > 1 else "free"


def _at(point: SectionRow) -> str:
    return f"[{point.number('x'):.9g} m, {point.number('y'):.9g} m]"
