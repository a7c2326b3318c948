"""Where compiled laws are kept."""

import builtins
from collections.abc import Callable, Iterator
from pathlib import Path
from types import BuiltinFunctionType, FunctionType
from typing import Any

import pytest

from calm.batch.net_profiles import solve_net_rows
from calm.batch.solving import solve_rows
from calm.physics import compiled
from calm.physics.drag import drag_share
from calm.physics.passing import pass_line
from calm.solve.leg_closing import do_task
from calm.solve.mooring import run_search


def test_a_folder_that_cannot_be_written_is_done_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "file"
    file.write_text("")
    monkeypatch.setenv("CALM_CACHE_DIR", str(file / "below"))
    monkeypatch.setattr(compiled, "_entries", {})
    compiled.cache_folder.cache_clear()
    assert compiled.cache_folder() is None
    arguments = (0.3, -0.1, 0.9, 0.7, 0.5, -0.2, 0.1)
    share = compiled.outcome(drag_share, True, *arguments)
    compiled.cache_folder.cache_clear()
    assert share == drag_share(*arguments)


def test_compiled_code_is_kept_where_the_user_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CALM_CACHE_DIR", str(tmp_path))
    compiled.cache_folder.cache_clear()
    folder = compiled.cache_folder()
    compiled.cache_folder.cache_clear()
    assert folder is not None
    assert folder.parent == tmp_path
    assert folder.is_dir()


def test_rows_of_a_list_are_set() -> None:
    rows = [(1.0, 2.0), (3.0, 4.0)]
    compiled.set_row(rows, 1, (5.0, 6.0))
    assert rows == [(1.0, 2.0), (5.0, 6.0)]


def test_a_compiled_law_gives_the_digits_of_the_law(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled, "cache_folder", lambda: None)
    monkeypatch.setattr(compiled, "_entries", {})
    arguments = (0.3, -0.1, 0.9, 0.7, 0.5, -0.2, 0.1)
    assert compiled.outcome(drag_share, True, *arguments) == drag_share(*arguments)


def called_by(law: Callable[..., Any], known: set[Any]) -> Iterator[Any]:
    """What a law and the laws that it calls name, but for these."""
    known.add(law)
    for name in law.__code__.co_names:
        named = law.__globals__.get(name, getattr(builtins, name, None))
        if isinstance(named, FunctionType) and named.__module__.startswith("calm."):
            if named not in known:
                yield from called_by(named, known)
        else:
            yield named


@pytest.mark.parametrize("law", [run_search, pass_line, do_task, solve_rows, solve_net_rows])
def test_laws_call_laws_and_functions_of_numbers_alone(law: Callable[..., Any]) -> None:
    """The translator knows no others."""
    numbers = {abs, len, max, min, range, bool, float, int, tuple}
    for named in called_by(law, set()):
        if isinstance(named, BuiltinFunctionType) and named not in numbers:
            assert named.__module__ == "math", named
        assert not isinstance(named, FunctionType), named
        assert not getattr(named, "__name__", "").startswith("numpy"), named
