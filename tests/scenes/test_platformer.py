"""Rules of the platformer: pick-ups, checkpoints, injuries, enemies, crates, assists, the goal, and texts on the
screen.
"""

import pytest

from game.drawing.canvas import Canvas
from game.input.inputs import InputFrame
from game.run.session import Session
from game.run.sources import ScriptSource
from scenes.platformer.feel import HEIGHT, steps
from scenes.platformer.level import level_of
from scenes.platformer.scene import APPLAUSE, HIT_STOP, Platformer
from scenes.platformer.view import hero_frame


def start(frames=(), seed=1, **assists):
    scene = Platformer(seed=seed)
    changes = tuple((f"assist:{name}", on) for name, on in assists.items())
    first = [InputFrame(changes=changes)] if changes else []
    session = Session(scene, ScriptSource(first + [f.split() for f in frames]))
    play(session, len(first))
    return scene, session


def put(scene, x, bottom):
    """Place the hero with the middle of its feet at (x, bottom)."""
    scene.hero.place((x, bottom - HEIGHT / 2))


def play(session, frames):
    for _ in range(frames):
        session.step()


def enemy_of(scene, kind):
    return next(enemy for enemy in scene.things.enemies.values() if enemy.kind == kind)


def beside(scene, enemy):
    """Place the hero where the enemy will run into it."""
    put(scene, enemy.character.position[0] + 20 * enemy.way, enemy.bottom)


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
    play(session, scene.life_after + HIT_STOP + 2)
    assert scene.phase == "playing" and scene.coins == 1
    assert scene.hero.character.position == (scene.spawn[0], scene.spawn[1])


def test_a_new_life_begins_within_a_second():
    scene, session = start(["right"] * 200)
    spikes = scene.things.of("spikes")[0]
    put(scene, spikes.x, spikes.y)
    play(session, 1)
    assert scene.phase == "hurt"
    waited = 0
    while scene.hero.vx == 0.0 or scene.phase != "playing":
        session.step()
        waited += 1
    assert waited <= 60


def test_secrets_are_counted_and_worth_more():
    scene, session = start()
    for number, gem in enumerate(scene.things.of("secret"), 1):
        put(scene, gem.x, gem.y + 8)
        play(session, 2)
        assert scene.secrets == number
    assert scene.secrets == scene.things.secrets_in_all == 4
    assert scene._result().points == 4000 + 100 * scene.coins


def test_a_checkpoint_is_where_the_next_life_starts_also_when_jumped_over():
    scene, session = start()
    lantern = scene.checkpoints[0]
    x, bottom = lantern.foot
    put(scene, x, bottom - 50)
    play(session, 2)
    assert lantern.lit and scene.spawn == (x, bottom - HEIGHT / 2)


def test_a_spring_throws_higher_than_any_jump():
    scene, session = start()
    spring = scene.things.of("spring")[0]
    x, bottom = spring.foot
    put(scene, x, bottom)
    session.step()
    highest = bottom
    for _ in range(60):
        session.step()
        highest = min(highest, scene.hero.box[3])
    assert scene.feats.done["springs"] >= 1 and 80 < bottom - highest < 130


@pytest.mark.parametrize("kind", ["walker", "hedgehog"])
def test_a_walker_is_stomped_from_above_and_a_hedgehog_is_not(kind):
    scene, session = start()
    enemy = enemy_of(scene, kind)
    put(scene, enemy.character.position[0], enemy.top - 40)
    play(session, 30)
    stomped = kind == "walker"
    assert (scene.feats.done["stomps"], scene.deaths) == (int(stomped), int(not stomped))
    assert (enemy.body.id in scene.things.enemies) == (not stomped)


@pytest.mark.parametrize("kind", ["walker", "hedgehog"])
def test_from_beside_both_hurt(kind):
    scene, session = start()
    beside(scene, enemy_of(scene, kind))
    play(session, 60)
    assert scene.deaths == 1


def test_a_bat_wakes_by_its_lair_and_is_stomped():
    scene, session = start()
    bat = enemy_of(scene, "bat")
    x, y = bat.start
    put(scene, x - 60, 512)
    play(session, 3)
    assert bat.seen and bat.phase == "flying"
    scene.mercy = 999  # it comes to where he stands
    while bat.count < 80:
        session.step()
    put(scene, bat.character.position[0] + 4 * bat.way, bat.top - 10)
    play(session, 12)
    assert scene.feats.done["stomps"] == 1 and scene.deaths == 0 and bat.body.id not in scene.things.enemies


def test_enemies_far_from_the_hero_rest():
    scene, session = start()
    before = {enemy: enemy.character.position for enemy in scene.things.enemies.values()}
    play(session, 60)
    far = [enemy for enemy, (x, _) in before.items() if x > 1000 and scene.things.decks[enemy.body.id] is None]
    assert len(far) > 8 and all(enemy.character.position == before[enemy] for enemy in far)


def test_a_hit_stop_stops_the_world_and_can_be_switched_off():
    for hit_stop in (True, False):
        scene, session = start(hit_stop=hit_stop)
        walker = enemy_of(scene, "walker")
        put(scene, walker.character.position[0], walker.top - 8)
        while not scene.feats.done["stomps"]:
            session.step()
        ticks, clock = scene.ticks, scene.clock
        play(session, 3)
        assert (scene.ticks - ticks, scene.clock - clock) == ((0, 0) if hit_stop else (3, 3))


def test_a_jump_pressed_in_a_hit_stop_counts():
    scene, session = start(["right"] * 3 + ["jump"] * 20)
    scene.stop = 6
    play(session, 8)
    assert "jump" in scene.hero.news or scene.hero.vy < 0.0


def test_with_the_assist_enemies_throw_back_and_nothing_is_lost():
    scene, session = start(invincible=True)
    walker = enemy_of(scene, "walker")
    beside(scene, walker)
    side = walker.way
    for _ in range(60):
        session.step()
        if "thrown" in scene.hero.news or scene.hero.locked:
            break
    assert scene.hero.vx * side > 0 and scene.mercy > 0 and scene.phase == "playing" and scene.deaths == 0


def test_with_the_assist_spikes_put_him_back_where_he_stood_and_a_fall_is_still_a_fall():
    scene, session = start(invincible=True)
    play(session, 3)
    stood = scene.hero.character.position
    for spikes in scene.things.of("spikes"):
        put(scene, spikes.x, spikes.y)
        play(session, 2)
        assert scene.hero.character.position == stood and scene.phase == "playing" and scene.deaths == 0
    put(scene, 100, scene.level.size[1] + 200)
    play(session, 2)
    assert scene.phase == "hurt"


def test_a_new_life_is_spared_by_enemies_for_a_moment():
    scene, session = start()
    walker = enemy_of(scene, "walker")
    scene.spawn = (walker.home, walker.bottom - HEIGHT / 2)
    scene._lose()
    play(session, scene.life_after + HIT_STOP + 20)
    assert scene.deaths == 1 and scene.phase == "playing" and scene.mercy > 0
    play(session, 300)
    assert scene.deaths >= 2, "the mercy must end"


def drop_crate(scene, x, bottom, speed):
    """Drop the largest crate at (x, bottom) and return its body; its lower edge starts 20 px above the point."""
    crate = max(scene.things.crates, key=lambda one: one.size).body
    crate.move_to((x, bottom - 20 - 16), 0.0)
    crate.velocity = (0.0, speed)
    return crate


@pytest.mark.parametrize("kind", ["walker", "hedgehog"])
def test_a_crate_flattens_by_its_impulse_and_not_when_it_is_set_down(kind):
    for speed, alive in ((0.0, True), (400.0, False)):
        scene, session = start()
        enemy = enemy_of(scene, kind)
        put(scene, enemy.character.position[0] - 120, enemy.bottom)
        x, _ = enemy.character.position
        drop_crate(scene, x, enemy.top - (0 if speed else -15), speed)
        play(session, 20)
        assert (enemy.body.id in scene.things.enemies) == alive


def test_a_crate_that_comes_down_on_the_hero_hurts_him():
    scene, session = start()
    drop_crate(scene, scene.hero.character.position[0], scene.hero.box[1], 400.0)
    play(session, 20)
    assert scene.deaths == 1


def test_sound_and_dust_of_a_crate_grow_with_the_impulse_of_its_hit():
    loud, dusty = [], []
    for speed in (100.0, 250.0, 500.0):
        scene, session = start()
        put(scene, 60, 320)
        drop_crate(scene, 200, 320, speed)
        before, heard = scene.particles.count, []
        for _ in range(12):
            session.step()
            heard += [volume for name, _, volume in scene.cues if name == "crate"]
        loud.append(max(heard))
        dusty.append(scene.particles.count - before)
    assert loud == sorted(loud) and loud[0] < 0.7 * loud[2]
    assert dusty[0] < dusty[2]


def test_crates_on_a_lift_go_home_to_where_the_lift_is():
    scene, session = start()
    crate = next(crate for crate in scene.things.crates if scene.things.decks[crate.body.id] is not None)
    deck = scene.things.decks[crate.body.id]
    play(session, 100)
    crate.body.move_to((300.0, 200.0), 0.5)
    scene.things.go_home()
    assert crate.box[3] == pytest.approx(deck.box[1], abs=1)
    assert deck.box[0] <= crate.body.position[0] <= deck.box[2]


def test_the_goal_stops_the_clock_and_the_result_comes_once():
    scene, session = start([""] * 150 + ["jump"] + [""] * 5)
    goal = scene.things.of("goal")[0]
    put(scene, goal.x, goal.foot[1])
    play(session, 3)
    assert scene.phase == "won" and scene.result is None
    clock = scene.clock
    play(session, steps(APPLAUSE))
    result = scene.result
    assert result.won and result.seconds == pytest.approx(clock / 60) and len(result.lines) == 3
    play(session, 100)
    assert scene.result is result and scene.phase == "won" and scene.clock == clock and scene.hero.grounded


def test_the_trail_has_a_row_for_each_step_and_the_ghost_is_drawn_whatever_it_says():
    scene, session = start(["right"] * 60)
    play(session, 60)
    assert len(scene.trail) == scene.clock == 60
    x, bottom, name, way = scene.trail[-1]
    assert (x, bottom) == (scene.hero.character.position[0], scene.hero.box[3]) and (name, way) == hero_frame(scene)
    canvas = Canvas()
    scene.look.act_age = 9.0
    scene.draw(canvas, 1.0)
    alone = canvas.surface.copy()
    for frame in ("run_0", "no_such_frame"):
        scene.ghost = [(x - 30, bottom, frame, -1)] * 80
        scene.draw(canvas, 1.0)
        assert canvas.surface.get_buffer().raw != alone.get_buffer().raw
    for ghost in ([], [(x, bottom, "run_0", 1)]):
        scene.ghost = ghost
        scene.draw(canvas, 1.0)
        assert canvas.surface.get_buffer().raw == alone.get_buffer().raw


def test_a_ghost_reports_the_time_at_a_checkpoint():
    scene, session = start()
    x, bottom = scene.checkpoints[0].foot
    scene.ghost = [(0.0, 0.0, "idle_0", 1)] * 100 + [(x, bottom, "run_0", 1)]
    put(scene, x, bottom)
    play(session, 2)
    behind, _ = scene.look.split
    assert behind == pytest.approx((1 - 101) / 60, abs=0.02)


def test_signs_counters_and_titles_never_overlap_or_leave_the_picture():
    scene, session = start()
    canvas = Canvas()
    for sign in scene.level.map.things_of("sign"):
        put(scene, sign.x, sign.y + sign.height)
        scene.mercy, scene.since, scene.touched = 600, 60, set()
        scene.look.split = (-1.25, 0.0)
        session.step()
        scene.look.act_age = 1.0
        canvas.begin()
        scene.draw(canvas, 0.5)
        if scene.phase != "playing":
            continue
        words = sign.properties["text"]
        assert any(text in words for _, text in canvas.boxes), words
        rects = [rect for rect, _ in canvas.boxes]
        assert all(canvas.rect.contains(rect) for rect in rects)
        assert not any(a.colliderect(b) for i, a in enumerate(rects) for b in rects[:i])
    assert scene.deaths == 0


def test_covered_rooms_are_seen_from_inside_only():
    scene, session = start()
    gem = scene.things.of("secret")[0]
    assert scene.look.hidden(gem.x, gem.y)
    put(scene, gem.x - 30, gem.y + 8)
    play(session, 40)
    assert not scene.look.hidden(gem.x, gem.y) and max(scene.look.open) > 0.9
    put(scene, 100, 320)
    play(session, 60)
    assert scene.look.hidden(gem.x, gem.y)


def test_every_thing_of_the_level_is_met():
    level = level_of()
    scene, _ = start()
    for kind in ("coin", "secret", "spring", "spikes", "checkpoint", "goal", "ladder"):
        assert len(scene.things.of(kind)) == len(level.map.things_of(kind)) > 0
    for kind in ("walker", "hedgehog", "bat"):
        assert sum(enemy.kind == kind for enemy in scene.things.enemies.values()) == len(level.map.things_of(kind)) > 0
    assert len(scene.things.of("secret")) == 4 and 6 <= len(scene.checkpoints) <= 9
    assert (level.map.columns, level.map.rows) >= (240, 40) and level.map.rows >= 40


def test_what_the_scene_declares_is_what_it_uses():
    scene, _ = start()
    assert scene.effects.names() == [
        "narrowphase",
        "response",
        "gravity",
        "rotation",
        "friction",
        "stacking",
        "continuous",
        "sleeping",
        "sensors",
        "one_way",
        "conveyor",
        "carving",
    ]
