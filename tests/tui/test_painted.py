"""What is sent to the terminal is what changed, and leaves it as all of the screen would."""

import asyncio
import random

import pyte
import pytest
from rich.console import Console
from rich.segment import Segment
from rich.style import Style
from textual.driver import Driver
from textual.strip import Strip

from calm.tui.painted import Painted, TerminalOutput

COLUMNS, ROWS = 40, 6
HALF = COLUMNS // 2  # where one widget ends and the next begins
LOOKS = "none", "bold", "red", "red on blue", "green on blue", "dim", "reverse", "underline"
STYLES = [Style.parse(each) for each in LOOKS]
SIGNS = "abc  …│█深±"
SYNC = "\x1b[?2026h", "\x1b[?2026l"
ASKED = "\x1b[6n"
CONSOLE = Console(force_terminal=True, color_system="truecolor", legacy_windows=False)


def row(chance, width=COLUMNS):
    segments, left = [], width
    while left > 0:
        text = "".join(chance.choices(SIGNS, k=chance.randint(1, 6)))
        strip = Strip([Segment(text, chance.choice(STYLES))]).adjust_cell_length(
            min(left, chance.randint(1, 9)), STYLES[0]
        )
        segments += strip
        left -= strip.cell_length
    return Strip(segments)


def placed(strip, x, y):
    """A part of the screen, as Textual writes it."""
    return f"\x1b[{y + 1};{x + 1}H{strip.render(CONSOLE)}"


def whole(rows):
    return "\n".join(placed(each, 0, y) for y, each in enumerate(rows))


def sent(painted, text):
    """What a frame sends; none of its text goes past the frame."""
    assert painted.take(text) == ""
    return painted.changes()


def shown(texts):
    screen = pyte.Screen(COLUMNS, ROWS)
    pyte.Stream(screen).feed("".join(texts))
    return [[seen(screen.buffer[y][x]) for x in range(COLUMNS)] for y in range(ROWS)]


def seen(cell):
    """What the eye has of a cell: of a blank neither colour nor weight."""
    marks = cell.bg, cell.reverse, cell.underscore
    return (
        cell.data,
        *marks,
        "" if cell.data == " " and not any(marks[1:]) else cell.fg,
        cell.bold and cell.data != " ",
    )


@pytest.mark.parametrize("seed", range(8))
def test_the_terminal_shows_what_all_of_the_screen_would(seed):
    chance, painted = random.Random(seed), Painted()
    halves = [[row(chance, HALF), row(chance, HALF)] for _ in range(ROWS)]
    rows = [Strip.join(each) for each in halves]
    frames = [sent(painted, whole(rows))]
    for _ in range(12):
        y, side = chance.randrange(ROWS), chance.randrange(2)
        halves[y][side] = row(chance, HALF)
        rows[y] = Strip.join(halves[y])
        frames.append(
            sent(painted, chance.choice([whole(rows), placed(halves[y][side], side * HALF, y)]))
        )
        assert shown(frames) == shown([whole(rows)])


def test_a_text_may_come_in_pieces():
    rows = [row(random.Random(3)) for _ in range(ROWS)]
    painted, text = Painted(), whole(rows)
    for start in range(0, len(text), 7):  # in the middle of a sequence, too
        assert painted.take(text[start : start + 7]) == ""
    assert painted.changes() == sent(Painted(), text)


def test_blanks_that_look_alike_are_not_sent_again():
    painted, text = Painted(), "a" + 20 * " " + "b"
    strips = [Strip([Segment(text, Style.parse(f"{look} on #010203"))]) for look in ("red", "blue")]
    sent(painted, whole(strips[:1]))
    again = sent(painted, whole(strips[1:]))
    assert again.count(" ") == 0 and again.count("a") == again.count("b") == 1


def test_nothing_is_sent_twice_unless_it_is_forgotten():
    rows = [row(random.Random(1)) for _ in range(ROWS)]
    painted = Painted()
    first = sent(painted, whole(rows))
    assert first and not sent(painted, whole(rows))
    painted.forget()
    assert painted.changes() == first


def test_a_cleared_terminal_is_painted_whole():
    rows = [row(random.Random(2)) for _ in range(ROWS)]
    painted = Painted()
    sent(painted, whole(rows))
    painted.clear()
    assert not painted.changes()
    assert sent(painted, whole(rows[:-1])) == sent(Painted(), whole(rows[:-1]))


def test_modes_go_at_once_and_a_frame_keeps_its_marks():
    painted = Painted()
    assert painted.take("\x1b[?1049h\x1b[>13u\x1b]52;c;YQ==\x07\x07\x1b[?2026$p") == (
        "\x1b[?1049h\x1b[>13u\x1b]52;c;YQ==\x07\x07\x1b[?2026$p"
    )
    text = painted.take(f"{SYNC[0]}\x1b[1;1Hone{SYNC[1]}")
    assert (text, painted.changes()) == ("", f"{SYNC[0]}\x1b[1;1Hone\x1b[1;4H{SYNC[1]}")
    assert painted.changes() == ""


class Terminal(Driver):
    """A terminal that notes what it is sent."""

    def __init__(self):
        self.sent = []

    def write(self, data):
        self.sent.append(data)

    def start_application_mode(self):
        self.write("\x1b[?1049h")

    def stop_application_mode(self):
        self.write("\x1b[?1049l")
        self.flush()

    def disable_input(self):
        pass


def test_a_frame_waits_for_the_terminal_and_has_all_changes_since():
    async def story():
        output = TerminalOutput()
        driver = output.driver_class(Terminal)()
        driver.start_application_mode()
        for text in "one", "two", "three":
            driver.write(f"\x1b[1;1H{text}")
            driver.flush()
        # it has never answered, so that nothing waits, and it is asked once
        assert [each.count(ASKED) for each in driver.sent] == [0, 1, 0, 0]
        output.answered()
        for text in "seven", "eight", "sevEN":
            driver.write(f"\x1b[1;1H{text}")
            driver.flush()
        assert len(driver.sent) == 5 and output.is_out
        output.answered()
        assert driver.sent[5:] == [f"\x1b[1;4HEN\x1b[1;6H{ASKED}"]
        driver.write("\x1b[1;1Hlast")
        driver.stop_application_mode()
        assert driver.sent[6:] == ["\x1b[?1049l"]  # no frame, and no question to the shell

    asyncio.run(story())
