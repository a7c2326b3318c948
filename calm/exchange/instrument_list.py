"""Instrument lists of moorings, with nominal depths or heights.

Lists are CSV tables, workbooks, `info.dat` of RODB (RAPID, OSNAP), configurations of oceanarray, or
NetCDF files with serial numbers and nominal depths.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import nan
from pathlib import Path
from types import MappingProxyType

import numpy as np

from calm.errors import InputError, Problem, refused
from calm.exchange.model import MOST_PIECES
from calm.exchange.oceanarray import is_oceanarray, listed_instruments
from calm.exchange.table.cells import SheetRows, is_workbook, read_sheets
from calm.records import cf_files, velocity
from calm.records.current_terms import TimeChoiceError, parse_time
from calm.records.delimited import NumberedLine, is_gap, no_number, read_table
from calm.records.headings import column_unit, heading, zone_complaint
from calm.records.instrument_series import instruments_apart, who_along
from calm.units import QuantityError
from calm.whole_file import read_head, read_text

_EXAMPLE = "name,serial,nominal depth[m],clock offset[s],clock checked"
_HEAD = 70_000  # bytes from which a form is recognised
_LARGEST = 5_000_000
_COLUMNS = {
    "serial": r"serial.*|s/?n|sn|instrument_?serial.*",
    "name": r"name|instrument(_?(name|type|model))?|type|model|label",
    "nominal": r"(nominal|planned|instr(ument)?|sensor|target)?[ _]*depth|z",
    "height": r"hab|height.*|.*above.*(bottom|seabed|sea ?floor)",
    "checked": r"(clock[ _]*)?checked([ _](at|on))?|clock[ _]*check([ _]*(time|date))?"
    r"|(time|date)[ _]of[ _](the[ _])?clock[ _]*check",
    "own": r"instrument[ _]*(clock|time)([ _]at[ _]recovery)?|time_?drift_?instrument",
    "true": r"(gps|utc|computer)[ _]*(clock|time)([ _]at[ _]recovery)?|time_?drift_?gps",
    "end": r"(time|date)[ _]of[ _]recovery|recover(y|ed).*|time_deployment_end"
    r"|end([ _]*(time|date))?",
    "clock": r"clock.*|time[ _]offset|drift.*|late",
}  # fmt: skip
_TIMES = ("checked", "true", "own", "end")
_OF_OCEANARRAY = {
    "clock_drift_seconds": "clock", "clock_offset": "constant", "recovery_time": "end",
    "computer_clock_at_recovery": "true", "instrument_clock_at_recovery": "own",
}  # fmt: skip
_DIMENSIONS = {"nominal": "length", "height": "length", "clock": "time", "constant": "time"}
_USUAL = {"length": "m", "time": "s"}
_PAIR = re.compile(r"\s*(\w+)\s*=\s*(.*?)\s*$")


@dataclass(frozen=True)
class ListedInstrument:
    """An instrument in a list.

    Attributes
    ----------
    where : position in the list, for messages
    name, serial : empty if missing
    nominal : nominal depth [m]; NaN if unknown
    clock : lag of the clock [s], negative if early; None if unknown
    checked : time at which the lag was measured; None if unknown
    remark : any other clock error, in words
    """

    where: str
    name: str
    serial: str
    nominal: float
    clock: float | None = None
    checked: np.datetime64 | None = None
    remark: str = ""


def in_words(late: float) -> str:
    """Describe the lag of a clock [s], such as ``3 s late``."""
    return f"{abs(late):g} s {'late' if late >= 0.0 else 'early'}"


def read_instrument_list(path: Path, seabed: float) -> list[ListedInstrument]:
    """Read the instruments of a list, in the order of the list.

    Only instruments with a serial number, or with a nominal depth and a name or clock error, are
    kept. `seabed` is the water depth [m]. Raise InputError if the list is unreadable or has no such
    instrument.
    """
    head = read_head(path, _HEAD)
    if cf_files.engine_of(path):
        found = [*_of_arrays(path, seabed)]
    elif is_oceanarray(head):
        found = [*_of_oceanarray(path, seabed)]
    elif re.search(rb"(?mi)^\s*columns\s*=.*\binstrument\b", head):
        found = [*_of_rodb(path, seabed)]
    else:
        found = _of_table(path, seabed, _first_sheet(path) if is_workbook(head) else None)
    found = [one for one in found if one.serial or (one.nominal == one.nominal and _says_more(one))]
    if not found:
        message = (
            "lists no usable instrument; each needs a serial number, or a nominal depth with a "
            "name or clock offset"
        )
        raise refused(path, message)
    if len(found) > MOST_PIECES:
        raise refused(path, f"lists more than {MOST_PIECES} instruments")
    return found


def _says_more(one: ListedInstrument) -> bool:
    return bool(one.name or one.remark) or one.clock is not None


def _of_arrays(path: Path, seabed: float) -> Iterator[ListedInstrument]:
    with cf_files.opened(path) as dataset:
        for part in instruments_apart(velocity.with_components(dataset)):
            several = [dim for dim, size in part.sizes.items() if size > 1]
            along = next((dim for dim in several if cf_files.labels_along(part, str(dim))), None)
            name = None if along is None else str(along)
            for one in who_along(part, name, seabed, path.name):
                yield ListedInstrument(path.name, one.label, one.serial, one.nominal)


def _instrument_from(
    where: str,
    texts: Mapping[str, str],
    seabed: float,
    factors: Mapping[str, float] = MappingProxyType({}),
) -> tuple[ListedInstrument, dict[str, str]]:
    """Build an instrument from the texts of its columns; also return messages about mistakes.

    `texts`, `factors` and the messages have the keys of `_COLUMNS`. `factors` convert numbers to SI
    units.
    """
    figures, times, wrong = dict[str, float](), dict[str, np.datetime64](), dict[str, str]()
    compared = not all(is_gap(texts.get(kind, "")) for kind in ("clock", "true"))
    for kind, text in texts.items():
        if is_gap(text) or (kind == "end" and not compared):
            continue
        if kind in _TIMES:
            try:
                times[kind] = parse_time(text.replace("/", "-"))  # RODB has slashes
            except TimeChoiceError as error:
                wrong[kind] = str(error)
        elif kind in _DIMENSIONS:
            if complaint := no_number(text):
                wrong[kind] = f"`{text}` {complaint}"
            else:
                figures[kind] = float(text) * factors.get(kind, 1.0)
    late, remark = figures.get("clock"), ""
    if {"true", "own"} <= times.keys():  # times that both clocks showed
        late = float((times["true"] - times["own"]) / np.timedelta64(1, "us")) / 1e6
    if constant := figures.get("constant"):
        late, remark = None, f"clock {in_words(constant)} since the deployment"
    checked = next((times[kind] for kind in ("checked", "true", "end") if kind in times), None)
    nominal = figures.get("nominal", seabed - figures.get("height", nan))
    name, serial = texts.get("name", ""), texts.get("serial", "")
    return ListedInstrument(where, name, serial, nominal, late, checked, remark), wrong


def _of_oceanarray(path: Path, seabed: float) -> Iterator[ListedInstrument]:
    for line, name, serial, height, keys in listed_instruments(path):
        texts = {kind: str(keys[key]) for key, kind in _OF_OCEANARRAY.items() if keys.get(key)}
        texts = {kind: text for kind, text in texts.items() if text != "unknown"}
        texts |= {"name": name, "serial": serial, "height": str(height)}
        one, wrong = _instrument_from(f"{path.name}, line {line}", texts, seabed)
        for message in wrong.values():
            raise refused(path, message, line=line)
        yield one


def _first_sheet(path: Path) -> list[NumberedLine]:
    rows: SheetRows = next(iter(read_sheets(path).rows.values()), [[]])
    text, width = io.StringIO(), len(rows[0])
    csv.writer(text).writerows([*row, *[""] * width][:width] for row in rows)
    return [*enumerate(text.getvalue().splitlines(), 1)]


def _of_rodb(path: Path, seabed: float) -> Iterator[ListedInstrument]:
    """Yield instruments from `info.dat` with a header like `Columns = z:instrument:serialnumber`.

    Instrument models are numbers. Clock offsets [s] apply at the end of the record (`End_Date`,
    `End_Time`).
    """
    names: list[str] = []
    header: dict[str, str] = {}
    for number, line in enumerate(read_text(path, largest=_LARGEST).splitlines(), 1):
        pair, cells = _PAIR.match(line), line.split()
        if pair is not None:
            header[pair[1].lower()] = pair[2]
            names = pair[2].lower().split(":") if pair[1].lower() == "columns" else names
        elif names and cells:
            if len(cells) != len(names) or "z" not in names or no_number(cells[names.index("z")]):
                raise refused(
                    path, f"the row does not match the columns {':'.join(names)}", line=number
                )
            texts = {_column_kind(name): text for name, text in zip(names, cells, strict=True)}
            texts["name"] = f"RODB {texts.get('name', '')}"
            texts["end"] = f"{header.get('end_date', '')} {header.get('end_time', '')}".strip()
            one, wrong = _instrument_from(f"{path.name}, line {number}", texts, seabed)
            for message in wrong.values():
                raise refused(path, message, line=number)
            yield one


def _column_kind(name: str) -> str:
    plain = name.strip().lower()
    return next((kind for kind, text in _COLUMNS.items() if re.fullmatch(text, plain)), "")


def _of_table(
    path: Path, seabed: float, lines: list[NumberedLine] | None
) -> list[ListedInstrument]:
    table, problems = read_table(path, _EXAMPLE, lines), list[Problem]()
    places: dict[str, int] = {}
    factors: dict[str, float] = {}
    for j, column in enumerate(table.header.cells):
        name, unit = heading(column)
        whole = _column_kind(column)  # the last word of the name of a time is no unit
        kind = whole if whole in _TIMES else _column_kind(name)
        if not kind or kind in places:
            continue
        places[kind] = j
        if kind in _TIMES and kind != whole and (complaint := zone_complaint(column)):
            problems.append(table.header.problem(complaint, j))
        if kind in _DIMENSIONS:
            try:
                usual = _USUAL[_DIMENSIONS[kind]]
                factors[kind] = column_unit(column, unit, [_DIMENSIONS[kind]], usual)[1]
            except QuantityError as error:
                problems.append(table.header.problem(str(error), j))
    if not {"serial", "nominal", "height"} & places.keys():
        message = f"there is no column for serial numbers or nominal depths; an example: {_EXAMPLE}"
        problems.append(table.header.problem(message))
    found = []
    for row in table.whole_rows(problems):
        texts = {kind: row.cells[j].strip() for kind, j in places.items()}
        one, wrong = _instrument_from(f"{path.name}, line {row.number}", texts, seabed, factors)
        problems += [row.problem(message, places[kind]) for kind, message in wrong.items()]
        found.append(one)
    if problems:
        raise InputError(problems)
    return found
