"""Fire of the bosses: functions that compute the headings of bullets, and the class Gun.

A Gun fires one Pattern of a stage file. The patterns "aimed", "lead" and "fan" target the player; "ring", "spiral" and
"wall" fill the whole picture. All bullets of a "stream" follow the heading of the first one.
"""

from math import atan2, hypot, pi, radians, sin

from scenes.shooter.bullets import DOWN
from scenes.shooter.cast import WIDTH, steps

WALL_Y = -8.0  # [px] y at which a wall of bullets starts
WALL_EDGE = 30.0  # [px] least distance of the middle of its gap from the sides


def aimed(x, y, target):
    """Return the heading [rad] from (x, y) [px] to the point `target` (x, y)."""
    return atan2(target[1] - y, target[0] - x)


def lead(x, y, target, velocity, speed):
    """Return the heading [rad] at which a bullet from (x, y) [px] hits a target that keeps its velocity.

    target: position (x, y) of the target [px]; velocity: velocity of the target [px/s]; speed: speed of the bullet
    [px/s].
    """
    ahead = 0.0
    for _ in range(3):  # each round halves the error at least, because targets are slower than bullets
        ahead_x, ahead_y = target[0] + velocity[0] * ahead, target[1] + velocity[1] * ahead
        ahead = hypot(ahead_x - x, ahead_y - y) / speed
    return atan2(ahead_y - y, ahead_x - x)


def fan(heading, count, spread):
    """Return a list of `count` headings [rad], evenly spaced around `heading`. spread: angle from first to
    last [rad].
    """
    if count == 1:
        return [heading]
    return [heading + spread * (number / (count - 1) - 0.5) for number in range(count)]


def ring(count, turn=0.0):
    """Return a list of `count` headings [rad], evenly spaced over the full circle. turn: the first heading [rad]."""
    return [turn + 2 * pi * number / count for number in range(count)]


def wall(spacing, middle, gap, width=WIDTH):
    """Return a list of the x [px] of the bullets in a row that crosses the picture and has a gap.

    spacing: distance between bullets [px]; middle, gap: centre and width of the gap [px]; width: width of the row
    [px].
    """
    count = int(width / spacing) + 1
    edge = (width - (count - 1) * spacing) / 2
    places = [edge + spacing * number for number in range(count)]
    return [x for x in places if abs(x - middle) > gap / 2]


class Gun:
    """A gun that fires a Pattern, with the state of its fire, such as the time until the next shot."""

    def __init__(self, pattern):
        self.pattern = pattern
        self.wait = max(steps(pattern.after), 1)  # steps until the next shot
        self.fired = 0  # shots so far
        self.age = 0  # steps
        self.held = DOWN  # heading of the current stream [rad]
        self.middle = WIDTH / 2  # x of the middle of the last wall's gap [px]

    def step(self, sky, x, y):
        """Make one step, and fire if a shot is due. Return whether the gun has fired.

        sky: the scene; x, y: centre of the plane that carries the gun [px].
        """
        self.age += 1
        self.wait -= 1
        if self.wait > 0:
            return False
        pattern = self.pattern
        shot = self.fired % pattern.shots
        speed = pattern.speed + pattern.faster * shot
        if pattern.shoot == "wall":
            self._fire_wall(sky, speed)
        else:
            for dx, dy in pattern.muzzles:
                headings = self._headings(sky, x + dx, y + dy, shot, speed)
                sky.incoming.fire(pattern.bullet, x + dx, y + dy, headings, speed, pattern.out)
        self.fired += 1
        # The times since the start are rounded, not each interval, so that a fractional rate is exact on average.
        rest = pattern.rest if shot + 1 == pattern.shots else 0.0
        self.wait = max(steps(pattern.every * (self.fired + 1)) - steps(pattern.every * self.fired) + steps(rest), 1)
        return True

    def _headings(self, sky, x, y, shot, speed):
        pattern = self.pattern
        turned = radians(pattern.turn) * self.fired
        if pattern.shoot == "aimed":
            return [aimed(x, y, sky.target)]
        if pattern.shoot == "lead":
            return fan(lead(x, y, sky.target, sky.plane.velocity, speed), pattern.count, radians(pattern.spread))
        if pattern.shoot == "fan":
            heading = aimed(x, y, sky.target) if pattern.heading is None else radians(pattern.heading)
            return fan(heading, pattern.count, radians(pattern.spread))
        if pattern.shoot == "stream":
            if shot == 0:
                self.held = aimed(x, y, sky.target)
            return [self.held + radians(pattern.turn) * shot]
        if pattern.shoot == "spiral":
            turned += radians(pattern.sway) * sin(2 * pi * self.age / 60 / pattern.period)
        return ring(pattern.count, DOWN + turned)

    def _fire_wall(self, sky, speed):
        pattern = self.pattern
        step = sky.random.uniform(-pattern.shift, pattern.shift)
        self.middle = min(max(self.middle + step, WALL_EDGE), WIDTH - WALL_EDGE)
        for x in wall(pattern.spacing, self.middle, pattern.gap):
            sky.incoming.fire(pattern.bullet, x, WALL_Y, (DOWN,), speed)

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return self.wait, self.fired, self.age, self.held, self.middle
