"""All kinds of shapes, and the mass of a body, in which overlapping area counts once."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import combinations
from typing import NamedTuple

import numpy as np

from physics import checks
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
from physics.shapes.mask import Bounds, PixelMask
from physics.shapes.values import Capsule, Chain, Circle, Mass, Polygon, Segment, TileGrid, together

# ---- overlapping -----------------------------------------------------------------------------------------------------
# Mass of the shapes of one body: overlapping area counts once, with the density of the densest shape.
#
# This holds for convex shapes and for pixel masks, as the union of their pixel squares. Tile grids and lines have no
# mass. Shapes are grouped by overlaps, and each group is weighed as a union. Shapes that only touch keep their own
# mass, to the bit.

CONVEX = (Circle, Capsule, Polygon)


class Hull(NamedTuple):
    """A convex shape with a density [mass per px2]."""

    corners: tuple
    radius: float  # [px]
    density: float


class Pixels(NamedTuple):
    """A mask with a density [mass per px2]."""

    mask: PixelMask
    density: float


Weighed = Hull | Pixels


def weighed_once(parts: Sequence[tuple]) -> Mass:
    """Return the mass of shapes with their densities: [(shape, density)]; overlapping area counts once."""
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
    solid = shape.shape if isinstance(shape, Bounds) else shape
    if isinstance(solid, PixelMask):
        return Pixels(solid, float(density)) if solid.bounds is not None else None
    if not isinstance(solid, CONVEX):
        return None
    corners = (tuple(solid.center),) if isinstance(solid, Circle) else tuple(tuple(each) for each in solid.points)
    return Hull(corners, float(solid.radius), float(density))


def _box_of(figure: Weighed) -> Box:
    if isinstance(figure, Pixels):
        return figure.mask.bounds or (0.0, 0.0, 0.0, 0.0)
    low, high = np.min(figure.corners, axis=0) - figure.radius, np.max(figure.corners, axis=0) + figure.radius
    return (*low.tolist(), *high.tolist())


def _groups(figures):
    """Return the sets of figures connected by overlaps. Equal figures count as one that overlaps."""
    groups: list[set] = [{each} for each in dict.fromkeys(figures) if figures.count(each) > 1]
    different = list(dict.fromkeys(figures))
    for i, k in _near(different):
        a, b = different[i], different[k]
        if overlap(a, b) if isinstance(a, Hull) and isinstance(b, Hull) else _shares_pixels(a, b):
            joined = {a, b}.union(*(each for each in groups if each & {a, b}))
            groups = [each for each in groups if not each & joined] + [joined]
    return groups


def _near(figures):
    """Return the index pairs of the figures whose boxes share area."""
    if len(figures) < 2:
        return []
    boxes = np.array([_box_of(each) for each in figures])
    low, high = boxes[:, :2], boxes[:, 2:]
    meet = ((low[:, None] < high[None, :]) & (low[None, :] < high[:, None])).all(axis=2)
    return np.argwhere(np.triu(meet, 1)).tolist()


def overlap(a: Hull, b: Hull) -> bool:
    """Return whether two rounded hulls share area, by the separating axis theorem.

    Candidate axes are the normals of all sides and, because of the rounding, the lines between any two corners of both
    hulls.
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
    """Return whether two figures share area, one or both of them a mask."""
    window = _common(_box_of(a), _box_of(b))
    cells = cells_of([_placed(each) for each in (a, b) if isinstance(each, Pixels)], window)
    base = (window[0], window[1])
    hulls = [each for each in (a, b) if isinstance(each, Hull)]
    shared = shared_sums(_outline(hulls), cells, base) if hulls else cell_sums(cells, cells.count > 1, base)
    return shared.area > ROUNDING * max(window[2] - window[0], window[3] - window[1]) ** 2


def _placed(figure: Pixels):
    """Return (solid, left, top) of a mask in body space."""
    return figure.mask.solid, -figure.mask.origin[0], -figure.mask.origin[1]


def _outline(hulls: Sequence[Hull]) -> list[Stretch]:
    return boundary([(np.array(each.corners), each.radius) for each in hulls])


def _common(a: Box, b: Box) -> Box:
    """Return the intersection of two boxes; if it is empty, the right side lies left of the left one."""
    return max(a[0], b[0]), max(a[1], b[1]), min(a[2], b[2]), min(a[3], b[3])


def _around(boxes: Sequence[Box]) -> Box:
    low, high = np.min(boxes, axis=0), np.max(boxes, axis=0)
    return (*low[:2].tolist(), *high[2:].tolist())


def _mass_of_group(group: set) -> Mass:
    masks = [each for each in group if isinstance(each, Pixels)]
    hulls = sorted(each for each in group if isinstance(each, Hull))
    if not masks:
        return _union_mass(tuple(hulls))
    # Sorted: the sum is independent of the order of the shapes.
    return _mass_with_masks(
        sorted(masks, key=lambda each: (each.density, each.mask.bounds, each.mask.fingerprint)), hulls
    )


def _layered(group: Sequence[Weighed], found_of: Callable[[list], Moments]) -> Mass:
    """Return the mass of a group, summed by layers of density.

    Each layer is the moments, from found_of, of all shapes with at least that density.
    """
    densities = sorted({each.density for each in group})
    layers = []
    for below, density in zip([0.0, *densities], densities, strict=False):
        found, share = found_of([each for each in group if each.density >= density]), density - below
        layers.append(Mass(share * found.area, Vec2(found.x, found.y), share * found.inertia))
    return together(layers)


@lru_cache(maxsize=256)
def _union_mass(group: tuple[Hull, ...]) -> Mass:
    """Return the mass of overlapping hulls."""
    return _layered(group, lambda hulls: moments(_outline(hulls)))


def _mass_with_masks(masks: Sequence[Pixels], hulls: Sequence[Hull]) -> Mass:
    """Return the mass of overlapping masks and hulls, by inclusion-exclusion: masks plus hulls minus the shared
    area.
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
    """Return the sums of the union of masks: the sum of all, minus the area counted more than once."""
    sums = NO_SUMS
    for each in masks:
        weight = each.mask.mass_of(1.0)
        sums = sums.plus(sums_of(Moments(weight.mass, *weight.center, weight.inertia), base))
    windows = [_common(_box_of(a), _box_of(b)) for a, b in combinations(masks, 2)]
    windows = [each for each in windows if each[0] < each[2] and each[1] < each[3]]
    if not windows:
        return sums
    cells = cells_of([_placed(each) for each in masks], _around(windows))
    return sums.plus(cell_sums(cells, np.maximum(cells.count - 1, 0), base), -1.0)


# ---- kinds -----------------------------------------------------------------------------------------------------------
# All kinds of shapes, and the mass of any of them.
#
# A shape is an immutable value in body space, in pixels; x right, y down, angles clockwise on the screen. It has a
# geometry and a mass, but no pose: that belongs to its body. All but PixelMask and TileGrid compare by value.

Shape = Circle | Capsule | Polygon | Segment | Chain | TileGrid | PixelMask | Bounds
SHAPES = (Circle, Capsule, Polygon, Segment, Chain, TileGrid, PixelMask, Bounds)


def mass_of(shapes: Shape | tuple[Shape, ...] | list[Shape], density: float) -> Mass:
    """Return the mass of one shape or several together, with the inertia about the common centre of mass.

    Overlapping area counts once, with the highest density. density [mass per px2]: of shapes without a material of
    their own. Raises TypeError for a value that is no shape, ValueError for a density that is not > 0.
    """
    density = checks.number("density", density, above=0.0)
    parts = shapes if isinstance(shapes, (tuple, list)) else (shapes,)
    for shape in parts:
        if not isinstance(shape, SHAPES):
            raise TypeError(f"shapes must be shapes (got {checks.shown(shape)})")
    return weighed_once([(shape, density if shape.material is None else shape.material.density) for shape in parts])
