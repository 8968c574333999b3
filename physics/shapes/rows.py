"""The rows that shapes need: SHAPE rows, masses, places in the broad phase."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from physics import checks
from physics.shapes.kinds import SHAPES, Shape, mass_of
from physics.shapes.library import Library
from physics.shapes.lines import Chain, Segment
from physics.shapes.mask import PixelMask
from physics.shapes.mass import Mass
from physics.shapes.outline import outline_of
from physics.shapes.tiles import TileGrid
from physics.tables.body import DYNAMIC, KINDS, STATIC


def check_shapes(shapes: Sequence, kind: int, angles: ArrayLike) -> None:
    """Refuse no shapes, dynamic chains, turned or dynamic tiles. Raises TypeError, ValueError."""
    if kind == DYNAMIC and shapes and all(isinstance(shape, Segment) for shape in shapes):
        raise ValueError(
            f"shapes of a dynamic body must hold one with mass, a Segment has none (got {checks.shown(shapes)})"
        )
    for shape in shapes:
        if not isinstance(shape, SHAPES):
            raise TypeError(f"shapes must be shapes such as Circle(8) (got {checks.shown(shape)})")
        if isinstance(shape, TileGrid) and (kind == DYNAMIC or np.any(np.asarray(angles) != 0.0)):
            raise ValueError(
                f"a TileGrid needs kind static or kinematic and angle 0 (got {KINDS[kind]}, "
                f"{np.asarray(angles).tolist()})"
            )
        if isinstance(shape, Chain) and kind == DYNAMIC:
            raise ValueError("a Chain needs kind static or kinematic (got dynamic): it has no inside and no mass")
        if isinstance(shape, PixelMask) and shape.one_way and kind == DYNAMIC:
            raise ValueError(f"a mask with one_way=True needs kind static or kinematic (got dynamic, {shape})")


def rounding_of(shape: Shape) -> tuple[float, float, float]:
    """(radius, centre of a circle in body space) [px] of a shape, or of what a Bounds wraps, for its SHAPE row."""
    inner = getattr(shape, "shape", shape)
    x, y = getattr(inner, "center", (0.0, 0.0))
    return getattr(inner, "radius", 0.0), x, y


def is_snapped(shape: Shape) -> bool:
    """Whether a shape is a mask that is tested as drawn, for its SHAPE row."""
    return isinstance(shape, PixelMask) and shape.snap


def weigh(shapes: Sequence[Shape], density: float, mass: float) -> Mass:
    """The mass of a body's shapes, sensors among them; mass: in place of what the densities make of it, 0: none."""
    found = mass_of(tuple(shapes), density)
    if mass == 0.0:
        return found
    return Mass(mass, found.center, found.inertia * (mass / found.mass) if found.mass > 0.0 else 0.0)


def thin_half(shape: Shape, in_parts: bool) -> float:
    """Half of how thin [px] a shape is where it is thinnest; in_parts: of a mask the parts that stand for it.

    Thin arms would be over a wall before the middle is: measured, sprites of 3 px blocks passed 1 px walls at half
    their size a step. A part thinner than a pixel lies beside one that makes it up.
    """
    if not (in_parts and isinstance(shape, PixelMask)):
        return shape.smallest_half
    return min((max(0.5, part.shape.smallest_half) for part in outline_of(shape)), default=shape.smallest_half)


def set_mass(rows: np.ndarray, mass: Mass, shapes: Sequence[Shape], in_parts: bool) -> None:
    """Write mass, inertia and size of BODY rows of one kind of body. in_parts: whether masks are pushed by parts."""
    in_parts = in_parts and bool((rows["kind"] != STATIC).any())  # how thin it is counts for what moves
    rows["mass"], rows["inertia"] = mass.mass, mass.inertia
    rows["local_center_x"], rows["local_center_y"] = mass.center
    moves = (rows["kind"] == DYNAMIC) & (mass.mass > 0.0)
    turns = moves & (mass.inertia > 0.0) & ~rows["fixed_rotation"]
    rows["inverse_mass"] = np.where(moves, 1.0 / mass.mass if mass.mass > 0.0 else 0.0, 0.0)
    rows["inverse_inertia"] = np.where(turns, 1.0 / mass.inertia if mass.inertia > 0.0 else 0.0, 0.0)
    rows["smallest_half"] = min((shape.smallest_half for shape in shapes), default=0.0)
    rows["thin_half"] = min((thin_half(shape, in_parts) for shape in shapes), default=0.0)
    rows["extent"] = max((shape.reach(*mass.center) for shape in shapes), default=0.0)


def place(
    library: Library, shape: Shape, bodies: np.ndarray, shapes: np.ndarray, row: int, pose: Sequence[float]
) -> None:
    """Fill a BODY and a SHAPE row for a shape at a pose that stands in no world."""
    b = bodies[row : row + 1]
    describe(library, shape, shapes[row : row + 1], row, row, pose[2:3])
    b["id"], b["x"], b["y"], b["angle"] = row, *pose
    b["previous_x"], b["previous_y"], b["previous_angle"] = pose


def describe(
    library: Library, shape: Shape, rows: np.ndarray, ids: ArrayLike, body_rows: ArrayLike, angles: Sequence[float]
) -> None:
    """Fill SHAPE rows, a view, for one shape at so many places in no world; angles: those that its bodies have."""
    kind, geometry, wrapped = library.add(shape)
    rows["id"], rows["body"], rows["body_row"] = ids, body_rows, body_rows
    rows["kind"], rows["geometry"], rows["wrapped"] = kind, geometry, wrapped
    rows["radius"], rows["local_x"], rows["local_y"] = rounding_of(shape)
    rows["snap"] = is_snapped(shape)
    if is_snapped(getattr(shape, "shape", shape)):
        for angle in angles:
            library.raster(geometry, angle)
