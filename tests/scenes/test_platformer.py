"""The platformer: the rules of the scene, its words on the screen, and the bot on three seeds."""

import pytest

import physics
from game.digest import scene_digest
from game.draw import Canvas
from game.inputs import BotSource, ScriptSource
from game.run_report import judge
from game.session import Session
from scenes.platformer.hero import HEIGHT
from scenes.platformer.level import load_level
from scenes.platformer.scene import Platformer


def start(frames=(), seed=1):
    scene = Platformer(seed=seed)
    session = Session(scene, ScriptSource([f.split() for f in frames]))
    return scene, session


def put(scene, x, bottom):
    """Place the hero with the middle of his feet at a point."""
    scene.hero.place((x, bottom - HEIGHT / 2))


def play(session, frames):
    for _ in range(frames):
        session.step()


def test_a_coin_is_taken_once_and_stays_taken_after_a_death():
    scene, session = start()
    coin = scene.things.of("coin")[0]
    put(scene, coin.x, coin.y + 10)
    play(session, 2)
    assert scene.coins == 1 and coin.body.id not in scene.things.triggers
    spikes = scene.things.of("spikes")[0]
    put(scene, spikes.x, spikes.y)
    play(session, 2)
    assert (scene.phase, scene.deaths) == ("hurt", 1)
    play(session, scene.life_after + 2)
    assert scene.phase == "playing" and scene.coins == 1
    assert scene.hero.character.position == (scene.spawn[0], scene.spawn[1])


def test_a_checkpoint_is_where_the_next_life_starts_also_when_jumped_over():
    scene, session = start()
    lantern = scene.checkpoints[0]
    x, bottom = lantern.foot
    put(scene, x, bottom - 50)
    play(session, 2)
    assert lantern.lit and scene.spawn == (x, bottom - HEIGHT / 2)


def test_a_spring_throws_higher_than_any_jump():
    scene, session = start()
    spring = scene.things.of("spring")[1]
    x, bottom = spring.foot
    put(scene, x, bottom)
    session.step()
    highest = bottom
    for _ in range(60):
        session.step()
        highest = min(highest, scene.hero.box[3])
    assert scene.feats["springs"] >= 1 and 80 < bottom - highest < 130


def test_a_walker_is_stomped_from_above_and_hurts_from_beside():
    scene, session = start()
    walker = next(iter(scene.things.walkers.values()))
    x, _ = walker.character.position
    put(scene, x, walker.top - 40)
    play(session, 30)
    assert scene.feats["stomps"] == 1 and scene.deaths == 0 and walker not in scene.things.walkers.values()
    other = next(iter(scene.things.walkers.values()))
    put(scene, other.character.position[0] - 20 * other.way * -1, other.bottom)
    play(session, 60)
    assert scene.deaths == 1


def test_a_new_life_is_spared_by_walkers_for_a_moment():
    scene, session = start()
    walker = next(iter(scene.things.walkers.values()))
    scene.spawn = (walker.home[0], walker.bottom - HEIGHT / 2)
    scene._hurt()
    play(session, scene.life_after + 20)
    assert scene.deaths == 1 and scene.phase == "playing" and scene.mercy > 0
    play(session, 300)
    assert scene.deaths == 2, "the mercy must end"


def drop_crate(scene, x, bottom, speed):
    """Let the large crate come down at a place; its lower edge starts 20 px above it."""
    crate = max(scene.things.crates, key=lambda one: one.size).body
    crate.move_to((x, bottom - 20 - 16), 0.0)
    crate.velocity = (0.0, speed)
    return crate


def test_a_crate_flattens_a_walker_by_its_impulse_and_not_when_it_is_set_down():
    for speed, alive in ((0.0, True), (400.0, False)):
        scene, session = start()
        identity, walker = next(iter(scene.things.walkers.items()))
        x, y = walker.character.position
        drop_crate(scene, x, walker.top - (0 if speed else -15), speed)
        play(session, 20)
        assert (identity in scene.things.walkers) == alive


def test_a_crate_that_comes_down_on_the_hero_hurts_him():
    scene, session = start()
    x = scene.hero.character.position[0]
    drop_crate(scene, x, scene.hero.box[1], 400.0)
    play(session, 20)
    assert scene.deaths == 1


def test_sound_and_dust_of_a_crate_grow_with_the_impulse_of_its_hit():
    loud, dusty = [], []
    for speed in (100.0, 250.0, 500.0):
        scene, session = start()
        put(scene, 60, 288)
        drop_crate(scene, 120, 288, speed)
        before, heard = scene.particles.count, []
        for _ in range(12):
            session.step()
            heard += [volume for name, _, volume in scene.cues if name == "land"]
        loud.append(max(heard))
        dusty.append(scene.particles.count - before)
    assert loud == sorted(loud) and loud[0] < 0.7 * loud[2]
    assert dusty[0] < dusty[2]


def test_the_goal_stops_the_clock_and_a_key_starts_again():
    scene, session = start([""] * 150 + ["jump"] + [""] * 5)
    goal = scene.things.of("goal")[0]
    put(scene, goal.x, goal.foot[1])
    play(session, 3)
    assert scene.phase == "won"
    clock = scene.clock
    play(session, 100)
    assert scene.clock == clock and scene.hero.grounded
    play(session, 60)
    assert scene.phase == "playing" and scene.coins == 0 and scene.clock < 60


def test_signs_and_counters_never_overlap_or_leave_the_picture():
    scene, session = start()
    canvas = Canvas()
    for sign in scene.level.map.things_of("sign"):
        put(scene, sign.x, sign.y + sign.height)
        scene.mercy, scene.since = 600, 60
        for _ in range(2):
            session.step()
        canvas.begin()
        scene.draw(canvas, 0.5)
        assert any(text in sign.properties["text"] for _, text in canvas.boxes), sign.properties["text"]
        rects = [rect for rect, _ in canvas.boxes]
        assert all(canvas.rect.contains(rect) for rect in rects)
        assert not any(a.colliderect(b) for i, a in enumerate(rects) for b in rects[:i])


def test_every_thing_of_the_level_is_met():
    level = load_level()
    scene, _ = start()
    for kind in ("coin", "spring", "spikes", "checkpoint", "goal"):
        assert len(scene.things.of(kind)) == len(level.map.things_of(kind)) > 0
    assert len(scene.things.walkers) == len(level.map.things_of("walker"))
    assert (level.map.columns, level.map.rows) >= (100, 20)


def test_what_the_scene_declares_is_what_it_uses():
    scene, _ = start()
    assert scene.effects.names() == ["narrowphase", "response", "gravity", "rotation", "friction", "stacking",
                                     "continuous", "sleeping", "sensors", "one_way"]


@pytest.mark.skipif(not physics.JIT, reason="a minute of play takes long without compiled kernels")
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_bot_reaches_the_goal_in_a_minute(seed):
    scene = Platformer(seed=seed)
    session = Session(scene, BotSource())
    play(session, 3600)
    check = judge(scene, 3600)
    assert check["ok"], check["failures"]
    assert scene.inside_solid == 0 and scene.deaths <= 2


@pytest.mark.skipif(not physics.JIT, reason="as above")
def test_seeds_differ_by_their_walkers():
    digests = set()
    for seed in (1, 2, 3):
        scene = Platformer(seed=seed)
        play(Session(scene, BotSource()), 30)
        digests.add(scene_digest(scene))
    assert len(digests) > 1
