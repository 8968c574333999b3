"""Camera control of the lander: the camera follows the ship and looks ahead in the ship's direction of motion."""

from game.drawing.canvas import CANVAS_SIZE

AHEAD_X, AHEAD_Y = 0.55, 0.45  # [s] the camera looks ahead by the ship's motion in this time
MOST_X, MOST_Y = 96.0, 62.0  # [px] greatest look ahead
BELOW = 14.0  # [px] distance of the picture's centre below the ship
EASE, RATE = 2.6, 7.0  # [1/s] rates at which the look ahead, and the camera, approach their targets
TOP = -150.0  # [px] the highest visible point


class Gaze:
    """Controller of the lander's camera."""

    def __init__(self, camera, ship, moon):
        self.camera, self.ship = camera, ship
        self.ahead_x = self.ahead_y = 0.0
        camera.keep_within(0.0, TOP, moon.width, moon.height)
        camera.center_on(ship.x, ship.y + BELOW)

    def step(self, dt):
        """Move the camera for one step of `dt` [s]."""
        ship = self.ship
        if ship.here:
            share = min(EASE * dt, 1.0)
            self.ahead_x += (limited(ship.vx * AHEAD_X, MOST_X) - self.ahead_x) * share
            self.ahead_y += (limited(ship.vy * AHEAD_Y, MOST_Y) - self.ahead_y) * share
        self.camera.follow(ship.x + self.ahead_x, ship.y + self.ahead_y + BELOW, dt, RATE)


def limited(value, most):
    """Return the value, clamped to the range -most .. most."""
    return max(-most, min(value, most))


def sees(camera, x, y, margin):
    """Return whether the world point (x, y) [px] is in the picture, or at most `margin` px outside it."""
    return -margin < x - camera.x < CANVAS_SIZE[0] + margin and -margin < y - camera.y < CANVAS_SIZE[1] + margin
