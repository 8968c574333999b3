"""Each move of the platformer's hero on a few tiles, and the objects that it pushes, rides or meets."""

import pytest

from scenes.platformer import feel
from scenes.platformer.feel import HEIGHT, steps
from scenes.platformer.view import lowered
from tests.scenes.hero_stage import Stage, thing

FLAT = ".................\n" * 8 + "#################\n"


def apex(stage, keys, hold):
    """Return the height of a jump [px] with jump held for `hold` steps."""
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
    stage.hero.place((4 * 16 - 5 + 6, 7 * 16 - HEIGHT / 2))  # six pixels under the roof
    stage.run("", 2)
    assert apex(stage, "", 40) > 50 and "bump" not in stage.news
    stage = Stage(roof, 6)
    stage.hero.place((6 * 16 + 8, 7 * 16 - HEIGHT / 2))
    stage.run("", 2)
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
    stage.hero.place((6 * 16 - 5 - 4, 150))  # four pixels from the wall
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
        stage.until("right" if side > 0 else "left", lambda hero, side=side: hero.wall == side and hero.vy > 0)
        stage.run("jump", 1)
        stage.until("jump " + ("left" if side > 0 else "right"), lambda hero, side=side: hero.wall == -side)
    assert start - stage.hero.box[3] > 120
    lone = Stage("..........#\n" * 30 + "###########\n", 9)
    start = lone.hero.box[3]
    lone.run("right jump", 14)
    kicks = []
    for _ in range(5):
        lone.until("right jump", lambda hero: hero.vy >= 0)
        lone.until("right", lambda hero: hero.wall == 1 or hero.grounded)
        lone.run("right jump")
        kicks.append(start - lone.hero.box[3])
    assert kicks == sorted(kicks, reverse=True) and kicks[-1] < kicks[0]


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


def test_feet_that_are_nearly_up_through_a_plank_are_helped_up():
    """A jump that is 1 to 12 px too low at its highest point still ends on the plank."""
    tall = ".......\n.......\n..---..\n" + ".......\n" * 6 + "#######\n"
    reached = {}
    for short in (3, 30):
        stage = Stage(tall, 3)
        stage.hero.place((56, 32 + 46 + short - HEIGHT / 2))  # a jump from the air: as high as if from ground
        stage.hero.grounded, stage.hero.coyote = False, 3
        stage.run("jump", 40)
        stage.run("", 12)
        reached[short] = stage.hero.box[3] == 32
    assert reached == {3: True, 30: False}


def test_a_ceiling_met_at_once_only_delays_a_jump():
    low = "..........\n" * 5 + "....##....\n" + "..........\n..........\n##########\n"
    stage = Stage(low, 4)
    stage.hero.place((5 * 16, 6 * 16 + HEIGHT / 2))  # his head at the ceiling
    stage.hero.rise = steps(feel.JUMP_HOLD) + 1
    stage.hero._bump(-3.0)
    assert stage.hero.rise == steps(feel.JUMP_HOLD) + 1, "within the grace the hold goes on"
    stage.hero.rise = 4
    stage.hero._bump(-3.0)
    assert stage.hero.rise == 0


SLOPE = "...........\n" * 3 + "....../####\n" + "...../#####\n" + "..../######\n" + "###########\n"


def test_the_speed_is_along_the_slope_and_the_feet_are_drawn_on_it():
    stage = Stage(SLOPE, 1)
    stage.until("right", lambda hero: hero.slope == 1.0)
    stage.run("right", 3)
    x = stage.hero.box[0]
    stage.run("right", 6)
    assert stage.hero.slope == 1.0 and 11 <= stage.hero.box[0] - x <= 14  # 18 px of way, 12.7 along x
    assert lowered(stage.level, stage.hero) == 5.0
    stage.until("right", lambda hero: hero.slope == 0.0)
    stage.run("right", 5)
    assert lowered(stage.level, stage.hero) == 0.0
    while stage.hero.box[0] > 40:
        assert stage.run("left").grounded, f"left the ground at {stage.hero.box}"


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


def test_who_is_squeezed_by_a_corner_alone_slips_out():
    press = thing("platform", 48, 32, 48, 16, to_x=48, to_y=112, period=2.0)
    stage = Stage("........\n" * 9 + "########\n", 1, [press])
    stage.hero.place((48 - 5 + 6, 9 * 16 - HEIGHT / 2))  # six pixels under it
    for _ in range(120):
        assert not stage.run("").crushed
    assert stage.hero.box[2] == 48
    stage.hero.place((72, 9 * 16 - HEIGHT / 2))
    stage.until("", lambda hero: hero.crushed)


def test_a_crate_is_pushed_slowly_and_falls():
    box = thing("crate", 80, 48, 32, 32)
    wide = 24  # it may roll over once more: there is floor for it
    air = "." * wide + "\n"
    stage = Stage(air * 5 + "#######" + "." * (wide - 7) + "\n" + air * 3 + "#" * wide + "\n", 2, [box])
    stage.until("right", lambda hero: hero.pushing)
    stage.run("right", 4)
    x = stage.crates[0].box[0]
    stage.run("right", 30)
    assert stage.crates[0].box[0] - x == pytest.approx(0.8 * feel.PUSH_SPEED / 2, abs=4)
    stage.until("right", lambda hero: stage.crates[0].body.position[1] > 8 * 16 - 17)
    stage.run("", 150)
    assert stage.crates[0].box[3] == 9 * 16 and not stage.crates[0].body.awake


def test_two_crates_on_each_other_are_too_heavy_and_one_alone_is_not():
    moved = []
    for count in (1, 2):
        stage = Stage(FLAT, 2, [thing("crate", 96, 96 - 32 * k, 32, 32) for k in range(count)])
        stage.run("right", 120)
        moved.append(stage.crates[0].body.position[0] - 112)
    assert moved[0] > 60 and abs(moved[1]) < 0.5 and stage.hero.vx == 0.0


FLAT_LOW = "............\n" * 7 + "############\n"


def test_a_crate_that_falls_on_his_head_is_held_up_by_it():
    stage = Stage(FLAT_LOW, 2, [thing("crate", 24, 50, 32, 32)])
    stage.run("", 60)
    assert stage.crates[0].box[3] == pytest.approx(stage.hero.box[1], abs=1) and not stage.hero.crushed
    stage.until("right", lambda hero: hero.box[0] > 66)
    stage.run("", 60)
    assert stage.crates[0].box[3] == 7 * 16


def test_he_rides_a_crate_on_a_platform_and_jumps_off_with_its_speed():
    ferry = thing("platform", 32, 112, 48, 16, to_x=160, to_y=112, period=4.0)
    stage = Stage("................\n" * 8 + "################\n", 2, [ferry, thing("crate", 40, 80, 32, 32)])
    stage.hero.place((56, 80 - HEIGHT / 2))
    stage.run("", 60)
    crate = stage.crates[0].body
    assert stage.hero.riding == crate and abs(crate.angle) < 0.01
    assert crate.position[0] == pytest.approx(stage.platforms[0].body.position[0], abs=2)
    assert stage.hero.character.position[0] == pytest.approx(crate.position[0], abs=2.5)
    speed = crate.velocity[0]
    stage.run("jump")
    assert stage.hero.vx == pytest.approx(speed, rel=0.2) and speed > 60
