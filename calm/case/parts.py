"""Lookup of pieces and clamps by label, and copies of files with changed values."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np

from calm.errors import NoEquilibrium, UsageError, unknown
from calm.files import Clamp, MooringFile, Piece, read_mooring
from calm.files.mooring_file import legs_of
from calm.files.pieces import parts_of
from calm.files.yaml_document import Location
from calm.physics.line import Floats
from calm.solve import Solution
from calm.whole_file import read_text

TOP = "top"
"""Name that always refers to the free end of the line, whatever the label of its piece."""


def one_part(pieces: Sequence[Piece], text: str) -> Piece | Clamp:
    """Find the only part with a given label.

    Raises LookupError, with the existing labels, if no part or more than one part matches.
    """
    found = all_parts(pieces, text)
    if len(found) > 1:
        listed = _listed([part.label for part in found])
        raise LookupError(f"{len(found)} parts have the label `{text}`; select one: {listed}")
    return found[0]


def all_parts(pieces: Sequence[Piece], text: str) -> tuple[Piece | Clamp, ...]:
    """Find the part with a given label or, if there is none, all parts with this label and a
    number.

    Raises LookupError, with the nearest label, if no part matches.
    """
    parts = parts_of(pieces)
    for part in parts:
        if part.label == text:
            return (part,)
    if text == TOP:
        return (pieces[0],)
    numbered = re.compile(re.escape(text) + r" \d+")
    found = tuple(part for part in parts if numbered.fullmatch(part.label))
    if not found:
        labels = [TOP, *(part.label for part in parts)]
        raise LookupError(unknown(f"no part of the line has the label `{text}`", text, labels))
    return found


def _listed(labels: Sequence[str]) -> str:
    if len(labels) <= 6:
        return ", ".join(labels)
    return f"{', '.join(labels[:3])} … {labels[-1]}"


@contextmanager
def naming_the_piece(pieces: Sequence[Piece], *, towed: bool = False) -> Iterator[None]:
    """Context manager that adds the label of the affected piece to errors raised by the solver.

    `towed` is set for a tow, because the solver numbers the pieces of a tow from the lower end.
    """
    try:
        yield
    except NoEquilibrium as error:
        if error.piece is None:
            raise
        piece = pieces[len(pieces) - 1 - error.piece if towed else error.piece]
        raise error.naming(f"{piece.label} (piece {piece.index + 1})") from error


OtherEnvironment = str | Path | Mapping[str, Any]
"""Environment to use: a name in the file, the path of an environment file, or changes to the
default environment.
"""


@dataclass(frozen=True)
class Origin:
    """Input from which a mooring is read; the attributes are the arguments of `load`."""

    path: str | Path
    environment: str | Path | None
    catalogs: tuple[Path, ...]
    text: str | None

    def read(self) -> MooringFile:
        """Read the file and all files to which it refers (see `read_mooring`)."""
        return read_mooring(
            self.path, environment=self.environment, catalogs=self.catalogs, text=self.text
        )

    def changed(
        self,
        file: MooringFile,
        label: str | None,
        environment: OtherEnvironment | None,
        keys: Mapping[str, Any],
    ) -> Origin:
        """Return a copy of the origin with changed values, or with another environment.

        Parameters
        ----------
        label : piece or clamp whose keys are changed; None for keys of the file
        environment : name or path of another environment, or changed keys of the default
            environment; None for no change
        keys : names and values as in the file. None removes a key; a mapping changes only the keys
            that it contains

        Raises
        ------
        UsageError
            No piece and no clamp has the label.
        """
        from calm.files.editing import Draft

        draft = Draft(read_text(Path(self.path)) if self.text is None else self.text)
        place: Location = () if label is None else _place_of(file, label)
        own = environment if isinstance(environment, Mapping) else {}
        changes = [*((place, *each) for each in keys.items()), ((), "environment", own)]
        for at, name, value in changes:
            inner = value if isinstance(value, Mapping) and not at else {None: value}
            for key, each in inner.items():
                where = (*at, name) if key is None else (*at, name, key)
                draft = draft.put_at(where, _numbers_as_text(each))
        named = None if isinstance(environment, Mapping) else environment
        return replace(self, text=draft.text, environment=named or self.environment)


def _numbers_as_text(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _numbers_as_text(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_numbers_as_text(each) for each in value]
    if isinstance(value, bool):
        return str(value).lower()
    return str(value) if isinstance(value, Real) else value


def _place_of(file: MooringFile, label: str) -> Location:
    from calm.files.editing import LINE, clamps_of

    places = {part.label: part.place for part in parts_of(file.pieces)}
    numbered = re.compile(rf"{re.escape(label)} \d+")  # as the pieces of a `count` are labelled
    copies = [place for name, place in places.items() if numbered.fullmatch(name)]
    if len({(place.item, place.clamp) for place in copies}) == 1:
        places.setdefault(label, copies[0])
    if label not in places:
        raise UsageError(unknown(f"no piece or clamp is labelled `{label}`", label, places))
    place = places[label]
    if place.part >= 0 and not place.is_clamp:
        raise UsageError(f"`{label}` is a part of an assembly; change the assembly")
    return (*clamps_of(place.item), place.clamp) if place.is_clamp else (*LINE, place.item)


def below_the_seabed(file: MooringFile, solution: Solution, depth: float) -> Floats:
    """Return the distance (k + 1,) of each node below the seabed [m].

    The distance is NaN outside the depth grid. `depth` is the water depth [m] at the anchor of the
    leg. For a leg without an anchor, it is the water depth at the origin.
    """
    seabed, place = file.environment.seabed, solution.position
    assert seabed is not None
    anchor = legs_of(file)[0].bottom.anchor
    origin = (0.0, 0.0) if anchor is None else anchor.at
    below: Floats = -place[:, 2] - depth - seabed.deeper(place[:, :2] - np.array(origin))
    return below
