"""Rules of the shooter: exact shapes decide hits, no side hits its own, core and hull, bombs, grazes, pick-ups."""

import numpy as np
import pytest

import physics
from game.drawing.sprites import load_atlas
from game.run.session import Session
from game.run.sources import BotSource
from physics import debug
from scenes.shooter.bomb import BURN, LEADER_DAMAGE, REACH
from scenes.shooter.bullets import NAMES, mask_of
from scenes.shooter.cast import BLAST, BULLET, CORE, ENEMY, HULL, ITEM, RING, SHOT
from scenes.shooter.plane import BANKS, BOMBS, BORDER, CORE_RADIUS, LIVES, MOST_BOMBS, RING_RADIUS, VOLLEYS
from scenes.shooter.scene import FREEZE, LAST_MOMENT, Shooter
from tests.scenes.shooter_stages import Sky

MEET = {
    CORE | ENEMY,
    CORE | BULLET,
    HULL | ENEMY,
    HULL | BULLET,
    RING | BULLET,
    RING | ITEM,
    SHOT | ENEMY,
    BLAST | ENEMY,
    BLAST | BULLET,
}
HULL_HURTS = (("slider:hurts", 1),)


def hull_sky(**chosen):
    """Return a `Sky` in which hits anywhere on the plane's hull count, not only those on its small core."""
    sky = Sky(**chosen)
    sky.step(1, changes=HULL_HURTS)
    return sky


def offsets(shares):
    """Return the offset (dx, dy) of a dart from the plane at which their boxes overlap most [px].

    shares: whether the two masks must share pixels at this offset, or must share none.
    """
    planes = load_atlas("planes")
    mine, other = planes.mask("player"), planes.mask("dart_0")
    left, top, right, bottom = (int(edge) for edge in mine.bounds)
    found = []
    for dx in range(-26, 27):
        for dy in range(-26, 27):
            x0, y0, x1, y1 = (int(edge) for edge in other.bounds)
            wide = min(right, x1 + dx) - max(left, x0 + dx)
            high = min(bottom, y1 + dy) - max(top, y0 + dy)
            if wide > 0 and high > 0 and (share_pixels(mine, other, dx, dy) > 0) == shares:
                found.append((min(wide, high), dx, dy))
    return max(found)[1:]


def share_pixels(a, b, dx, dy):
    """Return the number of pixels that two masks share, b moved by whole pixels, counted on a large grid."""
    grids = []
    for mask, x, y in ((a, 0, 0), (b, dx, dy)):
        grid = np.zeros((128, 128), bool)
        left, top = 64 + x - int(mask.origin[0]), 64 + y - int(mask.origin[1])
        grid[top : top + mask.size[1], left : left + mask.size[0]] = mask.solid
        grids.append(grid)
    return int((grids[0] & grids[1]).sum())


def test_debris_grows_with_the_impulse_of_the_hit_and_flies_along_it():
    found = []
    for side in (0.0, 500.0):
        sky = Sky()
        dart = sky.enemy("dart", 240, 60)
        dart.health = 0.1
        dart.vx, dart.vy = 0.0, side
        sky.scene.shots.fire("shot", 240, 60 + 60 + 0.2 * side, [-np.pi / 2], 540.0)
        works = sky.scene.spectacle.works
        sky.until(lambda works=works: works.debris, 60)
        found.append(
            (sky.scene.blows.found, len(works.debris), sum(piece[4] for piece in works.debris) / len(works.debris))
        )
    blow, pieces = found[0][0], [each[1] for each in found]
    assert pieces[0] < pieces[1] and len(blow) == 2
    (ax, ay), (bx, by) = blow.values()
    assert (ax, ay) == (-bx, -by)
    assert found[0][2] < 25.0, "upwards, as the shot flew; thrown about alone they would fall"


def test_a_shot_hurts_as_much_as_its_impulse():
    lost = []
    for speed in (140.0, 540.0, 900.0):
        sky = Sky()
        gunship = sky.enemy("gunship", 240, 80)
        sky.scene.shots.fire("shot", 240, 140, [-np.pi / 2], speed)
        sky.until(lambda gunship=gunship: gunship.health < gunship.full, 60)
        lost.append(gunship.full - gunship.health)
    assert lost[0] < lost[1] < lost[2]
    assert lost[1] == pytest.approx(1.0, abs=0.2), "a plain shot, straight on, is the unit"


def test_boxes_that_overlap_without_pixels_are_no_hit_but_counted():
    sky = hull_sky()
    dx, dy = offsets(shares=False)
    x, y = sky.scene.plane.body.position
    sky.enemy("dart", x + dx, y + dy)
    sky.step(3)
    assert sky.scene.freeze == 0 and sky.scene.plane.lives == LIVES
    assert sky.scene.hits.count == {"core": 0, "hull": 0, "box": 1}


def test_the_same_place_is_a_hit_where_boxes_decide():
    sky = hull_sky(tier="aabb")
    dx, dy = offsets(shares=False)
    x, y = sky.scene.plane.body.position
    sky.enemy("dart", x + dx, y + dy)
    sky.step()
    assert sky.scene.freeze == FREEZE


def test_a_shared_pixel_is_a_hit_and_all_stands_still_to_show_it():
    sky = hull_sky()
    dx, dy = offsets(shares=True)
    x, y = sky.scene.plane.body.position
    dart = sky.enemy("dart", x + dx, y + dy)
    sky.step()
    assert sky.scene.freeze == FREEZE and sky.scene.hit_by == [dart.id]
    before = sky.scene.world.bodies[["x", "y"]].tolist()
    sky.step(FREEZE - 1)
    assert sky.scene.world.bodies[["x", "y"]].tolist() == before
    assert len(debug.mask_hits(sky.scene.world)) == 1
    sky.step(LAST_MOMENT + 1)
    assert sky.scene.plane.lives == LIVES - 1 and not sky.scene.plane.here
    assert not sky.scene.fleet.planes and not len(sky.scene.world.bodies), "what rammed you is gone too"


def test_core_and_hull_are_both_tested_and_only_the_chosen_one_hurts():
    for part, hurt in (("core", False), ("hull", True)):
        sky = hull_sky() if part == "hull" else Sky()
        x, y = sky.scene.plane.body.position
        sky.bullet("red", x + 10, y + 6)  # over the wing, beside the core
        sky.step()
        assert sky.scene.hits.count == {"core": 0, "hull": 1, "box": 1}
        assert (sky.scene.stricken > 0) == hurt
    sky = Sky()
    x, y = sky.scene.plane.body.position
    sky.bullet("red", x, y)
    assert sky.scene.hits.count == {"core": 1, "hull": 1, "box": 1} and sky.scene.stricken == LAST_MOMENT


def test_core_hull_and_ring_stay_together_and_the_core_is_small():
    sky = Sky()
    for actions in (("left",), ("left", "up"), ("down", "right", "focus"), ()):
        sky.step(15, actions)
        places = {tuple(body.position) for body in sky.scene.plane.bodies.values()}
        assert len(places) == 1
    assert CORE_RADIUS < RING_RADIUS / 4


def test_a_bullet_is_grazed_once_and_feeds_the_chain():
    sky = Sky()
    x, y = sky.scene.plane.body.position
    sky.bullet("red", x + 17, y)
    sky.step(5)
    assert sky.scene.score.grazes == 1 and sky.scene.score.chain == 1 and sky.scene.score.points > 0
    sky.step(20, ["left"])
    sky.step(24, ["right"])
    sky.step(8, ["left"])
    assert sky.scene.score.grazes == 1, "the same bullet again is no new graze"


def test_the_mask_of_the_frame_shown_is_the_mask_that_collides():
    sky, seen = Sky(), set()
    for action in ("left", "right"):
        for _ in range(14):
            sky.step(1, [action])
            plane = sky.scene.plane
            assert plane.body.shapes == (load_atlas("planes").mask(plane.frame),)
            seen.add(plane.frame)
    assert seen == set(BANKS)


def test_velocity_is_instant_diagonals_are_no_faster_and_a_border_is_kept():
    sky = Sky()
    sky.step(1, ["right"])
    vx = sky.scene.plane.velocity[0]
    assert vx > 0.0
    sky.step(1, ["right", "up"])
    assert np.hypot(*sky.scene.plane.velocity) == pytest.approx(vx)
    sky.step(1, ["right", "focus"])
    assert sky.scene.plane.velocity[0] == pytest.approx(vx / 2)
    sky.step(1)
    assert sky.scene.plane.velocity == (0.0, 0.0)
    sky.step(200, ["left", "down"])
    assert sky.scene.plane.body.position == pytest.approx((BORDER, 270 - BORDER))


def test_a_new_plane_is_a_ghost_for_a_while():
    sky = Sky()
    x, y = sky.scene.plane.body.position
    sky.bullet("red", x, y)
    sky.until(lambda: not sky.scene.plane.here, 20)
    away = sky.until(lambda: sky.scene.plane.here, 90)
    assert 55 <= away <= 65, "back after a second"
    sky.step(60)
    x, y = sky.scene.plane.body.position
    sky.bullet("red", x, y)
    lives = sky.scene.plane.lives
    safe = sky.until(lambda: not sky.scene.plane.ghost, 200)
    assert 80 <= safe <= 130 and sky.scene.plane.lives == lives, "150 steps after the flight into the picture"
    sky.step()
    assert sky.scene.stricken, "once it is no ghost, what lies over it hits it"


def test_a_lost_plane_costs_power_and_refills_bombs_and_leaves_something_to_catch():
    sky = Sky()
    sky.scene.plane.power, sky.scene.plane.bombs = 4, 1
    x, y = sky.scene.plane.body.position
    sky.bullet("red", x, y)
    sky.until(lambda: not sky.scene.plane.here, 20)
    assert sky.scene.plane.power == 2 and sky.scene.plane.bombs == BOMBS
    assert [item.what for item in sky.scene.loot.items.values()] == ["power"]
    assert not len(sky.scene.incoming) or not sky.step(1) and not len(sky.scene.incoming)


def test_a_bomb_in_the_last_moment_saves_the_plane():
    for wait, lives in ((LAST_MOMENT - 2, LIVES), (LAST_MOMENT + 1, LIVES - 1)):
        sky = Sky()
        x, y = sky.scene.plane.body.position
        sky.bullet("red", x, y)
        assert sky.scene.stricken
        sky.step(wait)
        sky.step(1, ["bomb"])
        sky.step(10)
        assert sky.scene.plane.lives == lives


def test_a_bomb_is_a_sensor_that_grows_burns_bullets_and_hurts_planes_once():
    sky = Sky()
    x, y = sky.scene.plane.body.position
    for dx in (-60, 60, 100):
        sky.scene.incoming.fire("purple", x + dx, y - 20, [0.0], 0.0)
    sky.scene.incoming.fire("purple", x - 200, y - 20, [0.0], 0.0)
    gunship, dart = sky.enemy("gunship", x, y - 90), sky.enemy("dart", x + 50, y - 60)
    sky.step(2)
    points = sky.scene.score.points
    sky.step(1, ["bomb"])
    body = sky.scene.bomb.body
    assert body.shapes[0].radius < 40 and sky.scene.plane.bombs == BOMBS - 1 and sky.scene.plane.ghost
    assert sky.scene.world.shapes["sensor"][sky.scene.world.shapes["body"] == body.id].all()
    sky.step(30)
    assert body.shapes[0].radius == REACH
    assert len(sky.scene.incoming) == 1, "the one out of reach is left"
    assert dart.id not in sky.scene.fleet.planes and 0 < gunship.health < gunship.full
    assert sky.scene.score.points > points
    health = gunship.health
    sky.step(BURN)
    assert gunship.health == health and sky.scene.bomb.body is None, "once, and then it is over"
    assert gunship.full - health < LEADER_DAMAGE


def test_one_shot_strikes_one_plane_and_is_gone():
    sky = Sky()
    first, second = (sky.enemy("gunship", 240, 100) for _ in range(2))
    sky.scene.shots.fire("shot", 240, 104, (-1.57,), 0.0)
    sky.step(2)
    assert first.health < first.full and second.health == second.full
    assert len(sky.scene.shots) == 0


def test_power_ups_widen_the_weapon_and_the_ring_takes_them():
    sky = Sky()
    volleys = []
    for power in range(1, len(VOLLEYS) + 1):
        assert sky.scene.plane.power == power
        sky.until(lambda: sky.scene.plane.fired, 30, ["fire"])
        volleys.append(len(sky.scene.shots))
        x, y = sky.scene.plane.body.position
        sky.scene.loot.drop("power", x + RING_RADIUS + 5, y, sky.scene.frame)
        sky.until(lambda: not sky.scene.loot.items, 60)
        sky.step(80)
    assert volleys == sorted(set(volleys)) and volleys[0] == 2
    assert sky.scene.score.taken == len(VOLLEYS) and sky.scene.score.points > 0, "one too many is worth points"


def test_bombs_and_lives_are_picked_up_too_and_have_an_end():
    sky = Sky()
    for what, held, most in (("bomb", "bombs", MOST_BOMBS), ("life", "lives", 6)):
        for _ in range(8):
            sky.scene.loot.drop(what, *sky.scene.plane.body.position, sky.scene.frame)
            sky.step(3)
        assert getattr(sky.scene.plane, held) == most


def test_invincible_counts_hits_and_loses_nothing():
    sky = Sky()
    sky.step(1, changes=[("assist:invincible", True)])
    for _ in range(3):
        sky.bullet("red", *sky.scene.plane.body.position)
        sky.step(2)
    assert sky.scene.hits.count["core"] == 3 and sky.scene.plane.lives == LIVES and not len(sky.scene.incoming)


def test_without_hit_stop_nothing_stands_still():
    sky = Sky()
    sky.step(1, changes=[("assist:hit_stop", False)])
    sky.bullet("red", *sky.scene.plane.body.position)
    assert sky.scene.stricken and not sky.scene.freeze


def test_sides_never_pair_with_their_own():
    scene = Shooter(seed=2)
    session = Session(scene, BotSource())
    met = set()
    for _ in range(1500 if physics.JIT else 260):
        session.step()
        shapes = scene.world.shapes
        side = dict(zip(shapes["id"].tolist(), shapes["membership"].tolist(), strict=True))
        met |= {side[a] | side[b] for a, b in scene.world.candidates.tolist()}
    assert met <= MEET
    assert len(scene.world.bodies) < 250


@pytest.mark.skipif(not physics.JIT, reason="who shoots back comes late: too long without compiled kernels")
def test_nothing_that_is_fired_slips_through_what_it_may_hit():
    """No shot or bullet passes through its target without continuous collision.

    A shot is longer than its path in a step, and so are bullet and core together.
    """
    scene = Shooter(seed=1)
    session = Session(scene, BotSource())
    sizes = np.array([mask_of(look).size for look in NAMES])
    ways = np.zeros((2, len(NAMES)))  # [px] the longest of a shot in a step, and of a bullet as the plane sees it
    for _ in range(1500):
        session.step()
        bodies, plane = scene.world.bodies, scene.plane.velocity
        for side, (group, seen) in enumerate(((scene.shots, (0.0, 0.0)), (scene.incoming, plane))):
            own = bodies[group.places()]
            way = np.hypot(own["vx"] - seen[0], own["vy"] - seen[1]) / 60.0
            np.maximum.at(ways[side], group.table.rows["look"], way)
    assert (ways[0] < sizes.max(axis=1)).all() and (ways[1] < sizes.min(axis=1) + 2.0 * CORE_RADIUS).all()
    assert (ways > 0.0).any(axis=1).all()
