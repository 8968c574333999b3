"""Constraints in lanes: rows of one colour side by side, and the motions of their bodies."""

import math
from typing import Any, NamedTuple

import numpy as np

from physics.jit import inlined, subkernel
from physics.jit.plain import JIT, Builtin, put_in
from physics.settings import COLORS
from physics.solver.step_context import firmness_of
from physics.tables.table import zeros_in_lines

# ---- lanes -----------------------------------------------------------------------------------------------------------
# Constraints of a group in lanes: rows of one colour side by side, each field contiguous.
#
# No two rows of a colour share a dynamic body, so all of them can be solved at once. The compiler vectorises a loop
# over the lanes of a block that has no branches. Unused lanes hold a row between no bodies. The results equal those of
# one row after the other, to the bit. Source: Catto, SIMD Matters, 2024.

# The plain form solves one row after the other. Wide blocks are as fast in heaps, and slower with few boxes (measured
# with 16).
LANES = 8 if JIT else 1

# Offsets of the fields of a block: the values of a CONSTRAINT row and of its two MOTION rows that last for the step.
# They are ordered by readers: the pass with bias alone, both passes, the relaxing pass, and the substep estimate.
(
    SHARE,
    RESTS,
    BIAS_RATE,
    GIVE,
    BLOW,
    NX,
    NY,
    AX_1,
    AY_1,
    BX_1,
    BY_1,
    AX_2,
    AY_2,
    BX_2,
    BY_2,
    MASS_1,
    MASS_2,
    COUPLE_1,
    COUPLE_2,
    SPLIT,
    IM_A,
    II_A,
    IM_B,
    II_B,
    GAP_1,
    GAP_2,
    NORMAL_1,
    NORMAL_2,
    TOTAL_1,
    TOTAL_2,
    BASE_1,
    BASE_2,
    RADIUS_A,
    RADIUS_B,
    ROLLING_LIMIT,
    ROLLING_MASS,
    ROLLING,
    SURFACE,
    TANGENT_MASS_1,
    TANGENT_MASS_2,
    TANGENT_1,
    TANGENT_2,
    FRICTION,
    TANGENT_TOTAL_1,
    TANGENT_TOTAL_2,
    RESTITUTION,
    FIRMNESS,
    SIZE,
) = (line * LANES for line in range(48))
# Offsets of the values that a pass gathers from the motions of each block. They have an array of their own: among the
# others they were a quarter of the memory traffic of a pass.
(VX_A, VY_A, W_A, DX_A, DY_A, COS_A, SIN_A, VX_B, VY_B, W_B, DX_B, DY_B, COS_B, SIN_B, OUTCOME, GATHERED) = (
    line * LANES for line in range(16)
)
PRESSED, FREE = 1.0, 2.0  # outcomes of a lane: it bears or rests; it bears nothing, and is let out of its overlap


def _lanes_in_use(manifolds, block):
    """Return the number of lanes of a block in use, which are the first ones. The plain form skips the others."""
    count = 0
    while count < LANES and manifolds[block, count] >= 0:
        count += 1
    return count


def _make_all_lanes(count):
    def all_lanes(manifolds, block):
        return count

    return all_lanes


ALL_LANES = _make_all_lanes(LANES)
# The compiled pass also solves empty lanes, whose results are 0: a fixed count vectorises.
lanes_of: Any = Builtin(_lanes_in_use, put_in(ALL_LANES), ALL_LANES) if JIT else _lanes_in_use


@subkernel
def pack_nothing(lane, c_out):
    """Write a row between no bodies, which yields no impulse."""
    for at in range(lane, SIZE, LANES):
        c_out[at] = 0.0


@subkernel
def gap_of(x, y, r):
    """Return the distance along the normal of a CONSTRAINT row of two points that are (x, y) apart [px]."""
    return x * r.normal_x + y * r.normal_y


@inlined
def pack_row(r, a, b, restitution, pace, lane, c_out):
    """Write a CONSTRAINT row, the masses of its MOTION rows a, b and its restitution into a lane.

    With one point, the second is a copy without effective mass.
    """
    two = r.count == 2
    spring = pace.still_spring if r.still else pace.spring
    c_out[NX + lane] = r.normal_x
    c_out[NY + lane] = r.normal_y
    c_out[FRICTION + lane] = r.friction
    c_out[SURFACE + lane] = r.surface_speed
    c_out[ROLLING_LIMIT + lane] = r.rolling_limit
    c_out[ROLLING_MASS + lane] = r.rolling_mass
    c_out[ROLLING + lane] = r.rolling_impulse
    c_out[RADIUS_A + lane] = r.radius_a
    c_out[RADIUS_B + lane] = r.radius_b
    c_out[SHARE + lane] = -r.push_share if r.calm else r.push_share  # its sign: no approach before the step
    c_out[RESTS + lane] = 1.0 if r.rests else 0.0
    c_out[BIAS_RATE + lane] = spring.bias_rate
    firmness = firmness_of(r, pace)
    c_out[FIRMNESS + lane] = -firmness if r.alone else firmness  # its sign: see CONSTRAINT.alone
    c_out[GIVE + lane] = 1.0 / (1.0 + firmness_of(r, pace) * spring.grip)
    c_out[BLOW + lane] = pace.blow * (r.normal_impulse_1 + r.normal_impulse_2) if r.loaded and not r.still else math.inf
    c_out[COUPLE_1 + lane] = r.couple_1
    c_out[COUPLE_2 + lane] = r.couple_2
    c_out[SPLIT + lane] = r.split
    c_out[AX_1 + lane] = r.ax_1
    c_out[AY_1 + lane] = r.ay_1
    c_out[BX_1 + lane] = r.bx_1
    c_out[BY_1 + lane] = r.by_1
    c_out[BASE_1 + lane] = r.base_1
    c_out[MASS_1 + lane] = r.normal_mass_1
    c_out[TANGENT_MASS_1 + lane] = r.tangent_mass_1
    c_out[NORMAL_1 + lane] = r.normal_impulse_1
    c_out[TANGENT_1 + lane] = r.tangent_impulse_1
    c_out[TOTAL_1 + lane] = r.normal_total_1
    c_out[TANGENT_TOTAL_1 + lane] = r.tangent_total_1
    c_out[AX_2 + lane] = r.ax_2 if two else r.ax_1
    c_out[AY_2 + lane] = r.ay_2 if two else r.ay_1
    c_out[BX_2 + lane] = r.bx_2 if two else r.bx_1
    c_out[BY_2 + lane] = r.by_2 if two else r.by_1
    c_out[BASE_2 + lane] = r.base_2 if two else r.base_1
    c_out[MASS_2 + lane] = r.normal_mass_2 if two else 0.0
    c_out[TANGENT_MASS_2 + lane] = r.tangent_mass_2 if two else 0.0
    c_out[NORMAL_2 + lane] = r.normal_impulse_2
    c_out[TANGENT_2 + lane] = r.tangent_impulse_2
    c_out[TOTAL_2 + lane] = r.normal_total_2
    c_out[TANGENT_TOTAL_2 + lane] = r.tangent_total_2
    # At the start of the substeps nothing has moved; afterwards the relaxing pass measures.
    c_out[GAP_1 + lane] = r.radius_a + r.radius_b + r.base_1 + gap_of(r.bx_1 - r.ax_1, r.by_1 - r.ay_1, r)
    c_out[GAP_2 + lane] = c_out[GAP_1 + lane]
    if two:
        c_out[GAP_2 + lane] = r.radius_a + r.radius_b + r.base_2 + gap_of(r.bx_2 - r.ax_2, r.by_2 - r.ay_2, r)
    c_out[IM_A + lane] = a.inverse_mass
    c_out[II_A + lane] = a.inverse_inertia
    c_out[IM_B + lane] = b.inverse_mass
    c_out[II_B + lane] = b.inverse_inertia
    c_out[RESTITUTION + lane] = restitution


@subkernel
def unpack_row(c, lane, row_out):
    """Write the arms, masses and impulses of a lane into a CONSTRAINT row."""
    r = row_out
    r.count = 2 if c[MASS_2 + lane] > 0.0 else 1
    r.still = c[IM_A + lane] == 0.0 or c[IM_B + lane] == 0.0
    r.rests = c[RESTS + lane] > 0.0
    r.normal_x = c[NX + lane]
    r.normal_y = c[NY + lane]
    r.friction = c[FRICTION + lane]
    r.couple_1 = c[COUPLE_1 + lane]
    r.couple_2 = c[COUPLE_2 + lane]
    r.split = c[SPLIT + lane]
    r.ax_1 = c[AX_1 + lane]
    r.ay_1 = c[AY_1 + lane]
    r.bx_1 = c[BX_1 + lane]
    r.by_1 = c[BY_1 + lane]
    r.ax_2 = c[AX_2 + lane]
    r.ay_2 = c[AY_2 + lane]
    r.bx_2 = c[BX_2 + lane]
    r.by_2 = c[BY_2 + lane]
    r.normal_mass_1 = c[MASS_1 + lane]
    r.normal_mass_2 = c[MASS_2 + lane]
    r.normal_impulse_1 = c[NORMAL_1 + lane]
    r.normal_impulse_2 = c[NORMAL_2 + lane]
    r.tangent_impulse_1 = c[TANGENT_1 + lane]
    r.tangent_impulse_2 = c[TANGENT_2 + lane]
    r.normal_total_1 = c[TOTAL_1 + lane]
    r.normal_total_2 = c[TOTAL_2 + lane]
    r.tangent_total_1 = c[TANGENT_TOTAL_1 + lane]
    r.tangent_total_2 = c[TANGENT_TOTAL_2 + lane]


@subkernel
def repack_impulses(r, lane, c_out):
    """Write the impulses of a CONSTRAINT row back into its lane."""
    c_out[NORMAL_1 + lane] = r.normal_impulse_1
    c_out[NORMAL_2 + lane] = r.normal_impulse_2
    c_out[TANGENT_1 + lane] = r.tangent_impulse_1
    c_out[TANGENT_2 + lane] = r.tangent_impulse_2
    c_out[TOTAL_1 + lane] = r.normal_total_1
    c_out[TOTAL_2 + lane] = r.normal_total_2
    c_out[TANGENT_TOTAL_1 + lane] = r.tangent_total_1
    c_out[TANGENT_TOTAL_2 + lane] = r.tangent_total_2


class Blocks(NamedTuple):
    """Arrays for blocks of lanes."""

    manifold: np.ndarray  # (blocks, LANES) int32 manifold of each lane, -1 for none
    motion_a: np.ndarray  # (blocks, LANES) uint32 its rows of MOTION, 0 for none
    motion_b: np.ndarray
    lines: np.ndarray  # SIZE numbers for each block
    gathered: np.ndarray  # GATHERED numbers of the current block of a pass
    block_of: np.ndarray  # (colours + 1) place of the next row of each colour, rows without a colour first
    lane_of: np.ndarray


def make_blocks(count: int) -> Blocks:
    """Return arrays for so many blocks."""
    lanes = (count, LANES)
    return Blocks(
        manifold=np.zeros(lanes, np.int32),
        motion_a=np.zeros(lanes, np.uint32),
        motion_b=np.zeros(lanes, np.uint32),
        lines=zeros_in_lines(count * SIZE, np.float64),
        gathered=zeros_in_lines(GATHERED, np.float64),
        block_of=np.zeros(COLORS + 1, np.int64),
        lane_of=np.zeros(COLORS + 1, np.int64),
    )


def blocks_needed(rows: int, loose: int) -> int:
    """Return the greatest number of blocks of so many rows, of which so many have no colour."""
    return rows // LANES + COLORS + 1 + loose  # the last block of a colour may be partly empty


@subkernel
def lay_out(starts, blocks_out):
    """Assign blocks to the rows of each colour, and empty the unused lanes. Return the number of blocks. O(blocks).

    starts (colours + 2) int64: the first row of each colour, rows without a colour first, and the end of the last
    colour. A row without a colour has a block of its own.
    """
    found = 0
    for slot in range(len(starts) - 1):
        blocks_out.block_of[slot] = found
        blocks_out.lane_of[slot] = 0
        wide = 1 if slot == 0 else LANES
        left = starts[slot + 1] - starts[slot]
        while left > 0:
            for lane in range(min(left, wide), LANES):
                blocks_out.manifold[found, lane] = -1
                blocks_out.motion_a[found, lane] = 0
                blocks_out.motion_b[found, lane] = 0
                pack_nothing(lane, blocks_out.lines[found * SIZE : (found + 1) * SIZE])
            left -= wide
            found += 1
    return found


# ---- lane motions ----------------------------------------------------------------------------------------------------
# Motions of lanes: gathering from the MOTION rows of a block, separations, and scattering.


@inlined
def gather_speeds(a, b, lane, s_out):
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
def scatter_speeds(s, lane, a_out, b_out):
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
def levers_of(c, lane):
    """Return the moment arms of both points for an impulse along the normal: a_1, b_1, a_2, b_2 [px]."""
    nx = c[NX + lane]
    ny = c[NY + lane]
    return (
        c[AX_1 + lane] * ny - c[AY_1 + lane] * nx,
        c[BX_1 + lane] * ny - c[BY_1 + lane] * nx,
        c[AX_2 + lane] * ny - c[AY_2 + lane] * nx,
        c[BX_2 + lane] * ny - c[BY_2 + lane] * nx,
    )
