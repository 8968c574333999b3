"""Hard cases of bodies that start inside one another or cannot fit (section F): slow push-out, no escape."""

import numpy as np
import pytest

from physics import Circle, Polygon
from tests.stability.invariants import Watch, deepest, kinetic, movers, rms_speed
from tests.stability.piles import SLOP, SOLVERS, floor, metres, needs_speed, pile_effects

PUSH = 3.0  # [m/s] the fastest that overlapping bodies are pushed apart


def parting(world):
    """Return the greatest speed [px/s] with which two bodies in contact separate along the normal."""
    rows, contacts = world.bodies, world.contacts
    a, b = world.rows(contacts["body_a"]), world.rows(contacts["body_b"])
    along = (rows["vx"][b] - rows["vx"][a]) * contacts["normal_x"] + (rows["vy"][b] - rows["vy"][a]) * contacts[
        "normal_y"
    ]
    return float(along.max(initial=0.0))


@pytest.mark.parametrize("solver", SOLVERS)
def test_f9_pyramid_that_starts_a_quarter_inside_itself(measured, solver):
    world = metres(solver)
    floor(world)
    for row in range(4):
        world.add_bodies(Polygon.box(1, 1), [(0.75 * (k - (3 - row) / 2), -0.5 - 0.75 * row) for k in range(4 - row)])
    top = -movers(world)["y"].min()
    watch, highest, fastest = Watch(world), 0.0, 0.0
    for _ in range(300):
        watch.step()
        fastest = max(fastest, parting(world))
        highest = max(highest, -movers(world)["y"].min())
    # Each row may leave the one below it at the speed of a push-out; apart, the top one lies at 3.5.
    assert watch.fastest <= 2 * PUSH and top < 3.5, "pushed out, not shot out"
    measured("F9", "speed at which two part", fastest)
    measured("F9", "highest over the height of the stack when apart", highest - 3.5)
    measured("F9", "kinetic energy at the end", kinetic(world))
    assert deepest(world) <= 2 * SLOP


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_f10_a_hundred_boxes_at_one_point(measured, solver):
    """A hundred boxes at one point separate within 10 s, no faster than ten times the push-out speed.

    All values stay finite, and a second run gives the same digest.
    """
    runs = []
    for _ in range(2):
        world = metres(solver, gravity=(0, 0), effects=pile_effects(gravity=False, friction=False))
        world.add_bodies(Polygon.box(1, 1), np.zeros((100, 2)))
        watch = Watch(world, without=("U6",))  # under sequential impulses the last of it goes as slowly as what settles
        watch.step(60)
        runs.append(world.digest())
    measured("F10", "runs that differ", runs[0] != runs[1])
    watch.step(540)
    measured("F10", "overlap at the end", deepest(world))
    measured("F10", "speed", watch.fastest)
    rows = movers(world)
    measured("F10", "spread along and across", min(np.ptp(rows["x"]), np.ptp(rows["y"])))
    drift = np.hypot(rows["vx"].mean(), rows["vy"].mean())
    assert drift < 1e-9 * max(1.0, watch.fastest)


def crowd(measured, side, steps):
    """Simulate a closed box with side x side discs, more than fit into it.

    Check that none escapes and that they slow down. The discs cover the share of the box that F11 states.
    """
    world = metres(effects=pile_effects())
    width, height = side * 0.8, side * 0.78
    for x, y, w, h in (
        (0, height / 2 + 1, width + 4, 2),
        (0, -height / 2 - 1, width + 4, 2),
        (-width / 2 - 1, 0, 2, height),
        (width / 2 + 1, 0, 2, height),
    ):
        world.add_body(Polygon.box(w, h), position=(x, y), kind="static")
    at = [
        ((i - (side - 1) / 2) * width / (side + 0.3), (j - (side - 1) / 2) * height / (side + 0.3))
        for j in range(side)
        for i in range(side)
    ]
    world.add_bodies(Circle(0.5), at)
    watch, speeds = Watch(world, without=("U6",)), []  # overlapped, as there is no room
    for _ in range(steps):
        watch.step()
        speeds.append(rms_speed(world))
    rows = movers(world)
    out = (np.abs(rows["x"]) >= width / 2 + 0.5) | (np.abs(rows["y"]) >= height / 2 + 0.5)
    measured("F11", "escaped", out.sum())
    half = len(speeds) // 2
    measured("F11", "rms speed at the end", speeds[-1])
    measured("F11", "growth of the rms speed", np.mean(speeds[half:]) - np.mean(speeds[:half]))


@needs_speed
def test_f11_more_discs_than_fit_stay_in_and_calm(measured):
    crowd(measured, 10, 300)


@needs_speed
def test_f11_625_discs_in_room_for_496_stay_in_and_calm(measured):
    crowd(measured, 25, 600)


@needs_speed
def test_f12_discs_crushed_by_plates_stay_between_them(measured):
    """Discs crushed between two plates stay between them; their overlap grows with the compression."""
    world = metres(gravity=(0, 0), effects=pile_effects(gravity=False))
    for y in (-5.0, 5.0):
        world.add_body(Polygon.box(40, 2), position=(0.0, y), kind="static")
    plates = [
        world.add_body(Polygon.box(2, 8.0), position=(side * 8.0, 0.0), kind="kinematic", velocity=(-side * 1.0, 0.0))
        for side in (-1, 1)
    ]
    world.add_bodies(Circle(0.5), [(1.0 * (i - 3.5), 1.0 * (j - 3.5)) for i in range(8) for j in range(8)])
    watch, depths, out = Watch(world), [], 0
    for _ in range(5):
        watch.step(60)
        rows = movers(world)
        out += int(((np.abs(rows["x"]) > plates[1].position[0]) | (np.abs(rows["y"]) > 4.5)).sum())
        depths.append(deepest(world))
        if plates[1].position[0] < 3.6:
            break
    measured("F12", "escaped", out)
    measured("F12", "growth of the overlap with the crushing", min(np.diff(depths)))


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("depth", [0.5 * SLOP, SLOP, 4 * SLOP, 20 * SLOP])
def test_f27_overlap_at_the_start_goes_without_a_pop(measured, solver, depth):
    """An overlap at the start shrinks to at most a slop, and the box hardly rises.

    It rises by no more than a slop above the floor and no faster than the push-out speed.
    """
    world = metres(solver)
    floor(world)
    box = world.add_body(Polygon.box(1, 1), position=(0.0, -0.5 + depth))
    watch, rise = Watch(world), 0.0
    for _ in range(120):
        watch.step()
        rise = max(rise, -box.position[1] - 0.5)
    assert watch.fastest <= PUSH * (1 + 1e-9) + 10 * world.dt
    measured("F27", "rise above the floor", rise)
    measured("F27", "overlap left of what is in further", deepest(world))
    assert (
        abs(box.position[0]) <= (1e-5 if depth <= SLOP else 0.01 * depth)
        and abs(box.angle) < 1e-3 * depth
        and kinetic(world) < 1e-9
    )


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("depth", [0.5 * SLOP, SLOP])
def test_f27_what_is_in_by_a_slop_stays_without_gravity(measured, solver, depth):
    world = metres(solver, gravity=(0, 0), effects=pile_effects(gravity=False))
    floor(world)
    box = world.add_body(Polygon.box(1, 1), position=(0.0, -0.5 + depth))
    Watch(world).step(120)
    measured("F27", "way of what is in by a slop or less", abs(box.position[1] + 0.5 - depth))
