"""Surveys as ships write them down, as the table of positions and ranges that they are.

Positions in two columns, degrees and minutes; columns by the names of deck boxes and event logs;
and two forms without a heading, of programs that find an anchor by its ranges:

- five columns: degrees and minutes of latitude and of longitude, and seconds one way (WHOI);
- three columns: range, latitude and longitude, below the target, depth, height of the release
  and transducer, and the position of the drop (NOC).
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from calm.records.delimited import NUMBER, CellRow, Dialect, TextTable, dialect_of, read_table
from calm.records.headings import heading
from calm.whole_file import read_text

OTHER_NAMES: Mapping[str, str] = {
    **dict.fromkeys(("lat", "ship_lat", "ship_latitude"), "latitude"),
    **dict.fromkeys(("lon", "long", "lng", "ship_lon", "ship_longitude"), "longitude"),
    **dict.fromkeys(("slant_range", "slant", "distance", "rng", "slantrange"), "range"),
    **dict.fromkeys(("twt", "twtt", "two_way_time", "two_way_travel_time", "travel_time"), "time"),
}
"""What columns are called elsewhere."""

_PART = re.compile(r"(?i)(?:ship[ _]?)?(lat|lon)\w*?[ _\[(]*(deg|min|hem|ns|ew|dir)\w*[\])]*")
_LARGEST = 5_000_000
_NEAR = 1.0  # degrees between a survey's positions, at most


def survey_table(path: Path, example: str) -> tuple[TextTable, float | None, list[str]]:
    """Return the table of a survey, the depth of its transducer [m] where it says so, and notices.

    Parameters
    ----------
    path : of the file
    example : of a header, for messages

    Raises
    ------
    InputError
        It cannot be read, is empty, or has no header and is of neither form without one.
    """
    bare = _without_heading(path)
    if bare is None:
        return _joined(read_table(path, example)), None, []
    rows, columns = bare
    if columns == 5:
        lines = []
        for row in rows:
            place = f"{_placed(row.cells[:2])},{_placed(row.cells[2:4])}"
            lines.append((row.number, f"{place},{2.0 * float(row.cells[4]):.9g}"))
        said = (
            "has no heading: read as degrees, minutes, degrees, minutes and the seconds one way; "
            "south and west are negative"
        )
        table = read_table(path, example, [(1, "latitude,longitude,time[s]"), *lines])
        return table, None, [said]
    transducer = float(rows[1].cells[2])
    lines = [(row.number, ",".join(row.cells)) for row in rows[3:]]
    said = (
        "has no heading: read as range, latitude and longitude below the target, the depths and "
        f"the drop; its transducer is {transducer:g} m deep"
    )
    return (
        read_table(path, example, [(1, "range[m],latitude,longitude"), *lines]),
        transducer,
        [said],
    )


def _without_heading(path: Path) -> tuple[list[CellRow], int] | None:
    """Return the rows of one of the two forms without a heading, and how many columns it has."""
    lines = [
        (number, line.partition("%")[0].partition("#")[0])
        for number, line in enumerate(read_text(path, largest=_LARGEST).splitlines(), 1)
    ]
    there = [(number, line.strip()) for number, line in lines if line.strip()]
    if not there:
        return None
    dialect: Dialect = dialect_of([line for _, line in there])
    rows = [CellRow(number, line, dialect.cells(line), dialect) for number, line in there]
    counts = {len(row.cells) for row in rows}
    if len(counts) != 1 or not all(NUMBER.fullmatch(cell) for row in rows for cell in row.cells):
        return None
    count = counts.pop()
    values = [[float(cell) for cell in row.cells] for row in rows]
    if count == 5 and all(0.0 <= row[1] < 60.0 and 0.0 <= row[3] < 60.0 for row in values):
        return rows, count
    places = [row[1:] for row in values[:1] + values[2:]]
    together = count == 3 and len(rows) > 4 and all(
        max(each) - min(each) < _NEAR for each in zip(*places, strict=True)
    )  # fmt: skip
    return (rows, count) if together else None


def _placed(cells: Sequence[str]) -> str:
    """Return degrees and minutes as one cell, the sign of the degrees before both."""
    degrees, *rest = (cell.strip() for cell in cells)
    degrees = re.sub(r"\.0*$", "", degrees)
    return " ".join([degrees, *rest]).strip()


def _joined(table: TextTable) -> TextTable:
    """Return a table whose degrees and minutes of one position are one cell, in that of degrees.

    A time of day is no time of travel: its column is called another.
    """
    rows, header = list(table.rows), list(table.header.cells)
    for j, cell in enumerate(header):
        of_day = any(":" in row.cells[j] for row in rows if j < len(row.cells))
        if of_day and heading(cell) == (cell.strip(), ""):
            header[j] = f"clock {cell}"
    parts: dict[str, dict[str, int]] = {}
    for j, cell in enumerate(table.header.cells):
        if found := _PART.fullmatch(cell.strip()):
            kind = found[2].lower()
            parts.setdefault(found[1].lower(), {})[kind if kind in ("deg", "min") else "hem"] = j
    split = {name: at for name, at in parts.items() if {"deg", "min"} <= at.keys()}
    names = {"lat": "latitude", "lon": "longitude"}
    for name, at in split.items():
        for j in at.values():
            header[j] = ""
        header[at["deg"]] = names[name]
    for i, row in enumerate(rows):
        cells = list(row.cells)
        if len(cells) == len(header):
            for at in split.values():
                chosen = [cells[at[kind]] for kind in ("deg", "min", "hem") if kind in at]
                cells[at["deg"]] = _placed(chosen)
            rows[i] = row._replace(cells=cells)
    return replace(table, header=table.header._replace(cells=header), rows=rows)
