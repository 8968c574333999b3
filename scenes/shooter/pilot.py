"""The bot: it looks ahead where bullets will be, tries some ways to fly, and takes the least dangerous.

Each plan is a direction flown for some steps and then rest. All plans, moments and threats are compared in one
array expression; what is predicted is read from the tables' positions and velocities.
"""

import numpy as np

from scenes.shooter.bullets import NAMES
from scenes.shooter.cast import HEIGHT
from scenes.shooter.plane import BOTTOM, DIAGONAL, FOCUS, LEFT, RIGHT, SPEED, TOP

MOMENTS = np.array([1, 3, 5, 8, 11, 14, 18, 22, 27, 32, 38, 45], dtype=np.float64)    # steps ahead
WEIGHTS = 1.0 / (1.0 + MOMENTS / 14.0)      # what comes later can still be dodged later
FLOWN = (5.0, 12.0, 26.0)                   # steps that a direction is held
HALF_WIDTH, HALF_HEIGHT = 13.0, 15.0        # [px] of the plane, for the prediction
RADIUS = {"red": 5.0, "purple": 4.0, "orange": 6.0, "needle": 5.0}
ENEMY_RADIUS = {"dart": 13.0, "saucer": 16.0, "gunship": 25.0}
CAUTION = {"pixels": 1.0, "obb": 1.3, "aabb": 1.2, "circle": 1.3}      # factor on sizes: what is tested is larger
COMFORT = 1.75                              # in sizes: nearer than this is uncomfortable
DEADLY = 1.08                               # nearer than this is a hit
NEAR = 190.0                                # [px] farther threats can wait
LINE_Y = 216.0                              # [px] where it likes to fly


def directions():
    """(dx, dy, steps, focus) of every plan; the first stays."""
    plans = [(0.0, 0.0, 0.0, False)]
    for focus in (False, True):
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                if dx or dy:
                    plans += [(dx, dy, flown, focus) for flown in (FLOWN if not focus else FLOWN[1:2])]
    return plans


class Pilot:
    """keys(scene) gives the actions to hold in the next step."""

    def __init__(self):
        self.plans = directions()
        dx, dy, flown, focus = (np.array(column, dtype=np.float64) for column in zip(*self.plans, strict=True))
        speed = SPEED / 60 * np.where(focus > 0, FOCUS, 1.0) * np.where((dx != 0) & (dy != 0), DIAGONAL, 1.0)
        held = np.minimum(MOMENTS[None, :], flown[:, None])
        self.way_x, self.way_y = (dx * speed)[:, None] * held, (dy * speed)[:, None] * held

    def keys(self, scene):
        """Fly where it is safest, and among safe ways to where there is something to shoot or to take."""
        plane = scene.plane
        if plane.body is None:
            return frozenset()
        x, y = plane.body.position
        place_x = np.clip(x + self.way_x, LEFT, RIGHT)
        place_y = np.clip(y + self.way_y, TOP, BOTTOM)
        cost = self._danger(scene, x, y, place_x, place_y) + self._distance(scene, x, y, place_x[:, -1], place_y[:, -1])
        dx, dy, _, focus = self.plans[int(np.argmin(cost))]
        actions = {"fire"}
        if dx:
            actions.add("right" if dx > 0 else "left")
        if dy:
            actions.add("down" if dy > 0 else "up")
        if focus:
            actions.add("focus")
        return frozenset(actions)

    def _danger(self, scene, x, y, place_x, place_y):
        """Cost of each plan by what comes near."""
        ahead_x, ahead_y, radius = threats(scene)
        near = (np.abs(ahead_x[0] - x) < NEAR) & (np.abs(ahead_y[0] - y) < NEAR)
        if not near.any():
            return np.zeros(len(place_x))
        radius, care = radius[near], CAUTION[scene.tier] if scene.narrowphase else CAUTION["aabb"]
        off_x = place_x[:, :, None] - ahead_x[None, :, near]
        off_y = place_y[:, :, None] - ahead_y[None, :, near]
        off = np.sqrt((off_x / (HALF_WIDTH + radius)) ** 2 + (off_y / (HALF_HEIGHT + radius)) ** 2) / care
        fear = np.maximum(COMFORT - off, 0.0) ** 2 + 60.0 * (off < DEADLY)
        return (fear.sum(axis=2) * WEIGHTS).sum(axis=1)

    def _distance(self, scene, x, y, end_x, end_y):
        """Cost of each plan by how far it ends from where there is something to do."""
        goal_x, goal_y, pull = 240.0, LINE_Y, 0.004
        prey = [e for e in scene.fleet.planes.values() if -20 < e.y < y - 30 and e.mode != "dive"]
        if prey:
            aim = min(prey, key=lambda e: (abs(e.x - x) - 0.4 * e.y, e.id))
            ahead = max(y - aim.y, 0.0) / 540.0
            goal_x, pull = aim.x + aim.vx * ahead, 0.012
        loot = list(scene.loot.born)
        if loot:
            bodies, rows = scene.world.bodies, scene.world.rows(loot)
            nearest = int(np.argmin(np.abs(bodies["x"][rows] - x) + np.abs(bodies["y"][rows] - y)))
            item_x, item_y = bodies["x"][rows[nearest]].item(), bodies["y"][rows[nearest]].item()
            if 60.0 < item_y < HEIGHT:
                goal_x, goal_y, pull = item_x, item_y + 10.0, 0.03
        return pull * np.abs(end_x - goal_x) + 0.6 * pull * np.abs(end_y - goal_y)


def threats(scene):
    """Where all bullets and enemies will be, x and y [moment, threat] in px, and the radius [px] of each."""
    bodies, incoming = scene.world.bodies, scene.incoming
    ahead, rows = MOMENTS[:, None] / 60, incoming.places()
    columns_x = [bodies["x"][rows] + bodies["vx"][rows] * ahead]
    columns_y = [bodies["y"][rows] + bodies["vy"][rows] * ahead]
    fleet = list(scene.fleet.planes.values())
    for enemy in fleet:
        x, y = enemy.ahead(ahead)
        columns_x.append(x)
        columns_y.append(y)
    sizes = np.array([RADIUS.get(name, 5.0) for name in NAMES])
    radius = np.concatenate([sizes[incoming.table.rows["look"]], [ENEMY_RADIUS[enemy.kind] for enemy in fleet]])
    return np.concatenate(columns_x, axis=1), np.concatenate(columns_y, axis=1), radius
