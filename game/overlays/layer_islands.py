"""Islands: groups of bodies that are connected by contacts or joints.

The bodies of an island are solved together, and fall asleep together when all of them rest.
"""

from collections.abc import Sequence
from math import ceil, floor

import numpy as np
import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, PAPER, SERIES, SLATE, Color, faded
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from game.overlays.outlines import draw_outline
from physics import World, debug

BODY_BUDGET = 700  # shapes outlined per picture; the note says how many bodies there are
ISLAND_BUDGET = 120  # hulls drawn per picture
DIRECTIONS = 32  # number of directions whose farthest points make a hull
FILL, ASLEEP_FILL, EDGE = 46, 120, 200  # opacity of 255


class Islands(Layer):
    """Convex hull of each island, and outlines of its shapes, in the island's colour.

    Sleeping islands are grey, with the letter z on each body.
    """

    name, title, key, color = "islands", "Islands, sleeping", "i", SERIES[1]
    under = True  # drawn before the other layers, since it fills areas

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limits on drawn objects are divided evenly among the views."""
        self.drawn = self.total = self.asleep = self.islands = 0
        self.found = False  # whether any world has the effect sleeping
        self.room, self.hulls = BODY_BUDGET // views, ISLAND_BUDGET // views
        self.labels = []

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the islands of a world. lens: maps world to frame coordinates."""
        self.found |= world.effects.sleeping
        islands, bodies = debug.islands(world), world.bodies
        moving = bodies["kind"] == 2
        asleep = moving & ~bodies["awake"]
        self.total += int(np.count_nonzero(moving))
        self.asleep += int(np.count_nonzero(asleep))
        self.islands += len(np.unique(islands[islands >= 0]))
        boxes = debug.bounds(world)
        if len(boxes) == 0:
            return
        owner = world.shapes["body_row"]
        shown = lens.seen(boxes) & moving[owner]
        self._draw_hulls(frame, lens, boxes, np.where(shown, islands[owner], -1), asleep[owner])
        seen = np.flatnonzero(shown)[: self.room]
        self.drawn += len(np.unique(owner[seen]))
        lonely = faded(PAPER, 0.5)
        numbers, sleeps = islands[owner[seen]].tolist(), asleep[owner[seen]].tolist()
        for outline, island, sleeping in zip(debug.outlines(world, seen.tolist()), numbers, sleeps, strict=True):
            color = FOG if sleeping else color_of(island) if island >= 0 else lonely
            draw_outline(frame.surface, lens, outline, frame.tone(color), 1, frame.scale)
        for row in np.unique(owner[seen][asleep[owner[seen]]]).tolist():
            x, y = lens.points(float(bodies["center_x"][row]), float(bodies["center_y"][row]))
            self.labels.append(("z", x, y - 2 * frame.text_scale, FOG))

    def _draw_hulls(self, frame, lens, boxes, islands, asleep):
        """Draw the translucent hulls of the islands, each on a surface of its own size.

        A surface of the picture's size would cost 2 ms. boxes, islands, asleep: for each shape, its AABB (4,), the
        number of its island (-1 for none), and whether its body sleeps.
        """
        members = np.flatnonzero(islands >= 0)
        if len(members) == 0:
            return
        order = members[np.argsort(islands[members], kind="stable")]
        starts = np.flatnonzero(np.r_[True, np.diff(islands[order]) != 0])
        for group in np.split(order, starts[1:])[: self.hulls]:
            sleeping = bool(asleep[group].all())
            corners = boxes[group][:, [0, 1, 2, 1, 2, 3, 0, 3]].reshape(-1, 2)
            hull = hull_of(np.column_stack(lens.points(corners[:, 0], corners[:, 1])))
            color = frame.tone(SLATE if sleeping else color_of(int(islands[group[0]])))
            draw_hull(frame.surface, lens.clip, hull, color, ASLEEP_FILL if sleeping else FILL, max(1, frame.scale - 1))

    def draw_labels(self, frame: Frame) -> None:
        """Write the letter z on each sleeping body, where it covers no other text."""
        for text, x, y, color in self.labels:
            frame.text_if_free(text, x, y, color, SMALL, frame.text_scale, "center", True)

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        if not self.found:
            return [(FOG, "no islands: sleeping is not declared")]
        return [
            (self.color, f"{self.islands} islands, outlined {self.drawn} of {self.total} bodies"),
            (FOG, f"{self.asleep} asleep"),
        ]


def hull_of(points: np.ndarray) -> list[list[float]]:
    """Return an approximate convex hull of `points` (n, 2): the farthest point in each of DIRECTIONS directions."""
    angles = np.arange(DIRECTIONS) * (2 * np.pi / DIRECTIONS)
    ways = np.column_stack((np.cos(angles), np.sin(angles)))
    return points[np.argmax(points @ ways.T, axis=0)].tolist()


def draw_hull(
    surface: pygame.Surface, clip: pygame.Rect, hull: Sequence[Sequence[float]], color: Color, fill: int, width: int
) -> None:
    """Draw the polygon `hull` with its edge, filled with opacity `fill` (0..255).

    hull: corners (k, 2) on the surface; width: width of the edge [px]. The part outside `clip` is not drawn.
    """
    x, y = zip(*hull, strict=True)
    left, top = floor(min(x)) - width, floor(min(y)) - width
    place = pygame.Rect(left, top, ceil(max(x)) + width + 1 - left, ceil(max(y)) + width + 1 - top).clip(clip)
    if place.size == (0, 0):
        return
    sheet = pygame.Surface(place.size, pygame.SRCALPHA)
    hull = [(px - place.x, py - place.y) for px, py in hull]
    pygame.draw.polygon(sheet, (*color, fill), hull)
    pygame.draw.polygon(sheet, (*color, EDGE), hull, width)
    surface.blit(sheet, place)


def color_of(island: int) -> Color:
    """Return the colour of the island with the number `island`. Consecutive numbers have different colours."""
    return SERIES[int(island) * 5 % (len(SERIES) - 1)]
