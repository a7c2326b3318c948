"""Currents that WHOI Cable reads from a file of their own, on a grid of time and place."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calm.exchange.cbl.problem import KeyValue
from calm.exchange.refusal import refused
from calm.files.document import read_text

_LARGEST = 20_000_000  # bytes
_MOST = 2_000_000  # speeds
_AXES = ("time", "depth", "x", "y")


@dataclass(frozen=True)
class GriddedCurrent:
    """The profile at the anchor at the time 0.

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
        """A speed by depth, constant beyond the first and the last level, as in that program."""
        column = self.speeds[:, number]
        return lambda depth: float(np.interp(depth, self.depth, column))


def gridded_current(value: KeyValue, folder: Path, *, allow_include: bool) -> GriddedCurrent | None:
    """The currents of a file beside the problem; None where there is no such file.

    It begins with step, start and count of time, depth, x and y; the speeds to x, y and z follow,
    the depth running fastest, then x, then y, then the time.

    Raises
    ------
    InputError
        The file lies elsewhere, or its numbers do not go together.
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
        others.append("how it changes from place to place: it is that at the anchor")
    order = np.argsort(axes["depth"])
    return GriddedCurrent(axes["depth"][order], here[order], tuple(others))


def _numbers(path: Path) -> NDArray[np.float64]:
    try:
        numbers = np.array(read_text(path, largest=_LARGEST).split(), np.float64)
    except ValueError:
        raise refused(path, "holds something else than numbers") from None
    if not np.all(np.isfinite(numbers)):
        raise refused(path, "holds numbers without a value")
    return numbers


def _at_zero(grid: NDArray[np.float64], axis: NDArray[np.float64]) -> NDArray[np.float64]:
    """The grid at 0 of its first axis, or at that end of it which is nearer."""
    order = np.argsort(axis)
    axis, grid = axis[order], grid[order]
    place = min(max(0.0, axis[0]), axis[-1])
    above = min(int(np.searchsorted(axis, place)), axis.size - 1)
    below = max(above - 1, 0)
    apart = axis[above] - axis[below]
    share = (place - axis[below]) / apart if above > below else 0.0
    return np.asarray(grid[below] + share * (grid[above] - grid[below]))
