"""Compiled kernels on disk, as numba's cache asks for them; imported only where there is a compiler."""

import hashlib
import pickle
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

from numba.core import caching

from physics.jit import claims, parts
from physics.jit.folders import folder_for

CHECKSUM = 16  # bytes


def _checksum(content: bytes) -> bytes:
    return hashlib.blake2b(content, digest_size=CHECKSUM).digest()


class _ByContent(caching._CacheLocator):
    """A folder whose name holds all that the kernel depends on: neither dates of files nor their path count."""

    def __init__(self, function, path):
        self._py_file = path  # numba names it in its warnings
        self.line = function.__code__.co_firstlineno

    @classmethod
    def from_function(cls, function, path):
        return cls(function, path)

    def get_cache_path(self):
        return folder_for(Path(self._py_file))

    def get_source_stamp(self):
        return 0

    def get_disambiguator(self):
        return str(self.line)


class _Results(caching.CompileResultCacheImpl):
    """What is kept of a kernel that stages call: machine code, and its code for linking."""

    _locator_classes = [_ByContent]


class _PartResults(_Results):
    """What is kept of a kernel that only kernels call: its code for linking."""

    def reduce(self, result):
        return parts.reduce(result)

    def rebuild(self, target_context, payload):
        return parts.rebuild(target_context, payload)


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


class KernelCache(caching.FunctionCache):
    """A disk cache that treats a damaged or unwritable entry as a miss, and says so."""

    _impl_class = _Results

    def __init__(self, function: Callable) -> None:
        super().__init__(function)
        self._cache_file = _Files(self._cache_path, self._impl.filename_base, 0)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        found = self._load(sig, target_context)
        if found is None and claims.claim is not None:
            path = self.path_of(sig, target_context)
            if path not in claims.claimed:
                claims.claimed[path] = claims.claim(path)  # of what is called, never of what calls: no ring of waiting
            found = self._load(sig, target_context)
            if found is not None:
                claims.claimed.pop(path)()
        return found

    def path_of(self, sig: Any, target_context: Any) -> str:
        """Where a version is kept, or will be."""
        return self._cache_file.path_of(self._index_key(sig, target_context.codegen()))

    def _load(self, sig, target_context):
        try:
            return super().load_overload(sig, target_context)
        except Exception as error:  # a file of another length, other bytes, or that may not be read
            warnings.warn(
                f"compiled kernel {self._name} in {self._cache_path} is damaged ({error!r}): recompiled", stacklevel=2
            )
            return None  # what is compiled now is written over it

    def save_overload(self, sig: Any, data: Any) -> None:
        try:
            super().save_overload(sig, data)
        except OSError as error:
            warnings.warn(f"compiled kernel {self._name} could not be kept ({error})", stacklevel=2)
        claims.claimed.pop(self.path_of(sig, data.target_context), lambda: None)()


class PartCache(KernelCache):
    """The same for a kernel that only kernels call."""

    _impl_class = _PartResults
