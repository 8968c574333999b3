"""`python -m game.measure.kernel_counts`: how many kernels each effect has compiled for it, told as lines of JSON.

Kernels run plain and note the types they are called with; nothing is compiled.
One line on standard input: {"effects": names, "broadphase": name, "pieces": as physics.warmup takes them}. For each
effect [name, kernels called with it and not without it] on standard output; nothing where there is no compiler.
"""

import json
import sys
from collections.abc import Iterable
from functools import cache

import physics
from game.measure.effect_costs import sides_of
from physics import Effects
from physics.jit import tiers
from physics.warmup import run_warmup


def called(effects: Effects, broadphase: str, pieces: tuple[str, ...] | None) -> frozenset:
    """Return (kernel, types) of all that a world under effects may call."""
    with tiers.collecting(all_calls=True) as found:
        run_warmup(effects, broadphase, pieces=pieces)
    return frozenset(found)


def counts(effects: Effects, broadphase: str, pieces: Iterable[str] | None) -> Iterable[tuple[str, int]]:
    """(effect, number of kernels that are there for it alone) of every effect."""
    wanted = None if pieces is None else tuple(pieces)
    known = cache(lambda each: called(each, broadphase, wanted))
    for name, (one, other) in sides_of(effects).items():
        yield name, len(known(one.effects) - known(other.effects))


def main() -> None:
    """Count for one world, and end."""
    order = json.loads(sys.stdin.readline())
    if physics.JIT:
        for found in counts(Effects.named(order["effects"]), order["broadphase"], order["pieces"]):
            print(json.dumps(found), flush=True)


if __name__ == "__main__":
    main()
