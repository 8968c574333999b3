"""A user's program in which every line is correct: basedpyright must report no error. It is checked, not run."""

from collections.abc import Iterable, Sequence

import numpy as np
import pygame
from numpy.typing import NDArray

from physics import (
    BROADPHASES,
    SOLVERS,
    TIERS,
    Body,
    Bounds,
    Capsule,
    Chain,
    Character,
    Circle,
    Distance,
    Drive,
    DynamicTree,
    Effects,
    Filter,
    Joint,
    Material,
    Motor,
    NoContact,
    PixelMask,
    Polygon,
    Prismatic,
    RayHit,
    Revolute,
    Segment,
    Snapshot,
    Spring,
    Target,
    TileGrid,
    Vec2,
    Weld,
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

HERE = Vec2(1, 2)
PLACE = pygame.Vector2(3, 4)
RECT, EXACT = pygame.Rect(0, 0, 10, 10), pygame.FRect(0, 0, 9.5, 9.5)
SPRITE = PixelMask.from_surface(pygame.Surface((8, 8)), origin=PLACE)


def shapes() -> list[Circle | Capsule | Polygon | Segment | Chain | TileGrid | PixelMask | Bounds]:
    """Return one shape of each kind, made from points of all types."""
    ball = Circle(8, PLACE)
    x: float = ball.center.x + ball.points[0].y
    corners = [(0, 0), (9, 0), (9, 9)]
    triangle = Polygon(corners, radius=1)
    first: Vec2 = triangle.points[0]
    return [
        ball, Circle(radius=np.float64(3), center=[1, x]), Capsule(HERE, PLACE, 2), triangle,
        Polygon([HERE, PLACE, (0, 9)]), Polygon(np.zeros((3, 2))), Polygon([[0, 0], [1, 0], [0, 1]]),
        Polygon.box(*RECT.size, center=RECT.center, angle=0.5), Segment(first, [3, 4]),
        Chain([(0, 0), (9, 0)], ghosts=(None, (12, 0)), materials=[Material()]),
        TileGrid([[True, False]], 16), TileGrid(np.ones((2, 2), bool), 16.0), Bounds(ball), SPRITE.flipped(x=True),
        SPRITE.with_(one_way=True), *decompose(corners), hull([PLACE, HERE, (0, 9)]),
        ball.with_(material=Material(friction=0.5), filter=Filter(3)),
    ]  # fmt: skip


def bodies(world: World, shape: Polygon) -> Body:
    """Add bodies with positions of all types, change them, and return the last one."""
    world.add_body(shape, position=PLACE, kind="static")
    world.add_body(shape, position=RECT.center, kind="kinematic", velocity=[1, 2])
    world.add_body(shape, SPRITE, position=EXACT.topleft, continuous="toi", tier=None, user={"name": "crate"})
    world.add_body(*[shape, shape], position=np.array([1.0, 2.0]), mass=3)
    world.add_body(*fit(SPRITE, "hull"), position=HERE + PLACE, filter=Filter(membership=1 << 2))
    ids = world.add_bodies(shape, [(0, 0), PLACE, HERE], [(1, 0)] * 3, [0.0, 0.1, 0.2], kind="dynamic", bullet=True)
    world.add_bodies(shape, np.zeros((3, 2)), angles=np.zeros(3), material=Material(restitution=0.5))
    world.move(ids, np.zeros((3, 2)), velocities=[(0, 0)] * 3)
    world.move([world.body(0), 1], [PLACE, (3, 4)])
    world.remove_bodies(ids)
    world.remove_bodies([world.body(0)])
    world.remove_body(ids[0])
    body = world.body(int(ids[1]))
    body.position = PLACE
    body.velocity = HERE * 2 - (1, 2)
    body.velocity = 3 * body.velocity.normalized() + np.array([1.0, 2.0])
    body.angle += 0.1
    body.continuous, body.tier = "swept", "obb"
    body.set_kind("kinematic")
    body.set_target(PLACE, angle=1)
    body.set_shapes(shape, SPRITE)
    body.apply_force((0, -9), PLACE)
    body.material, body.filter = Material(density=2), Filter.ALL
    kind: str = body.kind
    if body.kind == "static" or kind == "dynamic":
        body.world.step()
    for other in world:
        other.user = body.position.x + body.to_world(PLACE)[0]
    return body


def worlds() -> None:
    """Make worlds with all settings."""
    world = World(Effects.rigid_bodies(), "tree", "soft_step", gravity=(0, 500), substeps="auto")
    world.substeps = 8
    world.solver = "sequential_impulse"
    world.joint_solver = "direct"
    world.broadphase = DynamicTree()
    world.broadphase = "hash"
    world.gravity = pygame.Vector2(0, 300)
    for solver in SOLVERS:
        World(solver=solver, broadphase=BROADPHASES["tree"]())
    for name in BROADPHASES:
        World(broadphase=BROADPHASES[name]())
    for tier in TIERS:
        measure(SPRITE, fit(SPRITE, tier))
    world.step()
    world.step(1 / 120)
    snapshot: Snapshot = world.snapshot()
    world.restore(snapshot)
    seconds: float = world.profile.stages["solve"] + world.time
    print(seconds, world.effects.with_(persist=True), world.stages)


def queries(world: World, shape: Circle) -> list[Body]:
    """Make queries with points, rectangles and poses of all types."""
    hit: RayHit | None = world.ray_cast(PLACE, (0, 500), filter=Filter(1, 2), sensors=True)
    found = world.ray_cast((0, 0), HERE)
    fractions: NDArray[np.float64] = world.ray_casts([(0, 0)], [HERE])["fraction"]
    owners: NDArray[np.int64] = world.query_points(np.zeros((3, 2)), sensors=True)["body"]
    if found is not None:
        found.body.velocity = (0, 0)
        print(found.point.x, found.normal.angle, hit, fractions.sum(), owners.max())
    for each in world.ray_cast_all((0, 0), PLACE):
        each.body.wake()
    cast = world.shape_cast(shape, (*PLACE, 0.5), (9, 0))
    near = world.closest(pygame.mouse.get_pos())
    if near is not None and cast is not None:
        body, point, gap = near
        print(body.id, point.length, gap + cast.fraction)
    print(world.query_aabb((0, 0), PLACE), world.query_point(PLACE))
    print(world.query_rect(RECT), world.query_rect(EXACT), world.query_rect((0, 0, 9, 9)))
    print(collide(shape, PLACE, shape, (0, 0, 1.5)).normal.x, distance(shape, HERE, SPRITE, [1, 2]).point_a.y)
    print(time_of_impact(shape, (0, 0), PLACE, shape, (9, 0), (9, 0, 0.5)).fraction, mass_of([shape, SPRITE], 2).center)
    return world.overlap(shape, PLACE)


def arrays(world: World, awake: Sequence[int], handles: Iterable[Body]) -> float:
    """Read and write columns of a step's arrays."""
    table = world.bodies
    table["vx"] += 1.0
    table["vy"][table["awake"]] = 0.0
    table["x"] = np.round(table["x"])
    moving = table[table["kind"] == 2]
    order = np.argsort(moving["y"])
    lowest = moving[order][-1]["y"] + moving["x"].max()
    world.touch(table["id"])
    world.touch(awake)
    world.touch(handles)
    for contact in world.contacts:
        lowest += contact["separation"] * contact["normal_x"]
    for event in world.events.begin:
        world.body(event["body_a"]).wake()
    hits = world.events.hits
    for hit in hits[hits["speed"] > 300.0]:
        print(hit["body_b"], hit["normal_impulse"])
    for lost in world.events.quarantined:
        print(lost["body"], lost["reason"])
    for broken in world.events.broken:
        print(broken["joint"], broken["reason"])
    world.joints["motor_speed"] = 3.0
    print(len(world.contacts), world.candidates[:, 0], world.sleeping_contacts["area"], table[["x", "y"]])
    for a, b in world.touching(users=True):
        print(a, b)
    return float(lowest) + float(world.touching()[0, 1])


def joints(world: World, a: Body, b: Body) -> Joint:
    """Add joints of all kinds and return one of them."""
    hinge = world.add_joint(Revolute(a, b, at=PLACE, limits=(-0.5, None), motor=Drive(2, max=1e5)))
    world.add_joint(Prismatic(a.id, None, (0, 0), axis=HERE, breaks=(1e4, None)))
    world.add_joint(Distance(a, b, PLACE, HERE, spring=Spring(2.0, 0.5)))
    world.add_joint(Weld(a, b, [1, 2]))
    world.add_joint(Motor(a, b, max_force=9, max_torque=9))
    world.add_joint(Target(b, at=PLACE, point=pygame.mouse.get_pos()))
    world.add_joint(NoContact(a, b))
    world.add_joints(Revolute, [a, b], [b.id, None], at=[(0, 0), (1, 1)])
    world.remove_joints([hinge])
    hinge.limits = (0, 1)
    hinge.motor = None
    return hinge


def character(world: World) -> bool:
    """Move a character; return whether it is grounded and not blocked to the right."""
    hero = Character(world, Polygon.box(10, 20), PLACE, filter=Filter(1), max_slope=0.8)
    moved = hero.move(1.5, -2)
    if moved.riding is not None:
        moved.riding.wake()
    return moved.grounded and not hero.blocked(1, 0)


class Crate(pygame.sprite.Sprite):
    """A sprite that follows its body."""

    def __init__(self, world: World) -> None:
        super().__init__()
        self.box = pygame.Rect(0, 0, 16, 16)
        self.body = world.add_body(Polygon.box(*self.box.size), position=self.box.center, user=self)

    def update(self) -> None:
        """Move the sprite to its body, then the body by one pixel."""
        self.box.center = round(self.body.position.x), round(self.body.position.y)
        self.body.position += (1, 0)
        self.body.velocity *= 0.5
        self.body.velocity = (self.body.velocity[0], -300)
        x, y = self.body.position
        corners = [self.body.to_world(corner) for corner in ((0, 0), (x, y), (2, 0))]
        pygame.draw.polygon(pygame.display.get_surface() or pygame.Surface((9, 9)), "red", corners)


def copies(world: World, other: Body) -> None:
    """Add bodies with keywords and numbers taken from other bodies and from loops."""
    for kind in ("static", "dynamic"):
        world.add_body(Circle(3), kind=kind)
    kind = "static" if len(world) else "kinematic"
    world.add_body(Circle(3), kind=kind, continuous=other.continuous, tier=other.tier)
    world.add_body(*other.shapes, kind=other.kind, material=other.material, velocity=-other.velocity)
    places: list[tuple[int, int]] = [(0, 0), (1, 1)]
    corners: list[list[int]] = [[0, 0], [4, 0], [4, 4]]
    world.add_bodies(Polygon(corners), places)
    ids = {int(each) for each in world.bodies["id"]}
    world.remove_bodies(each for each in ids)
    world.touch(ids)
    first = world.bodies[world.rows(3)]
    print(first["x"], world.bodies.dtype.names, world.bodies["x"].tolist())
