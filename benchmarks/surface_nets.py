"""Random surface buoys on several legs: how many are solved in still water and in a current, and
whether they are the same turned, mirrored, and with their legs listed the other way round.

    python benchmarks/surface_nets.py [CASES] [FIRST]
    python benchmarks/surface_nets.py --smoke

CASES (80), numbered from FIRST (0). Prints those that are refused, with the reason; slack legs; the
greatest difference between a net and its images, as a share of the depth; seconds of the processor.
"""

import sys
from pathlib import Path
from time import process_time

import numpy as np
from machine import describe

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from calm.case import Result, load
from calm.errors import NoEquilibrium
from tests.validation.surface_nets import SurfaceNet, surface_net

TURN = 1.1
TURNED = np.array([[np.cos(TURN), -np.sin(TURN)], [np.sin(TURN), np.cos(TURN)]])
MIRRORED = np.diag([1.0, -1.0])


def solve(net: SurfaceNet) -> Result | NoEquilibrium:
    """The result, or why there is none."""
    mooring = load("surface-net.yaml", text=net.text)
    try:
        return mooring.solve()
    except NoEquilibrium as failure:
        return failure


def node(result: Result) -> np.ndarray:
    """Where its node is."""
    (at,) = result.nodes
    return np.array([at.x, at.y, -at.depth])


def main(cases: str = "80", first: str = "0") -> None:
    """Solve nets and their images."""
    print(describe("calm-mooring", "numpy"))
    numbers = range(int(first), int(first) + int(cases))
    found: dict[int, Result] = {}
    for water in ("still", "current"):
        begun, solved, slack, drifting = process_time(), 0, 0, 0
        for number in numbers:
            net = surface_net(number)
            result = solve(net if water == "current" else net.still())
            if isinstance(result, NoEquilibrium):
                drifting += result.status == "slack"
                print(f"{water}, net {number}: {result}"[:170])
                continue
            solved += 1
            slack += any(" is slack: " in said for said in result.warnings)
            if water == "current":
                found[number] = result
        print(
            f"{water}: {solved} of {len(numbers)} solved, {slack} with slack legs; "
            f"{drifting} that nothing holds sideways; "
            f"{process_time() - begun:.1f} s",
            flush=True,
        )
    lost, worst = 0, (0.0, -1, "")
    for number, result in found.items():
        net, mirror = surface_net(number), TURNED @ MIRRORED
        images = (
            ("turned", net.placed(TURNED), TURNED),
            ("mirrored", net.placed(mirror), mirror),
            ("reordered", net.reordered(), np.eye(2)),
        )
        for name, image, matrix in images:
            other = solve(image)
            if isinstance(other, NoEquilibrium):
                lost += 1
                print(f"{name}, net {number}: {other}"[:170])
                continue
            expected = node(result)
            expected[:2] = matrix @ expected[:2]
            off = float(np.abs(node(other) - expected).max()) / net.depth
            if off > 1e-6:
                print(f"{name}, net {number}: {off:.2g} of the depth off")
            worst = max(worst, (off, number, name))
    print(
        f"images: {lost} of {3 * len(found)} lost; at most {worst[0]:.2g} of the depth off "
        f"(net {worst[1]}, {worst[2]})"
    )


if __name__ == "__main__":
    main(*(["2"] if sys.argv[1:] == ["--smoke"] else sys.argv[1:]))
