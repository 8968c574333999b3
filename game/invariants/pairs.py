"""U7, U8 and U10: the answer about two shapes does not depend on their order, their place, or the function that is
called.

The invariants query physics about a sample of pairs: a few in a step, the next ones in the next. They take turns, one
invariant a step.
"""

import math

import numpy as np

from game.invariants.invariant import Answer, Invariant, NotAsked
from game.invariants.sample import Pair, sample
from game.invariants.step import Step
from physics import PixelMask, World, collide, distance

ULPS = 4.0  # of the poses: allowed change of a distance by a turn and a shift (U8)
SHIFT = (16.0, -32.0)  # [px] whole, so that pixels stay on the pixel grid
BAND = 1e-9  # of the positions and sizes of two shapes: nearer to touching, either answer is right
TURNS = 3  # invariants that take turns
SELDOM = 4  # turns of an invariant before it checks a concave pair again: a tile map takes 5 ms


class OfPairs(Invariant):
    """An invariant checked on a sample of pairs in every third step; in between the last answer stays. concave: concave
    pairs, too.
    """

    turn: int

    def __init__(self, concave: bool = True) -> None:
        self.concave = concave
        self.answer: Answer = NotAsked("not its turn yet")

    def look(self, step: Step) -> Answer:
        """Check it for the last step."""
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
        """Check it for one pair."""
        raise TypeError(f"{type(self).__name__} must define ask")


class Swap(OfPairs):
    """U7: with its shapes swapped, a pair has the opposite normal and the same points and depths, to the bit."""

    id, word, turn = "U7", "swap", 0

    def ask(self, step: Step, pair: Pair) -> Answer:
        """Check it for one pair."""
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
    """U8: two shapes, rotated together by quarter turns and shifted by whole pixels, keep their distance.

    The tolerance is 4 ulp of the poses: of the coordinates, and of the angles at the reach of the shapes. Shapes that
    are drawn on the pixel grid or do not rotate are only shifted. Mirrored scenes need a second world to compare with,
    for 60 steps: tests do that.
    """

    id, word, turn = "U8", "turn", 1

    def ask(self, step: Step, pair: Pair) -> Answer:
        """Check it for one pair."""
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
    """Return a pose rotated about the origin by quarter turns, and shifted."""
    x, y, angle = pose
    for _ in range(quarters):
        x, y = -y, x
    return x + SHIFT[0], y + SHIFT[1], angle + quarters * 0.5 * math.pi


def rounding(pair: Pair) -> float:
    """Return an ulp of the positions, and of the angles at the reach of the shapes [px]."""
    size = pair.size + max(map(abs, SHIFT))
    angle = max(abs(pair.pose_a[2]), abs(pair.pose_b[2])) + 2.0 * math.pi
    return math.ulp(size) + pair.size * math.ulp(angle)


class Agree(OfPairs):
    """U10: overlap, zero distance, depth and contact of two shapes are true together or not at all.

    In a world without response its contacts are compared, too. With response they belong to poses that the solver has
    moved since, and begin a little before touching.
    """

    id, word, turn = "U10", "agree", 2

    def ask(self, step: Step, pair: Pair) -> Answer:
        """Check it for one pair."""
        found = disagreement(step.world, pair)
        return None if found is None else self.broken(step, pair.bodies, *found)


def disagreement(world: World, pair: Pair) -> tuple[float, float, str] | None:
    """Return (value, allowed, sentence) if distance, depth, contact and the contacts of a world without response
    differ.
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
    """Return whether no body has moved since the world looked for contacts."""
    effects = world.effects
    return effects.narrowphase and not effects.response and not effects.continuous


def reports_contacts(world: World, pair: Pair) -> bool:
    """Return whether a contact of the two is reported by their shapes: no sensor, and no mask, which is tested by its
    pixels.
    """
    shapes = world.shapes
    at = np.searchsorted(shapes["id"], (pair.shape_id_a, pair.shape_id_b))
    masks = isinstance(pair.shape_a, PixelMask) or isinstance(pair.shape_b, PixelMask)
    return not shapes["sensor"][at].any() and not masks
