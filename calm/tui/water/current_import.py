"""A current from a file: which one, at what time, and whether to refer to it or to copy it."""

from __future__ import annotations

from collections.abc import Sequence
from math import isclose
from pathlib import Path

from numpy import float32

from calm.errors import UsageError
from calm.records.profile_tables import speed_and_direction
from calm.tui.checking import Check, Reading, anything
from calm.tui.dialogs import Asked, Sheet
from calm.tui.water.form import CURRENT_COLUMNS

_SPEEDS = ("depth m", "u m/s", "v m/s", "w m/s")
_NOISE = 1e-12  # of computing a speed and a direction in doubles, and then some


class ImportSheet(Sheet):
    """File, time, and how it is to stand in the mooring file."""

    def __init__(self, folder: Path) -> None:
        super().__init__(
            "A current from a file",
            f"CSV or CF NetCDF, from {folder} unless another is named. `refer` keeps the file's "
            "name in the mooring file; `copy` writes its profile as a table.",
            [
                Asked("file", "File", check=_existing(folder), placeholder="e.g. adcp.nc"),
                Asked(
                    "time",
                    "Time",
                    check=anything,
                    placeholder="e.g. 2026-03-01T06:00, if it is a record",
                ),
                Asked("how", "refer or copy", "refer", _how),
            ],
        )


def imported(path: Path, time: str, depth: float) -> tuple[Sequence[str], Sequence[Sequence[str]]]:
    """The profile of a file as columns and rows of a table.

    Parameters
    ----------
    path : CSV, NetCDF or zarr
    time : which profile of a record, as ISO 8601; empty where there is one only
    depth : of the water [m]

    Returns
    -------
    columns : depth [m]; speed [m/s] and direction [degrees], or eastward and northward speed
        [m/s], whichever needs fewer digits, as a rule that of the file; with an upward speed
        [m/s] where the water rises or sinks
    rows : a level each, from the top, with all digits of the file

    Raises
    ------
    CalmError
        The file, or the time, cannot be used.
    """
    from calm.records.current_file import read_current_file
    from calm.records.current_terms import Terms
    from calm.records.times import TimeChoiceError

    try:
        table, _ = read_current_file(path, time or None, Terms(water_depth=depth))
    except TimeChoiceError as error:
        raise UsageError(f"{path.name}: {error}") from None
    levels = list(zip(table.depth, table.u, table.v, table.w, strict=True))
    by_components = [[_written(each) for each in level] for level in levels]
    if any(table.w):
        return _SPEEDS, by_components
    plain = [row[:3] for row in by_components]
    by_direction = [
        [*map(_written, (depth, *speed_and_direction(u, v)))] for depth, u, v, _ in levels
    ]
    if _signs(plain) < _signs(by_direction):
        return _SPEEDS[:3], plain
    return CURRENT_COLUMNS, by_direction


def _written(value: float) -> str:
    """All digits of a value that was read, as 32 bits where it came of such, and no noise."""
    short = float32(value)
    if isclose(short, value, rel_tol=_NOISE):
        return f"{float(str(short)) + 0.0:.12g}"
    return f"{round(value, 12) + 0.0:.12g}"


def _signs(rows: Sequence[Sequence[str]]) -> int:
    return sum(len(text) for row in rows for text in row)


def _existing(folder: Path) -> Check:
    def check(text: str) -> Reading:
        tidy = text.strip()
        if not tidy:
            return Reading("", "a file is needed")
        try:
            is_there = (folder / tidy).exists()
        except (OSError, ValueError):  # no file can have such a name
            is_there = False
        return Reading(tidy) if is_there else Reading(tidy, "no such file")

    return check


def _how(text: str) -> Reading:
    word = text.strip().casefold()
    for choice in ("refer", "copy"):
        if word and choice.startswith(word):
            return Reading(choice)
    return Reading(word, "is refer or copy", "refer")
