"""How long the commands take, from the shell's point of view.

    python benchmarks/run_command.py [REPETITIONS | --smoke]

Prints the median and the fastest wall time of whole processes, warm disk, the time of a bare
`python -c pass` beside them, and the imports that cost most in `calm run`. `--smoke` starts each
command once.
"""

import statistics
import subprocess
import sys
import time
from pathlib import Path

from machine import describe

LINES = Path(__file__).resolve().parents[1] / "lines"
DEEP_LINE = str(LINES / "deep-current-meters.yaml")
COMMANDS = {
    "python -c pass": ["-c", "pass"],
    "calm --help": ["-m", "calm", "--help"],
    "calm catalog list": ["-m", "calm", "catalog", "list"],
    "calm run deep-current-meters.yaml": ["-m", "calm", "run", DEEP_LINE],
    "calm run (every shipped mooring)": [
        "-m",
        "calm",
        "run",
        *sorted(map(str, LINES.glob("*.yaml"))),
    ],
}


def wall_times(arguments: list[str], repetitions: int) -> list[float]:
    """Seconds of each whole process; the first, which fills the caches, counts only alone."""
    times = []
    for _ in range(repetitions + 1):
        start = time.perf_counter()
        subprocess.run([sys.executable, *arguments], check=True, stdout=subprocess.DEVNULL)
        times.append(time.perf_counter() - start)
    return times[1:] or times


def dearest_imports(arguments: list[str], count: int) -> list[tuple[float, str]]:
    """Own import time [ms] of the `count` packages that cost most, with all their modules."""
    finished = subprocess.run(
        [sys.executable, "-X", "importtime", *arguments], check=True, capture_output=True, text=True
    )
    spent: dict[str, float] = {}
    for line in finished.stderr.splitlines():
        own, _, module = (
            line.removeprefix("import time:").split("|") if "|" in line else ("", "", "")
        )
        if own.strip().isdigit():
            package = module.strip().partition(".")[0]
            spent[package] = spent.get(package, 0.0) + int(own) / 1000.0
    dearest = sorted(((time_spent, package) for package, time_spent in spent.items()), reverse=True)
    return dearest[:count]


def main() -> None:
    """Print all figures."""
    words = sys.argv[1:]
    repetitions = 0 if words == ["--smoke"] else int(*words or [10])
    print(describe("calm-mooring", "numpy", "pydantic", "cyclopts", "rich"))
    print(f"\n{'whole process, warm':40}{'median':>9}{'fastest':>9}")
    for name, arguments in COMMANDS.items():
        times = wall_times(arguments, repetitions)
        print(f"{name:40}{statistics.median(times):7.3f} s{min(times):7.3f} s")
    print("\nimports of `calm run deep-current-meters.yaml`, own time")
    for milliseconds, package in dearest_imports(COMMANDS["calm run deep-current-meters.yaml"], 10):
        print(f"{package:40}{milliseconds:6.1f} ms")


if __name__ == "__main__":
    main()
