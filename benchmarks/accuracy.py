"""CALM against an independent integration, at both speeds, alone and as one of many profiles.

    python benchmarks/accuracy.py
    python benchmarks/accuracy.py CASES [FIRST] [FAMILY ...]
    python benchmarks/accuracy.py --smoke

Without arguments the sweep: as many cases as `SWEEP` says of each of its families. CASES are those
of every family, or of some, numbered from FIRST (1). Of each family it prints how many were
compared and why others were not; statuses that differ; quantiles of the true error, as shares of
the depth (of a tow of the line out) and of the tension; which share of the stated errors covers the
true one, and the numbers of those that are off by more than three times; promises that are broken;
and the same of `batch`, the profile among others, against `run`. One to four cases a second;
`--smoke` compares one a family.
"""

import sys
from collections import Counter
from pathlib import Path

import numpy as np
from machine import describe

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tests.validation.comparison import CONVERGED, NET, Comparison, compared
from tests.validation.families import FAMILIES

SWEEP = {"mooring": 600, "stepped": 40, "tow": 100, "tow, strumming": 40, "net": 100}
QUANTILES = 50, 90, 99, 100
MARCHES, CLOSURE = 60, 1e-6
PROMISED, OF_BATCH = (5e-5, 2e-4), (1e-4, 2e-4)
"""Of places and of tensions: against the integration, and of a batch against a run."""
MEASURES = {
    "place": "place_ratio",
    "tension": "tension_ratio",
    "place inside cables": "inside_place_ratio",
    "tension inside cables": "inside_tension_ratio",
    "pull on the anchor": "anchor_ratio",
    "needed weight": "weight_ratio",
}
Numbered = list[tuple[int, Comparison]]


def measure(family: str, cases: int, first: int) -> None:
    """Print what comes out for one family."""
    found = [(number, compared(family, number)) for number in range(first, first + cases)]
    held = [(number, one) for number, one in found if one.error is not None]
    print(f"\n{family}: {len(held)} of {len(found)} compared")
    print_statuses(found)
    if held:
        print(f"  {'':32}" + "".join(f"{q:>8} %" for q in QUANTILES) + "   worst")
        errors = [(number, one.error) for number, one in held if one.error]
        for what in ("place", "tension"):
            print_quantiles(f"true error, {what}", [(n, getattr(e, what)) for n, e in errors])
        print_coverage(held)
        print_broken(held)
    differing = [number for number, one in found if one.plain_differs]
    print(f"  plain and compiled differ: {differing or 'none'}")
    print_batch(found)
    sys.stdout.flush()


def print_statuses(found: Numbered) -> None:
    """Why cases were not compared."""
    others: Counter[str] = Counter()
    for number, one in found:
        if one.undecided:
            others[f"the integration cannot decide: {one.refusal}; CALM: {one.status}"] += 1
        elif one.refusal and one.status != CONVERGED:
            others[f"neither: {one.refusal}; CALM: {one.status}"] += 1
        elif one.refusal:
            print(f"  {number}: CALM ALONE HAS A SHAPE; the integration: {one.refusal}")
        elif one.status != CONVERGED:
            print(f"  {number}: CALM ALONE FAILS: {one.status}")
    for reason, times in others.most_common():
        print(f"  {times:4d}  {reason}")


def print_quantiles(name: str, values: list[tuple[int, float]]) -> None:
    """One line of the table."""
    numbers, column = zip(*values, strict=True)
    quantiles = "".join(f"{q:10.2g}" for q in np.percentile(column, QUANTILES))
    print(f"  {name:32}{quantiles}   {numbers[int(np.argmax(column))]}")


def print_coverage(held: Numbered) -> None:
    """How the stated errors do: true over stated."""
    for name, attribute in MEASURES.items():
        values = [(number, getattr(one, attribute)) for number, one in held]
        ratios = np.array([ratio for _, ratio in values])
        if not ratios.any():
            continue
        off = [number for number, ratio in values if ratio > 3.0]
        print_quantiles(f"true/stated, {name}", values)
        covered = np.mean(ratios <= 1.0)
        print(f"  {'':32}{covered:10.1%} covered; off by more than 3 times: {off or 'none'}")


def print_broken(held: Numbered) -> None:
    """Promises that are not kept."""
    for number, one in held:
        assert one.error is not None
        figures = {
            "place": (one.error.place, PROMISED[0]),
            "tension": (one.error.tension, PROMISED[1]),
            "closure": (one.closure, CLOSURE),
            "marches": (one.marches, MARCHES),
        }
        broken = [f"{name} {value:.3g}" for name, (value, most) in figures.items() if value > most]
        if broken:
            print(f"  {number}: BROKEN: {', '.join(broken)}")


def print_batch(found: Numbered) -> None:
    """The same profiles among others against their runs."""
    found = [(number, one) for number, one in found if one.batch_status is not None]
    if not found:
        return
    differing = [(n, one) for n, one in found if one.batch_status != one.status]
    for number, one in differing:
        print(f"  {number}: batch {one.batch_status}, run {one.status}")
    held = [(number, one.batch) for number, one in found if one.batch is not None]
    print(f"  batch: {len(held)} compared with run, {len(differing)} statuses differ")
    if not held:
        return
    for what, most in zip(("place", "tension"), OF_BATCH, strict=True):
        values = [(number, getattr(one, what)) for number, one in held]
        print_quantiles(f"batch off run, {what}", values)
        beyond = [number for number, value in values if value > most]
        print(f"  {'':32}beyond {most:g}: {beyond or 'none'}")


def main(cases: str = "", first: str = "1", *families: str) -> None:
    """The sweep, or some cases of every family or of some."""
    print(describe("calm-mooring", "llvmlite", "numpy", "scipy"))
    chosen = SWEEP if not cases else dict.fromkeys(families or (*FAMILIES, NET), int(cases))
    for family, count in chosen.items():
        measure(family, count, int(first))


if __name__ == "__main__":
    main(*(["1"] if sys.argv[1:] == ["--smoke"] else sys.argv[1:]))
