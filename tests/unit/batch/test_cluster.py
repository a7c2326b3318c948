import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from calm.batch.run import run_batch
from calm.errors import UsageError
from tests.unit.batch.made import MadeRecord, made_mooring

distributed = pytest.importorskip("distributed")
dask = pytest.importorskip("dask")

ROOT = Path(__file__).parents[3]

# dask opens sockets and event loops in threads of its own, and leaves some to the collector: a
# warning that is raised there as an error would leave it waiting
pytestmark = [pytest.mark.thorough, pytest.mark.filterwarnings("ignore")]


@pytest.fixture
def cluster():
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0"
    ) as workers:
        yield workers


@pytest.fixture
def started(tmp_path):
    """Starts `dask scheduler` or `dask worker` as on machines of their own; ends them."""
    processes = []

    def start(*words, calm=ROOT):
        command = [sys.executable, "-m", "distributed.cli.dask_" + words[0], *words[1:]]
        process = subprocess.Popen(
            command, cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(calm)},
            stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        processes.append(process)
        return process

    yield start
    for process in processes:
        process.kill()
        process.communicate()


def address_of(scheduler):
    """Where a scheduler listens, which it says as it starts."""
    for line in scheduler.stderr:
        if "Scheduler at:" in line:
            return line.split()[-1]
    raise AssertionError("the scheduler did not start")


SCHEDULER = ("scheduler", "--port", "0", "--host", "127.0.0.1", "--no-dashboard")


def worker_of(address):
    return ("worker", address, "--nthreads", "1", "--no-dashboard", "--no-nanny")


@pytest.mark.skipif(sys.platform == "win32", reason="kills a process as POSIX has it")
def test_a_worker_killed_on_the_way_changes_nothing(tmp_path, cluster):
    mooring, record = made_mooring(tmp_path), MadeRecord(400)
    processes = [worker.pid for worker in cluster.workers.values()]
    killed = []

    def kill(progress):
        if progress.done >= 64 and not killed:
            os.kill(processes[0], signal.SIGKILL)
            killed.append(progress.done)

    there, here = tmp_path / "there.nc", tmp_path / "here.nc"
    counts = run_batch(
        mooring, record, there, block=16, scheduler=cluster.scheduler_address, progress=kill
    )
    assert killed and killed[0] < 400
    assert run_batch(mooring, record, here, block=16) == counts == {
        "converged": 399, "no-current": 1,
    }  # fmt: skip
    assert there.read_bytes() == here.read_bytes()


def test_the_first_worker_is_waited_for(tmp_path, started):
    address = address_of(started(*SCHEDULER))
    told = []

    def tell(text):
        told.append(text)
        started(*worker_of(address))

    mooring = made_mooring(tmp_path)
    counts = run_batch(
        mooring, MadeRecord(100), tmp_path / "r.nc", block=16, scheduler=address, tell=tell
    )
    assert counts["converged"] == 99
    assert told == [f"the scheduler at {address} has no workers yet; waiting for the first worker"]


@pytest.mark.skipif(sys.platform == "win32", reason="kills a process as POSIX has it")
def test_a_scheduler_killed_on_the_way_leaves_nothing(tmp_path, started):
    scheduler = started(*SCHEDULER)
    address = address_of(scheduler)
    started(*worker_of(address))
    mooring, record = made_mooring(tmp_path), MadeRecord(400)

    def kill(progress):
        if progress.done >= 64:
            scheduler.kill()

    with (
        dask.config.set({"distributed.comm.timeouts.connect": "1s"}),
        pytest.raises(UsageError, match="the connection to the scheduler or its workers was lost"),
    ):
        run_batch(mooring, record, tmp_path / "r.nc", block=16, scheduler=address, progress=kill)
    assert not (tmp_path / "r.nc").exists()


def test_calm_missing_there_is_told(tmp_path, started):
    hidden = tmp_path / "hidden"
    (hidden / "calm").mkdir(parents=True)
    (hidden / "calm" / "__init__.py").write_text("raise ImportError('no such module')\n")
    address = address_of(started(*SCHEDULER, calm=hidden))
    started(*worker_of(address), calm=hidden)
    mooring, record = made_mooring(tmp_path), MadeRecord(20)
    with pytest.raises(
        UsageError, match=r"install calm-mooring \d.* on the scheduler and on every worker"
    ):
        run_batch(mooring, record, tmp_path / "r.nc", scheduler=address)
    assert [path.name for path in tmp_path.glob("*.nc*")] == []


def test_nobody_at_the_address(tmp_path, monkeypatch):
    monkeypatch.setattr("calm.batch.cluster.PATIENCE", "0.2s")
    mooring, record = made_mooring(tmp_path), MadeRecord(20)
    for address in ("tcp://127.0.0.1:9", "nonsense"):
        with pytest.raises(UsageError, match="no scheduler answers"):
            run_batch(mooring, record, tmp_path / "r.nc", scheduler=address)
        assert [path.name for path in tmp_path.glob("*.nc*")] == []
