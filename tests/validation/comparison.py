"""One case of a family: CALM against the referee, at both speeds, and as one of many profiles.

Of a net the referee starts from CALM's answer, so that it says nothing of nets that CALM refuses.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from random import Random
from typing import Any

import numpy as np

from calm.errors import NoEquilibrium
from calm.physics.seabed import required_weight
from calm.solve import Settings, Solution
from calm.solve.net import NetSolution
from tests.validation.agreement import (
    Difference,
    apart,
    closure,
    difference,
    ends_of,
    inside_cables,
    integrated_ends,
    size_of,
)
from tests.validation.batched import in_company, net_in_company, net_run
from tests.validation.cables import Folded, NoContinuousSolution
from tests.validation.closing import Equilibrium
from tests.validation.families import FAMILIES, Case, MooringCase, NetCase, random_net
from tests.validation.towed import HalfOut, Towed

CONVERGED, NET = "converged", "net"


@dataclass(frozen=True)
class Comparison:
    """How a case of a family came out.

    Attributes
    ----------
    status : of CALM
    refusal : why the referee finds no equilibrium; empty where it finds one
    undecided : whether it is a shape that neither can be held against
    error : of CALM against the referee; None where one of them finds none
    place_ratio, tension_ratio, anchor_ratio, weight_ratio : true over stated error of the worst
        depth or offset and of the worst tension at the ends of pieces and at clamps, of the worse
        of the anchor's pulls, and of the weight that it needs
    inside_place_ratio, inside_tension_ratio : the same of the nodes inside hanging cables
    closure, marches : of CALM
    plain_differs : whether plain and compiled differ in a bit
    batch_status, batch : status and error against the run of the same profile among others; None
        of what is no mooring
    """

    status: str
    refusal: str
    undecided: bool
    error: Difference | None = None
    place_ratio: float = 0.0
    tension_ratio: float = 0.0
    anchor_ratio: float = 0.0
    weight_ratio: float = 0.0
    inside_place_ratio: float = 0.0
    inside_tension_ratio: float = 0.0
    closure: float = 0.0
    marches: int = 0
    plain_differs: bool = False
    batch_status: str | None = None
    batch: Difference | None = None


def compared(family: str, number: int) -> Comparison:
    """Compare a case of a family, or a net, by its number."""
    if family == NET:
        return _compared_net(random_net(Random(f"{family} {number}")))
    case = FAMILIES[family](Random(f"{family} {number}"))
    referee, refusal, undecided = _integrated(case)
    solution, status = _solved(case, compiled=True)
    plain, plain_status = _solved(case, compiled=False)
    found = Comparison(status, refusal, undecided)
    found = replace(
        found, plain_differs=(status, _bytes(solution)) != (plain_status, _bytes(plain))
    )  # fmt: skip
    if isinstance(case, MooringCase):
        found = _with_batch(found, case, solution)
    if solution is None or referee is None:
        return found
    if solution.other is not None and _stand_apart(solution, referee):
        return replace(found, refusal="CALM reports another equilibrium", undecided=True)
    error = difference(solution, referee)
    pull, weight = _at_the_anchor(solution, referee)
    inside = inside_cables(solution, referee)
    return replace(
        found,
        error=error,
        place_ratio=error.metres / solution.depth_error,
        tension_ratio=error.newtons / solution.tension_error,
        anchor_ratio=pull,
        weight_ratio=weight,
        inside_place_ratio=inside[0] / solution.depth_error,
        inside_tension_ratio=inside[1] / solution.tension_error,
        closure=closure(solution, case.profile),
        marches=solution.marches,
    )


def _integrated(case: Case) -> tuple[Equilibrium | Towed | None, str, bool]:
    try:
        return case.integrated(), "", False
    except (Folded, HalfOut) as none:
        return None, str(none), True
    except NoContinuousSolution as none:
        return None, str(none), False


def _compared_net(case: NetCase) -> Comparison:
    (found, status), (plain, plain_status) = (
        _solved(case, compiled=speed) for speed in (True, False)
    )
    differs = (status, _net_bytes(found)) != (plain_status, _net_bytes(plain))
    batch_status, ends = net_in_company(case.net)
    out = Comparison(status, "", False, plain_differs=differs, batch_status=batch_status)
    if found is None:
        return replace(out, refusal="not sought")
    if batch_status == CONVERGED:
        batch = apart(ends, net_run(case.net), case.net.water.depth)
        out = replace(out, batch=batch)
    try:
        expected = case.integrated(found)
    except NoContinuousSolution as none:
        return replace(out, refusal=str(none), undecided=True)
    legs = [ends_of(leg) for leg in found.legs]
    mine, its = (
        tuple(np.concatenate(parts) for parts in zip(*each, strict=True))
        for each in (legs, expected)
    )  # fmt: skip
    error = apart(mine, its, case.net.water.depth)
    return replace(
        out,
        error=error,
        place_ratio=error.metres / found.depth_error,
        tension_ratio=error.newtons / found.tension_error,
    )


def _net_bytes(found: NetSolution | None) -> bytes:
    return b"" if found is None else b"".join(map(_bytes, found.legs))


def _solved(case: Case | NetCase, *, compiled: bool) -> tuple[Any, str]:
    try:
        return case(Settings(compiled=compiled)), CONVERGED
    except NoEquilibrium as refusal:
        return None, refusal.status


def _stand_apart(solution: Solution, referee: Equilibrium | Towed) -> bool:
    """Whether of two equilibria CALM and the referee have each another one."""
    lands = referee.shape.grounded is not None
    off = np.abs(ends_of(solution)[0] - integrated_ends(referee.shape)[0]).max()
    return solution.landed != lands or bool(off > 1e-3 * size_of(solution))


def _bytes(solution: Solution | None) -> bytes:
    if solution is None:
        return b""
    stated = np.array([solution.depth_error, solution.tension_error])
    return solution.position.tobytes() + solution.force.tobytes() + stated.tobytes()


def _with_batch(found: Comparison, case: MooringCase, solution: Solution | None) -> Comparison:
    status, ends = in_company(case.line, case.water, case.settings(Settings()))
    batch = None
    if solution is not None and status == CONVERGED:
        batch = apart(ends, ends_of(solution), size_of(solution))
    return replace(found, batch_status=status, batch=batch)


def _at_the_anchor(solution: Solution, referee: Equilibrium | Towed) -> tuple[float, float]:
    """True over stated error of the pull on the anchor and of its needed weight; 0 of a tow."""
    if solution.line.towed:
        return 0.0, 0.0
    forces = solution.force[-1], referee.shape.force_bottom[-1]
    lift = abs(float(forces[0][2] - forces[1][2]))
    pull = abs(float(np.subtract(*(np.hypot(*force[:2]) for force in forces))))
    stated = max(solution.lift_error, solution.pull_error)
    needed = required_weight(solution.lift_error, solution.pull_error, 1.5, 0.6)
    return max(lift, pull) / stated, float(required_weight(lift, pull, 1.5, 0.6) / needed)
