"""How long `calm motion` takes for a year of hours with seven sensors.

    python benchmarks/motion.py            # 8766 hours
    python benchmarks/motion.py --smoke    # 48, in seconds: whether it runs

The line is that of `docs/field/dune2`, its seven current meters and their pressures are made:
eddies, a tide and noise, in which the line is solved with 10 % more drag on its cables; the
currents are then measured with errors of 5 %. The command is timed whole, files in and files out,
on one thread and on two: by the clock, and by the processor, which other work disturbs less.
"""

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import xarray
from machine import describe

import calm
from calm.motion.line_response import Forward, labels_of, points

HOURS, SMOKE = 8766, 48
FILE = Path(__file__).parents[1] / "docs" / "field" / "dune2" / "mooring.yaml"
METERS = [f"Aquadopp {height}" for height in (626, 526, 426, 326, 226, 126, 26)]


def write_records(folder: Path, hours: int) -> list[str]:
    """Currents and pressures of so many hours; the words of the command that name them."""
    import gsw

    mooring = calm.load(FILE)
    assert isinstance(mooring, calm.Design) and mooring.file.position is not None
    line = Forward(mooring, {"cable_drag": 1.1})
    at = [labels_of(mooring).index(label) for label in METERS]
    random = np.random.default_rng(1)
    turns = 2.0 * np.pi * np.arange(hours)[:, None]
    shape = np.linspace(0.7, 1.0, len(at))
    east, north = (
        shape * (0.3 * np.sin(turns / 90.0 + phase) + 0.15 * np.sin(turns / 12.42 + phase))
        + 0.03 * random.standard_normal((hours, len(at)))
        for phase in (0.0, 1.2)
    )
    depth = points(line.solve(np.tile(line.still[at], (hours, 1)), east, north))[:, at]
    depth += 0.1 * random.standard_normal(depth.shape)
    wrong = np.exp(0.05 * random.standard_normal(east.shape))
    pressure = gsw.p_from_z(-depth, mooring.file.position.latitude)
    coordinates = {
        "time": np.datetime64("2026-01-01", "ns") + np.arange(hours) * np.timedelta64(1, "h"),
        "instrument": METERS,
    }
    written = []
    for name, variables in (
        ("currents", {"eastward": east * wrong, "northward": north * wrong}),
        ("pressures", {"pressure": pressure}),
    ):
        arrays = {}
        for one, values in variables.items():
            standard = "sea_water_pressure" if one == "pressure" else f"{one}_sea_water_velocity"
            unit = "dbar" if one == "pressure" else "m/s"
            told = {"standard_name": standard, "units": unit}
            arrays[one] = (("time", "instrument"), values, told)
        xarray.Dataset(arrays, coordinates).to_netcdf(folder / f"{name}.nc", engine="h5netcdf")
        written += [f"--{name}", str(folder / f"{name}.nc")]
    return written


def processor() -> float:
    """Seconds of processor of all processes that were started and have ended."""
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    return spent.ru_utime + spent.ru_stime


def main() -> None:
    """Print the seconds of the command."""
    print(describe("calm-mooring", "numpy", "llvmlite", "h5py"))
    smoke = sys.argv[1:] == ["--smoke"]
    hours, threads_of = (SMOKE, (2,)) if smoke else (HOURS, (1, 2))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        words = write_records(folder, hours)  # and the march is compiled
        for workers in threads_of:
            output = folder / f"{workers}.nc"
            start, spent = time.perf_counter(), processor()
            subprocess.run(
                [sys.executable, "-m", "calm", "motion", str(FILE), *words, "-o", str(output),
                 "--workers", str(workers)],
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True,
            )  # fmt: skip
            seconds = time.perf_counter() - start
            threads = f"{workers} thread{'s' * (workers > 1)}"
            print(
                f"{hours} hours, {len(METERS)} sensors, {threads:9}: {seconds:6.1f} s, "
                f"{processor() - spent:6.1f} s of processor"
            )


if __name__ == "__main__":
    main()
