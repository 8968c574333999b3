"""Fingerprints of kernels: hashes of all data on which the machine code of a kernel depends, equal in every process.

A fingerprint covers the code, with docstrings, of the kernel and of all functions that it calls or closes over, at any
depth; closed-over values and module globals that the kernel reads; its flags; the name of its module; and the sources
of this folder. It also covers the versions of Python, NumPy, numba and llvmlite, the processor and its features, bounds
checks and SVML. It does not cover comments in kernels and line numbers.
"""

import hashlib
import importlib.metadata
import os
import sys
import threading
from functools import cache
from pathlib import Path
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType

import numpy as np

from physics.jit.kernels import Kernel
from physics.jit.plain import Builtin, compiler, globals_of, names_in

DIGEST = 20  # bytes
OUTSIDE = ("math", "numpy")  # modules whose version identifies them


_describing = threading.RLock()


class NotHashable(TypeError):
    """An error for a value whose hash would differ between processes, such as an address."""


def fingerprint(kernel: Kernel) -> str:
    """Return the fingerprint of a kernel as hexadecimal digits: a hash of its content and of environment().

    This function imports numba.
    """
    return _digest(environment(), content_of(kernel))


def content_of(kernel: Kernel) -> str:
    """Return a hash of a kernel's code and of all values to which the code refers, as hexadecimal digits.

    Raises NotHashable if such a value cannot be hashed; the message contains the value.
    """
    with _describing:
        if kernel.content is None:
            kernel.content = "recursive"  # in a recursive function, the inner call is described by this word
            try:
                parts = [kernel.flags_text, *_describe_function(kernel.py_func)]
            except NotHashable as error:
                kernel.content = None
                raise NotHashable(f"{kernel.name}: {error}") from None
            kernel.content = _digest(*parts)
        return kernel.content


def _digest(*parts):
    digest = hashlib.blake2b(digest_size=DIGEST)
    for part in parts:
        content = part.encode()
        digest.update(len(content).to_bytes(8, "little") + content)
    return digest.hexdigest()


def content_of_library(function: FunctionType) -> str:
    """Return a hash of the code and the closure of a function of numba itself, as hexadecimal digits.

    The globals of the function's module are not hashed, because numba's version identifies them. Raises NotHashable for
    a function of another package.
    """
    return _digest(*_describe_library(function, ()))


def _describe_library(function, outer):
    if not function.__module__.startswith("numba.") or function in outer:
        raise NotHashable(f"{function.__module__}.{function.__qualname__} is not numba's, or closes over itself")
    yield f"{function.__module__}.{function.__qualname__}"
    yield from _describe_code(function.__code__)
    yield from _describe(function.__defaults__)
    for cell in function.__closure__ or ():
        value = cell.cell_contents
        if isinstance(value, FunctionType):
            yield from _describe_library(value, (*outer, function))
        else:
            yield from _describe(value)


def _describe_function(function):
    yield f"{function.__module__}.{function.__qualname__}"
    yield from _describe_code(function.__code__)
    yield from _describe(function.__defaults__)
    for name, value in sorted((function.__kwdefaults__ or {}).items()):
        yield name
        yield from _describe(value)
    for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
        yield f"closure {name}"
        yield from _describe(cell.cell_contents)
    for name, value in globals_of(function):
        yield f"global {name}"
        yield from _describe(value, names_in(function.__code__))


def _describe_code(code):
    yield f"code {code.co_name} {code.co_argcount} {code.co_kwonlyargcount} {code.co_flags}"
    yield code.co_code.hex()
    yield code.co_exceptiontable.hex() if hasattr(code, "co_exceptiontable") else ""
    for names in (code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars):
        yield " ".join(names)
    for each in code.co_consts:
        yield from _describe(each)


def _describe(value, names=()):
    """Yield texts that describe a value; only equal values have equal texts.

    names: if the value is a module, the names of its attributes to describe. Raises NotHashable for a value that cannot
    be part of a kernel.
    """
    kind = type(value)
    if value is None or kind in (bool, int, float, complex, str, bytes):
        yield f"{kind.__name__} {value!r}"
    elif isinstance(value, Kernel):
        yield f"kernel {content_of(value)}"
    elif isinstance(value, Builtin):
        for each in value.sources:
            yield f"builtin {each.__qualname__}"
            yield from _describe_code(each.__code__)
            for cell in each.__closure__ or ():
                yield from _describe(cell.cell_contents)
    elif isinstance(value, tuple):
        yield f"tuple {len(value)}"
        if kind is not tuple:
            yield from _describe(kind)
        for each in value:
            yield from _describe(each, names)
    elif isinstance(value, frozenset):
        yield f"frozenset {sorted(map(repr, value))}"
    elif isinstance(value, CodeType):
        yield from _describe_code(value)
    elif isinstance(value, np.dtype):
        yield f"dtype {value!r} {value.itemsize} {value.alignment}"
    elif isinstance(value, np.ndarray) and not value.dtype.hasobject:
        yield f"array {value.dtype!r} {value.shape} {hashlib.blake2b(value.tobytes()).hexdigest()}"
    elif isinstance(value, np.generic):
        yield f"scalar {value.dtype!r} {value.tobytes().hex()}"
    elif isinstance(value, type):
        yield f"type {value.__module__}.{value.__qualname__} {getattr(value, '_fields', '')}"
    elif isinstance(value, BuiltinFunctionType):
        yield f"builtin function {value.__module__}.{value.__qualname__}"
    elif isinstance(value, ModuleType):
        yield f"module {value.__name__}"
        yield from _describe_module(value, names)
    elif kind.__module__.startswith("numba.core.types"):
        yield _described_type(value)
    else:
        raise NotHashable(f"{kind.__module__}.{kind.__qualname__} cannot be part of a kernel ({value!r:.80})")


def _describe_module(module, names):
    if module.__name__.split(".")[0] in OUTSIDE:
        return
    for name in names:
        if hasattr(module, name):
            yield f"attribute {name}"
            yield from _describe(getattr(module, name))


def _described_type(value):
    text = f"numba {value}"
    if "0x" in text:
        raise NotHashable(f"{text} names an address")
    return text


@cache
def environment() -> str:
    """Return a text with all data on which machine code depends, except the kernel itself.

    The data are the sources of this folder, versions of packages, the processor and numba's settings. This function
    imports numba.
    """
    import llvmlite.binding as llvm

    numba = compiler()
    config = numba.core.config
    sources = hashlib.blake2b(digest_size=DIGEST)
    for path in sorted(Path(__file__).parent.glob("*.py")):
        sources.update(path.name.encode() + path.read_bytes())
    return "\n".join(
        f"{name}={value}"
        for name, value in {
            "sources": sources.hexdigest(),
            "python": (sys.implementation.cache_tag, sys.version_info[:3]),
            "numpy": np.__version__,
            "numba": numba.__version__,
            "llvmlite": importlib.metadata.version("llvmlite"),
            "processor": config.CPU_NAME or llvm.get_host_cpu_name(),
            "features": config.CPU_FEATURES or numba.core.codegen.get_host_cpu_features(),
            "bounds": config.BOUNDSCHECK,
            "svml": config.USING_SVML,
            "optimisation": config.OPT,
            "flags": sorted((k, v) for k, v in os.environ.items() if k.startswith("NUMBA_") and k not in IRRELEVANT),
        }.items()
    )


IRRELEVANT = ("NUMBA_CACHE_DIR", "NUMBA_NUM_THREADS", "NUMBA_DISABLE_INTEL_SVML", "NUMBA_BOUNDSCHECK")
