"""How soon the line builder shows what an edit does.

    python benchmarks/build.py [REPETITIONS]

The deep current-meter mooring with shackles added up to 60 pieces is opened in a terminal of 80
columns and 24 rows. Prints the wall time to the first picture, beside that of `calm run` and of a
bare `python -c pass` in the same run; from a key to the first bytes of the screen that follows;
and from a text to its verdict, of that the solving, after edits of a length, of the current and of
a label. Needs a system with pseudo-terminals.
"""

import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path

import pexpect
import pyte
from machine import describe

from calm.case import Mooring
from calm.files import read_mooring
from calm.tui.live import judge

DEEP_LINE = Path(__file__).resolve().parents[1] / "lines" / "deep-current-meters.yaml"
PIECES = 60
COLUMNS, ROWS = 80, 24
PATIENCE = 60.0
QUIET = 0.2
"""Seconds without a byte after which a screen is complete."""
DOWN, UP = "\x1b[B", "\x1b[A"


def sixty_pieces() -> str:
    """The deep mooring with a shackle below its meters and ropes, as many as it takes."""
    head, line = DEEP_LINE.read_text(encoding="utf-8").split("\nline:\n")
    rows = line.splitlines(keepends=True)
    items = [number for number, row in enumerate(rows) if row.startswith("  - ")]
    lacking = PIECES - len(items)
    for number in reversed(items[-2 - lacking : -2]):
        rows.insert(number, "  - {use: shackle-13}\n")
    return f"{head}\nline:\n{''.join(rows)}"


def seconds(action: Callable[[], object]) -> float:
    """Wall time of something done once."""
    start = time.perf_counter()
    action()
    return time.perf_counter() - start


class Terminal:
    """`calm build` in a terminal, from its start to its first picture."""

    def __init__(self, file: Path) -> None:
        self.screen = pyte.Screen(COLUMNS, ROWS)
        self.stream = pyte.ByteStream(self.screen)
        self.child = pexpect.spawn(
            sys.executable,
            ["-m", "calm", "build", str(file)],
            dimensions=(ROWS, COLUMNS),
            timeout=PATIENCE,
        )
        self.child.delaybeforesend = 0
        self.first = seconds(self._await_picture)
        self.settle()

    def _await_picture(self) -> None:
        while "top float" not in "\n".join(self.screen.display):
            self.stream.feed(self.child.read_nonblocking(65536, timeout=PATIENCE))

    def settle(self) -> None:
        """Read until nothing comes any more."""
        try:
            while True:
                self.stream.feed(self.child.read_nonblocking(65536, timeout=QUIET))
        except pexpect.TIMEOUT:
            return

    def answer(self, key: str) -> float:
        """From a key to the first bytes of what it shows [s]."""
        self.child.send(key)
        taken = seconds(lambda: self.stream.feed(self.child.read_nonblocking(65536, PATIENCE)))
        self.settle()
        return taken

    def close(self) -> None:
        """End it as a closed terminal does."""
        self.child.close(force=True)


def first_pictures(file: Path, repetitions: int) -> dict[str, list[float]]:
    """Wall times by command; the first round, which fills the caches, is not counted."""
    run = [sys.executable, "-m", "calm", "run", str(file)]

    def build() -> float:
        terminal = Terminal(file)
        terminal.close()
        return terminal.first

    def whole(command: list[str]) -> float:
        return seconds(lambda: subprocess.run(command, check=True, stdout=subprocess.DEVNULL))

    found: dict[str, list[float]] = {"python -c pass": [], "calm run": [], "calm build": []}
    for _ in range(repetitions + 1):
        found["python -c pass"].append(whole([sys.executable, "-c", "pass"]))
        found["calm run"].append(whole(run))
        found["calm build"].append(build())
    return {name: times[1:] for name, times in found.items()}


def keys(file: Path, repetitions: int) -> dict[str, list[float]]:
    """Times from a key to its screen, of the cursor, of a new piece and of its undoing."""
    terminal = Terminal(file)
    cursor = [terminal.answer(key) for _ in range(repetitions) for key in (DOWN, UP)]
    terminal.answer(DOWN)
    edits = [(terminal.answer("d"), terminal.answer("u")) for _ in range(repetitions)]
    terminal.close()
    duplicated, undone = zip(*edits, strict=True)
    return {"cursor": cursor, "duplicate": [*duplicated], "undo": [*undone]}


def edits(text: str, repetitions: int) -> Iterable[tuple[str, list[float], list[float]]]:
    """Of every kind of edit the times to its verdict, and those of its solving alone."""
    kinds: dict[str, Callable[[int], str]] = {
        "length": lambda i: text.replace("length: 395 m", f"length: {395 + i / 10:.1f} m"),
        "current": lambda i: text.replace("[300, 0.45, 68]", f"[300, {0.45 + i / 1000:.3f}, 68]"),
        "label": lambda i: text.replace("label: top float", f"label: top float {i}"),
    }
    for kind, edited in kinds.items():
        view = judge(text)
        times, solving = [], []
        for i in range(1, repetitions + 1):
            changed = edited(i)
            assert changed != text
            start = time.perf_counter()
            view = judge(changed, keep=view)
            times.append(time.perf_counter() - start)
            assert view.result is not None
            mooring = Mooring(read_mooring("line.yaml", text=changed))
            solving.append(seconds(lambda known=mooring: known.equilibrium(known.water)))
        yield kind, times, solving


def main() -> None:
    """Print all figures."""
    repetitions = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    print(describe("calm-mooring", "textual", "rich", "numpy"))
    text = sixty_pieces()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "sixty.yaml"
        file.write_text(text, encoding="utf-8")
        print(f"\n{'whole process':32}{'median':>11}{'fastest':>11}{'to calm run':>13}")
        wall = first_pictures(file, max(repetitions // 4, 3))
        for name, times in wall.items():
            ratio = min(times) / min(wall["calm run"])
            told = f"{name}, first picture" if name == "calm build" else name
            print(f"{told:32}{_pair(times)}{ratio:13.2f}")
        print(f"\n{'key to screen':32}{'median':>11}{'fastest':>11}")
        for name, times in keys(file, repetitions).items():
            print(f"{name:32}{_pair(times)}")
    print(f"\n{'edit to verdict':32}{'median':>11}{'fastest':>11}{'to one solve':>13}")
    for kind, times, solving in edits(text, 2 * repetitions):
        print(f"{kind:32}{_pair(times)}{min(times) / min(solving):13.2f}")


def _pair(times: list[float]) -> str:
    median, fastest = (1e3 * value for value in (statistics.median(times), min(times)))
    return f"{median:8.1f} ms{fastest:8.1f} ms"


if __name__ == "__main__":
    main()
