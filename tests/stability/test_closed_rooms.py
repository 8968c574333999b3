"""Closed rooms with every kind of wall keep the bodies inside them.

Resting rooms run under every solver; moving and rotating rooms run under the stacking solvers. A room is never narrower
than a body. The speeds of the room and of the bodies inside it are random.
"""

import itertools
import math

import numpy as np
import pytest

from physics import JIT, Capsule, Chain, Circle, Effects, Material, Polygon, Segment, TileGrid, World

WALLS = ("boxes", "segments", "chain", "tiles")
STACKING = ("soft_step", "sequential_impulse")
SOLVERS = (*STACKING, "projection", "blocking")
CASES = [*itertools.product(WALLS, SOLVERS, (False, True))]
CASES = [case for case in CASES if not case[2] or case[1] in STACKING]
ROUNDS = 16 if JIT else 1  # of each case, and as many more of every seed at night
STEPS = 120 if JIT else 25
THICK = 16.0  # [px] of walls that have an inside


def walls_of(kind, half_x, half_y):
    """Return the wall shapes around a free box of these half sizes [px] about the origin."""
    corners = [(-half_x, -half_y), (half_x, -half_y), (half_x, half_y), (-half_x, half_y)]
    if kind == "chain":
        return [Chain(corners[::-1], loop=True)]  # counter-clockwise on the screen: a room
    if kind == "segments":
        return [Segment(corners[k], corners[(k + 1) % 4]) for k in range(4)]
    wide, high = 2.0 * (half_x + THICK), 2.0 * (half_y + THICK)
    return [
        Polygon.box(wide, THICK, (0.0, -half_y - THICK / 2)),
        Polygon.box(wide, THICK, (0.0, half_y + THICK / 2)),
        Polygon.box(THICK, high, (-half_x - THICK / 2, 0.0)),
        Polygon.box(THICK, high, (half_x + THICK / 2, 0.0)),
    ]


def add_room(world, rng, kind, moves):
    """Add a random room and return (body of the room, its centre in body space, half sizes [px]). moves: True if it
    moves.
    """
    columns, rows = int(rng.integers(4, 9)), int(rng.integers(4, 9))
    half_x, half_y = columns * THICK / 2.0, rows * THICK / 2.0
    speed = rng.uniform(-400.0, 400.0, 2) * moves
    if kind == "tiles":
        solid = np.pad(np.zeros((rows, columns), bool), 1, constant_values=True)
        corner = (-half_x - THICK, -half_y - THICK)
        body = world.add_body(
            TileGrid(solid, THICK), position=corner, kind="kinematic" if moves else "static", velocity=tuple(speed)
        )
        return body, (half_x + THICK, half_y + THICK), (half_x, half_y)
    turn = float(rng.choice([0.0, 2.0, -6.0]) * moves)
    kind_of_body = (
        {"kind": "kinematic", "velocity": tuple(speed), "angular_velocity": turn} if moves else {"kind": "static"}
    )
    body = world.add_body(*walls_of(kind, half_x, half_y), **kind_of_body)
    return body, (0.0, 0.0), (half_x, half_y)


def fill(world, rng, half_x, half_y):
    """Add random bodies that do not touch, on a grid inside the room, and return them."""
    inside = []
    for x, y in itertools.product(np.arange(-half_x + 10, half_x - 9, 20.0), np.arange(-half_y + 10, half_y - 9, 20.0)):
        if len(inside) == 6 or rng.random() < 0.5:
            continue
        r = float(rng.uniform(2.0, 6.0))
        shape = (Circle(r), Polygon.box(2.0 * r, r), Capsule((-r / 2, 0), (r / 2, 0), r / 2), Polygon.box(r, r))[
            rng.integers(4)
        ]
        turn = rng.uniform(0.0, math.tau)
        inside.append(
            world.add_body(
                shape,
                position=(float(x), float(y)),
                angle=float(turn),
                velocity=tuple(10.0 ** rng.uniform(1.0, 3.7) * np.array((math.cos(turn), math.sin(turn)))),
                angular_velocity=float(rng.choice([0.0, 30.0])),
                material=Material(friction=float(rng.choice([0.0, 0.6])), restitution=float(rng.choice([0.0, 1.0]))),
                bullet=bool(rng.integers(2)),
            )
        )
    return inside


def outside(body, room, middle, halves):
    """Return how far [px] a body's centre of mass lies beyond the walls, 0 inside.

    middle: centre of the room in its body space. halves: half sizes of the room.
    """
    cosine, sine = math.cos(room.angle), math.sin(room.angle)
    x, y = body.center[0] - room.position[0], body.center[1] - room.position[1]
    u, v = cosine * x + sine * y - middle[0], cosine * y - sine * x - middle[1]
    return max(abs(u) - halves[0], abs(v) - halves[1], 0.0)


def lost_in(rng, kind, solver, moves, steps=STEPS):
    """Simulate one random room and return the bodies that are beyond its walls at the end. moves: True if the room
    moves.
    """
    stacking = solver in STACKING
    effects = Effects(response=True, gravity=True, rotation=True, friction=True, restitution=True, continuous=True)
    world = World(
        effects.with_(stacking=stacking),
        solver=solver,
        substeps=int(rng.choice([2, 4])),  # one does not carry an impact on to the wall behind what is hit
        gravity=(0.0, 313.6) if rng.integers(2) else (0.0, 0.0),
    )
    room, middle, halves = add_room(world, rng, kind, moves)
    inside = fill(world, rng, *halves)
    for _ in range(steps):
        world.step()
    return [
        (each.id, outside(each, room, middle, halves)) for each in inside if outside(each, room, middle, halves) > 0.0
    ]


@pytest.mark.parametrize("kind, solver, moves", CASES)
def test_nobody_gets_out_of_a_closed_room(kind, solver, moves):
    rng = np.random.default_rng(CASES.index((kind, solver, moves)))
    for number in range(ROUNDS):
        assert lost_in(rng, kind, solver, moves) == [], number


@pytest.mark.parametrize(
    "kind, solver, seed, number",
    [
        ("chain", "sequential_impulse", 0, 12),
        ("chain", "soft_step", 1, 0),
        ("chain", "soft_step", 2, 9),
        ("segments", "sequential_impulse", 2, 9),
    ],
)
def test_rooms_that_lost_somebody(kind, solver, seed, number):
    """Small bodies pressed into the corner of a rotating room stay inside; each of these random
    rooms once lost a body.
    """
    rng = np.random.default_rng([1000 + seed, CASES.index((kind, solver, True))])
    for _ in range(number):
        lost_in(rng, kind, solver, True, steps=0)
    assert lost_in(rng, kind, solver, True, steps=120) == []


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind, solver, moves", CASES)
def test_nobody_gets_out_of_a_thousand_more(kind, solver, moves, seed):
    rng = np.random.default_rng([1000 + seed, CASES.index((kind, solver, moves))])
    for number in range(ROUNDS):
        assert lost_in(rng, kind, solver, moves) == [], number
