"""A user's program in which the marked lines are wrong: basedpyright must report all of them and no others."""

import pygame

from physics import (
    Body,
    Capsule,
    Character,
    Circle,
    Distance,
    Drive,
    Effects,
    Filter,
    Material,
    PixelMask,
    Polygon,
    Revolute,
    Segment,
    Spring,
    World,
    collide,
    fit,
)

RECT, SURFACE = pygame.Rect(0, 0, 10, 10), pygame.Surface((8, 8))
BALL = Circle(8)


def words(world: World, body: Body, mask: PixelMask) -> None:
    """Use keywords that do not exist."""
    world.add_body(BALL, kind="dynmic")  # wrong
    world.add_body(BALL, kind=0)  # wrong
    world.add_body(BALL, kind="Static")  # wrong
    world.add_body(BALL, continuous="always")  # wrong
    world.add_body(BALL, continuous=True)  # wrong
    world.add_body(mask, tier="boxes")  # wrong
    world.add_bodies(BALL, [(0, 0)], kind="moving")  # wrong
    body.set_kind("rigid")  # wrong
    body.continuous = "on"  # wrong
    body.tier = "box"  # wrong
    body.kind = "static"  # wrong
    fit(mask, "convex")  # wrong
    World(solver="pgs")  # wrong
    world.solver = "box2d"  # wrong
    world.substeps = "many"  # wrong
    World(substeps="adaptive")  # wrong
    World(broadphase="quadtree")  # wrong
    world.broadphase = "grid"  # wrong
    world.joint_solver = "exact"  # wrong
    World(effects="gravity")  # wrong
    World(Effects.rigid_bodies)  # wrong
    Effects(gravty=True)  # wrong


def places(world: World, body: Body) -> None:
    """Pass positions that are not pairs."""
    world.add_body(BALL, position=RECT)  # wrong
    world.add_body(BALL, position=(1, 2, 3))  # wrong
    world.add_body(BALL, position=5)  # wrong
    world.add_body(BALL, position="1, 2")  # wrong
    world.add_body(BALL, position=pygame.Vector3(1, 2, 3))  # wrong
    world.add_body(BALL, position=("1", "2"))  # wrong
    world.add_body(BALL, position=body)  # wrong
    world.add_bodies(BALL, (0, 0))  # wrong
    world.gravity = 9.8  # wrong
    body.position = RECT  # wrong
    body.velocity = 3.0  # wrong
    body.center = (0, 0)  # wrong
    body.angle = (1, 0)  # wrong
    body.apply_force(9.0)  # wrong
    world.ray_cast(RECT, (1, 0))  # wrong
    world.query_point(3)  # wrong
    world.query_rect((1, 2, 3))  # wrong
    world.query_rect(pygame.Vector2(1, 2))  # wrong
    collide(BALL, 3.0, BALL, (0, 0))  # wrong
    print(body.position + "here")  # wrong
    print(body.position.z)  # wrong


def shapes(world: World, body: Body) -> None:
    """Pass values that are no shapes, or shape arguments in the wrong order."""
    world.add_body(SURFACE)  # wrong
    world.add_body(RECT)  # wrong
    world.add_body([BALL])  # wrong
    world.add_body(Circle)  # wrong
    world.add_body([(0, 0), (1, 0), (0, 1)])  # wrong
    world.overlap(RECT, (0, 0))  # wrong
    body.set_shapes(SURFACE)  # wrong
    fit(SURFACE, "hull")  # wrong
    Circle((0, 0), 5)  # wrong
    Circle(r=5)  # wrong
    Capsule((0, 0), 5, (1, 1))  # wrong
    Segment(1, 2, 3, 4)  # wrong
    Polygon(RECT)  # wrong
    Polygon(10, 20)  # wrong
    Polygon.box((10, 20))  # wrong
    Character(world, RECT, (0, 0))  # wrong
    Character(BALL, world, (0, 0))  # wrong


def names(world: World, body: Body) -> None:
    """Use argument names of other engines."""
    world.add_body(BALL, friction=0.5)  # wrong
    world.add_body(BALL, pos=(1, 2))  # wrong
    world.add_body(BALL, material=0.5)  # wrong
    world.add_body(BALL, filter=3)  # wrong
    world.add_bodies(BALL, [(0, 0)], friction=0.5)  # wrong
    world.add_bodies(BALL, [(0, 0)], filter=3)  # wrong
    body.filter = 3  # wrong
    body.material = 0.5  # wrong
    body.linear_velocity = (1, 0)  # wrong
    BALL.with_(material=0.5)  # wrong
    BALL.radius = 3  # wrong
    Material(bounce=0.5)  # wrong
    Filter(group=1)  # wrong
    world.ray_cast((0, 0), (1, 0), filter=1)  # wrong
    world.remove_body("crate")  # wrong
    world.restore("save.npz")  # wrong
    world.gravty = (0, 0)  # wrong


def columns(world: World) -> None:
    """Read columns that do not exist."""
    print(world.bodies["velocity_x"])  # wrong
    world.bodies["vel_x"] = 0.0  # wrong
    print(world.bodies[0]["px"])  # wrong
    print(world.contacts["depth"])  # wrong
    print(world.events.hits["velocity"])  # wrong
    print(world.events.begins)  # wrong
    for event in world.events.begin:
        print(event["speed"])  # wrong
    world.joints["speed_of_motor"] = 3.0  # wrong
    moving = world.bodies[world.bodies["awake"]]
    print(moving["speed"])  # wrong


def joints(world: World, a: Body, b: Body) -> None:
    """Pass wrong arguments to joints."""
    world.add_joint(Revolute)  # wrong
    world.add_joint(Revolute(a, b))  # wrong
    world.add_joint(Revolute(a, b, anchor=(0, 0)))  # wrong
    world.add_joint(Revolute("a", b, (0, 0)))  # wrong
    world.add_joint(Revolute(a, b, (0, 0), motor=5))  # wrong
    world.add_joint(Revolute(a, b, (0, 0), limits=5))  # wrong
    world.add_joint(Distance(a, b, (0, 0), 9))  # wrong
    world.add_joint(Distance(a, b, (0, 0), (1, 1), spring=2.0))  # wrong
    hinge = world.add_joint(Revolute(a, b, (0, 0)))
    hinge.motor = Drive()  # wrong
    hinge.spring = Spring("stiff")  # wrong
    hinge.limits = 3  # wrong
    world.remove_body(hinge)  # wrong
