"""Rewind: any step of the last ten seconds is restored to the bit, play continues from it, and it needs few bytes."""

from itertools import count
from time import process_time

import numpy as np
import pygame
import pytest

import physics
from game.audio.sound import Sounds
from game.files.settings import Settings
from game.input.devices import DeviceSource
from game.input.inputs import InputFrame
from game.run.chunks import CHUNK, Chunks, bytes_of
from game.run.digest import scene_digest
from game.run.picture import Picture
from game.run.replay import Recorder, load_replay
from game.run.rewind import KEY_SECONDS, MOST_STEPS, PLAIN, STEPS, Rewind
from game.run.session import Session
from game.run.sources import BotSource, ScriptSource
from game.screens.parts.panel_rows import LEAP, play_rows
from game.screens.play import Play
from physics.jit import tiers
from scenes import SCENES
from tests.game.arena import Arena, Race
from tests.lockstep import make_scene

K = pygame
# Steps played; where other input begins; for how long.
LENGTH, BRANCH, OTHER = (96, 70, 24) if physics.JIT else (24, 17, 8)
LEFT = InputFrame(frozenset({"left", "fire"}), (200, 120))
BESIDE, A_BODY = 64 * 1024, 128  # [bytes] that the last ten seconds may take, and per moving body and step
MEASURED = ("shooter", "platformer", "lander", "lab/pyramid", "lab/conveyor", "lab/tunnelling", "lab/shapes")


class Noted:
    """A session with its rewind; `digests` and `inputs` list those of every step that was played."""

    def __init__(self, scene, source=None, recorder=None):
        self.session = Session(scene, source or BotSource(), recorder)
        self.rewind = Rewind(self.session)
        self.digests, self.inputs = [scene_digest(scene)], []

    @property
    def digest(self):
        return scene_digest(self.session.scene)

    def play(self, steps, source=None):
        """Play `steps` steps from the current state and record them; later recorded steps are dropped first."""
        self.session.source = source or self.session.source
        self.rewind.drop_future()
        del self.digests[self.rewind.position + 1 :], self.inputs[self.rewind.position :]
        for _ in range(steps):
            self.session.step()
            self.rewind.note()
            self.inputs.append(self.session.inputs.now)
            self.digests.append(self.digest)
        return self


def moving_bodies(scene):
    return sum(int((world.bodies["kind"] != 0).sum()) for world in scene.worlds)


@pytest.mark.parametrize("name", SCENES)
def test_every_scene_goes_back_and_on_again_to_the_bit(name):
    noted = Noted(make_scene(name, few=True)).play(LENGTH)
    for step in (LENGTH - 1, LENGTH // 2, LENGTH, 1, 0, BRANCH):
        noted.rewind.seek(step)
        assert noted.digest == noted.digests[step], f"step {step}"
    for step in range(BRANCH + 1, LENGTH + 1):
        noted.rewind.seek(step)
        assert noted.digest == noted.digests[step], f"on again, step {step}"
    noted.rewind.seek(BRANCH)
    noted.play(OTHER, ScriptSource([LEFT] * OTHER))
    fresh = Session(make_scene(name, few=True), ScriptSource(noted.inputs))
    for digest in noted.digests[1:]:
        fresh.step()
        assert scene_digest(fresh.scene) == digest


@pytest.mark.nightly
@pytest.mark.skipif(not physics.JIT, reason="twenty seconds of every scene")
@pytest.mark.parametrize("name", SCENES)
def test_ten_seconds_back_and_on_again_in_every_scene(name):
    session = Session(make_scene(name, few=True), BotSource())
    rewind, digests = Rewind(session), {0: scene_digest(session.scene)}
    for step in range(1, STEPS + 1):
        session.step()
        rewind.note()
        if step % 60 == 0:
            digests[step] = scene_digest(session.scene)
    for step, digest in digests.items():  # the first is ten seconds back
        rewind.seek(step)
        assert rewind.position == step and scene_digest(session.scene) == digest, f"step {step}"


@pytest.fixture
def even_clock(monkeypatch):
    """Make all key frames take the same measured time, because a slow one on a busy machine would be postponed."""
    ticks = count()
    monkeypatch.setattr("game.run.rewind.perf_counter", lambda: 1e-6 * next(ticks))


@pytest.mark.usefixtures("even_clock")
def test_ten_seconds_are_within_reach_and_no_more():
    noted = Noted(Arena(seed=3)).play(STEPS + 250)
    rewind = noted.rewind
    assert rewind.start == 250 and rewind.end == STEPS + 250
    rewind.seek(0)
    assert rewind.position == 250 and noted.digest == noted.digests[250]
    # Dropped when a stretch begins: the last may have begun so many steps ago, and the first be as long.
    assert rewind.stretches[0].start > 250 - 2 * MOST_STEPS, "what lies before is dropped"
    rewind.seek(10_000)
    assert rewind.live and noted.digest == noted.digests[-1]


@pytest.mark.usefixtures("even_clock")
def test_a_seek_makes_few_steps_and_going_back_fewer():
    noted = Noted(Arena(seed=3)).play(STEPS)
    rewind, made = noted.rewind, []
    for step in range(STEPS, 0, -7):
        rewind.seek(step)
        assert rewind.position == step and rewind.steps_made <= MOST_STEPS
        made.append(rewind.steps_made)
    assert 0 < sum(made) < len(made) * MOST_STEPS / 2


@pytest.mark.usefixtures("even_clock")
@pytest.mark.parametrize("milliseconds", [3, 10, 30])
def test_while_kernels_run_plain_key_frames_wait_and_every_step_comes_back(monkeypatch, milliseconds):
    spacings = []
    for wanted in ({}, {"a kernel": None}):
        with monkeypatch.context() as patch:
            patch.setattr(tiers, "wanted", wanted)
            noted = Noted(Arena(seed=3))
            patch.setattr(noted.session.report, "note_step", lambda scene, seconds: None)
            noted.session.report.last = 1e-3 * milliseconds
            noted.play(200)
        starts = [each.start for each in noted.rewind.stretches]
        spacings.append(max(np.diff(starts)))
        for step in (199, 131, 58, 1, 0):
            noted.rewind.seek(step)
            assert noted.digest == noted.digests[step], f"step {step}"
    assert spacings[1] == min(MOST_STEPS, int(np.ceil(PLAIN * 1e3 * KEY_SECONDS / milliseconds))) > spacings[0]


def test_slow_steps_have_key_frames_closer_together(monkeypatch):
    noted = Noted(Arena(seed=3))
    monkeypatch.setattr(noted.session.report, "note_step", lambda scene, seconds: None)
    noted.session.report.last = 0.030
    noted.play(40)
    starts = [each.start for each in noted.rewind.stretches]
    assert max(np.diff(starts)) == 2, "two steps of 30 ms, and the next seek would take too long"


@pytest.mark.parametrize("every", [1, 30])
def test_the_recording_is_cut_back_and_replays(tmp_path, every):
    scene = Arena(seed=3)
    right = [InputFrame(frozenset({"right"}))] * 50
    noted = Noted(scene, ScriptSource(right * 3), Recorder(scene, every=every)).play(130)
    noted.rewind.seek(47)
    noted.play(60, ScriptSource([InputFrame(frozenset({"left"} if n % 9 else ())) for n in range(60)]))
    noted.session.recorder.save(tmp_path / "run.json")
    replay = load_replay(tmp_path / "run.json")
    fresh = Session(Arena(seed=3), replay, replay=replay)
    for _ in range(replay.frames):
        fresh.step()  # raises where it diverges
    assert replay.frames == 107 and replay.inputs == noted.inputs and len(replay.digests) == 107 // every
    assert scene_digest(fresh.scene) == noted.digests[-1]


def test_a_step_made_in_the_past_is_refused():
    noted = Noted(Arena(seed=3)).play(10)
    noted.rewind.seek(5)
    noted.session.step()
    with pytest.raises(ValueError, match="step 5 of 10"):
        noted.rewind.note()


def measured(name):
    noted = Noted(make_scene(name))
    bodies = 0
    for _ in range(STEPS + 60):
        noted.session.step()
        noted.rewind.note()
        bodies += moving_bodies(noted.session.scene)
    return noted.rewind.bytes, A_BODY * bodies * STEPS // (STEPS + 60) + BESIDE


@pytest.mark.skipif(not physics.JIT, reason="slow steps have more key frames")
@pytest.mark.parametrize("name", MEASURED)
def test_ten_seconds_take_few_bytes(name, monkeypatch):
    for where in ("rewind", "session"):  # seconds of this process: where others run too, there are more key frames
        monkeypatch.setattr(f"game.run.{where}.perf_counter", process_time)
    taken, allowed = measured(name)
    assert taken <= allowed


def test_bytes_are_those_that_are_there():
    rng = np.random.default_rng(1)
    noise = [memoryview(rng.bytes(size)) for size in (CHUNK * 5, 100, 400 * 48)]
    chunks = Chunks(noise, [1, 1, 48])
    assert sum(map(len, noise)) < bytes_of([chunks]) < 1.1 * sum(map(len, noise)) + 1000
    again = Chunks(noise, [1, 1, 48], chunks)
    assert bytes_of([chunks, again]) < bytes_of([chunks]) + 1000


@pytest.mark.parametrize("rows", [1, 30, 400, 5000])
def test_chunks_give_back_what_they_were_given(rows):
    rng = np.random.default_rng(rows)
    table = np.zeros(rows, [("a", "f8"), ("b", "i8"), ("c", "f8")])
    odd = rng.integers(0, 255, (rows, 13), np.uint8)
    before = None
    for turn in range(3):
        table["b"] = rng.integers(0, 2**60, rows)
        table["c"] += turn
        given = [
            memoryview(x.tobytes()) for x in (b"stream" * rows, table, odd, np.arange(turn)) if not isinstance(x, bytes)
        ]
        given.insert(0, memoryview(b"stream" * rows))
        before = Chunks(given, [0, table.itemsize, 13, 8], before)
        for packed in (False, True):
            if packed:
                for chunk in before.new:
                    chunk.pack()
            found = before.contents()
            assert [bytes(x) for x in found] == [bytes(x) for x in given]
            assert all(not x.readonly for x in found)


def test_columns_that_stay_are_shared():
    table = np.zeros(4000, [("still", "f8", 3), ("moves", "f8")])
    table["still"] = np.random.default_rng(1).random((4000, 3))
    one = Chunks([memoryview(table.tobytes())], [table.itemsize])
    table["moves"] += np.random.default_rng(2).random(4000)
    two = Chunks([memoryview(table.tobytes())], [table.itemsize], one)
    assert 0 < sum(len(chunk.data) for chunk in two.new) < table.nbytes / 2


# --- on the screen --------------------------------------------------------------------------------------------------


class Silent(Sounds):
    """Replacement of the sounds that counts the steps."""

    def __init__(self):
        super().__init__(silent=True)
        self.heard, self.jingles = 0, []

    def play_cues(self, cues):
        self.heard += 1

    def jingle(self, name):
        self.jingles.append(name)


@pytest.fixture
def play():
    """Return a Play after 150 steps. `play.digests`: its digests, by step."""
    play = Play(Arena(seed=3), DeviceSource(), Silent(), settings=Settings(hint_seen=True, window_scale=1))
    play.digests = [scene_digest(play.scene)]
    play.advance(0.0)
    for _ in range(150):
        play.step()
        play.digests.append(scene_digest(play.scene))
    play.clock.rest()
    return play


def key(play, name, down=True, mod=0):
    kind = K.KEYDOWN if down else K.KEYUP
    event = K.event.Event(kind, key=name, mod=mod)
    if not play.feed(event):
        play.devices.feed(event)


def turns(play, count, start):
    for n in range(count):
        play.advance(start + (n + 1) / 60)
    return start + count / 60


def test_backspace_runs_back_while_held_and_play_goes_on_from_there(play):
    rewind, heard = play.timeline.rewind, play.sounds.heard
    key(play, K.K_BACKSPACE)
    now = turns(play, 31, 0.0)
    assert rewind.position == pytest.approx(120, abs=2) and rewind.end == 150
    assert scene_digest(play.scene) == play.digests[rewind.position]
    assert play.sounds.heard == heard and not play.scene.cues, "no sound is heard on the way"
    assert play.assisted
    key(play, K.K_BACKSPACE, down=False)
    place = rewind.position
    turns(play, 13, now)
    assert rewind.live and rewind.end == pytest.approx(place + 12, abs=1) and play.recorder.frames == rewind.end
    key(play, K.K_BACKSPACE)
    turns(play, 200, 10.0)
    assert rewind.position == 0, "and faster after a while"


def test_arrows_move_the_frozen_game_along_the_timeline_and_it_goes_on_where_it_is(play):
    rewind = play.timeline.rewind
    key(play, K.K_p)
    for name, mod, place in ((K.K_LEFT, 0, 149), (K.K_LEFT, K.KMOD_LSHIFT, 139), (K.K_RIGHT, 0, 140)):
        key(play, name, mod=mod)
        key(play, name, down=False)
        turns(play, 1, 1.0)
        assert rewind.position == place and scene_digest(play.scene) == play.digests[place]
    key(play, K.K_RIGHT, mod=K.KMOD_RSHIFT)
    key(play, K.K_RIGHT, down=False)
    turns(play, 1, 2.0)
    assert rewind.live and scene_digest(play.scene) == play.digests[150]
    key(play, K.K_LEFT)
    now = turns(play, 60, 3.0)
    assert rewind.position < 130, "held, it goes on by itself"
    key(play, K.K_p)
    place = rewind.position
    turns(play, 10, now)
    assert rewind.live and rewind.end > place, "an arrow held on is no longer heard when the game goes on"
    assert not play.devices.next().actions, "nor does it steer"


def test_the_bar_is_worked_with_the_mouse(play):
    picture, rewind = Picture(K.Surface((960, 540))), play.timeline.rewind
    key(play, K.K_p)
    play.draw(picture)
    bar = play.timeline.bar
    at = (bar.right - bar.width * 60 // STEPS, bar.centery)
    assert play.feed(K.event.Event(K.MOUSEBUTTONDOWN, button=1, pos=at))
    turns(play, 1, 1.0)
    assert rewind.position == pytest.approx(90, abs=1)
    play.feed(K.event.Event(K.MOUSEMOTION, pos=(bar.x, 0), rel=(0, 0), buttons=(1, 0, 0)))
    turns(play, 1, 2.0)
    assert rewind.position == 0 and scene_digest(play.scene) == play.digests[0]
    play.feed(K.event.Event(K.MOUSEBUTTONUP, button=1, pos=at))
    play.feed(K.event.Event(K.MOUSEMOTION, pos=(bar.right, 0), rel=(0, 0), buttons=(0, 0, 0)))
    turns(play, 1, 3.0)
    assert rewind.position == 0


def test_the_pad_moves_along_the_timeline_while_frozen_and_flies_while_not(play):
    def button(name, down=True):
        kind = K.CONTROLLERBUTTONDOWN if down else K.CONTROLLERBUTTONUP
        event = K.event.Event(kind, button=name, instance_id=5)
        return play.feed(event)

    rewind = play.timeline.rewind
    assert not button(K.CONTROLLER_BUTTON_LEFTSHOULDER)
    key(play, K.K_p)
    assert button(K.CONTROLLER_BUTTON_LEFTSHOULDER)
    now = turns(play, 30, 0.0)
    assert rewind.position == pytest.approx(120, abs=2)
    assert button(K.CONTROLLER_BUTTON_LEFTSHOULDER, down=False)
    place = rewind.position
    turns(play, 30, now)
    assert rewind.position == place


def test_the_panel_has_a_row_for_it(play):
    row = next(row for row in play_rows(play) if row.label.startswith("Rewind"))
    assert row.key == "Backspace"
    row.press()
    assert play.clock.paused and play.timeline.rewind.position == 150 - LEAP
    assert any("1.0 s back" in row.label for row in play_rows(play))


def test_a_result_is_taken_back():
    play = Play(Race(seed=5), DeviceSource(), Silent(), settings=Settings(hint_seen=True, window_scale=1))
    play.session.source = ScriptSource([InputFrame(frozenset({"right"}))] * 400)
    while play.since_result < 30:
        play.step()
    ended, trail = play.timeline.rewind.end - 29, list(play.scene.trail)
    assert play.scene.result is not None and play.sounds.jingles == ["victory"]
    play.timeline.go(-40)
    assert play.scene.result is None and play.since_result == 0 and play.assisted
    play.timeline.go(25)
    assert play.since_result == 15
    play.timeline.go(-25)
    assert play.sounds.jingles == ["victory"]
    play.timeline.rewind.seek(play.timeline.rewind.end)
    assert play.scene.trail == trail, "what was gone along is whole again"
    play.timeline.go(-40)
    play.session.source = ScriptSource([InputFrame()] * 400)
    for _ in range(20):
        play.step()
    assert play.scene.result is None and play.timeline.rewind.end == ended - 11 + 20
    assert play.recorder.frames == play.timeline.rewind.end


def test_a_restart_is_where_the_past_begins(play):
    rewind = play.timeline.rewind
    play.restart()
    play.step()
    assert rewind.start == rewind.end == 151
    for _ in range(30):
        play.step()
    play.timeline.go(-100)
    assert rewind.position == 151 and play.scene.frame == 1
    play.step()
    assert play.recorder.frames == 2


def test_invariants_are_watched_as_they_are_now(play):
    key(play, K.K_u)
    play.step()
    play.timeline.go(-30)
    assert play.scene.monitor is not None, "though nobody watched then"
    assert any(status.state == "green" for status in play.scene.monitor.statuses)
    key(play, K.K_u)
    play.step()
    play.timeline.go(-1)
    assert play.scene.monitor is None


def test_what_is_set_from_outside_stays(play):
    play.settings.shake = 0.0
    play.apply_settings()
    play.scene.best, play.scene.ghost = 70, [(1.0, 2.0, "run_0", 1)]
    play.timeline.go(-50)
    assert play.scene.best == 70 and play.scene.ghost and play.scene.camera.shake_share == 0.0
    assert not play.timeline.rewind.live
