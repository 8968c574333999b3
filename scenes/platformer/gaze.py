"""Camera control of the platformer: the camera looks ahead of a run and ignores small jumps.

While the key up or down is held, the camera looks up or down. The view stays inside the level's zone in which the hero
is.
"""

from math import exp

from game.drawing.canvas import CANVAS_SIZE
from scenes.platformer.feel import RUN_SPEED

AHEAD = 64.0  # [px] look ahead in the direction of a run
STANDING_AHEAD = AHEAD * 0.35  # [px] look ahead in the direction that the hero faces while he stands
AHEAD_RATE = 1.8  # [1/s] slow, so that a step back does not swing the picture
FOLLOW_RATE = 6.5  # [1/s]
RUNNING = 60.0  # [px/s] above this speed the camera looks in the direction of motion, below it where the hero faces
DEAD_ZONE = (6.0, 10.0)  # [px] small moves leave the picture still
RAISED = 46.0  # [px] the hero stands below the middle: there is more to see above
JUMP_ROOM = 58.0  # [px] a jump of this height does not lift the camera; its landing does
PEEK, PEEK_AFTER = 62.0, 24  # [px] shift of the view after up or down was held on the ground for so many steps


class Gaze:
    """Controller of the platformer's camera."""

    def __init__(self, scene):
        self.scene = scene
        self.ahead = STANDING_AHEAD
        self.level_y = scene.hero.character.position[1]
        self.peeking = 0  # steps of looking up or down
        scene.camera.keep_within(0, 0, *scene.level.size)

    def arrive(self, x, y):
        """Centre the camera at once on the hero at (x, y) [px]. Called at the start of a life."""
        self.level_y, self.ahead, self.peeking = y, STANDING_AHEAD, 0
        self.scene.camera.center_on(*self._kept(x + self.ahead, y - RAISED))

    def step(self, dt):
        """Move the camera towards the hero for a step of `dt` [s]."""
        scene, hero = self.scene, self.scene.hero
        x, y = hero.character.position
        wanted = AHEAD * hero.vx / RUN_SPEED if abs(hero.vx) > RUNNING else STANDING_AHEAD * hero.facing
        self.ahead += (max(-AHEAD, min(AHEAD, wanted)) - self.ahead) * (1.0 - exp(-AHEAD_RATE * dt))
        if hero.grounded or hero.sliding or hero.ladder is not None:
            self.level_y = y
        self.level_y = max(min(self.level_y, y + JUMP_ROOM), y)  # a fall below this height is followed at once
        self.peeking = self.peeking + 1 if hero.gazing else 0
        peek = PEEK * hero.gazing if self.peeking > PEEK_AFTER else 0.0
        scene.camera.follow(*self._kept(x + self.ahead, self.level_y - RAISED + peek), dt, FOLLOW_RATE, DEAD_ZONE)

    def _kept(self, x, y):
        """Return the view's centre (x, y) [px], shifted if necessary to keep the view inside the hero's zone.

        A zone that is smaller than the view sets no limit in that direction.
        """
        zones = self.scene.level.zones_at(*self.scene.hero.character.position)
        width, height = CANVAS_SIZE
        wide = next((zone for zone in zones if zone.width >= width), None)
        if wide is not None:
            x = min(max(x, wide.x + width / 2), wide.x + wide.width - width / 2)
        high = next((rows for rows in map(rows_of, zones) if rows[1] - rows[0] >= height), None)
        if high is not None:
            y = min(max(y, high[0] + height / 2), high[1] - height / 2)
        return x, y


def rows_of(zone):
    """Return (top, bottom), the y [px] of the view's upper and lower limit in a zone of the level.

    They are the zone's properties "view_top" and "view_bottom", or the zone's edges if these are missing.
    """
    return zone.properties.get("view_top", zone.y), zone.properties.get("view_bottom", zone.y + zone.height)
