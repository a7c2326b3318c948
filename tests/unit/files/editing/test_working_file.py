"""A file is saved whole or not at all, and unsaved work outlives a session that is killed."""

import json
import os
import stat
import subprocess
import sys
import time
from pathlib import Path

import pytest

from calm.errors import InputError
from calm.files.editing import NotWritten, WorkingFile

ROOT = Path(__file__).resolve().parents[4]


@pytest.fixture
def path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    folder = tmp_path / "folder"
    folder.mkdir()
    path = folder / "line.yaml"
    path.write_bytes("\ufeffname: é\r\n".encode())
    return path


def test_text_is_read_and_saved_byte_for_byte(path: Path) -> None:
    before = path.read_bytes()
    file = WorkingFile(path)
    text = file.read()
    assert text == "\ufeffname: é\r\n"
    file.save(text)
    assert path.read_bytes() == before
    assert list(path.parent.iterdir()) == [path]


def test_what_is_no_text_is_refused(path: Path) -> None:
    path.write_bytes(b"\0")
    with pytest.raises(InputError, match="binary"):
        WorkingFile(path).read()
    with pytest.raises(InputError, match="no such file"):
        WorkingFile(path.with_name("other")).read()


def test_permissions_and_links_stay(path: Path) -> None:
    path.chmod(0o640)
    link = path.with_name("link.yaml")
    link.symlink_to(path.name)
    file = WorkingFile(link)
    beside = kept(file, "name: x\n")
    assert beside.name.startswith(".line.yaml.")
    assert stat.S_IMODE(beside.stat().st_mode) == 0o640
    assert file.save("name: new\n") == ""
    assert link.is_symlink() and path.read_text() == "name: new\n"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_what_a_new_file_cannot_take_over_is_told(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = WorkingFile(path)
    other = path.with_name("other.yaml")
    os.link(path, other)
    assert "hard links to the file keep the old text" in file.save("name: a\n")
    assert other.read_text() != "name: a\n"

    really = Path.stat
    mine = os.stat_result

    def foreign(one: Path, **options: bool) -> os.stat_result:
        status = really(one, **options)
        is_old = one == path and path.read_text() == "name: a\n"
        return mine([*status[:4], 12345, *status[5:]]) if is_old else status

    monkeypatch.setattr(Path, "stat", foreign)
    monkeypatch.setattr(os, "chown", refuse)
    assert "owner or group of the file could not be preserved" in file.save("name: b\n")


def refuse(*_: object) -> None:
    raise PermissionError(1, "Operation not permitted")


def test_a_protected_file_is_known(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = WorkingFile(path)
    assert not file.is_protected
    monkeypatch.setattr(os, "access", lambda *_: False)  # an administrator may write everything
    assert file.is_protected
    assert not WorkingFile(path.with_name("new.yaml")).is_protected


def test_the_folder_is_told_to_last(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    settled = []
    really = os.fsync

    def note(descriptor: int) -> None:
        settled.append(stat.S_ISDIR(os.fstat(descriptor).st_mode))
        really(descriptor)

    monkeypatch.setattr(os, "fsync", note)
    WorkingFile(path).save("name: x\n")
    assert settled == [False, True]


def test_another_programs_change_is_noticed(path: Path) -> None:
    file = WorkingFile(path)
    file.read()
    os.utime(path)
    assert not file.changed_on_disk()
    path.write_text("name: other\n")
    assert file.changed_on_disk()
    file.save("name: mine\n")
    assert not file.changed_on_disk()
    path.unlink()
    assert file.changed_on_disk()


def test_a_change_while_the_file_is_read_is_noticed(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = WorkingFile(path)
    really = Path.read_bytes

    def read_and_change(one: Path) -> bytes:
        content = really(one)
        one.write_text("name: other\n")
        return content

    with monkeypatch.context() as during:
        during.setattr(Path, "read_bytes", read_and_change)
        assert file.read() == "\ufeffname: é\r\n"
    assert file.changed_on_disk()


def test_a_file_that_did_not_change_is_not_read_again(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    os.utime(path, (1e9, 1e9))
    file = WorkingFile(path)
    file.read()
    assert not file.changed_on_disk()
    monkeypatch.setattr(Path, "read_bytes", refuse)
    assert not file.changed_on_disk()
    os.utime(path, (1e9, 1e9 + 1))
    assert file.changed_on_disk()  # it cannot be read now


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes with a name")
def test_what_is_no_regular_file_is_not_opened(path: Path) -> None:
    file = WorkingFile(path)
    file.read()
    path.unlink()
    os.mkfifo(path)
    with pytest.raises(InputError, match="not a regular file"):
        WorkingFile(path).read()
    assert file.changed_on_disk()
    assert file.recoverable_work() is None


def test_a_file_that_is_new(path: Path) -> None:
    new = path.with_name("new.yaml")
    file = WorkingFile(new)
    assert not file.changed_on_disk() and file.recoverable_work() is None
    file.save("name: new\n")
    assert new.read_text() == "name: new\n"


def test_unsaved_work_is_offered_until_it_is_forgotten(path: Path) -> None:
    text = WorkingFile(path).read()
    assert WorkingFile(path).recoverable_work() is None
    place = left_by_another(path, text + "# more\r\n")
    assert place.parent == path.parent
    file = WorkingFile(path)
    file.read()
    found = file.recoverable_work()
    assert found is not None and found.text == text + "# more\r\n" and found.place == place
    assert not file.is_of_another(found)
    file.adopt(found)
    assert not file.changed_on_disk()
    file.keep()  # nothing is unsaved: this removes no work of others
    assert place.exists()
    file.forget()
    assert list(path.parent.iterdir()) == [path]


def test_work_that_is_in_the_file_is_not_offered(path: Path) -> None:
    place = left_by_another(path, path.read_bytes().decode())
    assert WorkingFile(path).recoverable_work() is None
    assert not place.exists()


def test_work_on_another_text_is_told(path: Path) -> None:
    left_by_another(path, "name: mine\n")
    path.write_text("name: theirs\n")
    file = WorkingFile(path)
    file.read()
    found = file.recoverable_work()
    assert found is not None and file.is_of_another(found)
    file.adopt(found)
    assert file.changed_on_disk()
    file.save(found.text)
    assert not file.changed_on_disk()


def test_the_latest_work_is_offered_first(path: Path) -> None:
    for age, name in ((3, "old"), (1, "new"), (2, "middle")):
        os.utime(left_by_another(path, f"name: {name}\n"), (1e9 - age, 1e9 - age))
    found = WorkingFile(path).recoverable_work()
    assert found is not None and found.text == "name: new\n" and found.at == 1e9 - 1


def test_a_running_session_keeps_its_work_to_itself(path: Path) -> None:
    first, second = WorkingFile(path), WorkingFile(path)
    of_first = kept(first, "name: first\n")
    assert second.is_open_elsewhere() and not first.is_open_elsewhere()
    assert second.recoverable_work() is None
    of_second = kept(second, "name: second\n")
    second.forget()
    assert of_first.exists() and not of_second.exists()


def test_a_process_number_that_is_given_again_is_another(path: Path) -> None:
    place = kept(WorkingFile(path), "name: mine\n")
    assert WorkingFile(path).recoverable_work() is None
    rewrite(place, started="1")
    assert WorkingFile(path).recoverable_work() is not None


def test_a_killed_session_that_nobody_has_asked_after_is_gone(path: Path) -> None:
    command = [sys.executable, "-c", UNTIL_KILLED, str(path)]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE) as session:
        assert session.stdout is not None
        session.stdout.readline()
        assert WorkingFile(path).is_open_elsewhere()
        session.kill()
        session.stdout.read()  # it ends with the process, whose status is not read
        deadline = time.monotonic() + 600.0
        while WorkingFile(path).is_open_elsewhere():
            assert time.monotonic() < deadline
        assert WorkingFile(path).recoverable_work() is not None


UNTIL_KILLED = """
import signal, sys
from calm.files.editing import WorkingFile

file = WorkingFile(sys.argv[1])
file.unsaved = "name: mine"
file.keep()
print("ready", flush=True)
signal.pause()
"""


def test_a_session_on_another_machine_is_named(path: Path) -> None:
    rewrite(kept(WorkingFile(path), "name: mine\n"), host="elsewhere")
    found = WorkingFile(path).recoverable_work()
    assert found is not None and found.keeper.host == "elsewhere" and not found.keeper.is_here


def test_only_copies_are_read(path: Path) -> None:
    for name, content in {
        ".line.yaml.0123abcd.calm-autosave": b"name: no record\n",
        ".line.yaml.0123abce.calm-autosave": b"# calm build: not saved; {}\nname: x\n",
        ".line.yaml.0123abcf.calm-autosave": b"# calm build: not saved; [\xff\n",
        ".line.yaml.old.0123abcd.calm-autosave": b"another file's",
    }.items():
        path.with_name(name).write_bytes(content)
    assert WorkingFile(path).recoverable_work() is None


def kept(file: WorkingFile, text: str) -> Path:
    """Where a session that runs keeps a text."""
    file.unsaved = text
    place = file.keep()
    assert place is not None
    return place


def rewrite(place: Path, **changes: object) -> Path:
    """Change the record of a copy."""
    record, _, text = place.read_bytes().decode().partition("\n")
    begin, _, values = record.partition("{")
    changed = json.dumps(json.loads("{" + values) | changes)
    place.write_bytes(f"{begin}{changed}\n{text}".encode())
    return place


def left_by_another(path: Path | None, text: str) -> Path:
    """Where a session that has ended kept a text."""
    file = WorkingFile(path)
    if path is not None:
        file.read()
    return rewrite(kept(file, text), process=ended_process())


def ended_process() -> int:
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


def test_a_folder_that_cannot_be_written_loses_nothing(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    refuse_writing_in(path.parent, monkeypatch)
    file = WorkingFile(path)
    before = path.read_bytes()
    with pytest.raises(NotWritten, match="Permission denied"):
        file.save("name: lost?\n")
    assert path.read_bytes() == before
    place = left_by_another(path, "name: kept\n")
    assert place.parent == path.parents[1] / "state" / "calm"
    found = WorkingFile(path).recoverable_work()
    assert found is not None and found.text == "name: kept\n"
    refuse_writing_in(path.parents[1], monkeypatch)
    with pytest.raises(NotWritten, match="cannot be stored"):
        kept(file, "name: kept\n")


def refuse_writing_in(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Permissions do not stop an administrator, as whom tests may run."""
    really_open = os.open

    def refusing(path: object, flags: int, *rest: int) -> int:
        if flags & os.O_CREAT and str(path).startswith(f"{folder}{os.sep}"):
            raise PermissionError(13, "Permission denied")
        return really_open(path, flags, *rest)

    monkeypatch.setattr(os, "open", refusing)


def test_a_folder_is_no_file(path: Path) -> None:
    with pytest.raises(NotWritten, match="not a regular file"):
        WorkingFile(path.parent).save("name: x\n")


def test_work_without_a_name_is_offered_once_its_session_is_gone(path: Path) -> None:
    mine = kept(WorkingFile(None), "name: mine\n")
    assert WorkingFile(None).recoverable_work() is None
    rewrite(mine, process=ended_process())
    later = WorkingFile(None)
    found = later.recoverable_work()
    assert found is not None and found.text == "name: mine\n"
    later.discard(found)
    assert WorkingFile(None).recoverable_work() is None


def test_a_long_name_leaves_room_for_the_copy(path: Path) -> None:
    long = path.with_name("n" * 240 + ".yaml")
    long.write_text("name: long\n")
    left_by_another(long, "name: kept\n")
    found = WorkingFile(long).recoverable_work()
    assert found is not None and found.text == "name: kept\n"


KILLS = """
import os, random, signal, sys, time
from calm.files.editing import WorkingFile

path = sys.argv[1]
file = WorkingFile(path)
file.save("#\\n" * 20_000)
wait = random.Random(7)
for _ in range(40):
    kept, tell = os.pipe()
    child = os.fork()
    number = 0
    while not child:
        number += 1
        file.save(f"# {number}\\n" * 20_000)
        file.unsaved = f"# {number} and more\\n" * 20_000
        file.keep()
        os.write(tell, b".") if number == 1 else None
    os.read(kept, 1)
    os.close(kept), os.close(tell)
    time.sleep(wait.uniform(0.0, 0.03))
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    folder = os.path.dirname(path)
    kept = [name for name in os.listdir(folder) if name.endswith(".calm-autosave")]
    for written in (path, *(os.path.join(folder, name) for name in kept)):
        with open(written) as stream:
            lines = [line for line in stream if "not saved" not in line]
        assert len(lines) == 20_000 and len(set(lines)) == 1, written
"""


@pytest.mark.thorough
def test_a_kill_leaves_whole_files(path: Path) -> None:
    """A session is killed at random while it saves and autosaves without a pause.

    It has done both once before, however busy the machine is.
    """
    subprocess.run([sys.executable, "-c", KILLS, str(path)], cwd=ROOT, check=True)
    assert WorkingFile(path).recoverable_work() is not None


def test_parts_of_killed_sessions_are_swept(path: Path) -> None:
    names = (".line.yaml.1-0.calm-part", "..line.yaml.0123abcd.calm-autosave.1-2.calm-part")
    old = [path.with_name(name) for name in names]
    for part in old:
        part.write_text("half")
        os.utime(part, (0, 0))
    recent = path.with_name(".line.yaml.1-1.calm-part")
    recent.write_text("half")
    WorkingFile(path).read()
    assert recent.exists() and not any(part.exists() for part in old)
