"""Many current profiles of one mooring: solves a second, accuracy, and scipy by hand.

    python benchmarks/profiles.py [PROFILES] [CHECKED] [CHECKOUT]

PROFILES of every mooring (8192), of which CHECKED (24) are solved again at a tenth of the angle
step. The currents are sheared and turn with depth; the best of three runs counts, after one that
compiles. Prints the rate on one thread and on two; then that under every other law of the manual.
CHECKOUT is the folder of another version, with its own `.venv`, whose rates are measured first, by
its own copy of this program.
"""

import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from math import radians
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np
from machine import describe

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import s1000_by_hand as by_hand

from calm.batch.profiles import Batch, Profiles
from calm.case import Design, load
from calm.case.measure import components_of
from calm.physics.line import Floats, Water
from calm.shipped import shipped_folder
from calm.solve import solve_mooring

LEVELS = 50
MOORINGS = (
    "deep-current-meters", "s1000", "upward-adcp-300m", "taut-nylon-surface",
    "chain-and-rope-surface", "braconnot-buoy",
)  # fmt: skip
Arrays = tuple[np.ndarray, ...]


def currents(mooring: Design, count: int, seed: int = 1) -> Arrays:
    """Depths and u, v, w: the file's current, 0.3 to 1.5 times, turned by depth and ragged."""
    rng = np.random.default_rng(seed)
    water = mooring.water
    depth = np.linspace(0.0, water.depth, LEVELS)
    u, v = (np.interp(depth, water.level, part) for part in (water.u, water.v))
    size = rng.uniform(0.3, 1.5, (count, 1)) * (1.0 + 0.03 * rng.normal(size=(count, LEVELS)))
    angle = rng.uniform(0.0, 2.0 * np.pi, (count, 1))
    angle = angle + rng.uniform(-0.6, 0.6, (count, 1)) * depth / water.depth
    sine, cosine = np.sin(angle), np.cos(angle)
    return depth, size * (u * cosine - v * sine), size * (u * sine + v * cosine), 0.0 * size


def best(solve: Callable[[], object], runs: int = 5) -> float:
    """Seconds of the fastest run."""
    times = []
    for _ in range(runs):
        start = perf_counter()
        solve()
        times.append(perf_counter() - start)
    return min(times)


def water_of(base: Water, depth: Floats, u: Floats, v: Floats, w: Floats) -> Water:
    """A water with a profile's current."""
    levels = np.union1d(base.level, depth)
    current, density = base.current_at(levels), base.density_at(levels)
    parts = [np.interp(levels, depth, part) + current[:, i] for i, part in enumerate((u, v, w))]
    return replace(base, level=levels, u=parts[0], v=parts[1], w=parts[2], density=density)


def arrays_rate(batch: Batch, current: Arrays, workers: int) -> float:
    """Solves a second of all that a batch does."""
    depth, u, v, w = current
    return len(u) / best(lambda: batch.solve(u, v, depth, w, workers=workers), 3)


def errors(mooring: Design, base: Water, current: Arrays, found: Profiles, count: int) -> list[str]:
    """Worst differences from `calm run` at its usual angle step and at a tenth of it."""
    depth, u, v, w = current
    lines = []
    for degrees in (1.0, 0.1):
        place = tension = 0.0
        for case in range(count):
            water = water_of(base, depth, u[case], v[case], w[case])
            settings = replace(mooring.settings, angle_step=radians(degrees))
            exact = components_of(
                mooring.file.pieces[:-1],
                solve_mooring(mooring.line, water, settings)
                if degrees < 1.0
                else mooring.leg.equilibrium(water),
            )
            for name in ("depth_top", "x_top", "y_top"):
                off = getattr(found, name)[case, :-1] - getattr(exact, name)
                place = max(place, float(np.abs(off).max()) / water.depth)
            off = found.tension_bottom[case, :-1] / exact.tension_bottom - 1.0
            tension = max(tension, float(np.abs(off).max()))
        lines.append(f"{place:8.1e} of the depth, {tension:8.1e} of the tension at {degrees:g}°")
    return lines


def by_scipy(count: int = 20) -> float:
    """Solves a second of S1000 by scipy alone, at 1e-6, in currents of growing speed."""
    speeds = by_hand.CURRENT_SPEED
    start = perf_counter()
    for factor in np.linspace(0.3, 1.2, count):
        by_hand.CURRENT_SPEED = factor * speeds
        by_hand.solve(1e-6)
    by_hand.CURRENT_SPEED = speeds
    return count / (perf_counter() - start)


def rates_of(checkout: Path, profiles: str) -> dict[str, float]:
    """Solves a second of another version on one thread, by mooring."""
    python = checkout / ".venv" / "bin" / "python"
    program = checkout / "benchmarks" / Path(__file__).name
    printed = subprocess.run(
        [python, program, profiles, "1"], check=True, capture_output=True, text=True
    ).stdout
    found: dict[str, float] = {}
    name = ""
    for line in printed.splitlines():
        if ": " in line and "pieces" in line:
            name = line.split(":")[0]
        elif "1 threads" in line:
            found.setdefault(name, float(line.split()[-2]))
    return found


LINE = """\
  - {use: float}
  - {use: cable, length: 1000 m}"""
TWO_FLOATS = """\
  - {use: float}
  - {use: cable, length: 100 m}
  - {use: float}
  - {use: cable, length: 1150 m}"""
LAWS = {
    "friction: hoerner": ("", "solver: {friction: hoerner}", LINE),
    "friction: constant": ("", "solver: {friction: constant}", LINE),
    "elongation table": (
        "breaking_load: 60 kN\n    elongation: [[0.05, 0.001], [0.2, 0.003], [0.5, 0.006]]",
        "",
        LINE,
    ),
    "drag: reynolds": ("", "solver: {drag: reynolds}", LINE),
    "two floats afloat": ("", "", TWO_FLOATS),
}
"""What stands in S1000 in place of its stiffness, below it, and for its line."""


def s1000_with(stretch: str, solver: str, line: str) -> Design:
    """S1000, its float a smooth sphere, under another law."""
    text = (shipped_folder("lines") / "s1000.yaml").read_text(encoding="utf-8")
    text, _, _ = text.partition("\nchecks:\n")  # what it accepts names the pieces of its line
    text = text.replace(LINE, line)
    text = text.replace("stiffness: 4000 kN", stretch or "stiffness: 4000 kN")
    text = text.replace("kind: body\n    length: 0 m", "kind: sphere\n    diameter: 1.2 m")
    text = text.replace("    drag_area: 0.6 m^2\n    cd: 1\n", "    surface: smooth\n")
    with TemporaryDirectory() as folder:
        path = Path(folder) / "s1000.yaml"
        path.write_text(f"{text}{solver}\n", encoding="utf-8")
        found = load(path)
        assert found.line.length.size
    return found


def main(profiles: str = "8192", checked: str = "24", checkout: str = "") -> None:
    """Measure some moorings."""
    print(describe("calm-mooring", "llvmlite", "numpy", "scipy"))
    others = rates_of(Path(checkout), profiles) if checkout else {}
    for name in MOORINGS:
        mooring = load(shipped_folder("lines") / f"{name}.yaml")
        batch = Batch(mooring)
        current = currents(mooring, int(profiles))
        depth, u, v, w = current
        start = perf_counter()
        batch.solve(u[:1], v[:1], depth, w[:1])
        print(f"\n{name}: {len(mooring.line.length)} pieces, {LEVELS} levels")
        print(f"  first profile {perf_counter() - start:.1f} s")
        for workers in (1, 2):
            rate = arrays_rate(batch, current, workers)
            print(f"  {workers} threads  {rate:9.0f} solves/s")
        if name in others:
            print(f"  1 thread of {checkout}  {others[name]:9.0f} solves/s")
        few = int(checked)
        found = batch.solve(u[:few], v[:few], depth, w[:few])
        for line in errors(mooring, batch.water, current, found, few):
            print(f"  off by {line}")
    print("\nS1000 under other laws, 1 thread")
    for name, law in {"constant drag": ("", "", LINE), **LAWS}.items():
        mooring = s1000_with(*law)
        current = currents(mooring, int(profiles) // 4)
        rate = arrays_rate(Batch(mooring), current, 1)
        print(f"  {name:20} {rate:9.0f} solves/s")
    print(f"\nS1000 by scipy alone at 1e-6: {by_scipy():.0f} solves/s")


if __name__ == "__main__":
    main(*(["256", "2"] if sys.argv[1:] == ["--smoke"] else sys.argv[1:]))
