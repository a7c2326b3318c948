"""Where compiled laws are kept."""

from pathlib import Path

import pytest

from calm.physics import compiled
from calm.physics.drag import drag_share


def test_a_folder_that_cannot_be_written_is_done_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "file"
    file.write_text("")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(file / "below"))
    compiled.cache_folder.cache_clear()
    assert compiled.cache_folder() is None
    doubled = compiled.entry(lambda x: 2.0 * x, 1.5)
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


@pytest.mark.parametrize("newest", [compiled.NEWEST, (0, 0)])
def test_laws_linked_into_a_law_give_its_digits(
    newest: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """By parts of numba that are not for everyone, and by those that are."""
    monkeypatch.setattr(compiled, "NEWEST", newest)
    monkeypatch.setattr(compiled, "cache_folder", lambda: None)
    monkeypatch.setattr(compiled, "_entries", {})
    stores = (compiled.called, compiled._law_compiler)
    for store in stores:
        store.cache_clear()
    arguments = (0.3, -0.1, 0.9, 0.7, 0.5, -0.2, 0.1)
    try:
        assert compiled.outcome(drag_share, True, *arguments) == drag_share(*arguments)
    finally:
        for store in stores:
            store.cache_clear()
