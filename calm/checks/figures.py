"""Whether the figures of a design's components can be true, as those of a catalogue are judged."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from calm.checks.catalogue import IMPOSSIBLE
from calm.checks.finding import State, Verdict, rule, verdict_on

if TYPE_CHECKING:
    from calm.checks.handling import Handling
    from calm.files import Clamp, Piece


@rule("figures", once=True)
def figures(handling: Handling) -> Iterator[Verdict]:
    """What no component of its size and material can have, such as a load in N that was in kN.

    What hangs several times on the line is named once.
    """
    named: set[tuple[str, str]] = set()
    for piece in handling.mooring.file.pieces:
        parts: tuple[Piece | Clamp, ...] = (piece, *piece.clamps)
        for part in parts:
            for impossible in IMPOSSIBLE:
                said = impossible(part.component)
                if said is not None and (part.use, said) not in named:
                    named.add((part.use, said))
                    remedy = "Look at its figures, and at their units."
                    yield verdict_on(part, State.WARN, f"{part.label} {said}.", remedy)
