import os
from pathlib import Path

from calm.whole_file import FileCache


def aged(path: Path, text: str, seconds: float = 100.0) -> Path:
    """A file written some time ago."""
    path.write_text(text)
    then = path.stat().st_mtime - seconds
    os.utime(path, (then, then))
    return path


def test_files_are_read_again_only_where_they_changed(tmp_path: Path) -> None:
    read = []
    path = aged(tmp_path / "a", "1")
    last: FileCache[int] = FileCache()

    def of(*paths: Path) -> int:
        return last.of(paths, lambda: read.append(1) or len(read))

    assert [of(path), of(path)] == [1, 1]
    aged(path, "22")
    assert [of(path), of(path)] == [2, 2]
    aged(path, "33", seconds=50.0)  # as long as it was
    assert [of(path), of(path)] == [3, 3]
    other = aged(tmp_path / "b", "1")
    assert [of(path, other), of(path)] == [4, 5]


def test_a_file_just_written_may_be_written_again(tmp_path: Path) -> None:
    path, read = tmp_path / "a", []
    path.write_text("1")
    last: FileCache[None] = FileCache()
    for _ in range(2):
        last.of([path], lambda: read.append(1))
    assert len(read) == 2


def test_files_that_are_not_there_are_asked_for_each_time(tmp_path: Path) -> None:
    read: list[int] = []
    last: FileCache[None] = FileCache()
    for _ in range(2):
        last.of([tmp_path / "none"], lambda: read.append(1))
    assert len(read) == 2
