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
from physics.settings import PIXELS_PER_METER, STANDARD_GRAVITY, tolerances
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
from physics.world_state import Handle, Profile, WorldState, checked_accuracy, checked_substeps

PLAIN = Material()  # the default material of bodies


def _set_known(world: Any, name: str, value: Any) -> None:
    """Set the attribute `name` of a world. A subclass of World may add attributes.

    Raises AttributeError for an unknown or read-only attribute.
    """
    if "profile" in world.__dict__ and name not in world.__dict__ and not hasattr(type(world), name):
        checks.known_attribute(world, name, value, type(world) is World)
    try:
        object.__setattr__(world, name, value)
    except AttributeError:
        checks.settable_attribute(world, name, value)
        raise


@checks.setting_by(_set_known)
class World(WorldState, metaclass=hints.WithForeignNames):
    """A simulation: bodies, joints, the declared effects, and the stages of a step that these effects need.

    Add bodies with add_body, call step repeatedly with equal lengths, and read positions, contacts and events.

    effects: the declared Effects; None: Effects.rigid_bodies().
    broadphase: "brute", "sweep", "hash" or "tree", or an instance of a strategy; None: SpatialHashGrid().
    solver: one of SOLVERS; None: "soft_step" with the effect `stacking`, "projection" without it.
    gravity: (x, y) [px/s²]; None: 9.8 m/s² downwards, (0, 313.6) at 32 pixels per metre. Other than 0 it needs the
        effect `gravity`.
    drag: rate at which velocities decay [1/s], >= 0. Other than 0 it needs the effect `drag` or `wind`.
    wind: velocity of the air (x, y) [px/s]; it accelerates bodies by drag · wind. Other than 0 it needs the effect
        `wind`.
    pixels_per_meter: scale of all tolerances and of the default gravity, > 0.
    dt: length of a step [s], > 0; call step() 1 / dt times per second.
    substeps: number of substeps of the stacking solvers, 1 to 1000, or "auto". With "auto" each island gets 4 to 32
        substeps, as many as its contacts need to sag by at most `accuracy`; a leaning island gets up to 128. The
        counter cap_hits counts islands that would need more.
    accuracy: greatest sag (overlap) of a contact under its load [px], > 0, for substeps="auto"; None: 1 mm.
    restitution_speed: speed [px/s], >= 0, below which an impact does not bounce; None: 1 m/s.
    seed: seed of `random`, a whole number >= 0.

    The state of a world, besides its arrays and settings:

    random: NumPy Generator for the game, seeded with `seed`; part of snapshots, but not of digests.
    events: the Events of the last step.
    profile: the Profile of the last step: times of its stages, and work counters.
    steps: number of steps so far; time: total length of all steps [s]; tolerances: the Tolerances of this world.

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

    __copy__ = checks.independent("copy.deepcopy(world), or world.snapshot() for world.restore()")

    def __getstate__(self):
        if self._removed:
            self._drop_removed()
        return {name: value for name, value in vars(self).items() if name not in ("workspace", "_plans", "_templates")}

    def __setstate__(self, state):
        effects, solver, slop = state["_effects"], state["_solver"], state["tolerances"].slop
        workspace = Workspace(effects, solver, slop)
        vars(self).update(state, workspace=workspace, _plans=plans(effects, solver), _templates={})

    # --- the step ------------------------------------------------------------------------------------------------

    def step(self, dt: float | None = None) -> None:
        """Advance the simulation by one step. Afterwards bodies, contacts and events show the state after this step.

        dt: length of the step [s], >= 0 (pygame's Clock.tick() / 1000); None: world.dt. A length below 1e-30 s counts
            as 0: no body moves, and forces and targets remain for the next step.

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
        """Add one body with the given shapes, and return the Body.

        *shapes: shapes in body space, or none. If a dynamic body has shapes, at least one must be of a kind with an
            area (not a Segment). Chain and TileGrid are only for static and kinematic bodies.
        position: the body's origin (x, y) [px].
        angle: angle [rad], clockwise on the screen. It must be 0 with a TileGrid.
        kind: "dynamic": moved by forces and contacts; "kinematic": moved only by its velocity; "static": never moved.
        velocity: velocity (x, y) of the centre of mass [px/s]; must be (0, 0) for a static body.
        angular_velocity: [rad/s]. Other than 0 it needs the effect `rotation`, and a body that is not static.
        mass: mass [density px²], > 0; None: sum of density · area of the shapes.
        material: the Material (density, friction, restitution, …) of the shapes without a material of their own.
        filter: the Filter (which other shapes collide with a shape) of the shapes without a filter of their own.
        sensor: whether the shapes without a sensor value of their own are sensors, which report overlaps and do not
            push. True needs the effect `sensors`.
        bullet: whether the body is also swept against other dynamic bodies. True needs the effect `continuous`.
        continuous: "off" | "ray" | "swept" | "toi" | "auto": how a fast body is stopped at its first impact, see
            Body.continuous. "ray", "swept" and "toi" need the effect `continuous`.
        fixed_rotation: whether contacts and impulses leave the angular velocity unchanged.
        gravity_scale: factor by which world.gravity is multiplied; with 0 the body does not fall.
        allow_sleep: False keeps the island of a dynamic body awake.
        tier: one of TIERS: a single PixelMask is replaced by simpler shapes, see fit; None: use the given shapes.
        user: any value of the caller, such as a sprite, stored as body.user.

        Raises TypeError or ValueError naming the argument, RuntimeError during a step. The world is then unchanged.

        >>> ice = Material(friction=0.02, density=0.5)
        >>> crate = world.add_body(Polygon.box(20, 10), position=(150, 100), angle=0.5, material=ice, user="crate")
        >>> crate.mass, crate.user
        (100.0, 'crate')
        """
        if others:
            raise hints.unexpected("World.add_body", hints.argument_names(self.add_body), others)
        position, velocity = checks.position("position", position), checks.vector("velocity", velocity)
        angle, spin = checks.angle("angle", angle), checks.number("angular_velocity", angular_velocity)
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
        """Add n bodies with the same shape, one at each position, and return the ids (n,) int64 of the bodies.

        shape: the shape of all bodies.
        positions: origins of the bodies, (n, 2) [px].
        velocities: velocities of the bodies, (n, 2) [px/s]; None: 0.
        angles: angles of the bodies, (n,) [rad]; None: 0.
        **definition: the other arguments of add_body, one value for all bodies. If `user` is a list or 1-D array, it
            contains one value for each body; any other `user`, such as a tuple or a dict, is used for all bodies.

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
        positions = checks.positions("positions", positions)
        n = len(positions)
        checked_shape("shape", shape)
        velocities = np.zeros((n, 2)) if velocities is None else checks.columns("velocities", velocities, n)
        angles = np.zeros(n) if angles is None else checks.angles("angles", angles, n)
        return edit.add_rows(self, (shape,), positions, velocities, angles, edit.BodyDef(**definition))

    def remove_body(self, body: BodyRef) -> None:
        """Remove a body, with its shapes and joints.

        body: a Body or an id.

        Raises KeyError for an unknown body; TypeError for anything but a Body or an id; ValueError for a Body of
        another world; RuntimeError during a step.
        """
        self._remove_one(self._identity("body", body))

    def remove_bodies(self, ids: BodyRefs) -> None:
        """Remove many bodies in one pass over the tables.

        ids: Bodies or ids, in any order. A body may be listed more than once.

        Raises KeyError, TypeError, ValueError and RuntimeError as remove_body does. No body is then removed.
        """
        self._remove(np.unique(self._identities("ids", ids, repeats=True)))

    def move(
        self, ids: BodyRefs, positions: Points, angles: Numbers | None = None, velocities: Points | None = None
    ) -> None:
        """Teleport many bodies in one call, like Body.move_to. The bodies and the islands that they touched wake.

        ids: n Bodies or ids in order, each once; not a set. The targets of these bodies are cancelled.
        positions: new origins, (n, 2) [px].
        angles: new angles, (n,) [rad]; None: unchanged.
        velocities: new velocities, (n, 2) [px/s]; None: unchanged.

        Raises KeyError for an unknown body; TypeError or ValueError for invalid arguments, a velocity other than 0 of a
        static body, a rotation of a TileGrid, or the body of a Character; RuntimeError during a step. No body is then
        moved.
        """
        teleport.move(self, ids, positions, angles, velocities)

    def touch(self, ids: BodyRefs) -> None:
        """Wake bodies whose columns in world.bodies were written, and have the next step update the bodies' AABBs.

        ids: a Body, an id, or many, each once. The call is not needed for bodies that are awake, nor in a world without
            the effect `sleeping`.

        Raises KeyError for an unknown body; TypeError or ValueError for repeated ids and for anything but Bodies and
        ids; RuntimeError during a step. No body is then changed.
        """
        self._unlocked()
        teleport.touch(self, ids)

    def clear(self) -> None:
        """Remove all bodies. The ids of the bodies and of their shapes are not used again.

        Raises RuntimeError during a step.
        """
        self.remove_bodies(self.bodies["id"])

    # --- joints ----------------------------------------------------------------------------------------------------

    def add_joint(self, joint_of: Kind) -> Joint:
        """Add one joint, and return the Joint. The bodies of the joint wake.

        joint_of: a Revolute, Prismatic, Wheel, Distance, Weld, Angle, Motor, Target, NoContact, Gear, Pulley or
            Ratchet, which contains the bodies, anchors and settings.

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
        """Add one joint between each of n pairs of bodies, and return the ids (n,) int64 of the joints.

        kind: the class of all joints, such as Revolute.
        bodies_a, bodies_b: n Bodies or ids in order; an entry None means the world, and None instead of the sequence
            means the world for all joints. For gears: the n sides A and n sides B, as Joints, ids of joints, or Bodies.
        **settings: the other arguments of the kind, one value for all joints. Anchors (at, or at_a and at_b) and
            pulley wheels (ground_a, ground_b) are arrays (n, 2) [px]; axis may be an array (n, 2), user a list of n.

        Raises TypeError, ValueError, KeyError and RuntimeError as add_joint does.
        """
        return add_joints.add_many(self, kind, bodies_a, bodies_b, settings)

    def joint(self, identity: Joint | int | np.integer[Any]) -> Joint:
        """Return the Joint with an id.

        identity: the id of a joint, or the Joint itself.

        Raises KeyError for an unknown joint, TypeError for anything else, ValueError for a Joint of another world.
        """
        return Joint(self, self.joints["id"].item(joint.row_of(self, identity)))

    def remove_joints(self, ids: Joint | int | Iterable[Joint | int] | np.ndarray) -> None:
        """Remove joints and the gears that couple these joints. The bodies of the joints wake.

        ids: Joints or ids, one or many. A joint may be listed more than once.

        The next step reports the gears in events.broken, with the reason "removed". Raises KeyError for an unknown
        joint, TypeError for anything but Joints and ids, ValueError for a Joint of another world, RuntimeError during a
        step. No joint is then removed.
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

        A pair is included from its event in events.begin to its event in events.end, also while it sleeps. Without the
        effect `response`, masks touch if they share pixels, and other shapes if their separation is <= 0. With
        `response`, a pair begins to touch when its separation is <= 0, when it has an impulse, or when the sweep finds
        an impact. It ends when the separation exceeds the slop and there is no impulse. Overlaps with sensors are not
        included. Raises TypeError if users is not a bool.

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
        """Return a hash of the state on which the next step depends: blake2b-128, as 32 hexadecimal digits."""
        return digest(self)

    def snapshot(self) -> Snapshot:
        """Return a copy of the state of the world as a Snapshot, for restore() or Snapshot.save().

        Raises RuntimeError during a step.
        """
        return snapshot.take(self)

    def restore(self, taken: Snapshot) -> None:
        """Set the world to the state in a snapshot: bodies, joints, time, random numbers and settings.

        taken: a Snapshot of a world with the same effects and pixels_per_meter.

        The settings are solver, joint_solver, dt, substeps, accuracy, restitution_speed, gravity, drag and wind. The
        kind of broad phase is unchanged. A snapshot contains no `user` values: ids in the snapshot keep their present
        values, and all others are deleted. Raises TypeError for anything but a Snapshot; ValueError if the snapshot is
        damaged, or if its effects or pixels_per_meter differ; RuntimeError during a step.
        """
        self._unlocked()
        snapshot.restore(self, taken)

    # --- settings, which can be set between steps ----------------------------------------------------------------

    @property
    def solver(self) -> SolverName:
        """The name of the solver, one of SOLVERS. It can be set between steps; setting it wakes all bodies."""
        return self._solver

    @solver.setter
    def solver(self, name: SolverName) -> None:
        self._unlocked()
        self._solver = self._checked_solver(name)
        sleep.wake_all(self)
        self._plan()

    @property
    def stacks(self) -> bool:
        """Whether the solver warm starts contacts from the last step, as "soft_step" and "sequential_impulse" do."""
        return self._solver in STACKING

    @property
    def ignored_effects(self) -> tuple[str, ...]:
        """Names of the declared effects that the present solver ignores, in the order of Effects.names().

        Results are the same with and without such an effect, with two exceptions. `rotation` with the solver
        "blocking": a body rotates by its own angular velocity, although contacts do not rotate it. `stacking` with any
        solver: Characters can stand on dynamic bodies.
        """
        return ignored_effects(self._effects, self._solver)

    def _checked_solver(self, name):
        name = checks.choice("solver", name, SOLVERS)
        self._needs("stacking", f"solver {name!r}", name in STACKING)
        if self._joints.count and name not in STACKING:
            raise ValueError(f"solver must be one of {', '.join(STACKING)}, which solve joints (got {name!r})")
        return name

    def set_narrowphase(self, on: bool) -> None:
        """Set whether collisions are tested by the narrow phase or only by AABBs, from the next step on.

        on: True: test by the narrow phase; False: test only by AABBs.

        Raises TypeError for anything but a bool, RuntimeError during a step.
        """
        self.set_effects(self._effects.with_(narrowphase=checks.flag("on", on)))

    @hints.explained
    def set_effects(self, effects: Effects) -> None:
        """Replace the effects from the next step on, and wake all bodies.

        effects: the new Effects.

        Values that belong to a removed effect, such as angular velocity, bullet, sensor or material, are stored but do
        not act. The solver becomes the default solver if `stacking` is added or removed, or if the present solver
        cannot solve existing joints. If `response` is added or removed, the shapes of bodies with masks get new ids.
        Raises TypeError for anything but an Effects, ValueError for effects without `response` in a world with
        Characters, RuntimeError during a step.
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
        before, self.workspace = self.workspace, Workspace(self._effects, self._solver, self.tolerances.slop)
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
        """Set whether later steps process only the awake bodies (`sleeping` True) or all bodies (False)."""
        self.awake = Awake(sleeping)
        self.bodies["active"] = not sleeping
        self.awake.mark_dirty(self.bodies["id"][self.bodies["kind"] != DYNAMIC].tolist())
        self.pairs.let_sleep(sleeping)
        self._broadphase = self._broadphase.fresh()  # an empty instance, which receives all present proxies
        self.sleeping_set.return_all(self)

    @property
    def joint_solver(self) -> JointSolverName:
        """The name of the solver for joints. It can be set between steps; a change wakes all bodies.

        "iterative": converges from substep to substep. "direct": solves each tree of joints exactly, with its loops,
        limits and motors, at about three times the cost. "auto": as "direct", except for meshes with too many loops to
        solve exactly, which are solved iteratively. If a tree has more than 96 rows of loops, limits and motors, or
        more than 16 motors, these rows are solved iteratively. The counter `cap_hits` then increases.
        """
        return self._joint_solver

    @joint_solver.setter
    def joint_solver(self, name: JointSolverName) -> None:
        self._unlocked()
        name = checks.choice("joint_solver", name, joint.JOINT_SOLVERS)
        if name != self._joint_solver:
            self._joint_solver = name
            self.bodies["reserve"] = 0.0  # energy that joints lost as they parted must not come back as they close
            sleep.wake_all(self)

    # --- queries: see queries/casts.py for details -------------------------------------------------------------------

    def body(self, identity: BodyRef) -> Body:
        """Return the Body with an id.

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
        """Return True, even for a world without bodies."""
        return True

    def __iter__(self) -> Iterator[Body]:
        """Yield a Body for each body in the world, in the order of ids.

        Bodies that are added during the iteration are not yielded. Bodies that are removed during it, before they are
        yielded, are skipped.
        """
        for identity in self.bodies["id"].tolist():
            if identity in self:
                yield Body(self, identity)

    def __contains__(self, body: object) -> bool:
        """Return whether a Body, a Joint or the id of a body is in this world."""
        if isinstance(body, Handle):
            return body.world is self and body.id in self
        if isinstance(body, (int, np.integer)) and not isinstance(body, bool):
            return int(body) in self._shapes_of
        return isinstance(body, Joint) and body.world is self and bool((self.joints["id"] == body.id).any())

    @hints.explained
    def ray_cast(
        self, origin: Pair, translation: Pair, filter: Filter = Filter.ALL, sensors: bool = False
    ) -> RayHit[Body] | None:
        """Return the RayHit of the first shape that a ray hits, or None if it hits no shape.

        origin: start of the ray (x, y) [px].
        translation: vector from the start of the ray to its end (x, y) [px]; (0, 0) is a point query.
        filter: the Filter of the ray; the ray hits only shapes with which a shape with this Filter collides.
        sensors: whether sensors can also be hit.

        A RayHit has body, shape, point, normal and fraction. If the ray starts inside a shape, the fraction is 0 and
        the normal is opposite to the ray. If several shapes are hit at the same fraction, the one with the smallest id
        is returned. Raises TypeError for values of other types, ValueError for numbers that are not finite, or for an
        origin too far away.

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
        """Return a list with the RayHit of each shape that a ray hits, in the order of fraction, then of shape id.

        origin: start of the ray (x, y) [px]; translation: vector from the start to the end of the ray (x, y) [px].
        filter: the Filter of the ray, see ray_cast; sensors: whether sensors can also be hit.

        Raises TypeError and ValueError as ray_cast does.
        """
        return casts.ray_cast_all(self, origin, translation, filter, sensors)

    @hints.explained
    def ray_casts(
        self, origins: Points, translations: Points, filter: Filter = Filter.ALL, sensors: bool = False
    ) -> RayHits:
        """Return the first hit of each of n rays as an array (n,) of RAY_HIT rows, in the order of the rays.

        origins: starts of the rays (n, 2) [px]; translations: vectors from the starts to the ends (n, 2) [px].
        filter: the Filter of all rays, see ray_cast; sensors: whether sensors can also be hit.

        The row of a ray without a hit has body -1, fraction 1 and the end of the ray as point. Raises TypeError and
        ValueError as ray_cast does.
        """
        return batches.ray_casts(self, origins, translations, filter, sensors)

    @hints.explained
    def shape_cast(
        self, shape: Shape, pose: Pose, translation: Pair, filter: Filter = Filter.ALL, sensors: bool = False
    ) -> RayHit[Body] | None:
        """Return the RayHit of the first shape that a moving shape hits, or None if it hits no shape.

        shape: the shape that moves along a straight line without rotation.
        pose: start of the motion, (x, y) or (x, y, angle) [px, rad].
        translation: vector from the start to the end of the motion (x, y) [px].
        filter: the Filter of the moving shape, see ray_cast; sensors: whether sensors can also be hit.

        A shape that touches the moving shape at the start is hit at fraction 0 if the moving shape approaches it.
        Raises TypeError and ValueError as ray_cast does.
        """
        return casts.shape_cast(self, shape, pose, translation, filter, sensors)

    @hints.explained
    def closest(
        self, point: Pair, filter: Filter = Filter.ALL, sensors: bool = False
    ) -> tuple[Body, Vec2, float] | None:
        """Find the shape nearest to a point. Return (its Body, nearest point on the shape, distance [px]).

        point: (x, y) [px]; filter: the Filter of the query, see ray_cast; sensors: whether sensors are also considered.

        The result is None if no shape passes the filter. For a point inside a shape the distance is 0. Raises TypeError
        and ValueError as ray_cast does.
        """
        return casts.closest(self, point, filter, sensors)

    @hints.explained
    def overlap(self, shape: Shape, pose: Pose, filter: Filter = Filter.ALL, sensors: bool = False) -> list[Body]:
        """Return the bodies that a shape at a pose overlaps, in the order of body ids.

        shape: the tested shape; pose: (x, y) or (x, y, angle) [px, rad] of this shape in the world.
        filter: the Filter of the tested shape, see ray_cast; sensors: whether sensors are also considered.

        Raises TypeError and ValueError as ray_cast does.
        """
        return casts.overlap(self, shape, pose, filter, sensors)

    @hints.explained
    def query_aabb(self, lower: Pair, upper: Pair, filter: Filter = Filter.ALL, sensors: bool = False) -> list[Body]:
        """Return the bodies with a shape whose AABB overlaps or touches a box, in the order of body ids.

        lower, upper: corners of the box (x, y) [px] with the least and the greatest coordinates.
        filter: the Filter of the query, see ray_cast; sensors: whether sensors are also considered.

        To test exact shapes instead of AABBs use overlap; for a pygame.Rect use query_rect. Raises TypeError and
        ValueError as ray_cast does, ValueError also for lower > upper.
        """
        return casts.query_aabb(self, lower, upper, filter, sensors)

    @hints.explained
    def query_rect(self, rect: Rect, filter: Filter = Filter.ALL, sensors: bool = False) -> list[Body]:
        """Return the bodies with a shape whose AABB overlaps or touches a rectangle, in the order of body ids.

        rect: (x, y, width, height) or ((x, y), (width, height)) [px], such as a pygame.Rect.
        filter: the Filter of the query, see ray_cast; sensors: whether sensors are also considered.

        To test exact shapes instead of AABBs use overlap. Raises TypeError and ValueError as ray_cast does, ValueError
        also for a negative width or height.
        """
        return casts.query_rect(self, rect, filter, sensors)

    @hints.explained
    def query_point(self, point: Pair, filter: Filter = Filter.ALL, sensors: bool = False) -> list[Body]:
        """Return the bodies with a shape that contains a point, in the order of body ids.

        point: (x, y) [px]; filter: the Filter of the query, see ray_cast; sensors: whether sensors are also considered.

        Raises TypeError and ValueError as ray_cast does.
        """
        return casts.query_point(self, point, filter, sensors)

    @hints.explained
    def query_points(self, points: Points, filter: Filter = Filter.ALL, sensors: bool = False) -> PointHits:
        """Find the bodies that contain each of n points. Return a POINT_HIT row for each pair of a point and a body.

        points: (n, 2) [px].
        filter: the Filter of the query, see ray_cast; sensors: whether sensors are also considered.

        The rows are sorted by point, then by body.

        Raises TypeError and ValueError as ray_cast does.
        """
        return batches.query_points(self, points, filter, sensors)
