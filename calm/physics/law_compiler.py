"""Compiler of the physics functions ("laws"): numba's compiler reduced to the necessary steps.

It is much faster than numba's own compiler. Only laws called from Python become machine code. All
other laws are linked into these and optimised there once; numba itself optimises and translates
every law again at each level of the calls. The types of an operation are resolved only once. Passes
for language features that laws do not use are omitted, variables that are assigned once need no
memory, and arrays are passed as fewer numbers.
"""

import copy
import gc
import hashlib
from collections import defaultdict
from typing import Any

import numba

_numba: Any = numba
core = _numba.core
_Array: Any = core.datamodel.models.ArrayModel
_Library: Any = core.codegen.JITCodeLibrary
_Lower: Any = core.lowering.Lower
_Lowering: Any = core.typed_passes.NativeLowering
_Compiler: Any = core.compiler.CompilerBase

UNUSED_PASSES = {
    "WithLift", "InlineClosureLikes", "RewriteSemanticConstants", "DeadBranchPrune",
    "RewriteDynamicRaises", "MakeFunctionToJitFunction", "InlineInlinables", "FindLiterallyCalls",
    "LiteralUnroll", "LiteralPropagationSubPipelinePass", "InlineOverloads", "NopythonRewrites",
    "NoPythonSupportedFeatureValidation", "IRLegalization", "DumpParforDiagnostics",
}  # fmt: skip
"""Compiler passes for closures, array expressions and other features that laws do not use."""

COUNT, SIZE, DATA, SHAPE, STRIDES = range(2, 7)
"""Indices into numba's representation of an array, after the members for memory management."""

GC_THRESHOLDS = 100_000, 20, 100
"""Thresholds of garbage collection during compilation, which are high because almost none of the
millions of objects can be freed.
"""

_seen: dict[Any, Any] = {}


def resolving_once(typing: Any) -> Any:
    """Return a typing context that remembers the signatures of operations.

    numba's own context tries all candidates every time. Only the compiler of laws uses this
    context.
    """
    remembering = copy.copy(typing)

    def resolve(operation: Any, given: Any, named: Any) -> Any:
        if named or not isinstance(operation, _numba.types.Function):
            return typing.resolve_function_type(operation, given, named)
        if (operation, given) not in _seen:
            _seen[operation, given] = typing.resolve_function_type(operation, given, named)
        return _seen[operation, given]

    remembering.resolve_function_type = resolve
    return remembering


def short_name(name: str, given: Any, **more: Any) -> str:
    """Return a short symbol for a law.

    numba's own symbols contain all argument types and are pages long.
    """
    digest = hashlib.sha256(repr(given).encode()).hexdigest()[:16]
    return str(core.funcdesc.default_mangler(f"{name}_{digest}", (), **more))


class LawArray(_Array):  # type: ignore[misc]
    """Array that is passed as its address and shape; its other properties follow from these.

    Functions that numba itself compiles for laws, such as `max`, take only numbers.
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


class LinkedLibrary(_Library):  # type: ignore[misc]
    """Library of a law that is linked into the laws called from Python."""

    def finalize(self) -> None:
        """Generate no machine code, because linked laws are compiled with their callers."""
        self._finalize_dynamic_globals()
        self._finalized = True


class LawLower(_Lower):  # type: ignore[misc]
    """Translation of a law to LLVM instructions."""

    def _find_singly_assigned_variable(self) -> None:
        """Treat a variable that is assigned once, before all its uses, as a value."""
        blocks = self.func_ir.blocks
        before = core.analysis.compute_cfg_from_blocks(blocks).dominators()
        assigned, used = defaultdict(list), defaultdict(set)
        for place, block in blocks.items():
            for statement in block.body:
                if isinstance(statement, core.ir.Assign):
                    assigned[statement.target.name].append(place)
                for variable in statement.list_vars():
                    used[variable.name].add(place)
        self._singly_assigned_vars = {
            name
            for name, [first, *others] in assigned.items()
            if not others and all(first in before[use] and first <= use for use in used[name])
        }
        self._blk_local_varmap: dict[str, Any] = {}


@core.compiler_machinery.register_pass(mutates_CFG=True, analysis_only=False)
class LawLowering(_Lowering):  # type: ignore[misc]
    """Last compiler pass, which generates machine code only for laws that Python calls."""

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
        key = _numba._dynfunc.make_function(module, name, "", 0, lowered.env, (state.library,))
        target.insert_user_function(key, lowered.fndesc, [*libraries])
        state["cr"] = lowered._replace(cfunc=key)
        return True


_arrays = core.datamodel.manager.DataModelManager({_numba.types.Array: LawArray})
core.registry.cpu_target.target_context.refresh()
OWN_ATTRIBUTES: dict[str, Any] = {
    "data_model_manager": _arrays.chain(core.datamodel.default_manager),
    "mangler": short_name,
    "cached_internal_func": {},
    "refresh": lambda: None,
}
"""Attributes that replace those of numba's own context, which repeatedly searches for new
operations.
"""


class LawCompiler(_Compiler):  # type: ignore[misc]
    """Compiler class for laws."""

    def __init__(self, typing: Any, target: Any, *others: Any) -> None:
        super().__init__(resolving_once(typing), target.subtarget(**OWN_ATTRIBUTES), *others)

    def compile_extra(self, law: Any) -> Any:
        """Compile a law and its callees."""
        collected = gc.get_threshold()
        gc.set_threshold(*GC_THRESHOLDS)
        try:
            return super().compile_extra(law)
        finally:
            gc.set_threshold(*collected)

    def define_pipelines(self) -> list[Any]:
        """Return numba's passes, without those that laws do not need."""
        pipeline = core.compiler.DefaultPassBuilder.define_nopython_pipeline(self.state)
        pipeline.passes = [
            (LawLowering if each is _Lowering else each, about)
            for each, about in pipeline.passes
            if each.__name__ not in UNUSED_PASSES
        ]
        pipeline.finalize()
        return [pipeline]
