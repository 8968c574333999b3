"""Finished step of a world: the bodies before and after the step, the contacts, and external influences."""

from functools import cached_property

import numpy as np

from game.invariants.bodies import Bodies
from physics import DYNAMIC, KINEMATIC, World
from physics.tables.joint import GEARED


class Step:
    """A finished step of a world. before, now: Bodies before and after the step; dt: length of the step [s].

    edited: whether the game changed the world since the previous step. changed: (n,) bool, whether the game changed
    each body. forced: (n,) bool, whether a force was applied to each body. n is the number of bodies before the step.
    """

    def __init__(
        self, world: World, before: Bodies, dt: float, edited: bool, changed: np.ndarray, forced: np.ndarray
    ) -> None:
        self.world, self.before, self.dt = world, before, dt
        self.edited, self.changed, self.forced = edited, changed, forced
        self.number = world.steps
        self.now = Bodies(world)
        self.contacts = world.contacts

    @property
    def slop(self) -> float:
        """Overlap [px] that the solver does not remove at a contact, so that the contact persists."""
        return self.world.tolerances.slop

    @cached_property
    def overlap(self) -> float:
        """Overlap of the deepest contact [px]; 0 if no contact overlaps."""
        depths = self.contacts["separation"]
        return max(0.0, -float(depths.min())) if len(depths) else 0.0

    @cached_property
    def max_speed(self) -> np.ndarray:
        """(n,) greater of two speeds of each body [px/s]: size of its velocity, and distance moved in the step / dt.

        The two differ because push-out moves a body without changing its velocity.
        """
        if self.dt == 0.0 or len(self.before) != len(self.now):
            return self.now.speed
        x, y = self.now.cx - self.before.cx, self.now.cy - self.before.cy
        return np.maximum(self.now.speed, np.sqrt(x * x + y * y) / self.dt)

    @cached_property
    def sides(self) -> tuple[np.ndarray, np.ndarray]:
        """Bodies of the contacts: (rows of the bodies A, rows of the bodies B), two arrays of row indices."""
        return self.rows_of(self.contacts["body_a"]), self.rows_of(self.contacts["body_b"])

    @cached_property
    def linked(self) -> tuple[np.ndarray, np.ndarray]:
        """Bodies of the joints that acted in the step: (rows of the bodies A, rows of the bodies B), two index arrays.

        The row of the world is -1. Joints that broke in the step are included.
        """
        world = self.world
        joints, broken = world.joints[world.joints["enabled"]], world.events.broken
        broken = broken[broken["reason"] != "removed"]
        a, b = (np.concatenate([joints[name], broken[name]]) for name in ("body_a", "body_b"))
        return np.where(a < 0, -1, self.rows_of(a)), np.where(b < 0, -1, self.rows_of(b))

    def rows_of(self, ids: np.ndarray) -> np.ndarray:
        """Return the row indices of bodies in the world's table of bodies. ids: ids of the bodies."""
        return np.searchsorted(self.now.ids, ids)

    def spread(self, rows: np.ndarray, through: np.ndarray) -> np.ndarray:
        """Return (n,) bool: the bodies that are flagged in `rows` or connected to one of these by contacts or joints.

        The connection may lead through several bodies. rows, through: (n,) bool. A contact or joint counts only if both
        its bodies are flagged in `through`.
        """
        joined = (self.linked[0] >= 0) & (self.linked[1] >= 0)
        a, b = (np.concatenate([one, other[joined]]) for one, other in zip(self.sides, self.linked, strict=True))
        open_ones = through[a] & through[b]
        a, b, reached = a[open_ones], b[open_ones], rows.copy()
        while (reached[a] != reached[b]).any():
            reached[b[reached[a]]] = True
            reached[a[reached[b]]] = True
        return reached

    @cached_property
    def moved_by_hand(self) -> np.ndarray:
        """(n,) bool: whether each body is kinematic and moves (has a velocity, or changed its pose in this step)."""
        now = self.now
        moves = (now.vx != 0.0) | (now.vy != 0.0) | (now.turn != 0.0)
        moves |= (now.numbers[:3] != self.before.numbers[:3]).any(axis=0)
        return moves & (now.kind == KINEMATIC)

    @cached_property
    def outside(self) -> str:
        """A phrase that names an external influence that may act on any body, such as wind; "" if there is none."""
        world, effects = self.world, self.world.effects
        if len(self.before) != len(self.now):
            return "bodies came or went"
        if effects.response and len(world.characters.rows):
            return "a character walks and pushes"
        if effects.wind and any(world.wind):
            return "wind blows"
        return ""

    @cached_property
    def alone(self) -> np.ndarray:
        """(n,) bool: the isolated bodies.

        Isolated bodies are dynamic bodies on which only gravity acted from outside in the whole step. They have no
        applied force and were not stopped within the step. No contact or joint connects them, directly or through other
        bodies, to the world or to a static, kinematic, sleeping, stopped or forced body. Contacts that ended in the
        step count, because they may have acted in its first part.
        """
        rows = self.world.bodies
        still = (self.now.kind != DYNAMIC) | ~rows["awake"] | rows["quarantined"] | self.forced
        still |= rows["fraction"] < 1.0
        a, b = self.linked
        coupled = self.world.joints[self.world.joints["hold"] >= GEARED]  # their forces do not add up to 0
        for name in ("body_a", "body_b"):
            still[self.rows_of(coupled[name][coupled[name] >= 0])] = True
        still[b[a < 0]] = True
        still[a[b < 0]] = True
        ended = self.world.events.end
        ended = ended[np.isin(ended["body_a"], self.now.ids) & np.isin(ended["body_b"], self.now.ids)]
        if self.world.effects.response and len(ended):
            one, other = self.rows_of(ended["body_a"]), self.rows_of(ended["body_b"])
            acted = still.copy()
            still[one] |= acted[other]
            still[other] |= acted[one]
        if self.world.effects.response and (len(self.contacts) or len(a)):
            still = self.spread(still, np.ones(len(self.now), bool))
        return ~still
