"""Where compiled laws are kept."""

import builtins
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from shutil import rmtree
from threading import Event, Thread
from types import BuiltinFunctionType, FunctionType
from typing import Any

import pytest

from calm.batch.net_profiles import solve_net_rows
from calm.batch.solving import solve_rows
from calm.errors import UsageError
from calm.physics import compiled
from calm.physics.drag import drag_share
from calm.physics.passing import pass_line
from calm.solve import Settings, load_line_solver, two_speeds
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


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """An LLVM that is installed but does not support this machine."""
    import llvmlite.binding

    def refuse(*_: Any, **__: Any) -> Any:
        raise RuntimeError("No available targets are compatible")

    kept = compiled.fault, compiled._target_machine, compiled._machine_name
    monkeypatch.setattr(llvmlite.binding.Target, "from_default_triple", refuse)
    for each in kept:
        each.cache_clear()
    yield
    for each in kept:
        each.cache_clear()


def test_an_llvm_that_does_not_work_leaves_the_interpreted_solver(
    broken: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    paces = {each: two_speeds._Pace(each) for each in two_speeds.CompiledPart}
    monkeypatch.setattr(two_speeds, "_paces", paces)
    for wish in ("always", ""):
        monkeypatch.setenv("CALM_COMPILED", wish)
        assert not two_speeds.may_compile()
        two_speeds.expect_many(1e9)
        assert not two_speeds.runs_compiled(Settings())
    assert not any(compiled.is_cached(each.value) for each in two_speeds.CompiledPart)
    monkeypatch.setattr(compiled, "_entries", {})
    with pytest.raises(UsageError, match=r"does not work here \(RuntimeError: No available"):
        compiled.outcome(drag_share, True, 0.3, -0.1, 0.9, 0.7, 0.5, -0.2, 0.1)


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


ARGUMENTS = (0.3, -0.1, 0.9, 0.7, 0.5, -0.2, 0.1)


@pytest.fixture
def kept_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The file in the cache with the code of a law."""
    monkeypatch.setenv("CALM_CACHE_DIR", str(tmp_path / "Käfig of code"))
    monkeypatch.setattr(compiled, "cache_folder", compiled.cache_folder.__wrapped__)
    monkeypatch.setattr(compiled, "_entries", {})
    compiled.outcome(drag_share, True, *ARGUMENTS)
    [file] = tmp_path.rglob("*.o")
    return file


def compilations(monkeypatch: pytest.MonkeyPatch) -> int:
    """Number of compilations by another process that calls the law."""
    count: list[int] = []
    monkeypatch.setattr(compiled, "_entries", {})
    monkeypatch.setattr(compiled, "on_compilation", [lambda: count.append(1)])
    assert compiled.outcome(drag_share, True, *ARGUMENTS) == drag_share(*ARGUMENTS)
    return len(count)


@pytest.mark.parametrize(
    "damaged",
    [
        lambda code: b"",
        lambda code: code[:100],
        lambda code: code[: len(code) // 2],
        lambda code: bytes(5000),
        lambda code: code[:-1] + bytes([code[-1] ^ 1]),
    ],
    ids=["empty", "head", "half", "zeros", "one bit"],
)
def test_damaged_code_in_the_cache_is_compiled_again(
    kept_code: Path, monkeypatch: pytest.MonkeyPatch, damaged: Callable[[bytes], bytes]
) -> None:
    assert compilations(monkeypatch) == 0
    kept_code.write_bytes(damaged(kept_code.read_bytes()))
    assert compilations(monkeypatch) == 1
    assert compilations(monkeypatch) == 0


def test_code_of_another_law_is_not_taken(kept_code: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    other = kept_code.with_name("other.o")
    kept_code.rename(other)
    assert compilations(monkeypatch) == 1
    other.write_bytes(kept_code.read_bytes())
    assert compiled._stored(kept_code)
    assert not compiled._stored(other)


def test_a_cache_deleted_meanwhile_is_done_without(
    kept_code: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = kept_code.parent
    monkeypatch.setattr(compiled, "cache_folder", lambda: folder)
    rmtree(folder)
    assert compilations(monkeypatch) == 1
    assert not folder.exists()


def test_code_that_cannot_be_stored_leaves_no_file(kept_code: Path) -> None:
    folder = kept_code.parent
    kept_code.unlink()
    kept_code.mkdir()
    compiled._store(kept_code, b"code")
    assert list(folder.iterdir()) == [kept_code]


def test_without_a_home_folder_nothing_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    def no_home() -> Path:
        raise RuntimeError("Could not determine home directory.")

    for name in ("CALM_CACHE_DIR", "NUMBA_CACHE_DIR", "XDG_CACHE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(Path, "home", no_home)
    assert compiled.cache_folder.__wrapped__() is None


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
def test_a_fork_waits_for_a_compilation(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled, "cache_folder", lambda: None)
    monkeypatch.setattr(compiled, "_entries", {})
    begun = Event()
    monkeypatch.setattr(compiled, "on_compilation", [begun.set])
    thread = Thread(target=compiled.outcome, args=(drag_share, True, *ARGUMENTS))
    thread.start()
    begun.wait()
    child = os.fork()
    if child == 0:
        os._exit(0 if compiled._lock.acquire(timeout=5.0) else 1)
    assert os.waitpid(child, 0)[1] == 0
    thread.join()


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


def test_the_line_solver_is_loaded_before_a_fork(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled, "_entries", {})
    monkeypatch.setenv("CALM_COMPILED", "never")
    load_line_solver()
    assert not compiled._entries
    monkeypatch.setenv("CALM_COMPILED", "always")
    load_line_solver()
    assert {run_search, pass_line} <= compiled._entries.keys()
