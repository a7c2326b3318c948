"""When the solver is compiled: for many lines, and never where it would not pay."""

import pytest

from calm.solve import Settings, solution


@pytest.fixture(autouse=True)
def as_nobody_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CALM_COMPILED", raising=False)
    monkeypatch.setattr(solution, "_count", solution._Count())


@pytest.mark.parametrize(
    ("solves", "kept", "compiled"),
    [
        (1, True, False),
        (solution.WARM, False, False),
        (solution.WARM, True, True),
        (solution.COLD, False, True),
    ],
)
def test_it_is_compiled_where_that_pays(monkeypatch, solves, kept, compiled) -> None:
    monkeypatch.setattr(solution, "is_kept", lambda: kept)
    solution.expect_many(solves)
    assert solution.runs_compiled(Settings()) is compiled


def test_who_solves_in_a_loop_gets_there(monkeypatch) -> None:
    monkeypatch.setattr(solution, "is_kept", lambda: True)
    for _ in range(solution.WARM):
        solution.expect_many(1)
    assert solution.runs_compiled(Settings())


@pytest.mark.parametrize(("wish", "compiled"), [("never", False), ("always", True)])
def test_the_user_may_settle_it(monkeypatch, wish, compiled) -> None:
    monkeypatch.setenv("CALM_COMPILED", wish)
    solution.expect_many(1 if compiled else 1e9)
    assert solution.runs_compiled(Settings()) is compiled


@pytest.mark.parametrize("compiled", [False, True])
def test_whoever_solves_may_settle_it(monkeypatch, compiled) -> None:
    monkeypatch.setenv("CALM_COMPILED", "never" if compiled else "always")
    assert solution.runs_compiled(Settings(compiled=compiled)) is compiled


def test_without_numba_all_is_done_as_it_stands(monkeypatch) -> None:
    monkeypatch.setattr(solution, "find_spec", lambda name: None)
    solution.expect_many(1e9)
    assert not solution.runs_compiled(Settings())
