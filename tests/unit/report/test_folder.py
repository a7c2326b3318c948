import errno
import os
from pathlib import Path

import pytest

from calm.errors import UsageError
from calm.report.folder import check_folder, write_report

REPORT = {"report.html": b"new page", "report.json": b"new data"}


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_makes_the_folder_and_writes_every_file(tmp_path):
    folder = tmp_path / "cruise" / "north"
    check_folder(folder)
    write_report(folder, REPORT)
    assert contents(folder) == REPORT


def test_replaces_a_report_and_keeps_what_is_no_part_of_it(tmp_path):
    (tmp_path / "report.html").write_bytes(b"old page")
    (tmp_path / "notes.txt").write_bytes(b"mine")
    write_report(tmp_path, REPORT)
    assert contents(tmp_path) == {**REPORT, "notes.txt": b"mine"}


def test_a_full_disk_leaves_the_old_report_whole(tmp_path, monkeypatch):
    old = {"report.html": b"old page", "report.json": b"old data"}
    write_report(tmp_path, old)
    write = Path.write_bytes

    def full_at_the_second(path, content):
        if "report.json" in path.name:
            write(path, content[:2])
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(path, content)

    monkeypatch.setattr(Path, "write_bytes", full_at_the_second)
    with pytest.raises(UsageError, match=r"report\.json: No space left on device"):
        write_report(tmp_path, REPORT)
    monkeypatch.undo()
    assert contents(tmp_path) == old


@pytest.mark.parametrize("failing", [1, 2, 3, 4])
@pytest.mark.parametrize("old", [{"report.html": b"old page", "report.json": b"old data"}, {}])
@pytest.mark.parametrize("error", [OSError(errno.EIO, "Input/output error"), KeyboardInterrupt()])
def test_a_report_is_replaced_as_a_set_or_not_at_all(tmp_path, monkeypatch, old, failing, error):
    """Whichever of the moves fails; of a new report there are two, of one replaced four."""
    folder = tmp_path / "report"
    if old:
        write_report(folder, old)
    moves, replace = [], os.replace

    def failing_once(source, target):
        moves.append(target)
        if len(moves) == failing:
            raise error
        replace(source, target)

    monkeypatch.setattr(os, "replace", failing_once)
    fails = failing <= (4 if old else 2)
    if fails:
        with pytest.raises(UsageError if isinstance(error, OSError) else KeyboardInterrupt):
            write_report(folder, REPORT)
    else:
        write_report(folder, REPORT)
    assert (contents(folder) if folder.exists() else {}) == (old if fails else REPORT)


def test_a_folder_in_a_files_place_is_named(tmp_path):
    (tmp_path / "report.json").mkdir()
    with pytest.raises(UsageError, match=r"report\.json: it is a folder"):
        write_report(tmp_path, REPORT)
    assert os.listdir(tmp_path) == ["report.json"]


def test_an_interruption_leaves_no_temporary_file(tmp_path, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_report(tmp_path, REPORT)
    assert os.listdir(tmp_path) == []


def test_a_file_in_the_folders_place_is_refused(tmp_path):
    path = tmp_path / "report"
    path.write_bytes(b"mine")
    with pytest.raises(UsageError, match="the output must be a folder"):
        check_folder(path)
    with pytest.raises(UsageError, match="cannot write"):
        write_report(path, REPORT)
    assert path.read_bytes() == b"mine"


def test_a_folder_below_a_file_is_refused(tmp_path):
    (tmp_path / "file").write_bytes(b"mine")
    with pytest.raises(UsageError, match="cannot write"):
        check_folder(tmp_path / "file" / "report")


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is forbidden to root")
def test_a_folder_that_may_not_be_written_is_refused(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(UsageError, match="permission denied"):
        check_folder(tmp_path / "report")
    with pytest.raises(UsageError, match="Permission denied"):
        write_report(tmp_path / "report", REPORT)
