"""Examples for the overlay layers: rectangles in the current step of a scene that show best what a layer draws.

Functions with the argument `world` return boxes (min x, min y, max x, max y) [px], best example first.
"""

from collections.abc import Callable, Iterable

import numpy as np
import pygame

from game.drawing.camera import Camera
from game.scene import Scene
from physics import World, debug

POINT_REACH = 8.0  # [px] around a contact point
BORDER = 10  # [canvas px] between a subject and the border of its view, for a ring
LARGEST = (220, 84)  # [canvas px] greatest size of an example; a taller one leaves no room for a card


def subject_of(scene: Scene, layer: str) -> pygame.Rect | None:
    """Return the canvas rectangle of the best example for the layer named `layer`; None if this step has no example.

    The example is completely visible.
    """
    for world, camera in scene.views():
        for rect in _on_canvas(SUBJECTS[layer](world), camera):
            return rect
    return None


def _on_canvas(rows: np.ndarray, camera: Camera) -> Iterable[pygame.Rect]:
    """Yield the canvas rectangles of the boxes that fit into the camera's view with room for a ring around them.

    rows: (n, 4) boxes in world coordinates.
    """
    inside = camera.viewport.inflate(-2 * BORDER, -2 * BORDER)
    left, top = camera.to_canvas(rows[:, 0], rows[:, 1])
    right, bottom = camera.to_canvas(rows[:, 2], rows[:, 3])
    fits = (left >= inside.left) & (right <= inside.right) & (top >= inside.top) & (bottom <= inside.bottom)
    fits &= (right - left <= LARGEST[0]) & (bottom - top <= LARGEST[1])
    for row in np.flatnonzero(fits).tolist():
        x, y = int(np.floor(left[row])), int(np.floor(top[row]))
        yield pygame.Rect(x, y, int(np.ceil(right[row])) - x, int(np.ceil(bottom[row])) - y)


def _around(boxes, ids, pairs):
    """Return an (n, 4) array of boxes, one around the two shapes of each pair.

    boxes: (m, 4) boxes of the shapes; ids: (m,) ids of the shapes, ascending; pairs: (n, 2) shape ids. Pairs of removed
    shapes are left out.
    """
    rows = np.minimum(np.searchsorted(ids, pairs), len(ids) - 1)
    there = (ids[rows] == pairs).all(axis=1)  # a shape removed since the step has no row
    a, b = boxes[rows[there, 0]], boxes[rows[there, 1]]
    return np.concatenate([np.minimum(a, b)[:, :2], np.maximum(a, b)[:, 2:]], axis=1)


def _of_pairs(world, pairs):
    if not len(pairs):
        return np.zeros((0, 4))
    return _around(debug.bounds(world), np.ascontiguousarray(world.shapes["id"]), pairs)


def touching(world: World) -> np.ndarray:
    """Return (n, 4) boxes, each around the two shapes of a contact."""
    rows = world.reported_rows()
    return _of_pairs(world, np.stack([rows["parent_a"], rows["parent_b"]], axis=1))


def candidates(world: World) -> np.ndarray:
    """Return (n, 4) boxes, each around the two shapes of a candidate pair of the broad phase."""
    return _of_pairs(world, world.candidates)


def moving(world: World) -> np.ndarray:
    """Return (n, 4) swept AABBs of moving bodies, largest first."""
    rows = debug.motion(world)
    return rows[np.argsort(-(rows[:, 2] - rows[:, 0]) * (rows[:, 3] - rows[:, 1]), kind="stable")]


def kept(world: World) -> np.ndarray:
    """Return (n, 4) cells or boxes of the broad phase's structure, in the order of decreasing number of shapes.

    Empty cells and boxes are left out.
    """
    rows, boxes = debug.structure(world).rects, debug.bounds(world)
    x, y = (boxes[:, 0] + boxes[:, 2]) / 2, (boxes[:, 1] + boxes[:, 3]) / 2
    inside = (rows[:, :1] <= x) & (x <= rows[:, 2:3]) & (rows[:, 1:2] <= y) & (y <= rows[:, 3:])
    held = inside.sum(axis=1)
    order = np.argsort(-held, kind="stable")
    return rows[order[held[order] > 0]]


def shared_pixels(world: World) -> np.ndarray:
    """Return (n, 4) boxes around the pixels in which two masks overlap. The pair with the most such pixels is first."""
    hits = sorted(debug.mask_hits(world), key=lambda hit: -int(hit[2].sum()))
    rows = [(left, top, left + solid.shape[1], top + solid.shape[0]) for left, top, solid in hits]
    return np.array(rows, float).reshape(-1, 4)


def piled_up(world: World) -> np.ndarray:
    """Return (n, 4) boxes, each around an island of at least two bodies, largest island first."""
    islands, boxes = debug.islands(world)[world.shapes["body_row"]], debug.bounds(world)
    names, counts = np.unique(islands[islands >= 0], return_counts=True)
    several = names[np.argsort(-counts, kind="stable")][: int((counts > 1).sum())]
    found = [boxes[islands == name] for name in several]
    return np.array([(*each[:, :2].min(axis=0), *each[:, 2:].max(axis=0)) for each in found]).reshape(-1, 4)


def contacts(world: World) -> np.ndarray:
    """Return (n, 4) boxes around contact points, sorted by decreasing normal impulse.

    Speculative contacts are left out.
    """
    points = debug.contact_points(world)
    points = points[np.isin(points["state"], (debug.NEW, debug.PERSISTED, debug.ASLEEP))]
    points = points[np.argsort(-points["normal_impulse"], kind="stable")]
    x, y = points["point_x"], points["point_y"]
    return np.stack([x - POINT_REACH, y - POINT_REACH, x + POINT_REACH, y + POINT_REACH], axis=1)


def shapes_that_move(world: World) -> np.ndarray:
    """Return (n, 4) boxes of the shapes of dynamic and kinematic bodies, largest first."""
    boxes = debug.bounds(world)[debug.shape_rows(world)["kind"] != 0]
    return boxes[np.argsort(-(boxes[:, 2] - boxes[:, 0]) * (boxes[:, 3] - boxes[:, 1]), kind="stable")]


def stopped_on_their_way(world: World) -> np.ndarray:
    """Return (n, 4) boxes, each around a body that was stopped at a time of impact.

    A box contains the position at which the body was stopped, and the position that it would have reached.
    """
    ghosts = debug.impact_ghosts(world)
    rows = world.rows(ghosts["body"]) if len(ghosts) else np.zeros(0, int)
    x, y = world.bodies["x"][rows], world.bodies["y"][rows]
    low_x, low_y = np.minimum(x, ghosts["x"]), np.minimum(y, ghosts["y"])
    high_x, high_y = np.maximum(x, ghosts["x"]), np.maximum(y, ghosts["y"])
    return np.stack([low_x, low_y, high_x, high_y], axis=1) + np.array([-1.0, -1.0, 1.0, 1.0]) * POINT_REACH


SUBJECTS: dict[str, Callable[[World], np.ndarray]] = {
    "bounds": touching,
    "motion": moving,
    "structure": kept,
    "pairs": candidates,
    "masks": shared_pixels,
    "islands": piled_up,
    "contacts": contacts,
    "outlines": shapes_that_move,
    "impulses": contacts,
    "ghosts": stopped_on_their_way,
}
