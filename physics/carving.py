"""Carving: removal of pixels from a body's masks. Pieces that are separated by the cut become bodies."""

import math
from typing import Any, NamedTuple

import numpy as np

from physics import body_values, checks, edit, hints
from physics.edit import replace_mask
from physics.math2d import rotate
from physics.raster.pixel_tiles import Cut, Loose, Tool, cut, find_in_hull, find_in_pixels
from physics.shapes.kinds import mass_of, with_area
from physics.shapes.library import weigh
from physics.shapes.mask import PixelMask
from physics.shapes.shape import rectangle
from physics.tables.body import CONTINUOUS, DYNAMIC
from physics.tables.shape import MASK
from physics.world_state import WorldState


class Carved(NamedTuple):
    """The result of Body.carve.

    removed: number of pixels that were removed because they were inside the shape.
    fragments: Bodies of the separated pieces, sorted by the carved mask, then by the first pixel of the piece.
    crumbs: number of pixels that were removed because their separated piece was too small.
    """

    removed: int
    fragments: tuple[Any, ...]
    crumbs: int


def carve(world: WorldState, identity: int, shape: object, pose: object, crumb: object) -> Carved:
    """Remove from a body's masks all pixels whose centres are inside a shape or on its boundary. Return a Carved.

    identity: id of the body. The other arguments, the errors and the result are those of Body.carve, except that
    Carved.fragments holds ids instead of Bodies.
    """
    world._unlocked()
    world._needs("carving", "carve", True)
    if not isinstance(shape, tools := with_area()):
        names = ", ".join(each.__name__ for each in tools)
        hint = hints.in_place_of_shape(shape)
        raise TypeError(f"shape must be one of {names} to carve with (got {checks.shown(shape)}){hint}")
    pose, crumb = checks.pose("pose", pose), checks.whole("crumb", crumb, 0, 2**31)
    shapes = world._shapes_of[identity]
    if not any(each._kind == MASK for each in shapes):
        raise ValueError(f"body {identity} must have a PixelMask to be carved (got {checks.shown(shapes)})")
    row = world._body_row(identity)
    stays_in_pieces = row["kind"] != DYNAMIC
    frame = tuple(row[name].item() for name in ("x", "y", "angle"))
    cuts = {}
    for at, mask in enumerate(shapes):
        if isinstance(mask, PixelMask) and mask.area:
            tool, box = _tool_in(mask, frame, shape, pose)
            found = cut(mask.tiles, tool, box, not stays_in_pieces, crumb)
            if found.removed:
                cuts[at] = found
    if not cuts:
        return Carved(0, (), 0)
    pieces = [(shapes[at], loose) for at, each in cuts.items() for loose in each.loose]
    given, wanted = _motion_and_weight(world, identity), _values_of(world, identity) if pieces else None
    _shrink(world, identity, cuts, given)
    fragments = tuple(_add_fragment(world, *each, frame, given, wanted) for each in pieces) if wanted else ()
    removed, crumbs = sum(each.removed for each in cuts.values()), sum(each.crumbs for each in cuts.values())
    world._carved_pixels += removed + crumbs
    return Carved(removed, fragments, crumbs)


# --- the tool in the mask's raster -----------------------------------------------------------------------------------


def _tool_in(mask, frame, shape, pose):
    """Return (tool, box): a function that finds the pixels inside a shape in one tile of a mask, and the shape's AABB.

    tool: see pixel_tiles.Tool; box: (min_x, min_y, max_x, max_y) [px] in the raster of the mask. frame: pose
    (x, y, angle) of the mask's body in the world; pose: pose of the shape in the world.
    """
    corners = shape.points if shape._is_convex else rectangle(*(shape.bounds or (0.0, 0.0, 0.0, 0.0)))
    radius = shape.radius if shape._is_convex else 0.0
    x, y, angle = pose
    cosine, sine = math.cos(angle), math.sin(angle)
    seen = [_in_raster(mask, frame, x + u, y + v) for u, v in (rotate(*corner, cosine, sine) for corner in corners)]
    across, down = zip(*seen, strict=True)
    box = min(across) - radius, min(down) - radius, max(across) + radius, max(down) + radius
    if not shape._is_convex:
        return _mask_tool(mask, frame, shape, pose), box
    points = np.array(seen, np.float64)
    return lambda words, left, top, found: find_in_hull(words, left, top, points, radius, found), box


def _in_raster(mask, frame, x, y):
    """Convert a world point (x, y) [px] to coordinates (x, y) [px] in the raster of a mask.

    frame: pose (x, y, angle) of the mask's body.
    """
    u, v = rotate(x - frame[0], y - frame[1], math.cos(frame[2]), -math.sin(frame[2]))
    return u + mask.origin[0], v + mask.origin[1]


def _mask_tool(mask, frame, shape, pose) -> Tool:
    """Return a Tool (see pixel_tiles) that finds the pixels of a mask whose centres are in solid pixels of `shape`.

    mask: the carved mask; shape: the other mask; frame: pose (x, y, angle) of the body of `mask`; pose: pose of `shape`
    in the world.
    """
    turn = frame[2] - pose[2]
    cosine, sine = math.cos(turn), math.sin(turn)
    # The corner of the mask's raster, first in the world, then in the tool's raster.
    u, v = rotate(-mask.origin[0], -mask.origin[1], math.cos(frame[2]), math.sin(frame[2]))
    x, y = _in_raster(shape, pose, frame[0] + u, frame[1] + v)

    def find(words, left, top, found):
        along, down = rotate(float(left), float(top), cosine, sine)
        return find_in_pixels(words, shape.solid, x + along, y + down, cosine, sine, found)

    return find


# --- the remainder ------------------------------------------------------------------------------------------------


def _shrink(world: WorldState, identity: int, cuts: dict[int, Cut], given: "_Given") -> None:
    """Replace each carved mask of a body (id) by a mask of its remaining pixels, and remove empty masks.

    The body is removed if it has no shape left, or if it is dynamic and has no mass left. cuts: {index of a carved
    mask in the body's shapes: its Cut}; given: the motion and density of the body before the cut.
    """
    shapes, ids = world._shapes_of[identity], edit.shape_ids(world, identity)
    empty = [at for at, each in cuts.items() if not len(each.tiles.nodes)]
    rest = [shape for at, shape in enumerate(shapes) if at not in empty]
    if not rest or (world._body_row(identity)["kind"] == DYNAMIC and mass_of(tuple(rest), 1.0).mass == 0.0):
        world._remove([identity])
        return
    for at, each in cuts.items():
        mask = shapes[at]
        if at not in empty and isinstance(mask, PixelMask):
            replace_mask(world, identity, at, ids[at], mask.with_tiles(each.tiles), each.changed)
    for at in empty:
        edit.remove_shape(world, identity, ids[at])
    if given.share:
        left = weigh(world._shapes_of[identity], given.density, 0.0).mass
        edit.set_mass_of(world, identity, given.share * left)
    # The motion of the remaining pixels is unchanged; its velocity refers to the new centre of mass.
    row = world._body_row(identity)
    row["vx"] -= given.spin * (row["center_y"].item() - given.center[1])
    row["vy"] += given.spin * (row["center_x"].item() - given.center[0])


class _Given(NamedTuple):
    """The motion and density of a body before it is carved, from which those of its fragments are computed."""

    center: tuple[float, float]
    velocity: tuple[float, float]
    spin: float
    share: float  # given mass / mass from the densities; 0 if no mass was given
    density: float


def _motion_and_weight(world, identity) -> _Given:
    row, given = world._body_row(identity), world._definitions.rows[world._row_number(identity)]
    share, density = 0.0, given["density"].item()
    if given["mass"] > 0.0:
        share = given["mass"].item() / weigh(world._shapes_of[identity], density, 0.0).mass
    center = (row["center_x"].item(), row["center_y"].item())
    return _Given(center, (row["vx"].item(), row["vy"].item()), row["angular_velocity"].item(), share, density)


def _values_of(world, identity) -> edit.BodyDef:
    """Return the BodyDef of the fragments of a carved body (id): all values that they inherit, except the mass."""
    row, given = world._body_row(identity), world._definitions.rows[world._row_number(identity)]
    return edit.BodyDef(
        angular_velocity=row["angular_velocity"].item(),
        material=body_values.material_of(world, identity),
        filter=body_values.filter_of(world, identity),
        sensor=given["sensor"].item(),
        bullet=bool(row["bullet"]),
        continuous=CONTINUOUS[int(row["continuous"])],
        fixed_rotation=bool(row["fixed_rotation"]),
        gravity_scale=row["gravity_scale"].item(),
        allow_sleep=bool(row["allow_sleep"]),
    )


def _add_fragment(world, mask: PixelMask, loose: Loose, frame, given: _Given, wanted: edit.BodyDef) -> int:
    """Add a body for a separated piece of a carved mask, and return the body's id.

    The pixels of the piece keep their positions and velocities. mask: the carved mask; loose: the piece; frame: pose
    (x, y, angle) of the carved body; given: motion and density of the carved body; wanted: definition of the new body.
    """
    # The origin of the fragment is a corner of the mask's pixel grid near the middle of the piece, so that its pixels
    # stay on whole pixels.
    height, width = loose.solid.shape
    shift_x = loose.left + width // 2 - math.floor(mask.origin[0])
    shift_y = loose.top + height // 2 - math.floor(mask.origin[1])
    origin = (mask.origin[0] - loose.left + shift_x, mask.origin[1] - loose.top + shift_y)
    # A fragment of a one-way mask is solid from all sides.
    piece = mask.like(loose.solid, origin).with_(mask.material, mask.filter, mask.sensor, one_way=False)
    u, v = rotate(float(shift_x), float(shift_y), math.cos(frame[2]), math.sin(frame[2]))
    x, y = frame[0] + u, frame[1] + v
    weight = piece.mass_of(given.density if mask.material is None else mask.material.density)
    cx, cy = rotate(*weight.center, math.cos(frame[2]), math.sin(frame[2]))
    dx, dy = x + cx - given.center[0], y + cy - given.center[1]
    velocity = (given.velocity[0] - given.spin * dy, given.velocity[1] + given.spin * dx)
    heavy = wanted._replace(mass=weight.mass * given.share or None)
    return int(edit.add_rows(world, (piece,), [(x, y)], [velocity], [frame[2]], heavy)[0])
