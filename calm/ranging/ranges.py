"""Read acoustic ranges from a table of ship positions with `range[m]` or `time[s]`.

The usual form is CSV with a header. Column names of deck boxes and event logs are accepted, as are
degrees and minutes in two columns. Two formats have no column headings:

- WHOI, five columns: degrees and minutes of latitude and of longitude, and one-way time [s].
- NOC, three columns: range, latitude and longitude. The rows above the ranges contain the target
  position (optional), the depths, and the drop position, in this order. The depths are water depth,
  height of the release and depth of the transducer.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from calm.errors import InputError, Problem, UsageError, shown
from calm.physics.line import Floats
from calm.positions import HEMISPHERES, Frame, degrees_of
from calm.records import delimited
from calm.records.grids import kilometres_from
from calm.records.headings import heading, read_named_columns
from calm.units import DIMENSIONS
from calm.whole_file import read_text

EXAMPLE = "latitude[deg],longitude[deg],range[m]"
LONGEST = {"range": 25_000.0, "time": 35.0}
"""Maximum range of mooring transponders [m], and maximum two-way time [s]."""
WIDEST = 50.0
"""Maximum distance of positions from the middle of a survey [km]."""
_FILLS = frozenset({"-9999", "-999", "-99", "9999", "99999", "999999", "-99999", "1e35", "1e+35"})
_COLUMNS = {"latitude": "latitude", "longitude": "longitude", "range": "length", "time": "time"}


@dataclass(frozen=True)
class Survey:
    """Acoustic ranges measured by a ship.

    Attributes
    ----------
    line : line number of each range in the file
    latitude, longitude : (n,) position of the transducer, WGS 84 [degrees]
    measured : (n,) ranges [m], or two-way times if `timed` [s]
    transducer : depth of the transducer [m]
    """

    path: Path
    line: tuple[int, ...]
    latitude: Floats
    longitude: Floats
    measured: Floats
    timed: bool
    transducer: float
    notices: tuple[str, ...] = ()

    @cached_property
    def frame(self) -> Frame:
        """Local frame centred on the mean position of the ship; valid across the 180° meridian."""
        lam = np.radians(self.longitude)
        middle = np.degrees(np.arctan2(np.sin(lam).mean(), np.cos(lam).mean()))
        return Frame(float(self.latitude.mean()), float(middle))


def read_ranges(path: Path, transducer: float = 0.0, hemisphere: str = "") -> Survey:
    """Read the acoustic ranges in a file. Blank rows and repeated rows are omitted.

    Parameters
    ----------
    transducer : depth of the transducer [m]; 0 for the depth in the file, if any
    hemisphere : letters such as ``"S,W"`` for positions with neither letter nor sign

    Raises
    ------
    InputError
        The file has mistakes; all of them are listed.
    UsageError
        `hemisphere` is not a pair of letters such as ``"S,W"``.
    """
    problems: list[Problem] = []
    signs = hemisphere_signs(hemisphere)
    table, its_transducer, notices = _survey_table(path)
    columns = read_named_columns(table, _COLUMNS, problems, other_names=_OTHER_NAMES)
    heads = columns.factors
    problems += [
        columns.lacks(name, "deg") for name in ("latitude", "longitude") if name not in heads
    ]
    if ("range" in heads) == ("time" in heads):
        both = "there are columns `range` and `time`; remove one of them"
        none = "there is no column `range[m]` or `time[s]`"
        problems.append(columns.header.problem(both if "range" in heads else none))
    measure = "time" if "time" in heads else "range"
    values: list[tuple[int, float, float, float]] = []
    silent: list[int] = []
    places = columns.places
    for row in columns.rows:
        if measure not in places or delimited.is_gap(row.cells[places[measure]]):
            silent.append(row.number)
            continue
        numbers = []
        for name in [name for name in ("latitude", "longitude", measure) if name in places]:
            text = row.cells[places[name]]
            try:
                bare = not re.match(r"[+-]|.*[NSEWnsew]", text.strip())
                figure = _parsed_cell(name, text, heads[name])
                numbers.append(figure * (signs.get(name, 1.0) if bare else 1.0))
            except ValueError as error:
                problems.append(row.problem(f"`{name}: {shown(text)}` {error}", places[name]))
        if len(numbers) == 3:
            values.append((row.number, numbers[0], numbers[1], numbers[2]))
    problems += _position_problems(path, values)
    if problems:
        raise InputError(delimited.abridged(problems))
    if columns.others:
        notices.append(f"not read: {', '.join(f'`{shown(one)}`' for one in columns.others)}")
    once: dict[tuple[float, float, float], int] = {}
    for line, *what in values:
        first = once.setdefault((what[0], what[1], what[2]), line)
        if first != line:
            notices.append(f"line {line} of the file repeats line {first} and was ignored")
    if silent:
        lines = ", ".join(map(str, silent))
        notices.append(f"rows without a reply were ignored: line{'s' * (len(silent) > 1)} {lines}")
    latitude, longitude, measured = np.array([*once]).reshape(-1, 3).T
    return Survey(
        path=path,
        line=tuple(once.values()),
        latitude=latitude,
        longitude=longitude,
        measured=measured,
        timed=measure == "time",
        transducer=transducer or its_transducer or 0.0,
        notices=tuple(notices),
    )


def hemisphere_signs(letters: str) -> dict[str, float]:
    """Return the signs of latitude and longitude for two hemisphere letters such as ``S,W``.

    Raises
    ------
    UsageError
        A letter is not N, S, E or W, or both letters refer to the same coordinate.
    """
    signs: dict[str, float] = {}
    for letter in filter(None, (part.strip().upper() for part in letters.split(","))):
        name = next((name for name, both in HEMISPHERES.items() if letter in both), None)
        if name is None or name in signs:
            raise UsageError(f"--hemisphere: `{letters[:20]}` is not a pair of letters such as S,W")
        signs[name] = -1.0 if letter in ("S", "W") else 1.0
    return signs


def _parsed_cell(name: str, text: str, factor: float) -> float:
    """Parse a cell to SI units or degrees; raise ValueError with a reason if it is invalid."""
    placed = name in HEMISPHERES
    if re.sub(r"\.0*$", "", text) in _FILLS:
        leave = "remove the row" if placed else "leave the cell blank"
        raise ValueError(f"is a fill value; {leave} if it is missing")
    sexagesimal = degrees_of(text, name) if placed else None
    if sexagesimal is None and (complaint := delimited.no_number(text)):
        degrees = "; degrees are needed, such as -5.2 or 5 12.0 W" if placed else ""
        raise ValueError(complaint + degrees)
    value = (float(text) if sexagesimal is None else sexagesimal) * factor
    if name == "latitude" and abs(value) > 90.0:
        raise ValueError("is beyond 90 degrees; are latitude and longitude exchanged?")
    if name == "longitude" and abs(value) > 360.0:
        raise ValueError("is beyond 360 degrees")
    if not placed and value <= 0.0:
        raise ValueError("must be above 0; leave the cell blank if there was no reply")
    if not placed and value > LONGEST[name]:
        hint = "; did you mean `time[ms]`?" if name == "time" and factor == 1.0 else ""
        unit = DIMENSIONS[_COLUMNS[name]].unit
        farther = f"{LONGEST[name]:g} {unit}, the maximum for an acoustic transponder"
        raise ValueError(f"is more than {farther}{hint}")
    return value


def _position_problems(path: Path, values: list[tuple[int, float, float, float]]) -> list[Problem]:
    problems = []
    places = []
    for line, latitude, longitude, _ in values:
        if latitude == 0.0 and longitude == 0.0:
            message = "position 0, 0 is a fill value; remove the row"
            problems.append(Problem(str(path), line, 1, message))
        else:
            places.append((line, latitude, longitude))
    if len(places) > 2:
        north, east = np.median([place[1:] for place in places], axis=0)
        for line, latitude, longitude in places:
            away = kilometres_from(latitude, longitude, (float(north), float(east)))
            if away > WIDEST:
                message = f"the position is {away:.0f} km from the other positions"
                problems.append(Problem(str(path), line, 1, message))
    return problems


SLOWEST, FASTEST = 1380.0, 1680.0
"""Lowest and highest speed of sound in natural waters [m/s].

The lowest speed occurs in fresh water near freezing, and the highest in the deepest trench.
"""
_OF_SOUND = {"depth": "length", "sound_speed": "speed"}
_EXAMPLE = "depth[m],sound_speed[m/s]"


@dataclass(frozen=True)
class Sound:
    """Profile of the speed of sound, linear between its depths and constant beyond them.

    Attributes
    ----------
    depth : (k,) depths, increasing [m]
    speed : (k,) speed of sound at these depths [m/s]
    """

    depth: Floats
    speed: Floats

    @classmethod
    def constant(cls, speed: float) -> Sound:
        """Return a profile with the same speed at all depths [m/s]."""
        return cls(np.zeros(1), np.array([speed]))

    def mean(self, above: float, below: float) -> float:
        """Return the harmonic mean of the speed between two depths [m/s].

        The travel time of a straight ray of any slope is its length divided by this speed.
        """
        if len(self.speed) == 1 or below - above < 1e-6:
            return float(np.interp(0.5 * (above + below), self.depth, self.speed))
        inside = self.depth[(self.depth > above) & (self.depth < below)]
        levels = np.array([above, *inside, below])
        speeds = np.interp(levels, self.depth, self.speed)
        ratio = np.diff(speeds) / speeds[:-1]
        # ∫ dz/c of a linear c is Δz ln(1 + x)/(x c), x its relative growth
        same = ratio == 0.0
        slowness = np.where(same, 1.0, np.log1p(ratio) / np.where(same, 1.0, ratio))
        time = float((np.diff(levels) * slowness / speeds[:-1]).sum())
        return (below - above) / time


def read_sound(path: Path) -> Sound:
    """Read a sound-speed profile from CSV with the header ``depth[m],sound_speed[m/s]``.

    Raises
    ------
    InputError
        The file has mistakes, such as implausible speeds; all of them are listed.
    """
    problems: list[Problem] = []
    columns = read_named_columns(delimited.read_table(path, _EXAMPLE), _OF_SOUND, problems)
    for name, dimension in _OF_SOUND.items():
        if name not in columns.factors:
            problems.append(columns.lacks(name, DIMENSIONS[dimension].unit))
    depths: list[float] = []
    speeds: list[float] = []
    for row in columns.rows:
        for name, place in columns.places.items():
            text, factor = row.cells[place], columns.factors[name]
            complaint = _complaint(name, text, factor, depths)
            if complaint:
                problems.append(row.problem(f"`{name}: {shown(text)}` {complaint}", place))
            else:
                (depths if name == "depth" else speeds).append(float(text) * factor)
    if not problems and not depths:
        problems.append(Problem(str(path), 0, 0, "there are no rows below the header"))
    if problems:
        raise InputError(delimited.abridged(problems))
    return Sound(np.array(depths), np.array(speeds))


def _complaint(name: str, text: str, factor: float, depths: list[float]) -> str:
    if complaint := delimited.no_number(text):
        return complaint
    value = float(text) * factor
    if name == "depth":
        if value < 0.0 or (depths and value <= depths[-1]):
            return "is not valid: depths are positive down from the surface and must increase"
        return ""
    return "" if SLOWEST <= value <= FASTEST else sound_complaint()


def sound_complaint() -> str:
    """Return the message for an implausible speed of sound."""
    return f"is not a speed of sound in water, which is {SLOWEST:g} to {FASTEST:g} m/s"


_OTHER_NAMES: Mapping[str, str] = {
    **dict.fromkeys(("lat", "ship_lat", "ship_latitude"), "latitude"),
    **dict.fromkeys(("lon", "long", "lng", "ship_lon", "ship_longitude"), "longitude"),
    **dict.fromkeys(("slant_range", "slant", "distance", "rng", "slantrange"), "range"),
    **dict.fromkeys(("twt", "twtt", "two_way_time", "two_way_travel_time", "travel_time"), "time"),
}
"""Alternative column names."""

_PART = re.compile(r"(?i)(?:ship[ _]?)?(lat|lon)\w*?[ _\[(]*(deg|min|hem|ns|ew|dir)\w*[\])]*")
_LARGEST = 5_000_000
_NEAR = 1.0  # degrees: largest difference between the positions of a survey
_BareRow = tuple[int, list[str]]
"""Line number and cells of one row in a file without column headings."""


def _survey_table(path: Path) -> tuple[delimited.TextTable, float | None, list[str]]:
    """Read the table of a survey; return it with the transducer depth [m], if given, and notices.

    Raises
    ------
    InputError
        The file is unreadable or empty, or has an unknown format.
    """
    rows = _bare_rows(path)
    columns = len(rows[0][1]) if rows else 0
    transducer = None
    if columns == 5 and all(0.0 <= float(cells[at]) < 60.0 for _, cells in rows for at in (1, 3)):
        header = "latitude,longitude,time[s]"
        lines = [
            (number, f"{_angle(cells[:2])},{_angle(cells[2:4])},{2.0 * float(cells[4]):.9g}")
            for number, cells in rows
        ]
        note = (
            "has no column headings and was read as degrees, minutes, degrees, minutes and one-way "
            "time in seconds; south and west are negative"
        )
    elif columns == 3 and (above := _row_of_depths(rows)):
        header = "range[m],latitude,longitude"
        depth, release, transducer = map(float, rows[above - 1][1])
        lines = [(number, ",".join(cells)) for number, cells in rows[above + 1 :]]
        note = (
            "has no column headings and was read as range, latitude and longitude below a row "
            f"with the depths and the drop position. The transducer depth of {transducer:g} m in "
            f"the file is used. The water depth of {depth:g} m and the release height of "
            f"{release:g} m above the seabed are ignored; set them with --depth and --above-seabed"
        )
    else:
        return _with_joined_positions(delimited.read_table(path, EXAMPLE)), None, []
    return delimited.read_table(path, EXAMPLE, [(1, header), *lines]), transducer, [note]


def _bare_rows(path: Path) -> list[_BareRow]:
    """Read the rows of a purely numeric file with rows of equal length; [] for other files."""
    whole = enumerate(read_text(path, largest=_LARGEST).splitlines(), 1)
    bare = ((number, re.split("[%#]", line)[0].strip()) for number, line in whole)
    lines = [(number, line) for number, line in bare if line]
    parted = any(sign in line for _, line in lines for sign in ",;")  # else by blanks of any kind
    dialect = delimited.dialect_of([line for _, line in lines]) if parted else None
    rows = [(number, dialect.cells(line) if dialect else line.split()) for number, line in lines]
    plain = all(delimited.NUMBER.fullmatch(cell) for _, cells in rows for cell in cells)
    return rows if plain and len({len(cells) for _, cells in rows}) == 1 else []


def _row_of_depths(rows: Sequence[_BareRow]) -> int:
    """Return the number of the row that contains the depths, counted from 1.

    The number is 2 if a row with the target precedes the depths; otherwise, it is 1. Return 0 if
    the file has another format. In the NOC format, the last two cells of all other rows are
    positions of one survey.
    """
    if len(rows) <= 4:
        return 0
    for above in (1, 2):
        others = (map(float, cells[1:]) for _, cells in (*rows[: above - 1], *rows[above:]))
        if all(max(each) - min(each) < _NEAR for each in zip(*others, strict=True)):
            return above
    return 0


def _angle(cells: Sequence[str]) -> str:
    """Join degrees, minutes and hemisphere in one cell."""
    degrees, *rest = (cell.strip() for cell in cells)
    degrees = re.sub(r"\.0*$", "", degrees)
    return " ".join([degrees, *rest]).strip()


def _with_joined_positions(table: delimited.TextTable) -> delimited.TextTable:
    """Return a copy of a table with the degrees and minutes of each position in one cell.

    The cell is in the column of the degrees.
    """
    rows, header = list(table.rows), list(table.header.cells)
    for j, cell in enumerate(header):
        of_day = any(":" in row.cells[j] for row in rows if j < len(row.cells))
        if of_day and heading(cell) == (cell.strip(), ""):
            header[j] = f"clock {cell}"  # not to be mistaken for travel times
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
                cells[at["deg"]] = _angle(chosen)
            rows[i] = row._replace(cells=cells)
    return replace(table, header=table.header._replace(cells=header), rows=rows)
