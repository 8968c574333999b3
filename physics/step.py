"""The step: its stages in order, the targets of kinematic bodies, and a step that pauses between stages."""

import warnings
from collections.abc import Generator
from time import perf_counter
from typing import NamedTuple, get_args

import numpy as np

from physics import checks, events
from physics.annotations import Pair, SolverName
from physics.broadphase.proxies import broad_phase, motion_rectangles
from physics.ccd.sweep import NO_IMPACTS, Sweeper, detect_moved, foresee_impacts, sweep_piles
from physics.character.carry import apply_character_weight, carry_characters
from physics.character.solids import new_scratch
from physics.collision.narrow_phase import SKIN, NarrowPhase, detect_ended
from physics.contacts.cache import update_contacts, update_contacts_at_final_poses
from physics.contacts.matching import ContactCache, find_contacts
from physics.dynamics.integrate import (
    integrate_positions,
    integrate_velocities,
    quarantine,
    quarantine_solved,
    refresh_centers,
)
from physics.edit import check_grid_stands
from physics.effects import Effects
from physics.islands import sleep
from physics.islands.awake import list_awake
from physics.islands.sleep import IslandWorkspace, rest, wake_disturbed
from physics.joint import NO_JOINTS, break_joints, keep_apart
from physics.settings import LONG_STEP, MILLISECONDS, SHORTEST_STEP, STALL
from physics.solver.blocking import IGNORED as IGNORED_BY_BLOCKING
from physics.solver.blocking import blocking
from physics.solver.contact_lanes import ContactLanes
from physics.solver.joint_report import mark_sleeping, measure_joints
from physics.solver.motions import Motions
from physics.solver.projection import IGNORED as IGNORED_BY_PROJECTION
from physics.solver.projection import PushSet, projection
from physics.solver.sequential_impulse import sequential_impulse
from physics.solver.soft_step import soft_step
from physics.tables.body import KINEMATIC
from physics.tables.contact import CONTACT
from physics.tables.step_state import CARVED_PIXELS, Stage, StepState, stage
from physics.tables.table import rows_of
from physics.teleport import check_no_character
from physics.world_state import WorldState

# ---- targets ---------------------------------------------------------------------------------------------------------
# Targets of kinematic bodies: the pose at the end of the next step, and the velocity that reaches this pose.
#
# Targets are set between steps. The velocity is computed at the start of the step, from the step length. At the end of
# the step, the pose is set exactly.


def set_target(world: WorldState, identity: int, position: Pair, angle: float | None) -> None:
    """Set the pose that a kinematic body (id) reaches at the end of the next step.

    position: (x, y) [px]; angle: [rad], None: unchanged. Raises TypeError for arguments of a wrong type; ValueError for
    a body that is not kinematic, a position too far away for one step, and a rotation of a TileGrid or without the
    effect `rotation`; KeyError for an unknown body; RuntimeError during a step.
    """
    world._unlocked()
    row = world._body_row(identity)
    x, y = checks.position("position", position)
    turned = float(row["angle"]) if angle is None else checks.angle("angle", angle)
    if row["kind"] != KINEMATIC:
        raise ValueError(f"set_target needs a kinematic body; body {identity} is not (got {checks.shown(position)})")
    check_no_character(world, identity, "the target")
    turn = turned - float(row["angle"])
    check_grid_stands(world._shapes_of[identity], turn, "the turn to angle")
    world._needs("rotation", f"set_target with angle {angle}", turn != 0.0)
    aimed = _velocities(world.bodies[[world._row_number(identity)]], np.array([(x, y, turned)]), world.dt)
    limit = world.tolerances.speed_limit
    if not np.abs(aimed[:, :2]).max() < limit:
        raise ValueError(f"position must be within {limit * world.dt:g} px of the body (got {checks.shown(position)})")
    row["vx"], row["vy"], row["angular_velocity"] = aimed[0]
    world._targets[identity] = (x, y, turned)
    if not row["awake"]:
        sleep.disturb(world, [identity])


def _velocities(bodies: np.ndarray, targets: np.ndarray, dt: float) -> np.ndarray:
    """Return the velocities (n, 3) with which n bodies reach their target poses in dt [s].

    The columns are the velocity x, y of the centre of mass [px/s] and the angular velocity [rad/s]. bodies: BODY rows
    (n,); targets: (n, 3) x, y [px], angle [rad].
    """
    cosine, sine = np.cos(targets[:, 2]), np.sin(targets[:, 2])
    x, y = bodies["local_center_x"], bodies["local_center_y"]
    return np.stack(
        [
            (targets[:, 0] + (cosine * x - sine * y) - bodies["center_x"]) / dt,
            (targets[:, 1] + (sine * x + cosine * y) - bodies["center_y"]) / dt,
            (targets[:, 2] - bodies["angle"]) / dt,
        ],
        axis=1,
    )


def _rows(world) -> tuple[np.ndarray, np.ndarray]:
    """Return (BODY row numbers (n,) of the bodies with a target, target poses (n, 3) x, y [px], angle [rad])."""
    return rows_of(world.bodies, np.array([*world._targets], np.int64)), np.array([*world._targets.values()])


def aim(world: WorldState, dt: float) -> None:
    """Set the velocities of all bodies with targets, so that they reach their targets in a step of dt [s].

    Do nothing for a step of length 0.
    """
    if not world._targets or dt == 0.0:
        return
    rows, targets = _rows(world)
    aimed = _velocities(world.bodies[rows], targets, dt)
    for k, name in enumerate(("vx", "vy", "angular_velocity")):
        world.bodies[name][rows] = aimed[:, k]


def arrive(world: WorldState, dt: float) -> None:
    """Set the poses of all bodies with targets exactly to the targets, and their velocities to 0. Clear the targets.

    A body that was quarantined (disabled) in the step is not moved. Do nothing for a step of length 0.
    """
    if not world._targets or dt == 0.0:
        return
    rows, targets = _rows(world)
    bodies = world.bodies
    there = ~bodies["quarantined"][rows]
    rows, targets = rows[there], targets[there]
    for k, name in enumerate(("x", "y", "angle")):
        bodies[name][rows] = targets[:, k]
    for name in ("vx", "vy", "angular_velocity"):
        bodies[name][rows] = 0.0
    refresh_centers(rows, bodies)
    world._targets.clear()


# ---- step ------------------------------------------------------------------------------------------------------------
# The step: the order of its stages by effects, and the state that the stages share.
#
# With a solver that does not stack, bodies first move, as far as the sweep allows, and are then pushed out of overlaps.
# With a stacking solver, contacts are found first, the solver solves them and moves the bodies, and fast bodies are
# moved back to their first impact. A stage that no effect needs is not in the plan: it never runs, and its kernels are
# never compiled.

SOLVERS: tuple[SolverName, ...] = get_args(SolverName)
STACKING = {"sequential_impulse": sequential_impulse, "soft_step": soft_step}
FORCES = ("force_x", "force_y", "torque")
NO_CONTACTS = np.zeros(0, CONTACT)
PUSHING = {"blocking": blocking, "projection": projection}
IGNORED = {"blocking": IGNORED_BY_BLOCKING, "projection": IGNORED_BY_PROJECTION}


@stage(
    "motion_rectangles",
    reads=(*quarantine.reads, *motion_rectangles.reads),
    writes=(*quarantine.writes, *motion_rectangles.writes),
)
def swept_aabbs_of_finite_bodies(state: StepState) -> None:
    """Quarantine (disable) bodies with invalid numbers, and write the swept AABBs of all other bodies."""
    quarantine(state)
    motion_rectangles(state)


@stage("rest", reads=(*rest.reads, "joints"), writes=(*rest.writes, "joints.awake"))
def evaluate_contacts_before_sleep(state: StepState) -> None:
    """Put islands at rest to sleep, and evaluate their contacts at the final poses.

    The stored contacts are therefore valid when the islands wake.
    """
    rest(state)
    if state.fell_asleep is not None:
        for key in np.unique(state.fell_asleep[1]).tolist():
            island = state.sleeping_set.islands[key]
            update_contacts(state.bodies, island.contacts)
        if len(state.joints):
            mark_sleeping(state.bodies, state.joints)


def own_solver(effects: Effects) -> SolverName:
    """Return the name of the default solver: "soft_step" with the effect `stacking`, otherwise "projection"."""
    return "soft_step" if effects.stacking else "projection"


def ignored_effects(effects: Effects, solver: str) -> tuple[str, ...]:
    """Return the names of the effects that are on and that a solver ignores, in the order of Effects.names().

    solver: name of the solver. Without the effect `response` no solver runs, and the result is empty.
    """
    ignored = IGNORED.get(solver, ()) if effects.response else ()
    return tuple(name for name in effects.names() if name in ignored)


class Plan(NamedTuple):
    """The stages of a step, in the order of execution, and the names of the stages in the same order."""

    stages: tuple[Stage, ...]
    names: tuple[str, ...]


def plan(effects: Effects, solver: str, characters: bool = True) -> Plan:
    """Return the Plan of a step with these effects and the named solver.

    characters: whether the world has a Character.
    """
    e = effects
    forces = e.gravity or e.drag or e.wind or e.response
    if solver in STACKING:
        stages = (
            (list_awake, e.sleeping),
            (quarantine, True),
            (apply_character_weight, characters),
            (motion_rectangles, True),
            (broad_phase, True),
            (find_contacts, True),
            (wake_disturbed, e.sleeping),
            (STACKING[solver], True),
            (quarantine_solved, True),
            (sweep_piles, e.continuous),
            (carry_characters, characters),
            (update_contacts_at_final_poses, True),
            (measure_joints, e.joints),
            (events.sense, e.sensors),
            (evaluate_contacts_before_sleep, e.sleeping),
            (events.report_events, True),
        )
    else:
        stages = (
            (
                apply_character_weight,
                e.stacking and characters,
            ),  # stacking is declared, but the present solver does not stack
            (integrate_velocities, forces),
            (swept_aabbs_of_finite_bodies, True),
            (broad_phase, True),
            (foresee_impacts, e.continuous),
            (integrate_positions, True),
            (carry_characters, e.response and characters),
            (detect_moved if e.continuous else detect_ended, True),
            (PUSHING[solver], e.response),
            (events.sense, e.response and e.sensors),
            (events.report_events, True),
        )
    called = tuple(each for each, wanted in stages if wanted)
    return Plan(called, tuple(each.stage for each in called))


def plans(effects: Effects, solver: str) -> tuple[Plan, Plan]:
    """Return the Plans of a step as (Plan for a world without a Character, Plan for a world with one)."""
    return plan(effects, solver, characters=False), plan(effects, solver)


class Workspace:
    """The scratch arrays of the stages of one world. They are reused in each step, and grow as needed.

    The contents of an array are valid only during one stage, except for CONTACT rows, which later stages read.
    """

    def __init__(self, effects: Effects, solver: str, slop: float) -> None:
        self.stacks = stacks = solver in STACKING
        boxes_only, one_way = not effects.narrowphase, effects.one_way
        self.narrow = NarrowPhase(False, one_way, boxes_only)
        if effects.response and solver != "blocking":
            self.narrow.skin = SKIN * slop
        # For the areas of mask contacts, which are computed on demand, only in worlds without response.
        self.telling = NarrowPhase(True, one_way, boxes_only) if not effects.response else None
        self.sensing = NarrowPhase(False, one_way, boxes_only) if effects.response and effects.sensors else None
        self.sweep = Sweeper() if effects.continuous or effects.response else None
        self.walk, self.walked = new_scratch(), np.zeros(4, np.int64)  # moved x, y; stopped x, y
        self.motions = Motions() if stacks else None
        self.contacts = ContactLanes() if stacks else PushSet()
        self.islands = IslandWorkspace() if effects.sleeping else None
        self.cache = ContactCache() if stacks else None
        self._rows, self.broken = np.zeros(16, np.int64), np.zeros((16, 2), np.int64)  # see quarantine

    def rows_for(self, count: int) -> np.ndarray:
        """Return a scratch array for row numbers, int64, with at least `count` elements. Its contents are undefined."""
        if len(self._rows) < count:
            self._rows = np.zeros(2 * count, np.int64)
        return self._rows


def next_span(span: float, dt: float, usual: float) -> float:
    """Return the averaging window [s] of the cached contact forces after a step of dt [s].

    span: window before the step [s]; usual: world.dt [s]. If dt >= span, the window is dt, but at most STALL times the
    greater of span and usual. For a shorter step, it is span - (span - dt) * dt / span.
    """
    if dt >= span:
        return min(dt, STALL * max(span, usual))
    return span - (span - dt) * dt / span


def step_length(world: WorldState, dt: float | None) -> float:
    """Check the argument dt of World.step, and return the length of the step [s].

    The length is world.dt if dt is None, 0 if dt < SHORTEST_STEP, otherwise dt. A warning is issued if dt is so long
    that it is probably in milliseconds. Raises TypeError if dt is not a number, ValueError if dt is negative, not
    finite, or an int of at least MILLISECONDS.
    """
    dt = world.dt if dt is None else checks.seconds("dt", dt, low=0.0)
    if dt >= max(MILLISECONDS, LONG_STEP * world.dt):
        text = f"World.step: dt is in seconds (got {dt:g}): write {dt:g} / 1000 if they are milliseconds"
        warnings.warn(text, stacklevel=3)
    return 0.0 if dt < SHORTEST_STEP else dt


def begin(world: WorldState, dt: float) -> StepState:
    """Prepare a step of dt [s]: set the velocities of bodies with targets, and return the StepState.

    The StepState contains the settings and tables of the world, and the contacts of the last step.
    """
    world.refresh_character_rows()
    if world._apart is not None:
        keep_apart(world)
    aim(world, dt)
    state = StepState()
    state.effects, state.stacks, state.tolerances = world.effects, world.stacks, world.tolerances
    state.workspace = world.workspace
    state.gravity, state.drag, state.wind = world.gravity, world.drag, world.wind
    state.dt, state.broadphase, state.accuracy = dt, world.broadphase, world.accuracy
    state.span = max(dt, world.span)
    state.substeps = 0 if world.substeps == "auto" else world.substeps
    state.bodies, state.shapes, state.characters = world.bodies, world.shapes, world.characters.rows
    state.joints, state.joint_solver = world.joints if world.effects.joints else NO_JOINTS, world.joint_solver
    state.queries, state.steps = world.queries, world.steps
    state.library, state.pairs = world.library, world.pairs
    state.awake, state.sleeping_set = world.awake, world.sleeping_set
    state.contact_rows = world.contact_rows
    state.touching_pairs, state.sensing_pairs = world.touching_pairs, world.sensing_pairs
    state.sensed, state.swept_sensors = world.sensed, NO_CONTACTS
    state.impacts, state.changed_count, state.non_finite_count = NO_IMPACTS, 0, 0
    state.ghosts = state.fell_asleep = state.kept_forces = None
    if dt == 0.0:
        state.kept_forces = world.bodies[[*FORCES]].copy()
    state.events, state.reported, state.work = events.Events(), (NO_CONTACTS, None), world.profile.work
    state.work[CARVED_PIXELS], world._carved_pixels = world._carved_pixels, 0
    if not world.awake.sleeping:
        world.awake.all_rows(state.bodies, state.shapes)
    return state


def finish(world: WorldState, state: StepState) -> None:
    """Complete a step: store the results in the world, move bodies to their targets, and advance the time."""
    world.contact_rows = state.contact_rows
    # One update instead of eight checks by __setattr__: 3 of 50 us of a step with ten boxes.
    vars(world).update(
        sensed=state.sensed,
        ghosts=state.ghosts,
        events=state.events,
        _reported=state.reported,
        _contacts=None,
        steps=world.steps + 1,
        time=world.time + state.dt,
        span=next_span(world.span, state.dt, world.dt),
    )
    if len(world.awake.fresh):
        world.bodies["dirty"][world.awake.fresh] = False
        world.awake.fresh = world.awake.fresh[:0]
    if world.effects.joints:
        break_joints(world, state.events)
    arrive(world, state.dt)
    if state.kept_forces is not None:
        # A step of length 0 uses no forces: restore the accumulated forces, without forces added by the stages.
        going_on = ~world.bodies["quarantined"]
        for name in FORCES:
            world.bodies[name][going_on] = state.kept_forces[name][going_on]


# ---- staged step -----------------------------------------------------------------------------------------------------
# A step that pauses after each of its stages, for inspection. World.step runs without pauses.


def staged_step(world: WorldState, dt: float | None = None) -> Generator[Stage | None, None, None]:
    """Run the step of World.step(dt) stage by stage. Yield None before the first stage, then each stage after its run.

    Between stages the world contains intermediate results: bodies, candidates, contacts, events, and the times and
    counters in world.profile. The world cannot be changed between stages, and is not valid for further steps. The
    caller must restore a snapshot if it stops before the last stage, or if it uses physics.debug or a query between
    stages.
    Raises ValueError for a negative or non-finite dt, RuntimeError during a step.
    """
    world._unlocked()
    dt = step_length(world, dt)
    stages, names = world._plan_now
    spent = world.profile.begin(names)
    world._stepping = True
    try:
        state = begin(world, dt)
        yield None
        for stage in stages:
            started = perf_counter()
            stage(state)
            spent.append(perf_counter() - started)
            _show(world, state)
            yield stage
        finish(world, state)
    finally:
        world._stepping = False


def _show(world: WorldState, state: StepState) -> None:
    """Store the results of the stages that have run so far in the world.

    Before the stage `events` has run, the contacts that touch so far are stored as the contacts of the world.
    """
    world.contact_rows, world.sensed = state.contact_rows, state.sensed
    world.ghosts, world.events = state.ghosts, state.events
    _, keep = state.reported
    world.report_contacts(*(state.reported if keep is not None else (state.contact_rows, _touching(state))))


def _touching(state: StepState) -> np.ndarray:
    """Return a bool for each CONTACT row of the step: whether it touches, by the rule of the stage `events`.

    A contact touches if it overlaps, has an impulse, or was found by the sweep. If its pair touched in the last step, a
    separation of at most the slop is enough. Contacts of sensors count as not touching.
    """
    rows, before = state.contact_rows, state.touching_pairs.rows
    second = rows["count"] > 1
    gap = np.minimum(rows["separation_1"], np.where(second, rows["separation_2"], np.inf))
    old = np.isin(rows["shape_a"] << 32 | rows["shape_b"], before["shape_a"] << 32 | before["shape_b"])
    pushed = (rows["normal_impulse_1"] > 0.0) | (second & (rows["normal_impulse_2"] > 0.0))
    return ((gap <= np.where(old, state.tolerances.slop, 0.0)) | pushed | rows["swept"]) & ~rows["sensor"]
