"""The wind of the lander: a steady part for each region, and gusts.

The strength of the gusts is the sum of two slow waves with random phases.
"""

from math import pi, sin

PERIODS = (7.3, 4.1)  # [s] periods of the two waves; their sum repeats after minutes
FIRST_SHARE = 0.65
CALMING = 0.04  # share of its distance from the wanted wind by which the wind changes per step


class Weather:
    """The weather at the ship.

    wind: current wind, positive to the right [px/s]; gust: strength of the gust, 0..1; steady: constant part of the
    wind in this region [px/s]. Only the steady part is the world's wind. Gusts act as forces on the bodies in the air,
    because a world wind that changes in every step would keep all bodies awake.
    """

    def __init__(self, random, moon):
        self.moon = moon
        self.phases = tuple(random.uniform(0.0, 2.0 * pi) for _ in PERIODS)
        self.wind = self.steady = self.gust = 0.0

    def step(self, seconds, x, y):
        """Compute the wind at the time `seconds` [s] and the position (x, y) [px]."""
        region, inside = self.moon.wind_at(x), self.moon.is_inside(x, y)
        first, second = (
            sin(2.0 * pi * seconds / period + phase) for period, phase in zip(PERIODS, self.phases, strict=True)
        )
        self.gust = max(FIRST_SHARE * first + (1.0 - FIRST_SHARE) * second, 0.0)
        self.steady = 0.0 if inside else region.steady
        wanted = 0.0 if inside else region.steady + region.gust * self.gust
        self.wind += (wanted - self.wind) * CALMING

    def blow(self, world, *bodies):
        """Set the world's steady wind, and apply the force of the gust to `bodies`, for the next step."""
        if world.effects.wind and world.wind.x != self.steady:
            world.wind = (self.steady, 0.0)
        for body in bodies:
            body.apply_force((body.mass * world.drag * (self.wind - self.steady), 0.0))

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (*self.phases, self.wind, self.steady, self.gust)
