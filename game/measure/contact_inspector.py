"""Inspector of a contact: shows the result of each stage of the last step for one pair of shapes.

The time that is shown for a stage is its time for all pairs in the step. The narrow-phase time of the single pair is
measured on request: a thousand copies of the pair are timed in five runs after a warm-up.
"""

from math import atan2, degrees
from typing import NamedTuple

import numpy as np

from game.drawing.number_text import amount_text, count_text, plain_name
from game.measure.pair_batch import PairBatch
from game.measure.timing import LEAST_PAIRS, Cost, timed_in_turns
from physics import World
from physics.collision.manifold import by_parent

MICRO, NANO = 1e6, 1e9
CATEGORIES = 32  # bits of a filter
IMPULSE = "mass px/s"  # unit of impulses


class Part(NamedTuple):
    """The result of one stage of the step for a pair of shapes. stage: name of the stage; text: the result in words."""

    stage: str
    text: str


class Touch(NamedTuple):
    """A contact point: the ids of the two bodies and shapes, and its position (x, y) [px]."""

    body_a: int
    body_b: int
    shape_a: int
    shape_b: int
    x: float
    y: float


def nearest(world: World, x: float, y: float, reach: float) -> Touch | None:
    """Return the contact point nearest to (x, y) [px]; None if no contact point is within `reach` [px]."""
    found = world.contacts
    if not len(found):
        return None
    away = np.hypot(found["point_x"] - x, found["point_y"] - y)
    row = int(np.argmin(away))
    if away[row] > reach:
        return None
    c = found[row]
    a, b, s, t = (int(c[name]) for name in ("body_a", "body_b", "shape_a", "shape_b"))
    return Touch(a, b, s, t, float(c["point_x"]), float(c["point_y"]))


def still_there(world: World, touch: Touch) -> bool:
    """Return whether the two shapes of `touch` have a contact after the last step."""
    found = world.contacts
    return bool(((found["shape_a"] == touch.shape_a) & (found["shape_b"] == touch.shape_b)).any())


def explain(world: World, touch: Touch) -> list[Part]:
    """Return one Part for each stage of the last step: the result of this stage for the two shapes of `touch`.

    Raises ValueError if the shapes do not touch.
    """
    rows, _ = by_parent(world.reported_rows())
    # contacts of the child shapes of both shapes
    mine = rows[(rows["parent_a"] == touch.shape_a) & (rows["parent_b"] == touch.shape_b)]
    if not len(mine):
        raise ValueError(f"touch must be of a pair that touches (got {touch})")
    parts = [_broad_phase(world, touch), _filter(world, touch), _narrow_phase(world, touch, mine)]
    if world.effects.stacking:
        parts.append(_warm_start(world, mine))
    if world.effects.response:
        parts.append(_solver(world, mine))
    return parts


def cost_of(world: World, touch: Touch) -> Cost:
    """Return the narrow-phase time [s] of the two bodies of `touch` at their current poses, as a Cost."""
    bodies = world.body(touch.body_a), world.body(touch.body_b)
    poses = [np.tile((*body.position, body.angle), (LEAST_PAIRS, 1)) for body in bodies]
    batch = PairBatch(bodies[0].shapes, poses[0], bodies[1].shapes, poses[1])
    return timed_in_turns({"pair": batch.test}, {"pair": len(batch)})["pair"]


def _stage(world, name):
    seconds = world.profile.stages.get(name)
    return "" if seconds is None else f"; the stage took {MICRO * seconds:.0f} us"


def _broad_phase(world, touch):
    ids = world.candidates
    place = np.flatnonzero((ids == (touch.shape_a, touch.shape_b)).all(axis=1))
    tested = world.profile.counters["pairs_tested"]
    name = plain_name(world.broadphase.name)
    where = f"pair {int(place[0]) + 1} of {len(ids)} whose boxes meet" if len(place) else "found again by the solver"
    words = f"{where}, from {count_text(tested, 'test')} of boxes" if tested else where + ", known from steps before"
    return Part(f"broad phase, {name}", words + _stage(world, "broad_phase"))


def _filter(world, touch):
    rows = world.shapes
    a, b = (rows[rows["id"] == each][0] for each in (touch.shape_a, touch.shape_b))
    ways = [
        f"{name} is in {_categories(s['membership'])}, {other} meets {_categories(t['mask'])}"
        for name, s, other, t in (("A", a, "B", b), ("B", b, "A", a))
    ]
    return Part("filter", f"{ways[0]}; {ways[1]}: they may meet")


def _categories(bits):
    """Return the categories of a filter, 1 to 32, as text. bits: int, one bit for each category."""
    found = [k + 1 for k in range(CATEGORIES) if int(bits) >> k & 1]
    if len(found) == CATEGORIES:
        return "all categories"
    name = "category" if len(found) == 1 else "categories"
    return f"{name} {', '.join(map(str, found))}" if found else "no category"


def _narrow_phase(world, touch, mine):
    deepest = mine[np.argmin(mine["separation_1"])]
    points = count_text(int(mine["count"].sum()), "point")
    gaps = [float(deepest["separation_1"])] + ([float(deepest["separation_2"])] if deepest["count"] > 1 else [])
    how = ", ".join(f"{abs(gap):.3f} px {'apart' if gap > 0.0 else 'deep'}" for gap in gaps)
    angle = degrees(atan2(float(deepest["normal_y"]), float(deepest["normal_x"])))
    again = ", used again as it was" if int(deepest["previous"]) >= 0 else ""
    text = f"{points}: {how}; normal at {angle:.0f} deg, from A to B{again}"
    return Part("narrow phase", text + _stage(world, "narrow_phase"))


def _warm_start(world, mine):
    known = int(mine["persisted_1"].sum() + (mine["persisted_2"] & (mine["count"] > 1)).sum())
    if not known:
        return Part("warm start", "all is new here: the solver begins at nothing")
    points = count_text(int(mine["count"].sum()), "point")
    return Part("warm start", f"{known} of {points} known: the solver begins at what they bore before")


def _solver(world, mine):
    second = mine["count"] > 1
    normal = float(mine["normal_impulse_1"].sum() + mine["normal_impulse_2"][second].sum())
    tangent = float(mine["tangent_impulse_1"].sum() + mine["tangent_impulse_2"][second].sum())
    count = world.substeps
    effort = "" if not world.effects.stacking else ", substeps by load" if count == "auto" else f", {count} substeps"
    words = f"pushed by {amount_text(normal)} {IMPULSE} along the normal" if normal > 0.0 else "bears nothing"
    if world.effects.friction:
        words += f", held by {amount_text(abs(tangent))} {IMPULSE} along it"
    return Part(f"solver, {plain_name(world.solver)}{effort}", words + _stage(world, world.solver))
