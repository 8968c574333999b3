"""The platformer: each move of the hero on a few tiles, the rules of the scene, and the bot on three seeds."""

import numpy as np
import pytest

import physics
from game.digest import scene_digest
from game.draw import Canvas
from game.inputs import BotSource, InputFrame, InputState, ScriptSource
from game.run_report import judge
from game.session import Session
from game.tilemap import Thing, TileMap
from physics import Effects, World
from scenes.platformer import hero as feel
from scenes.platformer.hero import HEIGHT, Hero, steps
from scenes.platformer.level import Level, load_level
from scenes.platformer.scene import Platformer
from scenes.platformer.things import Crate, Platform, Walker
from scenes.platformer.view import lowered

TILES = {"#": 0, "-": 1, "/": 2, "\\": 3, "1": 4, "2": 5}
PROPERTIES = {0: {"kind": "solid"}, 1: {"kind": "one_way"}, 2: {"kind": "slope", "left": 0.0, "right": 1.0},
              3: {"kind": "slope", "left": 1.0, "right": 0.0}, 4: {"kind": "slope", "left": 0.0, "right": 0.5},
              5: {"kind": "slope", "left": 0.5, "right": 1.0}}


class Stage:
    """A few letters of level with a hero in it; run(keys, steps) plays."""

    def __init__(self, text, x, things=()):
        rows = text.strip("\n").split("\n")
        numbers = np.array([[TILES.get(letter, -1) for letter in row] for row in rows])
        empty = np.full_like(numbers, -1)
        self.level = Level(TileMap("stage", numbers.shape[1], numbers.shape[0], 16, {"solid": numbers, "decor": empty},
                                   {}, PROPERTIES, "", 1, tuple(things), {}))
        self.world = World(Effects(response=True, one_way=True, sensors=True))
        self.level.add_to(self.world)
        floor = next(row for row in range(len(rows)) if rows[row][x] in "#-") * 16
        self.hero = Hero(self.world, self.level, (x * 16 + 8, floor - HEIGHT / 2))
        self.platforms = [Platform(self.world, thing) for thing in things if thing.kind == "platform"]
        self.crates = [Crate(self.world, thing) for thing in things if thing.kind == "crate"]
        self.inputs = InputState()
        self.frame = 0
        self.news = []
        self.run("", 2)
        self.news.clear()

    def run(self, keys, count=1):
        """Hold keys (a string of words) for some steps."""
        for _ in range(count):
            self.inputs.set(InputFrame(frozenset(keys.split())))
            for platform in self.platforms:
                platform.aim(self.frame)
            for crate in self.crates:
                crate.step(self.hero.box)
            self.hero.crates = tuple(crate.box for crate in self.crates)
            self.hero.solids = self.hero.crates + tuple(platform.box for platform in self.platforms)
            self.hero.step(self.inputs)
            self.news += self.hero.news
            self.world.step()
            self.frame += 1
        return self.hero

    def until(self, keys, met, most=200):
        """Hold keys until something is so."""
        for _ in range(most):
            self.run(keys)
            if met(self.hero):
                return self.hero
        raise AssertionError(f"not within {most} steps of {keys!r}: {self.hero.box}")


FLAT = ".................\n" * 8 + "#################\n"


def apex(stage, keys, hold):
    """How high a jump goes [px] with jump held for `hold` steps."""
    start = stage.hero.box[3]
    best = 0
    for step in range(60):
        stage.run(f"{keys} jump" if step < hold else keys)
        best = max(best, start - stage.hero.box[3])
    return best


def test_jump_heights_from_one_button():
    assert 8 <= apex(Stage(FLAT, 4), "", 1) <= 16
    assert 54 <= apex(Stage(FLAT, 4), "", 40) <= 60
    assert 20 < apex(Stage(FLAT, 4), "", 6) < 50


def test_full_speed_after_six_steps_and_stop():
    stage = Stage(FLAT, 2)
    assert stage.run("right", 6).vx == feel.RUN_SPEED
    assert stage.run("", 6).vx == 0.0


def test_a_running_jump_is_a_long_one():
    stage = Stage("....................\n" * 8 + "####################\n", 1)
    stage.run("right", 10)
    start = stage.hero.box[0]
    stage.until("right jump", lambda hero: "land" in hero.news)
    assert 7.2 * 16 < stage.hero.box[0] - start < 8.5 * 16


LEDGE = "...........\n" * 6 + "####.......\n" + "...........\n" * 6 + "###########\n"


@pytest.mark.parametrize("late, jumps", [(4, True), (8, False)])
def test_coyote_time(late, jumps):
    stage = Stage(LEDGE, 1)
    stage.until("right", lambda hero: not hero.grounded)
    stage.run("right", late)
    stage.run("right jump")
    assert ("jump" in stage.news) == jumps


@pytest.mark.parametrize("early, jumps", [(3, True), (9, False)])
def test_a_jump_pressed_just_before_the_landing_counts(early, jumps):
    rehearsal = Stage(FLAT, 4)
    rehearsal.run("jump", 30)
    wait = 0
    while not rehearsal.run("").grounded:
        wait += 1
    stage = Stage(FLAT, 4)
    stage.run("jump", 30)
    stage.run("", wait - early + 1)
    stage.news.clear()
    stage.run("jump", early + 3)
    assert ("jump" in stage.news) == jumps


def test_a_head_slips_past_a_corner_but_not_through_a_ceiling():
    roof = "........\n" * 3 + "....####\n" + "........\n" * 3 + "########\n"
    stage = Stage(roof, 3)
    stage.hero.character.move_to((4 * 16 - 5 + 6, 7 * 16 - HEIGHT / 2))      # six pixels under the roof
    stage.run("")
    assert apex(stage, "", 40) > 50 and "bump" not in stage.news
    stage = Stage(roof, 6)
    assert apex(stage, "", 40) < 40 and "bump" in stage.news


WALLS = "#.....#\n" * 20 + "#######\n"


def test_a_wall_slows_the_fall_and_the_grip_tires():
    stage = Stage(WALLS, 5)
    stage.hero.place((6 * 16 - 5, 40))
    speeds = [stage.run("right").vy for _ in range(40)]
    assert stage.hero.sliding == 1
    assert 0 < speeds[12] < 90 and speeds[39] > speeds[12]
    free = Stage(WALLS, 3)
    free.hero.place((56, 40))
    assert free.run("", 20).vy > 250


def test_a_wall_jump_turns_away_and_reaches_a_little():
    stage = Stage(WALLS, 5)
    stage.hero.place((6 * 16 - 5 - 4, 150))         # four pixels from the wall
    stage.run("", 2)
    hero = stage.run("right jump")
    assert "wall_jump" in stage.news and hero.vx == -feel.WALL_JUMP_SPEED and hero.facing == -1
    stage.run("right jump", steps(feel.WALL_JUMP_TIME) - 2)
    assert stage.hero.vx < -100.0, "the keys turned back too early"


def test_kicking_from_wall_to_wall_leads_up_and_one_wall_alone_does_not():
    stage = Stage("#..#\n" * 30 + "####\n", 1)
    start = stage.hero.box[3]
    stage.run("right jump", 14)
    for _ in range(6):
        side = stage.hero.wall or 1
        stage.until("right" if side > 0 else "left", lambda hero: hero.wall == side and hero.vy > 0)
        stage.run("jump", 1)
        stage.until("jump " + ("left" if side > 0 else "right"), lambda hero: hero.wall == -side)
    assert start - stage.hero.box[3] > 120
    lone = Stage("..........#\n" * 30 + "###########\n", 9)
    start = lone.hero.box[3]
    best = 0
    for _ in range(8):
        lone.run("right jump", 30)
        lone.until("right", lambda hero: hero.grounded or hero.wall == 1 and hero.vy > 0)
        best = max(best, start - lone.hero.box[3])
    assert best < 100


PLANKS = ".......\n.......\n..---..\n.......\n.......\n#######\n"


def test_planks_are_open_from_below_and_by_down_and_jump():
    stage = Stage(PLANKS, 3)
    stage.hero.place((56, 5 * 16 - HEIGHT / 2))
    stage.run("", 3)
    stage.until("jump", lambda hero: hero.grounded, 60)
    assert stage.hero.box[3] == 32
    stage.run("", 2)
    stage.run("down", 20)
    assert stage.hero.box[3] == 32, "down alone must not drop"
    stage.run("down jump")
    stage.until("", lambda hero: hero.grounded, 60)
    assert "drop" in stage.news and stage.hero.box[3] == 80
    stage.run("", 2)
    stage.run("down jump", 4)
    assert "jump" in stage.news and stage.hero.box[3] < 80, "on solid ground down and jump is a jump"


SLOPE = "...........\n" * 3 + "....../####\n" + "...../#####\n" + "..../######\n" + "###########\n"


def test_the_speed_is_along_the_slope_and_the_feet_are_drawn_on_it():
    stage = Stage(SLOPE, 1)
    stage.until("right", lambda hero: hero.slope == 1.0)
    stage.run("right", 3)
    x = stage.hero.box[0]
    stage.run("right", 6)
    assert stage.hero.slope == 1.0 and 11 <= stage.hero.box[0] - x <= 14       # 18 px of way, 12.7 along x
    assert lowered(stage.level, stage.hero) == 5.0
    stage.until("right", lambda hero: hero.slope == 0.0)
    stage.run("right", 5)
    assert lowered(stage.level, stage.hero) == 0.0
    while stage.hero.box[0] > 40:
        assert stage.run("left").grounded, f"left the ground at {stage.hero.box}"


def thing(kind, x, y, width, height, **properties):
    return Thing(kind, "", x, y, width, height, properties)


def test_a_platform_carries_and_lends_its_speed():
    ferry = thing("platform", 32, 112, 48, 16, to_x=160, to_y=112, period=4.0)
    stage = Stage("................\n" * 8 + "################\n", 2, [ferry])
    stage.hero.place((56, 112 - HEIGHT / 2))
    stage.run("", 60)
    body = stage.platforms[0].body
    assert stage.hero.riding == body and stage.hero.vx == 0.0
    assert stage.hero.character.position[0] == pytest.approx(body.position[0], abs=1.0)
    speed = body.velocity[0]
    stage.run("jump")
    assert stage.hero.vx == pytest.approx(speed, rel=0.2) and speed > 60


def test_a_platform_against_a_wall_squeezes():
    ferry = thing("platform", 32, 96, 48, 16, to_x=80, to_y=96, period=1.0)
    stage = Stage("........#\n" * 7 + "#########\n", 7, [ferry])
    stage.hero.place((8 * 16 - 5, 7 * 16 - HEIGHT / 2))
    for _ in range(60):
        if stage.run("").crushed:
            return
    raise AssertionError("never squeezed")


def test_a_crate_is_pushed_slowly_and_falls():
    box = thing("crate", 80, 48, 32, 32)
    stage = Stage("............\n" * 5 + "#######.....\n" + "............\n" * 3 + "############\n", 2, [box])
    stage.until("right", lambda hero: hero.pushing)
    stage.run("right", 4)
    x = stage.crates[0].box[0]
    stage.run("right", 30)
    assert stage.crates[0].box[0] - x == pytest.approx(feel.PUSH_SPEED / 2, abs=3)
    stage.until("right", lambda hero: stage.crates[0].box[3] == 9 * 16)
    assert stage.crates[0].landed


def test_a_crate_waits_over_a_head():
    box = thing("crate", 32, 16, 32, 32)
    stage = Stage("......\n" * 7 + "######\n", 2, [box])
    stage.crates[0].landed = False
    stage.run("", 60)
    assert stage.crates[0].box[3] == stage.hero.box[1]
    stage.until("right", lambda hero: hero.box[0] >= 64)
    stage.run("right", 40)
    assert stage.crates[0].box[3] == 7 * 16


def test_a_walker_turns_at_its_range_and_at_walls():
    stage = Stage("#......#\n" * 3 + "########\n", 3)
    walker = Walker(stage.world, thing("walker", 64, 32, 20, 16, range=24), 1)
    seen = set()
    for _ in range(300):
        walker.step()
        seen.add(walker.character.position[0])
    assert max(seen) == pytest.approx(74 + 24, abs=1) and min(seen) == pytest.approx(74 - 24, abs=1)
    assert walker.place_after(0.0) == walker.character.position[0]


# --- the scene -----------------------------------------------------------------------------------------------------------


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
    assert scene.effects.names() == ["narrowphase", "response", "sensors", "one_way"]


@pytest.mark.skipif(not physics.JIT, reason="a minute of play takes long without compiled kernels")
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_bot_reaches_the_goal_in_a_minute(seed):
    scene = Platformer(seed=seed)
    session = Session(scene, BotSource())
    play(session, 3600)
    check = judge(scene, 3600)
    assert check["ok"], check["failures"]
    assert scene.inside_solid == 0 and scene.deaths == 0


@pytest.mark.skipif(not physics.JIT, reason="as above")
def test_seeds_differ_by_their_walkers():
    digests = set()
    for seed in (1, 2, 3):
        scene = Platformer(seed=seed)
        play(Session(scene, BotSource()), 30)
        digests.add(scene_digest(scene))
    assert len(digests) > 1
