"""Two more kinds of enemies: the hornet, which enters from the sides or from below, and the turret on the ground.

Hornets fly along an arc and aim at the player's predicted position. The turret fires slow rows and fans of bullets;
planes fly over it without a collision.
"""

from math import cos, hypot, pi, radians, sin

from scenes.shooter.bullets import DOWN
from scenes.shooter.cast import GROUND_SPEED, GROUNDED, HEIGHT, WIDTH, steps
from scenes.shooter.enemies import Enemy
from scenes.shooter.patterns import aimed, fan, lead

OUT = 26.0  # [px] outside of the picture, where a hornet enters


class Hornet(Enemy):
    """A plane that flies straight, then along an arc of the group's `bend` [deg], then straight again.

    It fires twice, each time at the position that the player will have if the player's velocity stays the same.
    """

    kind, frame, health, points = "hornet", "hornet_0", 3, 150
    SPEED, TURN = 150.0, radians(75.0)  # [px/s], [rad/s]: an arc of 115 px
    STRAIGHT = 0.45  # [s] before the arc begins
    MOMENTS, BULLET = (0.8, 1.7), 150.0  # [s], [px/s]
    CLOSE = 80.0  # [px] within which it does not fire, because the bullet could not be dodged

    def __init__(self, x, y, group, difficulty):
        super().__init__(x, y, group, difficulty)
        headings = {"left": 0.0, "right": pi, "below": -DOWN}
        self.face(headings[group.side])
        # A positive bend turns hornets from either side downwards, and hornets from below to the right.
        self.turn = self.TURN * (-1.0 if group.side == "right" else 1.0) * (1.0 if group.bend >= 0.0 else -1.0)
        self.left = abs(radians(group.bend))  # [rad] of the arc still to fly

    @staticmethod
    def entry(group, share):
        """Return the point (x, y) [px] at which the plane enters.

        share: position down the side, or along the lower edge, 0..1.
        """
        if group.side == "below":
            return WIDTH * share, HEIGHT + OUT
        return (-OUT if group.side == "left" else WIDTH + OUT), HEIGHT * share

    def think(self, sky):
        if self.age > steps(self.STRAIGHT) and self.left > 0.0:
            step = min(abs(self.turn) / 60, self.left)
            self.left -= step
            self.face(self.heading + (step if self.turn > 0.0 else -step))
        self.vx, self.vy = self.SPEED * cos(self.heading), self.SPEED * sin(self.heading)
        if self.age in [steps(moment * sky.difficulty.patience) for moment in self.MOMENTS]:
            self._fire(sky)

    def _fire(self, sky):
        x, y = sky.target
        inside = 0.0 < self.x < WIDTH and 0.0 < self.y < HEIGHT
        if not inside or hypot(x - self.x, y - self.y) < self.CLOSE:
            return
        speed = self.BULLET * sky.difficulty.speed
        heading = lead(self.x, self.y, (x, y), sky.plane.velocity, speed)
        count = 1 + sky.difficulty.extra // 2
        sky.incoming.fire("hollow", self.x, self.y, fan(heading, count, 0.3 * (count - 1)), speed)
        sky.spectacle.enemy_fires(self)

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (*super().state(), self.turn, self.left)


class Turret(Enemy):
    """A gun on the ground. It fires a short row of bullets straight down and a fan at the player alternately."""

    kind, frame, health, points = "turret", "turret_0", 24, 400
    side = GROUNDED
    BETWEEN, FIRST = 1.5, 0.9  # [s]
    WALL, FAN = 70.0, 88.0  # [px/s]
    COUNT, SPACING = 5, 13.0  # bullets in a row; their distance [px]
    SPREAD = 0.34  # [rad] between the bullets of a fan

    def think(self, sky):
        self.vx, self.vy = 0.0, GROUND_SPEED
        if self.since > steps((self.FIRST if not self.volleys else self.BETWEEN) * sky.difficulty.patience):
            if 6.0 < self.y < sky.target[1] - 50.0:
                self._fire(sky)
            self.since = 0

    def _fire(self, sky):
        muzzle = self.y + 12.0
        if self.volleys % 2 == 0:
            for number in range(self.COUNT):
                x = self.x + self.SPACING * (number - (self.COUNT - 1) / 2)
                sky.incoming.fire("big", x, muzzle, (DOWN,), self.WALL * sky.difficulty.speed)
        else:
            count = 3 + sky.difficulty.extra
            heading = aimed(self.x, muzzle, sky.target)
            sky.incoming.fire(
                "orange",
                self.x,
                muzzle,
                fan(heading, count, self.SPREAD * (count - 1)),
                self.FAN * sky.difficulty.speed,
            )
        self.volleys += 1
        sky.spectacle.enemy_fires(self)
