"""Tables of a world between steps, the StepState that the stages of a step share, and the work counters."""

from collections.abc import Callable
from typing import Any, Protocol, cast

import numpy as np

from physics.settings import Tolerances

# ---- counters --------------------------------------------------------------------------------------------------------
# Work counters of a step: their names, and the index of each in the int64 array that kernels add to.

COUNTERS = (
    "bodies_integrated",  # bodies moved by their velocities
    "nodes_visited",  # cells, tree nodes or list entries that the broad phase read
    "pairs_tested",  # pairs of boxes that the broad phase compared
    "candidates",  # pairs that passed broad phase and filters, world.candidates
    "filtered",  # pairs of boxes that overlap and that a filter rejected
    "narrow_tests",  # pairs of shapes whose geometry was tested
    "mask_tests",  # tests in which pixels of a mask were read
    "contacts",  # contact points of pairs that touch
    "toi_calls",  # searches for a time of impact
    "solver_rows",  # contact points that the solver solved
    "tangent_rows",  # of these, points with friction
    "restitution_rows",  # of these, points that bounced
    "gjk_iterations",  # rounds of GJK in searches for a time of impact
    "cap_hits",  # searches that reached their greatest number of rounds, and islands that need more substeps
    "sensor_tests",  # pairs with a sensor whose geometry was tested
    "joints_solved",  # joints that the solver solved
    "islands",  # awake islands
    "carved_pixels",  # pixels that Body.carve removed since the last step
    "swaps",  # places by which boxes moved in the order of sweep and prune
    "reinserts",  # boxes inserted again into the tree or grid
    "cells_touched",  # cells of the grid into which boxes were written
)
(
    BODIES_INTEGRATED, NODES_VISITED, PAIRS_TESTED, CANDIDATES, FILTERED, NARROW_TESTS, MASK_TESTS,
    CONTACTS, TOI_CALLS, SOLVER_ROWS, TANGENT_ROWS, RESTITUTION_ROWS, GJK_ITERATIONS, CAP_HITS,
    SENSOR_TESTS, JOINTS_SOLVED, ISLANDS, CARVED_PIXELS, SWAPS, REINSERTS, CELLS_TOUCHED,
) = range(len(COUNTERS))  # fmt: skip


# ---- world tables ----------------------------------------------------------------------------------------------------
# WorldTables: the common fields of a World, between steps, and of the StepState of a step.


class WorldTables(Protocol):
    """Fields that a World and the StepState of its step have in common.

    Functions that run both between and within steps take a WorldTables, for example those for sleeping and waking. A
    field is annotated Any if its type belongs to a package that imports this one.
    """

    awake: Any  # islands.awake.Awake
    sleeping_set: Any  # islands.sleep.SleepingSet
    pairs: Any  # broadphase.proxies.PairList
    touching_pairs: Any  # events.Pairs
    sensing_pairs: Any
    library: Any  # shapes.library.Library
    tolerances: Tolerances
    workspace: Any  # step.Workspace

    @property
    def contact_rows(self) -> np.ndarray:
        """CONTACT rows, sorted by the ids of their shapes."""
        ...

    @contact_rows.setter
    def contact_rows(self, rows: np.ndarray) -> None: ...

    @property
    def joints(self) -> np.ndarray:
        """JOINT rows of all joints."""
        ...

    @property
    def bodies(self) -> np.ndarray:
        """BODY rows of all bodies."""
        ...

    @property
    def shapes(self) -> np.ndarray:
        """SHAPE rows of all shapes."""
        ...

    @property
    def effects(self) -> Any:
        """Effects of the world: which parts of the simulation are switched on."""
        ...

    @property
    def stacks(self) -> bool:
        """Whether the world's solver keeps contacts from step to step (contact cache)."""
        ...

    @property
    def gravity(self) -> tuple[float, float]:
        """Gravity [px/s2]."""
        ...

    @property
    def dt(self) -> float:
        """Step length [s]."""
        ...


# ---- step state ------------------------------------------------------------------------------------------------------
# StepState: the data that the stages of a step pass to each other, and the declaration of the fields of each stage.
#
# A stage is a plain function of the state. `@stage(name, reads=…, writes=…)` names the fields that the stage reads and
# writes; a single column of a table is named as in "bodies.vx". A test compares all other fields byte for byte before
# and after the stage. Data that outlives a step belongs to the world: `begin` puts it into the state, and `finish`
# stores it in the world again (both in step.py).

STAGE_FIELDS = (
    # settings of the world
    "effects",
    "stacks",  # whether the solver has a contact cache
    "tolerances",
    "gravity",  # [px/s2]
    "drag",  # [1/s]
    "wind",  # [px/s]
    "dt",  # [s]
    "span",  # averaging window of the cached contact forces [s]; at least dt
    "substeps",  # number of substeps; 0: each island chooses its number by the accuracy
    "accuracy",  # [px] greatest sag of a contact under its load
    "broadphase",
    "steps",  # number of steps before this one
    "kept_forces",  # accumulated forces before a step of length 0, which keeps them for the next step; otherwise None
    # tables
    "bodies",  # BODY rows
    "shapes",  # SHAPE rows
    "characters",  # CHARACTER rows
    "joints",  # JOINT rows
    "joint_solver",  # "iterative", "direct" or "auto"
    "library",  # corners, tiles and pixels of the shapes
    # bodies and shapes by sleeping
    "awake",  # the awake body and shape rows, which the passes visit
    "sleeping_set",
    # broad phase and narrow phase
    "queries",  # index of shapes for queries by boxes
    "pairs",  # the pair list: proxies and candidate pairs
    "changed_count",  # number of proxies whose swept AABB changed
    "impacts",  # (n, 8) candidate, fraction, normal, stops, feature, point or nan; computed before the bodies move
    "contact_rows",  # CONTACT rows in the order of shape ids; until the narrow phase the rows of the last step
    "sensed",  # CONTACT rows of sensor contacts; None if `contact_rows` includes them
    "non_finite_count",  # number of bodies that a solver left non-finite or beyond the limits
    "swept_sensors",  # CONTACT rows of sensors that the sweep hit
    "ghosts",  # (n, 8) bodies stopped by a sweep: id, path, fraction; None if there are none
    "fell_asleep",  # (CONTACT rows, island key of each) of islands that fell asleep in this step; None: none
    # reports
    "touching_pairs",  # the touching pairs
    "sensing_pairs",  # the pairs with a sensor
    "events",
    "reported",  # contacts to report: (CONTACT rows, bool for each row whether it is reported; None: all)
    "work",  # work counters, int64
    "workspace",  # reusable scratch arrays, see step.Workspace
)


class StepState:
    """Data that the stages of a step pass to each other. The comments of STAGE_FIELDS describe the fields.

    A field is annotated Any if its type belongs to a package that imports this one.
    """

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
    joints: np.ndarray
    joint_solver: str
    library: Any  # shapes.library.Library
    awake: Any  # islands.awake.Awake
    sleeping_set: Any  # islands.sleep.SleepingSet
    queries: Any  # queries.index.QueryIndex
    pairs: Any  # broadphase.proxies.PairList
    changed_count: int
    impacts: np.ndarray
    contact_rows: np.ndarray
    sensed: np.ndarray | None
    non_finite_count: int
    swept_sensors: np.ndarray
    ghosts: np.ndarray | None
    fell_asleep: tuple[np.ndarray, np.ndarray] | None
    touching_pairs: Any  # events.Pairs
    sensing_pairs: Any
    events: Any  # events.Events
    reported: tuple[np.ndarray, np.ndarray | None]
    work: np.ndarray
    workspace: Any  # step.Workspace


class Stage(Protocol):
    """Type of a stage: a function of a StepState that declares which of the state's fields it reads and writes."""

    stage: str
    reads: tuple[str, ...]
    writes: tuple[str, ...]

    def __call__(self, state: StepState) -> None: ...


def stage(
    name: str, reads: tuple[str, ...] = (), writes: tuple[str, ...] = ()
) -> Callable[[Callable[[StepState], None]], Stage]:
    """Return a decorator that declares a function of a StepState as a stage of the step.

    name: name of the stage in `world.stages`; reads, writes: names of the fields that the stage reads and writes.
    Raises ValueError for an unknown field.
    """
    for each in (*reads, *writes):
        if each.split(".")[0] not in STAGE_FIELDS:
            raise ValueError(f"a stage may read and write {', '.join(STAGE_FIELDS)} (got {each!r} for {name!r})")

    def mark(function: Callable[[StepState], None]) -> Stage:
        marked = cast(Stage, function)
        marked.stage, marked.reads, marked.writes = name, tuple(reads), tuple(writes)
        return marked

    return mark
