"""The page of messages has every status, exit code and warning that there is."""

import ast
from pathlib import Path

import pytest

from calm.batch.statuses import STATUSES
from calm.cli.outputs import ExitCode
from calm.solve.solution import Status

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "reference" / "messages.md").read_text(encoding="utf-8")
WARNINGS = ROOT / "calm" / "case" / "warnings.py"


def sentences() -> list[str]:
    """The longest constant part of every warning; the page has its beginning."""
    yielded = [
        node.value
        for node in ast.walk(ast.parse(WARNINGS.read_text(encoding="utf-8")))
        if isinstance(node, ast.Yield) and isinstance(node.value, ast.JoinedStr | ast.Constant)
    ]
    parts = [
        [part for part in text.values if isinstance(part, ast.Constant)]
        if isinstance(text, ast.JoinedStr)
        else [text]
        for text in yielded
    ]
    return [max((str(part.value) for part in each), key=len) for each in parts]


def test_the_page_has_every_exit_code() -> None:
    assert not [code.name for code in ExitCode if f"\n| {code.value} | " not in PAGE]


@pytest.mark.parametrize("status", STATUSES)
def test_the_page_has_every_status(status: str) -> None:
    assert f"\n| `{status}` | " in PAGE


@pytest.mark.parametrize("status", Status, ids=lambda status: status.label)
def test_the_page_gives_the_advice_of_a_status(status: Status) -> None:
    (row,) = [row for row in PAGE.splitlines() if row.startswith(f"| `{status.label}` |")]
    assert row.endswith(f"| {status.advice} |".replace("|  |", "| |"))


def test_the_page_has_every_warning() -> None:
    found = sentences()
    assert len(found) > 15
    assert not [text for text in found if text.strip(" .,:")[:18] not in PAGE]
