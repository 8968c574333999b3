"""An impact is reported at its position on the side from which the body came, even if the body has moved on since."""

import math

import numpy as np
import pytest

from physics import Bounds, Capsule, Chain, Circle, Effects, Polygon, TileGrid, World
from tests.pairwise import pairwise, the_others

WALLS = {  # shape, position, its surface towards the left at the height y
    "box": (Polygon.box(4, 100), (100, 0), lambda y: 98.0),
    "disc": (Circle(8), (100, 0), lambda y: 100.0 - math.sqrt(64.0 - y * y)),
    "bounds": (Bounds(Circle(8)), (100, 0), lambda y: 92.0),
    "capsule": (Capsule((0, -20), (0, 20), 3), (100, 0), lambda y: 97.0),
    "tiles": (TileGrid(np.ones((8, 1), bool), 8.0), (96, -32), lambda y: 96.0),
    "chain": (Chain([(0, 40), (0, -40)]), (100, 0), lambda y: 100.0),
}
EFFECTS = {
    "detection": Effects(continuous=True, sensors=True),
    "turning": Effects(continuous=True, rotation=True, sensors=True),
    "response": Effects(response=True, continuous=True, sensors=True),
    "stacking": Effects.rigid_bodies(),
}
BULLETS = {"disc": Circle(3.0), "large disc": Circle(6.0), "box": Polygon.box(8, 6)}


CASES = (["ray", "swept", "toi"], WALLS, EFFECTS, BULLETS, [6000.0, 1260.0, 1500.0])


@pytest.mark.parametrize("way, wall, effects, bullet, speed", pairwise(*CASES))
def test_a_bullet_tells_the_near_side(way, wall, effects, bullet, speed):
    """The reported point of a bullet's impact equals the closed form along the x axis.

    A bullet in the mode "ray" hits with its centre, in the other modes with its front.
    """
    told_on_the_near_side(way, wall, effects, bullet, speed)


@pytest.mark.nightly
@pytest.mark.parametrize("way", CASES[0])
def test_a_bullet_tells_the_near_side_in_every_case(way):
    for case in the_others(*CASES):
        if case[0] == way:
            told_on_the_near_side(*case)


def told_on_the_near_side(way, wall, effects, bullet, speed):
    shape, place, surface = WALLS[wall]
    world = World(EFFECTS[effects], gravity=(0, 0))
    world.add_body(shape, position=place, kind="static")
    body = world.add_body(BULLETS[bullet], position=(80.0, 0.0), velocity=(speed, 0.0), continuous=way)
    for _ in range(4):
        world.step()
        if len(world.events.begin):
            break
    begun = world.events.begin
    assert len(begun) == 1
    assert begun["normal_x"][0] == pytest.approx(-1.0, abs=0.02), "towards where it came from"
    reach = {"disc": 3.0, "large disc": 6.0, "box": 4.0}[bullet]
    x, y = float(begun["point_x"][0]), float(begun["point_y"][0])
    # Between the surface and as far as the front of what was stopped, or has ended, in it.
    # Against what is round or a chain a disc may be swept with its outline, and tell its middle.
    early = reach if way == "ray" and wall in ("capsule", "chain") else 1e-6
    assert surface(0.0) - early <= x <= surface(0.0) + reach + 1e-6 and abs(y) <= 3.0 + 1e-6
    if body.position[0] > 115.0:
        assert x == pytest.approx(surface(0.0), abs=early), "it flew through: where they met"


@pytest.mark.parametrize("effects", EFFECTS)
@pytest.mark.parametrize("way", ["ray", "swept", "toi"])
def test_a_sensor_is_entered_where_it_begins(effects, way):
    world = World(EFFECTS[effects], gravity=(0, 0))
    world.add_body(Polygon.box(4, 100), position=(100, 0), kind="static", sensor=True)
    world.add_body(Circle(3.0), position=(80, 0), velocity=(6000.0, 0.0), continuous=way)
    world.step()
    told = world.events.sensor_begin
    assert len(told) == 1 and told["point_x"][0] == pytest.approx(98.0, abs=1e-6)
    assert told["normal_x"][0] == pytest.approx(-1.0)
