"""A line as a chain of straight bars between nodes, and the loads on the bars.

A cable or chain is divided into bars. A rigid piece is one bar. At the free end, the first buoyant
piece and the rigid pieces above it share one bar. A bar carries loads: rigid pieces, clamps, or a
part of a cable or chain. The force of a load is distributed to the two nodes of its bar by the
lever rule.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from calm.physics.hull import Floating
from calm.physics.line import Booleans, Floats, Integers, Line
from calm.physics.reynolds import DragCurve
from calm.physics.track import head_count

MIN_BAR_SHARE = 0.12
"""Smallest fraction of all bars that a cable or chain gets, unless it is short. Enough bars are
needed because any cable or chain may come to lie on the seabed.
"""
SHORT_SHARE = 0.02
"""A cable or chain is short if its share of the total length of cables and chains is at most this
fraction.
"""


@dataclass(frozen=True)
class Elements:
    """The k loads on the bars of a chain, sorted by bar; every bar has at least one load.

    All arrays are (k,) except `push`.

    Attributes
    ----------
    bar, piece : indices of the bar and the piece of each load; the piece of a clamp is -1
    place : position on the bar, from 0 at its upper node to 1 at its lower node
    buoyancy, volume : net buoyancy [N] and displaced volume [m³] in reference water
    normal_drag, tangential_drag : total Kn and Kt [N/(m/s)²]
    directional : whether the drag depends on the direction of the flow; if not, the drag is Kn|V|V
    flexible : whether the load belongs to a cable or chain
    thinning : exponent of 1 + strain in the drag of a cable or chain, as in `Line`
    lift : hydrodynamic lift at 1 m/s, positive up [N/(m/s)²]
    push : (3, k) force of the wind [N]
    height : length of a rigid load [m]; 0 for other loads
    out : whether the load belongs to the pieces above the uppermost float
    curve : drag curve of each smooth sphere or cylinder; None for other loads
    """

    bar: Integers
    place: Floats
    piece: Integers
    buoyancy: Floats
    volume: Floats
    normal_drag: Floats
    tangential_drag: Floats
    directional: Booleans
    flexible: Booleans
    thinning: Floats
    lift: Floats
    push: Floats
    height: Floats
    out: Booleans
    curve: tuple[DragCurve | None, ...]

    @cached_property
    def lifts(self) -> bool:
        """Whether at least one load has a lift coefficient."""
        return bool(self.lift.any())

    @cached_property
    def thins(self) -> bool:
        """Whether at least one load becomes thinner as it stretches."""
        return bool(self.thinning.any())

    @cached_property
    def share(self) -> Floats:
        """(2, k) fractions of each load that act on the upper and on the lower node of the bar."""
        return np.stack([1.0 - self.place, self.place])

    def summed(self, per_load: Floats) -> Floats:
        """Sum the values (..., k) of the loads over each bar, and return the sums (..., n)."""
        total: Floats = np.add.reduceat(per_load, self._first, axis=-1)
        return total

    @cached_property
    def _first(self) -> Integers:
        return np.flatnonzero(np.diff(self.bar, prepend=-1))


@dataclass(frozen=True)
class FloatOnChain:
    """Properties of the uppermost float, afloat at the surface, tabulated against its draft.

    Attributes
    ----------
    element : index of the load that represents the float
    weight : weight in air [N]
    draft : (m,) draft as a fraction of `height` [m], increasing from 0 to 1
    immersed, drag : (m,) volume and drag as fractions of their values for full immersion
    push : (m, 2) wind force towards the east and north [N]
    """

    element: int
    height: float
    weight: float
    draft: Floats
    immersed: Floats
    drag: Floats
    push: Floats


@dataclass(frozen=True)
class BarChain:
    """Chain of n straight bars between n + 1 nodes, free end first.

    Positions on a bar are from 0 at its upper to 1 at its lower end.

    Attributes
    ----------
    length : (n,) unstretched length of the bars [m]
    piece : (n,) index of the piece that each bar represents; of several rigid pieces, the last
    compliance : (n,) strain per unit tension, 1/EA [1/N]
    elongation : for every cable with an elongation curve, indices of its bars, and knots of the
        curve
    bars : (p, 2) first bar of every piece, and the bar after its last bar; for a piece without
        length, both are the adjacent bar
    span : (p, 2) position of each piece's upper end on its first bar, and of its lower end on its
        last bar
    clamp_bar, clamp_place : (m,) bar of each clamp, and position on this bar
    afloat : properties of the uppermost float at the surface; None if its hull is unknown
    """

    line: Line
    length: Floats
    piece: Integers
    compliance: Floats
    elongation: tuple[tuple[Integers, Floats], ...]
    elements: Elements
    bars: Integers
    span: Floats
    clamp_bar: Integers
    clamp_place: Floats
    afloat: FloatOnChain | None


def chain_of(line: Line, count: int) -> BarChain:
    """Represent a line by a chain of bars.

    Parameters
    ----------
    line : line above an anchor, free end first
    count : approximate number of bars for all cables and chains together

    Raises
    ------
    ValueError
        The line has no length.
    """
    length, piece, bars, span = _bars(line, count)
    if not len(length):
        raise ValueError("a line needs a length")
    clamp_bar, clamp_place = _along(
        line.clamp_piece, line.clamp_at / np.maximum(line.length, 1e-300)[line.clamp_piece],
        bars, span,
    )  # fmt: skip
    elements = _elements(line, bars, span, clamp_bar, clamp_place)
    return BarChain(
        line=line,
        length=length,
        piece=piece,
        compliance=line.compliance[piece] * line.flexible[piece],
        elongation=tuple(
            (np.flatnonzero(piece == i), np.array(curve.knots))
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
    """Return `length`, `piece`, `bars` and `span` of a `BarChain`."""
    pieces, head = len(line.length), head_count(line)
    cable = float(line.length[line.flexible].sum())
    share = line.length / max(cable, 1e-300)
    least = np.where(share > SHORT_SHARE, count * MIN_BAR_SHARE, 1.0)
    cuts = np.where(line.flexible, np.ceil(np.maximum(share * count, least)), 1.0)
    cuts[line.length == 0.0] = 0.0
    bars, span = np.zeros((pieces, 2), dtype=np.intp), np.zeros((pieces, 2))
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
        # a piece without length is at the upper end of the bar below, or the lower end of the last
        # bar
        below = bars[piece, 0] < len(length)
        span[piece] = (0.0, 0.0) if below else (1.0, 1.0)
        bars[piece] -= 0 if below else 1
    return np.array(length), np.array(owner, dtype=np.intp), bars, span


def _along(piece: Integers, share: Floats, bars: Integers, span: Floats) -> tuple[Integers, Floats]:
    """Locate points on bars: return the bar of each point, and the position on this bar.

    `piece` is the piece of each point. `share` is the distance of the point from the upper end of
    this piece, divided by the length of the piece.
    """
    first, end = bars[piece].T
    begin, stop = span[piece].T
    fraction = begin + share * (stop - begin)
    whole = fraction * np.maximum(end - first, 1)
    bar = np.minimum(whole.astype(np.intp), np.maximum(end - first - 1, 0))
    return first + bar, np.clip(whole - bar, 0.0, 1.0)


def _elements(
    line: Line, bars: Integers, span: Floats, clamp_bar: Integers, clamp_place: Floats
) -> Elements:
    first, end = bars.T
    parts = np.maximum(end - first, 1)
    piece = np.repeat(np.arange(len(parts)), parts)
    bar = np.concatenate([np.arange(at, at + n) for at, n in zip(first, parts, strict=True)])
    bar, place = np.append(bar, clamp_bar), np.append(0.5 * span.sum(1)[piece], clamp_place)
    order = np.lexsort((place, bar))
    share, flexible, head = 1.0 / parts[piece], line.flexible[piece], head_count(line)
    whole = share * np.where(flexible, line.length[piece], 1.0)
    curves = [line.drag_curve[i] if line.drag_curve else None for i in piece]
    curves += line.clamp_drag_curve or [None] * len(clamp_bar)

    def column(of_pieces: Any, of_clamps: Any = 0.0) -> Any:
        return np.append(of_pieces, np.broadcast_to(of_clamps, clamp_bar.shape))[order]

    return Elements(
        bar=bar[order],
        place=place[order],
        piece=column(piece, -1),
        buoyancy=column(whole * line.buoyancy[piece], line.clamp_buoyancy),
        volume=column(whole * line.volume[piece], line.clamp_volume),
        normal_drag=column(whole * line.normal_drag[piece], line.clamp_drag),
        tangential_drag=column(whole * line.tangential_drag[piece]),
        directional=column(line.directional[piece], False),
        flexible=column(flexible, False),
        thinning=column(line.thinning[piece]),
        lift=column(np.where(flexible, 0.0, line.lift[piece]), line.clamp_lift),
        push=np.stack(
            [*(column(share * p[piece]) for p in (line.push_east, line.push_north)), 0.0 * place]
        ),
        height=column(np.where(flexible, 0.0, line.length[piece])),
        out=column(piece < head - 1, line.clamp_piece < head - 1),
        curve=tuple(curves[i] for i in order),
    )


_DRAFTS = 401
"""Number of points in the table of a float's hull."""


def afloat_of(line: Line, elements: Elements) -> FloatOnChain | None:
    """Tabulate buoyancy, drag and wind force of the uppermost float against its draft.

    Return None if the hull of the float is unknown.
    """
    floating = line.floating
    if floating is None or floating.hull is None:
        return None
    first = np.flatnonzero(~line.flexible & (line.buoyancy > 0.0))[0]
    element = int(np.flatnonzero(elements.piece == first)[0])
    return _afloat(floating, element, float(elements.height[element]) or floating.hull.height)


@lru_cache(maxsize=4)
def _afloat(floating: Floating, element: int, height: float) -> FloatOnChain:
    hull = floating.hull
    assert hull is not None
    # by the immersed share, finer where a hull is thin: at its keel and at its top
    share = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, _DRAFTS))
    net = share * (floating.weight + floating.lift) - floating.weight
    ridings = [floating.riding(used) for used in (net / floating.lift).tolist()]
    draft = np.array([hull.curve(one)[0] for one in share.tolist()])
    growing = np.append(True, np.diff(np.maximum.accumulate(draft)) > 0.0)
    return FloatOnChain(
        element=element,
        height=height,
        weight=floating.weight,
        draft=draft[growing],
        immersed=share[growing],
        drag=np.array([riding.drag for riding in ridings])[growing],
        push=np.array([riding.push for riding in ridings])[growing],
    )
