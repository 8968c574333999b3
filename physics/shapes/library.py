"""Library: geometry of all shapes of a world in flat arrays, which kernels read.

Further functions write the SHAPE rows of shapes, and the masses and sizes in BODY rows.
"""

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import chain
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from physics.jit import kernel
from physics.outline.simple_shapes import mask_hull
from physics.raster.bits import bucket_of, halo, packed
from physics.raster.pixel_tiles import TILE
from physics.settings import MASK_ANGLE_BUCKETS, POSITION_LIMIT
from physics.shapes.kinds import Bounds, mass_of
from physics.shapes.mask import PixelMask
from physics.shapes.mass import Mass
from physics.shapes.outline import is_tiled
from physics.shapes.placement import place_masks
from physics.shapes.shape import EqualByArrays, Shape
from physics.shapes.values import Circle
from physics.tables.body import DYNAMIC, STATIC
from physics.tables.geometry import (
    BLOCK_LINKS,
    CELL,
    CHAIN_SPAN,
    CORNER,
    EMPTY,
    GRID,
    LINK,
    LINK_BLOCK,
    ONE_WAY,
    RASTER,
    SLOPE,
    SOLID,
    SPAN,
    Geometry,
)
from physics.tables.shape import BOUNDS, CAPSULE, CHAIN, CIRCLE, MASK, PART, PIXELS, POLYGON, SEGMENT, TILES
from physics.tables.table import Table

# ---- library ---------------------------------------------------------------------------------------------------------
# Corners, tiles and pixels of all shapes of a world, in flat arrays that kernels read.
#
# A shape used by a thousand bodies is stored once. Masks are rasterised per angle when an angle is needed. Unused
# geometry stays until it may be half of the whole; then the used geometry is copied to a new library.

SLACK = 1 << 16  # [bytes] size of added geometry, and …
FEW = 64  # … number of removed shapes, up to which unused geometry is always kept


class Geometries(NamedTuple):
    """All shapes of a library in one list for each kind of geometry, in the order of their geometry rows."""

    outlines: list  # convex shapes
    chains: list
    grids: list
    masks: list


class SameObject:
    """Dictionary key that is equal only to a key with the same mask or tile grid.

    Their values are not compared, because hashing the pixels after each cut would take longer than the cut.
    """

    __slots__ = ("shape",)

    def __init__(self, shape: Shape) -> None:
        self.shape = shape

    def __hash__(self) -> int:
        return id(self.shape)

    def __eq__(self, other: object) -> bool:
        """Return whether the other value is a key with the same object."""
        return isinstance(other, SameObject) and self.shape is other.shape


def key_of(shape: Shape) -> Shape | SameObject:
    """Return the key of a bare shape in Library.shapes."""
    return SameObject(shape) if isinstance(shape, EqualByArrays) else shape


class Library:
    """Geometry of all shapes of a world as flat arrays. Each distinct geometry is stored once.

    Convex shapes and chains share their geometry if their values are equal. Tile grids and masks share it only if they
    are the same object.
    """

    def __init__(self) -> None:
        self.polygons, self.corners = Table(SPAN), Table(CORNER)
        self.chains, self.links, self.link_blocks = Table(CHAIN_SPAN), Table(LINK), Table(LINK_BLOCK)
        self.grids, self.cells = Table(GRID), Table(CELL)
        self.rasters, self.words = Table(RASTER), Table(np.uint64, 64)
        self.raster_of = np.full((4, MASK_ANGLE_BUCKETS), -1, np.int64)
        # The geometry row of each shape, which is stored without material, filter and sensor; see key_of.
        self.shapes: dict[Shape | SameObject, int] = {}
        self.masks, self.tile_grids = [], []
        self.outlines, self.chain_shapes = [], []  # convex shapes by row, without circles; chains by row
        self.gone = 0  # number of SHAPE rows removed from the world since this library was created
        self.least = 0  # [bytes] size when this library was created
        self.tables = self._tables()

    @property
    def grown(self) -> tuple[Table, ...]:
        """The tables that may get new rows when a shape is added."""
        return (
            self.polygons,
            self.corners,
            self.chains,
            self.links,
            self.link_blocks,
            self.grids,
            self.cells,
            self.rasters,
            self.words,
        )

    @property
    def size(self) -> int:
        """Memory [bytes] of all geometry rows in use."""
        return sum(table.count * table.data.itemsize for table in self.grown)

    def may_be_half_unused(self, shapes: int) -> bool:
        """Return whether half of the geometry may be unused, so that copying the used half is worth the time.

        This is the case if more SHAPE rows were removed than now exist. It is also the case if the size has more than
        doubled since the last copy. Both limits are raised by a small constant. shapes: number of SHAPE rows.
        """
        return self.gone > shapes + (FEW if shapes else 0) or self.size > 2 * self.least + SLACK

    def without_unused(self, shapes: np.ndarray) -> "Library":
        """Return a new library with only the geometry that the given SHAPE rows use.

        The columns `geometry` and `raster` of these rows are updated to row numbers of the new library.
        """
        fresh = Library()
        kinds = np.where(shapes["kind"] == BOUNDS, shapes["wrapped"], shapes["kind"])
        rasters = np.zeros(self.rasters.count + 1, np.int64)
        for of, known in (
            ((CIRCLE, POLYGON, CAPSULE, SEGMENT), self.outlines),
            ((CHAIN,), self.chain_shapes),
            ((TILES,), self.tile_grids),
            ((MASK,), self.masks),
        ):
            mine = np.flatnonzero(np.isin(kinds, of) & (shapes["geometry"] >= 0))
            used, which = np.unique(shapes["geometry"][mine], return_inverse=True)
            if known is self.outlines:
                rows = fresh._add_known_hulls(self, used)
            else:
                rows = np.array([fresh.add(known[row])[1] for row in used.tolist()], np.int64)
            shapes["geometry"][mine] = rows[which]
            if known is self.masks:
                for old, new in zip(used.tolist(), rows.tolist(), strict=True):
                    for bucket in np.flatnonzero(self.raster_of[old] >= 0).tolist():
                        if fresh.raster_of[new, bucket] < 0:
                            fresh.add_raster(new, bucket)
                        rasters[self.raster_of[old, bucket]] = fresh.raster_of[new, bucket]
        # A raster drawn for a query is removed after the query (see visited). If its row is beyond the table, row 0 is
        # used.
        shapes["raster"] = rasters[np.minimum(shapes["raster"], self.rasters.count)]
        fresh.least = fresh.size
        return fresh

    def _tables(self):
        return Geometry._make((*(table.data for table in self.grown), self.raster_of))

    def add(self, shape: Shape) -> tuple[int, int, int]:
        """Add the geometry of a shape if it is not stored yet. Return (kind, geometry row, wrapped kind).

        The geometry row is the row number of the geometry in the table for its kind, or -1 for a circle, which needs no
        geometry. The wrapped kind is the kind of the shape inside a Bounds, and -1 for any other shape.
        """
        inner = shape._inner.bare
        row = -1 if isinstance(inner, Circle) else self._row_of(inner)
        return shape._kind, row, inner._kind if shape._inner is not shape else -1

    def _row_of(self, shape):
        """Return the geometry row of a shape. Geometry that is not stored yet is added first."""
        key = key_of(shape)
        if key not in self.shapes:
            add = {TILES: self._add_grid, MASK: self._add_mask, CHAIN: self._add_chain}.get(shape._kind)
            self.shapes[key] = add(shape) if add else self._add_hulls([shape])[0]
            self.tables = self._tables()
        return self.shapes[key]

    def _add_hulls(self, shapes):
        counts = np.array([len(each.points) for each in shapes], np.int64)
        rows = np.arange(self.polygons.count, self.polygons.count + len(shapes))
        spans = self.polygons.append(len(shapes))
        spans["offset"], spans["count"] = self.corners.count + np.cumsum(counts) - counts, counts
        points = chain.from_iterable(chain.from_iterable(each.points for each in shapes))
        self.corners.append(int(counts.sum()))[:] = np.fromiter(points, np.float64).view(CORNER)
        self.outlines += shapes
        return rows

    def _add_known_hulls(self, library, rows):
        """Copy convex shapes from another library, all at once. Return their new geometry rows.

        The entries by which `add` recognises equal shapes are copied, too. rows: geometry rows of the shapes in
        `library`.
        """
        new = self._add_hulls([library.outlines[row] for row in rows.tolist()])
        place = dict(zip(rows.tolist(), new.tolist(), strict=True))
        for shape, row in library.shapes.items():
            if isinstance(shape, Shape) and shape._is_convex and row in place:
                self.shapes[shape] = place[row]
        self.tables = self._tables()
        return new

    def _add_chain(self, shape):
        row, count = self.chains.count, shape.links
        blocks = -(-count // BLOCK_LINKS)
        self.chains.append()[:] = (self.links.count, count, self.link_blocks.count, blocks)
        a = np.array(shape.points)
        b = np.roll(a, -1, axis=0)[:count]
        # Neighbours of a link: the adjacent links (in a loop the first and last link are adjacent), or the ghosts at
        # the ends of an open chain.
        before, after = np.roll(a, 1, axis=0)[:count], np.roll(a, -2, axis=0)[:count]
        links = self.links.append(count)
        links["has_before"] = links["has_after"] = links["last_owned"] = True
        if not shape.loop:
            ghosts = shape.ghosts or (None, None)
            links["has_before"][0], links["has_after"][-1] = (each is not None for each in ghosts)
            links["first_owned"][0] = True
            before[0] = a[0] if ghosts[0] is None else ghosts[0]
            after[-1] = b[-1] if ghosts[1] is None else ghosts[1]
        for name, points in (("a", a[:count]), ("b", b), ("before_", before), ("after_", after)):
            links[name + "x"], links[name + "y"] = points.T
        for name, as_shape in (
            ("friction", -1.0),
            ("restitution", -1.0),
            ("rolling_resistance", -1.0),
            ("surface_speed", np.nan),
        ):
            links[name] = as_shape if shape.materials is None else [getattr(each, name) for each in shape.materials]
        for block, box in enumerate(self.link_blocks.append(blocks)):
            part = slice(block * BLOCK_LINKS, (block + 1) * BLOCK_LINKS)
            ends = np.concatenate([a[:count][part], b[part]])
            box["min_x"], box["min_y"] = ends.min(axis=0)
            box["max_x"], box["max_y"] = ends.max(axis=0)
        self.chain_shapes.append(shape)
        return row

    def _add_grid(self, shape):
        row = self.grids.count
        rows, columns = shape.solid.shape
        self.grids.append()[:] = (self.cells.count, rows, columns, shape.tile_size)
        cells = self.cells.append(rows * columns)
        kind = np.where(shape.solid, SOLID, np.where(shape.one_way, ONE_WAY, EMPTY))
        cells["kind"] = np.where((shape.slopes > 0).any(axis=2), SLOPE, kind).ravel()
        cells["left"], cells["right"] = shape.slopes.reshape(-1, 2).T
        kinds = cells["kind"].reshape(rows, columns)
        first = np.tile(np.arange(columns), (rows, 1))
        last = first.copy()
        merges = np.isin(kinds, (SOLID, ONE_WAY))
        joined = merges[:, 1:] & (kinds[:, 1:] == kinds[:, :-1])
        for column in range(1, columns):
            first[:, column] = np.where(joined[:, column - 1], first[:, column - 1], column)
            last[:, -1 - column] = np.where(joined[:, -column], last[:, -column], columns - 1 - column)
        cells["first"], cells["last"] = first.ravel(), last.ravel()
        self.tile_grids.append(shape)
        return row

    def _add_mask(self, shape):
        self.masks.append(shape)
        row = len(self.masks) - 1
        if row >= len(self.raster_of):
            self.raster_of = np.concatenate([self.raster_of, np.full_like(self.raster_of, -1)])
        self.add_raster(row, 0)
        return row

    def add_parts(self, shapes: Sequence[Shape]) -> np.ndarray:
        """Add shapes without a search for equal ones. Return an array (n, 3): for each shape the result of `add`.

        This is faster than `add`, and meant for shapes such as the parts of a mask's outline. A convex shape that is
        already stored is stored again.
        """
        kinds = [shape._kind for shape in shapes]
        if CHAIN in kinds:
            return np.array([self.add(shape) for shape in shapes], np.int64)
        found = np.full((len(shapes), 3), -1)
        found[:, 0] = kinds
        hulls = [k for k, shape in enumerate(shapes) if not isinstance(shape, Circle)]
        if hulls:
            found[hulls, 1] = self._add_hulls([shapes[k] for k in hulls])
            self.tables = self._tables()
        return found

    @classmethod
    def of(cls, shapes: Geometries) -> "Library":
        """Return a library with the given shapes, in which each shape's geometry row is its index in its list."""
        library = cls()
        library.add_parts(shapes.outlines)
        for row, shape in reversed([*enumerate(shapes.outlines)]):
            library.shapes[shape] = row
        for shape in (*shapes.chains, *shapes.grids, *shapes.masks):
            library.add(shape)
        return library

    def replace(self, old: Shape, new: PixelMask, changed: Sequence[int] | None, shapes: np.ndarray) -> int:
        """Store the mask `new` in place of the mask `old` of one SHAPE row. Return the geometry row of `new`.

        changed: numbers of the tiles in which the two masks differ, None if unknown; shapes: all SHAPE rows. Three
        conditions allow a fast update in place: the new mask is large, it has snap=True, and no other SHAPE row uses
        the old mask. Then only the changed tiles are written: O(changed words). The hull of the old mask is kept, so
        the AABB at other angles may be larger than the pixels. Otherwise the new mask is added by `add`.
        """
        row = self.shapes[key_of(old)]
        users = (shapes["kind"] == MASK) & (shapes["geometry"] == row)
        if changed is None or not is_tiled(new) or key_of(new) in self.shapes or users.sum() > 1 or not new.snap:
            return self.add(new)[1]
        del self.shapes[key_of(old)]
        self.shapes[key_of(new)] = row
        self.masks[row] = new
        self.raster_of[row, 1:] = -1
        raster = self.rasters.data[self.raster_of[row, 0]]
        stride, rows, left = int(raster["stride"]), new.size[1], int(raster["offset"])
        words = self.words.data[left : left + rows * stride].reshape(rows, stride)
        for tile in changed:
            line, column = divmod(tile, new.tiles.columns)
            part = words[line * TILE : (line + 1) * TILE, column]
            part[:] = new.tiles.words[tile][: len(part)]
        bounds = new.solid_box or (1, 1, 0, 0)
        for name, value in zip(("set_left", "set_top", "set_right", "set_bottom"), bounds, strict=True):
            raster[name] = value
        raster["area"] = new.area
        return row

    def _add_exact(self, shape):
        """Add the data of a mask for tests at exact poses: its convex hull, and its halo if snap is False.

        The hull gives a tight AABB. The halo consists of the solid pixels and their neighbours, see raster/exact.py.
        Return (first word of the halo or -1, words per row, first corner of the hull, number of corners). These values
        are stored in the RASTER row at angle 0.
        """
        hull = _hull_of(shape)
        around = np.zeros((0, 0), np.uint64) if shape.snap else halo(shape.solid)
        first = -1 if shape.snap else self.words.count, around.shape[1], self.corners.count, len(hull)
        self.words.append(around.size)[:] = around.ravel()
        corners = self.corners.append(len(hull))
        corners["x"], corners["y"] = hull.T
        return first

    def add_raster(self, mask: int, bucket: int) -> None:
        """Add the raster of a mask rotated to an angle bucket, one of 128 equal parts of a full turn.

        mask: geometry row of the mask, which is its index in Library.masks; bucket: index of the angle bucket.
        """
        shape = self.masks[mask]
        words, (width, height), origin, box = _drawn(shape, bucket)
        self.raster_of[mask, bucket] = self.rasters.count
        exact = self._add_exact(shape) if bucket == 0 else (-1, 0, 0, 0)
        self.rasters.append()[:] = (
            *(
                self.words.count,
                width,
                height,
                words.shape[1],
                *origin,
                *(box or (1, 1, 0, 0)),
                int(np.bitwise_count(words).sum()),
            ),
            *exact,
        )
        self.words.append(words.size)[:] = words.ravel()
        self.tables = self._tables()

    def shapes_by_row(self) -> Geometries:
        """Return all shapes of the library in lists ordered by geometry row, for a snapshot.

        Library.of makes an equal library from the result.
        """
        return Geometries([*self.outlines], [*self.chain_shapes], [*self.tile_grids], [*self.masks])

    def shape_of(self, row: np.void) -> Shape:
        """Return a shape equal to the one that a SHAPE row describes, but without material, filter and sensor."""
        kind, geometry = int(row["kind"]), int(row["geometry"])
        inner = int(row["wrapped"]) if kind == BOUNDS else kind
        if geometry < 0:
            shape = Circle(float(row["radius"]), (float(row["local_x"]), float(row["local_y"])))
        else:
            known = {TILES: self.tile_grids, MASK: self.masks, CHAIN: self.chain_shapes}
            shape = known.get(inner, self.outlines)[geometry]
        return Bounds(shape) if kind == BOUNDS else shape

    @contextmanager
    def visited(self) -> Iterator[None]:
        """Return a context manager that finally removes all geometry added inside its `with` block, as for a query."""
        kept = [(table, table.count) for table in self.grown]
        lists = [(each, len(each)) for each in (self.masks, self.tile_grids, self.outlines, self.chain_shapes)]
        known = len(self.shapes)
        try:
            yield
        finally:
            for key in list(self.shapes)[known:]:
                del self.shapes[key]
            for table, count in kept:
                table.count = count
            for each, count in lists:
                del each[count:]
            self.raster_of[self.raster_of >= self.rasters.count] = -1
            self.tables = self._tables()

    def raster(self, mask: int, angle: float) -> np.void:
        """Return the RASTER row of a mask at an angle [rad], and add it if it is missing.

        mask: geometry row of the mask.
        """
        bucket = bucket_of(angle, MASK_ANGLE_BUCKETS)
        if self.raster_of[mask, bucket] < 0:
            self.add_raster(mask, bucket)
        return self.rasters.data[int(self.raster_of[mask, bucket])]


def _drawn(shape, bucket):
    """Return the pixels of a mask at an angle bucket: (packed words, size, origin, box of the solid pixels or None).

    bucket: index of one of 128 angles; size: (width, height) [px]; origin: origin of body space in the raster [px];
    box: (left, top, right, bottom) [px].
    """
    if bucket == 0:
        return shape.words, shape.size, shape.origin, shape.solid_box
    turned = shape.turned_to(bucket)
    rows, columns = np.nonzero(turned.solid)
    box = (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1) if len(rows) else None
    return packed(turned.solid), turned.solid.shape[::-1], turned.origin, box


def _hull_of(shape):
    """Return the corners (n, 2) [px] of a mask's convex hull; for a large mask with snap=True, of its bounding box."""
    if shape.area and is_tiled(shape) and shape.snap:
        left, top, right, bottom = shape.bounds
        return np.array([(left, top), (right, top), (right, bottom), (left, bottom)])
    return mask_hull(shape) if shape.area else np.zeros((0, 2))


# ---- rasters ---------------------------------------------------------------------------------------------------------
# Rasters of masks: the pixels at one of 128 angles (angle buckets), added before a kernel needs them.
#
# The columns raster, left and top of a SHAPE row with the role PIXELS are valid for one test only. Every reader, such
# as the narrow phase, first writes them with `draw_masks`. A mask with snap=False is tested by its unrotated pixels,
# transformed with its body; its rasters at other angles are only for pictures.


def draw_masks(library: Library, rows: np.ndarray, bodies: np.ndarray, shapes: np.ndarray) -> None:
    """Write the columns raster, left and top of masks for the present poses of their bodies. Add missing rasters.

    rows: indices of SHAPE rows; only masks with role = PIXELS and snap = True are written. A mask is skipped if its
    body is beyond POSITION_LIMIT.
    """
    _draw(library, rows[(shapes["role"][rows] == PIXELS) & shapes["snap"][rows]], bodies, shapes)


def draw_pictures(library: Library, rows: np.ndarray, bodies: np.ndarray, shapes: np.ndarray) -> None:
    """Write the columns raster, left and top of masks for a picture at the present poses. Add missing rasters.

    rows: indices of SHAPE rows; only masks with role = PIXELS or snap = False are written.
    """
    pictured = (shapes["role"][rows] == PIXELS) | ~shapes["snap"][rows]
    _draw(library, rows[(shapes["kind"][rows] == MASK) & pictured], bodies, shapes)


def _draw(library, rows, bodies, shapes):
    if not len(rows):
        return
    x, y, angles = (bodies[name][shapes["body_row"][rows]] for name in ("x", "y", "angle"))
    there = (np.abs(x) < POSITION_LIMIT) & (np.abs(y) < POSITION_LIMIT) & (np.abs(angles) < POSITION_LIMIT)
    rows, angles = rows[there], angles[there]
    # The formula of placement.bucket_at.
    buckets = np.floor(angles * MASK_ANGLE_BUCKETS / math.tau + 0.5).astype(np.int64) & (MASK_ANGLE_BUCKETS - 1)
    masks = shapes["geometry"][rows]
    missing = library.raster_of[masks, buckets] < 0
    if missing.any():
        for mask, bucket in np.unique(np.stack([masks, buckets], axis=1)[missing], axis=0).tolist():
            library.add_raster(mask, bucket)
    place_masks(rows, library.tables, bodies, shapes)


# ---- rows ------------------------------------------------------------------------------------------------------------
# Table rows of shapes: SHAPE rows, and masses and extents of BODY rows.


def rounding_of(shape: Shape) -> tuple[float, float, float]:
    """Return (rounding radius, x, y) [px] of a shape. x, y: centre of a circle in body space, 0 for other shapes.

    For a Bounds, the values are those of the shape inside it.
    """
    inner = shape._inner
    x, y = inner.points[0] if inner._kind == CIRCLE else (0.0, 0.0)
    return inner.radius if inner._is_convex else 0.0, x, y


def weigh(shapes: Sequence[Shape], density: float, mass: float) -> Mass:
    """Return the Mass of a body with these shapes, sensors included.

    density [mass per px2]: density of shapes without a material; mass: total mass of the body, or 0 to compute it from
    the densities.
    """
    found = mass_of(tuple(shapes), density)
    if mass == 0.0:
        return found
    return Mass(mass, found.center, found.inertia * (mass / found.mass) if found.mass > 0.0 else 0.0)


def set_mass(rows: np.ndarray, mass: Mass, shapes: Sequence[Shape], in_parts: bool) -> None:
    """Write mass, inertia and size to BODY rows whose bodies all have the given shapes.

    mass: Mass of the shapes; in_parts: whether masks collide by the convex parts of their outlines. If so, the column
    `inradius` is that of the thinnest part.
    """
    in_parts = in_parts and bool((rows["kind"] != STATIC).any())  # only moving bodies need the thinnest part
    rows["mass"], rows["inertia"] = mass.mass, mass.inertia
    rows["local_center_x"], rows["local_center_y"] = mass.center
    moves = (rows["kind"] == DYNAMIC) & (mass.mass > 0.0)
    turns = moves & (mass.inertia > 0.0) & ~rows["fixed_rotation"]
    rows["inverse_mass"] = np.where(moves, 1.0 / mass.mass if mass.mass > 0.0 else 0.0, 0.0)
    rows["inverse_inertia"] = np.where(turns, 1.0 / mass.inertia if mass.inertia > 0.0 else 0.0, 0.0)
    rows["min_half_extent"] = min((shape.min_half_extent for shape in shapes), default=0.0)
    halves = (shape._thinnest_half if in_parts else shape.min_half_extent for shape in shapes)
    rows["inradius"] = min(halves, default=0.0)
    rows["extent"] = max((shape.reach(*mass.center) for shape in shapes), default=0.0)


def place(
    library: Library, shape: Shape, bodies: np.ndarray, shapes: np.ndarray, row: int, pose: Sequence[float]
) -> None:
    """Fill one BODY row and one SHAPE row with the shape of a query, which belongs to no body of the world.

    The SHAPE row refers to the geometry of `shape` in the library, which is added if it is missing. row: index in both
    tables; pose: (x, y, angle) [px, px, rad].
    """
    b = bodies[row : row + 1]
    describe(library, shape, shapes[row : row + 1], row, row, pose[2:3])
    b["id"], b["x"], b["y"], b["angle"] = row, *pose
    b["previous_x"], b["previous_y"], b["previous_angle"] = pose


def describe(
    library: Library, shape: Shape, rows: np.ndarray, ids: ArrayLike, body_rows: ArrayLike, angles: Sequence[float]
) -> None:
    """Fill several SHAPE rows with the same shape of a query, one row for each pose.

    rows: a view of the SHAPE rows; ids, body_rows: values of the columns `id` and `body_row`, one number for all rows
    or one each; angles [rad]: angles of the poses. For a mask with snap=True, the rasters at all angles are added.
    """
    kind, geometry, wrapped = library.add(shape)
    rows["id"], rows["body"], rows["body_row"] = ids, body_rows, body_rows
    rows["kind"], rows["geometry"], rows["wrapped"] = kind, geometry, wrapped
    rows["radius"], rows["local_x"], rows["local_y"] = rounding_of(shape)
    rows["snap"] = shape.snap
    if shape._inner.snap:
        for angle in angles:
            library.raster(geometry, angle)


# ---- part rows -------------------------------------------------------------------------------------------------------
# SHAPE rows of a large mask's parts: the rows of parts in given tiles, and the rows of parts equal to given polygons.


def rows_in_tiles(shapes: np.ndarray, owner: int, wanted: np.ndarray) -> np.ndarray:
    """Return the indices (n,) int64 of the SHAPE rows that are parts of a mask in selected tiles. O(shapes).

    owner: id of the mask's SHAPE row; wanted (tiles,) bool: whether each tile, by tile number, is selected.
    """
    found = np.empty(len(shapes), np.int64)
    return found[: list_parts(shapes, owner, wanted, found)]


def find_equal(
    geometry: Geometry, shapes: np.ndarray, rows: np.ndarray, corners: np.ndarray, counts: np.ndarray
) -> np.ndarray:
    """Find a SHAPE row with an equal polygon for each of k polygons. Return indices in `rows` (k,), -1 for no such row.

    Equal polygons have the same corners in the same order. geometry: tables of the library; rows (n,): the SHAPE rows
    to search; corners (m, 2) [px]: corners of all polygons, one polygon after another; counts (k,): number of corners
    of each polygon. O(k n).
    """
    found = np.empty(len(counts), np.int64)
    find_polygons(geometry, shapes, rows, corners, counts, found)
    return found


@kernel
def list_parts(shapes, owner, wanted, rows_out):
    """Write the indices of the SHAPE rows that are parts of a mask in selected tiles. Return their number. O(shapes).

    owner: id of the mask's SHAPE row; wanted (tiles,) bool: whether each tile, by tile number, is selected; rows_out
    (shapes,) int64: the indices.
    """
    count = 0
    for k in range(len(shapes)):
        s = shapes[k]
        if s.parent == owner and s.role == PART and wanted[s.tile]:
            rows_out[count] = k
            count += 1
    return count


@kernel
def find_polygons(geometry, shapes, rows, corners, counts, found_out):
    """Write, for each polygon, the index in `rows` of a SHAPE row with an equal polygon, or -1. O(k n).

    found_out (k,) int64: the indices; other arguments: see find_equal.
    """
    first = 0
    for k in range(len(counts)):
        found_out[k] = -1
        for i in range(len(rows)):
            span = geometry.polygons[shapes[rows[i]].geometry]
            same = span.count == counts[k]
            j = 0
            while same and j < counts[k]:
                corner = geometry.corners[span.offset + j]
                same = corner.x == corners[first + j, 0] and corner.y == corners[first + j, 1]
                j += 1
            if same:
                found_out[k] = i
                break
        first += counts[k]
