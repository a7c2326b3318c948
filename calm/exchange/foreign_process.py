"""Run readers of foreign binary files in a separate process.

The readers use C and Rust libraries, which may crash or request all memory on a damaged file. Only
the child process then ends.
"""

import os
import sys
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

_Given = ParamSpec("_Given")
_Found = TypeVar("_Found")

MOST_MEMORY = 3_000_000_000
"""Additional memory allowed for a reader [bytes]; limited on Linux only."""

MOST_SECONDS = 120.0
"""Time after which a reader is stopped [s]."""


def read_apart(
    reader: Callable[_Given, _Found], *given: _Given.args, **named: _Given.kwargs
) -> _Found:
    """Call a reader in a child process, and return the result.

    The reader must be defined at the top level of a module. Raise ValueError if the reader fails,
    crashes, or takes too much time or memory.
    """
    from multiprocessing import Pipe, Process

    here, there = Pipe(duplex=False)
    child = Process(target=_send_result, args=(there, reader, given, named), daemon=True)
    child.start()
    there.close()
    try:
        if not here.poll(MOST_SECONDS):
            raise ValueError(f"reading takes longer than {MOST_SECONDS:g} s")
        answer: tuple[_Found, str] = here.recv()
    except EOFError:
        child.join()
        raise ValueError(
            f"the process that reads the file ended with exit code {child.exitcode}"
        ) from None
    finally:
        child.kill()
        child.join()
        here.close()
    found, wrong = answer
    if wrong:
        raise ValueError(wrong)
    return found


def _send_result(
    pipe: Connection, reader: Callable[..., Any], given: tuple[Any, ...], named: dict[str, Any]
) -> None:
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # discard messages of the libraries
    _limit_memory()
    try:
        pipe.send((reader(*given, **named), ""))
    except MemoryError:
        pipe.send((None, f"reading needs more than {MOST_MEMORY / 1e9:g} GB of memory"))
    except BaseException as error:  # a Rust panic is not an `Exception`
        pipe.send((None, " ".join(str(error).split()) or type(error).__name__))


def _limit_memory() -> None:
    if sys.platform != "linux":
        return
    import resource

    with suppress(OSError, ValueError):
        pages = int(Path("/proc/self/statm").read_text("ascii").split()[0])
        most = pages * resource.getpagesize() + MOST_MEMORY
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
