"""How hard hits were: the impulse that each would have handed on. It scales damage, sparks, debris and sound."""

from math import hypot


class Blow:
    """An impulse [px3/s] on a body of some mass [px2]: where to, and how it compares with a plain shot's."""

    USUAL = 22000.0  # [px3/s] a shot of the player's, straight on
    FASTEST = 140.0  # [px/s] that debris is given

    def __init__(self, x=0.0, y=0.0, mass=1.0):
        self.x, self.y, self.mass = x, y, mass

    @property
    def strength(self):
        """1 for a plain shot, 0.5 at the least (a glance) and 2.5 at the most (rammed)."""
        return min(max(hypot(self.x, self.y) / self.USUAL, 0.5), 2.5)

    @property
    def kick(self):
        """The velocity [px/s] that it gives to what is left of the body."""
        x, y = self.x / self.mass, self.y / self.mass
        share = min(1.0, self.FASTEST / max(hypot(x, y), 1.0))
        return x * share, y * share


class Blows:
    """The hits of one step, looked up by who hit whom. Nothing is pushed in this scene, so speed and masses tell.

    `weights`: masses of bodies that stand for something heavier than themselves (a core for its plane).
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
        """The Blow that a body took from others."""
        each = [self.found.get((other, identity), (0.0, 0.0)) for other in others]
        return Blow(sum(x for x, _ in each), sum(y for _, y in each), self.mass.get(identity) or 1.0)


def push(dx, dy):
    """The Blow of a bomb away from its middle: as hard as a plain shot, on something light."""
    far = max(hypot(dx, dy), 1.0)
    return Blow(Blow.USUAL * dx / far, Blow.USUAL * dy / far, Blow.USUAL / 90.0)
