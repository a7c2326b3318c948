"""A current from a file: which one, at what time, and whether to refer to it or to copy it."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, degrees, hypot
from pathlib import Path

from calm.errors import CalmError, UsageError
from calm.tui.checking import Check, Reading, anything
from calm.tui.dialogs import Asked, Sheet
from calm.tui.water_form import CURRENT_COLUMNS, Water

_SPEEDS = ("depth m", "u m/s", "v m/s", "w m/s")


class ImportSheet(Sheet):
    """File, time, and how it is to stand in the mooring file."""

    def __init__(self, folder: Path) -> None:
        super().__init__(
            "A current from a file",
            f"CSV or CF NetCDF, from {folder} unless told otherwise. `refer` keeps the file's name "
            "in the mooring file; `copy` writes its profile as a table.",
            [
                Asked("file", "File", check=_existing(folder), placeholder="adcp.nc"),
                Asked(
                    "time",
                    "Time",
                    check=anything,
                    placeholder="2026-03-01T06:00, if it is a record",
                ),
                Asked("how", "refer or copy", "refer", _how),
            ],
        )


def imported(path: Path, time: str, water: Water) -> tuple[Sequence[str], Sequence[Sequence[str]]]:
    """The profile of a file as columns and rows of a table.

    Raises
    ------
    CalmError
        The file, or the time, cannot be used.
    """
    from calm.files.current_file import read_current_file
    from calm.files.times import TimeChoiceError

    try:
        table, _ = read_current_file(path, time or None, water.depth)
    except CalmError:
        raise
    except TimeChoiceError as error:
        raise UsageError(f"{path.name}: {error}") from None
    levels = list(zip(table.depth, table.u, table.v, table.w, strict=True))
    if any(w for *_, w in levels):
        return _SPEEDS, [[f"{each:.6g}" for each in level] for level in levels]
    rows = [
        [f"{depth:.6g}", f"{hypot(u, v):.4g}", f"{degrees(atan2(u, v)) % 360:.4g}"]
        for depth, u, v, _ in levels
    ]
    return CURRENT_COLUMNS, rows


def _existing(folder: Path) -> Check:
    def check(text: str) -> Reading:
        tidy = text.strip()
        if not tidy:
            return Reading("", "a file is needed")
        return Reading(tidy) if (folder / tidy).exists() else Reading(tidy, "no such file")

    return check


def _how(text: str) -> Reading:
    word = text.strip().casefold()
    for choice in ("refer", "copy"):
        if word and choice.startswith(word):
            return Reading(choice)
    return Reading(word, "is refer or copy", "refer")
