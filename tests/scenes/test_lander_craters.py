"""Craters in the lander's moon: the carved pixels, detached pieces, and agreement of picture, flight and physics."""

import copy

import numpy as np
import pygame
import pytest

import physics
from game.run.digest import scene_digest
from scenes.lander.feel import BLAST, CRASH_BLAST, LOOSE, REACH
from scenes.lander.ground import TILE
from scenes.lander.moon import the_moon
from scenes.lander.rubble_picture import RubblePictures
from scenes.lander.terrain_picture import BORDER, TerrainPicture
from tests.scenes.lander_stage import Flight

pytestmark = pytest.mark.skipif(not physics.JIT, reason="seconds of play take too long without compiled kernels")
ICE = (1790.0, 640.0)  # in the plug of the cave's mouth
TOOTH = (2118.0, 668.0)  # the root of a tooth of stone under the cave's roof


def solid_of(scene):
    """Return the pixels of the ground in the physics, solid[row, column]."""
    return scene.ground.body.shapes[0].solid


def carved_disc(x, y, radius):
    """Return bool [row, column] of the pixels whose centres are in a closed disc."""
    down, across = np.mgrid[0:1024, 0:4096] + 0.5
    return (across - x) ** 2 + (down - y) ** 2 <= radius * radius


def test_a_shell_blows_a_crater_where_it_hits():
    flight = Flight()
    scene = flight.scene
    flight.put(1690.0, 640.0, angle=1.57)
    before = solid_of(scene).sum()
    flight.step(1, ["fire"])
    flight.until(lambda: not scene.gun.shells, 60)
    gone = before - solid_of(scene).sum()
    assert 0.3 * np.pi * BLAST**2 < gone < 1.02 * np.pi * BLAST**2
    assert scene.ground.touched


def test_a_wreck_blows_a_larger_one_and_pads_stay_whole():
    flight = Flight()
    scene = flight.scene
    pad = next(body for body in scene.world if body.id in scene.yard.pads)
    whole = pad.shapes[0].area
    flight.put_over(scene.yard.pads[pad.id], 8.0, (0.0, 300.0))
    before = solid_of(scene).sum()
    flight.until(lambda: not flight.ship.here, 60)
    flight.step(2)
    assert before - solid_of(scene).sum() > 50 and CRASH_BLAST > BLAST
    assert pad.shapes[0].area == whole


def test_exactly_the_pixels_of_the_disc_go():
    scene = Flight().scene
    before = solid_of(scene).copy()
    scene.yard.rubble.add_ground(scene.ground.carve(2900.3, 700.7, 21.5))
    expected = before & ~carved_disc(2900.3, 700.7, 21.5)
    now = solid_of(scene)
    assert not (now & ~expected).any()
    rest = expected & ~now  # what came loose, or was dust
    assert rest.sum() == sum(body.shapes[0].area for body in scene.yard.rubble.bodies() if body.user == "rubble")


def test_flight_and_picture_read_the_same_pixels_as_the_physics():
    scene = Flight().scene
    random = np.random.default_rng(3)
    for _ in range(12):
        x, y = ICE[0] + random.uniform(-60, 60), ICE[1] + random.uniform(-90, 70)
        scene.yard.rubble.add_ground(scene.ground.carve(x, y, random.uniform(6, 24)))
    now = solid_of(scene)
    for x, y in random.uniform((1700, 540), (1880, 740), (400, 2)):
        assert scene.ground.is_solid(x, y) == now[int(y), int(x)]
    for column in range(26, 30):
        for row in range(8, 12):
            around = scene.ground.around(column, row, BORDER)
            part = now[
                row * TILE - BORDER : (row + 1) * TILE + BORDER, column * TILE - BORDER : (column + 1) * TILE + BORDER
            ]
            assert (
                (around == part).all()
                if around is not None
                else (
                    part
                    == the_moon().solid[
                        row * TILE - BORDER : (row + 1) * TILE + BORDER,
                        column * TILE - BORDER : (column + 1) * TILE + BORDER,
                    ]
                ).all()
            )


def cut_off_tooth(flight):
    """Cut a spike of rock off the roof, and return the body that it has become."""
    scene = flight.scene
    flight.step(1, changes=[("assist:invincible", True)])
    before = set(scene.yard.rubble.pieces)
    for x in range(-36, 40, 12):
        scene.yard.rubble.add_ground(scene.ground.carve(TOOTH[0] + x, TOOTH[1], 9.0))
    new = [scene.world.body(identity) for identity in scene.yard.rubble.pieces if identity not in before]
    return max(new, key=lambda body: body.mass)


def test_what_comes_loose_falls_and_comes_to_rest():
    flight = Flight()
    tooth = cut_off_tooth(flight)
    assert tooth.kind == "dynamic" and tooth.filter == LOOSE and tooth.shapes[0].area > 300
    start = tooth.position.y
    flight.step(60)
    assert tooth.position.y > start + 10.0
    flight.until(lambda: not tooth.awake, 1200)
    assert tooth.position.y < 900.0, "it lies on the floor"


def test_rubble_is_drawn_with_the_pixels_that_it_had():
    flight = Flight()
    scene = flight.scene
    tooth = cut_off_tooth(flight)
    piece, mask = scene.yard.rubble.pieces[tooth.id], tooth.shapes[0]
    left, top = piece.source
    assert (the_moon().solid[top : top + mask.size[1], left : left + mask.size[0]] >= mask.solid).all()
    picture = RubblePictures(the_moon())._cut_out(piece, mask)
    assert (pygame.surfarray.array_alpha(picture).T > 0).tolist() == mask.solid.tolist()
    own = pygame.surfarray.array3d(the_moon().picture.subsurface((left, top, *mask.size)))
    inner = (
        mask.solid[1:-1, 1:-1]
        & mask.solid[:-2, 1:-1]
        & mask.solid[2:, 1:-1]
        & mask.solid[1:-1, :-2]
        & mask.solid[1:-1, 2:]
    )
    same = (pygame.surfarray.array3d(picture) == own).all(axis=2).T[1:-1, 1:-1]
    assert same[inner].all()


def test_a_burst_splits_rubble_and_each_part_knows_where_its_pixels_are_from():
    flight = Flight()
    scene = flight.scene
    tooth = cut_off_tooth(flight)
    tooth.move_to((2240.0, 780.0), 0.7)
    x, y = tooth.center
    area = tooth.shapes[0].area
    scene.blast(x, y, 9.0)
    parts = [
        scene.world.body(identity) for identity, piece in scene.yard.rubble.pieces.items() if piece.look == "ground"
    ]
    assert sum(body.shapes[0].area for body in parts) < area - 100
    for body in parts:
        (left, top), mask = scene.yard.rubble.pieces[body.id].source, body.shapes[0]
        assert (the_moon().solid[top : top + mask.size[1], left : left + mask.size[0]] >= mask.solid).all()


def test_a_rock_of_which_nothing_is_left_is_gone_and_the_line_lets_go():
    flight = Flight()
    scene = flight.scene
    rock = scene.yard.rubble.bodies()[0]
    rock.move_to((300.0, 200.0))
    flight.put(300.0, 200.0 - REACH + 20.0)
    flight.step(1, ["bomb"])
    assert scene.line.load.id == rock.id
    scene.blast(300.0, 200.0, 40.0)
    assert rock.id not in scene.world and rock.id not in scene.yard.rubble.pieces and scene.line.load is None
    flight.step(5)


def test_tiles_show_what_is_there_also_after_a_restart_and_a_rewind():
    flight = Flight()
    scene, pictures = flight.scene, TerrainPicture(the_moon())
    column, row = int(ICE[0]) // TILE, int(ICE[1]) // TILE

    def pixels(of):
        return pygame.surfarray.array3d(pictures.tile(of.ground, column, row)).tobytes()

    fresh, kept = pixels(scene), copy.deepcopy(scene)
    scene.blast(*ICE, BLAST)
    holed = pixels(scene)
    assert holed != fresh
    assert pixels(kept) == fresh and pixels(scene) == holed
    scene.restart()
    assert pixels(scene) == fresh and (solid_of(scene) == the_moon().solid).all()


def test_copies_go_on_alike_through_bursts():
    one = Flight()
    one.scene.blast(*ICE, BLAST)
    cut_off_tooth(one)
    other = copy.deepcopy(one)
    for flight in (one, other):
        flight.step(30, ["up"])
        flight.scene.blast(ICE[0] + 12.0, ICE[1] - 20.0, BLAST)
        flight.step(30, ["up"])
    assert scene_digest(one.scene) == scene_digest(other.scene)


def test_the_edge_of_a_crater_is_scorched():
    flight = Flight()
    pictures = TerrainPicture(the_moon())
    x, y = 2000.0, 480.0  # deep in the rock
    column, row = int(x) // TILE, int(y) // TILE
    before = pygame.surfarray.array3d(pictures.tile(flight.scene.ground, column, row)).astype(int)
    flight.scene.blast(x, y, 10.0)
    after = pygame.surfarray.array3d(pictures.tile(flight.scene.ground, column, row)).astype(int)
    changed = (before != after).any(axis=2).sum()
    assert np.pi * 10**2 < changed < np.pi * 15**2, "the hole and three pixels around it"
