"""Contact constraints of a step: the choice of substeps, the order for the solver, and the storage of the impulses.

The solver works on lanes: a lane holds one contact for the SIMD passes, see lanes.py. Islands with the same number of
substeps form a group. The solver advances one group by the whole step, then the next. Islands do not affect each other,
and the motion of kinematic bodies between them depends on time alone, so groups may have different substeps.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from physics.islands.graph import (
    CONTACT_EDGE,
    JOINT_EDGE,
    Edges,
    color_edges,
    find_roots,
    new_edges,
    order_edges,
    order_nodes,
    share_classes,
    write_pair,
)
from physics.islands.substeps import (
    Islands,
    LoadRules,
    are_mixed,
    choose_substeps,
    class_motions,
    estimate_rate,
    expect_columns,
    expect_impacts,
    share_substeps,
)
from physics.jit import inlined, kernel, subkernel
from physics.math2d import norm
from physics.settings import AUTO_SUBSTEPS, COLORS, EASE_TIME, LEAN, LOAD_SUBSTEPS, STILL_STIFFNESS
from physics.solver import lanes as at
from physics.solver.energy import FACING, find_squeezed
from physics.solver.joint_couplings import begin_couplings, estimate_couplings
from physics.solver.joint_direct import JointSet, Trees
from physics.solver.joint_report import estimate_joints
from physics.solver.joint_rows import begin_joints, list_joints
from physics.solver.lanes import (
    LANES,
    PREPARE,
    SIZE,
    Blocks,
    blocks_needed,
    clamp,
    lanes_of,
    make_blocks,
    push_along,
    touches_slowly,
    write_arms,
    write_masses,
)
from physics.solver.motions import Motions
from physics.solver.restitution import list_impacts, make_impacts, restore_bounces
from physics.solver.step_context import StepContext
from physics.tables.body import KINEMATIC
from physics.tables.contact import SQUEEZE
from physics.tables.step_state import CAP_HITS, StepState

BOTH = (False, True)
CHOICES = np.array(AUTO_SUBSTEPS, np.int64)
BY_LOAD = AUTO_SUBSTEPS.index(LOAD_SUBSTEPS)  # index of the most substeps that a load alone may take


class Plan(NamedTuple):
    """The constraints to solve and their order, as a graph: each node is a MOTION row, each edge a contact or joint.

    An array marked (edges), (motions) or (joints) is at least as long as the number of constraints, MOTION rows or
    JOINT rows in use.
    """

    edges: Edges  # one edge for each contact to solve, then one for each joint
    colors: np.ndarray  # (edges) int32 colour of each contact
    traits: np.ndarray  # (edges) int8 ranks of the bodies of each contact, and which of them have finite mass
    colored: np.ndarray  # (2) int64 numbers of contacts and of MOTION rows for which `colors` and `degrees` are valid
    places: np.ndarray  # (edges) int32 index of each contact in the order by group and colour
    in_one_group: np.ndarray  # (1) bool all contacts are in one group
    taken: np.ndarray  # (motions) int64 bits of the colours of the contacts of each body
    degrees: np.ndarray  # (motions) int64 number of contacts of each body
    classes: np.ndarray  # (motions) int32 index in CHOICES of the number of substeps of each body
    parents: np.ndarray  # (motions) int32 root of the island of each body, valid if …
    joined: np.ndarray  # (1) bool … the islands were computed
    touching: np.ndarray  # (motions) int32 root of the set of bodies that exchanged impulses, see energy.py
    squeezed: np.ndarray  # (1) bool at least one island has no room, …
    squeeze: np.ndarray  # SQUEEZE (motions) … and the bounds of the impulses in such islands
    members: np.ndarray  # (motions) int32 island bodies, by group
    starts: np.ndarray  # (slots) int64 first contact of each colour of each group; contacts without a colour first
    firsts: np.ndarray  # (classes + 1) int64 first entry of each group in `members`
    cursors: np.ndarray  # (slots) int64 scratch
    joints: np.ndarray  # (joints, 4) int32 the joints to solve, see list_joints, …
    joint_count: np.ndarray  # (1) int64 … their number, …
    joint_rows: np.ndarray  # (joints) int32 … their JOINT rows by group, …
    joint_starts: np.ndarray  # (classes + 1) int64 … and the first entry of each group in `joint_rows`


def new_plan(edges: int, motions: int, joints: int) -> Plan:
    """Return an empty Plan. edges, motions, joints: capacities for constraints, MOTION rows and joints."""
    slots = len(AUTO_SUBSTEPS) * (COLORS + 1) + 1
    return Plan(
        edges=new_edges(edges),
        colors=np.zeros(edges, np.int32),
        traits=np.zeros(edges, np.int8),
        colored=np.zeros(2, np.int64),
        places=np.zeros(edges, np.int32),
        in_one_group=np.zeros(1, np.bool_),
        taken=np.zeros(motions, np.int64),
        degrees=np.zeros(motions, np.int64),
        classes=np.zeros(motions, np.int32),
        parents=np.zeros(motions, np.int32),
        joined=np.zeros(1, np.bool_),
        touching=np.zeros(motions, np.int32),
        squeezed=np.zeros(1, np.bool_),
        squeeze=np.zeros(motions, SQUEEZE),
        members=np.zeros(motions, np.int32),
        starts=np.zeros(slots, np.int64),
        firsts=np.zeros(len(AUTO_SUBSTEPS) + 1, np.int64),
        cursors=np.zeros(slots, np.int64),
        joints=np.zeros((joints, 4), np.int32),
        joint_count=np.zeros(1, np.int64),
        joint_rows=np.zeros(joints, np.int32),
        joint_starts=np.zeros(len(AUTO_SUBSTEPS) + 1, np.int64),
    )


class Group(NamedTuple):
    """The islands that take the same number of substeps, with their bodies, joints and range of contacts."""

    substeps: int
    edges: int  # number of contacts of all groups together
    count: int  # number of contacts of the group …
    uncolored: int  # … and number of these without a colour
    members: np.ndarray  # int32 indices of the MOTION rows of the island bodies
    starts: np.ndarray  # int64 first contact of each colour, contacts without a colour first; then the end of the group
    joints: np.ndarray  # int32 indices of JOINT rows


# ---- graph edges -----------------------------------------------------------------------------------------------------


@subkernel
def credit_overlap(overlap, motion, balance_inout):
    """Increase the energy reserve of a body by the energy that lifts it by an overlap [px] against its acceleration.

    The reserve is energy that the solver may add to the body's motion, see energy.py. motion, balance_inout: MOTION and
    BALANCE row of the body.
    """
    m = motion
    if m.inverse_mass > 0.0:
        balance_inout.reserve += overlap * norm(m.acceleration_x, m.acceleration_y) / m.inverse_mass


# If all normals are within the angle of this cosine from the first normal, no two of them are as far apart as
# energy.FACING: the angle is half of that of FACING, less a margin for rounding.
ALIKE = math.sqrt(0.5 + 0.5 * FACING) + 1e-6


@inlined
def traits_of(row_a, row_b, lists):
    """Return the traits of two bodies, which determine the colour of their contact, as the bits of one number.

    The traits of a body are its rank and whether it has finite mass, see graph.color_edges. row_a, row_b: indices of
    MOTION rows; lists: MotionLists.
    """
    a = lists.rank[row_a] << 1 | int(lists.has_finite_mass[row_a])
    b = lists.rank[row_b] << 1 | int(lists.has_finite_mass[row_b])
    return b << 3 | a


@subkernel
def list_contact_edges(contacts, bodies, motions, dt, limits, lists_inout, plan_out):
    """Write the contacts to solve as graph edges between MOTION rows. O(contacts).

    Return (number of edges, whether islands may be squeezed, greatest overlap [px], whether the colours of the last
    step are still valid). The colours are valid if the edges connect the same MOTION rows with the same traits, see
    traits_of.

    Sensors, contacts without a body of finite mass, and contacts under a character's feet are left out. A face is the
    side of a body of infinite mass that touches another body, or meets it within the step. Islands may be squeezed if
    faces differ in direction, or if a face moves.

    contacts, bodies, motions: CONTACT, BODY and MOTION rows; dt [s]; limits: see settings.Limits. lists_inout:
    MotionLists, in which a body created inside another gets an energy reserve. plan_out: see Plan.
    """
    edges_out, traits_out = plan_out.edges, plan_out.traits
    motion_of = lists_inout.motion_of
    found = 0
    unchanged = True
    may_squeeze = False
    first_x, first_y = 0.0, 0.0  # normal of the first face
    deepest = 0.0
    for i in range(len(contacts)):
        c = contacts[i]
        row_a, row_b = motion_of[c.body_row_a], motion_of[c.body_row_b]
        a, b = motions[row_a], motions[row_b]
        if (
            c.sensor
            or a.inverse_mass + b.inverse_mass == 0.0
            or (a.is_character and c.normal_y > abs(c.normal_x))
            or (b.is_character and -c.normal_y > abs(c.normal_x))
        ):
            continue
        traits = traits_of(row_a, row_b, lists_inout)
        unchanged = (
            unchanged
            and edges_out.nodes[found, 0] == row_a
            and edges_out.nodes[found, 1] == row_b
            and traits_out[found] == traits
        )
        traits_out[found] = traits
        write_pair(found, CONTACT_EDGE, i, row_a, row_b, edges_out)
        speed = c.speed_1 if c.speed_1 * dt > c.separation_1 else 0.0
        if c.count == 2 and c.speed_2 * dt > c.separation_2:
            speed = max(speed, c.speed_2)
        approaches = speed > 0.0
        edges_out.impact_speeds[found] = speed
        edges_out.resting[found] = touches_slowly(c.separation_1, c.speed_1, limits)
        overlap = -(min(c.separation_1, c.separation_2) if c.count == 2 else c.separation_1)
        edges_out.overlaps[found] = overlap
        deepest = max(deepest, overlap)
        edges_out.faces[found, 0] = 0.0
        edges_out.faces[found, 1] = 0.0
        for side in range(2):
            o = a if side == 0 else b
            # A character yields to bodies that push it, unless it is wedged.
            if (overlap > -limits.slop or approaches) and o.inverse_mass == 0.0 and not o.is_character:
                sign = 1.0 if side == 0 else -1.0
                face_x, face_y = sign * c.normal_x, sign * c.normal_y
                edges_out.faces[found, 0] = face_x
                edges_out.faces[found, 1] = face_y
                body = bodies[c.body_row_a if side == 0 else c.body_row_b]
                x, y = c.x_1 - body.center_x, c.y_1 - body.center_y
                speed = norm(o.vx - o.angular_velocity * y, o.vy + o.angular_velocity * x) if o.moves else 0.0
                edges_out.face_speeds[found] = speed
                edges_out.face_kinematic[found] = body.kind == KINEMATIC
                if first_x == 0.0 and first_y == 0.0:
                    first_x, first_y = face_x, face_y
                may_squeeze = may_squeeze or speed > 0.0 or face_x * first_x + face_y * first_y < ALIKE
        if overlap > 0.0 and c.of_new_pair:
            # A body that was created inside another body may be lifted out.
            credit_overlap(overlap, a, lists_inout.balance[row_a])
            credit_overlap(overlap, b, lists_inout.balance[row_b])
        found += 1
    unchanged = unchanged and plan_out.colored[0] == found and plan_out.colored[1] == len(motions)
    return found, may_squeeze, deepest, unchanged


@subkernel
def list_joint_edges(joints, count, edges_out):
    """Write the joints to solve as graph edges, after the edges of contacts. Return the number of all edges. O(joints).

    joints: result of joint_rows.list_joints; count: number of edges of contacts; edges_out: Edges of the graph.
    """
    for k in range(len(joints)):
        edge = count + k
        write_pair(edge, JOINT_EDGE, joints[k, 0], joints[k, 1], joints[k, 2], edges_out)
        edges_out.overlaps[edge] = 0.0
        edges_out.faces[edge, 0] = 0.0
        edges_out.faces[edge, 1] = 0.0
    return count + len(joints)


@subkernel
def share_halves(joints, motions_inout):
    """Clear MOTION.halves of two dynamic bodies coupled by a gear or rope, if it is clear for one of them. O(joints).

    A body with MOTION.halves gets half of its acceleration after it has moved, see motions.accelerate_again. Half of
    the load on a rope would otherwise act on a body on the ground after its contacts have been solved. joints: result
    of joint_rows.list_joints.
    """
    for k in range(len(joints)):
        a, b = motions_inout[joints[k, 1]], motions_inout[joints[k, 2]]
        if joints[k, 3] > 0 and a.is_dynamic and b.is_dynamic:
            both = a.halves and b.halves
            a.halves = both
            b.halves = both


# ---- order -----------------------------------------------------------------------------------------------------------


@subkernel
def list_and_color(contacts, bodies, dt, limits, motions_inout, lists_inout, plan_out):
    """Write the constraints to solve as graph edges, and colour the edges of contacts. O(constraints + motions).

    Return (number of contacts to solve, whether edges and colours are unchanged since the last step). The function also
    finds islands that are squeezed between faces (see energy.find_squeezed). It sets MOTION.halves to False for bodies
    with contacts. contacts, bodies: CONTACT and BODY rows; dt [s]: step length; limits: see settings.Limits;
    lists_inout: MotionLists; plan_out: see Plan. motions_inout: MOTION rows.
    """
    nodes = len(motions_inout)
    count, may_squeeze, deepest, unchanged = list_contact_edges(
        contacts, bodies, motions_inout, dt, limits, lists_inout, plan_out
    )
    taken = plan_out.taken[:nodes]
    degrees = plan_out.degrees[:nodes]
    if not unchanged:
        finite, rank = lists_inout.has_finite_mass, lists_inout.rank
        color_edges(plan_out.edges, count, finite, rank, taken, degrees, plan_out.colors)
        plan_out.colored[0] = count
        plan_out.colored[1] = nodes
    edges = list_joint_edges(plan_out.joints[: plan_out.joint_count[0]], count, plan_out.edges)
    if edges > count:
        for i in range(nodes):
            motions_inout[i].halves = motions_inout[i].halves and degrees[i] == 0
        share_halves(plan_out.joints[: plan_out.joint_count[0]], motions_inout)
    plan_out.squeezed[0] = False
    if may_squeeze and deepest > limits.deep:
        parents, squeeze = plan_out.parents[:nodes], plan_out.squeeze
        plan_out.squeezed[0] = find_squeezed(
            plan_out.edges, edges, lists_inout, motions_inout, limits, parents, squeeze
        )
    return count, unchanged


@subkernel
def order_joints(joints, classes, starts_out, rows_out):
    """Write the indices of JOINT rows, sorted by class (stable). A class is the index of a number of substeps.

    The class of a joint is the greater class of its two bodies. O(classes · joints). joints: result of
    joint_rows.list_joints; classes (motions,): class of each MOTION row. starts_out: index of the first joint of each
    class, then the number of joints; rows_out: the sorted indices.
    """
    found = 0
    for group in range(len(starts_out) - 1):
        starts_out[group] = found
        for k in range(len(joints)):
            if max(classes[joints[k, 1]], classes[joints[k, 2]]) == group:
                rows_out[found] = joints[k, 0]
                found += 1
    starts_out[len(starts_out) - 1] = found


@kernel
def order_in_one_group(contacts, bodies, dt, limits, motions_inout, lists_inout, plan_out):
    """Order all constraints as one group, in which every island has the same number of substeps.

    Return (number of contacts to solve, number of these without a colour). Contacts are sorted by colour. Arguments:
    see list_and_color. O(constraints + motions).
    """
    count, unchanged = list_and_color(contacts, bodies, dt, limits, motions_inout, lists_inout, plan_out)
    plan, starts = plan_out, plan_out.starts[: COLORS + 2]
    if not (unchanged and plan.in_one_group[0]):
        order_edges(plan.edges, count, plan.colors, plan.classes[:0], starts, plan.cursors, plan.places)
        plan.in_one_group[0] = True
    return count, starts[1] - starts[0]


@kernel
def order_by_load(contacts, bodies, islands, dt, limits, motions_inout, lists_inout, plan_out):
    """Order the constraints in groups by the number of substeps of their islands, and sort the contacts by colour.

    Return the number of contacts to solve. islands: see substeps.Islands; other arguments: see list_and_color.
    O(constraints + motions).
    """
    plan, motions = plan_out, motions_inout
    nodes = len(motions)
    classes = plan.classes[:nodes]
    count, _ = list_and_color(contacts, bodies, dt, limits, motions, lists_inout, plan)
    plan.in_one_group[0] = False
    choices, by_load = islands.choices, islands.by_load
    unknown = class_motions(motions, plan.degrees, islands, classes)
    expect_impacts(plan.edges, count, motions, islands.rate, choices[: by_load + 1], classes)
    if unknown:
        expect_columns(plan.edges, count, motions, plan.degrees, len(choices) - 1, classes)
    plan.joined[0] = are_mixed(motions, plan.degrees, classes)
    if plan.joined[0]:
        parents = plan.parents[:nodes]
        find_roots(plan.edges, count + plan.joint_count[0], lists_inout.links_islands, parents)
        share_classes(parents, classes)
    order_edges(plan.edges, count, plan.colors, classes, plan.starts, plan.cursors, plan.places)
    order_nodes(islands.members, classes, plan.firsts, plan.cursors, plan.members)
    order_joints(plan.joints[: plan.joint_count[0]], classes, plan.joint_starts, plan.joint_rows)
    return count


class Selection:
    """The constraints of one world in the order in which they are solved.

    The arrays grow when needed and are reused.
    """

    def __init__(self) -> None:
        self.plan = new_plan(16, 16, 0)

    def choose(self, state: StepState, motions: Motions, substeps: int) -> list[Group]:
        """Choose the constraints to solve, colour and order them. Return the groups in ascending order of substeps.

        motions: Motions of the world; substeps: number of substeps of all islands, 0: each island takes as many as it
        needs.
        """
        rows, contacts, limits = motions.used, state.contact_rows, state.tolerances.limits
        joints, plan = state.joints, self.plan
        room = len(contacts) + len(joints)
        if len(plan.colors) < room or len(plan.taken) < len(rows) or len(plan.joints) < len(joints):
            self.plan = plan = new_plan(2 * room, 2 * len(rows), 2 * len(joints))
        if len(joints):
            plan.joint_count[0] = list_joints(motions.lists.motion_of, rows, joints, plan.joints, state.work)
        else:
            plan.joint_count[0] = 0
        if substeps:
            count, uncolored = order_in_one_group(contacts, state.bodies, state.dt, limits, rows, motions.lists, plan)
            starts, own = plan.starts[: COLORS + 2], plan.joints[: plan.joint_count.item(0), 0].copy()
            return [Group(substeps, count, count, uncolored, motions.island_bodies, starts, own)]
        jointed = BY_LOAD if state.joint_solver == "iterative" else 0
        islands = Islands(motions.island_bodies, estimate_rate(state), CHOICES, BY_LOAD, jointed)
        edges = order_by_load(contacts, state.bodies, islands, state.dt, limits, rows, motions.lists, plan)
        colors, firsts, starts, joint_starts = COLORS + 1, plan.firsts.tolist(), plan.starts, plan.joint_starts.tolist()
        groups = [
            Group(
                substeps=number,
                edges=edges,
                count=starts.item((k + 1) * colors) - starts.item(k * colors),
                uncolored=starts.item(k * colors + 1) - starts.item(k * colors),
                members=plan.members[firsts[k] : firsts[k + 1]],
                starts=starts[k * colors : (k + 1) * colors + 1],
                joints=plan.joint_rows[joint_starts[k] : joint_starts[k + 1]],
            )
            for k, number in enumerate(AUTO_SUBSTEPS)
            if firsts[k] < firsts[k + 1]
        ]
        # Without dynamic bodies one empty group is returned, so that kinematic bodies move.
        none = plan.joint_rows[:0]
        return groups or [Group(AUTO_SUBSTEPS[0], 0, 0, 0, motions.island_bodies, plan.starts[: colors + 1], none)]


# ---- loads -----------------------------------------------------------------------------------------------------------
# The loads of a step determine the number of substeps of the next step, see islands/substeps.py.


@subkernel
def add_estimates(blocks, count, substeps, rules, motions_inout):
    """Raise MOTION.estimate of each body to the square of the number of substeps that its contacts need. O(contacts).

    Also set MOTION.capped if a load needs more substeps than both `substeps` and rules.most_by_load. blocks, count: the
    contacts, in the first `count` blocks; substeps: number of substeps in this step; rules: see LoadRules.
    motions_inout: MOTION rows.
    """
    reach = max(substeps, rules.most_by_load)
    reach_squared = float(reach * reach)
    # This estimate keeps an island with most_by_load substeps there, and lets an island with twice as many come down.
    by_load = 0.5 * float(rules.most_by_load * rules.most_by_load)
    for block in range(count):
        c = blocks.lines[block * at.SIZE : (block + 1) * at.SIZE]
        for lane in range(at.LANES):
            if blocks.contact[block, lane] < 0 or c[at.MOST + lane] < math.inf:
                continue
            static = c[at.IM_A + lane] == 0.0 or c[at.IM_B + lane] == 0.0
            per_speed = (rules.rate_static if static else rules.rate) / abs(c[at.STIFFNESS + lane])
            lean = 1.0
            estimate = per_speed * c[at.TOTAL_1 + lane] / c[at.MASS_1 + lane]
            if c[at.MASS_2 + lane] > 0.0:
                other = per_speed * c[at.TOTAL_2 + lane] / c[at.MASS_2 + lane]
                least = min(estimate, other)
                estimate = max(estimate, other)
                if c[at.STIFFNESS + lane] < 0.0 and least > 0.0:
                    # A body on a sole support leans if the two points of the support carry different loads.
                    lean = min(estimate / least, LEAN)
            capped = estimate > reach_squared
            estimate = min(lean * min(estimate, by_load), float(rules.most * rules.most))
            a = motions_inout[blocks.motion_a[block, lane]]
            b = motions_inout[blocks.motion_b[block, lane]]
            a.capped = a.capped or capped
            b.capped = b.capped or capped
            a.estimate = max(a.estimate, estimate)
            b.estimate = max(b.estimate, estimate)


@kernel
def choose_by_load(blocks, count, group, links_islands, rules, plan_inout, motions_inout):
    """Write to the MOTION rows how many substeps each island of a group takes in the next step.

    Return how many islands have needed more substeps than allowed for at least rules.patience [s], so that short
    impacts do not count. blocks, count: the contacts of the group, in the first `count` blocks; links_islands: see
    MotionLists; rules: see LoadRules; plan_inout: see Plan. Islands are searched only if a body needs another number of
    substeps. O(members + constraints).
    """
    plan = plan_inout
    substeps = group.substeps
    add_estimates(blocks, count, substeps, rules, motions_inout)
    if choose_substeps(group.members, plan.degrees, substeps, rules, motions_inout):
        return 0
    parents = plan.parents[: len(motions_inout)]
    if not plan.joined[0]:
        find_roots(plan.edges, group.edges + plan.joint_count[0], links_islands, parents)
        plan.joined[0] = True
    return share_substeps(group.members, parents, substeps, rules.most_by_load, motions_inout)


def estimate_substeps(
    state: StepState, motions: Motions, plan: Plan, group: Group, blocks: Blocks, count: int, joints: JointSet | int
) -> None:
    """Write the number of substeps of the next step to the MOTION rows of a group, from the loads in this step.

    blocks: the contacts of the group, in `count` blocks; joints: the JointSet of the group, 0 without joints; motions:
    Motions of the world; plan: see Plan; group: see Group.
    """
    rate = estimate_rate(state)
    rules = LoadRules(
        rate, rate / STILL_STIFFNESS**2, AUTO_SUBSTEPS[0], LOAD_SUBSTEPS, AUTO_SUBSTEPS[-1], state.dt, EASE_TIME
    )
    if len(group.joints):
        estimate_joints(group.joints, state.joints, group.substeps, rules, state.accuracy, motions.used)
    if isinstance(joints, JointSet) and len(joints.couplings):
        estimate_couplings(joints.couplings, state.joints, rate, motions.used)
    links = motions.lists.links_islands
    state.work[CAP_HITS] += choose_by_load(blocks, count, group, links, rules, plan, motions.used)


# ---- store -----------------------------------------------------------------------------------------------------------
# After the substeps: restitution, the limit of friction, and storing of impulses in CONTACT rows.


@subkernel
def limit_friction(count, motions_inout, blocks_inout):
    """Limit the friction impulses of the step to the friction coefficient times the final normal impulse. O(lanes).

    The excess is undone in the velocities of both bodies. motions_inout: MOTION rows; blocks_inout: the contacts, in
    the first `count` blocks.
    """
    for block in range(count):
        c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks_inout.contact, block)):
            for k in range(2):
                total = c[(at.TANGENT_TOTAL_1 if k == 0 else at.TANGENT_TOTAL_2) + lane]
                limit = c[at.FRICTION + lane] * c[(at.TOTAL_1 if k == 0 else at.TOTAL_2) + lane]
                if not abs(total) > limit:
                    continue
                change = clamp(total, limit) - total
                a = motions_inout[blocks_inout.motion_a[block, lane]]
                b = motions_inout[blocks_inout.motion_b[block, lane]]
                push_along(c, lane, k == 1, change, a, b)
                c[(at.TANGENT_TOTAL_1 if k == 0 else at.TANGENT_TOTAL_2) + lane] = total + change
                c[(at.TANGENT_1 if k == 0 else at.TANGENT_2) + lane] += change


@subkernel
def store_lanes(blocks, count, inverse_h, share, contacts_inout):
    """Write the impulses of the step, and the cached forces for the next step, to the CONTACT rows. O(lanes).

    blocks, count: the contacts, in the first `count` blocks; inverse_h [1/s]: inverse of the length of a substep.
    share: weight of this step's forces in the cached forces, which are a moving average. A very short step gets a small
    weight, because its impulses divided by its length would be large forces.
    """
    rest = 1.0 - share
    for block in range(count):
        s = blocks.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(LANES):
            i = blocks.contact[block, lane]
            if i < 0:
                continue
            c = contacts_inout[i]
            c.normal_impulse_1, c.normal_impulse_2 = s[at.TOTAL_1 + lane], s[at.TOTAL_2 + lane]
            c.tangent_impulse_1 = s[at.TANGENT_TOTAL_1 + lane]
            c.tangent_impulse_2 = s[at.TANGENT_TOTAL_2 + lane]
            c.normal_force_1 = share * (inverse_h * s[at.NORMAL_1 + lane]) + rest * c.normal_force_1
            c.normal_force_2 = share * (inverse_h * s[at.NORMAL_2 + lane]) + rest * c.normal_force_2
            c.tangent_force_1 = share * (inverse_h * s[at.TANGENT_1 + lane]) + rest * c.tangent_force_1
            c.tangent_force_2 = share * (inverse_h * s[at.TANGENT_2 + lane]) + rest * c.tangent_force_2
            c.rolling_force = share * (inverse_h * s[at.ROLLING + lane]) + rest * c.rolling_force


def make_finish_lanes(restitution: bool, friction: bool) -> Callable:
    """Return the kernel that ends a step after its last substep. restitution, friction: effects that the world has."""

    @kernel
    def finish_lanes(count, context, impacts_inout, motions_inout, blocks_inout, contacts_inout, work_inout):
        """Apply restitution, limit friction, and write the impulses from the lanes to the CONTACT rows. O(lanes).

        count: number of blocks; context: see StepContext; impacts_inout: IMPACT rows for scratch use, at least as many
        as contacts. motions_inout: MOTION rows; blocks_inout: the contacts, see lanes.Blocks; work_inout: counters, see
        COUNTERS.
        """
        found = list_impacts(blocks_inout, count, impacts_inout) if restitution else 0
        if restitution and found > 0:
            # Impact speeds are measured at the start of the step, so its normals and moment arms are used.
            for block in range(count):
                if blocks_inout.turns[block]:
                    c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
                    for lane in range(lanes_of(blocks_inout.contact, block)):
                        c[at.NX + lane] = c[at.START_NX + lane]
                        c[at.NY + lane] = c[at.START_NY + lane]
                        write_arms(lane, 1.0, 0.0, 1.0, 0.0, c)
                        write_masses(lane, c)
            restore_bounces(
                contacts_inout, count, found, context, impacts_inout, motions_inout, blocks_inout, work_inout
            )
        if friction:
            limit_friction(count, motions_inout, blocks_inout)
        store_lanes(blocks_inout, count, context.inverse_h, context.share, contacts_inout)

    return finish_lanes


FINISH = {(e, f): make_finish_lanes(restitution=e, friction=f) for e in BOTH for f in BOTH}

# ---- constraint set --------------------------------------------------------------------------------------------------
# The contacts of a world as constraints, for the stacking solvers.


class ContactLanes:
    """The contacts of one world as constraints in SIMD lanes. The arrays grow when needed and are reused."""

    def __init__(self) -> None:
        self.selection = Selection()
        self.blocks = make_blocks(0)
        self.impacts = make_impacts(16)
        self.trees = Trees()

    def choose(self, state: StepState, motions: Motions, substeps: int) -> list[Group]:
        """Return the groups of islands with the same number of substeps. Arguments: see Selection.choose."""
        return self.selection.choose(state, motions, substeps)

    def prepare(self, state: StepState, motions: Motions, group: Group, context: StepContext) -> tuple[Blocks, int]:
        """Write the contacts of a group into SIMD lanes. Return (Blocks, number of blocks in use).

        motions: Motions of the world; group: see Group; context: see StepContext.
        """
        needed = blocks_needed(group.count, group.uncolored)
        if len(self.blocks.contact) < needed:
            self.blocks = make_blocks(2 * needed)
        prepare = PREPARE[state.effects.friction, state.effects.conveyor]
        plan, contacts, blocks = self.selection.plan, state.contact_rows, self.blocks
        return blocks, prepare(state.bodies, motions.used, plan, group, context, contacts, blocks, state.work)

    def joints(self, state: StepState, motions: Motions, group: Group, h: float) -> JointSet:
        """Prepare the joints of a group for a step with substeps of h [s], and find their trees. Return the JointSet.

        motions: Motions of the world; group: see Group.
        """
        if len(group.joints):
            begin_joints(group.joints, state.bodies, h, state.joints)
        found = self.trees.build(group.joints, state.joints, motions.used, state.joint_solver)
        if len(found.couplings):
            begin_couplings(state.bodies, h, found.couplings, state.joints)
        return found

    def store(self, state: StepState, motions: Motions, count: int, context: StepContext) -> None:
        """Apply restitution, limit friction, and write the impulses of `count` blocks back to the CONTACT rows.

        motions: Motions of the world; count: number of blocks in use, as `prepare` returned it; context: see
        StepContext.
        """
        if len(self.impacts) < len(state.contact_rows):
            self.impacts = make_impacts(2 * len(state.contact_rows))
        finish = FINISH[state.effects.restitution, state.effects.friction]
        finish(count, context, self.impacts, motions.used, self.blocks, state.contact_rows, state.work)
