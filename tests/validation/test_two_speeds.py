"""The solver as it stands and compiled: the same digits, to the last bit.

Both are of one source; what could differ is what each takes for √, log, sin or a power, and the
liberties of a compiler. So they are compared over every law there is: the shipped lines with all
that a result holds, random moorings and tows of every family, and lines that fall and rise.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import fields, replace
from math import inf
from random import Random
from typing import Any

import numpy as np
import pytest

import calm
from calm.errors import NoEquilibrium
from calm.physics.cable import pass_segment
from calm.physics.compiled import outcome, packed
from calm.physics.drag import Friction
from calm.physics.law_kinds import record_type
from calm.physics.line import NO_BALANCE
from calm.physics.profile import Interval, Sea
from calm.physics.stretch import Knot
from calm.physics.strumming import AT_REST
from calm.physics.track import CableStretch
from calm.shipped import shipped_folder
from calm.solve import Settings, Solution, solve_mooring, solve_rise
from tests.validation.families import FAMILIES

SHIPPED = sorted(shipped_folder("lines").glob("*.yaml"))


def both(answer: Callable[[], Any]) -> tuple[Any, Any]:
    """What comes of it at either speed."""
    answers = []
    with pytest.MonkeyPatch.context() as patch:
        for wish in ("never", "always"):
            patch.setenv("CALM_COMPILED", wish)
            answers.append(answer())
    return answers[0], answers[1]


def digits(solve: Callable[[], Solution]) -> dict[str, Any]:
    """All numbers of a solution, or why there is none."""
    try:
        solution = solve()
    except NoEquilibrium as failure:
        return {"status": failure.status, "message": str(failure)}
    values = {column.name: getattr(solution, column.name) for column in fields(solution)}
    if (marched := values.pop("marched")) is not None:
        values |= {
            f"marched {column.name}": getattr(marched, column.name) for column in fields(marched)
        }
    return {
        name: value.tobytes() if isinstance(value, np.ndarray) else value
        for name, value in values.items()
        if name not in ("line", "water", "settings", "carried")
    }


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
@pytest.mark.thorough
def test_a_result_is_the_same_text(path) -> None:
    plain, compiled = both(lambda: json.dumps(calm.load(path).solve().to_dict()))
    assert plain == compiled


@pytest.mark.parametrize("family", FAMILIES)
def test_random_lines_are_the_same(family) -> None:
    for number in range(3):
        case = FAMILIES[family](Random(number))
        plain, compiled = both(lambda case=case: digits(lambda: case(Settings())))
        assert plain == compiled, number


@pytest.mark.parametrize("friction", [Friction.HOERNER, Friction.CONSTANT])
def test_other_laws_of_friction_are_the_same(friction) -> None:
    mooring = calm.load(shipped_folder("lines") / "chain-and-rope-surface.yaml")
    line = replace(mooring.line, friction=friction)
    plain, compiled = both(lambda: digits(lambda: solve_mooring(line, mooring.water)))
    assert plain == compiled
    assert "position" in plain


def test_lines_that_rise_are_the_same() -> None:
    mooring = calm.load(shipped_folder("lines") / "cdms-1.yaml")
    line, water = mooring.line, mooring.water
    plain, compiled = both(lambda: digits(lambda: solve_rise(line, water, 100.0).solution))
    assert plain == compiled
    assert "position" in plain


def segment_in_thin_shear(random: Random) -> tuple[Any, ...]:
    """Arguments of `pass_segment` for a segment beside a thin layer that turns the current over."""
    top, thick = random.uniform(0.5, 2.0), 10.0 ** random.uniform(-3.0, 0.0)
    far, at_top, below = (random.uniform(-3.0, 3.0) for _ in range(3))
    currents = [(0.0, far, 0.0), (top, at_top, (below - at_top) / thick), (top + thick, below, 0.0)]
    intervals = [Interval(z, u, du, 0.0, 0.0, 0.0, 0.0, 1025.0, 0.0) for z, u, du in currents]
    sea = Sea([-inf, top, top + thick, inf], intervals, [1.0] * 4, 9.81, [])
    net, drag = random.uniform(-90.0, 90.0), 10.0 ** random.uniform(0.0, 3.0)
    cable = CableStretch(0, 10.0, net, 0.0, drag, 0.1, 0.0, 0.5, 0, 0, 0, 0.0)
    pull, above = 10.0 ** random.uniform(-1.0, 2.0), random.uniform(-0.2, 1.5)
    state = (0.0, 0.0, above - top, random.uniform(-pull, pull), 0.0, -pull, 0.0, 0)
    return cable, [], AT_REST, sea, state, random.uniform(0.1, 3.0), 0.0, (0.0, 0.0, 0.0)


def test_segments_without_balance_are_the_same() -> None:
    random, unbalanced = Random(1), 0
    for _ in range(1000):
        cable, knots, vibration, sea, *others = segment_in_thin_shear(random)
        plain = pass_segment(cable, knots, vibration, sea, *others)
        none: Any = np.zeros(0, record_type(Knot))
        assert outcome(pass_segment, True, cable, none, vibration, packed(sea), *others) == plain
        unbalanced += plain[1] == NO_BALANCE
    assert unbalanced > 10
