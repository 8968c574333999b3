"""Mass, centre of mass and inertia of plane figures and of bodies. Area shared by shapes of a body counts once."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from physics.annotations import Coordinates, Corners
from physics.math2d import Vec2
from physics.outline.measure import (
    NO_SUMS,
    ROUNDING,
    Box,
    Moments,
    Stretch,
    Sums,
    boundary,
    cell_sums,
    cells_of,
    moments,
    shared_sums,
    sums_of,
)

# ---- mass ------------------------------------------------------------------------------------------------------------
# Masses of plane figures: exact sums over parts, each about its own centre, which is precise far from the origin.


@dataclass(frozen=True)
class Mass:
    """Mass, centre of mass and inertia of shapes, returned by mass_of.

    mass: [density px²].
    center: centre of mass (x, y) in body space [px].
    inertia: moment of inertia about the centre of mass [density px⁴].
    """

    mass: float
    center: Vec2
    inertia: float


NOTHING = Mass(0.0, Vec2(0.0, 0.0), 0.0)


def together(parts: Iterable[Mass]) -> Mass:
    """Return the total Mass of several parts, with the inertia about their common centre (parallel axis theorem)."""
    parts = [part for part in parts if part.mass > 0.0]
    if not parts:
        return NOTHING
    # Positions relative to the first part's centre are precise far from the origin.
    base_x, base_y = parts[0].center
    mass = math.fsum(part.mass for part in parts)
    x = math.fsum(part.mass * (part.center[0] - base_x) for part in parts) / mass
    y = math.fsum(part.mass * (part.center[1] - base_y) for part in parts) / mass
    inertia = math.fsum(
        part.inertia + part.mass * ((part.center[0] - base_x - x) ** 2 + (part.center[1] - base_y - y) ** 2)
        for part in parts
    )
    return Mass(mass, Vec2(base_x + x, base_y + y), inertia)


def polygon_mass(points: Corners, density: float) -> Mass:
    """Return the Mass of a polygon, by shoelace integrals.

    points (n, 2) [px]: corners, clockwise on the screen; density [mass per px2].
    """
    base = np.array(points[0])
    a = np.array(points) - base
    b = np.roll(a, -1, axis=0)
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    area = cross.sum() / 2.0
    center = ((a + b) * cross[:, None]).sum(axis=0) / (6.0 * area)
    a, b = a - center, b - center
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    second = (cross * ((a * a).sum(1) + (a * b).sum(1) + (b * b).sum(1))).sum() / 12.0
    return Mass(float(density * area), Vec2(*(base + center).tolist()), float(density * second))


def rounded_mass(points: Corners, radius: float, density: float) -> Mass:
    """Return the Mass of a convex polygon rounded by a radius [px].

    The Masses of the polygon, of a rectangle along each side, and of a sector at each corner are added. points (n, 2)
    [px]: corners, clockwise on the screen; density [mass per px2].
    """
    parts = [polygon_mass(points, density)]
    count = len(points)
    edges = [
        (points[(k + 1) % count][0] - points[k][0], points[(k + 1) % count][1] - points[k][1]) for k in range(count)
    ]
    for k, (dx, dy) in enumerate(edges):
        length = math.hypot(dx, dy)
        out_x, out_y = dy / length, -dx / length
        mass = density * length * radius
        parts.append(
            Mass(
                mass,
                Vec2(points[k][0] + 0.5 * dx + 0.5 * radius * out_x, points[k][1] + 0.5 * dy + 0.5 * radius * out_y),
                mass * (length * length + radius * radius) / 12.0,
            )
        )
        before_x, before_y = edges[k - 1]
        turn = math.atan2(before_x * dy - before_y * dx, before_x * dx + before_y * dy)
        # The axis of the sector is the bisector of the two outward normals.
        other = math.hypot(before_x, before_y)
        bisector_x, bisector_y = out_x + before_y / other, out_y - before_x / other
        size = math.hypot(bisector_x, bisector_y)
        away = 4.0 * radius * math.sin(0.5 * turn) / (3.0 * turn)
        mass = density * 0.5 * turn * radius * radius
        parts.append(
            Mass(
                mass,
                Vec2(points[k][0] + away * bisector_x / size, points[k][1] + away * bisector_y / size),
                mass * (0.5 * radius * radius - away * away),
            )
        )
    return together(parts)


def disc_mass(center: Coordinates, radius: float, density: float) -> Mass:
    """Return the Mass of a disc. center (x, y) [px]; radius [px]; density [mass per px2]."""
    mass = density * math.pi * radius * radius
    return Mass(mass, Vec2(*center), mass * radius * radius / 2.0)


def capsule_mass(a: Coordinates, b: Coordinates, r: float, density: float) -> Mass:
    """Return the Mass of a capsule of radius r [px] around the line from a to b [px]: a rectangle and two half discs.

    The centre of mass of a half disc is 4r/3π beyond the end of the line. density [mass per px2].
    """
    length = math.hypot(b[0] - a[0], b[1] - a[1])
    middle, ends = density * 2.0 * r * length, density * math.pi * r * r
    inertia = middle * (length * length + 4.0 * r * r) / 12.0 + ends * (
        r * r / 2.0 + length * length / 4.0 + length * 4.0 * r / (3.0 * math.pi)
    )
    center = Vec2(a[0] + 0.5 * (b[0] - a[0]), a[1] + 0.5 * (b[1] - a[1]))
    return Mass(middle + ends, center, inertia)


def convex_mass(points: Corners, radius: float, density: float) -> Mass:
    """Return the Mass of a convex hull rounded by a radius [px].

    points: 1 or more corners [px], clockwise on the screen; density [mass per px2].
    """
    if len(points) < 3:
        if len(points) == 2:
            return capsule_mass(points[0], points[1], radius, density)
        return disc_mass(points[0], radius, density)
    return rounded_mass(points, radius, density) if radius > 0.0 else polygon_mass(points, density)


# ---- overlapping -----------------------------------------------------------------------------------------------------
# Mass of the shapes of one body: overlapping area counts once, with the density of the densest shape.
#
# This holds for convex shapes and for pixel masks, which are the union of their pixel squares. Tile grids and lines
# have no mass. Shapes connected by overlaps form a group, whose mass is the mass of the group's union. Shapes that only
# touch are weighed alone, with the same result to the bit as if each were the body's only shape.


class Hull(NamedTuple):
    """A convex shape as argument of weighed_once: corners in body space [px], rounding radius and density."""

    corners: tuple
    radius: float  # [px]
    density: float


class Pixels(NamedTuple):
    """A pixel mask as argument of weighed_once, with its density [mass per px2]."""

    mask: Any  # a PixelMask; its module imports this one
    density: float


Weighed = Hull | Pixels


def weighed_once(parts: Sequence[tuple]) -> Mass:
    """Return the total Mass of several shapes. Shared area counts once, with the highest density of the shapes there.

    parts: [(shape, density)], density [mass per px2].
    """
    if len(parts) < 2:
        return together(shape.mass_of(density) for shape, density in parts)
    figures = [_figure_of(shape, density) for shape, density in parts]
    groups = _groups([each for each in figures if each is not None])
    crowded = set().union(*groups) if groups else set()
    alone = [
        shape.mass_of(density) for (shape, density), each in zip(parts, figures, strict=True) if each not in crowded
    ]
    return together([*alone, *(_mass_of_group(group) for group in groups)])


def _figure_of(shape, density) -> Weighed | None:
    solid = shape._inner
    if not solid._has_mass or solid.bounds is None:
        return None
    if not solid._is_convex:
        return Pixels(solid, float(density))
    return Hull(tuple(tuple(each) for each in solid.points), float(solid.radius), float(density))


def _box_of(figure: Weighed) -> Box:
    if isinstance(figure, Pixels):
        return figure.mask.bounds or (0.0, 0.0, 0.0, 0.0)
    low, high = np.min(figure.corners, axis=0) - figure.radius, np.max(figure.corners, axis=0) + figure.radius
    return (*low.tolist(), *high.tolist())


def _groups(figures):
    """Return the sets of figures that are connected by overlaps. Figures that overlap no other figure are omitted.

    figures: list of Hull and Pixels. Equal figures overlap; a set contains them once.
    """
    groups: list[set] = [{each} for each in dict.fromkeys(figures) if figures.count(each) > 1]
    different = list(dict.fromkeys(figures))
    for i, k in _near(different):
        a, b = different[i], different[k]
        if overlap(a, b) if isinstance(a, Hull) and isinstance(b, Hull) else _shares_pixels(a, b):
            joined = {a, b}.union(*(each for each in groups if each & {a, b}))
            groups = [each for each in groups if not each & joined] + [joined]
    return groups


def _near(figures):
    """Return [[i, k], ...]: the pairs of indices of figures whose bounding boxes share area."""
    if len(figures) < 2:
        return []
    boxes = np.array([_box_of(each) for each in figures])
    low, high = boxes[:, :2], boxes[:, 2:]
    meet = ((low[:, None] < high[None, :]) & (low[None, :] < high[:, None])).all(axis=2)
    return np.argwhere(np.triu(meet, 1)).tolist()


def overlap(a: Hull, b: Hull) -> bool:
    """Return whether two rounded hulls share area, by the separating axis theorem.

    The tested axes are the normals of all sides. Because of the rounding, the lines from each corner of one hull to
    each corner of the other hull are also tested.
    """
    first, second = np.array(a.corners), np.array(b.corners)
    reach = a.radius + b.radius
    both = np.concatenate([first, second])
    near = ROUNDING * (float(np.ptp(both, axis=0).max()) + reach)
    sides = [corners - np.roll(corners, 1, axis=0) for corners in (first, second)]
    axes = [np.stack([each[:, 1], -each[:, 0]], axis=1) for each in sides]
    axes.append((second[None, :] - first[:, None]).reshape(-1, 2))
    every = np.concatenate([*axes, *(-each for each in axes)])
    lengths = np.hypot(*every.T)
    every = every[lengths > near] / lengths[lengths > near, None]
    gaps = (second @ every.T).min(axis=0) - (first @ every.T).max(axis=0)
    return not len(gaps) or float(gaps.max()) < reach - near


def _shares_pixels(a: Weighed, b: Weighed) -> bool:
    """Return whether two figures share area. At least one of the figures is a mask."""
    window = _common(_box_of(a), _box_of(b))
    cells = cells_of([_placed(each) for each in (a, b) if isinstance(each, Pixels)], window)
    base = (window[0], window[1])
    hulls = [each for each in (a, b) if isinstance(each, Hull)]
    shared = shared_sums(_outline(hulls), cells, base) if hulls else cell_sums(cells, cells.count > 1, base)
    return shared.area > ROUNDING * max(window[2] - window[0], window[3] - window[1]) ** 2


def _placed(figure: Pixels):
    """Return (solid, left, top) of a mask: its pixels [row, col] bool, and its top left corner in body space [px]."""
    return figure.mask.solid, -figure.mask.origin[0], -figure.mask.origin[1]


def _outline(hulls: Sequence[Hull]) -> list[Stretch]:
    return boundary([(np.array(each.corners), each.radius) for each in hulls])


def _common(a: Box, b: Box) -> Box:
    """Return the intersection of two boxes (left, top, right, bottom).

    If they do not overlap, right < left or bottom < top in the result.
    """
    return max(a[0], b[0]), max(a[1], b[1]), min(a[2], b[2]), min(a[3], b[3])


def _around(boxes: Sequence[Box]) -> Box:
    low, high = np.min(boxes, axis=0), np.max(boxes, axis=0)
    return (*low[:2].tolist(), *high[2:].tolist())


def _mass_of_group(group: set) -> Mass:
    masks = [each for each in group if isinstance(each, Pixels)]
    hulls = sorted(each for each in group if isinstance(each, Hull))
    if not masks:
        return _union_mass(tuple(hulls))
    # Sorted, so that the sum does not depend on the order of the shapes.
    return _mass_with_masks(
        sorted(masks, key=lambda each: (each.density, each.mask.bounds, each.mask.fingerprint)), hulls
    )


def _layered(group: Sequence[Weighed], found_of: Callable[[list], Moments]) -> Mass:
    """Return the Mass of overlapping shapes. Shared area has the highest of the shapes' densities.

    The Mass is a sum of layers, one for each distinct density in ascending order. A layer is the union of all shapes
    with at least this density; its density is the increase over the previous one. group: the shapes; found_of(shapes):
    function that returns the Moments of the shapes' union.
    """
    densities = sorted({each.density for each in group})
    layers = []
    for below, density in zip([0.0, *densities], densities, strict=False):
        found, share = found_of([each for each in group if each.density >= density]), density - below
        layers.append(Mass(share * found.area, Vec2(found.x, found.y), share * found.inertia))
    return together(layers)


@lru_cache(maxsize=256)
def _union_mass(group: tuple[Hull, ...]) -> Mass:
    """Return the Mass of overlapping hulls. Shared area counts once. Results are cached. group: the Hulls."""
    return _layered(group, lambda hulls: moments(_outline(hulls)))


def _mass_with_masks(masks: Sequence[Pixels], hulls: Sequence[Hull]) -> Mass:
    """Return the Mass of the union of overlapping masks and hulls.

    Shared area counts once, with the highest density of the shapes there.
    """
    base = _box_of(masks[0])[:2]

    def union(dense):
        pixels = [each for each in dense if isinstance(each, Pixels)]
        solids = [each for each in dense if isinstance(each, Hull)]
        around = _outline(solids)
        sums = _mask_sums(pixels, base).plus(sums_of(moments(around), base))
        if pixels and solids:
            cells = cells_of([_placed(each) for each in pixels], _around([_box_of(each) for each in solids]))
            sums = sums.plus(shared_sums(around, cells, base), -1.0)
        return sums.moments(base)

    return _layered([*masks, *hulls], union)


def _mask_sums(masks: Sequence[Pixels], base) -> Sums:
    """Return the Sums of the union of masks, about the point `base` [px].

    The Sums of all masks are added, and area that this counts more than once is subtracted.
    """
    sums = NO_SUMS
    for each in masks:
        weight: Mass = each.mask.mass_of(1.0)
        sums = sums.plus(sums_of(Moments(weight.mass, *weight.center, weight.inertia), base))
    windows = [_common(_box_of(a), _box_of(b)) for a, b in combinations(masks, 2)]
    windows = [each for each in windows if each[0] < each[2] and each[1] < each[3]]
    if not windows:
        return sums
    cells = cells_of([_placed(each) for each in masks], _around(windows))
    return sums.plus(cell_sums(cells, np.maximum(cells.count - 1, 0), base), -1.0)
