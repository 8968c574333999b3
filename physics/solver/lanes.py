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
    AX_1,  # [px] moment arms of both points from the centres of mass
    AY_1,
    BX_1,
    BY_1,
    AX_2,
    AY_2,
    BX_2,
    BY_2,
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
    BASE_1,  # [px] separation minus the part of the arms
    BASE_2,
    RADIUS_A,  # [px] separations are measured from core to core
    RADIUS_B,
    ROLLING_LIMIT,  # [px] torque per normal impulse
    ROLLING_MASS,
    ROLLING,
    SURFACE,  # [px/s] surface speed
    TANGENT_MASS_1,
    TANGENT_MASS_2,
    TANGENT_1,
    TANGENT_2,
    FRICTION,
    TANGENT_TOTAL_1,
    TANGENT_TOTAL_2,
    RESTITUTION,
    STIFFNESS,  # factor on the stiffness; negative: the sole support of one side
    LOADED,  # 1: had an impulse in the step before; 0: not
    BOUNCING,  # 1: the sides approached fast enough to bounce; 0: not
    PUSH_1,  # impulses of the pseudo-velocities, of sequential impulses
    PUSH_2,
    MOST,  # greatest normal impulse of a substep at one point
    SIZE,
) = (line * LANES for line in range(53))
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
def moment_arms(c, lane):
    """Return the moment arms of both points for an impulse along the normal: a_1, b_1, a_2, b_2 [px]."""
    nx = c[NX + lane]
    ny = c[NY + lane]
    return (
        c[AX_1 + lane] * ny - c[AY_1 + lane] * nx,
        c[BX_1 + lane] * ny - c[BY_1 + lane] * nx,
        c[AX_2 + lane] * ny - c[AY_2 + lane] * nx,
        c[BX_2 + lane] * ny - c[BY_2 + lane] * nx,
    )


@inlined
def clamp(impulse, limit):
    """Return an impulse clamped to ± limit."""
    impulse = impulse if impulse < limit else limit
    return impulse if impulse > -limit else -limit


def make_friction(second: bool, rotation: bool, sums: bool) -> Any:
    """Return the friction at one point of a lane, in a world with this effect. sums: the step has several substeps."""
    ax_line, ay_line, bx_line, by_line = (AX_2, AY_2, BX_2, BY_2) if second else (AX_1, AY_1, BX_1, BY_1)
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
        ax = c[ax_line + lane]
        ay = c[ay_line + lane]
        bx = c[bx_line + lane]
        by = c[by_line + lane]
        old = c[impulse_line + lane]
        speed = (vx + (wa * ay - wb * by)) * -ny + (vy + (wb * bx - wa * ax)) * nx - c[SURFACE + lane]
        impulse = clamp(old - c[mass_line + lane] * speed, c[FRICTION + lane] * normal_impulse)
        c[impulse_line + lane] = impulse
        if sums:
            c[total_line + lane] += impulse
        x = (impulse - old) * -ny
        y = (impulse - old) * nx
        if rotation:
            wa -= c[II_A + lane] * (ax * y - ay * x)
            wb += c[II_B + lane] * (bx * y - by * x)
        return x, y, wa, wb

    return apply_friction


@inlined
def resist_rolling(lane, wa, wb, normal_impulse, c_inout):
    """Apply rolling resistance under a normal impulse. Return the angular velocities [1/s] after it."""
    c = c_inout
    old = c[ROLLING + lane]
    impulse = clamp(old - c[ROLLING_MASS + lane] * (wb - wa), c[ROLLING_LIMIT + lane] * normal_impulse)
    c[ROLLING + lane] = impulse
    return wa - c[II_A + lane] * (impulse - old), wb + c[II_B + lane] * (impulse - old)
