"""What the hero meets: triggers that are picked up or touched, walkers, platforms, crates."""

from math import ceil, cos, floor, pi, sin

from game.loop import STEP_SECONDS
from physics import Character, Material, Polygon
from scenes.platformer.level import CRATE_FILTER, PLATFORM_FILTER, TRIGGER_FILTER, WALKER_FILTER

WALK_SPEED = 36.0            # [px/s] a fifth of the hero's: it can be read and waited for
WALKER_BOX = (16, 13)        # [px] inside the sprite of 20 x 16: its cap's rim does not hurt
CRATE_DENSITY = 0.5          # the large one weighs two and a half heroes: he tips what he stands on
CRATE_FRICTION = 0.3         # the ground's is twice that
SLIDES = 0.1                 # [px] a step that a crate gives way by
COIN_REACH = 2               # [px] around a coin: whoever comes that close meant it
LANTERN_SHINES = 64          # [px] above a checkpoint it is still reached: nobody loses it to a jump
SPRING_INSET = (2, 7)        # [px] the plate lies low in its tile
TRIGGERS = ("coin", "spring", "spikes", "checkpoint", "goal")


class Trigger:
    """A sensor body of the level. `lit`: a checkpoint that was reached; `touched`: the step of the last touch."""

    def __init__(self, world, thing):
        self.kind, self.thing = thing.kind, thing
        left, top, width, height = thing.x, thing.y, thing.width, thing.height
        if self.kind == "coin":
            left, top, width, height = left - COIN_REACH, top - COIN_REACH, width + 2 * COIN_REACH, height + 2 * COIN_REACH
        elif self.kind == "spring":
            left, top, width, height = (left + SPRING_INSET[0], top + SPRING_INSET[1], width - 2 * SPRING_INSET[0],
                                        height - SPRING_INSET[1])
        elif self.kind == "checkpoint":
            top, height = top - LANTERN_SHINES, height + LANTERN_SHINES
        self.x, self.y = left + width / 2, top + height / 2
        self.body = world.add_body(Polygon.box(width, height), position=(self.x, self.y), kind="static", sensor=True,
                                   filter=TRIGGER_FILTER, user=self.kind)
        self.lit = False
        self.touched = None

    @property
    def foot(self):
        """The middle of its lower edge [px]."""
        return self.thing.x + self.thing.width / 2, self.thing.y + self.thing.height


class Walker:
    """Walks to and fro around its home and turns at walls. Not solid: it hurts, or is stomped."""

    def __init__(self, world, thing, way):
        width, height = WALKER_BOX
        self.home = (thing.x + thing.width / 2, thing.y + thing.height - height / 2)
        self.range = float(thing.properties.get("range", 0))
        self.character = Character(world, Polygon.box(width, height), self.home, filter=WALKER_FILTER, user="walker",
                                   push=0.0)        # it turns at crates
        self.way = way

    @property
    def top(self):
        """The upper edge of its box [px]."""
        return self.character.position[1] - WALKER_BOX[1] / 2

    @property
    def bottom(self):
        """The lower edge of its box [px]."""
        return self.character.position[1] + WALKER_BOX[1] / 2

    def step(self):
        """One step of walking."""
        x = self.character.position[0]
        if (x - self.home[0]) * self.way >= self.range:
            self.way = -self.way
        moved = self.character.move(self.way * WALK_SPEED * STEP_SECONDS, 0.0)
        if moved.wall == self.way:
            self.way = -self.way

    def place_after(self, seconds):
        """Where it will be on free ground [px]: it turns at the ends of its range."""
        there = self.character.position[0] + self.way * WALK_SPEED * seconds
        end = self.home[0] + self.way * self.range
        return 2.0 * end - there if (there - end) * self.way > 0.0 else there

    def go_home(self):
        """Stand where the level put it."""
        self.character.move_to(self.home)


class Platform:
    """A kinematic box that swings between two places: slow at the ends, where one steps on and off."""

    def __init__(self, world, thing):
        half_width, half_height = thing.width / 2, thing.height / 2
        there = thing.properties
        self.start = (thing.x + half_width, thing.y + half_height)
        self.end = (there["to_x"] + half_width, there["to_y"] + half_height)
        self.size = (thing.width, thing.height)
        self.period = float(there["period"])
        self.body = world.add_body(Polygon.box(*self.size), position=self.start, kind="kinematic", continuous="off",
                                   filter=PLATFORM_FILTER, user="platform")

    def place_at(self, frame):
        """Where its centre is after so many steps [px]."""
        share = (1.0 - cos(2.0 * pi * frame * STEP_SECONDS / self.period)) / 2.0
        return (self.start[0] + (self.end[0] - self.start[0]) * share,
                self.start[1] + (self.end[1] - self.start[1]) * share)

    def aim(self, frame):
        """Give it the velocity that takes it to its next place in one step: it moves in the world, and so carries."""
        x, y = self.body.position
        next_x, next_y = self.place_at(frame + 1)
        self.body.velocity = ((next_x - x) / STEP_SECONDS, (next_y - y) / STEP_SECONDS)

    @property
    def box(self):
        """Left, top, right, bottom in whole pixels, as characters feel it."""
        x, y = self.body.position
        left, top = int(x - self.size[0] / 2 + 0.5), int(y - self.size[1] / 2 + 0.5)
        return left, top, left + int(self.size[0]), top + int(self.size[1])


class Crate:
    """A body of the physics: it falls, stacks, tips over, is pushed and ridden."""

    def __init__(self, world, thing):
        self.size = (int(thing.width), int(thing.height))
        self.home = (thing.x + thing.width / 2, thing.y + thing.height / 2)
        self.body = world.add_body(Polygon.box(*self.size), position=self.home, filter=CRATE_FILTER, user="crate",
                                   material=Material(CRATE_DENSITY, CRATE_FRICTION),
                                   continuous="toi")         # or a fall of two tiles ends 5 px deep in the ground

    def slides(self, way):
        """Whether it moved that way (-1, 1) in the last step."""
        row = self.body.world.bodies[self.body.world.rows(self.body.id)]
        return (row["x"] - row["previous_x"]) * way > SLIDES

    def go_home(self):
        """Stand where the level put it."""
        self.body.move_to(self.home, 0.0)
        self.body.velocity = (0.0, 0.0)
        self.body.angular_velocity = 0.0

    @property
    def box(self):
        """Left, top, right, bottom in whole pixels around it, however it lies."""
        x, y = self.body.position
        c, s = abs(cos(self.body.angle)), abs(sin(self.body.angle))
        half_width, half_height = (c * self.size[0] + s * self.size[1]) / 2, (s * self.size[0] + c * self.size[1]) / 2
        return floor(x - half_width), round(y - half_height), ceil(x + half_width), round(y + half_height)


class Things:
    """All of them, by kind and by body id."""

    def __init__(self, world, level, random):
        self.world = world
        found = [Trigger(world, thing) for thing in level.map.things if thing.kind in TRIGGERS]
        self.triggers = {trigger.body.id: trigger for trigger in found}
        self.platforms = [Platform(world, thing) for thing in level.map.things_of("platform")]
        self.crates = [Crate(world, thing) for thing in level.map.things_of("crate")]
        # Which way each walker sets out is the one thing that the seed decides.
        walkers = [Walker(world, thing, random.choice((-1, 1))) for thing in level.map.things_of("walker")]
        self.walkers = {walker.character.body.id: walker for walker in walkers}
        self.coins_in_all = len(self.of("coin"))

    def of(self, kind):
        """The triggers of a kind, in the level's order."""
        return [trigger for trigger in self.triggers.values() if trigger.kind == kind]

    @property
    def crate_boxes(self):
        """Boxes of the crates."""
        return tuple(crate.box for crate in self.crates)

    @property
    def platform_boxes(self):
        """Boxes of the platforms."""
        return tuple(platform.box for platform in self.platforms)

    def take(self, trigger):
        """Remove a coin from the world."""
        self.world.remove_body(trigger.body)
        del self.triggers[trigger.body.id]

    def squash(self, identity):
        """Remove a walker from the world."""
        self.walkers.pop(identity).character.remove()

    def go_home(self):
        """A new life: crates and walkers are back where they were; what was taken or squashed is gone."""
        for one in (*self.crates, *self.walkers.values()):
            one.go_home()

    def state(self):
        """What the world does not hold of them."""
        return (*(walker.way for walker in self.walkers.values()),
                *(trigger.lit for trigger in self.of("checkpoint")))
