"""The three enemies: walkers, which can be stomped; hedgehogs, which cannot; bats, which hang and dive.

The hero passes through enemies. The scene reads his contacts with them after the step. A falling crate flattens an
enemy.
"""

from math import cos, pi, sin
from typing import cast

from game.scene import STEP_SECONDS
from physics import Body, Character, Polygon
from scenes.platformer.feel import FALL_SPEED, GRAVITY, approach
from scenes.platformer.level import ENEMY_FILTER, TRIGGER_FILTER

WALK_SPEED = {"walker": 36.0, "hedgehog": 24.0}  # [px/s] at most a fifth of the hero's speed: easy to judge
BOXES = {"walker": (16, 13), "hedgehog": (16, 11), "bat": (14, 9)}  # [px] smaller than the sprites
# Bats
LAIR = (104.0, 150.0)  # [px] to either side and down: a hero in this area wakes the bat
DIVE = 0.75  # [s] from waking to the end of the dive, at the height where the hero was when the bat woke
FLY_SPEED = 84.0  # [px/s] slower than a run, so that the hero can escape
WAVE, WAVE_TIME = 11.0, 0.9  # amplitude [px] and period [s] of the vertical wave of its flight
FLIGHT = 2.6  # [s] from waking until the bat turns back to its start
HOME_SPEED = 120.0  # [px/s] on the way back
HANGING, FLYING, RETURNING = "hanging", "flying", "returning"


class Creature:
    """Base class of enemies: a Character (a kinematic body) with a box shape, which pushes no other bodies."""

    def __init__(self, world, kind, start):
        self.kind, self.size, self.start = kind, BOXES[kind], start
        self.character = Character(world, Polygon.box(*self.size), start, filter=ENEMY_FILTER, user=kind, push=0.0)

    @property
    def body(self):
        """The enemy's body in the world."""
        return self.character.body

    @property
    def top(self):
        """The y of the upper edge of the enemy's box [px]."""
        return self.character.position[1] - self.size[1] / 2

    @property
    def bottom(self):
        """The y of the lower edge of the enemy's box [px]."""
        return self.character.position[1] + self.size[1] / 2


class Walker(Creature):
    """A walker or hedgehog, which walks to and fro and turns at walls and crates.

    home: x of the middle of its range [px], which moves with a platform that carries the enemy.
    """

    def __init__(self, world, thing, way):
        height = BOXES[thing.kind][1]
        super().__init__(world, thing.kind, (thing.x + thing.width / 2, thing.y + thing.height - height / 2))
        self.home = self.start[0]  # x of the middle of its range [px]
        self.range = float(thing.properties.get("range", 0))
        self.way = self.first_way = way
        self.vy = 0.0
        self.left_at = self.character.position[0]  # x [px] after its last own move, before it was carried
        self.squeezed = False
        self.riding = -1  # id of the body under its feet; -1: none

    @property
    def stompable(self):
        """True if the hero can flatten the enemy by jumping on it."""
        return self.kind == "walker"

    def step(self, seen):
        """Walk for one step. Return False, because a walker reports no event, unlike a bat. seen: not used."""
        x, _ = self.character.position
        if self.character.surface_speed == 0.0:
            self.home += x - self.left_at  # a platform moves its range along; a belt moves only the walker
        if (x - self.home) * self.way >= self.range:
            self.way = -self.way
        self.vy = approach(self.vy, FALL_SPEED, GRAVITY * STEP_SECONDS)
        speed = WALK_SPEED[self.kind] if self.range else 0.0
        moved = self.character.move(self.way * speed * STEP_SECONDS, self.vy * STEP_SECONDS)
        self.vy = 0.0 if moved.grounded else self.vy
        if moved.wall == self.way:
            self.way = -self.way
        self.squeezed = moved.squeezed
        carrier = cast(Body | None, moved.riding)
        self.riding = -1 if carrier is None else carrier.id
        self.left_at = self.character.position[0]
        return False

    def rest(self, x):
        """Stand still for one step. Called while the hero is far away. x: the enemy's current x [px]."""
        self.left_at = x

    def place_after(self, seconds):
        """Return the predicted x [px] after `seconds`.

        The walker turns at the ends of its range; obstacles are ignored.
        """
        if not self.range:
            return self.character.position[0]
        there = self.character.position[0] + self.way * WALK_SPEED[self.kind] * seconds
        end = self.home + self.way * self.range
        return 2.0 * end - there if (there - end) * self.way > 0.0 else there

    def go_home(self, moved=(0.0, 0.0)):
        """Move the enemy to its start. moved: (x, y) by which the platform under the start has moved [px]."""
        self.character.move_to((self.start[0] + moved[0], self.start[1] + moved[1]))
        self.home = self.left_at = self.character.position[0]
        self.way, self.vy, self.riding = self.first_way, 0.0, -1

    def remove(self):
        """Remove the walker from the world."""
        self.character.remove()

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return self.way, self.home, self.vy, self.left_at, self.riding


class Bat(Creature):
    """An enemy that hangs until the hero enters its lair, a sensor below it.

    Then it dives to the hero's height, flies on along a wave, and returns to its start.
    """

    stompable = True
    riding = -1
    squeezed = False

    def __init__(self, world, thing):
        super().__init__(world, "bat", (thing.x + thing.width / 2, thing.y + BOXES["bat"][1] / 2 + 1.0))
        self.lair = world.add_body(
            Polygon.box(2 * LAIR[0], LAIR[1]),
            position=(self.start[0], self.start[1] + LAIR[1] / 2),
            kind="static",
            sensor=True,
            filter=TRIGGER_FILTER,
            user="lair",
        )
        self.seen = False  # whether the hero is in its lair
        self._hang()

    def _hang(self):
        self.phase, self.count, self.way, self.from_y, self.to_y = HANGING, 0, 1, 0.0, 0.0

    def step(self, seen):
        """Fly or hang for one step. seen: the hero's position [px]. Return whether the bat wakes up in this step."""
        x, y = self.character.position
        if self.phase == HANGING:
            if self.seen:
                self.phase, self.count = FLYING, 0
                self.way = 1 if seen[0] >= x else -1
                self.from_y, self.to_y = y, max(seen[1], y + 16.0)
            return self.seen
        self.count += 1
        time = self.count * STEP_SECONDS
        if self.phase == FLYING:
            share = (1.0 - cos(pi * min(time / DIVE, 1.0))) / 2.0
            wanted = self.from_y + (self.to_y - self.from_y) * share
            if time > DIVE:
                wanted += WAVE * sin(2.0 * pi * (time - DIVE) / WAVE_TIME)
            moved = self.character.move(self.way * FLY_SPEED * STEP_SECONDS, wanted - y)
            if moved.wall == self.way:
                self.way = -self.way
            if time >= FLIGHT:
                self.phase = RETURNING
        else:
            self._return(x, y)
        return False

    def rest(self, x):
        """Stay in place for one step. Called while the hero is far away. x: not used."""

    def _return(self, x, y):
        """Fly back towards the start (self.start) for one step from (x, y) [px].

        If the bat is blocked on its way, it is moved to the start 3 * FLIGHT seconds after it woke up.
        """
        way = HOME_SPEED * STEP_SECONDS
        dx, dy = self.start[0] - x, self.start[1] - y
        far = max(abs(dx), abs(dy), 1e-9)
        share = min(way / far, 1.0)
        self.way = 1 if dx > 0.0 else -1
        self.character.move(dx * share, dy * share)
        if far <= way + 1.0 or self.count * STEP_SECONDS > 3.0 * FLIGHT:
            self.character.move_to(self.start)
            self._hang()

    def place_after(self, seconds):
        """Return the bat's predicted x [px] after `seconds`. Obstacles are ignored."""
        return self.character.position[0] + (self.way * FLY_SPEED * seconds if self.phase == FLYING else 0.0)

    def go_home(self, moved=(0.0, 0.0)):
        """Move the bat to its start, where it hangs. moved: not used, because bats do not ride platforms."""
        self.seen = False
        self.character.move_to(self.start)
        self._hang()

    def remove(self):
        """Remove the bat and its lair from the world."""
        self.character.remove()
        self.character.world.remove_body(self.lair)

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return self.phase, self.count, self.way, self.from_y, self.to_y, self.seen
