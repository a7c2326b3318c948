"""Breaks of a design and losses of its floats, and the parts that surface afterwards.

A design is a graph of its pieces, and a break removes one connection. After a break above the
release, back-up buoyancy recovers the release.
"""

from collections.abc import Collection, Hashable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import pairwise, takewhile

import numpy as np

from calm.assemble import net_buoyancy, with_axial_clamps
from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.checks.finding import State, Verdict, unknown, verdict_on
from calm.checks.recovery import lifts_of
from calm.errors import NoEquilibrium
from calm.files import Component, Flexible, Piece, Place
from calm.files.definition import CATALOGUE_DENSITY
from calm.physics.line import Floats
from calm.physics.materials import materials_in
from calm.solve.solution import standing_lift

SHORT_LEAD = 50.0
"""Line length up to which breaks between the lowest floats and the release are not checked [m].

The value is a default of CALM. The lowest floats are the back-up buoyancy for everything above
them. On a bottom lander, they alone recover the mooring.
"""

_SEABED, _HELD = object(), object()


@dataclass(frozen=True)
class Break:
    """Break of the line below one of its pieces.

    Attributes
    ----------
    break_after, label : index and label of the piece above the break
    margin : net buoyancy of the section with the release after all releases open [N]
    required : minimum required value of `margin` [N]
    weight_lifted : weight in water of the non-buoyant pieces in this section [N]
    judged : False for a break after which no design of the line could bring up the release
    loose : net buoyancy of the section that the break sets adrift before any release opens [N]
    """

    break_after: int
    label: str
    margin: float
    weight_lifted: float
    required: float
    judged: bool
    loose: float = 0.0


@dataclass(frozen=True)
class Loss:
    """Loss of one buoyant element, such as a flooded glass ball, from an intact line.

    Attributes
    ----------
    index : index of the lost piece, or of the piece that carries the lost clamp
    label, place : label of the lost element, and its place in the file
    margin : net buoyancy of all pieces that rise with the release [N]
    required : minimum required value of `margin` [N]
    weight_lifted : weight in water of the non-buoyant pieces that rise [N]
    """

    index: int
    label: str
    margin: float
    weight_lifted: float
    required: float
    place: Place


class LegGraph:
    """Graph of the connections between the pieces, nodes and fixed ends of a design.

    In each leg of a net, only the lowest release opens.

    Parameters
    ----------
    legs : legs of the design; empty without an equilibrium
    lifts : one array (n,) per leg, with the net force of each piece above the anchor [N]; the
        clamps on a piece are included
    """

    def __init__(self, legs: Sequence[Leg], lifts: Sequence[Floats]) -> None:
        self.pieces: list[Piece] = []
        self.chains: list[list[Hashable]] = []
        self.opened: dict[tuple[int, int], int] = {}
        columns: list[Floats] = []
        for number, (leg, lift) in enumerate(zip(legs, lifts, strict=True)):
            above = leg.pieces
            upper, lower = (_HELD if end.held else end.join for end in (leg.top, leg.bottom))
            first = len(self.pieces)
            chain: list[Hashable] = [upper, *range(first, first + len(above)), lower]
            if leg.anchored:
                chain[-2:] = [_SEABED]
            self.pieces += above
            self.chains.append(chain)
            releases = [at for at, one in enumerate(above) if one.component.role == "release"]
            for at in releases[-1:]:
                self.opened[number, at + 1] = first + at
            drag = with_axial_clamps(leg.line, above[: len(lift)]).plumb_drag
            figures = np.stack([lift, drag, leg.line.length])
            # anchors have no buoyancy
            columns.append(np.pad(figures, ((0, 0), (0, 1)))[:, : len(above)])
        self.lifts, self.drags, self.lengths = np.hstack([np.zeros((3, 0)), *columns])
        self.releases = set(self.opened.values())

    @classmethod
    def in_equilibrium(cls, results: Sequence[LegResult]) -> "LegGraph":
        """Return the graph of a solved design; net forces are those at the equilibrium depths."""
        lifts = [lifts_of(each.leg.line, each.leg.water, each) for each in results]
        return cls([each.leg for each in results], lifts)

    @classmethod
    def upright(cls, leg: Leg) -> "LegGraph":
        """Return the graph of a single line, with net forces at the depths in the upright line.

        The graph is empty if a fitted piece cannot reach its target depth.
        """
        with suppress(NoEquilibrium):
            return cls([leg], [standing_lift(leg.line, leg.water)])
        return cls([], [])

    @property
    def anchored(self) -> bool:
        """Whether the design has an anchor."""
        return any(_SEABED in chain for chain in self.chains)

    def parts(self, cut: Collection[tuple[int, int]]) -> list[set[Hashable]]:
        """Return the connected parts into which breaks divide the design.

        `cut` contains for each break the number of the leg, and the position in the leg.
        """
        parts: list[set[Hashable]] = []
        for number, chain in enumerate(self.chains):
            ends = sorted(at + 1 for leg, at in cut if leg == number)
            for first, end in pairwise([0, *ends, len(chain)]):
                run = {one for one in chain[first:end] if one is not None}
                touched = [part for part in parts if part & run]
                parts = [part for part in parts if not part & run]
                parts.append(run.union(*touched))
        return parts

    def _free_parts(self, cut: Collection[tuple[int, int]]) -> list[list[int]]:
        return [
            sorted(one for one in part if isinstance(one, int))
            for part in self.parts(cut)
            if not part & {_SEABED, _HELD}
        ]

    def _rising_parts(self, cut: Collection[tuple[int, int]]) -> list[list[int]]:
        parts = self._free_parts({*self.opened, *cut})
        return [part for part in parts if not self.releases.isdisjoint(part)]

    @property
    def coming_up(self) -> set[int]:
        """Indices of the pieces that surface after all releases open.

        In a design without a release, these are all pieces except anchors.
        """
        parts = self._rising_parts(()) if self.opened else self.chains
        return {one for part in parts for one in part if isinstance(one, int)}

    def breaks(self, whole: Leg) -> tuple[Break, ...]:
        """Return the breaks below every piece that surfaces, in file order.

        The margin of a break inside a cable lies between the margins of breaks at the two ends of
        the cable. Breaks are not judged if no design of the line could bring up the release:

        - breaks inside the last cluster of floats above a release;
        - breaks between this cluster and the release, up to a distance of `SHORT_LEAD`.

        Floats with only connectors and chain between them form a cluster. If these exceptions cover
        all breaks, floats with chain between them are separate clusters. `whole` contains all
        pieces as one leg, and supplies the limits.
        """
        rising = {one for part in self._rising_parts(()) for one in part}
        before = {one for part in self._free_parts(()) for one in part}
        found: list[Break] = []
        places: list[tuple[Sequence[Hashable], int, list[int]]] = []
        for number, chain in enumerate(self.chains):
            for at, (one, below) in enumerate(pairwise(chain)):
                # no break below a free end; the lower end of a release is not a break either
                opened = (number, at) in self.opened
                if below is None or opened or not isinstance(one, int) or one not in rising:
                    continue
                cut = {(number, at)}
                off = [
                    each for part in self._free_parts(cut) for each in part if each not in before
                ]
                margins = [(*self._margin(part, whole), part) for part in self._rising_parts(cut)]
                if not margins:
                    continue
                margin, weight, required, part = min(margins, key=lambda each: each[0] - each[2])
                label, loose = self.pieces[one].label, float(self.lifts[off].sum())
                found.append(Break(one, label, margin, weight, required, False, loose))
                places.append((chain, at, part))
        for between in (("connector", "chain"), ("connector",)):
            judged = [not self._strands_release(*place, between) for place in places]
            if any(judged):
                break
        return tuple(replace(one, judged=judge) for one, judge in zip(found, judged, strict=True))

    def _margin(self, part: list[int], whole: Leg) -> tuple[float, float, float]:
        lift = self.lifts[part]
        weight = float(-lift[lift < 0.0].sum())
        drag = float(self.drags[part].sum())
        return float(lift.sum()), weight, _required_margin(whole, weight, drag)

    def _strands_release(
        self, chain: Sequence[Hashable], at: int, part: list[int], between: tuple[str, ...]
    ) -> bool:
        """Return whether no design of the line could bring up the release after a break.

        `between` lists the kinds and roles of pieces that may lie between the floats of a cluster.
        """
        floats = {one for one in part if self._floats(one)}
        if not floats:
            above = takewhile(self._leads, reversed(chain[: at + 1]))
            lead = {one for one in (*above, *part) if isinstance(one, int)} - self.releases
            return float(self.lengths[sorted(lead)].sum()) <= SHORT_LEAD
        below = takewhile(lambda one: self._in_a_cluster(one, between), chain[at:])
        return floats <= set([*below][1:])

    def _in_a_cluster(self, one: Hashable, between: tuple[str, ...]) -> bool:
        return isinstance(one, int) and (self._floats(one) or self._is(one, *between))

    def _leads(self, one: Hashable) -> bool:
        return isinstance(one, int) and not self._floats(one)

    def _floats(self, one: int) -> bool:
        return bool(self.lifts[one] > 0.0) and not self._is(one, "cable")

    def _is(self, one: int, *what: str) -> bool:
        component = self.pieces[one].component
        return component.kind in what or component.role in what

    def losses(self, whole: Leg) -> tuple[Loss, ...]:
        """Return the effect of losing each buoyant piece or clamp that surfaces, one at a time.

        A lost element is assumed to be flooded if its mass and the density of its material are
        known, and otherwise to be gone. Cables are never lost. `whole` contains all pieces of the
        design as one leg, and supplies gravity and the limits of the check.
        """
        return tuple(
            loss for part in self._rising_parts(()) for loss in self._losses_of(part, whole)
        )

    def _losses_of(self, rising: list[int], whole: Leg) -> Iterator[Loss]:
        gravity, lift = whole.water.gravity, self.lifts[rising]
        weight, drag = float(-lift[lift < 0.0].sum()), float(self.drags[rising].sum())
        for index in rising:
            piece = whole.file.pieces[index]
            own = () if isinstance(piece.component, Flexible) else (piece,)
            for part in (*own, *piece.clamps):
                lifted = net_buoyancy(part.component, gravity)
                if lifted <= 0.0:
                    continue
                sunk = _weight_when_flooded(part.component, gravity)
                yield Loss(
                    index=index,
                    label=part.label,
                    margin=float(lift.sum()) - lifted - sunk,
                    weight_lifted=weight + sunk,
                    required=_required_margin(whole, weight + sunk, drag),
                    place=part.place,
                )

    def release_verdicts(self) -> Iterator[Verdict]:
        """Check that no float stays attached to an anchor after all releases open."""
        held = [
            self.pieces[one]
            for part in self.parts(self.opened)
            if _SEABED in part
            for one in sorted(each for each in part if isinstance(each, int))
            if self.lifts[one] > 0.0 and not isinstance(self.pieces[one].component, Flexible)
        ]
        for piece in held:
            message = f"No release lies between {piece.label} and an anchor that holds it."
            yield unknown(piece, message, "Mark the release with `role: release`.")
        if not held and self.opened:
            message = "The releases free every buoyant part from its anchors."
            yield verdict_on(self.pieces[min(self.releases)], State.PASS, message)


def _weight_when_flooded(component: Component, gravity: float) -> float:
    """Return the weight in water of a flooded float's shell [N]; 0 if unknown."""
    named = (material.density for material in materials_in(component.material))
    density = next((value for value in named if value and value > CATALOGUE_DENSITY), None)
    if density is None or component.mass is None:
        return 0.0
    return component.mass * gravity * (1.0 - CATALOGUE_DENSITY / density)


def _required_margin(leg: Leg, weight: float, drag: float) -> float:
    """Return the net buoyancy required after a break [N].

    Parameters
    ----------
    weight : weight in water of the non-buoyant pieces that rise [N]
    drag : drag of the rising pieces at 1 m/s [N/(m/s)²]
    """
    checks = leg.file.checks
    return max(checks.backup_margin * weight, drag * checks.minimum_rise_speed**2)
