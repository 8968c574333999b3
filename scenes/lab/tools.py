"""The tools of lab/carving: a disc, a square or a star, of a size that the player sets."""

from itertools import count
from math import cos, hypot, pi, sin

import numpy as np

from game.drawing.sprites import load_atlas
from physics import Capsule, Circle, PixelMask, Polygon

TOOLS = ("blast", "dig", "box", "sprite", "hand")
STAMP_EVERY = 0.5  # radii that the pointer moves between two stamps of a box or sprite
STAR = 12.0  # [px] from the middle of the sprite to its points
GOLDEN = 0.6180339887498949  # its multiples, modulo 1, are never near one another


class Tool:
    """The carving tool that the player has chosen. name: one of TOOLS; radius: size of the tool [px].

    cut() returns the shape to carve in each step.
    """

    def __init__(self):
        self.name, self.radius = TOOLS[0], 0
        self.last = None  # place of the last cut while the pointer stays down
        self.stamp: Circle | Polygon | PixelMask = Circle(1.0)
        self.reach = ((0.0, 0.0), (0.0, 0.0))  # box of the last cut

    def choose(self, name, radius):
        """Select the tool `name`, one of TOOLS, with the given radius [px]."""
        if (name, radius) != (self.name, self.radius):
            self.name, self.radius = name, radius
            self.last, self.stamp = None, self._make()

    def _make(self):
        if self.name == "box":
            return Polygon.box(2.0 * self.radius, 2.0 * self.radius)
        if self.name == "sprite":
            whole = PixelMask.from_surface(load_atlas("lab")["star_gold"])
            return whole.scaled(self.radius / STAR)
        return Circle(self.radius)

    def cut(self, inputs):
        """Return (shape, position) to carve in this step, or None if nothing is carved.

        A blast is carved once per press of the pointer. The other tools carve along the pointer's path while it is
        pressed.
        """
        if not inputs.pointer_down:
            self.last = None
            return None
        now = (float(inputs.pointer[0]), float(inputs.pointer[1]))
        before = self.last or now
        fresh, far = self.last is None, hypot(now[0] - before[0], now[1] - before[1])
        if self.name == "hand" or (self.name == "blast" and not fresh):
            return None
        if not fresh and far < (1.0 if self.name == "dig" else STAMP_EVERY * self.radius):
            return None
        self.last = now
        reach = 1.5 * self.radius
        self.reach = (
            (min(before[0], now[0]) - reach, min(before[1], now[1]) - reach),
            (max(before[0], now[0]) + reach, max(before[1], now[1]) + reach),
        )
        if self.name == "dig" and far > 0.0:  # the path of the pointer
            return Capsule(before, now, self.radius), (0.0, 0.0)
        return self.stamp, now

    def ring(self):
        """Return the corners of the tool's outline relative to the pointer, a list of (x, y) [px]."""
        if self.name == "box":
            return list(self.stamp.points)
        angles = [2.0 * pi * k / 40 for k in range(40)]
        if self.name != "sprite":
            return [(self.radius * cos(a), self.radius * sin(a)) for a in angles]
        points = [(pi / 5 * k - pi / 2, self.radius * (0.52 if k % 2 else 1.0)) for k in range(10)]
        return [(far * cos(a), far * sin(a)) for a, far in points]


def carving(world, name, radius, ground, crumb):
    """Return a function that carves the body with id `ground` once per call, each time at another solid pixel.

    name: one of TOOLS; radius: size of the tool [px]; crumb: as for Body.carve(). Successive pixels are far apart.
    """
    tool = Tool()
    tool.choose(name, radius)
    body = world.body(ground)
    rows, columns = np.nonzero(body.shapes[0].solid)
    left, top = body.position - body.shapes[0].origin
    numbers = count(1)

    def carve_the_next():
        at = int(next(numbers) * GOLDEN % 1.0 * len(rows))
        body.carve(tool.stamp, (left + columns[at] + 0.5, top + rows[at] + 0.5), crumb=crumb)

    return carve_the_next
