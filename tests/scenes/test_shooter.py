"""The shooter's rules: pixels decide, sides never meet their own, and the bot lives through a minute."""

import numpy as np
import pytest

import physics
from game.digest import scene_digest
from game.inputs import BotSource, InputFrame, InputState, ScriptSource
from game.run_report import judge
from game.session import Session
from game.sprites import load_atlas
from physics import debug
from scenes.shooter.cast import BULLET, ENEMY, FLYING, GHOST, ITEM, PLAYER, SHOT
from scenes.shooter.enemies import KINDS, Gunship
from scenes.shooter.plane import BANKS, LIVES, VOLLEYS
from scenes.shooter.scene import FREEZE, RESTART_AFTER, Shooter
from scenes.shooter.waves import WAVES, Pace

MEET = {PLAYER | ENEMY, PLAYER | BULLET, PLAYER | ITEM, SHOT | ENEMY}


class Sky:
    """A shooter without waves, whose plane can be hit from the first step on."""

    def __init__(self, **chosen):
        self.scene = Shooter(seed=1, **chosen)
        self.inputs = InputState()
        self.scene.director.step = lambda fleet, random: None
        self.step(100)
        self.scene.plane.safe = 0
        self.step()

    def step(self, count=1, actions=()):
        for _ in range(count):
            self.inputs.set(InputFrame(frozenset(actions)))
            self.scene.step(self.inputs)

    def enemy(self, kind, x, y):
        """A plane that hangs where it is put."""
        self.scene.fleet.launch(kind, 240, 60, 0, False, Pace(0))
        plane = list(self.scene.fleet.planes.values())[-1]
        plane.think = lambda sky: None
        self.scene.world.body(plane.id).move_to((x, y))
        return plane


def offsets(shares):
    """A place of a dart beside the plane at which boxes overlap, and pixels are shared or not: the most of the box."""
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
    """Shared pixels of two masks, b moved by whole pixels: laid on one large grid."""
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
        dart.health = 1
        dart.vx, dart.vy = 0.0, side
        shots = sky.scene.shots
        shots.fire("shot", 240, 60 + 60 + 0.2 * side, [-np.pi / 2], 540.0)
        debris = sky.scene.spectacle.debris
        while not debris:
            sky.step()
            debris = sky.scene.spectacle.debris
        found.append((sky.scene.blows.found, len(debris), sum(piece[4] for piece in debris) / len(debris)))
    blow, pieces = found[0][0], [each[1] for each in found]
    assert pieces[0] < pieces[1] and len(blow) == 2
    (ax, ay), (bx, by) = blow.values()
    assert (ax, ay) == (-bx, -by)
    assert found[0][2] < 25.0, "upwards, as the shot flew; thrown about alone they would fall"


def test_boxes_that_overlap_without_pixels_are_no_hit_but_a_near_miss():
    sky = Sky()
    dx, dy = offsets(shares=False)
    x, y = sky.scene.plane.body.position
    dart = sky.enemy("dart", x + dx, y + dy)
    sky.step(3)
    assert sky.scene.freeze == 0 and sky.scene.plane.lives == LIVES
    assert sky.scene.near == {dart.id}
    sky.scene.world.body(dart.id).move_to((x + 120, y))
    sky.step()
    assert sky.scene.score.close == 1 and sky.scene.plane.lives == LIVES


def test_the_same_place_is_a_hit_where_boxes_decide():
    sky = Sky(tier="aabb")
    dx, dy = offsets(shares=False)
    x, y = sky.scene.plane.body.position
    sky.enemy("dart", x + dx, y + dy)
    sky.step()
    assert sky.scene.freeze == FREEZE


def test_a_shared_pixel_is_a_hit_and_all_stands_still_to_show_it():
    sky = Sky()
    dx, dy = offsets(shares=True)
    x, y = sky.scene.plane.body.position
    dart = sky.enemy("dart", x + dx, y + dy)
    sky.step()
    assert sky.scene.freeze == FREEZE and sky.scene.hit_by == [dart.id]
    before = sky.scene.world.bodies[["x", "y"]].tolist()
    sky.step(FREEZE - 1)
    assert sky.scene.world.bodies[["x", "y"]].tolist() == before
    assert len(debug.mask_hits(sky.scene.world)) == 1
    sky.step(2)
    assert sky.scene.plane.lives == LIVES - 1 and sky.scene.plane.body is None
    assert not sky.scene.fleet.planes and not len(sky.scene.world.bodies), "what rammed you is gone too"


def test_the_mask_of_the_frame_shown_is_the_mask_that_collides():
    sky, seen = Sky(), set()
    for action in ("left", "right"):
        for _ in range(14):
            sky.step(1, [action])
            plane = sky.scene.plane
            assert plane.body.shapes == (load_atlas("planes").mask(plane.frame),)
            seen.add(plane.frame)
    assert seen == set(BANKS)


def test_a_new_plane_is_a_ghost_for_a_while():
    sky = Sky()
    sky.enemy("saucer", *sky.scene.plane.body.position)
    sky.step(FREEZE + 1)
    assert sky.scene.plane.body is None
    while sky.scene.plane.body is None:
        sky.step()
    assert sky.scene.plane.body.filter == GHOST
    sky.step(60)
    saucer = sky.enemy("saucer", *sky.scene.plane.body.position)
    sky.step(5)
    assert sky.scene.plane.lives == LIVES - 1 and not sky.scene.freeze and saucer.id in sky.scene.fleet.planes
    while sky.scene.plane.body.filter != FLYING:
        sky.step()
    assert sky.scene.freeze == FREEZE, "once it is no ghost, what lies over it hits it"


def test_one_shot_strikes_one_plane_and_is_gone():
    sky = Sky()
    first, second = (sky.enemy("gunship", 240, 100) for _ in range(2))
    sky.scene.shots.fire("shot", 240, 104, (-1.57,), 0.0)
    sky.step(2)
    assert (first.full - first.health, second.full - second.health) == (1, 0)
    assert len(sky.scene.shots) == 0


def test_a_power_up_is_a_sensor_that_widens_the_weapon():
    sky = Sky()
    x, y = sky.scene.plane.body.position
    volleys = []
    for power in range(1, len(VOLLEYS) + 1):
        assert sky.scene.plane.power == power
        while not sky.scene.plane.fired:
            sky.step(1, ["fire"])
        volleys.append(len(sky.scene.shots))
        sky.scene.loot.drop(x, y, sky.scene.frame, "pixels")
        while sky.scene.loot.born:
            sky.step()
        sky.step(70)
    assert volleys == sorted(set(volleys)) and volleys[0] == 2
    assert sky.scene.score.taken == len(VOLLEYS) and sky.scene.score.points > 0, "one too many is worth points"


def test_sides_never_pair_with_their_own():
    scene = Shooter(seed=2)
    session = Session(scene, BotSource())
    met = set()
    for _ in range(900 if physics.JIT else 150):
        session.step()
        shapes = scene.world.shapes
        side = dict(zip(shapes["id"].tolist(), shapes["membership"].tolist(), strict=True))
        met |= {side[a] | side[b] for a, b in scene.world.candidates.tolist()}
    assert met <= MEET
    assert len(scene.world.bodies) < 200


def test_game_over_and_again():
    scene = Shooter(seed=3)
    session = Session(scene, ScriptSource([]))
    for _ in range(20_000 if physics.JIT else 0):
        session.step()
        if scene.over > RESTART_AFTER:
            break
    if not physics.JIT:
        scene.over = RESTART_AFTER + 1
    again = Session(scene, ScriptSource([(), ("fire",), ()]))
    again.step()
    again.step()
    assert scene.frame == 1 and scene.over == 0 and scene.plane.lives == LIVES and scene.score.points == 0


@pytest.mark.skipif(not physics.JIT, reason="a minute of play takes too long without compiled kernels")
@pytest.mark.parametrize("seed", [1, 2, *(pytest.param(seed, marks=pytest.mark.deep) for seed in (3, 4, 5))])
def test_the_bot_lives_through_a_minute(seed):
    scene = Shooter(seed=seed)
    session = Session(scene, BotSource())
    for _ in range(3600):
        session.step()
    check = judge(scene, 3600)
    assert check["ok"] and not check["pending"], check
    assert session.report.quarantined == 0


@pytest.mark.skipif(not physics.JIT, reason="as above")
def test_it_gets_harder_and_ends():
    scene = Shooter(seed=1)
    session = Session(scene, BotSource())
    digests = []
    for frame in range(9000):
        session.step()
        if frame % 3000 == 2999:
            digests.append(scene_digest(scene))
    assert scene.pace.round >= 1 and len(set(digests)) == 3
    assert Pace(3).speed > Pace(1).speed > Pace(0).speed and Pace(99).speed == Pace(50).speed


def test_waves_are_well_formed_and_fans_have_gaps():
    for wave in WAVES:
        assert wave.title and wave.groups
        for group in wave.groups:
            assert group.kind in KINDS and all(0.0 < at < 1.0 for at in group.at) and 20 < group.hover < 80
    assert {group.kind for wave in WAVES[:4] for group in wave.groups} == set(KINDS), "all kinds within a minute"
    effects, planes = load_atlas("effects"), load_atlas("planes")
    room = (planes.mask("player").bounds[2] * 2) + effects.mask("bullet_orange_0").bounds[2] * 2
    assert Gunship.FAN_GAP * 140 > room, "a plane fits between two bullets of a fan"
