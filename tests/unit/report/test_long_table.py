"""Tables of many rows look as rich would print them."""

import io
import re

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


def table(rows, label="rope"):
    made = [(Cell("a head of what is below it", strong=True),)]
    for i in range(rows):
        state = State.FAIL if i % 7 == 3 else None
        mark = "!" if i % 5 == 2 else ""
        made.append((
            Cell(f"{label} {i}", indented=i % 3 == 1), Cell(f"{i * 1.5:.1f}"),
            Cell(f"{i}", mark=mark, state=state), Cell("never"), Cell("[bold]海 ok", state=state),
        ))  # fmt: skip
    return ReportPart("title", (Table("over it", COLUMNS, tuple(made), "below it", totals=1),))


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


@pytest.mark.parametrize("width", [80, 30])  # it fits, or its names are folded
def test_it_is_what_rich_prints(monkeypatch, width):
    part = table(150)
    ours, coloured = printed(part, width)
    monkeypatch.setattr(terminal, "MANY", 10**6)
    theirs, expected = printed(part, width)
    assert ours == theirs
    assert [one for one in coloured if "m[bold]" in one or "!" in one] == [
        one for one in expected if "m[bold]" in one or "!" in one
    ]
