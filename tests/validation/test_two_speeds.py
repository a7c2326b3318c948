"""The solver as it stands and compiled: the same digits, to the last bit.

Both are of one source; what could differ is what each takes for √, log, sin or a power, and the
liberties of a compiler. So they are compared over every law there is: the shipped lines with all
that a result holds, random moorings and tows of every family, and lines that fall and rise.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import fields, replace
from random import Random
from typing import Any

import numpy as np
import pytest

import calm
from calm.errors import NoEquilibrium
from calm.physics.drag import Friction
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
