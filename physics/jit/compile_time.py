"""How much of what goes on is compiling: it belongs to no measurement."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def compiling() -> Iterator[Callable[[], float]]:
    """A function that tells the seconds that went into compiling since; 0 without numba. What it tells is whole once
    the context is left."""
    try:
        from numba.core import event
    except ImportError:
        yield lambda: 0.0
        return
    listener = event.TimingListener()
    with event.install_listener("numba:compiler_lock", listener):
        yield lambda: listener.duration if listener.done else 0.0
