"""The bound of energy: contacts of an island add none, beyond the work of kinematic and moving surfaces.

Contacts that separate overlaps, springs that ring, and moment arms that are fixed for a step may add kinetic energy. After
a step the kinetic energy of an island is compared with that before, plus the work of gravity, forces and surfaces along the
motion of the step. An excess is removed by scaling the velocities of the island.
"""

import math

from physics.jit import kernel, subkernel
from physics.solver import lanes as at
from physics.solver.lanes import SIZE, lanes_of
from physics.tables.table import join_trees, root_of

PARALLEL = 1e-9  # sine between normals that count as one direction
RESERVE_TIME = 10.0  # [s] in which an island forgets the energy that it has lost

SHARE_BACK = 1e-2  # share of its energy that an island may take back in a step


@subkernel
def kinetic_energy(motion):
    """Return the kinetic energy of a MOTION row of finite mass."""
    m = motion
    energy = 0.5 * (m.vx * m.vx + m.vy * m.vy) / m.inverse_mass
    if m.inverse_inertia > 0.0:
        energy += 0.5 * m.angular_velocity * m.angular_velocity / m.inverse_inertia
    return energy


@subkernel
def note_direction(nx, ny, rubs, motion_inout):
    """Note along which direction a contact with this normal acts on a body: one, or with friction or others all."""
    m = motion_inout
    if m.inverse_mass == 0.0:
        return
    if m.acts_nx == 0.0 and m.acts_ny == 0.0:
        m.acts_nx = nx
        m.acts_ny = ny
    m.acts_all = m.acts_all or rubs or abs(nx * m.acts_ny - ny * m.acts_nx) > PARALLEL


@subkernel
def scale_without(energy, whole):
    """Return the factor on velocities that removes so much of their kinetic energy, or all."""
    if energy <= 0.0:
        return 1.0
    return math.sqrt(1.0 - energy / whole) if energy < whole else 0.0


@subkernel
def energy_along(motion):
    """Return the kinetic energy of a body along the only direction in which contacts act on it; 0 if they do in all."""
    m = motion
    along = m.vx * m.acts_nx + m.vy * m.acts_ny
    return 0.0 if m.acts_all else 0.5 * along * along / m.inverse_mass


@subkernel
def scale_motion(along_scale, scale, motion_inout):
    """Scale the velocities of a body, those along the only direction of its contacts by another factor first."""
    m = motion_inout
    if not m.acts_all:
        change = (along_scale - 1.0) * (m.vx * m.acts_nx + m.vy * m.acts_ny)
        m.vx += change * m.acts_nx
        m.vy += change * m.acts_ny
    m.vx *= scale
    m.vy *= scale
    m.angular_velocity *= scale


@subkernel
def work_of_surfaces(blocks, block, lane, motions):
    """Return the work of the impulses of a lane by surfaces that move: kinematic bodies and conveyors."""
    c = blocks.lines[block * SIZE : (block + 1) * SIZE]
    a = motions[blocks.motion_a[block, lane]]
    b = motions[blocks.motion_b[block, lane]]
    nx = c[at.NX + lane]
    ny = c[at.NY + lane]
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
            vx = o.vx - o.angular_velocity * y
            vy = o.vy + o.angular_velocity * x
            work -= sign * ((normal * nx - tangent * ny) * vx + (normal * ny + tangent * nx) * vy)
    return work


@subkernel
def work_of_lift(blocks, block, lane, dt, motions):
    """Return the work of the impulses of a lane along the gap that opens: springs that sagged give it back."""
    c = blocks.lines[block * SIZE : (block + 1) * SIZE]
    a = motions[blocks.motion_a[block, lane]]
    b = motions[blocks.motion_b[block, lane]]
    along = (b.dx - a.dx) * c[at.NX + lane] + (b.dy - a.dy) * c[at.NY + lane]
    first = along + b.turn * c[at.B_1 + lane] - a.turn * c[at.A_1 + lane]
    second = along + b.turn * c[at.B_2 + lane] - a.turn * c[at.A_2 + lane]
    return (c[at.TOTAL_1 + lane] * max(first, 0.0) + c[at.TOTAL_2 + lane] * max(second, 0.0)) / dt


@kernel
def limit_energy(
    # read
    blocks,
    count,
    group,
    links_islands,
    context,
    # write
    plan_inout,
    motions_inout,
):
    """Remove the energy that the contacts of a group have added to its islands. Return the number of such islands.

    O(members + lanes).
    """
    plan = plan_inout
    floor = 0.5 * context.limits.calm_speed * context.limits.calm_speed
    keep = 1.0 / (1.0 + context.dt / RESERVE_TIME)
    suspect = False
    for k in range(len(group.members)):
        m = motions_inout[group.members[k]]
        if m.inverse_mass == 0.0:
            continue
        work = (m.acceleration_x * m.dx + m.acceleration_y * m.dy) / m.inverse_mass
        if m.inverse_inertia > 0.0:
            work += m.angular_acceleration * m.turn / m.inverse_inertia
        m.energy_now = kinetic_energy(m)
        m.energy_excess = m.energy_now - m.energy - work
        m.energy += abs(work)
        m.reserve *= keep
        if plan.degrees[group.members[k]] > 0:
            suspect = suspect or m.energy_excess * m.inverse_mass > floor
    if not suspect:
        for k in range(len(group.members)):
            m = motions_inout[group.members[k]]
            m.reserve -= min(m.energy_excess, 0.0)
        return 0
    # Bodies that exchanged impulses in this step, and no others, exchanged energy.
    parents = plan.touching
    for k in range(len(group.members)):
        m = motions_inout[group.members[k]]
        parents[group.members[k]] = group.members[k]
        m.lift = 0.0
        m.acts_all = False
        m.acts_nx = 0.0
        m.acts_ny = 0.0
    for block in range(count):
        c = blocks.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks.contact, block)):
            if blocks.contact[block, lane] < 0 or c[at.TOTAL_1 + lane] + c[at.TOTAL_2 + lane] <= 0.0:
                continue
            row_a = blocks.motion_a[block, lane]
            row_b = blocks.motion_b[block, lane]
            rubs = c[at.TANGENT_TOTAL_1 + lane] != 0.0 or c[at.TANGENT_TOTAL_2 + lane] != 0.0
            note_direction(c[at.NX + lane], c[at.NY + lane], rubs, motions_inout[row_a])
            note_direction(c[at.NX + lane], c[at.NY + lane], rubs, motions_inout[row_b])
            if links_islands[row_a] and links_islands[row_b]:
                join_trees(row_a, row_b, parents)
    for k in range(len(group.members)):
        parents[group.members[k]] = root_of(group.members[k], parents)
    for block in range(count):
        c = blocks.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks.contact, block)):
            if blocks.contact[block, lane] < 0 or c[at.TOTAL_1 + lane] + c[at.TOTAL_2 + lane] <= 0.0:
                continue
            row_a = blocks.motion_a[block, lane]
            root = motions_inout[parents[row_a if links_islands[row_a] else blocks.motion_b[block, lane]]]
            root.energy_excess -= work_of_surfaces(blocks, block, lane, motions_inout)
            root.lift += work_of_lift(blocks, block, lane, context.dt, motions_inout)
            root.anchored = root.anchored or c[at.IM_A + lane] == 0.0 or c[at.IM_B + lane] == 0.0
    for k in range(len(group.members)):
        i = group.members[k]
        m = motions_inout[i]
        root = motions_inout[parents[i]]
        if m.inverse_mass > 0.0:
            m.energy_along = energy_along(m)
            root.island_mass += 1.0 / m.inverse_mass
            if parents[i] != i:
                root.energy += m.energy
                root.energy_excess += m.energy_excess
                root.energy_now += m.energy_now
                root.energy_along += m.energy_along
                root.reserve += m.reserve
    found = 0
    for k in range(len(group.members)):
        i = group.members[k]
        if parents[i] != i:
            continue
        root = motions_inout[i]
        # Errors of the integrator alternate: what an island has lost before it may take back, slowly.
        allowed = min(root.reserve, max(SHARE_BACK * root.energy, root.lift))
        root.along_scale = 1.0
        root.energy_scale = 1.0
        if root.anchored and root.energy_excess > allowed:
            found += 1
            root.along_scale = scale_without(root.energy_excess - allowed, root.energy_along)
            left = max(root.energy_excess - allowed - root.energy_along, 0.0)
            root.energy_scale = scale_without(left, root.energy_now - root.energy_along)
        root.reserve = max(root.reserve - min(root.energy_excess, allowed), 0.0)
    for k in range(len(group.members)):
        i = group.members[k]
        m = motions_inout[i]
        root = motions_inout[parents[i]]
        if m.inverse_mass > 0.0:
            scale_motion(root.along_scale, root.energy_scale, m)
            share = 1.0 / (m.inverse_mass * root.island_mass)
            if parents[i] != i:
                m.reserve = share * root.reserve
    for k in range(len(group.members)):
        i = group.members[k]
        m = motions_inout[i]
        if parents[i] == i and m.inverse_mass > 0.0:
            m.reserve *= 1.0 / (m.inverse_mass * m.island_mass)
    return found
