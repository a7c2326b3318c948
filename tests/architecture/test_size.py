"""What keeps the package easy to find one's way in: import directions, few cycles, unique names."""

import re
from collections import Counter
from pathlib import Path

import grimp
from importlinter import cli

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "calm"
MOST_CYCLES, MOST_MODULES_IN_CYCLES = 0, 0
"""To be lowered whenever a cycle is broken, never raised."""


def cycles() -> list[list[str]]:
    """Groups of modules that import one another, for types and inside functions too."""
    graph = grimp.build_graph("calm", cache_dir=None)
    imported = {module: graph.find_upstream_modules(module) for module in graph.modules}
    groups = {
        frozenset({module} | {other for other in others if module in imported[other]})
        for module, others in imported.items()
    }
    return [sorted(group) for group in groups if len(group) > 1]


def test_import_directions() -> None:
    assert cli.lint_imports(str(ROOT / "pyproject.toml"), no_cache=True) == 0


def test_import_cycles() -> None:
    found = cycles()
    assert len(found) <= MOST_CYCLES
    assert sum(map(len, found)) <= MOST_MODULES_IN_CYCLES


def test_a_public_class_name_is_used_once() -> None:
    names = Counter(
        name
        for path in sorted(PACKAGE.rglob("*.py"))
        for name in re.findall(r"^class ([A-Z]\w*)", path.read_text("utf-8"), re.MULTILINE)
    )
    assert [name for name, count in names.items() if count > 1] == []
