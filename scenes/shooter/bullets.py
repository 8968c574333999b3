"""Bullets are rows: fired in volleys, moved by the world, removed in batches. There is no object per bullet."""

from math import atan2, cos, pi, sin

import numpy as np

from game.sprites import load_atlas
from physics.tables import Table
from scenes.shooter.cast import HEIGHT, MARGIN, WIDTH

DOWN, UP = pi / 2, -pi / 2     # [rad] headings; y points down
# The frame that collides, in atlas "effects", and its heading as painted (None: round, it is never turned).
LOOKS = {
    "shot": ("player_bullet_0", UP),
    "side": ("side_bullet", UP),
    "red": ("bullet_red_0", None),
    "purple": ("bullet_purple_0", None),
    "orange": ("bullet_orange_0", None),
    "needle": ("bullet_needle", UP),
}
NAMES = tuple(LOOKS)
BULLET = np.dtype([("id", np.int64), ("look", np.int64)])


class Bullets:
    """The bullets of one side. `table.rows` holds id and look of each; where it is, the world knows."""

    def __init__(self, world, side):
        self.world, self.side = world, side
        self.table = Table(BULLET)
        self.volley = {name: [] for name in NAMES}      # look -> (x, y, vx, vy, angle) fired in this step
        atlas = load_atlas("effects")
        self.masks = {name: atlas.mask(frame) for name, (frame, _) in LOOKS.items()}

    def __len__(self):
        return self.table.count

    @property
    def ids(self):
        """Ids of all, ascending."""
        return self.table.rows["id"]

    def fire(self, look, x, y, headings, speed):
        """Add one bullet per heading [rad] at (x, y) [px], speed in px/s. They fly from the next step on."""
        painted = LOOKS[look][1]
        for heading in headings:
            angle = 0.0 if painted is None else heading - painted
            self.volley[look].append((x, y, speed * cos(heading), speed * sin(heading), angle))

    def launch(self, tier):
        """Put the volley into the world: one call per look that was fired."""
        for look, fired in self.volley.items():
            if not fired:
                continue
            rows = np.array(fired)
            ids = self.world.add_bodies(self.masks[look], rows[:, 0:2], rows[:, 2:4], rows[:, 4], kind="kinematic",
                                        filter=self.side, tier=tier)
            added = self.table.append(len(ids))
            added["id"], added["look"] = ids, NAMES.index(look)
            fired.clear()

    def places(self):
        """Rows of the world's bodies, in the order of the table."""
        return self.world.rows(self.ids)

    def forget(self, ids):
        """Drop the rows of bullets whose bodies are removed; other ids are ignored."""
        self.table.keep(~np.isin(self.ids, ids))


def outside(x, y):
    """Which places [px] are farther out than anything can be seen."""
    return (x < -MARGIN) | (x > WIDTH + MARGIN) | (y < -2 * MARGIN) | (y > HEIGHT + MARGIN)


def aimed(x, y, target):
    """One heading, at the target (x, y)."""
    return [atan2(target[1] - y, target[0] - x)]


def fan(heading, count, spread):
    """`count` headings, `spread` [rad] from first to last, around one."""
    if count == 1:
        return [heading]
    return [heading + spread * (number / (count - 1) - 0.5) for number in range(count)]


def ring(count, turn=0.0):
    """`count` headings all around, the first at `turn` [rad]."""
    return [turn + 2 * pi * number / count for number in range(count)]
