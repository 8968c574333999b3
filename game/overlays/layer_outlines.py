"""Outlines of the collision shapes, independent of the sprites. The pixels of masks are drawn by layer_masks.py."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pygame

from game.drawing.colors import FOG, GREEN, ORANGE, PINK, SKY, faded
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from game.overlays.mask_edges import mask_edges
from game.overlays.outlines import draw_lines, draw_outline
from physics import World, debug
from physics.tables.shape import CHAIN, MASK, PART

OUTLINE_BUDGET = 900  # shapes per picture; the note says how many there are
STATIC, KINEMATIC, DYNAMIC = faded(FOG, 0.15), SKY, GREEN

Edge = tuple[tuple[float, float], tuple[float, float], bool]  # start, end, whether it is one-way


class Outlines(Layer):
    """The outline of every shape: green for dynamic, blue for kinematic, grey for static bodies, and pink for sensors.

    Chains are hatched on their solid side. A mask is drawn as the outline used for collision, with darker seams between
    its convex parts.
    """

    name, title, key, color = "outlines", "Shapes", "l", GREEN

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limit on drawn objects is divided evenly among the views."""
        self.drawn = self.total = 0
        self.room = OUTLINE_BUDGET // views

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the outlines of a world's shapes. lens: maps world to frame coordinates."""
        boxes = debug.bounds(world)
        self.total += len(boxes)
        if len(boxes) == 0:
            return
        seen = np.flatnonzero(lens.seen(boxes) & (world.shapes["kind"] != MASK))[: self.room]
        self.drawn += len(seen)
        rows = debug.shape_rows(world)[seen]
        width = max(1, frame.scale - 1)
        tones = [frame.tone(color) for color in (STATIC, KINEMATIC, DYNAMIC)]
        parts = world.shapes["role"][seen] == PART
        for kind, tone in enumerate(tones):
            for sensor in (False, True):
                mine = seen[parts & (rows["kind"] == kind) & (rows["sensor"] == sensor)]
                open_ones = world.shapes["kind"][mine] == CHAIN
                self._draw_parts(frame, lens, world, mine[~open_ones], frame.tone(PINK) if sensor else tone, width)
                # The upper sides of one-way masks have the colour of one-way tile tops.
                self._draw_parts(frame, lens, world, mine[open_ones], frame.tone(PINK if sensor else ORANGE), width)
        rows, seen = rows[~parts], seen[~parts]
        for outline, kind, sensor in zip(
            debug.outlines(world, seen.tolist()), rows["kind"].tolist(), rows["sensor"].tolist(), strict=True
        ):
            color = frame.tone(PINK) if sensor else tones[kind]
            if outline[0] == "tiles":
                self._draw_tiles(frame, lens, world, outline[1], color, width)
            else:
                draw_outline(frame.surface, lens, outline, color, width, frame.scale)

    def _draw_parts(self, frame, lens, world, rows, color, width):
        """Draw the convex parts of mask outlines.

        rows: indices of rows of world.shapes; width: line width [frame px].
        """
        if len(rows):
            edges = mask_edges(world, rows, lens.scale)
            draw_lines(frame.surface, lens, edges.inner, faded(color, 0.6))
            draw_lines(frame.surface, lens, edges.outer, color, width)

    def _draw_tiles(self, frame, lens, world, shape_id, color, width):
        """Draw the edges of a tile grid's solid cells in `color`, and the upper edges of its one-way cells in orange.

        shape_id: id of the tile grid's shape; width: line width [frame px].
        """
        row = world.shapes[np.searchsorted(world.shapes["id"], shape_id)]
        body = world.body(int(row["body"]))
        number = int(np.count_nonzero(world.shapes["id"][world.shapes["body"] == row["body"]] < shape_id))
        (x, y), from_below = body.position, frame.tone(ORANGE)
        for start, end, one_way in edges_of(body.shapes[number], lens, x, y):
            pygame.draw.line(frame.surface, from_below if one_way else color, start, end, width)

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        return [
            (self.color, f"shapes {self.drawn} of {self.total}"),
            (SKY, "kinematic"),
            (STATIC, "static"),
            (PINK, "sensor"),
        ]


def edges_of(grid: Any, lens: Lens, x: float, y: float) -> Iterator[Edge]:
    """Yield (start, end, one-way) for each edge of the visible cells of a TileGrid. Points are (x, y) [frame px].

    x, y: position of the grid's body [px]; one-way: whether the edge belongs to a one-way cell.
    """
    size, (rows, columns) = grid.tile_size, grid.solid.shape
    clip = lens.clip
    left, top = (clip.left - lens.dx) / lens.scale - x, (clip.top - lens.dy) / lens.scale - y
    right, bottom = left + clip.width / lens.scale, top + clip.height / lens.scale
    across = slice(max(int(left // size), 0), max(min(int(right // size) + 1, columns), 0))
    down = slice(max(int(top // size), 0), max(min(int(bottom // size) + 1, rows), 0))
    slope, one_way = grid.slopes[down, across], grid.one_way[down, across]
    slopes = slope.any(axis=2)
    solid = np.pad(grid.solid | grid.slopes.any(axis=2), 1)
    here = grid.solid[down, across] & ~slopes
    # Sides of a cell: (x, y) of start and end in cells, and the direction of the neighbour: up, down, left, right.
    for ax, ay, bx, by, dx, dy in ((0, 0, 1, 0, 0, -1), (0, 1, 1, 1, 0, 1), (0, 0, 0, 1, -1, 0), (1, 0, 1, 1, 1, 0)):
        behind = solid[down.start + 1 + dy : down.stop + 1 + dy, across.start + 1 + dx : across.stop + 1 + dx]
        for row, column in np.argwhere(here & ~behind).tolist():
            yield _line(lens, size, x, y, column + across.start, row + down.start, ax, ay, bx, by, False)
    for row, column in np.argwhere(one_way & ~here).tolist():
        yield _line(lens, size, x, y, column + across.start, row + down.start, 0, 0, 1, 0, True)
    for row, column in np.argwhere(slopes).tolist():
        low, high = (1.0 - slope[row, column]).tolist()
        yield _line(lens, size, x, y, column + across.start, row + down.start, 0, low, 1, high, False)


def _line(lens, size, x, y, column, row, ax, ay, bx, by, one_way):
    return (
        lens.points(x + (column + ax) * size, y + (row + ay) * size),
        lens.points(x + (column + bx) * size, y + (row + by) * size),
        one_way,
    )
