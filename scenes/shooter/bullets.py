"""Bullets as table rows: added in volleys, moved by the world, removed in batches. No bullet has an object
of its own.
"""

from math import cos, pi, sin

import numpy as np

from game.drawing.sprites import load_atlas
from physics.tables.table import Table
from scenes.shooter.cast import HEIGHT, MARGIN, WIDTH

DOWN, UP = pi / 2, -pi / 2  # [rad] headings; y points down
# look -> (frame of atlas "effects" whose mask collides, heading in which it is painted; None: round, never rotated)
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
GRAZED, BOXED, HULLED, CORED = 1, 2, 4, 8  # bits: parts of the player that a bullet has touched; each counts once
BULLET = np.dtype([("id", np.int64), ("look", np.int64), ("met", np.int64)])


class Bullets:
    """The bullets of one side, the player or the enemies.

    A row of the table contains the body id, the look, and bits for the parts of the player that the bullet has
    touched. The world contains the positions.
    """

    def __init__(self, world, side):
        self.world, self.side = world, side
        self.table = Table(BULLET)
        self.volley = {name: [] for name in NAMES}  # look -> (x, y, vx, vy, angle) fired in this step

    def __len__(self):
        return self.table.count

    @property
    def ids(self):
        """Body ids of all bullets, ascending."""
        return self._rows["id"]

    @property
    def _rows(self) -> np.ndarray:
        return self.table.rows  # NumPy's stubs allow a column by name for no known dtype

    def make_room(self, count):
        """Make all tables grow to `count` bullets before the first step, so that later steps allocate no memory."""
        apart = 1000.0 + 20.0 * np.arange(count)  # on a diagonal far away, so that no two of them form a pair
        ids = self.world.add_bodies(
            mask_of("small"), np.column_stack((apart, apart)), kind="kinematic", filter=self.side
        )
        self.world.step()
        for part in np.split(ids, (1, 2, 3, 4)):  # small batches first: most rows are kept, as in the fight
            self.world.remove_bodies(part)
        self.table.append(count)
        self.table.keep(np.zeros(count, bool))

    def fire(self, look, x, y, headings, speed, out=0.0):
        """Add one bullet for each heading [rad] to the current volley. launch() adds the volley to the world.

        look: key of LOOKS. A bullet starts at (x, y) [px], moved by `out` px along its heading, with `speed` [px/s].
        """
        painted = LOOKS[look][1]
        for heading in headings:
            angle = 0.0 if painted is None else heading - painted
            across, down = cos(heading), sin(heading)
            self.volley[look].append((x + out * across, y + out * down, speed * across, speed * down, angle))

    def launch(self):
        """Add the bullets of the current volley to the world, with one call for each look, and start a new volley."""
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
        """Return the row numbers of the bullets in world.bodies, an array in the order of `table`."""
        return self.world.rows(self.ids)

    def has(self, ids):
        """Return a bool array (k,): whether each of the k body ids `ids` is one of these bullets.

        The cost is O(k log n) for n bullets, because the table is sorted by id.
        """
        if not len(self):
            return np.zeros(len(ids), bool)
        return self.ids[self._nearest(ids)] == ids

    def meet(self, ids, what):
        """Record that bullets have touched a part of the player.

        ids: body ids; ids of other bodies are ignored; what: bit of the part (GRAZED, BOXED, HULLED, CORED). Return
        the ids of the bullets that touch this part for the first time.
        """
        at = self._nearest(ids[self.has(ids)])
        met = self._rows["met"]
        new = at[(met[at] & what) == 0]
        met[new] |= what
        return self.ids[new]

    def forget(self, ids):
        """Remove the table rows of the bullets with the given body ids. Ids of other bodies are ignored."""
        there = ids[self.has(ids)]
        if len(there):
            keep = np.ones(len(self), bool)
            keep[self._nearest(there)] = False
            self.table.keep(keep)

    def _nearest(self, ids):
        """Return the table row of each id, an array.

        For an unknown id, it is the row of a neighbouring id in the sorted table.
        """
        return np.minimum(np.searchsorted(np.ascontiguousarray(self.ids), ids), max(len(self) - 1, 0))

    def state(self):
        """Return this object's part of Scene.state(): the whole table as a hexadecimal string."""
        return self.table.rows.tobytes().hex()


def mask_of(look):
    """Return the PixelMask of a bullet. look: key of LOOKS."""
    return load_atlas("effects").mask(LOOKS[look][0])


def outside(x, y):
    """Return a bool array (n,): whether a sprite at each point (x, y) [px] would be completely outside the picture."""
    return (x < -MARGIN) | (x > WIDTH + MARGIN) | (y < -2 * MARGIN) | (y > HEIGHT + MARGIN)
