"""The awake rows of a world, which the passes of a step process.

Without sleeping these are all rows. With sleeping they are the awake dynamic bodies, moving kinematic bodies,
characters, and for one step added or edited bodies. Sleeping bodies and bodies at rest cost nothing. The lists are
updated as bodies wake and fall asleep, not searched for.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.islands.graph import JOINT_EDGE, NO_NODE, write_pair
from physics.jit import inlined, kernel, subkernel
from physics.math2d import norm, rotation_of
from physics.tables.body import DYNAMIC, KINEMATIC
from physics.tables.joint import LENGTH, ON_AXIS, PINNED
from physics.tables.step_state import StepState, WorldTables, stage
from physics.tables.table import join_trees, root_of, rows_of

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
    reads=("bodies", "shapes", "characters", "awake", "sleeping_set", "pairs", "touching_pairs", "sensing_pairs"),
    writes=("awake", "sleeping_set", "pairs", "touching_pairs", "sensing_pairs", "bodies.active", "bodies.dirty"),
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


# ---- free motion -----------------------------------------------------------------------------------------------------
# Free motion: how far a body would move in a minute if no friction held it.
#
# A body that friction holds may sleep where it is slow. Any other body goes on: nothing stops a slow drift in space, a
# fall under a low gravity, or a slide on ice. Such a body may sleep only if its free motion stays under the slop.
#
# Bodies that friction links move as one, a group. A group with friction on a body that stands still is anchored. The
# others move freely, but for the surfaces that they press on without friction: the projection of their acceleration
# onto the directions that these surfaces leave open. In the plane, only the surface that the acceleration presses most
# can remain a face of this projection; any other surface that it meets along that face blocks it.

LOOSE, PIVOT, RAIL, HELD = 0, 1, 2, 3  # how a joint to a body that stands still holds a group
SWING = 0.2  # a pendulum may sleep within five slops of its lowest point
FREE_TIME = 60.0  # [s] for which the motion of a sleeping body would have stayed under the slop


class Groups(NamedTuple):
    """The groups of bodies that friction links: arrays by row of BODY, whose values count at the root of each group."""

    parents: np.ndarray  # int32, see join_trees
    anchored: np.ndarray  # bool friction holds it on a body that stands still
    blocked: np.ndarray  # bool the surfaces that it presses on leave it no way
    faces: np.ndarray  # bool of each body: two loaded points of one contact keep it from rotating
    masses: np.ndarray
    ax: np.ndarray  # [px/s2] acceleration, times mass while it is summed; then along the surface
    ay: np.ndarray
    press: np.ndarray  # [px/s2] acceleration into the surface that it presses on most; 0: on none
    nx: np.ndarray  # normal of that surface, towards the group
    ny: np.ndarray
    pivots: np.ndarray  # int32 number of joints about which it turns …
    rails: np.ndarray  # int32 … and of joints along which it slides
    hold_x: np.ndarray  # [px] the last pivot, or the direction of the last rail
    hold_y: np.ndarray
    center_x: np.ndarray  # [px] centre of mass of the group
    center_y: np.ndarray


class FreeFall(NamedTuple):
    """The acceleration of free bodies, and how far motion reaches in FREE_TIME."""

    gravity_x: float  # [px/s2] times gravity_scale
    gravity_y: float
    ax: float  # [px/s2] of the wind
    ay: float
    velocity_reach: float  # [s] distance per initial speed
    acceleration_reach: float  # [s2] distance per acceleration
    slop: float  # [px]


def new_groups(room: int) -> Groups:
    """Return room for that many bodies."""
    flags, numbers = [np.zeros(room, np.bool_) for _ in range(3)], [np.zeros(room) for _ in range(6)]
    counts, holds = [np.zeros(room, np.int32) for _ in range(2)], [np.zeros(room) for _ in range(4)]
    return Groups(np.zeros(room, np.int32), *flags, *numbers, *counts, *holds)


def free_fall(
    gravity: tuple[float, float], drag: float, wind: tuple[float, float], damped: bool, slop: float
) -> FreeFall:
    """Return the FreeFall of a world.

    gravity [px/s2], wind [px/s]: (0, 0) where undeclared. drag [1/s]. damped: whether drag slows bodies down.
    """
    decay = drag * FREE_TIME if damped else 0.0
    if decay < 1e-4:  # where the closed forms would lose their digits
        first, second = 1.0 - 0.5 * decay, 0.5 - decay / 6.0
    else:
        first = -math.expm1(-decay) / decay
        second = (1.0 - first) / decay
    return FreeFall(*gravity, drag * wind[0], drag * wind[1], first * FREE_TIME, second * FREE_TIME * FREE_TIME, slop)


@inlined
def is_loaded(contact):
    """Return whether a contact bore a force in the last substep, or an impulse in the step."""
    c = contact
    if c.normal_force_1 > 0.0 or c.normal_impulse_1 > 0.0:
        return True
    return c.count == 2 and (c.normal_force_2 > 0.0 or c.normal_impulse_2 > 0.0)


@inlined
def is_free(body):
    """Return whether a body moves by forces: dynamic, awake and finite."""
    return body.kind == DYNAMIC and body.awake and not body.quarantined


@kernel
def start_groups(rows, bodies, fall, groups_out):
    """Make each body a group of its own, with the acceleration of its free fall times its mass. O(rows).

    fall: see FreeFall; groups_out: see Groups.
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
    """Join the bodies of loaded contacts with friction, and mark the bodies that they hold on what stands still.

    friction 1: the effect is declared. O(contacts).
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
    """List the joints that link bodies, or that keep one awake, after `count` edges of contacts. Return the number.

    Joints link awake dynamic bodies. A body that is joined to a moving kinematic one stays awake, and so does one with
    a motor that runs. O(joints).
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
    """Return how a joint to a body that stands still holds the other body: LOOSE, PIVOT, RAIL or HELD.

    A taut rope or a rod is a pivot. A rail with a spring, a motor at rest or a limit that bears a load holds its body.
    """
    j = joint
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


@kernel
def join_jointed_groups(bodies, joints, groups_inout):
    """Join the bodies of joints, and write how joints to bodies that stand still hold their groups. O(joints).

    Of pivots and rails the place, or the direction, is written to the row of the body that hangs on them.
    """
    g = groups_inout
    for i in range(len(joints)):
        j = joints[i]
        if not j.awake:
            continue
        a = j.body_row_a >= 0 and is_free(bodies[j.body_row_a])
        b = j.body_row_b >= 0 and is_free(bodies[j.body_row_b])
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
    """Sum pivots, rails, and centres of mass of groups at their roots. O(rows).

    A group with two pivots, or with a pivot and a rail, cannot go far, and counts as anchored.
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
    """Return how far [px] a body of a group may still move that hangs on one pivot, or slides on rails.

    Under an acceleration a group swings to below its pivot: by the distance of its centre of mass from there. Without
    one it turns on about the pivot.
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
    """Write the mean acceleration of each group, weighted by mass, and whether it is anchored, to its root. O(rows)."""
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
    """Take the surface with a normal towards a group as its own if the group presses on it more than on the others."""
    g = groups_inout
    into = -(g.ax[root] * nx + g.ay[root] * ny)
    if into > g.press[root]:
        g.press[root] = into
        g.nx[root] = nx
        g.ny[root] = ny


@subkernel
def mark_blocked(root, nx, ny, fall, groups_inout):
    """Mark a group as blocked if its motion along its surface would enter another surface by more than the slop."""
    g = groups_inout
    into = -(g.ax[root] * nx + g.ay[root] * ny)
    if g.press[root] > 0.0 and into * fall.acceleration_reach > fall.slop:
        g.blocked[root] = True


@kernel
def find_surfaces(rows, bodies, contacts, fall, groups_inout):
    """Turn the acceleration of each group along the surface that it presses on most, and find the blocked groups.

    O(rows + contacts).
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
    """Write a sleep time of 0 for the islands of bodies whose free motion exceeds the slop. O(rows).

    islands (bodies) int32: the root of each body's island; least_out (bodies): its least sleep time [s].
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
            # Pressed on its surface, a body leaves it by no more than the height of this throw.
            if away * away < 2.0 * g.press[root] * fall.slop:
                vx -= away * g.nx[root]
                vy -= away * g.ny[root]
            way += norm(vx, vy) * fall.velocity_reach
            way += norm(g.ax[root], g.ay[root]) * fall.acceleration_reach
        if way > fall.slop:
            least_out[islands[i]] = 0.0


@kernel
def keep_sprung_awake(bodies, joints, slop, islands, least_out):
    """Write a sleep time of 0 for the islands of bodies on springs that still move. O(joints).

    A body on a spring may turn back slowly: it sleeps once it has stayed in place for half a period, and if it would
    come to rest within a slop [px]. islands, least_out: see keep_free_awake.
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
    """Keep awake the islands of bodies that no friction holds and whose free motion exceeds the slop.

    rows: the awake bodies; groups: room for all bodies; islands, least_out: see keep_free_awake.
    """
    start_groups(rows, bodies, fall, groups)
    join_groups(bodies, contacts, int(friction), groups)
    if len(joints):
        join_jointed_groups(bodies, joints, groups)
    sum_groups(rows, bodies, fall, groups)
    if len(joints):
        hold_groups(rows, bodies, groups)
    find_surfaces(rows, bodies, contacts, fall, groups)
    keep_free_awake(rows, bodies, groups, fall, islands, least_out)
    if len(joints):
        keep_sprung_awake(bodies, joints, fall.slop, islands, least_out)
