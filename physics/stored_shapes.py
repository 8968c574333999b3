"""The shapes of a world as arrays and facts, for a file, and back."""

from dataclasses import astuple
from typing import Any

import numpy as np

from physics.shapes.convex import Capsule, Polygon
from physics.shapes.library import Geometries
from physics.shapes.lines import Chain, Segment
from physics.shapes.mask import PixelMask
from physics.shapes.material import Material
from physics.shapes.tiles import TileGrid

HULLS = {
    "Polygon": lambda points, radius: Polygon(points, radius),
    "Capsule": lambda points, radius: Capsule(*points, radius=radius),
    "Segment": lambda points, radius: Segment(*points),
}


def pack_geometry(geometry: Geometries) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """(arrays, facts that JSON can say) of shapes."""
    arrays = {}
    for number, shape in enumerate(geometry.outlines):
        arrays[f"hull_{number}"] = np.array(shape.points)
    for number, shape in enumerate(geometry.chains):
        arrays[f"chain_{number}"] = np.array(shape.points)
    for number, shape in enumerate(geometry.grids):
        arrays[f"solid_{number}"], arrays[f"one_way_{number}"] = shape.solid, shape.one_way
        arrays[f"slopes_{number}"] = shape.slopes
    for number, shape in enumerate(geometry.masks):
        arrays[f"mask_{number}"] = shape.solid
    facts = {
        "hulls": [[type(shape).__name__, getattr(shape, "radius", 0.0)] for shape in geometry.outlines],
        "chains": [
            [shape.loop, shape.ghosts, shape.materials and [astuple(each) for each in shape.materials]]
            for shape in geometry.chains
        ],
        "tile_sizes": [shape.tile_size for shape in geometry.grids],
        "masks": [[shape.origin, shape.snap, shape.smooth, shape.one_way, shape.carved] for shape in geometry.masks],
    }
    return arrays, facts


def unpack_geometry(arrays: dict[str, np.ndarray], facts: dict[str, Any]) -> Geometries:
    """Shapes from arrays and facts. Raises KeyError, TypeError, ValueError."""
    outlines, masks = [], []
    for number, (name, radius) in enumerate(facts["hulls"]):
        points = tuple(map(tuple, arrays[f"hull_{number}"].tolist()))
        outlines.append(HULLS[name](points, radius))
    chains = [
        Chain(arrays[f"chain_{number}"], loop, ghosts, materials and tuple(Material(*each) for each in materials))
        for number, (loop, ghosts, materials) in enumerate(facts["chains"])
    ]
    grids = [
        TileGrid(arrays[f"solid_{number}"], size, arrays[f"one_way_{number}"], arrays[f"slopes_{number}"])
        for number, size in enumerate(facts["tile_sizes"])
    ]
    for number, (origin, snap, smooth, one_way, carved) in enumerate(facts["masks"]):
        mask = PixelMask(arrays[f"mask_{number}"], tuple(origin), snap, smooth, one_way)
        masks.append(mask.with_tiles(mask.tiles) if carved else mask)
    return Geometries(outlines, chains, grids, masks)
