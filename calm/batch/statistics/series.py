"""The columns of a batch result, one in memory at a time."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryFile
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from calm.errors import UsageError
from calm.files.explain import unknown

if TYPE_CHECKING:
    from xarray import Dataset

Column = NDArray[np.floating[Any]]
Times = NDArray[np.datetime64]

TOP = "top"
"""The free end of the line, whatever its label."""

_COLUMNS = (
    "depth_top", "x_top", "y_top", "tension_top", "tension_bottom", "tilt", "knockdown",
    "clamp_depth", "clamp_tension", "clamp_tilt", "clamp_knockdown",
)  # fmt: skip
_ROWS = 32768  # profiles turned at a time
_FIGURE = np.dtype(np.float32)


class Series:
    """A batch result over time, n profiles, NaN where a profile was not solved.

    A result lies on the disk by profiles; here it is turned once, into a temporary file by
    columns, so that each can be read by itself: memory does not grow with the components. The file
    has the size of the result without compression, and goes with the `with` block.

    Parameters
    ----------
    dataset : the result, opened without loading it
    folder : for the temporary file; the system's unless given

    Attributes
    ----------
    time : (n,) of the profiles
    status : (n,) 0 where solved
    component_label, clamp_label : of the columns

    Raises
    ------
    UsageError
        There is no room for the temporary file.
    """

    def __init__(self, dataset: Dataset, folder: Path | None = None) -> None:
        self.dataset = dataset
        self.time: Times = dataset["time"].values.astype("datetime64[ns]", copy=False)
        self.status: NDArray[np.int8] = dataset["status"].values
        self.component_label = _labels(dataset, "component_label")
        self.clamp_label = _labels(dataset, "clamp_label")
        self._columns: dict[str, range] = {}
        try:
            self._turned = TemporaryFile(dir=folder, prefix=".calm-", suffix=".part")  # noqa: SIM115
            self._turn()
        except OSError as error:
            place = folder or "the folder for temporary files"
            raise UsageError(f"cannot gather the statistics in {place}: {error.strerror}") from None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._turned.close()

    def __len__(self) -> int:
        return len(self.time)

    def ends(self, name: str) -> Column:
        """(n,) of a variable of the whole line, such as `anchor_vertical`."""
        return np.asarray(self.dataset[name].values)

    def column(self, name: str, index: int) -> Column:
        """(n,) of a component or a clamp, such as `tilt` or `clamp_tilt`."""
        values = np.empty(len(self), _FIGURE)
        self._turned.seek(self._columns[name][index] * values.nbytes)
        self._turned.readinto(values.data)
        return values

    def at(self, name: str, time: int) -> Column:
        """(columns,) of all components or clamps in one profile, none where there are none."""
        values = []
        for column in self._columns.get(name, ()):
            self._turned.seek((column * len(self) + time) * _FIGURE.itemsize)
            values.append(np.frombuffer(self._turned.read(_FIGURE.itemsize), _FIGURE)[0])
        return np.array(values, _FIGURE)

    def depth(self, label: str) -> Column:
        """(n,) depth of the upper end of a component, or of a clamp [m]."""
        prefix, index = self._place(label)
        return self.column("clamp_depth" if prefix else "depth_top", index)

    def knockdown(self, label: str) -> Column:
        """(n,) how much deeper than in still water [m]."""
        prefix, index = self._place(label)
        return self.column(f"{prefix}knockdown", index)

    def tilt(self, label: str) -> Column:
        """(n,) from the vertical [degrees]."""
        prefix, index = self._place(label)
        return self.column(f"{prefix}tilt", index)

    def tensions(self, label: str) -> tuple[Column, Column]:
        """(n,) at both ends of a component, the same twice at a clamp [N]."""
        prefix, index = self._place(label)
        names = ("clamp_tension",) * 2 if prefix else ("tension_top", "tension_bottom")
        upper, lower = (self.column(name, index) for name in names)
        return upper, lower

    def tension(self, label: str) -> Column:
        """(n,) the greater of those at both ends of a component, or at a clamp [N]."""
        return np.maximum(*self.tensions(label))

    def _place(self, label: str) -> tuple[str, int]:
        return _placed(label, self.component_label, self.clamp_label)

    def _turn(self) -> None:
        first = 0
        for name in _COLUMNS:
            if name not in self.dataset:
                continue
            variable = self.dataset[name]
            columns = range(first, first + variable.shape[1])
            self._columns[name] = columns
            for begin in range(0, len(self), _ROWS):
                block = variable[begin : begin + _ROWS].values.astype(_FIGURE, copy=False)
                for column, values in zip(columns, np.ascontiguousarray(block.T), strict=True):
                    self._turned.seek((column * len(self) + begin) * _FIGURE.itemsize)
                    self._turned.write(values.data)
            first = columns.stop
        self._turned.flush()


def place_of(dataset: Dataset, label: str) -> tuple[str, int]:
    """Prefix of the variables of a part of the line in a result, and its column.

    Parameters
    ----------
    label : of a component or a clamp; ``top`` is the first component

    Raises
    ------
    UsageError
        No part is called so; the message offers the nearest that is.
    """
    return _placed(label, _labels(dataset, "component_label"), _labels(dataset, "clamp_label"))


def _placed(label: str, components: tuple[str, ...], clamps: tuple[str, ...]) -> tuple[str, int]:
    if label in components:
        return "", components.index(label)
    if label in clamps:
        return "clamp_", clamps.index(label)
    if label == TOP:
        return "", 0
    parts = [TOP, *components, *clamps]
    raise UsageError(unknown(f"no part of the line is called `{label}`", label, parts))


def _labels(dataset: Dataset, name: str) -> tuple[str, ...]:
    if name not in dataset.variables:
        return ()
    return tuple(
        label.decode() if isinstance(label, bytes) else str(label) for label in dataset[name].values
    )
