"""Pick-ups of the shooter: power, bombs, lives.

They drift down, fly to the player's plane if it is near, and are taken when they touch its ring.
"""

from math import cos, hypot, pi

from game.drawing.sprites import load_atlas
from scenes.shooter.cast import LOOT, WIDTH

FALL, SWAY, SWINGS = 34.0, 26.0, 0.5  # [px/s], [px/s], swings per second
REACH, FAR_REACH, PULL = (
    58.0,
    130.0,
    170.0,
)  # [px] distance from which an item flies to the player, and that while focusing; its speed then [px/s]
TOSS, TOSS_TIME = 90.0, 34  # [px/s] upwards, and steps: a lost plane's items can be caught again
EDGE = 16.0  # [px] kept from the sides
PICTURES = {"power": "powerup", "bomb": "bomb_item", "life": "life_item"}


class Item:
    """A pick-up.

    what: "power", "bomb" or "life"; born: step in which it appeared; tossed: whether it came out of the player's plane
    at the loss of a life. A tossed pick-up flies upwards at first.
    """

    def __init__(self, what, born, tossed):
        self.what, self.born, self.tossed = what, born, tossed


class Loot:
    """The pick-ups in play. items: {body id: Item}."""

    def __init__(self, world):
        self.world = world
        self.items = {}

    def __len__(self):
        return len(self.items)

    def drop(self, what, x, y, now, tossed=False):
        """Add a pick-up at (x, y) [px] in step `now`.

        what: "power", "bomb" or "life"; tossed: whether it comes out of the player's plane at the loss of a life.
        """
        mask = load_atlas("planes").mask(PICTURES[what] + "_0")
        body = self.world.add_body(mask, kind="kinematic", filter=LOOT, position=(min(max(x, EDGE), WIDTH - EDGE), y))
        self.items[body.id] = Item(what, now, tossed)

    def step(self, now, plane):
        """Set the velocities of all pick-ups for the next step. now: current step; plane: the player's plane."""
        if not self.items:
            return
        rows, bodies = self.world.rows(list(self.items)), self.world.bodies
        reach = FAR_REACH if plane.focusing else REACH
        for row, item in zip(rows.tolist(), self.items.values(), strict=True):
            x, y = bodies["x"][row].item(), bodies["y"][row].item()
            age, far = now - item.born, hypot(plane.x - x, plane.y - y)
            if item.tossed and age < TOSS_TIME:
                vx, vy = 0.0, -TOSS * (1.0 - age / TOSS_TIME)
            elif plane.here and far < reach:
                share = PULL / max(far, 1.0)
                vx, vy = (plane.x - x) * share, (plane.y - y) * share
            else:
                vx, vy = SWAY * cos(2 * pi * SWINGS * age / 60), FALL
                vx = max(vx, 0.0) if x < EDGE else min(vx, 0.0) if x > WIDTH - EDGE else vx
            bodies["vx"][row], bodies["vy"][row] = vx, vy

    def forget(self, ids):
        """Remove the pick-ups with the given body ids (an array) from the table."""
        for identity in ids.tolist():
            self.items.pop(identity, None)

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return tuple(
            value for identity, item in self.items.items() for value in (identity, item.what, item.born, item.tossed)
        )
