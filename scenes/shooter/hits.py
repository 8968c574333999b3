"""Hits of the player's plane, counted separately for its core, its hull and its bounding box.

The three counts show the effect of exact shapes. Each bullet or plane counts once for each part. A slider of the scene
selects whether hits of the core or of the hull cost a life.
"""

import numpy as np

from scenes.shooter.bullets import BOXED, CORED, GRAZED, HULLED
from scenes.shooter.cast import BULLET, ENEMY

PARTS = {"core": CORED, "hull": HULLED}


class Hits:
    """Numbers of hits of the player's plane.

    count: {part of the plane: hits so far}; now: {part: ids of the bodies whose contact with this part began in this
    step}.
    """

    def __init__(self):
        self.count = {"core": 0, "hull": 0, "box": 0}
        self.now = {"core": [], "hull": []}

    def read(self, world, plane, incoming, fleet):
        """Count the hits of the player's plane in the last step, by enemy bullets (`incoming`) and planes (`fleet`).

        Return an array with the ids of the bullets that have entered the plane's graze ring for the first time.
        """
        events = world.events
        for part, bit in PARTS.items():
            self.now[part] = partners(events.begin, plane.bodies[part].id)
            self._count(part, bit, np.array(self.now[part], np.int64), incoming, fleet)
        self._count("box", BOXED, boxes_met(world, plane.bodies["hull"].id), incoming, fleet)
        return incoming.meet(np.array(partners(events.sensor_begin, plane.bodies["ring"].id), np.int64), GRAZED)

    def _count(self, part, bit, ids, incoming, fleet):
        self.count[part] += len(incoming.meet(ids, bit))
        for identity in ids.tolist():
            enemy = fleet.planes.get(identity)
            if enemy is not None and not enemy.met & bit:
                enemy.met |= bit
                self.count[part] += 1

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return tuple(self.count.values())


def partners(events, identity):
    """Return the ids of all bodies that form a pair with the body `identity`, as a list.

    events: a table of events, which contains the pairs.
    """
    if not len(events):
        return []
    a, b = events["body_a"], events["body_b"]
    return np.concatenate([b[a == identity], a[b == identity]]).tolist()


def boxes_met(world, identity):
    """Return the ids of the enemies and bullets whose bounding boxes overlapped the box of a body, as an array.

    The boxes of the last step are compared. identity: id of the body.
    """
    shapes = world.shapes
    box = shapes[np.flatnonzero(shapes["body"] == identity)[0]]  # it has one shape, whatever the tier
    a, b = world.candidates[:, 0], world.candidates[:, 1]
    others = np.concatenate([b[a == box["id"]], a[b == box["id"]]])
    if not len(others):
        return others.astype(np.int64)
    rows = np.searchsorted(np.ascontiguousarray(shapes["id"]), others)
    other = shapes[rows[(shapes["membership"][rows] & (ENEMY | BULLET)) != 0]]
    # Boxes that only touch at their edges do not count.
    over = (
        (other["min_x"] < box["max_x"])
        & (other["max_x"] > box["min_x"])
        & (other["min_y"] < box["max_y"])
        & (other["max_y"] > box["min_y"])
    )
    return np.unique(other["body"][over])
