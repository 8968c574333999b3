"""WorldState, the tables and settings of a world, and Profile, the times and work counters of a step."""

import copy
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physics import checks, hints
from physics.annotations import BroadphaseName, JointSolverName, Pair, SolverName, Substeps, TierName
from physics.broadphase import checked_broadphase
from physics.broadphase.proxies import PairList, Strategy, write_rectangles
from physics.collision.areas import with_areas
from physics.collision.manifold import contacts_of
from physics.contacts.cache import drop_contacts
from physics.effects import Effects, declaring
from physics.events import Events, Pairs
from physics.islands import sleep
from physics.islands.awake import Awake
from physics.islands.sleep import SleepingSet
from physics.math2d import Vec2
from physics.queries.index import QueryIndex
from physics.settings import ACCURACY, Tolerances, tolerances
from physics.shapes.library import Library
from physics.shapes.shape import Shape
from physics.solver.loads import ContactLists
from physics.tables.body import DYNAMIC, KINDS, SCATTERED, STATIC
from physics.tables.columns import BodyRows, ContactRows, JointRows
from physics.tables.step_state import COUNTERS
from physics.tables.table import Table, numbers_after, row_number, rows_in, rows_of

# ---- profile ---------------------------------------------------------------------------------------------------------
# Times of the stages of a step, and its work counters, an int64 array to which kernels add.


class Profile:
    """The times of the stages and the work counters of the last step. World.profile is a Profile."""

    def __init__(self, names: Sequence[str]) -> None:
        self.work = np.zeros(len(COUNTERS), np.int64)
        self.begin(names)

    def begin(self, names: Sequence[str]) -> list[float]:
        """Reset the profile for a step. Return an empty list, to which the caller appends the time [s] of each stage.

        names: names of the stages, in the order of the times.
        """
        self.work.fill(0)
        self._names, self._spent = names, []
        return self._spent

    def __copy__(self) -> "Profile":
        return copy.deepcopy(self)  # the next step overwrites the counters of the original

    def __repr__(self):
        """Return a text with the time of the last step, its longest stage, and the counters that are not 0."""
        stages, counters = self.stages, {name: count for name, count in self.counters.items() if count}
        longest = max(stages, key=stages.__getitem__, default="")
        parts = [f"{len(stages)} stages in {1e3 * sum(stages.values()):.3g} ms"]
        parts += [f"longest {longest} {1e3 * stages[longest]:.3g} ms"] if longest else []
        return f"Profile({', '.join([*parts, *(f'{name}={count}' for name, count in counters.items())])})"

    @property
    def stages(self) -> dict[str, float]:
        """Times of the stages of the last step, {name: seconds} in the order of execution.

        The time of a stage that has not run is 0.0.
        """
        found = dict.fromkeys(self._names, 0.0)
        for name, seconds in zip(self._names, self._spent, strict=False):
            found[name] += seconds
        return found

    @property
    def counters(self) -> dict[str, int]:
        """Work counters of the last step, {name: int}, with all names in COUNTERS."""
        return dict(zip(COUNTERS, self.work.tolist(), strict=True))


# ---- world state -----------------------------------------------------------------------------------------------------
# WorldState: the fields of a world by name and type, and the accessors that its parts share.


def checked_substeps(value: Any) -> Substeps:
    """Return `value` if it is a whole number of substeps from 1 to 1000, or "auto".

    Raises TypeError or ValueError for other values.
    """
    if isinstance(value, str) and value != "auto":
        hint = hints.in_place_of_word("substeps", value, ("auto",))
        raise ValueError(f'substeps must be a whole number from 1 to 1000, or "auto" (got {checks.shown(value)}){hint}')
    return "auto" if isinstance(value, str) else checks.whole("substeps", value, 1, 1000)


def checked_accuracy(value: Any) -> float | None:
    """Return `value` if it is a positive length [px], or None. Raises TypeError or ValueError for other values."""
    return None if value is None else checks.number("accuracy", value, above=0.0)


class Handle:
    """A reference to a body by the World and the id of the body. Base class of Body."""

    __slots__ = ("_world", "_id")

    def __init__(self, world: "WorldState", identity: int) -> None:
        if not isinstance(world, WorldState):
            raise TypeError(f"world must be a World (got {checks.shown(world)})")
        object.__setattr__(self, "_world", world)
        object.__setattr__(self, "_id", world._identity("identity", identity))

    @property
    def world(self) -> Any:
        """The World of the body."""
        return self._world

    @property
    def id(self) -> int:
        """The id of the body, which is never used again in its world."""
        return self._id

    def __eq__(self, other):
        return isinstance(other, Handle) and other.world is self.world and other.id == self.id

    def __hash__(self):
        return hash((id(self.world), self.id))

    def __repr__(self):
        """Return a text with the id and, if the body exists, its kind, position and velocity. No error is raised."""
        identity, bodies = self._id, self._world._bodies
        row = -1 if identity in self._world._removed else row_number(bodies, identity)
        if row < 0:
            return f"Body({identity}, removed)"
        b = bodies.data[row]
        kind = KINDS[b["kind"]] if 0 <= b["kind"] < len(KINDS) else f"kind {b['kind']}"
        state = ", quarantined" if b["quarantined"] else "" if b["awake"] or b["kind"] != DYNAMIC else ", asleep"
        place, motion = (f"({b[x]:.6g}, {b[y]:.6g})" for x, y in (("x", "y"), ("vx", "vy")))
        return f"Body({identity}, {kind}, position={place}, velocity={motion}{state})"


class WorldState:
    """The fields of a World, and accessors that other modules need. Base class of World, which sets all fields."""

    tolerances: Tolerances
    library: Library
    characters: Table
    random: np.random.Generator
    pairs: PairList
    awake: Awake
    sleeping_set: SleepingSet
    sensed: np.ndarray | None
    ghosts: np.ndarray | None
    touching_pairs: Pairs
    sensing_pairs: Pairs
    contact_lists: ContactLists
    queries: QueryIndex
    events: Events
    steps: int  # number of steps so far
    time: float  # their total length [s]
    span: float  # averaging window [s] of the cached contact forces, so that a short step changes them little
    profile: Profile
    workspace: Any  # a Workspace of step.py
    # Properties of World.
    joint_solver: JointSolverName
    solver: SolverName
    stacks: bool

    _gravity: Vec2
    _drag: float
    _wind: Vec2
    _dt: float
    _substeps: Substeps
    _accuracy: float | None
    _effects: Effects
    _plans: tuple[Any, Any]  # Plans of step.py: for a world without characters, with characters
    _stepping: bool
    _bodies: Table
    _definitions: Table  # BODY_DEF rows, one for each BODY row
    _shapes: Table
    _runs: Table  # RUN rows, one for each BODY row
    _contact_rows: np.ndarray
    _joints: Table
    _drop_joints_of: Callable[[np.ndarray], None]  # a method of World
    _joint_users: dict[int, Any]
    _apart: set[int] | None  # bodies of joints that changed since the last step; None: no joint has changed
    _lost_joints: list[tuple]  # BROKEN rows of joints whose bodies were removed since the last step
    _next_joint: int
    _removed: dict[int, None]  # ids of removed bodies, in order, whose rows are dropped when the tables are read
    _templates: dict[Any, Any]  # body_templates.Template by arguments of add_body
    _next_body: int
    _next_shape: int
    _carved_pixels: int  # number of pixels carved since the last step
    _users: dict[int, Any]  # this and the next four fields: by body id
    _targets: dict[int, tuple[float, float, float]]  # poses at the end of the next step
    _shapes_of: dict[int, tuple[Shape, ...]]
    _tiers: dict[int, TierName]
    _sources: dict[int, tuple[Shape, ...]]
    _broadphase: Strategy
    _reported: tuple[np.ndarray, np.ndarray | None]
    _contacts: np.ndarray | None

    def __repr__(self) -> str:
        """Return a text with the numbers of bodies, joints and contacts, the time, the solver and the effects."""
        if "profile" not in vars(self):
            return "World(unfinished)"
        bodies, rows, removed = self._bodies.rows, self.reported_rows(), list(self._removed)
        awake = bodies["awake"] & (bodies["kind"] == DYNAMIC) & ~np.isin(bodies["id"], removed)
        counts = [f"{self._bodies.count - len(removed)} bodies ({np.count_nonzero(awake)} dynamic and awake)"]
        counts += [f"{self._joints.count} joints"] if self._joints.count else []
        there = ~np.isin(rows["body_a"], removed) & ~np.isin(rows["body_b"], removed)
        counts += [f"{rows['count'][there].sum()} contacts"]
        step = f"step {self.steps}, time={self.time:.6g} s, solver={self.solver!r}"
        return f"{type(self).__name__}({', '.join(counts)}, {step}, {self._effects!r})"

    # --- tables --------------------------------------------------------------------------------------------------

    @property
    def bodies(self) -> BodyRows:
        """BODY rows (n,) of all bodies, in the order of ids. The array is valid until a body is added or removed."""
        if self._removed:
            self._drop_removed()
        return self._bodies.rows  # pyright: ignore[reportReturnType]

    @property
    def shapes(self) -> np.ndarray:
        """SHAPE rows (n,) of all shapes, in the order of ids.

        The array is valid until a body or shape is added or removed.
        """
        if self._removed:
            self._drop_removed()
        return self._shapes.rows

    @property
    def joints(self) -> JointRows:
        """JOINT rows (n,) of all joints, in the order of ids.

        The array is valid until a joint is added, removed or broken. Columns with settings may be written between
        steps; afterwards call `touch` to wake the bodies of these joints.
        """
        if self._removed:
            self._drop_removed()
        return self._joints.rows  # pyright: ignore[reportReturnType]

    @property
    def contacts(self) -> ContactRows:
        """CONTACT_POINT rows (n,), one for each contact point of the last step, sorted by shape ids.

        They are the points of pairs that touched, or for which the sweep found an impact.
        """
        if self._contacts is None:
            self._contacts = contacts_of(with_areas(self, self.reported_rows()))
        return self._contacts  # pyright: ignore[reportReturnType]

    def reported_rows(self) -> np.ndarray:
        """Return the CONTACT rows (n,) whose points are listed in `contacts`."""
        rows, keep = self._reported
        return rows if keep is None or keep.all() else rows[keep]

    @property
    def contact_rows(self) -> np.ndarray:
        """CONTACT rows (n,) of the last step, in the order of shape ids.

        Stacking solvers warm start the contacts of the next step from these rows.
        """
        if self._removed:
            self._drop_removed()
        return self._contact_rows

    @contact_rows.setter
    def contact_rows(self, rows: np.ndarray) -> None:
        self._contact_rows = rows

    @property
    def sleeping_contacts(self) -> ContactRows:
        """CONTACT_POINT rows (n,) of all contacts of sleeping islands, evaluated when the islands fell asleep."""
        return contacts_of(with_areas(self, self.sleeping_set.contacts()))  # pyright: ignore[reportReturnType]

    def report_contacts(self, rows: np.ndarray, keep: np.ndarray | None = None) -> None:
        """Store the CONTACT rows whose points `contacts` lists from now on.

        keep: a bool for each row, True if its points are listed; None: the points of all rows are listed.
        """
        self._reported, self._contacts = (rows, keep), None

    @property
    def candidates(self) -> NDArray[np.int32]:
        """Candidate pairs of the last step, after broad phase and filters: (n, 2) int32 shape ids a < b, sorted."""
        return self.pairs.ids(self.shapes).astype(np.int32)

    def rows(self, ids: Any) -> np.ndarray:
        """Return the row numbers of bodies in `world.bodies`, as an int64 array of the same shape as `ids`.

        ids: Bodies or ids, one or many, in the order of the result; not a set.

        Raises KeyError for a body that is not in this world, TypeError for anything but Bodies and ids, ValueError for
        a Body of another world.
        """
        checks.in_order("ids", ids, "the result")
        if isinstance(ids, Handle) or (isinstance(ids, (list, tuple)) and any(isinstance(x, Handle) for x in ids)):
            ids = self._identities("ids", ids)
        try:
            ids = np.asarray(ids)
        except ValueError:  # rows of different lengths
            raise TypeError(f"ids must be Bodies or ids (got {checks.shown(ids)})") from None
        if ids.size and ids.dtype.kind not in "iu":
            raise TypeError(f"ids must be Bodies or ids (got {checks.shown(ids)})")
        ids = ids.astype(np.int64, copy=False)
        if self._removed:
            self._drop_removed()
        rows = rows_in(self._bodies, ids.ravel())
        if (rows < 0).any():
            raise checks.NoSuchId(f"body {ids.ravel()[rows < 0][0]} is not in this world (removed, or never added)")
        return rows.reshape(ids.shape)

    def refresh_character_rows(self) -> None:
        """Update the column `body_row` of all characters, because row numbers change when bodies are removed."""
        if self.characters.count:
            characters = self.characters.rows
            characters["body_row"] = rows_of(self.bodies, characters["body"])

    def rebuild_proxies(self) -> None:
        """Replace the broad phase by an empty one, and add proxies for all shapes, after the tables were replaced."""
        self.pairs, self._apart = PairList(self.sleeps), set()
        self.awake.start_over()
        self._broadphase = self._broadphase.fresh()
        active = ~self.bodies["quarantined"][self.shapes["body_row"]]
        rows = np.flatnonzero(active)
        self.shapes["proxy"] = -1
        self.pairs.add_proxies(self.shapes, rows, self.bodies["kind"][self.shapes["body_row"][rows]] == STATIC)
        # Bodies that are not awake get no swept AABB in the next step, so they get one here.
        changed = write_rectangles(self, rows)
        self.pairs.search_again.append(self.pairs.changed[:changed].copy())

    @property
    def sleeps(self) -> bool:
        """Whether islands at rest can sleep. This needs the effect `sleeping` and a stacking solver."""
        return self.stacks and self._effects.sleeping

    @property
    def effects(self) -> Effects:
        """The declared effects of the world. Replace them by `set_effects`."""
        return self._effects

    @property
    def _plan_now(self) -> Any:
        return self._plans[self.characters.count > 0]

    @property
    def stages(self) -> list[str]:
        """Names of the stages of a step with the present effects, in the order of execution.

        The stages of characters are included only if the world has a character.
        """
        return list(self._plan_now.names)

    # --- settings, which can be set between steps ---------------------------------------------------------------

    @property
    def gravity(self) -> Vec2:
        """The acceleration (x, y) of gravity [px/s²]. It can be set between steps; a change wakes all bodies."""
        return self._gravity

    @gravity.setter
    def gravity(self, value: Pair) -> None:
        self._unlocked()
        gravity = checks.vector("gravity", value)
        self._needs_fields(gravity=gravity)
        self._gravity = self._felt(self._gravity, gravity, self._effects.gravity)

    def _felt(self, before, now, felt):
        """Return `now`, the new value of gravity, drag or wind, and wake all bodies if it differs from `before`.

        felt: whether the value acts on bodies with the present effects; if False, no body wakes.
        """
        if felt and now != before:
            sleep.wake_all(self)
        return now

    @property
    def dt(self) -> float:
        """The default length of a step [s]. It can be set between steps."""
        return self._dt

    @dt.setter
    def dt(self, value: float) -> None:
        self._unlocked()
        self._dt = checks.seconds("dt", value, above=0.0)

    @property
    def drag(self) -> float:
        """The rate [1/s] at which drag reduces velocities. It can be set between steps; a change wakes all bodies."""
        return self._drag

    @drag.setter
    def drag(self, value: float) -> None:
        self._unlocked()
        felt, drag = self._effects.drag or self._effects.wind, checks.number("drag", value, low=0.0)
        self._needs_fields(drag=drag)
        self._drag = self._felt(self._drag, drag, felt)

    @property
    def wind(self) -> Vec2:
        """The velocity (x, y) of the air [px/s], which accelerates bodies by drag · wind.

        It can be set between steps; a change wakes all bodies.
        """
        return self._wind

    @wind.setter
    def wind(self, value: Pair) -> None:
        self._unlocked()
        wind = checks.vector("wind", value)
        self._needs_fields(wind=wind)
        self._wind = self._felt(self._wind, wind, self._effects.wind)

    @property
    def substeps(self) -> Substeps:
        """The number of substeps of the stacking solvers, 1 to 1000, or "auto" (see World).

        It can be set between steps.
        """
        return self._substeps

    @substeps.setter
    def substeps(self, value: Substeps) -> None:
        self._unlocked()
        self._substeps = checked_substeps(value)

    @property
    def accuracy(self) -> float:
        """The greatest sag [px] of a contact under its load for which substeps="auto" chooses the number of substeps.

        The sag may be greater if the greatest number of substeps, 32 (128 for a leaning island), is not enough. The
        value can be set between steps; None sets 1 mm.
        """
        return ACCURACY * self.tolerances.pixels_per_meter if self._accuracy is None else self._accuracy

    @accuracy.setter
    def accuracy(self, value: float | None) -> None:
        self._unlocked()
        self._accuracy = checked_accuracy(value)

    @property
    def restitution_speed(self) -> float:
        """The approach speed [px/s] above which an impact bounces. It can be set between steps; None sets 1 m/s."""
        return self.tolerances.restitution_speed

    @restitution_speed.setter
    def restitution_speed(self, value: float | None) -> None:
        self._unlocked()
        self._set_restitution_speed(value)

    def _set_restitution_speed(self, value: float | None) -> None:
        if value is None:
            speed = tolerances(self.tolerances.pixels_per_meter).restitution_speed
        else:
            speed = checks.number("restitution_speed", value, low=0.0)
        self.tolerances = replace(self.tolerances, restitution_speed=speed)

    @property
    def broadphase(self) -> Strategy:
        """The broad phase, which finds the candidate pairs. Results do not depend on its choice.

        It can be set between steps, to an instance of a strategy or to a name in BROADPHASES.
        """
        return self._broadphase

    @broadphase.setter
    def broadphase(self, strategy: Strategy | BroadphaseName) -> None:
        self._unlocked()
        self._broadphase = checked_broadphase(strategy)
        self.pairs.start_over()

    # --- for World, Body and edit -----------------------------------------------------------------------------------

    def _unlocked(self) -> None:
        """Raise RuntimeError during a step. Otherwise delete the rows of removed bodies from the tables."""
        self._unstepped()
        if self._removed:
            self._drop_removed()

    def _unstepped(self) -> None:
        """Raise RuntimeError during a step."""
        if self._stepping:
            raise RuntimeError("the world cannot be changed during its step: read the events after it")

    def _row_number(self, identity: int) -> int:
        """Delete the rows of removed bodies from the tables, and return the row number of a body (id).

        The number is valid until a body is removed. Raises KeyError for an unknown body.
        """
        if self._removed:
            self._drop_removed()
        return self._row_at(identity)

    def _row_at(self, identity: int) -> int:
        """Return the row number of a body (id), without first deleting the rows of removed bodies from the tables.

        The number is valid until `bodies` or `shapes` is read, because these properties delete such rows and thereby
        move other rows. Use it only to access single values by Table.columns. Raises KeyError for an unknown body.
        """
        row = -1 if identity in self._removed else row_number(self._bodies, identity)
        if row < 0:
            raise checks.NoSuchId(f"body {identity} is not in this world (removed, or never added)")
        return row

    def _shape_rows(self, row: int) -> np.ndarray:
        """Return the ascending SHAPE row numbers (n,) of the body with the row number `row`.

        The rows of removed bodies are not deleted first.
        """
        run = self._runs.data
        count = run["count"].item(row)
        if count == SCATTERED:
            return np.flatnonzero(self._shapes.rows["body_row"] == row)
        if count == 0:
            return np.zeros(0, np.int64)
        first = row_number(self._shapes, run["first"].item(row))
        return np.arange(first, first + count)

    def _shape_rows_of(self, rows: np.ndarray) -> np.ndarray:
        """Return the SHAPE row numbers (n,), in any order, of all bodies with the row numbers `rows`.

        The rows of removed bodies are not deleted first.
        """
        runs, shapes = self._runs.data[rows], self._shapes.rows
        firsts, counts = runs["first"], runs["count"]
        least = int(counts.min()) if len(rows) else 0
        if least == SCATTERED:
            mine = np.zeros(self._bodies.count, bool)
            mine[rows] = True
            return np.flatnonzero(mine[shapes["body_row"]])
        if least == 0:
            firsts, counts = firsts[counts > 0], counts[counts > 0]
        if not len(firsts):
            return np.zeros(0, np.int64)
        starts = rows_in(self._shapes, firsts)
        if (counts == 1).all():
            return starts
        ends = np.cumsum(counts)
        return np.repeat(starts - ends + counts, counts) + np.arange(ends[-1])

    def _write_runs(self) -> None:
        """Write the RUN rows of all bodies after the tables were replaced.

        A RUN row contains the id of the body's first SHAPE row and the number of its SHAPE rows.
        """
        bodies, owners, ids = self._bodies.count, self.shapes["body_row"], self.shapes["id"]
        self._runs.count = 0
        runs, numbers = self._runs.append(bodies), np.arange(len(owners))
        starts, ends = np.zeros(bodies, np.int64), np.zeros(bodies, np.int64)
        starts[owners[::-1]], ends[owners] = numbers[::-1], numbers
        counts = np.bincount(owners, minlength=bodies)
        runs["count"] = np.where((counts > 0) & (ends - starts + 1 != counts), SCATTERED, counts)
        runs["first"][counts > 0] = ids[starts[counts > 0]]

    def _write_run(self, row: int) -> None:
        """Write the RUN row of the body with the row number `row` after its shapes changed. See _write_runs."""
        mine, run = np.flatnonzero(self.shapes["body_row"] == row), self._runs.data
        run["count"][row] = len(mine) if not len(mine) or mine[-1] - mine[0] + 1 == len(mine) else SCATTERED
        run["first"][row] = self.shapes["id"][mine[0]] if len(mine) else 0

    def _identity(self, name: str, value: Any) -> int:
        """Return the id of a body as an int, without a test whether the body exists. value: a Body or an id.

        name: name of the argument in messages. Raises TypeError for any other value, ValueError for a Body of another
        world, KeyError for a number outside the range of ids (0 to 2**62 - 1).
        """
        if isinstance(value, Handle):
            if value.world is not self:
                raise ValueError(f"{name} must be of this world (got {checks.shown(value)} of another one)")
            return value.id
        if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
            raise TypeError(f"{name} must be a Body or an id (got {checks.shown(value)})")
        if not 0 <= value < 2**62:
            raise checks.NoSuchId(f"{name} must be a Body or the id of one (got {value})")
        return int(value)

    def _identities(self, name: str, value: Any, repeats: bool = False) -> np.ndarray:
        """Return the ids (n,) int64 of bodies, without a test whether the bodies exist.

        value: Bodies or ids, one or many; name: name of the argument in messages; repeats: whether an id may occur more
        than once. Raises TypeError, ValueError or KeyError for invalid arguments.
        """
        if isinstance(value, (Handle, int, np.integer)):
            value = [value]
        if isinstance(value, np.ndarray) and value.dtype != np.object_:
            return checks.ids(name, value, repeats)
        found = checks.listed(value)
        if found is None:
            raise TypeError(f"{name} must be Bodies or ids (got {checks.shown(value)})")
        value = found
        kinds = set(map(type, value))
        if kinds == {int} and 0 <= min(value) and max(value) < 2**62:
            each = value
        elif len(kinds) == 1 and issubclass(next(iter(kinds)), Handle) and {one._world for one in value} == {self}:
            each = [one._id for one in value]
        else:
            each = [self._identity(f"{name}[{k}]", one) for k, one in enumerate(value)]
        return checks.ids(name, np.array(each, np.int64), repeats)

    def _tidy_library(self) -> None:
        """Remove the geometry without a shape from the library.

        Nothing is removed while a quick upper bound of its share is below one half.
        """
        if self.library.may_be_half_unused(self._shapes.count):
            self.library = self.library.without_unused(self.shapes)

    def _body_row(self, identity: int) -> np.void:
        row = self._row_number(identity)
        return self._bodies.data[row]

    def _drop_shapes(self, keep: np.ndarray) -> None:
        self.pairs.name(self.shapes)
        self.pairs.free_proxies(self.shapes["proxy"][~keep])
        self._shapes.keep(keep)
        self.library.gone += int(np.count_nonzero(~keep))
        self.pairs.rename(self.shapes)
        self.awake.forget_shapes()

    def _remove(self, ids: Sequence[int] | np.ndarray) -> None:
        """Remove the bodies with these ids. Raises KeyError for an unknown id; no body is then removed."""
        self._unlocked()
        ids = np.asarray(ids, np.int64)
        if not len(ids):
            return
        self._drop_joints_of(ids)
        rows = self.rows(ids)
        sleep.disturb(self, ids)
        self.contact_lists.forget_loads(self, rows, together=True)
        for identity in ids.tolist():
            self._forget_values(identity)
        self._drop_rows(ids, rows)

    def _remove_one(self, identity: int) -> None:
        """Remove the body with this id. Raises KeyError for an unknown id.

        In a world without characters and joints, the body's rows are deleted only when the tables are next read.
        """
        self._unstepped()
        if self.characters.count or self._joints.count:
            self._remove([identity])
            return
        at = sleep.disturb_one(self, identity, self._row_at(identity))
        self.contact_lists.forget_loads_of(self, at)
        self._bodies.columns["inverse_mass"][at] = 0.0  # forget_below stops at this body
        self._forget_values(identity)
        self._removed[identity] = None

    def _refresh_joint_rows(self) -> None:
        """Write the present row numbers of their two bodies to all JOINT rows."""
        if self._joints.count:
            joints = self._joints.rows
            for side in ("a", "b"):
                joints[f"body_row_{side}"] = rows_in(self._bodies, joints[f"body_{side}"])

    def _forget_values(self, identity: int) -> None:
        """Delete the values of a body (id) that are stored outside of the tables, such as its shapes and user value."""
        del self._shapes_of[identity]
        for values in (self._users, self._tiers, self._sources, self._targets):
            if values:
                values.pop(identity, None)

    def _drop_removed(self) -> None:
        """Delete from the tables the rows of all bodies that were removed by _remove_one."""
        ids = np.array([*self._removed], np.int64)
        self._removed.clear()
        self._drop_rows(ids, rows_in(self._bodies, ids))

    def _drop_rows(self, ids: np.ndarray, rows: np.ndarray) -> None:
        """Delete the rows of bodies, and of their shapes, contacts and characters, from the tables.

        ids, rows: ids and row numbers of the bodies.
        """
        keep = np.ones(self._bodies.count, bool)
        keep[rows] = False
        kept_shapes = keep[self.shapes["body_row"]]
        new_bodies = numbers_after(keep)
        drop_contacts(self, new_bodies, numbers_after(kept_shapes))
        self._drop_shapes(kept_shapes)
        self._bodies.keep(keep)
        self._definitions.keep(keep)
        self._runs.keep(keep)
        self.awake.renumber(new_bodies)
        self.shapes["body_row"] = new_bodies[self.shapes["body_row"]]
        if self.characters.count:
            self.characters.keep(~np.isin(self.characters.rows["body"], ids))
        self._refresh_joint_rows()
        self._tidy_library()

    def _needs(self, effect: str, what: str, asked: bool) -> None:
        if asked and not getattr(self._effects, effect):
            raise ValueError(f"{what} needs the effect {effect}: declare it in {declaring(self._effects, effect)}")

    def _needs_fields(self, gravity: Vec2 | None = None, drag: float = 0.0, wind: Vec2 | None = None) -> None:
        """Raise ValueError if a gravity, drag or wind other than 0 is given whose effect is not declared.

        For drag the effect `wind` is sufficient too.
        """
        self._needs("gravity", f"gravity={gravity}", bool(gravity and any(gravity)))
        self._needs("drag", f"drag={drag}", drag != 0.0 and not self._effects.wind)
        self._needs("wind", f"wind={wind}", bool(wind and any(wind)))

    def _needs_velocities(self, what: str) -> None:
        if "integrate_velocities" not in self.stages and not self.stacks:
            raise ValueError(f"{what} needs one of the effects response, gravity, drag, wind")
