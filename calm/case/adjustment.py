"""What of a mooring may be changed to size it: ``LABEL.buoyancy``, ``.length`` or ``.count``.

A change is made in the models of the file, as a person would make it on the line, so that
everything else follows as ever.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

from calm.files import Cable, Clamp, Component, MooringFile, Piece
from calm.files.definition import STANDARD_GRAVITY
from calm.files.labels import numbered
from calm.units import DIMENSIONS

MOST_BUOYANCY = 100.0
"""How many times its buoyancy a float is given at most, unless a range says otherwise."""
MOST_LENGTH = 2.0
"""How many water depths long a piece is made at most, unless a range says otherwise."""
LEAST_LENGTH = 0.01
"""The shortest a cable or chain is made [m]."""
MOST_COUNT = 1000
"""How many of a component are put in line at most, unless a range says otherwise."""


@dataclass(frozen=True)
class Adjustment(ABC):
    """One number of a mooring file that may be changed.

    Attributes
    ----------
    text : as it was written, e.g. ``top float.buoyancy``
    file : the mooring as it is
    labels : of the parts that change together
    """

    text: str
    file: MooringFile
    labels: tuple[str, ...]

    whole: ClassVar[bool] = False
    note: ClassVar[str] = ""

    @property
    def dimension(self) -> str:
        """Of the number, a key of `calm.units.DIMENSIONS`."""
        return "length"

    @property
    def unit(self) -> str:
        """SI unit of the number."""
        return DIMENSIONS[self.dimension].unit

    @property
    @abstractmethod
    def now(self) -> float:
        """The number as it is."""

    @property
    @abstractmethod
    def range(self) -> tuple[float, float]:
        """Between what it is changed when nothing else is said."""

    @abstractmethod
    def to(self, value: float) -> MooringFile:
        """The mooring with another number."""


class Buoyancy(Adjustment):
    """Net force in water of a rigid piece or clamped instrument [N], or of a cable [N/m]."""

    note = (
        "Only the net force in water changes; size, drag and mass stay as they are. What really "
        "has this buoyancy has another drag: put it in the file and run it."
    )

    @property
    def dimension(self) -> str:
        return "force per length" if isinstance(self._component, Cable) else "force"

    @property
    def now(self) -> float:
        return self._component.net_buoyancy

    @property
    def range(self) -> tuple[float, float]:
        most = MOST_BUOYANCY * self.now
        mass = self._component.mass
        if most < 0.0 and mass is not None:
            most = max(most, -mass * STANDARD_GRAVITY)
        return min(most, 0.0), max(most, 0.0)

    def to(self, value: float) -> MooringFile:
        pieces = tuple(
            replace(
                piece,
                component=self._lifted(piece.label, piece.component, value),
                clamps=tuple(
                    replace(clamp, component=self._lifted(clamp.label, clamp.component, value))
                    for clamp in piece.clamps
                ),
            )
            for piece in self.file.pieces
        )
        return replace(self.file, pieces=pieces)

    @property
    def _component(self) -> Component:
        return next(components_called(self.file, self.labels))

    def _lifted(self, label: str, component: Component, value: float) -> Component:
        if label not in self.labels:
            return component
        # what else the net force could follow from goes, as in an override on the line
        other = "weight" if isinstance(component, Cable) else "volume"
        return component.model_copy(update={"buoyancy": value, other: None})


class Length(Adjustment):
    """Unstretched length of a cable or chain [m]; its clamps stay where they are from its top."""

    @property
    def now(self) -> float:
        length = pieces_called(self.file, self.labels)[0].length
        assert length is not None
        return length

    @property
    def range(self) -> tuple[float, float]:
        pieces = pieces_called(self.file, self.labels)
        lowest = max((clamp.at for piece in pieces for clamp in piece.clamps), default=0.0)
        depth = self.file.environment.depth
        assert depth is not None  # a mooring stands on the seabed
        return max(lowest, LEAST_LENGTH), MOST_LENGTH * depth

    def to(self, value: float) -> MooringFile:
        pieces = tuple(
            replace(piece, length=value) if piece.label in self.labels else piece
            for piece in self.file.pieces
        )
        return replace(self.file, pieces=pieces)


class Count(Adjustment):
    """How many times a component stands in line, with its own clamps each time."""

    whole = True

    @property
    def dimension(self) -> str:
        return "number"

    @property
    def now(self) -> float:
        return float(len(self._group))

    @property
    def range(self) -> tuple[float, float]:
        return 1.0, float(MOST_COUNT)

    def to(self, value: float) -> MooringFile:
        pieces, group = self.file.pieces, self._group
        one = group[0]
        if len(group) > 1:  # labels of several are numbered
            clamps = tuple(replace(c, label=_unnumbered(c.label)) for c in one.clamps)
            one = replace(one, label=_unnumbered(one.label), clamps=clamps)
        first, last = group[0].index, group[-1].index
        line = (*pieces[:first], *(one,) * int(value), *pieces[last + 1 :])
        return replace(self.file, pieces=numbered(line))

    @property
    def _group(self) -> tuple[Piece, ...]:
        return pieces_called(self.file, self.labels)


def pieces_called(file: MooringFile, labels: tuple[str, ...]) -> tuple[Piece, ...]:
    """The pieces of these labels, down the line."""
    return tuple(piece for piece in file.pieces if piece.label in labels)


def components_called(file: MooringFile, labels: tuple[str, ...]) -> Iterator[Component]:
    """The components of the pieces and clamps of these labels."""
    for piece in file.pieces:
        parts: tuple[Piece | Clamp, ...] = (piece, *piece.clamps)
        for part in parts:
            if part.label in labels:
                yield part.component


def _unnumbered(label: str) -> str:
    return label.rpartition(" ")[0]
