"""`python -m game.measure.first_step`: the time of building a world and of its first step in a new process.

Standard input takes one line of JSON: [file of a snapshot, name of the broad phase, choice of effects: a name of
game.measure.effect_totals.NAMES]. Standard output gets the seconds; nothing if the world cannot have these effects.
"""

import json
import sys
from time import perf_counter

from game.measure.effect_costs import world_under
from game.measure.effect_totals import choices_of
from game.measure.moment import Moment
from physics import Snapshot


def main() -> None:
    """Measure one first step, then exit."""
    path, broadphase, name = json.loads(sys.stdin.readline())
    moment = Moment(Snapshot.load(path), broadphase)
    side = choices_of(moment).get(name)
    if side is None:
        return
    started = perf_counter()
    world_under(moment, side).step()
    print(f"{perf_counter() - started:.6f}", flush=True)


if __name__ == "__main__":
    main()
