"""What holds after every step of every scene (hard_cases section 1): a watcher that steps a world and looks.

Imports nothing from physics: it reads the tables alone.
"""

import math

import numpy as np

CONTACT_NUMBERS = ("point_x", "point_y", "normal_x", "normal_y", "separation", "normal_impulse", "tangent_impulse")
BODY_NUMBERS = ("x", "y", "angle", "vx", "vy", "angular_velocity", "center_x", "center_y", "mass", "inertia")
DYNAMIC = 2


def deepest(world):
    """How far the deepest contact overlaps [px], sensors aside."""
    contacts = world.contacts
    solid = contacts["separation"]
    return max(0.0, -float(solid.min())) if len(solid) else 0.0


def movers(world):
    """The rows of the dynamic bodies."""
    return world.bodies[world.bodies["kind"] == DYNAMIC]


def kinetic(world):
    """Kinetic energy of the dynamic bodies."""
    rows = movers(world)
    return float(
        0.5
        * (rows["mass"] * (rows["vx"] ** 2 + rows["vy"] ** 2) + rows["inertia"] * rows["angular_velocity"] ** 2).sum()
    )


def energy(world):
    """Kinetic energy and the energy of height of the dynamic bodies."""
    rows, (gx, gy) = movers(world), world.gravity
    return kinetic(world) - float(
        (rows["mass"] * rows["gravity_scale"] * (gx * rows["center_x"] + gy * rows["center_y"])).sum()
    )


def momentum(world):
    """(x, y) momentum of the dynamic bodies."""
    rows = movers(world)
    return np.array([(rows["mass"] * rows["vx"]).sum(), (rows["mass"] * rows["vy"]).sum()])


def spin(world):
    """Angular momentum of the dynamic bodies about the origin of the world."""
    rows = movers(world)
    return float(
        (
            rows["mass"] * (rows["center_x"] * rows["vy"] - rows["center_y"] * rows["vx"])
            + rows["inertia"] * rows["angular_velocity"]
        ).sum()
    )


def rms_speed(world):
    """Root mean square speed of the dynamic bodies [px/s]."""
    rows = movers(world)
    return math.sqrt(float((rows["vx"] ** 2 + rows["vy"] ** 2).mean())) if len(rows) else 0.0


class Watch:
    """Steps a world and asserts the invariants after every step.

    passive: nothing adds energy, so it never rises above the start (U5); isolated: nothing outside pushes, so momentum
    stays (U3); depth: the deepest overlap allowed after every step [px]; capped: whether a cap may be hit (U11).
    """

    def __init__(self, world, passive=False, isolated=False, depth=math.inf, capped=False):
        self.world, self.passive, self.isolated, self.depth, self.capped = world, passive, isolated, depth, capped
        self.steps = 0
        self.known = len(world.bodies)
        self.start_energy = self.top_energy = energy(world)
        self.start_momentum = momentum(world)
        rows = movers(world)
        self.momentum_scale = float((rows["mass"] * np.hypot(rows["vx"], rows["vy"])).sum())
        self.fall = float(rows["mass"].sum()) * math.hypot(*world.gravity)
        self.low, self.high = self._heights()
        self.deepest = self.fastest = 0.0

    def _heights(self):
        rows, (gx, gy) = movers(self.world), self.world.gravity
        heights = gx * rows["center_x"] + gy * rows["center_y"]
        return (float(heights.min()), float(heights.max())) if len(rows) else (0.0, 0.0)

    def step(self, steps=1, dt=None, each=None):
        """Step so many times; each(): called after every step and its checks."""
        for _ in range(steps):
            self.world.step(dt)
            self.steps += 1
            self.check()
            if each is not None:
                each()
        return self

    def check(self):
        """Assert what holds after any step."""
        world = self.world
        where = f"step {self.steps}"
        self._finite(where)
        for rows in (world.contacts, world.events.begin, world.events.hits):
            off = np.abs(rows["normal_x"] ** 2 + rows["normal_y"] ** 2 - 1.0)
            assert not len(off) or off.max() <= 2e-12, f"{where}: a normal of length 1 {off.max():+g}"
        assert (world.contacts["normal_impulse"] >= 0.0).all(), f"{where}: a contact pulls"
        assert len(world.events.quarantined) == 0, f"{where}: {world.events.quarantined}"
        if not self.capped:
            assert world.profile.counters["cap_hits"] == 0, f"{where}: a cap was hit"
        self.deepest = max(self.deepest, deepest(world))
        assert self.deepest <= self.depth, f"{where}: overlap {self.deepest:g} of {self.depth:g}"
        rows = movers(world)
        if len(rows):
            self.fastest = max(self.fastest, float(np.hypot(rows["vx"], rows["vy"]).max()))
        if self.passive:
            self._no_gain(where)
        if self.isolated:
            drift = np.abs(momentum(world) - self.start_momentum).max()
            assert drift <= 1e-10 * self.momentum_scale + 1e-300, f"{where}: momentum drifts by {drift:g}"

    def _finite(self, where):
        world = self.world
        tables = [
            (world.bodies, BODY_NUMBERS),
            (world.contacts, CONTACT_NUMBERS),
            (world.shapes, ("min_x", "min_y", "max_x", "max_y")),
            (world.events.begin, CONTACT_NUMBERS[:4]),
            (world.events.end, CONTACT_NUMBERS[:4]),
            (world.events.hits, CONTACT_NUMBERS[:4] + ("speed", "normal_impulse")),
        ]
        for rows, names in tables:
            for name in names:
                assert np.isfinite(rows[name]).all(), f"{where}: {name} is not finite"

    def _no_gain(self, where):
        """U5: never above the start by 1 % of the energy in play and m g slop per body.

        A body that is stopped on its way keeps the speed it would have had at the end of it: m g v dt for those.
        """
        low, high = self._heights()
        self.low, self.high = min(self.low, low), max(self.high, high)
        rows, now = movers(self.world), energy(self.world)
        self.top_energy = max(self.top_energy, now)
        in_play = kinetic(self.world) + float(rows["mass"].sum()) * (self.high - self.low)
        room = 0.01 * in_play + self.fall * self.world.tolerances.slop
        late = rows[rows["fraction"] < 1.0]
        room += (
            float((late["mass"] * np.hypot(late["vx"], late["vy"])).sum())
            * math.hypot(*self.world.gravity)
            * self.world.dt
        )
        assert now <= self.start_energy + room, f"{where}: energy {now:g}, {now - self.start_energy:g} above the start"
