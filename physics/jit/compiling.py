"""Compilation of kernels and of their parts: a compiled form is loaded from the store, or compiled and stored.

A part is a kernel that only kernels call. This module imports numba.
"""

import hashlib
import importlib
import pickle
import secrets
import zlib
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from time import perf_counter
from typing import Any

import llvmlite.binding as llvm
from numba.core import bytecode, caching, codegen, typed_passes, types
from numba.core.compiler import CompilerBase, DefaultPassBuilder, compile_result
from numba.core.compiler_lock import global_compiler_lock
from numba.core.compiler_machinery import register_pass
from numba.core.environment import Environment, lookup_environment
from numba.core.registry import cpu_target

from physics.jit import kernels
from physics.jit.content import NotHashable, content_of_library, fingerprint
from physics.jit.kernels import Form, Kernel, Keys, text_of, type_of
from physics.jit.plain import Builtin, compiler, rebound
from physics.jit.store import store

# ---- parts -----------------------------------------------------------------------------------------------------------
# Parts are kernels that only kernels call. A part is stored as LLVM bitcode, and no machine code is made of it alone.
#
# A caller links the code of its parts, and of all that they call, into its own code and optimises the whole. Numba
# would also optimise and generate machine code for every part, which is never run. Without that the kernels of the
# platformer compile in 81 s of processor time instead of 141 s (one run).
#
# Numba's interfaces for this: a pipeline of the dispatcher (numba.core.compiler.CompilerBase) whose last pass lowers
# into another library (numba.core.codegen.CodeLibrary).


class PartLibrary(codegen.JITCodeLibrary):
    """The LLVM code of a part (a kernel that only kernels call), which is linked into the code of the part's callers.

    Calls in this code are resolved, but the code is neither optimised nor executable.
    """

    def _optimize_final_module(self):
        pass

    def _finalize_final_module(self):
        self._finalize_dynamic_globals()
        self._finalized = True

    def bitcode(self) -> bytes:
        """Return the code as LLVM bitcode, for the store."""
        return self._get_module_for_linking().as_bitcode()

    @classmethod
    def from_bitcode(cls, generator: Any, name: str, code: bytes) -> "PartLibrary":
        """Return a PartLibrary made from stored bitcode. generator: a numba CPUCodegen; name: name of the library."""
        library = cls(generator, name)
        library._final_module = library._shared_module = llvm.parse_bitcode(code)
        library._finalized = True
        return library


@register_pass(mutates_CFG=True, analysis_only=False)
class PartLowering(typed_passes.NativeLowering):
    """Numba's lowering pass for parts. Its output is a PartLibrary."""

    _name = "part_lowering"

    def run_pass(self, state: Any) -> bool:
        """Lower the function to LLVM code as numba does, but generate no machine code. Return True.

        state: numba's compiler state. The entry point of the result is a placeholder without an address, see entry_of.
        """
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
    """Numba's compiler pipeline with PartLowering in place of the native lowering pass."""

    def define_pipelines(self) -> list:
        """Return [pipeline]: numba's nopython pipeline with PartLowering in place of NativeLowering."""
        manager = DefaultPassBuilder.define_nopython_pipeline(self.state)
        manager.add_pass_after(PartLowering, typed_passes.NativeLowering)
        manager.passes = [each for each in manager.passes if each[0] is not typed_passes.NativeLowering]
        manager.finalize()
        return [manager]


def entry_of(descriptor: Any, environment: Any, library: PartLibrary) -> Any:
    """Return a placeholder function object by which numba identifies a compiled part. It is never called.

    descriptor, environment: numba's function descriptor and environment of the part; library: the part's code.
    """
    name = descriptor.qualname.split(".")[-1]
    return _dynfunc.make_function(descriptor.lookup_module(), name, "", 0, environment, (library,))


def reduce(result: Any) -> tuple:
    """Convert a part's CompileResult to a tuple that can be pickled, for the store. The inverse is rebuild.

    result: numba's CompileResult of the part.
    """
    descriptor = result.fndesc
    descriptor.typemap = descriptor.calltypes = None  # these cannot always be pickled
    return result.library.name, result.library.bitcode(), descriptor, result.environment, result.signature


def rebuild(target_context: Any, kept: tuple) -> Any:
    """Convert `kept`, a result of reduce, back to a part's CompileResult. target_context: numba's target context."""
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


# ---- compiling -------------------------------------------------------------------------------------------------------
# Compiled forms of kernels: loaded from the store, or compiled and stored.
#
# A kernel of a stage is stored as machine code, and linked into numba's engine when it is loaded, without types and
# without numba's tables: 1 to 3 ms, against 9 to 53 ms with numba's cache. A part is stored as bitcode. The files and
# their symbols are named by content (content.py): numba's own symbols contain a counter of the process, with which
# parts of two processes could be linked to the wrong code.

# Two of numba's modules in C, which declare no types.
_dynfunc, _nrt_python = map(importlib.import_module, ("numba._dynfunc", "numba.core.runtime._nrt_python"))
# No kernel allocates an array, so reference counts are not needed; and only kernels of stages need an entry from
# Python. The kernels of the platformer compile in 145 s of processor time instead of 190 s (one busy machine).
LEANER = {"_nrt": False, "no_cfunc_wrapper": True}
READABLE = 48  # characters of a kernel's name in the name of its file


def file_name(kernel: Kernel, types_text: str) -> str:
    """Return the file name of a kernel's compiled form in the store: readable name, fingerprint, hash of the types.

    types_text: the types of the kernel's arguments, as text.
    """
    readable = f"{kernel.__module__.partition('.')[2]}.{kernel.__name__}"[-READABLE:]
    return f"{readable}.{fingerprint(kernel)}.{hashlib.blake2b(types_text.encode(), digest_size=8).hexdigest()}"


def name_of(kernel: Kernel, keys: Keys) -> str:
    """Return the file name in the store of a kernel's compiled form for arguments of the types `keys`."""
    return file_name(kernel, ",".join(map(text_of, keys)))


def load(kernel: Kernel, keys: Keys) -> Form | None:
    """Load the compiled form of a kernel from the store, and return it; return None if it is not stored.

    keys: types of the kernel's arguments.
    """
    content = store().read(name_of(kernel, keys))
    if content is None:
        return None
    started = perf_counter()
    form = _link(pickle.loads(zlib.decompress(content)))
    kernels.loaded += 1
    kernels.loading += perf_counter() - started
    return form


def load_or_compile(kernel: Kernel, keys: Keys) -> Form:
    """Return the compiled form of a kernel. Load it from the store; if it is not stored, compile and store it.

    keys: types of the kernel's arguments.
    """
    form = load(kernel, keys)
    if form is None:
        with store().claim(name_of(kernel, keys)):
            form = load(kernel, keys) or _compile(kernel, keys)
    return form


def _compile(kernel, keys):
    found = tuple(map(type_of, keys))
    with kernels.compiling(), global_compiler_lock, stable_symbols(), _claims():
        made = dispatcher_of(kernel)
        made.compile(found)
        result = made.overloads[found]
    store().write(name_of(kernel, keys), zlib.compress(pickle.dumps(_kept(result)), 1))
    return result.entry_point


def _kept(result):
    """Convert a kernel's CompileResult to a tuple for the store: names, constants of environments, machine code.

    result: numba's CompileResult of the kernel.
    """
    descriptor = result.fndesc
    constants = [
        (each.env_name, each.globals["__name__"], list(each.consts)) for each in result._find_referenced_environments()
    ]
    return (
        descriptor.modname,
        descriptor.qualname,
        descriptor.llvm_cpython_wrapper_name,
        descriptor.env_name,
        constants,
        result.library._get_compiled_object(),
    )


def prepare() -> None:
    """Initialise LLVM, so that the first load of a kernel does not have to wait for this."""
    with global_compiler_lock:
        _generator()
        _add_runtime_symbols()


def _generator() -> Any:
    """Return numba's code generator, a CPUCodegen."""
    context: Any = cpu_target.target_context
    return context.codegen()


def _link(kept):
    """Link stored machine code into numba's execution engine, and return it as a Python function.

    kept: a result of _kept.
    """
    modname, qualname, symbol, env_name, constants, code = kept
    with global_compiler_lock:
        generator = _generator()
        _add_runtime_symbols()
        engine = generator._engine
        engine._ee.add_object_file(llvm.ObjectFileRef.from_data(code))
        engine.finalize_object()
        address = engine.get_function_address(symbol)
        environments = {}
        for name, module, values in constants:
            environments[name] = _environment(name, module, values)
            generator.set_env(name, environments[name])
        if env_name not in environments:
            environments[env_name] = _environment(env_name, modname, [])
    name = qualname.rpartition(".")[2]
    module = importlib.import_module(modname)
    return _dynfunc.make_function(module, name, "", address, environments[env_name], tuple(environments.values()))


def _environment(name, module, values):
    """Return the numba Environment `name`, which contains data for compiled code. Create it if it does not exist.

    module: name of the module whose globals the code uses; values: constants of the code.
    """
    known = lookup_environment(name)
    if known is not None:
        return known
    made = Environment(importlib.import_module(module).__dict__)
    made.consts[:] = values
    made.env_name = name
    Environment._memo[name] = made
    return made


_runtime: list[bool] = []


def _add_runtime_symbols():
    """Register the addresses of numba's runtime functions with LLVM, as numba does at its first compilation."""
    if not _runtime:
        for name, address in _nrt_python.c_helpers.items():
            llvm.add_symbol(name if name.startswith("_") else f"NRT_{name}", address)
        _runtime.append(True)


_UNDER_WAY = object()


def dispatcher_of(kernel: Kernel) -> Any:
    """Return numba's dispatcher for a kernel. The dispatcher is made at the first call, and then cached.

    It compiles a copy of the kernel's function in which other kernels are replaced by their dispatchers. Raises
    TypeError for a kernel that calls itself.
    """
    if kernel.dispatcher is _UNDER_WAY:
        raise TypeError(f"{kernel.name} calls itself, which kernels do not")
    if kernel.dispatcher is None:
        kernel.dispatcher = _UNDER_WAY
        more = LEANER | ({"pipeline_class": PartCompiler} if kernel.is_part else {})
        twin = rebound(kernel.py_func, _compiled_form_of)
        twin.noalias = kernel.noalias
        twin.content = fingerprint(kernel)
        kernel.dispatcher = compiler().njit(
            twin,
            error_model="numpy",
            fastmath=False,
            no_cpython_wrapper=kernel.is_part,
            forceinline=kernel.is_inlined,
            **more,
        )
        _take_literals_as_values(kernel.dispatcher)
        if kernel.is_part:
            kernel.dispatcher._cache = PartCache(kernel)
    return kernel.dispatcher


def _compiled_form_of(value):
    if isinstance(value, Kernel):
        return dispatcher_of(value)
    return value.compiled if isinstance(value, Builtin) else value


def _take_literals_as_values(dispatcher):
    """Change a dispatcher, so that it compiles only one version for all calls with the same argument types.

    Numba would compile a version for each literal argument. With this change the kernels of the platformer compile in
    80 s of processor time instead of 136 s.
    """
    general = dispatcher.get_call_template

    def get_call_template(args, kws):
        return general(
            tuple(types.unliteral(each) for each in args), {name: types.unliteral(each) for name, each in kws.items()}
        )

    dispatcher.get_call_template = get_call_template


_claimed: dict[str, ExitStack] = {}  # file name -> release of the claim, for all parts that this process compiles


@contextmanager
def _claims():
    """Return a context manager that at its end releases all claims (locks) on parts, also after an error."""
    try:
        yield
    finally:
        for claim in _claimed.values():
            claim.close()
        _claimed.clear()


class PartCache(caching._Cache):
    """The store of compiled code as a cache in numba's interface, for the dispatcher of one part."""

    def __init__(self, kernel: Kernel) -> None:
        self.kernel = kernel

    @property
    def cache_path(self) -> str:
        """The path of the store's folder."""
        return str(store().folder)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Load the part from the store, and return its CompileResult; return None if it is not stored.

        If None is returned, the part is claimed (locked), so that other processes wait until this process has stored
        it. sig: numba's signature of the part; target_context: numba's target context.
        """
        name = self._name(sig)
        content = store().read(name)
        if content is None and name not in _claimed:
            _claimed[name] = ExitStack()  # only callees are claimed, so that processes do not wait in a circle
            _claimed[name].enter_context(store().claim(name))
            content = store().read(name)
        if content is None:
            return None
        if name in _claimed:
            _claimed.pop(name).close()
        target_context.refresh()
        kernels.parts_loaded += 1
        return rebuild(target_context, pickle.loads(zlib.decompress(content)))

    def save_overload(self, sig: Any, data: Any) -> None:
        """Store the compiled part, and release the claim (lock) on it.

        sig: numba's signature of the part; data: its CompileResult.
        """
        name = self._name(sig)
        store().write(name, zlib.compress(pickle.dumps(reduce(data)), 1))
        if name in _claimed:
            _claimed.pop(name).close()

    def _name(self, sig):
        return file_name(self.kernel, ",".join(map(_type_text, sig)))

    def enable(self) -> None:
        """Do nothing, because the store is always enabled."""

    def disable(self) -> None:
        """Do nothing, because the store is always enabled."""

    def flush(self) -> None:
        """Do nothing, because no stored file becomes stale: the name of a file contains a hash of its sources."""


def _type_text(found: Any) -> str:
    """Return a numba type as text. Different types have different texts."""
    any_tuple, named_tuple = _tuple_types()
    if isinstance(found, named_tuple):
        kind = found.instance_class
        return f"{kind.__module__}.{kind.__qualname__}{kind._fields}({','.join(map(_type_text, found))})"
    if isinstance(found, any_tuple):
        return f"({','.join(map(_type_text, found))})"
    return str(found)


def _tuple_types() -> Any:  # whose members numba does not declare
    return types.BaseTuple, types.BaseNamedTuple


@contextmanager
def stable_symbols() -> Iterator[None]:
    """Return a context manager in which numba names compiled functions by their content, not by a process counter."""
    identity: Any = bytecode.FunctionIdentity
    counted = identity.__dict__["from_function"]

    def from_function(cls, pyfunc):
        made = counted.__func__(cls, pyfunc)
        made.unique_id = _symbol(made.func)
        made.unique_name = f"{made.func_qualname}${made.unique_id}"
        return made

    identity.from_function = classmethod(from_function)
    try:
        yield
    finally:
        identity.from_function = counted


def _symbol(function):
    """Return a unique id for a function's symbol: the hash of its content, or random digits if it cannot be hashed."""
    content = getattr(function, "content", None)
    if content is not None:
        return content
    try:
        return content_of_library(function)
    except NotHashable:
        return secrets.token_hex(20)
