"""`python -m game.run.run_worker`: the measuring process of a played scene, which also plays the scene's recorded run.

It accepts the orders of game.measure.worker, and two more that contain a recorded run. The order "prove" tests a
setting on the whole run. The order with a snapshot and a "run" first plays the run, and counts which bodies met in it
under every collision tier. Then it measures the settings from the snapshot as usual. If the run continues the run of
the previous order, only its new steps are played.
"""

import json
import pickle
from collections.abc import Callable
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

from game.measure.errors import Verdicts
from game.measure.setting import Setting
from game.measure.worker import main, measure, sent_verdicts
from game.run.headless import start_dummy_display
from game.run.proven_advice import apply_to_run
from game.run.recorded_run import Encounters, Player, RecordedRun

LOOK_EVERY = 12  # steps between two looks at the touching pairs


class Follower:
    """Player of a recorded run that becomes longer while it is played. It counts which bodies meet in the run.

    The encounters are counted for every collision tier (kind of collision shape).
    """

    def __init__(self) -> None:
        self.run: RecordedRun | None = None
        self.player: Player | None = None
        self.steps = 0  # played so far
        self.encounters = Encounters()

    def follow(self, run: RecordedRun, goes_on: Callable[[], bool]) -> dict[str, Verdicts]:
        """Play the new steps of `run` while goes_on() is True. Return {collision tier: Verdicts} of all encounters.

        After a restart or a rewind, the run does not continue the previous one. Then it is played from its start. The
        result is {} for a scene without collision tiers.
        """
        if self.run is None or self.player is None or not run.continues(self.run, self.steps):
            self.player, self.steps, self.encounters = Player(run), 0, Encounters()
        self.run, scene = run, self.player.scene
        for frame in islice(run.frames(), self.steps, None):
            if scene.tier is None or not goes_on():
                break
            self.player.step(frame)
            self.steps += 1
            if self.steps % LOOK_EVERY == 0:
                self.encounters.look(scene)
        return self.encounters.verdicts()


def measure_played(
    follower: Follower, order: dict[str, Any], report: Callable[[str], object], goes_on: Callable[[], bool]
) -> None:
    """Count the encounters in the recorded run of an order, then measure its snapshot as worker.measure() does.

    follower: Follower that plays the run; report(line of JSON): called for each result. The work stops when goes_on()
    is False.
    """
    met = follower.follow(_loaded(order), goes_on)
    found = {tier: sent_verdicts(verdicts) for tier, verdicts in met.items()}
    report(json.dumps({"moment": order["moment"], "encounters": found}))
    measure(order, report, goes_on)


def prove(order: dict[str, Any], report: Callable[[str], object], goes_on: Callable[[], bool]) -> None:
    """Test the setting of an order on its whole run, and report the measured times.

    report(line of JSON): called with the result; goes_on: not used.
    """
    setting, predicted = order["prove"]
    applied = apply_to_run(_loaded(order), Setting(*setting), predicted)
    report(json.dumps({"moment": order["moment"], "applied": applied}))
    report(json.dumps({"moment": order["moment"], "done": True}))


def _loaded(order) -> RecordedRun:
    return pickle.loads(Path(order["run"]).read_bytes())  # written by the game that started this process


if __name__ == "__main__":
    start_dummy_display()
    main({"prove": prove, "run": partial(measure_played, Follower())})
