"""Compilation of the physics functions ("laws") to machine code.

A law is a function of floats, named tuples and sequences of named tuples, which CPython can also
run directly. In compiled laws, sequences are arrays, and sequences of named tuples are arrays of
records. Compiled and interpreted laws give the same digits. Machine code is stored in the user's
cache.
"""

import ctypes
import hashlib
import os
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from threading import Lock
from typing import Any, TypeVar, get_args, get_type_hints

import numpy as np

from calm.errors import UsageError, one_line
from calm.physics.law_kinds import FROM_MATH, NOTHING, Layout, Row, kind_asked, kind_of, record_type

Law = Callable[..., Any]

SOURCES = ("physics", "solve", "batch")
"""Packages that contain functions to compile."""

OPTIMISATION = 1
"""Level of LLVM's optimisation, which never changes a digit."""
QUICK = ("always_inliner", "sroa", "simplify_cfg", "instruction_combine")
"""LLVM's passes for most laws. They take a tenth of the time of LLVM's level 1, and the code is 5 %
slower.
"""

Fn = TypeVar("Fn", bound=Law)


def within(law: Fn) -> Fn:
    """Mark a function for inlining into its callers, even if the function is not short."""
    _within.add(law)
    return law


_within: set[Law] = set()


def optimised(law: Fn) -> Fn:
    """Mark a law whose calls take so long that full optimisation (`OPTIMISATION`) pays."""
    _optimised.add(law)
    return law


_optimised: set[Law] = set()


def set_row(rows: Any, i: int, row: Any) -> None:
    """Replace row i of a list of named tuples or, in compiled code, of an array of records."""
    rows[i] = row


class Compiled:
    """A physics function ("law") compiled to machine code, and called like the Python function.

    Types of arguments are set by the first call, and not checked in later calls.
    """

    def __init__(self, law: Law, kinds: tuple[Any, ...], result: Any) -> None:
        self._given, self._result = Layout(Row(None, kinds)), Layout(result)
        self._nothing = result == NOTHING
        address = _address_of(law, kinds, result)
        # calls through a CFUNCTYPE do not block other threads
        self._call = ctypes.CFUNCTYPE(None, ctypes.c_char_p, ctypes.c_char_p)(address)

    def __call__(self, *arguments: Any) -> Any:
        result = ctypes.create_string_buffer(self._result.size)
        self._call(self._given.written(arguments), result)
        return None if self._nothing else self._result.read(result.raw)


_entries: dict[Law, Any] = {}
_lock = Lock()
if hasattr(os, "register_at_fork"):  # a child process must not inherit a compilation under way
    os.register_at_fork(
        before=_lock.acquire, after_in_parent=_lock.release, after_in_child=_lock.release
    )


def entry(law: Law, *arguments: Any) -> Compiled:
    """Return a law in compiled form, for arguments of the same types as the given arguments."""
    with _lock:
        if law not in _entries:
            *hints, result = get_type_hints(law).values()
            kinds = tuple(map(kind_of, arguments, hints))
            _entries[law] = Compiled(law, kinds, kind_asked(result))
        found: Compiled = _entries[law]
        return found


def outcome(law: Law, compiled: bool, *given: Any) -> Any:
    """Call a law, either compiled (see `entry`) or interpreted, and return its result."""
    return (entry(law, *given) if compiled else law)(*given)


_ENTRY = "calm.entry"
_engines: list[Any] = []


def _address_of(law: Law, kinds: tuple[Any, ...], result: Any) -> int:
    """Return the address of the machine code of a law for given kinds of arguments.

    The code comes from the cache, or is compiled and stored there.

    Raise UsageError if LLVM does not work, or ModuleNotFoundError if LLVM is not installed.
    """
    if (error := fault()) is not None:
        if isinstance(error, ModuleNotFoundError):
            raise error
        raise UsageError(
            "the package llvmlite, which compiles the solver, does not work here "
            f"({type(error).__name__}: {one_line(str(error))}); install it again or in another "
            "version"
        ) from error
    import llvmlite.binding as llvm

    for name in FROM_MATH:
        llvm.add_symbol(f"calm.{name}", _in_c(name))
    target = _target_machine()
    folder, name = cache_folder(), f"{law.__module__}.{law.__qualname__}"
    file = folder and folder / f"{name}-{_short_name(kinds)}-{_machine_name()}.o"
    code = _stored(file) if file else b""
    if not code:
        for listener in on_compilation:
            listener()
        from calm.physics.law_compiler import Program

        program = Program(_within)
        program.add_entry(_ENTRY, law, kinds, result)
        module = llvm.parse_assembly(program.text())
        module.triple, module.data_layout = target.triple, str(target.target_data)
        tuning = llvm.create_pipeline_tuning_options(OPTIMISATION)
        builder = llvm.create_pass_builder(target, tuning)
        if law in _optimised:
            passes = builder.getModulePassManager()
        else:
            passes = llvm.create_new_module_pass_manager()
            for step in QUICK:
                getattr(passes, f"add_{step}_pass")()
        passes.run(module, builder)
        code = target.emit_object(module)
        if file:
            _store(file, code)
    return _loaded(code)


def _loaded(code: bytes) -> int:
    import llvmlite.binding as llvm

    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _target_machine())
    engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    _engines.append(engine)
    address: int = engine.get_function_address(_ENTRY)
    return address


@cache
def fault() -> Exception | None:
    """Compile and call a small function; return the exception if LLVM is missing or does not work.

    LLVM may be installed without support for this machine, or be forbidden to make code executable.
    """
    try:
        import llvmlite.binding as llvm

        _machine_name()
        module = llvm.parse_assembly(f'define i32 @"{_ENTRY}"() {{ ret i32 1 }}')
        address = _loaded(_target_machine().emit_object(module))
        if ctypes.CFUNCTYPE(ctypes.c_int)(address)() == 1:
            return None
        return RuntimeError("compiled code gives a wrong result")
    except Exception as error:
        return error


on_compilation: list[Callable[[], None]] = []
"""Functions to call before a law is compiled because the cache does not contain it."""


def _store(file: Path, code: bytes) -> None:
    """Write machine code and its seal to the cache if possible, completely or not at all."""
    try:
        with tempfile.NamedTemporaryFile(dir=file.parent, delete=False) as whole:
            try:
                whole.write(_seal(file, code) + code)
                whole.close()
                os.replace(whole.name, file)
            except OSError:
                os.unlink(whole.name)
    except OSError:
        return


def _stored(file: Path) -> bytes:
    """Return the machine code in a file of the cache, or nothing if the file is damaged.

    The check is needed because some damaged files make LLVM end the process.
    """
    try:
        whole = file.read_bytes()
    except OSError:
        return b""
    code = whole[_SEAL:]
    return code if whole[:_SEAL] == _seal(file, code) else b""


_SEAL = hashlib.sha256().digest_size


def _seal(file: Path, code: bytes) -> bytes:
    return hashlib.sha256(file.name.encode() + code).digest()


@cache
def _target_machine() -> Any:
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    features = llvm.get_host_cpu_features().flatten()
    return llvm.Target.from_default_triple().create_target_machine(
        cpu=llvm.get_host_cpu_name(), features=features, opt=OPTIMISATION, codemodel="jitdefault",
        jit=True,
    )  # fmt: skip


@cache
def _machine_name() -> str:
    import llvmlite.binding as llvm

    features = sorted(llvm.get_host_cpu_features().items())
    given = (llvm.get_process_triple(), llvm.get_host_cpu_name(), features, llvm.llvm_version_info)
    return _short_name(given)


def _short_name(given: Any) -> str:
    return hashlib.sha256(repr(given).encode()).hexdigest()[:12]


def _in_c(name: str) -> int:
    """Return the address of a function of the C library that CPython's `math` also calls."""
    windows: Any = getattr(ctypes, "cdll", None)
    library = windows.ucrtbase if sys.platform == "win32" else ctypes.CDLL(None)
    address = ctypes.cast(getattr(library, name), ctypes.c_void_p).value
    assert address is not None
    return address


def packed(value: Any) -> Any:
    """Convert the sequences in a named tuple to arrays, for compiled code."""
    named: Any = type(value)
    return named(*[pack(part) for pack, part in zip(_packers(named), value, strict=True)])


@cache
def _packers(named: Any) -> tuple[Callable[[Any], Any], ...]:
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
def cache_folder() -> Path | None:
    """Return the folder for compiled code, or None if the folder cannot be written.

    The folder is a subfolder for this version of the sources, in `CALM_CACHE_DIR` or in CALM's
    folder in the user's cache.
    """
    given = os.environ.get("CALM_CACHE_DIR") or os.environ.get("NUMBA_CACHE_DIR")  # its old name
    try:
        folder = (Path(given) if given else _user_cache() / "calm") / f"solver-{fingerprint()}"
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except (OSError, RuntimeError):  # the second if there is no home folder
        return None


def is_cached(law: str) -> bool:
    """Return whether LLVM works and the cache folder contains compiled code for a law."""
    folder = cache_folder()
    if folder is None or fault() is not None:
        return False
    return next(folder.glob(f"*.{law}-*-{_machine_name()}.o"), None) is not None


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
