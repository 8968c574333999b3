"""Heavy planes break up: pixels are lost only in cracks, and the pieces tumble, hit small planes and fall."""

from math import pi

import numpy as np
import pytest

from game.drawing.sprites import load_atlas
from scenes.shooter.plane import LIVES
from scenes.shooter.scene import Shooter
from scenes.shooter.wreckage import CRUMB, HARMLESS, cracks
from tests.scenes.shooter_stages import Sky, struck_down


def test_a_gunship_breaks_into_pieces_of_its_own_pixels():
    sky, plane = struck_down()
    pieces, whole = sky.scene.wreckage.pieces, load_atlas("planes").mask("gunship_0")
    assert len(pieces) >= 3 and plane.id not in sky.scene.fleet.planes
    found = np.zeros(whole.solid.shape, int)
    for piece in pieces.values():
        height, width = piece.mask.solid.shape
        found[piece.top : piece.top + height, piece.left : piece.left + width] += piece.mask.solid
        assert piece.mask.area >= CRUMB
    assert found.max() == 1, "no pixel is in two pieces"
    assert not (found.astype(bool) & ~whole.solid).any(), "each lies where it was in the plane"
    assert found.sum() > 0.7 * whole.area, "cracks are thin"


def test_pieces_fly_apart_turn_and_come_down():
    sky, _ = struck_down()
    scene = sky.scene
    ids = list(scene.wreckage.pieces)
    sky.step(12)
    bodies = [scene.world.body(identity) for identity in ids]
    assert all(abs(body.angular_velocity) > 0.4 for body in bodies)
    centers = np.array([body.center for body in bodies])
    sky.step(40)
    later = np.array([body.center for body in bodies])
    middle, after = centers.mean(axis=0), later.mean(axis=0)
    spread, wider = (np.linalg.norm(each - at, axis=1).mean() for each, at in ((centers, middle), (later, after)))
    assert wider > spread + 5.0
    sky.until(lambda: not len(scene.wreckage), 200)
    sky.step()
    assert not any(identity in scene.world for identity in ids) and scene.unknown == 0


def test_the_air_takes_them_along_with_the_ground():
    """Drag and wind act on the pieces, which finally drift with the ground."""
    sky, _ = struck_down(y=20.0)
    scene = sky.scene
    for piece in scene.wreckage.pieces.values():
        piece.life = 10**6
    for identity in scene.wreckage.pieces:
        scene.world.body(identity).velocity = (0.0, 0.0)
    sky.step(240)
    speeds = [scene.world.body(identity).velocity for identity in scene.wreckage.pieces]
    assert speeds and all(abs(v.x) < 1.0 and v.y == pytest.approx(30.0, abs=2.0) for v in speeds)


def test_pieces_never_meet_the_player_nor_each_other():
    sky, _ = struck_down()
    scene = sky.scene
    lives = scene.plane.lives
    for identity in scene.wreckage.pieces:
        scene.world.body(identity).move_to((scene.plane.x, scene.plane.y))
    sky.step(30)
    assert scene.plane.lives == lives == LIVES and not scene.stricken and scene.hits.count["hull"] == 0
    assert not any(identity in scene.hits.now["hull"] for identity in scene.wreckage.pieces)


@pytest.mark.parametrize("high", (True, False))
def test_a_piece_damages_a_small_plane_while_it_is_high(high):
    sky, _ = struck_down()
    scene = sky.scene
    identity, piece = max(scene.wreckage.pieces.items(), key=lambda each: each[1].mask.area)
    if not high:
        piece.age = int(piece.life * 0.9)
        assert piece.high < HARMLESS
    saucer = sky.enemy("saucer", 60, 60)
    sky.step(2)
    body = scene.world.body(identity)
    body.move_to((60, 100))
    body.velocity = (0.0, -300.0)
    sky.step(12)
    assert (saucer.health < saucer.full) == high


def test_heavy_planes_shrug_pieces_off():
    sky, _ = struck_down()
    other = sky.enemy("gunship", 60, 60)
    for identity in sky.scene.wreckage.pieces:
        sky.scene.world.body(identity).move_to((60, 60))
    sky.step(10)
    assert other.health == other.full


def test_small_planes_do_not_break():
    sky = Sky()
    dart = sky.enemy("dart", 240, 60)
    dart.health = 0.1
    sky.scene.shots.fire("shot", 240, 120, [-pi / 2], 540.0)
    sky.until(lambda: dart.health <= 0.0, 60)
    sky.step(2)
    assert not sky.scene.wreckage.pieces and dart.id not in sky.scene.world


@pytest.mark.parametrize("tier", Shooter.tiers)
def test_planes_break_at_every_tier_and_when_it_changes(tier):
    sky = Sky(tier=tier)
    sky.enemy("gunship", 240, 90).health = 0.1
    sky.scene.shots.fire("shot", 240, 160, [-pi / 2], 560.0)
    sky.until(lambda: len(sky.scene.wreckage), 60)
    sky.step(3)
    sky.scene.set_tier("circle")
    sky.step(20)
    assert len(sky.scene.wreckage) >= 3
    for identity, piece in sky.scene.wreckage.pieces.items():
        body = sky.scene.world.body(identity)
        assert body.tier is None and body.shapes == (piece.mask,) and not piece.mask.snap, "its own pixels"


def test_tumbling_pieces_are_not_drawn_for_who_tests_them():
    sky, _ = struck_down()
    sky.enemy("saucer", 60, 60)
    library = sky.scene.world.library
    known = library.rasters.count
    sky.step(40)
    assert len(sky.scene.wreckage) >= 3
    assert sky.scene.world.library is library and library.rasters.count == known


def test_where_it_was_hit_decides_how_it_breaks():
    patterns = set()
    for aside in (-14, 0, 14):
        sky = Sky()
        sky.enemy("gunship", 240, 90).health = 0.1
        sky.scene.shots.fire("shot", 240 + aside, 160, [-pi / 2], 560.0)
        sky.until(lambda sky=sky: len(sky.scene.wreckage), 60)
        patterns.add(tuple(piece.mask.area for piece in sky.scene.wreckage.pieces.values()))
    assert len(patterns) == 3


def test_cracks_lead_right_through():
    random, mask = np.random.default_rng(5), load_atlas("planes").mask("boss_a_0")
    for _ in range(20):
        crack = cracks(mask, *random.uniform(-30, 30, 2), random)
        assert crack.solid.any(axis=0).mean() > 0.5 and crack.solid.any(axis=1).all()
        assert crack.origin == mask.origin and crack.size == mask.size
