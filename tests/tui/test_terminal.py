"""The command in a terminal of its own: a line built from nothing, a session killed.

What a person presses goes in, what the terminal shows comes out; nothing else is known here.
"""

import json
import os
import signal
import subprocess
import sys
import time

import pexpect
import pyte
import pytest

from calm.files.editing import Draft
from calm.shipped import shipped_folder

ESCAPE_DELAY = 0.1  # seconds; as textual has it
pytestmark = [
    pytest.mark.thorough,
    pytest.mark.skipif(os.name != "posix", reason="there are no pseudo-terminals"),
]

PATIENCE = 600.0  # seconds; far more than anything takes, so that a busy machine fails nothing
ENTER, ESCAPE, TAB, DOWN, UP, RIGHT = "\r", "\x1b", "\t", "\x1b[B", "\x1b[A", "\x1b[C"
HOME, END = "\x1b[H", "\x1b[F"
SAVE, CLEAR = "\x13", "\x15"

DENSITY = [(0, 1024.5), (200, 1027.5), (1000, 1032.2), (2000, 1037.0), (4200, 1047.0)]
CURRENT = [
    (0, 0.70, 70), (300, 0.45, 68), (700, 0.25, 65), (1500, 0.12, 60), (3000, 0.08, 75),
    (4200, 0.06, 80),
]  # fmt: skip


class Terminal:
    """A command in a terminal of some columns and rows."""

    def __init__(self, *words, columns=110, rows=40):
        environ = os.environ | {"TERM": "xterm-256color", "COLUMNS": "", "LINES": ""}
        for name in ("COLUMNS", "LINES", "NO_COLOR", "TEXTUAL_DRIVER"):
            environ.pop(name, None)
        self._screen = pyte.Screen(columns, rows)
        self._stream = pyte.ByteStream(self._screen)
        self.child = pexpect.spawn(
            sys.executable, ["-m", "calm", "build", *map(str, words)], env=environ,
            dimensions=(rows, columns), timeout=PATIENCE,
        )  # fmt: skip
        self.child.delaybeforesend = 0

    @property
    def text(self):
        return "\n".join(self._screen.display)

    def _read(self, patience):
        try:
            self._stream.feed(self.child.read_nonblocking(65536, timeout=patience))
        except pexpect.TIMEOUT:
            pass
        except pexpect.EOF:
            pytest.fail(f"the command has ended:\n{self.text}")

    def wait(self, *words, gone=()):
        """Until the terminal shows all these words, and none of those that are to be gone."""
        deadline = time.monotonic() + PATIENCE
        while not all(word in self.text for word in words) or any(w in self.text for w in gone):
            if time.monotonic() > deadline:
                pytest.fail(f"{words} not shown:\n{self.text}")
            self._read(0.1)

    def press(self, *keys):
        """All keys at once, as a slow line delivers them: each waits for those before it.

        But for Esc: what follows it at once would be taken as one key with Alt.
        """
        for key in keys:
            self.child.send(key)
            if key == ESCAPE:
                time.sleep(3 * ESCAPE_DELAY)

    def end(self):
        self.child.expect(pexpect.EOF)
        self.child.close()


def run_json(path):
    command = [sys.executable, "-m", "calm", "run", str(path), "--json", "-"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=600)
    return json.loads(done.stdout)


def add(terminal, values):
    """Press what adds a piece to the line, the catalogue being open."""
    terminal.press(CLEAR, values["use"], ENTER)
    if "length" in values:
        terminal.press(values["length"], TAB, values["label"], ENTER)


def name(terminal, items):
    """Press what gives the rigid pieces their labels and counts, from the top."""
    terminal.press(HOME)
    for item in items:
        if "length" not in item.values:
            terminal.press("n", item.values["label"], ENTER)
        if "count" in item.values:
            terminal.press("=", item.values["count"], ENTER)
        terminal.press(DOWN)


def clamp(terminal, items):
    """Press what puts the clamps on, from the bottom: rows are added below only."""
    terminal.press(END)
    for item in reversed(items):
        for values in (each.values for each in item.clamps):
            terminal.press("i", CLEAR, values["use"], ENTER, values["at"], TAB, values["label"])
            terminal.press(ENTER)
            terminal.wait(values["label"])
            terminal.press(ESCAPE)
        terminal.press(*[UP] * (1 + len(item.clamps)))


def fill_table(terminal, rows):
    """Type rows into a new table of two; the cursor is on the line that tells its form."""
    terminal.press(TAB)
    for _ in rows[2:]:
        terminal.press("a", ESCAPE)
    terminal.press(*[UP] * (len(rows) - 2))
    for row in rows:
        for value in row:
            text = f"{value:g}" if value != int(value) else str(int(value))
            terminal.press(text, ENTER)


OF_THE_SHORT_LINE = {
    "top float", "wire 1", "meter 300 m", "wire 2", "parafil 3", "back-up glass", "releases",
    "three wheels",
}  # fmt: skip


def short_line(text):
    """The deep mooring with eight of its pieces: of every kind of them one."""
    draft = Draft(text.partition("checks:\n")[0])
    labels = [item.values["label"] for item in draft.items]
    draft = draft.put(labels.index("parafil 3"), "length", "3600 m")
    return draft.delete(i for i, label in enumerate(labels) if label not in OF_THE_SHORT_LINE)


@pytest.mark.parametrize(
    "line", [short_line, pytest.param(Draft, marks=pytest.mark.slow, id="all of it")]
)
def test_build_the_deep_mooring_from_nothing(tmp_path, monkeypatch, line):
    monkeypatch.setenv("CALM_COMPILED", "always")  # the line is judged after every key
    shipped = shipped_folder("lines") / "deep-current-meters.yaml"
    wanted = line(shipped.read_text(encoding="utf-8"))
    given = tmp_path / "given.yaml"
    given.write_text(wanted.text, encoding="utf-8")
    file = tmp_path / "mine.yaml"
    terminal = Terminal(file, columns=80, rows=24)
    terminal.wait("mine.yaml", "? help")

    terminal.press("m", CLEAR, "Deep current meters", ENTER, ENTER)
    terminal.press("38.5", ENTER, "-52", ENTER)
    terminal.wait("Deep current meters", gone=["Name and place"])

    terminal.press("w")
    terminal.wait("The water of mine.yaml")
    terminal.press("4200 m", ENTER, RIGHT, ENTER)
    terminal.wait("density kg/m^3")
    fill_table(terminal, DENSITY)
    terminal.wait("1047")
    terminal.press(DOWN, RIGHT, RIGHT, ENTER)
    terminal.wait("speed m/s")
    fill_table(terminal, CURRENT)
    terminal.wait("0.06")
    terminal.press(ESCAPE)
    terminal.wait("a add")

    terminal.press("a")
    for item in wanted.items:
        add(terminal, item.values)
    terminal.wait("anchor-wheels-3")
    terminal.press(ESCAPE)
    name(terminal, wanted.items)
    clamp(terminal, wanted.items)
    terminal.press(SAVE)
    terminal.wait("mine.yaml saved")
    terminal.press("q")
    terminal.end()
    assert terminal.child.exitstatus == 0

    assert run_json(file) == run_json(given)


def test_keys_that_come_in_one_parcel_are_not_mixed_up(tmp_path):
    file = tmp_path / "m.yaml"
    file.write_bytes((shipped_folder("lines") / "s1000.yaml").read_bytes())
    terminal = Terminal(file)
    terminal.wait("m.yaml", "a add", "Anchor")
    # every letter of the labels is a key of the line, too
    terminal.press("n", "duplicate", ENTER, DOWN, "n", "undo", ENTER, "m", CLEAR, "aux", ENTER)
    terminal.press(ENTER, ENTER, ENTER)
    terminal.wait("duplicate", "undo", "aux")
    terminal.press(SAVE, "q")
    terminal.end()
    assert b"name: aux" in file.read_bytes()
    assert file.read_bytes().count(b"use:") == 3


def test_killed_in_mid_edit_and_recovered(tmp_path):
    file = tmp_path / "m.yaml"
    original = (shipped_folder("lines") / "s1000.yaml").read_bytes()
    file.write_bytes(original)
    first = Terminal(file)
    first.wait("m.yaml", "a add", "Anchor")
    first.press("n", "a name of mine", ENTER)
    first.wait("a name of mine", "not saved")
    kept = copy_of(file)
    first.press("n", "half a na")  # a value half typed is not work yet
    first.wait("half a na")
    first.child.kill(signal.SIGKILL)
    assert file.read_bytes() == original

    second = Terminal(file)
    second.wait("Work that was not saved")
    second.press("r")
    second.wait("a name of mine", gone=["Work that was not saved"])
    second.press(SAVE)
    second.wait("m.yaml saved")
    second.press("q")
    second.end()
    assert b"a name of mine" in file.read_bytes()
    assert not kept.exists()


def test_a_closed_terminal_keeps_the_work(tmp_path):
    file = tmp_path / "m.yaml"
    file.write_bytes((shipped_folder("lines") / "s1000.yaml").read_bytes())
    terminal = Terminal(file)
    terminal.wait("m.yaml", "a add", "Anchor")
    terminal.press("n", "kept", ENTER)
    copy_of(file).unlink()  # it is the end that keeps the work
    terminal.child.kill(signal.SIGHUP)
    terminal.end()
    assert b"label: kept" in copy_of(file).read_bytes()


@pytest.mark.parametrize("number", [signal.SIGHUP, signal.SIGTERM])
def test_a_value_half_typed_survives_the_end(tmp_path, number):
    file = tmp_path / "m.yaml"
    file.write_bytes((shipped_folder("lines") / "s1000.yaml").read_bytes())
    terminal = Terminal(file)
    terminal.wait("m.yaml", "a add", "Anchor")
    terminal.press("n", "half a na")
    terminal.wait("half a na")
    terminal.child.kill(number)
    terminal.end()
    assert b"label: half a na" in copy_of(file).read_bytes()


@pytest.mark.parametrize("pressed", ["", "w" + 40 * DOWN])
def test_a_terminal_that_is_gone_ends_it(tmp_path, pressed):
    """The end of the terminal's window; what is drawn then can be written nowhere."""
    file = tmp_path / "m.yaml"
    file.write_bytes((shipped_folder("lines") / "s1000.yaml").read_bytes())
    terminal = Terminal(file)
    terminal.wait("m.yaml", "a add", "Anchor")
    terminal.press("n", "kept", ENTER)
    terminal.wait("kept", "not saved")
    terminal.press(pressed)
    terminal.child.ptyproc.fileobj.close()
    deadline = time.monotonic() + PATIENCE
    while terminal.child.isalive():
        if time.monotonic() > deadline:
            os.kill(terminal.child.pid, signal.SIGKILL)
            pytest.fail("it goes on without a terminal")
        time.sleep(0.05)
    assert terminal.child.signalstatus == signal.SIGHUP
    assert b"label: kept" in copy_of(file).read_bytes()


def test_a_file_that_is_open_elsewhere(tmp_path):
    file = tmp_path / "m.yaml"
    file.write_bytes((shipped_folder("lines") / "s1000.yaml").read_bytes())
    first = Terminal(file)
    first.wait("m.yaml", "a add", "Anchor")
    first.press("n", "of the first", ENTER)
    kept = copy_of(file)

    second = Terminal(file)
    second.wait("m.yaml is open elsewhere", "Anchor")
    second.press("q")
    second.end()
    assert b"of the first" in kept.read_bytes()
    first.press(SAVE)
    first.wait("m.yaml saved")
    first.press("q")
    first.end()
    assert not list(tmp_path.glob(".m.yaml.*"))


def copy_of(file):
    """Where unsaved work is kept, once it is."""
    deadline = time.monotonic() + PATIENCE
    while not (found := list(file.parent.glob(f".{file.name}.*.calm-autosave"))):
        assert time.monotonic() < deadline
        time.sleep(0.05)
    (copy,) = found
    return copy
