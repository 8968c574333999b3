"""The bodies of a world at one moment, as arrays, with their momentum, angular momentum and energy."""

import math
from functools import cached_property

import numpy as np

from game.invariants.columns import block
from physics import DYNAMIC, World

BODY_NUMBERS = ("x", "y", "angle", "vx", "vy", "angular_velocity", "center_x", "center_y", "mass", "inertia")


class Bodies:
    """Copy of the numbers of all bodies at one moment. Sums include only the dynamic bodies.

    Lengths are in px, times in s, angles in rad. A mass is density times area [px2]. gravity: [px/s2], (0, 0) in a
    world without the effect `gravity`.
    """

    def __init__(self, world: World) -> None:
        rows = world.bodies
        self.ids = rows["id"].copy()
        self.kind = rows["kind"].copy()
        self.numbers = block(rows, BODY_NUMBERS)
        self.x, self.y, self.angle, self.vx, self.vy, self.turn, self.cx, self.cy, mass, inertia = self.numbers
        self.dynamic = self.kind == DYNAMIC
        self.mass, self.inertia = mass * self.dynamic, inertia * self.dynamic
        self.gravity = world.gravity if world.effects.gravity else (0.0, 0.0)
        self.felt = rows["gravity_scale"].copy() if any(self.gravity) else np.ones(len(rows))

    def __len__(self) -> int:
        return len(self.ids)

    def same_as(self, other: "Bodies") -> bool:
        """Return whether all values equal those of `other`, bit by bit."""
        return (
            np.array_equal(self.ids, other.ids)
            and np.array_equal(self.kind, other.kind)
            and self.numbers.tobytes() == other.numbers.tobytes()
            and self.gravity == other.gravity
            and np.array_equal(self.felt, other.felt)
        )

    def differs_from(self, other: "Bodies | None") -> np.ndarray:
        """Return (n,) bool: whether each body is new in this copy or differs from the body in `other`.

        other: copy at an earlier moment. If it is None, all values are True.
        """
        if other is None:
            return np.ones(len(self), bool)
        if np.array_equal(self.ids, other.ids):
            return (self.numbers != other.numbers).any(axis=0) | (self.kind != other.kind)
        at = np.searchsorted(other.ids, self.ids).clip(max=max(0, len(other) - 1))
        if not len(other):
            return np.ones(len(self), bool)
        return (other.ids[at] != self.ids) | (self.numbers != other.numbers[:, at]).any(axis=0)

    @cached_property
    def speed(self) -> np.ndarray:
        """(n,) speed of each centre of mass [px/s]."""
        return np.sqrt(self.vx * self.vx + self.vy * self.vy)

    @cached_property
    def heights(self) -> np.ndarray:
        """(n,) scalar product of gravity and centre of mass [px2/s2]: the negative potential energy per mass."""
        gx, gy = self.gravity
        return gx * self.cx + gy * self.cy

    @cached_property
    def kinetic_each(self) -> np.ndarray:
        """(n,) kinetic energy of each body [mass px2/s2]."""
        return 0.5 * (self.mass * self.speed**2 + self.inertia * self.turn * self.turn)

    @cached_property
    def energy_each(self) -> np.ndarray:
        """(n,) kinetic plus potential energy of each body [mass px2/s2]."""
        return self.kinetic_each - self.mass * self.felt * self.heights

    @property
    def kinetic(self) -> float:
        """Total kinetic energy [mass px2/s2]."""
        return float(self.kinetic_each.sum())

    @property
    def energy(self) -> float:
        """Total kinetic and potential energy [mass px2/s2]."""
        return float(self.energy_each.sum())

    @property
    def total_mass(self) -> float:
        """Total mass of the dynamic bodies."""
        return float(self.mass.sum())

    @property
    def weight(self) -> float:
        """Total mass of the dynamic bodies times the magnitude of gravity [mass px/s2]."""
        return self.total_mass * math.hypot(*self.gravity)

    @property
    def momentum(self) -> tuple[float, float]:
        """Total momentum (x, y) of the dynamic bodies [mass px/s]."""
        return float(self.mass @ self.vx), float(self.mass @ self.vy)

    @property
    def momentum_scale(self) -> float:
        """Sum of mass times speed [mass px/s]. A drift of the momentum is compared with it."""
        return float(self.mass @ self.speed)

    def spin(self, among: np.ndarray) -> float:
        """Return the sum of the absolute angular momenta of the bodies in `among` about their common centre of mass.

        among: (n,) bool, True for each body to include.
        """
        mass = self.mass * among
        total = float(mass.sum())
        if total == 0.0:
            return 0.0
        x, y = self.cx - mass @ self.cx / total, self.cy - mass @ self.cy / total
        vx, vy = self.vx - mass @ self.vx / total, self.vy - mass @ self.vy / total
        orbit = mass * np.sqrt((x * x + y * y) * (vx * vx + vy * vy))
        return float(orbit.sum() + (self.inertia * among) @ np.abs(self.turn))
