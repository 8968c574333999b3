"""Constraints in lanes: contacts of one colour side by side, and the motions of their bodies."""

from typing import Any, NamedTuple

import numpy as np

from physics.jit import inlined, subkernel
from physics.jit.plain import JIT, Builtin, put_in
from physics.settings import COLORS
from physics.tables.table import zeros_in_lines

# ---- lanes -----------------------------------------------------------------------------------------------------------
# Contacts of a group in lanes: contacts of one colour side by side, each field contiguous.
#
# No two contacts of a colour share a dynamic body, so all of them can be solved at once. The compiler vectorises a loop
# over the lanes of a block that has no branches. Unused lanes hold a contact between no bodies. The results equal those
# of one contact after the other, to the bit. Source: Catto, SIMD Matters, 2024.

# The plain form solves one contact after the other. Wide blocks are as fast in heaps, and slower with few boxes
# (measured with 16).
LANES = 8 if JIT else 1

# Offsets of the fields of a block. They are ordered by readers: the pass with bias alone, both passes, the relaxing
# pass, and the passes before and after the substeps.
(
    PUSH_OUT_SHARE,  # share of the push-out speed; negative: not approaching before the step
    RESTING,  # 1: touching before the step, too slow to bounce; 0: not
    BIAS_RATE,  # [1/s] see Softness
    IMPULSE_SCALE,  # share of the accumulated impulse that a soft contact gives up
    STRIKE_LIMIT,  # impulse above which the contact counts as struck
    NX,  # unit normal
    NY,
    A_1,  # [px] moment arms of impulses along the normal, of both points, at the present poses
    B_1,
    A_2,
    B_2,
    MASS_1,  # effective masses along the normal; of one point alone, the second is 0
    MASS_2,
    OFF_DIAGONAL_1,  # off-diagonal terms of the block solver, and its factor: see restitution.py
    OFF_DIAGONAL_2,
    BLOCK_FACTOR,
    IM_A,  # inverse masses and inertias of both bodies
    II_A,
    IM_B,
    II_B,
    GAP_1,  # [px] separation at the present poses
    GAP_2,
    NORMAL_1,  # impulses of this substep
    NORMAL_2,
    TOTAL_1,  # impulses of the step
    TOTAL_2,
    AX_1,  # [px] both points from the centres of mass, at the start of the step
    AY_1,
    BX_1,
    BY_1,
    AX_2,
    AY_2,
    BX_2,
    BY_2,
    BASE_1,  # [px] separation minus the part of the points
    BASE_2,
    RADIUS_A,  # [px] separations are measured from core to core
    RADIUS_B,
    ROLLING_LIMIT,  # [px] torque per normal impulse
    ROLLING_MASS,
    ROLLING,
    SURFACE,  # [px/s] surface speed
    TANGENT_A_1,  # [px] moment arms of impulses along the tangent
    TANGENT_B_1,
    TANGENT_A_2,
    TANGENT_B_2,
    TANGENT_MASS_1,
    TANGENT_MASS_2,
    TANGENT_1,
    TANGENT_2,
    FRICTION,
    TANGENT_TOTAL_1,
    TANGENT_TOTAL_2,
    RESTITUTION,
    THRESHOLD,  # [px/s] slower impacts do not bounce
    LISTED,  # 1: among the impacts of the step, see restitution.py; 0: not
    STIFFNESS,  # factor on the stiffness; negative: the sole support of one side
    LOADED,  # 1: had an impulse in the step before; 0: not
    BOUNCING,  # 1: the sides approached fast enough to bounce; 0: not
    PUSH_1,  # impulses of the pseudo-velocities, of sequential impulses
    PUSH_2,
    TURNS,  # 1: its moment arms turn with the bodies in this step; 0: not
    MOST,  # greatest normal impulse of a substep at one point
    SIZE,
) = (line * LANES for line in range(64))
# Offsets of the values that a pass gathers from the motions of each block. They have an array of their own: among the
# others they were a quarter of the memory traffic of a pass.
(VX_A, VY_A, W_A, DX_A, DY_A, COS_A, SIN_A, VX_B, VY_B, W_B, DX_B, DY_B, COS_B, SIN_B, OUTCOME, GATHERED) = (
    line * LANES for line in range(16)
)
# Pseudo-velocities, in the place of poses: no pass gathers both.
PUSH_VX_A, PUSH_VY_A, PUSH_W_A, PUSH_VX_B, PUSH_VY_B, PUSH_W_B = DX_A, DY_A, COS_A, DX_B, DY_B, COS_B
IN_CONTACT, UNLOADED = 1.0, 2.0  # outcomes of a lane: it has an impulse or rests; it is pushed out of its overlap


def _lanes_in_use(contacts, block):
    """Return the number of lanes of a block in use, which are the first ones. The plain form skips the others."""
    count = 0
    while count < LANES and contacts[block, count] >= 0:
        count += 1
    return count


def _make_all_lanes(count):
    def all_lanes(contacts, block):
        return count

    return all_lanes


ALL_LANES = _make_all_lanes(LANES)
# The compiled pass also solves empty lanes, whose results are 0: a fixed count vectorises.
lanes_of: Any = Builtin(_lanes_in_use, put_in(ALL_LANES), ALL_LANES) if JIT else _lanes_in_use


class Blocks(NamedTuple):
    """Arrays for blocks of lanes."""

    contact: np.ndarray  # (blocks, LANES) int32 contact of each lane, -1 for none
    motion_a: np.ndarray  # (blocks, LANES) uint32 its rows of MOTION, 0 for none
    motion_b: np.ndarray
    turns: np.ndarray  # (blocks) bool moment arms of round contacts turn in this step
    lines: np.ndarray  # SIZE numbers for each block
    gathered: np.ndarray  # GATHERED numbers of the current block of a pass
    block_of: np.ndarray  # (colours + 1) place of the next contact of each colour, those without a colour first
    lane_of: np.ndarray


def make_blocks(count: int) -> Blocks:
    """Return arrays for so many blocks."""
    lanes = (count, LANES)
    return Blocks(
        contact=np.zeros(lanes, np.int32),
        motion_a=np.zeros(lanes, np.uint32),
        motion_b=np.zeros(lanes, np.uint32),
        turns=np.zeros(count, np.bool_),
        lines=zeros_in_lines(count * SIZE, np.float64),
        gathered=zeros_in_lines(GATHERED, np.float64),
        block_of=np.zeros(COLORS + 1, np.int64),
        lane_of=np.zeros(COLORS + 1, np.int64),
    )


def blocks_needed(contacts: int, uncolored: int) -> int:
    """Return the greatest number of blocks of so many contacts, of which so many have no colour."""
    return contacts // LANES + COLORS + 1 + uncolored  # the last block of a colour may be partly empty


@subkernel
def lay_out(starts, blocks_out):
    """Assign blocks to the contacts of each colour, and empty the unused lanes. Return the number of blocks. O(blocks).

    starts (colours + 2) int64: the first contact of each colour, those without a colour first, and the end of the last
    colour. A contact without a colour has a block of its own.
    """
    found = 0
    for slot in range(len(starts) - 1):
        blocks_out.block_of[slot] = found
        blocks_out.lane_of[slot] = 0
        wide = 1 if slot == 0 else LANES
        left = starts[slot + 1] - starts[slot]
        while left > 0:
            blocks_out.turns[found] = False
            for lane in range(min(left, wide), LANES):
                blocks_out.contact[found, lane] = -1
                blocks_out.motion_a[found, lane] = 0
                blocks_out.motion_b[found, lane] = 0
                for at in range(found * SIZE + lane, (found + 1) * SIZE, LANES):
                    blocks_out.lines[at] = 0.0
            left -= wide
            found += 1
    return found


@inlined
def next_lane(slot, blocks_inout):
    """Return the block and lane of the next contact of a colour, and move its place on. slot: see lay_out."""
    block = blocks_inout.block_of[slot]
    lane = blocks_inout.lane_of[slot]
    last = slot == 0 or lane == LANES - 1
    blocks_inout.block_of[slot] = block + 1 if last else block
    blocks_inout.lane_of[slot] = 0 if last else lane + 1
    return block, lane


# ---- two points ------------------------------------------------------------------------------------------------------
# Block solver for two contact points: the linear complementarity problem of two variables, by trying its four cases.
#
# Solving one point after the other lets a body rock from corner to corner. The problem is written in impulses and in
# ratios that last for the step, so that there is no division. Source: Catto, Modeling and Solving Constraints, GDC 2007
# (block solver).

FLAT = 1e-3  # share of k_11 · k_22 below which the two points count as one


@inlined
def block_factor(off_diagonal_1, off_diagonal_2):
    """Return the factor of solve_two where both points press, 1 / (1 - off_diagonal_1 · off_diagonal_2).

    It is 0 where the points coincide.
    """
    apart = 1.0 - off_diagonal_1 * off_diagonal_2
    return 1.0 / apart if apart > FLAT else 0.0


@inlined
def solve_two(change_1, change_2, off_diagonal_1, off_diagonal_2, factor, old_1, old_2):
    """Return the impulses x >= 0 of two points such that each gets the velocity change it needs, or separates.

    change: of each impulse if it were alone. off_diagonal: k_12 / k_11 and k_12 / k_22. factor: see block_factor. old:
    accumulated impulses. The points are solved in sequence where they nearly coincide, or where rounding leaves no
    case. All cases are computed side by side, so that the loop has no branch and vectorises.
    """
    only_1 = old_1 + change_1 + off_diagonal_1 * old_2
    only_2 = old_2 + change_2 + off_diagonal_2 * old_1
    both = (factor > 0.0) & (only_1 >= off_diagonal_1 * only_2) & (only_2 >= off_diagonal_2 * only_1)
    first = (only_1 >= 0.0) & (off_diagonal_2 * only_1 >= only_2)
    second = (only_2 >= 0.0) & (off_diagonal_1 * only_2 >= only_1)
    neither = (only_1 <= 0.0) & (only_2 <= 0.0)
    x_1 = old_1 + change_1
    x_1 = x_1 if x_1 > 0.0 else 0.0
    x_2 = old_2 + change_2 - off_diagonal_2 * (x_1 - old_1)
    x_2 = x_2 if x_2 > 0.0 else 0.0
    x_1 = 0.0 if second | neither else x_1
    x_2 = only_2 if second else (0.0 if neither else x_2)
    x_1 = only_1 if first else x_1
    x_2 = 0.0 if first else x_2
    x_1 = factor * (only_1 - off_diagonal_1 * only_2) if both else x_1
    x_2 = factor * (only_2 - off_diagonal_2 * only_1) if both else x_2
    return x_1, x_2


# ---- lane motions ----------------------------------------------------------------------------------------------------
# Motions of lanes: gathering from the MOTION rows of a block, separations, and scattering.


@inlined
def gather_velocities(a, b, lane, s_out):
    """Copy the velocities of MOTION rows into a lane."""
    s_out[VX_A + lane] = a.vx
    s_out[VY_A + lane] = a.vy
    s_out[W_A + lane] = a.angular_velocity
    s_out[VX_B + lane] = b.vx
    s_out[VY_B + lane] = b.vy
    s_out[W_B + lane] = b.angular_velocity


@inlined
def gather_poses(a, b, lane, s_out):
    """Copy the motion of MOTION rows since the start of the step into a lane."""
    s_out[DX_A + lane] = a.dx
    s_out[DY_A + lane] = a.dy
    s_out[COS_A + lane] = a.cosine
    s_out[SIN_A + lane] = a.sine
    s_out[DX_B + lane] = b.dx
    s_out[DY_B + lane] = b.dy
    s_out[COS_B + lane] = b.cosine
    s_out[SIN_B + lane] = b.sine


@inlined
def scatter_velocities(s, lane, a_out, b_out):
    """Write the velocities of a lane back to its MOTION rows."""
    a_out.vx = s[VX_A + lane]
    a_out.vy = s[VY_A + lane]
    a_out.angular_velocity = s[W_A + lane]
    b_out.vx = s[VX_B + lane]
    b_out.vy = s[VY_B + lane]
    b_out.angular_velocity = s[W_B + lane]


@inlined
def measure_gaps(lane, s, c_inout):
    """Write the separations [px] at both points of a lane.

    A round surface does not move when its body rotates, because only the core moves. Moment arms rotate with the bodies
    here, and stay fixed where speeds are computed.
    """
    c = c_inout
    nx = c[NX + lane]
    ny = c[NY + lane]
    cos_a = s[COS_A + lane]
    sin_a = s[SIN_A + lane]
    cos_b = s[COS_B + lane]
    sin_b = s[SIN_B + lane]
    core = c[RADIUS_A + lane] * cos_a + c[RADIUS_B + lane] * cos_b
    gap = core + (s[DX_B + lane] - s[DX_A + lane]) * nx + (s[DY_B + lane] - s[DY_A + lane]) * ny
    x = (cos_b * c[BX_1 + lane] - sin_b * c[BY_1 + lane]) - (cos_a * c[AX_1 + lane] - sin_a * c[AY_1 + lane])
    y = (sin_b * c[BX_1 + lane] + cos_b * c[BY_1 + lane]) - (sin_a * c[AX_1 + lane] + cos_a * c[AY_1 + lane])
    c[GAP_1 + lane] = gap + c[BASE_1 + lane] + (x * nx + y * ny)
    x = (cos_b * c[BX_2 + lane] - sin_b * c[BY_2 + lane]) - (cos_a * c[AX_2 + lane] - sin_a * c[AY_2 + lane])
    y = (sin_b * c[BX_2 + lane] + cos_b * c[BY_2 + lane]) - (sin_a * c[AX_2 + lane] + cos_a * c[AY_2 + lane])
    c[GAP_2 + lane] = gap + c[BASE_2 + lane] + (x * nx + y * ny)


@inlined
def arms_of(x, y, radius, cosine, sine, nx, ny):
    """Return the moment arms [px] of impulses along the normal and along the tangent at a point of a turned body.

    x, y: the point before the turn, on a surface at a radius from the core in the direction of the normal.
    """
    x -= radius * nx
    y -= radius * ny
    u = cosine * x - sine * y
    v = sine * x + cosine * y
    return u * ny - v * nx, u * nx + v * ny + radius


@inlined
def write_arms(lane, cos_a, sin_a, cos_b, sin_b, c_inout):
    """Write the moment arms of both points, for bodies turned by these angles since the start of the step.

    A point stays at its place on the core of a shape; the radius from there to the surface does not turn.
    """
    c = c_inout
    nx = c[NX + lane]
    ny = c[NY + lane]
    ra = c[RADIUS_A + lane]
    rb = -c[RADIUS_B + lane]
    c[A_1 + lane], c[TANGENT_A_1 + lane] = arms_of(c[AX_1 + lane], c[AY_1 + lane], ra, cos_a, sin_a, nx, ny)
    c[B_1 + lane], c[TANGENT_B_1 + lane] = arms_of(c[BX_1 + lane], c[BY_1 + lane], rb, cos_b, sin_b, nx, ny)
    c[A_2 + lane], c[TANGENT_A_2 + lane] = arms_of(c[AX_2 + lane], c[AY_2 + lane], ra, cos_a, sin_a, nx, ny)
    c[B_2 + lane], c[TANGENT_B_2 + lane] = arms_of(c[BX_2 + lane], c[BY_2 + lane], rb, cos_b, sin_b, nx, ny)


@inlined
def write_masses(lane, c_inout):
    """Write the effective masses at the present moment arms, and the factors of the block solver."""
    c = c_inout
    masses = c[IM_A + lane] + c[IM_B + lane]
    ii_a = c[II_A + lane]
    ii_b = c[II_B + lane]
    two = c[MASS_2 + lane] > 0.0
    a_1 = c[A_1 + lane]
    b_1 = c[B_1 + lane]
    a_2 = c[A_2 + lane]
    b_2 = c[B_2 + lane]
    k_1 = masses + ii_a * a_1 * a_1 + ii_b * b_1 * b_1
    k_2 = masses + ii_a * a_2 * a_2 + ii_b * b_2 * b_2
    k_12 = masses + ii_a * a_1 * a_2 + ii_b * b_1 * b_2
    c[MASS_1 + lane] = 1.0 / k_1 if k_1 > 0.0 else 0.0
    c[MASS_2 + lane] = 1.0 / k_2 if two & (k_2 > 0.0) else 0.0
    c[OFF_DIAGONAL_1 + lane] = c[MASS_1 + lane] * k_12 if two else 0.0
    c[OFF_DIAGONAL_2 + lane] = c[MASS_2 + lane] * k_12 if two else 0.0
    c[BLOCK_FACTOR + lane] = block_factor(c[OFF_DIAGONAL_1 + lane], c[OFF_DIAGONAL_2 + lane]) if two else 0.0
    a_1 = c[TANGENT_A_1 + lane]
    b_1 = c[TANGENT_B_1 + lane]
    a_2 = c[TANGENT_A_2 + lane]
    b_2 = c[TANGENT_B_2 + lane]
    k_1 = masses + ii_a * a_1 * a_1 + ii_b * b_1 * b_1
    k_2 = masses + ii_a * a_2 * a_2 + ii_b * b_2 * b_2
    c[TANGENT_MASS_1 + lane] = 1.0 / k_1 if k_1 > 0.0 else 0.0
    c[TANGENT_MASS_2 + lane] = 1.0 / k_2 if two & (k_2 > 0.0) else 0.0


@inlined
def clamp(impulse, limit):
    """Return an impulse clamped to ± limit."""
    impulse = impulse if impulse < limit else limit
    return impulse if impulse > -limit else -limit


def make_friction(second: bool, rotation: bool, sums: bool) -> Any:
    """Return the friction at one point of a lane, in a world with this effect. sums: the step has several substeps."""
    a_line, b_line = (TANGENT_A_2, TANGENT_B_2) if second else (TANGENT_A_1, TANGENT_B_1)
    mass_line, impulse_line = (TANGENT_MASS_2, TANGENT_2) if second else (TANGENT_MASS_1, TANGENT_1)
    total_line = TANGENT_TOTAL_2 if second else TANGENT_TOTAL_1

    @inlined
    def apply_friction(lane, vx, vy, wa, wb, normal_impulse, c_inout):
        """Apply friction under a normal impulse. Return the impulse x, y on B, and the angular velocities after it.

        vx, vy [px/s]: velocity of B's centre relative to A's. wa, wb [1/s]: angular velocities.
        """
        c = c_inout
        nx = c[NX + lane]
        ny = c[NY + lane]
        a = c[a_line + lane]
        b = c[b_line + lane]
        old = c[impulse_line + lane]
        speed = vy * nx - vx * ny + (wb * b - wa * a) - c[SURFACE + lane]
        impulse = clamp(old - c[mass_line + lane] * speed, c[FRICTION + lane] * normal_impulse)
        c[impulse_line + lane] = impulse
        if sums:
            c[total_line + lane] += impulse
        change = impulse - old
        if rotation:
            wa -= c[II_A + lane] * a * change
            wb += c[II_B + lane] * b * change
        return change * -ny, change * nx, wa, wb

    return apply_friction


@inlined
def resist_rolling(lane, wa, wb, normal_impulse, c_inout):
    """Apply rolling resistance under a normal impulse. Return the angular velocities [1/s] after it."""
    c = c_inout
    old = c[ROLLING + lane]
    impulse = clamp(old - c[ROLLING_MASS + lane] * (wb - wa), c[ROLLING_LIMIT + lane] * normal_impulse)
    c[ROLLING + lane] = impulse
    return wa - c[II_A + lane] * (impulse - old), wb + c[II_B + lane] * (impulse - old)
