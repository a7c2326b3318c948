"""What keeps the package as small as it is: who adds also deletes."""

import ast
import re
from collections import Counter
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2] / "calm"
MOST_LINES = 86_870
MOST_MODULES = 332
MOST_IMPORTS = 0.083
"""Share of the lines of code that import something."""


def modules() -> list[Path]:
    return sorted(PACKAGE.rglob("*.py"))


def lines_of_code_and_of_imports(text: str) -> tuple[int, int]:
    """How many lines hold code, neither blank nor comment nor docstring, and an import."""
    code = {
        number
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    }
    imports: set[int] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import | ast.ImportFrom):
            imports |= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))
        text_alone = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        if text_alone and isinstance(node.value.value, str):
            code -= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return len(code), len(imports)


def test_lines() -> None:
    assert sum(len(path.read_text("utf-8").splitlines()) for path in modules()) <= MOST_LINES


def test_modules() -> None:
    assert len(modules()) <= MOST_MODULES


def test_imports_are_a_small_part_of_the_code() -> None:
    counts = [lines_of_code_and_of_imports(path.read_text("utf-8")) for path in modules()]
    code, imports = (sum(column) for column in zip(*counts, strict=True))
    assert imports <= MOST_IMPORTS * code


def test_a_public_class_name_is_used_once() -> None:
    names = Counter(
        name
        for path in modules()
        for name in re.findall(r"^class ([A-Z]\w*)", path.read_text("utf-8"), re.MULTILINE)
    )
    assert [name for name, count in names.items() if count > 1] == []
