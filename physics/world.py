"""World: owns the tables and runs the stages. Start reading at `step`."""

from bisect import bisect_left
from time import perf_counter

import numpy as np

from physics import checks, editing, snapshot
from physics.body import Body
from physics.broadphase.pair_list import PairList
from physics.broadphase.rectangles import write_rectangles
from physics.broadphase.spatial_hash import SpatialHashGrid
from physics.collision.manifold import contacts_of
from physics.dynamics import sleep
from physics.dynamics.awake import Awake
from physics.dynamics.sleepers import Sleepers
from physics.effects import Effects
from physics.environment import Environment
from physics.events import Events, Pairs
from physics.profile import Profile
from physics.queries import casts as queries
from physics.queries.index import QueryIndex
from physics.settings import PIXELS_PER_METER, POSITION_LIMIT, STANDARD_GRAVITY, tolerances
from physics.shapes.filter import Filter
from physics.shapes.library import Library
from physics.shapes.material import Material
from physics.step import Workspace, begin, finish, plan
from physics.tables.body import BODY, DYNAMIC, STATIC
from physics.tables.character import CHARACTER
from physics.tables.manifold import ANCHOR, MANIFOLD
from physics.tables.rows import rows_of
from physics.tables.shape import SHAPE
from physics.tables.table import Table

PLAIN = Material()  # of bodies that are given none


class World(Environment):
    """Bodies, the effects they live under, and the stages that those call for.

    effects: what the scene calls for, None = Effects.rigid_bodies(); broadphase: an instance of one of the four, None =
    SpatialHashGrid(); solver: one of SOLVERS, None = soft_step with the effect stacking, else projection; gravity
    [px/s2], None = 9.8 m/s2 down; drag [1/s]; wind [px/s]; dt [s]; substeps: how often the stacking solvers look at the
    contacts in a step. Raises TypeError or ValueError naming the argument.
    """

    def __init__(
        self,
        effects=None,
        broadphase=None,
        solver=None,
        gravity=None,
        drag=0.0,
        wind=(0, 0),
        pixels_per_meter=PIXELS_PER_METER,
        dt=1 / 60,
        substeps=4,
        seed=0,
    ):
        effects = Effects.rigid_bodies() if effects is None else effects
        if not isinstance(effects, Effects):
            raise TypeError(f"effects must be an Effects (got {effects!r})")
        self.tolerances = tolerances(checks.number("pixels_per_meter", pixels_per_meter, above=0.0))
        self._dt = checks.number("dt", dt, above=0.0)
        self._drag = checks.number("drag", drag, low=0.0)
        self._gravity = (
            (0.0, STANDARD_GRAVITY * self.tolerances.pixels_per_meter)
            if gravity is None
            else checks.vector("gravity", gravity)
        )
        self._wind = checks.vector("wind", wind)
        self.random = np.random.default_rng(checks.whole("seed", seed, 0, 2**63 - 1))
        self._effects = effects
        self._substeps = checks.whole("substeps", substeps, 1, 1000)
        self._solver = self._checked_solver(
            ("soft_step" if effects.stacking else "projection") if solver is None else solver
        )
        self._bodies, self._shapes, self.characters = Table(BODY), Table(SHAPE), Table(CHARACTER)
        self.library = Library()
        self._broadphase, self._stepping = None, False
        self._next_body = self._next_shape = 0
        self._users, self._shapes_of, self._tiers, self._sources = {}, {}, {}, {}
        # What is remembered from step to step.
        self.pairs, self.awake, self.sleepers = PairList(), Awake(False), Sleepers()
        self.manifolds, self.anchors = np.zeros(0, MANIFOLD), np.zeros(0, ANCHOR)
        self.sensed = self.ghosts = None
        self.touching, self.sensing = Pairs(), Pairs()
        # What the last step told.
        self.tell_contacts(self.manifolds)
        self.queries, self.events = QueryIndex(), Events()
        self.broadphase = SpatialHashGrid() if broadphase is None else broadphase
        self._plan()

    def __getstate__(self):
        return {name: value for name, value in vars(self).items() if name not in ("workspace", "_stages")}

    def __setstate__(self, state):
        vars(self).update(state)
        self.workspace, self._stages = Workspace(self._effects, self._solver), plan(self._effects, self._solver)

    # --- the step ------------------------------------------------------------------------------------------------

    def step(self, dt=None):
        """Advance by dt [s] (None: world.dt). 0 moves nothing. Raises ValueError for a negative or non-finite dt."""
        self._unlocked()
        dt = self.dt if dt is None else checks.number("dt", dt, low=0.0)
        self.profile.begin()
        self._stepping = True
        try:
            state = begin(self, dt)
            for stage in self._stages:
                started = perf_counter()
                stage(state)
                self.profile.stages[stage.stage] += perf_counter() - started
            finish(self, state)
        finally:
            self._stepping = False

    def refresh_character_rows(self):
        """Bring the body rows of the characters up to date."""
        characters = self.characters.rows
        if len(characters):
            characters["body_row"] = rows_of(self.bodies, characters["body"])

    def _plan(self):
        self.workspace, self._stages = Workspace(self._effects, self._solver), plan(self._effects, self._solver)
        if (self.sensed is not None) != self.stacks:
            # The two kinds of worlds keep other facts of their contacts.
            self.manifolds, self.anchors = np.zeros(0, MANIFOLD), np.zeros(0, ANCHOR)
            self.sensed = self.manifolds if self.stacks else None
        if self.awake.sleeping != self.sleeps:
            self._let_sleep(self.sleeps)
        self.profile = Profile(self.stages)

    def _let_sleep(self, sleeping):
        """From now on the steps go over what is awake, or over everything."""
        self.awake = Awake(sleeping)
        self.bodies["active"] = not sleeping
        self.awake.stir(self.bodies["id"][self.bodies["kind"] != DYNAMIC].tolist())
        self.pairs.let_sleep(sleeping)
        self.sleepers.return_all(self)

    @property
    def stages(self) -> list[str]:
        """Names of the stages that the effects call for, in the order in which they run."""
        return [stage.stage for stage in self._stages]

    @property
    def effects(self) -> Effects:
        """What the scene calls for. Declared once; `set_narrowphase` alone switches."""
        return self._effects

    def set_narrowphase(self, on: bool):
        """Switch between the narrow phase and plain AABBs, between steps."""
        self._unlocked()
        self._effects = self._effects.with_(narrowphase=checks.flag("narrowphase", on))
        self._plan()

    # --- tables --------------------------------------------------------------------------------------------------

    @property
    def bodies(self) -> np.ndarray:
        """BODY rows in the order of ids: a view, valid until a body is added or removed."""
        return self._bodies.rows

    @property
    def shapes(self) -> np.ndarray:
        """SHAPE rows in the order of ids: a view, valid until a body is added or removed."""
        return self._shapes.rows

    @property
    def contacts(self) -> np.ndarray:
        """CONTACT rows of what touches, was pushed, or was met on the way in the last step,
        in the order of shape ids."""
        if self._contacts is None:
            self._contacts = contacts_of(self.told_manifolds())
        return self._contacts

    def told_manifolds(self) -> np.ndarray:
        """MANIFOLD rows that `contacts` lists the points of."""
        manifolds, keep = self._told
        return manifolds if keep is None or keep.all() else manifolds[keep]

    @property
    def sleeping_contacts(self) -> np.ndarray:
        """CONTACT rows, as `contacts`, of the pairs that sleep, as they were when they fell asleep."""
        return contacts_of(self.sleepers.manifolds())

    def tell_contacts(self, manifolds, keep=None):
        """Take in the manifolds of a step, of which the flagged ones count;
        their points are listed when somebody looks."""
        self._told, self._contacts = (manifolds, keep), None

    @property
    def candidates(self) -> np.ndarray:
        """(n, 2) int32 shape ids out of broad phase and filter in the last step: a < b, sorted."""
        return self.pairs.ids(self.shapes).astype(np.int32)

    def rows(self, ids) -> np.ndarray:
        """Row numbers of body ids in `world.bodies`. Raises KeyError for an id that is not there."""
        ids = np.asarray(ids, np.int64)
        rows = rows_of(self.bodies, ids.ravel())
        if (rows < 0).any():
            raise KeyError(f"no body {ids.ravel()[rows < 0][0]} in this world")
        return rows.reshape(ids.shape)

    def touch(self, ids):
        """Say that columns of these bodies (an id or a Body, or many) were written: what is dynamic wakes, and their
        boxes follow in the next step. Awake bodies, and worlds without the effect sleeping, need no touch. Raises
        KeyError, TypeError, ValueError; nothing is touched then."""
        self._unlocked()
        editing.touch(self, ids)

    # --- adding and removing ---------------------------------------------------------------------------------------

    def add_body(
        self,
        *shapes,
        position=(0, 0),
        angle=0.0,
        kind="dynamic",
        velocity=(0, 0),
        angular_velocity=0.0,
        material=PLAIN,
        filter=Filter.ALL,
        sensor=False,
        bullet=False,
        continuous="auto",
        fixed_rotation=False,
        gravity_scale=1.0,
        tier=None,
        user=None,
    ) -> Body:
        """Add one body. Raises TypeError or ValueError naming the argument; the world is unchanged then."""
        ids = editing.add_rows(
            self,
            shapes,
            [checks.position("position", position)],
            [checks.vector("velocity", velocity)],
            [checks.number("angle", angle)],
            kind,
            angular_velocity,
            material,
            filter,
            sensor,
            bullet,
            continuous,
            fixed_rotation,
            gravity_scale,
            tier,
            user,
        )
        return Body(self, int(ids[0]))

    def add_bodies(
        self,
        shape,
        positions,
        velocities=None,
        angles=None,
        kind="dynamic",
        angular_velocity=0.0,
        material=PLAIN,
        filter=Filter.ALL,
        sensor=False,
        bullet=False,
        continuous="auto",
        fixed_rotation=False,
        gravity_scale=1.0,
        tier=None,
        user=None,
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
            kind,
            angular_velocity,
            material,
            filter,
            sensor,
            bullet,
            continuous,
            fixed_rotation,
            gravity_scale,
            tier,
            user,
        )

    def remove_body(self, body):
        """Remove a body (or its id). Raises KeyError when it is not there."""
        if isinstance(body, Body):
            if body.world is not self:
                raise ValueError(f"body must be of this world (got {body!r} of another one)")
            body = body.id
        elif isinstance(body, bool) or not isinstance(body, (int, np.integer)):
            raise TypeError(f"body must be a Body or an id (got {body!r})")
        self.remove_bodies([body])

    def remove_bodies(self, ids):
        """Remove many bodies at once: one pass over the tables. Raises KeyError for an unknown id, ValueError for one
        that is named twice; nothing is removed then."""
        self._unlocked()
        ids = checks.ids("ids", ids)
        if not len(ids):
            return
        keep = np.ones(self._bodies.count, bool)
        keep[self.rows(ids)] = False
        sleep.disturb(self, ids)
        self._drop_shapes(keep[self.shapes["body_row"]])
        self._bodies.keep(keep)
        self.awake.keep_rows(keep)
        self.shapes["body_row"] = (np.cumsum(keep) - 1)[self.shapes["body_row"]]
        gone = set(ids.tolist())
        for table in (self._users, self._shapes_of, self._tiers, self._sources):
            for identity in gone & table.keys():
                del table[identity]
        self.characters.keep(~np.isin(self.characters.rows["body"], ids))
        sleep.forget(self)

    def _drop_shapes(self, keep):
        self.pairs.ids(self.shapes)  # named while the rows still stand
        self.pairs.free_proxies(self.shapes["proxy"][~keep])
        self._shapes.keep(keep)
        self.pairs.rename(self.shapes)
        self.awake.forget_shapes()

    def clear(self):
        """Remove every body. Ids go on from where they were."""
        self.remove_bodies(self.bodies["id"])

    def body(self, identity) -> Body:
        """The handle of an id. Raises KeyError when there is no such body."""
        if isinstance(identity, bool) or not isinstance(identity, (int, np.integer)):
            raise TypeError(f"identity must be a whole number (got {identity!r})")
        self._body_row(identity)
        return Body(self, int(identity))

    # --- what Body asks for ------------------------------------------------------------------------------------------

    def _unlocked(self):
        if self._stepping:
            raise RuntimeError("the world cannot be changed during its step: read the events after it")

    def _row_number(self, identity):
        count = self._bodies.count
        row = bisect_left(self._bodies.data["id"], identity, 0, count)
        if row == count or self._bodies.data["id"][row] != identity:
            raise KeyError(f"body {identity} is not in this world (removed, or never added)")
        return row

    def _body_row(self, identity):
        return self._bodies.data[self._row_number(identity)]

    def _needs(self, effect, what, asked):
        if asked and not getattr(self._effects, effect):
            raise ValueError(f"{what} needs the effect {effect}: declare it in Effects({effect}=True)")

    def _needs_velocities(self, what):
        if "integrate_velocities" not in self.stages and not self.stacks:
            raise ValueError(f"{what} needs one of the effects response, gravity, drag, wind")

    # --- queries, digest, snapshot ------------------------------------------------------------------------------------

    def ray_cast(self, origin, translation, filter=Filter.ALL, sensors=False):
        """The first shape that a ray [px] meets, or None. See queries.RayHit."""
        hits = queries.ray_cast_all(self, origin, translation, filter, sensors, first=True)
        return hits[0] if hits else None

    def ray_cast_all(self, origin, translation, filter=Filter.ALL, sensors=False) -> list:
        """All shapes that a ray [px] meets, nearest first, ties by shape id."""
        return queries.ray_cast_all(self, origin, translation, filter, sensors)

    def shape_cast(self, shape, pose, translation, filter=Filter.ALL):
        """The first shape that a shape at a pose (x, y, angle) touches on its way by a translation [px], or None."""
        return queries.shape_cast(self, shape, pose, translation, filter)

    def closest(self, point, filter=Filter.ALL):
        """(body, point, distance) [px] of the nearest point of any shape, or None."""
        return queries.closest(self, point, filter)

    def overlap(self, shape, pose, filter=Filter.ALL) -> list[Body]:
        """The bodies that a shape at a pose (x, y, angle) overlaps, in the order of ids."""
        return queries.overlap(self, shape, pose, filter)

    def query_aabb(self, lower, upper) -> list[Body]:
        """The bodies with a shape whose AABB meets the closed box [px], in the order of ids."""
        return queries.query_aabb(self, lower, upper)

    def query_point(self, point) -> list[Body]:
        """The bodies with a shape that holds the point [px], in the order of ids."""
        return queries.query_point(self, point)

    def rebuild_proxies(self):
        """Give every shape a new place in the broad phase: the tables were replaced."""
        self.pairs = PairList(self.sleeps)
        self.awake.start_over()
        self._broadphase = self._broadphase.fresh()
        active = ~self.bodies["quarantined"][self.shapes["body_row"]]
        rows = np.flatnonzero(active)
        self.shapes["proxy"] = -1
        self.pairs.add_proxies(self.shapes, rows, self.bodies["kind"][self.shapes["body_row"][rows]] == STATIC)
        # What is not awake gets no rectangle in the next step: here, once.
        changed = write_rectangles(self, rows)
        self.pairs.again.append(self.pairs.changed[:changed].copy())

    def digest(self) -> str:
        """blake2b-128 of the state that the next step depends on, independent of rows, times and broad phase."""
        return snapshot.digest(self)

    def snapshot(self):
        """A copy of the state."""
        return snapshot.take(self)

    def restore(self, taken):
        """Go back to a snapshot.
        Raises ValueError when it does not fit this version's tables or this world's effects."""
        self._unlocked()
        snapshot.restore(self, taken)
