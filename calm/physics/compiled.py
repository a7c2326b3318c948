"""The laws compiled by numba: the same source, made fast for whoever solves many lines.

A law is a function over floats, named tuples and sequences of them that CPython runs as it
stands. Compiled, it is the same function of the same code, whose globals hold the compiled laws
in place of those it calls; sequences become arrays, those of named tuples arrays of records. No
liberty is taken with the arithmetic, so that both give the same digits.
"""

import gc
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
"""Packages that have functions to be compiled."""

OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "_nrt": False}
"""Nothing is allocated by a compiled law, so that arrays need not be counted when they are passed
on: that takes as long as a segment. No law divides by zero, and none raises."""

NEWEST = (0, 68)
"""Of numba, whose parts are known to be as `_law_compiler` uses them."""

NEEDLESS = {
    "WithLift", "InlineClosureLikes", "RewriteSemanticConstants", "DeadBranchPrune",
    "RewriteDynamicRaises", "MakeFunctionToJitFunction", "InlineInlinables", "FindLiterallyCalls",
    "LiteralUnroll", "LiteralPropagationSubPipelinePass", "InlineOverloads", "NopythonRewrites",
    "NoPythonSupportedFeatureValidation", "DumpParforDiagnostics",
}  # fmt: skip
"""Passes of numba's compiler for what no law has: closures, array expressions, and the like."""

COUNT, SIZE, DATA, SHAPE, STRIDES = range(2, 7)
"""Where it stands in numba's own form of an array; nobody holds, or owns, what a law is given."""

SELDOM = 100_000, 20, 100
"""When garbage is collected while laws are compiled."""

Fn = TypeVar("Fn", bound=Law)


def within(law: Fn) -> Fn:
    """Mark a short law that is compiled within those that call it, as if it were written there."""
    _within.add(law)
    return law


_within: set[Law] = set()


def set_row(rows: Any, i: int, row: Any) -> None:
    """Put a named tuple in its place among others: a list, or compiled an array of records."""
    rows[i] = row


@cache
def compiled(law: Law) -> Any:
    """A law and all that it calls, compiled when first called, and kept for the next process."""
    import numba

    options = {**OPTIONS, "pipeline_class": _law_compiler()}
    return kept(numba.njit, clone(law), cache_folder(), **options)


_entries: dict[Law, Any] = {}


def entry(law: Law, *arguments: Any) -> Any:
    """A law compiled for the types of some arguments, whose types it does not look at again.

    All that it is ever given has these types: that saves what a short solve takes.
    """
    found = _entries.get(law)
    if found is None:
        numba: Any = __import__("numba")
        dispatcher = compiled(law)
        types = tuple(numba.typeof(argument) for argument in arguments)
        dispatcher.compile(types)
        found = _entries[law] = dispatcher.overloads[types].entry_point
    return found


def by_address(law: Law, *arguments: Any) -> Any:
    """A law compiled for the types of some arguments, and called by its address.

    Its last argument, besides these, and what it returns are floats. Those that call it are not
    compiled anew with it, which would take as long for each. As with `entry`, it is only ever given
    arguments of these types.
    """
    found = _entries.get(law)
    if found is None:
        numba: Any = __import__("numba")
        types = tuple(numba.typeof(argument) for argument in arguments)
        signature = numba.float64(*types, numba.float64)
        options = {name: OPTIONS[name] for name in ("error_model", "_nrt")}

        def compiler(law: Law, **options: Any) -> Any:
            return numba.cfunc(signature, pipeline_class=_law_compiler(), **options)(law)

        found = _entries[law] = kept(compiler, clone(law), cache_folder(), **options)
    return found


@cache
def called(law: Law) -> Any:
    """A law compiled into those that call it."""
    import numba

    if law is set_row:
        return _record_setter()
    njit: Any = numba.njit
    dispatcher = njit(clone(law), forceinline=law in _within, **_linked_options())
    resolve, plain = dispatcher.get_call_template, numba.types.unliteral

    def once_for_all_numbers(types: Any, named: Any) -> Any:
        """Not anew for every constant that it is given."""
        return resolve(tuple(map(plain, types)), named)

    dispatcher.get_call_template = once_for_all_numbers
    return dispatcher


def _linked_options() -> dict[str, Any]:
    """Options of a law that is only called by others."""
    wrappers = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    return {**OPTIONS, **wrappers, "pipeline_class": _law_compiler()}


@cache
def _law_compiler() -> Any:
    """The compiler of laws: what it spares is most of what numba's own takes for them.

    A law that others call is no machine code by itself. It is linked into the law that is called
    from Python, and optimised in it once; numba itself optimises and translates every law again on
    each level of the calls. A call of types that were seen before is not resolved again, passes for
    what no law has are left out, and what is assigned once needs no place in memory. All is left as
    it is in a numba newer than `NEWEST`.
    """
    numba: Any = __import__("numba")
    if numba.version_info.short > NEWEST:
        return numba.core.compiler.Compiler
    core, make_function = numba.core, numba._dynfunc.make_function
    library: Any = core.codegen.JITCodeLibrary
    lowering: Any = core.typed_passes.NativeLowering
    lower: Any = core.lowering.Lower
    compiler: Any = core.compiler.CompilerBase
    builtin: Any = numba.types.Function
    resolve, seen = builtin.get_call_type, {}

    def resolve_once(called: Any, typing: Any, given: Any, named: Any) -> Any:
        if named:
            return resolve(called, typing, given, named)
        found = seen.get((called, given))
        if found is None:
            found = seen[called, given] = resolve(called, typing, given, named)
        return found

    def short_name(name: str, types: Any, **more: Any) -> str:
        """The types of a law's arguments, written out, are pages."""
        digest = hashlib.sha256(repr(types).encode()).hexdigest()[:16]
        return str(core.funcdesc.default_mangler(f"{name}_{digest}", (), **more))

    datamodel: Any = core.datamodel

    class LawArray(datamodel.models.ArrayModel):  # type: ignore[misc]
        """An array, given to a law as its place and its shape, from which all else follows.

        What numba itself compiles for laws, such as `max`, is given numbers alone.
        """

        def get_argument_type(self) -> Any:
            assert self._fe_type.layout == "C"
            parts = self.get_value_type().elements
            return parts[DATA], (parts[COUNT],) * self._fe_type.ndim

        def as_argument(self, builder: Any, value: Any) -> Any:
            shape = [builder.extract_value(value, [SHAPE, k]) for k in range(self._fe_type.ndim)]
            return builder.extract_value(value, [DATA]), tuple(shape)

        def from_argument(self, builder: Any, value: Any) -> Any:
            data, shape = value
            item = self._dmm[self._fe_type.dtype].get_data_type()
            size = core.cgutils.sizeof(builder, item.as_pointer())
            count, array = size.type(1), self.get_value_type()(None)
            for k in reversed(range(len(shape))):
                array = builder.insert_value(array, builder.mul(count, size), [STRIDES, k])
                array = builder.insert_value(array, shape[k], [SHAPE, k])
                count = builder.mul(count, shape[k])
            for place, part in ((COUNT, count), (SIZE, size), (DATA, data)):
                array = builder.insert_value(array, part, [place])
            return array

    arrays = datamodel.manager.DataModelManager({numba.types.Array: LawArray})
    models = arrays.chain(datamodel.default_manager)

    class LinkedLibrary(library):  # type: ignore[misc]
        def finalize(self) -> None:
            self._finalize_dynamic_globals()
            self._finalized = True

    class LawLower(lower):  # type: ignore[misc]
        def _find_singly_assigned_variable(self) -> None:
            """A variable assigned once, before all its uses, is a value."""
            blocks = self.func_ir.blocks
            before = core.analysis.compute_cfg_from_blocks(blocks).dominators()
            assigned: dict[str, list[int]] = {}
            used: dict[str, set[int]] = {}
            for place, block in blocks.items():
                for each in block.find_insts(core.ir.Stmt):
                    if isinstance(each, core.ir.Assign):
                        assigned.setdefault(each.target.name, []).append(place)
                    if not isinstance(each, core.ir.Del):
                        for variable in each.list_vars():
                            used.setdefault(variable.name, set()).add(place)
            self._singly_assigned_vars = {
                name
                for name, places in assigned.items()
                if len(places) == 1
                and all(places[0] in before[use] and places[0] <= use for use in used[name])
            }
            self._blk_local_varmap: dict[str, Any] = {}

        def delvar(self, name: str) -> None:
            """Nothing is allocated."""

    @core.compiler_machinery.register_pass(mutates_CFG=True, analysis_only=False)
    class LawLowering(lowering):  # type: ignore[misc]
        _name = "law_lowering"
        lowering_class = LawLower

        def run_pass(self, state: Any) -> bool:
            if not (state.flags.no_cpython_wrapper and state.flags.no_cfunc_wrapper):
                return bool(super().run_pass(state))
            target, name = state.targetctx, state.func_id.func_qualname
            state.library = LinkedLibrary(target.codegen(), name)
            state.flags.no_compile = True
            super().run_pass(state)
            lowered = state["cr"]
            module = lowered.fndesc.lookup_module()
            libraries = dict.fromkeys([state.library, *state.library._linking_libraries])
            key = make_function(module, name, "", 0, lowered.env, (state.library,))
            target.insert_user_function(key, lowered.fndesc, [*libraries])
            state["cr"] = lowered._replace(cfunc=key)
            return True

    ours = {"mangler": short_name, "data_model_manager": models, "cached_internal_func": {}}

    class LawCompiler(compiler):  # type: ignore[misc]
        def __init__(self, typing: Any, target: Any, *others: Any) -> None:
            super().__init__(typing, target.subtarget(**ours), *others)

        def compile_extra(self, law: Law) -> Any:
            """Of the millions of objects that this makes hardly one is garbage."""
            chosen, resolves = gc.get_threshold(), builtin.get_call_type
            gc.set_threshold(*SELDOM)
            builtin.get_call_type = resolve_once
            try:
                return super().compile_extra(law)
            finally:
                gc.set_threshold(*chosen)
                builtin.get_call_type = resolves

        def define_pipelines(self) -> list[Any]:
            pipeline = core.compiler.DefaultPassBuilder.define_nopython_pipeline(self.state)
            pipeline.passes = [
                (LawLowering if each is lowering else each, about)
                for each, about in pipeline.passes
                if each.__name__ not in NEEDLESS
            ]
            pipeline.finalize()
            return [pipeline]

    return LawCompiler


@cache
def _record_setter() -> Law:
    """`set_row` as compiled laws know it: field by field."""
    from numba.extending import overload

    def set_record(rows, i, row):  # type: ignore[no-untyped-def]
        raise NotImplementedError

    @overload(set_record, jit_options=_linked_options())
    def for_types(rows, i, row):  # type: ignore[no-untyped-def]
        names: dict[str, Any] = {}
        fields = "\n".join(f"    rows[i].{name} = row.{name}" for name in rows.dtype.fields)
        exec(f"def by_field(rows, i, row):\n{fields}", names)
        return names["by_field"]

    return set_record


def clone(law: Law) -> Law:
    """The function, with what it calls compiled, and arrays of its tables."""
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


def kept(compiler: Callable[..., Any], law: Law, folder: Path | None, **options: Any) -> Any:
    """A law compiled, and kept in a folder if there is one."""
    import numba

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
    """A named tuple as compiled laws take it: its sequences as arrays."""
    named: Any = type(value)
    return named(*[pack(part) for pack, part in zip(_packers(named), value, strict=True)])


@cache
def _packers(named: Any) -> tuple[Callable[[Any], Any], ...]:
    """Return what packs each field of a named tuple."""
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
    """The numpy type of a named tuple of numbers."""
    return np.dtype(
        [
            (name, np.int64 if kind is int else np.float64)
            for name, kind in get_type_hints(named).items()
        ]
    )


@cache
def cache_folder() -> Path | None:
    """Return where compiled code is kept; None where no such folder can be written.

    `NUMBA_CACHE_DIR`, or else CALM's folder in the user's cache. What is compiled from other
    sources has another folder, as numba itself looks at one file alone.
    """
    given = os.environ.get("NUMBA_CACHE_DIR")
    folder = (Path(given) if given else _user_cache() / "calm") / f"solver-{fingerprint()}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError:
        return None


def is_kept() -> bool:
    """Return whether compiled laws are there already, from an earlier process."""
    folder = cache_folder()
    return folder is not None and next(folder.rglob("*.nbi"), None) is not None


def _user_cache() -> Path:
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")


def fingerprint() -> str:
    """Of the sources of everything that may be compiled: the laws, and the search."""
    digest = hashlib.sha256()
    package = Path(__file__).parents[1]
    for folder in SOURCES:
        for source in sorted((package / folder).glob("*.py")):
            digest.update(source.read_bytes())
    return digest.hexdigest()[:16]
