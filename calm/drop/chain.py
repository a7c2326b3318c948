"""A line as a chain: straight bars between nodes, and the loads that they carry.

A cable or chain is cut into bars, a rigid piece is one bar, and the pieces that are rigid with the
free end are one together. The force of a load goes to the two nodes of its bar by the lever: in
equilibrium a bar then lies along the mean of the forces at its ends, as everywhere in CALM.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calm.drop.elements import (
    Afloat,
    Element,
    Elements,
    afloat_of,
    clamp_element,
    piece_element,
)
from calm.physics.line import Floats, Integers, Line
from calm.physics.stretch import ElongationCurve
from calm.physics.track import head_count

LEAST = 0.12
"""Of all bars: those of a cable or chain that is not short, since it may be the one that turns on
the seabed."""
NOT_SHORT = 0.02
"""Share of all cables and chains from which on one is not short."""


@dataclass(frozen=True)
class Chain:
    """n bars between n + 1 nodes, the free end first.

    Attributes
    ----------
    line : what it is the chain of
    length : (n,) of the bars, unstretched [m]
    piece : (n,) each bar's own; of the rigid head its last
    compliance : (n,) 1/EA [1/N]
    elongation : the bars of every cable that stretches by a curve, and the curve
    elements : the loads
    bars : (p, 2) first bar of every piece, and the one behind its last; equal without length
    span : (p, 2) where a piece begins on its first bar and ends on its last, 0 to 1
    clamp_bar, clamp_place : (m,) where the clamps sit
    afloat : the first float at the surface, None where its hull is not known
    """

    line: Line
    length: Floats
    piece: Integers
    compliance: Floats
    elongation: tuple[tuple[Integers, ElongationCurve], ...]
    elements: Elements
    bars: Integers
    span: Floats
    clamp_bar: Integers
    clamp_place: Floats
    afloat: Afloat | None


def chain_of(line: Line, count: int) -> Chain:
    """The chain of a line whose cables and chains are cut into some `count` bars.

    Parameters
    ----------
    line : above an anchor, free end first

    Raises
    ------
    ValueError
        A line without any length.
    """
    length, piece, bars, span = _bars(line, count)
    if not len(length):
        raise ValueError("a line needs a length")
    clamp_bar, clamp_place = _along(
        line.clamp_piece, line.clamp_at / np.maximum(line.length, 1e-300)[line.clamp_piece],
        bars, span,
    )  # fmt: skip
    on_clamps = zip(clamp_bar.tolist(), clamp_place.tolist(), strict=True)
    elements = Elements.of(
        [
            *_piece_elements(line, bars, span),
            *(clamp_element(line, clamp, *place) for clamp, place in enumerate(on_clamps)),
        ]
    )
    return Chain(
        line=line,
        length=length,
        piece=piece,
        compliance=line.compliance[piece] * line.flexible[piece],
        elongation=tuple(
            (np.flatnonzero(piece == i), curve)
            for i, curve in enumerate(line.elongation)
            if curve is not None
        ),
        elements=elements,
        bars=bars,
        span=span,
        clamp_bar=clamp_bar,
        clamp_place=clamp_place,
        afloat=afloat_of(line, elements),
    )


def _bars(line: Line, count: int) -> tuple[Floats, Integers, Integers, Floats]:
    """Length and piece of every bar; bars and span of every piece."""
    pieces, head = len(line.length), head_count(line)
    cable = float(line.length[line.flexible].sum())
    share = line.length / max(cable, 1e-300)
    least = np.where(share > NOT_SHORT, count * LEAST, 1.0)
    cuts = np.where(line.flexible, np.ceil(np.maximum(share * count, least)), 1.0)
    cuts[line.length == 0.0] = 0.0
    bars, span = np.zeros((pieces, 2), dtype=np.int64), np.zeros((pieces, 2))
    length: list[float] = []
    owner: list[int] = []
    rigid = float(line.length[:head].sum())
    if rigid > 0.0:
        length, owner = [rigid], [head - 1]
        ends = np.cumsum(line.length[:head]) / rigid
        span[:head] = np.column_stack([ends - line.length[:head] / rigid, ends])
        bars[:head] = 0, 1
    for piece in range(head if rigid > 0.0 else 0, pieces):
        parts = int(cuts[piece])
        bars[piece] = len(length), len(length) + parts
        span[piece] = 0.0, 1.0
        length += [float(line.length[piece]) / max(parts, 1)] * parts
        owner += [piece] * parts
    for piece in np.flatnonzero(bars[:, 0] == bars[:, 1]).tolist():
        # without length it is at the upper end of the bar below it, or the lower end of the last
        below = bars[piece, 0] < len(length)
        span[piece] = (0.0, 0.0) if below else (1.0, 1.0)
        bars[piece] -= 0 if below else 1
    return np.array(length), np.array(owner, dtype=np.int64), bars, span


def _along(piece: Integers, share: Floats, bars: Integers, span: Floats) -> tuple[Integers, Floats]:
    """Bar, and place on it, of points at a share of the way down their pieces."""
    first, end = bars[piece].T
    begin, stop = span[piece].T
    way = begin + share * (stop - begin)
    whole = way * np.maximum(end - first, 1)
    bar = np.minimum(whole.astype(np.int64), np.maximum(end - first - 1, 0))
    return first + bar, np.clip(whole - bar, 0.0, 1.0)


def _piece_elements(line: Line, bars: Integers, span: Floats) -> list[Element]:
    rows = []
    for piece, (first, end) in enumerate(bars.tolist()):
        begin, stop = span[piece].tolist()
        middle = 0.5 * (begin + stop)
        parts = max(end - first, 1)
        rows += [piece_element(line, piece, first + i, middle, 1.0 / parts) for i in range(parts)]
    return rows
