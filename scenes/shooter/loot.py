"""Power-ups: sensor bodies that drift down and come to you when you are near. They report, and push nothing."""

from math import cos, hypot, pi

from game.sprites import load_atlas
from scenes.shooter.cast import LOOT, WIDTH

FALL, SWAY, SWINGS = 34.0, 26.0, 0.5      # [px/s], [px/s], swings per second
REACH, PULL = 58.0, 150.0                 # [px] from which it comes to you, and how fast [px/s]
EDGE = 16.0                               # [px] from the sides that it keeps


class Loot:
    """`born` maps the body of each power-up to the step it appeared in."""

    def __init__(self, world):
        self.world = world
        self.born = {}

    def __len__(self):
        return len(self.born)

    def drop(self, x, y, now, tier):
        """Leave one at a place [px]."""
        body = self.world.add_body(load_atlas("planes").mask("powerup_0"), kind="kinematic", sensor=True, filter=LOOT,
                                   position=(min(max(x, EDGE), WIDTH - EDGE), y), tier=tier)
        self.born[body.id] = now

    def step(self, now, plane):
        """Choose the velocities of the coming step."""
        if not self.born:
            return
        rows, bodies = self.world.rows(list(self.born)), self.world.bodies
        for row, born in zip(rows.tolist(), self.born.values(), strict=True):
            x, y = bodies["x"][row].item(), bodies["y"][row].item()
            far = hypot(plane.x - x, plane.y - y)
            if plane.body is not None and far < REACH:
                share = PULL / max(far, 1.0)
                vx, vy = (plane.x - x) * share, (plane.y - y) * share
            else:
                vx, vy = SWAY * cos(2 * pi * SWINGS * (now - born) / 60), FALL
                vx = max(vx, 0.0) if x < EDGE else min(vx, 0.0) if x > WIDTH - EDGE else vx
            bodies["vx"][row], bodies["vy"][row] = vx, vy

    def forget(self, ids):
        """Drop those whose bodies are removed."""
        for identity in ids.tolist():
            self.born.pop(identity, None)
