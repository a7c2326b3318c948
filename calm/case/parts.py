"""Pieces and clamped instruments by what a person calls them, and their names for the solver's."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

from calm.errors import NoEquilibrium, unknown
from calm.files import Clamp, Piece

if TYPE_CHECKING:
    from calm.case.mooring import Mooring
    from calm.case.tow import Tow
    from calm.files import MooringFile

TOP = "top"
"""The free end of the line, whatever its label."""


def parts_of(pieces: Sequence[Piece]) -> list[Piece | Clamp]:
    """Every piece of a line, each with its clamps after it."""
    parts: list[Piece | Clamp] = []
    for piece in pieces:
        parts += (piece, *piece.clamps)
    return parts


def clamps_in(pieces: Sequence[Piece]) -> list[Clamp]:
    """List the clamps of a line in the order of the file, which is that of the solver."""
    return [clamp for piece in pieces for clamp in piece.clamps]


def clamps_down(pieces: Sequence[Piece]) -> list[Clamp]:
    """List the clamps of a mooring's line from its top to its anchor, the order of its results."""
    return [clamp for piece in pieces for clamp in sorted(piece.clamps, key=lambda clamp: clamp.at)]


def cut_like(file: MooringFile, case: Mooring | Tow) -> MooringFile:
    """Return a file with the piece that is cut to fit at the length that it has in a case.

    NoEquilibrium: no length fits there.
    """
    pieces = tuple(
        piece
        if piece.fit_top_depth is piece.fit_body_depth is None
        else replace(
            piece,
            length=float(case.line.length[piece.index]),
            fit_top_depth=None,
            fit_body_depth=None,
        )
        for piece in file.pieces
    )
    return replace(file, pieces=pieces)


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
    """Adds the label of a piece to what the solver reports of it.

    Parameters
    ----------
    pieces : in the order of the file
    towed : whether the solver counts them from the other end
    """
    try:
        yield
    except NoEquilibrium as error:
        if error.piece is None:
            raise
        piece = pieces[len(pieces) - 1 - error.piece if towed else error.piece]
        raise error.naming(f"{piece.label} (piece {piece.index + 1})") from error
