"""When the solver is compiled: for many lines, and never where it would not pay."""

import pytest

from calm.solve import Settings, speed


@pytest.fixture(autouse=True)
def as_nobody_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CALM_COMPILED", raising=False)
    monkeypatch.setattr(speed, "_count", speed._Count())


@pytest.mark.parametrize(
    ("solves", "kept", "compiled"),
    [
        (1, True, False),
        (speed.WARM, False, False),
        (speed.WARM, True, True),
        (speed.COLD, False, True),
    ],
)
def test_it_is_compiled_where_that_pays(monkeypatch, solves, kept, compiled) -> None:
    monkeypatch.setattr(speed, "is_kept", lambda: kept)
    speed.expect_many(solves)
    assert speed.runs_compiled(Settings()) is compiled


def test_who_solves_in_a_loop_gets_there(monkeypatch) -> None:
    monkeypatch.setattr(speed, "is_kept", lambda: True)
    for _ in range(speed.WARM):
        speed.expect_many(1)
    assert speed.runs_compiled(Settings())


@pytest.mark.parametrize(("wish", "compiled"), [("never", False), ("always", True)])
def test_the_user_may_settle_it(monkeypatch, wish, compiled) -> None:
    monkeypatch.setenv("CALM_COMPILED", wish)
    speed.expect_many(1 if compiled else 1e9)
    assert speed.runs_compiled(Settings()) is compiled


@pytest.mark.parametrize("compiled", [False, True])
def test_whoever_solves_may_settle_it(monkeypatch, compiled) -> None:
    monkeypatch.setenv("CALM_COMPILED", "never" if compiled else "always")
    assert speed.runs_compiled(Settings(compiled=compiled)) is compiled


def test_without_numba_all_is_done_as_it_stands(monkeypatch) -> None:
    monkeypatch.setattr(speed, "find_spec", lambda name: None)
    speed.expect_many(1e9)
    assert not speed.runs_compiled(Settings())
