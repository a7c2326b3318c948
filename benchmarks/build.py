"""How soon the line builder shows what an edit does.

    python benchmarks/build.py [REPETITIONS | --smoke]

The deep current-meter mooring with shackles added up to 60 pieces is opened in a terminal of 80
columns and 24 rows. Prints the wall time to the first picture, beside that of `calm run` and of a
bare `python -c pass` in the same run; from a key to the first bytes of the screen that follows;
and from a text to its verdict, of that the solving, after edits of a length, of the current and of
a label. Then, in terminals of 80 columns and 24 rows and of 200 and 60, with 33 and with 200 rows
of the line, what a key costs over a slow link: the bytes that are sent for it, the processor time
it takes, and when the last byte of it has come. Last, the keys that a mooring of 4000 m takes from
an empty file: a script of them is typed into a terminal, and what is saved is counted. Needs a
system with pseudo-terminals; `--smoke` takes one terminal, one line and one script.
"""

import os
import re
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

from calm.case import Design
from calm.files import read_mooring
from calm.files.editing import Draft
from calm.tui.live import judge

DEEP_LINE = Path(__file__).resolve().parents[1] / "lines" / "deep-current-meters.yaml"
PIECES = 60
COLUMNS, ROWS = 80, 24
PATIENCE = 60.0
QUIET = 0.2
"""Seconds without a byte after which a screen is complete."""
UNHURRIED = 1.0
"""The same [s] where nothing is measured, on a machine that may be busy."""
DOWN, UP = "\x1b[B", "\x1b[A"
SIZES = ((80, 24), (200, 60))
SEARCH = (*"shackle", *["\x7f"] * 7)
NAMED = {
    "Enter": "\r", "Esc": "\x1b", "Down": DOWN, "Up": UP, "Right": "\x1b[C", "Home": "\x1b[H",
    "End": "\x1b[F", "Shift+Up": "\x1b[1;2A", "PgDn": "\x1b[6~", "Ctrl+P": "\x10", "Ctrl+S": "\x13",
}  # fmt: skip
"""What a terminal sends for the keys that the scripts name."""
_LENGTHS = (400, 400, 350, 350, *[300] * 6, 290, 290)
_PLACES = (10, 20, 15, 12, 30, 25, 50, 40)
_WATER = (
    "w4000<Down><Down><Down><Right><Right><Enter><Right>.6<Enter>70<Enter>a300<Enter>.4<Enter>70"
    "<Enter>1000<Enter>.2<Enter>65<Enter><Esc><Down><Right>.05<Enter>60<Enter><Esc>"
)
_ENDS = "<End>aar861<Enter>short-g30-13<Enter>5<Enter><Enter>wheels-4<Enter><Esc>"


def _entered(values: Iterable[int]) -> str:
    """Values typed one below the other."""
    return "".join(f"{value}<Enter>" for value in values)


PRACTISED = (
    ("depth and current", _WATER),
    ("top float", "aore-41<Enter>"),
    ("a shot and the glass below it", "d-8-5<Enter>320<Enter>shot<Enter>cluster-4<Enter><Esc>"),
    ("twelve of both", "<Shift+Up>+11<Enter>"),
    ("release, chain, anchor", _ENDS),
    ("lengths of the shots", f"<Home><Down>#l{_entered(_LENGTHS)}"),
    ("an instrument", "<Home><Down>isbe37<Enter>10<Enter><Enter><Esc>"),
    ("one on each of eight shots", "c" + "<Down><Down>v" * 7),
    ("where they are", f"#l{_entered(_PLACES)}"),
    ("their serial numbers", f"#s{_entered(range(5101, 5109))}"),
    ("save", "<Ctrl+S>"),
)
"""Of who knows the keys: what each part is for, and what is typed."""
FIRST_TIME = (
    (
        "the keys read, the catalogue looked at",
        "?<PgDn><PgDn><PgDn><Esc>a" + "<Down>" * 8 + "<Esc>",
    ),
    ("depth and current", _WATER),
    ("top float", "afloat<Down><Down>" + "\x7f" * 5 + "ore-41<Enter>"),
    (
        "shots and glass, one after the other",
        "".join(
            f"wire-jacketed-8-5<Enter>{length}<Enter><Enter>glass-cluster-4<Enter>"
            if not number
            else f"d-8-5<Enter>{length}<Enter><Enter>cluster-4<Enter>"
            for number, length in enumerate(_LENGTHS)
        ),
    ),
    ("release, chain, anchor", "<Esc>" + _ENDS),
    (
        "the instruments, each from the catalogue",
        "<Home><Down>"
        + "<Down><Down>".join(f"isbe37<Enter>{place}<Enter><Enter><Esc>" for place in _PLACES),
    ),
    (
        "their serial numbers, from the palette",
        "<Home><Down><Down><Ctrl+P>serial<Enter>5101<Ctrl+S>"
        + "".join(f"<Down><Down><Down>N{number}<Ctrl+S>" for number in range(5102, 5109)),
    ),
    ("save", "<Ctrl+S>"),
)
"""Of who types it for the first time: help, catalogue and palette are looked at, nothing is
repeated or filled in one go."""


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
    """`calm build` in a terminal, from its start to its first picture, or to words that it says."""

    def __init__(
        self, file: Path, columns: int = COLUMNS, rows: int = ROWS, said: str = "top float"
    ) -> None:
        self.screen = pyte.Screen(columns, rows)
        self.stream = pyte.ByteStream(self.screen)
        self.child = pexpect.spawn(
            sys.executable,
            ["-m", "calm", "build", str(file)],
            dimensions=(rows, columns),
            timeout=PATIENCE,
            env=os.environ | {"XDG_STATE_HOME": str(file.parent / "state")},
        )
        self.child.delaybeforesend = 0
        self.first = seconds(lambda: self.until(said))
        self.settle()

    def until(self, words: str) -> None:
        """Read until the screen says some words."""
        while words not in "\n".join(self.screen.display):
            self.stream.feed(self.child.read_nonblocking(65536, timeout=PATIENCE))

    def settle(self, quiet: float = QUIET) -> None:
        """Read until nothing has come for a time [s]."""
        try:
            while True:
                self.stream.feed(self.child.read_nonblocking(65536, timeout=quiet))
        except pexpect.TIMEOUT:
            return

    def type(self, script: str) -> int:
        """Type a script, one key after the other; how many keys it has."""
        keys = [found[1] or found[2] for found in re.finditer(r"<([A-Z][\w+]*)>|(.)", script)]
        for key in keys:
            if key == "Esc":  # a key that follows it at once is taken for one with Alt
                self.settle(UNHURRIED)
            self.child.send(NAMED.get(key, key))
            if key == "Esc":
                self.settle(UNHURRIED)
        self.settle(UNHURRIED)
        return len(keys)

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


def links(
    file: Path, repetitions: int, columns: int, rows: int
) -> Iterable[tuple[str, int, list[float], float]]:
    """Of a cursor key, of an edit and of a key of the search in the catalogue the most bytes, the
    times to the last, the processor's time.

    An edit is followed for a second: launch, recovery and breaks are judged half a second after it.
    """
    terminal = Terminal(file, columns, rows)
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


def typed(file: Path, script: Iterable[tuple[str, str]]) -> Iterable[tuple[str, int]]:
    """The keys of each part of a script, and of all, typed into an empty file that is saved then.

    Raises
    ------
    AssertionError
        What is saved is not the mooring that was meant.
    """
    terminal, whole = Terminal(file, 120, 40, said="The line is empty"), 0
    for part, keys in script:
        count = terminal.type(keys)
        whole += count
        yield part, count
    terminal.until(f"{file.name} saved")
    terminal.close()
    made = read_mooring(file)
    shots = [piece.length for piece in made.pieces if piece.use == "wire-jacketed-8-5"]
    clamped = [
        (each.at, each.equipment.serial)
        for piece in made.pieces
        for each in piece.clamps
        if each.use == "sbe37"
    ]
    meant = [(place, str(number)) for number, place in enumerate(_PLACES, 5101)]
    assert (shots, clamped) == ([*_LENGTHS], meant), (shots, clamped)
    yield "in all", whole


def edits(text: str, repetitions: int) -> Iterable[tuple[str, list[float], list[float]]]:
    """Of every kind of edit the times to its verdict, and those of its solving alone."""
    kinds: dict[str, Callable[[int], str]] = {
        "length": lambda i: text.replace("length: 395 m", f"length: {395 + i / 10:.1f} m"),
        "current": lambda i: text.replace("[300, 0.45, 68]", f"[300, {0.45 + i / 1000:.3f}, 68]"),
        "label": lambda i: text.replace("label: wire 1,", f"label: wire 1 {i},"),
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
            mooring = Design(read_mooring("line.yaml", text=changed))
            solving.append(seconds(lambda known=mooring: known.leg.equilibrium()))
        yield kind, times, solving


def main() -> None:
    """Print all figures."""
    smoke = sys.argv[1:] == ["--smoke"]
    repetitions = 1 if smoke else int(sys.argv[1]) if sys.argv[1:] else 20
    sizes, counts = (SIZES[:1], (33,)) if smoke else (SIZES, (33, 200))
    scripts = {"practised": PRACTISED} | ({} if smoke else {"the first time": FIRST_TIME})
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
        for columns, rows in sizes:
            print(f"\n{f'{columns} x {rows}, over a link':32}{heads}")
            for count in counts:
                file.write_text(pieces(count), encoding="utf-8")
                for name, sent, times, busy in links(file, repetitions, columns, rows):
                    told = f"{name}, {count} pieces"
                    print(f"{told:32}{sent:11}{_pair(times)}{1e3 * busy:8.1f} ms")
        print(f"\n{'a mooring of 4000 m, typed':52}{'keys':>7}")
        for who, script in scripts.items():
            for part, count in typed(Path(folder) / f"{who}.yaml", script):
                print(f"{f'{who}: {part}':52}{count:7}")
    print(f"\n{'edit to verdict':32}{'median':>11}{'fastest':>11}{'to one solve':>13}")
    for kind, times, solving in edits(text, 2 * repetitions):
        print(f"{kind:32}{_pair(times)}{min(times) / min(solving):13.2f}")


def _pair(times: list[float]) -> str:
    median, fastest = (1e3 * value for value in (statistics.median(times), min(times)))
    return f"{median:8.1f} ms{fastest:8.1f} ms"


if __name__ == "__main__":
    main()
