"""Resting bodies do not creep: light planks under heavy loads stay in place for over a minute."""

import pytest

from physics import Effects, Material, Polygon, World
from physics.step import STACKING
from tests.stability.piles import needs_speed

SCALE = 32.0  # [px/m]
EFFECTS = Effects.rigid_bodies().with_(sleeping=False)


def plank(density, x, **settings):
    """Return a world with a plank (10 m by 0.1 m) on two posts and a box of 1 m on it.

    density: density of the box. x: position of the box from the middle of the plank [m].
    """
    world = World(EFFECTS, **settings)
    world.add_body(Polygon.box(8000, 40), position=(0, 20), kind="static")
    for post in (-4.8, 4.8):
        world.add_body(Polygon.box(0.4 * SCALE, SCALE), position=(post * SCALE, -0.5 * SCALE), kind="static")
    below = world.add_body(Polygon.box(10 * SCALE, 0.1 * SCALE), position=(0, -1.05 * SCALE))
    load = world.add_body(
        Polygon.box(SCALE, SCALE), position=(x * SCALE, -1.6 * SCALE), material=Material(density=density)
    )
    return world, [below, load]


@needs_speed
@pytest.mark.parametrize("settings", [{}, {"substeps": 16}, {"solver": "sequential_impulse"},
                                      {"solver": "sequential_impulse", "substeps": 16}],
                         ids=["auto", "16", "sequential", "sequential 16"])  # fmt: skip
@pytest.mark.parametrize("density", [1.0, 10.0, 50.0])
def test_a_light_plank_under_a_load_stays_within_a_tenth_of_a_millimetre_a_minute(density, settings):
    for x in (-2.4, -1.3, 0.0, 0.7, 1.9, 3.1):
        world, bodies = plank(density, x, **settings)
        for _ in range(60):
            world.step()
        start = [body.position.x for body in bodies]
        for _ in range(3600 if x in (-2.4, 0.7) else 600):
            world.step()
        crept = max(abs(body.position.x - first) for body, first in zip(bodies, start, strict=True))
        assert crept / SCALE * 1000 <= 0.1, f"{x} m: {crept / SCALE * 1000:.3f} mm"


@needs_speed
@pytest.mark.parametrize("solver", STACKING)
@pytest.mark.parametrize("rows", [10, 20, 30])
def test_a_pyramid_comes_to_rest_with_as_many_passes_as_its_load_needs(rows, solver):
    world = World(EFFECTS, solver=solver)
    world.add_body(Polygon.box(4000, 40), position=(0, 20), kind="static")
    for row in range(rows):
        places = [((k - (rows - row - 1) / 2) * 17, -8 - 16 * row) for k in range(rows - row)]
        world.add_bodies(Polygon.box(16, 16), places)
    for _ in range(240):
        world.step()
    assert max(body.velocity.length for body in world if body.kind == "dynamic") <= 0.2


@pytest.mark.parametrize("speed", [5.0, 40.0, 150.0])
def test_what_slides_to_a_stop_is_not_drawn_back(speed):
    """A box that slides to a stop is not pulled back: its contact anchors the position where it stopped."""
    world = World(EFFECTS)
    world.add_body(Polygon.box(4000, 40), position=(0, 20), kind="static", material=Material(friction=0.4))
    box = world.add_body(Polygon.box(32, 16), position=(0, -8), velocity=(speed, 0), material=Material(friction=0.4))
    before = 0.0
    for _ in range(150):
        world.step()
        # It leans forward while it slides, and straightens up.
        assert box.position.x >= before - 0.003
        before = max(before, box.position.x)
    assert box.position.x == pytest.approx(speed**2 / (2 * 0.4 * world.gravity[1]), rel=0.1, abs=0.02)
