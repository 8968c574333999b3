"""Contacts are reported at the final poses of a step: their points, normals, separations and areas."""

import math

import numpy as np
import pytest

from physics import JIT, Capsule, Chain, Character, Circle, Effects, PixelMask, Polygon, TileGrid, World, collide

SOLVERS = ("blocking", "projection", "sequential_impulse", "soft_step")
FULL = Effects(response=True, gravity=True, rotation=True, friction=True, restitution=True, continuous=True)
DISC = [[(x - 6.5) ** 2 + (y - 6.5) ** 2 < 42.0 for x in range(14)] for y in range(14)]
SHAPES = {
    "boxes": (Polygon.box(16, 12),),
    "discs": (Circle(7.0),),
    "both": (Polygon.box(16, 12), Circle(7.0)),
    "round": (Capsule((-5, 0), (5, 0), 4.0), Polygon([(-6, -5), (7, -4), (0, 6)], radius=1.5), Circle(6.0)),
}
GROUNDS = {
    "box": lambda: (Polygon.box(900, 20), (0, 10)),
    "tiles": lambda: (TileGrid(np.ones((1, 60), bool), 16.0), (-480, 0)),
    "chain": lambda: (Chain([(-450, -20), (-60, 0), (60, 5), (450, -20)]), (0, 0)),
}


def world_for(solver, effects=FULL, **options):
    return World(effects.with_(stacking=solver in SOLVERS[2:]), solver=solver, **options)


def pose(body):
    return (*body.position, body.angle)


def detected(world, contact, margin=40.0):
    a, b = world.body(int(contact["body_a"])), world.body(int(contact["body_b"]))
    return collide(a.shapes[0], pose(a), b.shapes[0], pose(b), margin=margin)


def motion(world, contact):
    """Return how far the two bodies of a contact have moved relative to each other in the last step [px].

    The motion of a dynamic body's farthest point by rotation is added.
    """
    total = np.zeros(2)
    turns = 0.0
    for name, sign in (("body_a", -1.0), ("body_b", 1.0)):
        b = world.bodies[world.rows(int(contact[name]))]
        total += sign * np.array([b["x"] - b["previous_x"], b["y"] - b["previous_y"]])
        if b["kind"] == 2:
            turns += abs(b["angle"] - b["previous_angle"]) * b["extent"]
    return math.hypot(*total) + turns


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("shapes", SHAPES)
@pytest.mark.parametrize("ground", GROUNDS)
def test_they_are_what_a_look_at_the_final_poses_finds(solver, shapes, ground):
    """Reported contacts equal those computed at the final poses.

    A point with the same feature may differ by the square of the motion in this step. It may differ by the motion
    itself if a corner has left or reached a face in this step.
    """
    world = world_for(solver, FULL.with_(continuous=False))
    shape, place = GROUNDS[ground]()
    world.add_body(shape, position=place, kind="static")
    rng = np.random.default_rng(SOLVERS.index(solver))
    for k in range(16 if JIT else 7):
        world.add_body(
            SHAPES[shapes][k % len(SHAPES[shapes])],
            position=(rng.uniform(-40, 40), -24 - 11 * k),
            velocity=(rng.uniform(-150, 150), 0),
            angle=rng.uniform(0, 3),
            angular_velocity=rng.uniform(-3, 3),
        )
    same = near = 0
    for _ in range(120 if JIT else 50):
        world.step()
        for contact in world.contacts:
            found = detected(world, contact)
            assert len(found), contact
            if contact["feature"] not in list(found.features) or len(found) > 2:
                continue  # another face or corner is nearest now, or several faces are
            same += 1
            # As a face comes to lie along another, its ends change names.
            k = int(np.argmin(np.hypot(*(found.points - (contact["point_x"], contact["point_y"])).T)))
            moved = motion(world, contact) + world.tolerances.recycle
            if solver == "blocking":
                moved += 10.0  # what was put back had moved by a whole step
            errors = (
                abs(found.separations[k] - contact["separation"]),
                math.dist(found.points[k], (contact["point_x"], contact["point_y"])),
                10.0 * math.dist(found.normal, (contact["normal_x"], contact["normal_y"])),
            )
            assert errors[0] <= 3.0 * moved
            near += max(errors) <= moved * moved / 100.0 + 1e-9
    assert same > 30 and near >= 0.9 * same


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_box_and_a_disc_that_slide_on_the_ground(solver):
    """The contacts of a sliding box and disc have closed-form points.

    They lie under the corners of the box and the centre of the disc, halfway between the two surfaces.
    """
    world = world_for(solver, FULL.with_(friction=False, rotation=False), gravity=(0, 300))
    world.add_body(Polygon.box(4000, 20), position=(0, 10), kind="static")
    box = world.add_body(Polygon.box(20, 12), position=(0, -8), velocity=(410.0, 90.0))
    disc = world.add_body(Circle(5.0), position=(-200, -7), velocity=(-350.0, 60.0))
    seen = 0
    for _ in range(40):
        world.step()
        for body, half, offsets in ((box, 6.0, (-10.0, 10.0)), (disc, 5.0, (0.0,))):
            told = body.contacts
            seen += len(told)
            gap = -half - body.position[1]
            for contact in told:
                assert (contact["normal_x"], contact["normal_y"]) == (0.0, -1.0)
                assert abs(contact["separation"] - gap) < 1e-9
                assert abs(contact["point_y"] + 0.5 * gap) < 1e-9
                assert min(abs(contact["point_x"] - body.position[0] - each) for each in offsets) < 1e-9
    assert seen > 6


@pytest.mark.parametrize("solver", SOLVERS[1:])
def test_discs_round_each_other_and_round_a_corner(solver):
    """The contacts of discs that move around a disc or a corner lie on the line to its centre or to the corner."""
    world = world_for(solver, gravity=(0, 0))
    still = world.add_body(Circle(9.0), kind="static")
    block = world.add_body(Polygon.box(40, 40), position=(100, 20), kind="static")  # its corner at (80, 0)
    first = world.add_body(Circle(5.0), position=(-2.0, -13.5), velocity=(260.0, 60.0))
    second = world.add_body(Circle(5.0), position=(76.5, -3.5), velocity=(200.0, 60.0))
    seen = set()
    for _ in range(12):
        world.step()
        for contact in world.contacts:
            body, radius = {first.id: (first, 9.0), second.id: (second, 0.0)}[int(contact["body_b"])]
            center = np.array(body.position)
            core = np.array([0.0, 0.0] if contact["body_a"] == still.id else [80.0, 0.0])
            away = center - core
            if contact["body_a"] == block.id and away[0] > 0.0:
                continue  # over its top face
            distance = math.hypot(*away)
            normal = away / distance
            seen.add(int(contact["body_a"]))
            middle = core + normal * 0.5 * (radius + distance - 5.0)
            assert math.dist((contact["normal_x"], contact["normal_y"]), normal) < 1e-9
            assert abs(contact["separation"] - (distance - radius - 5.0)) < 1e-9
            assert math.dist((contact["point_x"], contact["point_y"]), middle) < 1e-9
    assert seen == {still.id, block.id}


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("angle", [0.0, 0.3, 0.7853981633974483])
def test_what_a_sweep_stopped_touches_where_it_was_put(solver, angle):
    world = world_for(solver, gravity=(0, 0))
    world.add_body(Polygon.box(10, 200), position=(100, 0), kind="static")
    body = world.add_body(Polygon.box(8, 6), position=(-20, 3), angle=angle, velocity=(5000.0, 200.0), continuous="toi")
    for _ in range(6):
        world.step()
        if len(world.contacts):
            break
    assert len(world.contacts) and body.position[0] < 96.0
    for contact in world.contacts:
        found = detected(world, contact)
        off = [math.dist(point, (contact["point_x"], contact["point_y"])) for point in found.points]
        k = int(np.argmin(off))
        assert off[k] < 1e-6 and abs(found.separations[k] - contact["separation"]) < 1e-6
        assert math.dist(found.normal, (contact["normal_x"], contact["normal_y"])) < 1e-6


@pytest.mark.parametrize("solver", SOLVERS[2:])
def test_a_character_that_was_carried_after_the_solver(solver):
    world = world_for(solver)
    lift = world.add_body(Polygon.box(100, 10), position=(0, 10), kind="kinematic", velocity=(90.0, 37.0))
    hero = Character(world, Polygon.box(10, 20), (0, -5))
    crate = world.add_body(Polygon.box(12, 12), position=(11.2, -1.2))
    seen = 0
    for _ in range(40):
        hero.move(0.7, 1.0)
        world.step()
        for contact in hero.body.contacts:
            found = detected(world, contact)
            off = [math.dist(point, (contact["point_x"], contact["point_y"])) for point in found.points]
            k = int(np.argmin(off))
            assert abs(found.separations[k] - contact["separation"]) < 0.1
            assert off[k] < 0.1, (lift, crate)
            seen += 1
    assert seen > 20


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_pixels_that_masks_share_at_the_end(solver):
    """The area of a mask's contact is the number of shared pixels at the final poses.

    It is tested against masks, discs, boxes, tiles and chain links.
    """
    world = world_for(solver, FULL.with_(continuous=False))
    world.add_body(TileGrid(np.ones((1, 30), bool), 16.0), position=(-240, 0), kind="static")
    world.add_body(Chain([(260.0, 0.0), (560.0, 0.0)]), kind="static")
    mask = PixelMask.from_array(DISC)
    for k, shape in enumerate((mask, Polygon.box(12, 12), Circle(6.0), mask, Capsule((-4, 0), (4, 0), 3.0))):
        for left in (-40.0, 400.0):
            world.add_body(shape, position=(left + 4.0 * k, -10 - 9.0 * k), velocity=(30.0 - 15.0 * k, 0.0))
            world.add_body(mask, position=(left + 40.0 + 4.0 * k, -10 - 9.0 * k), velocity=(-30.0, 0.0))
    seen = 0
    for _ in range(60 if JIT else 25):
        world.step()
        pairs = {}
        for contact in world.contacts:
            pairs.setdefault((int(contact["body_a"]), int(contact["body_b"])), []).append(contact)
        for (a, b), rows in pairs.items():
            kinds = {type(world.body(each).shapes[0]) for each in (a, b)}
            if PixelMask not in kinds:
                continue
            total = sum(float(each["area"]) for each in rows)
            whole = detected(world, rows[0], margin=0.0).area
            seen += 1
            # Of a grid a mask may have left one tile, or come to another, since it was looked at.
            assert total == whole or kinds & {TileGrid, Chain}, (total, whole)
            assert total <= whole
    assert seen > 40
