"""The four strategies on four layouts, 100 to 50,000 bodies: µs per step with nothing, few and all moving, and growth.

Boxes of 8 to 16 px, about one overlap per body when even. Brute force stops where a step takes seconds. The claims of
the design (which strategy suits which layout) stand or fall by the last table.
"""

import math

import numpy as np

from physics import BROADPHASES, Bounds, Circle, Effects, Polygon, SweepAndPrune, World
from tests.bench.timing import table

SIZES = (100, 1000, 10_000, 50_000)
BRUTE_LIMIT = 10_000
SPACING = 22.0  # px between even bodies
SPEED = 60.0  # px/s


def even(rng, n):
    return rng.uniform(0, SPACING * math.sqrt(n), (n, 2)), []


def line(rng, n):
    """Clustered along the ground: long and low."""
    return np.column_stack([rng.uniform(0, 0.5 * SPACING * n, n), rng.exponential(20.0, n)]), []


def clusters(rng, n):
    """A hundredth as many crowds, each 60 px around its middle."""
    middles = rng.uniform(0, SPACING * math.sqrt(n), (max(1, n // 100), 2))
    return middles[rng.integers(0, len(middles), n)] + rng.normal(0, 60.0, (n, 2)), []


def giant(rng, n):
    """Even bodies over one that is as wide as all of them."""
    places, _ = even(rng, n - 1)
    width = SPACING * math.sqrt(n)
    return places, [(Polygon.box(width, 40.0), (width / 2, width))]


LAYOUTS = {"even": even, "along the ground": line, "crowds": clusters, "one giant": giant}


def make_world(strategy, layout, n, moving):
    """A world of which a share of the bodies moves: 0, 0.02 or 1."""
    rng = np.random.default_rng(5)
    places, giants = LAYOUTS[layout](rng, n)
    world = World(Effects(narrowphase=False), strategy)
    movers = max(1, round(moving * len(places))) if moving else 0
    world.add_bodies(Bounds(Circle(6.0)), places[movers:], kind="static" if moving < 1 else "dynamic")
    angle = rng.uniform(0, math.tau, movers)
    world.add_bodies(Bounds(Circle(6.0)), places[:movers], SPEED * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    for shape, position in giants:
        world.add_body(shape, position=position, kind="static")
    world.step()
    return world


def step_time(world, runs):
    """Least seconds of the broad phase of a step."""
    least = math.inf
    for _ in range(runs):
        world.step()
        least = min(least, world.profile.stages["broad_phase"])
    return least


def run(quick=False):
    sizes = SIZES[:3] if quick else SIZES
    strategies = {name: make for name, make in BROADPHASES.items()}
    strategies["sweep both axes"] = lambda: SweepAndPrune(axes="both")
    best = {}
    for moving, label in ((1.0, "all moving"), (0.02, "2 % moving among still ones"), (0.0, "nothing moving")):
        rows = []
        for layout in LAYOUTS:
            for name, make in strategies.items():
                times = {}
                for n in sizes:
                    if name == "brute" and n > BRUTE_LIMIT or name == "sweep both axes" and n > BRUTE_LIMIT:
                        continue
                    world = make_world(make(), layout, n, moving)
                    times[n] = 1e6 * step_time(world, 3 if n > 5000 else 20)
                ends = sorted(times)
                growth = (
                    math.log(times[ends[-1]] / times[ends[1]]) / math.log(ends[-1] / ends[1])
                    if moving
                    else float("nan")
                )
                rows.append(
                    [f"{layout}, {name}"]
                    + [f"{times[n]:.0f}" if n in times else "-" for n in sizes]
                    + ["" if math.isnan(growth) else f"n^{growth:.2f}"]
                )
                for n in times:
                    key = (label, layout, n)
                    best.setdefault(key, []).append((times[n], name))
        table(f"Broad phase, {label}: µs per step", ("layout, strategy", *map(str, sizes), "growth from 1,000"), rows)
    rows = [
        [f"{label}, {layout}"]
        + [
            sorted(best[label, layout, n])[0][1]
            + " "
            + f"({sorted(best[label, layout, n])[1][0] / sorted(best[label, layout, n])[0][0]:.1f}x)"
            for n in sizes
        ]
        for label, layout in sorted({key[:2] for key in best})
        if label != "nothing moving"
    ]
    table("Fastest (and how much slower the next one is)", ("", *map(str, sizes)), rows)
