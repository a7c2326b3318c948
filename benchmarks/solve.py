"""How long a solve takes at either speed, how much work it is, and how good its answer is.

    python benchmarks/solve.py [--smoke] [--package FOLDER]

Every shipped mooring and tow at its own settings, against the same line at an angle step of 0.05°
(its error is 400 times smaller); then S1000 against scipy alone, both against scipy at 1e-12.
`plain` is the solver as it stands, `compiled` by LLVM. `--smoke` does a little of everything in
seconds. `--package` measures the CALM of another folder with the same script.
"""

import argparse
import os
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import radians
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import s1000_by_hand
from machine import describe

HERE = Path(__file__).resolve().parents[1]
Answer = TypeVar("Answer")


def fastest(job: Callable[[], Answer], repetitions: int) -> tuple[float, Answer]:
    """Milliseconds of the fastest of some repetitions, and what the job returns."""
    times = []
    for _ in range(repetitions):
        start = time.perf_counter()
        answer = job()
        times.append(time.perf_counter() - start)
    return 1000.0 * min(times), answer


def departure(solution: Any, reference: Any, span: float) -> tuple[float, float]:
    """Worst difference at the ends of all pieces: of depths and offsets as a share of the span,
    of tensions as a share of the tension."""
    nodes, same = solution.piece_nodes, reference.piece_nodes
    position = np.abs(solution.position[nodes] - reference.position[same]).max()
    pull = reference.tension[same]
    pulled = pull > 1e-3 * pull.max()
    tension = np.abs(solution.tension[nodes] - pull)[pulled] / pull[pulled]
    return float(position / span), float(tension.max())


def at_either_speed(job: Callable[[], Any], repetitions: int) -> tuple[float, float]:
    """Milliseconds as the solver stands, and compiled."""
    os.environ["CALM_COMPILED"] = "never"
    plain, _ = fastest(job, repetitions)
    os.environ["CALM_COMPILED"] = "always"
    job()  # fetches or compiles
    compiled, _ = fastest(job, repetitions)
    os.environ["CALM_COMPILED"] = "never"
    return plain, compiled


def solver_of(line: Any) -> tuple[Callable[[Any], Any], float]:
    """What solves a mooring or a tow at some settings, and its span [m]."""
    from calm.solve import solve_mooring, solve_tow

    if line.towed:
        span = float(line.line.length.sum())
        return partial(solve_tow, line.line, line.water, line.leg.towing), span
    return partial(solve_mooring, line.line, line.water), line.water.depth


def shipped_lines(lines: list[Path], repetitions: int) -> None:
    """Print one row a mooring or tow."""
    import calm
    from calm.solve import Settings

    print(
        f"\n{'line':30}{'segments':>9}{'marches':>9}{'plain':>10}{'compiled':>10}{'result':>10}"
        f"{'estimate':>12}{'error':>10}{'error T/T':>11}"
    )
    for path in lines:
        line = calm.load(path)
        given = line.file.solver
        settings = Settings(given.angle_step, given.tolerance, given.seabed_friction)
        solve, span = solver_of(line)
        reference, solution = solve(replace(settings, angle_step=radians(0.05))), solve(settings)
        plain, compiled = at_either_speed(partial(solve, settings), repetitions)
        whole, _ = fastest(line.solve, repetitions)
        depth_error, tension_error = departure(solution, reference, span)
        fast = f"{compiled:7.2f} ms"
        print(
            f"{path.stem:30}{solution.segments:9d}{solution.marches:9d}{plain:7.1f} ms{fast}"
            f"{whole:7.1f} ms{solution.depth_error / span:12.1e}{depth_error:10.1e}"
            f"{tension_error:11.1e}"
        )
    print(
        "plain, compiled: with its own accuracy estimate; result: plain, with the shape in still "
        "water and the columns of the result. Estimate and error: of depths and offsets, over the "
        "water depth or the line out"
    )


def against_scipy(repetitions: int) -> None:
    """Print S1000 by CALM and by scipy alone, in one run."""
    import calm
    from calm.solve import Settings, solve_mooring

    exact = np.array(s1000_by_hand.solve(1e-12))
    mooring = calm.load(HERE / "lines" / "s1000.yaml")

    def by_calm(degrees: float) -> Callable[[], tuple[float, float, float]]:
        def job() -> tuple[float, float, float]:
            settings = Settings(radians(degrees), mooring.file.solver.tolerance)
            solution = solve_mooring(mooring.line, mooring.water, settings)
            x, _, z = solution.position[0]
            return -z, float(x), float(solution.tension[-1])

        return job

    print(f"\n{'S1000':30}{'time':>10}{'depth':>12}{'offset':>12}{'tension':>12}")
    print(f"{'scipy, 1e-12':30}{'':10}{exact[0]:10.4f} m{exact[1]:10.4f} m{exact[2]:10.3f} N")

    def row(name: str, spent: float, answer: Any) -> None:
        error = np.array(answer) - exact
        print(f"{name:30}{spent:7.2f} ms{error[0]:+12.5f}{error[1]:+12.5f}{error[2]:+12.5f}")

    times = {}
    for step in (1.0, 0.5, 0.1):
        job = by_calm(step)
        plain, compiled = at_either_speed(job, repetitions)
        times[step] = compiled
        row(f"CALM, {step}°", plain, job())
        row(f"CALM, {step}°, compiled", compiled, job())
    for tolerance in (1e-4, 1e-6, 1e-8):
        spent, answer = fastest(partial(s1000_by_hand.solve, tolerance), repetitions)
        times[tolerance] = spent
        row(f"scipy by hand, {tolerance:.0e}", spent, answer)
    print(f"CALM at 1° takes {times[1.0] / times[1e-6]:.3f} of the time of scipy at 1e-6")


def main() -> None:
    """Print all figures."""
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("--smoke", action="store_true", help="two lines, two repetitions")
    words.add_argument("--package", type=Path, default=HERE, help="where the CALM to measure is")
    given = words.parse_args()
    sys.path.insert(0, str(given.package.resolve()))
    lines = sorted((HERE / "lines").glob("*.yaml"))
    if given.smoke:
        lines = [path for path in lines if path.stem in ("s1000", "bourget-marichal-sphere")]
    print(describe("calm-mooring", "numpy", "scipy"))
    shipped_lines(lines, 2 if given.smoke else 20)
    against_scipy(2 if given.smoke else 20)


if __name__ == "__main__":
    main()
