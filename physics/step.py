"""The step: what its stages hand on to each other, and which of them the declared effects call for, in order.

Without `stacking` bodies are moved first, as far as a sweep lets them, and pushed out of what they overlap afterwards.
With it contacts are found first, solved, and the bodies moved by the solver; what is fast is put back to where it met
something. A stage that no effect needs is not planned: it is not called, and its kernels are never compiled.
"""

from typing import NamedTuple

import numpy as np

from physics import checks, events
from physics.broadphase.pair_list import broad_phase
from physics.broadphase.rectangles import motion_rectangles
from physics.ccd.sweep import NO_IMPACTS, Sweeper, detect_moved, foresee_impacts, sweep_piles
from physics.character.carry import bear_characters, carry_characters
from physics.character.workspace import new_scratch
from physics.collision.detect import detect_ended, detect_piles, sense
from physics.collision.dispatch import NarrowPhase
from physics.collision.final_poses import settle_contacts
from physics.collision.follow import follow_bodies
from physics.dynamics.awake import list_awake
from physics.dynamics.integrate import integrate_positions, integrate_velocities
from physics.dynamics.quarantine import REASONS, quarantine, quarantine_solved
from physics.dynamics.rest import IslandWorkspace, rest
from physics.dynamics.sleep import wake_disturbed
from physics.effects import Effects
from physics.settings import SHORTEST_STEP, STALL
from physics.solver.blocking import IGNORED as IGNORED_BY_BLOCKING
from physics.solver.blocking import blocking
from physics.solver.contacts import ContactSet
from physics.solver.motions import Motions
from physics.solver.projection import IGNORED as IGNORED_BY_PROJECTION
from physics.solver.projection import projection
from physics.solver.pushes import PushSet
from physics.solver.sequential_impulse import sequential_impulse
from physics.solver.soft_step import soft_step
from physics.tables.counters import CARVED_PIXELS
from physics.tables.lines import zeros_in_lines
from physics.tables.manifold import ANCHOR, MANIFOLD
from physics.tables.step_state import Stage, StepState, stage
from physics.targets import aim, arrive
from physics.world_state import WorldState

SOLVERS = ("blocking", "projection", "sequential_impulse", "soft_step")
STACKING = {"sequential_impulse": sequential_impulse, "soft_step": soft_step}
FORCES = ("force_x", "force_y", "torque")
NO_MANIFOLDS = np.zeros(0, MANIFOLD)
PUSHING = {"blocking": blocking, "projection": projection}
IGNORED = {"blocking": IGNORED_BY_BLOCKING, "projection": IGNORED_BY_PROJECTION}


@stage(
    "motion_rectangles",
    reads=(*quarantine.reads, *motion_rectangles.reads),
    writes=(*quarantine.writes, *motion_rectangles.writes),
)
def sound_rectangles(state: StepState) -> None:
    """Where the bodies that are still finite can be."""
    quarantine(state)
    motion_rectangles(state)


@stage("rest", reads=rest.reads, writes=rest.writes)
def rest_exactly(state: StepState) -> None:
    """Who falls asleep keeps its contacts exactly where they stand: whoever wakes it has them solved as they are."""
    rest(state)
    if state.parked is not None:
        for key in np.unique(state.parked[1]).tolist():
            island = state.sleepers.islands[key]
            follow_bodies(state.bodies, island.anchors, island.manifolds)


def ignored_effects(effects: Effects, solver: str) -> tuple[str, ...]:
    """Return the names of the declared effects that a solver does not honour, in the order of Effects.names().

    Without the effect response no solver runs, and none is ignored.
    """
    ignored = IGNORED.get(solver, ()) if effects.response else ()
    return tuple(name for name in effects.names() if name in ignored)


class Plan(NamedTuple):
    """The stages of a step, in order, and their names."""

    stages: tuple[Stage, ...]
    names: tuple[str, ...]


def plan(effects: Effects, solver: str, characters: bool = True) -> Plan:
    """The stages that these effects call for, in order; characters: whether there are any."""
    e = effects
    forces = e.gravity or e.drag or e.wind or e.response
    if solver in STACKING:
        stages = (
            (list_awake, e.sleeping),
            (quarantine, True),
            (bear_characters, characters),
            (motion_rectangles, True),
            (broad_phase, True),
            (detect_piles, True),
            (wake_disturbed, e.sleeping),
            (STACKING[solver], True),
            (quarantine_solved, True),
            (sweep_piles, e.continuous),
            (carry_characters, characters),
            (settle_contacts, True),
            (sense, e.sensors),
            (rest_exactly, e.sleeping),
            (events.tell, True),
        )
    else:
        stages = (
            (bear_characters, e.stacking and characters),  # under another solver for the moment
            (integrate_velocities, forces),
            (sound_rectangles, True),
            (broad_phase, True),
            (foresee_impacts, e.continuous),
            (integrate_positions, True),
            (carry_characters, e.response and characters),
            (detect_moved if e.continuous else detect_ended, True),
            (PUSHING[solver], e.response),
            (sense, e.response and e.sensors),
            (events.tell, True),
        )
    called = tuple(each for each, wanted in stages if wanted)
    return Plan(called, tuple(each.stage for each in called))


def plans(effects: Effects, solver: str) -> tuple[Plan, Plan]:
    """The stages of a world while it has no character, and while it has some."""
    return plan(effects, solver, characters=False), plan(effects, solver)


class Workspace:
    """Arrays that the stages of one world grow and use again. Nothing in them outlives a stage."""

    def __init__(self, effects: Effects, solver: str) -> None:
        self.stacks = stacks = solver in STACKING
        boxes_only, one_way = not effects.narrowphase, effects.one_way
        self.narrow = NarrowPhase(False, one_way, boxes_only)
        # When somebody looks at contacts of masks: where they push, their outlines have told all.
        self.telling = NarrowPhase(True, one_way, boxes_only) if not effects.response else None
        self.sensing = NarrowPhase(False, one_way, boxes_only) if effects.response and effects.sensors else None
        self.sweep = Sweeper() if effects.continuous or effects.response else None
        self.walk, self.walked = new_scratch(), np.zeros(4, np.int64)  # moved x, y; stopped x, y
        self.motions = Motions() if stacks else None
        self.contacts = ContactSet() if stacks else PushSet()
        self.islands = IslandWorkspace() if effects.sleeping else None
        # Two tables of contacts and their anchors: those that there are, and room for those of the next step.
        self._manifolds = [zeros_in_lines(16, MANIFOLD) for _ in range(2 if stacks else 0)]
        self._anchors = [zeros_in_lines(16, ANCHOR) for _ in range(2 if stacks else 0)]
        self._rows, self.ends = np.zeros(16, np.int64), np.zeros(len(REASONS), np.int64)  # see quarantine

    def contacts_beside(self, manifolds: np.ndarray, anchors: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Room for so many MANIFOLD and ANCHOR rows in tables that do not hold these: between steps either may have
        been replaced."""
        for rows, tables in ((manifolds, self._manifolds), (anchors, self._anchors)):
            if rows.base is tables[0].base:
                tables.reverse()
        if min(len(self._manifolds[0]), len(self._anchors[0])) < count:
            self._manifolds[0], self._anchors[0] = (
                zeros_in_lines(2 * count, MANIFOLD),
                zeros_in_lines(2 * count, ANCHOR),
            )
        return self._manifolds[0], self._anchors[0]

    def rows_for(self, count: int) -> np.ndarray:
        """Room for that many row numbers."""
        if len(self._rows) < count:
            self._rows = np.zeros(2 * count, np.int64)
        return self._rows


def next_span(span: float, dt: float, usual: float) -> float:
    """The time [s] that contacts have forces of after a step of dt [s]: its length; where the steps before were longer
    it counts for as much as it lasts, and a stall for no more than a few of them, or of the usual ones."""
    if dt >= span:
        return min(dt, STALL * max(span, usual))
    return span - (span - dt) * dt / span


def step_length(world: WorldState, dt: float | None) -> float:
    """The time [s] that a step takes: None, the world's own; what is shorter than any is none. Raises ValueError."""
    dt = world.dt if dt is None else checks.number("dt", dt, low=0.0)
    return 0.0 if dt < SHORTEST_STEP else dt


def begin(world: WorldState, dt: float) -> StepState:
    """What the first stage is given: the world's settings and tables, and what it remembers of the last step."""
    world.refresh_character_rows()
    aim(world, dt)
    state = StepState()
    state.effects, state.stacks, state.tolerances = world.effects, world.stacks, world.tolerances
    state.workspace = world.workspace
    state.gravity, state.drag, state.wind = world.gravity, world.drag, world.wind
    state.dt, state.broadphase, state.accuracy = dt, world.broadphase, world.accuracy
    state.span = max(dt, world.span)
    state.substeps = 0 if world.substeps == "auto" else world.substeps
    state.bodies, state.shapes, state.characters = world.bodies, world.shapes, world.characters.rows
    state.queries, state.steps = world.queries, world.steps
    state.library, state.pairs, state.awake, state.sleepers = world.library, world.pairs, world.awake, world.sleepers
    state.manifolds, state.anchors = world.manifolds, world.anchors
    state.touching, state.sensing = world.touching, world.sensing
    state.sensed, state.swept_sensors = world.sensed, NO_MANIFOLDS
    state.impacts, state.changed_count, state.unsound = NO_IMPACTS, 0, 0
    state.ghosts = state.parked = state.kept_forces = None
    if dt == 0.0:
        state.kept_forces = world.bodies[[*FORCES]].copy()
    state.events, state.told, state.work = events.Events(), (NO_MANIFOLDS, None), world.profile.work
    state.work[CARVED_PIXELS], world._carved_pixels = world._carved_pixels, 0
    if not world.awake.sleeping:
        world.awake.all_rows(state.bodies, state.shapes)
    return state


def finish(world: WorldState, state: StepState) -> None:
    """What the world keeps of a step."""
    world.manifolds, world.anchors, world.sensed = state.manifolds, state.anchors, state.sensed
    world.ghosts, world.events = state.ghosts, state.events
    world.tell_contacts(*state.told)
    if len(world.awake.fresh):
        world.bodies["stirred"][world.awake.fresh] = False
        world.awake.fresh = world.awake.fresh[:0]
    arrive(world, state.dt)
    if state.kept_forces is not None:
        # In no time they did nothing: they are for the next step, and what the stages added is not.
        going_on = ~world.bodies["quarantined"]
        for name in FORCES:
            world.bodies[name][going_on] = state.kept_forces[name][going_on]
    world.steps += 1
    world.time += state.dt
    world.span = next_span(world.span, state.dt, world.dt)
