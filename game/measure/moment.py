"""One moment of a world, to be stepped on under other settings: what a step costs there, and where it leads.

The scene's own rules take no part: bodies go on with the velocities that they have, so that all settings do the same
work, and what is timed is the physics and nothing else. Times and ways are never taken in one pass.
"""

from collections import Counter
from typing import NamedTuple

import numpy as np

from game.measure.setting import SUBSTEPPED, Setting
from game.measure.staged import seconds_of_stage
from game.measure.timing import seconds_a_step
from game.wishes import STEPS, Act
from physics import BROADPHASES, DYNAMIC, Effects, Snapshot, World


class Moment:
    """A snapshot, and the settings under which it was taken: `here`. broadphase: the name of the strategy there."""

    def __init__(self, snapshot: Snapshot, broadphase: str) -> None:
        facts = snapshot.facts
        self.snapshot = snapshot
        self.effects = Effects.named(facts["effects"])
        self.tiered = tuple(identity for identity, _, _ in facts["tiers"])
        tier = facts["tiers"][0][1] if facts["tiers"] else None
        self.here = setting_of(self.effects, broadphase, facts["solver"], facts["substeps"], tier)

    def world(self, setting: Setting) -> World:
        """The world of this moment under a setting."""
        facts = self.snapshot.facts
        strategy = BROADPHASES[setting.broadphase]()
        world = World(self.effects, strategy, pixels_per_meter=facts["pixels_per_meter"])
        world.restore(self.snapshot)
        # Another solver wakes all; the one that the snapshot brings lets them sleep on.
        if setting.solver is not None and setting.solver != world.solver:
            world.solver = setting.solver
        if setting.substeps is not None and setting.substeps != world.substeps:
            world.substeps = setting.substeps
        if setting.tier is not None and setting.tier != self.here.tier:
            for identity in self.tiered:
                world.body(identity).tier = setting.tier
        if setting.narrowphase != self.effects.narrowphase:
            world.set_narrowphase(setting.narrowphase)
        return world

    def time_run(self, setting: Setting, steps: int = STEPS, stage: str | None = None, act: Act | None = None) -> float:
        """Seconds a step of one run from this moment on. The first run of a setting also compiles: leave it out.

        stage: only what this stage took, 0 where the step has none of that name; None: the whole step. act: what is
        done in place of steps, after one step, from which the broad phase knows what there is, and one untimed call.
        """
        world = self.world(setting)
        if stage is not None:
            return seconds_of_stage(world, stage, steps) if stage in world.stages else 0.0
        if act is None:
            return seconds_a_step(world.step, steps)
        world.step()
        do = act.made_for(world)
        do()
        return seconds_a_step(do, steps)

    def way(self, setting: Setting, steps: int = STEPS, divided: int = 1) -> "Way":
        """Where the bodies go from this moment on; divided: each step is made in so many."""
        world = self.world(setting)
        return follow(world, steps, divided)


class Way(NamedTuple):
    """Where all bodies were after each step, and what was seen on the way."""

    places: np.ndarray  # (steps, bodies, 2) centres of mass [px], in the order of ids
    moves: np.ndarray  # (bodies,) bool: dynamic
    overlap: np.ndarray  # (steps,) the deepest that contacts tell [px]
    failures: dict[str, int]  # cap hits, bodies put aside, steps with a place that is not finite

    def apart(self, other: "Way") -> np.ndarray:
        """(steps,) root mean square over the moving bodies of how far this way is from another [px]."""
        gaps = self.places[:, self.moves] - other.places[: len(self.places), self.moves]
        if not gaps.size:
            return np.zeros(len(self.places))
        return np.sqrt((gaps * gaps).sum(axis=2).mean(axis=1))


def follow(world: World, steps: int, divided: int = 1) -> Way:
    """Step a world and note its way."""
    places, overlap = [], []
    failures = Counter()
    dt = world.dt / divided
    for _ in range(steps):
        for _ in range(divided):
            world.step(dt)
            failures += failures_of(world)
        rows = world.bodies
        order = np.argsort(rows["id"])
        place = np.stack([rows["center_x"], rows["center_y"]], axis=1)[order]
        if not np.isfinite(place).all():
            failures["not_finite"] += 1
        places.append(place)
        separations = world.contacts["separation"]
        overlap.append(max(0.0, -float(separations.min())) if len(separations) else 0.0)
    moves = (world.bodies["kind"] == DYNAMIC)[np.argsort(world.bodies["id"])]
    return Way(np.array(places), moves, np.array(overlap), failures)


def failures_of(world: World) -> Counter[str]:
    """What went wrong in the last step, by how often; what did not is not there."""
    return +Counter(cap_hits=world.profile.counters["cap_hits"], put_aside=len(world.events.quarantined))


def here_of(world: World, tier: str | None) -> Setting:
    """The setting under which a world runs; tier: of its sprites, None where they have none."""
    return setting_of(world.effects, world.broadphase.name, world.solver, world.substeps, tier)


def setting_of(effects: Effects, broadphase: str, solver: str, substeps: int | str, tier: str | None) -> Setting:
    """A Setting without what the effects have no use for."""
    used = solver if effects.response else None
    return Setting(broadphase, effects.narrowphase, used, substeps if used in SUBSTEPPED else None, tier)
