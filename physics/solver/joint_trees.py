"""Direct solver for trees of joints: exact impulses in linear time, for any ratio of masses.

Bodies of finite mass and the joints between them form a graph. Joints that close a loop are solved iteratively
elsewhere; the other joints form a forest. Bodies of infinite mass cut the graph, so a bridge between two walls is a
tree. A tree is eliminated from its leaves to its root, and then solved from the root to its leaves (Baraff, Linear-Time
Dynamics using Lagrange Multipliers, SIGGRAPH 1996; Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 7).

The elimination computes articulated inverse inertias. The 3×3 matrix W of a body is the response of its velocity to an
impulse, with its subtree attached. The elimination is a Kalman filter: a joint to a child acts like a measurement of
the parent's velocity. The covariance of this measurement is S = Γ + Jc Wc Jcᵀ. Wc is the inverse inertia of the child,
Γ holds the compliances of the joint's rows, and Jc is their Jacobian for the child. The case S = 0, a rigid joint to a
body of infinite mass, needs no special treatment, because S is never inverted.

W is stored as U D Uᵀ, with U unit upper triangular and D diagonal. S is diagonalised row by row without being formed.
This loses no digits if a light body carries a heavy body (Bierman, Factorization Methods for Discrete Sequential
Estimation, 1977, chapters 5 and 6). Impulses follow from the innovations of the filter (the smoother of Bryson and
Frazier, 1963). The velocity of a child follows from the velocity of its parent.
"""

from typing import NamedTuple

import numpy as np

from physics.jit import inlined, kernel, subkernel
from physics.math2d import norm, rotation_of
from physics.tables.table import in_lines, join_trees, root_of, zeros_in_lines

MOST_ROWS = 3  # rows of a joint: row r of joint j is JOINT_ROW 3 j + r
NO_SLOT = -1  # value for no slot, joint or half-edge
# Thresholds of a pivot, relative to the pivot without other joints. The pivot decreases with the mass that hangs on a
# joint: to 1e-12 for 1e6 times the mass of a link at the end of 200 welded links. Rounding errors give a redundant row
# a relative pivot of 1e-28.
SINGULAR = 1e-16  # up to this value a row is redundant
IMMOVABLE = 1e-20  # up to this value of the child's part, the child does not respond to the row
NEGLIGIBLE = 1e-30  # up to this value a part of a pivot is a rounding error
AT_REST = 1e-250  # slower velocities count as 0: the rounding errors of bodies at rest become denormal, and slow

# ---- tables ----------------------------------------------------------------------------------------------------------

# A scalar row of a joint. After the solve, with the velocities (vx, vy, w) of A and of B:
# ax·vxA + ay·vyA + aw·wA + bx·vxB + by·vyB + bw·wB + compliance · impulse = rhs.
# The impulse changes the velocity of A by impulse · (ax, ay, aw) times its inverse mass and inertia, likewise of B.
JOINT_ROW = np.dtype(
    [
        ("ax", np.float64),  # Jacobian of body A …
        ("ay", np.float64),
        ("aw", np.float64),  # [px] for a row of a speed along a line
        ("bx", np.float64),  # … and of body B
        ("by", np.float64),
        ("bw", np.float64),
        ("rhs", np.float64),  # wanted relative velocity, with bias
        ("compliance", np.float64),  # 0: rigid
        ("impulse", np.float64),  # result: the impulse of the last solve
        ("earlier", np.float64),  # scratch of joint_schur.solve_tree_again
    ],
    align=True,
)

# A body of a tree. Rows (slots) are in breadth-first order, parents before their children. Each joint to a body of
# infinite mass has a separate row for that body.
TREE_BODY = in_lines(
    [
        ("motion", np.int32),  # MOTION row of the body
        ("parent", np.int32),  # slot of the parent, NO_SLOT for the root of a tree
        ("joint", np.int32),  # joint to the parent
        ("count", np.int32),  # number of rows of the joint to the parent
        ("parent_is_a", np.bool_),
        ("is_fixed", np.bool_),  # infinite mass
        ("inverse_inertia", np.float64),  # with the added inertia
        ("d_x", np.float64),  # D of the articulated inverse inertia U D Uᵀ …
        ("d_y", np.float64),
        ("d_w", np.float64),
        ("u_xy", np.float64),  # … and U
        ("u_xw", np.float64),
        ("u_yw", np.float64),
        ("vx", np.float64),  # velocity with the impulses of the subtree; after the solve with all impulses
        ("vy", np.float64),
        ("w", np.float64),
        ("fx", np.float64),  # impulse on the body by the joint to its parent, then also by solved joints to children
        ("fy", np.float64),
        ("fw", np.float64),
    ]
)

# A factored row of a joint: a linear combination of the joint's rows, uncorrelated with its other factored rows in the
# response of the child.
TREE_ROW = in_lines(
    [
        ("px", np.float64),  # Jacobian of the parent
        ("py", np.float64),
        ("pw", np.float64),
        ("cx", np.float64),  # Jacobian of the child
        ("cy", np.float64),
        ("cw", np.float64),
        ("gx", np.float64),  # gain of the child: its change of velocity per violation at the parent's final velocity
        ("gy", np.float64),
        ("gw", np.float64),
        ("kx", np.float64),  # gain of the parent: its change of velocity per violation, without impulses from outside
        ("ky", np.float64),
        ("kw", np.float64),
        ("inverse_pivot", np.float64),  # impulse per violation of the row
        ("of_first", np.float64),  # multiples of the first and second row in the row of the joint
        ("of_second", np.float64),
        ("source", np.int64),  # 0..2: the row of the joint
    ]
)


class Forest(NamedTuple):
    """The trees of joints with their bodies and factors, and scratch arrays for building them. The arrays are reused.

    (joints) and (motions) in the fields below are capacities for joints and MOTION rows. A half-edge is one side of a
    joint: 2 · joint for body A, 2 · joint + 1 for body B.
    """

    bodies: np.ndarray  # (2 joints) TREE_BODY in slots: roots first, parents before their children
    rows: np.ndarray  # (2 MOST_ROWS joints) TREE_ROW: rows of the joint to the parent of each slot
    violations: np.ndarray  # (2 MOST_ROWS joints) violation of each TREE_ROW if its parent is at rest
    sizes: np.ndarray  # (1) int64 number of slots in use
    parents: np.ndarray  # (motions) int32 union-find over MOTION rows
    heads: np.ndarray  # (motions) int32 first half-edge of each MOTION row, NO_SLOT: none
    nexts: np.ndarray  # (2 joints) int32 next half-edge of the same body, NO_SLOT: none


def new_forest(joints: int, motions: int) -> Forest:
    """Return an empty Forest with capacities for a number of joints and of MOTION rows."""
    return Forest(
        bodies=zeros_in_lines(2 * joints, TREE_BODY),
        rows=zeros_in_lines(2 * MOST_ROWS * joints, TREE_ROW),
        violations=np.zeros(2 * MOST_ROWS * joints),
        sizes=np.zeros(1, np.int64),
        parents=np.zeros(motions, np.int32),
        heads=np.zeros(motions, np.int32),
        nexts=np.zeros(2 * joints, np.int32),
    )


def with_room(forest: Forest, joints: int, motions: int) -> Forest:
    """Return the forest if its capacities suffice, otherwise an empty forest with greater capacities.

    joints, motions: required capacities for joints and MOTION rows. A capacity that is too small is at least doubled.
    """
    has_joints, has_motions = len(forest.nexts) // 2, len(forest.parents)
    if joints <= has_joints and motions <= has_motions:
        return forest
    return new_forest(
        has_joints if joints <= has_joints else max(joints, 2 * has_joints),
        has_motions if motions <= has_motions else max(motions, 2 * has_motions),
    )


# ---- structure -------------------------------------------------------------------------------------------------------


@inlined
def has_infinite_mass(motion):
    """Return whether both the mass and the inertia of a MOTION row are infinite."""
    return not (motion.inverse_mass > 0.0 or motion.inverse_inertia > 0.0)


@subkernel
def take_joints(order, motion_a, motion_b, motions, forest_inout, taken_out):
    """Choose the joints that form the forest, and link the chosen joints of each body into a list. Return their number.

    The elements of these lists are half-edges. A half-edge is one side of a joint, see Forest. Arguments: see
    build_forest.
    """
    f = forest_inout
    for i in range(len(motions)):
        f.parents[i] = i
        f.heads[i] = NO_SLOT
    count = 0
    for k in range(len(order)):
        joint = order[k]
        a, b = motion_a[joint], motion_b[joint]
        fixed_a, fixed_b = has_infinite_mass(motions[a]), has_infinite_mass(motions[b])
        takes = fixed_a != fixed_b
        if not fixed_a and not fixed_b and root_of(a, f.parents) != root_of(b, f.parents):
            join_trees(a, b, f.parents)
            takes = True
        taken_out[joint] = takes
        count += 1 if takes else 0
    for k in range(len(order) - 1, -1, -1):  # backwards: each list is in the order of ids
        joint = order[k]
        if not taken_out[joint]:
            continue
        for side in range(2):
            i = motion_a[joint] if side == 0 else motion_b[joint]
            if not has_infinite_mass(motions[i]):
                f.nexts[2 * joint + side] = f.heads[i]
                f.heads[i] = 2 * joint + side
    return count


@inlined
def write_body(motion, parent, joint, parent_is_a, is_fixed, body_out):
    """Write a TREE_BODY row that links a body to its parent in the tree.

    motion: MOTION row of the body; parent: slot of the parent (index of a TREE_BODY row); joint: joint to the parent;
    parent_is_a: whether the parent is body A of the joint; is_fixed: whether the body has infinite mass.
    """
    body_out.motion = motion
    body_out.parent = parent
    body_out.joint = joint
    body_out.count = 0
    body_out.parent_is_a = parent_is_a
    body_out.is_fixed = is_fixed


@subkernel
def order_bodies(motion_a, motion_b, motions, forest_inout):
    """Write the bodies of all trees as TREE_BODY rows, breadth-first from the roots. O(MOTION rows + joints).

    The written rows also serve as the queue of the search. All roots come first, so that adjacent rows belong to
    different trees, and the processor can work on several joints at the same time. Arguments: see build_forest.
    """
    f = forest_inout
    count = 0
    for root in range(len(motions)):
        if f.heads[root] >= 0 and f.parents[root] == root:
            write_body(root, NO_SLOT, NO_SLOT, False, False, f.bodies[count])
            count += 1
    slot = 0
    while slot < count:
        body = f.bodies[slot]
        half = NO_SLOT if body.is_fixed else f.heads[body.motion]
        while half >= 0:
            joint, parent_is_a = half // 2, half % 2 == 0
            if joint != body.joint:
                other = motion_b[joint] if parent_is_a else motion_a[joint]
                is_fixed = has_infinite_mass(motions[other])
                write_body(other, slot, joint, parent_is_a, is_fixed, f.bodies[count])
                count += 1
            half = f.nexts[half]
        slot += 1
    f.sizes[0] = count


@kernel
def build_forest(
    # read
    order,
    motion_a,
    motion_b,
    motions,
    # write
    forest_inout,
    taken_out,
):
    """Choose the joints of the forest, and order their elimination. Return the number of chosen joints.

    A joint is left out if earlier joints already connect its bodies, or if both bodies have infinite mass. The root of
    a tree is its lowest MOTION row. The result depends only on the order of the joints and on the MOTION rows. O(MOTION
    rows + joints).

    order: int64 joints that may be chosen, in the order of ids; motion_a, motion_b (joints,): int32 MOTION rows of the
    bodies of each joint; motions: all MOTION rows; forest_inout: a Forest with sufficient capacities; taken_out
    (joints,): bool, whether each joint of `order` was chosen.
    """
    count = take_joints(order, motion_a, motion_b, motions, forest_inout, taken_out)
    order_bodies(motion_a, motion_b, motions, forest_inout)
    return count


# ---- factor ----------------------------------------------------------------------------------------------------------
# While a row is factored it is a tuple: Jacobian of the parent (0..2), Jacobian of the child (3..5), Jacobian of the
# child times U of the child (6..8), part of the pivot from child and compliance (9), pivot without other joints, the
# scale (10), compliance (11), subtracted multiple of the first row (12), number of the row in the joint (13). Tuples
# stay in registers: 59 ns per joint instead of 74 ns with rows of a table (a chain of 760 pins).


@inlined
def load_row(joint_row, parent_is_a, parent_mass, child_mass, inertia, number):
    """Return a JOINT_ROW as the tuple in which rows are factored. Its fields: see the comment under "factor".

    parent_is_a: whether the parent is body A of the joint; parent_mass, child_mass: (inverse mass, inverse inertia) of
    each body; inertia: factors (D, U) of the child's inverse inertia; number: index of the row in the joint, 0..2.
    """
    j = joint_row
    px, py, pw = (j.ax, j.ay, j.aw) if parent_is_a else (j.bx, j.by, j.bw)
    cx, cy, cw = (j.bx, j.by, j.bw) if parent_is_a else (j.ax, j.ay, j.aw)
    d_x, d_y, d_w, u_xy, u_xw, u_yw = inertia
    gy, gw = cx * u_xy + cy, cx * u_xw + cy * u_yw + cw
    child = j.compliance + (cx * cx * d_x + gy * gy * d_y + gw * gw * d_w)
    scale = j.compliance + (px * px + py * py) * parent_mass[0] + pw * pw * parent_mass[1]
    scale += (cx * cx + cy * cy) * child_mass[0] + cw * cw * child_mass[1]
    scale = scale if scale > 0.0 else 0.0  # so that accepted pivots are positive, even with invalid masses
    return px, py, pw, cx, cy, cw, cx, gy, gw, child, scale, j.compliance, 0.0, number


@inlined
def moves_more(row, other):
    """Return whether a joint's child responds relatively more to `row` than to `other`, two tuples of load_row.

    The child's contributions to the pivots of both rows are compared. Each is divided by the pivot that its row has
    without other joints.
    """
    return row[9] * other[10] > other[9] * row[10]


@inlined
def independent(row, lead, inertia, common, is_second):
    """Make `row` uncorrelated with an earlier row `lead` of the joint. Return (new row, subtracted multiple of `lead`).

    Two rows are correlated if an impulse along one of them changes the velocity of the child along the other. Nothing
    is subtracted if the child does not respond to `lead`.

    row, lead: tuples of load_row; inertia: factors (D, U) of the child's inverse inertia; common: compliance of the
    first row in the order of elimination. is_second: True if `lead` is the second row in this order. Then `row` and
    `lead` may both contain a multiple of the first row, and so share its compliance.
    """
    d_x, d_y, d_w, _, _, _ = inertia
    px, py, pw, cx, cy, cw, gx, gy, gw, child, scale, compliance, of_first, number = row
    lx, ly, lw = lead[6], lead[7], lead[8]
    factor = 0.0
    if lead[9] > IMMOVABLE * lead[10]:
        factor = (gx * d_x * lx + gy * d_y * ly + gw * d_w * lw + common * of_first * lead[12]) / lead[9]
        px, py, pw = px - factor * lead[0], py - factor * lead[1], pw - factor * lead[2]
        cx, cy, cw = cx - factor * lead[3], cy - factor * lead[4], cw - factor * lead[5]
        gx, gy, gw = gx - factor * lx, gy - factor * ly, gw - factor * lw
        rest = factor
        if is_second:
            rest = of_first - factor * lead[12]
        else:
            of_first = factor
        child = compliance + (gx * gx * d_x + gy * gy * d_y + gw * gw * d_w) + common * rest * rest
        if is_second:
            child += lead[11] * factor * factor
    return (px, py, pw, cx, cy, cw, gx, gy, gw, child, scale, compliance, of_first, number), factor


@inlined
def apply_row(row, inertia):
    """Update the articulated inverse inertia of the parent by one row of a joint (Bierman's update).

    Return a tuple of six values. 1, 2: new factors D and U of the parent. 3: gain of the parent. 4: inverse pivot. 5:
    inverse of the child's part of the pivot. 6: 1 if the row is redundant, else 0. A redundant row gets its scale (the
    pivot without other joints) as compliance. row: tuple of load_row; inertia: factors (D, U) of the parent's inverse
    inertia.
    """
    d_x, d_y, d_w, u_xy, u_xw, u_yw = inertia
    x, y, w = row[0], row[0] * u_xy + row[1], row[0] * u_xw + row[1] * u_yw + row[2]
    scale = row[10]
    child = row[9] if row[9] > IMMOVABLE * scale else 0.0
    kx, ky, kw = d_x * x, d_y * y, d_w * w
    x_sum = child + kx * x
    y_sum = x_sum + ky * y
    w_sum = y_sum + kw * w
    singular = 0
    if not w_sum > SINGULAR * scale:
        singular = 1
        child, x_sum, y_sum, w_sum = child + scale, x_sum + scale, y_sum + scale, w_sum + scale
    xy, xw, yw = u_xy, u_xw, u_yw
    if x_sum > NEGLIGIBLE * scale:
        inverse = 1.0 / x_sum
        d_x *= child * inverse
        u_xy = xy - y * inverse * kx
    kx += xy * ky
    if y_sum > NEGLIGIBLE * scale:
        inverse = 1.0 / y_sum
        d_y *= x_sum * inverse
        u_xw, u_yw = xw - w * inverse * kx, yw - w * inverse * ky
    kx, ky = kx + xw * kw, ky + yw * kw
    inverse = 0.0
    if w_sum > 0.0:
        inverse = 1.0 / w_sum
        d_w *= y_sum * inverse
    inverse_child = 1.0 / child if child > 0.0 else 0.0
    gain = kx * inverse, ky * inverse, kw * inverse
    return (d_x, d_y, d_w, u_xy, u_xw, u_yw), gain, inverse, inverse_child, singular


@inlined
def finish_row(row, of_second, inertia, child_inertia, row_out):
    """Apply a row to the parent and write it as a TREE_ROW. Return (new D and U of the parent, 1 if redundant, else 0).

    row: tuple of load_row; of_second: multiple of the joint's second row that was subtracted from this row; inertia,
    child_inertia: factors (D, U) of the inverse inertias of parent and child.
    """
    inertia, gain, inverse_pivot, inverse_child, singular = apply_row(row, inertia)
    d_x, d_y, d_w, u_xy, u_xw, u_yw = child_inertia
    x, y, w = d_x * row[6] * inverse_child, d_y * row[7] * inverse_child, d_w * row[8] * inverse_child
    r = row_out
    r.px, r.py, r.pw, r.cx, r.cy, r.cw = row[0], row[1], row[2], row[3], row[4], row[5]
    r.gx, r.gy, r.gw = x + u_xy * y + u_xw * w, y + u_yw * w, w
    r.kx, r.ky, r.kw = gain
    r.inverse_pivot = inverse_pivot
    r.of_first = row[12]
    r.of_second = of_second
    r.source = row[13]
    return inertia, singular


@subkernel
def factor_joint(joint_rows, motions, body, at, rows_out, parent_inout):
    """Factor the joint of a body to its parent, and update the articulated inverse inertia of the parent.

    Return the number of redundant rows. Modified Gram-Schmidt makes the rows uncorrelated in the response of the child
    (S = L D Lᵀ). The rows are sorted by the relative contribution of the child to their pivots, greatest first. The
    subtracted multiples then stay small, even if the child can hardly move. joint_rows, motions: see factor_trees;
    body, parent_inout: TREE_BODY rows of the child and of the parent; at: index of the joint's first row in rows_out
    (TREE_ROW).
    """
    p = parent_inout
    count, is_a, j = body.count, body.parent_is_a, MOST_ROWS * body.joint
    mass_p = motions[p.motion].inverse_mass, p.inverse_inertia
    mass_c = motions[body.motion].inverse_mass, body.inverse_inertia
    child = body.d_x, body.d_y, body.d_w, body.u_xy, body.u_xw, body.u_yw
    inertia = p.d_x, p.d_y, p.d_w, p.u_xy, p.u_xw, p.u_yw
    first = load_row(joint_rows[j], is_a, mass_p, mass_c, child, 0)
    second, third = first, first
    of_second = 0.0
    if count > 1:
        second = load_row(joint_rows[j + 1], is_a, mass_p, mass_c, child, 1)
        if count > 2:
            third = load_row(joint_rows[j + 2], is_a, mass_p, mass_c, child, 2)
            if moves_more(third, second):
                second, third = third, second
        if moves_more(second, first):
            first, second = second, first
        common = first[11]
        second, _ = independent(second, first, child, common, False)
        if count > 2:
            third, _ = independent(third, first, child, common, False)
            if moves_more(third, second):
                second, third = third, second
            third, of_second = independent(third, second, child, common, True)
    inertia, singular = finish_row(first, 0.0, inertia, child, rows_out[at])
    if count > 1:
        inertia, more = finish_row(second, 0.0, inertia, child, rows_out[at + 1])
        singular += more
    if count > 2:
        inertia, more = finish_row(third, of_second, inertia, child, rows_out[at + 2])
        singular += more
    p.d_x, p.d_y, p.d_w, p.u_xy, p.u_xw, p.u_yw = inertia
    return singular


@kernel
def factor_trees(
    # read
    joint_rows,
    row_counts,
    motions,
    # write
    forest_inout,
):
    """Factor the equations of all trees, from the leaves to the roots. Return the number of redundant rows. O(joints).

    A row is redundant if its pivot is 0 after the elimination of other rows, or if no body responds to the row. Its
    compliance is then set to the row's pivot without other joints, which keeps the impulse finite. joint_rows
    (MOST_ROWS joints,): JOINT_ROW with Jacobians and compliances; row_counts (joints,): int32, 0..3; motions: MOTION
    rows with inverse masses and inertias; forest_inout: result of build_forest, receives the factors.
    """
    f = forest_inout
    singular = 0
    for slot in range(f.sizes[0]):
        body = f.bodies[slot]
        motion = motions[body.motion]
        body.inverse_inertia = motion.inverse_inertia
        body.d_x, body.d_y, body.d_w = motion.inverse_mass, motion.inverse_mass, body.inverse_inertia
        body.u_xy, body.u_xw, body.u_yw = 0.0, 0.0, 0.0
    for slot in range(f.sizes[0] - 1, -1, -1):
        body = f.bodies[slot]
        if body.parent < 0:
            continue
        body.count = row_counts[body.joint]
        if body.count > 0:
            parent = f.bodies[body.parent]
            singular += factor_joint(joint_rows, motions, body, MOST_ROWS * slot, f.rows, parent)
    return singular


# ---- solve -----------------------------------------------------------------------------------------------------------


@subkernel
def gather_violations(child, first, rows, joint_rows_inout, parent_inout, violations_out):
    """Update the velocity of a parent by the joint to one of its children (pass from leaves to root).

    The subtree of the child has been processed before. violations_out receives the violation of each row [px/s or
    rad/s] for a parent at rest: the required minus the present relative velocity. JOINT_ROW.impulse receives the
    impulses that follow from the subtree alone; spread_impulses then adds the effect of all other impulses on the
    parent.

    child, parent_inout: TREE_BODY rows; first: index of the joint's first row in `rows` (TREE_ROW) and violations_out.
    """
    c, p = child, parent_inout
    rhs_1, rhs_2 = 0.0, 0.0
    for r in range(c.count):
        row = rows[first + r]
        j = joint_rows_inout[MOST_ROWS * c.joint + row.source]
        rhs = j.rhs - row.of_first * rhs_1 - row.of_second * rhs_2
        if r == 0:
            rhs_1 = rhs
        else:
            rhs_2 = rhs
        violation = rhs - (row.cx * c.vx + row.cy * c.vy + row.cw * c.w)
        violations_out[first + r] = violation
        violation -= row.px * p.vx + row.py * p.vy + row.pw * p.w
        p.vx += row.kx * violation
        p.vy += row.ky * violation
        p.w += row.kw * violation
        j.impulse = row.inverse_pivot * violation


@inlined
def follow_parent(parent, first, rows, violations, body_inout):
    """Write the final velocity of a child, given the final velocity of its parent (pass from root to leaves).

    The velocity is computed from the violations that remain at the parent's final velocity, not from the impulses. The
    child then satisfies the joint to the last digit, even if impulses with long arms nearly cancel. parent, body_inout:
    TREE_BODY rows of parent and child; first: index of the joint's first row in `rows` (TREE_ROW) and `violations` (see
    gather_violations).
    """
    p, c = parent, body_inout
    for r in range(c.count):
        row = rows[first + r]
        violation = violations[first + r] - (row.px * p.vx + row.py * p.vy + row.pw * p.w)
        c.vx += row.gx * violation
        c.vy += row.gy * violation
        c.w += row.gw * violation


@subkernel
def spread_impulses(first, rows, joint_rows_inout, parent_inout, body_inout):
    """Write the final impulses of the rows of a joint, given the impulse (fx, fy, fw) that acts on the parent body.

    The final impulses are added to the impulse on the child. They are also added to the impulse on the parent, for the
    next joint of the parent. parent_inout, body_inout: TREE_BODY rows of parent and child; first: index of the joint's
    first row in `rows` (TREE_ROW); joint_rows_inout: JOINT_ROW, see gather_violations.
    """
    p, c = parent_inout, body_inout
    impulse_1, impulse_2 = 0.0, 0.0
    for r in range(c.count - 1, -1, -1):
        row = rows[first + r]
        j = joint_rows_inout[MOST_ROWS * c.joint + row.source]
        impulse = j.impulse - (row.kx * p.fx + row.ky * p.fy + row.kw * p.fw)
        p.fx += row.px * impulse
        p.fy += row.py * impulse
        p.fw += row.pw * impulse
        c.fx += row.cx * impulse
        c.fy += row.cy * impulse
        c.fw += row.cw * impulse
        if r == 0:
            impulse -= impulse_1
        elif r == 1:
            impulse -= impulse_2
        j.impulse = impulse
        impulse_1 += row.of_first * impulse
        impulse_2 += row.of_second * impulse


@inlined
def move_body(body, motion_inout):
    """Copy the velocity of a TREE_BODY row to its MOTION row, and change MOTION.free_… by the same amount."""
    m = motion_inout
    m.free_vx += body.vx - m.vx
    m.free_vy += body.vy - m.vy
    m.free_w += body.w - m.angular_velocity
    m.vx, m.vy, m.angular_velocity = body.vx, body.vy, body.w


@inlined
def place_body(motion, body_out):
    """Copy the velocity of a MOTION row to a TREE_BODY row, and set the impulse of the TREE_BODY row to 0."""
    b, m = body_out, motion
    b.vx = 0.0 if abs(m.vx) < AT_REST else m.vx
    b.vy = 0.0 if abs(m.vy) < AT_REST else m.vy
    b.w = 0.0 if abs(m.angular_velocity) < AT_REST else m.angular_velocity
    b.fx, b.fy, b.fw = 0.0, 0.0, 0.0


@subkernel
def sweep_trees(count, forest_inout, joint_rows_inout):
    """Solve all trees for the velocities of the first `count` TREE_BODY rows, in O(joints).

    The first pass goes from the leaves to the roots, and the second from the roots to the leaves. forest_inout: see
    Forest; joint_rows_inout: JOINT_ROW rows.
    """
    f = forest_inout
    for slot in range(count - 1, -1, -1):
        body = f.bodies[slot]
        if body.parent >= 0:
            first = MOST_ROWS * slot
            gather_violations(body, first, f.rows, joint_rows_inout, f.bodies[body.parent], f.violations)
    for slot in range(count):
        body = f.bodies[slot]
        if body.parent >= 0:
            first = MOST_ROWS * slot
            follow_parent(f.bodies[body.parent], first, f.rows, f.violations, body)
            spread_impulses(first, f.rows, joint_rows_inout, f.bodies[body.parent], body)


@kernel
def solve_trees(
    # write
    forest_inout,
    joint_rows_inout,
    motions_inout,
):
    """Solve the joints of all trees for the velocities of their bodies, and apply the impulses. O(joints).

    forest_inout: factored by factor_trees. joint_rows_inout (MOST_ROWS joints,): JOINT_ROW; `rhs` is read and `impulse`
    is written for the joints of the forest. motions_inout: MOTION rows; velocities and free velocities (without contact
    impulses) change by the same amounts.
    """
    f = forest_inout
    for slot in range(f.sizes[0]):
        place_body(motions_inout[f.bodies[slot].motion], f.bodies[slot])
    sweep_trees(f.sizes[0], f, joint_rows_inout)
    for slot in range(f.sizes[0]):
        body = f.bodies[slot]
        if not body.is_fixed:
            move_body(body, motions_inout[body.motion])


# ---- pseudo-velocities -----------------------------------------------------------------------------------------------
# Pseudo-velocities move bodies in a substep and are not part of their velocities. Bodies of infinite mass have none.


@inlined
def place_pseudo(motion, body_out):
    """Copy the pseudo-velocity of a MOTION row to a TREE_BODY row, and set the impulse of the TREE_BODY row to 0."""
    b, m = body_out, motion
    b.vx, b.vy, b.w = m.pseudo_vx, m.pseudo_vy, m.pseudo_w
    if b.is_fixed:
        b.vx, b.vy, b.w = 0.0, 0.0, 0.0
    b.fx, b.fy, b.fw = 0.0, 0.0, 0.0


@inlined
def move_pseudo(body, motion_inout):
    """Copy the velocity of a TREE_BODY row to the pseudo-velocity of its MOTION row."""
    motion_inout.pseudo_vx, motion_inout.pseudo_vy, motion_inout.pseudo_w = body.vx, body.vy, body.w


@subkernel
def solve_pseudo_velocities(push_speed, forest_inout, joint_rows_inout, motions_inout):
    """Solve the joints of all trees for the pseudo-velocities of their bodies, as solve_trees does for velocities.

    push_speed [px/s]: greatest speed at which contacts push a body out.
    """
    f = forest_inout
    for slot in range(f.sizes[0]):
        m = motions_inout[f.bodies[slot].motion]
        fast = norm(m.pseudo_vx, m.pseudo_vy)
        if fast > push_speed:
            share = push_speed / fast
            m.pseudo_vx, m.pseudo_vy, m.pseudo_w = share * m.pseudo_vx, share * m.pseudo_vy, share * m.pseudo_w
        place_pseudo(m, f.bodies[slot])
    sweep_trees(f.sizes[0], f, joint_rows_inout)
    for slot in range(f.sizes[0]):
        body = f.bodies[slot]
        if not body.is_fixed:
            move_pseudo(body, motions_inout[body.motion])


@subkernel
def move_by_pseudo_velocities(h, most_turn, forest_inout, motions_inout):
    """Move the bodies of all trees by their pseudo-velocities over a substep of h [s], and reset these. O(bodies).

    No body may rotate by more than `most_turn` [rad]. If one would, the pseudo-velocities of all bodies of its tree are
    scaled by one factor, so that the joints of the tree are kept. forest_inout: Forest, whose impulses are scratch;
    motions_inout: MOTION rows.
    """
    f = forest_inout
    for slot in range(f.sizes[0]):
        f.bodies[slot].fx = 0.0
    for slot in range(f.sizes[0] - 1, -1, -1):
        body = f.bodies[slot]
        if not body.is_fixed:
            body.fx = max(body.fx, abs(motions_inout[body.motion].pseudo_w))
        if body.parent >= 0:
            parent = f.bodies[body.parent]
            parent.fx = max(parent.fx, body.fx)
    for slot in range(f.sizes[0]):
        body = f.bodies[slot]
        if body.parent >= 0:
            body.fx = f.bodies[body.parent].fx
        if body.is_fixed:
            continue
        time = most_turn / body.fx if h * body.fx > most_turn else h
        m = motions_inout[body.motion]
        m.dx += time * m.pseudo_vx
        m.dy += time * m.pseudo_vy
        if m.pseudo_w != 0.0:
            m.turn += time * m.pseudo_w
            m.cosine, m.sine = rotation_of(m.turn)
        m.pseudo_vx, m.pseudo_vy, m.pseudo_w = 0.0, 0.0, 0.0
