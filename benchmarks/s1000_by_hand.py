"""The mooring of `lines/s1000.yaml` by scipy alone: what one writes in an hour without CALM.

    python benchmarks/s1000_by_hand.py [--smoke]

`solve_ivp` carries position and force from the float down the cable, `brentq` finds the depth of
the float at which the cable's end meets the anchor. Prints the float and the anchor's load at
three tolerances, with `--smoke` at the coarsest alone.
"""

import sys

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

DEPTH = 1100.0
DENSITY = 1025.0
FLOAT_BUOYANCY = 4000.0
FLOAT_DRAG = 0.5 * DENSITY * 0.6
LENGTH = 1000.0
WEIGHT = 2.0
NORMAL_DRAG = 0.5 * DENSITY * 0.010 * 1.3
TANGENTIAL_DRAG = 0.5 * DENSITY * np.pi * 0.010 * 0.01
STIFFNESS = 4e6
CURRENT_DEPTH = np.array([0.0, 200.0, 500.0, 1100.0])
CURRENT_SPEED = np.array([1.0, 0.6, 0.2, 0.05])


def current(z: float) -> float:
    """Current [m/s] at the height z [m] above the surface."""
    return float(np.interp(-z, CURRENT_DEPTH, CURRENT_SPEED))


def slope(s: float, state: np.ndarray) -> list[float]:
    """Change of (x, z, force east, force up) per unstretched metre, down the cable."""
    _, z, east, up = state
    tension = np.hypot(east, up)
    strain = tension / STIFFNESS
    along_x, along_z = -east / tension, -up / tension
    speed = current(z)
    tangential = speed * along_x
    normal_x, normal_z = speed - tangential * along_x, -tangential * along_z
    normal = np.hypot(normal_x, normal_z)
    thinner = np.sqrt(1.0 + strain)
    drag_x = (
        NORMAL_DRAG * normal * normal_x + TANGENTIAL_DRAG * abs(tangential) * tangential * along_x
    )
    drag_z = (
        NORMAL_DRAG * normal * normal_z + TANGENTIAL_DRAG * abs(tangential) * tangential * along_z
    )
    return [
        (1.0 + strain) * along_x,
        (1.0 + strain) * along_z,
        thinner * drag_x,
        thinner * drag_z - WEIGHT,
    ]


def march(float_depth: float, tolerance: float) -> np.ndarray:
    """State at the anchor end of the cable hung from a float at `float_depth` [m]."""
    speed = current(-float_depth)
    start = [0.0, -float_depth, FLOAT_DRAG * speed * speed, FLOAT_BUOYANCY]
    solved = solve_ivp(slope, (0.0, LENGTH), start, rtol=tolerance, atol=tolerance)
    return solved.y[:, -1]


def solve(tolerance: float) -> tuple[float, float, float]:
    """Depth and offset of the float [m] and tension at the anchor [N]."""
    depth = brentq(
        lambda trial: march(trial, tolerance)[1] + DEPTH, 50.0, 400.0, xtol=tolerance * DEPTH
    )
    x, _, east, up = march(depth, tolerance)
    return depth, -x, float(np.hypot(east, up))


def main() -> None:
    """Print a row a tolerance."""
    print(f"{'tolerance':>10}{'depth':>12}{'offset':>12}{'tension':>12}")
    for tolerance in (1e-4,) if sys.argv[1:] == ["--smoke"] else (1e-4, 1e-8, 1e-12):
        depth, offset, tension = solve(tolerance)
        print(f"{tolerance:10.0e}{depth:10.4f} m{offset:10.4f} m{tension:10.3f} N")


if __name__ == "__main__":
    main()
