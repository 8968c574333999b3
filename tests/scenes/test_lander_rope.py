"""The lander's rope: its length, how it bends around obstacles, what breaks it, and the remaining parts."""

from itertools import pairwise
from math import hypot, pi

import pytest

import physics
from physics import Polygon
from scenes.lander.feel import GROUND, LINE, LINE_STRENGTH, LINKS
from tests.scenes.lander_stage import Flight

pytestmark = pytest.mark.skipif(not physics.JIT, reason="seconds of play take too long without compiled kernels")
SKY = (300.0, 160.0)  # [px] nothing is near it


def hooked(dx, dy, velocity=(0.0, 0.0)):
    """Return (flight, load): a ship in the sky with a piece of cargo on its rope.

    dx, dy: position of the load relative to the ship [px]. velocity: velocity of the load [px/s].
    """
    flight = Flight()
    _, piece = flight.piece()
    flight.put(*SKY)
    piece.body.move_to((SKY[0] + dx, SKY[1] + dy))
    piece.body.velocity = velocity
    flight.step(1, ["bomb"])
    assert flight.scene.line.load is piece.body
    return flight, piece.body


def points(flight):
    """Return the end points of the rope's links at their present poses."""
    world = flight.scene.world
    return flight.scene.line.points(lambda identity: (*world.body(identity).position, world.body(identity).angle))


def gap(flight, load):
    """Return the distance between the centres of mass of ship and load [px]."""
    at = flight.ship.body.center
    return hypot(load.center.x - at.x, load.center.y - at.y)


@pytest.mark.parametrize("angle", range(0, 360, 40))
@pytest.mark.parametrize("away", [30.0, 47.0, 61.0])
def test_it_is_tied_at_every_angle_and_never_longer_than_it_was_tied(away, angle):
    unit = physics.Vec2(1.0, 0.0).rotated(angle * pi / 180.0)
    flight, load = hooked(*(unit * away))
    line = flight.scene.line
    assert len(line.links) == LINKS and len(flight.scene.world.joints) == LINKS + 1
    longest = max(LINE, gap(flight, load))
    for _ in range(180):
        flight.step(1, ["up"])
        if line.load is None:  # the ship met the load, or the ground
            break
        assert gap(flight, load) < longest + 0.5
        assert flight.scene.world.joints["separation"].max() < 0.6  # [px] 0.31 measured
        ends = points(flight)
        assert len(ends) == LINKS + 1
        at = flight.ship.body.center
        assert hypot(ends[0][0] - at.x, ends[0][1] - at.y) < 0.5
        assert hypot(ends[-1][0] - load.center.x, ends[-1][1] - load.center.y) < 0.5


def crosses(rock, a, b, margin=2.0):
    """Return whether the line from a to b passes through the box of a rock, deeper than the margin [px]."""
    left, top, right, bottom = rock.bounds
    shares = [k / 60 for k in range(61)]
    points = [(a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])) for share in shares]
    return any(left + margin < x < right - margin and top + margin < y < bottom - margin for x, y in points)


@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("speed", [15.0, 25.0, 40.0])
def test_it_bends_around_a_rock(speed, side):
    """The rope bends around a rock: the straight line from ship to load passes through the rock, but no link does."""
    flight, load = hooked(0.0, 46.0)
    x, y = flight.ship.x + side * 14.0, flight.ship.y + 24.0
    rock = flight.scene.world.add_body(Polygon.box(16, 16), position=(x, y), kind="static", filter=GROUND)
    bent = 0
    for _ in range(90):
        flight.ship.body.velocity = (side * speed, -6.0)
        flight.step(1, ["up"])
        if flight.scene.line.load is None:
            break
        assert not any(crosses(rock, a, b) for a, b in pairwise(points(flight)))
        bent += crosses(rock, tuple(flight.ship.body.center), tuple(load.center))
    assert bent > 5, "it was bent at all"


@pytest.mark.parametrize("high", [36.0, 38.0, 40.0, 42.0, 46.0, 50.0, 55.0])
def test_a_gentle_lift_does_not_tear_it(high):
    """Thrust alone lifts a load off the ground from every height within reach, and a rope that
    tightens does not break.
    """
    flight = Flight()
    _, piece = flight.piece()
    x, y = piece.body.position
    flight.put(x, y - high)
    flight.step(2)
    flight.step(1, ["bomb"])
    flight.until(lambda: piece.body.position.y < y - 40.0, 400, ["up"])
    assert flight.scene.line.load is piece.body


@pytest.mark.parametrize("speed, tears", [(20.0, False), (60.0, False), (400.0, True), (900.0, True)])
def test_it_tears_when_it_is_jerked(speed, tears):
    flight, load = hooked(0.0, 40.0, (0.0, speed))
    torn = strongest = 0
    for _ in range(60):
        flight.step(1)
        torn += flight.scene.line.torn
        if flight.scene.line.load is not None:
            joints = flight.scene.world.joints
            strongest = max(strongest, float((joints["force_x"] ** 2 + joints["force_y"] ** 2).max() ** 0.5))
    assert bool(torn) == tears and (flight.scene.line.load is None) == tears
    assert strongest <= LINE_STRENGTH
    if tears:
        assert torn == 1 and len(flight.scene.world.joints) == 0 and not flight.scene.line.links
        assert not any(body.user == "line" for body in flight.scene.world)


def test_it_goes_with_the_load_and_with_the_ship():
    flight, load = hooked(0.0, 46.0)
    flight.scene.gone.append(load.id)
    del flight.scene.yard.cargo[load.id]
    flight.step(2)
    assert flight.scene.line.load is None and not any(body.user == "line" for body in flight.scene.world)
    flight, _ = hooked(0.0, 46.0)
    flight.scene.give_up()
    flight.step(2)
    assert flight.scene.line.load is None and not any(body.user == "line" for body in flight.scene.world)


def test_without_joints_it_catches_nothing():
    flight = Flight()
    flight.scene.world.set_effects(flight.scene.world.effects.with_(joints=False))
    _, piece = flight.piece()
    flight.put(*SKY)
    piece.body.move_to((SKY[0], SKY[1] + 46.0))
    flight.step(1, ["bomb"])
    assert flight.scene.line.load is None and not flight.scene.line.links
