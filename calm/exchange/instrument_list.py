"""Instrument lists of moorings, as used by observing groups, with nominal depths or heights.

Read are CSV tables and workbooks, `info.dat` of RODB (RAPID, OSNAP), configurations of oceanarray,
and NetCDF files whose instruments have serial numbers and nominal depths, such as the products of
IMOS.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import nan
from pathlib import Path

import numpy as np

from calm.errors import InputError, Problem, refused
from calm.exchange.model import MOST_PIECES
from calm.exchange.oceanarray import is_oceanarray, listed_instruments
from calm.exchange.table.cells import is_workbook, read_sheets
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
    "computer_clock_at_recovery": "true", "instrument_clock_at_recovery": "own",
    "recovery_time": "end",
}  # fmt: skip
_DIMENSIONS = {"nominal": "length", "height": "length", "clock": "time"}
_PAIR = re.compile(r"\s*(\w+)\s*=\s*(.*?)\s*$")


@dataclass(frozen=True)
class ListedInstrument:
    """An instrument in a list.

    Attributes
    ----------
    where : in the list, for people
    name, serial : empty where the list does not say
    nominal : its depth [m]; NaN where not known
    clock : how late its clock was [s]; None where not known
    checked : time at which this was found; None where not known
    remark : other error of its clock, in words
    """

    where: str
    name: str
    serial: str
    nominal: float
    clock: float | None = None
    checked: np.datetime64 | None = None
    remark: str = ""


def in_words(late: float) -> str:
    """Describe the error of a clock [s]."""
    return f"{abs(late):g} s {'late' if late >= 0.0 else 'early'}"


def read_instrument_list(path: Path, seabed: float) -> list[ListedInstrument]:
    """Read an instrument list in its order.

    Parameters
    ----------
    seabed : depth of the water, for heights above it [m]

    Raises
    ------
    InputError
        It cannot be read, is of none of the forms, or lists no instrument by a serial number or a
        nominal depth.
    """
    head = read_head(path, _HEAD)
    if cf_files.engine_of(path):
        found = [*_of_arrays(path, seabed)]
    elif is_oceanarray(head):
        found = [*_of_oceanarray(path, seabed)]
    elif re.search(rb"(?mi)^\s*columns\s*=.*\binstrument\b", head):
        found = [*_of_rodb(path)]
    else:
        found = [*_of_table(path, seabed, _of_workbook(path) if is_workbook(head) else None)]
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


def _of_oceanarray(path: Path, seabed: float) -> Iterator[ListedInstrument]:
    for line, name, serial, height, keys in listed_instruments(path):
        texts = {kind: str(keys[key]) for key, kind in _OF_OCEANARRAY.items() if keys.get(key)}
        try:
            drift, constant = (
                float(keys.get(key) or 0.0) for key in ("clock_drift_seconds", "clock_offset")
            )
            times = {kind: _time(text) for kind, text in texts.items() if text != "unknown"}
        except ValueError as error:
            raise refused(path, f"`{name}`: {error}", line=line) from None
        late, checked = _comparison(drift if drift else None, times)
        remark = f"clock {in_words(constant)} from the deployment on" if constant else ""
        yield ListedInstrument(
            f"{path.name}, line {line}", name, serial, seabed - height,
            None if constant else late, checked, remark,
        )  # fmt: skip


def _time(text: str) -> np.datetime64:
    """Parse a time, also with slashes as in RODB; TimeChoiceError: the text is no time."""
    return parse_time(text.replace("/", "-"))


def _comparison(
    late: float | None, times: Mapping[str, np.datetime64]
) -> tuple[float | None, np.datetime64 | None]:
    """Return the delay of a clock [s], and the time of its comparison.

    The delay is `late`, or the difference of the times that both clocks showed. Without a time of
    the comparison, it is that of the recovery.
    """
    if {"true", "own"} <= times.keys():
        late = float((times["true"] - times["own"]) / np.timedelta64(1, "us")) / 1e6
    at = next((times[kind] for kind in ("checked", "true", "end") if kind in times), None)
    return late, at


def _of_workbook(path: Path) -> list[NumberedLine]:
    """Return the first sheet of a workbook as lines of CSV."""
    rows = next(iter(read_sheets(path).rows.values()), [[]])
    text, width = io.StringIO(), len(rows[0])
    csv.writer(text).writerows([*row, *[""] * width][:width] for row in rows)
    return [*enumerate(text.getvalue().splitlines(), 1)]


def _of_rodb(path: Path) -> Iterator[ListedInstrument]:
    """Yield the rows of `info.dat`, `Columns = z:instrument:serialnumber`; models are numbers.

    A column of clock offsets [s] is compared at the end of the record, `End_Date` and `End_Time`.
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
                raise refused(path, f"the row is not {':'.join(names)}", line=number)
            of = dict(zip(names, cells, strict=True))
            serial = of.get("serialnumber", "")
            where, model = f"{path.name}, line {number}", of.get("instrument", "")
            clock = next((text for name, text in of.items() if _kind_of(name) == "clock"), "")
            end = " ".join(header[key] for key in ("end_date", "end_time") if header.get(key))
            try:
                late, checked = _comparison(
                    None if is_gap(clock) else float(clock), {"end": _time(end)} if end else {}
                )
            except ValueError as error:
                raise refused(path, str(error), line=number) from None
            yield ListedInstrument(where, f"RODB {model}", serial, float(of["z"]), late, checked)


def _kind_of(name: str) -> str | None:
    """Return the kind of a column; None for one that is not read."""
    plain = name.strip().lower()
    return next((kind for kind, text in _COLUMNS.items() if re.fullmatch(text, plain)), None)


def _of_table(
    path: Path, seabed: float, lines: list[NumberedLine] | None
) -> Iterator[ListedInstrument]:
    table, problems = read_table(path, _EXAMPLE, lines), list[Problem]()
    places: dict[str, int] = {}
    factors: dict[str, float] = {}
    for j, column in enumerate(table.header.cells):
        name, unit = heading(column)
        whole = _kind_of(column)  # the last word of the name of a time is no unit
        kind = whole if whole in _TIMES else _kind_of(name)
        if kind is None or kind in places:
            continue
        places[kind] = j
        if kind in _TIMES and kind != whole and (complaint := zone_complaint(column)):
            problems.append(table.header.problem(complaint, j))
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
    times: dict[int, dict[str, np.datetime64]] = {}
    for row in rows:
        times[row.number] = {}
        for kind in places.keys() & {*_TIMES}:
            try:
                if not is_gap(cell := row.cells[places[kind]]):
                    times[row.number][kind] = _time(cell)
            except TimeChoiceError as error:
                problems.append(row.problem(str(error), places[kind]))
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
        clock = _comparison(known.get("clock"), times[row.number])
        yield ListedInstrument(
            where, texts.get("name", ""), texts.get("serial", ""), nominal, *clock
        )
