"""Base class of enemy planes, and the three kinds that enter from above: dart, saucer, gunship.

The dart hovers, aims, and dives at the player. The saucer weaves down and fires at the player. The gunship flies to
its home position, drifts there, and fires fans and rings of bullets. Each kind sets its velocity and angle, and may
fire, in every step.
"""

from math import atan2, cos, hypot, pi, sin

import numpy as np

from scenes.shooter.bullets import DOWN
from scenes.shooter.cast import HOSTILE, WIDTH, steps
from scenes.shooter.patterns import aimed, fan, ring

ENTRY_Y = -40.0  # [px] above the picture
APPROACH = 3.2  # [1/s] rate at which a plane approaches its place
NOTCH = 2 * pi / 64  # [rad] step of the planes' angles: every other angle of the rotated masks
EDGE = 40.0  # [px] distance that gunships keep from the sides


class Enemy:
    """An enemy plane.

    frame: name of its picture, whose mask is its shape; side: its collision filter; health: number of plain shots that
    it withstands. A subclass defines think(sky), which sets vx, vy [px/s] and angle for the next step, and fires. sky:
    the scene.
    """

    kind, frame, health, points = "", "", 1, 0
    side = HOSTILE
    heavy = False  # smokes when damaged, shows its health, and survives ramming the player
    leads = False  # a mid-boss or a boss

    def __init__(self, x, y, group, difficulty):
        self.id = -1  # body id; -1 before the launch
        self.x, self.y = x, y
        self.home_x, self.home_y = x, group.hover
        self.sway, self.bend = group.sway, group.bend
        self.carries, self.wave = "", 0
        self.health = self.full = type(self).health * difficulty.armour
        self.vx = self.vy = self.angle = 0.0
        self.heading = DOWN
        self.age = self.since = self.volleys = 0
        self.met = 0  # bits: parts of the player that it has touched (GRAZED ... CORED of bullets.py)
        self.mode = "arrive"

    @staticmethod
    def entry(group, share):
        """Return the point (x, y) [px] at which a plane of the group enters.

        share: position along the upper edge, 0..1. Kinds that enter elsewhere override this method.
        """
        return WIDTH * share, ENTRY_Y

    def begin(self, mode):
        """Start a mode of behaviour ("arrive", "fight", ...), and set `since`, the time in this mode, to 0."""
        self.mode, self.since = mode, 0

    def approach(self, x, y, most):
        """Set the velocity towards (x, y) [px], which decreases near this point. Return the remaining distance [px].

        most: greatest speed [px/s].
        """
        far = hypot(x - self.x, y - self.y)
        speed = min(most, APPROACH * far)
        self.vx, self.vy = (0.0, 0.0) if far < 0.5 else (speed * (x - self.x) / far, speed * (y - self.y) / far)
        return far

    def face(self, heading):
        """Rotate the plane, with its picture and mask, to a heading [rad]. The angle is rounded to a multiple of
        NOTCH.
        """
        self.heading = heading
        self.angle = round((heading - DOWN) / NOTCH) * NOTCH

    def ahead(self, seconds):
        """Return the position (x, y) [px] of the plane after `seconds`, a number or an array, at its
        current velocity.
        """
        return self.x + self.vx * seconds, self.y + self.vy * seconds

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (
            self.id,
            self.kind,
            self.health,
            self.age,
            self.since,
            self.volleys,
            self.mode,
            self.home_x,
            self.home_y,
            self.sway,
            self.bend,
            self.carries,
            self.wave,
            self.met,
            self.heading,
        )


class Dart(Enemy):
    """A plane that stops, turns towards the player for a moment, and then dives in the direction it faces."""

    kind, frame, health, points = "dart", "dart_0", 3, 100
    DIVE_SPEED, DIVE_GAIN = 205.0, 190.0  # [px/s], [px/s2]
    AIM_TIME, TURN_RATE = 0.55, 7.0  # [s], [1/s]
    NEEDLE = 280.0  # [px/s]

    def think(self, sky):
        if self.mode == "arrive":
            if self.approach(self.home_x, self.home_y, 190.0) < 14.0:
                self.begin("aim")
        elif self.mode == "aim":
            self.vx = self.vy = 0.0
            heading = atan2(sky.target[1] - self.y, sky.target[0] - self.x)
            off = (heading - self.heading + pi) % (2 * pi) - pi
            self.face(self.heading + off * self.TURN_RATE / 60)
            if self.since > steps(self.AIM_TIME * sky.difficulty.patience):
                self.frame = "dart_1"
                self.begin("dive")
                sky.spectacle.dive(self)
        else:
            speed = (self.DIVE_SPEED + self.DIVE_GAIN * self.since / 60) * sky.difficulty.speed
            self.vx, self.vy = speed * cos(self.heading), speed * sin(self.heading)
            if sky.difficulty.extra and self.since == 10:
                sky.incoming.fire("needle", self.x, self.y, [self.angle + DOWN], self.NEEDLE * sky.difficulty.speed)


class Saucer(Enemy):
    """A plane that weaves down the picture. It fires at the player while it is well above the player."""

    kind, frame, health, points = "saucer", "saucer_0", 8, 200
    FALL, TURNS = 40.0, 0.36  # [px/s], swings per second
    BETWEEN, BULLET = 1.6, 112.0  # [s], [px/s]
    SPREAD = 0.26  # [rad] between the bullets of a volley

    @staticmethod
    def entry(group, share):
        """Return the point (x, y) [px] at which the plane enters the upper edge. share: position along this edge,
        0..1.

        The point is far enough from the sides for the plane to weave.
        """
        room = abs(group.sway) + 20.0
        return min(max(WIDTH * share, room), WIDTH - room), ENTRY_Y

    def think(self, sky):
        turn = 2 * pi * self.TURNS
        self.vx = self.sway * turn * cos(turn * self.age / 60)
        self.vy = self.FALL * (2.2 if self.y < 10.0 else 1.0)
        due = steps(self.BETWEEN * sky.difficulty.patience)
        if self.since > due and 8.0 < self.y < sky.target[1] - 70.0:
            self.since = 0
            self.volleys += 1
            count = 1 + sky.difficulty.extra
            heading = aimed(self.x, self.y + 8.0, sky.target)
            sky.incoming.fire(
                "red",
                self.x,
                self.y + 8.0,
                fan(heading, count, self.SPREAD * (count - 1)),
                self.BULLET * sky.difficulty.speed,
            )
            sky.spectacle.enemy_fires(self)

    def ahead(self, seconds):
        turn = 2 * pi * self.TURNS
        return (
            self.x + self.sway * (np.sin(turn * (self.age / 60 + seconds)) - sin(turn * self.age / 60)),
            self.y + self.vy * seconds,
        )


class Gunship(Enemy):
    """A plane that flies to its home position and drifts from side to side. It fires fans and rings alternately, then
    leaves.
    """

    kind, frame, health, points = "gunship", "gunship_0", 90, 1000
    heavy = True
    BETWEEN, FIRST = 1.15, 0.6  # [s]
    FAN, RING = 104.0, 82.0  # [px/s]
    FAN_GAP = 0.31  # [rad] a plane fits through the gap from 140 px on
    DRIFT, STAY = 26.0, 16.0  # [px/s], [s]

    def think(self, sky):
        if self.mode == "arrive":
            if self.approach(self.home_x, self.home_y, 90.0) < 4.0:
                self.begin("fight")
                self.vx = self.DRIFT if self.home_x < WIDTH / 2 else -self.DRIFT
        elif self.mode == "fight":
            self.vy = 5.0 * cos(2 * pi * 0.4 * self.since / 60)
            if (self.x < EDGE and self.vx < 0.0) or (self.x > WIDTH - EDGE and self.vx > 0.0):
                self.vx = -self.vx
            between = steps(self.BETWEEN * sky.difficulty.patience)
            if self.since % between == steps(self.FIRST) % between:
                self._fire(sky)
            if self.since > steps(self.STAY):
                self.begin("leave")
        else:
            self.vx, self.vy = self.vx * 0.98, max(self.vy - 1.5, -70.0)

    def _fire(self, sky):
        difficulty = sky.difficulty
        if self.volleys % 2 == 0:
            heading = aimed(self.x, self.y + 14.0, sky.target)
            count = 5 + 2 * (difficulty.extra // 2)
            spokes = fan(heading, count, self.FAN_GAP * (count - 1))
            sky.incoming.fire("orange", self.x, self.y + 14.0, spokes, self.FAN * difficulty.speed)
        else:
            spokes = ring(16 + 2 * difficulty.extra, 0.26 * self.volleys)
            sky.incoming.fire("purple", self.x, self.y, spokes, self.RING * difficulty.speed)
        self.volleys += 1
        sky.spectacle.enemy_fires(self)
