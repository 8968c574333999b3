"""Bullets are rows: fired in volleys, moved by the world, removed in batches. There is no object per bullet."""

from math import cos, pi, sin

import numpy as np

from game.drawing.sprites import load_atlas
from physics.tables.table import Table
from scenes.shooter.cast import HEIGHT, MARGIN, WIDTH

DOWN, UP = pi / 2, -pi / 2  # [rad] headings; y points down
# The colliding frame, in atlas "effects", and its painted heading (None: round, never rotated).
LOOKS = {
    "shot": ("player_bullet_0", UP),
    "side": ("side_bullet", UP),
    "heavy": ("heavy_shot", UP),
    "red": ("bullet_red_0", None),
    "purple": ("bullet_purple_0", None),
    "orange": ("bullet_orange_0", None),
    "small": ("bullet_small_0", None),
    "big": ("bullet_big_0", None),
    "hollow": ("bullet_ring_0", None),
    "needle": ("bullet_needle", UP),
}
NAMES = tuple(LOOKS)
HOSTILE_LOOKS = NAMES[3:]
GRAZED, BOXED, HULLED, CORED = 1, 2, 4, 8  # parts of the player that a bullet has met: each counts once
BULLET = np.dtype([("id", np.int64), ("look", np.int64), ("met", np.int64)])


class Bullets:
    """The bullets of one side. `table.rows` holds id, look and contacts; the world has the positions."""

    def __init__(self, world, side):
        self.world, self.side = world, side
        self.table = Table(BULLET)
        self.volley = {name: [] for name in NAMES}  # look -> (x, y, vx, vy, angle) fired in this step

    def __len__(self):
        return self.table.count

    @property
    def ids(self):
        """Ids of all bullets, ascending."""
        return self._rows["id"]

    @property
    def _rows(self) -> np.ndarray:
        return self.table.rows  # NumPy's stubs allow a column by name for no known dtype

    def make_room(self, count):
        """Let every table grow before the first step, so that no later step allocates."""
        apart = 1000.0 + 20.0 * np.arange(count)  # on a diagonal far away: none of them are ever a pair
        ids = self.world.add_bodies(
            mask_of("small"), np.column_stack((apart, apart)), kind="kinematic", filter=self.side
        )
        self.world.step()
        for part in np.split(ids, (1, 2, 3, 4)):  # most are kept, several times over, as in the fight
            self.world.remove_bodies(part)
        self.table.append(count)
        self.table.keep(np.zeros(count, bool))

    def fire(self, look, x, y, headings, speed, out=0.0):
        """Add one bullet per heading [rad], `out` [px] along it from (x, y) [px], speed in px/s. They fly from the next
        step on.
        """
        painted = LOOKS[look][1]
        for heading in headings:
            angle = 0.0 if painted is None else heading - painted
            across, down = cos(heading), sin(heading)
            self.volley[look].append((x + out * across, y + out * down, speed * across, speed * down, angle))

    def launch(self):
        """Put the volley into the world: one call per look in it."""
        for look, fired in self.volley.items():
            if not fired:
                continue
            rows = np.array(fired)
            ids = self.world.add_bodies(
                mask_of(look), rows[:, 0:2], rows[:, 2:4], rows[:, 4], kind="kinematic", filter=self.side
            )
            self.table.append(len(ids))
            added = self._rows[-len(ids) :]
            added["id"], added["look"], added["met"] = ids, NAMES.index(look), 0
            fired.clear()

    def places(self):
        """Return rows of the world's bodies, in the order of the table."""
        return self.world.rows(self.ids)

    def has(self, ids):
        """Return which of some ids are bullets of this side. O(k log n): ids are in order."""
        if not len(self):
            return np.zeros(len(ids), bool)
        return self.ids[self._nearest(ids)] == ids

    def meet(self, ids, what):
        """Record that bullets met a part of the player (GRAZED ...). Return those that meet it for the first time;
        other ids are ignored.
        """
        at = self._nearest(ids[self.has(ids)])
        met = self._rows["met"]
        new = at[(met[at] & what) == 0]
        met[new] |= what
        return self.ids[new]

    def forget(self, ids):
        """Drop the rows of bullets whose bodies are removed; other ids are ignored."""
        there = ids[self.has(ids)]
        if len(there):
            keep = np.ones(len(self), bool)
            keep[self._nearest(there)] = False
            self.table.keep(keep)

    def _nearest(self, ids):
        """Return the row of each id, or where it would be; always an existing row."""
        return np.minimum(np.searchsorted(np.ascontiguousarray(self.ids), ids), max(len(self) - 1, 0))

    def state(self):
        """Return the state for the digest: the whole table."""
        return self.table.rows.tobytes().hex()


def mask_of(look):
    """Return the pixels of a bullet."""
    return load_atlas("effects").mask(LOOKS[look][0])


def outside(x, y):
    """Return which places [px] are beyond all visible ones."""
    return (x < -MARGIN) | (x > WIDTH + MARGIN) | (y < -2 * MARGIN) | (y > HEIGHT + MARGIN)
