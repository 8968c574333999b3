"""Sprites are drawn from exactly the mask's pixels, and particles never affect a game."""

import numpy as np
import pygame
import pytest

from game.drawing.camera import Camera
from game.drawing.canvas import Canvas
from game.drawing.particles import CAPACITY, Particles
from game.drawing.sprites import RotatedSprites, load_atlas

RAMP = ((255, 255, 255), (255, 100, 0), (90, 0, 0))


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.5707963, 2.9, -1.0])
def test_a_turned_sprite_has_exactly_the_mask_s_pixels(angle):
    atlas = load_atlas("planes")
    mask = atlas.mask("player")
    image, origin = RotatedSprites(atlas["player"], mask).at(angle)
    turned = mask.turned(angle)
    assert np.array_equal(pygame.surfarray.array_alpha(image).T > 127, turned.solid)
    assert origin == turned.origin


def test_unknown_frames_are_named():
    with pytest.raises(ValueError, match="no frame 'playr'"):
        load_atlas("planes")["playr"]
    with pytest.raises(ValueError, match="no animation 'dartt'"):
        load_atlas("planes").animation("dartt")


def test_animation_loops_or_stays():
    explosion = load_atlas("effects").animation("explosion_small")
    assert explosion.index_at(explosion.seconds * 1.5, loop=False) == len(explosion.images) - 1
    assert explosion.index_at(explosion.seconds + 0.001) == 0


def test_particles_fly_age_and_are_drawn_in_the_picture_only():
    particles = Particles()
    particles.burst(10.0, 10.0, 50, RAMP, life=(0.5, 0.5))
    particles.burst(1e6, 1e6, 50, RAMP, life=(0.5, 0.5))
    canvas = Canvas()
    canvas.begin((0, 0, 0))
    particles.draw(canvas, Camera())
    assert pygame.surfarray.array3d(canvas.surface).any() and particles.count == 100
    for _ in range(31):
        particles.step(1 / 60)
    assert particles.count == 0


def test_particles_never_grow():
    particles = Particles()
    for _ in range(10):
        particles.burst(0, 0, CAPACITY, RAMP)
    assert particles.count == CAPACITY
