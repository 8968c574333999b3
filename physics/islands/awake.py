"""Lists of awake rows: the bodies and shapes that the passes of a step process.

Without sleeping, the lists contain all rows. With sleeping, they contain the awake dynamic bodies, moving static or
kinematic bodies, characters, and for one step the added or edited bodies. Sleeping bodies and bodies at rest cost
nothing. The lists are updated when bodies wake or fall asleep, so a step does not have to search all bodies.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.islands.graph import JOINT_EDGE, NO_NODE, write_pair
from physics.jit import inlined, kernel, subkernel
from physics.math2d import norm, rotation_of
from physics.tables.body import DYNAMIC, KINEMATIC
from physics.tables.joint import GEARED, LENGTH, ON_AXIS, PINNED, SLUNG, TOOTHED
from physics.tables.step_state import StepState, WorldTables, stage
from physics.tables.table import distinct, join_trees, root_of, rows_of, without

NONE = np.zeros(0, np.int64)


@inlined
def is_active(body):
    """Return whether a body can change a contact. body: BODY row.

    A dynamic body can change contacts if it is awake. Another body can change them if it moves or was moved.
    """
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
    """Return whether `body` wakes `other` on contact: `other` is asleep, and `body` is active or was edited.

    body, other: BODY rows; for active see is_active.
    """
    return other.kind == DYNAMIC and not other.awake and (body.dirty or is_active(body))


@kernel
def list_active(bodies, rows, rows_out):
    """Write the rows among `rows` whose bodies are active (see is_active) and not quarantined. Return their number.

    bodies: BODY table; rows, rows_out: row numbers. O(rows).
    """
    found = 0
    for k in range(len(rows)):
        b = bodies[rows[k]]
        if is_active(b) and not b.quarantined:
            rows_out[found] = rows[k]
            found += 1
    return found


@kernel
def gather_shapes(rows, order, starts, rows_out):
    """Write the row numbers of all shapes of the given bodies to rows_out. Return their number.

    O(shapes of these bodies). rows: distinct body rows; order: shape rows sorted by body row; starts: index in `order`
    of the first shape of each body row.
    """
    found = 0
    for k in range(len(rows)):
        for n in range(starts[rows[k]], starts[rows[k] + 1]):
            rows_out[found] = order[n]
            found += 1
    return found


class Awake:
    """The lists of awake rows of one world: `bodies` and `shapes`, int64 row numbers, ascending.

    sleeping: whether bodies of the world may sleep. If not, the lists contain all rows.
    """

    def __init__(self, sleeping: bool) -> None:
        self.sleeping = sleeping
        self.bodies = self.shapes = NONE
        self.dynamic = NONE  # rows of the awake dynamic bodies
        self.kinematic = NONE  # rows of all kinematic bodies
        self.dirty = []  # ids of bodies that were added or edited since the last step
        self.fresh = NONE  # rows of the added or edited bodies during a step
        self.numbers = NONE  # 0, 1, 2 …
        self.order, self.starts = NONE, np.zeros(1, np.int64)  # shape rows by body row
        self.known = (0, 0)  # numbers of bodies and shapes that the lists cover; -1: the shapes have changed
        self.stale = True  # whether the lists must be rebuilt

    def start_over(self) -> None:
        """Mark the lists to be rebuilt.

        Call it after replacing tables, quarantining bodies or changing the kind of a body.
        """
        self.stale = True

    def mark_dirty(self, ids: list[int]) -> None:
        """Include added or edited bodies (ids) in the lists of the next step. No effect without sleeping."""
        if self.sleeping:
            self.dirty += ids

    def all_rows(self, bodies: np.ndarray, shapes: np.ndarray) -> None:
        """Set both lists, `bodies` and `shapes`, to all row numbers, for a world without sleeping."""
        if len(self.bodies) != len(bodies) or len(self.shapes) != len(shapes):
            most = max(len(bodies), len(shapes))
            if len(self.numbers) < most:
                self.numbers = np.arange(2 * most)
            self.bodies, self.shapes = self.numbers[: len(bodies)], self.numbers[: len(shapes)]

    def renumber(self, new_bodies: np.ndarray) -> None:
        """Update the row numbers in the lists after body rows were removed.

        new_bodies: new number of each row before the removal, negative for a removed row.
        """
        if self.sleeping and not self.stale:
            for name in ("bodies", "dynamic", "kinematic"):
                rows = new_bodies[getattr(self, name)]
                setattr(self, name, rows[rows >= 0])
            self.known = (int(np.count_nonzero(new_bodies[: self.known[0]] >= 0)), -1)

    def forget_shapes(self) -> None:
        """Mark the list of shape rows to be rebuilt, after shape rows were added or removed."""
        self.known = (self.known[0], -1)

    def take_in(self, tables: WorldTables) -> None:
        """Add rows that are new in `tables` to the lists, or rebuild the lists if start_over has marked them.

        Rebuilt lists contain the bodies of the last step (column `active`). The next step can then find the bodies that
        have come to rest since, and store their touching pairs.
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
        """Return whether the lists are valid and cover all rows of the tables `bodies` and `shapes`."""
        return not self.stale and self.known == (len(bodies), len(shapes))

    def may_move(self, bodies: np.ndarray, before: np.ndarray) -> np.ndarray:
        """Return the body rows whose pose may have changed since an earlier time.

        before: value of `self.bodies` at that time, which is at most one step ago. The result may contain bodies that
        have not moved.
        """
        dirty = rows_of(bodies, np.array(self.dirty, np.int64))
        rows = np.concatenate([before, self.bodies, self.dynamic, self.kinematic, dirty[dirty >= 0]])
        return distinct(rows, len(bodies))

    def shapes_of(self, rows: np.ndarray) -> np.ndarray:
        """Return the row numbers of the shapes of bodies, ascending. rows: distinct row numbers in BODY."""
        gathered = np.empty(len(self.order), np.int64)
        return np.sort(gathered[: gather_shapes(rows, self.order, self.starts, gathered)])

    def include(self, tables: WorldTables, rows: np.ndarray) -> None:
        """Add body rows to the lists and mark them as active. The broad phase searches their pairs again.

        May be called during a step. tables: a World or StepState.
        """
        self.take_in(tables)
        self.bodies = distinct(np.concatenate([self.bodies, rows]), len(tables.bodies))
        new = rows[tables.bodies["kind"][rows] == DYNAMIC]
        if len(new):
            self.dynamic = distinct(np.concatenate([self.dynamic, new]), len(tables.bodies))
        self._set_active(tables, rows, True)
        self.shapes = self.shapes_of(self.bodies)

    def exclude(self, tables: WorldTables, rows: np.ndarray) -> None:
        """Remove body rows from the lists of awake rows. Steps do not visit these bodies until they are included."""
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
    reads=("bodies", "shapes", "characters", "awake", "sleeping_set", "pairs", "touching_pairs", "sensing_pairs"),
    writes=("awake", "sleeping_set", "pairs", "touching_pairs", "sensing_pairs", "bodies.active", "bodies.dirty"),
)
def list_awake(state: StepState) -> None:
    """Update the lists of awake rows: add bodies that have begun to move, and remove bodies that have stopped.

    The sleeping set stores the touching pairs of bodies that are not in the lists. The touching pairs of added bodies
    are therefore moved out of the sleeping set, and those of removed bodies into it.
    """
    awake, bodies = state.awake, state.bodies
    awake.take_in(state)
    moving = awake.kinematic
    if len(moving):
        moving = np.empty(len(moving), np.int64)
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
    more = sum(map(len, wanted)) > len(awake.dynamic)
    rows = distinct(np.concatenate(wanted), len(bodies)) if more else awake.dynamic
    if rows is awake.bodies:
        return
    if len(rows) == len(awake.bodies) and np.array_equal(rows, awake.bodies):
        awake.bodies = rows  # the next step compares no numbers
        return
    flags = bodies["active"]
    begun = rows[~flags[rows]]
    ended = without(awake.bodies, rows, len(bodies))
    if len(begun):
        awake.include(state, begun)
        state.sleeping_set.return_reported(state, bodies["id"][begun])
    if len(ended):
        awake.exclude(state, ended)
        state.sleeping_set.keep_reported(state)


# ---- free motion -----------------------------------------------------------------------------------------------------
# Free motion: how far a body would move in a minute if no friction held it.
#
# A body that friction holds may sleep when it is slow. Other bodies keep moving: nothing stops a slow drift in space, a
# fall under low gravity, or a slide on ice. Such a body may sleep only if its free motion is below the slop.
#
# Bodies linked by friction or joints move together, as a group. A group with friction on a resting body is anchored.
# The other groups move freely, except into surfaces that they press on without friction. Their acceleration is
# projected onto the directions that these surfaces allow. In the plane, only the surface with the greatest acceleration
# into it can remain in contact. Any other surface on the way along that surface blocks the group.

LOOSE, PIVOT, RAIL, HELD, STOP = 0, 1, 2, 3, 4  # how a joint to a resting body holds a group
SWING = 0.2  # factor on the sideways distance of a pendulum from its rest: it may sleep within five slops
FREE_TIME = 60.0  # [s] time in which the free motion of a sleeping body would be below the slop


class Groups(NamedTuple):
    """Groups of bodies that friction or joints link: one array per property, indexed by BODY row.

    Each group is a tree of rows. The properties of a group are stored at its root row.
    """

    parents: np.ndarray  # int32 union-find, see join_trees
    anchored: np.ndarray  # bool friction or joints hold the group on a resting body
    blocked: np.ndarray  # bool the surfaces that the group presses on leave no direction free
    faces: np.ndarray  # bool, for each body: two loaded points of one contact keep the body from rotating
    masses: np.ndarray
    ax: np.ndarray  # [px/s2] acceleration; times mass while it is summed, at the end only along the surface
    ay: np.ndarray
    press: np.ndarray  # [px/s2] acceleration into the surface that the group presses on most; 0: no surface
    nx: np.ndarray  # normal of that surface, towards the group
    ny: np.ndarray
    pivots: np.ndarray  # int32 number of joints about which the group rotates …
    rails: np.ndarray  # int32 … and number of joints along which it slides
    hold_x: np.ndarray  # [px] the last pivot, or the direction of the last rail
    hold_y: np.ndarray
    center_x: np.ndarray  # [px] centre of mass of the group
    center_y: np.ndarray


class FreeFall(NamedTuple):
    """Constants of free bodies: acceleration, and the distances in FREE_TIME per unit of speed and of acceleration."""

    gravity_x: float  # [px/s2] before the gravity scale of a body
    gravity_y: float
    ax: float  # [px/s2] acceleration by the wind
    ay: float
    velocity_reach: float  # [s] distance per initial speed
    acceleration_reach: float  # [s2] distance per acceleration
    slop: float  # [px]


def new_groups(room: int) -> Groups:
    """Return Groups with room for `room` BODY rows."""
    flags, numbers = [np.zeros(room, np.bool_) for _ in range(3)], [np.zeros(room) for _ in range(6)]
    counts, holds = [np.zeros(room, np.int32) for _ in range(2)], [np.zeros(room) for _ in range(4)]
    return Groups(np.zeros(room, np.int32), *flags, *numbers, *counts, *holds)


def free_fall(
    gravity: tuple[float, float], drag: float, wind: tuple[float, float], damped: bool, slop: float
) -> FreeFall:
    """Return the FreeFall of a world with this gravity, drag and wind.

    gravity [px/s2]; drag [1/s]; wind [px/s]. Pass (0, 0) for a gravity or wind without effect. damped: whether drag
    slows bodies down; slop [px]: tolerance for free motion.
    """
    decay = drag * FREE_TIME if damped else 0.0
    if decay < 1e-4:  # the closed forms would be inaccurate
        first, second = 1.0 - 0.5 * decay, 0.5 - decay / 6.0
    else:
        first = -math.expm1(-decay) / decay
        second = (1.0 - first) / decay
    return FreeFall(*gravity, drag * wind[0], drag * wind[1], first * FREE_TIME, second * FREE_TIME * FREE_TIME, slop)


@inlined
def is_loaded(contact):
    """Return whether a contact had a normal force in the last substep, or a normal impulse in the step."""
    c = contact
    if c.normal_force_1 > 0.0 or c.normal_impulse_1 > 0.0:
        return True
    return c.count == 2 and (c.normal_force_2 > 0.0 or c.normal_impulse_2 > 0.0)


@inlined
def is_free(body):
    """Return whether a BODY row is dynamic, awake and not quarantined."""
    return body.kind == DYNAMIC and body.awake and not body.quarantined


@kernel
def start_groups(rows, bodies, fall, groups_out):
    """Make each body a group of its own, and write the force on the body in free fall: mass times acceleration.

    rows: awake body rows; bodies: BODY table; fall: see FreeFall; groups_out: Groups. O(rows).
    """
    g = groups_out
    for k in range(len(rows)):
        i = rows[k]
        b = bodies[i]
        g.parents[i] = i
        g.anchored[i] = False
        g.blocked[i] = False
        g.faces[i] = False
        g.masses[i] = b.mass
        g.ax[i] = b.mass * (b.gravity_scale * fall.gravity_x + fall.ax)
        g.ay[i] = b.mass * (b.gravity_scale * fall.gravity_y + fall.ay)
        g.press[i] = 0.0
        g.nx[i] = 0.0
        g.ny[i] = 0.0
        g.pivots[i] = 0
        g.rails[i] = 0


@kernel
def join_groups(bodies, contacts, friction, groups_inout):
    """Join free bodies (see is_free) that press on each other with friction into groups. O(contacts).

    A free body that friction holds on another kind of body is marked in Groups.anchored. A body with two loaded points
    in one contact is marked in Groups.faces. friction: 1 if the world applies friction, else 0.
    """
    g = groups_inout
    for i in range(len(contacts)):
        c = contacts[i]
        if c.sensor or not is_loaded(c):
            continue
        a, b = is_free(bodies[c.body_row_a]), is_free(bodies[c.body_row_b])
        if c.count == 2 and min(c.normal_force_1, c.normal_force_2) > 0.0:
            if a:
                g.faces[c.body_row_a] = True
            if b:
                g.faces[c.body_row_b] = True
        if friction == 0 or c.friction <= 0.0:
            continue
        if a and b:
            join_trees(c.body_row_a, c.body_row_b, g.parents)
        elif a:
            g.anchored[c.body_row_a] = True
        elif b:
            g.anchored[c.body_row_b] = True


@kernel
def list_joint_edges(bodies, joints, count, edges_out):
    """Append the joints of awake bodies to edges_out as graph edges. Return the number of all edges. O(joints).

    The edge of a joint links its awake dynamic bodies. A joint keeps its bodies awake if its motor runs, or if it
    connects them to a moving body that is not dynamic. count: number of contact edges, which are already in edges_out.
    """
    found = count
    for i in range(len(joints)):
        j = joints[i]
        if not j.awake:
            continue
        a, b = NO_NODE, NO_NODE
        carried = j.motor_max > 0.0 and j.motor_speed != 0.0
        if j.body_row_a >= 0:
            body = bodies[j.body_row_a]
            a = j.body_row_a if is_free(body) else NO_NODE
            carried = carried or (body.kind != DYNAMIC and is_active(body))
        if j.body_row_b >= 0:
            body = bodies[j.body_row_b]
            b = j.body_row_b if is_free(body) else NO_NODE
            carried = carried or (body.kind != DYNAMIC and is_active(body))
        if a < 0 and b < 0:
            continue
        write_pair(found, JOINT_EDGE, i, a if a >= 0 else b, b if a >= 0 else NO_NODE, edges_out)
        edges_out.keeps_awake[found] = carried
        found += 1
    return found


@subkernel
def hold_of(joint):
    """Return how a joint to a resting body holds the other body: LOOSE, PIVOT, RAIL, HELD or STOP.

    LOOSE: not at all. PIVOT: at a point, as do a taut rope and a rod. RAIL: on a line, as does the axis of a Wheel.
    HELD: completely, as does a rail with a spring, a motor, equal limits or a loaded limit. STOP: a loaded gear or
    ratchet, which holds a body that also has a pivot or a rail.
    """
    j = joint
    if j.hold == TOOTHED or j.hold == GEARED:
        return STOP if j.lower_force != 0.0 or j.upper_force > 0.0 else LOOSE
    driven = j.spring_hertz > 0.0 or j.motor_max > 0.0 or j.lower == j.upper
    driven = driven or j.lower_force > 0.0 or j.upper_force > 0.0
    if j.coordinate == LENGTH:
        if j.spring_hertz > 0.0 or j.motor_max > 0.0:
            return HELD
        return PIVOT if j.lower == j.upper or j.upper_force > 0.0 else LOOSE
    if j.hold == ON_AXIS:
        return HELD if driven and not j.turns_motor else RAIL
    if j.hold == PINNED and j.follows_point:
        return HELD if j.locks_angle or driven or j.point_hertz > 0.0 else PIVOT
    return LOOSE


@subkernel
def hang_on_pulleys(joint, a, b, groups_inout):
    """Write the wheels of a taut pulley rope as pivots of the free bodies that hang on the rope.

    The bodies stay in separate groups, because each swings about its own wheel. keep_coupled_awake detects ropes that
    move over their wheels. joint: JOINT row; a, b: whether each body is free, see is_free; groups_inout: Groups.
    """
    j, g = joint, groups_inout
    if not (j.upper_force > 0.0 or j.lower == j.upper):
        return
    if a:
        g.pivots[j.body_row_a] += 1
        g.hold_x[j.body_row_a], g.hold_y[j.body_row_a] = j.ground_ax, j.ground_ay
    if b:
        g.pivots[j.body_row_b] += 1
        g.hold_x[j.body_row_b], g.hold_y[j.body_row_b] = j.ground_bx, j.ground_by


@kernel
def stop_groups(bodies, joints, groups_inout):
    """Mark bodies as anchored that have a pivot or a rail and are held by a loaded gear or ratchet to a resting body.

    O(joints). bodies: BODY rows; joints: JOINT rows.
    """
    g = groups_inout
    for i in range(len(joints)):
        j = joints[i]
        if not j.awake or hold_of(j) != STOP:
            continue
        a = j.body_row_a >= 0 and is_free(bodies[j.body_row_a])
        b = j.body_row_b >= 0 and is_free(bodies[j.body_row_b])
        if a != b:
            row = j.body_row_a if a else j.body_row_b
            g.anchored[row] = g.anchored[row] or g.pivots[row] + g.rails[row] > 0


@kernel
def join_jointed_groups(bodies, joints, groups_inout):
    """Join free bodies (see is_free) into groups by their joints, and write how joints to resting bodies hold them.

    The position of a pivot, or the direction of a rail, is written to Groups.hold_x, hold_y at the row of the held
    body. O(joints).
    """
    g = groups_inout
    for i in range(len(joints)):
        j = joints[i]
        if not j.awake:
            continue
        a = j.body_row_a >= 0 and is_free(bodies[j.body_row_a])
        b = j.body_row_b >= 0 and is_free(bodies[j.body_row_b])
        if j.hold == SLUNG:
            hang_on_pulleys(j, a, b, g)
            continue
        if a and b:
            join_trees(j.body_row_a, j.body_row_b, g.parents)
            continue
        if not (a or b):
            continue
        row = j.body_row_a if a else j.body_row_b
        hold = hold_of(j)
        if hold == HELD:
            g.anchored[row] = True
        elif hold == PIVOT and j.hold == PINNED and bodies[row].inverse_inertia == 0.0:
            g.anchored[row] = True  # it cannot turn
        elif hold == PIVOT:
            g.pivots[row] += 1
            still = j.body_row_b if a else j.body_row_a
            x, y = (j.local_bx, j.local_by) if a else (j.local_ax, j.local_ay)
            if still >= 0:
                o = bodies[still]
                c, s = rotation_of(o.angle)
                x, y = o.x + c * x - s * y, o.y + s * x + c * y
            g.hold_x[row] = x
            g.hold_y[row] = y
        elif hold == RAIL:
            g.rails[row] += 1
            g.hold_x[row] = j.nx
            g.hold_y[row] = j.ny


@kernel
def hold_groups(rows, bodies, groups_inout):
    """Sum the pivots and rails of each group, and its centre of mass, at its root row. O(rows).

    A group with two pivots, or with a pivot and a rail, can hardly move and is marked as anchored. rows: awake body
    rows. groups_inout: Groups.
    """
    g = groups_inout
    for k in range(len(rows)):
        i = rows[k]
        g.center_x[i] = 0.0
        g.center_y[i] = 0.0
    for k in range(len(rows)):
        i = rows[k]
        root = root_of(i, g.parents)
        share = bodies[i].mass / g.masses[root] if g.masses[root] > 0.0 else 0.0
        g.center_x[root] += share * bodies[i].center_x
        g.center_y[root] += share * bodies[i].center_y
        if root != i and g.pivots[i] + g.rails[i] > 0:
            g.pivots[root] += g.pivots[i]
            g.rails[root] += g.rails[i]
            g.hold_x[root] = g.hold_x[i]
            g.hold_y[root] = g.hold_y[i]
    for k in range(len(rows)):
        i = rows[k]
        if g.parents[i] == i and g.pivots[i] > 0 and g.pivots[i] + g.rails[i] > 1:
            g.anchored[i] = True


@subkernel
def way_of_hung(root, body, groups, fall):
    """Return how far [px] a body may still move if its group hangs on one pivot or slides on rails.

    A pivoted group under an acceleration swings like a pendulum. The result is then SWING times the amplitude, computed
    from the present displacement and speed. It is infinite if the centre of mass is above the pivot. Without
    acceleration, the group is assumed to keep rotating about the pivot. root: root row of the group; body: BODY row;
    groups: see Groups; fall: see FreeFall.
    """
    g = groups
    ax, ay = g.ax[root], g.ay[root]
    spin = abs(body.angular_velocity) * body.extent * fall.velocity_reach
    if g.pivots[root] == 0:
        x, y = g.hold_x[root], g.hold_y[root]
        way = abs(ax * x + ay * y) * fall.acceleration_reach + spin
        return way + abs(body.vx * x + body.vy * y) * fall.velocity_reach
    x, y = g.center_x[root] - g.hold_x[root], g.center_y[root] - g.hold_y[root]
    size, length = norm(ax, ay), norm(x, y)
    if size * fall.acceleration_reach <= fall.slop or length * SWING <= fall.slop:
        return norm(body.vx, body.vy) * fall.velocity_reach + spin
    if x * ax + y * ay < 0.0:
        return math.inf
    # The amplitude, from the displacement and the speed of a pendulum of this length.
    aside = abs(x * ay - y * ax) / size
    return SWING * math.sqrt(aside * aside + (body.vx * body.vx + body.vy * body.vy) * length / size)


@kernel
def sum_groups(rows, bodies, fall, groups_inout):
    """Write the total mass, mean acceleration and anchored flag of each group at its root row. O(rows).

    The mean is weighted by mass. rows: awake body rows. groups_inout: Groups; fall: see FreeFall.
    """
    g = groups_inout
    for k in range(len(rows)):
        i = rows[k]
        root = root_of(i, g.parents)
        g.parents[i] = root
        if root != i:
            g.anchored[root] = g.anchored[root] or g.anchored[i]
            g.masses[root] += g.masses[i]
            g.ax[root] += g.ax[i]
            g.ay[root] += g.ay[i]
    for k in range(len(rows)):
        i = rows[k]
        if g.parents[i] != i:
            continue
        if g.masses[i] > 0.0:
            g.ax[i] /= g.masses[i]
            g.ay[i] /= g.masses[i]
        else:
            g.ax[i] = bodies[i].gravity_scale * fall.gravity_x + fall.ax
            g.ay[i] = bodies[i].gravity_scale * fall.gravity_y + fall.ay


@subkernel
def choose_surface(root, nx, ny, groups_inout):
    """Store a surface for a group if the group accelerates into it more than into the surface stored before.

    The stored surface is the one on which the group presses most. root: root row of the group; nx, ny: normal of the
    surface, towards the group; groups_inout: Groups.
    """
    g = groups_inout
    into = -(g.ax[root] * nx + g.ay[root] * ny)
    if into > g.press[root]:
        g.press[root] = into
        g.nx[root] = nx
        g.ny[root] = ny


@subkernel
def mark_blocked(root, nx, ny, fall, groups_inout):
    """Mark a group as blocked if another surface stops it from sliding along the surface on which it presses.

    The other surface stops the group if sliding would move the group into this surface by more than a slop. root: root
    row of the group; nx, ny: normal of the other surface, towards the group. groups_inout: Groups; fall: see FreeFall.
    """
    g = groups_inout
    into = -(g.ax[root] * nx + g.ay[root] * ny)
    if g.press[root] > 0.0 and into * fall.acceleration_reach > fall.slop:
        g.blocked[root] = True


@kernel
def find_surfaces(rows, bodies, contacts, fall, groups_inout):
    """Find the surface on which each group presses most, and remove the acceleration into this surface.

    Groups that another surface stops are marked, see mark_blocked. rows: awake body rows. O(rows + contacts).
    groups_inout: Groups; fall: see FreeFall.
    """
    g = groups_inout
    for turn in range(2):
        for i in range(len(contacts)):
            c = contacts[i]
            if c.sensor or not (is_loaded(c) or c.separation_1 <= 0.0 or (c.count == 2 and c.separation_2 <= 0.0)):
                continue
            a = g.parents[c.body_row_a] if is_free(bodies[c.body_row_a]) else -1
            b = g.parents[c.body_row_b] if is_free(bodies[c.body_row_b]) else -1
            if a == b:
                continue
            if a >= 0 and turn == 0:
                choose_surface(a, -c.normal_x, -c.normal_y, g)
            elif a >= 0:
                mark_blocked(a, -c.normal_x, -c.normal_y, fall, g)
            if b >= 0 and turn == 0:
                choose_surface(b, c.normal_x, c.normal_y, g)
            elif b >= 0:
                mark_blocked(b, c.normal_x, c.normal_y, fall, g)
        if turn == 1:
            break
        for k in range(len(rows)):
            i = rows[k]
            if g.parents[i] == i:
                g.ax[i] += g.press[i] * g.nx[i]
                g.ay[i] += g.press[i] * g.ny[i]


@kernel
def keep_free_awake(rows, bodies, groups, fall, islands, least_out):
    """Set the least sleep time of an island to 0 if the free motion of one of its bodies exceeds the slop. O(rows).

    Free motion is the distance that a body would move in FREE_TIME if no friction held it. rows: awake body rows;
    islands (bodies,) int32: root row of the island of each body; least_out (bodies,): least sleep time [s] of an
    island, at its root row; groups: see Groups; fall: see FreeFall.
    """
    g = groups
    for k in range(len(rows)):
        i = rows[k]
        b = bodies[i]
        root = g.parents[i]
        if not is_free(b) or g.anchored[root]:
            continue
        if g.pivots[root] + g.rails[root] > 0:
            if way_of_hung(root, b, g, fall) > fall.slop:
                least_out[islands[i]] = 0.0
            continue
        way = 0.0 if g.faces[i] else abs(b.angular_velocity) * b.extent * fall.velocity_reach
        if not g.blocked[root]:
            vx, vy = b.vx, b.vy
            away = vx * g.nx[root] + vy * g.ny[root]
            # A body that is pressed on its surface is thrown off it to this height at most.
            if away * away < 2.0 * g.press[root] * fall.slop:
                vx -= away * g.nx[root]
                vy -= away * g.ny[root]
            way += norm(vx, vy) * fall.velocity_reach
            way += norm(g.ax[root], g.ay[root]) * fall.acceleration_reach
        if way > fall.slop:
            least_out[islands[i]] = 0.0


@kernel
def keep_sprung_awake(bodies, joints, slop, islands, least_out):
    """Set the least sleep time of an island to 0 if one of its bodies still moves on a joint spring. O(joints).

    A body on a spring is slow where it reverses. It may therefore sleep only after it has stayed in place for half a
    period. Its speed must also be so low that the amplitude is at most about a slop [px]. islands, least_out: see
    keep_free_awake.
    """
    for i in range(len(joints)):
        j = joints[i]
        hertz = math.inf
        for part in range(3):
            soft = j.spring_hertz if part == 0 else (j.point_hertz if part == 1 else j.angle_hertz)
            damping = j.spring_damping if part == 0 else (j.point_damping if part == 1 else j.angle_damping)
            # An overdamped spring creeps back at the slower of its two rates.
            soft = soft / (2.0 * damping) if damping > 1.0 else soft
            hertz = soft if soft > 0.0 and soft < hertz else hertz
        if not j.awake or hertz == math.inf:
            continue
        for side in range(2):
            row = j.body_row_a if side == 0 else j.body_row_b
            if row < 0 or not is_free(bodies[row]):
                continue
            b = bodies[row]
            speed = norm(b.vx, b.vy) + abs(b.angular_velocity) * b.extent
            if b.sleep_time < 0.5 / hertz or speed > slop * math.pi * hertz:
                least_out[islands[row]] = 0.0


@kernel
def keep_coupled_awake(bodies, joints, fall, islands, least_out):
    """Set the least sleep time of an island to 0 if its gears or ropes move by more than the slop. O(joints).

    The motion is predicted for FREE_TIME at the present speed. bodies: BODY rows; joints: JOINT rows; fall: see
    FreeFall; islands, least_out: see keep_free_awake.
    """
    for i in range(len(joints)):
        j = joints[i]
        if not j.awake or j.hold < GEARED or j.rate * fall.velocity_reach <= fall.slop:
            continue
        if j.body_row_a >= 0 and is_free(bodies[j.body_row_a]):
            least_out[islands[j.body_row_a]] = 0.0
        if j.body_row_b >= 0 and is_free(bodies[j.body_row_b]):
            least_out[islands[j.body_row_b]] = 0.0


def keep_awake_what_moves_freely(
    rows: np.ndarray,
    bodies: np.ndarray,
    contacts: np.ndarray,
    joints: np.ndarray,
    friction: bool,
    fall: FreeFall,
    groups: Groups,
    islands: np.ndarray,
    least_out: np.ndarray,
) -> None:
    """Keep islands awake that contain a body which would move further than the slop in FREE_TIME, held by no friction.

    rows: awake body rows; friction: whether the world applies friction; groups: scratch Groups with room for all BODY
    rows; islands, least_out: see keep_free_awake; fall: see FreeFall.
    """
    start_groups(rows, bodies, fall, groups)
    join_groups(bodies, contacts, int(friction), groups)
    if len(joints):
        join_jointed_groups(bodies, joints, groups)
        stop_groups(bodies, joints, groups)
    sum_groups(rows, bodies, fall, groups)
    if len(joints):
        hold_groups(rows, bodies, groups)
    find_surfaces(rows, bodies, contacts, fall, groups)
    keep_free_awake(rows, bodies, groups, fall, islands, least_out)
    if len(joints):
        keep_sprung_awake(bodies, joints, fall.slop, islands, least_out)
        keep_coupled_awake(bodies, joints, fall, islands, least_out)
