"""Schur rows: loop closures, limits and motors of joints between bodies of a tree, solved exactly with the tree.

A row is one scalar equation of a joint. joint_trees.py solves only the rows of the tree itself. Three kinds of rows are
not part of the tree: rows of a joint that closes a loop (Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter
8), the limits on the coordinate of a joint, and its motor. They are called Schur rows.

The Schur complement S of the tree describes how these rows respond to impulses, with the tree attached: column i holds
the velocity changes of all rows by a unit impulse along row i. A column costs one solve of the tree, and is computed
when its row first needs an impulse. The equations in S are then solved by factors L D Lᵀ, in O(k³) for k rows with an
impulse.

Impulses of limits and motors are bounded. Block principal pivoting finds which of these impulses are at a bound (Júdice
and Pires, A block principal pivoting algorithm for large-scale strictly monotone linear complementarity problems,
1994).
"""

import math
from typing import NamedTuple

import numpy as np

from physics.jit import inlined, kernel, subkernel
from physics.solver.joint_rows import coordinate_of, has_limits, has_motor, point_inverse_mass, write_line, write_turn
from physics.solver.joint_trees import (
    MOST_ROWS,
    NO_SLOT,
    follow_parent,
    gather_violations,
    has_infinite_mass,
    move_body,
    move_pseudo,
    place_body,
    place_pseudo,
    spread_impulses,
)
from physics.solver.motions import change_velocity
from physics.tables.joint import ANGLE, GEARED, PINNED
from physics.tables.table import in_lines, zeros_in_lines

# A tree has rows beside it up to these numbers: beyond, passes over the joints cost less.
MOST_SCHUR = 96  # rows of a tree
MOST_MOTORS = 16  # motors of a tree, most of which need an impulse at all times
MOST_WORK = 16384  # rows of loops times bodies of a tree: a column of S costs 40 ns for each body
# Parts of a joint. A number below MOST_ROWS is a row of the joint itself, which closes a loop.
LOWER, UPPER, MOTOR = MOST_ROWS, MOST_ROWS + 1, MOST_ROWS + 2
AT_LOW, FREE_ROW, AT_HIGH = -1, 0, 1  # states of a row: its impulse is at a bound, or between its bounds
NO_TREE, ANY_TREE = -2, -1
# Relative pivots up to which a row is redundant; DOUBLED: if several joints connect the same two bodies.
DEPENDENT, DOUBLED = 1e-11, 1e-5
GAP_SHARE = 100.0  # factor on what the gaps of such joints may have added to a pivot; up to it a row is redundant too
LOCAL_CHANGES = 4.0  # see bound_motor
ROUNDING = 1e-12  # relative error of a velocity that counts as rounding
PATIENCE = 3  # rounds of pivoting without progress, after which only one row changes its state in a round
LEAST_ROUNDS = 20  # rounds of pivoting that are allowed in addition to two for each row

# ---- tables ----------------------------------------------------------------------------------------------------------

# A row beside a tree. Its velocity is ax·vxA + ay·vyA + aw·wA + bx·vxB + by·vyB + bw·wB, as that of a JOINT_ROW.
SCHUR_ROW = in_lines(
    [
        ("joint", np.int32),  # index of the joint in JointSet.rows
        ("part", np.int32),  # part of the joint: LOWER, UPPER, MOTOR or the number of its own row
        ("motion_a", np.int32),  # MOTION rows of the bodies …
        ("motion_b", np.int32),
        ("slot_a", np.int32),  # … and their slots in the forest; NO_SLOT for infinite mass
        ("slot_b", np.int32),
        ("state", np.int32),  # AT_LOW, FREE_ROW or AT_HIGH
        ("next_state", np.int32),  # scratch
        ("pair", np.int32),  # slot of one body if the other is its parent in the tree, else NO_SLOT
        ("is_known", np.bool_),  # the column of S has been computed
        ("ax", np.float64),  # Jacobian of body A …
        ("ay", np.float64),
        ("aw", np.float64),
        ("bx", np.float64),  # … and of body B
        ("by", np.float64),
        ("bw", np.float64),
        ("rhs", np.float64),  # wanted velocity, with bias
        ("compliance", np.float64),  # 0: rigid
        ("scale", np.float64),  # pivot without other joints
        ("dependent", np.float64),  # share of it up to which a pivot makes the row redundant, see begin_schur
        ("low", np.float64),  # bounds of `change`
        ("high", np.float64),
        ("impulse", np.float64),  # of a motor: magnitude of its impulse
        ("violation", np.float64),  # wanted velocity minus the velocity with the tree solved
        ("change", np.float64),  # result: change of the impulse
    ]
)

# A tree with rows beside it, or the root slot of any tree while rows are counted. `dependent` belongs to each slot.
SCHUR_TREE = in_lines(
    [
        ("loops", np.int32),  # number of rows of joints that close loops
        ("limits", np.int32),  # number of limits …
        ("motors", np.int32),  # … and motors
        ("anchors", np.int32),  # number of joints to bodies of infinite mass
        ("is_coupled", np.bool_),  # a gear or pulley acts on the tree
        ("is_pushed", np.bool_),  # its bodies move by pseudo-velocities in the present substep …
        ("has_wide_gap", np.bool_),  # … because of a wide gap, see joint_direct.close_gaps
        ("first", np.int32),  # index of its first row …
        ("count", np.int32),  # … and their number
        ("first_slot", np.int32),  # index of its first slot in Schur.slots …
        ("slots", np.int32),  # … and their number
        ("at", np.int64),  # index of its first entry in Schur.matrix
        ("dependent", np.float64),  # of the rows between a body and its parent, see SCHUR_ROW
    ]
)


class Schur(NamedTuple):
    """The Schur rows of a group of islands, which are solved beside the trees, and reusable scratch arrays."""

    rows: np.ndarray  # SCHUR_ROW, tree after tree
    trees: np.ndarray  # SCHUR_TREE, one for each root slot
    slots: np.ndarray  # int32 slots of the trees with rows, ascending in each tree
    matrix: np.ndarray  # float64 columns of S, tree after tree
    factor: np.ndarray  # (MOST_SCHUR²) float64 L and D of the free rows of a tree
    free: np.ndarray  # (MOST_SCHUR) int32 the free rows of a tree
    values: np.ndarray  # (MOST_SCHUR) float64 right-hand sides, then changes of the free rows
    slot_of: np.ndarray  # (motions) int32 slot of each MOTION row, NO_SLOT: not in a tree, or of infinite mass
    tree_of: np.ndarray  # (slots) int32 root slot of each slot
    counts: np.ndarray  # (3) int64 number of rows, number of entries of `matrix`, reached caps, see place_blocks


def new_schur(rows: int, slots: int, motions: int, entries: int) -> Schur:
    """Return an empty Schur with the given capacities.

    rows: number of Schur rows; slots: number of slots of the forest; motions: number of MOTION rows; entries: number of
    entries of the matrices.
    """
    return Schur(
        rows=zeros_in_lines(rows, SCHUR_ROW),
        trees=zeros_in_lines(slots, SCHUR_TREE),
        slots=np.zeros(slots, np.int32),
        matrix=np.zeros(entries),
        factor=np.zeros(MOST_SCHUR * MOST_SCHUR),
        free=np.zeros(MOST_SCHUR, np.int32),
        values=np.zeros(MOST_SCHUR),
        slot_of=np.zeros(motions, np.int32),
        tree_of=np.zeros(slots, np.int32),
        counts=np.zeros(3, np.int64),
    )


# ---- structure -------------------------------------------------------------------------------------------------------


@inlined
def tree_of_body(motion, motions, schur):
    """Return the root slot of the tree of a body: ANY_TREE for infinite mass, NO_TREE for a body outside all trees.

    motion: index of the MOTION row of the body.
    """
    if has_infinite_mass(motions[motion]):
        return ANY_TREE
    slot = schur.slot_of[motion]
    return NO_TREE if slot == NO_SLOT else schur.tree_of[slot]


@inlined
def tree_of_joint(joint, motions, schur):
    """Return the root slot of the tree that contains both bodies of a JOINT row, or a negative number for no tree."""
    a, b = tree_of_body(joint.motion_a, motions, schur), tree_of_body(joint.motion_b, motions, schur)
    if a == ANY_TREE:
        return b
    return a if b == ANY_TREE or a == b else NO_TREE


@inlined
def pair_of_joint(joint, forest, schur):
    """Return the slot of one body of a JOINT row if the other body is its parent in the tree, else NO_SLOT."""
    a, b = schur.slot_of[joint.motion_a], schur.slot_of[joint.motion_b]
    is_child = a >= 0 and b >= 0 and forest.bodies[a].parent == b
    return a if is_child else (b if a >= 0 and b >= 0 and forest.bodies[b].parent == a else NO_SLOT)


@inlined
def number_of_limits(joint):
    """Return how many limits bound the coordinate of a JOINT row, 0 to 2. Equal limits count as none."""
    count = (1 if joint.lower > -math.inf else 0) + (1 if joint.upper < math.inf else 0)
    return count if has_limits(joint) else 0


@kernel
def count_schur(
    # read
    rows,
    motions,
    forest,
    row_counts,
    taken,
    # write
    joints_inout,
    schur_out,
):
    """Count the Schur rows of all trees, and write where the Schur rows of each tree begin. O(MOTION rows + joints).

    Return the number of rows. A tree with a gear or pulley has no rows for limits and motors. JOINT.in_open_tree is set
    for the joints of trees without loops, with at most one joint to a body of infinite mass.

    rows: indices of the JOINT rows of the group; motions: MOTION rows; forest: result of build_forest; row_counts,
    taken: for each joint of `rows` its number of tree rows, and whether it is in the forest. joints_inout: all JOINT
    rows; schur_out: see Schur.
    """
    f, s = forest, schur_out
    for i in range(len(motions)):
        s.slot_of[i] = NO_SLOT
    for slot in range(f.sizes[0]):
        body, t = f.bodies[slot], s.trees[slot]
        s.tree_of[slot] = slot if body.parent < 0 else s.tree_of[body.parent]
        t.loops, t.limits, t.motors, t.count, t.slots, t.anchors = 0, 0, 0, 0, 0, 0
        t.is_coupled, t.dependent = False, DEPENDENT
        s.trees[s.tree_of[slot]].slots += 1
        s.trees[s.tree_of[slot]].anchors += 1 if body.is_fixed else 0
        if not body.is_fixed:
            s.slot_of[body.motion] = slot
    for k in range(len(rows)):
        j = joints_inout[rows[k]]
        tree = tree_of_joint(j, motions, s)
        if j.hold >= GEARED:
            for side in range(2):
                coupled = tree_of_body(j.motion_a if side == 0 else j.motion_b, motions, s)
                if coupled >= 0:
                    s.trees[coupled].is_coupled = True
        elif tree >= 0:
            s.trees[tree].loops += 0 if taken[k] else row_counts[k]
            s.trees[tree].limits += number_of_limits(j)
            s.trees[tree].motors += 1 if has_motor(j) else 0
    for k in range(len(rows)):
        if taken[k]:
            j = joints_inout[rows[k]]
            t = s.trees[tree_of_joint(j, motions, s)]
            j.in_open_tree = t.loops == 0 and t.anchors <= 1 and not t.is_coupled
    return place_blocks(f.sizes[0], s)


@subkernel
def place_blocks(size, schur_inout):
    """Choose the Schur rows of each tree, and write where its rows, slots and matrix begin. Return the number of rows.

    A tree with too many rows of one kind (loops, limits or motors) gets none of that kind. This counts as a reached
    cap. size: number of slots. O(slots).
    """
    s = schur_inout
    total, entries, slots = 0, 0, 0
    for root in range(size):
        t = s.trees[root]
        t.first, t.at, t.first_slot = total, entries, slots
        rows = t.loops + (0 if t.is_coupled else t.limits + t.motors)
        if t.loops > MOST_SCHUR or t.loops * t.slots > MOST_WORK:
            t.loops = 0
        if t.is_coupled or t.motors > MOST_MOTORS or t.loops + t.motors > MOST_SCHUR:
            t.motors = 0
        if t.is_coupled or t.loops + t.motors + t.limits > MOST_SCHUR:
            t.limits = 0
        own = t.loops + t.motors + t.limits
        s.counts[2] += 1 if own < rows else 0
        total += own
        entries += own * own
        slots += t.slots if own > 0 else 0
        t.slots = 0
    s.counts[0], s.counts[1] = total, entries
    return total


@subkernel
def add_part(index, part, joint, pair, schur_inout):
    """Append a Schur row for a joint to the rows of its tree.

    index: index of the joint in JointSet.rows; part: LOWER, UPPER or MOTOR, or the number of the joint's own row if the
    joint closes a loop; joint: JOINT row; pair: see SCHUR_ROW.
    """
    s = schur_inout
    a, b = s.slot_of[joint.motion_a], s.slot_of[joint.motion_b]
    t = s.trees[s.tree_of[a if a >= 0 else b]]
    row = s.rows[t.first + t.count]
    t.count += 1
    row.joint, row.part = index, part
    row.motion_a, row.motion_b = joint.motion_a, joint.motion_b
    row.slot_a, row.slot_b, row.pair = a, b, pair
    row.is_known = False


@kernel
def list_schur(rows, motions, forest, row_counts, taken, joints_inout, schur_inout):
    """Write the Schur rows of all trees, after count_schur. O(slots + joints).

    JOINT.direct, exact_limits and exact_motor are set for joints whose loop rows, limits or motor are among these rows.
    Arguments: see count_schur.
    """
    s = schur_inout
    for slot in range(forest.sizes[0]):
        t = s.trees[s.tree_of[slot]]
        if t.loops + t.limits + t.motors > 0:
            s.slots[t.first_slot + t.slots] = slot
            t.slots += 1
    for k in range(len(rows)):
        j = joints_inout[rows[k]]
        tree = NO_TREE if j.hold >= GEARED else tree_of_joint(j, motions, s)
        if tree < 0:
            continue
        pair = pair_of_joint(j, forest, s)
        if s.trees[tree].loops > 0 and not taken[k]:
            for part in range(row_counts[k]):
                add_part(k, part, j, pair, s)
            j.direct = j.direct or row_counts[k] > 0
            if pair >= 0:
                s.trees[pair].dependent = DOUBLED
        j.exact_limits = s.trees[tree].limits > 0 and has_limits(j)
        j.exact_motor = s.trees[tree].motors > 0 and has_motor(j)
        if j.exact_limits and j.lower > -math.inf:
            add_part(k, LOWER, j, pair, s)
        if j.exact_limits and j.upper < math.inf:
            add_part(k, UPPER, j, pair, s)
        if j.exact_motor:
            add_part(k, MOTOR, j, pair, s)


# ---- rows ------------------------------------------------------------------------------------------------------------


@inlined
def share_of_gap(joint, a, b):
    """Return what a gap of a pin may add to the pivot of a row, over the pivot of the pin. a, b: MOTION rows."""
    k_11, _, k_22 = point_inverse_mass(joint, a, b)
    gap = joint.apart_x * joint.apart_x + joint.apart_y * joint.apart_y
    return gap * (a.inverse_inertia + b.inverse_inertia) / (k_11 + k_22) if k_11 + k_22 > 0.0 else 0.0


@subkernel
def begin_schur(rows, joints, tree_rows, motions, forest, schur_inout):
    """Write the Jacobians of the Schur rows at the present poses. O(rows).

    The columns of the Schur complement are marked as not computed. Joints between the same two bodies may contradict
    one another, such as two pins and a limit of a slider. Without gaps, one of their rows would be redundant. A gap is
    an error of the moment arms, and adds up to gap² / I to the pivot of this row. Such a small pivot would cause a huge
    impulse, so SCHUR_ROW.dependent is raised for such rows.

    rows: see JointSet; joints: all JOINT rows, after place_joint; tree_rows: JOINT_ROW rows of the joints of `rows`;
    motions: MOTION rows; forest: see Forest.
    """
    s = schur_inout
    for k in range(len(rows) if s.counts[0] > 0 else 0):
        j = joints[rows[k]]
        pair = pair_of_joint(j, forest, s) if j.direct and j.hold == PINNED else NO_SLOT
        if pair >= 0 and s.trees[pair].dependent >= DOUBLED:
            share = GAP_SHARE * share_of_gap(j, motions[j.motion_a], motions[j.motion_b])
            s.trees[pair].dependent = max(s.trees[pair].dependent, share)
    for i in range(s.counts[0]):
        r = s.rows[i]
        j = joints[rows[r.joint]]
        r.is_known = False
        r.dependent = s.trees[r.pair].dependent if r.pair >= 0 else DEPENDENT
        r.compliance = 0.0
        if r.part < MOST_ROWS:
            t = tree_rows[MOST_ROWS * r.joint + r.part]
            r.ax, r.ay, r.aw, r.bx, r.by, r.bw = t.ax, t.ay, t.aw, t.bx, t.by, t.bw
            r.compliance = t.compliance
        elif j.coordinate == ANGLE or (r.part == MOTOR and j.turns_motor):
            write_turn(r)
        else:
            write_line(j, j.nx, j.ny, r)
        if r.part == UPPER:
            r.ax, r.ay, r.aw, r.bx, r.by, r.bw = -r.ax, -r.ay, -r.aw, -r.bx, -r.by, -r.bw
        a, b = motions[r.motion_a], motions[r.motion_b]
        r.scale = r.compliance + (r.ax * r.ax + r.ay * r.ay) * a.inverse_mass + r.aw * r.aw * a.inverse_inertia
        r.scale += (r.bx * r.bx + r.by * r.by) * b.inverse_mass + r.bw * r.bw * b.inverse_inertia


@inlined
def limit_target(gap, biased, most, inverse_h):
    """Return the least velocity [px/s or rad/s] at which a coordinate must move away from its limit.

    The result is negative for a gap, which may close within the substep. gap [px or rad]: distance from the limit,
    negative for a violation; biased: True to also remove violations, at a speed of no more than `most`; inverse_h
    [1/s]: inverse of a substep.
    """
    if gap > 0.0:
        return -gap * inverse_h
    return min(-gap * inverse_h, most) if biased else 0.0


@subkernel
def aim_schur(rows, biased, context, joints, tree_rows_inout, schur_inout):
    """Write the target velocities of the Schur rows, and the bounds of the changes of their impulses.

    Impulses of joints that close loops are reset to 0. biased: True to also remove errors of position; context: see
    StepContext; tree_rows_inout: JOINT_ROW rows with their targets; other arguments: see begin_schur. O(rows).
    """
    s = schur_inout
    for i in range(s.counts[0]):
        r = s.rows[i]
        j = joints[rows[r.joint]]
        r.low, r.high = -math.inf, math.inf
        if r.part < MOST_ROWS:
            t = tree_rows_inout[MOST_ROWS * r.joint + r.part]
            t.impulse = 0.0
            r.rhs = t.rhs
        elif r.part == MOTOR:
            most = j.motor_max * context.h
            r.rhs = j.motor_speed
            r.low, r.high = -most - j.motor, most - j.motor
            r.impulse = abs(j.motor)
        else:
            gap = coordinate_of(j) - j.lower if r.part == LOWER else j.upper - coordinate_of(j)
            most = context.push_turn if j.coordinate == ANGLE else context.push_speed
            r.rhs = limit_target(gap, biased, most, context.inverse_h)
            r.low = -j.low if r.part == LOWER else -j.high


@subkernel
def mark_pushed_out(forest, motions, schur_inout):
    """Mark the trees with a body that has a pseudo-velocity. Return whether there are any. O(bodies).

    forest: see Forest; motions: MOTION rows. schur_inout: see Schur; the marks of wide gaps are cleared.
    """
    s = schur_inout
    found = False
    for slot in range(forest.sizes[0]):
        root = s.trees[s.tree_of[slot]]
        if s.tree_of[slot] == slot:
            root.is_pushed, root.has_wide_gap = False, False
        m = motions[forest.bodies[slot].motion]
        if m.pseudo_vx != 0.0 or m.pseudo_vy != 0.0 or m.pseudo_w != 0.0:
            root.is_pushed = True
            found = True
    return found


@subkernel
def aim_schur_gaps(rows, context, joints, motions, tree_rows_inout, schur_inout):
    """Write the target pseudo-velocities of the Schur rows, and the bounds of their impulses. O(rows).

    A limit holds for the sum of velocity and pseudo-velocity. Motors have no impulse. Bodies of infinite mass have no
    pseudo-velocity, so their velocity is added to the targets. Arguments: see aim_schur; motions: MOTION rows.
    """
    s = schur_inout
    for i in range(s.counts[0]):
        r = s.rows[i]
        j = joints[rows[r.joint]]
        a, b = motions[r.motion_a], motions[r.motion_b]
        of_a = r.ax * a.vx + r.ay * a.vy + r.aw * a.angular_velocity
        of_b = r.bx * b.vx + r.by * b.vy + r.bw * b.angular_velocity
        fixed = (of_a if r.slot_a < 0 else 0.0) + (of_b if r.slot_b < 0 else 0.0)
        r.low, r.high = -math.inf, math.inf
        if r.part < MOST_ROWS:
            t = tree_rows_inout[MOST_ROWS * r.joint + r.part]
            t.impulse = 0.0
            r.rhs = t.rhs + fixed
        elif r.part == MOTOR:
            r.rhs, r.low, r.high, r.impulse = 0.0, 0.0, 0.0, 0.0
        else:
            gap = coordinate_of(j) - j.lower if r.part == LOWER else j.upper - coordinate_of(j)
            most = context.push_turn if j.coordinate == ANGLE else context.push_speed
            r.rhs = limit_target(gap, True, most, context.inverse_h) - (of_a + of_b) + fixed
            r.low = 0.0


@inlined
def velocity_along(row, bodies, motions):
    """Return the velocity along a SCHUR_ROW: its Jacobian times the velocities of its bodies.

    bodies: TREE_BODY rows; motions: MOTION rows, used for bodies of infinite mass.
    """
    r = row
    a, b = motions[r.motion_a], motions[r.motion_b]
    ax, ay, aw, bx, by, bw = a.vx, a.vy, a.angular_velocity, b.vx, b.vy, b.angular_velocity
    if r.slot_a >= 0:
        ax, ay, aw = bodies[r.slot_a].vx, bodies[r.slot_a].vy, bodies[r.slot_a].w
    if r.slot_b >= 0:
        bx, by, bw = bodies[r.slot_b].vx, bodies[r.slot_b].vy, bodies[r.slot_b].w
    return r.ax * ax + r.ay * ay + r.aw * aw + r.bx * bx + r.by * by + r.bw * bw


# ---- Schur complement ------------------------------------------------------------------------------------------------


@inlined
def bound_motor(row_inout):
    """Limit how much one solve may change the impulse of a motor. row_inout: SCHUR_ROW, whose bounds are reduced.

    The limit is the present impulse plus LOCAL_CHANGES times the impulse that the joint alone would need. The impulse
    then adapts to a load within a few solves. It stays small in a singular pose of a mechanism, in which the motor's
    speed hardly depends on its impulse.
    """
    r = row_inout
    most = r.impulse + (LOCAL_CHANGES * abs(r.violation) / r.scale if r.scale > 0.0 else 0.0)
    r.low, r.high = max(r.low, -most), min(r.high, most)


@subkernel
def begin_states(tree, bodies, motions, schur_inout):
    """Write the violations of a tree's Schur rows after a solve of the tree alone, and a first guess of their states.

    A row is free if its impulse can reduce its violation, otherwise at a bound. Return whether any row needs a change
    of its impulse. tree: SCHUR_TREE row; bodies: TREE_BODY rows; motions: MOTION rows.
    """
    needed = False
    for i in range(tree.first, tree.first + tree.count):
        r = schur_inout.rows[i]
        r.violation = r.rhs - velocity_along(r, bodies, motions)
        r.state, r.change = FREE_ROW, 0.0
        if r.part == MOTOR:
            bound_motor(r)
        if r.low >= 0.0 and r.violation <= 0.0:
            r.state, r.change = AT_LOW, r.low
        elif r.high <= 0.0 and r.violation >= 0.0:
            r.state, r.change = AT_HIGH, r.high
        needed = needed or r.state == FREE_ROW or r.change != 0.0
    return needed


@inlined
def respond(child, first, rows, parent_inout, violations_out):
    """Update the velocity of a parent by a joint to a child, like gather_violations, but for target velocities of 0.

    Arguments: see gather_violations.
    """
    c, p = child, parent_inout
    for r in range(c.count):
        row = rows[first + r]
        violation = -(row.cx * c.vx + row.cy * c.vy + row.cw * c.w)
        violations_out[first + r] = violation
        violation -= row.px * p.vx + row.py * p.vy + row.pw * p.w
        p.vx += row.kx * violation
        p.vy += row.ky * violation
        p.w += row.kw * violation


@subkernel
def compute_column(index, tree, motions, forest_inout, schur_inout):
    """Compute a column of the Schur complement: velocities of a tree's Schur rows after a unit impulse along one row.

    index: number of this row in the tree; tree: SCHUR_TREE row; motions: MOTION rows. O(slots).
    """
    f, s = forest_inout, schur_inout
    r = s.rows[tree.first + index]
    for k in range(tree.first_slot, tree.first_slot + tree.slots):
        body = f.bodies[s.slots[k]]
        body.vx, body.vy, body.w = 0.0, 0.0, 0.0
    if r.slot_a >= 0:
        a, inverse = f.bodies[r.slot_a], motions[r.motion_a].inverse_mass
        a.vx, a.vy, a.w = inverse * r.ax, inverse * r.ay, a.inverse_inertia * r.aw
    if r.slot_b >= 0:
        b, inverse = f.bodies[r.slot_b], motions[r.motion_b].inverse_mass
        b.vx, b.vy, b.w = b.vx + inverse * r.bx, b.vy + inverse * r.by, b.w + b.inverse_inertia * r.bw
    for k in range(tree.first_slot + tree.slots - 1, tree.first_slot, -1):
        slot = s.slots[k]
        body = f.bodies[slot]
        respond(body, MOST_ROWS * slot, f.rows, f.bodies[body.parent], f.violations)
    for k in range(tree.first_slot + 1, tree.first_slot + tree.slots):
        slot = s.slots[k]
        body = f.bodies[slot]
        follow_parent(f.bodies[body.parent], MOST_ROWS * slot, f.rows, f.violations, body)
    at = tree.at + index * tree.count
    for i in range(tree.count):
        o = s.rows[tree.first + i]
        speed = 0.0
        if o.slot_a >= 0:
            a = f.bodies[o.slot_a]
            speed += o.ax * a.vx + o.ay * a.vy + o.aw * a.w
        if o.slot_b >= 0:
            b = f.bodies[o.slot_b]
            speed += o.bx * b.vx + o.by * b.vy + o.bw * b.w
        s.matrix[at + i] = speed
    s.matrix[at + index] += r.compliance
    r.is_known = True


# ---- pivoting --------------------------------------------------------------------------------------------------------


@subkernel
def list_free(tree, motions, forest_inout, schur_inout):
    """List the free Schur rows of a tree, whose impulses are not at a bound. Return their number.

    Missing columns of the Schur complement are computed. tree: SCHUR_TREE row; motions: MOTION rows.
    """
    s = schur_inout
    found = 0
    for i in range(tree.count):
        r = s.rows[tree.first + i]
        if not r.is_known and (r.state == FREE_ROW or r.change != 0.0):
            compute_column(i, tree, motions, forest_inout, s)
        if r.state == FREE_ROW:
            s.free[found] = i
            found += 1
    return found


@subkernel
def solve_free(count, tree, schur_inout):
    """Solve the equations of a tree's free Schur rows by factors L D Lᵀ, and write the changes of their impulses.

    A row is redundant if its pivot is 0 after the elimination of other rows. Its scale (the pivot without other joints)
    is then used as compliance. count: number of free rows, see list_free; tree: SCHUR_TREE row. O(count³).
    """
    s = schur_inout
    for p in range(count):
        i, line = s.free[p], p * count
        r = s.rows[tree.first + i]
        value, pivot = r.violation, s.matrix[tree.at + i * tree.count + i]
        for k in range(tree.count):
            o = s.rows[tree.first + k]
            if o.state != FREE_ROW and o.change != 0.0:
                value -= s.matrix[tree.at + k * tree.count + i] * o.change
        for q in range(p):
            entry = s.matrix[tree.at + s.free[q] * tree.count + i]
            for e in range(q):
                entry -= s.factor[line + e] * s.factor[q * count + e]
            s.factor[line + q] = entry  # L times D
            value -= entry * s.values[q]
        for q in range(p):
            entry = s.factor[line + q]
            s.factor[line + q] = entry * s.factor[q * count + q]
            pivot -= entry * s.factor[line + q]
        if not pivot > r.dependent * r.scale:
            pivot = (pivot if pivot > 0.0 else 0.0) + r.scale
        s.factor[line + p] = 1.0 / pivot if pivot > 0.0 else 0.0
        s.values[p] = value * s.factor[line + p]
    for p in range(count - 1, -1, -1):
        for q in range(p + 1, count):
            s.values[p] -= s.factor[q * count + p] * s.values[q]
        s.rows[tree.first + s.free[p]].change = s.values[p]


@inlined
def next_state(index, tree, schur):
    """Return the state that a Schur row of a tree should have according to the present impulses.

    A free row whose impulse is beyond a bound gets the state of that bound. A row at a bound becomes free if its
    impulse must leave the bound to reduce its violation. index: number of the row in the tree; tree: SCHUR_TREE row.
    """
    s = schur
    r = s.rows[tree.first + index]
    if r.state == FREE_ROW:
        return AT_LOW if r.change < r.low else (AT_HIGH if r.change > r.high else FREE_ROW)
    left, size = r.violation, abs(r.violation)
    for k in range(tree.count):
        change = s.rows[tree.first + k].change
        if change != 0.0:
            part = s.matrix[tree.at + k * tree.count + index] * change
            left -= part
            size += abs(part)
    if r.state == AT_LOW:
        return FREE_ROW if left > ROUNDING * size else AT_LOW
    return FREE_ROW if left < -ROUNDING * size else AT_HIGH


@subkernel
def change_states(only_last, tree, schur_inout):
    """Correct the states of a tree's Schur rows that differ from next_state. Return how many were wrong. O(count²).

    only_last: True to correct only the last of them; tree: SCHUR_TREE row.
    """
    s = schur_inout
    wrong, last = 0, -1
    for i in range(tree.count):
        r = s.rows[tree.first + i]
        r.next_state = next_state(i, tree, s)
        if r.next_state != r.state:
            wrong += 1
            last = i
    for i in range(tree.count):
        r = s.rows[tree.first + i]
        if r.next_state != r.state and (i == last or not only_last):
            r.state = r.next_state
            r.change = r.low if r.state == AT_LOW else (r.high if r.state == AT_HIGH else 0.0)
    return wrong


@subkernel
def pivot_rows(tree, motions, forest_inout, schur_inout):
    """Find the impulse changes of a tree's Schur rows by block principal pivoting. Return 1 for a failure, else 0.

    All rows in a wrong state change their states at once, as long as the number of such rows decreases. Otherwise only
    the last of them changes, which always terminates (Murty, 1974). The search fails if its rounds do not suffice.
    tree: SCHUR_TREE row, after begin_states; motions: MOTION rows.
    """
    s = schur_inout
    fewest, patience, wrong = tree.count + 1, PATIENCE, 1
    for _ in range(LEAST_ROUNDS + 2 * tree.count):
        count = list_free(tree, motions, forest_inout, s)
        solve_free(count, tree, s)
        wrong = change_states(patience == 0, tree, s)
        if wrong == 0:
            break
        if wrong < fewest:
            fewest, patience = wrong, PATIENCE
        elif patience > 0:
            patience -= 1
    for i in range(tree.first, tree.first + tree.count):
        r = s.rows[i]
        r.change = min(max(r.change, r.low), r.high)
    return 1 if wrong > 0 else 0


# ---- solve -----------------------------------------------------------------------------------------------------------


@subkernel
def push_row(pseudo, row, a_inout, b_inout):
    """Apply the change of the impulse of a SCHUR_ROW to its bodies. a_inout, b_inout: MOTION rows.

    pseudo: whether it changes pseudo-velocities instead of velocities.
    """
    r, a, b = row, a_inout, b_inout
    x = r.change
    if pseudo:
        a.pseudo_vx += a.inverse_mass * r.ax * x
        a.pseudo_vy += a.inverse_mass * r.ay * x
        a.pseudo_w += a.inverse_inertia * r.aw * x
        b.pseudo_vx += b.inverse_mass * r.bx * x
        b.pseudo_vy += b.inverse_mass * r.by * x
        b.pseudo_w += b.inverse_inertia * r.bw * x
        return
    change_velocity(a.inverse_mass * r.ax * x, a.inverse_mass * r.ay * x, a.inverse_inertia * r.aw * x, a)
    change_velocity(b.inverse_mass * r.bx * x, b.inverse_mass * r.by * x, b.inverse_inertia * r.bw * x, b)


@subkernel
def push_rows(pseudo, rows, tree, schur, joints_inout, tree_rows_inout, motions_inout):
    """Apply the impulse changes of a tree's Schur rows to the bodies, and add them to the impulses of the joints.

    pseudo: whether they change pseudo-velocities, and are not added; tree: SCHUR_TREE row; other arguments: see
    solve_schur.
    """
    for i in range(tree.first, tree.first + tree.count):
        r = schur.rows[i]
        if r.change == 0.0:
            continue
        j = joints_inout[rows[r.joint]]
        push_row(pseudo, r, motions_inout[r.motion_a], motions_inout[r.motion_b])
        if pseudo:
            continue
        if r.part < MOST_ROWS:
            tree_rows_inout[MOST_ROWS * r.joint + r.part].impulse = r.change
        elif r.part == LOWER:
            j.low += r.change
        elif r.part == UPPER:
            j.high += r.change
        else:
            j.motor += r.change


@subkernel
def solve_tree_again(pseudo, tree, slots, forest_inout, tree_rows_inout, motions_inout):
    """Solve a tree a second time, and add the impulses to those of the first solve. O(slots of the tree).

    pseudo: whether to solve for pseudo-velocities; tree: SCHUR_TREE row; slots: see Schur; tree_rows_inout: JOINT_ROW
    rows with the impulses of the first solve. In rows with compliance these impulses change the target velocity.
    """
    f, last = forest_inout, tree.first_slot + tree.slots - 1
    for k in range(tree.first_slot, last + 1):
        body = f.bodies[slots[k]]
        if pseudo:
            place_pseudo(motions_inout[body.motion], body)
        else:
            place_body(motions_inout[body.motion], body)
        for r in range(body.count if body.parent >= 0 else 0):
            t = tree_rows_inout[MOST_ROWS * body.joint + r]
            t.rhs -= t.compliance * t.impulse
            t.earlier = t.impulse
    for k in range(last, tree.first_slot, -1):
        body = f.bodies[slots[k]]
        first = MOST_ROWS * slots[k]
        gather_violations(body, first, f.rows, tree_rows_inout, f.bodies[body.parent], f.violations)
    for k in range(tree.first_slot, last + 1):
        body = f.bodies[slots[k]]
        if body.parent >= 0:
            first = MOST_ROWS * slots[k]
            follow_parent(f.bodies[body.parent], first, f.rows, f.violations, body)
            spread_impulses(first, f.rows, tree_rows_inout, f.bodies[body.parent], body)
            for r in range(body.count):
                t = tree_rows_inout[MOST_ROWS * body.joint + r]
                t.impulse += t.earlier
        if body.is_fixed:
            continue
        if pseudo:
            move_pseudo(body, motions_inout[body.motion])
        else:
            move_body(body, motions_inout[body.motion])


@subkernel
def solve_schur(pseudo, rows, forest_inout, schur_inout, joints_inout, tree_rows_inout, motions_inout):
    """Solve the Schur rows together with their trees, after a solve of the trees alone.

    pseudo: whether to solve for pseudo-velocities of pushed trees, after aim_schur_gaps; the impulses of joints stay;
    rows: indices of the JOINT rows of the group; forest_inout: after solve_trees; schur_inout: after aim_schur;
    joints_inout: all JOINT rows, of which the impulses of limits and motors change; tree_rows_inout: JOINT_ROW rows of
    the joints of `rows`; motions_inout: MOTION rows.
    """
    f, s = forest_inout, schur_inout
    for root in range(f.sizes[0]):
        tree = s.trees[root]
        if tree.count == 0 or (pseudo and not tree.is_pushed) or not begin_states(tree, f.bodies, motions_inout, s):
            continue
        s.counts[2] += pivot_rows(tree, motions_inout, f, s)
        push_rows(pseudo, rows, tree, s, joints_inout, tree_rows_inout, motions_inout)
        solve_tree_again(pseudo, tree, s.slots, f, tree_rows_inout, motions_inout)
