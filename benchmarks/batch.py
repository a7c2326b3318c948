"""How fast `calm batch` is from NetCDF to NetCDF, against its solver alone; and its memory.

    python benchmarks/batch.py                 # 100 000 and 262 980 profiles
    python benchmarks/batch.py 1000000         # these many too
    python benchmarks/batch.py --smoke         # 2000 alone, in seconds: whether it runs

A deep mooring of twelve components in made currents at twenty levels, hourly: eddies, a tide and
noise. The command is timed whole, from its start to the page of its statistics, and without them;
memory is the most that the process ever held. What one thread can read, hash, pack and write is
timed with profiles that are solved already. The last table is that of `docs/reference/batch.md`.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path
from unittest.mock import patch

import numpy as np
from machine import describe

import calm
from calm.batch.profiles import Batch, Profiles
from calm.batch.run import BLOCK, run_batch
from calm.records.current_file import open_record
from calm.records.current_terms import Terms

COUNTS = (100_000, 262_980)
SMOKE = 2000
SIZES = (10**7, 10**8, 10**9)
PARTS = 16  # of a record, each with a process of its own
SAMPLE = 65_536  # profiles for the solver alone
MOORING = """\
name: Deep line of twelve
environment: {depth: 5000 m, density: 1027 kg/m^3}
line:
  - {use: sphere, label: top float}
  - {use: wire, length: 500 m, clamps: [{use: logger, at: 100 m}, {use: logger, at: 300 m}]}
  - {use: meter}
  - {use: wire, length: 1000 m}
  - {use: meter}
  - {use: rope, length: 1200 m}
  - {use: meter}
  - {use: glass}
  - {use: rope, length: 1500 m}
  - {use: release}
  - {use: chain, length: 20 m}
  - {use: anchor}
components:
  sphere: {kind: sphere, role: float, diameter: 1.5 m, buoyancy: 12 kN}
  wire: {kind: cable, diameter: 8 mm, weight: 1.6 N/m, stiffness: 3000 kN}
  rope: {kind: cable, diameter: 14 mm, weight: 0.4 N/m, stiffness: 500 kN}
  chain: {kind: chain, diameter: 40 mm, weight: 60 N/m}
  logger: {kind: cylinder, diameter: 50 mm, length: 0.4 m, buoyancy: -10 N}
  meter: {kind: cylinder, diameter: 150 mm, length: 1 m, buoyancy: -200 N}
  glass: {kind: cylinder, role: float, diameter: 0.43 m, length: 4 m, buoyancy: 2 kN}
  release: {kind: cylinder, diameter: 0.2 m, length: 1 m, buoyancy: -300 N}
  anchor: {kind: anchor, weight: 30 kN}
"""


def write_record(path: Path, count: int) -> None:
    """A record of so many profiles, a part at a time."""
    import h5netcdf

    depth = np.linspace(0.0, 5000.0, 20)
    decay = 0.3 * np.exp(-depth / 800.0)
    random = np.random.default_rng(1)
    with h5netcdf.File(path, "w") as file:
        file.dimensions = {"time": count, "depth": len(depth)}
        clock = file.create_variable("time", ("time",), "i4")
        clock.attrs["units"] = "hours since 1993-01-01"
        clock.attrs["standard_name"] = "time"
        clock[...] = np.arange(count)
        levels = file.create_variable("depth", ("depth",), "f4")
        levels.attrs.update({"units": "m", "positive": "down", "standard_name": "depth"})
        levels[...] = depth
        for name, standard, phase in (("uo", "eastward", 0.0), ("vo", "northward", np.pi / 2)):
            current = file.create_variable(
                name, ("time", "depth"), "f4", chunks=(min(8192, count), len(depth))
            )
            current.attrs["units"] = "m/s"
            current.attrs["standard_name"] = f"{standard}_sea_water_velocity"
            for start in range(0, count, 65_536):
                t = np.arange(start, min(start + 65_536, count))
                turns = 2.0 * np.pi * t
                eddies = sum(np.sin(turns / hours + phase + hours) for hours in (700, 2100, 5000))
                tide = 0.5 * np.sin(turns / 12.42 + phase)
                noise = 0.02 * random.normal(size=(len(t), len(depth)))
                current[start : start + len(t)] = decay * (0.6 * eddies + tide)[:, None] + noise


def solver_alone(mooring: calm.Design, path: Path, workers: int) -> float:
    """Profiles a second of `solve_profiles`, arrays in and arrays out."""
    with open_record(path, Terms(5000.0)) as record:
        depth, u, v, _ = record.profiles(0, min(SAMPLE, record.count))
    calm.solve_profiles(mooring, u[:2048], v[:2048], depth, workers=workers)  # compiles, or fetches
    start = time.perf_counter()
    calm.solve_profiles(mooring, u, v, depth, workers=workers)
    return len(u) / (time.perf_counter() - start)


def without_statistics(
    mooring: calm.Design, path: Path, output: Path, workers: int
) -> tuple[float, float]:
    """Profiles a second from record to result, in this process, and the bytes of each."""
    start = time.perf_counter()
    with open_record(path, Terms(5000.0)) as record:
        counts = run_batch(mooring, record, output, workers=workers)
        count = record.count
    rate = count / (time.perf_counter() - start)
    unsolved = count - counts["converged"]
    print(f"{'':12}{unsolved} without equilibrium, {output.stat().st_size / 1e6:.0f} MB")
    return rate, output.stat().st_size / count


def without_solving(mooring: calm.Design, path: Path, output: Path) -> float:
    """Profiles a second that are read, hashed, packed and written: those of one block, again."""
    with open_record(path, Terms(5000.0)) as record:
        depth, u, v, _ = record.profiles(0, min(BLOCK, record.count))
    known = vars(calm.solve_profiles(mooring, u, v, depth))

    def solved(batch: Batch, u: np.ndarray, *_: object, **__: object) -> Profiles:
        columns = {
            name: values[: len(u)] if isinstance(values, np.ndarray) else values
            for name, values in known.items()
        }
        return Profiles(**columns)

    start = time.perf_counter()
    with patch.object(Batch, "solve", solved), open_record(path, Terms(5000.0)) as record:
        run_batch(mooring, record, output, workers=1)
        count = record.count
    output.unlink()
    return count / (time.perf_counter() - start)


MEASURE = """\
import resource, subprocess, sys, time
start = time.perf_counter()
subprocess.run([sys.executable, "-m", "calm", *sys.argv[1:]], stdout=subprocess.DEVNULL, check=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
seconds = time.perf_counter() - start
print(seconds, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)
"""
"""Run by a small process: one that is large hands its own size on to those that it starts."""


def whole_command(file: Path, path: Path, output: Path, workers: int) -> tuple[float, float, float]:
    """Seconds of the whole command, those of its processors, and the most memory it held [MB]."""
    words = ["batch", str(file), "--currents", str(path), "-o", str(output)]
    command = [sys.executable, "-c", MEASURE, *words, "--workers", str(workers)]
    told = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout
    seconds, used, memory = map(float, told.split())
    return seconds, used, memory


def main() -> None:
    """Print a table a count."""
    print(describe("calm-mooring", "numpy", "llvmlite", "h5py"))
    words = sys.argv[1:]
    counts = (SMOKE,) if words == ["--smoke"] else (*COUNTS, *map(int, words))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        file = folder / "mooring.yaml"
        file.write_text(MOORING)
        mooring = calm.load(file)
        for count in counts:
            path = folder / f"{count}.nc"
            write_record(path, count)
            print(f"\n{count} profiles, record of {path.stat().st_size / 1e6:.0f} MB")
            rates = {}
            for workers in (1, 2):
                alone = solver_alone(mooring, path, workers)
                output = folder / f"{count}-{workers}.nc"
                rate, size = without_statistics(mooring, path, output, workers)
                rates[workers] = rate
                output.unlink()
                seconds, used, memory = whole_command(file, path, output, workers)
                print(
                    f"{workers} worker{'s' * (workers > 1):12}solver alone {alone:8.0f}/s; "
                    f"NetCDF to NetCDF {rate:8.0f}/s, {rate / alone:.0%}; "
                    f"whole command {seconds:6.1f} s, {count / seconds:8.0f}/s, "
                    f"{count / used:8.0f}/s of a processor, {memory:.0f} MB"
                )
            served = without_solving(mooring, path, folder / f"{count}.served.nc")
            print(f"{'':12}without solving, by one thread: {served:8.0f}/s")
    print_sizes(rates, served, size)


def print_sizes(rates: dict[int, float], served: float, size: float) -> None:
    """Print the hours of large batches.

    Parameters
    ----------
    rates : profiles a second by workers, measured
    served : what one thread reads and writes a second
    size : bytes of a profile in the result
    """
    print(f"\nOne thread reads and writes {served:.0f} profiles a second, {size:.0f} bytes each.\n")
    columns = {"1 core": rates[1], "2 cores": rates[2]}
    columns[f"{PARTS} parts of 2 cores, computed"] = PARTS * rates[2]
    print(f"| profiles | result | {' | '.join(columns)} |")
    print(f"| --- | --- | {' | '.join('---' for _ in columns)} |")
    for count in SIZES:
        hours = (f"{count / rate / 3600.0:.2g} h" for rate in columns.values())
        print(f"| {count:.0e} | {count * size / 1e9:.3g} GB | {' | '.join(hours)} |")


if __name__ == "__main__":
    main()
