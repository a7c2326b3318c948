"""Batches that are killed, stopped, or find no room: the result is there whole, or not at all."""

import errno
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from calm.batch.profiles import Batch
from calm.batch.run import run_batch
from calm.dataset import netcdf
from calm.errors import UsageError
from calm.whole_file import UNFINISHED
from tests.unit.batch.made import MadeRecord, made_mooring

ROOT = Path(__file__).parents[3]


@pytest.fixture
def mooring(tmp_path):
    return made_mooring(tmp_path)


@pytest.fixture
def record():
    return MadeRecord()


@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError, ValueError])
@pytest.mark.parametrize("there", [False, True])
def test_what_ends_it_leaves_what_was_there(tmp_path, mooring, record, error, there):
    output = tmp_path / "r.nc"
    if there:
        output.write_text("before")

    def stop(progress):
        if progress.done >= 24:
            raise error

    with pytest.raises(error):
        run_batch(mooring, record, output, workers=1, block=8, progress=stop)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["m.yaml", *["r.nc"] * there]
    assert not there or output.read_text() == "before"
    assert run_batch(mooring, record, output, block=8)["converged"] == 39


def test_an_error_of_a_thread_is_that_of_the_batch(tmp_path, mooring, record, monkeypatch):
    def fail(*_, **__):
        raise MemoryError

    monkeypatch.setattr(Batch, "_solve_block", fail)
    with pytest.raises(MemoryError):
        run_batch(mooring, record, tmp_path / "r.nc", block=8)
    assert not (tmp_path / "r.nc").exists()


KILLED = """\
import sys
from pathlib import Path
from calm.batch.run import run_batch
from tests.unit.batch.made import MadeRecord, made_mooring
folder = Path(sys.argv[1])
def tell(progress):
    print(progress.done, flush=True)
    if progress.done >= 64:
        sys.stdin.read()
run_batch(made_mooring(folder), MadeRecord(400), folder / "r.nc", block=16, progress=tell)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="kills processes as POSIX has it")
@pytest.mark.thorough
def test_killed_there_is_no_half_written_result(tmp_path, mooring):
    """With SIGKILL in the middle; the same command then does it all."""
    process = subprocess.Popen(
        [sys.executable, "-c", KILLED, tmp_path], cwd=ROOT, text=True,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE,
    )  # fmt: skip
    while int(process.stdout.readline()) < 64:
        pass
    left = [path.name for path in tmp_path.iterdir() if path.name.endswith(UNFINISHED)]
    os.kill(process.pid, signal.SIGKILL)
    process.communicate()
    assert process.returncode == -signal.SIGKILL
    assert len(left) == 1 and not (tmp_path / "r.nc").exists()
    old = time.time() - 3600.0
    os.utime(tmp_path / left[0], (old, old))
    assert run_batch(mooring, MadeRecord(400), tmp_path / "r.nc", block=16)["converged"] == 399
    run_batch(mooring, MadeRecord(400), tmp_path / "u.nc", block=16)
    assert (tmp_path / "r.nc").read_bytes() == (tmp_path / "u.nc").read_bytes()
    # what the killed process left goes with the next batch, once nobody can be writing it
    assert sorted(path.name for path in tmp_path.iterdir()) == ["m.yaml", "r.nc", "u.nc"]


@pytest.mark.parametrize("room", [0, 1, 4])
def test_a_full_disk_is_told_and_leaves_nothing(tmp_path, mooring, record, monkeypatch, room):
    left, take = [room], netcdf._take_room

    def full(handle, size):
        left[0] -= 1
        if left[0] < 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        take(handle, size)

    monkeypatch.setattr(netcdf, "_take_room", full)
    with pytest.raises(UsageError, match=r"cannot write .*r\.nc: No space left on device"):
        run_batch(mooring, record, tmp_path / "r.nc", workers=1, block=4)
    assert [path.name for path in tmp_path.iterdir()] == ["m.yaml"]


@pytest.mark.thorough
@pytest.mark.parametrize("step", [11_987, pytest.param(1999, marks=pytest.mark.slow)])
@pytest.mark.skipif(sys.platform == "win32", reason="limits files as POSIX has it")
def test_a_disk_that_is_full_at_any_byte(tmp_path, mooring, record, step):
    """HDF5 does not survive a write that fails: in a process of its own, which is to end well."""
    program = (
        "import resource, sys\n"
        "from pathlib import Path\n"
        "from calm.batch.run import run_batch\n"
        "from calm.errors import UsageError\n"
        "from tests.unit.batch.made import MadeRecord, made_mooring\n"
        "folder, step = Path(sys.argv[1]), int(sys.argv[2])\n"
        "mooring, output = made_mooring(folder), folder / 'r.nc'\n"
        "run_batch(mooring, MadeRecord(), folder / 'u.nc', block=4)\n"
        "whole = (folder / 'u.nc').read_bytes()\n"
        "size = len(whole)\n"
        "for limit in [*range(1500, size, step), size - 1]:\n"
        "    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))\n"
        "    try:\n"
        "        run_batch(mooring, MadeRecord(), output, block=4)\n"
        "        sys.exit(f'written at {limit}')\n"
        "    except UsageError as error:\n"
        "        assert 'File too large' in str(error), error\n"
        "    assert not output.exists()\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY,) * 2)\n"
        "run_batch(mooring, MadeRecord(), output, block=4)\n"
        "assert output.read_bytes() == whole\n"
        "print(size)\n"
    )
    finished = subprocess.run(
        [sys.executable, "-c", program, tmp_path, str(step)], cwd=ROOT,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert finished.returncode == 0, finished.stderr
    assert int(finished.stdout) > 40_000
