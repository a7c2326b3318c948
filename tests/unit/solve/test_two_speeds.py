"""When the solver runs compiled: once that pays."""

from pathlib import Path

import pytest

from calm.solve import CompiledPart, Settings, two_speeds
from calm.solve.two_speeds import (
    COMPILE_FROM,
    LOAD_FROM,
    UNANNOUNCED,
    count_lines,
    expect_many,
    runs_compiled,
)

LEFT_OPEN = Settings()


@pytest.fixture(autouse=True)
def nothing_solved(monkeypatch: pytest.MonkeyPatch) -> None:
    """The solver has solved nothing so far, and no code is in the cache."""
    monkeypatch.delenv("CALM_COMPILED", raising=False)
    paces = {each: two_speeds._Pace(each) for each in CompiledPart}
    monkeypatch.setattr(two_speeds, "_paces", paces)
    monkeypatch.setattr(two_speeds, "is_cached", lambda law: False)


@pytest.mark.parametrize(("lines", "compiled"), [(LOAD_FROM - 1, False), (LOAD_FROM, True)])
def test_cached_code_is_loaded_for_many_lines(monkeypatch, lines, compiled) -> None:
    monkeypatch.setattr(two_speeds, "is_cached", lambda law: law == CompiledPart.LINE.value)
    expect_many(lines)
    assert runs_compiled(LEFT_OPEN) is compiled
    assert not runs_compiled(LEFT_OPEN, solver=CompiledPart.LEGS)


def test_a_check_of_fifty_cases_does_not_compile() -> None:
    expect_many(150)
    for _ in range(150):
        count_lines(1.0, CompiledPart.LINE, 7.0)
    assert not runs_compiled(LEFT_OPEN)


def test_many_announced_lines_are_solved_compiled() -> None:
    expect_many(COMPILE_FROM - 1)
    assert not runs_compiled(LEFT_OPEN)
    expect_many(COMPILE_FROM)
    assert runs_compiled(LEFT_OPEN)
    assert not runs_compiled(LEFT_OPEN, solver=CompiledPart.NEARBY)


def test_many_more_lines_are_expected_after_unannounced_ones() -> None:
    for _ in range(UNANNOUNCED - 1):
        count_lines(1.0, CompiledPart.LINE)
    assert not runs_compiled(LEFT_OPEN)
    count_lines(1.0, CompiledPart.LINE)
    assert runs_compiled(LEFT_OPEN)


@pytest.mark.parametrize(("wish", "compiled"), [("never", False), ("always", True)])
def test_the_user_may_settle_it(monkeypatch, wish, compiled) -> None:
    monkeypatch.setenv("CALM_COMPILED", wish)
    expect_many(1 if compiled else 1e9)
    assert runs_compiled(LEFT_OPEN) is compiled


@pytest.mark.parametrize("compiled", [False, True])
def test_settings_may_settle_it(monkeypatch, compiled) -> None:
    monkeypatch.setenv("CALM_COMPILED", "never" if compiled else "always")
    assert runs_compiled(Settings(compiled=compiled)) is compiled


def test_without_llvm_nothing_is_compiled(monkeypatch) -> None:
    monkeypatch.setattr(two_speeds, "_has_llvm", lambda: False)
    expect_many(1e9)
    assert not runs_compiled(LEFT_OPEN)


def test_every_part_is_named_by_a_function_of_the_solver() -> None:
    folder = Path(two_speeds.__file__).parent
    sources = "".join(path.read_text("utf-8") for path in folder.glob("*.py"))
    assert all(f"\ndef {part.value}(" in sources for part in CompiledPart)
