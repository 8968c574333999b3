"""Piles of pixel masks stand as boxes do, heaps come to rest, and wedged masks are pushed out (invariant U6)."""

import math

import numpy as np
import pytest

from physics import JIT, Effects, PixelMask, Polygon, World
from tests.stability.piles import needs_speed

AWAKE = Effects(response=True, gravity=True, rotation=True, friction=True, restitution=True, stacking=True)
CRATE = PixelMask(np.ones((32, 32), bool))


def column(shape, seconds, solver):
    """Return the greatest sideways motion [px] in a column of ten bodies that cannot sleep."""
    world = World(AWAKE, solver=solver)
    world.add_body(Polygon.box(800, 40), position=(0.0, 20.0), kind="static")
    bodies = [world.add_body(shape, position=(0.0, -16.0 - 32.0 * k)) for k in range(10)]
    sway = 0.0
    for _ in range(round(seconds / world.dt)):
        world.step()
        sway = max(sway, *(abs(body.position.x) for body in bodies))
    assert bodies[-1].position.y == pytest.approx(-16.0 - 32.0 * 9, abs=2.0), "it stands"
    return sway


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_ten_crates_of_pixels_stand(solver):
    assert column(CRATE, 5.0 if JIT else 0.5, solver) <= 0.5


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_ten_crates_of_pixels_stand_for_a_minute_beside_ten_boxes(solver):
    sway, beside = column(CRATE, 60.0, solver), column(Polygon.box(32, 32), 60.0, solver)
    assert sway == beside and sway <= 0.5


def blob(rng):
    """Return a random round sprite with bumps and bays, 14 to 28 px wide."""
    size = int(rng.integers(14, 29))
    y, x = np.indices((size, size)) - (size - 1) / 2
    around, far = np.arctan2(y, x), np.hypot(x, y)
    bumps = 0.15 * np.cos(rng.integers(2, 6) * around + rng.uniform(0, 6))
    return PixelMask(far <= size / 2 * (0.75 + bumps + 0.1 * np.cos(rng.integers(1, 4) * around + rng.uniform(0, 6))))


def ragged(rng):
    """Return a random sprite with spikes and notches on all sides, 14 to 28 px wide."""
    size = int(rng.integers(14, 29))
    y, x = np.indices((size, size)) - (size - 1) / 2
    radii = size / 2 * rng.uniform(0.45, 1.0, 24)
    around = np.arctan2(y, x) % math.tau / math.tau * 24
    return PixelMask(np.hypot(x, y) <= np.interp(around, np.arange(25), np.append(radii, radii[0])))


def heap(count, seed, solver="soft_step", seconds=20.0, sprite=blob):
    """Drop sprites into a bin. Return (time of the last new contact [s], time at which all
    slept [s] or None, bodies).
    """
    rng = np.random.default_rng(seed)
    world = World(solver=solver)
    world.add_body(PixelMask(np.ones((20, 500), bool)), position=(0.0, 210.0), kind="static")
    for x in (-250.0, 250.0):
        world.add_body(PixelMask(np.ones((600, 20), bool)), position=(x, -100.0), kind="static")
    bodies = [
        world.add_body(
            sprite(rng),
            position=(float(rng.uniform(-200, 200)), 150.0 - 34.0 * (k // 10)),
            angle=float(rng.uniform(0, math.tau)),
        )
        for k in range(count)
    ]
    met, landed = set(), 0.0
    while world.time < seconds:
        world.step()
        for name in ("body_a", "body_b"):
            new = set(world.events.begin[name].tolist()) - met
            if new:
                met, landed = met | new, world.time
        if not any(body.awake for body in bodies):
            return landed, world.time, bodies
    return landed, None, bodies


@pytest.mark.parametrize("seed", range(8) if JIT else [3])
@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_sprites_come_to_rest_on_each_other(solver, seed):
    landed, asleep, bodies = heap(30 if JIT else 6, seed, solver)
    assert asleep is not None and asleep - landed < 5.0
    assert all(-240.0 < body.position.x < 240.0 and body.position.y < 200.0 for body in bodies), "none got out"


@needs_speed
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("sprite", [blob, ragged])
@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_two_hundred_sprites_sleep_within_eight_seconds_of_the_last_landing(solver, sprite, seed):
    """Two hundred sprites in a bin all sleep within eight seconds of the last new contact.

    Sprites that roll off others, rock in a hollow or tremble where two outline parts meet take the longest time.
    """
    landed, asleep, bodies = heap(200, seed, solver, 14.0, sprite)
    assert all(-240.0 < body.position.x < 240.0 and body.position.y < 200.0 for body in bodies), "none got out"
    assert asleep is not None and asleep - landed < 8.0


@pytest.mark.parametrize("depth", [2.0, 4.0])
@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_what_is_wedged_in_a_notch_comes_to_rest(solver, depth):
    """A crate placed in a notch narrower than itself is pushed out or stays, and comes to rest."""
    fork = np.ones((30, 40), bool)
    fork[:18, 14:26] = False  # a notch of 12 px
    world = World(solver=solver)
    world.add_body(PixelMask(fork), position=(0.0, 0.0), kind="static")
    world.add_body(Polygon.box(800, 40), position=(0.0, 35.0), kind="static")
    body = world.add_body(PixelMask(np.ones((14, 14), bool)), position=(0.3, -15.0 - 7.0 + depth), angle=0.05)
    fastest = 0.0
    for _ in range(300):
        world.step()
        fastest = max(fastest, math.hypot(*body.velocity))
    assert fastest < 180.0, "not thrown: it may fall off, by 30 px"
    assert math.hypot(*body.velocity) < 2.0 and abs(body.angular_velocity) < 0.2
