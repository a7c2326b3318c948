import os
import signal
import subprocess
import sys

import pytest

from calm.batch.run import run_batch
from calm.errors import UsageError
from tests.unit.batch.made import MadeRecord, content, made_mooring

distributed = pytest.importorskip("distributed")

# dask opens sockets and event loops in threads of its own, and leaves some to the collector
pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::DeprecationWarning")


@pytest.fixture
def cluster():
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as workers:
        yield workers


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


def test_nobody_at_the_address(tmp_path, monkeypatch):
    monkeypatch.setattr("calm.batch.cluster.PATIENCE", "0.2s")
    mooring, record = made_mooring(tmp_path), MadeRecord(20)
    for address in ("tcp://127.0.0.1:9", "nonsense"):
        with pytest.raises(UsageError, match="no scheduler answers"):
            run_batch(mooring, record, tmp_path / "r.nc", scheduler=address)
        assert not (tmp_path / "r.nc.part").exists()


def test_without_dask_it_says_what_to_install(tmp_path):
    program = (
        "import sys; sys.modules['distributed'] = None\n"
        "from pathlib import Path\n"
        "from calm.batch.cluster import solved_on\n"
        "from calm.errors import UsageError\n"
        "try:\n"
        "    next(solved_on('tcp://127.0.0.1:9', None, iter(())))\n"
        "except UsageError as error:\n"
        "    print(error)\n"
    )
    finished = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert "pip install 'calm-mooring[cluster]'" in finished.stdout
