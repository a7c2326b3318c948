"""Connections between the pieces of a net, and the parts that remain after a break."""

from collections.abc import Collection, Hashable, Iterator, Sequence
from itertools import pairwise, takewhile

import numpy as np

from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.checks.finding import State, Verdict, unknown, verdict_on
from calm.checks.recovery import (
    SHORT_LEAD,
    Break,
    Loss,
    drags_of,
    lifts_of,
    losses_among,
    required_margin,
)
from calm.files import Flexible, Piece
from calm.physics.line import Floats

_SEABED, _HELD = object(), object()


class LegGraph:
    """Connections of a net between pieces, by their index in the file, nodes, and fixed ends.

    Parameters
    ----------
    legs : results of the legs; empty for a net without equilibrium
    """

    def __init__(self, legs: Sequence[LegResult]) -> None:
        self.pieces: list[Piece] = []
        self.chains: list[list[Hashable]] = []
        columns: list[Floats] = []
        for leg in legs:
            own, above = leg.leg, leg.leg.pieces
            upper, lower = (
                _HELD if end.held else end.join for end in (leg.leg.top, leg.leg.bottom)
            )
            first = len(self.pieces)
            chain: list[Hashable] = [upper, *range(first, first + len(above)), lower]
            if own.anchored:
                chain[-2:] = [_SEABED]
            self.pieces += above
            self.chains.append(chain)
            force = lifts_of(own.line, own.water, leg)
            figures = np.stack([force, drags_of(own.line, above), own.line.length])
            # anchors have no buoyancy
            columns.append(np.pad(figures, ((0, 0), (0, 1)))[:, : len(above)])
        self.lifts, self.drags, self.lengths = np.hstack([np.zeros((3, 0)), *columns])
        self.opened = {
            (number, at)
            for number, chain in enumerate(self.chains)
            for at, one in enumerate(chain)
            if isinstance(one, int) and self.pieces[one].component.role == "release"
        }

    @property
    def anchored(self) -> bool:
        """Whether the net has an anchor."""
        return any(_SEABED in chain for chain in self.chains)

    def parts(self, cut: Collection[tuple[int, int]]) -> list[set[Hashable]]:
        """Return the connected parts of the net after a break below given places (`cut`) of its
        chains.
        """
        parts: list[set[Hashable]] = []
        for number, chain in enumerate(self.chains):
            for at, one in enumerate(chain):
                if one is None:
                    continue
                goes_on = at + 1 < len(chain) and (number, at) not in cut
                own = {one, chain[at + 1]} - {None} if goes_on else {one}
                touched = [part for part in parts if part & own]
                parts = [part for part in parts if not part & own]
                parts.append(own.union(*touched))
        return parts

    def _free(self, cut: Collection[tuple[int, int]]) -> list[list[int]]:
        """Return the pieces of each part without a fixed end, in file order."""
        return [
            sorted(one for one in part if isinstance(one, int))
            for part in self.parts(cut)
            if not part & {_SEABED, _HELD}
        ]

    def _rising(self, cut: Collection[tuple[int, int]]) -> list[list[int]]:
        """Return the free parts that contain a release, after all releases open."""
        return [
            part
            for part in self._free(self.opened | set(cut))
            if any(self.pieces[one].component.role == "release" for one in part)
        ]

    @property
    def coming_up(self) -> set[int]:
        """Return the pieces that surface after all releases open; without a release, all pieces
        except anchors.
        """
        parts = self._rising(()) if self.opened else self.chains
        return {one for part in parts for one in part if isinstance(one, int)}

    def breaks(self, whole: Leg) -> tuple[Break, ...]:
        """Return the breaks below every piece that surfaces, in file order.

        The margin of a break refers to the section that still holds a release after all releases
        have opened; `loose` is the net buoyancy of the section that drifts off before that.
        """
        rising = {one for part in self._rising(()) for one in part}
        before = {one for part in self._free(()) for one in part}
        found = []
        for number, chain in enumerate(self.chains):
            for at, (one, below) in enumerate(pairwise(chain)):
                # no break below a free end; the lower end of a release is not a break either
                opened = (number, at) in self.opened
                if below is None or opened or not isinstance(one, int) or one not in rising:
                    continue
                cut = {(number, at)}
                off = [each for part in self._free(cut) for each in part if each not in before]
                margins = [(*self._margin(part, whole), part) for part in self._rising(cut)]
                if not margins:
                    continue
                margin, weight, required, part = min(margins, key=lambda each: each[0] - each[2])
                label, loose = self.pieces[one].label, float(self.lifts[off].sum())
                judged = not self._beyond_help(chain, at, part)
                found.append(Break(one, label, margin, weight, required, judged, loose))
        return tuple(found)

    def _margin(self, part: list[int], whole: Leg) -> tuple[float, float, float]:
        lift = self.lifts[part]
        weight = float(-lift[lift < 0.0].sum())
        drag = float(self.drags[part].sum())
        return float(lift.sum()), weight, required_margin(whole, weight, drag)

    def _beyond_help(self, chain: Sequence[Hashable], at: int, part: list[int]) -> bool:
        """Return whether a break strands the net in any design: it divides the cluster of all
        remaining floats, or a short lead from that cluster to the release.
        """
        floats = {one for one in part if self._floats(one)}
        if not floats:
            above = takewhile(self._leads, reversed(chain[: at + 1]))
            lead = {one for one in (*above, *part) if isinstance(one, int)}
            return float(self.lengths[sorted(lead)].sum()) <= SHORT_LEAD
        below = list(takewhile(self._in_a_cluster, chain[at:]))
        return floats <= set(below[1:])

    def _in_a_cluster(self, one: Hashable) -> bool:
        return isinstance(one, int) and (self._floats(one) or self._is(one, "connector", "chain"))

    def _leads(self, one: Hashable) -> bool:
        return isinstance(one, int) and not self._floats(one)

    def _floats(self, one: int) -> bool:
        return bool(self.lifts[one] > 0.0) and not self._is(one, "cable")

    def _is(self, one: int, *what: str) -> bool:
        component = self.pieces[one].component
        return component.kind in what or component.role in what

    def losses(self, whole: Leg) -> tuple[Loss, ...]:
        """Return the loss of each buoyant piece or clamp that would otherwise surface."""
        return tuple(
            loss
            for part in self._rising(())
            for loss in losses_among(
                whole,
                [whole.file.pieces[one] for one in part],
                self.lifts[part],
                float(self.drags[part].sum()),
            )
        )

    def release_verdicts(self) -> Iterator[Verdict]:
        """Report the floats that stay attached to an anchor after all releases open."""
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
            number, at = min(self.opened)
            one = self.chains[number][at]
            assert isinstance(one, int)
            message = "The releases free every buoyant part from its anchors."
            yield verdict_on(self.pieces[one], State.PASS, message)
