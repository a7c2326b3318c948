"""How soon the line builder shows what an edit does.

    python benchmarks/build.py [REPETITIONS] [--smoke]

The deep current-meter mooring with shackles added up to 60 pieces is opened in a terminal of 80
columns and 24 rows. Prints the wall time to the first picture, beside that of `calm run` and of a
bare `python -c pass` in the same run; from a key to the first bytes of the screen that follows;
and from a text to its verdict, of that the solving, after edits of a length, of the current and of
a label. Then, in a terminal of 140 columns and 45 rows with 33 and with 200 rows of the line, what
a key costs over a slow link: the bytes that are sent for it, the processor time it takes, and when
the last byte of it has come. Needs a system with pseudo-terminals; `--smoke` takes seconds.
"""

import os
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
from calm.files.editing import Draft
from calm.tui.live import judge

DEEP_LINE = Path(__file__).resolve().parents[1] / "lines" / "deep-current-meters.yaml"
PIECES = 60
COLUMNS, ROWS = 80, 24
PATIENCE = 60.0
QUIET = 0.2
"""Seconds without a byte after which a screen is complete."""
DOWN, UP = "\x1b[B", "\x1b[A"
SEARCH = (*"shackle", *["\x7f"] * 7)


def pieces(count: int) -> str:
    """The deep mooring with shackles above its lowest three pieces, as many as it takes."""
    line = Draft(DEEP_LINE.read_text(encoding="utf-8"))
    lacking = max(count - len(line.items), 0)
    return line.paste(len(line.items) - 3, ["- {use: shackle-13}\n"] * lacking).text


def seconds(action: Callable[[], object]) -> float:
    """Wall time of something done once."""
    start = time.perf_counter()
    action()
    return time.perf_counter() - start


class Terminal:
    """`calm build` in a terminal, from its start to its first picture."""

    def __init__(self, file: Path, columns: int = COLUMNS, rows: int = ROWS) -> None:
        self.screen = pyte.Screen(columns, rows)
        self.stream = pyte.ByteStream(self.screen)
        self.child = pexpect.spawn(
            sys.executable,
            ["-m", "calm", "build", str(file)],
            dimensions=(rows, columns),
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

    def cost(self, key: str, quiet: float) -> tuple[int, float, float]:
        """Of a key the bytes that are sent, the time to the last [s], the processor's time [s].

        It is over when nothing has come for a time [s]."""
        self.child.send(key)
        begun, busy = time.perf_counter(), self._busy()
        count, last = 0, begun
        try:
            while True:
                count += len(self.child.read_nonblocking(1 << 20, timeout=quiet))
                last = time.perf_counter()
        except pexpect.TIMEOUT:
            return count, last - begun, self._busy() - busy

    def _busy(self) -> float:
        """The processor's time that the command has taken [s], as the system counts it."""
        path = Path(f"/proc/{self.child.pid}/stat")
        if not path.exists():
            return 0.0
        values = path.read_text(encoding="utf-8").rpartition(")")[2].split()
        return (int(values[11]) + int(values[12])) / os.sysconf("SC_CLK_TCK")

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


def links(file: Path, repetitions: int) -> Iterable[tuple[str, int, list[float], float]]:
    """Of a cursor key, of an edit and of a key of the search in the catalogue the most bytes, the
    times to the last, the processor's time.

    An edit is followed for a second: launch, recovery and breaks are judged half a second after it.
    """
    terminal = Terminal(file, 140, 45)
    terminal.cost(DOWN, 2.0)
    for name, keys, quiet in (
        ("cursor", (DOWN, UP), QUIET),
        ("duplicate, undo", ("d", "u"), 1.0),
        ("search", SEARCH, QUIET),
    ):
        if name == "search":
            terminal.answer("a")
        rounds = range(max(2 * repetitions // len(keys), 1))
        costs = [terminal.cost(key, quiet) for _ in rounds for key in keys]
        counts, times, busy = zip(*costs, strict=True)
        yield name, max(counts), [*times], sum(busy) / len(busy)
    terminal.close()


def edits(text: str, repetitions: int) -> Iterable[tuple[str, list[float], list[float]]]:
    """Of every kind of edit the times to its verdict, and those of its solving alone."""
    kinds: dict[str, Callable[[int], str]] = {
        "length": lambda i: text.replace("length: 395 m", f"length: {395 + i / 10:.1f} m"),
        "current": lambda i: text.replace("[300, 0.45, 68]", f"[300, {0.45 + i / 1000:.3f}, 68]"),
        "label": lambda i: text.replace("label: wire 1}", f"label: wire 1 {i}}}"),
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
    given = [word for word in sys.argv[1:] if word != "--smoke"]
    repetitions = 1 if "--smoke" in sys.argv else int(given[0]) if given else 20
    print(describe("calm-mooring", "textual", "rich", "numpy"))
    text = pieces(PIECES)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "sixty.yaml"
        file.write_text(text, encoding="utf-8")
        print(f"\n{'whole process':32}{'median':>11}{'fastest':>11}{'to calm run':>13}")
        wall = first_pictures(file, repetitions // 4 or 1)
        for name, times in wall.items():
            ratio = min(times) / min(wall["calm run"])
            told = f"{name}, first picture" if name == "calm build" else name
            print(f"{told:32}{_pair(times)}{ratio:13.2f}")
        print(f"\n{'key to screen':32}{'median':>11}{'fastest':>11}")
        for name, times in keys(file, repetitions).items():
            print(f"{name:32}{_pair(times)}")
        heads = "".join(f"{each:>11}" for each in ("most bytes", "median", "fastest", "processor"))
        print(f"\n{'140 x 45, over a link':32}{heads}")
        for rows in (33, 200):
            file.write_text(pieces(rows), encoding="utf-8")
            for name, count, times, busy in links(file, repetitions):
                told = f"{name}, {rows} pieces"
                print(f"{told:32}{count:11}{_pair(times)}{1e3 * busy:8.1f} ms")
    print(f"\n{'edit to verdict':32}{'median':>11}{'fastest':>11}{'to one solve':>13}")
    for kind, times, solving in edits(text, 2 * repetitions):
        print(f"{kind:32}{_pair(times)}{min(times) / min(solving):13.2f}")


def _pair(times: list[float]) -> str:
    median, fastest = (1e3 * value for value in (statistics.median(times), min(times)))
    return f"{median:8.1f} ms{fastest:8.1f} ms"


if __name__ == "__main__":
    main()
