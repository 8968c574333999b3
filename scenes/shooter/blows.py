"""Strength of hits in the shooter, computed as the impulse that each hit would transfer.

Damage, sparks, debris and sound are proportional to this impulse.
"""

from math import hypot


class Blow:
    """The impulse (x, y) [px3/s] of a hit on a body of mass `mass` [px2]."""

    USUAL = 22000.0  # [px3/s] impulse of a plain shot: the player's, head on
    FASTEST = 140.0  # [px/s] limit for debris

    def __init__(self, x=0.0, y=0.0, mass=1.0):
        self.x, self.y, self.mass = x, y, mass

    @property
    def strength(self):
        """Magnitude of the impulse relative to a plain shot of the player, limited to 0.5 (glancing) ..
        2.5 (ramming).
        """
        return min(max(hypot(self.x, self.y) / self.USUAL, 0.5), 2.5)

    @property
    def kick(self):
        """Velocity (x, y) [px/s] that the impulse gives to the body's debris, at most FASTEST."""
        x, y = self.x / self.mass, self.y / self.mass
        share = min(1.0, self.FASTEST / max(hypot(x, y), 1.0))
        return x * share, y * share


class Blows:
    """The impulses of all hits of one step, by pair of bodies.

    The scene has no collision response, so each impulse is computed from the closing speed and the two masses.
    weights: {body id: mass}, masses to use instead of the bodies' own masses. The player's core gets the mass of the
    whole plane.
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
        """Return the Blow on the body `identity`: the sum of its impulses from the bodies `others` (ids)."""
        each = [self.found.get((other, identity), (0.0, 0.0)) for other in others]
        return Blow(sum(x for x, _ in each), sum(y for _, y in each), self.mass.get(identity) or 1.0)


def push(dx, dy):
    """Return the Blow of a bomb on a plane. It points away from the bomb's centre.

    dx, dy: position of the plane relative to this centre [px]. The blow has the strength of a plain shot at a light
    plane.
    """
    far = max(hypot(dx, dy), 1.0)
    return Blow(Blow.USUAL * dx / far, Blow.USUAL * dy / far, Blow.USUAL / 90.0)
