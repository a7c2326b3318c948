"""Currents to begin with, and those of files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import exp, isclose
from pathlib import Path
from typing import TYPE_CHECKING

from numpy import float32

from calm.errors import CalmError, UsageError
from calm.records.profile_tables import speed_and_direction
from calm.tui.checking import Check, Reading
from calm.tui.dialogs import Answer, Asked, InputSheet, Question, choose
from calm.tui.water.form import CURRENT_COLUMNS, USUAL_DEPTH

if TYPE_CHECKING:
    from calm.tui.water.water_screen import WaterScreen

_SHARES = (0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0)
_POWER = 1 / 7


_PRESETS: Mapping[str, Callable[[float], float]] = {
    "uniform, 0.5 m/s": lambda share: 0.5,
    "tidal stream, 1 m/s, falling by the 1/7 power of the height above the bed":
        lambda share: (1.0 - share) ** _POWER,
    "linear shear, 0.8 m/s at the surface to nothing at the bed":
        lambda share: 0.8 * (1.0 - share),
    "boundary current, 1.2 m/s at the surface, decaying by e in a fifth of the depth":
        lambda share: 0.05 + 1.15 * exp(-share / 0.2),
}  # fmt: skip
"""Profiles to begin with: the speed [m/s] at a share of the depth, 0 at the surface, 1 at the bed.
"""


class Currents:
    """What puts a whole current into the environment that the screen of the water shows."""

    def __init__(self, screen: WaterScreen) -> None:
        self._screen, self._workspace = screen, screen.workspace

    def offer_presets(self) -> None:
        """A profile to begin with."""

        def take(speed: Callable[[float], float]) -> None:
            deep = self._screen.water.depth or USUAL_DEPTH
            rows = [(f"{part * deep:.4g}", f"{speed(part):.2g}", "90") for part in _SHARES]
            self._screen.put_table(CURRENT_COLUMNS, rows, "a preset current")

        if self._screen.settle():
            depth = self._screen.water.depth
            down = f"{USUAL_DEPTH:g} m, as no depth is given" if depth is None else f"{depth:g} m"
            answers = [
                Answer(str(key), name, partial(take, speed))
                for key, (name, speed) in enumerate(_PRESETS.items(), 1)
            ]
            text = f"A table down to {down}, towards the east, for you to change."
            choose(self._screen.app, Question("A current to start from", text, answers))

    def ask_for_file(self) -> None:
        """A current from CSV or NetCDF: referred to, or its profile copied."""

        def take(texts: dict[str, str] | None) -> None:
            if texts is None:
                self._screen.show_draft()
                return
            path, time, water = texts["file"], texts["time"], self._screen.water
            if texts["how"] == "refer":
                given = {"file": path} | ({"time": time} if time else {})
                message = f"current of {path}"
                self._screen.change(lambda water: water.put_form(("current",), given), message)
                return
            self._workspace.tell(f"Reading {path} …")
            read = partial(self._read, water.variant, path, time, water.depth or USUAL_DEPTH)
            self._screen.run_worker(read, thread=True, exit_on_error=False)

        if self._screen.settle():
            self._screen.app.push_screen(import_sheet(self._folder), take)

    def _read(self, variant: str | None, path: str, time: str, depth: float) -> None:
        """Read a file for an environment in a thread; what comes of it is taken by the form."""
        tell, later = self._workspace.tell, self._screen.call_later
        try:
            columns, rows = imported(self._folder / path, time, depth)
        except CalmError as error:
            later(tell, str(error).partition("\n")[0], wrong=True)
        except Exception as error:  # the libraries that read NetCDF raise whatever they like
            reason = f"{type(error).__name__}: {error}"
            later(tell, f"{path} cannot be read: {reason}", wrong=True)
        else:
            later(self._take, variant, path, columns, rows)

    def _take(
        self,
        variant: str | None,
        path: str,
        columns: Sequence[str],
        rows: Sequence[Sequence[str]],
    ) -> None:
        if variant != self._screen.water.variant:
            message = f"{path} was read for another environment; read it again"
            self._workspace.tell(message, wrong=True)
        else:
            self._screen.put_table(columns, rows, f"current of {path}")
            self._workspace.tell(f"The current of {path} is in the table")

    @property
    def _folder(self) -> Path:
        path = self._screen.session.file.path
        return Path.cwd() if path is None else path.absolute().parent


_SPEEDS = ("depth m", "u m/s", "v m/s", "w m/s")
_NOISE = 1e-12  # of computing a speed and a direction in doubles, and then some


def import_sheet(folder: Path) -> InputSheet:
    """Ask for a file, a time, and how it is to stand in the mooring file."""
    return InputSheet(
        "A current from a file",
        f"CSV or CF NetCDF, from {folder} unless another is named. `refer` keeps the file's "
        "name in the mooring file; `copy` writes its profile as a table.",
        [
            Asked("file", "File", check=_existing(folder), placeholder="e.g. adcp.nc"),
            Asked("time", "Time", placeholder="e.g. 2026-03-01T06:00, if it is a record"),
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
    from calm.records.current_terms import Terms, TimeChoiceError

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
