"""Contacts: where two shapes touch, which way they are pushed apart, and how deep they are."""

import numpy as np
import pygame

from game.colors import GOLD, GREEN, ORANGE, SKY
from game.draw import SMALL

NORMAL_LENGTH = 9.0        # [canvas px] drawn length of a normal, before the depth is added
CONTACT_BUDGET = 800       # contacts per picture; the note says how many there are
LABEL_BUDGET = 40          # depths written out per picture


class Contacts:
    """A dot per contact point (green: new in this step), its normal from A to B, and the depth in pixels."""

    name, title, key, color = "contacts", "Contacts and normals", "6", ORANGE

    def begin(self, views=1):
        """Start a picture of so many views, which share the budget evenly."""
        self.drawn = self.total = 0
        self.room = CONTACT_BUDGET // views
        self.labels = []           # (text, x, y, align), drawn when all fixed text has its place

    def draw(self, frame, lens, world):
        """Draw one world through one lens."""
        rows = world.contacts
        self.total += len(rows)
        if len(rows) == 0:
            return
        x, y = lens.points(rows["point_x"], rows["point_y"])
        clip = lens.clip
        seen = (x >= clip.left) & (x < clip.right) & (y >= clip.top) & (y < clip.bottom)
        seen = np.flatnonzero(seen)[: self.room]
        self.drawn += len(seen)
        begun = world.events.begin
        new = set(zip(begun["shape_a"].tolist(), begun["shape_b"].tolist(), strict=True))
        for i in seen.tolist():
            row = rows[i]
            is_new = (int(row["shape_a"]), int(row["shape_b"])) in new
            self._draw_one(frame, lens, float(x[i]), float(y[i]), row, GREEN if is_new else SKY)

    def _draw_one(self, frame, lens, x, y, row, color):
        depth = max(0.0, -float(row["separation"]))
        reach = NORMAL_LENGTH * frame.scale + min(depth, 24.0) * lens.scale
        end_x, end_y = x + float(row["normal_x"]) * reach, y + float(row["normal_y"]) * reach
        pygame.draw.line(frame.surface, ORANGE, (x, y), (end_x, end_y), max(1, frame.scale - 1))
        pygame.draw.circle(frame.surface, color, (x, y), frame.scale + 1)
        if len(self.labels) < LABEL_BUDGET:
            self.labels.append((f"{depth:.1f}", end_x, end_y, "left" if row["normal_x"] >= 0 else "right"))

    def draw_labels(self, frame):
        """Write the depths where there is room."""
        for text, x, y, align in self.labels:
            frame.text_if_free(text, x, y, GOLD, SMALL, frame.text_scale, align, True)

    def notes(self):
        """(color, text) lines for the legend."""
        return [(self.color, f"contacts {self.drawn} of {self.total}, px deep where room")]
