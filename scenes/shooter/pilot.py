"""The shooter's bot. It predicts the bullets, compares several plans of flight, and chooses the least dangerous one.

A plan is a direction, flown for a number of steps; after them the plane stops. One array expression gives the
distances of all plans from all threats at all predicted moments. The bot drops a bomb if its best plan soon ends in a
hit.
"""

import numpy as np

from scenes.shooter.bullets import NAMES, mask_of
from scenes.shooter.cast import GROUNDED, HEIGHT
from scenes.shooter.plane import BOTTOM, CORE_RADIUS, DIAGONAL, FOCUS, LEFT, SPEED, TOP

MOMENTS = np.array([1, 3, 5, 8, 11, 14, 18, 22, 27, 32, 38, 45], dtype=np.float64)  # steps ahead
SOON = 5  # the first SOON of these moments are so near that only a bomb would help
WEIGHTS = 1.0 / (1.0 + MOMENTS / 14.0)  # later threats can still be dodged
FLOWN = (5.0, 12.0, 26.0)  # steps for which a direction is held
SIZE = {"core": CORE_RADIUS + 1.0, "hull": 15.0}  # [px] radius of the vulnerable part, for the prediction
ENEMY_RADIUS = {"dart": 13.0, "saucer": 16.0, "gunship": 25.0, "hornet": 12.0, "midboss": 38.0, "boss": 56.0}
CAUTION = {"pixels": 1.0, "obb": 1.3, "aabb": 1.2, "circle": 1.3}  # factor on enemies' sizes
COMFORT = 14.0  # [px] a smaller distance from a threat adds to a plan's cost
DEADLY = 0.8  # [px] a smaller distance is a hit
HIT = 60.0  # cost of a hit
NEAR, MOST = 130.0, 64  # [px] range within which bullets are threats; greatest number of them
AT_ONCE = 7  # plans compared at once, so that arrays stay small
LINE_Y = 216.0  # [px] the bot's preferred y
CROWD = 1500  # number of enemy bullets at which the bot uses its first bomb in any case


def directions():
    """Return the plans among which the bot chooses, a list of (dx, dy, steps, focus).

    dx, dy: direction, -1, 0 or 1 each; steps: duration; focus: whether the plane flies slowly. In the first plan the
    plane does not move.
    """
    plans = [(0.0, 0.0, 0.0, False)]
    for focus in (False, True):
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                if dx or dy:
                    plans += [(dx, dy, flown, focus) for flown in (FLOWN if not focus else FLOWN[1:2])]
    return plans


class Pilot:
    """The bot, which plays the shooter. keys(scene) returns the actions that it holds in the next step."""

    def __init__(self):
        self.plans = directions()
        dx, dy, flown, focus = (np.array(column, dtype=np.float64) for column in zip(*self.plans, strict=True))
        speed = SPEED / 60 * np.where(focus > 0, FOCUS, 1.0) * np.where((dx != 0) & (dy != 0), DIAGONAL, 1.0)
        held = np.minimum(MOMENTS[None, :], flown[:, None])
        self.way_x, self.way_y = (dx * speed)[:, None] * held, (dy * speed)[:, None] * held

    def keys(self, scene):
        """Return the actions of the plan with the least cost, a frozenset of names.

        The cost is the plan's danger, plus the distance of its end from the nearest target or pick-up.
        """
        plane = scene.plane
        if not plane.here:
            return frozenset()
        x, y = plane.body.position
        place_x = np.clip(x + self.way_x, LEFT, scene.plane.right)
        place_y = np.clip(y + self.way_y, TOP, BOTTOM)
        danger, doomed = self._danger(scene, x, y, place_x, place_y)
        cost = danger + self._distance(scene, x, y, place_x[:, -1], place_y[:, -1])
        best = int(np.argmin(cost))
        dx, dy, _, focus = self.plans[best]
        actions = {"fire"}
        if dx:
            actions.add("right" if dx > 0 else "left")
        if dy:
            actions.add("down" if dy > 0 else "up")
        if focus:
            actions.add("focus")
        if self._bombs(scene, bool(doomed[best])):
            actions.add("bomb")
        return frozenset(actions)

    def _bombs(self, scene, doomed):
        """Return whether to drop a bomb.

        A bomb is dropped just after a hit, before a hit that cannot be avoided (`doomed`), or once when there are very
        many bullets.
        """
        if not scene.plane.bombs or scene.bomb.body is not None:
            return False
        crowded = not scene.score.bombs and len(scene.incoming) >= CROWD
        return scene.stricken > 0 or (not scene.plane.safe and doomed) or crowded

    def _danger(self, scene, x, y, place_x, place_y):
        """Return (cost, doomed), two arrays with a value for each plan: its danger, and whether it soon ends in a hit.

        x, y: position of the plane [px]; place_x, place_y: predicted positions of the plane [px], arrays [plan,
        moment] at the moments MOMENTS.
        """
        ahead_x, ahead_y, radius = threats(scene, x, y)
        if not len(radius):
            return np.zeros(len(place_x)), np.zeros(len(place_x), bool)
        radius = radius + SIZE[scene.hurts if scene.narrowphase else "hull"]
        cost, doomed = np.zeros(len(place_x)), np.zeros(len(place_x), bool)
        for some in range(0, len(place_x), AT_ONCE):
            part = slice(some, some + AT_ONCE)
            gap = (place_x[part, :, None] - ahead_x) ** 2
            gap += (place_y[part, :, None] - ahead_y) ** 2
            np.sqrt(gap, out=gap)
            gap -= radius
            hit = gap < DEADLY
            fear = np.maximum(COMFORT - gap, 0.0, out=gap)
            fear /= COMFORT
            fear *= fear
            fear[hit] += HIT
            cost[part] = (fear.sum(axis=2) * WEIGHTS).sum(axis=1)
            doomed[part] = hit[:, :SOON].any(axis=(1, 2))
        return cost, doomed

    def _distance(self, scene, x, y, end_x, end_y):
        """Return an array with a value for each plan: the cost of the distance between its end and a target or
        pick-up.

        x, y: position of the plane [px]; end_x, end_y: positions at the end of each plan [px].
        """
        goal_x, goal_y, pull = 240.0, LINE_Y, 0.004
        prey = [
            e for e in scene.fleet.planes.values() if -20 < e.y < y - 30 and e.mode not in ("dive", "fall", "leave")
        ]
        if prey:
            aim = min(prey, key=lambda e: (abs(e.x - x) - 0.4 * e.y, e.id))
            ahead = max(y - aim.y, 0.0) / 540.0
            goal_x, pull = aim.x + aim.vx * ahead, 0.012
        loot = list(scene.loot.items)
        if loot:
            bodies, rows = scene.world.bodies, scene.world.rows(loot)
            nearest = int(np.argmin(np.abs(bodies["x"][rows] - x) + np.abs(bodies["y"][rows] - y)))
            item_x, item_y = bodies["x"][rows[nearest]].item(), bodies["y"][rows[nearest]].item()
            if 60.0 < item_y < HEIGHT:
                goal_x, goal_y, pull = item_x, item_y + 10.0, 0.03
        return pull * np.abs(end_x - goal_x) + 0.6 * pull * np.abs(end_y - goal_y)


def threats(scene, x, y):
    """Predict the positions of the bullets near (x, y) [px] and of all enemies in the air.

    Return (x, y, radius): the positions, two arrays [moment, threat] at the moments MOMENTS [px], and the radii of the
    threats, an array [px].
    """
    bodies, incoming = scene.world.bodies, scene.incoming
    rows = incoming.places()
    sizes = np.array([mask_of(name).size[0] / 2 - 0.5 for name in NAMES])[incoming.table.rows["look"]]
    off = np.maximum(np.abs(bodies["x"][rows] - x), np.abs(bodies["y"][rows] - y)) - sizes
    near = np.flatnonzero(off < NEAR)
    if len(near) > MOST:
        near = near[np.argsort(off[near], kind="stable")[:MOST]]
    rows, ahead = rows[near], MOMENTS[:, None] / 60
    columns_x = [bodies["x"][rows] + bodies["vx"][rows] * ahead]
    columns_y = [bodies["y"][rows] + bodies["vy"][rows] * ahead]
    fleet = [enemy for enemy in scene.fleet.planes.values() if enemy.side is not GROUNDED]
    care = CAUTION[scene.tier] if scene.narrowphase else CAUTION["aabb"]
    for enemy in fleet:
        ahead_x, ahead_y = enemy.ahead(ahead)
        columns_x.append(ahead_x)
        columns_y.append(ahead_y)
    radius = np.concatenate([sizes[near], [ENEMY_RADIUS[enemy.kind] * care for enemy in fleet]])
    return np.concatenate(columns_x, axis=1), np.concatenate(columns_y, axis=1), radius
