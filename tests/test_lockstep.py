"""Lockstep reports which run differs, in which first frame, and in which part of the scene."""

import re
from contextlib import closing

import pytest

from game.errors import ReplayDiverged
from tests import lockstep as module
from tests.game.arena import Arena
from tests.lockstep import Changing, Diverged, DrawnRun, PlainRun, Run, failures_of, first_difference, lockstep


class Pushed(Arena):
    """Arena in which one disc gets another velocity in one frame."""

    def update(self, inputs):
        super().update(inputs)
        if self.frame == 6:
            self.disc.velocity = (5.0, 5.0)


class Counted(Arena):
    """Arena that reports a wrong state in frame 8, so that a comparison with an Arena fails there."""

    def state(self):
        return (*super().state()[:-1], 0.0) if self.frame == 8 else super().state()


class Shaken(Arena):
    """Arena whose drawing uses random numbers of the game."""

    def draw(self, canvas, alpha):
        super().draw(canvas, alpha)
        self.random.random()


def message(one, other, frames=20):
    with pytest.raises(Diverged) as caught:
        lockstep([one, other], frames)
    return str(caught.value)


def test_runs_that_are_alike_are_stepped_to_the_end():
    runs = [Run("one", Arena(seed=1)), Run("two", Arena(seed=1, broadphase="brute")), DrawnRun("drawn", Arena(seed=1))]
    lockstep(runs, 40)
    assert [run.session.report.steps for run in runs] == [40, 40, 40]


@pytest.mark.parametrize(
    "other, words", [(Pushed, "since frame 7 in world 0:"), (Counted, "since frame 8 in the scene's state:")]
)
def test_the_first_frame_and_the_place_are_named(other, words):
    found = message(Run("the scene", Arena(seed=1)), Run("the other", other(seed=1)))
    assert found.startswith(f"the other differs from the scene {words} digest ")
    assert len(re.findall(r"\b[0-9a-f]{32}\b", found)) == 2


def test_drawing_that_takes_part_in_the_game_is_named():
    found = message(Run("the scene", Shaken(seed=1)), DrawnRun("drawn", Shaken(seed=1)))
    assert f"drawn differs from the scene since frame {module.DRAWN_EVERY} in its random numbers" in found


def test_other_seeds_differ_at_once():
    assert first_difference(Run("", Arena(seed=1)), Run("", Arena(seed=2)), 5) == 1
    assert first_difference(Run("", Arena(seed=1)), Run("", Arena(seed=1)), 5) is None


def test_a_change_comes_in_the_frame_that_was_given():
    run = Run("", Arena(seed=1), Changing({3: (("broadphase", "tree"),)}))
    seen = []
    for _ in range(5):
        run.step()
        seen.append(run.scene.broadphase)
    assert seen == ["hash"] * 3 + ["tree"] * 2


def test_goals_that_were_due_and_caps_that_were_hit_are_failures():
    run = Run("", Arena(seed=1))
    lockstep([run], 10)
    assert failures_of(run, 10) == []
    assert failures_of(run, 120) == ["they meet: 0 times (was due 120)"]
    run.session.report.counters["cap_hits"] = 2
    run.session.report.quarantined = 1
    assert failures_of(run, 10) == ["1 bodies were quarantined", "2 cap hits"]


def test_a_replay_names_its_frame_too(tmp_path):
    """A replayed recording that differs names its first frame; recordings are compared after every frame."""
    from game.run.replay import Recorder, load_replay
    from game.run.session import Session

    scene = Arena(seed=1)
    run = Run("", scene, recorder=Recorder(scene, bot=True))
    lockstep([run], 12)
    run.session.recorder.save(tmp_path / "run.json")
    recording = load_replay(tmp_path / "run.json")
    replayed = Session(Pushed(seed=1), recording, replay=recording)
    with pytest.raises(ReplayDiverged, match="diverged at frame 7:"):
        for _ in range(12):
            replayed.step()


def test_a_process_that_ends_early_says_why():
    with closing(PlainRun("without compiled kernels", ["lab/nowhere"], 3)) as run:
        with pytest.raises(RuntimeError, match="without compiled kernels ended early: (?s:.*)'lab/nowhere'"):
            run.step()
