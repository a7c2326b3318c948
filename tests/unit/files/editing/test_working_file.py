"""A file is saved whole or not at all, and unsaved work outlives a session that is killed."""

import os
import signal
import stat
import subprocess
import sys
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
    file.autosave("name: x\n")
    beside = link.with_name(".link.yaml.calm-autosave")
    assert stat.S_IMODE(beside.stat().st_mode) == 0o640
    file.save("name: new\n")
    assert link.is_symlink() and path.read_text() == "name: new\n"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


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


def test_a_file_that_is_new(path: Path) -> None:
    new = path.with_name("new.yaml")
    file = WorkingFile(new)
    assert not file.changed_on_disk() and file.recovered() is None
    file.save("name: new\n")
    assert new.read_text() == "name: new\n"


def test_unsaved_work_is_offered_until_it_is_forgotten(path: Path) -> None:
    file = WorkingFile(path)
    text = file.read()
    assert file.recovered() is None
    assert file.autosave(text + "# more\r\n") == path.with_name(".line.yaml.calm-autosave")
    other = WorkingFile(path)
    assert other.recovered() == text + "# more\r\n"
    other.forget()
    assert other.recovered() is None
    assert list(path.parent.iterdir()) == [path]
    file.autosave(text)
    assert WorkingFile(path).recovered() is None


def test_a_folder_that_cannot_be_written_loses_nothing(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    refuse_writing_in(path.parent, monkeypatch)
    file = WorkingFile(path)
    before = path.read_bytes()
    with pytest.raises(NotWritten, match="Permission denied"):
        file.save("name: lost?\n")
    assert path.read_bytes() == before
    kept = file.autosave("name: kept\n")
    assert kept.parent == path.parents[1] / "state" / "calm"
    assert WorkingFile(path).recovered() == "name: kept\n"
    refuse_writing_in(path.parents[1], monkeypatch)
    with pytest.raises(NotWritten, match="cannot be kept"):
        file.autosave("name: kept\n")


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
    mine = WorkingFile(None)
    place = mine.autosave("name: mine\n")
    assert WorkingFile(None).recovered() is None
    place.rename(place.with_name(f"unnamed-{ended_process()}.calm-autosave"))
    later = WorkingFile(None)
    assert later.recovered() == "name: mine\n"
    later.forget()
    assert WorkingFile(None).recovered() is None


def ended_process() -> int:
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


KILLS = """
import os, random, signal, sys, time
from calm.files.editing import WorkingFile

path = sys.argv[1]
beside = os.path.join(os.path.dirname(path), ".line.yaml.calm-autosave")
file = WorkingFile(path)
file.save("#\\n" * 20_000)
wait = random.Random(7)
for _ in range(40):
    child = os.fork()
    number = 0
    while not child:
        number += 1
        text = f"# {number}\\n" * 20_000
        file.save(text)
        file.autosave(text)
    time.sleep(wait.uniform(0.0, 0.03))
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    for written in filter(os.path.exists, (path, beside)):
        with open(written) as stream:
            lines = stream.readlines()
        assert len(lines) == 20_000 and len(set(lines)) == 1, written
"""


def test_a_kill_leaves_whole_files(path: Path) -> None:
    """A session is killed at random while it saves and autosaves without a pause."""
    subprocess.run([sys.executable, "-c", KILLS, str(path)], cwd=ROOT, check=True)
    assert path.with_name(".line.yaml.calm-autosave").exists()


HANDLER = """
import os, signal, sys
from calm.files.editing import WorkingFile
file = WorkingFile(sys.argv[1])

def keep(number, frame):
    file.autosave("name: from the handler\\n")
    os._exit(0)

signal.signal(signal.SIGHUP, keep)
print("ready", flush=True)
while True:
    file.autosave("name: from the session\\n" * 5_000)
"""


def test_a_signal_handler_can_keep_the_work(path: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", HANDLER, str(path)], cwd=ROOT, stdout=subprocess.PIPE
    )
    assert process.stdout is not None
    process.stdout.readline()
    process.send_signal(signal.SIGHUP)
    assert process.wait() == 0
    process.stdout.close()
    assert WorkingFile(path).recovered() == "name: from the handler\n"


def test_parts_of_killed_sessions_are_swept(path: Path) -> None:
    names = (".line.yaml.1-0.calm-part", "..line.yaml.calm-autosave.1-2.calm-part")
    old = [path.with_name(name) for name in names]
    for part in old:
        part.write_text("half")
        os.utime(part, (0, 0))
    recent = path.with_name(".line.yaml.1-1.calm-part")
    recent.write_text("half")
    WorkingFile(path).read()
    assert recent.exists() and not any(part.exists() for part in old)
