"""When the march is compiled: for many lines, and never where it would not pay."""

import pytest

from calm.physics import pace


@pytest.fixture(autouse=True)
def as_nobody_asked(monkeypatch: pytest.MonkeyPatch, march_as_it_stands: None) -> None:
    monkeypatch.delenv("CALM_COMPILED", raising=False)


@pytest.mark.parametrize(
    ("solves", "kept", "fast"),
    [
        (1, True, False),
        (pace.WARM, False, False),
        (pace.WARM, True, True),
        (pace.COLD, False, True),
    ],
)
def test_it_is_compiled_where_that_pays(monkeypatch, solves, kept, fast) -> None:
    monkeypatch.setattr(pace, "is_kept", lambda: kept)
    pace.expect(solves)
    assert pace.is_fast() is fast


@pytest.mark.parametrize(("wish", "fast"), [("never", False), ("always", True)])
def test_the_user_may_settle_it(monkeypatch, wish, fast) -> None:
    monkeypatch.setenv("CALM_COMPILED", wish)
    pace.expect(1 if fast else 1e9)
    assert pace.is_fast() is fast


def test_without_numba_all_is_done_as_it_stands(monkeypatch) -> None:
    monkeypatch.setattr(pace, "find_spec", lambda name: None)
    pace.expect(1e9)
    assert not pace.is_fast()
    assert pace.paced(abs) is abs


def test_once_fast_it_stays_so() -> None:
    pace.march_fast(True)
    pace.expect(1)
    assert pace.is_fast()
