"""Instrument lists of moorings, as used by observing groups, with nominal depths or heights.

Supported are CSV tables, `info.dat` of RODB (RAPID, OSNAP), configurations of oceanarray, and
NetCDF files whose instruments have serial numbers and nominal depths, such as the products of IMOS.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from math import nan
from pathlib import Path

from calm.errors import InputError, Problem, refused
from calm.exchange.model import MOST_PIECES
from calm.exchange.oceanarray import is_oceanarray, listed_instruments
from calm.records import cf_files, velocity
from calm.records.delimited import is_gap, no_number, read_table
from calm.records.headings import column_unit, heading
from calm.records.instrument_series import instruments_apart, who_along
from calm.units import QuantityError
from calm.whole_file import read_head, read_text

_EXAMPLE = "name,serial,nominal depth[m],clock offset[s]"
_HEAD = 70_000  # bytes from which a form is recognised
_LARGEST = 5_000_000
_COLUMNS = {
    "serial": r"serial.*|s/?n|sn|instrument_?serial.*",
    "name": r"name|instrument(_?(name|type|model))?|type|model|label",
    "nominal": r"(nominal|planned|instr(ument)?|sensor|target)?[ _]*depth|z",
    "height": r"hab|height.*|.*above.*(bottom|seabed|sea ?floor)",
    "clock": r"clock.*|time[ _]offset|drift.*|late",
}  # fmt: skip
_DIMENSIONS = {"nominal": "length", "height": "length", "clock": "time"}
_PAIR = re.compile(r"\s*(\w+)\s*=\s*(.*?)\s*$")


@dataclass(frozen=True)
class ListedInstrument:
    """An instrument in a list.

    Attributes
    ----------
    where : position in the list, for messages
    name, serial : empty if missing in the list
    nominal : nominal depth [m]; NaN if unknown
    clock : lag of its clock [s]; None if unknown
    """

    where: str
    name: str
    serial: str
    nominal: float
    clock: float | None = None


def read_instrument_list(path: Path, seabed: float) -> list[ListedInstrument]:
    """Read an instrument list in its order.

    Parameters
    ----------
    seabed : depth of the water, for heights above it [m]

    Raises
    ------
    InputError
        The list cannot be read, has an unknown format, or has no instrument with a serial number or
        a nominal depth.
    """
    head = read_head(path, _HEAD)
    if cf_files.engine_of(path):
        found = [*_of_arrays(path, seabed)]
    elif is_oceanarray(head):
        found = [
            ListedInstrument(f"{path.name}, line {line}", name, serial, seabed - height)
            for line, name, serial, height in listed_instruments(path)
        ]
    elif re.search(rb"(?mi)^\s*columns\s*=.*\binstrument\b", head):
        found = [*_of_rodb(path)]
    else:
        found = [*_of_table(path, seabed)]
    found = [one for one in found if one.serial or one.nominal == one.nominal]
    if not found:
        raise refused(path, "lists no instrument with a serial number or a nominal depth")
    if len(found) > MOST_PIECES:
        raise refused(path, f"lists more than {MOST_PIECES} instruments")
    return found


def _of_arrays(path: Path, seabed: float) -> Iterator[ListedInstrument]:
    with cf_files.opened(path) as dataset:
        for part in instruments_apart(velocity.with_components(dataset)):
            several = [dim for dim, size in part.sizes.items() if size > 1]
            along = next((dim for dim in several if cf_files.labels_along(part, str(dim))), None)
            name = None if along is None else str(along)
            for one in who_along(part, name, seabed, path.name):
                yield ListedInstrument(path.name, one.label, one.serial, one.nominal)


def _of_rodb(path: Path) -> Iterator[ListedInstrument]:
    """Yield the rows of `info.dat`, `Columns = z:instrument:serialnumber`; models are numbers."""
    names: list[str] = []
    for number, line in enumerate(read_text(path, largest=_LARGEST).splitlines(), 1):
        pair, cells = _PAIR.match(line), line.split()
        if pair is not None:
            names = pair[2].lower().split(":") if pair[1].lower() == "columns" else names
        elif names and cells:
            if len(cells) != len(names) or "z" not in names or no_number(cells[names.index("z")]):
                raise refused(path, f"the row is not {':'.join(names)}", line=number)
            of = dict(zip(names, cells, strict=True))
            serial = of.get("serialnumber", "")
            where, model = f"{path.name}, line {number}", of.get("instrument", "")
            yield ListedInstrument(where, f"RODB {model}", serial, float(of["z"]))


def _of_table(path: Path, seabed: float) -> Iterator[ListedInstrument]:
    table, problems = read_table(path, _EXAMPLE), list[Problem]()
    places: dict[str, int] = {}
    factors: dict[str, float] = {}
    for j, column in enumerate(table.header.cells):
        name, unit = heading(column)
        plain = name.strip().lower()
        kind = next((kind for kind, text in _COLUMNS.items() if re.fullmatch(text, plain)), None)
        if kind is None or kind in places:
            continue
        places[kind] = j
        if kind in _DIMENSIONS:
            try:
                usual = {"length": "m", "time": "s"}[_DIMENSIONS[kind]]
                factors[kind] = column_unit(column, unit, [_DIMENSIONS[kind]], usual)[1]
            except QuantityError as error:
                problems.append(table.header.problem(str(error), j))
    if not {"serial", "nominal", "height"} & places.keys():
        message = f"there is no column for serial numbers or nominal depths: write {_EXAMPLE}"
        problems.append(table.header.problem(message))
    rows = table.whole_rows(problems)
    for row in rows:
        for kind in factors:
            cell = row.cells[places[kind]]
            if not is_gap(cell) and (complaint := no_number(cell)):
                problems.append(row.problem(f"`{cell}` {complaint}", places[kind]))
    if problems:
        raise InputError(problems)
    for row in rows:
        texts = {kind: row.cells[j].strip() for kind, j in places.items()}
        known = {
            kind: float(texts[kind]) * factor
            for kind, factor in factors.items()
            if not is_gap(texts[kind])
        }
        nominal = known.get("nominal", seabed - known["height"] if "height" in known else nan)
        where = f"{path.name}, line {row.number}"
        yield ListedInstrument(
            where, texts.get("name", ""), texts.get("serial", ""), nominal, known.get("clock")
        )
