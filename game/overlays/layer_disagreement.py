"""False box hits: pairs of shapes, one of them a sprite, whose bounding boxes overlap although their pixels do not."""

from collections import deque

import numpy as np
import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GOLD, RED, faded
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from game.overlays.layer_bounds import draw_boxes
from game.scene import Scene
from physics import World, debug
from physics.tables.shape import MASK

LIE_BUDGET = 400  # pairs drawn per picture; the note says how many there are
REMEMBERED = 600  # steps over which the share of false hits is counted
KEPT = 50  # steps for which the mark of a false hit on the player stays, fading
OWN = "your box would have died here"


def false_hits(world: World) -> tuple[np.ndarray, np.ndarray]:
    """Return (hits, lies), two (n, 2) arrays of SHAPE rows. Each row is a pair whose bounding boxes overlap.

    hits: candidate pairs of the last step that include a sprite; lies: the pairs of `hits` without a contact. Pairs
    with a sensor are not included.
    """
    ids, pairs = np.ascontiguousarray(world.shapes["id"]), world.candidates.astype(np.int64)
    none = np.zeros((0, 2), np.int64)
    if not len(ids) or not len(pairs):
        return none, none
    rows = np.minimum(np.searchsorted(ids, pairs), len(ids) - 1)
    rows = rows[(ids[rows] == pairs).all(axis=1)]  # a shape removed since the step has no row
    shapes, boxes = world.shapes, debug.bounds(world)
    asked = (shapes["kind"][rows] == MASK).any(axis=1) & ~shapes["sensor"][rows].astype(bool).any(axis=1)
    a, b = boxes[rows[:, 0]], boxes[rows[:, 1]]
    asked &= ((a[:, :2] < b[:, 2:]) & (b[:, :2] < a[:, 2:])).all(axis=1)  # boxes that only share an edge do not overlap
    rows = rows[asked]
    contacts = world.contacts
    contacts = contacts[contacts["separation"] <= 0.0]
    touching = contacts["shape_a"].astype(np.int64) << 32 | contacts["shape_b"]
    found = ids[rows].astype(np.int64)
    return rows, rows[~np.isin(found[:, 0] << 32 | found[:, 1], touching)]


class Disagreement(Layer):
    """Overlay that draws the boxes of false hits in red. Call note(scene) after each step while the layer is on.

    A false hit on the player's body is also marked with a text.
    """

    name, title, key, color = "disagreement", "Boxes that lie", "j", RED

    def __init__(self) -> None:
        self.clear()
        self.begin()

    def clear(self) -> None:
        """Reset the counts. This is called when the scene has changed or restarted."""
        self.counts: deque[tuple[int, int]] = deque(maxlen=REMEMBERED)  # (box hits, false hits), by step
        self.marks: list[list] = []  # [age in steps, the player's box] of false hits on the player
        self.inside: dict[int, list] = {}  # body whose box overlaps the player's -> [player's box, whether they hit]
        self.frame = 0

    def note(self, scene: Scene) -> None:
        """Count the box hits and the false hits of the last step."""
        if scene.frame < self.frame:
            self.clear()
        self.frame = scene.frame
        reported = [false_hits(world) for world in scene.worlds]
        self.counts.append((sum(len(rows) for rows, _ in reported), sum(len(lies) for _, lies in reported)))
        self.marks = [[age + 1, box] for age, box in self.marks if age < KEPT]
        if reported:
            self._mark_own(scene, *reported[0])

    def _mark_own(self, scene, hits, lies):
        """Add a mark for each false hit on the player's body that has ended in this step.

        A false hit lasts while another body's box overlaps the player's box without any contact between the two bodies.
        hits, lies: results of false_hits().
        """
        own, world = scene.own_body, scene.world
        now = {}
        if own is not None:
            boxes = debug.bounds(world)
            for found, has_hit in ((lies, False), (hits, True)):
                bodies = world.shapes["body"][found]
                for pair, rows in zip(bodies.tolist(), found.tolist(), strict=True):
                    if own in pair:
                        mine = pair.index(own)
                        now.setdefault(pair[1 - mine], [boxes[rows[mine]], has_hit])
        for body, (box, has_hit) in self.inside.items():
            if body in now:
                now[body] = [box, has_hit or now[body][1]]
            elif not has_hit and own is not None:
                self.marks.append([0, box])
        self.inside = now

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limit on drawn objects is divided evenly among the views."""
        self.drawn = self.total = 0
        self.room = LIE_BUDGET // views
        self.labels: list[tuple[int, float, float]] = []

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the boxes of false hits in a world, and the marks on the player.

        lens: maps world to frame coordinates.
        """
        _, lies = false_hits(world)
        self.total += len(lies)
        boxes = debug.bounds(world)
        seen = lens.seen(boxes)
        shown = lies[seen[lies].any(axis=1)][: self.room]
        self.drawn += len(shown)
        rows = np.unique(shown[seen[shown]])
        draw_boxes(frame, lens, boxes[rows], (self.color,), np.zeros(len(rows), int))
        for age, (x0, y0, x1, y1) in self.marks:
            (left, right), (top, bottom) = lens.points(np.array([x0, x1]), np.array([y0, y1]))
            color = faded(frame.tone(GOLD), age / KEPT)
            pygame.draw.rect(frame.surface, color, (left, top, right - left, bottom - top), frame.scale)
            self.labels.append((age, (left + right) / 2, top))

    def draw_labels(self, frame: Frame) -> None:
        """Write a text at each recent false hit on the player's body."""
        for age, x, y in reversed(self.labels):
            if age < KEPT // 2:
                frame.text_if_free(OWN, x, y - 8 * frame.text_scale, GOLD, SMALL, frame.text_scale, "center", True)

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        hits, lies = (sum(column) for column in zip(*self.counts, strict=True)) if self.counts else (0, 0)
        lines = [(self.color, f"box hits without a shared pixel {self.drawn} of {self.total}")]
        if hits:
            seconds = len(self.counts) / 60.0
            lines.append((FOG, f"{100 * lies / hits:.0f} % of {hits} box hits in {seconds:.0f} s"))
        return lines
