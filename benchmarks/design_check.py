"""How long a design check of many moorings in many environments takes, report included.

    python benchmarks/design_check.py [MOORINGS] [ENVIRONMENTS]
    python benchmarks/design_check.py --smoke

Copies of the shipped moorings under names of their own, in currents of growing speed that turn;
prints the wall time of the whole process with one worker and with two, the processor's time of a
case over that of S1000 by scipy alone, and the size of the report. `--smoke` checks two moorings
in two environments.
"""

import itertools
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import s1000_by_hand
from machine import describe

LINES = Path(__file__).resolve().parents[1] / "lines"
ENVIRONMENT = """\
name: e{number}
environment:
  current:
    columns: [depth m, speed m/s, toward deg]
    rows:
      - [0, {speed}, {toward}]
      - [200, {half}, {toward}]
      - [2000, 0.03, {back}]
"""


def write_moorings(folder: Path, count: int) -> list[str]:
    """As many moorings as wanted, the shipped ones again and again."""
    texts = [path.read_text(encoding="utf-8") for path in sorted(LINES.glob("*.yaml"))]
    moored = [text for text in texts if "\ntow:" not in text]
    files = []
    for number, text in enumerate(itertools.islice(itertools.cycle(moored), count)):
        lines = [
            f"name: mooring {number}" if line[:5] == "name:" else line for line in text.splitlines()
        ]
        files.append(folder / f"mooring-{number}.yaml")
        files[-1].write_text("\n".join(lines), encoding="utf-8")
    return [str(file) for file in files]


def write_environments(folder: Path, count: int) -> list[str]:
    """Options that name as many environments as wanted."""
    options = []
    for number in range(count):
        speed, toward = 0.2 + 0.5 * number / count, 36 * number
        file = folder / f"environment-{number}.yaml"
        text = ENVIRONMENT.format(
            number=number, speed=speed, half=speed / 2, toward=toward, back=(toward + 90) % 360
        )
        file.write_text(text, encoding="utf-8")
        options += ["--environment", str(file)]
    return options


def _of_processor(work: Callable[[], object]) -> float:
    begin = time.process_time()
    work()
    return time.process_time() - begin


def main() -> None:
    """Print all figures."""
    words = ["2", "2"] if sys.argv[1:] == ["--smoke"] else sys.argv[1:]
    moorings, environments = (int(word) for word in (*words, 20, 10)[:2])
    print(describe("calm-mooring", "numpy", "typst"))
    print(f"\n{moorings} moorings in {environments} environments, whole process with its report")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        words = [*write_moorings(folder, moorings), *write_environments(folder, environments)]
        for workers in (2, 1):
            report = folder / f"report-{workers}"
            command = [sys.executable, "-m", "calm", "check", *words, "--report", str(report)]
            start = time.perf_counter()
            ended = subprocess.run(
                [*command, "--workers", str(workers)], stdout=subprocess.DEVNULL, check=False
            )
            spent = time.perf_counter() - start
            assert ended.returncode in (0, 1), ended.returncode
            print(f"{workers} workers: {spent:6.1f} s")
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        cases = 2 * moorings * environments  # of both runs
        each = (used.ru_utime + used.ru_stime) / cases
        scipy = min(_of_processor(lambda: s1000_by_hand.solve(1e-6)) for _ in range(40))
        print(
            f"a case: {1e3 * each:.1f} ms of the processor, {each / scipy:.1f} times scipy's S1000"
        )
        for file in sorted(report.iterdir()):
            print(f"{file.name:16}{file.stat().st_size / 1e6:8.2f} MB")


if __name__ == "__main__":
    main()
