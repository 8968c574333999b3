"""How a thread beside the program shares the interpreter with it."""

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from time import sleep, thread_time
from typing import Any

from physics.jit import tiers

SHARE = 0.2  # of a thread's time in which it imports what nobody waits for
TURN = 0.0005  # [s] after which a thread of this process lets others go on while kernels are looked for


@contextmanager
def short_turns() -> Iterator[None]:
    """While this lasts, the interpreter goes from thread to thread after TURN.

    The program lets go of it in every call of NumPy's, and would wait for 5 ms each time. Measured: while the compiler
    is imported, frames of the platformer take 80 ms with that, 55 ms with TURN.
    """
    before = sys.getswitchinterval()
    sys.setswitchinterval(TURN)
    try:
        yield
    finally:
        sys.setswitchinterval(before)


class _Pauses:
    """A finder of modules that finds none. Before each import in the thread that made it, it sleeps while kernels run
    plain."""

    def __init__(self):
        self.thread, self.since = threading.get_ident(), thread_time()

    def find_spec(self, name, path=None, target=None):
        if threading.get_ident() == self.thread and tiers.wanted:
            sleep((thread_time() - self.since) * (1.0 / SHARE - 1.0))
            self.since = thread_time()


@contextmanager
def unhurried_imports() -> Iterator[None]:
    """While this lasts, imports take SHARE of this thread's time, so that a game goes on that runs plain meanwhile.

    Measured: importing the compiler takes 0.7 s of processor time, and a game showed 20 pictures in that second.
    """
    pauses: Any = _Pauses()
    sys.meta_path.insert(0, pauses)
    try:
        yield
    finally:
        sys.meta_path.remove(pauses)
