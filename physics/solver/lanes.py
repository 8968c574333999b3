"""The constraints of a group in lanes: rows of one colour side by side, each of their fields a line of its own.

Within a colour no two rows share a body that can be pushed, so any number of them can be solved at once; a compiler
makes vector instructions of a loop over the lanes of a block that has no branches. Lanes that are left over hold a row
that joins nothing to nothing. Sums are those of one row after the other, to the bit. Source: Catto, SIMD Matters, 2024.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.jit import JIT, subkernel
from physics.solver.pace import firmness_of
from physics.tables.lines import zeros_in_lines

# What is not compiled takes one row after the other. Measured: 16 are as fast in heaps, and slower in few boxes.
LANES = 8 if JIT else 1

# Where the lines of a block begin: what a row of CONSTRAINT says, and two of MOTION that last for the step.
(
    NX,
    NY,
    FRICTION,
    SURFACE,
    ROLLING_LIMIT,
    ROLLING_MASS,
    ROLLING,
    RADIUS_A,
    RADIUS_B,
    SHARE,
    CALM,
    RESTS,
    BIAS_RATE,
    GIVE,
    BLOW,
    COUPLE_1,
    COUPLE_2,
    SPLIT,
    AX_1,
    AY_1,
    BX_1,
    BY_1,
    BASE_1,
    MASS_1,
    TANGENT_MASS_1,
    NORMAL_1,
    TANGENT_1,
    TOTAL_1,
    TANGENT_TOTAL_1,
    AX_2,
    AY_2,
    BX_2,
    BY_2,
    BASE_2,
    MASS_2,
    TANGENT_MASS_2,
    NORMAL_2,
    TANGENT_2,
    TOTAL_2,
    TANGENT_TOTAL_2,
    IM_A,
    II_A,
    IM_B,
    II_B,
    GAP_1,
    GAP_2,
    SIZE,
) = (line * LANES for line in range(47))
# Where the lines begin that a pass gathers from the motions of one block after another. In an array of their own: among
# the others they were a quarter of what each pass has to read and to write.
(VX_A, VY_A, W_A, DX_A, DY_A, COS_A, SIN_A, VX_B, VY_B, W_B, DX_B, DY_B, COS_B, SIN_B, OUTCOME, GATHERED) = (
    line * LANES for line in range(16)
)
PRESSED, FREE = 1.0, 2.0  # outcomes of a lane: it bears or rests; it bears nothing, and is let out of its overlap


@subkernel
def pack_nothing(lane, c_out):
    """Write a row that joins nothing to nothing: no impulse comes of it."""
    for at in range(lane, SIZE, LANES):
        c_out[at] = 0.0


@subkernel
def gap_of(x, y, r):
    """How far two points that are (x, y) apart [px] are from each other along the normal of a CONSTRAINT row."""
    return x * r.normal_x + y * r.normal_y


@subkernel
def pack_row(r, a, b, pace, lane, c_out):
    """Write a CONSTRAINT row and the masses of its MOTION rows a, b into a lane; of one point the second is a
    copy that nothing can push."""
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
    c_out[SHARE + lane] = r.push_share
    c_out[CALM + lane] = 1.0 if r.calm else 0.0
    c_out[RESTS + lane] = 1.0 if r.rests else 0.0
    c_out[BIAS_RATE + lane] = spring.bias_rate
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
    # As the substeps begin nothing has moved; after that the relaxing pass measures.
    c_out[GAP_1 + lane] = r.radius_a + r.radius_b + r.base_1 + gap_of(r.bx_1 - r.ax_1, r.by_1 - r.ay_1, r)
    c_out[GAP_2 + lane] = c_out[GAP_1 + lane]
    if two:
        c_out[GAP_2 + lane] = r.radius_a + r.radius_b + r.base_2 + gap_of(r.bx_2 - r.ax_2, r.by_2 - r.ay_2, r)
    c_out[IM_A + lane] = a.inverse_mass
    c_out[II_A + lane] = a.inverse_inertia
    c_out[IM_B + lane] = b.inverse_mass
    c_out[II_B + lane] = b.inverse_inertia


class Blocks(NamedTuple):
    """Arrays for blocks of lanes."""

    row_of: np.ndarray  # (blocks, LANES) int32 the row in each lane, -1 for none
    motion_a: np.ndarray  # (blocks, LANES) uint32 its rows of MOTION, 0 for none
    motion_b: np.ndarray
    lines: np.ndarray  # SIZE numbers for each block
    gathered: np.ndarray  # GATHERED numbers: of the block that a pass is at


def make_blocks(count: int) -> Blocks:
    """Arrays for so many blocks."""
    lanes = (count, LANES)
    return Blocks(
        row_of=np.zeros(lanes, np.int32),
        motion_a=np.zeros(lanes, np.uint32),
        motion_b=np.zeros(lanes, np.uint32),
        lines=zeros_in_lines(count * SIZE, np.float64),
        gathered=zeros_in_lines(GATHERED, np.float64),
    )


def blocks_needed(rows: int, starts: np.ndarray) -> int:
    """How many blocks so many rows take at most; starts: see pack_rows."""
    return rows // LANES + len(starts) + int(starts[1] - starts[0])  # a colour's last block need not be full


@subkernel
def pack_rows(
    # read
    constraints,
    starts,
    motions,
    pace,
    # write
    blocks_out,
):
    """Write the rows of a group into blocks, each of one colour. Returns the number of blocks. O(constraints).

    starts (colours + 2) int64: where the rows of each colour begin, the colourless first, which stand in a block each,
    and where the last end.
    """
    found = 0
    for slot in range(len(starts) - 1):
        at = starts[slot] - starts[0]
        end = starts[slot + 1] - starts[0]
        while at < end:
            count = 1 if slot == 0 else min(LANES, end - at)
            c = blocks_out.lines[found * SIZE : (found + 1) * SIZE]
            for lane in range(LANES):
                i = at + lane if lane < count else -1
                blocks_out.row_of[found, lane] = i
                if i < 0:
                    blocks_out.motion_a[found, lane] = 0
                    blocks_out.motion_b[found, lane] = 0
                    pack_nothing(lane, c)
                else:
                    r = constraints[i]
                    blocks_out.motion_a[found, lane] = r.motion_a
                    blocks_out.motion_b[found, lane] = r.motion_b
                    pack_row(r, motions[r.motion_a], motions[r.motion_b], pace, lane, c)
            at += count
            found += 1
    return found


@subkernel
def unpack_rows(
    # read
    blocks,
    count,
    # write
    constraints_inout,
):
    """Write the impulses of so many blocks back to the rows. O(constraints)."""
    for block in range(count):
        c = blocks.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(LANES):
            i = blocks.row_of[block, lane]
            if i < 0:
                continue
            r = constraints_inout[i]
            r.normal_impulse_1 = c[NORMAL_1 + lane]
            r.tangent_impulse_1 = c[TANGENT_1 + lane]
            r.normal_total_1 = c[TOTAL_1 + lane]
            r.tangent_total_1 = c[TANGENT_TOTAL_1 + lane]
            r.rolling_impulse = c[ROLLING + lane]
            if r.count == 2:
                r.normal_impulse_2 = c[NORMAL_2 + lane]
                r.tangent_impulse_2 = c[TANGENT_2 + lane]
                r.normal_total_2 = c[TOTAL_2 + lane]
                r.tangent_total_2 = c[TANGENT_TOTAL_2 + lane]
