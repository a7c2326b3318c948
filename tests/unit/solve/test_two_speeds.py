"""When the solver runs compiled: once that pays, and nobody waits for the compiler."""

import os
import subprocess
import sys
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


class Child:
    """A compiling process that runs until it is told to finish."""

    def __init__(self) -> None:
        self.code: int | None = None

    def poll(self) -> int | None:
        return self.code


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[Child]:
    """The compiling processes that were started, of a solver that has solved nothing so far."""
    children: list[Child] = []

    def start(_: CompiledPart) -> Child:
        children.append(Child())
        return children[-1]

    monkeypatch.delenv("CALM_COMPILED", raising=False)
    paces = {each: two_speeds._Pace(each) for each in CompiledPart}
    monkeypatch.setattr(two_speeds, "_paces", paces)
    monkeypatch.setattr(two_speeds, "_compile_ahead", start)
    monkeypatch.setattr(two_speeds, "is_cached", lambda law: False)
    return children


@pytest.mark.parametrize(("lines", "compiled"), [(LOAD_FROM - 1, False), (LOAD_FROM, True)])
def test_cached_code_is_loaded_for_many_lines(started, monkeypatch, lines, compiled) -> None:
    monkeypatch.setattr(two_speeds, "is_cached", lambda law: law == CompiledPart.LINE.value)
    expect_many(lines)
    assert runs_compiled(LEFT_OPEN) is compiled
    assert not runs_compiled(LEFT_OPEN, solver=CompiledPart.LEGS)
    assert not started


def test_a_check_of_a_hundred_cases_does_not_compile(started) -> None:
    expect_many(300)
    for _ in range(300):
        count_lines(1.0, CompiledPart.LINE, 7.0)
    assert not started
    assert not runs_compiled(LEFT_OPEN)


def test_a_worker_process_waits_for_the_code_that_its_parent_has_compiled(
    started, monkeypatch
) -> None:
    """The child is not its own, so it looks into the cache."""
    expect_many(COMPILE_FROM)
    [child] = started
    child.code = 0
    monkeypatch.setattr(two_speeds, "parent_process", object)
    count_lines(1.0, CompiledPart.LINE)
    assert not runs_compiled(LEFT_OPEN)
    monkeypatch.setattr(two_speeds, "is_cached", lambda law: True)
    count_lines(1.0, CompiledPart.LINE)
    assert runs_compiled(LEFT_OPEN)


@pytest.mark.parametrize("announced", [COMPILE_FROM, 0])
def test_a_child_compiles_while_the_solver_goes_on(started, announced) -> None:
    if announced:
        expect_many(announced)
    else:
        for _ in range(UNANNOUNCED):
            count_lines(1.0, CompiledPart.LINE)
    [child] = started
    assert not runs_compiled(LEFT_OPEN)
    child.code = 0
    count_lines(1.0, CompiledPart.LINE)
    assert runs_compiled(LEFT_OPEN)
    assert len(started) == 1


def test_a_child_that_fails_leaves_the_solver_as_it_is(started) -> None:
    expect_many(COMPILE_FROM)
    started[0].code = 1
    for _ in range(2 * COMPILE_FROM):
        count_lines(1.0, CompiledPart.LINE)
    assert not runs_compiled(LEFT_OPEN)
    assert len(started) == 1


def test_workers_start_no_child(started, monkeypatch) -> None:
    monkeypatch.setattr(two_speeds, "parent_process", lambda: "a process that feeds workers")
    expect_many(1e9)
    assert not started


@pytest.mark.parametrize(("wish", "compiled"), [("never", False), ("always", True)])
def test_the_user_may_settle_it(started, monkeypatch, wish, compiled) -> None:
    monkeypatch.setenv("CALM_COMPILED", wish)
    expect_many(1 if compiled else 1e9)
    assert runs_compiled(LEFT_OPEN) is compiled
    assert not started


@pytest.mark.parametrize("compiled", [False, True])
def test_settings_may_settle_it(started, monkeypatch, compiled) -> None:
    monkeypatch.setenv("CALM_COMPILED", "never" if compiled else "always")
    assert runs_compiled(Settings(compiled=compiled)) is compiled


def test_without_llvm_nothing_is_compiled(started, monkeypatch) -> None:
    monkeypatch.setattr(two_speeds, "_has_llvm", lambda: False)
    expect_many(1e9)
    assert not runs_compiled(LEFT_OPEN)
    assert not started


@pytest.mark.thorough
@pytest.mark.parametrize("solver", CompiledPart, ids=lambda each: each.name.lower())
def test_the_child_leaves_in_the_cache_what_the_solver_loads(monkeypatch, tmp_path, solver) -> None:
    environment = {**os.environ, "CALM_CACHE_DIR": str(tmp_path), "CALM_COMPILED": "always"}
    command = [sys.executable, "-m", "calm.solve.compile_ahead", solver.name]
    subprocess.run(command, env=environment, check=True)
    two_speeds.cache_folder.cache_clear()
    monkeypatch.setenv("CALM_CACHE_DIR", str(tmp_path))
    try:
        assert two_speeds.is_cached(solver.value)
    finally:
        two_speeds.cache_folder.cache_clear()


def test_every_part_is_named_by_a_function_of_the_solver() -> None:
    folder = Path(two_speeds.__file__).parent
    sources = "".join(path.read_text("utf-8") for path in folder.glob("*.py"))
    assert all(f"\ndef {part.value}(" in sources for part in CompiledPart)
