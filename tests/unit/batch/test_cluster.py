import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from calm.batch import work as cluster_module
from calm.batch.run import run_batch
from calm.errors import UsageError
from tests.unit.batch.made import MadeRecord, content, made_mooring

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
    outcome = run_batch(
        mooring, record, there, block=16, shape=True, scheduler=cluster.scheduler_address,
        progress=kill,
    )  # fmt: skip
    assert outcome.done
    assert killed and killed[0] < 400
    assert run_batch(mooring, record, here, block=16, shape=True) == outcome
    assert content(there) == content(here)


def test_workers_that_come_late_get_their_share(tmp_path, started, monkeypatch):
    """The first is waited for, and that is said; with the second there is twice as much ahead."""
    monkeypatch.setattr(cluster_module, "ASKED_ANEW", 0.1)
    address = address_of(started(*SCHEDULER))
    mooring, record = made_mooring(tmp_path), MadeRecord(1600)
    told, under_way, taken, kept = [], [], [], []
    read = record.profiles

    def count(progress):
        kept.append(progress.done)
        under_way.append(len(taken) - progress.done // 16)
        if len(kept) == 10:
            started(*worker_of(address))
            with distributed.Client(address, set_as_default=False) as client:
                client.wait_for_workers(2, timeout=60)

    record.profiles = lambda start, stop: taken.append(start) or read(start, stop)
    record.digest = lambda check: "the same"

    def tell(text):
        told.append(text)
        if "waiting for the first" in text:
            started(*worker_of(address))

    outcome = run_batch(
        mooring, record, tmp_path / "r.nc", block=16, scheduler=address, progress=count, tell=tell
    )
    assert outcome.done
    assert sum("waiting for the first" in text for text in told) == 1
    assert max(under_way[1:10]) == cluster_module.AHEAD
    assert max(under_way) == 2 * cluster_module.AHEAD


def test_a_worker_that_compiles_says_so(tmp_path, monkeypatch):
    def compile_anew(batch, tell):
        tell("compiling the solver")

    monkeypatch.setattr(cluster_module, "compile_solver", compile_anew)
    told = []
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as here:
        run_batch(
            made_mooring(tmp_path), MadeRecord(20), tmp_path / "r.nc",
            scheduler=here.scheduler_address, tell=told.append,
        )  # fmt: skip
        (address,) = here.scheduler_info["workers"]
    assert told == [f"{address}: compiling the solver"]


@pytest.mark.skipif(sys.platform == "win32", reason="kills a process as POSIX has it")
def test_a_scheduler_killed_on_the_way_leaves_what_can_be_finished(tmp_path, started, monkeypatch):
    scheduler = started(*SCHEDULER)
    address = address_of(scheduler)
    started(*worker_of(address))
    mooring, record = made_mooring(tmp_path), MadeRecord(400)

    def kill(progress):
        if progress.done >= 64:
            scheduler.kill()

    there, here = tmp_path / "there.nc", tmp_path / "here.nc"
    with dask.config.set({"distributed.comm.timeouts.connect": "1s"}):
        outcome = run_batch(mooring, record, there, block=16, scheduler=address, progress=kill)
    assert not outcome.done
    assert "lost" in outcome.reason
    assert 64 <= sum(outcome.counts.values()) < 400
    assert run_batch(mooring, record, there, block=16).done
    run_batch(mooring, record, here, block=16)
    assert content(there) == content(here)


def test_calm_missing_there_is_told(tmp_path, started):
    hidden = tmp_path / "hidden"
    (hidden / "calm").mkdir(parents=True)
    (hidden / "calm" / "__init__.py").write_text("raise ImportError('no such module')\n")
    address = address_of(started(*SCHEDULER, calm=hidden))
    started(*worker_of(address), calm=hidden)
    mooring, record = made_mooring(tmp_path), MadeRecord(20)
    with pytest.raises(UsageError, match=r"calm-mooring \d.* is needed there too"):
        run_batch(mooring, record, tmp_path / "r.nc", scheduler=address)
    assert not (tmp_path / "r.nc.part").exists()


def test_nobody_at_the_address(tmp_path, monkeypatch):
    monkeypatch.setattr("calm.batch.work.PATIENCE", "0.2s")
    mooring, record = made_mooring(tmp_path), MadeRecord(20)
    for address in ("tcp://127.0.0.1:9", "nonsense"):
        with pytest.raises(UsageError, match="no scheduler answers"):
            run_batch(mooring, record, tmp_path / "r.nc", scheduler=address)
        assert not (tmp_path / "r.nc.part").exists()


def test_without_dask_it_says_what_to_install(tmp_path):
    program = (
        "import sys; sys.modules['distributed'] = None\n"
        "from pathlib import Path\n"
        "from calm.batch.work import solved_on\n"
        "from calm.errors import UsageError\n"
        "try:\n"
        "    next(solved_on('tcp://127.0.0.1:9', None, iter(()), print, None))\n"
        "except UsageError as error:\n"
        "    print(error)\n"
    )
    finished = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert "pip install 'calm-mooring[cluster]'" in finished.stdout
