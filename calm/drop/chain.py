"""A line as a chain: straight bars between nodes, and the loads that they carry.

A cable or chain is cut into bars, a rigid piece is one bar, and the pieces that are rigid with the
free end are one together. The force of a load goes to the two nodes of its bar by the lever: in
equilibrium a bar then lies along the mean of the forces at its ends, as everywhere in CALM.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from calm.physics.hull import Floating
from calm.physics.line import Booleans, Floats, Integers, Line
from calm.physics.reynolds import DragCurve
from calm.physics.track import head_count

LEAST = 0.12
"""Of all bars: those of a cable or chain that is not short, since it may be the one that turns on
the seabed."""
NOT_SHORT = 0.02
"""Share of all cables and chains from which on one is not short."""


@dataclass(frozen=True)
class Elements:
    """The k loads of a chain, by growing bar; every bar has one at least.

    Attributes
    ----------
    bar : (k,) the bar it is on
    place : (k,) where on it, from 0 at its upper node to 1 at its lower
    piece : (k,) that it is part of; -1 of a clamp
    buoyancy, volume : (k,) whole, in reference water [N], [m³]
    normal_drag, tangential_drag : (k,) Kn and Kt, whole [N/(m/s)²]
    directional : (k,) False where the drag is Kn|V|V
    flexible : (k,) whether it is cable or chain
    thinning, lift : (k,) as in `Line`
    push : (3, k) of the wind [N]
    height : (k,) of what is rigid, from its top to its lower end [m]
    out : (k,) whether it stands on the float, and so out of the water where that is at the surface
    curve : (k,) of smooth spheres and cylinders, None of others
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
        """Return whether the flow lifts any."""
        return bool(self.lift.any())

    @cached_property
    def share(self) -> Floats:
        """(2, k) of what acts on a load that its bar's upper and its lower node take."""
        return np.stack([1.0 - self.place, self.place])

    def summed(self, per_load: Floats) -> Floats:
        """(..., n) over the loads of every bar."""
        total: Floats = np.add.reduceat(per_load, self._first, axis=-1)
        return total

    @cached_property
    def _first(self) -> Integers:
        return np.flatnonzero(np.diff(self.bar, prepend=-1))


@dataclass(frozen=True)
class FloatOnChain:
    """The first float at the surface, by its draft as a share of its height, 0 to 1.

    Attributes
    ----------
    element : the load that it is
    height : [m]
    weight : in air [N]
    draft : (m,) growing
    immersed, drag : (m,) shares of the volume, and of the drag below the surface
    push : (m, 2) of the wind to the east and north [N]
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
    """n bars between n + 1 nodes, the free end first.

    Attributes
    ----------
    line : what it is the chain of
    length : (n,) of the bars, unstretched [m]
    piece : (n,) each bar's own; of the rigid head its last
    compliance : (n,) 1/EA [1/N]
    elongation : the bars of every cable that stretches by a curve, and the knots of the curve
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
    elongation: tuple[tuple[Integers, Floats], ...]
    elements: Elements
    bars: Integers
    span: Floats
    clamp_bar: Integers
    clamp_place: Floats
    afloat: FloatOnChain | None


def chain_of(line: Line, count: int) -> BarChain:
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
    """Length and piece of every bar; bars and span of every piece."""
    pieces, head = len(line.length), head_count(line)
    cable = float(line.length[line.flexible].sum())
    share = line.length / max(cable, 1e-300)
    least = np.where(share > NOT_SHORT, count * LEAST, 1.0)
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
        # without length it is at the upper end of the bar below it, or the lower end of the last
        below = bars[piece, 0] < len(length)
        span[piece] = (0.0, 0.0) if below else (1.0, 1.0)
        bars[piece] -= 0 if below else 1
    return np.array(length), np.array(owner, dtype=np.intp), bars, span


def _along(piece: Integers, share: Floats, bars: Integers, span: Floats) -> tuple[Integers, Floats]:
    """Bar, and place on it, of points at a share of the way down their pieces."""
    first, end = bars[piece].T
    begin, stop = span[piece].T
    way = begin + share * (stop - begin)
    whole = way * np.maximum(end - first, 1)
    bar = np.minimum(whole.astype(np.intp), np.maximum(end - first - 1, 0))
    return first + bar, np.clip(whole - bar, 0.0, 1.0)


def _elements(
    line: Line, bars: Integers, span: Floats, clamp_bar: Integers, clamp_place: Floats
) -> Elements:
    """Return the loads: pieces, shared out over their bars, and clamps."""
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
"""Points of the table of a hull afloat."""


def afloat_of(line: Line, elements: Elements) -> FloatOnChain | None:
    """Return how the first float of a line rides by its draft; None where its hull is not known."""
    floating = line.floating
    if floating is None or floating.hull is None:
        return None
    first = np.flatnonzero(~line.flexible & (line.buoyancy > 0.0))[0]
    element = int(np.flatnonzero(elements.piece == first)[0])
    return _afloat(floating, element, float(elements.height[element]) or floating.hull.height)


@lru_cache(maxsize=4)
def _afloat(floating: Floating, element: int, height: float) -> FloatOnChain:
    """Return how a float with a hull rides that is a load of a height [m]."""
    hull = floating.hull
    assert hull is not None
    # by the share immersed, finer where a hull is thin: at its keel and at its top
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
