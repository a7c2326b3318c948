"""Runs batches in processes that are killed; started by `test_run.py`, prints what came of it.

python killed.py FOLDER ENDING moments|steps
"""

import json
import os
import signal
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))

from calm.batch.profiles import Batch
from calm.batch.run import compile_kernel, run_batch
from tests.unit.batch.made import MadeRecord, content, made_mooring

KILLS = 12
BLOCK = 16


def start(mooring, record, output, before=lambda: None):
    """A batch in a process of its own, whose end is not awaited."""
    child = os.fork()
    if not child:
        before()
        outcome = run_batch(mooring, record, output, workers=1, block=BLOCK)
        os._exit(0 if outcome.done else 75)
    return child


def ended(child):
    """How a process ended: its exit code, less than 0 for a signal."""
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def at_moments(mooring, record, output, duration):
    """Kill at moments that a seed chooses, until enough have hit."""
    random = np.random.default_rng(20240229)
    results, hit, kept = [], 0, 0
    while hit < KILLS:
        child = start(mooring, record, output)
        time.sleep(random.uniform(0.0, duration))
        os.kill(child, signal.SIGKILL)
        if ended(child) == -signal.SIGKILL:
            hit += 1
            kept += any(output.with_name(output.name + ".part").glob("time/*"))
        if output.exists():
            results.append(finished(mooring, record, output))
    results.append(finished(mooring, record, output))
    return {"hit": hit, "kept": kept, "results": results}


def at_steps(mooring, record, output, stride=17):
    """End the process without a word before it touches the n-th file, for every so many-th n."""
    results, hit, step = [], 0, 1
    while True:
        if ended(start(mooring, record, output, lambda n=step: end_before(n, output))) == 0:
            break
        hit += 1
        results.append(finished(mooring, record, output))
        step += stride
    return {"hit": hit, "results": results}


def end_before(step, output):
    left = [step]

    def watch(event, arguments):
        touched = event in {"open", "os.rename", "os.remove", "os.rmdir", "os.mkdir"}
        if touched and str(output) in str(arguments[0]):
            left[0] -= 1
            if not left[0]:
                os._exit(9)

    sys.addaudithook(watch)


def finished(mooring, record, output):
    """Run to the end, and take the result away."""
    assert ended(start(mooring, record, output)) == 0
    assert not output.with_name(output.name + ".part").exists()
    found = content(output)
    for path in sorted(output.rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()
    output.rmdir() if output.is_dir() else output.unlink()
    return found


if __name__ == "__main__":
    folder, ending, how = Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    mooring, record = made_mooring(folder), MadeRecord(100 if how == "moments" else 40)
    compile_kernel(Batch(mooring), print)
    import h5netcdf  # noqa: F401 — so that every process has it, and is killed at its work

    began = time.perf_counter()
    wanted = finished(mooring, record, folder / f"undisturbed{ending}")
    duration = time.perf_counter() - began
    output = folder / f"killed{ending}"
    if how == "moments":
        told = at_moments(mooring, record, output, duration)
    else:
        told = at_steps(mooring, record, output)
    results = told.pop("results")
    print(json.dumps({**told, "finished": len(results), "same": all(r == wanted for r in results)}))
