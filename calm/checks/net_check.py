"""The design check of a net: each leg by the rules of a line, then what its breaks leave.

The launch and the recovery of a net are not solved: nothing of them is judged.
"""

from collections.abc import Collection, Hashable, Iterator, Sequence
from dataclasses import replace
from datetime import date
from itertools import pairwise, takewhile

import numpy as np

from calm.case import Mooring, Result
from calm.case.net import Net
from calm.case.result import NetResult
from calm.checks import assess, assessment, situations
from calm.checks.arrangement import clamp_place, hardware, metals, release_present, swivel
from calm.checks.assessment import Assessment, Handling, MooringInEnvironment, Situation, estimated
from calm.checks.catalogue_rules import figures
from calm.checks.criterion import limits_used
from calm.checks.finding import AS_GIVEN, OWN, State, Verdict, unknown, verdict_on
from calm.checks.growth import grown
from calm.checks.handling import backup
from calm.checks.inventory import inventory_of
from calm.checks.missing import with_missing
from calm.checks.recovery import Break, Loss, lifts_of, losses_among, required_margin
from calm.errors import NoEquilibrium, or_why_not
from calm.files import Flexible, Piece
from calm.files.legs import stand_in_anchor
from calm.files.mooring_file import STAND_IN
from calm.physics.line import Floats
from calm.solve import Status, expect_many

NOT_HANDLED = (
    "a net of legs: each leg is judged by the rules of a line; launch, recovery and "
    "waves are not judged"
)
_NOT_SOLVED = Status.NOT_CONVERGED.because("The launch and the recovery of a net are not solved.")


def check(*designs: Mooring | Net, day: date | None = None) -> Assessment:
    """Judge a mooring, or a net of legs, by every rule of the design check.

    Parameters
    ----------
    designs : the same one, loaded in each of the environments it is judged in
    day : on which accepts count or have ended; today unless given

    Raises
    ------
    TypeError
        It is a tow, or none of these.
    """
    if kinds := [type(one).__name__ for one in designs if not isinstance(one, Mooring | Net)]:
        raise TypeError(f"a Mooring or a Net is needed, as calm.load gives it, not a {kinds[0]}")
    name = designs[0].file.name
    expect_many(situations.SOLVES * len(designs))
    stands: list[MooringInEnvironment] = []
    for each in designs:
        stands += (
            stands_of_net(each, name, day)
            if isinstance(each, Net)
            else [assess.stand_of(each, name, day)]
        )
    of = assessment_of_net if isinstance(designs[0], Net) else assess.assessment_of
    return of(name, stands, day)


def stands_of_net(net: Net, name: str, day: date | None = None) -> list[MooringInEnvironment]:
    """Solve a net in its environment, in every situation, and judge each of its legs.

    Parameters
    ----------
    name, day : as of `stand_of`

    Where the net does not stand there is one, with the reason.
    """
    environment = net.file.environment.name or OWN
    solved = list(_situations(net))
    if isinstance(solved[0][1], NoEquilibrium):
        return [assess.failed_stand(net.lines[0], name, solved[0][1])]
    return [
        assess.judged_stand(
            tuple(
                Situation(said, None, found)
                if isinstance(found, NoEquilibrium)
                else Situation(said, found.legs[number], None)
                for said, found in solved
            ),
            line,
            name,
            f"{environment}: {line.file.name}",
            day,
        )
        for number, line in enumerate(net.lines)
    ]


def _situations(net: Net) -> Iterator[tuple[str, NetResult | NoEquilibrium]]:
    given = or_why_not(net.solve)
    yield AS_GIVEN, given
    if isinstance(given, NoEquilibrium):
        return
    for name, file in situations.in_other_waters(net.file, net.water):
        yield name, or_why_not(Net(file).solve)
    fouling = net.file.environment.fouling
    if fouling is not None:
        legs = [grown(leg.file.pieces, leg, fouling) for leg in given.legs]
        yield situations.FOULED, or_why_not(net.with_lines(legs).solve)
    if (strummed := situations.strumming_file(net.file)) is not None:
        yield situations.STRUMMING, or_why_not(Net(strummed).solve)
    if net.file.deployed is not None:
        deployed = situations.deployed_file(net.file)
        if (deployed.pieces, deployed.environment) != (net.file.pieces, net.file.environment):
            yield situations.DEPLOYED, or_why_not(Net(deployed).solve)


def assessment_of_net(
    name: str, stands: Sequence[MooringInEnvironment], day: date | None = None
) -> Assessment:
    """Judge the breaks of a net too, and how it is put together.

    Parameters
    ----------
    stands : those of `stands_of_net`, of one environment after the other
    day : see `check`
    """
    own: dict[str, MooringInEnvironment] = {}
    for stand in stands:
        if stand.result is not None:
            own.setdefault(stand.mooring.file.name, stand)
    legs = [stand.result for stand in own.values() if stand.result is not None]
    lines = [leg.mooring for leg in legs] or [stands[0].mooring]
    whole = _whole(lines, any(leg.type == "surface" for leg in legs))
    acceptance = assessment.Acceptance.of_file(whole.file, day)
    graph = NetGraph(legs)
    breaks, losses = graph.breaks(whole), graph.losses(whole)
    handling = Handling(estimated(whole), _NOT_SOLVED, _NOT_SOLVED, breaks, losses)
    first = whole.file.environment.name or OWN
    once = [(hardware, hardware.judge(handling), first), (figures, figures.judge(handling), first)]
    if graph.anchored:
        once.append((release_present, graph.release_verdicts(), first))
        once.append((backup, backup.judge(handling), first))
    for stand in own.values():
        leg = Handling(estimated(stand.mooring), _NOT_SOLVED, _NOT_SOLVED, ())
        once += [(each, each.judge(leg), stand.environment)
                 for each in (swivel, clamp_place, metals)]  # fmt: skip
    waters = {stand.mooring.file.environment.name: stand.mooring for stand in stands}
    findings = list(assess.findings_of_currents(list(waters.values()), name, acceptance))
    for rule, verdicts, environment in once:
        findings += acceptance.findings(rule, verdicts, name, environment)
    lacking = [one for stand in stands for one in stand.lacking]
    findings = with_missing((*lacking, *findings), acceptance.parts, name, first)
    fast = (float(np.hypot(each.water.u, each.water.v).max()) for each in waters.values())
    if legs and max(fast) < situations.LEAST_CURRENT:
        findings.insert(
            0, situations.equilibrium.find(situations.STILL_ONLY, name, first, AS_GIVEN)
        )
    surface = bool(whole.for_surface)
    accepted = [*(one for stand in stands for one in stand.accepted), *findings]
    return Assessment(
        name=name,
        stands=tuple(stands),
        launch=None,
        recovery=None,
        backup=breaks,
        losses=losses,
        limits=tuple(dict.fromkeys(k for each in lines for k in limits_used(each.file, surface))),
        inventory=tuple(item for item in inventory_of(whole) if item.use != STAND_IN),
        findings=tuple(findings),
        notices=(NOT_HANDLED, *acceptance.notices(accepted)),
    )


def _whole(lines: Sequence[Mooring], surface: bool) -> Mooring:
    """All pieces of a net as one list, a stand-in for an anchor below them."""
    pieces = [piece for line in lines for piece in line.file.pieces if piece.use != STAND_IN]
    pieces.append(stand_in_anchor(0, len(pieces)))
    listed = tuple(replace(piece, index=index) for index, piece in enumerate(pieces))
    file = replace(lines[0].file, pieces=listed, legs=())
    return Mooring(file, surface, water=lines[0].water)


_SEABED, _HELD = object(), object()


class NetGraph:
    """Tell what holds what in a net: pieces by their index in the file, nodes by name, what is
    fixed.

    Parameters
    ----------
    legs : of a solved net; none of one that does not stand
    """

    def __init__(self, legs: Sequence[Result]) -> None:
        self.pieces: list[Piece] = []
        self.chains: list[list[Hashable]] = []
        lifts: list[Floats] = []
        for leg in legs:
            (keys,), own = leg.file.legs, leg.file.pieces
            above = own if own[-1].use != STAND_IN else own[:-1]
            upper, lower = (_HELD if end.held else end.join for end in keys.ends)
            first = len(self.pieces)
            chain: list[Hashable] = [upper, *range(first, first + len(above)), lower]
            if keys.bottom.anchor is not None:
                chain[-2:] = [_SEABED]
            self.pieces += above
            self.chains.append(chain)
            force = lifts_of(leg.mooring.line, leg.mooring.water, leg)  # an anchor lifts nothing
            lifts.append(np.append(force, 0.0)[: len(above)])
        self.lifts = np.concatenate(lifts) if lifts else np.zeros(0)
        self.opened = {
            (number, at)
            for number, chain in enumerate(self.chains)
            for at, one in enumerate(chain)
            if isinstance(one, int) and self.pieces[one].component.role == "release"
        }

    @property
    def anchored(self) -> bool:
        """Return whether an anchor holds any of it."""
        return any(_SEABED in chain for chain in self.chains)

    def parts(self, cut: Collection[tuple[int, int]]) -> list[set[Hashable]]:
        """Return what still hangs together; `cut` are places of chains, below which it parts."""
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
        """The pieces of each part that nothing holds, down the file."""
        return [
            sorted(one for one in part if isinstance(one, int))
            for part in self.parts(cut)
            if not part & {_SEABED, _HELD}
        ]

    def _rising(self, cut: Collection[tuple[int, int]]) -> list[list[int]]:
        """The free parts that have a release, once all are opened."""
        return [
            part
            for part in self._free(self.opened | set(cut))
            if any(self.pieces[one].component.role == "release" for one in part)
        ]

    @property
    def coming_up(self) -> set[int]:
        """Return the pieces that come up once all releases open; without any, all but anchors."""
        parts = self._rising(()) if self.opened else self.chains
        return {one for part in parts for one in part if isinstance(one, int)}

    def breaks(self, whole: Mooring) -> tuple[Break, ...]:
        """Return the breaks below every piece that comes up, down the file.

        Of each it is judged what is left with a release, all releases being opened; `loose` is what
        comes off before that.
        """
        rising = {one for part in self._rising(()) for one in part}
        before = {one for part in self._free(()) for one in part}
        found = []
        for number, chain in enumerate(self.chains):
            for at, (one, below) in enumerate(pairwise(chain)):
                # nothing breaks below an end that hangs free, nor is a release's own end a break
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

    def _margin(self, part: list[int], whole: Mooring) -> tuple[float, float, float]:
        lift = self.lifts[part]
        weight = float(-lift[lift < 0.0].sum())
        return float(lift.sum()), weight, required_margin(whole, weight)

    def _beyond_help(self, chain: Sequence[Hashable], at: int, part: list[int]) -> bool:
        """Return whether it parts the cluster of all floats that are left, or what leads from it to
        the release: as of a single line.
        """
        floats = {one for one in part if self._floats(one)}
        if not floats:
            return all(self._is(one, "connector", "chain", "release") for one in part)
        below = list(takewhile(self._in_a_cluster, chain[at:]))
        return floats <= set(below[1:])

    def _in_a_cluster(self, one: Hashable) -> bool:
        return isinstance(one, int) and (self._floats(one) or self._is(one, "connector", "chain"))

    def _floats(self, one: int) -> bool:
        return bool(self.lifts[one] > 0.0) and not self._is(one, "cable")

    def _is(self, one: int, *what: str) -> bool:
        component = self.pieces[one].component
        return component.kind in what or component.role in what

    def losses(self, whole: Mooring) -> tuple[Loss, ...]:
        """Return the loss of each buoyant piece or clamp of what comes up."""
        return tuple(
            loss
            for part in self._rising(())
            for loss in losses_among(
                whole, [whole.file.pieces[one] for one in part], self.lifts[part]
            )
        )

    def release_verdicts(self) -> Iterator[Verdict]:
        """Return which floats no release frees from their anchors."""
        held = [
            self.pieces[one]
            for part in self.parts(self.opened)
            if _SEABED in part
            for one in sorted(each for each in part if isinstance(each, int))
            if self.lifts[one] > 0.0 and not isinstance(self.pieces[one].component, Flexible)
        ]
        for piece in held:
            message = f"No release lies between {piece.label} and an anchor that holds it."
            yield unknown(piece, message, "Give the release `role: release`.")
        if not held and self.opened:
            number, at = min(self.opened)
            one = self.chains[number][at]
            assert isinstance(one, int)
            told = "The releases free all that floats from its anchors."
            yield verdict_on(self.pieces[one], State.PASS, told)
