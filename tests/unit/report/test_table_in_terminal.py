"""Tables in a terminal look as rich would print them."""

import io
import re
from dataclasses import replace

import pytest
from rich.console import Console

from calm.checks.finding import State
from calm.report import terminal
from calm.report.blocks import Cell, Column, ReportPart, Table

COLUMNS = (
    Column("name"),
    Column("depth", "m", numeric=True),
    Column("above seabed", "m", numeric=True, short="above\nseabed", marked=True),
    Column("left out", narrow=False),
    Column("verdict"),
)


ONE_FOLDED = (COLUMNS[0], *(replace(each, share=0.0) for each in COLUMNS[1:]))


def table(columns, rows=40, label="hyphened-rope of a long name"):
    made = [(Cell("a head of what is below it", strong=True),)]
    for i in range(rows):
        state = State.FAIL if i % 7 == 3 else None
        mark = "!" if i % 5 == 2 else ""
        made.append((
            Cell(f"{label} {i}", indented=i % 3 == 1), Cell(f"{i * 1.5:.1f}"),
            Cell(f"{i}", mark=mark, state=state), Cell("never"), Cell("[bold]海 ok", state=state),
        ))  # fmt: skip
    return ReportPart("title", (Table("over it", columns, tuple(made), "below it", totals=1),))


def printed(part, width):
    file = io.StringIO()
    Console(file=file, width=width, force_terminal=True, color_system="standard").print(
        terminal.shown(part)
    )
    # which blanks are coloured is nothing one sees
    plain = re.sub(r"\x1b\[[\d;]*m", "", file.getvalue())
    return re.sub(" +$", "", plain, flags=re.MULTILINE), re.findall(
        r"\x1b\[[\d;]+m\S+", file.getvalue()
    )


def as_rich(made, console, options):
    yield made._table


@pytest.mark.parametrize("columns", [COLUMNS, ONE_FOLDED])
@pytest.mark.parametrize("width", [80, 60, 50, 40, 34, 20])  # it fits, or its names are folded
def test_it_is_what_rich_prints(monkeypatch, columns, width):
    part = table(columns)
    ours, coloured = printed(part, width)
    monkeypatch.setattr(terminal.PlainTable, "__rich_console__", as_rich)
    theirs, expected = printed(part, width)
    assert ours == theirs
    assert [one for one in coloured if "m[bold]" in one or "!" in one] == [
        one for one in expected if "m[bold]" in one or "!" in one
    ]


@pytest.mark.parametrize("width", [80, 40, 20])
def test_it_may_be_printed_many_times(width):
    """A window prints a table whenever it measures it."""
    file = io.StringIO()
    console, shown = Console(file=file, width=width), terminal.shown(table(COLUMNS))
    console.print(shown)
    once = file.getvalue()
    console.print(shown)
    assert file.getvalue() == 2 * once
