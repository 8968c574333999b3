"""Broad phases on four layouts of 100 to 50,000 bodies: µs per step while none, 2 % or all of the bodies move.

The tables also show how the time grows with the number of bodies. The boxes are 12 px wide, with about one overlap per
body in the even layout. Brute force is left out where a step takes seconds. The last table shows which broad phase
suits which layout.
"""

import math
from functools import partial

import numpy as np

from game.report.charts import broadphases as charts
from physics import BROADPHASES, Bounds, BruteForce, Circle, Effects, Polygon, SweepAndPrune, World
from tests.bench.timing import best_in_turns, table

SIZES = (100, 1000, 10_000, 50_000)
BRUTE_LIMIT = 10_000
STEPS = 32  # of which a time is the mean: two rounds of rectangles that reach ahead
LEAST_TOLD = 1000  # fewer bodies take some 10 µs, which is not much beside the step around them
SPEED = 60.0  # px/s


def giant(rng, n):
    """Return (positions, extra bodies) of a layout with one body as wide as the area of the others.

    The other n - 1 bodies are evenly spread. extra bodies: list of (shape, position).
    """
    places, _ = charts.even(rng, n - 1)
    width = charts.SPACING * math.sqrt(n)
    return places, [(Polygon.box(width, 40.0), (width / 2, width))]


def alone(layout):
    """Return a layout for LAYOUTS with the positions of a layout of the report, and without extra bodies."""
    return lambda rng, n: (layout(rng, n)[0], [])


LAYOUTS = {
    "even": alone(charts.even),
    "along the ground": alone(charts.line),
    "crowds": alone(charts.clusters),
    "one giant": giant,
}
MOVING = {"all moving": 1.0, "2 % moving among still ones": 0.02, "nothing moving": 0.0}  # shares of the bodies


def make_world(strategy, layout, n, moving):
    """Return a world in which a share `moving` of the bodies moves: 0, 0.02 or 1."""
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


def step_time(world):
    """Return the mean time of the broad phase in a step [s].

    It is a mean over several steps, because the broad phase does not search for moving bodies in each of them.
    """
    spent = 0.0
    for _ in range(STEPS):
        world.step()
        spent += world.profile.stages["broad_phase"]
    return spent / STEPS


class Findings:
    """Measured times {(share of moving bodies, layout, size): {broad phase: seconds}}, and ratios of these times."""

    def __init__(self):
        self.times = {}

    def keep(self, moving, layout, size, strategy, seconds):
        """Store the time of one measurement."""
        self.times.setdefault((moving, layout, size), {})[strategy] = seconds

    def fastest(self, moving, layout, size):
        """Return the fastest broad phase for a layout and size as text, such as "tree (1.4x)".

        The number in brackets is the time of the next best broad phase divided by that of the fastest.
        """
        (best, name), (second, _) = sorted((t, name) for name, t in self.times[moving, layout, size].items())[:2]
        return f"{name} ({second / best:.1f}x)"

    def ratios(self):
        """Return {name: time of a broad phase / time of brute force}.

        Cases without moving bodies, without a time of brute force or with fewer than LEAST_TOLD bodies are left out.
        """
        return {
            f"{size} bodies {layout}, {moving}: {name} / brute": seconds / found["brute"]
            for (moving, layout, size), found in self.times.items()
            for name, seconds in found.items()
            if "brute" in found and name != "brute" and MOVING[moving] and size >= LEAST_TOLD
        }


def growth(times):
    """Return the exponent with which the time grows with the number of bodies. times: {number of bodies: time}.

    It is computed from the second size and the last one.
    """
    sizes = sorted(times)
    return math.log(times[sizes[-1]] / times[sizes[1]]) / math.log(sizes[-1] / sizes[1])


def timed(strategies, layout, n, moving):
    """Return {broad phase: function}. A function steps its world and returns the time of the broad phase [s].

    Broad phases that test every pair or sort both axes are left out above BRUTE_LIMIT bodies.
    """
    return {
        name: partial(step_time, make_world(make(), layout, n, moving))
        for name, make in strategies.items()
        if n <= BRUTE_LIMIT or name not in ("brute", "every pair, every step", "sweep both axes")
    }


def run(quick=False):
    """Print the tables. Return {name: time of a broad phase / time of brute force}.

    quick: True leaves out the largest size.
    """
    sizes = SIZES[:3] if quick else SIZES
    strategies = {
        **BROADPHASES,
        "every pair, every step": lambda: BruteForce(incremental=False),
        "sweep both axes": lambda: SweepAndPrune(axes="both"),
    }
    findings = Findings()
    for label, moving in MOVING.items():
        rows = []
        for layout in LAYOUTS:
            times = {name: {} for name in strategies}
            for n in sizes:
                least = best_in_turns(3, timed(strategies, layout, n, moving))
                for name, seconds in least.items():
                    times[name][n] = seconds
                    findings.keep(label, layout, n, name, seconds)
            for name, found in times.items():
                cells = [f"{1e6 * found[n]:.0f}" if n in found else "-" for n in sizes]
                rows.append([f"{layout}, {name}", *cells, f"n^{growth(found):.2f}" if moving else ""])
        table(f"Broad phase, {label}: µs per step", ("layout, strategy", *map(str, sizes), "growth from 1,000"), rows)
    rows = [
        [f"{label}, {layout}", *(findings.fastest(label, layout, n) for n in sizes)]
        for label, moving in MOVING.items()
        if moving
        for layout in LAYOUTS
    ]
    table("Fastest (and how much slower the next one is)", ("", *map(str, sizes)), rows)
    return findings.ratios()
