"""Seconds and memory of `calm waves` for a sea and for sixty, beside the equilibrium.

python benchmarks/waves.py [--smoke]
"""

import resource
import sys
import time
from pathlib import Path

from machine import describe

import calm
from calm.records.sea_states import spectrum_of
from calm.waves.analysis import analyse

LINE = Path(__file__).parents[1] / "tests" / "validation" / "sofs5.yaml"


def main() -> None:
    """Print the times of one sea and of sixty, as the least of three runs."""
    smoke = "--smoke" in sys.argv
    print(describe("numpy"))
    mooring = calm.load(LINE)
    seas = [
        spectrum_of("bretschneider", 0.5 + 0.5 * (number % 12), 6.0 + number // 12, 3.3)
        for number in range(2 if smoke else 60)
    ]
    solve = least(lambda: calm.load(LINE).solve(), 1 if smoke else 3)
    one = least(lambda: analyse(mooring.leg, seas[-1:], 90.0), 1 if smoke else 3)
    table = least(lambda: analyse(mooring.leg, seas, 90.0), 1)
    print(f"equilibrium {solve:.2f} s, one sea {one:.2f} s ({one / solve:.1f} times that)")
    megabytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"greatest memory of the process {megabytes:.0f} MB")
    print(f"{len(seas)} seas {table:.1f} s, {table / len(seas):.2f} s each")


def least(work, times):
    """Return the least time of a piece of work [s]."""
    found = []
    for _ in range(times):
        begin = time.perf_counter()
        work()
        found.append(time.perf_counter() - begin)
    return min(found)


if __name__ == "__main__":
    main()
