"""Impacts of fast bodies during a step: the poses at their times of impact, and the poses without the impacts."""

import numpy as np
import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, SKY, WHITE, faded
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from game.overlays.mask_edges import mask_edges
from game.overlays.outlines import draw_outline, moved
from physics import World, debug
from physics.tables.shape import PART

GHOST_BUDGET = 200  # bodies per picture; the note says how many there are
ARC_SCALE = 3.0  # [frame px per px] scale that sets the fineness of arcs
KEPT = 45  # steps for which an impact stays visible, fading


class Ghosts(Layer):
    """Recent impacts of fast bodies, each with its time as a share of the step.

    The body at its time of impact is drawn in white. The pose that it would have had at the end of the step without the
    impact is drawn in blue.
    """

    name, title, key, color = "ghosts", "Times of impact", "h", WHITE

    def __init__(self) -> None:
        self.kept = {}  # id of a world -> ([[age, outlines, fraction, place, aim], ...], events, world)
        self.begin()

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limit on drawn objects is divided evenly among the views."""
        self.drawn = self.total = 0
        self.room = GHOST_BUDGET // views
        self.labels = []

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the recent impacts in a world. lens: maps world to frame coordinates."""
        kept = self._note(world)
        self.total += sum(1 for ghost in kept if ghost[0] == 0)
        width = max(1, frame.scale - 1)
        for age, outlines, fraction, there, aim in kept[-self.room :]:
            place, end = lens.points(*there), lens.points(*aim)
            if not lens.clip.collidepoint(place):
                continue
            self.drawn += age == 0
            fading = 0.75 * age / KEPT
            going = faded(frame.tone(SKY), 0.3 + fading)
            pygame.draw.line(frame.surface, going, place, end)
            for now, then in outlines:
                draw_outline(frame.surface, lens, then, going, 1, frame.scale)
                draw_outline(frame.surface, lens, now, faded(WHITE, fading), width if age == 0 else 1, frame.scale)
            if age < KEPT // 3:
                self.labels.append((f"{fraction:.2f}", place[0], place[1], faded(WHITE, fading)))

    def _note(self, world):
        """Return the recent impacts in a world. They are updated if the world has been stepped since the last picture.

        The update increments their ages, removes the old ones, and adds the impacts of the last step.
        """
        kept, step, last = self.kept.get(id(world), ([], None, None))
        now = world.events  # a new object in every step
        if last is not world:
            kept, step = [], None
        if step is not now:
            kept = [[ghost[0] + 1, *ghost[1:]] for ghost in kept if ghost[0] < KEPT]
            kept += self._fresh(world)
            self.kept = {id(world): (kept, now, world), **{k: v for k, v in self.kept.items() if k != id(world)}}
            while len(self.kept) > 16:
                self.kept.pop(next(reversed(self.kept)))
        return kept

    def _fresh(self, world):
        """Return the impacts of the last step, each as [age, outlines, time, position, position without impact].

        age: 0, because the impact is new. outlines: for each shape of the body, a pair of outlines: at the time of
        impact, and at the end of the step without the impact. time: time of impact as a share of the step. The
        positions are (x, y) [px].
        """
        ghosts = debug.impact_ghosts(world)[:GHOST_BUDGET]
        bodies, shapes = world.bodies, world.shapes
        ids = np.ascontiguousarray(bodies["id"])
        found = []
        for ghost in ghosts:
            row = int(np.searchsorted(ids, ghost["body"]))
            if row == len(ids) or ids[row] != ghost["body"]:
                continue
            now = (float(bodies["x"][row]), float(bodies["y"][row]), float(bodies["angle"][row]))
            then = (float(ghost["x"]), float(ghost["y"]), float(ghost["angle"]))
            mine = np.flatnonzero(shapes["body"] == ghost["body"])
            parts = mine[shapes["role"][mine] == PART]
            outlines = debug.outlines(world, mine[shapes["role"][mine] != PART].tolist())
            if len(parts):
                outlines.append(("lines", mask_edges(world, parts, ARC_SCALE).outer.reshape(-1, 2)))
            pairs = [(each, moved(each, now, then)) for each in outlines if each[0] not in ("mask", "tiles")]
            found.append([0, pairs, float(ghost["fraction"]), now[:2], then[:2]])
        return found

    def draw_labels(self, frame: Frame) -> None:
        """Write the times of impact, as shares of the step, where they cover no other text."""
        for text, x, y, color in self.labels:
            frame.text_if_free(text, x, y - 4 * frame.text_scale, color, SMALL, frame.text_scale, "left", True)

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        return [
            (self.color, f"impacts {self.drawn} of {self.total} in this step"),
            (SKY, "where they were going"),
            (FOG, "number: share of the step"),
        ]
