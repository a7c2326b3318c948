"""Where compiled laws are kept."""

from pathlib import Path

import pytest

from calm.physics import compiled


def test_a_folder_that_cannot_be_written_is_done_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "file"
    file.write_text("")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(file / "below"))
    compiled.cache_folder.cache_clear()
    assert compiled.cache_folder() is None
    doubled = compiled.compiled(lambda x: 2.0 * x)
    compiled.cache_folder.cache_clear()
    assert doubled(1.5) == 3.0


def test_compiled_code_is_kept_where_the_user_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
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
