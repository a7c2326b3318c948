"""Names for what the solver knows by number only."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from calm.errors import NoEquilibrium
from calm.files import Piece


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
