"""World: the tables of a simulation and the stages that advance them. Start reading at `World.step`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from time import perf_counter
from typing import Any, Literal, Never, Unpack, overload

import numpy as np
from numpy.typing import NDArray

from physics import add_joints, body_templates, checks, edit, hints, joint, snapshot, teleport
from physics.annotations import (
    BodyRef,
    BodyRefs,
    BroadphaseName,
    ContinuousName,
    JointSolverName,
    KindName,
    Numbers,
    Pair,
    Points,
    Pose,
    Rect,
    SolverName,
    Substeps,
    TierName,
)
from physics.body import Body
from physics.body_templates import Definition
from physics.broadphase import checked_broadphase
from physics.broadphase.proxies import PairList, Strategy
from physics.broadphase.spatial_hash import SpatialHashGrid
from physics.edit import rebuild_masks
from physics.effects import Effects, checked_effects
from physics.events import Events, Pairs, touching_bodies
from physics.islands import sleep
from physics.islands.awake import Awake
from physics.islands.sleep import SleepingSet
from physics.jit import tiers
from physics.joint import Joint
from physics.joints.kinds import Kind
from physics.math2d import Vec2
from physics.queries import batches, casts
from physics.queries.casts import RayHit
from physics.queries.index import QueryIndex
from physics.settings import PIXELS_PER_METER, POSITION_LIMIT, STANDARD_GRAVITY, tolerances
from physics.shapes.kinds import checked_shape
from physics.shapes.library import Library
from physics.shapes.shape import Filter, Material, Shape
from physics.snapshot import Snapshot, digest
from physics.solver.loads import ContactLists
from physics.step import SOLVERS, STACKING, Workspace, begin, finish, ignored_effects, own_solver, plans, step_length
from physics.tables.body import BODY, BODY_DEF, DYNAMIC, RUN
from physics.tables.character import CHARACTER
from physics.tables.columns import PointHits, RayHits
from physics.tables.contact import CONTACT
from physics.tables.joint import JOINT
from physics.tables.shape import SHAPE
from physics.tables.table import Table
from physics.world_state import Profile, WorldState, checked_accuracy, checked_substeps

PLAIN = Material()  # the default material of bodies


def _set_known(world: Any, name: str, value: Any) -> None:
    """Set an attribute. Raises AttributeError for one that is unknown or read-only; a subclass may add attributes."""
    if "profile" in world.__dict__ and name not in world.__dict__ and not hasattr(type(world), name):
        checks.known_attribute(world, name, value, type(world) is World)
    try:
        object.__setattr__(world, name, value)
    except AttributeError:
        checks.settable_attribute(world, name, value)
        raise


@checks.setting_by(_set_known)
class World(WorldState):
    """A simulation: its bodies, the declared effects, and the stages of a step that these effects need.

    Add bodies with add_body, call step with the same length each time, and read positions, contacts and events.

    effects: the declared Effects; None: Effects.rigid_bodies().
    broadphase: "brute", "sweep", "hash" or "tree", or an instance of a strategy; None: SpatialHashGrid().
    solver: one of SOLVERS; None: "soft_step" with the effect `stacking`, "projection" without it.
    gravity: (x, y) [px/s²]; None: 9.8 m/s² downwards, (0, 313.6) at 32 pixels per metre. Other than 0 it needs the
        effect `gravity`.
    drag: rate at which velocities decay [1/s], >= 0. Other than 0 it needs the effect `drag` or `wind`.
    wind: velocity of the air (x, y) [px/s], which acts through the drag. Other than 0 it needs the effect `wind`.
    pixels_per_meter: scale of all tolerances and of the default gravity, > 0.
    dt: length of a step [s], > 0: step() is called 1 / dt times per second.
    substeps: substeps of the stacking solvers, 1 to 1000, or "auto": 4 to 32 for each island, as many as keep the sag
        of its contacts within accuracy; up to 128 for a leaning one. The counter cap_hits counts islands that need
        more.
    accuracy: greatest sag of a contact under its load [px], > 0, for substeps="auto"; None: 1 mm.
    restitution_speed: slower impacts do not bounce [px/s], >= 0; None: 1 m/s.
    seed: seed of `random`, a whole number >= 0.

    The state of a world, besides its arrays and settings:

    random: NumPy Generator for the game, seeded with seed; part of snapshots and digests.
    events: the Events of the last step.
    profile: the Profile of the last step: times of its stages, and work counters.
    steps: number of steps so far; time: their total length [s]; tolerances: the Tolerances of this world.

    Raises TypeError or ValueError naming the argument.

    >>> world = World(gravity=(0, 500))
    >>> floor = world.add_body(Polygon.box(400, 20), position=(200, 300), kind="static")
    >>> ball = world.add_body(Circle(10), position=(200, 100), material=Material(restitution=0.5))
    >>> for _ in range(300):
    ...     world.step()
    >>> round(ball.position.y), world.touching().tolist()
    (280, [[0, 1]])
    """

    _solver: SolverName
    _joint_solver: JointSolverName

    @hints.explained
    def __init__(
        self,
        effects: Effects | None = None,
        broadphase: Strategy | BroadphaseName | None = None,
        solver: SolverName | None = None,
        gravity: Pair | None = None,
        drag: float = 0.0,
        wind: Pair = (0, 0),
        pixels_per_meter: float = PIXELS_PER_METER,
        dt: float = 1 / 60,
        substeps: Substeps = "auto",
        accuracy: float | None = None,
        restitution_speed: float | None = None,
        seed: int = 0,
    ) -> None:
        effects = Effects.rigid_bodies() if effects is None else checked_effects(effects)
        self.tolerances = tolerances(checks.number("pixels_per_meter", pixels_per_meter, above=0.0))
        self._dt = checks.seconds("dt", dt, above=0.0)
        self._drag = checks.number("drag", drag, low=0.0)
        self._gravity = (
            Vec2(0.0, STANDARD_GRAVITY * self.tolerances.pixels_per_meter)
            if gravity is None
            else checks.vector("gravity", gravity)
        )
        self._wind = checks.vector("wind", wind)
        self.random = np.random.default_rng(checks.whole("seed", seed, 0, 2**63 - 1))
        self._effects = effects
        if gravity is not None:
            self._needs_fields(gravity=self._gravity)
        self._needs_fields(drag=self._drag, wind=self._wind)
        self._set_restitution_speed(restitution_speed)
        self._substeps, self._accuracy = checked_substeps(substeps), checked_accuracy(accuracy)
        strategy = SpatialHashGrid() if broadphase is None else checked_broadphase(broadphase)
        self._bodies, self._definitions, self._shapes, self.characters = map(Table, (BODY, BODY_DEF, SHAPE, CHARACTER))
        self._runs, self.library, self._joints = Table(RUN), Library(), Table(JOINT, 0)
        self._joint_users, self._lost_joints, self._next_joint, self._joint_solver = {}, [], 0, "auto"
        self._apart = None
        self._solver = self._checked_solver(own_solver(effects) if solver is None else solver)
        self._stepping = False
        self._next_body = self._next_shape = self._carved_pixels = 0
        self._templates, self._removed = {}, {}
        self._users, self._shapes_of, self._tiers, self._sources, self._targets = {}, {}, {}, {}, {}
        # Caches that later steps read.
        self.pairs, self.awake, self.sleeping_set = PairList(), Awake(False), SleepingSet()
        self.contact_rows = np.zeros(0, CONTACT)
        self.sensed = self.ghosts = self.workspace = None
        self.touching_pairs, self.sensing_pairs = Pairs(), Pairs()
        self.contact_lists = ContactLists()
        # Results of the last step.
        self.report_contacts(self.contact_rows)
        self.queries, self.events, self.steps, self.time, self.span = QueryIndex(), Events(), 0, 0.0, 0.0
        self._broadphase = strategy
        self._plan()

    def __getstate__(self):
        if self._removed:
            self._drop_removed()
        return {name: value for name, value in vars(self).items() if name not in ("workspace", "_plans", "_templates")}

    def __setstate__(self, state):
        effects, solver = state["_effects"], state["_solver"]
        vars(self).update(state, workspace=Workspace(effects, solver), _plans=plans(effects, solver), _templates={})

    # --- the step ------------------------------------------------------------------------------------------------

    def step(self, dt: float | None = None) -> None:
        """Advance the simulation by one step. Afterwards events, contacts and bodies are those of this step.

        dt: length of the step [s], >= 0 (pygame's Clock.tick() / 1000); None: world.dt. A step below 1e-30 s counts
            as 0: it moves nothing, and keeps forces and targets for the next step.

        Raises TypeError if dt is not a number; ValueError if it is negative, not finite, or an int >= 4, which looks
        like milliseconds; RuntimeError during a step.

        >>> ball.velocity = (0, -100)
        >>> for _ in range(60):
        ...     world.step()
        ...     for hit in world.events.hits:
        ...         print(f"{world.time:.2f} s: {hit['body_a']} and {hit['body_b']} at {hit['speed']:.0f} px/s")
        0.65 s: 0 and 1 at 99 px/s
        """
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

    @hints.without_others
    def add_body(
        self,
        *shapes: Shape,
        position: Pair = (0, 0),
        angle: float = 0.0,
        kind: KindName = "dynamic",
        velocity: Pair = (0, 0),
        angular_velocity: float = 0.0,
        mass: float | None = None,
        material: Material = PLAIN,
        filter: Filter = Filter.ALL,
        sensor: bool = False,
        bullet: bool = False,
        continuous: ContinuousName = "auto",
        fixed_rotation: bool = False,
        gravity_scale: float = 1.0,
        allow_sleep: bool = True,
        tier: TierName | None = None,
        user: Any = None,
        **others: Never,
    ) -> Body:
        """Add one body with these shapes, and return it.

        *shapes: shapes in body space, or none. If a dynamic body has shapes, at least one must be of a kind with an
            area (not a Segment). Chain and TileGrid are only for static and kinematic bodies.
        position: the body's origin (x, y) [px].
        angle: angle [rad], clockwise on the screen. It must be 0 with a TileGrid.
        kind: "dynamic": moved by forces and contacts; "kinematic": moved only by its velocity; "static": never moved.
        velocity: velocity (x, y) of the centre of mass [px/s]; must be (0, 0) for a static body.
        angular_velocity: [rad/s]. Other than 0 it needs the effect `rotation`, and a body that is not static.
        mass: mass, > 0, in place of density · area of the shapes [density px²]; None: that mass.
        material: the Material (density, friction, restitution, …) of the shapes without a material of their own.
        filter: the Filter (which shapes they meet) of the shapes without a filter of their own.
        sensor: whether the shapes without a sensor value of their own are sensors, which report overlaps and do not
            push. True needs the effect `sensors`.
        bullet: whether the body is also swept against other dynamic bodies. True needs the effect `continuous`.
        continuous: "off" | "ray" | "swept" | "toi" | "auto": how a fast body is stopped at its first impact, see
            Body.continuous. "ray", "swept" and "toi" need the effect.
        fixed_rotation: whether contacts and impulses leave the rotation unchanged.
        gravity_scale: factor on world.gravity; 0: it does not fall.
        allow_sleep: False keeps the island of a dynamic body awake.
        tier: one of TIERS, which replaces a PixelMask by simpler shapes, see fit; None: the shapes as given.
        user: any value of the game, such as its sprite, kept as body.user.

        Raises TypeError or ValueError naming the argument, RuntimeError during a step. The world is then unchanged.

        >>> ice = Material(friction=0.02, density=0.5)
        >>> crate = world.add_body(Polygon.box(20, 10), position=(150, 100), angle=0.5, material=ice, user="crate")
        >>> crate.mass, crate.user
        (100.0, 'crate')
        """
        if others:
            raise hints.unexpected("World.add_body", hints.argument_names(self.add_body), others)
        position, velocity = checks.position("position", position), checks.vector("velocity", velocity)
        angle, spin = checks.number("angle", angle), checks.number("angular_velocity", angular_velocity)
        values = mass, material, filter, sensor, bullet, continuous, fixed_rotation, gravity_scale, allow_sleep
        key = None if tier is not None or self._stepping else body_templates.key_of(shapes, kind, *values)
        known = body_templates.find(self, key)
        identity = -1
        if known is not None:
            identity = body_templates.add_like(self, known, shapes, position, velocity, angle, spin)
        if identity < 0:
            wanted = edit.BodyDef(kind, spin, *values, tier)
            identity = int(edit.add_rows(self, shapes, [position], [velocity], [angle], wanted)[0])
            body_templates.keep(self, key, shapes)
        if user is not None:
            self._users[identity] = user
        return Body(self, identity)

    def add_bodies(
        self,
        shape: Shape,
        positions: Points,
        velocities: Points | None = None,
        angles: Numbers | None = None,
        **definition: Unpack[Definition],
    ) -> NDArray[np.int64]:
        """Add a body with the same shape at each position, and return the ids (n,) int64 of the bodies.

        shape: one shape, which all bodies share.
        positions: origins of the bodies, (n, 2) [px].
        velocities: (n, 2) [px/s]; None: 0.
        angles: (n,) [rad]; None: 0.
        **definition: the other arguments of add_body, one value for all bodies. A list (or 1-D array) as user has one
            value for each body; any other user, such as a tuple or a dict, is that of all bodies.

        Raises TypeError or ValueError naming the argument, RuntimeError during a step. The world is then unchanged.

        >>> ids = world.add_bodies(Circle(3), [(0, 0), (20, 0), (40, 0)], [(10, 0)] * 3, user=["a", "b", "c"])
        >>> ids, world.body(ids[1]).user
        (array([3, 4, 5]), 'b')
        >>> world.bodies["vx"][world.rows(ids)]
        array([10., 10., 10.])
        """
        if wrong := {name: value for name, value in definition.items() if name not in edit.BodyDef._fields}:
            names = ("shape", "positions", "velocities", "angles", *edit.BodyDef._fields)
            raise hints.unexpected("World.add_bodies", names, wrong)
        positions = checks.columns("positions", positions)
        if np.any(np.abs(positions) >= POSITION_LIMIT):
            raise ValueError(
                f"positions must lie within {POSITION_LIMIT:g} px of the origin (got {positions.tolist()})"
            )
        n = len(positions)
        checked_shape("shape", shape)
        velocities = np.zeros((n, 2)) if velocities is None else checks.columns("velocities", velocities, n)
        angles = np.zeros(n) if angles is None else checks.columns("angles", angles, n, width=1)
        return edit.add_rows(self, (shape,), positions, velocities, angles, edit.BodyDef(**definition))

    def remove_body(self, body: BodyRef) -> None:
        """Remove a body.

        body: a Body or an id.

        Raises KeyError for an unknown body, TypeError for anything but a Body or an id, ValueError for a Body of
        another world, RuntimeError during a step.
        """
        self._remove_one(self._identity("body", body))

    def remove_bodies(self, ids: BodyRefs) -> None:
        """Remove many bodies in one pass over the tables.

        ids: Bodies or ids, in any order. A body may be listed more than once.

        Raises KeyError, TypeError, ValueError and RuntimeError as remove_body does. Nothing is removed then.
        """
        self._remove(np.unique(self._identities("ids", ids, repeats=True)))

    def move(
        self, ids: BodyRefs, positions: Points, angles: Numbers | None = None, velocities: Points | None = None
    ) -> None:
        """Teleport many bodies in one call, as Body.position does. They and the islands that they touched wake.

        ids: n Bodies or ids, each once. Their targets are cancelled.
        positions: new origins, (n, 2) [px].
        angles: (n,) [rad]; None: unchanged.
        velocities: (n, 2) [px/s]; None: unchanged.

        Raises KeyError for an unknown body; TypeError or ValueError for invalid arguments, a velocity other than 0 of a
        static body, or a rotation of a TileGrid; RuntimeError during a step. Nothing is moved then.
        """
        teleport.move(self, ids, positions, angles, velocities)

    def touch(self, ids: BodyRefs) -> None:
        """Report that table columns of bodies were written. Dynamic bodies wake, and the next step updates boxes.

        ids: a Body, an id, or many. Awake bodies, and worlds without the effect `sleeping`, need no touch.

        Raises KeyError for an unknown body; TypeError or ValueError for anything but different Bodies or ids;
        RuntimeError during a step. Nothing is touched then.
        """
        self._unlocked()
        teleport.touch(self, ids)

    def clear(self) -> None:
        """Remove all bodies. Their ids, and those of their shapes, are not used again.

        Raises RuntimeError during a step.
        """
        self.remove_bodies(self.bodies["id"])

    # --- joints ----------------------------------------------------------------------------------------------------

    def add_joint(self, joint_of: Kind) -> Joint:
        """Add one joint, and return its handle. The bodies of the joint wake.

        joint_of: a Revolute, Prismatic, Wheel, Distance, Weld, Angle, Motor, Target, NoContact, Gear, Pulley or
            Ratchet.

        Raises TypeError for anything else; ValueError without the effect `joints`, for equal bodies, without a dynamic
        body, or for the body of a character; KeyError for an unknown body or joint; RuntimeError during a step. The
        world is then unchanged.

        >>> door = world.add_joint(Revolute(None, box, at=(230, 280), limits=(-1.5, 1.5)))
        >>> door.motor = Drive(speed=2.0, max=1e7)
        >>> door
        Joint(1, Revolute, world, body 2)
        """
        return add_joints.add_one(self, joint_of)

    def add_joints(
        self,
        kind: type[Kind],
        bodies_a: Sequence[BodyRef | None] | np.ndarray | None,
        bodies_b: Sequence[BodyRef | None] | np.ndarray | None,
        **settings: Any,
    ) -> NDArray[np.int64]:
        """Add a joint of one kind between each of n pairs of bodies, and return their ids (n,) int64.

        kind: the class of the joints, such as Revolute.
        bodies_a, bodies_b: n Bodies or ids; an entry None, or None in place of all entries, means the world. For a
            Gear: the joints that it couples, as Joints, ids of joints, or Bodies.
        **settings: the other arguments of the kind, one value for all joints. Anchors (at, or at_a and at_b) and
            pulleys (ground_a, ground_b) are arrays (n, 2) [px]; an axis may be an array (n, 2), user a list of n.

        Raises TypeError, ValueError, KeyError and RuntimeError as add_joint does.
        """
        return add_joints.add_many(self, kind, bodies_a, bodies_b, settings)

    def joint(self, identity: Joint | int | np.integer[Any]) -> Joint:
        """Return the Joint with this id.

        identity: the id of a joint, or the Joint itself.

        Raises KeyError for an unknown joint, TypeError for anything else, ValueError for a Joint of another world.
        """
        return Joint(self, self.joints["id"].item(joint.row_of(self, identity)))

    def remove_joints(self, ids: Joint | int | Iterable[Joint | int] | np.ndarray) -> None:
        """Remove joints and the gears that couple them. The bodies of the joints wake.

        ids: Joints or ids, one or many. A joint may be listed more than once.

        The next step reports the gears in events.broken, with the reason "removed". Raises KeyError for an unknown
        joint, TypeError for anything but Joints and ids, ValueError for a Joint of another world, RuntimeError during a
        step. Nothing is removed then.
        """
        joint.remove(self, ids)

    def _drop_joints_of(self, ids: np.ndarray) -> None:
        if self._joints.count:
            joint.drop_of_bodies(self, ids)

    # --- pairs -------------------------------------------------------------------------------------------------------

    @overload
    def touching(self, users: Literal[False] = False) -> NDArray[np.int64]: ...

    @overload
    def touching(self, users: Literal[True]) -> list[tuple[Any, Any]]: ...

    def touching(self, users: bool = False) -> NDArray[np.int64] | list[tuple[Any, Any]]:
        """Return the pairs of touching bodies after the last step: (n, 2) int64 ids a < b, each pair once, sorted.

        users: True returns a list of pairs of the `user` values instead, in the same order.

        The pairs are those that events.begin has reported and events.end has not; sleeping pairs are included. Without
        the effect `response`, masks touch if they share pixels, other shapes if separation <= 0. With it, a pair
        begins to touch by separation <= 0, an impulse or a hit of the sweep; it ends beyond the slop without an
        impulse. Overlaps of sensors are not included. Raises TypeError if users is not a bool.

        >>> world.step()
        >>> world.touching()
        array([[0, 1],
               [0, 2]])
        >>> floor.user, ball.user, box.user = "floor", "ball", "box"
        >>> world.touching(users=True)
        [('floor', 'ball'), ('floor', 'box')]
        """
        pairs = touching_bodies(self)
        if not checks.flag("users", users):
            return pairs
        found = map(self._users.get, pairs.ravel().tolist())
        return list(zip(found, found, strict=True))

    # --- digest, snapshot ------------------------------------------------------------------------------------

    def digest(self) -> str:
        """Return the blake2b-128 hash, 32 hexadecimal digits, of the state on which the next step depends."""
        return digest(self)

    def snapshot(self) -> Snapshot:
        """Return a copy of the state of the world as a Snapshot, for restore() or a file.

        Raises RuntimeError during a step.
        """
        return snapshot.take(self)

    def restore(self, taken: Snapshot) -> None:
        """Set the world to the state in a snapshot: bodies, joints, time, random numbers and settings.

        taken: a Snapshot of a world with the same effects and pixels_per_meter.

        The settings are solver, joint_solver, dt, substeps, accuracy, restitution_speed, gravity, drag and wind. The
        kind of broad phase is unchanged. `user` values are not part of a snapshot: present values are kept for the ids
        in the snapshot. Raises TypeError for anything but a Snapshot; ValueError if the snapshot is damaged, or has
        other effects or another pixels_per_meter; RuntimeError during a step.
        """
        self._unlocked()
        snapshot.restore(self, taken)

    # --- settings, which can be set between steps ----------------------------------------------------------------

    @property
    def solver(self) -> SolverName:
        """The name of the solver, one of SOLVERS. It can be set between steps, which wakes all bodies."""
        return self._solver

    @solver.setter
    def solver(self, name: SolverName) -> None:
        self._unlocked()
        self._solver = self._checked_solver(name)
        sleep.wake_all(self)
        self._plan()

    @property
    def stacks(self) -> bool:
        """Whether the solver stacks: it warm starts its contacts from the last step (soft_step, sequential_impulse)."""
        return self._solver in STACKING

    @property
    def ignored_effects(self) -> tuple[str, ...]:
        """Names of the declared effects that the present solver ignores, in the order of Effects.names().

        A run with and without such an effect is the same, with two exceptions. With the solver blocking, a body rotates
        by its own angular velocity, although contacts do not rotate it. Characters stand on dynamic bodies if the
        effect `stacking` is declared, with any solver.
        """
        return ignored_effects(self._effects, self._solver)

    def _checked_solver(self, name):
        name = checks.choice("solver", name, SOLVERS)
        self._needs("stacking", f"solver {name!r}", name in STACKING)
        if self._joints.count and name not in STACKING:
            raise ValueError(f"solver must be one of {', '.join(STACKING)}, which solve joints (got {name!r})")
        return name

    def set_narrowphase(self, on: bool) -> None:
        """Use the narrow phase, or only AABBs, from the next step on.

        on: True for the narrow phase.

        Raises TypeError for anything but a bool, RuntimeError during a step.
        """
        self.set_effects(self._effects.with_(narrowphase=checks.flag("narrowphase", on)))

    @hints.explained
    def set_effects(self, effects: Effects) -> None:
        """Replace the effects from the next step on, and wake all bodies.

        effects: the new Effects.

        Values for effects that are no longer declared are kept, but have no effect (angular velocity, bullet, sensor,
        material). If `stacking` is added or removed, or if the solver cannot solve present joints, the solver becomes
        the default solver. If `response` is added or removed, the shapes of bodies with masks get new ids. Raises
        TypeError for anything but an Effects, ValueError for effects without `response` in a world with Characters,
        RuntimeError during a step.
        """
        self._unlocked()
        effects = checked_effects(effects)
        if len(self.characters.rows) and not effects.response:
            raise ValueError("effects must have response: this world has Characters, which need it")
        before, self._effects = self._effects, effects
        sleep.wake_all(self)
        if before.stacking != effects.stacking or (effects.joints and self._joints.count and not self.stacks):
            self._solver = own_solver(effects)
        self._plan()
        if before.response != effects.response:
            rebuild_masks(self)

    def _plan(self):
        before, self.workspace = self.workspace, Workspace(self._effects, self._solver)
        self._plans = plans(self._effects, self._solver)
        if before is None or before.stacks != self.stacks:
            # Contact rows of solvers with and without a contact cache are not compatible.
            self.contact_rows = np.zeros(0, CONTACT)
            self.sensed = None
        if (self.sensed is not None) != self._effects.response:
            self.sensed = np.zeros(0, CONTACT) if self._effects.response else None
        if self.awake.sleeping != self.sleeps:
            self._let_sleep(self.sleeps)
        self.profile = Profile(self._plan_now.names)

    def _let_sleep(self, sleeping):
        """Have later steps process only the awake bodies (`sleeping` True) or all bodies (False)."""
        self.awake = Awake(sleeping)
        self.bodies["active"] = not sleeping
        self.awake.mark_dirty(self.bodies["id"][self.bodies["kind"] != DYNAMIC].tolist())
        self.pairs.let_sleep(sleeping)
        self._broadphase = self._broadphase.fresh()  # an empty instance, which receives all present proxies
        self.sleeping_set.return_all(self)

    @property
    def joint_solver(self) -> JointSolverName:
        """The solver of joints. It can be set between steps; a change wakes all bodies.

        "iterative": converges from substep to substep. "direct": solves each tree of joints exactly, with its loops,
        limits and motors, at about three times the cost. "auto": as "direct", except for meshes with too many loops to
        solve exactly, which are solved iteratively. In a tree with more than 96 rows of loops, limits and motors, or
        more than 16 motors, these are solved iteratively, which counts in `cap_hits`.
        """
        return self._joint_solver

    @joint_solver.setter
    def joint_solver(self, name: JointSolverName) -> None:
        self._unlocked()
        name = checks.choice("joint_solver", name, joint.JOINT_SOLVERS)
        if name != self._joint_solver:
            self._joint_solver = name
            sleep.wake_all(self)

    # --- queries: see queries/casts.py for details -------------------------------------------------------------------

    def body(self, identity: BodyRef) -> Body:
        """Return the handle of a body.

        identity: the id of a body, or the Body itself.

        Raises KeyError for an unknown body, TypeError for anything else, ValueError for a Body of another world.
        """
        identity = self._identity("identity", identity)
        self._row_at(identity)
        return Body(self, identity)

    def __len__(self) -> int:
        """Return the number of bodies."""
        return self._bodies.count - len(self._removed)

    def __bool__(self) -> bool:
        """Return True, also for a world without bodies."""
        return True

    def __iter__(self) -> Iterator[Body]:
        """Yield the bodies that exist now, in the order of ids.

        Bodies that are added during the iteration are not included, nor bodies that are removed before their turn.
        """
        for identity in self.bodies["id"].tolist():
            if identity in self:
                yield Body(self, identity)

    def __contains__(self, body: object) -> bool:
        """Return whether a Body, a Joint or the id of a body is in this world."""
        if isinstance(body, Joint):
            return body.world is self and bool((self.joints["id"] == body.id).any())
        if isinstance(body, Body):
            return body.world is self and body.id in self
        if isinstance(body, bool) or not isinstance(body, (int, np.integer)):
            return False
        return int(body) in self._shapes_of

    @hints.explained
    def ray_cast(
        self, origin: Pair, translation: Pair, filter: Filter = Filter.ALL, sensors: bool = False
    ) -> RayHit[Body] | None:
        """Return the first RayHit of a ray, or None without a hit.

        origin: start of the ray (x, y) [px].
        translation: vector from there to its end (x, y) [px]; (0, 0) is a point query.
        filter: the Filter of the ray, which hits the shapes that a shape with this Filter collides with.
        sensors: whether sensors can also be hit.

        RayHit has body, shape, point, normal and fraction. Inside a shape the fraction is 0, and the normal is opposite
        to the ray. Equally near hits are in the order of shape ids. Raises TypeError for values of other types,
        ValueError for numbers that are not finite, or for an origin too far away.

        >>> hit = world.ray_cast((200, 0), (0, 400), filter=Filter(mask=1))
        >>> hit.body, hit.point, hit.fraction
        (Body(1, dynamic, position=(200, 280), velocity=(0, 0)), Vec2(x=200.0, y=270.0), 0.675)
        >>> world.ray_cast((200, 0), (0, 100)) is None
        True
        """
        hits = casts.ray_cast_all(self, origin, translation, filter, sensors, first=True)
        return hits[0] if hits else None

    @hints.explained
    def ray_cast_all(
        self, origin: Pair, translation: Pair, filter: Filter = Filter.ALL, sensors: bool = False
    ) -> list[RayHit[Body]]:
        """Return the RayHits of all shapes on a ray, nearest first.

        origin: start of the ray (x, y) [px]; translation: vector from there to its end (x, y) [px].
        filter: which shapes can be hit; sensors: whether sensors can also be hit.

        Raises TypeError and ValueError as ray_cast does.
        """
        return casts.ray_cast_all(self, origin, translation, filter, sensors)

    @hints.explained
    def ray_casts(
        self, origins: Points, translations: Points, filter: Filter = Filter.ALL, sensors: bool = False
    ) -> RayHits:
        """Return the first hit of each of n rays as an array (n,) of RAY_HIT rows, in the order of the rays.

        origins: starts of the rays (n, 2) [px]; translations: vectors from there to their ends (n, 2) [px].
        filter: which shapes can be hit; sensors: whether sensors can also be hit.

        A ray without a hit has body -1, fraction 1 and its end as point. Raises TypeError and ValueError as ray_cast
        does.
        """
        return batches.ray_casts(self, origins, translations, filter, sensors)

    @hints.explained
    def shape_cast(
        self, shape: Shape, pose: Pose, translation: Pair, filter: Filter = Filter.ALL, sensors: bool = False
    ) -> RayHit[Body] | None:
        """Return the first RayHit of a shape that moves along a straight line, or None without a hit.

        shape: the moving shape; pose: its start, (x, y) or (x, y, angle) [px, rad].
        translation: vector from there to its end (x, y) [px].
        filter: which shapes can be hit; sensors: whether sensors can also be hit.

        Shapes that touch at the start are hit at fraction 0 if the cast shape approaches. Raises TypeError and
        ValueError as ray_cast does.
        """
        return casts.shape_cast(self, shape, pose, translation, filter, sensors)

    @hints.explained
    def closest(
        self, point: Pair, filter: Filter = Filter.ALL, sensors: bool = False
    ) -> tuple[Body, Vec2, float] | None:
        """Return (body, nearest point on its shapes, distance [px]) for the shape nearest to a point, or None.

        point: (x, y) [px]; filter: which shapes are considered; sensors: whether sensors are, too.

        Inside a shape the distance is 0. Raises TypeError and ValueError as ray_cast does.
        """
        return casts.closest(self, point, filter, sensors)

    @hints.explained
    def overlap(self, shape: Shape, pose: Pose, filter: Filter = Filter.ALL, sensors: bool = False) -> list[Body]:
        """Return the bodies that a shape at a pose overlaps, in the order of ids.

        shape: the tested shape; pose: (x, y) or (x, y, angle) [px, rad].
        filter: which shapes are considered; sensors: whether sensors are, too.

        Raises TypeError and ValueError as ray_cast does.
        """
        return casts.overlap(self, shape, pose, filter, sensors)

    @hints.explained
    def query_aabb(self, lower: Pair, upper: Pair, filter: Filter = Filter.ALL, sensors: bool = False) -> list[Body]:
        """Return the bodies with a shape whose AABB meets a box, boundary included, in the order of ids.

        lower, upper: corners of the box (x, y) [px] with the least and the greatest coordinates.
        filter: which shapes are considered; sensors: whether sensors are, too.

        overlap tests the shapes themselves; query_rect takes a pygame.Rect. Raises TypeError and ValueError as
        ray_cast does, ValueError also for lower > upper.
        """
        return casts.query_aabb(self, lower, upper, filter, sensors)

    @hints.explained
    def query_rect(self, rect: Rect, filter: Filter = Filter.ALL, sensors: bool = False) -> list[Body]:
        """Return the bodies with a shape whose AABB meets a rectangle, boundary included, in the order of ids.

        rect: (x, y, width, height) or ((x, y), (width, height)) [px], such as a pygame.Rect.
        filter: which shapes are considered; sensors: whether sensors are, too.

        overlap tests the shapes themselves. Raises TypeError and ValueError as ray_cast, ValueError also for a negative
        width or height.
        """
        return casts.query_rect(self, rect, filter, sensors)

    @hints.explained
    def query_point(self, point: Pair, filter: Filter = Filter.ALL, sensors: bool = False) -> list[Body]:
        """Return the bodies with a shape that contains a point, in the order of ids.

        point: (x, y) [px]; filter: which shapes are considered; sensors: whether sensors are, too.

        Raises TypeError and ValueError as ray_cast does.
        """
        return casts.query_point(self, point, filter, sensors)

    @hints.explained
    def query_points(self, points: Points, filter: Filter = Filter.ALL, sensors: bool = False) -> PointHits:
        """Return which bodies contain which of n points, as an array of POINT_HIT rows, sorted by point, then by body.

        points: (n, 2) [px]; filter: which shapes are considered; sensors: whether sensors are, too.

        Raises TypeError and ValueError as ray_cast does.
        """
        return batches.query_points(self, points, filter, sensors)
