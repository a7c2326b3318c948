import os
import subprocess
import sys
from pathlib import Path
from threading import Event

import h5netcdf
import numpy as np
import pytest

import calm
from calm.batch.blocks import IN_PROGRESS, in_order, in_threads
from calm.batch.compiling import compile_solver
from calm.batch.finished import open_result
from calm.batch.profiles import Batch
from calm.batch.resolved import resolved_input
from calm.batch.run import run_batch
from calm.batch.statuses import STATUSES
from calm.errors import UsageError
from tests.unit.batch.made import MOORING, MadeRecord, made_mooring
from tests.unit.batch.records import write


@pytest.fixture
def mooring(tmp_path):
    return made_mooring(tmp_path)


@pytest.fixture
def record():
    return MadeRecord()


@pytest.mark.parametrize("block", [None, 16])
def test_the_result_is_what_solve_profiles_gives(tmp_path, mooring, record, block):
    output = tmp_path / "r.nc"
    counts = run_batch(mooring, record, output, workers=2, block=block)
    solved = calm.solve_profiles(mooring, record.u, record.v, record.depth)
    assert int((solved.status == 0).sum()) == 39
    assert counts == {"converged": 39, "no-current": 1}
    with open_result(output) as result:
        assert (result["time"].values == record.time).all()
        assert result["component_label"].values.tolist() == list(solved.component_label)
        assert result["clamp_label"].values.tolist() == ["Logger é"]
        told = [name for name in result.variables if name in vars(solved)]
        assert len(told) == 21
        for name in set(told) - {"component_label", "clamp_label"}:
            given, wanted = result[name].values, getattr(solved, name)
            assert given.dtype == (np.int8 if name == "status" else np.float32)
            np.testing.assert_array_equal(given, wanted.astype(given.dtype), err_msg=name)
        assert result["status"].values[4] == STATUSES.index("no-current")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["m.yaml", "r.nc"]


@pytest.mark.thorough
def test_neither_workers_nor_what_was_there_change_a_byte(tmp_path, mooring, record):
    outputs = [tmp_path / "one.nc", tmp_path / "three.nc"]
    outputs[1].write_text("another file")
    for output, workers in zip(outputs, (1, 3), strict=True):
        run_batch(mooring, record, output, workers=workers, block=4)
    assert outputs[0].read_bytes() == outputs[1].read_bytes()


def test_the_file_ends_where_hdf5_says(tmp_path, mooring, record):
    """No room that was taken for blocks is left behind its end."""
    run_batch(mooring, record, tmp_path / "r.nc", block=4)
    with h5netcdf.File(tmp_path / "r.nc") as file:
        assert file._h5file.id.get_filesize() == (tmp_path / "r.nc").stat().st_size


def test_progress_counts_blocks_and_endings(tmp_path, mooring, record):
    told = []
    run_batch(mooring, record, tmp_path / "r.nc", block=16, progress=told.append)
    assert [one.done for one in told] == [0, 16, 32, 40]
    assert {one.total for one in told} == {40}
    assert sum(told[-1].endings.values()) == 40


def test_the_hash_is_of_the_input_and_the_currents_not_of_names(tmp_path, mooring, record):
    def attributes(name, mooring, record):
        run_batch(mooring, record, tmp_path / name)
        with h5netcdf.File(tmp_path / name) as file:
            return file.attrs["input_sha256"], file.attrs["input_resolved"]

    first = attributes("a.nc", mooring, record)
    again = tmp_path / "again"
    again.mkdir()
    assert attributes("b.nc", made_mooring(again), MadeRecord()) == first
    currents = attributes("c.nc", mooring, MadeRecord(seed=2))
    assert currents[0] != first[0] and currents[1] == first[1]
    other = made_mooring(again, MOORING.replace("length: 40 m", "length: 45 m"))
    assert attributes("d.nc", other, record)[0] not in (first[0], currents[0])


@pytest.mark.parametrize(
    "other",
    [
        MOORING + "checks: {anchor_factor: 2}\n# a word more\n",
        MOORING.replace("current: {speed: 0.5 m/s", "current: {speed: 0.7 m/s"),
        MOORING.replace(
            "environment:",
            "environment:\n  waves: {significant_height: 3 m, peak_period: 8 s}",
        ),
    ],
    ids=["limits", "the file's own current", "waves"],
)
def test_what_changes_no_figure_is_no_other_input(tmp_path, mooring, record, other):
    first = resolved_input(mooring, record.time, {})
    assert resolved_input(made_mooring(tmp_path, other), record.time, {}) == first


@pytest.mark.thorough
def test_compiling_is_told_when_it_takes_place(tmp_path, mooring):
    program = (
        "import sys\n"
        "from pathlib import Path\n"
        "from calm.batch.compiling import compile_solver\n"
        "from calm.batch.profiles import Batch\n"
        "from tests.unit.batch.made import made_mooring\n"
        "compile_solver(Batch(made_mooring(Path(sys.argv[1]))), print)\n"
    )
    compile_solver(Batch(mooring), print)
    for cache, expected in (({}, ""), ({"CALM_CACHE_DIR": str(tmp_path / "cache")}, "compiling")):
        finished = subprocess.run(
            [sys.executable, "-c", program, tmp_path], cwd=Path(__file__).parents[3],
            env={**os.environ, **cache}, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert finished.stdout.startswith(expected), finished.stderr
        assert bool(finished.stdout) == bool(expected)


@pytest.mark.thorough
def test_memory_does_not_grow_with_the_record(tmp_path):
    """Ten times the profiles: what HDF5 and the record keep of each is a few bytes; the results
    alone would be 300. In a process of its own, since what other tests leave running is counted,
    too."""
    program = (
        "import sys, tracemalloc\n"
        "from pathlib import Path\n"
        "from calm.batch.run import run_batch\n"
        "from tests.unit.batch.made import MadeRecord, made_mooring\n"
        "folder = Path(sys.argv[1])\n"
        "mooring = made_mooring(folder)\n"
        # first of all what is loaded once for any number of profiles
        "for number, count in enumerate((40_000, 4000, 40_000)):\n"
        "    record = MadeRecord(count)\n"
        "    tracemalloc.start()\n"
        "    run_batch(mooring, record, folder / f'{number}.nc', workers=1, block=1000)\n"
        "    print(tracemalloc.get_traced_memory()[1])\n"
        "    tracemalloc.stop()\n"
    )
    finished = subprocess.run(
        [sys.executable, "-c", program, tmp_path], cwd=Path(__file__).parents[3],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    peaks = [int(peak) for peak in finished.stdout.split()]
    assert peaks[2] < peaks[1] + 12 * 36_000


def test_no_profile_is_no_batch(tmp_path, mooring):
    with pytest.raises(UsageError, match="no profile in the requested period"):
        run_batch(mooring, MadeRecord(0), tmp_path / "r.nc")


@pytest.mark.parametrize("workers", [1, 3])
def test_threads_take_no_more_than_is_ahead_and_keep_the_order(workers):
    taken, finished = [], []

    def tasks():
        for number in range(30):
            assert number - len(finished) <= IN_PROGRESS * workers
            taken.append(number)
            yield number

    for done in in_threads(lambda number: number * number, tasks(), workers):
        finished.append(done)
    assert finished == [number * number for number in taken] and len(taken) == 30


def test_workers_that_come_late_are_given_their_share():
    """What is ahead is asked for with each task."""
    begun, done, under_way = [], [], []

    class Now:
        def __init__(self, task):
            begun.append(task)
            self.result = lambda: task

    for one in in_order(Now, range(8), lambda: 1 if len(done) < 3 else 3):
        done.append(one)
        under_way.append(len(begun) - len(done))
    assert done == list(range(8))
    assert under_way == [0, 0, 0, 2, 2, 2, 1, 0]


def test_an_error_in_a_thread_ends_the_others_and_is_raised():
    seen = []

    def job(number):
        seen.append(number)
        if number == 3:
            raise ValueError("three")

    with pytest.raises(ValueError, match="three"):
        list(in_threads(job, range(10**6), 2))
    assert len(seen) < 100


def test_left_early_nothing_goes_on(mooring):
    going, done = Event(), []

    def job(number):
        going.wait(0.05)
        done.append(number)

    solved = in_threads(job, range(100), 2)
    next(solved)
    solved.close()
    count = len(done)
    going.wait(0.2)
    assert len(done) == count <= 5


@pytest.mark.thorough
def test_a_record_of_any_kind_gives_the_same(tmp_path, mooring):
    from tests.unit.batch.test_record import opened

    results = []
    for ending in ("nc", "zarr"):
        with opened(write("glorys", tmp_path, ending)) as record:
            run_batch(mooring, record, tmp_path / f"{ending}.nc")
        with open_result(tmp_path / f"{ending}.nc") as result:
            results.append((result["status"].values, result.attrs["input_sha256"]))
    assert (results[0][0] == results[1][0]).all() and results[0][1] == results[1][1]
