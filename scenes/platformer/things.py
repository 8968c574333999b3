"""Objects of a level: triggers (coins, springs, spikes, ladders, ...), platforms, belts, crumbling stones, crates."""

from math import ceil, cos, floor, pi, sin

from game.scene import STEP_SECONDS
from physics import Filter, Material, Polygon
from scenes.platformer.feel import SPRING_SPEED, steps
from scenes.platformer.level import (
    CRATE,
    CRATE_FILTER,
    DEBRIS_FILTER,
    ENEMY,
    HERO,
    PLATFORM,
    PLATFORM_FILTER,
    SPRING_FILTER,
    TILE_FILTER,
    TRIGGER_FILTER,
)

CRATE_DENSITY = 0.5  # the large crate weighs two and a half times as much as the hero, so that he can tip it
CRATE_FRICTION = 0.3  # half of the friction of the ground
SLIDES = 0.1  # [px per step] motion from which a crate counts as moving
SPRING_KEEPS = 0.5  # share of its speed along x that a crate keeps on a spring, which throws upwards
COIN_REACH = 2  # [px] by which the sensor of a coin is larger on each side
LANTERN_SHINES = 64  # [px] by which the sensor of a checkpoint is higher, so that a jump does not miss it
SPRING_INSET = (2, 7)  # [px] by which the sensor of a spring is smaller at the sides and at the top: the plate is low
LADDER_INSET, LADDER_OVER = (3, 4)  # [px] narrower at each side; higher, to reach the feet of a hero on its top
TRIGGERS = ("coin", "secret", "spring", "spikes", "checkpoint", "goal", "ladder")
SHAKES = 0.5  # [s] for which a crumbling stone holds after something has stepped on it
GONE = 3.0  # [s] from breaking until it is back, if its place is free
BITS = ((-10.0, 2.0), (0.0, -3.0), (10.0, 2.0))  # [px] starts of its pieces, relative to its centre
BIT_SIZE, BIT_DENSITY = 7, 0.2
BIT_LIFE = 1.6  # [s]


class Trigger:
    """An object of the level with a sensor: coin, secret, spring, spikes, checkpoint, goal or ladder.

    lit: whether this is a checkpoint that has been reached; touched: number of the step of the last touch, or None.
    """

    def __init__(self, world, thing):
        self.kind, self.thing = thing.kind, thing
        left, top, width, height = thing.x, thing.y, thing.width, thing.height
        self.top = thing.y
        if self.kind in ("coin", "secret"):
            left, top, width, height = (
                left - COIN_REACH,
                top - COIN_REACH,
                width + 2 * COIN_REACH,
                height + 2 * COIN_REACH,
            )
        elif self.kind == "spring":
            left, top, width, height = (
                left + SPRING_INSET[0],
                top + SPRING_INSET[1],
                width - 2 * SPRING_INSET[0],
                height - SPRING_INSET[1],
            )
        elif self.kind == "checkpoint":
            top, height = top - LANTERN_SHINES, height + LANTERN_SHINES
        elif self.kind == "ladder":
            left, top, width, height = (
                left + LADDER_INSET,
                top - LADDER_OVER,
                width - 2 * LADDER_INSET,
                height + LADDER_OVER,
            )
        self.x, self.y = left + width / 2, top + height / 2
        self.body = world.add_body(
            Polygon.box(width, height),
            position=(self.x, self.y),
            kind="static",
            sensor=True,
            filter=SPRING_FILTER if self.kind == "spring" else TRIGGER_FILTER,
            user=self.kind,
        )
        self.lit = False
        self.touched: int | None = None

    @property
    def foot(self):
        """Centre (x, y) [px] of the object's lower edge."""
        return self.thing.x + self.thing.width / 2, self.thing.y + self.thing.height


class Platform:
    """A kinematic box that moves to and fro between two positions. It is slow near the ends, so that
    boarding is easy.
    """

    kind = "platform"

    def __init__(self, world, thing):
        half_width, half_height = thing.width / 2, thing.height / 2
        there = thing.properties
        self.start = (thing.x + half_width, thing.y + half_height)
        self.end = (there["to_x"] + half_width, there["to_y"] + half_height)
        self.size = (thing.width, thing.height)
        self.period = float(there["period"])
        self.body = world.add_body(
            Polygon.box(*self.size),
            position=self.start,
            kind="kinematic",
            continuous="off",
            filter=PLATFORM_FILTER,
            user="platform",
        )

    def place_at(self, tick):
        """Return the centre (x, y) [px] of the platform in step `tick` of the world."""
        share = (1.0 - cos(2.0 * pi * tick * STEP_SECONDS / self.period)) / 2.0
        return (
            self.start[0] + (self.end[0] - self.start[0]) * share,
            self.start[1] + (self.end[1] - self.start[1]) * share,
        )

    def aim(self, tick):
        """Set the velocity with which the platform reaches its position of step `tick` + 1 of the world.

        The platform is moved by a velocity, so that it carries the bodies on it.
        """
        x, y = self.body.position
        next_x, next_y = self.place_at(tick + 1)
        self.body.velocity = ((next_x - x) / STEP_SECONDS, (next_y - y) / STEP_SECONDS)

    @property
    def box(self):
        """Box (left, top, right, bottom) of the platform in integer pixels, rounded in the same way as for
        characters.
        """
        x, y = self.body.position
        left, top = int(x - self.size[0] / 2 + 0.5), int(y - self.size[1] / 2 + 0.5)
        return left, top, left + int(self.size[0]), top + int(self.size[1])


class Block:
    """Base class of the static boxes of the level that are not tiles: belts and crumbling stones."""

    def __init__(self, world, thing):
        self.world, self.thing, self.kind = world, thing, thing.kind
        self.size = (int(thing.width), int(thing.height))
        self.center = (thing.x + thing.width / 2, thing.y + thing.height / 2)
        left, top = int(thing.x), int(thing.y)
        self.box = (left, top, left + self.size[0], top + self.size[1])


class Belt(Block):
    """A conveyor belt, which carries bodies. speed: speed of its surface, positive to the right [px/s]."""

    def __init__(self, world, thing):
        super().__init__(world, thing)
        self.speed = float(thing.properties["speed"])
        self.body = world.add_body(
            Polygon.box(*self.size),
            position=self.center,
            kind="static",
            filter=TILE_FILTER,
            material=Material(surface_speed=self.speed),
            user="belt",
        )


class Crumble(Block):
    """A stone that shakes under a load, then breaks into pieces, and is restored after GONE seconds."""

    FREE = Filter(PLATFORM, HERO | ENEMY | CRATE)

    def __init__(self, world, thing):
        super().__init__(world, thing)
        self.whole = self.box
        self.count = 0  # steps since it began to shake, or since it broke
        self.shaking = False
        self.body = None
        self.bits = []  # [body, age in steps]
        self.stand()

    def stand(self):
        """Restore the whole stone."""
        if self.body is None:
            self.body = self.world.add_body(
                Polygon.box(*self.size),
                position=self.center,
                kind="kinematic",
                continuous="off",
                filter=PLATFORM_FILTER,
                user="crumble",
            )
        self.box, self.count, self.shaking = self.whole, 0, False

    def press(self):
        """Make the stone shake. Called when it carries a load."""
        self.shaking = self.body is not None

    def step(self):
        """Make one step of the stone and its pieces.

        Return "shake" when the stone begins to shake, "break" when it breaks, "back" when it is restored, otherwise
        None.
        """
        for bit in self.bits:
            bit[1] += 1
        for body, _ in [bit for bit in self.bits if bit[1] > steps(BIT_LIFE)]:
            self.world.remove_body(body)
        self.bits = [bit for bit in self.bits if bit[1] <= steps(BIT_LIFE)]
        if self.body is None:
            self.count += 1
            if self.count >= steps(GONE) and not self.world.overlap(
                Polygon.box(*self.size), (*self.center, 0.0), filter=self.FREE
            ):
                self.stand()
                return "back"
        elif self.shaking:
            self.count += 1
            if self.count == 1:
                return "shake"
            if self.count > steps(SHAKES):
                self._fall_apart()
                return "break"
        return None

    def _fall_apart(self):
        self.world.remove_body(self.body)
        self.body, self.box, self.count, self.shaking = None, (0, 0, 0, 0), 0, False
        for dx, dy in BITS:
            body = self.world.add_body(
                Polygon.box(BIT_SIZE, BIT_SIZE),
                position=(self.center[0] + dx, self.center[1] + dy),
                velocity=(3.0 * dx, -30.0),
                angular_velocity=0.3 * dx,
                filter=DEBRIS_FILTER,
                material=Material(BIT_DENSITY),
                user="bit",
            )
            self.bits.append([body, 0])


class Crate:
    """A crate: a dynamic box that can be pushed, stacked, tipped over, ridden, thrown and carried."""

    kind = "crate"

    def __init__(self, world, thing):
        self.size = (int(thing.width), int(thing.height))
        self.home = (thing.x + thing.width / 2, thing.y + thing.height / 2)
        self.body = world.add_body(
            Polygon.box(*self.size),
            position=self.home,
            filter=CRATE_FILTER,
            user="crate",
            material=Material(CRATE_DENSITY, CRATE_FRICTION),
            continuous="toi",
        )  # without continuous collision, a fall of two tiles would end 5 px deep in the ground

    def slides(self, way):
        """Return whether the crate moved towards `way` (-1 left, 1 right) in the last step."""
        row = self.body.world.bodies[self.body.world.rows(self.body.id)]
        return (row["x"] - row["previous_x"]) * way > SLIDES

    def launch(self):
        """Throw the crate up by a spring, as high as the hero. The crate's mass has no influence."""
        vx, vy = self.body.velocity
        mass = self.body.mass
        self.body.apply_impulse(((SPRING_KEEPS - 1.0) * vx * mass, -(SPRING_SPEED + vy) * mass))

    def go_home(self, moved=(0.0, 0.0)):
        """Move the crate to its start, at rest. moved: (x, y) by which the platform under the start has moved [px]."""
        self.body.move_to((self.home[0] + moved[0], self.home[1] + moved[1]), 0.0)
        self.body.velocity = (0.0, 0.0)
        self.body.angular_velocity = 0.0

    @property
    def box(self):
        """Bounding box (left, top, right, bottom) of the crate in integer pixels."""
        x, y = self.body.position
        c, s = abs(cos(self.body.angle)), abs(sin(self.body.angle))
        half_width, half_height = (c * self.size[0] + s * self.size[1]) / 2, (s * self.size[0] + c * self.size[1]) / 2
        return floor(x - half_width), round(y - half_height), ceil(x + half_width), round(y + half_height)
