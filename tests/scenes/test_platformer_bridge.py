"""The rope bridge: the hero jumps up through it, stands, walks its curve and drops; its picture equals its shape."""

from game.run.session import Session
from game.run.sources import IdleSource
from scenes.platformer.scene import Platformer
from tests.scenes.hero_stage import Stage, thing

FLAT = "\n".join(["." * 16] * 9 + ["#" * 16])
LEFT, TOP = 64, 80  # [px] of the bridge: its middle is 50 px above the floor, he jumps 57


def stage(x=8, *more):
    return Stage(FLAT, x, [thing("bridge", LEFT, TOP, 128, 32), *more])


def feet(hero):
    return hero.box[3]


def on_it(hero, bridge):
    left, _, right, bottom = hero.box
    return hero.grounded and bridge.bears(left, right, bottom)


def test_he_jumps_up_through_it_and_stands():
    play = stage()
    (bridge,) = play.bridges
    hero = play.until("jump", lambda one: feet(one) < 100 or one.vy > 0)
    assert not hero.grounded and "bump" not in play.news
    hero = play.until("", lambda one: one.grounded)
    assert on_it(hero, bridge) and feet(hero) < 96


def test_he_walks_its_curve_to_its_end():
    play = stage()
    (bridge,) = play.bridges
    play.until("jump", lambda one: one.vy >= 0)
    hero = play.until("", lambda one: one.grounded)
    heights = [feet(hero)]
    while hero.box[2] < LEFT + 128:
        hero = play.run("right")
        assert on_it(hero, bridge) and hero.vx > 0
        heights.append(feet(hero))
    assert heights == sorted(heights, reverse=True) and heights[0] - heights[-1] >= 10
    assert abs(heights[-1] - TOP) <= 3
    play.run("right", 6)
    play.until("right", lambda one: one.grounded)
    assert feet(hero) == 144


def test_he_drops_through_and_comes_in_from_a_side():
    play = stage()
    (bridge,) = play.bridges
    play.until("jump", lambda one: one.vy >= 0)
    hero = play.until("", lambda one: one.grounded)
    play.run("down jump")
    assert "drop" in play.news
    hero = play.until("", lambda one: one.grounded)
    assert feet(hero) == 144 and not on_it(hero, bridge)
    # A jump beside its end, feet below the boards: nothing stops him.
    play = stage(2)
    play.run("jump", 12)
    hero = play.until("jump right", lambda one: one.box[2] > LEFT + 4, 60)
    assert hero.wall == 0 and hero.vx > 100


def test_a_crate_falls_onto_it_and_stays():
    play = stage(2, thing("crate", LEFT + 56, 20, 16, 16))
    play.run("", 180)
    (crate,) = play.crates
    left, _, right, bottom = crate.box
    assert play.bridges[0].bears(left, right, round(bottom))
    assert crate.body.velocity.length < 1.0


def test_the_level_has_one_whose_ends_are_planks():
    scene = Platformer()
    Session(scene, IdleSource())
    (bridge,) = scene.things.bridges
    right = bridge.left + len(bridge.heights)
    for x in (bridge.left - 8, right + 8):
        assert scene.level.kind_at(x, bridge.top + 2) == "one_way"
    assert bridge.heights[0] == bridge.heights[-1] == bridge.top
    assert bridge.body.shapes[0].one_way
    # From the ground below he can reach its middle: 57 px is what he jumps.
    middle = (bridge.left + right) // 2
    ground = scene.level.drop_to_ground(middle, bridge.top, 200) + bridge.top
    assert ground - bridge.heights.max() < 57
