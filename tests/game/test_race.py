"""The race: two scenes with the same seed and input differ only by the effect of their settings."""

import numpy as np
import pygame
import pytest

import physics
from game.files.settings import Settings
from game.input.devices import DeviceSource
from game.input.inputs import InputFrame
from game.measure.moment import here_of
from game.run.digest import scene_digest
from game.run.picture import Picture
from game.run.replay import load_replay
from game.run.session import Session
from game.run.sources import BotSource, ScriptSource
from game.screens.parts import race as race_module
from game.screens.parts.panel_rows import play_rows
from game.screens.parts.race import STEPS_TIMED
from game.screens.play import Play
from scenes import SCENES
from tests.lockstep import make_scene

needs_speed = pytest.mark.skipif(not physics.JIT, reason="hundreds of steps of whole games")
OTHER = {"hash": "tree", "tree": "hash", "sweep": "hash", "brute": "tree"}


class Silent:
    """Replacement of the sounds that plays nothing."""

    def __getattr__(self, name):
        return lambda *a, **k: None


@pytest.fixture
def played():
    """Yield played(name, source=None), a function that returns a Play of a scene. At the end all Plays are closed.

    source: source of input besides the devices, such as the bot.
    """
    screens = []

    def make(name, source=None):
        settings = Settings(window_scale=1, hint_seen=True, labs_seen=list(SCENES))
        play = Play(make_scene(name, few=True), DeviceSource(), Silent(), settings=settings)
        if source is not None:
            play.session.source = Mixed(source, play.devices)
        screens.append(play)
        return play

    yield make
    for play in screens:
        play.close()


class Mixed:
    """Source that combines the keys of another source, such as a bot, with setting changes from the devices."""

    def __init__(self, source, devices):
        self.source, self.devices = source, devices

    def next(self, scene):
        frame, changes = self.source.next(scene), self.devices.next().changes
        return InputFrame(frame.actions, frame.pointer, frame.pointer_down, frame.wheel, (*frame.changes, *changes))


def race_of(play, **changes):
    play.start_race(play.measuring.now()._replace(**changes))
    assert play.measuring.race is not None, play.news
    return play.measuring.race


def steps(play, count):
    for _ in range(count):
        play.step()


@needs_speed
@pytest.mark.parametrize("name", ["shooter", "lab/pyramid", "lab/mask_stack"])
def test_another_broad_phase_is_never_apart(played, name):
    play = played(name, BotSource())
    steps(play, 30)
    race = race_of(play, broadphase=OTHER[play.scene.world.broadphase.name])
    for _ in range(90):
        play.step()
        assert play.scene.frame == race.rival.frame
        assert [w.digest() for w in race.rival.worlds] == [w.digest() for w in play.scene.worlds]
    assert race.rival.world.broadphase.name == OTHER[play.scene.world.broadphase.name]
    assert "0 px apart, 0 of" in race.report_lines()[2] and race.steps == 90


@needs_speed
def test_fewer_substeps_are_apart_and_that_is_reported_and_drawn(played):
    play = played("lab/pyramid", BotSource())
    steps(play, 5)
    race = race_of(play, substeps=1)
    steps(play, 60)
    ours, theirs = race.gaps()
    bodies, others = play.scene.world.bodies, race.rival.world.bodies
    apart = np.hypot(bodies["x"] - others["x"], bodies["y"] - others["y"])
    assert np.hypot(*(ours - theirs).T) == pytest.approx(apart) and apart.max() > 0.0
    assert f"{np.sqrt((apart**2).mean()):.2g} px apart" in race.report_lines()[2]
    assert "1 substep:" in race.report_lines()[1] and "us a step" in race.report_lines()[0]
    picture = Picture(pygame.Surface((960, 540)))
    with_rival = pygame.surfarray.array3d(play.draw(picture).surface)
    text = " ".join(text for _, text in picture.presenter.frame.boxes)
    assert all(word in text for line in race.report_lines() for word in line.split())
    play.measuring.end_race()
    assert (pygame.surfarray.array3d(play.draw(picture).surface) != with_rival).any()


@needs_speed
def test_one_number_for_two_things_is_not_one_body(played):
    """Bodies with equal ids in both scenes are compared only if they are the same body.

    Shots that hit a circle are removed, while they fly past pixels in the other scene; later ids therefore differ.
    """
    play = played("shooter", BotSource())
    race = race_of(play, tier="circle")
    for _ in range(1200):
        play.step()
        ours, theirs = race.gaps()
        assert len(ours) == len(theirs) == len(race.same)
    ids = np.intersect1d(play.scene.world.bodies["id"], race.rival.world.bodies["id"])
    assert len(race.same) < len(ids) or len(ids) == 0 or len(race.same) == 0
    assert "without a twin" in race.report_lines()[2]


def test_what_the_player_does_goes_to_both_and_what_is_raced_to_one(played):
    play = played("lab/pyramid")
    race = race_of(play, substeps=8)
    steps(play, 3)
    play.devices.change("slider:rows", 6)
    play.devices.change("broadphase", "brute")
    steps(play, 3)
    assert race.rival.values["rows"] == play.scene.values["rows"] == 6
    assert play.scene.broadphase == "brute" != race.rival.broadphase
    assert race.rival.world.substeps == 8 != play.scene.world.substeps


def test_it_is_started_from_the_plot_with_shift_and_ended_in_the_panel(drive):
    d = drive(listing=SCENES)
    d.app.screens.play("lab/cradle")
    d.turns(3)
    d.key(pygame.K_RETURN)
    d.key(pygame.K_m)
    d.turns(20)
    play = d.screen
    play.costs.hovered = play.measuring.now()._replace(broadphase="brute")
    d.post(pygame.KEYDOWN, key=pygame.K_RETURN, mod=pygame.KMOD_SHIFT, unicode="\r")
    d.turns(4)
    assert play.measuring.race is not None and play.scene.frame < 20, "both began anew"
    assert play.scene.frame == play.measuring.race.rival.frame and "the race" in play.news
    row = next(row for row in play_rows(play) if row.label == "End the race")
    row.press()
    assert play.measuring.race is None and not any(row.label == "End the race" for row in play_rows(play))
    play.close()


def test_the_rival_has_the_solver_that_was_chosen(played):
    play = played("lab/pyramid")
    play.start_race(play.measuring.now()._replace(solver="projection", substeps=None))
    assert play.measuring.race.rival.world.solver == "projection"


def test_a_setting_that_cannot_be_played_is_reported_and_nothing_restarts(played):
    play = played("lab/stacks")
    steps(play, 10)
    play.start_race(play.measuring.now()._replace(solver="blocking", substeps=None))
    play.step()
    assert play.measuring.race is None and play.scene.frame == 11 and "only measured" in play.news


def test_rewinding_ends_it(played):
    play = played("lab/cradle")
    race_of(play, broadphase="brute")
    steps(play, 20)
    play.timeline.go(-5)
    assert play.measuring.race is None


@needs_speed
def test_the_recording_knows_nothing_of_it(played, tmp_path):
    right = [InputFrame(frozenset({"right"} if number % 20 < 10 else ())) for number in range(200)]
    play = played("shooter", ScriptSource(right))
    steps(play, 20)
    race_of(play, tier="circle")
    steps(play, 100)
    play.recorder.save(tmp_path / "run.json")
    replay = load_replay(tmp_path / "run.json")
    fresh = Session(make_scene("shooter"), replay, replay=replay)
    for _ in range(replay.frames):
        fresh.step()  # raises where it diverges
    assert scene_digest(fresh.scene) == scene_digest(play.scene)


@pytest.mark.parametrize("size", [(480, 270), (960, 540), (1440, 810)])
def test_its_figures_are_whole_beside_an_open_panel(played, size):
    play = played("lab/cradle", BotSource())
    race_of(play, broadphase="brute")
    steps(play, 4)
    play.panel_open = True
    frame = play.draw(Picture(pygame.Surface(size)))
    inside = frame.area.clip(frame.rect)
    found = [
        rect
        for rect, text in frame.boxes
        if len(text) > 8 and any(text in line for line in play.measuring.race.report_lines())
    ]
    assert len(found) >= 2 and all(inside.contains(rect) for rect in found)


def panel_row(play, label):
    return next(row for row in play_rows(play) if row.label == label)


def test_the_panel_starts_it_against_whatever_can_be_played(played):
    play = played("lab/pyramid", BotSource())
    steps(play, 20)
    now, names = play.measuring.now(), []
    for _ in play.measuring.rivals():
        row = panel_row(play, "Race against")
        names.append(row.value)
        row.turn(1)
    assert len(set(names)) == len(names) and {"1 substep", "tree", "boxes only", "projection"} <= set(names)
    assert panel_row(play, "Race against").value == names[0], "around the end"
    panel_row(play, "Race against").turn(-1)
    panel_row(play, "Start the race").press()
    play.step()
    race = play.measuring.race
    assert play.scene.frame == race.rival.frame == 1
    assert here_of(race.rival.world, race.rival.tier).label(now) == names[-1]
    assert not any(row.label == "Start the race" for row in play_rows(play))


@needs_speed
def test_the_split_screen_shows_both_and_their_difference(played):
    play = played("lab/pyramid", BotSource())
    press_k = pygame.event.Event(pygame.KEYDOWN, key=pygame.K_k, mod=0, unicode="k")
    play.feed(press_k)
    assert "no race" in play.news and play.measuring.split is None
    race = race_of(play, substeps=1)
    steps(play, 60)
    play.feed(press_k)
    picture = Picture(pygame.Surface((960, 540)))
    frame = play.draw(picture)
    pixels = pygame.surfarray.array3d(frame.surface)
    left, right = pixels[:478, 40:230], pixels[480:958, 40:230]
    assert (left != right).any(axis=2).mean() > 0.001, "the crates of the rival have sunk"
    text = " ".join(text for _, text in frame.boxes)
    for line in race.report_lines():
        assert all(part in text for part in line.rsplit(": ", 1)), line
    apart = race.distances()
    assert race.apart[-1] == pytest.approx(np.sqrt((apart**2).mean())) and len(race.apart) == 60
    assert max(race.apart) > race.apart[0]
    row = panel_row(play, "Split screen")
    assert row.on and row.key == "K"
    row.press()
    assert play.measuring.split is None and "px apart" in " ".join(t for _, t in play.draw(picture).boxes)
    row.press()
    play.measuring.end_race()
    assert play.measuring.split is None


@needs_speed
def test_two_that_are_the_same_look_the_same_side_by_side(played):
    play = played("shooter", BotSource())
    race_of(play, broadphase="tree")
    steps(play, 60)
    play.measuring.toggle_split()
    frame = play.draw(Picture(pygame.Surface((960, 540))))
    pixels = pygame.surfarray.array3d(frame.surface)
    assert (pixels[2:478, :268] == pixels[482:958, :268]).all()
    assert any("not by the last bit" in text for _, text in frame.boxes)


@pytest.mark.parametrize("panel", [False, True])
@pytest.mark.parametrize("size", [(480, 270), (960, 540), (1440, 810)])
def test_the_split_screen_is_whole_at_any_size(played, size, panel):
    play = played("lab/cradle", BotSource())
    race = race_of(play, broadphase="brute")
    steps(play, 4)
    play.measuring.toggle_split()
    play.panel_open = panel
    picture = Picture(pygame.Surface(size))
    frame = play.draw(picture)
    if panel and picture.presenter.crowded:
        return  # the panel has the whole picture
    inside = frame.area.clip(frame.rect)
    parts = [part for line in race.report_lines() for part in line.rsplit(": ", 1)]
    found = {text for rect, text in frame.boxes if text in parts and inside.contains(rect)}
    assert len(found) >= 4, found


@pytest.mark.parametrize("name", SCENES)
def test_it_can_be_run_in_every_scene(played, name):
    play = played(name, BotSource())
    if name in ("lab/pyramid", "lab/dominoes", "lab/tumbler", "lab/ghost_bumps"):
        steps(play, 2)  # its bot begins by choosing another solver or number of substeps, which a rival keeps
    now = play.measuring.now()
    race = race_of(play, **({"broadphase": OTHER[now.broadphase]} if play.scene.switches_broadphase else {}))
    steps(play, 8)
    frame = play.draw(Picture(pygame.Surface((960, 540))))
    assert any("px apart" in text for _, text in frame.boxes)
    assert [w.digest() for w in race.rival.worlds] == [w.digest() for w in play.scene.worlds]


def test_k_says_what_can_be_raced_where_there_are_no_sprites(played):
    play = played("lab/tumbler")
    play.feed(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_k, mod=0, unicode="k"))
    assert play.measuring.race is None and play.news.startswith("no race: the panel starts one, against ")
    assert len(play.news.split(", ")) > 2


def test_no_time_is_told_while_a_kernel_is_not_compiled(played, monkeypatch):
    play = played("lab/tumbler", BotSource())
    play.start_race(here_of(play.scene.world, None)._replace(broadphase="tree"))
    race = play.measuring.race
    monkeypatch.setattr(race_module.tiers, "background", True)
    monkeypatch.setattr(race_module.tiers, "wanted", [object()])
    steps(play, 3)
    assert race.seconds is None and all("not timed while kernels compile" in line for line in race.report_lines()[:2])
    monkeypatch.setattr(race_module.tiers, "background", False)
    steps(play, STEPS_TIMED - 1)
    assert race.seconds is None and f"measuring, {STEPS_TIMED - 1} of {STEPS_TIMED} steps" in race.report_lines()[0]
    steps(play, 1)
    assert race.seconds is not None and "us a step" in race.report_lines()[1]
    monkeypatch.setattr(race_module.tiers, "background", True)
    steps(play, 1)
    assert race.seconds is None, "a kernel that is called for the first time ends the times before"


@needs_speed
def test_k_races_pixels_against_boxes_at_once_where_there_are_sprites(played):
    play = played("shooter", BotSource())
    play.feed(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_k, mod=0, unicode="k"))
    race = play.measuring.race
    assert race is not None and play.measuring.split is not None
    assert {race.rival.tier, play.scene.tier} == {"aabb", "pixels"}
    steps(play, 30)
    play.feed(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_k, mod=0, unicode="k"))
    assert play.measuring.race is race and play.measuring.split is None, "again it toggles the view"
