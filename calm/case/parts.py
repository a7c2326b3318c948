"""Pieces and clamps by what a person calls them, and a file with some of their values changed."""

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
"""The free end of the line, whatever its label."""


def one_part(pieces: Sequence[Piece], text: str) -> Piece | Clamp:
    """The part meant by a text.

    LookupError: no part, or more than one, is called so; the message says what the parts are
    called.
    """
    found = all_parts(pieces, text)
    if len(found) > 1:
        listed = _listed([part.label for part in found])
        raise LookupError(f"{len(found)} parts are called `{text}`; name one: {listed}")
    return found[0]


def all_parts(pieces: Sequence[Piece], text: str) -> tuple[Piece | Clamp, ...]:
    """The parts meant by a text: the part of that label, or all whose label is that with a number.

    LookupError: no part is called so; the message offers the nearest label.
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
        raise LookupError(unknown(f"no part of the line is called `{text}`", text, labels))
    return found


def _listed(labels: Sequence[str]) -> str:
    if len(labels) <= 6:
        return ", ".join(labels)
    return f"{', '.join(labels[:3])} … {labels[-1]}"


@contextmanager
def naming_the_piece(pieces: Sequence[Piece], *, towed: bool = False) -> Iterator[None]:
    """Adds the label of a piece to what the solver reports of it, which in a tow counts the pieces
    from the other end.
    """
    try:
        yield
    except NoEquilibrium as error:
        if error.piece is None:
            raise
        piece = pieces[len(pieces) - 1 - error.piece if towed else error.piece]
        raise error.naming(f"{piece.label} (piece {piece.index + 1})") from error


OtherEnvironment = str | Path | Mapping[str, Any]
"""The name of one in the file, an environment file, or keys to change in the file's own."""


@dataclass(frozen=True)
class Origin:
    """Tell what a mooring was read from; the names are those of `load`."""

    path: str | Path
    environment: str | Path | None
    catalogs: tuple[Path, ...]
    text: str | None

    def read(self) -> MooringFile:
        """Return the file with all it refers to, as `read_mooring` does."""
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
        """Return the same with values put into the text, or in another environment.

        Parameters
        ----------
        file : as it was read
        label : of the piece or clamp that has the keys; None where they are those of the file
        environment : None for its own; keys are those of its own
        keys : names and values as the file writes them; None takes a key out; where the file has a
            mapping under a name, its keys are changed one by one

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
                draft = draft.put_at(where, _written(each))
        named = None if isinstance(environment, Mapping) else environment
        return replace(self, text=draft.text, environment=named or self.environment)


def _written(value: Any) -> Any:
    """A value as the text of a file has it: numbers within lists and mappings are texts, too."""
    if isinstance(value, Mapping):
        return {key: _written(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_written(each) for each in value]
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
    """Return how far below the seabed of its file every node of a line is (k+1,) [m]; NaN off its
    grid.

    `depth`: of the water at the origin, or of a leg at its anchor [m].
    """
    seabed, place = file.environment.seabed, solution.position
    assert seabed is not None
    anchor = legs_of(file)[0].bottom.anchor
    origin = (0.0, 0.0) if anchor is None else anchor.at
    below: Floats = -place[:, 2] - depth - seabed.deeper(place[:, :2] - np.array(origin))
    return below
