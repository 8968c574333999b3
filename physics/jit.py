"""The only place that imports numba: compiles kernels, or runs them as they are.

A kernel is a plain function over tables and scalars. With numba it is compiled on first call and cached on disk.
Without numba the same source runs: structured arrays are handed over as row views, arrays as memoryviews, which
return Python numbers and are several times faster to index than NumPy arrays.

Two decorators: `kernel` for functions that a stage calls with arrays, `subkernel` for functions that only kernels
call. Both compile alike; only the first converts its arguments when nothing is compiled.
"""

import ast
import hashlib
import os
import pickle
import shutil
import sys
import tempfile
import warnings
from collections.abc import Callable
from functools import cache, wraps
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
WORD_MASK = 0xFFFFFFFFFFFFFFFF
CHECKSUM = 16  # bytes

try:
    if os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0"):
        raise ImportError("NUMBA_DISABLE_JIT is set")
    # Vector maths from SVML rounds differently from libm; compiled and plain runs must agree to the bit.
    os.environ.setdefault("NUMBA_DISABLE_INTEL_SVML", "1")
    import numba as compiler
    from numba.core import caching
    from numba.extending import intrinsic

    numba: Any = compiler  # Any: it declares no type for half of what is used here
    JIT = True
except ImportError:
    numba = None
    JIT = False

LISTING = JIT and os.environ.get("HITBOX_LISTING", "") == "1"  # this process only compiles: kernels are noted, not run

# claim(path): wait for the right to compile what goes there; returns what lets it go. Set where processes share work.
claim: Callable[[str], Callable[[], object]] | None = None
claimed: dict[str, Callable[[], object]] = {}  # path -> what lets it go, of all that is being compiled here
registry = []  # every compiled kernel, in the order of definition: warm-up and tests read it


# --- where compiled kernels are kept -----------------------------------------------------------------------------


def cache_home() -> Path:
    """The user's cache folder by the platform's rule, without creating it."""
    override = os.environ.get("HITBOX_CACHE_DIR")
    if override:
        return Path(override)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local")) / "hitbox" / "kernels"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "hitbox" / "kernels"
    return Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "hitbox" / "kernels"


@cache
def _imports_of(path: Path) -> tuple[Path, ...]:
    """Files of this package that the file at `path` imports, from its import statements."""
    found = []
    for node in ast.walk(ast.parse(path.read_bytes())):
        if isinstance(node, ast.ImportFrom) and node.level == 0 and str(node.module).split(".")[0] == HERE.name:
            module = HERE.parent.joinpath(*str(node.module).split("."))
            names = [module] + [module / alias.name for alias in node.names]
            found += [name.with_suffix(".py") for name in names if name.with_suffix(".py").is_file()]
    return tuple(sorted(set(found)))


def source_stamp(path: Path) -> str:
    """Hash of a kernel module and of everything it imports from this package, whatever the depth."""
    todo, seen = [Path(path).resolve()], set()
    while todo:
        at = todo.pop()
        if at not in seen:
            seen.add(at)
            todo += _imports_of(at)
    digest = hashlib.sha1()
    for each in sorted(seen):
        digest.update(each.name.encode() + each.read_bytes())
    versions = f"{sys.version_info[:3]} {np.__version__} {numba.__version__ if JIT else ''}"
    bounds = os.environ.get("NUMBA_BOUNDSCHECK", "0")
    digest.update(f"{versions} bounds={bounds} {numba.config.CPU_NAME if JIT else ''}".encode())
    return digest.hexdigest()[:16]


@cache
def _writable_home() -> Path | None:
    for home in (
        cache_home(),
        Path(tempfile.gettempdir()) / f"hitbox-kernels-{os.getuid() if hasattr(os, 'getuid') else 0}",
    ):
        try:
            home.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=home):
                return home
        except OSError:
            continue
    warnings.warn("no folder can be written for compiled kernels: they are compiled anew at every start", stacklevel=2)
    return None


@cache
def _folder_for(path: Path) -> str:
    """The cache folder of one kernel module; folders of older sources of the same module are purged."""
    home = _writable_home()
    if home is None:
        return ""
    path = path.resolve()
    name = (
        ".".join(path.relative_to(HERE).with_suffix("").parts) if path.is_relative_to(HERE) else f"outside.{path.stem}"
    )
    stamp = source_stamp(path)
    old = sorted(
        (each for each in home.glob(f"{name}-*") if each.name != f"{name}-{stamp}"),
        key=lambda each: each.stat().st_mtime if each.exists() else 0.0,
    )
    for each in old[:-3]:  # a few stay: a bounds-checked run and another checkout are not enemies
        shutil.rmtree(each, ignore_errors=True)
    folder = home / f"{name}-{stamp}"
    try:
        folder.mkdir(exist_ok=True)
    except OSError:
        return ""
    return str(folder)


def _checksum(content: bytes) -> bytes:
    return hashlib.blake2b(content, digest_size=CHECKSUM).digest()


if JIT:

    class _ByContent(caching._CacheLocator):
        """A folder whose name holds all that the kernel depends on: neither dates of files nor their path count."""

        def __init__(self, function, path):
            self._py_file = path  # numba names it in its warnings
            self.line = function.__code__.co_firstlineno

        @classmethod
        def from_function(cls, function, path):
            return cls(function, path)

        def get_cache_path(self):
            return _folder_for(Path(self._py_file))

        def get_source_stamp(self):
            return 0

        def get_disambiguator(self):
            return str(self.line)

    class _Results(caching.CompileResultCacheImpl):
        _locator_classes = [_ByContent]

    class _Files(caching.IndexDataCacheFile):
        """One file per compiled version, named by what it was compiled for, its checksum in front.

        Numba's own index file loses entries, or mixes them up, where several processes compile side by side; and
        machine code with a wrong byte in it ends the process.
        """

        def save(self, key, data):
            content = self._dump((key, data))
            with self._open_for_write(self.path_of(key)) as file:
                file.write(_checksum(content) + content)

        def load(self, key):
            path = Path(self.path_of(key))
            if not path.exists():
                return None
            content = path.read_bytes()
            if _checksum(content[CHECKSUM:]) != content[:CHECKSUM]:
                raise ValueError(f"{path.name} does not hold what was written")
            kept, data = pickle.loads(content[CHECKSUM:])
            return data if kept == key else None

        def path_of(self, key):
            """The file of one version; key as numba makes it: types, processor, code."""
            name = hashlib.sha256(str(key).encode()).hexdigest()[:24]
            return self._data_path(f"{self._index_name.removesuffix('.nbi')}.{name}.nbc")

    class _SafeCache(caching.FunctionCache):
        """A disk cache that treats a damaged or unwritable entry as a miss, and says so."""

        _impl_class = _Results

        def __init__(self, function):
            super().__init__(function)
            self._cache_file = _Files(self._cache_path, self._impl.filename_base, 0)

        def load_overload(self, sig, target_context):
            found = self._load(sig, target_context)
            if found is None and claim is not None:
                path = self.path_of(sig, target_context)
                claimed[path] = claim(path)  # of what is called, never of what calls: nobody waits in a ring
                found = self._load(sig, target_context)
                if found is not None:
                    claimed.pop(path)()
            return found

        def path_of(self, sig, target_context):
            """Where a version is kept, or will be."""
            return self._cache_file.path_of(self._index_key(sig, target_context.codegen()))

        def _load(self, sig, target_context):
            try:
                return super().load_overload(sig, target_context)
            except Exception as error:  # a file of another length, other bytes, or that may not be read
                warnings.warn(
                    f"compiled kernel {self._name} in {self._cache_path} is damaged ({error!r}): recompiled",
                    stacklevel=2,
                )
                return None  # what is compiled now is written over it

        def save_overload(self, sig, data):
            try:
                super().save_overload(sig, data)
            except OSError as error:
                warnings.warn(f"compiled kernel {self._name} could not be kept ({error})", stacklevel=2)
            claimed.pop(self.path_of(sig, data.target_context), lambda: None)()

    listed = {}  # (kernel, types of its arguments) -> None, in the order of the calls
    nesting = [0]  # calls under way

    class _Listed(numba.core.dispatcher.Dispatcher):
        """A kernel that is run as it is, and notes with which types it is called; it compiles only when told to."""

        plain = None  # what stands for it where it is not its own source

        def __call__(self, *arguments):
            nesting[0] += 1
            try:
                if nesting[0] == 1:  # called by a stage, not by another kernel
                    listed[self, tuple(self.typeof_pyval(each) for each in arguments)] = None
                    arguments = [_view(each) for each in arguments]
                return (self.plain or self.py_func)(*arguments)
            finally:
                nesting[0] -= 1

    class _Inner(numba.core.dispatcher.Dispatcher):
        """A kernel that kernels call: it has no way in from Python, where it is run as it is, with the same result."""

        def __call__(self, *arguments):
            return self.py_func(*[_view(each) for each in arguments])

    class _ListedIntrinsic(numba.core.extending._Intrinsic):
        __call__ = staticmethod(int.bit_count)

    def _count_bits(typing_context, word):
        """Number of set bits of a uint64."""

        def generate(context, builder, signature, args):
            return (
                builder.zext(builder.ctpop(args[0]), context.get_value_type(signature.return_type))
                if signature.args[0].bitwidth < 64
                else builder.ctpop(args[0])
            )

        return numba.types.int64(numba.types.uint64), generate

    def _as_word(value):
        """The value as an unsigned 64-bit word."""
        return np.uint64(value)

    popcount: Any = intrinsic(_count_bits)  # Any: called with one argument, and declared with the context's too
    word: Any = numba.njit(inline="always")(_as_word)
    if LISTING:
        popcount.__class__, word.__class__ = _ListedIntrinsic, _Listed
        word.plain = lambda value: value & WORD_MASK
else:

    def _bits_of(word):
        return word.bit_count()

    def _masked(value):
        return value & WORD_MASK

    popcount, word = _bits_of, _masked


def _compile(function: Callable, from_python: bool) -> Callable:
    if not JIT:
        return function
    # No kernel makes an array, so none counts references; and only kernels that stages call need a way in from Python.
    # Measured: compiling what the platformer needs takes 145 s of processor time, with both 190, on one busy machine.
    leaner = {"_nrt": False, "no_cfunc_wrapper": True, "no_cpython_wrapper": not from_python}
    dispatcher = numba.njit(function, error_model="numpy", fastmath=False, **leaner)
    _take_literals_as_values(dispatcher)
    if _folder_for(Path(function.__code__.co_filename)):
        dispatcher._cache = _SafeCache(function)
    registry.append(dispatcher)
    if LISTING or not from_python:
        dispatcher.__class__ = _Listed if LISTING else _Inner
    return dispatcher


def _take_literals_as_values(dispatcher):
    """Compile one version for all calls of the same types: numba makes another for every literal among the arguments.

    Measured: compiling what the platformer needs takes 136 s of processor time with them, 80 s without.
    """
    general = dispatcher.get_call_template

    def get_call_template(args, kws):
        return general(
            tuple(numba.types.unliteral(each) for each in args),
            {name: numba.types.unliteral(each) for name, each in kws.items()},
        )

    dispatcher.get_call_template = get_call_template


def subkernel(function: Callable) -> Callable:
    """A function that kernels call: compiled, or left as it is."""
    return _compile(function, from_python=False)


def kernel(function: Callable) -> Callable:
    """A function that a stage calls with tables, arrays and scalars: compiled, or given views of its arguments."""
    if JIT:
        return _compile(function, from_python=True)

    @wraps(function)
    def run(*arguments):
        return function(*[_view(each) for each in arguments])

    return run


# --- tables without numba ----------------------------------------------------------------------------------------


def _buffer(array: Any) -> memoryview:
    """Any, as arrays are typed as buffers only from Python 3.12 on."""
    return memoryview(array)


class TableView:
    """A structured array as a sequence of row objects; `view[i].x = 1.0` writes the array."""

    __slots__ = ("make", "columns", "length")

    def __init__(self, array: np.ndarray) -> None:
        self.make = _row_class(array.dtype)
        self.columns = tuple(_buffer(array[name]) for name in array.dtype.names or ())
        self.length = len(array)

    def __getitem__(self, index):
        if not 0 <= index < self.length:
            raise IndexError(f"row {index} of a table of {self.length}")
        return self.make(self.columns, index)

    def __len__(self):
        return self.length


@cache
def _row_class(dtype):
    members: dict[str, Any] = {"__slots__": ("_columns", "_index")}

    def __init__(self, columns, index):
        self._columns = columns
        self._index = index

    members["__init__"] = __init__
    for number, name in enumerate(dtype.names):

        def read(self, number=number):
            return self._columns[number][self._index]

        def write(self, value, number=number):
            self._columns[number][self._index] = value

        members[name] = property(read, write)
    return type("Row", (), members)


def _view(argument):
    if type(argument) is np.ndarray:
        if argument.dtype.names:
            return TableView(argument)
        return _buffer(argument)
    if isinstance(argument, tuple):
        views = [_view(each) for each in argument]
        return type(argument)(*views) if hasattr(argument, "_fields") else tuple(views)
    if isinstance(argument, np.generic):
        return argument.item()
    return argument
