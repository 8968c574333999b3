"""`python -m game.measure.first_step`: measure the time of building a world and making its first step in a new process.

Standard input is one line of JSON, a list: file of a snapshot, name of the broad phase, names of the effects, names of
the idle effects (see Side). Standard output is the time in seconds.
"""

import json
import sys
from time import perf_counter

from game.measure.effect_costs import Side, world_under
from game.measure.moment import Moment
from physics import Effects, Snapshot


def main() -> None:
    """Measure one first step, print the seconds, and exit."""
    path, broadphase, effects, idle = json.loads(sys.stdin.readline())
    moment, side = Moment(Snapshot.load(path), broadphase), Side(Effects.named(effects), tuple(idle))
    started = perf_counter()
    world_under(moment, side).step()
    print(f"{perf_counter() - started:.6f}", flush=True)


if __name__ == "__main__":
    main()
