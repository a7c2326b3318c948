"""Compilation of the physics functions ("laws") by numba, from the source that CPython also runs.

A *law* is a function of floats, named tuples and sequences of named tuples that CPython can run
directly. The compiled law is the same function, except that the functions it calls are compiled
laws, sequences become arrays, and sequences of named tuples become arrays of records. The
arithmetic is not reordered, so both give the same digits.
"""

import hashlib
import os
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import FunctionType
from typing import Any, TypeVar, get_args, get_type_hints

import numpy as np

Law = Callable[..., Any]

SOURCES = ("physics", "solve", "batch")
"""Packages that contain functions to compile."""

OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "_nrt": False}
"""Compiler options. Laws allocate nothing, so reference counting of arrays is switched off for
speed; they never divide by zero or raise an exception.
"""

NEWEST = (0, 68)
"""Latest version of numba whose internals are compatible with `calm.physics.law_compiler`."""

Fn = TypeVar("Fn", bound=Law)


def within(law: Fn) -> Fn:
    """Mark a short function for inlining into its callers."""
    _within.add(law)
    return law


_within: set[Law] = set()


def set_row(rows: Any, i: int, row: Any) -> None:
    """Replace row i of a list of named tuples, which compiled code sees as an array of records."""
    rows[i] = row


_entries: dict[Law, Any] = {}


def entry(law: Law, *arguments: Any) -> Any:
    """Return a law compiled for the types of the given arguments.

    The types are checked only in the first call, which saves time in short solves. All later
    arguments must have the same types.
    """
    found = _entries.get(law)
    if found is None:
        numba: Any = __import__("numba")
        dispatcher = kept(numba.njit, clone(law))
        types = tuple(numba.typeof(argument) for argument in arguments)
        dispatcher.compile(types)
        found = _entries[law] = dispatcher.overloads[types].entry_point
    return found


def outcome(law: Law, compiled: bool, *given: Any) -> Any:
    """Call a law, compiled (see `entry`) or interpreted."""
    return (entry(law, *given) if compiled else law)(*given)


def by_address(law: Law, *arguments: Any) -> Any:
    """Return a law compiled for the types of the given arguments, to be called by its address.

    The law has a float as an additional last argument, and returns a float. Its callers are
    compiled without it, which saves its compilation time for each caller. As for `entry`, all later
    arguments must have the same types.
    """
    found = _entries.get(law)
    if found is None:
        numba: Any = __import__("numba")
        types = tuple(numba.typeof(argument) for argument in arguments)
        signature = numba.float64(*types, numba.float64)
        found = _entries[law] = kept(
            lambda law, **options: numba.cfunc(signature, **options)(law), clone(law)
        )
    return found


@cache
def called(law: Law) -> Any:
    """Return a law compiled for inclusion in the compiled code of the laws that call it."""
    import numba

    if law is set_row:
        return _record_setter()
    njit: Any = numba.njit
    dispatcher = njit(clone(law), forceinline=law in _within, **_linked_options())
    resolve, plain = dispatcher.get_call_template, numba.types.unliteral

    def once_for_all_numbers(types: Any, named: Any) -> Any:
        """Compile the law once for all values of an integer, not once per constant."""
        return resolve(tuple(map(plain, types)), named)

    dispatcher.get_call_template = once_for_all_numbers
    return dispatcher


def _linked_options() -> dict[str, Any]:
    wrappers = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    return {**OPTIONS, **wrappers, "pipeline_class": _law_compiler()}


@cache
def _law_compiler() -> Any:
    """Return the compiler class for laws, or numba's own class if numba is newer than `NEWEST`."""
    numba: Any = __import__("numba")
    if numba.version_info.short > NEWEST:
        return numba.core.compiler.Compiler
    from calm.physics.law_compiler import LawCompiler

    return LawCompiler


@cache
def _record_setter() -> Law:
    """Return the compiled form of `set_row`, which copies a record field by field."""
    numba: Any = __import__("numba.extending")

    def set_record(rows, i, row):  # type: ignore[no-untyped-def]
        raise NotImplementedError

    @numba.extending.overload(set_record, jit_options=_linked_options())
    def for_types(rows, i, row):  # type: ignore[no-untyped-def]
        names: dict[str, Any] = {}
        fields = "\n".join(f"    rows[i].{name} = row.{name}" for name in rows.dtype.fields)
        exec(f"def by_field(rows, i, row):\n{fields}", names)
        return names["by_field"]

    return set_record


def clone(law: Law) -> Law:
    """Copy a function for compilation: it calls compiled laws, and its tables are arrays."""
    assert isinstance(law, FunctionType)
    names = {**law.__globals__}
    for name in law.__code__.co_names:
        value = names.get(name)
        if isinstance(value, FunctionType) and value.__module__.startswith("calm."):
            names[name] = called(value)
        elif type(value) is tuple and value and all(type(x) is float for x in value):
            names[name] = np.array(value)
    clone = FunctionType(law.__code__, names, law.__name__, law.__defaults__, law.__closure__)
    clone.__module__, clone.__qualname__ = law.__module__, law.__qualname__
    return clone


def kept(compiler: Callable[..., Any], law: Law) -> Any:
    """Compile a law, and cache the result on disk if there is a cache folder."""
    import numba

    folder, options = cache_folder(), {**OPTIONS, "pipeline_class": _law_compiler()}
    if folder is None:
        return compiler(law, **options)
    settings: Any = numba.config
    chosen = settings.CACHE_DIR
    settings.CACHE_DIR = str(folder)  # read as the function is decorated
    try:
        return compiler(law, cache=True, **options)
    finally:
        settings.CACHE_DIR = chosen


def packed(value: Any) -> Any:
    """Convert a named tuple for compiled code: its sequences become arrays."""
    named: Any = type(value)
    return named(*[pack(part) for pack, part in zip(_packers(named), value, strict=True)])


@cache
def _packers(named: Any) -> tuple[Callable[[Any], Any], ...]:
    """Return the functions that convert the fields of a named tuple."""
    return tuple(map(_packer, get_type_hints(named).values()))


def _packer(kind: Any) -> Callable[[Any], Any]:
    if kind in (int, float):
        number: Callable[[Any], Any] = kind
        return number
    if not get_args(kind):
        return packed
    item = get_args(kind)[0]
    of = np.dtype(np.float64) if item is float else record_type(item)
    return lambda part: np.array(part if isinstance(part, np.ndarray) else list(part), of)


@cache
def record_type(named: type) -> np.dtype[Any]:
    """Return the numpy record type of a named tuple of numbers."""
    return np.dtype(
        [
            (name, np.intp if kind is int else np.float64)
            for name, kind in get_type_hints(named).items()
        ]
    )


@cache
def cache_folder() -> Path | None:
    """Return the folder for compiled code, or None if no folder can be written.

    The folder is in `NUMBA_CACHE_DIR` if set, else in the user's cache. Every version of the
    sources has its own subfolder, because numba itself checks for changes in a single source file
    only.
    """
    given = os.environ.get("NUMBA_CACHE_DIR")
    folder = (Path(given) if given else _user_cache() / "calm") / f"solver-{fingerprint()}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError:
        return None


def is_cached(law: str) -> bool:
    """True if the cache folder contains the compiled code of a law."""
    folder = cache_folder()
    return folder is not None and next(folder.rglob(f"*.{law}-*.nbi"), None) is not None


def _user_cache() -> Path:
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")


def fingerprint() -> str:
    """Return a hash of all source files that may be compiled."""
    digest = hashlib.sha256()
    package = Path(__file__).parents[1]
    for folder in SOURCES:
        for source in sorted((package / folder).glob("*.py")):
            digest.update(source.read_bytes())
    return digest.hexdigest()[:16]
