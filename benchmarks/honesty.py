"""True over stated error on random moorings and tows of every family.

    python benchmarks/honesty.py [CASES] [FIRST] [FAMILY ...]
    python benchmarks/honesty.py --smoke

CASES a family (50), numbered from FIRST (1). Prints quantiles of the ratios, of depths and offsets
and of tensions, at the ends of pieces and clamps and at the nodes inside the cables; the numbers of
the worst; and what counts for nothing, by its reason. About eight cases a second; `--smoke`
measures one a family.
"""

import sys
from collections import Counter
from dataclasses import astuple
from pathlib import Path

import numpy as np
from machine import describe

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tests.validation.families import FAMILIES
from tests.validation.honesty import Honesty, honesty

QUANTILES = 50, 90, 95, 99, 100
MEASURES = (
    "place", "tension", "place inside cables", "tension inside cables", "anchor", "needed weight",
)  # fmt: skip


def measure(family: str, cases: int, first: int) -> None:
    """Print the table of one family."""
    numbers, ratios, others = [], [], Counter[str]()
    for number in range(first, first + 20 * cases):
        outcome = honesty(family, number)
        if isinstance(outcome, Honesty):
            numbers.append(number)
            ratios.append(astuple(outcome))
        else:
            others[outcome] += 1
        if len(numbers) == cases:
            break
    print(f"\n{family}: {len(numbers)} cases; left out: {dict(others)}")
    for name, column in zip(MEASURES, np.array(ratios).T, strict=True):
        quantiles = "".join(f"{q:9.3g}" for q in np.percentile(column, QUANTILES))
        worst = int(np.argmax(column))
        print(f"  {name:24}{quantiles}   worst: {numbers[worst]}", flush=True)


def main(cases: str = "50", first: str = "1", *families: str) -> None:
    """Measure every family, or some."""
    print(describe("calm-mooring", "numpy", "scipy"))
    print("quantiles:", *(f"{q} %" for q in QUANTILES))
    for family in families or FAMILIES:
        measure(family, int(cases), int(first))


if __name__ == "__main__":
    main(*(["1"] if sys.argv[1:] == ["--smoke"] else sys.argv[1:]))
