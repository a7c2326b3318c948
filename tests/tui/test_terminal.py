"""The command in a terminal of its own: a line built from nothing, a session killed.

What a person presses goes in, what the terminal shows comes out; nothing else is known here.
"""

import os
import signal
import sys
import time

import pexpect
import pyte
import pytest

from calm.shipped import shipped_folder
from tests.tui.test_stories import (
    DEEP,
    DEEP_MEANT,
    PASTED,
    SURFACE,
    SURFACE_MEANT,
    assert_file_is,
)

ESCAPE_DELAY = 0.1  # seconds; as textual has it
pytestmark = [
    pytest.mark.thorough,
    pytest.mark.skipif(os.name != "posix", reason="there are no pseudo-terminals"),
]

PATIENCE = 180.0  # seconds; far more than anything takes, so that a busy machine fails nothing
ENTER, ESCAPE, DOWN = "\r", "\x1b", "\x1b[B"
SAVE, CLEAR = "\x13", "\x15"

SIGNS = {"⏎": ENTER, "⎋": ESCAPE, "⑥": "\x1b[17~"}


class Terminal:
    """A command in a terminal of some columns and rows."""

    def __init__(self, *words, columns=110, rows=40, folder=None):
        environ = os.environ | {"TERM": "xterm-256color", "COLUMNS": "", "LINES": ""}
        for name in ("COLUMNS", "LINES", "NO_COLOR", "TEXTUAL_DRIVER"):
            environ.pop(name, None)
        self._screen = pyte.Screen(columns, rows)
        self._stream = pyte.ByteStream(self._screen)
        self.child = pexpect.spawn(
            sys.executable, ["-m", "calm", "build", *map(str, words)], env=environ,
            dimensions=(rows, columns), timeout=PATIENCE, cwd=folder,
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


@pytest.mark.parametrize(
    ("story", "name", "meant"),
    [
        pytest.param(SURFACE, "buoy.yaml", SURFACE_MEANT, id="surface"),
        pytest.param(DEEP, "deep.yaml", DEEP_MEANT, marks=pytest.mark.slow, id="deep"),
    ],
)
def test_build_a_mooring_from_nothing(tmp_path, monkeypatch, story, name, meant):
    monkeypatch.setenv("CALM_COMPILED", "always")  # the line is judged after every key
    terminal = Terminal(columns=80, rows=24, folder=tmp_path)
    terminal.wait("? help")
    for number, part in enumerate(PASTED.split(story)):
        if number % 2:
            terminal.press(f"\x1b[200~{part}\x1b[201~")
            terminal.wait("columns")
        else:
            terminal.press(*(SIGNS.get(sign, sign) for sign in part))
    terminal.wait(f"{name} saved")
    terminal.press("q")
    terminal.end()
    assert terminal.child.exitstatus == 0
    assert_file_is(tmp_path / name, meant)


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
    second.wait("Unsaved work")
    second.press("r")
    second.wait("a name of mine", gone=["Unsaved work"])
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


class SlowLink:
    """A terminal behind a satellite: 300 ms there and back, 20 kbit/s; it answers as xterm does."""

    ROUND, RATE = 0.3, 2500.0  # s; bytes a second

    def __init__(self, file, folder):
        self.terminal = Terminal(file, columns=80, rows=24, folder=folder)
        self._coming, self._tail, self._answers, self._credit = b"", b"", [], 0.0
        self._last = time.monotonic()
        self.bytes = 0

    def run(self, seconds):
        """Let the link work for a time."""
        begun = time.monotonic()
        while time.monotonic() - begun < seconds:
            try:
                data = self.terminal.child.read_nonblocking(65536, timeout=0.01)
                self._coming, self.bytes = self._coming + data, self.bytes + len(data)
            except pexpect.TIMEOUT:
                pass
            now = time.monotonic()
            self._credit = min(self._credit + (now - self._last) * self.RATE, self.RATE * 0.05)
            self._last = now
            taken, self._coming = (
                self._coming[: int(self._credit)],
                self._coming[int(self._credit) :],
            )
            self._credit -= len(taken)
            if taken:
                self.terminal._stream.feed(taken)
                asked = self._tail + taken  # a question may come in two pieces
                self._answers += [now + self.ROUND] * asked.count(b"[6n")
                self._tail = asked[-2:]
            while self._answers and self._answers[0] <= now:
                self._answers.pop(0)
                self.terminal.child.send("\x1b[1;1R")

    def settle(self, after=0):
        """Until something has come after so many bytes, and then nothing for three seconds."""
        deadline = time.monotonic() + PATIENCE
        seen = after
        while seen != self.bytes or seen <= after or self._coming:
            assert time.monotonic() < deadline, f"it does not settle:\n{self.terminal.text}"
            seen = self.bytes
            self.run(3.0)


def test_twenty_keys_over_a_satellite_send_few_frames(folder):
    """What waits for the terminal is one frame, and the next has all that has changed since.

    Sent one by one the frames of twenty keys are 16 kB, which take the link 4.5 s more than the
    keys; merged they are 8 kB at most, on a machine that is busy fewer still.
    """
    path = folder / "deep.yaml"
    lines = shipped_folder("lines") / "deep-current-meters.yaml"
    path.write_text(lines.read_text(encoding="utf-8"), encoding="utf-8")
    link = SlowLink(path, folder)
    link.settle()  # the first screen is there, and all is judged
    before = link.bytes
    for _ in range(20):
        link.terminal.child.send(DOWN)
        link.run(0.1)
    link.settle(before)
    rows = [line for line in link.terminal.text.splitlines() if line.startswith("▸")]
    assert len(rows) == 1
    assert link.bytes - before < 8_000
    quiet = link.bytes
    link.terminal.child.send("l")
    link.settle(quiet)  # what opens is drawn, and an open input is silent
    link.terminal.child.close(force=True)
