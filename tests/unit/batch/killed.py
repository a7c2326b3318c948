"""Runs batches in processes that are killed; started by `test_interrupted.py`.

    python killed.py FOLDER ENDING KILLS|steps

Prints what came of so many kills at moments of chance, or of one before every step.
"""

import json
import os
import signal
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))

import h5netcdf
import h5py

from calm.batch.profiles import Batch
from calm.batch.run import run_batch
from calm.batch.work import compile_solver
from tests.unit.batch.made import PLAIN, MadeRecord, content, made_mooring

TOUCHES = {"open", "os.rename", "os.remove", "os.rmdir", "os.mkdir", "os.truncate", "shutil.rmtree"}


def start(mooring, record, output, block, before=lambda: None):
    """A batch in a process of its own, whose end is not awaited."""
    child = os.fork()
    if not child:
        before()
        outcome = run_batch(mooring, record, output, workers=1, block=block)
        os._exit(0 if outcome.done else 75)
    return child


def ended(child):
    """How a process ended: its exit code, less than 0 for a signal."""
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def at_moments(mooring, record, output, duration, kills):
    """Kill at moments that a seed chooses, until enough have left a block, or a result."""
    random = np.random.default_rng(20240229)
    results, hit, kept = [], 0, 0
    while kept < kills:
        child = start(mooring, record, output, 16)
        time.sleep(random.uniform(0.0, duration))
        os.kill(child, signal.SIGKILL)
        if ended(child) == -signal.SIGKILL:
            hit += 1
            kept += any(output.with_name(output.name + ".part").glob(".batch/[0-9]"))
        if output.exists():
            results.append(finished(mooring, record, output, 16))
    results.append(finished(mooring, record, output, 16))
    return {"hit": hit, "kept": kept, "results": results}


def at_steps(mooring, record, output):
    """End the process without a word before it touches the n-th file, for every n.

    But for what makes one of them, NetCDF files and zarr folders come about alike: every fifth
    is enough for the file.
    """
    results, kept, step = [], 0, 1
    flags = output.with_name(output.name + ".part") / ".batch"
    while ended(start(mooring, record, output, 4, lambda n=step: end_before(n, output))) != 0:
        done = len([*flags.glob("[0-9]")])
        kept += done > 0
        writes_netcdf = done == 2 and not output.exists()
        results.append(finished(mooring, record, output, 4))
        step += 1 if writes_netcdf or output.suffix == ".zarr" else 5
    finished(mooring, record, output, 4)
    return {"hit": len(results), "kept": kept, "results": results}


def end_before(step, output):
    """Count what is done to files, whether by a path, in a folder that is open, or in HDF5."""
    left = [step]
    folder = str(output.parent)

    def count():
        left[0] -= 1
        if not left[0]:
            os._exit(9)

    def watch(event, arguments):
        if event not in TOUCHES:
            return
        in_open_folder = event in {"os.remove", "os.rmdir"} and arguments[-1] not in (None, -1)
        if in_open_folder or folder in str(arguments[0]):
            count()

    def counted(method):
        def call(self, *arguments, **options):
            if not arguments or not isinstance(arguments[0], h5py.h5f.FileID):  # open already
                count()
            return method(self, *arguments, **options)

        return call

    sys.addaudithook(watch)
    for kind in (h5py.File, h5netcdf.File):
        kind.__init__ = counted(kind.__init__)
        kind.close = counted(kind.close)


def finished(mooring, record, output, block):
    """Run to the end, and take the result away."""
    assert ended(start(mooring, record, output, block)) == 0
    left = [path.name for path in output.parent.iterdir() if path.name.startswith(output.name)]
    assert left == [output.name], left
    found = content(output)
    for path in sorted(output.rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()
    output.rmdir() if output.is_dir() else output.unlink()
    return found


if __name__ == "__main__":
    folder, ending, how = Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    # few blocks of few variables where every step is tried
    mooring = made_mooring(folder, *([PLAIN] if how == "steps" else []))
    record, block = (MadeRecord(8), 4) if how == "steps" else (MadeRecord(100), 16)
    compile_solver(Batch(mooring), print)
    os.fsync = lambda handle: None  # the power stays on

    began = time.perf_counter()
    wanted = finished(mooring, record, folder / f"undisturbed{ending}", block)
    duration = time.perf_counter() - began
    output = folder / f"killed{ending}"
    if how == "steps":
        told = at_steps(mooring, record, output)
    else:
        told = at_moments(mooring, record, output, duration, int(how))
    results = told.pop("results")
    print(json.dumps({**told, "finished": len(results), "same": all(r == wanted for r in results)}))
