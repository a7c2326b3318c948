"""What may be changed to size a mooring: ``LABEL.buoyancy``, ``.length`` or ``.count``.

A change is made in the models of the file, as if it had been written there; everything else follows
from them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

from calm.files import Cable, Clamp, Component, MooringFile, Piece, Place
from calm.files.definition import STANDARD_GRAVITY
from calm.files.labels import numbered, placed
from calm.units import DIMENSIONS

MOST_BUOYANCY = 100.0
"""Largest factor on the buoyancy of a float, unless a range is given."""
MOST_LENGTH = 2.0
"""Greatest length of a piece in water depths, unless a range is given."""
LEAST_LENGTH = 0.01
"""Least length of a cable or chain [m]."""
MOST_COUNT = 1000
"""Greatest count of a component, unless a range is given."""


@dataclass(frozen=True)
class Adjustment(ABC):
    """One number of a mooring file that may be changed.

    Attributes
    ----------
    text : as it was written, e.g. ``top float.buoyancy``
    file : the mooring before the change
    parts : those that change together, before the change
    """

    text: str
    file: MooringFile
    parts: tuple[Piece | Clamp, ...]

    whole: ClassVar[bool] = False
    note: ClassVar[str] = ""

    @property
    def dimension(self) -> str:
        """Dimension of the number, a key of `calm.units.DIMENSIONS`."""
        return "length"

    @property
    def unit(self) -> str:
        """SI unit of the number."""
        return DIMENSIONS[self.dimension].unit

    @property
    @abstractmethod
    def now(self) -> float:
        """The number before the change."""

    @property
    @abstractmethod
    def range(self) -> tuple[float, float]:
        """Its range where none is given: least and greatest value."""

    @abstractmethod
    def to(self, value: float) -> MooringFile:
        """The mooring with another number."""

    @property
    def labels(self) -> tuple[str, ...]:
        """Labels of the parts that change."""
        return tuple(part.label for part in self.parts)

    @cached_property
    def _places(self) -> frozenset[Place]:
        return frozenset(part.place for part in self.parts)


class Buoyancy(Adjustment):
    """Net force in water of a rigid piece or clamped instrument [N], or of a cable [N/m]."""

    note = (
        "Only the net force in water changes; size, drag and mass stay as they are. A real part "
        "with this buoyancy has another drag: put it in the file and run it."
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
                component=self._lifted(piece, value),
                clamps=tuple(
                    replace(clamp, component=self._lifted(clamp, value)) for clamp in piece.clamps
                ),
            )
            for piece in self.file.pieces
        )
        return replace(self.file, pieces=pieces)

    @property
    def _component(self) -> Component:
        return self.parts[0].component

    def _lifted(self, part: Piece | Clamp, value: float) -> Component:
        component = part.component
        if part.place not in self._places:
            return component
        # what else the net force could follow from goes, as in an override on the line
        other = "weight" if isinstance(component, Cable) else "volume"
        return component.model_copy(update={"buoyancy": value, other: None})


class Length(Adjustment):
    """Unstretched length of a cable or chain [m]; its clamps stay where they are from its top."""

    @property
    def now(self) -> float:
        first = self.parts[0]
        assert isinstance(first, Piece) and first.length is not None
        return first.length

    @property
    def range(self) -> tuple[float, float]:
        clamps = [clamp for part in self.parts if isinstance(part, Piece) for clamp in part.clamps]
        lowest = max((clamp.at for clamp in clamps), default=0.0)
        depth = self.file.environment.depth
        assert depth is not None  # a mooring stands on the seabed
        return max(lowest, LEAST_LENGTH), MOST_LENGTH * depth

    def to(self, value: float) -> MooringFile:
        pieces = tuple(
            replace(piece, length=value) if piece.place in self._places else piece
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
        return float(len(self.parts))

    @property
    def range(self) -> tuple[float, float]:
        return 1.0, float(MOST_COUNT)

    def to(self, value: float) -> MooringFile:
        pieces, group = self.file.pieces, self.parts
        one, last = group[0], group[-1]
        assert isinstance(one, Piece) and isinstance(last, Piece)
        if len(group) > 1:  # labels of several are numbered
            clamps = tuple(replace(c, label=_unnumbered(c.label)) for c in one.clamps)
            one = replace(one, label=_unnumbered(one.label), clamps=clamps)
        repeats = (placed(one, replace(one.place, repeat=number)) for number in range(int(value)))
        line = (*pieces[: one.index], *repeats, *pieces[last.index + 1 :])
        return replace(self.file, pieces=numbered(line))


def _unnumbered(label: str) -> str:
    return label.rpartition(" ")[0]
