"""`python -m tests.bench.rewind [SCENE …] [--cpu]`: memory and time of ten seconds of rewind for each scene.

It prints the total memory of the stored data. The memory beyond 64 kB is also divided by the numbers of moving bodies
and frames. The times are those of the slowest and the mean seek. For each key frame one seek goes from the end to the
last step before the key frame, which takes the most steps, and one to the step before that. --cpu measures processor
seconds of this process instead of clock seconds, for a machine with other load; rewind itself then measures in the
same way.
"""

import argparse
from time import perf_counter, process_time
from unittest.mock import patch

from game.run.rewind import STEPS, Rewind
from game.run.session import Session
from game.run.sources import BotSource
from game.scene import set_loaded_aside
from scenes import SCENES
from tests.game.test_rewind import A_BODY, BESIDE, moving_bodies
from tests.lockstep import make_scene

EXTRA = 60  # steps more than are kept, so that the oldest are dropped
SLOWEST = 0.1  # [s] that a seek may take


def measured(name: str, clock) -> dict[str, float]:
    """Return the figures of one scene, {name: value}: memory, bodies, key frames and times.

    "kB" is the whole memory. "a body" is the memory beyond BESIDE bytes, in bytes per moving body and frame. The times
    of notes and seeks are in seconds. clock: function that returns seconds.
    """
    with patch("game.run.rewind.perf_counter", clock), patch("game.run.session.perf_counter", clock):
        session = Session(make_scene(name), BotSource())
        set_loaded_aside()  # as the game does when a scene begins
        rewind, bodies, noting = Rewind(session), 0, 0.0
        for _ in range(STEPS + EXTRA):
            session.step()
            started = clock()
            rewind.note()
            noting = max(noting, clock() - started)
            bodies += moving_bodies(session.scene)
        held, bodies = rewind.bytes, bodies * STEPS / (STEPS + EXTRA)
        ends = [each.start for each in rewind.stretches[1:]] + [rewind.end]
        seeks = []
        for end in ends:
            for goal in (rewind.end, end, max(end - 1, rewind.start)):
                started = clock()
                rewind.seek(goal)
                seeks.append(clock() - started)
    return {
        "kB": held / 1000,
        "a body": max(0.0, held - BESIDE) / bodies if bodies else 0.0,
        "bodies": bodies / STEPS,
        "key frames": len(rewind.stretches),
        "note": noting,
        "slowest": max(seeks),
        "mean": sum(seeks) / len(seeks),
        "misses": sum(each > SLOWEST for each in seeks),
        "of": len(seeks),
    }


def main() -> None:
    """Measure the scenes of the command line, and print a line for each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", default=list(SCENES), metavar="SCENE")
    parser.add_argument("--cpu", action="store_true")
    options = parser.parse_args()
    print(f"{'scene':<18} moving      kB  B/body/frame  keys  note ms  seek ms  mean ms  over {1e3 * SLOWEST:.0f} ms")
    for name in options.scenes:
        found = measured(name, process_time if options.cpu else perf_counter)
        print(
            f"{name:<18} {found['bodies']:6.0f} {found['kB']:7.0f}  {found['a body']:12.0f}  {found['key frames']:4.0f}"
            f"  {1e3 * found['note']:7.1f}  {1e3 * found['slowest']:7.1f}  {1e3 * found['mean']:7.1f}"
            f"  {found['misses']:3.0f} of {found['of']:.0f}"
            + ("  MISSES THE BYTES" if found["a body"] > A_BODY else ""),
            flush=True,
        )


if __name__ == "__main__":
    main()
