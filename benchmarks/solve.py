"""How long a solve takes, how much work it is, and how good its answer and its own estimate are.

    python benchmarks/solve.py

Every shipped mooring at its own settings, against the same mooring at an angle step of 0.05°
(its error is 400 times smaller); then S1000 against scipy alone, both against scipy at 1e-12.
"""

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import radians
from pathlib import Path
from typing import TypeVar

import numpy as np
import s1000_by_hand
from machine import describe

import calm
from calm.solve import Settings, Solution, solve_mooring

LINES = Path(__file__).resolve().parents[1] / "lines"
REPETITIONS = 20
Answer = TypeVar("Answer")


def fastest(job: Callable[[], Answer]) -> tuple[float, Answer]:
    """Milliseconds of the fastest of some repetitions, and what the job returns."""
    times = []
    for _ in range(REPETITIONS):
        start = time.perf_counter()
        answer = job()
        times.append(time.perf_counter() - start)
    return 1000.0 * min(times), answer


def departure(solution: Solution, reference: Solution) -> tuple[float, float]:
    """Worst difference at the ends of all pieces: of depths and offsets as a share of the water
    depth, of tensions as a share of the tension."""
    nodes, same = solution.piece_nodes, reference.piece_nodes
    position = np.abs(solution.position[nodes] - reference.position[same]).max()
    pull = reference.tension[same]
    pulled = pull > 1e-3 * pull.max()
    tension = np.abs(solution.tension[nodes] - pull)[pulled] / pull[pulled]
    return float(position / solution.water.depth), float(tension.max())


def shipped_moorings() -> None:
    """Print one row a mooring."""
    print(
        f"\n{'mooring':30}{'segments':>9}{'marches':>9}{'solve':>10}{'result':>10}"
        f"{'estimate/H':>12}{'error/H':>10}{'error T/T':>11}"
    )
    for path in sorted(LINES.glob("*.yaml")):
        mooring = calm.load(path)
        solver = mooring.file.solver
        settings = Settings(solver.angle_step, solver.tolerance)
        fine = replace(settings, angle_step=radians(0.05))
        reference = solve_mooring(mooring.line, mooring.water, fine)
        solving, solution = fastest(partial(solve_mooring, mooring.line, mooring.water, settings))
        whole, _ = fastest(mooring.solve)
        depth_error, tension_error = departure(solution, reference)
        estimate = solution.depth_error / mooring.water.depth
        print(
            f"{path.stem:30}{solution.segments:9d}{solution.marches:9d}{solving:7.1f} ms"
            f"{whole:7.1f} ms{estimate:12.1e}{depth_error:10.1e}{tension_error:11.1e}"
        )
    print(
        "solve: with its own accuracy estimate; result: with the shape in still water and the "
        "columns of the result"
    )


def against_scipy() -> None:
    """Print S1000 by CALM and by scipy alone, in one run."""
    exact = np.array(s1000_by_hand.solve(1e-12))
    mooring = calm.load(LINES / "s1000.yaml")

    def by_calm(degrees: float) -> Callable[[], tuple[float, float, float]]:
        def job() -> tuple[float, float, float]:
            settings = Settings(radians(degrees), mooring.file.solver.tolerance)
            solution = solve_mooring(mooring.line, mooring.water, settings)
            x, _, z = solution.position[0]
            return -z, float(x), float(solution.tension[-1])

        return job

    print(f"\n{'S1000':30}{'time':>10}{'depth':>12}{'offset':>12}{'tension':>12}")
    print(f"{'scipy, 1e-12':30}{'':10}{exact[0]:10.4f} m{exact[1]:10.4f} m{exact[2]:10.3f} N")
    rows = {f"CALM, {step}°": by_calm(step) for step in (1.0, 0.5, 0.1)}
    rows |= {
        f"scipy by hand, {tolerance:.0e}": lambda tolerance=tolerance: s1000_by_hand.solve(
            tolerance
        )
        for tolerance in (1e-4, 1e-6, 1e-8)
    }
    times = {}
    for name, job in rows.items():
        times[name], answer = fastest(job)
        error = np.array(answer) - exact
        print(f"{name:30}{times[name]:7.1f} ms{error[0]:+12.5f}{error[1]:+12.5f}{error[2]:+12.5f}")
    ratio = times["CALM, 1.0°"] / times["scipy by hand, 1e-06"]
    print(f"CALM at 1° takes {ratio:.2f} of the time of scipy at 1e-6")


if __name__ == "__main__":
    print(describe("calm-mooring", "numpy", "scipy"))
    shipped_moorings()
    against_scipy()
