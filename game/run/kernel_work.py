"""Kernels as work that several processes share: which there are, which are kept, and who compiles one.

Who is at a kernel holds a lock on a file beside it, which the system lets go when its process ends, however it ends.
"""

import contextlib
import inspect
import os
import time
from collections.abc import Callable
from typing import Any

from physics.jit import claims

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

POLL = 0.02  # [s]


class Version:
    """A kernel and the types that it is called with."""

    def __init__(self, kernel: Any, types: tuple) -> None:
        self.kernel, self.types = kernel, types
        self.path = kernel._cache.path_of(types, kernel.targetctx)

    @property
    def kept(self) -> bool:
        """True where it lies in the cache, compiled."""
        return os.path.exists(self.path)

    def compile(self) -> bool:
        """Compile it with all that it calls; False: another process is at it."""
        let_go = try_claim(self.path)
        if let_go is None:
            return False
        claims.claimed[self.path] = let_go
        try:
            self.kernel.compile(self.types)
        finally:
            for let_go in claims.claimed.values():
                let_go()
            claims.claimed.clear()
        return True


def listing(run: Callable[[], object]) -> list[Version]:
    """The versions that run() calls, in the order to compile them. Only where jit.LISTING is set: nothing is compiled.

    The one that adds the most comes first: processes that share the work are then at different parts of the physics,
    and whoever needs what another is at seldom waits. Measured with the platformer on two cores: of the processes'
    time 14 % was waiting when the longest code came first, 1 % so.
    """
    from physics.jit.dispatchers import listed

    listed.clear()
    run()
    left = {Version(kernel, types): parts_of(kernel) for kernel, types in listed}
    order: list[Version] = []
    covered: set[Any] = set()
    while left:
        first = max(left, key=lambda each: sum(size for part, size in left[each].items() if part not in covered))
        covered.update(left.pop(first))
        order.append(first)
    return order


def parts_of(kernel: Any) -> dict[Any, int]:
    """A kernel and all that it calls, whatever the depth, each with the length of its code."""
    found: dict[Any, int] = {}
    todo = [kernel]
    while todo:
        each = todo.pop()
        if each not in found:
            found[each] = len(each.py_func.__code__.co_code)
            names = inspect.getclosurevars(each.py_func)
            todo += [
                value
                for value in (*names.globals.values(), *names.nonlocals.values())
                if isinstance(value, type(kernel))
            ]
    return found


def claim(path: str) -> Callable[[], object]:
    """Wait for the right to make the file at `path`; returns what lets it go."""
    while (let_go := try_claim(path)) is None:
        time.sleep(POLL)
    return let_go


def try_claim(path: str) -> Callable[[], object] | None:
    """As claim(), None where another process has it.

    Where a folder cannot be written, or its system knows no such locks, everybody has it: at worst work is done twice.
    """
    if fcntl is None:
        return lambda: None
    beside = f"{path}.claim"
    try:
        file = open(beside, "ab")
    except OSError:
        return lambda: None
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.close()
        return None
    except OSError:
        return file.close

    def let_go():
        with contextlib.suppress(OSError):
            os.unlink(beside)
        file.close()

    return let_go
