"""Batches that are killed, stopped, or find no room: what is left, and what becomes of it."""

import errno
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from threading import Event

import pytest

from calm.batch import finished
from calm.batch import run as run_module
from calm.batch import work as work_module
from calm.batch.run import BatchOutcome, run_batch
from calm.batch.statuses import Ending
from calm.batch.work import Progress
from tests.unit.batch.made import MadeRecord, content, made_mooring

pytestmark = pytest.mark.thorough

KILLED = Path(__file__).with_name("killed.py")


@pytest.fixture
def mooring(tmp_path):
    return made_mooring(tmp_path)


@pytest.fixture
def record():
    return MadeRecord()


@pytest.mark.parametrize("ending", [".nc", ".zarr"])
def test_what_is_done_is_not_done_again(tmp_path, mooring, record, ending):
    output, undisturbed = tmp_path / f"r{ending}", tmp_path / f"undisturbed{ending}"
    run_batch(mooring, record, undisturbed, block=8)

    def stop(progress):
        if progress.done >= 24:
            raise KeyboardInterrupt

    first = run_batch(mooring, record, output, workers=1, block=8, progress=stop)
    assert (first.done, first.reason) == (False, "interrupted")
    assert not output.exists()
    asked, told = [], []
    read = record.profiles
    record.profiles = lambda start, stop: asked.append(start) or read(start, stop)
    second = run_batch(mooring, record, output, workers=1, block=8, progress=told.append)
    assert second.done
    assert asked == [24, 32]
    ended = {**dict.fromkeys(Ending, 0), Ending.SOLVED: 23, Ending.NO_DATA: 1}
    assert told[0] == Progress(done=24, total=40, found=24, endings=ended)
    assert content(output) == content(undisturbed)
    third = run_batch(mooring, record, output, block=8)
    assert asked == [24, 32]
    assert third == second


@pytest.mark.parametrize("ending", [".nc", ".zarr"])
@pytest.mark.parametrize(
    "how", ["4", *(pytest.param(how, marks=pytest.mark.slow) for how in ("20", "steps"))]
)
@pytest.mark.skipif(sys.platform == "win32", reason="kills processes as POSIX has them")
def test_killed_at_any_moment_it_finishes_to_the_same_bytes(tmp_path, ending, how):
    # in memory where there is such a folder: a killed process leaves the disk to the system anyway
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(dir=memory if os.access(memory, os.W_OK) else None) as folder:
        command = [sys.executable, KILLED, folder, ending, how]
        finished = subprocess.run(command, capture_output=True, text=True, check=False)
    assert finished.returncode == 0, finished.stderr
    told = json.loads(finished.stdout.splitlines()[-1])
    assert told["same"], told
    assert told["kept"] >= (20 if how == "steps" else int(how))
    assert told["hit"] >= told["kept"]


def undisturbed(folder, mooring, record, ending=".nc", block=4):
    """What comes of it when nothing happens."""
    output = folder / f"undisturbed{ending}"
    run_batch(mooring, record, output, block=block)
    return content(output)


@pytest.mark.parametrize("ending", [".nc", ".zarr"])
@pytest.mark.parametrize("room", [0, 1, 20, 45, 60, 200, 270])
def test_a_full_disk_stops_it_and_keeps_what_is_done(
    tmp_path, mooring, record, monkeypatch, room, ending
):
    """Files from the first on: the metadata are some 60, and the chunks of a block 23."""
    output = tmp_path / f"r{ending}"
    opened, left = Path.open, [room]

    def full(path, mode="r", *arguments, **options):
        if "w" in mode:
            left[0] -= 1
            if left[0] < 0:
                with opened(path, mode, *arguments, **options) as file:
                    file.write(b"abc")
                raise OSError(errno.ENOSPC, "as the system has it")
        return opened(path, mode, *arguments, **options)

    with monkeypatch.context() as patched:
        patched.setattr(Path, "open", full)
        outcome = run_batch(mooring, record, output, workers=1, block=4)
    assert not outcome.done
    assert outcome.reason == "No space left on device"
    kept = sum(outcome.counts.values())
    assert kept == 0 if room <= 60 else kept > 0
    assert run_batch(mooring, record, output, block=4).done
    assert content(output) == undisturbed(tmp_path, mooring, record, ending)
    assert not list(tmp_path.glob("*.part*"))


@pytest.mark.parametrize("step", [11_987, pytest.param(1999, marks=pytest.mark.slow)])
@pytest.mark.skipif(sys.platform == "win32", reason="limits files as POSIX has it")
def test_a_disk_that_is_full_at_any_byte_of_a_netcdf_file(tmp_path, mooring, record, step):
    """HDF5 does not survive a write that fails: in a process of its own, which is to end well."""
    program = (
        "import resource, signal, sys\n"
        "from pathlib import Path\n"
        "from calm.batch.run import run_batch\n"
        "from tests.unit.batch.made import MadeRecord, content, made_mooring\n"
        "folder, step = Path(sys.argv[1]), int(sys.argv[2])\n"
        "mooring, output = made_mooring(folder), folder / 'r.nc'\n"
        "run_batch(mooring, MadeRecord(), folder / 'u.nc', block=4)\n"
        "whole = content(folder / 'u.nc')\n"
        "size = len(whole[''])\n"
        "for limit in [*range(1500, size, step), size - 1]:\n"
        "    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))\n"
        "    outcome = run_batch(mooring, MadeRecord(), output, block=4)\n"
        "    assert (outcome.done, outcome.reason) == (False, 'File too large'), (limit, outcome)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY,) * 2)\n"
        "assert run_batch(mooring, MadeRecord(), output, block=4).done\n"
        "assert content(output) == whole\n"
        "print(size)\n"
    )
    finished = subprocess.run(
        [sys.executable, "-c", program, tmp_path, str(step)], cwd=Path(__file__).parents[3],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert finished.returncode == 0, finished.stderr
    assert int(finished.stdout) > 40_000


@pytest.mark.parametrize("ending", [".nc", ".zarr"])
@pytest.mark.parametrize("size", [True, False], ids=["cut short", "changed"])
def test_a_block_damaged_at_the_last_moment_is_solved_again(
    tmp_path, mooring, record, monkeypatch, ending, size
):
    output, told = tmp_path / f"r{ending}", []
    undamaged = undisturbed(tmp_path, mooring, record, ending)
    finish = finished.finish

    def damaged(store, output, check):
        if not told:
            for name in ("tilt/0.0", "status/5"):
                chunk = store.folder / name
                data = chunk.read_bytes()
                chunk.write_bytes(data[:-2] if size else data[:-1] + bytes([data[-1] ^ 1]))
        return finish(store, output, check)

    monkeypatch.setattr(finished, "finish", damaged)
    outcome = run_batch(mooring, record, output, block=4, tell=told.append)
    assert outcome.done
    assert sum(outcome.counts.values()) == 40
    assert told == ["2 blocks were damaged on the disk; they are solved again"]
    assert content(output) == undamaged


def test_a_disk_that_keeps_nothing_is_given_up(tmp_path, mooring, record, monkeypatch):
    monkeypatch.setattr(finished, "finish", lambda *_: [0])
    outcome = run_batch(mooring, record, tmp_path / "r.nc", block=8)
    assert not outcome.done
    assert "does not keep what is written" in outcome.reason


def test_the_lock_is_held_until_the_last_thread_has_ended(tmp_path, mooring, record, monkeypatch):
    """Ctrl-C twice while a thread writes: nobody may begin before it is done."""
    output = tmp_path / "r.nc"
    keep = work_module.BatchWork._keep
    at_it, interrupted, alive = Event(), [], []

    def slowly(self, number, parts):
        at_it.set()
        threading.Event().wait(0.3)
        keep(self, number, parts)

    join = threading.Thread.join

    def interrupt(thread, timeout=None):
        main = threading.current_thread() is threading.main_thread()
        if main and thread.daemon and len(interrupted) < 2:  # the others are of pools
            at_it.wait()
            interrupted.append(thread)
            raise KeyboardInterrupt
        join(thread, timeout)

    locked = finished.locked

    def watched(*arguments):
        class Watched:
            def __enter__(self):
                self.held = locked(*arguments)
                self.held.__enter__()

            def __exit__(self, *error):
                alive.extend(thread.is_alive() for thread in interrupted)
                return self.held.__exit__(*error)

        return Watched()

    with monkeypatch.context() as patched:
        patched.setattr(work_module.BatchWork, "_keep", slowly)
        patched.setattr("calm.batch.work.Thread.join", interrupt)
        patched.setattr(finished, "locked", watched)
        outcome = run_batch(mooring, record, output, workers=1, block=8)
    assert (outcome.done, outcome.reason) == (False, "interrupted")
    assert alive == [False, False]
    # the block under way is kept
    assert sum(outcome.counts.values()) == 8


def test_another_number_of_workers_goes_on_with_it(tmp_path, mooring, record):
    output = tmp_path / "r.nc"
    for workers, limit in ((1, 8), (3, 20), (2, 99)):

        def stop(progress, limit=limit):
            if progress.done >= limit:
                raise KeyboardInterrupt

        outcome = run_batch(mooring, record, output, workers=workers, block=4, progress=stop)
    assert outcome.done
    assert content(output) == undisturbed(tmp_path, mooring, record)


@pytest.mark.parametrize("ending", [".nc", ".zarr"])
def test_what_happens_behind_the_end_is_no_failure(tmp_path, mooring, record, monkeypatch, ending):
    """The result has its name: what the work left may stay, and goes the next time."""
    output = tmp_path / f"r{ending}"
    for error in (OSError(errno.EACCES, "no"), KeyboardInterrupt()):

        def fail(path, error=error):
            raise error

        with monkeypatch.context() as patched:
            patched.setattr(finished, "clear", fail)
            assert run_batch(mooring, record, output, block=8).done
        assert list(output.rglob(".batch")) or list(tmp_path.glob("*.part"))
        (tmp_path / f"r{ending}.part.lock").touch()  # as of a process killed at its very last
        assert run_batch(mooring, record, output, block=8).done
        assert sorted(path.name for path in tmp_path.iterdir()) == ["m.yaml", output.name]
        assert not list(output.rglob(".batch"))
        shutil.rmtree(output) if output.is_dir() else output.unlink()


def test_an_empty_folder_of_work_goes_with_the_result(tmp_path, mooring, record):
    output = tmp_path / "r.nc"
    run_batch(mooring, record, output, block=8)
    (tmp_path / "r.nc.part").mkdir()
    assert run_batch(mooring, record, output, block=8).done
    assert not (tmp_path / "r.nc.part").exists()


def test_a_result_of_somebody_else_in_the_meantime_is_taken(tmp_path, mooring, record, monkeypatch):
    output, locked = tmp_path / "r.nc", finished.locked

    def later(folder, tell):
        with monkeypatch.context() as patched:
            patched.setattr(finished, "locked", locked)
            run_batch(mooring, record, output, block=8)
        return locked(folder, tell)

    monkeypatch.setattr(finished, "locked", later)
    monkeypatch.setattr(run_module, "BatchWork", None)
    with pytest.raises(TypeError):
        run_batch(mooring, record, tmp_path / "other.nc", block=8)
    monkeypatch.undo()
    calls = []

    def once(folder, tell):
        if not calls:
            calls.append(folder)
            run_batch(mooring, record, output, block=8)
            before.append(output.stat().st_mtime_ns)
        return locked(folder, tell)

    before = []
    monkeypatch.setattr(finished, "locked", once)
    assert run_batch(mooring, record, output, block=8).counts["converged"] == 39
    assert output.stat().st_mtime_ns == before[0]
    assert not (tmp_path / "r.nc.part").exists()


def test_ctrl_c_while_the_record_is_read_through(tmp_path, mooring, record):
    def digest(check):
        raise KeyboardInterrupt

    record.digest = digest
    assert run_batch(mooring, record, tmp_path / "r.nc") == BatchOutcome({}, False, "interrupted")


def test_an_event_ends_it_wherever_it_is(tmp_path, mooring, record):
    """While the record is read through, in a block, and as the result is made."""
    output, stop = tmp_path / "r.nc", Event()
    record.digest = lambda check: (stop.set(), check())
    assert run_batch(mooring, record, output, stop=stop) == BatchOutcome({}, False, "interrupted")
    del record.digest
    for limit in (0, 16, 40):
        stop.clear()

        def tell(progress, limit=limit):
            if progress.done >= limit:
                stop.set()

        outcome = run_batch(mooring, record, output, workers=1, block=8, progress=tell, stop=stop)
        assert (outcome.done, outcome.reason) == (False, "interrupted")
        assert sum(outcome.counts.values()) == limit
    assert run_batch(mooring, record, output, block=8).done
    assert content(output) == undisturbed(tmp_path, mooring, record, block=8)


def test_an_interrupt_while_compiling_ends_as_any_other(tmp_path):
    """Numba compiles by `exec`: CPython remembers an interrupt in one, though it was caught."""
    program = (
        "import sys\n"
        "from pathlib import Path\n"
        "from calm.batch.run import run_batch\n"
        "from tests.unit.batch.made import MadeRecord, made_mooring\n"
        "def interrupted(check):\n"
        "    exec('raise KeyboardInterrupt')\n"
        "record, folder = MadeRecord(), Path(sys.argv[1])\n"
        "record.digest = interrupted\n"
        "sys.exit(75 if not run_batch(made_mooring(folder), record, folder / 'r.nc').done else 0)\n"
    )
    (tmp_path / "program.py").write_text(program)
    done = subprocess.run(
        [sys.executable, "-m", "program", tmp_path], cwd=tmp_path, check=False,
        env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[3])},
    )  # fmt: skip
    assert done.returncode == 75
