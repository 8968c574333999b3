"""Worker process `python -m physics.compile_worker`: compiles kernels for another process.

Each line on standard input is an order, and each line on standard output is the answer to one order. The orders are:
- ("compile", spec, keys): compile one kernel and store it (physics/jit/store.py). The answer is the name of the
  kernel's file in the store.
- ("list", arguments of physics.warmup): run this warm-up as plain Python. The answer is a list of (name, spec, keys)
  for the kernels that the warm-up calls and that are not in the store.

The answer to an order that fails is None. The process ends when its standard input ends.
"""

import contextlib
import os
import queue
import sys
import threading
import traceback
from typing import Any

NICE = 10  # niceness from 0 to 19: the program has priority over this process


def answer(order: tuple) -> Any:
    """Execute one order, and return the answer, as described in the docstring of this module.

    order: ("compile", spec, keys), see tiers.spec_of and kernels.key_of; or ("list", arguments of physics.warmup).
    """
    from physics.effects import Effects
    from physics.jit import compiling, tiers
    from physics.warmup import run_warmup

    if order[0] == "compile":
        kernel = tiers.kernel_of(order[1])
        compiling.load_or_compile(kernel, order[2])
        return compiling.name_of(kernel, order[2])
    with tiers.collecting() as found:
        run_warmup(**{**order[1], "effects": Effects.named(order[1]["effects"])})
    return [(compiling.name_of(kernel, keys), tiers.spec_of(kernel), keys) for kernel, keys in found]


def main() -> None:
    """Read orders from standard input, and write their answers to standard output, until the input ends.

    When the input ends, the process exits immediately, even while it executes an order.
    """
    from physics.jit.workers import decoded, encoded

    with contextlib.suppress(OSError, AttributeError):
        os.nice(NICE)
    answers, orders = sys.stdout, queue.SimpleQueue()
    sys.stdout = sys.stderr  # nothing else gets between the answers

    def listen():
        for line in sys.stdin:
            orders.put(line)
        os._exit(0)

    threading.Thread(target=listen, daemon=True).start()
    while True:
        order = decoded(orders.get())
        try:
            found = answer(order)
        except Exception:  # the answer is None: the program runs this kernel plain, and the next order may succeed
            traceback.print_exc()
            found = None
        answers.write(encoded(found) + "\n")
        answers.flush()


if __name__ == "__main__":
    main()
