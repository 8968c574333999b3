"""Invariants U3, U4 and U5: without external influence, bodies keep their momenta and gain no energy.

U3 is momentum, U4 angular momentum, and U5 energy. Each is checked only where the world's tables prove that nothing
acts from outside. If the game changes something between two steps, the energy comparison starts anew.
"""

import math

import numpy as np

from game.invariants.bodies import Bodies
from game.invariants.invariant import Answer, Invariant, NotAsked
from game.invariants.step import Step
from physics import World

DRIFT = 1e-10  # of the momentum's scale in LONG steps (U3) …
TWIST = 1e-3  # … and of the spin's, which push-out changes slightly (U4)
GAIN = 0.01  # of the energy in play (U5)
STILL = 1e-9  # sleeping speeds: a slower motion is rounding error of a stop
LONG = 600  # number of steps that DRIFT and TWIST refer to
APART = 2.0  # slops that bodies may overlap by at the start: deeper overlaps are pushed out


class OfTheAlone(Invariant):
    """Base class of invariants of a quantity that isolated bodies conserve.

    In each step, the gain of the quantity is summed over the isolated bodies (Step.alone), on which nothing acts from
    outside. The sum of the gains of all steps must not exceed an allowance.
    """

    gained: str  # sentence that reports the gain

    def __init__(self) -> None:
        self.drift, self.room, self.steps = np.zeros(2), 0.0, 0

    def look(self, step: Step) -> Answer:
        """Check the invariant for `step`. Return a Broken, a NotAsked, or None if the invariant holds."""
        if step.outside:
            return NotAsked(step.outside)
        alone = step.alone
        why = self.why_not(step, alone)
        if why:
            return NotAsked(why)
        gain, room, change = self.gain(step, alone)
        self.drift, self.room, self.steps = self.drift + gain, max(self.room, room), self.steps + 1
        drift, allowed = float(np.hypot(*self.drift)), self.room * max(1.0, self.steps / LONG)
        if drift <= allowed:
            return None
        self.drift = np.zeros(2)  # reported once, not in every later step
        return self.broken(step, most(step, np.where(alone, change, 0.0)), drift, allowed, self.gained)

    def why_not(self, step: Step, alone: np.ndarray) -> str:
        """Return the reason why the invariant cannot be checked in this step; "" if it can be checked.

        alone: (n,) bool, True for each isolated body (see Step.alone).
        """
        if not alone.any():
            return "all that is dynamic touches what stands, sleeps or is driven"
        return "drag acts" if step.world.effects.drag and step.world.drag > 0.0 else ""

    def gain(self, step: Step, alone: np.ndarray) -> tuple[np.ndarray, float, np.ndarray]:
        """Return (gain, allowance, change) of the conserved quantity in this step.

        gain: (2,) gain of the quantity, summed over the bodies in `alone`; allowance: allowed gain in LONG steps;
        change: (n,) change of the quantity of each body. alone: (n,) bool, True for each isolated body.
        """
        raise TypeError(f"{type(self).__name__} must define gain")


class Momentum(OfTheAlone):
    """Invariant U3: isolated bodies keep their momentum, to 1e-10 of Σ m v in 600 steps.

    The change by gravity is subtracted.
    """

    id, word = "U3", "momentum"
    gained = "momentum drifted though nothing pushes from outside"

    def gain(self, step: Step, alone: np.ndarray) -> tuple[np.ndarray, float, np.ndarray]:
        """Return (gain, allowance, change) of the momentum in this step, without the change by gravity.

        gain: (2,) gain along x and y, summed over the bodies in `alone`; allowance: allowed gain in LONG steps; change:
        (n,) change of the momentum of each body. alone: (n,) bool, True for each isolated body.
        """
        now, before = step.now, step.before
        mass = now.mass * alone
        fall = mass * now.felt * step.dt
        gx, gy = now.gravity
        x, y = mass * (now.vx - before.vx) - fall * gx, mass * (now.vy - before.vy) - fall * gy
        scale = float(mass @ now.speed + mass @ before.speed + np.abs(fall).sum() * math.hypot(gx, gy))
        return np.array((x.sum(), y.sum())), DRIFT * scale, np.hypot(x, y)


class Spin(OfTheAlone):
    """Invariant U4: the angular momentum of isolated bodies about their common centre of mass is constant.

    The check sums the torques of the impulses. Each body is taken halfway between its positions before and after the
    step. The tolerance is the sum of two terms. The first is 1e-3 of Σ |r × m v| + |I ω| in 600 steps. The second is
    the rounding error of U3 (momentum), times the moment arms of the bodies.

    Three effects are errors of a single step rather than a drift, and are not counted:

    1. Push-out moves bodies, and thus changes the moment arms of their momenta. In this way, a falling column of ten
    boxes loses 0.9 % in a step under projection.

    2. After an impact within the step, the two bodies continue to move past each other (see `slip`). The error is 0.7 %
    in one hit of two stones of lab/carving, and 0.1 % in 214 steps of 130 bodies in lab/tumbler.

    3. Joints also act at moments within the step (see `lag`). The error is 0.2 % in a second of the doll of lab/joints,
    which flies with gaps of up to a pixel.
    """

    id, word = "U4", "spin"
    gained = "angular momentum drifted though nothing turns from outside"

    def why_not(self, step: Step, alone: np.ndarray) -> str:
        """Return the reason why the invariant cannot be checked in this step; "" if it can be checked.

        alone: (n,) bool, True for each isolated body (see Step.alone).
        """
        why = super().why_not(step, alone)
        if why:
            return why
        felt = step.now.felt[alone]
        if (felt != felt[0]).any():
            return "gravity pulls some more than others"
        touching = np.zeros(len(alone), bool)
        for side in step.sides:
            touching[side] = True
        touching &= alone
        if step.world.effects.response and (step.world.bodies["inverse_inertia"][touching] == 0.0).any():
            return "a body that cannot be turned is touched"
        return ""

    def gain(self, step: Step, alone: np.ndarray) -> tuple[np.ndarray, float, np.ndarray]:
        """Return (gain, allowance, change) of the angular momentum in this step.

        gain: (gain of angular momentum, 0), summed over the bodies in `alone`; allowance: allowed gain in LONG steps;
        change: (n,) change of each body's angular momentum. alone: (n,) bool, True for each isolated body.
        """
        now, before = step.now, step.before
        mass, inertia = now.mass * alone, now.inertia * alone
        total = float(mass.sum())
        x, y = 0.5 * (before.cx + now.cx), 0.5 * (before.cy + now.cy)
        x, y = x - mass @ x / total, y - mass @ y / total
        torque = mass * (x * (now.vy - before.vy) - y * (now.vx - before.vx)) + inertia * (now.turn - before.turn)
        arm, max_speed = np.sqrt(x * x + y * y), np.maximum(step.max_speed, before.speed)
        fall = math.hypot(*now.gravity) * step.dt * np.abs(now.felt)
        scale = now.spin(alone) + before.spin(alone)
        reach = arm + step.world.bodies["extent"]
        rounding = float(mass @ (reach * (max_speed + fall)) + inertia @ (np.abs(now.turn) + np.abs(before.turn)))
        drift = float(torque.sum())
        beyond = math.copysign(max(0.0, abs(drift) - slip(step, alone) - lag(step, alone)), drift)
        return np.array((beyond, 0.0)), TWIST * scale + DRIFT * rounding, np.abs(torque)


def slip(step: Step, among: np.ndarray) -> float:
    """Return the error of angular momentum that the contacts of a step may cause.

    Only contacts between two bodies that are flagged in `among`, (n,) bool, are included. The error of a contact is
    impulse · (path + gap). The path is the distance by which the two bodies move past each other at the contact point
    in the step. The gap is the gap or overlap of the contact. The errors of all contacts are added.
    """
    rows, (a, b) = step.contacts, step.sides
    pushed = np.flatnonzero(among[a] & among[b])
    if not len(pushed):
        return 0.0
    rows, a, b = rows[pushed], a[pushed], b[pushed]
    impulse = np.abs(rows["normal_impulse"]) + np.abs(rows["tangent_impulse"])
    way = np.abs(rows["separation"])
    for bodies in (step.before, step.now):
        ax, ay = rows["point_x"] - bodies.cx[a], rows["point_y"] - bodies.cy[a]
        bx, by = rows["point_x"] - bodies.cx[b], rows["point_y"] - bodies.cy[b]
        vx = bodies.vx[b] - bodies.turn[b] * by - bodies.vx[a] + bodies.turn[a] * ay
        vy = bodies.vy[b] + bodies.turn[b] * bx - bodies.vy[a] - bodies.turn[a] * ax
        way += np.sqrt(vx * vx + vy * vy) * step.dt
    return float(impulse @ way)


def lag(step: Step, among: np.ndarray) -> float:
    """Return the error of angular momentum that the joints of a step may cause.

    The check of U4 places each body halfway between its positions before and after the step. A joint acts at another
    moment of the step, when its bodies are elsewhere. The gap between its anchors is an additional moment arm.

    Only joints between two bodies that are flagged in `among`, (n,) bool, are included. The error of a joint is impulse
    · (half of the bodies' relative path in the step + gap). The errors of all joints are added.
    """
    rows, (a, b) = step.world.joints[step.world.joints["enabled"]], step.linked
    a, b = a[: len(rows)], b[: len(rows)]  # broken joints follow, whose last force is not known
    held = np.flatnonzero((a >= 0) & (b >= 0) & among[a] & among[b])
    if not len(held):
        return 0.0
    rows, a, b = rows[held], a[held], b[held]
    path = sum(np.hypot(bodies.vx[b] - bodies.vx[a], bodies.vy[b] - bodies.vy[a]) for bodies in (step.before, step.now))
    way = np.abs(rows["separation"]) + 0.5 * 0.5 * path * step.dt
    return float(np.hypot(rows["force_x"], rows["force_y"]) * step.dt @ way)


def most(step: Step, change: np.ndarray) -> tuple[int, ...]:
    """Return the id of the body with the greatest `change`, as (id,); () if there are no bodies.

    change: (n,), one per body.
    """
    return (int(step.now.ids[int(np.argmax(change))]),) if len(change) else ()


class Account:
    """Account of a world's energy since the start of a comparison. start: total energy at the start [mass px2/s2]."""

    def __init__(self, bodies: Bodies, overlap: float = 0.0) -> None:
        self.start = self.top = bodies.energy
        self.overlap = overlap  # [px] of the deepest contact at the start
        self.low, self.high = math.inf, -math.inf
        self._span(bodies)

    def _span(self, bodies):
        if bodies.dynamic.any():
            heights = bodies.heights[bodies.dynamic]
            self.low, self.high = min(self.low, float(heights.min())), max(self.high, float(heights.max()))

    def gain(self, world: World, now: Bodies) -> tuple[float, float]:
        """Return (energy gained since the start, greatest allowed gain) [mass px2/s2].

        now: Bodies of the present state. The allowed gain is the sum of four terms. The first is 1 % of the energy in
        play (kinetic energy, plus the potential energy between the lowest and the highest position so far). The second
        is m g (slop + overlap at the start) of each body. The third is the rounding error of bodies that come to rest.
        The fourth is m g v dt of each body that was stopped at its time of impact.
        """
        self._span(now)
        energy = now.energy
        self.top = max(self.top, energy)
        in_play = now.kinetic + now.total_mass * max(0.0, self.high - self.low)
        late = world.bodies["fraction"] < 1.0
        ahead = float((now.mass * now.speed)[late].sum()) * math.hypot(*now.gravity) * world.dt
        rounding = 0.5 * now.total_mass * (STILL * world.tolerances.sleep_speed) ** 2
        allowed = GAIN * in_play + now.weight * (world.tolerances.slop + self.overlap) + ahead + rounding
        return energy - self.start, allowed


class Energy(Invariant):
    """Invariant U5: without a drive, the total energy never exceeds the energy at the start by more than allowed.

    Account.gain() defines the allowed gain. The comparison starts after the last change by the game, once no overlap is
    deeper than two slops. Before that, bodies that were created overlapping are pushed apart, some of them upwards.
    """

    id, word = "U5", "energy"

    def __init__(self) -> None:
        self.account: Account | None = None

    def look(self, step: Step) -> Answer:
        """Check the invariant for `step`. Return a Broken, a NotAsked, or None if the invariant holds."""
        world = step.world
        why = step.outside or driven(step)
        if why:
            self.account = None
            return NotAsked(why)
        account = self.account
        if account is None or step.edited:
            if world.effects.response and step.overlap > APART * step.slop:
                self.account = None
                return NotAsked("bodies that were set into each other come apart")
            if account is None:
                # The overlap before this step is unknown. Push-out removed at most this much of it, in this step alone.
                account = Account(step.before, step.overlap + world.tolerances.push_speed * step.dt)
                self.account = Account(step.now, step.overlap)
            else:
                self.account = account = Account(step.before, step.overlap)
        gain, allowed = account.gain(world, step.now)
        if gain <= allowed:
            return None
        self.account = None
        rise = step.now.energy_each - step.before.energy_each
        return self.broken(step, most(step, rise), gain, allowed, "energy rose above the start though nothing drives")


def driven(step: Step) -> str:
    """Return a phrase that names a drive in this step, such as a motor or a force; "" if there is none.

    A drive is anything that may add energy to bodies.
    """
    world, effects = step.world, step.world.effects
    if step.forced.any():
        return "forces act"
    if not effects.response:
        return ""
    links = world.library.tables.links  # of chains, which may have materials of their own
    if effects.conveyor and (world.shapes["surface_speed"].any() or np.nan_to_num(links["surface_speed"]).any()):
        return "a belt runs"
    if effects.restitution and ((world.shapes["restitution"] > 1.0).any() or (links["restitution"] > 1.0).any()):
        return "a surface gives more than it takes: restitution above 1"
    if effects.joints:
        drives = ("motor_max", "spring_hertz", "point_hertz", "angle_hertz")
        joints = world.joints[world.joints["enabled"]]
        if any((joints[name] > 0.0).any() for name in drives):
            return "a motor or a spring of a joint acts"
    if step.moved_by_hand.any():
        a, b = step.sides
        if (step.moved_by_hand[a] | step.moved_by_hand[b]).any():
            return "a body that is moved by hand touches something"
    if len(world.events.quarantined):
        return "a body was taken out"
    return ""
