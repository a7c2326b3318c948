"""Finding pieces and clamped instruments by what a person calls them."""

from __future__ import annotations

import re
from collections.abc import Sequence

from calm.files import Piece
from calm.files.explain import unknown

TOP = "top"
"""The free end of the line, whatever its label."""


def labels_of(pieces: Sequence[Piece]) -> list[str]:
    """Every label of a line, the clamps of a piece behind it."""
    return [label for piece in pieces for label in (piece.label, *_clamped(piece))]


def one_label(pieces: Sequence[Piece], text: str) -> str:
    """The label meant by a text.

    Raises
    ------
    LookupError
        No part, or more than one, is called so; its message says what is.
    """
    found = all_labels(pieces, text)
    if len(found) > 1:
        raise LookupError(f"{len(found)} parts are called `{text}`; name one: {_listed(found)}")
    return found[0]


def all_labels(pieces: Sequence[Piece], text: str) -> tuple[str, ...]:
    """The labels meant by a text: that label, or all that are it with a number.

    Raises
    ------
    LookupError
        No part is called so; the message offers the nearest that is.
    """
    labels = labels_of(pieces)
    if text in labels:
        return (text,)
    if text == TOP:
        return (pieces[0].label,)
    numbered = tuple(one for one in labels if re.fullmatch(re.escape(text) + r" \d+", one))
    if not numbered:
        raise LookupError(unknown(f"no part of the line is called `{text}`", text, [TOP, *labels]))
    return numbered


def _clamped(piece: Piece) -> list[str]:
    return [clamp.label for clamp in piece.clamps]


def _listed(labels: Sequence[str]) -> str:
    if len(labels) <= 6:
        return ", ".join(labels)
    return f"{', '.join(labels[:3])} … {labels[-1]}"
