"""U3, U4 and U5: what bodies keep while nobody pushes them from outside: momentum, spin, and energy at most.

They are asked over a stretch: steps on end in which the tables prove that nothing acted from outside. A change by hand
between two steps begins it anew, from what that change left.
"""

import math

import numpy as np

from game.invariants.bodies import Bodies
from game.invariants.invariant import Answer, Invariant, NotAsked
from game.invariants.step import Step
from physics import World

DRIFT = 1e-10  # of the momentum's scale in LONG steps (hard_cases U3) …
TWIST = 1e-3  # … and of the spin's, which letting overlaps out breaks slightly (U4)
GAIN = 0.01  # of the energy in play (U5)
LONG = 600  # steps
APART = 2.0  # slops that bodies may overlap by when a stretch begins: what lies deeper is lifted out


class Momentum(Invariant):
    """U3: the momentum of bodies that are alone with each other stays, to 1e-10 of Σ m v in 600 steps."""

    id, word = "U3", "momentum"

    def __init__(self) -> None:
        self.start: tuple[float, float] | None = None
        self.scale, self.steps = 0.0, 0

    def look(self, step: Step) -> Answer:
        """Ask it of the step just made."""
        why = step.open or fell_asleep(step)
        if why:
            self.start = None
            return NotAsked(why)
        if self.start is None or step.edited:
            self.start, self.scale, self.steps = step.before.momentum, step.before.momentum_scale, 0
        self.steps += 1
        self.scale = max(self.scale, step.now.momentum_scale)
        (x, y), (x0, y0) = step.now.momentum, self.start
        drift, allowed = math.hypot(x - x0, y - y0), DRIFT * self.scale * max(1.0, self.steps / LONG)
        if drift <= allowed:
            return None
        bodies = most(step, np.abs(step.now.mass * (step.now.vx - step.before.vx)))
        self.start = None  # told once, not in every step from here on
        return self.broken(step, bodies, drift, allowed, "momentum drifted though nothing pushes from outside")


class Spin(Invariant):
    """U4: so does their angular momentum, about their common centre of mass, to 1e-3 of Σ |r × m v| + |I ω| in 600
    steps."""

    id, word = "U4", "spin"

    def __init__(self) -> None:
        self.start: float | None = None
        self.scale, self.steps = 0.0, 0

    def look(self, step: Step) -> Answer:
        """Ask it of the step just made."""
        why = step.open or fell_asleep(step) or cannot_turn(step)
        if why:
            self.start = None
            return NotAsked(why)
        spin, scale = step.now.spin
        if self.start is None or step.edited:
            (self.start, self.scale), self.steps = step.before.spin, 0
        self.steps += 1
        self.scale = max(self.scale, scale)
        drift, allowed = abs(spin - self.start), TWIST * self.scale * max(1.0, self.steps / LONG)
        if drift <= allowed:
            return None
        bodies = most(step, np.abs(step.now.inertia * (step.now.turn - step.before.turn)))
        self.start = None
        return self.broken(step, bodies, drift, allowed, "angular momentum drifted though nothing turns from outside")


def fell_asleep(step: Step) -> str:
    """Why a step in which something fell asleep is passed over: what little speed it had is taken from it."""
    if not step.world.sleeps:
        return ""
    still = step.now.dynamic & ~step.world.bodies["awake"]
    return "a body falls asleep" if (step.before.speed[still] + np.abs(step.before.turn[still])).any() else ""


def cannot_turn(step: Step) -> str:
    """Why contacts off the centre take spin away, "" where they do not."""
    if len(step.contacts) == 0:
        return ""
    if not step.world.effects.rotation:
        return "nothing turns: rotation is not declared"
    fixed = step.world.bodies["inverse_inertia"] == 0.0
    return "a body cannot be turned" if (fixed & step.now.dynamic).any() else ""


def most(step: Step, change: np.ndarray) -> tuple[int, ...]:
    """The id of the body with the greatest change, () where there is none."""
    return (int(step.now.ids[int(np.argmax(change))]),) if len(change) else ()


class Account:
    """The energy of a world since a moment: `start` and the room that U5 leaves above it."""

    def __init__(self, bodies: Bodies) -> None:
        self.start = self.top = bodies.energy
        self.low, self.high = math.inf, -math.inf
        self._span(bodies)

    def _span(self, bodies):
        if bodies.dynamic.any():
            heights = bodies.heights[bodies.dynamic]
            self.low, self.high = min(self.low, float(heights.min())), max(self.high, float(heights.max()))

    def gain(self, world: World, now: Bodies) -> tuple[float, float]:
        """(how far the energy is above the start, how far it may be).

        1 % of the energy in play and m g slop of each body. A body that is stopped on its way keeps the speed it would
        have had at the end of it: m g v dt for those.
        """
        self._span(now)
        energy = now.energy
        self.top = max(self.top, energy)
        in_play = now.kinetic + now.total_mass * max(0.0, self.high - self.low)
        late = world.bodies["fraction"] < 1.0
        ahead = float((now.mass * now.speed)[late].sum()) * math.hypot(*now.gravity) * world.dt
        return energy - self.start, GAIN * in_play + now.weight * world.tolerances.slop + ahead


class Energy(Invariant):
    """U5: what nobody drives never has more energy than at the start of the stretch (Account.gain says how much more).

    A stretch begins when nothing overlaps by more than two slops: bodies set into each other are pushed out, and some of
    them up.
    """

    id, word = "U5", "energy"

    def __init__(self) -> None:
        self.account: Account | None = None

    def look(self, step: Step) -> Answer:
        """Ask it of the step just made."""
        world = step.world
        why = step.outside
        if not why and world.effects.restitution and (world.shapes["restitution"] > 1.0).any():
            why = "a surface gives more than it takes: restitution above 1"
        if why:
            self.account = None
            return NotAsked(why)
        if self.account is None or step.edited:
            self.account = Account(step.before) if step.overlap <= APART * step.slop else None
            if self.account is None:
                return NotAsked("bodies that were set into each other come apart")
        gain, allowed = self.account.gain(world, step.now)
        if gain <= allowed:
            return None
        self.account = None
        rise = step.now.energy_each - step.before.energy_each
        return self.broken(step, most(step, rise), gain, allowed, "energy rose above the start though nothing drives")
