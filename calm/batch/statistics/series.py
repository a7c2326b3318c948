"""Columns of a batch result. Only one column is in memory at a time."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from pathlib import Path
from tempfile import TemporaryFile
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from calm.batch.finished import labels_of, readable, statuses_of
from calm.case.result_tables import MOORED_ENDS
from calm.errors import UsageError
from calm.files import MooringFile

if TYPE_CHECKING:
    from xarray import Dataset

Column = NDArray[np.floating[Any]]
Times = NDArray[np.datetime64]

_COLUMNS = (
    "depth_top", "x_top", "y_top", "tension_top", "tension_bottom", "tilt", "knockdown",
    "clamp_depth", "clamp_tension", "clamp_tilt", "clamp_knockdown",
    "anchor_vertical", "anchor_horizontal", "used_buoyancy",
)  # fmt: skip
_ROWS = 32768  # profiles turned at a time
_FIGURE = np.dtype(np.float32)


class PartNumber(NamedTuple):
    """Column number of a part in a result.

    Attributes
    ----------
    number : number among the components or among the clamps, counted from the top
    clamped : whether the part is a clamp
    """

    number: int
    clamped: bool = False


class LegColumns(NamedTuple):
    """Columns of a batch result that belong to one leg of a net.

    Attributes
    ----------
    components, clamps : ranges of columns
    number : number of the leg, counted from 0
    """

    components: slice
    clamps: slice
    number: int

    @classmethod
    def of_file(cls, file: MooringFile) -> list[LegColumns]:
        """Return the column positions for each leg of a file."""
        found, clamped = [], 0
        for number, leg in enumerate(file.legs):
            own = sum(len(piece.clamps) for piece in file.pieces[leg.first : leg.end])
            found.append(cls(slice(leg.first, leg.end), slice(clamped, clamped + own), number))
            clamped += own
        return found


class ResultColumns:
    """Columns of a batch result over n profiles, with NaN for unsolved profiles.

    A temporary file, deleted at the end of the `with` block, holds the result with 4 bytes per
    number.

    Parameters
    ----------
    dataset : the result, opened without loading it
    folder : folder of the temporary file; by default the temporary folder of the system
    source : file of the result, for messages

    Attributes
    ----------
    time : (n,) times of the profiles
    statuses : number of profiles by status

    Raises
    ------
    UsageError
        The result cannot be read, or the disk space is too small.
    """

    def __init__(
        self,
        dataset: Dataset,
        folder: Path | None = None,
        source: Path = Path("the result"),
    ) -> None:
        self.dataset = dataset
        self._source = source
        self.time: Times = dataset["time"].values
        self.statuses = statuses_of(dataset)
        self.component_label = labels_of(dataset, "component_label")
        self.clamp_label = labels_of(dataset, "clamp_label")
        self._columns: dict[str, range] = {}
        try:
            self._turned = TemporaryFile(dir=folder, prefix=".calm-", suffix=".part")  # noqa: SIM115
            self._turn()
        except OSError as error:
            place = folder or "the folder for temporary files"
            raise UsageError(f"cannot gather the statistics in {place}: {error.strerror}") from None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self._turned.close()

    def __len__(self) -> int:
        return len(self.time)

    def of_leg(self, leg: LegColumns) -> ResultColumns:
        """Return the columns of one leg of a net. They share the temporary file of the whole
        result.
        """
        view, ends = copy(self), slice(leg.number, leg.number + 1)
        of_ends = {one.name for one in MOORED_ENDS}
        view._columns = {
            name: columns[
                leg.clamps if name.startswith("clamp_") else ends if name in of_ends
                else leg.components
            ]
            for name, columns in self._columns.items()
        }  # fmt: skip
        return view

    @property
    def parts(self) -> tuple[PartNumber, ...]:
        """Column numbers of all components, and then of all clamps."""
        components, clamps = len(self.component_label), len(self.clamp_label)
        return (
            *map(PartNumber, range(components)),
            *(PartNumber(each, True) for each in range(clamps)),
        )

    def label(self, part: PartNumber) -> str:
        """Return the label of a part."""
        return (self.clamp_label if part.clamped else self.component_label)[part.number]

    def ends(self, name: str) -> Column:
        """Return the values (n,) of a variable of the whole line, such as `anchor_vertical`."""
        return self.column(name, 0)

    def column(self, name: str, index: int) -> Column:
        """Return the values (n,) of a variable, such as `tilt` or `clamp_tilt`, for one component
        or clamp.
        """
        return self._read(self._columns[name][index])

    def at(self, name: str, time: int) -> Column:
        """Return the values of a variable for all components or clamps in one profile. The array is
        empty if the result has no such variable.
        """
        values = []
        for column in self._columns.get(name, ()):
            self._turned.seek((column * len(self) + time) * _FIGURE.itemsize)
            values.append(np.frombuffer(self._turned.read(_FIGURE.itemsize), _FIGURE)[0])
        return np.array(values, _FIGURE)

    def depth(self, part: PartNumber) -> Column:
        """Return the depth (n,) of a clamp, or of a component's upper end [m]."""
        return self.column("clamp_depth" if part.clamped else "depth_top", part.number)

    def of_part(self, name: str, part: PartNumber) -> Column:
        """Return the values (n,) of `tilt` [degrees] or `knockdown` [m] for a component or
        clamp.
        """
        return self.column(f"clamp_{name}" if part.clamped else name, part.number)

    def greatest_tension(self, parts: Sequence[PartNumber]) -> Column:
        """Return the maximum tension (n,) over several parts [N].

        For a component, both ends are considered.
        """
        return self._gathered(np.maximum, parts)

    def least_tension(self, part: PartNumber) -> Column:
        """Return the smaller of the tensions (n,) at the ends of a component, or the tension at a
        clamp [N].
        """
        return self._gathered(np.minimum, [part])

    def _gathered(self, choose: np.ufunc, parts: Sequence[PartNumber]) -> Column:
        first, *others = (column for part in parts for column in self._tensions(part))
        chosen, tension = self._read(first), None
        for other in others:
            tension = self._read(other, tension)
            choose(chosen, tension, out=chosen)
        return chosen

    def _tensions(self, part: PartNumber) -> tuple[int, ...]:
        names = ("clamp_tension",) if part.clamped else ("tension_top", "tension_bottom")
        return tuple(self._columns[name][part.number] for name in names)

    def _read(self, column: int, into: Column | None = None) -> Column:
        values = np.empty(len(self), _FIGURE) if into is None else into
        self._turned.seek(column * values.nbytes)
        self._turned.readinto(values.data)
        return values

    def _turn(self) -> None:
        first = 0
        for name in _COLUMNS:
            if name not in self.dataset:
                continue
            variable = self.dataset[name]
            columns = range(first, first + (variable.shape[1] if variable.ndim > 1 else 1))
            self._columns[name] = columns
            for begin in range(0, len(self), _ROWS):
                with readable(self._source):
                    block = np.asarray(variable[begin : begin + _ROWS], _FIGURE)
                by_column = np.ascontiguousarray(block.T).reshape(len(columns), -1)
                for column, values in zip(columns, by_column, strict=True):
                    self._turned.seek((column * len(self) + begin) * _FIGURE.itemsize)
                    self._turned.write(values.data)
            first = columns.stop
        self._turned.flush()
