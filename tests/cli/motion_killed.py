"""Runs `calm motion` in processes that end without a word; started by `test_motion.py`.

    python motion_killed.py FOLDER

The folder holds the mooring, what was measured, and a file of instruments. Prints what came of an
end before each touch of the folder of the results. What is done to the blocks that are kept within
is tried with batches.
"""

import json
import os
import sys
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from calm.cli.main import main
from tests.unit.batch.killed import TOUCHES, ended

WRITTEN = ("copy.motion.nc", "copy.nc", "said.json")


def motion(out):
    """The command, whose results go to a folder; its exit code."""
    return main([
        "motion", "m.yaml", "--currents", "c.csv", "--pressures", "p.csv", "--workers", "1",
        "--onto", "own.nc", "-o", str(out / "copy.nc"), "--json", str(out / "said.json"),
    ])  # fmt: skip


def start(out, before=lambda: None):
    """The command in a process of its own; its exit code."""
    child = os.fork()
    if not child:
        before()
        os._exit(motion(out))
    return ended(child)


def end_before(step, out):
    """End this process before it touches something in a folder for the n-th time."""
    left = [step]

    def watch(event, arguments):
        if event in TOUCHES:
            paths = [Path(os.fsdecode(one)) for one in arguments if isinstance(one, (str, bytes))]
            left[0] -= any(path.parent == out for path in paths)
            if not left[0]:
                os._exit(9)

    sys.addaudithook(watch)


def content(out):
    """What stands under the names of the results."""
    return {name: (out / name).read_bytes() for name in WRITTEN if (out / name).exists()}


def emptied(out):
    for path in sorted(out.rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()


if __name__ == "__main__":
    os.chdir(sys.argv[1])
    os.environ["SOURCE_DATE_EPOCH"] = "1800000000"  # the date in every history
    out = Path("out").absolute()
    out.mkdir()
    assert motion(out) == 0  # and all is loaded
    whole = content(out)
    assert sorted(whole) == sorted(WRITTEN)
    step, seen, wrong = 1, [], []
    while True:
        emptied(out)
        code = start(out, partial(end_before, step, out))
        there = content(out)
        wrong += [(step, name) for name, held in there.items() if held != whole[name]]
        if code == 0:
            break
        seen.append(len(there))
        if step % 4 == 0 and (start(out) != 0 or content(out) != whole):
            wrong.append((step, "again"))
        step += 1
    print(json.dumps({"seen": seen, "wrong": wrong}))
