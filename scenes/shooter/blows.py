"""Strength of hits: the impulse that each would transfer. It scales damage, sparks, debris and sound."""

from math import hypot


class Blow:
    """An impulse [px3/s] on a body of some mass [px2], with its direction and its ratio to a plain shot's."""

    USUAL = 22000.0  # [px3/s] a shot of the player's, head on
    FASTEST = 140.0  # [px/s] limit for debris

    def __init__(self, x=0.0, y=0.0, mass=1.0):
        self.x, self.y, self.mass = x, y, mass

    @property
    def strength(self):
        """1 for a plain shot, 0.5 at least (a glance) and 2.5 at most (rammed)."""
        return min(max(hypot(self.x, self.y) / self.USUAL, 0.5), 2.5)

    @property
    def kick(self):
        """Velocity [px/s] that it gives to the debris of the body."""
        x, y = self.x / self.mass, self.y / self.mass
        share = min(1.0, self.FASTEST / max(hypot(x, y), 1.0))
        return x * share, y * share


class Blows:
    """The hits of one step by pair of bodies. The scene has no collision response, so speeds and masses give the
    impulse.

    `weights`: masses of bodies that stand for heavier ones (a core for its plane).
    """

    def __init__(self, world, weights=None):
        hits = world.events.hits
        self.mass, self.found = {}, {}
        if not len(hits):
            return
        for side in ("body_a", "body_b"):
            at = world.rows(hits[side])
            self.mass |= dict(zip(world.bodies["id"][at].tolist(), world.bodies["mass"][at].tolist(), strict=True))
        self.mass |= {identity: mass for identity, mass in (weights or {}).items() if identity in self.mass}
        columns = (hits[name].tolist() for name in ("body_a", "body_b", "normal_x", "normal_y", "speed"))
        for a, b, nx, ny, speed in zip(*columns, strict=True):
            both = self.mass[a] + self.mass[b]
            impulse = speed * self.mass[a] * self.mass[b] / both if both > 0.0 else 0.0
            self.found[a, b] = (impulse * nx, impulse * ny)
            self.found[b, a] = (-impulse * nx, -impulse * ny)

    def on(self, identity, *others):
        """Return the Blow that other bodies gave to a body."""
        each = [self.found.get((other, identity), (0.0, 0.0)) for other in others]
        return Blow(sum(x for x, _ in each), sum(y for _, y in each), self.mass.get(identity) or 1.0)


def push(dx, dy):
    """Return the Blow of a bomb, away from its middle: as strong as a plain shot on a light body."""
    far = max(hypot(dx, dy), 1.0)
    return Blow(Blow.USUAL * dx / far, Blow.USUAL * dy / far, Blow.USUAL / 90.0)
