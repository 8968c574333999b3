"""Invariants U7, U8 and U10: collision queries about two shapes are consistent.

U7: the queries give the same result for swapped shapes. U8: they give the same result at any position. U10: different
queries agree with each other. In each step, a few candidate pairs are checked, which differ from step to step. Each
step checks one of the three invariants, in turn.
"""

import math

import numpy as np

from game.invariants.invariant import Answer, Invariant, NotAsked
from game.invariants.sample import Pair, sample
from game.invariants.step import Step
from physics import PixelMask, World, collide, distance

ULPS = 4.0  # of the poses: allowed change of a distance by a turn and a shift (U8)
SHIFT = (16.0, -32.0)  # [px] whole, so that pixels stay on the pixel grid
BAND = 1e-9  # of the positions and sizes of two shapes: for a smaller distance or depth, both answers are right
TURNS = 3  # invariants that take turns
SELDOM = 4  # turns of an invariant before it checks a concave pair again: a tile map takes 5 ms


class OfPairs(Invariant):
    """Base class of an invariant that is checked on a sample of pairs, in every third step.

    In the other steps, look() returns the result of the last check. concave: whether pairs with concave shapes are also
    checked.
    """

    turn: int

    def __init__(self, concave: bool = True) -> None:
        self.concave = concave
        self.answer: Answer = NotAsked("not its turn yet")

    def look(self, step: Step) -> Answer:
        """Check the invariant for `step`. Return a Broken, a NotAsked, or None if the invariant holds."""
        if not step.world.effects.narrowphase:
            return NotAsked("no narrow phase: boxes that meet are a hit")
        if step.number % TURNS != self.turn:
            return self.answer
        asked = step.number // TURNS
        pairs = list(sample(step, asked, self.concave and asked % SELDOM == 0))
        self.answer = None if pairs else NotAsked("no two shapes are near each other")
        for pair in pairs:
            broken = self.ask(step, pair)
            if broken is not None:
                return broken
        return self.answer

    def ask(self, step: Step, pair: Pair) -> Answer:
        """Check the invariant for one pair of shapes. Return a Broken, or None if the invariant holds."""
        raise TypeError(f"{type(self).__name__} must define ask")


class Swap(OfPairs):
    """Invariant U7: swapped shapes have the opposite normal and the same contact points and depths, bit by bit."""

    id, word, turn = "U7", "swap", 0

    def ask(self, step: Step, pair: Pair) -> Answer:
        """Check the invariant for one pair of shapes. Return a Broken, or None if the invariant holds."""
        if pair.same:
            return None
        margin = step.world.tolerances.speculative
        one = collide(pair.shape_a, pair.pose_a, pair.shape_b, pair.pose_b, margin)
        two = collide(pair.shape_b, pair.pose_b, pair.shape_a, pair.pose_a, margin)
        if len(one) != len(two):
            return self.broken(step, pair.bodies, len(two), len(one), "another number of points, asked B before A")
        off = max(abs(n + m) for n, m in zip(one.normal, two.normal, strict=True))
        if off > 0.0:
            return self.broken(step, pair.bodies, off, 0.0, "the normal is not turned round, asked B before A")
        for name, first, second in (("points", one.points, two.points), ("depths", one.separations, two.separations)):
            if len(first) and not np.array_equal(np.sort(first, axis=0), np.sort(second, axis=0)):
                off = float(np.abs(np.sort(first, axis=0) - np.sort(second, axis=0)).max())
                return self.broken(step, pair.bodies, off, 0.0, f"other {name}, asked B before A")
        return None


class Turn(OfPairs):
    """Invariant U8: the distance of two shapes does not change if both are rotated and shifted together.

    The rotation is by quarter turns, and the shift is in whole pixels. The tolerance is 4 times the rounding error of
    the poses, see `rounding`. Shapes that are drawn on the pixel grid or do not rotate are only shifted. Mirrored
    scenes are compared only by tests, because this needs a second world and 60 steps.
    """

    id, word, turn = "U8", "turn", 1

    def ask(self, step: Step, pair: Pair) -> Answer:
        """Check the invariant for one pair of shapes. Return a Broken, or None if the invariant holds."""
        quarters = 1 + step.number // TURNS % 3 if pair.hulls else 0
        here = distance(pair.shape_a, pair.pose_a, pair.shape_b, pair.pose_b)
        there = distance(pair.shape_a, moved(pair.pose_a, quarters), pair.shape_b, moved(pair.pose_b, quarters))
        if math.isinf(here.distance) and math.isinf(there.distance):
            return None
        off, allowed = abs(here.distance - there.distance), ULPS * rounding(pair)
        if off <= allowed:
            return None
        reported = f"by {quarters} quarters and shifted" if quarters else "by nothing but shifted"
        return self.broken(step, pair.bodies, off, allowed, f"another distance [px], turned {reported}")


def moved(pose: tuple[float, float, float], quarters: int) -> tuple[float, float, float]:
    """Return the pose (x, y, angle) after `quarters` quarter turns about the origin and a shift by SHIFT."""
    x, y, angle = pose
    for _ in range(quarters):
        x, y = -y, x
    return x + SHIFT[0], y + SHIFT[1], angle + quarters * 0.5 * math.pi


def rounding(pair: Pair) -> float:
    """Return the rounding error of the poses of a pair [px].

    The error is one ulp of the coordinates, plus the pair's size times one ulp of the angles.
    """
    size = pair.size + max(map(abs, SHIFT))
    angle = max(abs(pair.pose_a[2]), abs(pair.pose_b[2])) + 2.0 * math.pi
    return math.ulp(size) + pair.size * math.ulp(angle)


class Agree(OfPairs):
    """Invariant U10: all queries agree about whether two shapes overlap.

    An overlap means a negative distance, a positive depth, and at least one contact point. In a world without the
    effect `response`, the world's contacts are also compared. With this effect they cannot be compared: they were found
    before the solver moved the bodies, and include shapes that are about to touch.
    """

    id, word, turn = "U10", "agree", 2

    def ask(self, step: Step, pair: Pair) -> Answer:
        """Check the invariant for one pair of shapes. Return a Broken, or None if the invariant holds."""
        found = disagreement(step.world, pair)
        return None if found is None else self.broken(step, pair.bodies, *found)


def disagreement(world: World, pair: Pair) -> tuple[float, float, str] | None:
    """Return (value, allowed value, sentence) if the queries about a pair disagree; None if they agree.

    Distance, depth and contact points are compared. The contacts that the world reports are also compared, if
    looks_only() and reports_contacts() are True.
    """
    gap = distance(pair.shape_a, pair.pose_a, pair.shape_b, pair.pose_b).distance
    if math.isinf(gap) or abs(gap) <= BAND * (abs(gap) + pair.size):
        return None
    met = collide(pair.shape_a, pair.pose_a, pair.shape_b, pair.pose_b)
    depth = -float(met.separations.min()) if len(met) else 0.0
    if (len(met) > 0) != (gap < 0.0):
        return gap, 0.0, f"distance [px] and {len(met)} points of contact disagree"
    if (depth > 0.0) != (gap < 0.0):
        return depth, max(0.0, -gap), "depth [px] and distance disagree"
    if not looks_only(world) or not reports_contacts(world, pair):
        return None
    rows = world.contacts
    of_pair = (rows["shape_a"] == pair.shape_id_a) & (rows["shape_b"] == pair.shape_id_b)
    reported = bool((of_pair & (rows["separation"] <= 0.0)).any())
    if reported == (gap < 0.0):
        return None
    return gap, 0.0, f"the world reports {'a' if reported else 'no'} contact at this distance [px]"


def looks_only(world: World) -> bool:
    """Return whether the world's contacts are exact for the poses at the end of the step.

    This requires the effect `narrowphase`. No body may move after the contacts are found, so the effects `response` and
    `continuous` must be off.
    """
    effects = world.effects
    return effects.narrowphase and not effects.response and not effects.continuous


def reports_contacts(world: World, pair: Pair) -> bool:
    """Return whether the world finds the contacts of this pair from the pair's two shapes.

    This is False for sensors, which report no contacts, and for masks, which are tested by their pixels.
    """
    shapes = world.shapes
    at = np.searchsorted(shapes["id"], (pair.shape_id_a, pair.shape_id_b))
    masks = isinstance(pair.shape_a, PixelMask) or isinstance(pair.shape_b, PixelMask)
    return not shapes["sensor"][at].any() and not masks
