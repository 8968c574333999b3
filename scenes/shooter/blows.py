"""How hard hits were: the impulse that each would have handed on, for what flies about after it."""

from math import hypot


class Blow:
    """An impulse [px3/s] on a body of some mass [px2]: where to, and how it compares with a plain shot's."""

    USUAL = 22000.0              # [px3/s] a shot of the player's, straight on

    def __init__(self, x=0.0, y=0.0, mass=1.0):
        self.x, self.y, self.mass = x, y, mass

    @property
    def strength(self):
        """1 for a plain shot, 0.5 at the least (a glance) and 2.5 at the most (rammed)."""
        return min(max(hypot(self.x, self.y) / self.USUAL, 0.5), 2.5)

    @property
    def kick(self):
        """The velocity [px/s] that it gives to what is left of the body."""
        return self.x / self.mass, self.y / self.mass


class Blows:
    """The hits of one step, looked up by who hit whom. Nothing is pushed in this scene, so speed and masses tell."""

    def __init__(self, world):
        hits = world.events.hits
        rows = [dict(zip(world.bodies["id"][at].tolist(), world.bodies["mass"][at].tolist(), strict=True))
                for at in (world.rows(hits["body_a"]), world.rows(hits["body_b"]))] if len(hits) else [{}, {}]
        self.mass = rows[0] | rows[1]
        self.found = {}
        for a, b, nx, ny, speed in zip(*(hits[name].tolist() for name in ("body_a", "body_b", "normal_x", "normal_y", "speed")),
                                       strict=True):
            both = self.mass[a] + self.mass[b]
            impulse = speed * self.mass[a] * self.mass[b] / both if both > 0.0 else 0.0
            self.found[a, b] = (impulse * nx, impulse * ny)
            self.found[b, a] = (-impulse * nx, -impulse * ny)

    def on(self, identity, *others):
        """The Blow that a body took from others."""
        each = [self.found.get((other, identity), (0.0, 0.0)) for other in others]
        return Blow(sum(x for x, _ in each), sum(y for _, y in each), self.mass.get(identity) or 1.0)
