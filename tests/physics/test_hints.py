"""Errors of every public callable for typical mistakes name the argument and the correct expression.

The mistakes are a pygame object, a value of another argument, a number instead of a Material or Filter, a misspelt
word, a class instead of an instance, and a keyword of another engine. Each error leaves the world unchanged.
"""

import dataclasses
import inspect

import numpy as np
import pygame
import pytest

import physics
from physics import (
    BROADPHASES,
    STATIC,
    Angle,
    Bounds,
    Capsule,
    Chain,
    Character,
    Circle,
    Distance,
    Drive,
    Effects,
    Filter,
    Gear,
    Material,
    Motor,
    NoContact,
    PixelMask,
    Polygon,
    Prismatic,
    Revolute,
    Segment,
    Snapshot,
    Spring,
    Target,
    TileGrid,
    Vec2,
    Weld,
    Wheel,
    World,
    collide,
    decompose,
    distance,
    fit,
    hull,
    mass_of,
    measure,
    time_of_impact,
)

BALL, BOX, MASK = Circle(3.0), Polygon.box(4, 4), PixelMask(np.ones((3, 3), bool))
RECT, SURFACE, BITS = pygame.Rect(1, 2, 30, 40), pygame.Surface((4, 4)), pygame.Mask((4, 4))
CORNERS = [(0, 0), (4, 0), (4, 4)]
SPRITE = pygame.sprite.Sprite()
OTHER = World(Effects.rigid_bodies().with_(joints=True))
BODY = OTHER.add_body(BALL)

FRECTS = [pygame.FRect] if hasattr(pygame, "FRect") else []  # pygame 2.6 has none
SHAPE = [
    (SURFACE, "PixelMask.from_surface(surface)"),
    (BITS, "PixelMask.from_mask(mask)"),
    (RECT, "Polygon.box(30, 40), placed at (16, 22)"),
    *((each(0, 0, 3, 5), "Polygon.box(3.0, 5.0)") for each in FRECTS),
    (SPRITE, "PixelMask.from_surface(sprite.image)"),
    (CORNERS, "Polygon(points)"),
    (tuple(CORNERS), "Polygon(points)"),
    (np.array(CORNERS), "Polygon(points)"),
    ([pygame.Vector2(0, 0), pygame.Vector2(1, 0), pygame.Vector2(0, 1)], "Polygon(points)"),
    (CORNERS[:2], "Segment(a, b)"),
    (np.ones((2, 2), bool), "PixelMask.from_array(solid), or TileGrid(solid, tile_size)"),
    (Circle, "Circle(…)"),
    (BODY, "*body.shapes"),
    (5, "Circle(5)"),
    ("ship.png", "pygame.image.load"),
    (Material(), "material=Material(…)"),
    (Filter(), "filter=Filter(…)"),
    (None, ""),
]
WITHOUT_LISTS = [each for each in SHAPE if not isinstance(each[0], (list, tuple))]  # callables that take one or many
PAIR = [
    (RECT, "rect.center or rect.topleft"),
    (5.0, "("),
    (BODY, "body.position"),
    ((1, 2, 3), ""),
    (pygame.Vector3(1, 2, 3), ""),
    ("1, 2", ""),
    (1 + 2j, "(z.real, z.imag)"),
]
NO_PAIRS = [({1, 2}, "got {1, 2}"), (b"ab", "got b'ab'"), ({1: 2, 3: 4}, "got {1: 2")]
POSE = [(RECT, "rect.center"), (BODY, "body.position"), ("0, 0", ""), ((1, 2, 3, 4), ""), *NO_PAIRS]
RECT_CORNERS = "[rect.topleft, rect.topright, rect.bottomright, rect.bottomleft]"
POINTS = {
    "Polygon": [(20, "Polygon.box(width, height)"), (RECT, "Polygon.box(30, 40, center=(16, 22))")],
    "Chain": [(20, "write Chain([(x, y), (x, y), …])"), (RECT, f"write Chain({RECT_CORNERS}, loop=True)")],
    "hull": [(20, "write hull([(x, y), (x, y), …])"), (RECT, f"write hull({RECT_CORNERS})")],
    "decompose": [(20, "write decompose([(x, y), (x, y), …])"), (RECT, f"write decompose({RECT_CORNERS})")],
}
for _each in POINTS.values():
    _each += [
        (SURFACE, "PixelMask.from_surface(surface)"),
        (np.float32(2.5), _each[0][1]),
        ("0, 0", "(got '0, 0')"),
        (None, "(got None)"),
        ((3, 4), "[(3, 4)] for one point"),
        (BALL, "write shape.points"),
        ({(0, 0), (4, 0), (4, 4)}, "write a list, because a set has no order"),
        (iter(CORNERS), "write [*points], a list"),
        (np.ones((3, 2), bool), "an array of bool"),
        ([(0, 0), (1, "x")], "(got [(0, 0), (1, 'x')])"),
    ]
POSITIONS = [((3, 4), "[(3, 4)]"), (5, ""), ("ab", ""), (RECT, ""), ({(3, 4), (5, 6)}, "a set has no order")]
MANY = [((3, 4), "write [(3, 4)] * 2"), ([(3, 4)], "2 rows")]  # of two bodies
ANGLES = [(0.5, "write [0.5] * 2"), ([0.5], "2 rows")]
SETS = [({(3, 4), (5, 6)}, "a set has no order"), ({3, 4}, "a set has no order")]
PLACES = [((3, 4), "write [(3, 4)] for one point"), (5, "write [(x, y)]"), *SETS]
MATERIAL = [
    (0.5, "Material(friction=0.5)"),
    ({"friction": 0.5, "density": 2}, "Material(friction=0.5, density=2)"),
    (Filter(), "filter=Filter(…)"),
    (Material, "Material()"),
    ("ice", "Material(friction=…"),
]
FILTER = [
    (3, "Filter(membership=3)"),
    ((1, 6), "Filter(membership=1, mask=6)"),
    (Material(), "material=Material(…)"),
    (Filter, "Filter()"),
    ("enemy", "Filter(membership=…"),
]
KIND = [
    (STATIC, 'kind="static"'),
    (np.int64(2), 'kind="dynamic"'),
    ("dynmic", '"dynamic"'),
    ("Static", '"static"'),
    (True, ""),
    (None, ""),
]
CONTINUOUS = [(True, 'continuous="toi"'), (False, 'continuous="off"'), ("TOI", '"toi"'), ("sweept", '"swept"')]
TIER = [("hulls", '"hull"'), ("Pixels", '"pixels"'), (3, "")]
SOLVER = [("soft-step", '"soft_step"'), ("SequentialImpulse", '"sequential_impulse"'), (0, "")]
BOX_SIDES = [((3, 4), "Polygon.box(width, height)"), (RECT, "Polygon.box(width, height)")]
BITS_OF_PYGAME = [(SURFACE, "PixelMask.from_surface(surface)"), (BITS, "PixelMask.from_mask(mask)")]
SOLID = [
    *BITS_OF_PYGAME,
    ("level.txt", "'level.txt'"),
    (["#..", "###"], '[[each == "#" for each in row] for row in rows]'),
    ([["#", "."]], '[[each == "#" for each in row] for row in rows]'),
    (np.zeros((2, 3, 4), np.uint8), "(2, 3, 4)"),
    ("ship.png", "PixelMask.from_surface(pygame.image.load('ship.png'))"),
    ((3, 4), "np.ones((4, 3), bool)"),
    (RECT, "np.ones((40, 30), bool)"),
    (5, "(got 5)"),
]
SURFACES = [
    ("ship.png", "pygame.image.load('ship.png')"),
    (BITS, "PixelMask.from_mask(mask)"),
    (SPRITE, "sprite.image"),
]
PYGAME_MASKS = [(SURFACE, "PixelMask.from_surface(surface)"), (SPRITE, "sprite.image"), (5, "")]
MASKS = [(SURFACE, "from_surface"), (BITS, "from_mask"), (SPRITE, "sprite.image"), (BALL, "")]
ONE_SHAPE = [*SHAPE, ([BALL, BOX], "one shape")]
SHAPES = [
    ([BALL, BOX], "*shapes"),
    ((3, 4), "position=(3, 4) for a place, Polygon.box(3, 4) for a size"),
    ((0, 0), "write position=(0, 0) for a place"),
    ("static", "kind='static'"),
]
JOINT = [(Revolute, "Revolute(…)"), (BODY, "Revolute(a, b, at)"), ("hinge", "")]
JOINT_KIND = [("revolute", "Revolute, the class"), (Revolute(0, 1, (0, 0)), "the class")]
BROADPHASE = [
    ("quadtree", "brute, sweep, hash, tree"),
    ("tre", '"tree"'),
    ("Hash", '"hash"'),
    (physics.DynamicTree, "DynamicTree()"),
    (7, "brute, sweep"),
]
EFFECTS = [
    ("gravity", "Effects(gravity=True)"),
    (["gravity", "drag"], "Effects(gravity=True, drag=True)"),
    ({"drag": True, "wind": False}, "Effects(drag=True)"),
    (Effects, "Effects()"),
    (Effects.rigid_bodies, "Effects.rigid_bodies()"),
    (7, "Effects.rigid_bodies()"),
    ("brute", "(got 'brute'): write Effects.rigid_bodies()"),
    (["gravity", "brute"], "Effects.rigid_bodies()"),
]
FLAG = [(1, "True"), (0, "False"), ("yes", ""), (None, "")]
NUMBER = [("5", ""), ([5], ""), (1j, "")]
RADIUS = [((3, 4), "Circle(radius, center)"), ("5", ""), (None, "")]
WHOLE = [(8.0, "write 8"), (8.5, ""), ("8", "")]
IDS = [("crate", ""), (1.5, ""), (BALL, "")]
SPRING = [(2.0, "Spring(2.0)"), ("stiff", "")]
DRIVE = [(2.0, "Drive(2.0, max=…)"), ("fast", "")]
RANGE = [(3.0, ""), ("ab", ""), *NO_PAIRS]
LIMITS = [(3.0, "write (None, 3.0)"), ("ab", ""), *NO_PAIRS, (np.zeros((2, 3)), "limits[0] must be a number")]
SUBSTEPS = [("many", 'a whole number from 1 to 1000, or "auto"'), ("Auto", '"auto"'), *WHOLE[:2]]
PATH = [(5, "a str or a pathlib.Path"), (None, "a str or a pathlib.Path"), (BALL, "a str or a pathlib.Path")]


def make_world():
    """Return a world with every effect, a dynamic, a static and a kinematic body, a joint, and a mask."""
    effects = Effects(**{each.name: True for each in Effects.__dataclass_fields__.values()})
    world = World(effects)
    world.add_body(BALL, velocity=(5.0, 3.0))
    world.add_body(BOX, position=(2.0, 9.0), kind="static")
    world.add_body(MASK, position=(90.0, 1.0), kind="kinematic")
    world.add_body(MASK, position=(200.0, 1.0))
    world.add_joint(Revolute(0, 3, (50, 0)))
    world.step()
    return world


def setter(identity, name):
    return lambda w, v: setattr(w.body(identity), name, v)


def world_setter(name):
    return lambda w, v: setattr(w, name, v)


def motor(local):
    return Motor(0, 3, max_force=1.0, max_torque=1.0, local=local)


def grid():
    return World().add_body(TileGrid(np.zeros((3, 3), bool), 8), kind="static")


CALLS = [
    ("radius", RADIUS, lambda w, v: Circle(v)),
    ("center", PAIR, lambda w, v: Circle(1, v)),
    ("a", PAIR, lambda w, v: Capsule(v, (1, 1), 2)),
    ("b", PAIR, lambda w, v: Capsule((1, 1), v, 2)),
    ("radius", NUMBER, lambda w, v: Capsule((1, 1), (2, 2), v)),
    ("a", PAIR, lambda w, v: Segment(v, (1, 1))),
    ("points", POINTS["Polygon"], lambda w, v: Polygon(v)),
    ("points", POINTS["Chain"], lambda w, v: Chain(v)),
    ("points", POINTS["hull"], lambda w, v: hull(v)),
    ("points", POINTS["decompose"], lambda w, v: decompose(v)),
    ("width", BOX_SIDES, lambda w, v: Polygon.box(v, 1)),
    ("width", [(1e300, "by a factor below 1e+09"), (1e-12, "")], lambda w, v: Polygon.box(v, 1)),
    ("radius", [(1e300, "more than 1e-09 of the radius")], lambda w, v: Capsule((0, 0), (1, 0), v)),
    ("ghosts", [({(0, 0), (9, 9)}, "(before, after)"), (5, "")], lambda w, v: Chain(CORNERS, ghosts=v)),
    ("slopes", [(10**400, "got int"), ("ab", "got str")], lambda w, v: TileGrid([[False]], 8, slopes=v)),
    ("holes", [(np.array(3.0), "a list of polygons"), (5, ""), ("ab", "")], lambda w, v: decompose(CORNERS, v)),
    ("lower", [(10**400, ""), ("ab", ""), ([(1, 2), (3,)], "")], lambda w, v: physics.DynamicTree().find_pairs(v, v)),
    ("names", [(5, ""), (None, ""), ([1, 2], "a list of names"), (np.array(3), "")], lambda w, v: Effects.named(v)),
    ("name", [([], ""), (5, "a string"), (None, "")], lambda w, v: Effects.rigid_bodies().without(v)),
    ("name", [([], ""), (5, "a string"), (None, "")], lambda w, v: Effects.rigid_bodies().and_needed(v)),
    ("on", FLAG, lambda w, v: w.set_narrowphase(v)),
    ("center", PAIR, lambda w, v: Polygon.box(2, 3, v)),
    ("shape", [each for each in SHAPE if each[0] is not None], lambda w, v: Bounds(v)),
    ("solid", SOLID, lambda w, v: PixelMask(v)),
    ("solid", SOLID, lambda w, v: TileGrid(v, 16)),
    ("surface", SURFACES, lambda w, v: PixelMask.from_surface(v)),
    ("mask", PYGAME_MASKS, lambda w, v: PixelMask.from_mask(v)),
    ("origin", PAIR, lambda w, v: PixelMask(np.ones((2, 2), bool), v)),
    ("snap", FLAG, lambda w, v: PixelMask(np.ones((2, 2), bool), snap=v)),
    ("material", MATERIAL, lambda w, v: BALL.with_(material=v)),
    ("filter", FILTER, lambda w, v: BALL.with_(filter=v)),
    ("sensor", FLAG[:3], lambda w, v: BALL.with_(sensor=v)),
    ("one_way", FLAG[:3], lambda w, v: MASK.with_(one_way=v)),
    ("mask", MASKS, lambda w, v: fit(v, "hull")),
    ("tier", TIER, lambda w, v: fit(MASK, v)),
    ("mask", MASKS, lambda w, v: measure(v, BALL)),
    ("shapes", WITHOUT_LISTS, lambda w, v: mass_of(v, 1.0)),
    ("membership", WHOLE, lambda w, v: Filter(v)),
    ("friction", NUMBER, lambda w, v: Material(friction=v)),
    ("shape_a", SHAPE, lambda w, v: collide(v, (0, 0), BALL, (0, 0))),
    ("pose_a", POSE, lambda w, v: collide(BALL, v, BALL, (0, 0))),
    ("shape_b", SHAPE, lambda w, v: distance(BALL, (0, 0), v, (0, 0))),
    ("pose_b", POSE, lambda w, v: distance(BALL, (0, 0), BALL, v)),
    ("shape_a", SHAPE, lambda w, v: time_of_impact(v, (0, 0), (1, 1), BALL, (0, 0), (1, 1))),
    ("end_b", POSE, lambda w, v: time_of_impact(BALL, (0, 0), (1, 1), BALL, (0, 0), v)),
    ("effects", EFFECTS, lambda w, v: World(v)),
    ("broadphase", BROADPHASE, lambda w, v: World(broadphase=v)),
    ("solver", SOLVER, lambda w, v: World(solver=v)),
    ("gravity", PAIR, lambda w, v: World(gravity=v)),
    ("substeps", SUBSTEPS, lambda w, v: World(substeps=v)),
    ("seed", WHOLE, lambda w, v: World(seed=v)),
    ("shapes", SHAPE, lambda w, v: w.add_body(v)),
    ("shapes", SHAPES, lambda w, v: w.add_body(v)),
    ("position", PAIR, lambda w, v: w.add_body(BALL, position=v)),
    ("velocity", PAIR, lambda w, v: w.add_body(BALL, velocity=v)),
    ("angle", NUMBER, lambda w, v: w.add_body(BALL, angle=v)),
    ("kind", KIND, lambda w, v: w.add_body(BALL, kind=v)),
    ("material", MATERIAL, lambda w, v: w.add_body(BALL, material=v)),
    ("filter", FILTER, lambda w, v: w.add_body(BALL, filter=v)),
    ("sensor", FLAG, lambda w, v: w.add_body(BALL, sensor=v)),
    ("bullet", FLAG, lambda w, v: w.add_body(BALL, bullet=v)),
    ("continuous", CONTINUOUS, lambda w, v: w.add_body(BALL, continuous=v)),
    ("gravity_scale", [((0, 9), "World(gravity=(0, 9))"), *NUMBER], lambda w, v: w.add_body(BALL, gravity_scale=v)),
    ("tier", TIER, lambda w, v: w.add_body(MASK, tier=v)),
    ("shape must be a shape", ONE_SHAPE, lambda w, v: w.add_bodies(v, [(0, 0)])),
    ("positions", POSITIONS, lambda w, v: w.add_bodies(BALL, v)),
    ("velocities", [((3, 4), "[(3, 4)]")], lambda w, v: w.add_bodies(BALL, [(0, 0)], v)),
    ("velocities", MANY, lambda w, v: w.add_bodies(BALL, [(0, 0), (9, 9)], v)),
    ("angles", ANGLES, lambda w, v: w.add_bodies(BALL, [(0, 0), (9, 9)], angles=v)),
    ("kind", KIND, lambda w, v: w.add_bodies(BALL, [(0, 0)], kind=v)),
    ("filter", FILTER, lambda w, v: w.add_bodies(BALL, [(0, 0)], filter=v)),
    ("body", IDS, lambda w, v: w.remove_body(v)),
    ("ids", [("crate", ""), (1.5, "")], lambda w, v: w.remove_bodies(v)),
    ("ids", [({0, 3}, "in the order of the result"), ([[0], [1, 2]], ""), ("ab", "")], lambda w, v: w.rows(v)),
    ("ids", [("", ""), (b"a", ""), (np.array(0.0), ""), (5.0, "")], lambda w, v: w.remove_joints(v)),
    ("joint", [(True, "got True"), ("ab", "")], lambda w, v: w.joint(v)),
    ("bodies_a", [(np.array(3.0), ""), (b"ab", ""), (5, "")], lambda w, v: w.add_joints(Angle, v, [1])),
    ("at", [([(1, 2), (3,)], "rows of different lengths")], lambda w, v: w.add_joints(Revolute, [0, 0], [3, 3], at=v)),
    ("solid", [([[True], [True, False]], "a bool"), (1, "a bool")], lambda w, v: grid().set_cells([(0, 0)], v)),
    ("local", [(np.zeros(2), "True or False"), (1, "write True")], lambda w, v: w.add_joint(motor(v))),
    ("path", [("", "must name a file (got '')")], lambda w, v: w.snapshot().save(v)),
    ("ids", [({0, 3}, "a list, because a set has no order")], lambda w, v: w.move(v, [(0, 0), (9, 9)])),
    ("ids", [(frozenset([0]), "in the order of positions")], lambda w, v: w.move(v, [(0, 0)])),
    ("bodies_a", [({0, 3}, "in the order of bodies_b")], lambda w, v: w.add_joints(Angle, v, [2, 1])),
    ("bodies_b", [({0, 3}, "in the order of bodies_a")], lambda w, v: w.add_joints(Angle, [2, 1], v)),
    ("cells", [({(0, 0), (1, 1)}, "a set has no order")], lambda w, v: grid().set_cells(v, [True, False])),
    ("positions", POSITIONS, lambda w, v: w.move([0], v)),
    ("velocities", MANY, lambda w, v: w.move([0, 3], [(0, 0), (9, 9)], velocities=v)),
    ("angles", ANGLES, lambda w, v: w.move([0, 3], [(0, 0), (9, 9)], v)),
    ("ids", [("crate", ""), (1.5, "")], lambda w, v: w.touch(v)),
    ("identity", IDS, lambda w, v: w.body(v)),
    ("effects", EFFECTS, lambda w, v: w.set_effects(v)),
    ("solver", SOLVER, world_setter("solver")),
    ("broadphase", BROADPHASE, world_setter("broadphase")),
    ("joint_solver", [("Direct", '"direct"')], world_setter("joint_solver")),
    ("gravity", PAIR, world_setter("gravity")),
    ("wind", PAIR, world_setter("wind")),
    ("dt", NUMBER, world_setter("dt")),
    ("substeps", SUBSTEPS, world_setter("substeps")),
    ("snapshot", [("a.npz", "Snapshot.load(path)")], lambda w, v: w.restore(v)),
    ("path", PATH, lambda w, v: Snapshot.load(v)),
    ("path", PATH, lambda w, v: w.snapshot().save(v)),
    ("origin", PAIR, lambda w, v: w.ray_cast(v, (1, 0))),
    ("translation", PAIR, lambda w, v: w.ray_cast((1, 0), v)),
    ("filter", FILTER, lambda w, v: w.ray_cast((1, 0), (1, 1), filter=v)),
    ("sensors", FLAG, lambda w, v: w.ray_cast((1, 0), (1, 1), sensors=v)),
    ("filter", FILTER, lambda w, v: w.ray_cast_all((1, 0), (1, 1), filter=v)),
    ("shape", SHAPE, lambda w, v: w.shape_cast(v, (0, 0), (1, 1))),
    ("pose", POSE, lambda w, v: w.shape_cast(BALL, v, (1, 1))),
    ("filter", FILTER, lambda w, v: w.shape_cast(BALL, (0, 0), (1, 1), filter=v)),
    ("point", PAIR, lambda w, v: w.closest(v)),
    ("filter", FILTER, lambda w, v: w.closest((0, 0), filter=v)),
    ("shape", ONE_SHAPE, lambda w, v: w.overlap(v, (0, 0))),
    ("pose", POSE, lambda w, v: w.overlap(BALL, v)),
    ("filter", FILTER, lambda w, v: w.overlap(BALL, (0, 0), filter=v)),
    ("lower", PAIR, lambda w, v: w.query_aabb(v, (9, 9))),
    ("point", PAIR, lambda w, v: w.query_point(v)),
    ("points", PLACES, lambda w, v: w.query_points(v)),
    ("origins", POSITIONS, lambda w, v: w.ray_casts(v, [(1, 0)])),
    ("joint", JOINT, lambda w, v: w.add_joint(v)),
    ("kind", JOINT_KIND, lambda w, v: w.add_joints(v, [0], [3])),
    ("a", IDS, lambda w, v: w.add_joint(Revolute(v, 3, (0, 0)))),
    ("at", PAIR, lambda w, v: w.add_joint(Revolute(0, 3, v))),
    ("axis", PAIR, lambda w, v: w.add_joint(Prismatic(0, 3, (0, 0), axis=v))),
    ("motor", DRIVE, lambda w, v: w.add_joint(Wheel(0, 3, (0, 0), motor=v))),
    ("spring", SPRING, lambda w, v: w.add_joint(Distance(0, 3, (0, 0), (9, 9), spring=v))),
    ("limits", LIMITS, lambda w, v: w.add_joint(Angle(0, 3, limits=v))),
    ("breaks", RANGE, lambda w, v: w.add_joint(Weld(0, 3, (0, 0), breaks=v))),
    ("velocity", PAIR, lambda w, v: w.add_joint(Motor(0, 3, velocity=v, max_force=1, max_torque=1))),
    ("point", PAIR, lambda w, v: w.add_joint(Target(0, (0, 0), point=v))),
    ("spring", SPRING, lambda w, v: setattr(w.joint(0), "spring", v)),
    ("motor", DRIVE, lambda w, v: setattr(w.joint(0), "motor", v)),
    ("limits", LIMITS, lambda w, v: setattr(w.joint(0), "limits", v)),
    ("position", PAIR, setter(0, "position")),
    ("velocity", PAIR, setter(0, "velocity")),
    ("angle", NUMBER, setter(0, "angle")),
    ("material", MATERIAL, setter(0, "material")),
    ("filter", FILTER, setter(0, "filter")),
    ("sensor", FLAG, setter(0, "sensor")),
    ("continuous", CONTINUOUS, setter(0, "continuous")),
    ("tier", TIER, setter(2, "tier")),
    ("kind", KIND, lambda w, v: w.body(0).set_kind(v)),
    ("shapes", SHAPE, lambda w, v: w.body(0).set_shapes(v)),
    ("shape", SHAPE, lambda w, v: w.body(0).add_shape(v)),
    ("position", PAIR, lambda w, v: w.body(0).move_to(v)),
    ("position", PAIR, lambda w, v: w.body(2).set_target(v)),
    ("force", PAIR, lambda w, v: w.body(0).apply_force(v)),
    ("impulse", PAIR, lambda w, v: w.body(0).apply_impulse(v)),
    ("point", PAIR, lambda w, v: w.body(0).to_world(v)),
    ("shape", SHAPE[:3], lambda w, v: w.body(2).carve(v, (0, 0))),
    ("shape", SHAPE, lambda w, v: Character(w, v, (0, 0))),
    ("world", [(BALL, "Character(world, shape, position)"), (None, "")], lambda w, v: Character(v, BOX, (0, 0))),
    ("position", PAIR, lambda w, v: Character(w, BOX, v)),
    ("filter", FILTER, lambda w, v: Character(w, BOX, (0, 0), filter=v)),
]


def state(world):
    """Return all state that an error must not change."""
    return world.digest(), world.bodies.tobytes(), world.shapes.tobytes(), len(world.joints), len(world.characters.rows)


@pytest.mark.parametrize(("name", "values", "call"), CALLS, ids=[f"{name}-{k}" for k, (name, _, _) in enumerate(CALLS)])
def test_a_typical_wrong_argument_gets_the_right_name_and_changes_nothing(name, values, call):
    world = make_world()
    before = state(world)
    for value, hint in values:
        with pytest.raises((TypeError, ValueError)) as caught:
            call(world, value)
        text = str(caught.value)
        assert name in text and "got" in text, f"{text!r} does not name {name}"
        assert hint in text, f"{text!r} does not say {hint}"
        assert len(text) < 600 and "\n" not in text, text
    assert state(world) == before


MISSING = [
    (Circle, (), "Circle() needs radius (got no radius): write Circle(radius)"),
    (Capsule, (5,), "needs a, b, radius (got no b, no radius): write Capsule((x, y), (x, y), radius)"),
    (Capsule, ((0, 0), (1, 1)), "(got no radius): write Capsule((x, y), (x, y), radius)"),
    (Segment, (5,), "Segment() needs a, b (got no b): write Segment((x, y), (x, y))"),
    (Polygon, (), "write Polygon([(x, y), (x, y), (x, y)])"),
    (Polygon.box, (5,), "Polygon.box() needs width, height (got no height): write Polygon.box(width, height)"),
    (Chain, (), "write Chain([(x, y), (x, y)])"),
    (TileGrid, ([[True]],), "TileGrid() needs solid, tile_size (got no tile_size): write TileGrid(solid, tile_size)"),
    (PixelMask, (), "write PixelMask.from_surface(surface)"),
    (PixelMask.from_mask, (), "PixelMask.from_mask() needs mask (got no mask)"),
    (OTHER.ray_cast, ((0, 0),), "needs origin, translation (got no translation)"),
    (Polygon, (CORNERS[:2],), "(got 2): write Segment(a, b), or Capsule(a, b, radius)"),
]


@pytest.mark.parametrize(("called", "given", "words"), MISSING)
def test_a_missing_argument_gets_a_call_that_has_all(called, given, words):
    with pytest.raises((TypeError, ValueError)) as caught:
        called(*given)
    assert words in str(caught.value) and caught.value.__context__ is None, str(caught.value)


def test_a_missing_argument_by_keyword_is_named():
    with pytest.raises(TypeError, match=r"Capsule\(\) needs a, b, radius \(got no a\)"):
        Capsule(radius=3, b=(0, 0))


def test_an_error_within_a_call_is_not_taken_for_a_missing_argument():
    with pytest.raises(TypeError, match="radius must be a number"):
        Circle("5")


# ---- keywords --------------------------------------------------------------------------------------------------------

NAMED = [
    (World, {}), (Circle, {"radius": 3}), (Capsule, {"a": (0, 0), "b": (1, 1), "radius": 3}),
    (Polygon, {"points": CORNERS}),
    (Polygon.box, {"width": 3, "height": 3}), (Segment, {"a": (0, 0), "b": (1, 1)}), (Chain, {"points": CORNERS}),
    (Material, {}), (Filter, {}), (Effects, {}), (Drive, {"speed": 1, "max": 1}), (Spring, {"hertz": 1}),
    (Revolute, {"a": 0, "b": 1, "at": (0, 0)}), (Prismatic, {"a": 0, "b": 1, "at": (0, 0)}),
    (Wheel, {"a": 0, "b": 1, "at": (0, 0)}), (Distance, {"a": 0, "b": 1, "at_a": (0, 0), "at_b": (1, 1)}),
    (Weld, {"a": 0, "b": 1, "at": (0, 0)}), (Angle, {"a": 0, "b": 1}), (Motor, {"a": 0, "b": 1}),
    (Target, {"body": 0, "at": (0, 0)}), (NoContact, {"a": 0, "b": 1}),
    (PixelMask, {"solid": [[True]]}), (TileGrid, {"solid": [[True]], "tile_size": 8}),
]  # fmt: skip


def slips(name):
    """Return three misspellings of a keyword: one letter missing, two exchanged, another case;
    [] for short keywords.
    """
    if len(name) < 4:
        return []
    return [name[:2] + name[3:], name[:-2] + name[-1] + name[-2], name.title()]


@pytest.mark.parametrize(("called", "given"), NAMED, ids=[each.__name__ for each, _ in NAMED])
def test_a_misspelt_keyword_gets_the_right_one(called, given):
    assert called(**given) is not None
    names = [each for each in inspect.signature(called).parameters if not each.startswith("_")]
    for name in names:
        for slip in {*slips(name)} - {*names}:
            with pytest.raises(TypeError) as caught:
                called(**{**given, slip: 0.25})
            text = str(caught.value)
            assert repr(slip) in text and f"write {name}=" in text, text


def test_a_misspelt_keyword_of_add_body_gets_the_right_one_and_adds_nothing():
    world = make_world()
    before, names = state(world), [*inspect.signature(world.add_body).parameters][1:]
    assert "others" not in names and len(names) == 16
    for add in (
        lambda **given: world.add_body(BALL, **given),
        lambda **given: world.add_bodies(BALL, [(0, 0)], **given),
    ):
        for name in names:
            if add.__code__.co_names[0] == "add_bodies" and name in ("position", "velocity", "angle"):
                continue
            for slip in {*slips(name)} - {*names}:
                with pytest.raises(TypeError, match=f"write {name}="):
                    add(**{slip: 0.25})
    assert state(world) == before


FOREIGN = [
    ({"friction": 0.5}, "material=Material(friction=0.5)"),
    ({"elasticity": 0.5}, "material=Material(restitution=0.5)"),
    ({"density": 2}, "material=Material(density=2)"),
    ({"mask": 6}, "filter=Filter(mask=6)"),
    ({"category": 2}, "filter=Filter(membership=2)"),
    ({"pos": (1, 2)}, "position=(1, 2)"),
    ({"x": 3}, "position=(x, y)"),
    ({"static": True}, 'kind="static"'),
    ({"body_type": 1}, 'kind="static", "kinematic" or "dynamic"'),
    ({"is_sensor": True}, "sensor=True"),
    ({"linear_velocity": (1, 0)}, "velocity=(vx, vy)"),
    ({"user_data": "crate"}, "user='crate'"),
    ({"shape": BALL}, "add_body(Circle(8), …)"),
    ({"rotation": 90}, "angle=…, in radians"),
    ({"surprise": 1}, "its arguments are *shapes, position, angle"),
]


@pytest.mark.parametrize(("given", "hint"), FOREIGN, ids=[next(iter(given)) for given, _ in FOREIGN])
def test_a_keyword_of_another_engine_gets_ours(given, hint):
    with pytest.raises(TypeError, match="unexpected keyword") as caught:
        World().add_body(BALL, **given)
    assert hint in str(caught.value), str(caught.value)


FOREIGN_ELSEWHERE = [
    (lambda w: Filter(1, group=2), "membership=…, mask=…"),
    (lambda w: w.add_body(BALL, collision_type=7), "user=7"),
    (lambda w: w.add_bodies(BALL, [(0, 0)], velocity=(1, 2)), "velocities=[(1, 2)] * n"),
    (lambda w: w.add_bodies(BALL, [(0, 0)], angle=0.5), "angles=[0.5] * n"),
    (lambda w: w.add_bodies(BALL, [(0, 0)], position=(1, 2)), "positions=[(1, 2)]"),
    (lambda w: Distance(0, 3, (0, 0), (9, 9), max_length=90), "limits=(None, 90)"),
    (lambda w: Distance(0, 3, (0, 0), (9, 9), min_length=5), "limits=(5, None)"),
    (lambda w: Distance(0, 3, (0, 0), (9, 9), rest_length=5), "length=5"),
    (lambda w: w.ray_cast((0, 0), end=(9, 9)), "translation=…, the end minus the origin"),
    (lambda w: w.ray_cast_all((0, 0), direction=(9, 9)), "translation=…"),
    (lambda w: w.ray_cast((0, 0), (9, 9), ignore=0), "filter=Filter(mask=…)"),
    (lambda w: w.ray_casts([(0, 0)], [(9, 9)], exclude=0), "filter=Filter(mask=…)"),
    (lambda w: w.shape_cast(BALL, (0, 0), (9, 9), include_sensors=True), "sensors=True"),
    (lambda w: w.closest((0, 0), sensor=True), "sensors=True"),
    (lambda w: w.overlap(BALL, (0, 0), mask=6), "filter=Filter(mask=6)"),
    (lambda w: w.query_aabb((0, 0), (9, 9), sensor=True), "sensors=True"),
    (lambda w: w.query_rect(RECT, layers=3), "filter=Filter(membership=3)"),
    (lambda w: w.query_point((0, 0), max_distance=3), "its arguments are point, filter, sensors"),
    (lambda w: w.query_points([(0, 0)], sensor=True), "sensors=True"),
    (lambda w: World(joints=True), "effects=Effects.rigid_bodies().with_(joints=True)"),
    (lambda w: World(rotation=False), "effects=Effects.rigid_bodies().with_(rotation=False)"),
    (lambda w: w.set_effects(carving=True), "effects=Effects.rigid_bodies().with_(carving=True)"),
    (lambda w: Effects.rigid_bodies(joints=True), "write Effects.rigid_bodies().with_(joints=True)"),
    (lambda w: Effects.detection(sensors=True), "write Effects.detection().with_(sensors=True)"),
]


@pytest.mark.parametrize(("call", "hint"), FOREIGN_ELSEWHERE, ids=[hint for _, hint in FOREIGN_ELSEWHERE])
def test_a_foreign_keyword_of_other_callables_gets_ours(call, hint):
    world = make_world()
    before = state(world)
    with pytest.raises(TypeError, match="unexpected keyword") as caught:
        call(world)
    assert hint in str(caught.value), str(caught.value)
    assert state(world) == before


def test_no_hint_names_an_argument_that_the_function_lacks():
    for called, given in NAMED:
        names = {*inspect.signature(called).parameters}
        for word in physics.hints.MEANT.keys() - names:
            with pytest.raises(TypeError, match="unexpected keyword") as caught:
                called(**{**given, word: 1})
            text = str(caught.value)
            assert "its arguments are" in text or any(f"{name}=" in text.split("write ")[1] for name in names), text


def test_the_hints_know_every_effect():
    assert list(physics.hints.EFFECTS) == [field.name for field in dataclasses.fields(Effects)]


@pytest.mark.parametrize(("effects", "call", "expression"), [
    (None, lambda w, b: b.carve(BALL, (0, 0)), "Effects.rigid_bodies().with_(carving=True)"),
    (None, lambda w, b: w.add_joint(Revolute(None, b, at=(0, 0))), "Effects.rigid_bodies().with_(joints=True)"),
    (
        Effects.detection(), lambda w, b: w.add_joint(Revolute(None, b, at=(0, 0))),
        "Effects(response=True, stacking=True, joints=True)",
    ),
    (Effects(response=True, gravity=True), lambda w, b: w.add_body(MASK, sensor=True), "gravity=True, sensors=True)"),
])  # fmt: skip
def test_a_missing_effect_comes_with_the_expression_that_declares_it(effects, call, expression):
    """The error for a missing effect contains the expression that declares it.

    The expression keeps the effects of the world and adds those that the missing one needs.
    """
    world = World(effects)
    body = world.add_body(BALL)
    with pytest.raises(ValueError, match="needs the effect (carving|joints|sensors): declare it in Effects") as caught:
        call(world, body)
    text = str(caught.value)
    assert text.endswith(expression), text
    other = World(eval(text.partition("declare it in ")[2]))
    call(other, other.add_body(MASK))


# ---- attributes ------------------------------------------------------------------------------------------------------

ATTRIBUTES = [
    ("mass", 3.0, "material = Material(density=…)"),
    ("kind", "static", "set_kind('static')"),
    ("shapes", [BALL], "set_shapes("),
    ("center", (1, 2), "position"),
    ("awake", True, "wake()"),
    ("friction", 0.5, "material = Material(friction=0.5)"),
    ("elasticity", 0.5, "material = Material(restitution=0.5)"),
    ("pos", (1, 2), "position = (1, 2)"),
    ("x", 5, "position = (x, y)"),
    ("rotation", 5, "angle = …, in radians"),
    ("type", "static", "set_kind("),
    ("force", (1, 2), "apply_force((1, 2))"),
    ("velocty", (1, 2), "velocity"),
]
WORLD_ATTRIBUTES = [
    ("effects", Effects(), "set_effects(Effects())"),
    ("fps", 50, "dt = 1 / 50"),
    ("iterations", 5, "substeps = 5"),
    ("bodies", [], "add_body(…)"),
]
JOINT_ATTRIBUTES = [
    ("stifness", 1, "spring = Spring(hertz=…"),
    ("stiffness", 1, "spring = Spring(hertz=…"),
    ("motor_sped", 3, "motor = Drive(speed=3, max=…)"),
    ("rate", 3, "motor = Drive(speed=3, max=…)"),
    ("motr", None, "did you mean motor?"),
    ("enabld", False, "did you mean enabled?"),
    ("limit", (0, 1), "did you mean limits?"),
    ("upper", 1, "limits = (low, high)"),
    ("max_force", 1e6, "breaks = (1000000.0, None), or give max_force to a new Target or Motor"),
    ("body_b", 1, "remove(), and world.add_joint(…)"),
    ("colour", "red", "has no attribute colour"),
]


@pytest.mark.parametrize(("name", "value", "hint"), ATTRIBUTES, ids=[name for name, _, _ in ATTRIBUTES])
def test_an_attribute_that_a_body_cannot_have_gets_the_right_one(name, value, hint):
    world = make_world()
    before = state(world)
    with pytest.raises(AttributeError, match=f"Body.* {name}|Body.{name} cannot be set") as caught:
        setattr(world.body(0), name, value)
    assert hint in str(caught.value), str(caught.value)
    assert state(world) == before


@pytest.mark.parametrize(("name", "value", "hint"), WORLD_ATTRIBUTES, ids=[name for name, _, _ in WORLD_ATTRIBUTES])
def test_an_attribute_that_a_world_cannot_have_gets_the_right_one(name, value, hint):
    world = make_world()
    before = state(world)
    with pytest.raises(AttributeError, match=f"World.* {name}|World.{name} cannot be set") as caught:
        setattr(world, name, value)
    assert hint in str(caught.value), str(caught.value)
    assert state(world) == before


@pytest.mark.parametrize(("name", "value", "hint"), JOINT_ATTRIBUTES, ids=[name for name, _, _ in JOINT_ATTRIBUTES])
def test_an_attribute_that_a_joint_cannot_have_gets_the_right_one(name, value, hint):
    world = World(Effects.rigid_bodies().with_(joints=True))
    hinge = world.add_joint(Revolute(None, world.add_body(BALL), at=(0, 0)))
    before = world.digest(), world.joints.tobytes()
    with pytest.raises(AttributeError, match=f"Joint has no attribute {name}|Joint.{name} cannot be set") as caught:
        setattr(hinge, name, value)
    assert hint in str(caught.value), str(caught.value)
    assert (world.digest(), world.joints.tobytes()) == before
    hinge.user = "still settable"
    assert hinge.user == "still settable"


UNCHANGEABLE = [
    (Vec2(3.0, 4.0), "x", 5, "position = (5, 4.0)"),
    (Vec2(3.0, 4.0), "y", 5, "position = (3.0, 5)"),
    (Material(restitution=0.5), "friction", 0.1, "material = replace(body.material, friction=0.1)"),
    (Filter(), "mask", 6, "filter = replace(body.filter, mask=6)"),
    (Effects(), "drag", True, "world.set_effects(world.effects.with_(drag=True))"),
]


@pytest.mark.parametrize(("thing", "name", "value", "hint"), UNCHANGEABLE)
def test_a_value_that_cannot_be_changed_says_what_to_set(thing, name, value, hint):
    with pytest.raises(AttributeError, match=f"{type(thing).__name__} cannot be changed") as caught:
        setattr(thing, name, value)
    assert hint in str(caught.value), str(caught.value)
    with pytest.raises(AttributeError):
        delattr(thing, name)


# ---- files, removed bodies, bodies without mass --------------------------------------------------------------------


def test_a_file_that_is_no_snapshot_says_so(tmp_path):
    path = tmp_path / "level.txt"
    path.write_text("no snapshot")
    with pytest.raises(ValueError, match=r"level.txt is no snapshot of this program: it is not an .npz file$"):
        Snapshot.load(path)


def test_other_effects_of_a_snapshot_are_named():
    world, other = World(Effects(drag=True)), World(Effects(drag=True, wind=True, sensors=True))
    with pytest.raises(ValueError, match="only this world has sensors, wind$"):
        other.restore(world.snapshot())
    with pytest.raises(ValueError, match="only the snapshot has sensors, wind$"):
        world.restore(other.snapshot())


@pytest.mark.parametrize("call", [
    lambda w, b: w.remove_body(b), lambda w, b: b.remove(), lambda w, b: w.move([b], [(0, 0)]), lambda w, b: w.body(b),
    lambda w, b: b.position, lambda w, b: w.touch(b), lambda w, b: w.rows([b]),
    lambda w, b: w.add_joint(Revolute(b, 3, (0, 0))),
])  # fmt: skip
def test_a_removed_body_is_named_by_every_call(call):
    world = make_world()
    body = world.body(0)
    body.remove()
    with pytest.raises(KeyError) as caught:
        call(world, body)
    assert str(caught.value) == "body 0 is not in this world (removed, or never added)"


def test_a_dynamic_body_without_mass_is_explained():
    clear = PixelMask(np.zeros((3, 3), bool))
    for shape, hint in ((clear, "mass=…"), (Segment((0, 0), (9, 9)), 'kind="static"')):
        with pytest.raises(ValueError, match="dynamic body") as caught:
            make_world().add_body(shape)
        assert hint in str(caught.value), str(caught.value)


# ---- what simply works -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", BROADPHASES)
def test_a_broad_phase_is_given_by_its_name(name):
    world = World(broadphase=name)
    assert type(world.broadphase) is BROADPHASES[name]
    world.add_bodies(BALL, [(0, 0), (5, 0)])
    world.broadphase = "brute"
    world.broadphase = name
    world.step()
    assert type(world.broadphase) is BROADPHASES[name] and len(world.candidates) == 1


def test_vectors_and_rectangles_of_pygame_work_where_pairs_do():
    world, place = World(), pygame.Vector2(3, 4)
    body = world.add_body(Circle(2, pygame.Vector2(1, 0)), position=place, velocity=place)
    assert (body.position, body.velocity) == ((3, 4), (3, 4)) and type(body.position) is Vec2
    world.add_bodies(Polygon([place, (0, 0), (9, 0)]), [place, (50, 50)], [place, place])
    world.gravity = body.position = place
    found = world.query_rect(pygame.Rect(0, 0, 9, 9))
    assert found and all(world.query_rect(each(0, 0, 9, 9)) == found for each in FRECTS)
    assert world.overlap(BALL, place) and collide(BALL, place, BALL, (*place, 0.5))
    total = Vec2(1, 2) + place - place / 2
    assert total == (2.5, 4) and type(Vec2(1, 2) + place) is Vec2 and Vec2(1, 2).dot(place) == 11
    with pytest.raises(TypeError):
        Vec2(1, 2) + pygame.Vector3(1, 2, 3)
    with pytest.raises(TypeError):
        Vec2(1, 2) + RECT


def test_too_many_arguments_get_the_names():
    for call in (lambda: Circle(1, 2, 3), lambda: Polygon((0, 0), (1, 0), (1, 1)), lambda: Polygon.box(1, 2, 3, 4, 5)):
        with pytest.raises(TypeError, match=r"takes .* \(got [35] arguments: \("):
            call()
    for gravity, written in ((500, "500"), (-9.8, "9.8")):  # y points down, so that a fall is positive
        with pytest.raises(TypeError, match=rf"gravity must be a pair .*: write \(0, {written}\), in px/s², y points"):
            World(gravity=gravity)
    with pytest.raises(TypeError, match="names must be a list"):
        Effects.named("gravity")


def test_arrays_in_place_of_anything_are_refused_by_name():
    world, array = make_world(), np.zeros((3, 3))
    before = state(world)
    for name, values, call in CALLS:
        if any(hint for _, hint in values) and name not in ("points", "positions", "velocities", "solid", "snap"):
            with pytest.raises((TypeError, ValueError)) as caught:
                call(world, array)
            assert name in str(caught.value) and "ambiguous" not in str(caught.value), caught.value
    assert state(world) == before


def test_messages_survive_values_that_have_no_text():
    class Mute:
        def __repr__(self):
            raise RuntimeError("no text")

    for value in (Mute(), 10**5000, [Mute()]):
        for call in (Circle, World, lambda v: World().add_body(v), lambda v: World().add_body(BALL, filter=v)):
            with pytest.raises((TypeError, ValueError), match="got"):
                call(value)
    with pytest.raises(TypeError, match="snapshot must be a Snapshot"):
        World().restore(Mute())
    assert Snapshot


@pytest.mark.parametrize("value", ("x" * 5000, ["x" * 5000], [f"name_{k}" for k in range(5000)], {"y" * 5000: True}))
def test_a_hint_repeats_no_long_value(value):
    with pytest.raises(TypeError) as caught:
        World(value)
    assert str(caught.value).startswith("effects must be an Effects") and len(str(caught.value)) < 1000


# ---- seconds, and values for many ------------------------------------------------------------------------------------


@pytest.mark.parametrize(("call", "hints"), [
    (lambda w: w.step(16), ["16 / 1000", "16.0 for seconds"]),
    (lambda w: w.step(dt=np.int64(17)), ["17 / 1000"]),
    (lambda w: w.step(pygame.time.Clock().tick(60) + 16), [" / 1000"]),
    (lambda w: World(dt=16), ["16 / 1000"]),
    (lambda w: setattr(w, "dt", 60), ["1 / 60 for steps per second"]),
])  # fmt: skip
def test_milliseconds_are_refused_with_the_seconds(call, hints):
    world = make_world()
    before = state(world)
    with pytest.raises(ValueError, match=r"dt must be in seconds.*got .*\d+") as caught:
        call(world)
    assert all(hint in str(caught.value) for hint in hints), str(caught.value)
    assert state(world) == before


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("dt", [1 / 20, 1 / 3, 0, 1, 2, 3, 3.5, np.float32(0.5), np.int64(1)])
def test_steps_of_seconds_run_without_a_warning(dt):
    world = World(Effects.detection())
    world.step(dt)
    assert world.time == pytest.approx(float(dt)) and World(dt=dt or 1).dt == pytest.approx(float(dt) or 1.0)


@pytest.mark.parametrize(("usual", "dt", "warns"), [
    (1 / 60, 1000 / 60, True), (1 / 60, 16.0, True), (1 / 60, 3.9, False), (1.0, 16.0, False), (3600.0, 7200.0, False),
])  # fmt: skip
def test_a_float_that_looks_like_milliseconds_runs_with_a_warning(usual, dt, warns, recwarn):
    """A float time step that looks like milliseconds causes a warning, not an error.

    It may be a real pause of the program, which must not stop a game.
    """
    world = World(Effects.detection(), dt=usual)
    world.step(dt)
    assert world.time == dt and len(recwarn) == warns
    assert not warns or (f"write {dt:g} / 1000" in str(recwarn[0].message) and recwarn[0].filename == __file__)


@pytest.mark.parametrize(("user", "users"), [
    (["a", None, 3], ["a", None, 3]),
    (np.array([7, 8, 9]), [7, 8, 9]),
    ([["x"]] * 3, [["x"]] * 3),
    (("a", "b", "c"), [("a", "b", "c")] * 3),
    ({"hp": 3}, [{"hp": 3}] * 3),
    ("abc", ["abc"] * 3),
    (None, [None] * 3),
])  # fmt: skip
def test_a_list_of_users_has_one_for_each(user, users):
    """A list of `user` values gives one value to each body or joint; any other value, a tuple too, goes to all."""
    world = World(Effects.rigid_bodies().with_(joints=True))
    ids = world.add_bodies(BALL, [(0, 0), (20, 0), (40, 0)], user=user)
    assert [world.body(k).user for k in ids] == users
    pins = world.add_joints(Revolute, None, ids, at=[(0, 0), (20, 0), (40, 0)], user=user)
    assert [world.joint(k).user for k in pins] == users
    gears = world.add_joints(Gear, pins[:1].tolist() * 2, pins[1:].tolist(), user=["one", "two"])
    assert [world.joint(k).user for k in gears] == ["one", "two"]


def test_one_body_or_joint_keeps_a_list_as_it_is():
    world = World(Effects.rigid_bodies().with_(joints=True))
    items = ["sword", "rope"]
    body = world.add_body(BALL, user=items)
    assert body.user is items and world.add_joint(Revolute(None, body, at=(0, 0), user=items)).user is items
    ids = world.add_bodies(BALL, [(0, 0), (1, 0)], user=[items] * 2)
    assert all(world.body(k).user is items for k in ids)


@pytest.mark.parametrize("count", [0, 1, 3])
def test_a_list_of_users_of_another_length_is_refused(count):
    world = World(Effects.rigid_bodies().with_(joints=True))
    ids = world.add_bodies(BALL, [(0, 0), (20, 0)])
    before = world.digest(), len(world), len(world.joints)
    for call in (
        lambda: world.add_bodies(BALL, [(0, 9), (20, 9)], user=["a"] * count),
        lambda: world.add_joints(Revolute, None, ids, at=[(0, 0), (20, 0)], user=["a"] * count),
    ):
        with pytest.raises(ValueError, match=f"user must be one value, or a list of 2, .*got {count} in"):
            call()
    assert (world.digest(), len(world), len(world.joints)) == before
