"""Objects and enemies of the platformer: ladders, belts, crumbling stones, springs, lifts and the three enemies."""

import pytest

from scenes.platformer import feel
from scenes.platformer.enemies import DIVE, Bat, Walker
from scenes.platformer.feel import HEIGHT, steps
from scenes.platformer.things import GONE, SHAKES
from tests.scenes.hero_stage import Stage, thing

FLAT = ".................\n" * 8 + "#################\n"
SHAFT = "........\n" * 3 + "###-####\n" + "........\n" * 6 + "########\n"


def ladder_stage():
    """Return a stage with a ladder from the floor at row 10 up through a plank at row 3, and the hero at its foot."""
    stage = Stage(SHAFT, 1, [thing("ladder", 48, 48, 16, 112)])
    stage.hero.place((56, 160 - HEIGHT / 2))
    stage.run("", 3)
    return stage


def test_he_climbs_up_stands_on_its_top_and_climbs_down_again():
    stage = ladder_stage()
    start = stage.hero.box[3]
    stage.run("up", 20)
    assert stage.hero.ladder is not None and start - stage.hero.box[3] == pytest.approx(
        20 * feel.CLIMB_SPEED / 60, abs=4
    )
    stage.run("", 30)
    assert stage.hero.ladder is not None, "without keys he holds on"
    stage.until("up", lambda hero: hero.ladder is None)
    assert stage.hero.box[3] == 48 and stage.hero.grounded
    stage.run("up", 20)
    assert stage.hero.box[3] == 48 and stage.hero.ladder is None
    stage.run("down", 10)
    assert stage.hero.ladder is not None and stage.hero.box[3] > 48
    stage.until("down", lambda hero: hero.ladder is None)
    assert stage.hero.box[3] == 160 and stage.hero.grounded


def test_a_jump_leaves_the_ladder_and_so_does_a_step_aside():
    stage = ladder_stage()
    stage.run("up", 20)
    high = stage.hero.box[3]
    stage.run("right jump", 12)
    assert stage.hero.ladder is None and stage.hero.box[3] < high and stage.hero.vx > 100
    stage = ladder_stage()
    stage.run("up", 20)
    stage.run("left", 3)
    assert stage.hero.ladder is None and stage.hero.vx < 0


def test_a_ladder_is_not_grabbed_from_beside_nor_without_up():
    stage = ladder_stage()
    stage.hero.place((90, 160 - HEIGHT / 2))
    stage.run("up", 10)
    assert stage.hero.ladder is None
    stage.hero.place((56, 160 - HEIGHT / 2))
    stage.run("right", 4)
    assert stage.hero.ladder is None


@pytest.mark.parametrize("speed", [60.0, -60.0])
def test_a_belt_carries_him_and_a_crate_and_lends_its_speed_to_a_jump(speed):
    things = [thing("belt", 64, 128, 160, 16, speed=speed), thing("crate", 128, 96, 32, 32)]
    stage = Stage("....................\n" * 9 + "####################\n", 1, things)
    stage.hero.place((112 if speed < 0 else 180, 128 - HEIGHT / 2))
    stage.run("", 20)
    x, crate = stage.hero.character.position[0], stage.crates[0].body.position[0]
    stage.run("", 30)
    assert stage.hero.character.position[0] - x == pytest.approx(speed / 2, abs=2)
    assert stage.crates[0].body.position[0] - crate == pytest.approx(speed / 2, abs=3)
    stage.run("jump")
    assert stage.hero.vx == pytest.approx(speed, abs=1)


STONE = thing("crumble", 96, 112, 32, 16)


def test_a_stone_breaks_half_a_second_after_the_first_foot_and_comes_back():
    stage = Stage(FLAT, 2, [STONE])
    stone = stage.crumbles[0]
    stage.hero.place((112, 112 - HEIGHT / 2))
    stage.run("", 2)
    assert stage.hero.riding == stone.body
    stone.press()
    stage.run("", steps(SHAKES) - 2)
    assert stone.body is not None and stage.hero.box[3] == 112
    stage.run("", 4)
    assert stone.body is None and len(stone.bits) == 3
    stage.until("", lambda hero: hero.grounded)
    assert stage.hero.box[3] == 128
    stage.run("right", 40)
    stage.run("", steps(GONE))
    assert stone.body is not None and stone.box == stone.whole and not stone.bits


def test_a_stone_does_not_come_back_into_somebody():
    stage = Stage("........\n" * 8 + "########\n", 2, [thing("crumble", 48, 112, 32, 16)])
    stone = stage.crumbles[0]
    stage.hero.place((64, 112 - HEIGHT / 2))
    stage.run("", 1)
    stone.press()
    stage.run("", steps(SHAKES) + steps(GONE) + 60)
    assert stone.body is None, "he stands where it was"
    stage.run("left", 30)
    assert stone.body is not None


def test_a_crate_on_a_spring_flies_as_high_as_the_hero():
    stage = Stage("............\n" * 14 + "############\n", 8, [thing("crate", 32, 192, 32, 32)])
    stage.run("", 30)
    crate = stage.crates[0]
    start = crate.body.position[1]
    crate.launch()
    highest = min(stage.run("") and crate.body.position[1] for _ in range(40))
    assert start - highest == pytest.approx(feel.SPRING_SPEED**2 / (2 * feel.GRAVITY), rel=0.06)


def test_a_crate_thrown_from_below_comes_through_planks_and_lands_on_them():
    planks = "............\n" * 6 + "..-----.....\n" + "............\n" * 5 + "############\n"
    stage = Stage(planks, 10, [thing("crate", 48, 160, 32, 32)])
    stage.run("", 20)
    stage.crates[0].launch()
    stage.run("", 160)
    assert stage.crates[0].box[3] == pytest.approx(96, abs=1)


def test_a_lift_carries_hero_crate_and_walker_together():
    things = [thing("platform", 32, 112, 96, 16, to_x=32, to_y=32, period=6.0), thing("crate", 90, 80, 32, 32)]
    stage = Stage("................\n" * 8 + "################\n", 12, things)
    stage.hero.place((80, 112 - HEIGHT / 2))
    walker = Walker(stage.world, thing("walker", 36, 96, 20, 16, range=0), 1)
    for _ in range(150):
        walker.step(stage.hero.character.position)
        stage.run("")
    top = stage.platforms[0].box[1]
    assert top < 60
    assert stage.hero.box[3] == pytest.approx(top, abs=1) and walker.bottom == pytest.approx(top, abs=1)
    assert stage.crates[0].box[3] == pytest.approx(top, abs=1)


def walk(stage, walker, count):
    for _ in range(count):
        walker.step(stage.hero.character.position)
        stage.run("")


def test_a_walker_turns_at_a_crate_and_does_not_push_it():
    stage = Stage(FLAT, 2, [thing("crate", 160, 112, 16, 16)])
    walker = Walker(stage.world, thing("walker", 120, 112, 20, 16, range=64), 1)
    walk(stage, walker, 120)
    assert walker.way == -1 and stage.crates[0].body.position[0] == pytest.approx(168, abs=0.01)


@pytest.mark.parametrize("kind", ["walker", "hedgehog"])
def test_a_walker_turns_at_its_range_and_at_walls(kind):
    stage = Stage("#......#\n" * 3 + "########\n", 3)
    size = (20, 16) if kind == "walker" else (20, 14)
    walker = Walker(stage.world, thing(kind, 64, 48 - size[1], *size, range=24), 1)
    seen = set()
    for _ in range(400):
        walk(stage, walker, 1)
        seen.add(walker.character.position[0])
    assert max(seen) == pytest.approx(74 + 24, abs=1) and min(seen) == pytest.approx(74 - 24, abs=1)
    assert walker.place_after(0.0) == walker.character.position[0]
    assert walker.stompable == (kind == "walker")


def test_a_walker_falls():
    stage = Stage(FLAT, 2)
    walker = Walker(stage.world, thing("walker", 120, 40, 20, 16, range=16), 1)
    walk(stage, walker, 60)
    assert walker.bottom == 128


def test_a_bat_hangs_until_it_is_woken_dives_to_his_height_and_goes_back():
    stage = Stage("####################\n" + "....................\n" * 9 + "####################\n", 10)
    bat = Bat(stage.world, thing("bat", 100, 16, 20, 14))
    seen = (40.0, 150.0)
    for _ in range(20):
        assert not bat.step(seen)
    assert bat.phase == "hanging"
    bat.seen = True
    assert bat.step(seen), "it tells that it wakes"
    for _ in range(steps(DIVE)):
        bat.step(seen)
    assert bat.character.position[1] == pytest.approx(150, abs=3) and bat.character.position[0] < 110
    for _ in range(600):
        if bat.phase == "hanging":
            break
        bat.seen = False
        bat.step(seen)
    assert bat.phase == "hanging" and bat.character.position[1] < 30
