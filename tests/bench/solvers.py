"""Pyramids of 10 to 5,050 boxes for 10 s, with each solver of this project and with pymunk, side by side.

Boxes of 32 px stand on the ground and on one another, with friction 0.6, gravity 10 m/s2 and 60 steps/s; nothing
sleeps. All runs of a size advance in turns of a second each, so that other load on the machine affects them alike.

soft_step and sequential_impulse run with the settings 1, 2, 4 and 8 substeps, soft_step also with as many as the loads
need ("auto"). sequential_impulse makes 2.5 passes in place of each substep. The projection pushes out and does not
stack, so it is shown at the small sizes only. pymunk runs at its defaults: 10 iterations, no substeps and a collision
slop of 0.1 px. Hitbox has a slop of 0.16 px, which it does not use at rest.

Two more tables show the times of the stages with four substeps, and the cost of a world that sleeps.
"""

import math
from statistics import median
from time import perf_counter

import numpy as np

from game.report.piles import BOX, EFFECTS, GRAVITY, overlap, pyramid, world_of
from game.report.pymunk_piles import overlap_in, space_of
from tests.bench.timing import table

ROWS = (4, 10, 20, 45, 100)  # 10, 55, 210, 1,035, 5,050 boxes
SECONDS, RATE = 10, 60
PROJECTION_LIMIT = 20  # rows


class Ours:
    """A pyramid in a Hitbox world."""

    def __init__(self, rows, solver, substeps, effects=EFFECTS):
        self.name = f"{solver} {substeps}" if solver != "projection" else solver
        self.world = world_of(pyramid(rows), solver, substeps, effects)
        self.step = self.world.step

    def state(self):
        """Return (x, y), (vx, vy) and the angular velocity of the boxes."""
        rows = self.world.bodies[1:]
        return np.stack([rows["x"], rows["y"]]), np.stack([rows["vx"], rows["vy"]]), rows["angular_velocity"]

    def depth(self):
        return overlap(self.world)


class Pymunk:
    """The same pyramid in pymunk."""

    def __init__(self, rows):
        self.name = "pymunk"
        self.space = space_of(pyramid(rows))

    def step(self):
        self.space.step(1 / RATE)

    def state(self):
        bodies = self.space.bodies
        return (
            np.array([body.position for body in bodies]).T,
            np.array([body.velocity for body in bodies]).T,
            np.array([body.angular_velocity for body in bodies]),
        )

    def depth(self):
        """Return the overlap of the deepest contact [px]; it is called outside the timed steps."""
        return overlap_in(self.space)


class Run:
    """One solver's run with a pyramid: its step times and its state at the end."""

    def __init__(self, pile):
        self.pile, self.times = pile, []
        (x, y), _, _ = pile.state()
        self.start = np.stack([x, y])
        self.depth = self.gain = 0.0
        self.energy = self._energy()

    def _energy(self):
        """Return the kinetic and potential energy of the boxes per unit of mass, summed [px2/s2]."""
        (_, y), velocity, spin = self.pile.state()
        return float((0.5 * (velocity**2).sum(axis=0) + 0.5 * spin**2 * BOX * BOX / 6.0 - GRAVITY * y).sum())

    def advance(self, steps):
        clock, step = perf_counter, self.pile.step
        for _ in range(steps):
            start = clock()
            step()
            self.times.append(clock() - start)
        self.gain = max(self.gain, self._energy() - self.energy)

    def settle(self):
        """Measure the overlap at the end of the run, whether or not the pile has come to rest."""
        self.depth = self.pile.depth()

    def row(self, reference):
        (x, y), velocity, _ = self.pile.state()
        ms = 1e3 * median(self.times)
        sag = float((y - self.start[1])[-1])
        sunk = int((y - self.start[1] > BOX / 2).sum())
        # Energy against that of the top box's height, so that all sizes read alike.
        scale = GRAVITY * (BOX * math.sqrt(2 * len(x))) * len(x)
        return [
            self.pile.name,
            f"{ms:.3f}",
            f"{ms / reference:.2f}",
            f"{self.depth:.3f}",
            f"{sag:.2f}",
            f"{np.abs(x - self.start[0]).max():.2f}",
            f"{float(np.sqrt((velocity**2).sum(axis=0).mean())):.3f}",
            f"{100 * self.gain / scale:+.3f} %",
            sunk or "",
        ]


HEADER = (
    "solver, substeps",
    "ms/step",
    "x pymunk",
    "overlap px",
    "top sinks px",
    "sway px",
    "speed px/s",
    "energy won",
    "sunk by half",
)


def measure(rows, seconds):
    """Step one pyramid with pymunk and with all solvers, in turns of a second each, and print the table.

    Return {name: median time of a step / that of pymunk}. rows: number of rows of the pyramid; seconds: simulated time.
    """
    piles = [
        Ours(rows, solver, substeps) for solver in ("soft_step", "sequential_impulse") for substeps in (1, 2, 4, 8)
    ]
    piles.append(Ours(rows, "soft_step", "auto"))
    if rows <= PROJECTION_LIMIT:
        piles.append(Ours(rows, "projection", 1))
    for pile in piles:  # compiled before the clock runs, on a world of its own
        Ours(3, pile.world.solver, 1).step()
    runs = [Run(pile) for pile in (Pymunk(rows), *piles)]
    for _ in range(seconds):
        for run in runs:
            run.advance(RATE)
    for run in runs:
        run.settle()
    reference, boxes = median(runs[0].times), rows * (rows + 1) // 2
    table(
        f"Pyramid of {boxes:,} boxes of {BOX:.0f} px, {seconds} s: medians; overlap and speed at the end",
        HEADER,
        [run.row(1e3 * reference) for run in runs],
    )
    return {f"{boxes} boxes, {run.pile.name} / pymunk": median(run.times) / reference for run in runs[1:]}


PASSES = 2 * 4  # of a step over its contacts: each of four substeps solves them and relaxes them


def measure_stages(every):
    """Measure the time of each stage of a step with four substeps, and print the table.

    Return {name: time of the narrow phase / time of the step}. every: numbers of rows of the pyramids to measure. The
    table also shows the time of a pass, which includes preparing and storing: the time of the solver's stage divided by
    the numbers of manifolds and passes.
    """
    lines, ratios = [], {}
    for rows in every:
        pile, boxes = Ours(rows, "soft_step", 4), rows * (rows + 1) // 2
        told = []
        for _ in range((SECONDS - 2) * RATE):  # it has settled by then, as far as it does
            pile.step()
        for _ in range(2 * RATE):
            pile.step()
            told.append(dict(pile.world.profile.stages))
        middle = {name: median(each[name] for each in told) for name in pile.world.stages}
        whole, manifolds = sum(middle.values()), pile.world.profile.counters["narrow_tests"]
        shares = {name: spent / whole for name, spent in middle.items()}
        others = 1.0 - sum(shares[name] for name in ("broad_phase", "narrow_phase", "soft_step"))
        ratios[f"{boxes} boxes, narrow phase / step"] = shares["narrow_phase"]
        lines.append(
            [
                f"{boxes:,}",
                f"{1e3 * whole:.3f}",
                *(f"{100 * shares[name]:.1f} %" for name in ("broad_phase", "narrow_phase", "soft_step")),
                f"{100 * others:.1f} %",
                f"{1e9 * middle['soft_step'] / (manifolds * PASSES):.1f}",
            ]
        )
    header = ("boxes", "ms in stages", "broad phase", "narrow phase", "solver", "others", "ns a manifold and pass")
    table("Where a step of four substeps goes: medians of the last two seconds", header, lines)
    return ratios


def measure_sleep(rows):
    """Measure a step while all bodies are awake and a step while all sleep, and print the table.

    Return {name: time asleep / time awake}. rows: number of rows of the pyramid.
    """
    lines, ratios, boxes = [], {}, rows * (rows + 1) // 2
    for solver in ("soft_step", "sequential_impulse"):
        awake, asleep = Ours(rows, solver, 4), Ours(rows, solver, 4, EFFECTS.with_(sleeping=True))
        for _ in range(20 * RATE):
            if not asleep.world.bodies["awake"][1:].any():
                break
            asleep.step()
        for _ in range(RATE):
            awake.step()
        runs = [Run(awake), Run(asleep)]
        for _ in range(6):
            for run in runs:
                run.advance(RATE // 2)
        slow, fast = (1e3 * median(run.times) for run in runs)
        ratios[f"{boxes} boxes, {solver}, asleep / awake"] = fast / slow
        lines.append(
            [
                solver,
                f"{slow:.3f}",
                f"{fast:.4f}",
                f"{100 * fast / slow:.1f} %",
                int(asleep.world.bodies["awake"][1:].sum()) or "",
            ]
        )
    table(
        f"{boxes:,} boxes awake, and asleep (at most 5 % of that)",
        ("solver", "awake ms", "asleep ms", "share", "still awake"),
        lines,
    )
    return ratios


def run(quick=False):
    """Measure all pyramids and print the tables. Return {name: ratio of two times}.

    The names say which two: a solver and pymunk, the narrow phase and the whole step, or a sleeping and an awake world.
    quick: True measures fewer and smaller pyramids.
    """
    ratios = {}
    every = ROWS[1:3] if quick else ROWS
    for rows in every:
        ratios |= measure(rows, 3 if quick else SECONDS)
    return ratios | measure_stages(every) | measure_sleep(20 if quick else 45)
