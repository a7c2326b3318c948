"""Places and labels of pieces and clamps: each has its own in the line."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import replace

from calm.files.mooring import Piece, Place


def placed(piece: Piece, place: Place) -> Piece:
    """The piece, with its clamps and the serial numbers there, at another place of the line."""
    clamps = tuple(
        replace(
            clamp,
            place=replace(place, clamp=number),
            equipment=clamp.equipment.of(place.repeat),
        )
        for number, clamp in enumerate(piece.clamps)
    )
    return replace(piece, place=place, clamps=clamps, equipment=piece.equipment.of(place.repeat))


def numbered(pieces: Iterable[Piece]) -> tuple[Piece, ...]:
    """The pieces with their index, and labels that occur more than once numbered down the line."""
    pieces = tuple(pieces)
    labels = [[piece.label, *(clamp.label for clamp in piece.clamps)] for piece in pieces]
    total = Counter(label for group in labels for label in group)
    seen: Counter[str] = Counter()

    def numbered_label(text: str) -> str:
        if total[text] == 1:
            return text
        seen[text] += 1
        while f"{text} {seen[text]}" in total:
            seen[text] += 1
        return f"{text} {seen[text]}"

    return tuple(
        replace(
            piece,
            index=index,
            label=numbered_label(piece.label),
            clamps=tuple(
                replace(clamp, label=numbered_label(clamp.label)) for clamp in piece.clamps
            ),
        )
        for index, piece in enumerate(pieces)
    )
