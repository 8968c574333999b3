"""World: owns the tables and runs the stages. Start reading at `step`."""

from collections.abc import Iterable
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from physics import checks, editing, snapshot
from physics.body import Body
from physics.broadphase.pair_list import PairList
from physics.broadphase.proxies import Strategy
from physics.broadphase.spatial_hash import SpatialHashGrid
from physics.checks import Pair
from physics.digest import digest
from physics.dynamics.awake import Awake
from physics.dynamics.sleepers import Sleepers
from physics.effects import Effects
from physics.environment import Environment, checked_accuracy, checked_substeps, own_solver
from physics.events import Events, Pairs
from physics.jit import tiers
from physics.queries.index import QueryIndex
from physics.questions import Questions
from physics.settings import PIXELS_PER_METER, POSITION_LIMIT, STANDARD_GRAVITY, tolerances
from physics.shapes.filter import Filter
from physics.shapes.kinds import Shape
from physics.shapes.library import Library
from physics.shapes.material import Material
from physics.snapshot import Snapshot
from physics.step import Workspace, begin, finish, plans, step_length
from physics.tables.body import BODY, GIVEN
from physics.tables.character import CHARACTER
from physics.tables.manifold import ANCHOR, MANIFOLD
from physics.tables.shape import SHAPE
from physics.tables.table import Table
from physics.vec2 import Vec2

PLAIN = Material()  # of bodies that are given none


class World(Environment, Questions):
    """Bodies, the effects they live under, and the stages that those call for.

    effects: what the scene calls for, None = Effects.rigid_bodies(); broadphase: an instance of one of the four, None =
    SpatialHashGrid(); solver: one of SOLVERS, None = soft_step with the effect stacking, else projection; gravity
    [px/s2], None = 9.8 m/s2 down; drag [1/s]; wind [px/s]; dt [s]; substeps: how often the stacking solvers look at the
    contacts in a step; "auto": 4 to 32 times, each island as often as keeps its contacts from sinking further than
    accuracy [px], None = 1 mm; what leans up to 128 times. What needs more is counted in cap_hits. Raises TypeError or
    ValueError naming the argument.
    """

    def __init__(
        self,
        effects: Effects | None = None,
        broadphase: Strategy | None = None,
        solver: str | None = None,
        gravity: Pair | None = None,
        drag: float = 0.0,
        wind: Pair = (0, 0),
        pixels_per_meter: float = PIXELS_PER_METER,
        dt: float = 1 / 60,
        substeps: int | str = "auto",
        accuracy: float | None = None,
        seed: int = 0,
    ) -> None:
        effects = Effects.rigid_bodies() if effects is None else effects
        if not isinstance(effects, Effects):
            raise TypeError(f"effects must be an Effects (got {checks.shown(effects)})")
        self.tolerances = tolerances(checks.number("pixels_per_meter", pixels_per_meter, above=0.0))
        self._dt = checks.number("dt", dt, above=0.0)
        self._drag = checks.number("drag", drag, low=0.0)
        self._gravity = (
            Vec2(0.0, STANDARD_GRAVITY * self.tolerances.pixels_per_meter)
            if gravity is None
            else checks.vector("gravity", gravity)
        )
        self._wind = checks.vector("wind", wind)
        self.random = np.random.default_rng(checks.whole("seed", seed, 0, 2**63 - 1))
        self._effects = effects
        self._substeps, self._accuracy = checked_substeps(substeps), checked_accuracy(accuracy)
        self._solver = self._checked_solver(own_solver(effects) if solver is None else solver)
        self._bodies, self._given, self._shapes, self.characters = map(Table, (BODY, GIVEN, SHAPE, CHARACTER))
        self.library = Library()
        self._stepping = False
        self._next_body = self._next_shape = self._carved_pixels = 0
        self._users, self._shapes_of, self._tiers, self._sources, self._targets = {}, {}, {}, {}, {}
        # What is remembered from step to step.
        self.pairs, self.awake, self.sleepers = PairList(), Awake(False), Sleepers()
        self.manifolds, self.anchors = np.zeros(0, MANIFOLD), np.zeros(0, ANCHOR)
        self.sensed = self.ghosts = self.workspace = None
        self.touching, self.sensing = Pairs(), Pairs()
        # What the last step told.
        self.tell_contacts(self.manifolds)
        self.queries, self.events, self.steps, self.time, self.span = QueryIndex(), Events(), 0, 0.0, 0.0
        self.broadphase = SpatialHashGrid() if broadphase is None else broadphase
        self._plan()

    def __getstate__(self):
        return {name: value for name, value in vars(self).items() if name not in ("workspace", "_plans")}

    def __setstate__(self, state):
        vars(self).update(state)
        self.workspace, self._plans = Workspace(self._effects, self._solver), plans(self._effects, self._solver)

    # --- the step ------------------------------------------------------------------------------------------------

    def step(self, dt: float | None = None) -> None:
        """Advance by dt [s] (None: world.dt). 0 moves nothing, and keeps forces and targets for the next step; so does
        what is shorter than SHORTEST_STEP.

        Raises ValueError for a negative or non-finite dt."""
        self._unlocked()
        if tiers.arrived:
            tiers.take_over()
        dt = step_length(self, dt)
        stages, names = self._plan_now
        spent = self.profile.begin(names)
        self._stepping = True
        try:
            state = begin(self, dt)
            started = perf_counter()
            for stage in stages:
                stage(state)
                ended = perf_counter()
                spent.append(ended - started)
                started = ended
            finish(self, state)
        finally:
            self._stepping = False

    # --- adding and removing ---------------------------------------------------------------------------------------

    def add_body(
        self,
        *shapes: Shape,
        position: Pair = (0, 0),
        angle: float = 0.0,
        kind: str = "dynamic",
        velocity: Pair = (0, 0),
        angular_velocity: float = 0.0,
        mass: float | None = None,
        material: Material = PLAIN,
        filter: Filter = Filter.ALL,
        sensor: bool = False,
        bullet: bool = False,
        continuous: str = "auto",
        fixed_rotation: bool = False,
        gravity_scale: float = 1.0,
        tier: str | None = None,
        user: Any = None,
    ) -> Body:
        """Add one body. mass: in place of what its shapes' densities make of it.

        Raises TypeError or ValueError naming the argument; the world is unchanged then."""
        ids = editing.add_rows(
            self,
            shapes,
            [checks.position("position", position)],
            [checks.vector("velocity", velocity)],
            [checks.number("angle", angle)],
            editing.Wanted(
                kind,
                angular_velocity,
                mass,
                material,
                filter,
                sensor,
                bullet,
                continuous,
                fixed_rotation,
                gravity_scale,
                tier,
                user,
            ),
        )
        return Body(self, int(ids[0]))

    def add_bodies(
        self,
        shape: Shape,
        positions: ArrayLike,
        velocities: ArrayLike | None = None,
        angles: ArrayLike | None = None,
        kind: str = "dynamic",
        angular_velocity: float = 0.0,
        mass: float | None = None,
        material: Material = PLAIN,
        filter: Filter = Filter.ALL,
        sensor: bool = False,
        bullet: bool = False,
        continuous: str = "auto",
        fixed_rotation: bool = False,
        gravity_scale: float = 1.0,
        tier: str | None = None,
        user: Any = None,
    ) -> np.ndarray:
        """Add a body of one shape at each of positions (n, 2) [px]. Returns their ids. Raises as add_body."""
        positions = checks.columns("positions", positions)
        if np.any(np.abs(positions) >= POSITION_LIMIT):
            raise ValueError(
                f"positions must lie within {POSITION_LIMIT:g} px of the origin (got {positions.tolist()})"
            )
        n = len(positions)
        velocities = np.zeros((n, 2)) if velocities is None else checks.columns("velocities", velocities, n)
        angles = np.zeros(n) if angles is None else checks.columns("angles", angles, n, width=1)
        return editing.add_rows(
            self,
            (shape,),
            positions,
            velocities,
            angles,
            editing.Wanted(
                kind,
                angular_velocity,
                mass,
                material,
                filter,
                sensor,
                bullet,
                continuous,
                fixed_rotation,
                gravity_scale,
                tier,
                user,
            ),
        )

    def remove_body(self, body: Body | int) -> None:
        """Remove a body (or its id). Raises KeyError when it is not there, TypeError, ValueError."""
        self._remove([self._identity("body", body)])

    def remove_bodies(self, ids: Body | int | Iterable[Body | int] | np.ndarray) -> None:
        """Remove many bodies (or ids) at once: one pass over the tables. Raises KeyError for one that is not there,
        ValueError for one that is named twice, TypeError; nothing is removed then."""
        self._remove(self._identities("ids", ids))

    def touch(self, ids: Body | int | Iterable[Body | int] | np.ndarray) -> None:
        """Say that columns of these bodies (an id or a Body, or many) were written: what is dynamic wakes, and their
        boxes follow in the next step. Awake bodies, and worlds without the effect sleeping, need no touch. Raises
        KeyError, TypeError, ValueError; nothing is touched then."""
        self._unlocked()
        editing.touch(self, ids)

    def clear(self) -> None:
        """Remove every body, and what is kept of their shapes. Ids go on from where they were."""
        self.remove_bodies(self.bodies["id"])

    # --- digest, snapshot ------------------------------------------------------------------------------------

    def digest(self) -> str:
        """blake2b-128 of the state that the next step depends on, independent of rows, times and broad phase."""
        return digest(self)

    def snapshot(self) -> Snapshot:
        """A copy of the state."""
        return snapshot.take(self)

    def restore(self, taken: Snapshot) -> None:
        """Go back to a snapshot: bodies, time, random numbers, and the settings solver, dt, substeps, gravity, drag,
        wind. The broad phase, and the `user` of bodies that are there, stay.

        Raises ValueError when it does not fit this version's tables, this world's effects or pixels_per_meter."""
        self._unlocked()
        snapshot.restore(self, taken)
