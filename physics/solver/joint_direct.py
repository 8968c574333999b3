"""Direct tier of joints: the parts of joints that are solved exactly, as rows of the tree solver joint_trees.py.

For a joint in a tree, the parts that hold its anchors and its angle are solved exactly, together with all other joints
of the tree. Its coordinate is solved in the same way if it is held or has a spring. Joints that close a loop, further
joints between the same two bodies, limits and motors are solved beside the tree, see joint_schur.py. The passes of
joint_rows.py solve everything else before the trees: parts with a bounded force, and all parts of meshes (see
drop_meshes).

Rigid parts have no spring. A velocity removes an error of position within the next substep, and the solve at the end of
that substep removes this velocity again. To close a wide gap, bodies would rotate so far that some of this velocity
remained. Wide gaps are closed by pseudo-velocities instead, which move the bodies in this substep and are not part of
their velocities. A spring that the user has set is a compliance of its row (Catto, Soft Constraints, GDC 2011).
"""

from typing import NamedTuple

import numpy as np

from physics.jit import inlined, kernel, subkernel
from physics.math2d import norm
from physics.solver.joint_couplings import list_couplings, solve_couplings, sum_couplings, warm_couplings
from physics.solver.joint_rows import (
    aim_springs,
    bounded,
    coordinate_of,
    has_spring,
    has_wide_gap,
    holds_angle,
    holds_coordinate,
    holds_point,
    impulse_of,
    inverse_mass_along,
    is_rigid_pin,
    place_joint,
    softness_of,
    solve_joints,
    spring_inverse_mass,
    spring_of,
    sum_joints,
    warm_joints,
    write_line,
    write_turn,
)
from physics.solver.joint_schur import (
    MOST_SCHUR,
    MOST_WORK,
    SCHUR_ROW,
    Schur,
    aim_schur,
    aim_schur_gaps,
    begin_schur,
    count_schur,
    list_schur,
    mark_pushed_out,
    new_schur,
    solve_schur,
    tree_of_joint,
)
from physics.solver.joint_trees import (
    JOINT_ROW,
    MOST_ROWS,
    Forest,
    build_forest,
    factor_trees,
    move_by_pseudo_velocities,
    new_forest,
    solve_pseudo_velocities,
    solve_trees,
    with_room,
)
from physics.tables.joint import ANGLE, COUPLING, ON_AXIS, PINNED
from physics.tables.table import root_of, zeros_in_lines

FADING = 0.25  # [s] for which a tension counts
SHORT_SHARE = 4.0  # a step shorter than the steps before by more than this factor counts by its share alone
MOST_PSEUDO_TURN = 0.1  # [rad] by which a pseudo-velocity rotates a body in a substep, at most
# Rates at which bend() fades to 0: with the growth of an inertia by tension, and with the square of the rotation in a
# substep [1/rad²]. In a closed mechanism it fades early: in a singular pose the corrections of different joints
# contradict one another.
FADE_BY_GROWTH, FADE_BY_TURN = 20.0, 100.0
OPEN_FADE_BY_GROWTH, OPEN_FADE_BY_TURN = 1.0, 2.0  # in an open tree

# ---- trees -----------------------------------------------------------------------------------------------------------


@kernel
def list_tree_joints(rows, joints, order_out, counts_out, motion_a_out, motion_b_out):
    """List the joints of a group that a tree can solve at least in part. Return their number. O(rows).

    rows: indices of the JOINT rows of the group, in the order of ids; joints: all JOINT rows; order_out: indices into
    `rows` of the listed joints. counts_out receives the number of tree rows, 0 to 3, of every joint of `rows`;
    motion_a_out and motion_b_out receive the MOTION rows of its two bodies.
    """
    found = 0
    for k in range(len(rows)):
        j = joints[rows[k]]
        count = 0
        if holds_point(j):
            count += 2 if j.hold == PINNED else 1
        if holds_angle(j):
            count += 1
        if holds_coordinate(j):
            count += 1
        counts_out[k] = count
        motion_a_out[k] = j.motion_a
        motion_b_out[k] = j.motion_b
        if count > 0:
            order_out[found] = k
            found += 1
    return found


@kernel
def drop_meshes(order, row_counts, motion_a, motion_b, taken, parents_inout, sums_out, order_inout):
    """Remove the joints of meshes from the list of joints for trees. Return the number of remaining joints.

    A connected component is a mesh under two conditions. Its joints outside the tree are more than a quarter of the
    joints in the tree. They also have too many rows for the exact solver of joint_schur.py. In a mesh the iterative
    passes converge better without trees, because a tree would undo their corrections of the loops. O(joints + motions).

    order, row_counts, motion_a, motion_b, taken: arguments of joint_trees.build_forest and factor_trees; parents_inout:
    Forest.parents. sums_out (motions, 3) int32, for the root of each component: number of joints in its tree, number of
    joints outside, and number of rows of the joints outside. order_inout: the same array as `order`, shortened in
    place.
    """
    for i in range(len(sums_out)):
        sums_out[i, 0], sums_out[i, 1], sums_out[i, 2] = 0, 0, 0
    for k in range(len(order)):
        joint = order[k]
        for side in range(2):
            root = root_of(motion_a[joint] if side == 0 else motion_b[joint], parents_inout)
            sums_out[root, 0 if taken[joint] else 1] += 1
            sums_out[root, 2] += 0 if taken[joint] else row_counts[joint]
    left = 0
    for k in range(len(order)):
        joint = order[k]
        # Row 0 and each kinematic body are separate components. The component of the other body counts.
        root = max(root_of(motion_a[joint], parents_inout), root_of(motion_b[joint], parents_inout))
        loops, bodies = sums_out[root, 2] // 2, sums_out[root, 0] + 1  # an upper bound of the number of bodies
        is_exact = loops <= MOST_SCHUR and loops * bodies <= MOST_WORK
        if is_exact or 4 * sums_out[root, 1] <= sums_out[root, 0]:
            order_inout[left] = joint
            left += 1
    return left


@kernel
def mark_direct(rows, taken, joints_inout):
    """Record in JOINT.direct whether each joint of a group is in a tree. Return the number of joints with a spring.

    O(rows). Only springs on coordinates count. The flags that joint_schur.py sets are cleared. rows: indices of JOINT
    rows; taken: for each of these rows, True if the joint is in a tree.
    """
    springs = 0
    for k in range(len(rows)):
        j = joints_inout[rows[k]]
        j.direct = taken[k]
        j.exact_limits, j.exact_motor, j.in_open_tree = False, False, False
        springs += int(has_spring(j))
    return springs


@kernel
def mark_pins(rows, joints_inout):
    """Write JOINT.is_pin of the joints of a group, after JOINT.direct. rows: indices of JOINT rows. O(rows)."""
    for k in range(len(rows)):
        j = joints_inout[rows[k]]
        j.is_pin = not j.direct and is_rigid_pin(j)


# ---- rows ------------------------------------------------------------------------------------------------------------


@subkernel
def soften(hertz, damping, h, inverse_mass, row_out):
    """Write the compliance of a JOINT_ROW from the spring that holds it. Without a spring (hertz 0) the row is rigid.

    hertz [1/s], damping: frequency and damping ratio of the spring; h [s]: length of a substep; inverse_mass: inverse
    effective mass of the row without other joints, to which the frequency refers.
    """
    row_out.compliance = 0.0
    if hertz > 0.0:
        _, mass_share, give = softness_of(hertz, damping, h)
        row_out.compliance = give * inverse_mass / mass_share if mass_share > 0.0 else 0.0


@subkernel
def write_rows(joint, h, a, b, first, rows_out):
    """Write the Jacobians and compliances of the rows of a joint at its present moment arms.

    joint: JOINT row; h [s]: length of a substep; a, b: MOTION rows; first: index of the joint's first row in rows_out
    (JOINT_ROW).
    """
    j = joint
    at = first
    turning = a.inverse_inertia + b.inverse_inertia
    if holds_point(j):
        if j.hold == PINNED:
            for side in range(2):
                x, y = 1.0 - side, float(side)
                write_line(j, x, y, rows_out[at])
                soften(j.point_hertz, j.point_damping, h, inverse_mass_along(j, x, y, a, b), rows_out[at])
                at += 1
        else:
            write_line(j, -j.ny, j.nx, rows_out[at])
            rows_out[at].compliance = 0.0
            at += 1
    if holds_angle(j):
        write_turn(rows_out[at])
        soften(j.angle_hertz, j.angle_damping, h, turning, rows_out[at])
        at += 1
    if holds_coordinate(j):
        if j.coordinate == ANGLE:
            write_turn(rows_out[at])
        else:
            write_line(j, j.nx, j.ny, rows_out[at])
        rows_out[at].compliance = 0.0
        if j.lower != j.upper:
            _, _, give = spring_of(j.spring_hertz, j.spring_damping, h)
            rows_out[at].compliance = give * spring_inverse_mass(j, a, b)


@subkernel
def draw(error, hertz, damping, impulse, rate, most, h, row_inout):
    """Write the target velocity (rhs) of a JOINT_ROW that removes an error of position [px or rad].

    A rigid row (hertz 0) removes the error at `rate` [1/s], with a speed of at most `most` [px/s or rad/s]. A row with
    a spring (hertz [1/s], damping ratio) takes its rate from softness_of instead. It also uses `impulse`, the
    accumulated impulse of the row in this substep of h [s].
    """
    row_inout.rhs = -bounded(rate * error, most)
    if hertz > 0.0:
        spring_rate, _, _ = softness_of(hertz, damping, h)
        row_inout.rhs = -spring_rate * error - row_inout.compliance * impulse


@inlined
def bend(joint, a, b, h):
    """Return a velocity correction (x, y) [px/s] that compensates the curved paths of the anchors of a rotating joint.

    Velocities move anchors along straight lines, but an arm r [px] that rotates at w [rad/s] curves the path of its
    anchor. In a substep of h [s] the anchor ends w² h² r / 2 nearer to the body's centre, so the two anchors would
    separate. The correction is added to the target velocity of B's anchor relative to A's. It fades to 0 for light
    bodies under tension (see add_inertia) and for fast rotation, because it would amplify oscillations. The next
    substep then removes the separation. joint: JOINT row; a, b: MOTION rows.
    """
    j = joint
    growth = max(a.tension * a.own_inverse_inertia, b.tension * b.own_inverse_inertia)
    of_a, of_b = a.angular_velocity * a.angular_velocity, b.angular_velocity * b.angular_velocity
    by_growth, by_turn = FADE_BY_GROWTH, FADE_BY_TURN
    if j.in_open_tree:
        by_growth, by_turn = OPEN_FADE_BY_GROWTH, OPEN_FADE_BY_TURN
    h *= max(1.0 - by_growth * growth - by_turn * max(of_a, of_b) * h * h, 0.0)
    return 0.5 * h * (of_b * j.bx - of_a * j.ax), 0.5 * h * (of_b * j.by - of_a * j.ay)


@subkernel
def write_targets(joint, rate, bends, context, a, b, first, rows_inout):
    """Write the target velocities of the rows of a joint.

    joint: JOINT row; rate [1/s]: fraction of the position errors to remove per second, 0 in the solve at the end of a
    substep; bends: whether targets are corrected for rotating arms, see bend; context: see StepContext; a, b: MOTION
    rows; first: index of the joint's first row in rows_inout (JOINT_ROW).
    """
    j = joint
    at = first
    h, most = context.h, context.push_speed
    bend_x, bend_y = bend(j, a, b, h) if bends else (0.0, 0.0)
    if holds_point(j) and j.hold == PINNED:
        fast = rate * norm(j.apart_x, j.apart_y)
        slow = rate * context.push_speed / fast if fast > context.push_speed else rate
        draw(j.apart_x, j.point_hertz, j.point_damping, j.point_x, slow, most, h, rows_inout[at])
        draw(j.apart_y, j.point_hertz, j.point_damping, j.point_y, slow, most, h, rows_inout[at + 1])
        if j.point_hertz == 0.0:
            rows_inout[at].rhs += bend_x
            rows_inout[at + 1].rhs += bend_y
        at += 2
    elif holds_point(j):
        draw(j.apart_y * j.nx - j.apart_x * j.ny, 0.0, 0.0, 0.0, rate, most, h, rows_inout[at])
        at += 1
    if holds_angle(j):
        draw(j.turn, j.angle_hertz, j.angle_damping, j.hold_impulse, rate, context.push_turn, h, rows_inout[at])
        at += 1
    if holds_coordinate(j):
        if j.lower == j.upper:
            most = context.push_turn if j.coordinate == ANGLE else most
            draw(coordinate_of(j) - j.lower, 0.0, 0.0, 0.0, rate, most, h, rows_inout[at])
        else:
            rows_inout[at].rhs = j.spring_aim - rows_inout[at].compliance * j.spring


@subkernel
def stretch_of(joint):
    """Return (impulse, lever [px] of A, lever [px] of B): the tension in a joint, and the arms on which it acts.

    The result is used by add_inertia. For most joints, the impulse is that which holds the anchors, and the levers are
    the lengths of the moment arms.

    For a joint on an axis, the arms include its translation and may be long. But its force acts almost through a centre
    of mass, or presses the bodies together. Only a force that pulls outwards turns a body back, so the levers are the
    parts of the arms along this force. If the joint also locks the angle, both bodies rotate as one. Then the lever of
    both is the distance between the centres of mass, and only the part of the impulse along this line counts. joint:
    JOINT row.
    """
    j = joint
    x, y, _ = impulse_of(j)
    impulse = norm(x, y)
    if j.hold != ON_AXIS:
        return impulse, norm(j.ax, j.ay), norm(j.bx, j.by)
    if holds_angle(j):
        between_x, between_y = j.bx - j.ax, j.by - j.ay
        lever = norm(between_x, between_y)
        pull = max((x * between_x + y * between_y) / lever, 0.0) if lever > 0.0 else 0.0
        return pull, lever, lever
    if impulse > 0.0:
        return impulse, max(-(x * j.ax + y * j.ay) / impulse, 0.0), max((x * j.bx + y * j.by) / impulse, 0.0)
    return 0.0, 0.0, 0.0


@subkernel
def add_inertia(rows, order, context, joints_inout, motions_inout):
    """Raise the inertia of light bodies in trees under tension, so that substeps can resolve their oscillations.

    A light link between heavy bodies oscillates like a string. A tension F at an arm r turns the link back by a torque
    F r per radian. With an inertia of at least h² Σ F r, the oscillation advances by at most one radian in a substep of
    h [s]. F is the greatest recent force. It fades within a quarter of a second, because a jerking chain is slack
    between jerks. A step that is far shorter than the steps before counts by its share: the force of an impulse would
    be huge in a step of a microsecond. Source: geometric stiffness, Andrews, Teichmann and Kövecses,
    2017. rows, order: see JointSet; context: see StepContext; joints_inout: JOINT rows; motions_inout: MOTION rows.
    O(order).
    """
    h = context.h
    fade = max(1.0 - h / FADING, 0.0)
    for k in range(len(order)):
        j = joints_inout[rows[order[k]]]
        motions_inout[j.motion_a].tension = 0.0
        motions_inout[j.motion_b].tension = 0.0
    for k in range(len(order)):
        j = joints_inout[rows[order[k]]]
        if j.direct and h > 0.0:
            impulse, lever_a, lever_b = stretch_of(j)
            j.strain = max(min(SHORT_SHARE * context.share, 1.0) * impulse / h, fade * j.strain)
            motions_inout[j.motion_a].tension += h * h * j.strain * lever_a
            motions_inout[j.motion_b].tension += h * h * j.strain * lever_b
    for k in range(len(order)):
        j = joints_inout[rows[order[k]]]
        for side in range(2):
            m = motions_inout[j.motion_a if side == 0 else j.motion_b]
            growth = m.own_inverse_inertia * m.tension
            m.inverse_inertia = m.own_inverse_inertia / growth if growth > 1.0 else m.own_inverse_inertia


@subkernel
def place_trees(rows, order, h, motions, joints_inout, tree_rows_out):
    """Compute the moment arms of all joints in trees at the present poses, and write their Jacobians and compliances.

    rows, order: see JointSet; h [s]: length of a substep; motions: MOTION rows; joints_inout: all JOINT rows;
    tree_rows_out: JOINT_ROW rows. O(order).
    """
    for k in range(len(order)):
        j = joints_inout[rows[order[k]]]
        if j.direct:
            a, b = motions[j.motion_a], motions[j.motion_b]
            place_joint(a, b, j)
            write_rows(j, h, a, b, MOST_ROWS * order[k], tree_rows_out)


@subkernel
def aim_trees(rows, order, biased, context, joints, motions, tree_rows_out):
    """Write the target velocities of the rows of all trees. Return whether any joint has a wide gap. O(order).

    rows, order: see JointSet; biased: see solve_all_trees; context: see StepContext; joints, motions: all JOINT and
    MOTION rows; tree_rows_out: JOINT_ROW rows. A velocity does not close wide gaps, see close_gaps.
    """
    any_wide = False
    for k in range(len(order)):
        j = joints[rows[order[k]]]
        if j.direct:
            a, b = motions[j.motion_a], motions[j.motion_b]
            is_wide = biased and has_wide_gap(j, context.wide_gap)
            any_wide = any_wide or is_wide
            rate = context.inverse_h if biased and not is_wide else 0.0
            write_targets(j, rate, rate > 0.0, context, a, b, MOST_ROWS * order[k], tree_rows_out)
    return any_wide


@subkernel
def translate_open_trees(rows, order, context, joints, schur_inout, motions_inout):
    """Mark the trees with wide gaps. Give the bodies of the open trees among them an infinite inertia. O(order).

    A tree is open if it has no loop, and at most one joint to a body of infinite mass. Its gaps close without rotation:
    the moment arms stay, and with them the velocities that its joints permit. With rotation, the light links of a chain
    that is nearly straight would turn by large angles.

    rows, order: see JointSet; context: see StepContext; joints: all JOINT rows. schur_inout: see Schur; motions_inout:
    MOTION rows, whose inertias add_inertia restores.
    """
    s = schur_inout
    for k in range(len(order)):
        j = joints[rows[order[k]]]
        if j.direct and has_wide_gap(j, context.wide_gap):
            t = s.trees[tree_of_joint(j, motions_inout, s)]
            t.is_pushed, t.has_wide_gap = True, True
    for k in range(len(order)):
        j = joints[rows[order[k]]]
        if j.direct and j.in_open_tree and s.trees[tree_of_joint(j, motions_inout, s)].has_wide_gap:
            for side in range(2):
                m = motions_inout[j.motion_a if side == 0 else j.motion_b]
                if m.inverse_mass > 0.0:
                    m.inverse_inertia = 0.0


@subkernel
def aim_gaps(rows, order, counts, context, joints, motions, tree_rows_out):
    """Write the target pseudo-velocities of the rows of all trees. O(order).

    The targets of a joint with a wide gap close the gap. All other targets are 0. rows, order, counts: see JointSet;
    context: see StepContext; joints, motions: all JOINT and MOTION rows; tree_rows_out: JOINT_ROW rows.
    """
    for k in range(len(order)):
        j = joints[rows[order[k]]]
        if j.direct:
            first = MOST_ROWS * order[k]
            rate = context.inverse_h if has_wide_gap(j, context.wide_gap) else 0.0
            write_targets(j, rate, False, context, motions[j.motion_a], motions[j.motion_b], first, tree_rows_out)
            for at in range(first, first + counts[order[k]]):
                if tree_rows_out[at].compliance > 0.0:
                    tree_rows_out[at].rhs = 0.0  # a spring


@subkernel
def collect_trees(rows, order, tree_rows, joints_inout):
    """Add the impulses from the solve of the trees to the impulses of their joints. O(order).

    rows, order: see JointSet; tree_rows: JOINT_ROW rows with the impulses; joints_inout: all JOINT rows.
    """
    for k in range(len(order)):
        j = joints_inout[rows[order[k]]]
        if not j.direct:
            continue
        at = MOST_ROWS * order[k]
        if holds_point(j):
            if j.hold == PINNED:
                j.point_x += tree_rows[at].impulse
                j.point_y += tree_rows[at + 1].impulse
                at += 2
            else:
                j.point_y += tree_rows[at].impulse
                at += 1
        if holds_angle(j):
            j.hold_impulse += tree_rows[at].impulse
            at += 1
        if holds_coordinate(j):
            if j.lower == j.upper:
                j.low += tree_rows[at].impulse
            else:
                j.spring += tree_rows[at].impulse


# ---- passes ----------------------------------------------------------------------------------------------------------


class JointSet(NamedTuple):
    """The joints of a group of islands, with the trees among them."""

    table: np.ndarray  # all JOINT rows
    rows: np.ndarray  # int32 indices of the JOINT rows of the group, in the order of ids
    springs: int  # number of joints with a spring on their coordinate
    couplings: np.ndarray  # COUPLING rows of the gears, pulleys and ratchets
    order: np.ndarray  # int64 indices into `rows` of the joints with parts for a tree
    counts: np.ndarray  # int32 number of tree rows of each joint of `rows`
    tree_rows: np.ndarray  # JOINT_ROW, MOST_ROWS for each joint of `rows`
    forest: Forest
    schur: Schur  # rows beside the trees


@subkernel
def begin_trees(context, joints_inout, motions_inout):
    """Prepare the trees for a solve at the present poses. Return the number of redundant rows, see factor_trees.

    The geometry of the joints in trees is computed, and the trees are factored. context: see StepContext; joints_inout:
    JointSet; motions_inout: MOTION rows.
    """
    s = joints_inout
    if len(s.order) == 0:
        return 0
    add_inertia(s.rows, s.order, context, s.table, motions_inout)
    place_trees(s.rows, s.order, context.h, motions_inout, s.table, s.tree_rows)
    begin_schur(s.rows, s.table, s.tree_rows, motions_inout, s.forest, s.schur)
    return factor_trees(s.tree_rows, s.counts, motions_inout, s.forest)


@subkernel
def begin_substep(context, motions, joints_inout):
    """Prepare the springs of all joints for a substep, before accelerations act. joints_inout: JointSet.

    context: see StepContext; motions: MOTION rows.
    """
    if joints_inout.springs > 0:
        aim_springs(joints_inout.rows, context.h, motions, joints_inout.table)


@subkernel
def solve_all_trees(biased, context, joints_inout, motions_inout):
    """Solve all joints in trees exactly. Return whether a joint has a wide gap, which close_gaps closes.

    biased: True to also remove errors of position, up to the greatest push-out speed; context: see StepContext;
    joints_inout: JointSet; motions_inout: MOTION rows.
    """
    s = joints_inout
    any_wide = False
    if len(s.order) > 0:
        any_wide = aim_trees(s.rows, s.order, biased, context, s.table, motions_inout, s.tree_rows)
        solve_trees(s.forest, s.tree_rows, motions_inout)
        if s.schur.counts[0] > 0:
            aim_schur(s.rows, biased, context, s.table, s.tree_rows, s.schur)
            solve_schur(False, s.rows, s.forest, s.schur, s.table, s.tree_rows, motions_inout)
        collect_trees(s.rows, s.order, s.tree_rows, s.table)
    return any_wide


@subkernel
def close_gaps(any_wide, context, joints_inout, motions_inout):
    """Move the bodies of trees by pseudo-velocities that close wide gaps, and that keep the push-out within the joints.

    It follows the push-out of contacts, whose pseudo-velocities it changes so that they neither part joints nor exceed
    limits. Afterwards the trees must be factored again. any_wide: whether a joint has a wide gap; context: see
    StepContext; joints_inout: JointSet; motions_inout: MOTION rows.
    """
    s = joints_inout
    if len(s.order) == 0 or not (mark_pushed_out(s.forest, motions_inout, s.schur) or any_wide):
        return
    if any_wide:
        translate_open_trees(s.rows, s.order, context, s.table, s.schur, motions_inout)
        begin_schur(s.rows, s.table, s.tree_rows, motions_inout, s.forest, s.schur)
        factor_trees(s.tree_rows, s.counts, motions_inout, s.forest)
    aim_gaps(s.rows, s.order, s.counts, context, s.table, motions_inout, s.tree_rows)
    solve_pseudo_velocities(context.push_speed, s.forest, s.tree_rows, motions_inout)
    if s.schur.counts[0] > 0:
        aim_schur_gaps(s.rows, context, s.table, motions_inout, s.tree_rows, s.schur)
        solve_schur(True, s.rows, s.forest, s.schur, s.table, s.tree_rows, motions_inout)
    move_by_pseudo_velocities(context.h, MOST_PSEUDO_TURN, s.forest, motions_inout)


@subkernel
def solve_once(biased, context, joints_inout, motions_inout):
    """Solve all joints of a JointSet once. The trees come last, so that their joints are exact at the end.

    biased: True to also remove errors of position; context: see StepContext; motions_inout: MOTION rows. joints_inout:
    JointSet.
    """
    s = joints_inout
    solve_joints(s.rows, biased, context, s.table, motions_inout)
    solve_couplings(biased, context, s.couplings, s.table, motions_inout)
    solve_all_trees(biased, context, s, motions_inout)


@subkernel
def start_joints(first, context, joints_inout, motions_inout):
    """Apply the joint impulses of the last substep (warm start), then solve all joints once.

    first: whether this is the first substep of the step; context: see StepContext; joints_inout: JointSet;
    motions_inout: MOTION rows.
    """
    s = joints_inout
    warm_joints(s.rows, first, context.wide_gap, s.table, motions_inout)
    if not first:
        sum_couplings(s.couplings, s.table)
    warm_couplings(s.couplings, s.table, motions_inout)
    solve_once(True, context, s, motions_inout)


@subkernel
def finish_joints(context, joints_inout, motions_inout):
    """Solve all joints once after a substep, at the new poses and without correction of position errors.

    context: see StepContext; joints_inout: JointSet; motions_inout: MOTION rows.
    """
    s = joints_inout
    begin_trees(context, s, motions_inout)
    solve_once(False, context, s, motions_inout)


@subkernel
def end_joints(joints_inout):
    """Add the impulses of the last substep to the totals of the step. joints_inout: JointSet."""
    sum_joints(joints_inout.rows, joints_inout.table)
    sum_couplings(joints_inout.couplings, joints_inout.table)


class Trees:
    """Arrays for the joint trees of a group of islands. They are reused for each group, and grow as needed."""

    def __init__(self) -> None:
        self.forest: Forest = new_forest(0, 0)
        self._make_room(0)

    def _make_room(self, joints: int) -> None:
        self.rows = np.zeros(MOST_ROWS * joints, JOINT_ROW)
        self.order, self.counts = np.zeros(joints, np.int64), np.zeros(joints, np.int32)
        self.motion_a, self.motion_b = np.zeros(joints, np.int32), np.zeros(joints, np.int32)
        self.taken = np.zeros(joints, np.bool_)
        self.couplings = zeros_in_lines(joints, COUPLING)
        self.sums = np.zeros((0, 3), np.int32)
        self.schur = new_schur(0, 2 * joints, 0, 0)

    def build(self, rows: np.ndarray, joints: np.ndarray, motions: np.ndarray, tier: str) -> JointSet:
        """Find the trees among the joints of a group, and return the JointSet.

        rows: indices of the JOINT rows of the group, in the order of ids; joints: all JOINT rows; motions: MOTION rows.
        tier: "iterative" builds no trees, "direct" builds all, and "auto" builds trees except in meshes, see
        drop_meshes.
        """
        n = len(rows)
        if len(self.taken) < n:
            self._make_room(2 * n)
        taken = self.taken[:n]
        taken[:] = False
        order, taken_count = self.order[:0], 0
        if tier != "iterative" and n:
            found = list_tree_joints(rows, joints, self.order, self.counts, self.motion_a, self.motion_b)
            order = self.order[:found]
            self.forest = with_room(self.forest, n, len(motions))
            taken_count = build_forest(order, self.motion_a, self.motion_b, motions, self.forest, taken)
            if tier == "auto" and taken_count < found:
                order, taken_count = self._drop_meshes(order, motions, taken)
        springs = mark_direct(rows, taken, joints) if n else 0
        self.schur.counts[:] = 0
        schur = self._list_schur(rows, joints, motions, taken) if taken_count else self.schur
        if n:
            mark_pins(rows, joints)
        couplings = self.couplings[: list_couplings(rows, joints, self.couplings) if n else 0]
        return JointSet(joints, rows, springs, couplings, order, self.counts, self.rows, self.forest, schur)

    def _drop_meshes(self, order, motions, taken):
        """Return (joints for trees without the joints of meshes, number of joints that are in trees).

        order: see JointSet; motions: MOTION rows; taken: for each joint, whether it is in a tree; updated in place.
        """
        a, b = self.motion_a, self.motion_b
        if len(self.sums) < len(motions):
            self.sums = np.zeros((2 * len(motions), 3), np.int32)
        sums = self.sums[: len(motions)]
        left = drop_meshes(order, self.counts, a, b, taken, self.forest.parents, sums, order)
        if left < len(order):
            taken[:] = False
        return order[:left], build_forest(order[:left], a, b, motions, self.forest, taken) if left else 0

    def _list_schur(self, rows, joints, motions, taken):
        """Return a Schur with the Schur rows of the group, enlarged if needed. Arguments: see count_schur."""
        schur = self.schur
        if len(schur.slot_of) < len(motions):
            schur = self.schur = schur._replace(slot_of=np.zeros(2 * len(motions), np.int32))
        count = count_schur(rows, motions, self.forest, self.counts, taken, joints, schur)
        entries = schur.counts.item(1)
        if count > len(schur.rows):
            schur = schur._replace(rows=zeros_in_lines(2 * count, SCHUR_ROW))
        if entries > len(schur.matrix):
            schur = schur._replace(matrix=np.zeros(2 * entries))
        self.schur = schur
        if count:
            list_schur(rows, motions, self.forest, self.counts, taken, joints, schur)
        return schur
