"""The yard of lab/effects: a world with many kinds of bodies.

Each effect of the engine acts on at least one of them.
"""

from dataclasses import dataclass
from math import sqrt

import numpy as np

from game.drawing.sprites import load_atlas
from physics import Capsule, Circle, Distance, Material, PixelMask, Polygon, TileGrid

LEFT, RIGHT, FLOOR = 196.0, 480.0, 254.0  # [px] the inner sides of the walls, the floor
DRAG, WIND = 0.35, (46.0, 0.0)  # [1/s], [px/s]
TILE = 16
PLANK = (304.0, 150.0)  # [px] upper left corner of four one-way tiles
BELT = ((212.0, 108.0), (276.0, 108.0), 5.0)  # centres of its rollers, their radius
TARGET = (458.0, 72.0)  # [px] middle of the thin wall that shots fly at
ZONE = (290.0, 222.0, 34.0, 62.0)  # middle and size of the sensor zone
ROCK = (398.0, 222.0, 64, 32)  # upper left corner and size [px]
BITE, BITES, BITE_EVERY = 4.0, 18, 20  # radius of the drill [px], bites to a rock, steps between them
CRUMB = 8  # pixels
GRIP, RUBBER = Material(friction=0.6), Material(friction=0.4, restitution=0.85)
BRAKED = Material(friction=0.6, restitution=0.2, rolling_resistance=0.15)
CRATE = Polygon.box(14, 14)


@dataclass(frozen=True)
class Kind:
    """A kind of body that is added at intervals and removed again.

    One body is added every `every` steps, from step `first` on. Each body is removed `life` steps later.
    """

    name: str
    shape: Circle | Polygon | Capsule | PixelMask
    ramp: str
    place: tuple[float, float]  # [px]
    velocity: tuple[float, float]  # [px/s]
    every: int
    first: int
    life: int
    material: Material = GRIP
    spin: float = 0.0  # [rad/s], where bodies turn
    weight: float = 1.0  # share of gravity


KINDS = (
    Kind("crate", CRATE, "wood", (222, 84), (0, 0), 70, 4, 420),
    Kind("pill", Capsule((-5, 0), (5, 0), 5), "teal", (224, 82), (0, 0), 70, 39, 420, spin=2.0),
    Kind("ball", Circle(6), "gold", (336, 240), (-14, -300), 40, 8, 330, BRAKED),
    Kind("rubber", Circle(8), "coral", (386, 90), (0, 0), 110, 2, 330, RUBBER),
    Kind("bullet", Circle(2), "steel", (206, 66), (2400, 0), 24, 1, 44, GRIP),
    Kind("feather", Circle(4), "violet", (206, 190), (0, -20), 50, 20, 300, GRIP, weight=0.02),
)
STACKS = ((214.0, 5), (234.0, 4), (254.0, 3))  # x of a stack, number of its crates
STAR = (430.0, 206.0)
HOOK, BOB, BOBS = (446.0, 96.0), Circle(5), ((468.0, 96.0), (468.0, 118.0))  # of a double pendulum, on two rods
ROOM = 34.0  # [px] over the rock, for the star
PLACED = 1000000  # first number of things that are there from the start; the star is the first


class BusyYard:
    """A world to which bodies are added, and from which they are removed, by a schedule.

    ids: {number: body id} of the moving bodies. A copy of the yard uses the same numbers for the same bodies, while
    their body ids may differ.
    """

    def __init__(self, world):
        self.world = world
        self.ids, self.kinds, self.ends = {}, {}, {}  # by number: body id; Kind or name; step of its removal
        self.rock = -1
        self.reported = np.zeros(6, np.int64)  # begin, persist, end, hits, sensor begin, sensor end
        self.worked = 0  # bodies moved, pairs tested and rows solved, over all steps

    def furnish(self):
        """Add the static bodies, and the moving bodies that exist from the start."""
        world, middle = self.world, (LEFT + RIGHT) / 2
        world.add_body(Polygon.box(800, 40), position=(middle, FLOOR + 20), kind="static", material=GRIP)
        for x in (LEFT - 10, RIGHT + 10):
            world.add_body(Polygon.box(20, 800), position=(x, 0), kind="static", material=GRIP)
        start, end, radius = BELT
        belt = Material(friction=0.6, surface_speed=60.0)
        world.add_body(Capsule(start, end, radius), kind="static", material=belt)
        planks = TileGrid(np.zeros((1, 4), bool), TILE, np.full((1, 4), world.effects.one_way))
        world.add_body(planks, position=PLANK, kind="static", material=GRIP)
        world.add_body(Polygon.box(2, 40), position=TARGET, kind="static", material=GRIP)
        if world.effects.sensors:
            world.add_body(Polygon.box(*ZONE[2:]), position=ZONE[:2], kind="static", sensor=True)
        self._lay_rock()
        self._place("star", world.add_body(load_atlas("lab").mask("star_gold"), position=STAR, material=GRIP))
        for x, count in STACKS:
            for row in range(count):
                self._place("crate", world.add_body(CRATE, position=(x, FLOOR - 7 - 14 * row), material=GRIP))
        above, at = None, HOOK
        for place in BOBS:
            bob = world.add_body(BOB, position=place, material=GRIP)
            self._place("bob", bob)
            if world.effects.joints:
                world.add_joint(Distance(above, bob, at_a=at, at_b=place))
            above, at = bob, place

    def _place(self, name, body):
        number = PLACED + len(self.ids)
        self.ids[number], self.kinds[number] = body.id, name

    def _renew_rock(self):
        """Replace the carved rock by a whole rock.

        Bodies in its place are removed, except the star, which is moved back to its start.
        """
        x, y, width, height = ROCK
        star, numbers = PLACED, {identity: number for number, identity in self.ids.items()}
        for body in self.world.query_aabb((x, y - ROOM), (x + width, y + height)):
            if numbers.get(body.id, star) != star:
                self._remove(numbers[body.id])
        body = self.world.body(self.ids[star])
        body.move_to(STAR, 0.0)
        body.velocity = 0.0, 0.0
        if self.world.effects.rotation:
            body.angular_velocity = 0.0
        self.world.remove_body(self.rock)
        self._lay_rock()

    def _lay_rock(self):
        x, y, width, height = ROCK
        mask = PixelMask(np.ones((height, width), bool), (0, 0))
        self.rock = self.world.add_body(mask, position=(x, y), kind="static", material=GRIP).id

    def beside(self, world):
        """Return a copy of this BusyYard for another World that contains the same bodies.

        Each body of `world` must have the same id as the same body of this yard's world.
        """
        other = BusyYard(world)
        other.ids, other.kinds, other.ends = dict(self.ids), dict(self.kinds), dict(self.ends)
        other.rock = self.rock
        return other

    def step(self, clock):
        """Add, remove and carve bodies as scheduled for step number `clock`, then step the world and update the totals.

        The totals are the numbers of events by kind, and the work: bodies moved, pairs tested, solver rows.
        """
        world = self.world
        for number in [number for number, end in self.ends.items() if end == clock]:
            self._remove(number)
        for place, kind in enumerate(KINDS):
            if clock % kind.every == kind.first:
                self._add(clock * len(KINDS) + place, kind, clock)
        bite, due = divmod(clock % (BITE_EVERY * BITES), BITE_EVERY)
        if due == 0 and world.effects.carving:
            if bite == 0:
                self._renew_rock()
            x = ROCK[0] + BITE + (ROCK[2] - 2 * BITE) * (bite % 9) / 8
            world.body(self.rock).carve(Circle(BITE), (x, ROCK[1] + 2 + 7 * (bite // 9)), crumb=CRUMB)
        world.step()
        self._count()

    def _add(self, number, kind, clock):
        body = self.world.add_body(
            kind.shape,
            position=kind.place,
            velocity=kind.velocity,
            angular_velocity=kind.spin if self.world.effects.rotation else 0.0,
            material=kind.material,
            gravity_scale=kind.weight,
        )
        self.ids[number], self.kinds[number], self.ends[number] = body.id, kind, clock + kind.life

    def _remove(self, number):
        for table in (self.kinds, self.ends):
            table.pop(number, None)
        self.world.remove_body(self.ids.pop(number))

    def _count(self):
        events, counters = self.world.events, self.world.profile.counters
        found = (events.begin, events.persist, events.end, events.hits, events.sensor_begin, events.sensor_end)
        self.reported += [len(rows) for rows in found]
        self.worked += sum(counters[name] for name in ("bodies_integrated", "narrow_tests", "solver_rows"))

    def places(self, numbers):
        """Return the centres of mass of some bodies, an array (n, 2) [px]. numbers: keys of `ids`."""
        rows = self.world.bodies[self.world.rows([self.ids[number] for number in numbers])]
        return np.column_stack([rows["center_x"], rows["center_y"]])


def apart(one, other):
    """Return (numbers, distances) of the bodies that exist in both of two BusyYards.

    one, other: the two yards; numbers: list of keys of `ids`; distances: array (n,) [px], the distance between a body's
    positions in the two yards.
    """
    numbers = sorted(one.ids.keys() & other.ids.keys())
    return numbers, np.hypot(*(one.places(numbers) - other.places(numbers)).T) if numbers else np.zeros(0)


def rms(values):
    """Return the root mean square of the values; 0 if there are none."""
    return sqrt(float((values * values).mean())) if len(values) else 0.0
