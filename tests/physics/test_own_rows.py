"""Values of a body are written to all its SHAPE rows and to no others, wherever the rows are in the table."""

import numpy as np
import pytest

from physics import Circle, Effects, Filter, Material, PixelMask, Polygon, World

RING = np.hypot(*(np.indices((24, 24)) - 11.5))
SHAPES = {
    "one shape": (Circle(6.0),),
    "three shapes": (Circle(4.0), Polygon([(2, -2), (14, -2), (14, 2), (2, 2)]), Circle(3.0, (-8, 0))),
    "own values": (Circle(4.0).with_(Material(friction=0.1), Filter(8, 8), False), Polygon.box(12, 4)),
    "mask": (PixelMask((RING < 12) & (RING > 6)),),
    "no shape": (),
}
EDITS = {
    "material": lambda body: setattr(body, "material", Material(friction=0.9, density=2.0)),
    "filter": lambda body: setattr(body, "filter", Filter(2, 6)),
    "sensor": lambda body: setattr(body, "sensor", True),
    "kind": lambda body: body.set_kind("static"),
    "shapes": lambda body: body.set_shapes(Polygon.box(5, 7), Circle(2.0, (9, 9))),
    "fixed rotation": lambda body: setattr(body, "fixed_rotation", True),
}
PLACES = ("as added", "after removals", "scattered", "before the drop")


def crowd(shapes, place):
    """Return (world, body to change) of nine bodies with these shapes. place: case of row positions, such as
    "scattered".
    """
    world = World(Effects.rigid_bodies())
    bodies = [
        world.add_body(*(shapes or (Circle(5.0),)), position=(60.0 * k, 7.0 * k), mass=None if shapes else 1.0)
        for k in range(9)
    ]
    if not shapes:
        bodies[4] = world.add_body(position=(20.0, 0.0), mass=1.0)
    if place == "after removals":
        world.remove_bodies([bodies[1], bodies[6]])
    if place == "scattered":  # rows of a body are no longer consecutive
        for body in (bodies[4], bodies[5], bodies[4]):
            body.add_shape(Circle(3.0, (0, 12)))
    world.step()
    if place == "before the drop":  # the rows of a body that was removed alone are dropped later
        bodies[2].remove()
    return world, bodies[4]


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("shapes", SHAPES)
@pytest.mark.parametrize("edit", EDITS)
def test_an_edit_reaches_the_rows_of_its_body_alone(edit, shapes, place):
    world, body = crowd(SHAPES[shapes], place)
    EDITS[edit](body)
    rows = world.shapes
    mine, others = rows[rows["body"] == body.id], rows[rows["body"] != body.id]
    twin, same = crowd(SHAPES[shapes], place)
    before = twin.shapes[twin.shapes["body"] != same.id]
    for name in ("id", "friction", "membership", "mask", "sensor", "kind"):
        assert np.array_equal(others[name], before[name]), name
    for column, own, edited, value in (
        ("friction", "own_material", "material", 0.9),
        ("membership", "own_filter", "filter", 2),
        ("mask", "own_filter", "filter", 6),
        ("sensor", "own_sensor", "sensor", True),
    ):
        if edit == edited:
            assert (mine[column][~mine[own]] == value).all() and (mine[column][mine[own]] != value).all()
    if edit == "kind":
        slots = mine["proxy"][mine["proxy"] >= 0]
        assert world.pairs.proxies["still"][slots].all()
    if edit == "shapes":
        assert len(mine) == 2
    world.step()
    world.step()


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("shapes", SHAPES)
@pytest.mark.parametrize("angle", [0.0, 0.7, -2.1])
def test_bounds_are_those_of_the_shapes_at_the_present_pose(shapes, place, angle):
    world, body = crowd(SHAPES[shapes], place)
    for pose in ((0.0, 0.0), (-310.5, 77.25)):
        body.move_to(pose, angle)
        found = body.bounds
        world.queries.begin(world)  # places all shapes
        rows = world.shapes[world.shapes["body"] == body.id]
        if not len(rows):
            assert found is None
            continue
        assert found == tuple(
            getattr(rows[name], least)().item()
            for name, least in (("min_x", "min"), ("min_y", "min"), ("max_x", "max"), ("max_y", "max"))
        )
        assert found[0] < found[2] and found[1] < found[3]
