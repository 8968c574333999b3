"""Time of joints in nets of 760 and 4,900 joints, in Hitbox and in pymunk: nanoseconds per joint and step.

    python -m tests.bench.joints

A net of n x n balls hangs on its two upper corners and swings; each ball is pinned to its neighbours, as in Box2D's
benchmark JointGrid. Two more tables show the time of a sleeping net, and the cost of the effect of joints in a world
that has none.

Runs advance in turns, one step each, so that other load on the machine affects them alike. The median of the processor
time is printed. Hitbox takes 4 substeps, or as many as the loads need; pymunk takes ten iterations a step.
"""

import importlib
import itertools
import statistics
from time import process_time
from typing import Any

from physics import Circle, Effects, Filter, Polygon, Revolute, World
from tests.bench.timing import table

STEP, STEPS, WARM = 16.0, 60, 20
EFFECTS = Effects.rigid_bodies().with_(joints=True, sleeping=False)
OURS = {
    "default settings": {},
    "4 substeps": {"substeps": 4},
    "4 substeps, direct": {"substeps": 4, "tier": "direct"},
    "sequential_impulse": {"solver": "sequential_impulse"},
    "sequential_impulse, 4 substeps": {"solver": "sequential_impulse", "substeps": 4},
}


def joints_of(wide):
    """Return the pairs of neighbouring balls in a net of wide x wide balls, each as ((row, column), (row, column))."""
    places = list(itertools.product(range(wide), repeat=2))
    return [((j, i), (j, i + 1)) for j, i in places if i + 1 < wide] + [
        ((j, i), (j + 1, i)) for j, i in places if j + 1 < wide
    ]


def net(wide: int, tier: Any = "auto", effects: Effects = EFFECTS, **settings) -> World:
    """Return a world with a net of wide x wide balls. tier: its joint solver."""
    world = World(effects, **settings)
    world.joint_solver = tier
    at = [(STEP * i, STEP * j) for j in range(wide) for i in range(wide)]
    ids = world.add_bodies(Circle(6.0), at, filter=Filter(1, 0))
    ends = [tuple(ids[j * wide + i] for j, i in pair) for pair in joints_of(wide)]
    middles = [
        tuple((at[j * wide + i][k] + at[m * wide + n][k]) / 2 for k in (0, 1)) for (j, i), (m, n) in joints_of(wide)
    ]
    world.add_joints(Revolute, [a for a, _ in ends], [b for _, b in ends], at=middles)
    for corner in (ids[0], ids[wide - 1]):
        world.add_joint(Revolute(None, int(corner), at=world.body(int(corner)).position))
    return world


def space(wide: int):
    """Return a function that steps the same net in pymunk. Raises ModuleNotFoundError if pymunk is not installed."""
    pymunk: Any = importlib.import_module("pymunk")
    found = pymunk.Space()
    found.gravity, found.iterations = (0.0, 9.8 * 32.0), 10
    balls = {}
    for j, i in itertools.product(range(wide), repeat=2):
        body = balls[j, i] = pymunk.Body(1.0, pymunk.moment_for_circle(1.0, 0.0, 6.0))
        body.position = STEP * i, STEP * j
        shape = pymunk.Circle(body, 6.0)
        shape.filter = pymunk.ShapeFilter(group=1)
        found.add(body, shape)
    for one, two in joints_of(wide):
        a, b = balls[one], balls[two]
        found.add(pymunk.PivotJoint(a, b, (a.position + b.position) / 2))
    for corner in (balls[0, 0], balls[0, wide - 1]):
        found.add(pymunk.PivotJoint(found.static_body, corner, corner.position))
    return lambda: found.step(1.0 / 60.0)


def medians(runs: dict, steps: int = STEPS) -> dict:
    """Return {name: median nanoseconds of a step}. runs: {name: function that steps}, called in turns."""
    spent = {name: [] for name in runs}
    for step in range(WARM + steps):
        for name, run in runs.items():
            started = process_time()
            run()
            if step >= WARM:
                spent[name].append(1e9 * (process_time() - started))
    return {name: statistics.median(times) for name, times in spent.items()}


def asleep(wide: int) -> World:
    """Return a world whose net of wide x wide balls has come to rest in air and sleeps."""
    world = net(wide, effects=EFFECTS.with_(sleeping=True, drag=True), drag=4.0)
    for _ in range(6000):
        world.step()
        if not world.bodies["awake"].any():
            return world
    raise RuntimeError("the net is awake after 100 s")


def boxes(joints: bool) -> World:
    """Return a world of 400 boxes that fall on a floor, without any joint.

    joints: True declares the effect of joints nevertheless.
    """
    world = World(Effects.rigid_bodies().with_(sleeping=False, joints=joints), substeps=4)
    world.add_body(Polygon.box(2000, 20), position=(200, 420), kind="static")
    world.add_bodies(Polygon.box(16, 16), [(20.0 * (k % 20), 20.0 * (k // 20)) for k in range(400)])
    return world


def main() -> None:
    """Measure, and print the tables."""
    rows = []
    for wide in (20, 50):
        count = 2 * wide * (wide - 1)
        runs = {name: net(wide, **settings).step for name, settings in OURS.items()} | {"pymunk": space(wide)}
        rows += [(f"{count}", name, f"{spent / count:.0f}") for name, spent in medians(runs).items()]
    table("A net of joints", ("joints", "engine", "ns a joint and step"), rows)
    resting, empty = asleep(20), World(EFFECTS)
    spent = medians({"a net of 760 joints asleep": resting.step, "an empty world": empty.step})
    table("Asleep", ("world", "us a step"), [(name, f"{each / 1e3:.1f}") for name, each in spent.items()])
    spent = medians({f"joints={each}": boxes(each).step for each in (False, True)})
    table(
        "No joints", ("400 boxes, effects", "us a step"), [(name, f"{each / 1e3:.0f}") for name, each in spent.items()]
    )


if __name__ == "__main__":
    main()
