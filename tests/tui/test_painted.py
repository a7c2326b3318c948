"""What is sent to the terminal is what changed, and leaves it as all of the screen would."""

import random

import pyte
import pytest
from rich.color import ColorSystem
from rich.console import Console
from rich.segment import Segment
from rich.style import Style
from textual._compositor import ChopsUpdate, LayoutUpdate
from textual.geometry import Region
from textual.strip import Strip

from calm.tui.painted import Painted

COLUMNS, ROWS = 40, 6
HALF = COLUMNS // 2  # where one widget ends and the next begins
LOOKS = "none", "bold", "red", "red on blue", "green on blue", "dim", "reverse", "underline"
STYLES = [Style.parse(each) for each in LOOKS]
SIGNS = "abc  …│█深±"


@pytest.fixture
def console():
    found = Console(force_terminal=True, color_system="truecolor", legacy_windows=False)
    found._color_system = ColorSystem.TRUECOLOR
    return found


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


def whole(rows):
    return LayoutUpdate([[each] for each in rows], Region(0, 0, COLUMNS, len(rows)))


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
def test_the_terminal_shows_what_all_of_the_screen_would(console, seed):
    chance, painted, sent = random.Random(seed), Painted(), []
    halves = [[row(chance, HALF), row(chance, HALF)] for _ in range(ROWS)]
    rows = [Strip.join(each) for each in halves]
    sent.append(painted.update(whole(rows)).render_segments(console))
    for _ in range(12):
        y, side = chance.randrange(ROWS), chance.randrange(2)
        halves[y][side] = row(chance, HALF)
        rows[y] = Strip.join(halves[y])
        x = side * HALF
        update = chance.choice([
            whole(rows),
            ChopsUpdate([{x: halves[y][side]} if n == y else {} for n in range(ROWS)],
                        [(y, x, x + HALF)], [[x + HALF]] * ROWS),
        ])  # fmt: skip
        sent.append(painted.update(update).render_segments(console))
        every = Painted().update(whole(rows)).render_segments(console)
        assert shown(sent) == shown([every])


def test_blanks_that_look_alike_are_not_sent_again(console):
    painted, text = Painted(), "a" + 20 * " " + "b"
    strips = [
        Strip([Segment(text, Style.parse(look))]) for look in ("red on blue", "green on blue")
    ]
    painted.update(whole(strips[:1])).render_segments(console)
    sent = painted.update(whole(strips[1:])).render_segments(console)
    assert sent.count(" ") == 0 and sent.count("a") == sent.count("b") == 1


def test_nothing_is_sent_twice_unless_it_is_forgotten(console):
    rows = [row(random.Random(1)) for _ in range(ROWS)]
    painted = Painted()
    first = painted.update(whole(rows)).render_segments(console)
    assert first and not painted.update(whole(rows)).render_segments(console)
    painted.forget()
    assert painted.update(whole(rows)).render_segments(console) == first


def test_a_terminal_of_another_size_is_painted_whole(console):
    rows = [row(random.Random(2)) for _ in range(ROWS)]
    painted = Painted()
    painted.update(whole(rows)).render_segments(console)
    fewer = painted.update(whole(rows[:-1])).render_segments(console)
    assert len(fewer) > COLUMNS * (ROWS - 1)
