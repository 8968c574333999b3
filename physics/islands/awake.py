"""The awake rows of a world, which the passes of a step process.

Without sleeping these are all rows. With sleeping they are the awake dynamic bodies, moving kinematic bodies,
characters, and for one step added or edited bodies. Sleeping bodies and bodies at rest cost nothing. The lists are
updated as bodies wake and fall asleep, not searched for.
"""

import numpy as np

from physics.jit import inlined, kernel, subkernel
from physics.tables.body import DYNAMIC, KINEMATIC
from physics.tables.step_state import StepState, WorldTables, stage
from physics.tables.table import rows_of

NONE = np.zeros(0, np.int64)


@inlined
def is_active(body):
    """Return whether a body can change a contact: awake and dynamic, or else edited or moving."""
    if body.kind == DYNAMIC:
        return body.awake
    return (
        body.vx != 0.0
        or body.vy != 0.0
        or body.angular_velocity != 0.0
        or body.x != body.previous_x
        or body.y != body.previous_y
        or body.angle != body.previous_angle
    )


@subkernel
def wakes(body, other):
    """Return whether a body wakes a sleeping one on contact: it may move, or was edited."""
    return other.kind == DYNAMIC and not other.awake and (body.dirty or is_active(body))


@kernel
def list_active(bodies, rows, rows_out):
    """List those of the rows whose body is active and not quarantined. Return their number. O(rows)."""
    found = 0
    for k in range(len(rows)):
        b = bodies[rows[k]]
        if is_active(b) and not b.quarantined:
            rows_out[found] = rows[k]
            found += 1
    return found


@kernel
def gather_shapes(rows, order, starts, rows_out):
    """List the shape rows of distinct body rows; order, starts: shape rows by body row. Return their number.

    O(shapes of these bodies).
    """
    found = 0
    for k in range(len(rows)):
        for n in range(starts[rows[k]], starts[rows[k] + 1]):
            rows_out[found] = order[n]
            found += 1
    return found


class Awake:
    """The awake rows of one world: `bodies` and `shapes`, int64, ascending."""

    def __init__(self, sleeping: bool) -> None:
        self.sleeping = sleeping
        self.bodies = self.shapes = NONE
        self.dynamic = NONE  # rows of the awake dynamic bodies
        self.kinematic = NONE  # rows of all kinematic bodies
        self.dirty = []  # ids of bodies that were added or edited since the last step
        self.fresh = NONE  # rows of these in the step
        self.numbers = NONE  # 0, 1, 2 …
        self.order, self.starts = NONE, np.zeros(1, np.int64)  # shape rows by body row
        self.known = (0, 0)  # number of bodies and shapes that the lists cover
        self.stale = True  # rows have moved: the lists are built again

    def start_over(self) -> None:
        """Mark the lists to be built again: tables were replaced, rows dropped, or kinds of bodies changed."""
        self.stale = True

    def mark_dirty(self, ids: list[int]) -> None:
        """Add bodies, by id, to the rows of the next step, because they were added or edited."""
        if self.sleeping:
            self.dirty += ids

    def all_rows(self, bodies: np.ndarray, shapes: np.ndarray) -> None:
        """Set the lists to all rows: for worlds without sleeping."""
        if len(self.bodies) != len(bodies) or len(self.shapes) != len(shapes):
            most = max(len(bodies), len(shapes))
            if len(self.numbers) < most:
                self.numbers = np.arange(2 * most)
            self.bodies, self.shapes = self.numbers[: len(bodies)], self.numbers[: len(shapes)]

    def keep_rows(self, kept_bodies: np.ndarray) -> None:
        """Update the rows in the lists after bodies were dropped. kept_bodies: bool, of the former rows."""
        if self.sleeping and not self.stale:
            new = np.cumsum(kept_bodies) - 1
            for name in ("bodies", "dynamic", "kinematic"):
                rows = getattr(self, name)
                setattr(self, name, new[rows[kept_bodies[rows]]])
            self.known = (int(np.count_nonzero(kept_bodies[: self.known[0]])), -1)

    def forget_shapes(self) -> None:
        """Mark the shapes of the bodies to be looked up again, after shape rows were added or dropped."""
        self.known = (self.known[0], -1)

    def take_in(self, tables: WorldTables) -> None:
        """Update the lists with the added rows, or build them again.

        In the second case the bodies of the last step, by the column `active`, stay in the lists. The next step
        compares with these, and stores the touching pairs of bodies that have come to rest.
        """
        bodies, shapes = tables.bodies, tables.shapes
        count, shape_count = len(bodies), len(shapes)
        went_on = NONE
        if self.stale:
            went_on = np.flatnonzero(bodies["active"] & ~bodies["quarantined"])
            self.bodies = self.dynamic = self.kinematic = NONE
            bodies["active"] = False
            tables.pairs.proxies["awake"] = False
            self.known = (0, -1)
            self.stale = False
        if self.known[0] < count:
            new = bodies[self.known[0] :]
            there = ~new["quarantined"]
            kinds = new["kind"]
            self.dynamic = np.concatenate(
                [self.dynamic, self.known[0] + np.flatnonzero((kinds == DYNAMIC) & new["awake"] & there)]
            )
            self.kinematic = np.concatenate(
                [self.kinematic, self.known[0] + np.flatnonzero((kinds == KINEMATIC) & there)]
            )
        if self.known != (count, shape_count):
            self._sort_shapes(bodies, shapes)
            self.known = (count, shape_count)
            self.shapes = self.shapes_of(self.bodies)
        if len(went_on):
            self.include(tables, went_on)

    def _sort_shapes(self, bodies, shapes):
        owners = np.ascontiguousarray(shapes["body_row"])
        self.order = np.argsort(owners, kind="stable")
        self.starts = np.searchsorted(owners[self.order], np.arange(len(bodies) + 1))

    def is_known(self, bodies: np.ndarray, shapes: np.ndarray) -> bool:
        """Return whether the lists cover these tables."""
        return not self.stale and self.known == (len(bodies), len(shapes))

    def may_move(self, bodies: np.ndarray, before: np.ndarray) -> np.ndarray:
        """Return the body rows whose pose may differ from when the rows of `before` were awake, at most one step
        ago."""
        dirty = rows_of(bodies, np.array(self.dirty, np.int64))
        return np.unique(np.concatenate([before, self.bodies, self.dynamic, self.kinematic, dirty[dirty >= 0]]))

    def shapes_of(self, rows: np.ndarray) -> np.ndarray:
        """Return the shape rows of these body rows, ascending."""
        gathered = np.empty(len(self.order), np.int64)
        return np.sort(gathered[: gather_shapes(rows, self.order, self.starts, gathered)])

    def include(self, tables: WorldTables, rows: np.ndarray) -> None:
        """Add body rows to the lists, also in the middle of a step; their pairs are searched again."""
        self.take_in(tables)
        self.bodies = np.union1d(self.bodies, rows)
        new = rows[tables.bodies["kind"][rows] == DYNAMIC]
        if len(new):
            self.dynamic = np.union1d(self.dynamic, new)
        self._set_active(tables, rows, True)
        self.shapes = self.shapes_of(self.bodies)

    def exclude(self, tables: WorldTables, rows: np.ndarray) -> None:
        """Drop body rows from the lists; they do not change until they are included again."""
        self.take_in(tables)
        self._set_active(tables, rows, False)
        flags = tables.bodies["active"]
        self.bodies = self.bodies[flags[self.bodies]]
        self.dynamic = self.dynamic[flags[self.dynamic]]
        self.shapes = self.shapes_of(self.bodies)

    def _set_active(self, tables, rows, active):
        tables.bodies["active"][rows] = active
        tables.pairs.set_awake(tables.shapes["proxy"][self.shapes_of(rows)], active)


@stage(
    "awake",
    reads=("bodies", "shapes", "characters", "awake", "sleeping_set", "pairs", "touching", "sensing"),
    writes=("awake", "sleeping_set", "pairs", "touching", "sensing", "bodies.active", "bodies.dirty"),
)
def list_awake(state: StepState) -> None:
    """List the rows of this step, and update non-dynamic bodies that begin or cease to move."""
    awake, bodies = state.awake, state.bodies
    awake.take_in(state)
    moving = np.empty(len(awake.kinematic), np.int64)
    moving = moving[: list_active(bodies, awake.kinematic, moving)]
    wanted = [awake.dynamic, moving]
    if len(awake.fresh):
        bodies["dirty"] = False  # left by a step that raised an error
        awake.fresh = NONE
    if awake.dirty:
        dirty = rows_of(bodies, np.array(awake.dirty, np.int64))
        awake.fresh = dirty[dirty >= 0]
        bodies["dirty"][awake.fresh] = True
        wanted.append(awake.fresh)
        awake.dirty = []
    if len(state.characters):
        wanted.append(state.characters["body_row"])
    rows = np.unique(np.concatenate(wanted)) if sum(map(len, wanted)) > len(awake.dynamic) else awake.dynamic
    if len(rows) == len(awake.bodies) and np.array_equal(rows, awake.bodies):
        return
    flags = bodies["active"]
    begun = rows[~flags[rows]]
    ended = np.setdiff1d(awake.bodies, rows, assume_unique=True)
    if len(begun):
        awake.include(state, begun)
        state.sleeping_set.return_reported(state, bodies["id"][begun])
    if len(ended):
        awake.exclude(state, ended)
        state.sleeping_set.keep_reported(state)
