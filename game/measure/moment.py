"""A snapshot of a world, stepped under other settings: the time of a step and the resulting motion.

The scene's rules do not run, so that only the physics is timed, and every setting does the same work. Times and motions
are always measured in separate runs.
"""

from collections import Counter
from typing import NamedTuple

import numpy as np

from game.measure.setting import SUBSTEPPED, Setting
from game.measure.staged import seconds_of_stage
from game.measure.timing import seconds_a_step
from game.measurement_requests import STEPS, Act
from physics import BROADPHASES, DYNAMIC, Effects, Snapshot, World
from physics.annotations import JointSolverName, SolverName, Substeps, TierName

PINNED, ON_AXIS, FREE, LENGTH = 1, 2, 0, 3  # values of the columns hold and coordinate, see physics.debug.joints
HOLDS = (PINNED, ON_AXIS)


class Moment:
    """Snapshot of a world. here: the setting of the world at that moment.

    broadphase: name of the world's broad phase.
    """

    def __init__(self, snapshot: Snapshot, broadphase: str) -> None:
        facts = snapshot.facts
        self.snapshot = snapshot
        self.effects = Effects.named(facts["effects"])
        self.tiered = tuple(identity for identity, _, _ in facts["tiers"])
        tier = facts["tiers"][0][1] if facts["tiers"] else None
        self.here = setting_of(
            self.effects, broadphase, facts["solver"], facts["substeps"], tier, facts["joint_solver"]
        )

    def world(self, setting: Setting) -> World:
        """Return a new world in the state of the snapshot, with the given setting."""
        facts = self.snapshot.facts
        strategy = BROADPHASES[setting.broadphase]()
        world = World(self.effects, strategy, pixels_per_meter=facts["pixels_per_meter"])
        world.restore(self.snapshot)
        # Setting another solver wakes all bodies; keeping the solver of the snapshot lets them sleep.
        if setting.solver is not None and setting.solver != world.solver:
            world.solver = setting.solver
        if setting.substeps is not None and setting.substeps != world.substeps:
            world.substeps = setting.substeps
        if setting.joint_solver is not None and setting.joint_solver != world.joint_solver:
            world.joint_solver = setting.joint_solver
        if setting.tier is not None and setting.tier != self.here.tier:
            for identity in self.tiered:
                world.body(identity).tier = setting.tier
        if setting.narrowphase != self.effects.narrowphase:
            world.set_narrowphase(setting.narrowphase)
        return world

    def time_run(self, setting: Setting, steps: int = STEPS, stage: str | None = None, act: Act | None = None) -> float:
        """Return the mean time of a step [s] in one run that starts from this snapshot.

        The first run of a setting also compiles kernels, so the caller must not count it.

        stage: name of the only stage to time, None for the whole step. The result is 0 if the step has no such stage.

        act: operation that is timed instead of the steps. Before it is timed, one step is made, which fills the broad
        phase, and the operation is called once.
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
        """Return the motion of the bodies in a run from this snapshot under a setting, as a Way.

        divided: number of shorter steps that replace each step.
        """
        world = self.world(setting)
        return follow(world, steps, divided)


class Way(NamedTuple):
    """Motion of the bodies in a run, recorded after each step.

    places: centres of mass of the bodies; overlap: depth of the deepest overlap; gaps: width of the widest gap of a
    joint; failures: counts of failures in the run, by kind.
    """

    places: np.ndarray  # (steps, bodies, 2) centres of mass [px], in the order of ids
    moves: np.ndarray  # (bodies,) bool: dynamic
    overlap: np.ndarray  # (steps,) the deepest overlap of the contacts [px]
    gaps: np.ndarray  # (steps,) the widest gap of a joint [px]
    failures: dict[str, int]  # cap hits, quarantined bodies, steps with a non-finite position

    def apart(self, other: "Way") -> np.ndarray:
        """Return (steps,) root mean square distance [px] of the dynamic bodies from their positions in another run."""
        gaps = self.places[:, self.moves] - other.places[: len(self.places), self.moves]
        if not gaps.size:
            return np.zeros(len(self.places))
        return np.sqrt((gaps * gaps).sum(axis=2).mean(axis=1))


def follow(world: World, steps: int, divided: int = 1) -> Way:
    """Make `steps` steps of a world, and return the motion of its bodies as a Way.

    divided: number of shorter steps that replace each step.
    """
    places, overlap, gaps = [], [], []
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
        gaps.append(widest_gap(world))
    moves = (world.bodies["kind"] == DYNAMIC)[np.argsort(world.bodies["id"])]
    return Way(np.array(places), moves, np.array(overlap), np.array(gaps), failures)


def failures_of(world: World) -> Counter[str]:
    """Return {kind: number} of the failures in the last step: cap hits and disabled bodies.

    A cap hit is an iteration that stopped at its limit.
    """
    return +Counter(cap_hits=world.profile.counters["cap_hits"], disable_body=len(world.events.quarantined))


def here_of(world: World, tier: TierName | None) -> Setting:
    """Return the current Setting of a world.

    tier: collision tier (kind of collision shape) of the world's sprites, None if there are none.
    """
    return setting_of(world.effects, world.broadphase.name, world.solver, world.substeps, tier, world.joint_solver)


def setting_of(
    effects: Effects,
    broadphase: str,
    solver: SolverName,
    substeps: Substeps,
    tier: TierName | None,
    joint_solver: JointSolverName,
) -> Setting:
    """Return the Setting of a world with these values.

    tier: collision tier (kind of collision shape) of the world's sprites, None if there are none. The fields `solver`,
    `substeps` and `joint_solver` are None if the effects do not use them.
    """
    used = solver if effects.response else None
    joints = joint_solver if effects.joints and used in SUBSTEPPED else None
    return Setting(broadphase, effects.narrowphase, used, substeps if used in SUBSTEPPED else None, tier, joints)


def widest_gap(world: World) -> float:
    """Return the widest gap [px] of any joint that holds anchors together; 0 if there is no such joint.

    A Target is ignored: it is the joint of a mouse drag, and its separation is the distance to the pointer.
    """
    rows = world.joints
    held = rows["separation"][np.isin(rows["hold"], HOLDS) & (rows["point_hertz"] == 0.0) & rows["enabled"]]
    lengths = rows["separation"][(rows["coordinate"] == LENGTH) & (rows["hold"] == FREE)]
    return float(max(held.max(initial=0.0), lengths.max(initial=0.0)))
