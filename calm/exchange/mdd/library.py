"""The table of elements of Mooring Design & Dynamics: character matrices, a row an element."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from calm.exchange.mdd.matfile import read_variables
from calm.exchange.mdd.value import MatValue, names, numbers
from calm.exchange.refusal import refused

GROUPS = ("floats", "wires", "chains", "acrels", "cms", "anchors", "miscs")
"""The variables that hold elements."""

_LINES = ("wires", "chains")
_NAME = 16  # bytes of a name, where the file does not say
_FIGURES = (6, 7)  # behind it: buoyancy, mass in air of late, length, width, diameter, Cd, material
_CENTIMETRE = 0.01
_METRE = 100.0  # cm: the length of a line whose figures are those of a metre


@dataclass(frozen=True)
class MddEntry:
    """An element: net buoyancy [kg, of a line per metre], sizes [m], Cd and number of material."""

    name: str
    is_line: bool
    lift: float
    length: float
    width: float
    diameter: float
    cd: float
    material: float


def read_entries(path: Path) -> list[MddEntry]:
    """The elements of a file such as `mdcodes.mat`.

    Raises
    ------
    InputError
        It holds none.
    """
    variables = read_variables(path, [*GROUPS, "format"])
    entries = [
        entry
        for group in GROUPS
        for text in names(variables.get(group))
        if (entry := _entry(text, group, _width(variables))) is not None
    ]
    if not entries:
        raise refused(path, "holds no element library of that program (`floats`, `wires` …)")
    return entries


def _width(variables: Mapping[str, MatValue]) -> int:
    """Bytes of a name: `format` has the columns of the name and of each figure."""
    try:
        columns = numbers(variables.get("format"))
    except ValueError:
        return _NAME
    return int(columns[0, -1]) if columns.ndim == 2 and 0 < columns.size <= 100 else _NAME


def _entry(text: str, group: str, end: int) -> MddEntry | None:
    """An element of a row; None for a row that cannot be read."""
    content = text.encode()
    try:
        figures = [float(word) for word in content[end:].split()]
    except ValueError:
        return None
    if len(figures) not in _FIGURES:
        return None
    length, width, diameter, cd, material = figures[-5:]
    return MddEntry(
        name=content[:end].decode("utf-8", "replace").strip(),
        is_line=group in _LINES and length == _METRE,
        lift=figures[0],
        length=length * _CENTIMETRE,
        width=width * _CENTIMETRE,
        diameter=diameter * _CENTIMETRE,
        cd=cd,
        material=material,
    )
