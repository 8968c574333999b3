"""Questions about boxes: which bodies stand in one, and which box a body stands in."""

from typing import Any

import numpy as np

from physics import checks
from physics.checks import Pair
from physics.queries.index import AskedWorld, IndexedWorld
from physics.tables.shape import BOUNDS, MASK, TILES


def query_aabb(world: AskedWorld, lower: Pair, upper: Pair) -> list:
    """Bodies with a shape whose AABB meets the closed box [px]; what holds no pixel or tile has none.

    Raises ValueError for lower > upper."""
    lower, upper = checks.vector("lower", lower), checks.vector("upper", upper)
    if lower[0] > upper[0] or lower[1] > upper[1]:
        raise ValueError(f"lower must be <= upper (got {lower} and {upper})")
    world.queries.begin(world)
    rows = with_content(world, world.queries.rows_in(world, lower, upper))
    s = world.shapes[rows]
    rows = rows[
        (s["min_x"] <= upper[0]) & (s["max_x"] >= lower[0]) & (s["min_y"] <= upper[1]) & (s["max_y"] >= lower[1])
    ]
    return [world.body(each) for each in np.unique(world.shapes["body"][rows]).tolist()]


def query_rect(world: AskedWorld, rect: Any) -> list:
    """query_aabb of (x, y, width, height) or ((x, y), (width, height)). Raises TypeError, ValueError."""
    try:
        parts = tuple(rect)
        x, y, width, height = (*parts[0], *parts[1]) if len(parts) == 2 else parts
    except (TypeError, ValueError):
        raise TypeError(f"rect must be (x, y, width, height) (got {checks.shown(rect)})") from None
    x, y = checks.position("rect", (x, y))
    width, height = checks.number("rect[2]", width, low=0.0), checks.number("rect[3]", height, low=0.0)
    return query_aabb(world, (x, y), checks.vector("rect[0] + rect[2], rect[1] + rect[3]", (x + width, y + height)))


def bounds_of(world: IndexedWorld, identity: int) -> tuple[float, float, float, float] | None:
    """(min_x, min_y, max_x, max_y) [px] of a body's shapes at its present pose; None when they hold nothing."""
    world.queries.refresh(world)
    rows = with_content(world, np.flatnonzero(world.shapes["body"] == identity))
    if not len(rows):
        return None
    s = world.shapes[rows]
    return (s["min_x"].min().item(), s["min_y"].min().item(), s["max_x"].max().item(), s["max_y"].max().item())


def with_content(world: IndexedWorld, rows: np.ndarray) -> np.ndarray:
    """The shape rows without masks that have no solid pixel, and grids of empty cells."""
    shapes, library = world.shapes[rows], world.library
    kinds = np.where(shapes["kind"] == BOUNDS, shapes["wrapped"], shapes["kind"])
    keep = np.ones(len(rows), bool)
    masks = np.flatnonzero(kinds == MASK)
    if len(masks):
        upright = library.raster_of[shapes["geometry"][masks], 0]  # turned, it has as many pixels
        keep[masks] = library.rasters.rows["area"][upright] > 0
    grids = np.flatnonzero(kinds == TILES)
    keep[grids] = [not library.tile_grids[grid].is_empty for grid in shapes["geometry"][grids].tolist()]
    return rows[keep]
