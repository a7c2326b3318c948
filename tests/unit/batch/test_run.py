import errno
import os
import subprocess
import sys
from pathlib import Path
from threading import Event, get_ident

import numpy as np
import pytest

import calm
from calm.batch import run as run_module
from calm.batch.finished import open_result
from calm.batch.profiles import Batch
from calm.batch.run import LARGEST_BLOCK, run_batch
from calm.batch.statuses import STATUSES, Ending
from calm.batch.work import compile_solver, in_threads
from calm.batch.work_store import identity_of, to_text
from calm.errors import UsageError
from tests.unit.batch.made import MOORING, MadeRecord, content, made_mooring


@pytest.fixture
def mooring(tmp_path):
    return made_mooring(tmp_path)


@pytest.fixture
def record():
    return MadeRecord()


def test_waves_of_the_file_change_no_identity(tmp_path, mooring, record):
    (tmp_path / "waves").mkdir()
    waves = "environment:\n  waves: {significant_height: 3 m, peak_period: 8 s}"
    wavy = made_mooring(tmp_path / "waves", MOORING.replace("environment:", waves))
    assert wavy.file.environment.seas
    texts = [to_text(identity_of(each, record, {}, Event())) for each in (mooring, wavy)]
    assert texts[0] == texts[1]


@pytest.mark.parametrize("ending", [".nc", ".zarr"])
def test_the_result_is_what_solve_profiles_gives(tmp_path, mooring, record, ending):
    output = tmp_path / f"r{ending}"
    outcome = run_batch(mooring, record, output, workers=2, block=16)
    solved = calm.solve_profiles(mooring, record.u, record.v, record.depth)
    assert outcome.done
    assert int((solved.status == 0).sum()) == 39
    assert outcome.counts == {"converged": 39, "no-current": 1}
    assert outcome.endings[Ending.NO_DATA] == 1
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
    assert not list(tmp_path.glob("*.part"))


@pytest.mark.thorough
def test_neither_workers_nor_order_change_a_byte(tmp_path, mooring, record):
    outputs = [tmp_path / "one.nc", tmp_path / "three.nc"]
    for output, workers in zip(outputs, (1, 3), strict=True):
        run_batch(mooring, record, output, workers=workers, block=16)
    assert content(outputs[0]) == content(outputs[1])


@pytest.mark.thorough
def test_the_shape_passes_through_the_components(tmp_path, mooring, record):
    output, plain = tmp_path / "r.nc", tmp_path / "plain.nc"
    run_batch(mooring, record, output, shape=True)
    run_batch(mooring, record, plain)
    with open_result(output) as result, open_result(plain) as without:
        tops = np.flatnonzero(np.diff(result["node_component"].values, prepend=-1))
        for name, top in (("shape_depth", "depth_top"), ("shape_x", "x_top")):
            np.testing.assert_array_equal(result[name].values[:, tops], result[top].values)
        good = result["status"].values == 0
        drops = np.diff(result["shape_depth"].values[good], axis=1)
        lengths = np.diff(result["node_distance"].values)
        # stiff rope: no part is longer than it was cut, and the line leads down; a millimetre for
        # depths in float32 and for bends between nodes
        assert (drops > 0).all() and (drops < lengths + 1e-3).all()
        # the nodes cut the line elsewhere, so that figures agree to their accuracy, 5e-5 of 100 m
        for name in ("depth_top", "clamp_depth", "clamp_x"):
            np.testing.assert_allclose(
                result[name].values[good], without[name].values[good], atol=5e-3
            )
        assert result["clamp_label"].values.tolist() == ["Logger é"]


def test_a_file_system_without_locks_is_told(tmp_path, mooring, record, monkeypatch):
    fcntl, told = pytest.importorskip("fcntl"), []

    def none(handle, how):
        raise OSError(errno.ENOLCK, "no locks")

    monkeypatch.setattr(fcntl, "flock", none)
    assert run_batch(mooring, record, tmp_path / "r.nc", tell=told.append).done
    assert any("does not support file locks" in text for text in told)


def test_a_long_reading_is_told(tmp_path, mooring, record, monkeypatch):
    monkeypatch.setattr(run_module, "LONG", 0.0)
    told, heard = [], Event()
    digest = record.digest

    def tell(text):
        told.append(text)
        heard.set()

    record.digest = lambda check: heard.wait(60) and digest()
    assert run_batch(mooring, record, tmp_path / "r.nc", tell=tell).done
    assert told == ["reading the whole record, to check that it is unchanged"]


@pytest.mark.thorough
def test_compiling_is_told_when_it_takes_place(tmp_path, mooring):
    """An index of the cache is there for every kind of processor, its code for this one may not."""
    program = (
        "import sys\n"
        "from pathlib import Path\n"
        "from calm.batch.work import compile_solver\n"
        "from numba.core.dispatcher import _FunctionCompiler\n"
        "from calm.batch.profiles import Batch\n"
        "from tests.unit.batch.made import made_mooring\n"
        "compile = _FunctionCompiler.compile\n"
        "def seen(self, *signature):\n"
        "    if type(self) is _FunctionCompiler: sys.exit('compiles')\n"
        "    return compile(self, *signature)\n"
        "_FunctionCompiler.compile = seen\n"
        "compile_solver(Batch(made_mooring(Path(sys.argv[1]))), print)\n"
    )
    compile_solver(Batch(mooring), print)
    for cache, expected in (({}, ""), ({"NUMBA_CACHE_DIR": str(tmp_path / "cache")}, "compiling")):
        finished = subprocess.run(
            [sys.executable, "-c", program, tmp_path], cwd=Path(__file__).parents[3],
            env={**os.environ, **cache}, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert finished.stdout.startswith(expected), finished.stderr
        assert bool(finished.stdout) == bool(expected)


@pytest.mark.thorough
def test_memory_does_not_grow_with_the_record(tmp_path):
    """Ten times the profiles: what is known of the blocks, of a thousand each, is some 6 bytes
    more of each; the results alone would be 300. In a process of its own, since what other tests
    leave running is counted, too."""
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
        "    record.digest = lambda check: 'the same'\n"
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


def test_longer_records_have_larger_blocks():
    assert [run_module._block_for(count) for count in (1, 262_980, 2**24, 2**24 + 1)] == [
        8192, 8192, 8192, 16384,
    ]  # fmt: skip
    assert run_module._block_for(10**9) == LARGEST_BLOCK


@pytest.mark.parametrize("finished", [False, True])
def test_another_input_is_refused_and_told(tmp_path, mooring, record, finished):
    output = tmp_path / "r.nc"

    def stop(progress):
        if not finished:
            raise KeyboardInterrupt

    run_batch(mooring, record, output, workers=1, block=8, progress=stop)
    before = content(output if finished else tmp_path / "r.nc.part")
    other = made_mooring(tmp_path, MOORING.replace("length: 40 m", "length: 45 m"))
    with pytest.raises(UsageError, match=r"pieces\[1\]\.length was 40\.0, is now 45\.0"):
        run_batch(other, record, output, block=8)
    with pytest.raises(UsageError, match=r"record\.sha256 was"):
        run_batch(mooring, MadeRecord(seed=2), output, block=8)
    with pytest.raises(UsageError, match=r"options\.shape was False, is now True"):
        run_batch(mooring, record, output, block=8, shape=True)
    after = content(output if finished else tmp_path / "r.nc.part")
    assert after == before


@pytest.mark.parametrize(
    "other",
    [
        MOORING + "checks: {anchor_factor: 2}\n# a word more\n",
        MOORING.replace("current: {speed: 0.5 m/s", "current: {speed: 0.7 m/s"),
    ],
    ids=["limits", "the file's own current"],
)
def test_what_changes_no_figure_is_no_other_input(tmp_path, mooring, record, other):
    output = tmp_path / "r.nc"
    first = run_batch(mooring, record, output)
    before = content(output)
    assert run_batch(made_mooring(tmp_path, other), record, output) == first
    assert content(output) == before


def test_what_is_no_result_is_left_alone(tmp_path, mooring, record):
    (tmp_path / "r.nc").write_text("mine")
    (tmp_path / "r.zarr").mkdir()
    (tmp_path / "s.nc.part").mkdir()
    (tmp_path / "s.nc.part" / "mine").write_text("mine")
    for name, words in (
        ("r.nc", "not a readable result"),
        ("r.zarr", "not a readable result"),
        ("s.nc", "in the way"),
    ):
        with pytest.raises(UsageError, match=words):
            run_batch(mooring, record, tmp_path / name)
    assert (tmp_path / "r.nc").read_text() == (tmp_path / "s.nc.part" / "mine").read_text()
    with pytest.raises(UsageError, match=r"must end in \.nc or \.zarr"):
        run_batch(mooring, record, tmp_path / "r.txt")


@pytest.mark.parametrize("ending", [".nc", ".zarr"])
def test_a_finished_result_that_cannot_be_read_says_what_to_do(tmp_path, mooring, record, ending):
    output = tmp_path / f"r{ending}"
    run_batch(mooring, record, output, block=8)
    if ending == ".nc":
        output.write_bytes(output.read_bytes()[:2000])
    else:
        (output / "status" / "2").write_bytes(b"\0" * 40)
    with pytest.raises(UsageError, match=r"remove it|Remove it"):
        run_batch(mooring, record, output, block=8)


def test_a_damaged_identity_says_what_to_do(tmp_path, mooring, record):
    output, stop = tmp_path / "r.nc", Event()
    outcome = run_batch(mooring, record, output, progress=lambda _: stop.set(), stop=stop)
    assert (outcome.done, outcome.reason) == (False, "interrupted")
    identity = tmp_path / "r.nc.part" / ".batch" / "identity"
    for content_of_it in (b"", b"\0\0\xff", b'{"calm":'):
        identity.write_bytes(content_of_it)
        with pytest.raises(UsageError, match=r"r\.nc\.part is damaged.* Remove it"):
            run_batch(mooring, record, output)


def test_too_little_memory_is_said_and_can_be_resumed(tmp_path, mooring, record, monkeypatch):
    def fail(*_, **__):
        raise MemoryError

    with monkeypatch.context() as patched:
        patched.setattr(Batch, "_solve_block", fail)
        outcome = run_batch(mooring, record, tmp_path / "r.nc", block=8)
    assert not outcome.done
    assert outcome.reason.startswith("not enough memory")
    assert run_batch(mooring, record, tmp_path / "r.nc", block=8).done


def test_two_batches_do_not_work_on_one_result(tmp_path, mooring, record):
    output = tmp_path / "r.nc"
    refused = []

    def again(progress):
        if not refused:
            with pytest.raises(UsageError, match="another calm batch is working"):
                run_batch(mooring, record, output)
            refused.append(progress)

    assert run_batch(mooring, record, output, workers=1, progress=again).done
    assert refused


def test_an_error_in_a_thread_stops_the_others_and_is_raised():
    seen = []

    def job(number):
        seen.append((number, get_ident()))
        if number == 3:
            raise ValueError("three")

    with pytest.raises(ValueError, match="three"):
        in_threads(job, range(10**6), 2, Event())
    assert len(seen) < 10**6
