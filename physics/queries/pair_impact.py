"""When two moving shapes first touch, without a world."""

import math
from dataclasses import dataclass

import numpy as np

from physics.ccd.advance import TOLERANCE
from physics.ccd.closed_form import MISS, sweep_circles
from physics.ccd.parts import advance_on_ground, advance_parts, sweep_unions
from physics.ccd.rotational import new_rotational_workspace
from physics.checks import Pose
from physics.proximity.gjk import AX, AY, BX, BY, NX, NY, new_gap_workspace
from physics.proximity.witness import separate_parts
from physics.queries.pair_distance import checked
from physics.queries.pair_rows import order_of
from physics.shapes.bounds import Bounds
from physics.shapes.convex import Circle
from physics.shapes.kinds import Shape
from physics.shapes.library import Library
from physics.shapes.lines import Chain
from physics.shapes.mask import PixelMask
from physics.shapes.parts import (
    Parts,
    chain_outlines,
    mask_outlines,
    outline_parts,
    parts_of,
    rectangle,
    tile_outlines,
    turned_parts,
)
from physics.shapes.tiles import TileGrid
from physics.vec2 import Vec2

BOX_STOPS = 4000  # of a turning box, whose speed is only bounded: each is before the impact
LOOKS = 1024  # of shapes that touch and do not approach


@dataclass(frozen=True)
class TimeOfImpact:
    """Whether two motions meet; the first fraction 0..1 at which they touch; where [px];
    the unit normal from A to B."""

    hit: bool
    fraction: float
    point: Vec2 | None
    normal: Vec2 | None


NO_IMPACT = TimeOfImpact(False, 1.0, None, None)


def time_of_impact(
    shape_a: Shape, start_a: Pose, end_a: Pose, shape_b: Shape, start_b: Pose, end_b: Pose
) -> TimeOfImpact:
    """First fraction at which two shapes touch while their poses (x, y) or (x, y, angle) go straight from start to end,
    angles unwrapped.

    Two discs: in closed form; convex shapes: to 1e-13 of their size and motion. Touching or overlapping at the start:
    fraction 0 when they approach; when they part or slide they are looked at until they approach. A Chain is met from
    its front, a one-way tile from above; no seam of ground is felt, and what only grazes tiles or links does not meet
    them; nor does what only grazes a PixelMask, which is its outline at the exact pose. A Bounds whose shape turns
    changes its size on the way: to 1e-12 of it. Tiles and chains do not meet each other. Raises TypeError, ValueError.
    """
    moves = [
        [checked(f"shape_{side}", shape, f"{when}_{side}", pose) for when, pose in (("start", start), ("end", end))]
        for side, shape, start, end in (("a", shape_a, start_a, end_a), ("b", shape_b, start_b, end_b))
    ]
    ground = [isinstance(each, (TileGrid, Chain)) for each in (shape_a, shape_b)]
    if all(ground):
        return NO_IMPACT
    swap = ground[0] or (not ground[1] and (*order_of(shape_b), *moves[1]) < (*order_of(shape_a), *moves[0]))
    given = [(shape_a, moves[0]), (shape_b, moves[1])]
    (a, move_a), (b, move_b) = reversed(given) if swap else given
    fraction, nx, ny = _first(a, move_a, b, move_b)
    if fraction > 1.0:
        return NO_IMPACT
    side = -1.0 if swap else 1.0
    return TimeOfImpact(
        True, float(fraction), _point(a, move_a, b, move_b, fraction), Vec2(side * nx + 0.0, side * ny + 0.0)
    )


def _first(a, move_a, b, move_b):
    if any(isinstance(each, Bounds) and _turns(move) for each, move in ((a, move_a), (b, move_b))):
        return _advance_boxes(a, move_a, b, move_b)
    if isinstance(a, Circle) and isinstance(b, Circle) and not (_swings(a, move_a) or _swings(b, move_b)):
        (ax, ay), (bx, by) = (_turned_point(each.center, move[0][2]) for each, move in ((a, move_a), (b, move_b)))
        x, y = (move_b[0][0] - move_a[0][0]) + (bx - ax), (move_b[0][1] - move_a[0][1]) + (by - ay)
        dx, dy = ((move_b[1][k] - move_b[0][k]) - (move_a[1][k] - move_a[0][k]) for k in (0, 1))
        return sweep_circles(x, y, dx, dy, a.radius + b.radius)
    workspace, found, totals = new_rotational_workspace(), np.zeros(3), np.zeros(2)
    parts_a, motion_a = _local(a, move_a)
    if isinstance(b, (TileGrid, Chain)):
        library = Library()
        row = library.add(b)[1]
        advance_on_ground(
            library.tables, row, int(isinstance(b, Chain)), parts_a, motion_a, _motion(move_b), workspace, found, totals
        )
    else:
        parts_b, motion_b = _local(b, move_b)
        sweep = sweep_unions if isinstance(a, PixelMask) or isinstance(b, PixelMask) else advance_parts
        sweep(parts_a, parts_b, motion_a, motion_b, workspace, found, totals)
    return found.tolist()


def _turns(move) -> bool:
    return move[0][2] != move[1][2]


def _swings(circle, move) -> bool:
    return _turns(move) and circle.center != (0.0, 0.0)


def _turned_point(point, angle):
    cosine, sine = math.cos(angle), math.sin(angle)
    return cosine * point[0] - sine * point[1], sine * point[0] + cosine * point[1]


def _motion(move):
    start, end = move
    return np.array([*start, *(q - p for p, q in zip(start, end, strict=True))])


def _local(shape, move) -> tuple[Parts, np.ndarray]:
    """Parts in body space, and the motion they make; a Bounds that does not turn is the box it has at its angle."""
    motion = _motion(move)
    if not isinstance(shape, Bounds):
        return _body_parts(shape), motion
    angle, motion[2] = move[0][2], 0.0
    return _box_at(shape.shape, angle), motion


def _body_parts(shape) -> Parts:
    """In body space; of a mask its outline."""
    if isinstance(shape, PixelMask):
        return outline_parts(shape)
    if isinstance(shape, TileGrid):
        return parts_of(tile_outlines(shape, 0.0, 0.0, -math.inf))
    if isinstance(shape, Chain):
        return parts_of(chain_outlines(shape))
    if isinstance(shape, Circle):
        return parts_of([[shape.center]], shape.radius)
    return parts_of([shape.points], getattr(shape, "radius", 0.0))


def _boxed_parts(shape) -> Parts:
    """As _body_parts, of what a Bounds wraps: of a mask its pixels."""
    if isinstance(shape, PixelMask):
        return parts_of(mask_outlines(shape, 0, -shape.origin[0], -shape.origin[1]))
    return _body_parts(shape)


def _box_at(shape, angle) -> Parts:
    """The box around a shape that is turned by an angle; around a mask's pixels as it is drawn at that angle."""
    parts = _boxed_parts(shape)
    if isinstance(shape, PixelMask) and shape.snap and shape.area:
        turned = shape.turned(angle)
        rows, columns = np.nonzero(turned.solid)
        x, y = turned.origin
        return parts_of([rectangle(columns.min() - x, rows.min() - y, columns.max() + 1 - x, rows.max() + 1 - y)])
    if not len(parts.counts):
        return parts
    placed = _placed(parts, (0.0, 0.0, angle))
    return parts_of([rectangle(*placed.boxes[:, :2].min(axis=0), *placed.boxes[:, 2:].max(axis=0))])


def _placed(parts, pose, x=0.0, y=0.0) -> Parts:
    """Parts at a pose, seen from (x, y)."""
    return turned_parts(parts, pose[0] - x, pose[1] - y, math.cos(pose[2]), math.sin(pose[2]))


def _at(move, fraction):
    return tuple(p + fraction * (q - p) for p, q in zip(*move, strict=True))


def _parts_at(shape, move, fraction, x, y) -> Parts:
    pose = _at(move, fraction)
    if isinstance(shape, Bounds):
        return _placed(_box_at(shape.shape, pose[2]), (pose[0], pose[1], 0.0), x, y)
    return _placed(_body_parts(shape), pose, x, y)


def _point(a, move_a, b, move_b, fraction):
    """Midway between the nearest points at a fraction [px]."""
    x, y = move_a[0][:2]
    gap = _gap_at(*(_parts_at(each, move, fraction, x, y) for each, move in ((a, move_a), (b, move_b))))
    return Vec2(float(x + 0.5 * (gap[AX] + gap[BX])), float(y + 0.5 * (gap[AY] + gap[BY])))


def _gap_at(parts_a, parts_b):
    workspace = new_gap_workspace()
    separate_parts(parts_a, parts_b, np.zeros((16, 2)), np.zeros((16, 2)), workspace, np.zeros(2))
    return workspace.gap


def _advance_boxes(a, move_a, b, move_b):
    """Conservative advancement by the distance and a bound on the speed: where a box changes its size as it turns."""
    x, y = move_a[0][:2]
    parts = [_boxed_parts(each.shape) if isinstance(each, Bounds) else _body_parts(each) for each in (a, b)]
    if not all(len(each.counts) for each in parts):
        return MISS, 1.0, 0.0
    reach = [float(np.hypot(*np.abs(each.boxes).reshape(-1, 2, 2).max(axis=(0, 1)))) for each in parts]
    turn = [abs(move[1][2] - move[0][2]) for move in (move_a, move_b)]
    path = math.hypot(*((move_b[1][k] - move_b[0][k]) - (move_a[1][k] - move_a[0][k]) for k in (0, 1)))
    # Each side of a turning box moves no faster than its shape's furthest point, and a normal meets two sides.
    speed = path + math.sqrt(2.0) * (turn[0] * reach[0] + turn[1] * reach[1])
    tolerance = 1e-12 * (sum(reach) + path)

    def look(fraction):
        gap = _gap_at(*(_parts_at(each, move, fraction, x, y) for each, move in ((a, move_a), (b, move_b))))
        return float(gap[0]), float(gap[NX]), float(gap[NY])

    fraction, was_apart = 0.0, False
    for _ in range(BOX_STOPS):
        separation, nx, ny = look(fraction)
        if separation <= tolerance:
            soon = min(1.0, fraction + 1.0 / (LOOKS * LOOKS))
            if was_apart or look(soon)[0] < separation - TOLERANCE * speed:
                return fraction, nx, ny
            fraction += 1.0 / LOOKS
        else:
            was_apart = True
            if fraction == 1.0:
                return MISS, nx, ny
            fraction = min(1.0, fraction + separation / speed) if speed > 0.0 else 1.0
        if fraction > 1.0:
            return MISS, nx, ny
    return fraction, nx, ny
