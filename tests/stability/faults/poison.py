"""A scene with every kind of table, and the list of all float columns that a step reads.

The list is derived from the dtypes of the tables.
"""

import math
from typing import NamedTuple

import numpy as np

from physics import Capsule, Chain, Character, Circle, Effects, Material, PixelMask, Polygon, TileGrid, World
from physics.tables.contact import CONTACT
from physics.tables.shape import PROXY


def floats_of(dtype):
    """Return the names of the columns of a table that contain floats. dtype: dtype of the rows."""
    return [name for name in dtype.names if dtype[name].kind == "f"]


VALUES = {"nan": math.nan, "+inf": math.inf, "-inf": -math.inf, "1e308": 1e308}
STACKING = Effects.rigid_bodies().with_(sleeping=False, one_way=True, conveyor=True, drag=True, wind=True)
WORLDS = {
    "soft_step": (STACKING, "soft_step"),
    "sequential_impulse": (STACKING, "sequential_impulse"),
    "projection": (STACKING.with_(stacking=False), "projection"),
    "sleeping": (STACKING.with_(sleeping=True), "soft_step"),
}
KINDS = tuple(WORLDS)
TABLES = ("bodies", "shapes", "proxies", "characters", "contact_rows")
# Numbers that no step takes on from the one before: told, or worked out again before they are read. All others put the
# body they belong to aside.
WRITTEN_ANEW = {
    "bodies": {
        *(f"{when}_{axis}" for when in ("previous", "settled", "still", "rocking") for axis in ("x", "y", "angle")),
        "sleep_time",
        "rocking_time",
        "cooldown",
        "reserve",
    },
    "shapes": {"density", "min_x", "min_y", "max_x", "max_y"},
    "proxies": set(floats_of(PROXY)),
    "characters": set(),
    "contact_rows": set(floats_of(CONTACT)),  # found anew; forces that are none are forgotten
}
# Large, and yet of use: a mass that is told has its inverse beside it.
QUIETLY = {("bodies", name, "1e308") for name in ("mass", "inertia", "min_half_extent", "inradius", "fraction")}
MASK = PixelMask(np.ones((8, 10), bool))


class Field(NamedTuple):
    """One float column of a table that persists between steps."""

    table: str
    name: str

    def __str__(self):
        return f"{self.table}.{self.name}"


def table_of(world, name):
    """Return the rows of a persistent table in the form that the next step reads."""
    return {
        "bodies": world.bodies,
        "shapes": world.shapes,
        "proxies": world.pairs.proxies,
        "characters": world.characters.rows,
        "contact_rows": world.contact_rows,
    }[name]


class Scene:
    """Three heaps of four bodies, 400 px apart, over ground of every kind, with a character beside each.

    The heaps do not affect each other, so a fault in the first must not change the others. `sick` is the id of a body
    in the middle of the first heap, which gets the wrong values.
    """

    def __init__(self, kind):
        effects, solver = WORLDS[kind]
        self.world = world = World(effects, solver=solver, drag=0.1, wind=(5, 0), substeps=4)
        grounds = []
        for k in range(3):
            x = 400.0 * k
            grounds.append(world.add_body(TileGrid(np.ones((1, 8), bool), 16.0), position=(x - 64, 0), kind="static"))
            grounds.append(world.add_body(Chain([(-60, 0), (0, 6), (60, -6)]), position=(x + 130, 0), kind="static"))
        self.heaps = [self._heap(400.0 * k) for k in range(3)]
        self.heroes = [Character(world, Polygon.box(8, 16), (400.0 * k - 40, -8)) for k in range(3)]
        lift = world.add_body(Polygon.box(20, 6), position=(-90, -30), kind="kinematic", velocity=(0, -1))
        self.sick = self.heaps[0][1]
        self.named = {"ground": grounds[0].id, "chain": grounds[1].id, "disc": self.heaps[0][3]}
        self.named |= {"mask": self.heaps[0][2], "lift": lift.id}
        self.steps(40)

    def _heap(self, x):
        world, belt = self.world, Material(surface_speed=3.0, rolling_resistance=0.1, restitution=0.1)
        shapes = (Polygon.box(24, 10), Polygon([(-8, 6), (0, -6), (8, 6)], radius=1.0), MASK, Circle(5.0))
        heap = [world.add_body(shapes[0], position=(x, -5), material=belt).id]
        heap += [world.add_body(shapes[k], position=(x, -1 - 12 * k - 4)).id for k in (1, 2)]
        heap += [world.add_body(shapes[3], position=(x + 120, -8)).id]
        world.add_body(Capsule((-6, 0), (6, 0), 4), position=(x + 40, -4), angle=0.1)
        return heap

    def steps(self, count):
        """Make `count` steps; in each of them every character walks a little."""
        for _ in range(count):
            for hero in self.heroes:
                hero.move(0.5, 1.0)
            self.world.step()

    def target(self, field):
        """Return [id] of the body to which a field belongs: the sick body, or the body of the first character."""
        return [self.heroes[0].body.id if field.table == "characters" else self.sick]

    def others(self):
        """Return the rows of the bodies in the other heaps (x above 250)."""
        return np.flatnonzero(self.world.bodies["x"] > 250.0)

    def row_of(self, table):
        """Return the index of the row to spoil in a table: a row of the sick body, or that of the first character."""
        world, sick = self.world, self.sick
        if table == "bodies":
            return int(world.rows([sick])[0])
        if table == "shapes":
            return int(np.flatnonzero(world.shapes["body"] == sick)[0])
        if table == "proxies":
            return int(world.shapes["proxy"][self.row_of("shapes")])
        if table == "characters":
            return 0
        found = np.flatnonzero((world.contact_rows["body_a"] == sick) | (world.contact_rows["body_b"] == sick))
        return int(found[0])

    def poison(self, field, value):
        """Write a value into a field of the sick body or of the first character."""
        body = self.world.body(self.sick)
        if body.kind == "dynamic":
            body.wake()  # what sleeps is looked at when it is touched
        table_of(self.world, field.table)[field.name][self.row_of(field.table)] = value
        if body.kind != "dynamic":
            self.world.touch([self.sick])


def fields_of(world, table):
    """Return the `Field` of every float column of a persistent table; an empty list if the table has no rows."""
    rows = table_of(world, table)
    return [Field(table, each) for each in floats_of(rows.dtype)] if len(rows) else []


def same(found, wanted, rows):
    """Return whether poses and velocities of these rows are equal in two body tables, to the bit."""
    names = ("x", "y", "angle", "vx", "vy", "angular_velocity")
    return all(np.array_equal(found[name][rows], wanted[name][rows]) for name in names)


def columns_of(value, fill, depth=3):
    """Fill every float array in the attributes of an object with a value, and return the number of arrays.

    The search includes the attributes of attributes, down to `depth` levels. The attribute `tables` is left out: its
    contacts are overwritten by column names elsewhere.
    """
    if isinstance(value, np.ndarray):
        if value.dtype.names:
            for name in floats_of(value.dtype):
                value[name] = fill
        elif value.dtype.kind == "f":
            value[:] = fill
        return 1
    if depth == 0 or isinstance(value, (str, bytes, int, float, bool, type(None))):
        return 0
    named = getattr(value, "__dict__", {})
    parts = value if isinstance(value, (list, tuple)) else [named[name] for name in named if name != "tables"]
    return sum(columns_of(each, fill, depth - 1) for each in parts)
