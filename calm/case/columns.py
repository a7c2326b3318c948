"""Tables kept by column: one array per figure, records and data frames on demand."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from functools import cached_property
from math import isfinite
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from calm.physics.line import Floats, Integers

if TYPE_CHECKING:
    import pandas


class Columns:
    """A table whose dataclass fields are its columns, all of one length."""

    def _names(self) -> list[str]:
        return [field.name for field in fields(self)]  # type: ignore[arg-type]

    def __len__(self) -> int:
        return len(getattr(self, self._names()[0]))

    def __getitem__(self, row: int) -> SimpleNamespace:
        """One row as a record with the columns' names."""
        return SimpleNamespace(**{name: _plain(getattr(self, name)[row]) for name in self._names()})

    def __iter__(self) -> Iterator[SimpleNamespace]:
        return iter(self._records)

    def __getstate__(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in self._names()}

    @cached_property
    def _records(self) -> tuple[SimpleNamespace, ...]:
        """The rows, which every rule of a design check goes through again."""
        names = self._names()
        columns = [getattr(self, name) for name in names]
        # whole columns become plain numbers faster than their numbers one by one
        plain = [column if isinstance(column, list) else column.tolist() for column in columns]
        rows = zip(*plain, strict=True)
        return tuple(SimpleNamespace(**dict(zip(names, row, strict=True))) for row in rows)

    def with_row(self, **row: Any) -> Self:
        """The same table with one more row, a value for every column."""
        columns = {name: getattr(self, name) for name in self._names()}
        longer = {
            name: [*column, row[name]] if isinstance(column, list) else np.append(column, row[name])
            for name, column in columns.items()
        }
        return type(self)(**longer)

    def to_dicts(self) -> list[dict[str, Any]]:
        """The rows as dictionaries of plain numbers and text; None where unknown."""
        return [{name: _known(value) for name, value in vars(record).items()} for record in self]

    def to_dataframe(self) -> pandas.DataFrame:
        """The table as a pandas data frame; needs pandas, which CALM does not."""
        import pandas

        return pandas.DataFrame({name: getattr(self, name) for name in self._names()})


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _known(value: Any) -> Any:
    return None if isinstance(value, float) and not isfinite(value) else value


@dataclass(frozen=True)
class Components(Columns):
    """The n pieces of the line in file order; NaN where a figure is unknown.

    Those of a mooring from the free end down, the anchor last; those of a tow from the ship.

    Attributes
    ----------
    index, use, label, kind, role : (n,) which piece, of what component
    length, cut_length : (n,) stretched and unstretched [m]
    depth_top, depth_bottom : (n,) of the first-listed and the other end [m], + down
    x_top, y_top, x_bottom, y_bottom : (n,) east and north of the anchor or the tow point [m]
    tension_top, tension_bottom, tension : (n,) at the ends and the greatest in the piece [N]
    least_tension : (n,) of what does not lie on the seabed [N]; NaN where all of a piece does
    tilt : (n,) of the chord from the lower to the upper end, from the vertical [degrees]
    knockdown : (n,) depth_top less the same in still water [m]; NaN in a tow
    safety_factor : (n,) breaking load / greatest tension
    utilisation : (n,) greatest tension / working load
    reynolds : (n,) greatest Reynolds number of speed and diameter
    """

    index: Integers
    use: list[str]
    label: list[str]
    kind: list[str]
    role: list[str]
    length: Floats
    cut_length: Floats
    depth_top: Floats
    depth_bottom: Floats
    x_top: Floats
    y_top: Floats
    x_bottom: Floats
    y_bottom: Floats
    tension_top: Floats
    tension_bottom: Floats
    tension: Floats
    least_tension: Floats
    tilt: Floats
    knockdown: Floats
    safety_factor: Floats
    utilisation: Floats
    reynolds: Floats


@dataclass(frozen=True)
class Clamps(Columns):
    """The m instruments clamped on the line, in file order.

    Attributes
    ----------
    index : (m,) of the piece each sits on
    use, label : (m,)
    depth, x, y, knockdown : (m,) [m]
    tension : (m,) the greater of those above and below [N]
    tilt : (m,) of the piece's axis there [degrees]
    """

    index: Integers
    use: list[str]
    label: list[str]
    depth: Floats
    x: Floats
    y: Floats
    tension: Floats
    tilt: Floats
    knockdown: Floats


@dataclass(frozen=True)
class Shape:
    """The line node by node, free end first; a clamp's point twice (above, below).

    Attributes
    ----------
    depth, x, y : (k,) [m]
    tension : (k,) [N]
    tilt : (k,) of the segment that ends there [degrees]
    """

    depth: Floats
    x: Floats
    y: Floats
    tension: Floats
    tilt: Floats
