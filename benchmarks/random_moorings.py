"""Thousands of random moorings against the continuous solution.

    python benchmarks/random_moorings.py [COUNT] [FIRST] [DEGREES]
    python benchmarks/random_moorings.py --smoke

COUNT moorings (1000), numbered from FIRST (0), at an angle step of DEGREES (1). Prints every
mooring that breaks a promise of CALM, with the number that draws it; then how the moorings ended,
the worst errors, the most marches, and how the solver's own estimate of its error did. About
three moorings a second; `--smoke` compares five.
"""

import sys
from collections import Counter
from math import radians
from pathlib import Path
from random import Random

import numpy as np
from machine import describe

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from calm.errors import NoEquilibrium
from calm.solve import Settings, solve_mooring
from tests.property.strategies import mooring
from tests.validation.agreement import closure, difference
from tests.validation.cables import Folded, NoContinuousSolution
from tests.validation.closing import solve_continuous

PLACE, TENSION, MARCHES, CLOSURE = 5e-5, 2e-4, 60, 1e-6
FIGURES = "place", "tension", "marches", "closure", "error/estimate"


def compare(number: int, degrees: float) -> tuple[str, list[float]]:
    """How one mooring ended, and its figures where both solutions exist."""
    line, water = mooring(Random(number))
    try:
        referee = solve_continuous(line, water)
    except Folded:
        return "neither: folded where it is slack", []
    except NoContinuousSolution as refusal:
        referee, reason = None, str(refusal)
    try:
        solution = solve_mooring(line, water, Settings(radians(degrees)))
    except NoEquilibrium as refusal:
        if referee is None:
            return f"neither: {reason} / {refusal.status}", []
        return f"CALM ALONE FAILS: {refusal}", []
    if referee is None:
        return f"THE REFEREE ALONE FAILS: {reason}", []
    found = difference(solution, referee)
    estimated = solution.depth_error / water.depth
    figures = [
        found.place, found.tension, solution.marches, closure(solution),
        found.place / max(estimated, 1e-8),
    ]  # fmt: skip
    scale = degrees**2  # errors are of second order; closing has a tolerance of its own
    limits = [PLACE * scale + 1e-7, TENSION * scale + 1e-6, MARCHES, CLOSURE, np.inf]
    broken = [
        f"{name} {figure:.3g}"
        for name, figure, limit in zip(FIGURES, figures, limits, strict=True)
        if figure > limit
    ]
    return f"BROKEN: {', '.join(broken)}" if broken else "agree", figures


def main(count: int = 1000, first: int = 0, degrees: float = 1.0) -> None:
    """Compare, and print what stands out."""
    print(describe("calm-mooring", "numpy", "scipy"))
    outcomes: Counter[str] = Counter()
    table = []
    for number in range(int(first), int(first) + int(count)):
        outcome, figures = compare(number, degrees)
        outcomes[outcome if outcome.startswith("neither") else outcome.partition(":")[0]] += 1
        if outcome != "agree" and not outcome.startswith("neither"):
            print(f"mooring {number}: {outcome}", flush=True)
        if figures:
            table.append(figures)
    for outcome, times in outcomes.most_common():
        print(f"{times:6d}  {outcome}")
    print(f"{'':16}{'median':>10}{'99 %':>10}{'worst':>10}")
    for name, column in zip(FIGURES, np.array(table).T, strict=True):
        median, most, worst = np.percentile(column, [50, 99, 100])
        print(f"{name:16}{median:10.2g}{most:10.2g}{worst:10.2g}")


if __name__ == "__main__":
    main(*([5.0] if sys.argv[1:] == ["--smoke"] else map(float, sys.argv[1:])))
