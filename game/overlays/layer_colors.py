"""Graph colours of the contacts. Contacts of one colour share no dynamic body, so they can be solved in parallel."""

import numpy as np
import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, PINK, SERIES, WHITE, Color
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from game.overlays.layer_contacts import seen_points
from game.overlays.layer_impulses import can_move
from physics import World, debug

COLOR_BUDGET = 800  # contacts per picture; the note says how many there are
LABEL_BUDGET = 150  # numbers written out per picture
LISTED = 8  # colours with their own line in the legend


class Colors(Layer):
    """Lines from each contact to the centres of its dynamic bodies, in the display colour of its graph colour.

    Contacts without a graph colour, which are solved first, are white.
    """

    name, title, key, color = "colors", "Graph colours", "g", PINK

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limit on drawn objects is divided evenly among the views."""
        self.drawn = self.total = 0
        self.counts = np.zeros(0, int)
        self.overflow = 0
        self.room = COLOR_BUDGET // views
        self.labels = []

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the contacts of a world in their colours. lens: maps world to frame coordinates."""
        rows = debug.contact_points(world)
        rows = rows[(rows["state"] == 1) | (rows["state"] == 2)]
        self.total += len(rows)
        if len(rows) == 0:
            return
        self._count(rows["color"])
        bodies = world.bodies
        ids = np.ascontiguousarray(bodies["id"])
        x, y = lens.points(rows["point_x"], rows["point_y"])
        seen = seen_points(lens, x, y)[: self.room]
        self.drawn += len(seen)
        for side in ("body_a", "body_b"):
            owner = np.minimum(np.searchsorted(ids, rows[side][seen]), len(ids) - 1)
            moves = can_move(bodies, rows[side][seen])
            cx, cy = lens.points(bodies["center_x"][owner], bodies["center_y"][owner])
            for i in np.flatnonzero(moves).tolist():
                color = frame.tone(color_of(int(rows["color"][seen[i]])))
                pygame.draw.line(
                    frame.surface, color, (float(x[seen[i]]), float(y[seen[i]])), (float(cx[i]), float(cy[i]))
                )
        for i in seen.tolist():
            color = int(rows["color"][i])
            tone = frame.tone(color_of(color))
            pygame.draw.circle(frame.surface, tone, (float(x[i]), float(y[i])), 2 * frame.scale)
            if len(self.labels) < LABEL_BUDGET:
                self.labels.append((f"{color}" if color >= 0 else "-", float(x[i]), float(y[i]), tone))

    def _count(self, colors):
        self.overflow += int(np.count_nonzero(colors < 0))
        found = np.bincount(colors[colors >= 0].astype(int), minlength=len(self.counts))
        found[: len(self.counts)] += self.counts
        self.counts = found

    def draw_labels(self, frame: Frame) -> None:
        """Write the number of the graph colour beside each contact, where it covers no other text."""
        scale = frame.text_scale
        for text, x, y, color in self.labels:
            frame.text_if_free(text, x + 3 * scale, y - 6 * scale, color, SMALL, scale, "left", True)

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        used = np.flatnonzero(self.counts).tolist()
        lines = [(self.color, f"coloured {self.drawn} of {self.total} contacts, {len(used)} colours")]
        lines += [(color_of(i), f"{i}: {self.counts[i]}") for i in used[:LISTED]]
        if len(used) > LISTED:
            lines.append((FOG, f"and {len(used) - LISTED} more"))
        if self.overflow:
            lines.append((WHITE, f"{self.overflow} in no colour"))
        return lines


def color_of(number: int) -> Color:
    """Return the display colour of a graph colour. A negative number means no graph colour, and gives white."""
    return SERIES[number % (len(SERIES) - 1)] if number >= 0 else WHITE
