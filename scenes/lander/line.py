"""The line: a rope of links between ship and load. It bends around rock, and tears under too great a force.

Each link is a thin capsule, pinned to the next link. The ends are pinned to the centres of mass of ship and load, so
that the rope causes no torque there. The pins form a tree, for which the solver of joints is exact at any mass of the
load. Links collide with the ground and with nothing else.
"""

from itertools import pairwise
from math import atan2, cos, hypot, sin, sqrt
from typing import Any

from physics import Capsule, Revolute
from scenes.lander.feel import LINE, LINE_FILTER, LINE_MASS, LINE_STRENGTH, LINKS, REACH

THICK = 1.0  # [px] radius of a link


class Line:
    """The rope on which the ship carries a load.

    load: the carried body, or None; torn: whether the rope tore in this step; links: the bodies of the rope, from the
    ship to the load.
    """

    def __init__(self, world):
        self.world = world
        self.load: Any = None
        self.torn = False
        self.links = []

    def toggle(self, ship, loose):
        """Release the load or, without a load, catch the nearest of the bodies `loose` that is within REACH of the
        ship.

        Return "let go", "caught", or "missed" if no body is in reach.
        """
        if self.load is not None:
            self.let_go()
            return "let go"
        near = [(hypot(body.center.x - ship.x, body.center.y - ship.y), body.id, body) for body in loose]
        near = [each for each in near if each[0] < REACH]
        if not near or not self.world.effects.joints:
            return "missed"
        self.load = min(near)[2]
        self._tie(ship.body)
        return "caught"

    def _tie(self, body):
        """Build the rope between the ship's body and the load: straight, or in a zigzag if the distance is shorter
        than the rope.
        """
        start, end = body.center, self.load.center
        away = hypot(end.x - start.x, end.y - start.y)
        length = max(LINE, away) / LINKS  # of a link
        ux, uy = ((end.x - start.x) / away, (end.y - start.y) / away) if away > 0.0 else (0.0, 1.0)
        along = away / (LINKS * length)
        aside = sqrt(max(0.0, 1.0 - along * along)) * length
        ends = []
        for number in range(LINKS + 1):
            step, bend = number * along * length, aside * (number % 2)
            ends.append((start.x + step * ux - bend * uy, start.y + step * uy + bend * ux))
        for (ax, ay), (bx, by) in pairwise(ends):
            angle = atan2(by - ay, bx - ax)
            half = 0.5 * length
            self.links.append(
                self.world.add_body(
                    Capsule((-half, 0.0), (half, 0.0), THICK),
                    position=((ax + bx) / 2.0, (ay + by) / 2.0),
                    angle=angle,
                    velocity=tuple(body.velocity),
                    mass=LINE_MASS / LINKS,
                    filter=LINE_FILTER,
                    user="line",
                )
            )
        bodies = [body, *self.links, self.load]
        for (a, b), at in zip(pairwise(bodies), ends, strict=True):
            self.world.add_joint(Revolute(a, b, at=at, breaks=(LINE_STRENGTH, None), contacts=False))

    def let_go(self):
        """Release the load: remove the rope."""
        self.world.remove_bodies([link.id for link in self.links])
        self.load, self.links = None, []

    def read(self):
        """Read from the step's events whether the rope tore, and remove the rest of a torn rope."""
        self.torn = any(row["reason"] in ("force", "torque") for row in self.world.events.broken)
        if self.torn:
            self.let_go()

    def points(self, pose):
        """Return a list of the ends (x, y) [px] of all links, from the ship to the load.

        pose(id): function that returns the pose (x, y, angle) [px, rad] at which a link is drawn.
        """
        found = []
        for link in self.links:
            x, y, angle = pose(link.id)
            (left, _), (right, _) = link.shapes[0].points
            ends = [(x + at * cos(angle), y + at * sin(angle)) for at in (left, right)]
            found += ends if not found else ends[1:]
        return found

    def drop(self, identity):
        """Release the load if it is the body `identity`. Call this method before that body is removed."""
        if self.load is not None and self.load.id == identity:
            self.let_go()

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (-1 if self.load is None else self.load.id,)
