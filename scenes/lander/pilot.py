"""The lander's bot, which flies from waypoint to waypoint.

The bot computes the thrust from the wanted velocity, and the ship's angle from the thrust. The engine has no throttle:
it is on whenever at least half of its thrust is needed. If ice blocks the path, the bot hovers, turns the ship's nose
to the ice, and fires until the ship fits through.
"""

from math import atan2, hypot, sqrt
from typing import Any

from scenes.lander.feel import DRAG, FUEL, HULL, REACH, SHIP_MASS, THRUST, TURN_LOSS
from scenes.lander.ship import STAND, wrapped

CRUISE, SLOWEST, SINK = 105.0, 26.0, 62.0  # [px/s] speed along the path, at a waypoint, and down to a pad
BRAKING = 26.0  # [px/s2] deceleration that the bot plans with
TOUCH = 15.0  # [px/s] touchdown speed
GAIN = 2.2  # [1/s] acceleration per error of velocity
NEARLY = 0.03  # [rad] error of the angle below which the bot stops turning
LEAN = 0.85  # [rad] greatest lean in flight
NEAR, AT = 34.0, 16.0  # [px] distance at which a waypoint is passed; at which it is reached
STEADY = 16.0  # [px/s] speed below which the bot may begin to aim, or throw the line
AIMED, SLIPPED = 7.0, 24.0  # [px] error of aim below which it fires; drift at which it stops aiming
OVER, UPON = 13.0, 16.0  # [px], [px/s] greatest offset from a pad's middle, and drift, with which it descends
SIDES = (0.0, -9.0, 9.0, -19.0, 19.0)  # [px] sideways offsets of the rays along the path that must be free
LOOKS = 6  # steps between two checks for obstacles
FALLING = 60.0  # [px/s] downward speed at which it stops aiming
LOADED, LOADED_LEAN = 62.0, 0.45  # [px/s], [rad] greatest speed and lean with a load, which swings
OVER_CARGO, ASTRAY = 44.0, 90.0  # [px] height above cargo for the line; cargo farther from its waypoint is ignored
ASIDE, GENTLY = 84.0, 7.0  # [px] height at which it waits until a pad is free; [px/s] speed to set cargo down
ROOM, MOVES = 40.0, 10.0  # [px] distance from the path within which falling rubble blocks it; its least speed [px/s]
STUCK, BACKING = 40, 70  # steps of contact after which the bot backs off; steps of backing off
BACK_OFF = ((24.0, -48.0), (-24.0, -48.0))  # [px/s] velocity away from an obstacle on the left, on the right
WAIT = 22  # steps between two shells


class Pilot:
    """The bot, which flies the ship from waypoint to waypoint.

    act, number: indices of the current act, and of the next waypoint in this act; aiming: whether the bot is about to
    fire.
    """

    def __init__(self):
        self.act = self.number = self.wait = 0
        self.aiming = False
        self.leant = 0  # steps in contact, then steps of backing off
        self.loaded = False  # whether the line carries a load
        self.blocked: Any = None  # point (x, y) of the obstacle in the path, or None

    def keys(self, scene):
        """Return the actions that the bot holds in the next step, a frozenset of names."""
        ship, course = scene.ship, scene.course
        if not ship.here or course.over:
            self.number, self.aiming = 0, False
            return frozenset()
        if self.act != course.act:
            self.act, self.number, self.aiming = course.act, 0, False
        if self._waits(scene):
            return frozenset()
        self.wait = max(self.wait - 1, 0)
        way = scene.moon.flight[self.act]
        while self.number < len(way) and self._passed(scene, way, self.number):
            self.number += 1
        self.loaded = scene.line.load is not None
        if self.number == len(way):
            keys = self._steer(scene, *self._sinking(scene, course.site))
            return keys | {"bomb"} if self._sets_down(scene, course.site) else keys
        if self._is_stuck(scene):
            return self._steer(scene, *BACK_OFF[scene.ship.x < way[self.number].at[0]])
        point = way[self.number]
        if point.take >= 0:
            return self._take(scene, scene.yard.piece(point.take))
        if point.until and self.blocked and (keys := self._shoot(scene, point, *self.blocked)) is not None:
            return keys
        return self._steer(scene, *self._towards(ship, point.at, last=bool(point.until) or self.number == len(way) - 1))

    def _is_stuck(self, scene):
        """Return whether the ship has been in contact for so long that it must back off, for example from rubble."""
        self.leant = self.leant + 1 if scene.ship.touching or self.leant > STUCK else 0
        if self.leant > STUCK + BACKING:
            # After backing off, fly to the previous waypoint again.
            self.leant, self.number = 0, max(self.number - 1, 0)
        return self.leant > STUCK

    def _waits(self, scene):
        """Return whether the ship waits on a pad, either to be refuelled or while the points of a landing are shown."""
        ship, course = scene.ship, scene.course
        if scene.pad_below() is None or not ship.quiet:
            return False
        full = ship.fuel >= FUEL - 1.0 and ship.hull >= HULL - 1.0 and ship.shells >= 10
        return course.mode != "flying" or not full or scene.pad_below() is course.site

    def _passed(self, scene, way, number):
        ship, point = scene.ship, way[number]
        if point.take >= 0:
            piece = scene.yard.piece(point.take)
            return piece is None or scene.line.load is not None or hypot(*(piece.body.position - point.at)) > ASTRAY
        if point.until:
            if not self._is_at(ship, point.at, 2.0 * NEAR):
                return False
            if self.blocked is None or scene.frame % LOOKS == 0:
                self.blocked = obstacle(scene.ground, point.at, point.until)
            return self.blocked is None and self._is_at(ship, point.at, NEAR) and not falls(scene, point)
        return self._is_at(ship, point.at, AT if number == len(way) - 1 else NEAR)

    def _is_at(self, ship, place, near):
        return hypot(place[0] - ship.x, place[1] - ship.y) < near

    # --- wanted velocities -------------------------------------------------------------------------------------------

    def _towards(self, ship, place, last):
        dx, dy = place[0] - ship.x, place[1] - ship.y
        far = max(hypot(dx, dy), 1.0)
        speed = min(CRUISE if not self.loaded else LOADED, sqrt(2.0 * BRAKING * far) + (0.0 if last else SLOWEST))
        if last:
            speed = min(speed, 1.6 * far)
        return speed * dx / far, speed * dy / far

    def _sinking(self, scene, pad):
        ship, load = scene.ship, scene.line.load
        dx, high = pad.x - ship.x, max(pad.y - STAND - ship.y, 0.0)
        if load is not None:
            high = max(pad.y - load.bounds[3], 0.0)
        elif any(piece.over is pad for piece in scene.yard.cargo.values()):
            # Cargo has just been set down on the pad and will soon be gone.
            return 0.7 * dx, pad.y - ASIDE - ship.y
        wanted_x = max(-40.0, min(dx * 0.9, 40.0))
        if (abs(dx) > OVER or abs(ship.vx) > UPON) and high > 14.0:
            # Not above the pad yet: keep the height.
            return wanted_x, max(-30.0, min((high - 60.0) * 0.8, 24.0))
        return wanted_x * 0.6, min(SINK, max(sqrt(2.0 * 0.5 * BRAKING * high), TOUCH))

    # --- cargo -------------------------------------------------------------------------------------------------------

    def _take(self, scene, piece):
        """Return the keys to pick up a piece of cargo, a frozenset: slow down above it, then catch it with the line."""
        ship = scene.ship
        x, y = piece.body.position
        keys = self._steer(scene, *self._towards(ship, (x, y - OVER_CARGO), last=True))
        near = self._is_at(ship, (x, y), REACH - 6.0) and ship.speed < STEADY
        if not near or self.wait:
            return keys
        self.wait = WAIT
        return keys | {"bomb"}

    def _sets_down(self, scene, pad):
        """Return whether to release the cargo in this step, because it is at rest on the pad."""
        load = scene.line.load
        if load is None or self.wait or pad.y - load.bounds[3] > 2.0 or load.velocity.length > GENTLY:
            return False
        self.wait = WAIT
        return True

    # --- keys --------------------------------------------------------------------------------------------------------

    def _steer(self, scene, wanted_x, wanted_y):
        """Return the keys that steer the ship towards the velocity (wanted_x, wanted_y) [px/s], a frozenset."""
        ship = scene.ship
        heavy = 1.0 if scene.line.load is None else 1.0 + scene.line.load.mass / SHIP_MASS
        push_x = GAIN * (wanted_x - ship.vx) + DRAG * (ship.vx - scene.weather.wind)
        push_y = GAIN * (wanted_y - ship.vy) + DRAG * ship.vy - scene.world.gravity[1]
        lean = atan2(push_x, max(-push_y, 12.0))
        most = LEAN if not self.loaded else LOADED_LEAN
        keys = self._turn(ship, max(-most, min(lean, most)))
        x, y = ship.nose
        if (push_x * x + push_y * y) * heavy > 0.5 * THRUST:
            keys.add("up")
        return frozenset(keys)

    def _turn(self, ship, wanted):
        spin = ship.body.angular_velocity
        off = wrapped(wanted - ship.angle) - spin * abs(spin) / (2.0 * TURN_LOSS)
        return {"right"} if off > NEARLY else {"left"} if off < -NEARLY else set()

    def _shoot(self, scene, point, x, y):
        """Return the keys to aim at an obstacle at (x, y) [px] and fire, a frozenset.

        Return None if the ship must first slow down or fly back to the waypoint `point`.
        """
        ship = scene.ship
        if not self.aiming:
            slow = ship.speed < STEADY
            self.aiming = slow and self._is_at(ship, point.at, AT) and ship.shells > 0
        elif not self._is_at(ship, point.at, SLIPPED) or ship.vy > FALLING or ship.shells == 0:
            self.aiming = False
        if not self.aiming:
            return None
        wanted = atan2(x - ship.x, ship.y - y)
        keys = self._turn(ship, wanted)
        if abs(ship.angle) < LEAN and ship.vy > point.at[1] - ship.y:
            # The ship is upright enough for its engine to keep the height.
            keys.add("up")
        if abs(wrapped(wanted - ship.angle)) * hypot(x - ship.x, y - ship.y) < AIMED and not self.wait:
            self.wait = WAIT
            keys.add("fire")
        return frozenset(keys)


def falls(scene, point):
    """Return whether rubble is falling near the path from the waypoint `point` on, so that the bot must wait."""
    (x, y), (end_x, end_y) = point.at, point.until
    left, right = min(x, end_x) - ROOM, max(x, end_x) + ROOM
    return any(
        left < body.center.x < right and end_y - ROOM < body.center.y < y + ROOM and body.velocity.y > MOVES
        for body in scene.yard.rubble.bodies()
    )


def obstacle(ground, start, end):
    """Return the first point (x, y) [px] at which a ship on the straight path from `start` to `end` touches ground.

    Return None if the path is free.
    """
    dx, dy = end[0] - start[0], end[1] - start[1]
    far = hypot(dx, dy)
    dx, dy = dx / far, dy / far
    found = []
    for side in SIDES:
        x, y = start[0] - side * dy, start[1] + side * dx
        clear = ground.clear_way(x, y, dx, dy, far)
        if clear < far:
            found.append((clear, abs(side), x + dx * clear, y + dy * clear))
    return min(found)[2:] if found else None
