"""Rule `joints`: joints between metal pieces that lack connecting hardware."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from calm.checks.assessment import Handling
from calm.checks.finding import State, Verdict, rule, verdict_on
from calm.files import Cable, Piece
from calm.files.pieces import STAND_IN
from calm.physics.materials import materials_in

MOST_NAMED = 5
"""Maximum number of joints listed in the message."""


@rule("joints", once=True)
def joints(handling: Handling) -> Iterator[Verdict]:
    """Yield one warning for all joints without a shackle, link or swivel.

    These joints need no hardware:

    - joints of ropes, and of wires with a specified `termination`;
    - joints of two floats, or of two equal pieces other than cables and chains;
    - joints within one row of the file, such as an assembly.
    """
    pieces = handling.leg.file.pieces
    if not any(piece.component.role == "connector" for piece in pieces):
        return
    bare = bare_joints(pieces)
    if not bare:
        return
    named = [f"{one.label} to {other.label}" for one, other in bare[:MOST_NAMED]]
    if len(bare) > MOST_NAMED:
        named.append(f"{len(bare) - MOST_NAMED} more")
    what = "This joint has" if len(bare) == 1 else f"{len(bare)} joints have"
    message = f"{what} no shackle, link or swivel: {'; '.join(named)}."
    remedy = "Add the hardware, or set the `termination` of the wire."
    yield verdict_on(bare[0][0], State.WARN, message, remedy)


def bare_joints(pieces: Sequence[Piece]) -> list[tuple[Piece, Piece]]:
    """Return the pairs of adjacent pieces that lack hardware between them, from the top down."""
    return [pair for pair in pairwise(pieces) if _needs_hardware(*pair)]


def _needs_hardware(one: Piece, other: Piece) -> bool:
    roles = {one.component.role, other.component.role}
    if one.place.row == other.place.row or "connector" in roles or roles == {"float"}:
        return False
    if STAND_IN in (one.use, other.use) or (one.use == other.use and roles != {"line"}):
        return False
    return _only_joins_by_hardware(one) and _only_joins_by_hardware(other)


def _only_joins_by_hardware(piece: Piece) -> bool:
    if not isinstance(piece.component, Cable):
        return True
    metal = any(one.family == "metal" for one in materials_in(piece.component.material))
    return metal and piece.equipment.termination is None
