"""Read the environment of a WHOI Cable problem, and currents in a file beside it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calm.errors import refused
from calm.exchange.cable_grammar import KeyValue, KeyValues
from calm.exchange.design import (
    ImportedWater,
    Remark,
)
from calm.quantities import bearing_of
from calm.whole_file import read_text

USUAL_GRAVITY = 9.81
"""Gravity in the problems that come with that program, which has no default [m/s²]."""

_FINEST = 1e-4  # share of the fastest current by which levels may miss a formula
_HALVINGS = 8
_DIGITS = 9  # of a speed in m/s
_WAVES = ("x-wave", "y-wave", "x-input", "y-input", "z-input", "wave-file")
_DYNAMICS = ("forcing-method", "input-type", "velocity-file", "force-file")
_SEABED = ("bottom-stiffness", "bottom-damping", "bottom-elevation")
_Profile = tuple[Callable[[float], float], list[float]]
"""A speed by depth, and the depths between which it is linear."""

_LARGEST = 20_000_000  # bytes
_MOST = 2_000_000  # speeds
_AXES = ("time", "depth", "x", "y")


def water_of(
    environment: KeyValues,
    deepest: float,
    dropped: list[Remark],
    *,
    folder: Path,
    allow_include: bool,
) -> ImportedWater:
    """Depth, density, gravity, current and wind.

    Parameters
    ----------
    deepest : of the line [m], for a tow whose file gives no depth
    folder : of the problem, in which files of currents stand
    allow_include : whether they may stand elsewhere
    """
    depth = environment.number("depth")
    water = ImportedWater(depth if depth > 0.0 else None)
    water.density = environment.number("rho", "density") or None
    water.gravity = environment.number("gravity", default=USUAL_GRAVITY)
    if "gravity" not in environment:
        water.guesses["gravity"] = "the file gives none; the usual value of such files"
    gridded = None
    if "current-file" in environment:
        value = environment["current-file"]
        gridded = _gridded_current(value, folder, allow_include=allow_include)
        if gridded is None:
            what = f"still water: its current-file `{value.text}` is missing"
            water.guesses["current"] = what
        else:
            dropped += [Remark("current-file", each) for each in gridded.others]
    water.current = _current(environment, gridded, depth if depth > 0.0 else deepest)
    east, north = (environment.number(f"{axis}-wind") for axis in "xy")
    if east or north:
        water.wind = math.hypot(east, north), bearing_of(east, north)
    for what, keys in (("waves", _WAVES), ("how waves act", _DYNAMICS), ("the seabed", _SEABED)):
        found = [key for key in keys if key in environment]
        if found:
            dropped.append(Remark("environment", f"{what} ({', '.join(found)})"))
    return water


def _current(
    environment: KeyValues, gridded: GriddedCurrent | None, deepest: float
) -> tuple[tuple[float, float, float, float], ...]:
    """Rows of depth, and speed to the east (x), to the north (y) and up (z), at the time 0."""
    axes = [_profile(environment, axis, gridded) for axis in "xyz"]
    if not any(axes):
        return ()
    angle = 0.0 if gridded else environment.number("current-rotation")

    def at(depth: float) -> tuple[float, float, float]:
        x, y, z = (0.0 if axis is None else axis[0](depth) for axis in axes)
        turned = x * math.cos(angle) - y * math.sin(angle)
        return turned, x * math.sin(angle) + y * math.cos(angle), z

    knots = {0.0, deepest}
    knots.update(knot for axis in axes if axis for knot in axis[1] if 0.0 < knot < deepest)
    levels = sorted(knots)
    if any(axis is not None and not axis[1] for axis in axes):
        levels = _refined(at, levels)
    rows = []
    for depth in levels:
        x, y, z = (round(speed, _DIGITS) + 0.0 for speed in at(depth))
        rows.append((depth, x, y, z))
    return tuple(rows) if any(any(row[1:]) for row in rows) else ()


def _profile(environment: KeyValues, axis: str, gridded: GriddedCurrent | None) -> _Profile | None:
    scale = environment.number(f"{axis}-current-scale", default=1.0)
    if scale == 1.0:
        scale = environment.number("current-scale", default=1.0)
    if gridded is not None:  # it is scaled there, but neither modulated nor turned
        speed = gridded.axis("xyz".index(axis))
        return (lambda depth: scale * speed(depth)), gridded.depth.tolist()
    value = environment.get(f"{axis}-current")
    if value is None:
        return None
    modulation = environment.get(f"{axis}-current-modulation")
    if modulation is not None:
        scale *= modulation.at(0.0)
    knots = [row[0].at() for row in value.rows]
    if not knots and value.formula is not None and not value.formula.names:
        knots = [0.0]  # one speed at all depths
    return (lambda depth: scale * value.at(depth)), knots


def _refined(at: Callable[[float], tuple[float, float, float]], levels: list[float]) -> list[float]:
    """Levels between which the current is linear within a tolerance."""
    fastest = max(max(map(abs, at(depth))) for depth in levels)
    for _ in range(_HALVINGS):
        finer = [levels[0]]
        for upper, lower in pairwise(levels):
            middle = (upper + lower) / 2.0
            a, b, c = at(upper), at(middle), at(lower)
            fastest = max(fastest, *map(abs, b))
            straight = all(
                abs(y - (x + z) / 2.0) <= _FINEST * fastest for x, y, z in zip(a, b, c, strict=True)
            )
            finer += [lower] if straight and len(levels) > 4 else [middle, lower]
        if len(finer) == len(levels):
            break
        levels = finer
    return levels


@dataclass(frozen=True)
class GriddedCurrent:
    """Hold the profile at the anchor at the time 0.

    Attributes
    ----------
    depth : of the levels, growing [m]
    speeds : to the east (x), to the north (y) and up (z) by level, (n, 3) [m/s]
    others : what it leaves out of the grid
    """

    depth: NDArray[np.float64]
    speeds: NDArray[np.float64]
    others: tuple[str, ...]

    def axis(self, number: int) -> Callable[[float], float]:
        """Return a speed by depth, constant beyond the first and the last level, as there."""
        column = self.speeds[:, number]
        return lambda depth: float(np.interp(depth, self.depth, column))


def _gridded_current(
    value: KeyValue, folder: Path, *, allow_include: bool
) -> GriddedCurrent | None:
    """Return the currents of a file beside the problem; None where there is no such file.

    It begins with step, start and count of time, depth, x and y; the speeds to x, y and z follow,
    the depth running fastest, then x, then y, then the time.
    """
    path = folder / value.text
    if not allow_include and not path.resolve().is_relative_to(folder.resolve()):
        raise value.token.refuse(
            f"`{value.text}` lies outside the folder of the file; --allow-include reads it"
        )
    if not path.is_file():
        return None
    numbers = _numbers(path)
    steps, starts, counts = (numbers[i:12:3] for i in range(3))
    sizes = [round(count) for count in counts]
    if numbers.size < 12 or min(sizes) < 1 or not np.all(steps):
        raise refused(path, "must begin with step, start and count of time, depth, x and y")
    if np.prod([float(size) for size in sizes]) * 3 > _MOST:
        raise refused(path, f"holds more than {_MOST} speeds")
    times, depths, easts, norths = sizes
    wanted = 12 + times * norths * easts * depths * 3
    if numbers.size < wanted:
        raise refused(path, f"has {numbers.size - 12} speeds, not {wanted - 12}")
    grid = numbers[12:wanted].reshape(times, norths, easts, depths, 3)
    axes = {
        name: start + step * np.arange(size)
        for name, start, step, size in zip(_AXES, starts, steps, sizes, strict=True)
    }
    here = _at_zero(_at_zero(_at_zero(grid, axes["time"]), axes["y"]), axes["x"])
    others = ["times after the first"] if times > 1 else []
    if np.ptp(grid, axis=(1, 2)).any():
        others.append("how it varies horizontally: the profile at the anchor is taken")
    order = np.argsort(axes["depth"])
    return GriddedCurrent(axes["depth"][order], here[order], tuple(others))


def _numbers(path: Path) -> NDArray[np.float64]:
    try:
        numbers = np.array(read_text(path, largest=_LARGEST).split(), np.float64)
    except ValueError:
        raise refused(path, "holds something other than numbers") from None
    if not np.all(np.isfinite(numbers)):
        raise refused(path, "holds numbers without a value")
    return numbers


def _at_zero(grid: NDArray[np.float64], axis: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the grid at 0 of its first axis, or at that end of it which is nearer."""
    order = np.argsort(axis)
    axis, grid = axis[order], grid[order]
    place = min(max(0.0, axis[0]), axis[-1])
    above = min(int(np.searchsorted(axis, place)), axis.size - 1)
    below = max(above - 1, 0)
    apart = axis[above] - axis[below]
    share = (place - axis[below]) / apart if above > below else 0.0
    return np.asarray(grid[below] + share * (grid[above] - grid[below]))
