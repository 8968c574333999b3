"""Kernels that only kernels call are parts: kept as code for linking, never made into machine code by themselves.

Whatever calls one links its code, and all that it calls, into its own and optimizes the whole. Numba optimizes and
generates machine code for every part as well, which nobody runs. Measured without: the kernels of the platformer take
81 s of processor time to compile, with 141, in one run.

Numba's ways to do so: a pipeline of the dispatcher's own (numba.core.compiler.CompilerBase) whose last pass lowers into
a library of its own (numba.core.codegen.CodeLibrary). Imported only where there is a compiler.
"""

import importlib
from typing import Any

import llvmlite.binding as llvm
from numba.core import codegen, typed_passes
from numba.core.compiler import CompilerBase, DefaultPassBuilder, compile_result
from numba.core.compiler_machinery import register_pass

_dynfunc = importlib.import_module("numba._dynfunc")  # in C: it declares no types


class PartLibrary(codegen.JITCodeLibrary):
    """Code that is linked into others: the calls in it are resolved, but nothing is optimized or can be run."""

    def _optimize_final_module(self):
        pass

    def _finalize_final_module(self):
        self._finalize_dynamic_globals()
        self._finalized = True

    def bitcode(self) -> bytes:
        """What a cache keeps."""
        return self._get_module_for_linking().as_bitcode()

    @classmethod
    def from_bitcode(cls, generator: Any, name: str, code: bytes) -> "PartLibrary":
        """The library that was kept; generator: a numba CPUCodegen."""
        library = cls(generator, name)
        library._final_module = library._shared_module = llvm.parse_bitcode(code)
        library._finalized = True
        return library


@register_pass(mutates_CFG=True, analysis_only=False)
class PartLowering(typed_passes.NativeLowering):
    """Lowers a part into a library of its own kind."""

    _name = "part_lowering"

    def run_pass(self, state: Any) -> bool:
        """As numba's, which would go on to ask for the address of the machine code."""
        state.library = PartLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.flags.no_compile = True
        state.flags.noalias = getattr(state.func_id.func, "noalias", False)
        super().run_pass(state)
        state.library.finalize()
        lowered = state["cr"]
        entry = entry_of(lowered.fndesc, lowered.env, state.library)
        state.targetctx.insert_user_function(entry, lowered.fndesc, [state.library])
        state["cr"] = lowered._replace(cfunc=entry)
        return True


class PartCompiler(CompilerBase):
    """Numba's pipeline for compiled functions, but for its last pass."""

    def define_pipelines(self) -> list:
        """One pipeline."""
        manager = DefaultPassBuilder.define_nopython_pipeline(self.state)
        manager.add_pass_after(PartLowering, typed_passes.NativeLowering)
        manager.passes = [each for each in manager.passes if each[0] is not typed_passes.NativeLowering]
        manager.finalize()
        return [manager]


def entry_of(descriptor: Any, environment: Any, library: PartLibrary) -> Any:
    """What numba knows a compiled function by: a function of no address, as nobody calls it."""
    name = descriptor.qualname.split(".")[-1]
    return _dynfunc.make_function(descriptor.lookup_module(), name, "", 0, environment, (library,))


def reduce(result: Any) -> tuple:
    """What is kept of a CompileResult."""
    descriptor = result.fndesc
    descriptor.typemap = descriptor.calltypes = None  # may not be pickled
    return result.library.name, result.library.bitcode(), descriptor, result.environment, result.signature


def rebuild(target_context: Any, kept: tuple) -> Any:
    """A CompileResult of what reduce() kept."""
    name, code, descriptor, environment, signature = kept
    library = PartLibrary.from_bitcode(target_context.codegen(), name, code)
    return compile_result(
        target_context=target_context,
        typing_context=target_context.typing_context,
        library=library,
        environment=environment,
        entry_point=entry_of(descriptor, environment, library),
        fndesc=descriptor,
        signature=signature,
        objectmode=False,
        reload_init=(),
        referenced_envs=[],
    )
