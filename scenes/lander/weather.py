"""The wind: steady by region, with gusts. These are two slow waves, whose phases the seed chooses."""

from math import pi, sin

PERIODS = (7.3, 4.1)  # [s] of the two waves; together they repeat after minutes
FIRST_SHARE = 0.65
CALMING = 0.04  # share of the change of wind per step


class Weather:
    """The weather. `wind` [px/s] at the ship, to the right, of which `steady` is constant in its region; `gust` 0..1 of
    the strongest.

    The steady part is the world's own wind. A changing world wind keeps all bodies awake, so gusts, which change in
    every step, are forces on the bodies in the air.
    """

    def __init__(self, random, moon):
        self.moon = moon
        self.phases = tuple(random.uniform(0.0, 2.0 * pi) for _ in PERIODS)
        self.wind = self.steady = self.gust = 0.0

    def step(self, seconds, x, y):
        """Compute the wind at a time and place."""
        region, inside = self.moon.wind_at(x), self.moon.is_inside(x, y)
        first, second = (
            sin(2.0 * pi * seconds / period + phase) for period, phase in zip(PERIODS, self.phases, strict=True)
        )
        self.gust = max(FIRST_SHARE * first + (1.0 - FIRST_SHARE) * second, 0.0)
        self.steady = 0.0 if inside else region.steady
        wanted = 0.0 if inside else region.steady + region.gust * self.gust
        self.wind += (wanted - self.wind) * CALMING

    def blow(self, world, *bodies):
        """Set the world's wind, and push bodies by the gust for the next step."""
        if world.effects.wind and world.wind.x != self.steady:
            world.wind = (self.steady, 0.0)
        for body in bodies:
            body.apply_force((body.mass * world.drag * (self.wind - self.steady), 0.0))

    def state(self):
        """Return the state for the replay digest, as a flat tuple."""
        return (*self.phases, self.wind, self.steady, self.gust)
