import json
import subprocess
import sys
from pathlib import Path
from threading import get_ident

import numpy as np
import pytest

import calm
from calm.batch.accessor import open_result
from calm.batch.profiles import STATUSES
from calm.batch.run import Progress, in_threads, run_batch
from calm.errors import UsageError
from tests.unit.batch.made import MOORING, MadeRecord, content, made_mooring

KILLED = Path(__file__).with_name("killed.py")


@pytest.fixture
def mooring(tmp_path):
    return made_mooring(tmp_path)


@pytest.fixture
def record():
    return MadeRecord()


@pytest.mark.parametrize("ending", [".nc", ".zarr"])
def test_the_result_is_what_solve_profiles_gives(tmp_path, mooring, record, ending):
    output = tmp_path / f"r{ending}"
    outcome = run_batch(mooring, record, output, workers=2, block=16)
    solved = calm.solve_profiles(mooring, record.u, record.v, record.depth)
    assert outcome.done
    assert int((solved.status == 0).sum()) == 39
    assert (outcome.converged, outcome.failed) == (39, 1)
    with open_result(output) as result:
        assert (result["time"].values == record.time).all()
        assert result["component_label"].values.tolist() == list(solved.component_label)
        assert result["clamp_label"].values.tolist() == ["Logger é"]
        told = [name for name in result.variables if name in vars(solved)]
        assert len(told) == 20
        for name in set(told) - {"component_label", "clamp_label"}:
            given, wanted = result[name].values, getattr(solved, name)
            assert given.dtype == (np.int8 if name == "status" else np.float32)
            np.testing.assert_array_equal(given, wanted.astype(given.dtype), err_msg=name)
        assert result["status"].values[4] == STATUSES.index("no-current")
    assert not list(tmp_path.glob("*.part"))


def test_neither_workers_nor_order_change_a_byte(tmp_path, mooring, record):
    outputs = [tmp_path / "one.nc", tmp_path / "three.nc"]
    for output, workers in zip(outputs, (1, 3), strict=True):
        run_batch(mooring, record, output, workers=workers, block=16)
    assert content(outputs[0]) == content(outputs[1])


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
    assert told[0] == Progress(done=24, total=40, found=24, failed=1)
    assert content(output) == content(undisturbed)
    third = run_batch(mooring, record, output, block=8)
    assert asked == [24, 32]
    assert third == second


@pytest.mark.parametrize(("ending", "how"), [(".nc", "moments"), (".zarr", "moments"),
                                             (".nc", "steps"), (".zarr", "steps")])  # fmt: skip
@pytest.mark.skipif(sys.platform == "win32", reason="kills processes as POSIX has them")
def test_killed_at_any_moment_it_finishes_to_the_same_bytes(tmp_path, ending, how):
    command = [sys.executable, KILLED, tmp_path, ending, how]
    finished = subprocess.run(command, capture_output=True, text=True, check=False)
    assert finished.returncode == 0, finished.stderr
    told = json.loads(finished.stdout.splitlines()[-1])
    assert told["same"], told
    assert told["hit"] >= 10
    assert told.get("kept", 1) > 0


def test_a_full_disk_stops_it_and_keeps_what_is_done(tmp_path, mooring, record, monkeypatch):
    output = tmp_path / "r.nc"
    written = Path.write_bytes
    left = [200]

    def full(path, data):
        left[0] -= 1
        if left[0] < 0:
            written(path, data[:3])
            raise OSError(28, "No space left on device")
        return written(path, data)

    with monkeypatch.context() as patched:
        patched.setattr(Path, "write_bytes", full)
        outcome = run_batch(mooring, record, output, workers=1, block=4)
    assert not outcome.done
    assert outcome.reason == "No space left on device"
    assert 0 < outcome.converged < 39
    assert run_batch(mooring, record, output, block=4).done
    run_batch(mooring, record, tmp_path / "undisturbed.nc", block=4)
    assert content(output) == content(tmp_path / "undisturbed.nc")


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


def test_limits_of_the_design_check_are_no_other_input(tmp_path, mooring, record):
    output = tmp_path / "r.nc"
    run_batch(mooring, record, output)
    other = made_mooring(tmp_path, MOORING + "checks: {anchor_factor: 2}\n# a word more\n")
    assert run_batch(other, record, output).done


def test_what_is_no_result_is_left_alone(tmp_path, mooring, record):
    (tmp_path / "r.nc").write_text("mine")
    (tmp_path / "r.zarr").mkdir()
    (tmp_path / "s.nc.part").mkdir()
    (tmp_path / "s.nc.part" / "mine").write_text("mine")
    for name, words in (("r.nc", "no result"), ("r.zarr", "no result"), ("s.nc", "in the way")):
        with pytest.raises(UsageError, match=words):
            run_batch(mooring, record, tmp_path / name)
    assert (tmp_path / "r.nc").read_text() == (tmp_path / "s.nc.part" / "mine").read_text()
    with pytest.raises(UsageError, match=r"ends in \.nc or \.zarr"):
        run_batch(mooring, record, tmp_path / "r.txt")


def test_two_batches_do_not_work_on_one_result(tmp_path, mooring, record):
    output = tmp_path / "r.nc"
    refused = []

    def again(progress):
        if not refused:
            with pytest.raises(UsageError, match="another calm batch is at work"):
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
        in_threads(job, range(10**6), 2)
    assert len(seen) < 10**6
