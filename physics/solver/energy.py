"""Energy bound: contacts add no energy to an island, except the work of kinematic bodies and moving surfaces.

Contacts may add energy for four reasons. They separate overlaps, their springs oscillate, their normals are a step old
on curved ground, or their moment arms are fixed for a substep. Bodies that exchanged impulses in a step form a set of
touching bodies. After the step, the kinetic energy of a set is compared with its energy before the step plus the work
of gravity, forces and moving surfaces. A further gain may be taken from the reserve of the bodies, which is energy lost
in earlier steps. The rest of the gain is removed by scaling the velocities.

If a set touches no body of infinite mass, it keeps its momentum and angular momentum. Only the velocities relative to
the set's common motion as one rigid body are scaled. In sets with joints, whose tension changes inertias, the rotation
of the common motion is slowed too if that is not enough.
"""

import math

from physics.islands.graph import find_roots
from physics.jit import inlined, kernel, subkernel
from physics.math2d import norm
from physics.solver import lanes as at
from physics.solver.lanes import SIZE, lanes_of
from physics.solver.motions import kinetic_energy
from physics.tables.table import join_trees, root_of

PARALLEL = 1e-9  # sine of the angle between normals up to which they count as one direction
FACES = 0.05  # sine of the angle between normals up to which faces count as parallel or perpendicular
FORGETTING = 0.1  # [1/s] rate at which the reserve of a body decays
QUICK_LIFT = 0.02  # [slops] a gain of at most the energy of this lift needs no check of the whole island
SHARE_BACK = 1e-3  # fraction of its energy that a set of bodies may take back from the reserve in a step

# ---- work ------------------------------------------------------------------------------------------------------------


@inlined
def work_of_surfaces(c, lane, a, b):
    """Return the work that conveyors and moving kinematic bodies did in this step through the impulses of a contact.

    c: the fields of a block; lane: lane of the contact in the block; a, b: MOTION rows of its bodies.
    """
    nx, ny = c[at.NX + lane], c[at.NY + lane]
    work = abs(c[at.SURFACE + lane] * (c[at.TANGENT_TOTAL_1 + lane] + c[at.TANGENT_TOTAL_2 + lane]))
    for side in range(2):
        o = a if side == 0 else b
        if o.inverse_mass > 0.0 or not o.moves:
            continue
        sign = -1.0 if side == 0 else 1.0
        for point in range(2):
            normal = c[(at.TOTAL_1 if point == 0 else at.TOTAL_2) + lane]
            tangent = c[(at.TANGENT_TOTAL_1 if point == 0 else at.TANGENT_TOTAL_2) + lane]
            if side == 0:
                x = c[(at.AX_1 if point == 0 else at.AX_2) + lane]
                y = c[(at.AY_1 if point == 0 else at.AY_2) + lane]
            else:
                x = c[(at.BX_1 if point == 0 else at.BX_2) + lane]
                y = c[(at.BY_1 if point == 0 else at.BY_2) + lane]
            vx, vy = o.vx - o.angular_velocity * y, o.vy + o.angular_velocity * x
            work -= sign * ((normal * nx - tangent * ny) * vx + (normal * ny + tangent * nx) * vy)
    return work


@inlined
def work_of_lift(c, lane, a, b, context):
    """Return the work that a contact did in this step by moving its points apart, over at most one slop per point.

    A contact spring that was compressed by a load returns this energy. c: the fields of a block; lane: lane of the
    contact in the block; a, b: MOTION rows; context: see StepContext.
    """
    along = (b.dx - a.dx) * c[at.NX + lane] + (b.dy - a.dy) * c[at.NY + lane]
    first = along + b.turn * c[at.B_1 + lane] - a.turn * c[at.A_1 + lane]
    second = along + b.turn * c[at.B_2 + lane] - a.turn * c[at.A_2 + lane]
    first, second = min(max(first, 0.0), context.slop), min(max(second, 0.0), context.slop)
    return (c[at.TOTAL_1 + lane] * first + c[at.TOTAL_2 + lane] * second) * context.inverse_dt


# ---- direction -------------------------------------------------------------------------------------------------------
# Contacts without friction do not change the velocity along their tangent. So the tangential velocity is scaled only if
# the energy along the normal is less than the gain.


@inlined
def note_direction(nx, ny, rubs, motion, balance_inout):
    """Record in a body's BALANCE row that a contact acts on the body along the normal (nx, ny).

    The record is a single normal, or `in_all` for all directions. Friction sets `in_all`, and so does a normal that is
    not parallel to the recorded one. rubs: True if friction acted; motion, balance_inout: MOTION and BALANCE row of the
    body.
    """
    e = balance_inout
    if motion.inverse_mass == 0.0:
        return
    if e.normal_x == 0.0 and e.normal_y == 0.0:
        e.normal_x, e.normal_y = nx, ny
    e.in_all = e.in_all or rubs or abs(nx * e.normal_y - ny * e.normal_x) > PARALLEL


@inlined
def energy_along(motion, balance):
    """Return the kinetic energy of a body along the single normal of its contacts; 0 if they act in all directions.

    motion, balance: MOTION and BALANCE row of the body, see note_direction.
    """
    if balance.in_all or motion.inverse_mass == 0.0:
        return 0.0
    along = motion.vx * balance.normal_x + motion.vy * balance.normal_y
    return 0.5 * along * along / motion.inverse_mass


@subkernel
def scale_without(energy, whole):
    """Return the factor for velocities that reduces their kinetic energy `whole` by `energy`.

    The result is 1 for energy <= 0, and 0 if `energy` is at least `whole`.
    """
    if energy <= 0.0:
        return 1.0
    return math.sqrt(1.0 - energy / whole) if energy < whole else 0.0


@inlined
def scale_motion(root, balance, motion_inout):
    """Scale the velocities of a body to remove energy that contacts added.

    root: BALANCE row with the scale factors for the set of touching bodies that contains this body; balance,
    motion_inout: BALANCE and MOTION row of the body.

    A set is `anchored` if one of its bodies touches a body of infinite mass. If it is not, only the velocity relative
    to the common motion of the set is scaled. If it is, root.along_scale is applied to the velocity along the single
    normal of the body's contacts, and then root.scale to the whole velocity.
    """
    m = motion_inout
    if not root.anchored:
        vx = root.vx - root.spin * (balance.y + m.dy - root.middle_y)
        vy = root.vy + root.spin * (balance.x + m.dx - root.middle_x)
        m.vx, m.vy = vx + root.scale * (m.vx - vx), vy + root.scale * (m.vy - vy)
        if m.inverse_inertia > 0.0:
            m.angular_velocity = root.spin + root.scale * (m.angular_velocity - root.spin)
        return
    if not balance.in_all:
        change = (root.along_scale - 1.0) * (m.vx * balance.normal_x + m.vy * balance.normal_y)
        m.vx += change * balance.normal_x
        m.vy += change * balance.normal_y
    m.vx *= root.scale
    m.vy *= root.scale
    m.angular_velocity *= root.scale


# ---- parallel faces --------------------------------------------------------------------------------------------------
# Between parallel faces, without restitution, no body becomes faster than the fastest face or the fastest body before
# the step. Without this limit, impact impulses that are cached from substep to substep may overshoot. If normals are
# not parallel or perpendicular there is no limit, because levers and wedges may accelerate a body.


@inlined
def note_face(c, lane, a, b, root_inout):
    """Record a contact's normal, and the speed of a kinematic body in the contact, for its set of touching bodies.

    `oblique` is set in three cases: the normal is neither parallel nor perpendicular to the first recorded normal, the
    contact has restitution, or the kinematic body rotates. c: the fields of a block; lane: lane of the contact in the
    block; a, b: MOTION rows; root_inout: BALANCE row of the root of the set.
    """
    e = root_inout
    nx, ny = c[at.NX + lane], c[at.NY + lane]
    if e.face_x == 0.0 and e.face_y == 0.0:
        e.face_x, e.face_y = nx, ny
    least = min(abs(nx * e.face_x + ny * e.face_y), abs(nx * e.face_y - ny * e.face_x))
    e.oblique = e.oblique or least > FACES or c[at.RESTITUTION + lane] > 0.0
    for side in range(2):
        o = a if side == 0 else b
        if o.inverse_mass == 0.0 and o.moves:
            e.pushed = True
            e.oblique = e.oblique or o.angular_velocity != 0.0
            e.fastest = max(e.fastest, norm(o.vx, o.vy))


@inlined
def limit_speed(root, push_speed, motion_inout):
    """Limit the speed of a body that a moving kinematic face pushes, directly or through other bodies.

    The limit is the greatest speed of these faces and of the set's bodies before the step, plus push_speed [px/s].
    Push-out of overlaps may add this speed. There is no limit among oblique faces, see note_face. root: BALANCE row of
    the root of the body's set; motion_inout: MOTION row of the body.
    """
    m = motion_inout
    speed = norm(m.vx, m.vy)
    most = root.fastest + push_speed
    if root.pushed and not root.oblique and speed > most:
        m.vx *= most / speed
        m.vy *= most / speed


# ---- balance ---------------------------------------------------------------------------------------------------------


@subkernel
def balance_bodies(group, degrees, floor, lift, keep, motions, balance_inout):
    """Write the energy that each body of a group gained. Return whether a body in contact gained more than allowed.

    The allowed gain per mass is the greater of `floor` [px2/s2] and the gain that the body may take from its energy
    reserve. The body may take at most SHARE_BACK of its energy or, if greater, the energy of a lift by `lift` [px]
    against its acceleration. A body with a joint always counts as having gained more than allowed.

    group: see contact_lanes.Group; degrees: number of contacts of each body; keep: fraction of the reserve that remains
    after this step; motions, balance_inout: MOTION and BALANCE rows.
    """
    suspect = False
    for k in range(len(group.members)):
        i = group.members[k]
        m = motions[i]
        e = balance_inout[i]
        e.excess = 0.0
        e.now = 0.0
        e.suspect = False
        if m.inverse_mass == 0.0:
            continue
        work = (m.acceleration_x * m.dx + m.acceleration_y * m.dy) / m.inverse_mass
        if m.inverse_inertia > 0.0:
            work += m.angular_acceleration * m.turn / m.inverse_inertia
        e.now = kinetic_energy(m)
        e.excess = e.now - e.before - work
        e.before += abs(work)
        e.reserve *= 1.0 if m.jointed else keep
        load = lift * norm(m.acceleration_x, m.acceleration_y)
        allowed = min(e.reserve * m.inverse_mass, max(SHARE_BACK * e.before * m.inverse_mass, load))
        e.suspect = m.jointed or (degrees[i] > 0 and e.excess * m.inverse_mass > max(floor, allowed))
        suspect = suspect or e.suspect
    return suspect


@inlined
def reset_balance(balance_out):
    """Clear the fields of a BALANCE row that hold contact normals, or sums over a set of touching bodies."""
    e = balance_out
    e.lift, e.surfaces = 0.0, 0.0
    e.face_x, e.face_y, e.fastest = 0.0, 0.0, 0.0
    e.oblique = False
    e.pushed = False
    e.mass, e.load = 0.0, 0.0
    e.vx, e.vy = 0.0, 0.0
    e.middle_x, e.middle_y, e.spin = 0.0, 0.0, 0.0
    e.inertia, e.normal_x, e.normal_y = 0.0, 0.0, 0.0
    e.in_all = False
    e.anchored = False
    e.jointed = False
    e.driven = False
    e.has_wide_gap = False


@subkernel
def join_touching(blocks, count, group, joints, links_islands, motions, parents_out, balance_inout):
    """Find the sets of touching bodies of a group: bodies that exchanged impulses in this step (union-find).

    Only such bodies can have exchanged energy. A contact or joint joins its two bodies, unless one of them has infinite
    mass. Also record in the BALANCE rows the directions in which contacts and joints act on each body.

    blocks, count: the contacts, in the first `count` blocks; group: see contact_lanes.Group; joints: the joints of all
    groups, see joint_rows.list_joints; links_islands: see MotionLists; motions: MOTION rows. parents_out (motions)
    int32: the root of each body, which is a body that represents its set; balance_inout: BALANCE rows.
    """
    for k in range(len(joints)):  # also of the other groups, whose bodies are reset before their turn
        parents_out[joints[k, 1]] = joints[k, 1]
        parents_out[joints[k, 2]] = joints[k, 2]
    for k in range(len(group.members)):
        i = group.members[k]
        parents_out[i] = i
        reset_balance(balance_inout[i])
    for block in range(count):
        c = blocks.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks.contact, block)):
            if c[at.TOTAL_1 + lane] + c[at.TOTAL_2 + lane] <= 0.0:
                continue
            row_a = blocks.motion_a[block, lane]
            row_b = blocks.motion_b[block, lane]
            rubs = c[at.TANGENT_TOTAL_1 + lane] != 0.0 or c[at.TANGENT_TOTAL_2 + lane] != 0.0
            note_direction(c[at.NX + lane], c[at.NY + lane], rubs, motions[row_a], balance_inout[row_a])
            note_direction(c[at.NX + lane], c[at.NY + lane], rubs, motions[row_b], balance_inout[row_b])
            if links_islands[row_a] and links_islands[row_b]:
                join_trees(row_a, row_b, parents_out)
    for k in range(len(joints)):
        row_a, row_b = joints[k, 1], joints[k, 2]
        balance_inout[row_a].in_all = True
        balance_inout[row_b].in_all = True
        if links_islands[row_a] and links_islands[row_b]:
            join_trees(row_a, row_b, parents_out)
    for k in range(len(group.members)):
        parents_out[group.members[k]] = root_of(group.members[k], parents_out)
    for k in range(len(joints)):
        row = joints[k, 1] if links_islands[joints[k, 1]] else joints[k, 2]
        if joints[k, 3] > 0 or not (links_islands[joints[k, 1]] and links_islands[joints[k, 2]]):
            balance_inout[parents_out[row]].anchored = True
    for k in range(len(group.members)):
        # With joints, only sets with a gain are looked at: none may depend on the joints of another island.
        e, root = balance_inout[group.members[k]], balance_inout[parents_out[group.members[k]]]
        root.suspect = root.suspect or e.suspect or len(joints) == 0


@inlined
def add_momentum(motion, balance, root_inout):
    """Add the mass, momentum and angular momentum of a body to the sums of its set of touching bodies.

    motion, balance: MOTION and BALANCE row of the body; root_inout: BALANCE row of the set's root, with the sums.
    Positions in the sums are relative to the root's centre of mass before the step.
    """
    m = motion
    e = root_inout
    mass = 1.0 / m.inverse_mass if m.inverse_mass > 0.0 else 0.0
    x, y = balance.x + m.dx - e.x, balance.y + m.dy - e.y
    e.mass += mass
    e.vx += mass * m.vx
    e.vy += mass * m.vy
    e.middle_x += mass * x
    e.middle_y += mass * y
    e.spin += mass * (x * m.vy - y * m.vx)
    e.inertia += mass * (x * x + y * y)
    if m.inverse_inertia > 0.0:
        e.spin += m.angular_velocity / m.inverse_inertia
        e.inertia += 1.0 / m.inverse_inertia


@subkernel
def energy_in_common(balance_inout):
    """Compute the motion of a set of touching bodies as one rigid body, and return the energy of this motion.

    balance_inout: BALANCE row of the set's root. It holds the sums of add_momentum before the call, and the common
    motion afterwards: velocity, centre of mass, angular velocity (`spin`) and moment of inertia.
    """
    e = balance_inout
    if e.mass == 0.0:
        return 0.0
    e.vx *= 1.0 / e.mass
    e.vy *= 1.0 / e.mass
    e.middle_x *= 1.0 / e.mass
    e.middle_y *= 1.0 / e.mass
    e.spin -= e.mass * (e.middle_x * e.vy - e.middle_y * e.vx)
    e.inertia -= e.mass * (e.middle_x * e.middle_x + e.middle_y * e.middle_y)
    e.spin = e.spin / e.inertia if e.inertia > 0.0 else 0.0
    e.middle_x += e.x
    e.middle_y += e.y
    return 0.5 * (e.mass * (e.vx * e.vx + e.vy * e.vy) + e.inertia * e.spin * e.spin)


@subkernel
def sum_balances(blocks, count, group, links_islands, parents, context, motions, balance_inout):
    """Sum the energy balances of each set of touching bodies, and the work of moving surfaces on the set.

    The BALANCE row of each root receives the sums. blocks, count: the contacts, in the first `count` blocks; group: see
    contact_lanes.Group; links_islands: see MotionLists; parents (motions) int32: the root of each body, see
    join_touching; context: see StepContext; motions: MOTION rows.
    """
    for block in range(count):
        c = blocks.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks.contact, block)):
            if c[at.TOTAL_1 + lane] + c[at.TOTAL_2 + lane] <= 0.0:
                continue
            row_a = blocks.motion_a[block, lane]
            row_b = blocks.motion_b[block, lane]
            a, b = motions[row_a], motions[row_b]
            root = balance_inout[parents[row_a if links_islands[row_a] else row_b]]
            root.surfaces += work_of_surfaces(c, lane, a, b)
            root.lift += work_of_lift(c, lane, a, b, context)
            note_face(c, lane, a, b, root)
            root.anchored = root.anchored or c[at.IM_A + lane] == 0.0 or c[at.IM_B + lane] == 0.0
    for k in range(len(group.members)):
        i = group.members[k]
        if motions[i].inverse_mass == 0.0 or not balance_inout[parents[i]].suspect:
            continue
        e = balance_inout[i]
        root = balance_inout[parents[i]]
        root.jointed = root.jointed or motions[i].jointed
        root.driven = root.driven or motions[i].driven
        root.has_wide_gap = root.has_wide_gap or motions[i].has_wide_gap
        e.along = energy_along(motions[i], e)
        root.load += norm(motions[i].acceleration_x, motions[i].acceleration_y) / motions[i].inverse_mass
        add_momentum(motions[i], e, root)
        root.fastest = max(root.fastest, math.sqrt(2.0 * e.before * motions[i].inverse_mass))
        if parents[i] != i:
            root.before += e.before
            root.now += e.now
            root.excess += e.excess
            root.along += e.along
            root.reserve += e.reserve


@subkernel
def draw_on_reserve(slop, balance_inout):
    """Write the factors on velocities that remove the energy gain of a set of touching bodies.

    A gain that the energy reserve covers is subtracted from the reserve, and not removed. Return 1 if a gain has to be
    removed, else 0. slop [px]: see settings.Tolerances; balance_inout: BALANCE row of the set's root, from
    sum_balances.

    Errors of the integrator alternate in sign, so bodies may regain energy that they lost before. In one step they may
    regain SHARE_BACK of their energy, or the energy of a lift by a slop. Sets with joints and without contacts may
    regain all of their reserve in one step, because light links under tension exchange much energy with the
    integrator's error. With contacts, joints would return the energy that an impact took in the step before.

    Work of surfaces that did not speed up a body is not added to the reserve. Bodies with motors, springs or joints to
    kinematic bodies keep all gains. A set with a joint whose anchors are far apart has no reserve. The energy that it
    loses while the anchors part or are drawn together is not an error of the integrator.
    """
    e = balance_inout
    if e.has_wide_gap:
        e.reserve = 0.0
    in_contact = e.face_x != 0.0 or e.face_y != 0.0
    allowed = e.reserve
    if in_contact or not e.jointed:
        allowed = min(allowed, max(SHARE_BACK * e.before, min(e.lift, slop * e.load)))
    gained = e.excess - e.surfaces
    beyond = 0.0 if e.driven else gained - allowed
    e.along_scale = 1.0
    if e.anchored:
        e.along_scale = scale_without(beyond, e.along)
        e.scale = scale_without(beyond - e.along, e.now - e.along)
    else:
        relative = e.now - energy_in_common(e)
        e.scale = scale_without(beyond, relative)
        if e.jointed:  # raised inertias change the angular momentum; where e.scale is 0, the rotation is slowed too
            e.spin *= scale_without(beyond - relative, 0.5 * e.inertia * e.spin * e.spin)
    e.reserve += max(-max(e.excess, gained), 0.0) - min(max(gained, 0.0), allowed)
    if e.has_wide_gap:
        e.reserve = 0.0
    return int(beyond > 0.0)


@subkernel
def limit_squeezed(most, before, motion_inout):
    """Limit the speed of a body squeezed between faces to the greater of `most` [px/s] and its speed before the step.

    The limit applies to the kinetic energy, so that rotation is included. most: 0 for no limit; before: kinetic energy
    of the body before the step, plus the work done on it in the step; motion_inout: MOTION row.
    """
    m = motion_inout
    if most == 0.0 or m.inverse_mass == 0.0:
        return
    allowed = max(0.5 * most * most / m.inverse_mass, before)
    energy = kinetic_energy(m)
    if energy > allowed:
        scale = math.sqrt(allowed / energy)
        m.vx *= scale
        m.vy *= scale
        m.angular_velocity *= scale


@subkernel
def join_pushed(blocks, count, group, links_islands, parents_out):
    """Join the bodies of a group that exchanged contact impulses in this step into sets of touching bodies.

    Unlike join_touching, this function ignores joints and records no directions. Arguments: see join_touching.
    """
    for k in range(len(group.members)):
        parents_out[group.members[k]] = group.members[k]
    for block in range(count):
        c = blocks.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks.contact, block)):
            row_a, row_b = blocks.motion_a[block, lane], blocks.motion_b[block, lane]
            pushed = c[at.TOTAL_1 + lane] + c[at.TOTAL_2 + lane] > 0.0
            if pushed and links_islands[row_a] and links_islands[row_b]:
                join_trees(row_a, row_b, parents_out)
    for k in range(len(group.members)):
        parents_out[group.members[k]] = root_of(group.members[k], parents_out)


@subkernel
def keep_losses(group, parents, motions, balance_inout):
    """Add the energy that each set of touching bodies lost to the set's reserve, if no set of the group gained energy.

    Return True if no set gained; otherwise no reserve is changed. group: see contact_lanes.Group; parents (motions)
    int32: the root of each body, see join_touching; motions: MOTION rows; balance_inout: BALANCE rows.

    This is a shortcut for worlds without joints and moving kinematic bodies, with the result of sum_balances and
    draw_on_reserve. In such worlds surfaces can only add energy to a set, so a set without a gain is not slowed down.
    The shortcut takes a third of the time in a pile that settles.
    """
    for k in range(len(group.members)):
        e = balance_inout[group.members[k]]
        e.along, e.lift, e.mass = e.excess, e.reserve, 0.0
    for k in range(len(group.members)):
        i = group.members[k]
        if motions[i].inverse_mass == 0.0:
            continue
        e, root = balance_inout[i], balance_inout[parents[i]]
        root.mass += 1.0 / motions[i].inverse_mass
        if parents[i] != i:
            root.along += e.excess
            root.lift += e.reserve
    for k in range(len(group.members)):
        i = group.members[k]
        if parents[i] == i and balance_inout[i].along > 0.0:
            return False
    for k in range(len(group.members)):
        i = group.members[k]
        root = balance_inout[parents[i]]
        if motions[i].inverse_mass > 0.0:
            reserve = root.lift + max(-root.along, 0.0)
            if parents[i] == i:
                balance_inout[i].reserve = reserve * (1.0 / (motions[i].inverse_mass * root.mass))
            else:
                balance_inout[i].reserve = reserve / (motions[i].inverse_mass * root.mass)
        elif parents[i] == i:
            balance_inout[i].reserve = root.lift + max(-root.along, 0.0)
    return True


@subkernel
def remove_gains(blocks, count, group, links_islands, moving, context, plan_inout, balance_inout, motions_inout):
    """Remove the energy that contacts have added. Return how many sets of touching bodies had gained energy.

    blocks, count: the contacts, in the first `count` blocks; group, plan_inout: see contact_lanes.Group and Plan;
    links_islands: see MotionLists; moving: number of kinematic bodies that move; context: see StepContext;
    balance_inout: BALANCE rows, one for each MOTION row. motions_inout: MOTION rows.
    """
    plan, motions, parents_out = plan_inout, motions_inout, plan_inout.touching
    joints = plan.joints[: plan.joint_count[0]]
    if moving == 0 and len(joints) == 0 and not plan.squeezed[0]:
        join_pushed(blocks, count, group, links_islands, parents_out)
        if keep_losses(group, parents_out, motions, balance_inout):
            return 0
    join_touching(blocks, count, group, joints, links_islands, motions, parents_out, balance_inout)
    sum_balances(blocks, count, group, links_islands, parents_out, context, motions, balance_inout)
    found = 0
    for k in range(len(group.members)):
        i = group.members[k]
        if parents_out[i] == i and balance_inout[i].suspect:
            found += draw_on_reserve(context.slop, balance_inout[i])
    for k in range(len(group.members)):
        i = group.members[k]
        e = balance_inout[i]
        root = balance_inout[parents_out[i]]
        if not root.suspect:
            e.reserve = max(e.reserve - e.excess, 0.0)
            continue
        if motions[i].inverse_mass > 0.0:
            scale_motion(root, e, motions[i])
            limit_speed(root, context.push_speed, motions[i])
            if plan.squeezed[0] and root.anchored:
                limit_squeezed(plan.squeeze[i].most, e.before, motions[i])
            if parents_out[i] != i:
                e.reserve = root.reserve / (motions[i].inverse_mass * root.mass)
    for k in range(len(group.members)):
        i = group.members[k]
        if parents_out[i] == i and motions[i].inverse_mass > 0.0 and balance_inout[i].suspect:
            balance_inout[i].reserve *= 1.0 / (motions[i].inverse_mass * balance_inout[i].mass)
    return found


@kernel
def limit_energy(blocks, count, group, links_islands, moving, context, plan_inout, balance_inout, motions_inout):
    """Remove the energy that the contacts of a group have added. O(members + lanes).

    Return how many sets of touching bodies had gained energy. In islands squeezed between faces, the speed of a body is
    also limited to the speed of the faces plus the push-out speed. A body that was faster before the step may keep its
    speed.

    blocks, count: the contacts, in the first `count` blocks; group, plan_inout: see contact_lanes.Group and Plan;
    links_islands: see MotionLists; moving: number of kinematic bodies that move; context: see StepContext;
    balance_inout: BALANCE rows, one for each MOTION row; motions_inout: MOTION rows.
    """
    plan = plan_inout
    floor = 0.5 * context.limits.calm_speed * context.limits.calm_speed
    keep = max(1.0 - FORGETTING * context.dt, 0.0)
    found = 0
    if balance_bodies(group, plan.degrees, floor, QUICK_LIFT * context.slop, keep, motions_inout, balance_inout):
        found = remove_gains(blocks, count, group, links_islands, moving, context, plan, balance_inout, motions_inout)
    else:
        for k in range(len(group.members)):
            e = balance_inout[group.members[k]]
            e.reserve = max(e.reserve - e.excess, 0.0)
    return found


# ---- squeeze ---------------------------------------------------------------------------------------------------------
# Islands without room: bodies squeezed between opposing faces of bodies of infinite mass. Their impulses are bounded.
#
# Two faces that cannot yield would press a body with ever greater impulses, and would throw the body when it escapes.
# With the bound, the bodies stay overlapped. They escape at most at the speed of the faces plus the push-out speed.

FACING = 0.5  # cosine between normals of two faces below which a body between the faces has no room
OPPOSITE = -0.5  # cosine between normals of two faces below which the faces oppose each other


@subkernel
def note_faces(edges, count, lists, slop, parents, squeeze_out):
    """Write the greatest overlaps of each island, and whether the island is caught between opposing faces.

    A face is the side of a body of infinite mass at a contact. edges, count: the constraints, in the first `count`
    graph edges; lists: MotionLists; slop [px]: smaller overlaps with a face do not count; parents (motions) int32: the
    root of the island of each body; squeeze_out: SQUEEZE rows, of which only the rows of roots are written.
    """
    for turn in range(2):
        for i in range(count):
            node = edges.nodes[i, 0] if lists.links_islands[edges.nodes[i, 0]] else edges.nodes[i, 1]
            root = squeeze_out[parents[node]]
            x = edges.faces[i, 0]
            y = edges.faces[i, 1]
            is_face = x != 0.0 or y != 0.0
            if turn == 1:
                if is_face:
                    differs = x * root.face_x + y * root.face_y < FACING
                    root.caught = root.caught or (differs and edges.overlaps[i] > slop)
                    root.pressed = root.pressed or x * root.push_x + y * root.push_y < OPPOSITE
                continue
            root.depth = max(root.depth, edges.overlaps[i])
            if not is_face:
                continue
            root.face_speed = max(root.face_speed, edges.face_speeds[i])
            root.has_kinematic = root.has_kinematic or edges.face_kinematic[i]
            if edges.face_speeds[i] > 0.0 and root.push_x == 0.0 and root.push_y == 0.0:
                root.push_x, root.push_y = x, y
            if edges.overlaps[i] > slop:
                root.face_depth = max(root.face_depth, edges.overlaps[i])
                if root.face_x == 0.0 and root.face_y == 0.0:
                    root.face_x, root.face_y = x, y


@subkernel
def find_squeezed(edges, count, lists, motions, limits, parents_out, squeeze_out):
    """Find the islands without room, and write bounds on their contact impulses to the SQUEEZE rows.

    Return whether such an island exists. A face is the side of a body of infinite mass at a contact. An island has no
    room under two conditions. It overlaps deeply. Overlapping faces point in different directions, or a moving face is
    opposite to another face. edges, count: the constraints, in the first `count` graph edges; lists: MotionLists;
    motions: MOTION rows; limits: see settings.Limits; parents_out (motions) int32: the root of the island of each body.
    O(count + motions).
    """
    for i in range(len(motions)):
        s = squeeze_out[i]
        s.depth, s.face_depth, s.face_speed = 0.0, 0.0, 0.0
        s.face_x, s.face_y, s.push_x, s.push_y = 0.0, 0.0, 0.0, 0.0
        s.caught, s.pressed, s.has_kinematic = False, False, False
        s.most, s.speed, s.static_speed, s.force = 0.0, 0.0, 0.0, 0.0
    find_roots(edges, count, lists.links_islands, parents_out)
    note_faces(edges, count, lists, limits.slop, parents_out, squeeze_out)
    found = False
    for i in range(len(motions)):
        root = squeeze_out[parents_out[i]]
        if not lists.links_islands[i]:
            continue
        is_caught = root.caught and root.face_depth > limits.deep
        if is_caught or (root.pressed and root.depth > limits.deep):
            found = True
            root.most = limits.push_speed + root.face_speed
            if is_caught:
                root.speed = root.most
                root.static_speed = root.most if root.has_kinematic else 0.0
                m = motions[i]
                if m.inverse_mass > 0.0:
                    root.force += norm(m.acceleration_x, m.acceleration_y) / m.inverse_mass
    for i in range(len(motions)):
        if found and lists.links_islands[i]:
            root = squeeze_out[parents_out[i]]
            squeeze_out[i].most = root.most
            squeeze_out[i].speed = root.speed
            squeeze_out[i].static_speed = root.static_speed
            squeeze_out[i].force = root.force
    return found
