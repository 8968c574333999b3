"""Step inspector: stages forwards and backwards to the bit; play continues as if there had been no inspection."""

import re

import numpy as np
import pygame
import pytest

import physics
from game.audio.sound import Sounds
from game.files.settings import Settings
from game.input.devices import DeviceSource
from game.input.inputs import InputFrame
from game.run.digest import scene_digest
from game.run.picture import Picture
from game.run.session import Session
from game.run.sources import BotSource, ScriptSource
from game.run.step_inspector import StepInspector, compared, photographed
from game.screens.parts.panel_rows import play_rows
from game.screens.play import Play
from physics import debug
from scenes import SCENES
from tests.game.arena import Arena
from tests.lockstep import make_scene

K = pygame
KINDS = ("lab/pyramid", "shooter", "platformer", "lab/joints")  # stacking, without, with a character, with joints
BEFORE, AFTER = (24, 6) if physics.JIT else (3, 2)


def played(name, frames=BEFORE):
    session = Session(make_scene(name, few=True), BotSource())
    for _ in range(frames):
        session.step()
    return session


def inspector(session, world=None):
    scene = session.scene
    world = world or scene.views()[0][0]
    return StepInspector(scene, world, session.inputs.now, lambda: BotSource().next(scene))


def tables_of(world):
    """Return the contents of all tables of a world that is paused between stages, a list of bytes and the digest.

    Each entry has the bytes of one column, so that the padding between columns is left out.
    """
    shown = [*photographed(world).values(), world.contacts, debug.contact_points(world), debug.bounds(world)]
    parts = [each[name] for each in shown for name in each.dtype.names or [...]]
    return [part.tobytes() for part in parts] + [world.digest()]


@pytest.mark.parametrize("name", SCENES)
def test_play_goes_on_as_if_nobody_had_looked(name):
    session, other = played(name), played(name)
    before = scene_digest(session.scene)
    step = inspector(session)
    for place in (len(step.stages), 0, len(step.stages) // 2):
        step.go(place)
        debug.bounds(step.world)
    step.leave()
    assert scene_digest(session.scene) == before
    for _ in range(AFTER):
        session.step()
        other.step()
        assert scene_digest(session.scene) == scene_digest(other.scene)


@pytest.mark.parametrize("name", KINDS)
def test_forwards_and_back_to_the_bit(name):
    step = inspector(played(name))
    there = []
    for place in range(len(step.stages) + 1):
        step.go(place)
        assert step.place == place and (step.done is None) == (place == 0)
        there.append(tables_of(step.world))
    assert len({tuple(each) for each in there}) > len(there) / 3, "the stages do something"
    for place in reversed(range(len(step.stages) + 1)):
        step.go(place)
        assert tables_of(step.world) == there[place], f"back at {place}"
    assert all(len(runs) >= 3 and min(runs) > 0.0 for runs in step.seconds)
    step.go(1000)
    assert step.place == len(step.stages)
    step.go(-1)
    assert step.place == 0


@pytest.mark.parametrize("name", KINDS)
def test_the_last_stage_shows_the_step_that_is_then_made(name):
    session = played(name)
    step = inspector(session)
    step.go(len(step.stages))
    names, counted = [each.stage for each in step.stages], step.world.profile.counters
    shown = {column: step.world.bodies[column].copy() for column in ("id", "x", "y", "angle", "vx", "vy")}
    contacts = len(step.world.contacts)
    step.leave()
    session.step()
    world = session.scene.views()[0][0]
    assert names == world.stages and counted == world.profile.counters and contacts == len(world.contacts)
    for column, values in shown.items():
        kept = np.isin(shown["id"], world.bodies["id"])  # the rules take some away, and add others, after the step
        assert np.array_equal(values[kept], world.bodies[column][np.isin(world.bodies["id"], shown["id"])])


def test_what_a_stage_is_said_to_change_is_what_it_changes():
    step = inspector(played("lab/pyramid"))
    for place in range(1, len(step.stages) + 1):
        step.go(place - 1)
        before, counters = photographed(step.world), step.world.profile.counters
        step.go(place)
        after, done = photographed(step.world), step.done
        assert done is not None and done.stage is step.stages[place - 1]
        assert done == compared(done.stage, before, after)
        counted = {n: c - counters[n] for n, c in step.world.profile.counters.items() if c != counters[n]}
        assert done.counted == counted
        for table, rows, columns in done.changed:
            may = {each.partition(".")[::2] for each in done.stage.writes}
            assert rows <= len(after[table])
            if table in ("bodies", "shapes"):
                assert {(table, column) for column in columns} <= may, f"{done.stage.stage} says that it does not"
            for column in columns:
                old, new = before[table][column], after[table][column]
                assert int((old != new).sum()) == rows
    assert {"soft_step", "narrow_phase"} <= {each.stage for each in step.stages}


class Twice(Arena):
    """Scene that makes two steps a frame, and none in every fourth frame."""

    name = "twice"

    def update(self, inputs):
        if self.frame % 4 != 3:
            self.world.step(1 / 120)
            self.disc.velocity = (self.disc.velocity.x + 1.0, 0.0)
            self.world.step(1 / 120)


def test_all_steps_of_a_frame_one_after_the_other():
    session = Session(Twice(), BotSource())
    session.step()
    step = inspector(session)
    count = len(step.world.stages)
    assert step.starts == [0, count] and len(step.stages) == 2 * count
    step.go(count)
    assert step.world.body(0).velocity == (1.0, 0.0)
    step.go(count + 1)
    assert step.world.body(0).velocity == (2.0, 0.0)
    step.go(2 * count)
    shown = step.world.body(0).position
    step.leave()
    session.step()
    assert session.scene.disc.position == shown and session.scene.disc.velocity == (2.0, 0.0)


# --- on the screen --------------------------------------------------------------------------------------------------


def screen(scene, source=None, frames=30):
    settings = Settings(hint_seen=True, window_scale=1, labs_seen=list(SCENES))
    play = Play(scene, DeviceSource(), Sounds(silent=True), settings=settings)
    if source is not None:
        play.session.source = source
    play.advance(0.0)
    for _ in range(frames):
        play.step()
    play.clock.rest()
    return play


def key(play, name):
    for kind in (K.KEYDOWN, K.KEYUP):
        event = K.event.Event(kind, key=name, mod=0)
        if not play.feed(event):
            play.devices.feed(event)


def words(frame):
    return " ".join(text for _, text in frame.boxes)


@pytest.fixture
def play():
    play = screen(make_scene("lab/pyramid"), BotSource())
    yield play
    play.close()


def test_keys_go_through_it_and_out_again(play):
    before, frame = scene_digest(play.scene), play.scene.frame
    key(play, K.K_e)
    assert play.clock.paused and play.step_inspector.open and play.step_inspector.step.place == 1
    for name, place in ((K.K_RIGHT, 2), (K.K_RIGHT, 3), (K.K_LEFT, 2), (K.K_END, 8), (K.K_HOME, 0)):
        key(play, name)
        play.advance(1.0)
        assert play.step_inspector.step.place == place
    key(play, K.K_6)
    assert play.step_inspector.open and "contacts" in play.overlays.on, "overlays are switched as always"
    key(play, K.K_e)
    assert not play.step_inspector.open and play.clock.paused
    assert scene_digest(play.scene) == before and play.scene.frame == frame


@pytest.mark.parametrize("name", [K.K_p, K.K_o, K.K_r, K.K_TAB, K.K_m, K.K_ESCAPE, K.K_BACKSPACE, K.K_v])
def test_whatever_else_is_pressed_finds_the_scene_as_it_was(play, name):
    before = scene_digest(play.scene)
    key(play, K.K_e)
    key(play, K.K_END)
    assert scene_digest(play.scene) != before
    key(play, name)
    assert not play.step_inspector.open and scene_digest(play.scene) == before
    assert play.outcome is None


def test_a_single_step_makes_the_step_that_was_looked_at(play):
    other = played("lab/pyramid", 31)
    key(play, K.K_e)
    key(play, K.K_END)
    key(play, K.K_o)
    play.advance(1.0)
    assert play.scene.frame == 31 and scene_digest(play.scene) == scene_digest(other.scene)


def test_the_strip_names_all_stages_and_a_click_goes_there(play):
    picture = Picture(K.Surface((960, 540)))
    key(play, K.K_e)
    play.step_inspector.step.go(4)
    frame = play.draw(picture)
    reported = words(frame)
    assert all(stage.replace("_", " ") in reported for stage in play.scene.world.stages)
    assert "4 of 8: narrow phase" in reported and "us, the least of" in reported and "narrow tests +" in reported
    assert "contact rows" in reported and "FROZEN" not in reported and "-10 s" not in reported
    assert "contacts" not in play.overlays.on
    assert re.search(r"contacts (\d+) of \1", reported), "the layer of the stage is shown"
    rect, number = play.step_inspector.names[1]
    assert play.feed(K.event.Event(K.MOUSEBUTTONDOWN, button=1, pos=rect.center))
    assert play.step_inspector.step.place == number == 2
    assert "2 of 8: motion rectangles" in words(play.draw(picture))


@pytest.mark.parametrize("size", [(480, 270), (960, 540), (1440, 810)])
@pytest.mark.parametrize("name", ["platformer", "lab/stacks"])
def test_nothing_is_cut_at_any_size(name, size):
    play = screen(make_scene(name), BotSource())
    key(play, K.K_e)
    for place in range(len(play.step_inspector.step.stages) + 1):
        play.step_inspector.step.go(place)
        frame = play.draw(Picture(K.Surface(size)))
        inside, reported = frame.area.clip(frame.rect), words(frame)
        assert "the input is the bot's" in reported and "E puts the step back" in reported
        card = [rect for rect, text in frame.boxes if "reads" in text or "may write" in text or "the input" in text]
        assert all(inside.contains(rect) for rect in card)
        assert all(rect.bottom <= play.step_inspector.names[0][0].top for rect in card)
    play.close()


def test_of_several_worlds_each_in_turn():
    play = screen(make_scene("lab/stacks"), BotSource(), 5)
    worlds = play.step_inspector.worlds()
    key(play, K.K_e)
    seen = [play.step_inspector.step.world]
    for _ in range(2):
        key(play, K.K_DOWN)
        seen.append(play.step_inspector.step.world)
    assert [worlds.index(world) for world in seen] == [0, 1, 2]
    key(play, K.K_UP)
    assert play.step_inspector.step.world is worlds[1]
    assert "world 2 of 3" in words(play.draw(Picture(K.Surface((960, 540)))))
    play.close()


def test_in_the_past_it_is_the_step_that_was_recorded():
    frames = [InputFrame(frozenset({"right"} if number % 7 < 3 else ())) for number in range(60)]
    play = screen(Arena(seed=3), ScriptSource(frames), 60)
    recorded = play.timeline.rewind
    play.clock.paused = True
    play.timeline.go(-25)
    key(play, K.K_e)
    assert play.step_inspector.whose.endswith("recorded")
    key(play, K.K_END)
    shown = play.scene.disc.position
    key(play, K.K_e)
    assert recorded.position == 35 and recorded.end == 60
    play.timeline.go(1)
    assert play.scene.disc.position == shown
    play.close()


def test_a_person_goes_on_with_what_was_held():
    play = screen(Arena(seed=3), ScriptSource([InputFrame(frozenset({"right"}))] * 30))
    key(play, K.K_e)
    assert "held" in play.step_inspector.whose and play.scene.disc.velocity[0] == 60.0
    play.close()


def test_where_no_step_is_made_that_is_reported():
    play = screen(Twice(), BotSource(), 3)
    key(play, K.K_e)
    assert not play.step_inspector.open and "makes no step" in play.news
    play.close()


def test_nothing_is_measured_from_half_a_step(play, monkeypatch):
    taken, snapshot = [], type(play.scene.world).snapshot

    def note(world):
        taken.append(play.step_inspector.open)
        return snapshot(world)

    monkeypatch.setattr(type(play.scene.world), "snapshot", note)
    play.toggle_costs()
    key(play, K.K_e)
    play.measuring.tuner.on = True
    for _ in range(3):
        play.draw(Picture(K.Surface((960, 540))))
    assert not any(taken), "the effects are weighed from the moment before"


def test_a_change_from_elsewhere_ends_it(play):
    before = scene_digest(play.scene)
    key(play, K.K_e)
    play.devices.change("slider:rows", 5)
    play.session.source = BotSource(play.devices)
    play.advance(1.0)
    play.advance(1.1)
    assert not play.step_inspector.open and play.scene.values["rows"] == 5 and scene_digest(play.scene) != before


def test_the_panel_leads_there(play):
    play.panel_open = True
    row = next(row for row in play_rows(play) if row.label == "Step inspector")
    row.press()
    assert row.key == "E" and play.step_inspector.open and not play.panel_open


@pytest.mark.parametrize("size", [(640, 360), (960, 540), (1280, 720), (1440, 810)])
def test_the_card_leaves_the_title_line_of_a_lab_free(size):
    play = screen(make_scene("lab/stacks"))
    frame = play.draw(Picture(pygame.Surface(size)))
    head = frame.from_canvas((0, 0, 480, play.scene.head))

    def titles(frame):
        return [(rect, text) for rect, text in frame.boxes if head.contains(rect) and "measuring" not in text]

    before = titles(frame)
    assert before
    play.toggle_step_inspector()
    for _ in range(3):
        key(play, pygame.K_RIGHT)
        frame = play.draw(Picture(pygame.Surface(size)))
        assert titles(frame) == before
    play.close()
