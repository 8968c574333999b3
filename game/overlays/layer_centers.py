"""Centres of mass of bodies, with their velocities. A body rotates about its centre of mass."""

import numpy as np
import pygame

from game.drawing.colors import FOG, GOLD, INK, PAPER
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from game.overlays.layer_contacts import seen_points
from game.overlays.layer_impulses import arrow
from physics import World
from physics.tables.body import DYNAMIC

CENTER_BUDGET = 600  # bodies per picture; the note says how many there are
SECONDS = 0.1  # the arrow is the displacement in this time
APART = 1.0  # [px] minimum distance of a drawn origin from the centre of mass


class Centers(Layer):
    """A mark at the centre of mass of each dynamic body, as on a crash-test dummy.

    An arrow shows the motion in 0.1 s. A line leads to the body's origin if that is another point.
    """

    name, title, key, color = "centers", "Centres of mass", "c", GOLD

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limit on drawn objects is divided evenly among the views."""
        self.drawn = self.total = 0
        self.room = CENTER_BUDGET // views

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the marks of a world's dynamic bodies. lens: maps world to frame coordinates."""
        bodies = world.bodies
        bodies = bodies[(bodies["kind"] == DYNAMIC) & ~bodies["quarantined"]]
        self.total += len(bodies)
        if len(bodies) == 0:
            return
        x, y = lens.points(bodies["center_x"], bodies["center_y"])
        seen = seen_points(lens, x, y)[: self.room]
        self.drawn += len(seen)
        origin_x, origin_y = lens.points(bodies["x"][seen], bodies["y"][seen])
        way_x, way_y = bodies["vx"][seen] * SECONDS * lens.scale, bodies["vy"][seen] * SECONDS * lens.scale
        columns = np.column_stack((x[seen], y[seen], origin_x, origin_y, way_x, way_y, bodies["angle"][seen]))
        apart = np.hypot(bodies["x"][seen] - bodies["center_x"][seen], bodies["y"][seen] - bodies["center_y"][seen])
        for (x, y, ox, oy, wx, wy, angle), far in zip(columns.tolist(), (apart > APART).tolist(), strict=True):
            if far:
                pygame.draw.line(frame.surface, frame.tone(FOG), (ox, oy), (x, y))
                pygame.draw.circle(frame.surface, frame.tone(FOG), (ox, oy), frame.scale, 1)
            arrow(frame, x, y, wx, wy, GOLD)
            mark(frame.surface, x, y, angle, 2.0 * frame.scale)

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        return [(self.color, f"centres {self.drawn} of {self.total}, arrow: 0.1 s"), (FOG, "origin, where elsewhere")]


def mark(surface: pygame.Surface, x: float, y: float, angle: float, radius: float) -> None:
    """Draw a crash-test mark: a disc of two dark and two light quarters, rotated by `angle` [rad].

    x, y, radius: centre and radius of the disc [surface px].
    """
    pygame.draw.circle(surface, PAPER, (x, y), radius)
    cosine, sine = np.cos(angle) * radius, np.sin(angle) * radius
    for way in (1.0, -1.0):
        a, b = (x + way * cosine, y + way * sine), (x - way * sine, y + way * cosine)
        bulge = (x + way * (cosine - sine) * 0.707, y + way * (sine + cosine) * 0.707)
        pygame.draw.polygon(surface, INK, ((x, y), a, bulge, b))
    pygame.draw.circle(surface, INK, (x, y), radius + 1.0, 1)
