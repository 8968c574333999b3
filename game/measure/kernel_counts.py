"""`python -m game.measure.kernel_counts`: count the kernels that are compiled for each effect and choice of effects.

Kernels run as plain Python and record the types of their arguments; nothing is compiled.

Standard input is one line of JSON:
  {"effects": names, "broadphase": name, "pieces": shape pairs and queries as in physics.warmup,
  "choices": {name of the choice: names of effects}}

Standard output is lines of JSON: first one line for each choice, [name, number of kernels that a world with these
effects calls]. Then one line for each effect, [name, number of kernels that are called only with this effect]. Without
a compiler (numba) there is no output.
"""

import json
import sys
from collections.abc import Iterable, Mapping
from functools import cache

import physics
from game.measure.effect_costs import sides_of
from physics import Effects
from physics.jit import tiers
from physics.warmup import run_warmup


def called(effects: Effects, broadphase: str, pieces: tuple[str, ...] | None) -> frozenset:
    """Return the set of (kernel, argument types) of all kernel calls that a world can make.

    effects: effects of the world; broadphase: name of its broad phase; pieces: shape pairs and queries that the world
    uses, as in physics.warmup; None for all.
    """
    with tiers.collecting(all_calls=True) as found:
        run_warmup(effects, broadphase, pieces=pieces)
    return frozenset(found)


def counts(
    effects: Effects, broadphase: str, pieces: Iterable[str] | None, choices: Mapping[str, Iterable[str]]
) -> Iterable[tuple[str, int]]:
    """Yield (name, number of kernels) for every choice of effects, then for every effect.

    The number for an effect includes only the kernels that are compiled because of it. effects: effects of the world;
    broadphase: name of its broad phase; pieces: shape pairs and queries that the world uses, as in physics.warmup, None
    for all. choices: {name of the choice: names of effects}.
    """
    wanted = None if pieces is None else tuple(pieces)
    known = cache(lambda each: called(each, broadphase, wanted))
    for name, chosen in choices.items():
        yield name, len(known(Effects.named(chosen)))
    for name, (one, other) in sides_of(effects).items():
        yield name, len(known(one.effects) - known(other.effects))


def main() -> None:
    """Read one request, print the kernel counts for its world, and exit."""
    order = json.loads(sys.stdin.readline())
    if physics.JIT:
        for found in counts(Effects.named(order["effects"]), order["broadphase"], order["pieces"], order["choices"]):
            print(json.dumps(found), flush=True)


if __name__ == "__main__":
    main()
