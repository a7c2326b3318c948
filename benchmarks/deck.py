"""How long the sheets for the deck, the plan of an anchor drop and a comparison take.

    python benchmarks/deck.py [CABLES…] [--smoke]

For lines of so many cables (10, 100), each with a clamp: the cutting list with the effect of an
error on each cable, all sheets without the drop, the drop, their pages, and `calm diff` with a
line of one more. Fastest of three, seconds of processor. `--smoke` takes one line of three once.
"""

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from machine import describe

import calm
from calm.checks.comparison import comparison_of
from calm.deck import deck_of
from calm.deck.deck_items import Order, deck_items_of
from calm.deck.hardware import cuts_of
from calm.drop import drop_plan
from calm.report.deck_files import deck_report
from calm.report.diagram import PageSize
from calm.report.folder import printed

COMPONENTS = """
components:
  ball: {kind: sphere, role: float, diameter: 1.2 m, mass: 300 kg, buoyancy: 6000 N}
  rope: {kind: cable, diameter: 8 mm, weight: 0.5 N/m}
  logger: {kind: cylinder, diameter: 40 mm, length: 0.3 m, buoyancy: -5 N}
  weight: {kind: anchor, weight: 15 kN, kt: 400 N/(m/s)^2}
"""


def mooring(folder: Path, cables: int) -> calm.Design:
    """800 m of rope in so many parts, in 1000 m of water that moves at 0.2 m/s."""
    rope = f"  - {{use: rope, length: {800.0 / cables} m, clamps: [{{use: logger, at: 1 m}}]}}\n"
    path = folder / f"{cables}.yaml"
    path.write_text(
        "name: bench\nenvironment: {depth: 1000 m, current: {speed: 0.2 m/s, toward: 90 deg}}\n"
        f"line:\n  - {{use: ball}}\n{rope * cables}  - {{use: weight}}\n{COMPONENTS}"
    )
    loaded = calm.load(path)
    return loaded


def fastest(work: Callable[[], object], times: int) -> float:
    """Seconds of processor of the fastest of some runs."""
    spent = []
    for _ in range(times):
        start = time.process_time()
        work()
        spent.append(time.process_time() - start)
    return min(spent)


def main(counts: list[int], times: int) -> None:
    """Measure, and print a row for each line."""
    print(describe("calm-mooring", "numpy", "scipy"))
    heads = ("cables", "solve", "cutting", "sheets", "drop", "pages", "diff")
    print("".join(f"{head:>10}" for head in heads))
    with tempfile.TemporaryDirectory() as folder:
        for count in counts:
            line, more = (mooring(Path(folder), number) for number in (count, count + 1))
            result = line.solve()
            parts = deck_items_of(result)
            deck = deck_of([line], Order.ANCHOR_FIRST)
            works: list[Callable[[], object]] = [
                line.solve,
                lambda result=result, parts=parts: cuts_of(result, parts, Order.ANCHOR_LAST),
                lambda line=line: deck_of([line], Order.ANCHOR_FIRST),
                lambda line=line: drop_plan(line),
                lambda deck=deck: printed(deck_report(deck, PageSize("a4")), PageSize("a4")),
                lambda line=line, more=more: comparison_of(("a", "b"), line, more),
            ]
            figures = "".join(f"{fastest(work, times):10.3f}" for work in works)
            print(f"{count:>10}{figures}", flush=True)


if __name__ == "__main__":
    given = [int(word) for word in sys.argv[1:] if word != "--smoke"]
    main(given or ([3] if "--smoke" in sys.argv else [10, 100]), 1 if "--smoke" in sys.argv else 3)
