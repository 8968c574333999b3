"""StepState: what the stages of a step hand on to each other, the work counters, and the tables of a world."""

from collections.abc import Callable
from typing import Any, Protocol, cast

import numpy as np

from physics.settings import Tolerances

# ---- counters --------------------------------------------------------------------------------------------------------
# The work that a step counts: names of the counters, and the place of each in the int64 array that kernels add to.

COUNTERS = (
    "bodies_integrated",
    "nodes_visited",
    "pairs_tested",
    "candidates",
    "filtered",
    "narrow_tests",
    "mask_tests",
    "contacts",
    "toi_calls",
    "solver_rows",
    "tangent_rows",
    "restitution_rows",
    "gjk_iterations",
    "cap_hits",
    "sensor_tests",
    "joints_solved",
    "islands",
    "carved_pixels",
    "swaps",
    "reinserts",
    "cells_touched",
)
(
    BODIES_INTEGRATED,
    NODES_VISITED,
    PAIRS_TESTED,
    CANDIDATES,
    FILTERED,
    NARROW_TESTS,
    MASK_TESTS,
    CONTACTS,
    TOI_CALLS,
    SOLVER_ROWS,
    TANGENT_ROWS,
    RESTITUTION_ROWS,
    GJK_ITERATIONS,
    CAP_HITS,
    SENSOR_TESTS,
    JOINTS_SOLVED,
    ISLANDS,
    CARVED_PIXELS,
    SWAPS,
    REINSERTS,
    CELLS_TOUCHED,
) = range(len(COUNTERS))


# ---- world tables ----------------------------------------------------------------------------------------------------
# WorldTables: what a world between steps and the StepState of a step both have.


class WorldTables(Protocol):
    """For what is done to a world between steps, and in a step alike: falling asleep, waking, new rectangles.

    Any stands for what is defined in a folder to the right of this one.
    """

    manifolds: np.ndarray  # MANIFOLD rows
    anchors: np.ndarray  # ANCHOR rows beside them, in worlds that stack
    awake: Any  # dynamics.awake.Awake
    sleepers: Any  # dynamics.sleepers.Sleepers
    pairs: Any  # broadphase.pair_list.PairList
    touching: Any  # events.Pairs
    sensing: Any
    library: Any  # shapes.library.Library
    tolerances: Tolerances
    workspace: Any  # step.Workspace

    @property
    def bodies(self) -> np.ndarray:
        """BODY rows."""
        ...

    @property
    def shapes(self) -> np.ndarray:
        """SHAPE rows."""
        ...

    @property
    def effects(self) -> Any:
        """The declared Effects."""
        ...

    @property
    def stacks(self) -> bool:
        """Whether the solver is one whose contacts remember."""
        ...

    @property
    def gravity(self) -> tuple[float, float]:
        """[px/s2]."""
        ...

    @property
    def dt(self) -> float:
        """[s]."""
        ...


# ---- step state ------------------------------------------------------------------------------------------------------
# StepState: what the stages of a step hand on to each other, and what each of them says it touches.
#
# A stage is a plain function of the state. `@stage(name, reads=…, writes=…)` names the fields that it looks at and
# those that it changes, single columns of a table as "bodies.vx"; a test compares every other field byte for byte
# around it. What lasts longer than a step lies in the world, which gives it to the state and takes it back at the end.

STAGE_FIELDS = (
    # what the world was asked for
    "effects",
    "stacks",  # whether the solver is one whose contacts remember
    "tolerances",
    "gravity",  # [px/s2]
    "drag",  # [1/s]
    "wind",  # [px/s]
    "dt",  # [s]
    "span",  # [s] that what contacts remember of their forces is a mean of; no less than dt
    "substeps",  # 0: as many as each island asks for, …
    "accuracy",  # [px] … so that no contact sinks further
    "broadphase",
    "steps",  # made before this one
    "kept_forces",  # collected for a step of some length, when this one has none; else None
    # tables
    "bodies",  # BODY rows
    "shapes",  # SHAPE rows
    "characters",  # CHARACTER rows
    "library",  # corners, tiles and pixels of the shapes
    # what is awake: the rows that a pass goes over
    "awake",
    "sleepers",
    # from boxes to manifolds
    "queries",  # the look-up of shapes by boxes
    "pairs",  # the pair list: proxies and candidates
    "changed_count",  # slots whose rectangle changed
    "impacts",  # (n, 8) candidate, fraction, normal, stops, feature, point or nan: found before the bodies move
    "manifolds",  # MANIFOLD rows in the order of shape ids: of the step before, until the narrow phase
    "anchors",  # ANCHOR rows beside them, in worlds that stack
    "sensed",  # MANIFOLD rows with sensors; None where they stand among the others
    "unsound",  # bodies that a solver has put nowhere, or made faster than any can be
    "swept_sensors",  # MANIFOLD rows of sensors that were met on the way
    "ghosts",  # (n, 8) bodies that a sweep stopped: id, path, fraction; None without any
    "parked",  # MANIFOLD rows of what fell asleep in this step
    # what is told
    "touching",  # the pairs that touch
    "sensing",  # the pairs of which one is a sensor
    "events",
    "told",  # (MANIFOLD rows, which of them count), of what touches
    "work",  # counters, int64
    "workspace",  # arrays that are grown and used again; nothing in them outlives a stage
)


class StepState:
    """The fields of STAGE_FIELDS for one step. Any stands for what is defined in a folder to the right of this one."""

    __slots__ = STAGE_FIELDS

    effects: Any  # effects.Effects
    stacks: bool
    tolerances: Tolerances
    gravity: tuple[float, float]
    drag: float
    wind: tuple[float, float]
    dt: float
    span: float
    substeps: int
    accuracy: float
    broadphase: Any  # broadphase.proxies.Strategy
    steps: int
    kept_forces: np.ndarray | None
    bodies: np.ndarray
    shapes: np.ndarray
    characters: np.ndarray
    library: Any  # shapes.library.Library
    awake: Any  # dynamics.awake.Awake
    sleepers: Any  # dynamics.sleepers.Sleepers
    queries: Any  # queries.index.QueryIndex
    pairs: Any  # broadphase.pair_list.PairList
    changed_count: int
    impacts: np.ndarray
    manifolds: np.ndarray
    anchors: np.ndarray
    sensed: np.ndarray | None
    unsound: int
    swept_sensors: np.ndarray
    ghosts: np.ndarray | None
    parked: tuple[np.ndarray, np.ndarray] | None
    touching: Any  # events.Pairs
    sensing: Any
    events: Any  # events.Events
    told: tuple[np.ndarray, np.ndarray | None]
    work: np.ndarray
    workspace: Any  # step.Workspace


class Stage(Protocol):
    """A function of a StepState that says what it touches."""

    stage: str
    reads: tuple[str, ...]
    writes: tuple[str, ...]

    def __call__(self, state: StepState) -> None: ...


def stage(
    name: str, reads: tuple[str, ...] = (), writes: tuple[str, ...] = ()
) -> Callable[[Callable[[StepState], None]], Stage]:
    """Mark a function of a StepState as a stage: its name in `world.stages`,
    the fields it reads and those it writes."""
    for each in (*reads, *writes):
        if each.split(".")[0] not in STAGE_FIELDS:
            raise ValueError(f"a stage may read and write {', '.join(STAGE_FIELDS)} (got {each!r} for {name!r})")

    def mark(function: Callable[[StepState], None]) -> Stage:
        marked = cast(Stage, function)
        marked.stage, marked.reads, marked.writes = name, tuple(reads), tuple(writes)
        return marked

    return mark
