"""The speed of sound: one, or a profile, and the path of a straight ray through it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from calm.errors import InputError, Problem
from calm.physics.line import Floats
from calm.records.delimited import abridged, no_number
from calm.records.headings import read_named_columns
from calm.suggestions import shown
from calm.units import DIMENSIONS

SLOWEST, FASTEST = 1380.0, 1680.0
"""Of sound in natural waters [m/s]: near-freezing fresh water, the deepest trench."""
_COLUMNS = {"depth": "length", "sound_speed": "speed"}
_EXAMPLE = "depth[m],sound_speed[m/s]"


@dataclass(frozen=True)
class Sound:
    """Speed of sound by depth: linear between the depths, constant beyond them.

    Attributes
    ----------
    depth : (k,) growing [m]
    speed : (k,) [m/s]
    """

    depth: Floats
    speed: Floats

    @classmethod
    def constant(cls, speed: float) -> Sound:
        """Return the same speed at all depths [m/s]."""
        return cls(np.zeros(1), np.array([speed]))

    def mean(self, above: float, below: float) -> float:
        """Return the harmonic mean between two depths [m/s].

        A straight ray spends its way evenly over the depths between its ends, at any slope, so its
        time is its length over this mean.
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
    """Return a profile from a CSV file with the header ``depth[m],sound_speed[m/s]``.

    Raises
    ------
    InputError
        With every mistake of the file: a depth that does not grow, a speed that no water has.
    """
    problems: list[Problem] = []
    columns = read_named_columns(path, _COLUMNS, _EXAMPLE, problems)
    for name, dimension in _COLUMNS.items():
        if name not in columns.factors:
            problems.append(columns.lacks(path, name, DIMENSIONS[dimension].unit))
    depths: list[float] = []
    speeds: list[float] = []
    for row in columns.rows:
        for name, text in row.cells.items():
            factor = columns.factors[name]
            complaint = _complaint(name, text, factor, depths)
            if complaint:
                message = f"`{name}: {shown(text)}` {complaint}"
                problems.append(row.problem(path, name, message))
            else:
                (depths if name == "depth" else speeds).append(float(text) * factor)
    if not problems and not depths:
        problems.append(Problem(str(path), 0, 0, "there are no rows below the header"))
    if problems:
        raise InputError(abridged(problems))
    return Sound(np.array(depths), np.array(speeds))


def _complaint(name: str, text: str, factor: float, depths: list[float]) -> str:
    if complaint := no_number(text):
        return complaint
    value = float(text) * factor
    if name == "depth":
        if value < 0.0 or (depths and value <= depths[-1]):
            return "depths count downwards from 0 and must increase"
        return ""
    return "" if SLOWEST <= value <= FASTEST else sound_complaint()


def sound_complaint() -> str:
    """Return what is said of a speed of sound that no water has."""
    return f"is not a speed of sound in water; it is {SLOWEST:g} to {FASTEST:g} m/s"
