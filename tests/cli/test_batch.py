"""`calm batch` as a user runs it."""

import errno
import io
import json
import os
import signal
import subprocess
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import pytest
import xarray

from calm.batch.blocks import Progress
from calm.batch.statuses import Ending
from calm.cli import main
from calm.cli.progress import ProgressTeller, bar, state
from calm.quantities import duration
from calm.whole_file import UNFINISHED

ROOT = Path(__file__).parents[2]
HEADER = "time,depth[m],u[m/s],v[m/s]\n"


@pytest.fixture
def record(folder):
    """Thirty hourly profiles as CSV."""
    lines = [
        f"2024-01-{1 + hour // 24:02d}T{hour % 24:02d}:00,{depth},{0.02 * hour},0.1\n"
        for hour in range(30)
        for depth in (0, 100)
    ]
    (folder / "record.csv").write_text(HEADER + "".join(lines))
    return "record.csv"


def test_record_in_result_out(calm, write_mooring, record, folder):
    done = calm("batch", write_mooring(), "--currents", record, "-o", "r.nc", "--workers", 1)
    assert done.code == 0, done.err
    assert "30 profiles" in done.out
    with xarray.open_dataset(folder / "r.nc", engine="h5netcdf") as result:
        assert result.sizes["time"] == 30
        assert (result["status"] == 0).all()
        assert (np.diff(result["knockdown"].values[:, 0]) > 0).all()
    assert json.loads((folder / "r.summary.json").read_text())
    assert (folder / "r.summary.html").exists()
    before = (folder / "r.nc").read_bytes()
    again = calm("batch", "m.yaml", "--currents", record, "-o", "r.nc")
    assert (again.code, again.out) == (0, done.out)
    assert (folder / "r.nc").read_bytes() == before


def test_a_period_and_every_other(calm, write_mooring, record, folder):
    done = calm("batch", write_mooring(), "--currents", record, "-o", "r.nc",
                "--time", "2024-01-01T06:00/2024-01-01T12:00", "--every", 2)  # fmt: skip
    assert done.code == 0, done.err
    with xarray.open_dataset(folder / "r.nc", engine="h5netcdf") as result:
        assert result["time"].dt.hour.values.tolist() == [6, 8, 10, 12]


def test_the_column_is_that_of_the_mooring_unless_another_is_asked_for(calm, write_mooring, folder):
    """Two columns: still water at 48° N 5° W, a current at 49° N."""
    shape = ("time", "depth", "latitude", "longitude")
    u = np.full((3, 2, 2, 1), 0.01)
    u[:, :, 1] = 0.5
    current = {"uo": (shape, u, {"units": "m s-1"}), "vo": (shape, 0.1 * u, {"units": "m s-1"})}
    axes = {
        "time": np.arange("2026-03-01", "2026-03-04", dtype="M8[D]").astype("M8[ns]"),
        "depth": ("depth", [0.0, 100.0], {"units": "m", "positive": "down"}),
        "latitude": ("latitude", [48.0, 49.0], {"units": "degrees_north"}),
        "longitude": ("longitude", [-5.0], {"units": "degrees_east"}),
    }
    xarray.Dataset(current, axes).to_netcdf(folder / "grid.nc", engine="h5netcdf")
    file = write_mooring()
    with (folder / file).open("a", encoding="utf-8") as mooring:
        mooring.write("position: {latitude: 48.2 deg, longitude: -5 deg}\n")
    for name, more in (("own", ()), ("other", ("--at", "48.9,-5"))):
        done = calm("batch", file, "--currents", "grid.nc", "-o", f"{name}.nc", *more)
        assert done.code == 0, done.err
    own, other = (
        xarray.load_dataset(folder / f"{name}.nc", engine="h5netcdf")["x_top"].values[:, 0]
        for name in ("own", "other")
    )
    assert (10.0 * own < other).all()


@pytest.mark.thorough
def test_none_converged_is_3_and_some_are_counted(calm, write_mooring, heavy, record, folder):
    done = calm("batch", heavy, "--currents", record, "-o", "heavy.nc")
    assert done.code == 3
    assert "30 of 30 profiles are NaN: 30 without equilibrium (30 no-equilibrium)" in done.err
    text = (folder / record).read_text().replace(",0.2,0.1\n", ",,\n")
    (folder / "gap.csv").write_text(text)
    done = calm("batch", write_mooring(), "--currents", "gap.csv", "-o", "r.nc")
    assert done.code == 0
    assert "1 of 30 profiles are NaN: 1 without data (1 no-current)" in done.err
    assert "equilibrium" not in done.err


def test_implausible_currents_have_no_result_and_are_reported(calm, write_mooring, record, folder):
    """Fill values that no one marked; one of them above the surface, where it drops out."""
    text = (folder / record).read_text()
    text = text.replace("T05:00,100,0.1,0.1", "T05:00,100,-32.768,0.1")
    text = text.replace("T07:00,0,0.14,0.1", "T07:00,0,0.14,999.9")
    (folder / "filled.csv").write_text(text)
    done = calm("batch", write_mooring(), "--currents", "filled.csv", "-o", "r.nc")
    assert done.code == 0
    assert "2 of 30 profiles are NaN: 2 without data (2 implausible-current)" in done.err
    assert "the first at 2024-01-01T05:00, 100 m: 32.768 m/s" in done.err
    with xarray.open_dataset(folder / "r.nc", engine="h5netcdf") as result:
        bad = result["status"].values != 0
        assert np.flatnonzero(bad).tolist() == [5, 7]
        assert np.isnan(result["knockdown"].values[bad]).all()
        meanings = result["status"].attrs["flag_meanings"].split()
        assert meanings[result["status"].values[5]] == "implausible-current"
    mooring = (folder / "m.yaml").read_text()
    (folder / "fast.yaml").write_text(
        mooring.replace("environment:", "environment:\n  maximum_speed: 40 m/s", 1)
    )
    done = calm("batch", "fast.yaml", "--currents", "filled.csv", "-o", "fast.nc")
    assert "1 implausible-current" in done.err
    assert "the first at 2024-01-01T07:00, 0 m: 999.9 m/s" in done.err


def test_currents_whose_squares_overflow_are_implausible(calm, folder, write_mooring):
    times = (f"2024-01-{1 + hour // 24:02d}T{hour % 24:02d}:00" for hour in range(120))
    rows = [f"{time},{depth},1e300,0.1" for time in times for depth in (0, 50, 100)]
    (folder / "huge.csv").write_text("\n".join(["time,depth[m],u[m/s],v[m/s]", *rows]))
    done = calm("batch", write_mooring(), "--currents", "huge.csv", "-o", "r.nc")
    assert done.code == 3
    assert "the first at 2024-01-01T00:00, 0 m: 1e+300 m/s" in done.err


def test_a_declination_turns_what_is_magnetic(calm, write_mooring, record, folder):
    text = (folder / record).read_text()
    magnetic = text.replace("u[m/s],v[m/s]", "u[m/s magnetic],v[m/s magnetic]")
    (folder / "magnetic.csv").write_text(magnetic)
    done = calm("batch", write_mooring(), "--currents", "magnetic.csv", "-o", "r.nc")
    assert (done.code, done.out) == (2, "")
    assert "is relative to magnetic north; set the `declination` of the site" in done.err
    turned = ("--declination", "90 deg")
    done = calm("batch", "m.yaml", "--currents", record, "-o", "r.nc", *turned)
    assert done.code == 2
    assert "remove `declination`, or correct" in done.err
    for name, more in (("r", ()), ("magnetic", turned)):
        done = calm("batch", "m.yaml", "--currents", f"{name if more else 'record'}.csv",
                    "-o", f"{name}.nc", *more)  # fmt: skip
        assert done.code == 0, done.err
    assert "`u` and `v` were relative to magnetic north, and were rotated by 90°" in done.err
    true, other = (
        xarray.load_dataset(folder / f"{name}.nc", engine="h5netcdf") for name in ("r", "magnetic")
    )
    # what flowed east flows south, to the angle that the solver leaves open
    assert other["y_top"].values[5:, 0] == pytest.approx(-true["x_top"].values[5:, 0], rel=1e-6)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["-o", "r.nc", "--declination", "12"], "needs a unit: `12 deg`"),
        (["-o", "r.txt"], "must end in .nc"),
        (["-o", "r.zarr"], "must end in .nc"),
        (["-o", "."], "must end in .nc"),
        (["-o", "nowhere/r.nc"], "no folder"),
        (["-o", "r.nc", "--time", "2024"], "2024"),
        (["-o", "r.nc", "--at", "48"], "48"),
        (["-o", "r.nc", "--every", "0"], "--every"),
        (["-o", "r.nc", "--workers", "0"], "--workers"),
        (["-o", "r.nc", "--time", "2030-01-01/2030-02-01"], "2024-01-01"),
        (["-o", "r.nc", "--currents", "m.yaml"], "m.yaml"),
        (["-o", "r.nc", "--currents", "absent.nc"], "absent.nc"),
    ],
)
def test_bad_input_is_2_and_nothing_is_left(calm, write_mooring, record, folder, options, words):
    given = options if "--currents" in options else ["--currents", record, *options]
    done = calm("batch", write_mooring(), *given)
    assert done.code == 2
    assert words in done.err
    assert sorted(path.name for path in folder.iterdir()) == ["m.yaml", record]


def test_a_tow_and_an_input_as_output_are_refused(calm, write_mooring, record, folder):
    (folder / "t.yaml").write_text(
        "name: T\ntow: {speed: 1 m/s, toward: 0 deg}\nenvironment: {density: 1025 kg/m^3}\n"
        "line: [{use: w, length: 10 m}, {use: b}]\ncomponents:\n"
        "  w: {kind: cable, diameter: 10 mm, weight: 2 N/m}\n"
        "  b: {kind: body, length: 1 m, buoyancy: -100 N, drag_area: 0.1 m^2, cd: 1}\n"
    )
    done = calm("batch", "t.yaml", "--currents", record, "-o", "r.nc")
    assert (done.code, "is a tow" in done.err) == (2, True)
    done = calm("batch", write_mooring(), "--currents", record, "-o", record)
    assert done.code == 2
    assert "was not overwritten" in done.err


def test_links_that_lead_nowhere_are_refused(calm, write_mooring, record, folder):
    for link, target in (("a.nc", "b.nc"), ("b.nc", "a.nc"), ("d.nc", "absent"), ("f", "f")):
        (folder / link).symlink_to(target)
    for words, name in (
        ("link to a missing file", "a.nc"),
        ("link to a missing file", "d.nc"),
        ("no folder", "f/r.nc"),
    ):
        done = calm("batch", write_mooring(), "--currents", record, "-o", name)
        assert (done.code, words in done.err) == (2, True)
    done = calm("batch", write_mooring(), "--currents", "a.nc", "-o", "r.nc")
    assert (done.code, "no such file" in done.err) == (2, True)


def test_a_folder_is_no_result(calm, write_mooring, record, folder):
    (folder / "r.nc").mkdir()
    done = calm("batch", write_mooring(), "--currents", record, "-o", "r.nc")
    assert (done.code, "r.nc: it is a folder" in done.err) == (2, True)


def _heed_interrupts():
    """What is started in the background of a shell ignores them, and so do its children."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


IN_SMALL_BLOCKS = """
import runpy
import sys
from calm.batch import run
run.BLOCK = 8
sys.argv[0] = "calm"
runpy.run_module("calm", run_name="__main__")
"""


@pytest.mark.skipif(sys.platform == "win32", reason="sends signals as POSIX has them")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.thorough
def test_signals_end_it_with_nothing_left(write_mooring, folder, number):
    (folder / "long.csv").write_text(still_water(100_000))
    command = [sys.executable, "-c", IN_SMALL_BLOCKS, "batch", write_mooring(),
               "--currents", "long.csv", "-o", "r.nc", "--workers", "1"]  # fmt: skip
    process = subprocess.Popen(
        command, stderr=subprocess.PIPE, text=True, preexec_fn=_heed_interrupts
    )
    while not list(folder.glob(f".r.nc.*{UNFINISHED}")):
        assert process.poll() is None
        time.sleep(0.02)
    os.kill(process.pid, number)
    told = process.communicate(timeout=600)[1]
    assert (process.returncode, told.splitlines()[-1]) == (130, "calm: interrupted")
    assert sorted(path.name for path in folder.iterdir()) == ["long.csv", "m.yaml"]


@pytest.mark.slow  # it compiles the kernel anew
def test_without_a_folder_to_write_it_works_and_says_so(
    calm_process, write_mooring, record, folder
):
    environment = {**os.environ, "CALM_CACHE_DIR": "/proc/none"}
    done = calm_process(
        "batch", write_mooring(), "--currents", record, "-o", "r.nc",
        env=environment, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "compiling the solver" in done.stderr
    assert "no writable cache folder was found" in done.stderr
    assert "compiled in " in done.stderr


def test_statistics_that_fail_leave_the_result_and_say_so(
    calm, write_mooring, record, folder, monkeypatch
):
    def fail(*_, **__):
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr("calm.batch.statistics.series.TemporaryFile", fail)
        done = calm("batch", write_mooring(), "--currents", record, "-o", "r.nc")
    assert done.code == 2
    assert "cannot gather the statistics" in done.err and "No space left" in done.err
    assert (folder / "r.nc").exists()
    done = calm("batch", "m.yaml", "--currents", record, "-o", "r.nc")
    assert done.code == 0 and "read as" in done.err
    (read,) = json.loads((folder / "r.summary.json").read_text())["read"]
    assert read["file"] == record and read["step"] > 0.0 and read["gaps"] == []
    assert set(read["variables"]) == {"east", "north", "depth", "time"}
    with xarray.open_dataset(folder / "r.nc", engine="h5netcdf") as result:
        assert f"read {record}: east: u [m/s]: " in result.attrs["history"]
        assert json.loads(result.attrs["read"]) == [read]
    assert f"{record}</h" in (folder / "r.summary.html").read_text()


def test_without_statistics_there_is_the_result_alone(calm, write_mooring, record, folder):
    command = ("batch", write_mooring(), "--currents", record, "-o", "r.nc", "--no-statistics")
    done = calm(*command)
    assert (done.code, done.out) == (0, "")
    assert sorted(path.name for path in folder.iterdir()) == ["m.yaml", "r.nc", record]


@pytest.mark.skipif(sys.platform == "win32", reason="limits files as POSIX has it")
@pytest.mark.parametrize("largest", [0, 3000, pytest.param(100_000, marks=pytest.mark.slow)])
@pytest.mark.thorough
def test_files_that_cannot_grow_are_what_a_full_disk_is(
    calm, write_mooring, record, folder, largest
):
    """Bytes to a file: none, some metadata, and all but the last blocks."""
    assert calm("new", "--record", "-o", "record.nc").code == 0
    words = ["batch", write_mooring(), "--currents", "record.nc", "-o", "r.nc",
             "--no-statistics"]  # fmt: skip
    program = (
        "import resource, sys\n"
        "from calm.cli import main\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[1]), resource.RLIM_INFINITY))\n"
        "sys.exit(main(sys.argv[2:]))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(largest), *words],
        env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, "cannot write r.nc: File too large" in done.stderr) == (2, True)
    assert sorted(path.name for path in folder.iterdir()) == ["m.yaml", record, "record.nc"]


def still_water(hours):
    """So many hourly profiles without any current."""
    times = np.datetime64("2024-01-01T00") + np.arange(hours)
    return HEADER + "".join(f"{time},0,0,0\n{time},100,0,0\n" for time in times)


def test_still_water_is_solved_as_any(calm, write_mooring, folder):
    (folder / "still.csv").write_text(still_water(30))
    done = calm("batch", write_mooring(), "--currents", "still.csv", "-o", "r.nc")
    assert done.code == 0
    assert "NaN" not in done.err


def test_the_bar_goes_whatever_happens(calm, write_mooring, record, monkeypatch):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    def fail(*_, **__):
        raise ValueError("a bug")

    written = Terminal()
    monkeypatch.setattr(sys, "stderr", written)
    monkeypatch.setattr("calm.batch.blocks.packed", fail)
    assert main(["batch", write_mooring(), "--currents", record, "-o", "r.nc"]) == 70
    shown = written.getvalue()
    assert "[....." in shown
    assert shown.rpartition("[.....")[2].partition("\r\x1b[K")[2].startswith("calm: internal error")


@pytest.mark.thorough
def test_the_workers_of_a_scheduler(calm, write_mooring, record, folder):
    distributed = pytest.importorskip("distributed")
    with warnings.catch_warnings():  # dask leaves sockets to the collector
        warnings.simplefilter("ignore")
        with distributed.LocalCluster(
            n_workers=1, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster:
            done = calm("batch", write_mooring(), "--currents", record, "-o", "there.nc",
                        "--scheduler", cluster.scheduler_address)  # fmt: skip
    assert done.code == 0, done.err
    assert calm("batch", "m.yaml", "--currents", record, "-o", "here.nc").code == 0
    assert (folder / "there.nc").read_bytes() == (folder / "here.nc").read_bytes()


def ended(**counts):
    return {ending: counts.get(ending.name, 0) for ending in Ending}


def test_progress_has_rate_remaining_time_and_failures():
    halfway = Progress(60_000, 120_000, ended(SOLVED=59_988, NO_EQUILIBRIUM=12))
    assert state(halfway, 3.0) == (
        "60 000 of 120 000 profiles, 20 000 a second, 3 s left, 12 without equilibrium"
    )
    assert bar(halfway) == f"[{'#' * 12}{'.' * 12}]"
    many = Progress(10, 10, ended(SOLVED=4, NO_EQUILIBRIUM=3, NOT_CONVERGED=2, NO_DATA=1))
    assert state(many, 1.0) == (
        "10 of 10 profiles, 10 a second, 0 s left, 3 without equilibrium, 2 not converged, "
        "1 without data"
    )
    assert state(Progress(0, 10, ended()), 0.0) == "0 of 10 profiles"
    assert [duration(seconds) for seconds in (5, 600, 7230)] == ["5 s", "10 min", "2 h 00 min"]


def test_a_terminal_has_a_bar_and_others_a_line_now_and_then(monkeypatch, capsys):
    clock = [0.0]
    monkeypatch.setattr("calm.cli.progress.monotonic", lambda: clock[0])
    for terminal in (True, False):
        monkeypatch.setattr(sys.stderr, "isatty", lambda terminal=terminal: terminal)
        teller = ProgressTeller()
        for second in range(100):
            clock[0] = float(second)
            teller(Progress(second, 100, ended()))
        teller.clear()
        told = capsys.readouterr().err
        if terminal:
            assert told.count("\r\x1b[K[") == 100
            assert told.endswith("\r\x1b[K")
        else:
            assert [line.split()[0] for line in told.splitlines()] == ["10", "70"]
