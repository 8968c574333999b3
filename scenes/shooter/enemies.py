"""Three kinds of enemy. Each thinks once per step: a velocity, perhaps a turn, perhaps a volley.

The dart waits, aims and dives at where you are. The saucer weaves down and fires at you. The gunship takes
its place, drifts, and fills the sky with patterns.
"""

from math import atan2, cos, hypot, pi, sin

import numpy as np

from game.sprites import load_atlas
from scenes.shooter.bullets import DOWN, aimed, fan, ring
from scenes.shooter.cast import HOSTILE, WIDTH, steps

ENTRY_Y = -40.0               # [px] all enter from above the picture
APPROACH = 3.2                # [1/s] how quickly a plane closes in on its place
NOTCH = 2 * pi / 64           # [rad] planes are turned in such steps: every other angle at which a mask is drawn
TURNS = 20                    # notches to either side that are drawn before the game starts: darts dive no flatter
EDGE = 40.0                   # [px] from the sides that gunships keep


class Enemy:
    """`frame` names the picture and the mask that collides; `health` in hits of a shot; `home` is its place in the sky.

    A kind adds think(sky): set vx, vy [px/s] and angle for the coming step; `sky` is the scene.
    """

    kind, frame, health, points = "", "", 1, 0

    def __init__(self, identity, home_x, home_y, sway, carries, pace):
        self.id = identity
        self.home_x, self.home_y, self.sway, self.carries = home_x, home_y, sway, carries
        self.health = self.full = round(type(self).health * pace.armour)
        self.x, self.y = home_x, ENTRY_Y
        self.vx = self.vy = self.angle = 0.0
        self.heading = DOWN
        self.age = self.since = self.volleys = 0
        self.mode = "arrive"

    def begin(self, mode):
        """Change what it does."""
        self.mode, self.since = mode, 0

    def approach(self, x, y, most):
        """Fly towards a place, slower as it comes near; `most` [px/s]."""
        far = hypot(x - self.x, y - self.y)
        speed = min(most, APPROACH * far)
        self.vx, self.vy = (0.0, 0.0) if far < 0.5 else (speed * (x - self.x) / far, speed * (y - self.y) / far)
        return far

    def ahead(self, seconds):
        """Where it will be after so many seconds (array), as far as anybody can tell: x and y [px]."""
        return self.x + self.vx * seconds, self.y + self.vy * seconds

    def state(self):
        """For the digest."""
        return (self.id, self.kind, self.health, self.age, self.since, self.volleys, self.mode, self.home_x, self.home_y,
                self.sway, self.carries, self.heading)


class Dart(Enemy):
    """Waits for a moment, turns to you, dives at where you are then."""

    kind, frame, health, points = "dart", "dart_0", 2, 100
    DIVE_SPEED, DIVE_GAIN = 205.0, 190.0      # [px/s], [px/s2]
    AIM_TIME, TURN_RATE = 0.55, 7.0           # [s], [1/s]

    def think(self, sky):
        if self.mode == "arrive":
            if self.approach(self.home_x, self.home_y, 190.0) < 14.0:
                self.begin("aim")
        elif self.mode == "aim":
            self.vx = self.vy = 0.0
            heading = atan2(sky.target[1] - self.y, sky.target[0] - self.x)
            off = (heading - self.heading + pi) % (2 * pi) - pi
            self.heading += off * self.TURN_RATE / 60
            self.angle = round((self.heading - DOWN) / NOTCH) * NOTCH
            if self.since > steps(self.AIM_TIME * sky.pace.patience):
                self.frame = "dart_1"
                self.begin("dive")
                sky.spectacle.dive(self)
        else:
            speed = (self.DIVE_SPEED + self.DIVE_GAIN * self.since / 60) * sky.pace.speed
            self.vx, self.vy = speed * cos(self.heading), speed * sin(self.heading)
            if sky.pace.round and self.since == 12:
                sky.incoming.fire("needle", self.x, self.y, [self.angle + DOWN], 300.0 * sky.pace.speed)


class Saucer(Enemy):
    """Weaves down the sky and fires at you while it is well above you."""

    kind, frame, health, points = "saucer", "saucer_0", 5, 200
    FALL, TURNS = 40.0, 0.36                  # [px/s], swings per second
    BETWEEN, BULLET = 1.8, 118.0              # [s], [px/s]

    def think(self, sky):
        turn = 2 * pi * self.TURNS
        self.vx = self.sway * turn * cos(turn * self.age / 60)
        self.vy = self.FALL * (2.2 if self.y < 10.0 else 1.0)
        due = steps(self.BETWEEN * sky.pace.patience)
        if self.since > due and 8.0 < self.y < sky.target[1] - 70.0:
            self.since = 0
            self.volleys += 1
            count = 1 if sky.pace.round == 0 else 3
            heading = aimed(self.x, self.y + 8.0, sky.target)[0]
            sky.incoming.fire("red", self.x, self.y + 8.0, fan(heading, count, 0.4), self.BULLET * sky.pace.speed)
            sky.spectacle.enemy_fires(self)

    def ahead(self, seconds):
        turn = 2 * pi * self.TURNS
        return (self.x + self.sway * (np.sin(turn * (self.age / 60 + seconds)) - sin(turn * self.age / 60)),
                self.y + self.vy * seconds)


class Gunship(Enemy):
    """Takes its place, drifts from side to side, fires fans and rings by turns; leaves when its time is up."""

    kind, frame, health, points = "gunship", "gunship_0", 55, 1000
    BETWEEN, FIRST = 1.15, 0.6                # [s]
    FAN, RING = 104.0, 82.0                   # [px/s]
    FAN_GAP = 0.31                            # [rad] a plane fits through it from 140 px on
    DRIFT, STAY = 26.0, 16.0                  # [px/s], [s]

    def think(self, sky):
        if self.mode == "arrive":
            if self.approach(self.home_x, self.home_y, 90.0) < 4.0:
                self.begin("fight")
                self.vx = self.DRIFT if self.home_x < WIDTH / 2 else -self.DRIFT
        elif self.mode == "fight":
            self.vy = 5.0 * cos(2 * pi * 0.4 * self.since / 60)
            if (self.x < EDGE and self.vx < 0.0) or (self.x > WIDTH - EDGE and self.vx > 0.0):
                self.vx = -self.vx
            between = steps(self.BETWEEN * sky.pace.patience)
            if self.since % between == steps(self.FIRST) % between:
                self._fire(sky)
            if self.since > steps(self.STAY):
                self.begin("leave")
        else:
            self.vx, self.vy = self.vx * 0.98, max(self.vy - 1.5, -70.0)

    def _fire(self, sky):
        pace = sky.pace
        if self.volleys % 2 == 0:
            heading = aimed(self.x, self.y + 14.0, sky.target)[0]
            count = 5 + pace.extra // 2
            spokes = fan(heading, count, self.FAN_GAP * (count - 1))
            sky.incoming.fire("orange", self.x, self.y + 14.0, spokes, self.FAN * pace.speed)
        else:
            spokes = ring(16 + pace.extra, 0.26 * self.volleys)
            sky.incoming.fire("purple", self.x, self.y, spokes, self.RING * pace.speed)
        self.volleys += 1
        sky.spectacle.enemy_fires(self)


KINDS = {each.kind: each for each in (Dart, Saucer, Gunship)}


class Fleet:
    """All enemies, by body id in the order in which they came."""

    def __init__(self, world, tier):
        self.world, self.tier = world, tier
        self.planes = {}
        self.longest = 0             # steps that any enemy has been in the sky

    def __len__(self):
        return len(self.planes)

    def launch(self, kind, x, hover, sway, carries, pace):
        """Send one plane from above the picture to its place."""
        made = KINDS[kind]
        home = x if kind != "saucer" else min(max(x, abs(sway) + 20), WIDTH - abs(sway) - 20)
        body = self.world.add_body(load_atlas("planes").mask(made.frame), position=(home, ENTRY_Y), kind="kinematic",
                                   filter=HOSTILE, tier=self.tier)
        self.planes[body.id] = made(body.id, home, hover, sway, carries, pace)

    def step(self, sky):
        """Let every plane think, and write what it wants into the world's columns."""
        if not self.planes:
            return
        planes = list(self.planes.values())
        rows, bodies = self.world.rows(list(self.planes)), self.world.bodies
        places = zip(planes, bodies["x"][rows].tolist(), bodies["y"][rows].tolist(), strict=True)
        for plane, plane.x, plane.y in places:
            plane.age += 1
            plane.since += 1
            before = plane.frame
            plane.think(sky)
            self.longest = max(self.longest, plane.age)
            if plane.frame != before:
                dress(self.world, plane.id, plane.frame, self.tier)
        bodies = self.world.bodies
        for column in ("vx", "vy", "angle"):
            bodies[column][rows] = [getattr(plane, column) for plane in planes]

    def forget(self, ids):
        """Drop planes whose bodies are removed."""
        for identity in ids.tolist():
            self.planes.pop(identity, None)


def dress(world, identity, frame, tier):
    """Let a plane collide as the picture it shows now, at the scene's tier."""
    body = world.body(identity)
    body.set_shapes(load_atlas("planes").mask(frame))
    body.tier = tier


def draw_turned():
    """Turn the masks of what turns before the first step, so that no step of the game has to (1.7 ms each, once)."""
    planes, effects = load_atlas("planes"), load_atlas("effects")
    for notch in range(-TURNS, TURNS + 1):
        for frame in ("dart_0", "dart_1"):
            planes.mask(frame).turned(notch * NOTCH)
        effects.mask("bullet_needle").turned(pi + notch * NOTCH)
