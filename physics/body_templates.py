"""Templates: copies of the rows of an added body, reused for further bodies with the same shapes and values.

edit.add_rows checks all arguments of a new body and computes its rows: mass, geometry, proxies of the broad phase. For
a further body with equal arguments, only pose and velocity differ. A template stores the other values, so only pose
and velocity are checked and written. Arguments of unusual types are passed to edit.add_rows, which raises the errors.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple, TypedDict

import numpy as np

from physics.annotations import ContinuousName, KindName, TierName
from physics.dynamics.integrate import write_center
from physics.effects import Effects
from physics.math2d import Vec2
from physics.shapes.library import Library
from physics.shapes.shape import EqualByArrays, Filter, Material, Shape
from physics.tables.body import DYNAMIC, STATIC
from physics.world_state import WorldState

MOST = 64  # greatest number of templates of a world, a bound of memory for programs that never add equal bodies
MOST_SHAPES = 2**30  # beyond this shape id add_rows is used, which checks the number of remaining ids
NUMBERS = (float, int, type(None))
PROXY_VALUES = ("membership", "mask", "plane", "avoids")
POSE = tuple((name, kept + name) for kept in ("previous_", "still_", "rocking_") for name in ("x", "y", "angle"))


class Definition(TypedDict, total=False):
    """The keyword arguments of World.add_bodies that describe a body. They are also the fields of edit.BodyDef."""

    kind: KindName
    angular_velocity: float
    mass: float | None
    material: Material
    filter: Filter
    sensor: bool
    bullet: bool
    continuous: ContinuousName
    fixed_rotation: bool
    gravity_scale: float
    allow_sleep: bool
    tier: TierName | None
    user: Any


class Template(NamedTuple):
    """The rows of a body, which are copied for each further body with equal arguments except pose and velocity.

    The first three fields are the settings of the world for which the rows are valid.
    """

    effects: Effects
    sleeps: bool
    library: Library
    is_static: bool
    is_dynamic: bool
    body: np.void  # BODY row
    definition: np.void  # BODY_DEF row
    shapes: list[tuple[np.void, int, dict[str, int]]]  # each: SHAPE row, index of the parent, values of the proxy
    masks: Sequence[tuple[int, Shape]]  # each: index among the shapes of the body, PixelMask whose rows are stored


def key_of(
    shapes: Sequence[Shape],
    kind: Any,
    mass: Any,
    material: Any,
    filter: Any,
    sensor: Any,
    bullet: Any,
    continuous: Any,
    fixed_rotation: Any,
    gravity_scale: Any,
    allow_sleep: Any,
) -> tuple | None:
    """Return the key under which the template for these arguments of World.add_body is stored.

    The result is None if an argument has an unusual type; then no template is used.
    """
    plain = (
        type(kind) is type(continuous) is str
        and type(sensor) is type(bullet) is type(fixed_rotation) is type(allow_sleep) is bool
        and type(material) is Material
        and type(filter) is Filter
        and type(mass) in NUMBERS
        and type(gravity_scale) in NUMBERS
    )
    if not plain:
        return None
    flags = sensor, bullet, fixed_rotation, allow_sleep
    return (shapes, kind, mass, material, filter, continuous, gravity_scale, *flags)


def find(world: WorldState, key: tuple | None) -> Template | None:
    """Return the template stored under `key`, or None if there is no valid one.

    A template is valid while the world's effects, its library and its value of `sleeps` are the same as when the
    template was stored. The result for the key None is None.
    """
    try:
        found = world._templates.get(key)
    except TypeError:  # an argument is not hashable, so it is not a Shape
        found = None
    if found is None or found.library is not world.library or found.effects is not world.effects:
        return None
    if key is None or any(key[0][k] is not mask for k, mask in found.masks):
        return None  # an equal mask has its own geometry in the library, because carving replaces pixels in place
    return found if found.sleeps == world.sleeps else None


def keep(world: WorldState, key: tuple | None, shapes: Sequence[Shape]) -> None:
    """Store a template under `key`, made from the rows of the body that was added last.

    Do nothing if the key is None, or if a shape cannot rotate (TileGrid). shapes: the shapes of this body.
    """
    if key is None or not all(shape._may_turn for shape in shapes):
        return
    at, kind = world._bodies.count - 1, world.bodies["kind"][-1]
    rows = world._shape_rows(at)
    proxies, first = world.pairs.proxies, int(world.shapes["id"][rows[0]]) if len(rows) else 0
    parts = []
    for row in rows.tolist():
        shape = world.shapes[row]
        values = {name: proxies[name][shape["proxy"]].item() for name in PROXY_VALUES}
        parts.append((world._shapes.row_bytes(row), int(shape["parent"]) - first, values))
    if len(world._templates) >= MOST:
        world._templates.clear()
    bytes_of_body, definition = world._bodies.row_bytes(at), world._definitions.row_bytes(at)
    state = world.effects, world.sleeps, world.library
    masks = [(k, shape) for k, shape in enumerate(shapes) if isinstance(shape, EqualByArrays)]
    world._templates[key] = Template(*state, kind == STATIC, kind == DYNAMIC, bytes_of_body, definition, parts, masks)


def add_like(
    world: WorldState, template: Template, shapes: tuple, position: Vec2, velocity: Vec2, angle: float, spin: float
) -> int:
    """Add a body with the rows of a template, and return the body's id.

    If the template cannot be used, add nothing and return -1; the caller then calls edit.add_rows. shapes: the shapes
    of the body; position (x, y) [px]; velocity (x, y) [px/s]; angle [rad]; spin: angular velocity [rad/s].
    """
    parts, free = template.shapes, world.pairs.free
    moves = spin != 0.0 or velocity != (0.0, 0.0)
    if template.is_static and moves or (spin != 0.0 and not template.effects.rotation):
        return -1
    if world._next_shape > MOST_SHAPES or len(free) < len(parts):
        return -1
    identity, first = world._next_body, world._next_shape
    world._next_body += 1
    world._definitions.append_bytes(template.definition)
    at = world._bodies.append_bytes(template.body)
    columns = world._bodies.columns
    columns["id"][at] = identity
    columns["x"][at], columns["y"][at] = position
    columns["angle"][at] = angle
    columns["vx"][at], columns["vy"][at] = velocity
    columns["angular_velocity"][at] = spin
    for name, kept in POSE:
        columns[kept][at] = columns[name][at]
    write_center(world._bodies, at)
    if not template.is_dynamic:
        world.awake.mark_dirty([identity])
    _add_shapes(world, parts, identity, at)
    world._runs.append()
    run = world._runs.columns
    run["first"][at], run["count"][at] = first if parts else 0, len(parts)
    world._shapes_of[identity] = shapes
    return identity


def _add_shapes(world, parts, identity, at):
    """Append the SHAPE rows of a body and add their proxies.

    parts: Template.shapes; identity: id of the body; at: row number of the body.
    """
    pairs, first = world.pairs, world._next_shape
    world._next_shape += len(parts)
    for number, (row_bytes, parent, values) in enumerate(parts):
        row, slot = world._shapes.append_bytes(row_bytes), pairs.free.pop()
        columns = world._shapes.columns
        columns["id"][row], columns["parent"][row] = first + number, first + parent
        columns["body"][row], columns["body_row"][row] = identity, at
        columns["proxy"][row] = slot
        pairs.add_proxy(slot, identity, values, bool(world._bodies.columns["kind"][at] == STATIC))
