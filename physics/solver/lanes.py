"""Layout of contacts in SIMD lanes, the functions that fill lanes from CONTACT rows, and impulses in a lane."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from physics.jit import inlined, kernel, subkernel
from physics.jit.plain import JIT, Builtin, put_in
from physics.settings import COLORS, CROWD, ROCKING_TIME, STICKING_TURN
from physics.solver.step_context import restitution_threshold
from physics.tables.body import DYNAMIC, STATIC
from physics.tables.contact import UPRIGHT, WITH_A, WITH_B
from physics.tables.step_state import SOLVER_ROWS, TANGENT_ROWS
from physics.tables.table import zeros_in_lines

# ---- lanes -----------------------------------------------------------------------------------------------------------
# Contacts of a group in lanes: contacts of one colour side by side, each field contiguous.
#
# No two contacts of a colour share a dynamic body, so all of them can be solved at the same time. The compiler
# vectorises a loop over the lanes of a block if the loop has no branches. Unused lanes hold zeros, a contact without
# masses. The results are equal, to the bit, to solving one contact after another. Source: Catto, SIMD Matters, 2024.

# Plain Python solves one contact after another. Blocks of 16 lanes are as fast in heaps, and slower with few boxes.
LANES = 8 if JIT else 1

# Offsets of the fields of a block, in the order of their readers: only the pass with bias, both passes, only the
# relaxing pass, the passes before and after the substeps.
(
    PUSH_OUT_SHARE,  # factor on the push-out speed; negative: the sides did not approach before the step
    RESTING,  # 1: touched before the step, and was too slow to bounce; 0: not
    BIAS_RATE,  # [1/s] see Softness
    IMPULSE_SCALE,  # fraction of the accumulated impulse that a soft contact gives up in a substep
    STRIKE_LIMIT,  # impulse above which the contact counts as struck
    NX,  # unit normal
    NY,
    A_1,  # [px] moment arms of impulses along the normal, of both points, at the present poses
    B_1,
    A_2,
    B_2,
    MASS_1,  # effective masses along the normal; MASS_2 is 0 for a contact with one point
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
    BASE_1,  # [px] separation minus the distance of both points along the normal, minus both radii
    BASE_2,
    RADIUS_A,  # [px] distance of the surface from the core of the shape
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
    LOADED,  # 1: had a normal force at the end of the last step; 0: not
    BOUNCING,  # 1: the sides approached fast enough to bounce; 0: not
    PUSH_1,  # impulses of the pseudo-velocities, of sequential impulses
    PUSH_2,
    TURNS,  # how normal and arms follow the bodies in the step: FIXED, ARMS, NORMAL_OF_A, NORMAL_OF_B, NORMAL_OF_CORES
    START_NX,  # unit normal at the start of the step
    START_NY,
    LAST_NX,  # unit normal at the start of the substep, …
    LAST_NY,
    LAST_NORMAL,  # … and the sums of the impulses of both points before the relaxing pass along the present normal
    LAST_TANGENT,
    MOST,  # greatest normal impulse of a substep at one point
    SIZE,
) = (line * LANES for line in range(70))
FIXED = 0.0  # normal and moment arms of the start of the step are used
ARMS = 1.0  # moment arms rotate with the bodies
NORMAL_OF_A = 2.0  # arms rotate, and the normal rotates with a face of A, against the core of B
NORMAL_OF_B = 3.0  # arms rotate, and the normal rotates with a face of B, against the core of A
NORMAL_OF_CORES = 4.0  # arms rotate, and the normal points from core to core
# Offsets of the values that a pass gathers from the motions of each block. They are in a separate array of one block:
# as fields of each block they made up a quarter of the memory traffic of a pass.
(VX_A, VY_A, W_A, DX_A, DY_A, COS_A, SIN_A, VX_B, VY_B, W_B, DX_B, DY_B, COS_B, SIN_B, OUTCOME, GATHERED) = (
    line * LANES for line in range(16)
)
# Pseudo-velocities use the offsets of the poses, because no pass gathers both.
PUSH_VX_A, PUSH_VY_A, PUSH_W_A, PUSH_VX_B, PUSH_VY_B, PUSH_W_B = DX_A, DY_A, COS_A, DX_B, DY_B, COS_B
IN_CONTACT, UNLOADED = 1.0, 2.0  # summed in OUTCOME: the contact has an impulse or rests; it needs push-out


def _lanes_in_use(contacts, block):
    """Return how many lanes of a block hold a contact. The lanes in use come first. contacts: see Blocks.contact."""
    count = 0
    while count < LANES and contacts[block, count] >= 0:
        count += 1
    return count


def _make_all_lanes(count):
    def all_lanes(contacts, block):
        return count

    return all_lanes


ALL_LANES = _make_all_lanes(LANES)
# The compiled pass also solves empty lanes, whose results are 0: a loop with a fixed count vectorises.
lanes_of: Any = Builtin(_lanes_in_use, put_in(ALL_LANES), ALL_LANES) if JIT else _lanes_in_use


class Blocks(NamedTuple):
    """Arrays for contacts in blocks. A block has LANES lanes, and each lane holds the values of one contact."""

    contact: np.ndarray  # (blocks, LANES) int32 contact of each lane, -1 for none
    motion_a: np.ndarray  # (blocks, LANES) uint32 MOTION rows of the bodies of each contact, 0 for none
    motion_b: np.ndarray
    turns: np.ndarray  # (blocks) bool the block has a round contact whose moment arms turn in this step
    lines: np.ndarray  # SIZE numbers for each block
    gathered: np.ndarray  # GATHERED numbers of the current block of a pass
    block_of: np.ndarray  # (colours + 1) int64 block of the next contact: without a colour, then for each colour
    lane_of: np.ndarray  # (colours + 1) int64 lane of that contact


def make_blocks(count: int) -> Blocks:
    """Return Blocks with cleared arrays for `count` blocks."""
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
    """Return an upper bound on the blocks that contacts need. uncolored: how many contacts have no graph colour."""
    return contacts // LANES + COLORS + 1 + uncolored  # the last block of a colour may be partly empty


@subkernel
def lay_out(starts, blocks_out):
    """Assign blocks to the contacts of each graph colour, and clear the unused lanes. Return the number of blocks.

    starts (colours + 2) int64: index of the first contact of each slot, and finally the end of the last slot. Slot 0
    holds the contacts without a colour, which get one block each. Slot k + 1 holds the contacts of colour k. O(blocks).
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
    """Return the (block, lane) for the next contact of a slot, and advance the slot by one lane. slot: see lay_out."""
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
# ratios that are constant in a step, so the solver does not divide. Source: Catto, Modeling and Solving Constraints,
# GDC 2007 (block solver).

FLAT = 1e-3  # determinant relative to k_11 · k_22 below which the two points count as one


@inlined
def block_factor(off_diagonal_1, off_diagonal_2):
    """Return 1 / (1 - off_diagonal_1 · off_diagonal_2), or 0 if the two contact points nearly coincide.

    solve_two multiplies by this factor if both points have an impulse. off_diagonal_1, off_diagonal_2: see solve_two.
    """
    apart = 1.0 - off_diagonal_1 * off_diagonal_2
    return 1.0 / apart if apart > FLAT else 0.0


@inlined
def solve_two(change_1, change_2, off_diagonal_1, off_diagonal_2, factor, old_1, old_2):
    """Return the new accumulated normal impulses (>= 0) of two contact points that are solved together (block solver).

    Each point reaches its required velocity, or separates with impulse 0. change_1, change_2: change of impulse that
    each point needs if the other is unchanged. off_diagonal_1, off_diagonal_2: k_12 / k_11 and k_12 / k_22 of the
    matrix k of inverse effective masses. factor: see block_factor. old_1, old_2: impulses before. In the four cases
    both, either or no point has an impulse. All are computed, and one is selected without branches, for vectorisation.
    Point 2 is solved after point 1 if the points nearly coincide, or if no case fits because of rounding.
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
    """Copy the velocities of bodies A and B (MOTION rows a, b) to a lane of s_out. Layout of s_out: see GATHERED."""
    s_out[VX_A + lane] = a.vx
    s_out[VY_A + lane] = a.vy
    s_out[W_A + lane] = a.angular_velocity
    s_out[VX_B + lane] = b.vx
    s_out[VY_B + lane] = b.vy
    s_out[W_B + lane] = b.angular_velocity


@inlined
def gather_poses(a, b, lane, s_out):
    """Copy the displacements and rotations of MOTION rows a and b to a lane of s_out. Layout of s_out: see GATHERED."""
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
    """Write the velocities from a lane of the gathered values s back to bodies A and B (MOTION rows a_out, b_out)."""
    a_out.vx, a_out.vy = s[VX_A + lane], s[VY_A + lane]
    a_out.angular_velocity = s[W_A + lane]
    b_out.vx, b_out.vy = s[VX_B + lane], s[VY_B + lane]
    b_out.angular_velocity = s[W_B + lane]


@inlined
def measure_gaps(lane, s, c_inout):
    """Write the separations [px] of both points of a contact at the present poses to GAP_1 and GAP_2.

    The core of a rounded shape is the shape without its radius. Each point of the core rotates with its body. The
    surface stays one radius away from the core along the normal. s: gathered poses, see GATHERED. lane: lane of the
    contact in the block c_inout.
    """
    c = c_inout
    nx = c[NX + lane]
    ny = c[NY + lane]
    cos_a = s[COS_A + lane]
    sin_a = s[SIN_A + lane]
    cos_b = s[COS_B + lane]
    sin_b = s[SIN_B + lane]
    turn_c = nx * c[START_NX + lane] + ny * c[START_NY + lane]
    turn_s = ny * c[START_NX + lane] - nx * c[START_NY + lane]
    core = c[RADIUS_A + lane] * (cos_a * turn_c + sin_a * turn_s)
    core += c[RADIUS_B + lane] * (cos_b * turn_c + sin_b * turn_s)
    gap = core + (s[DX_B + lane] - s[DX_A + lane]) * nx + (s[DY_B + lane] - s[DY_A + lane]) * ny
    x = (cos_b * c[BX_1 + lane] - sin_b * c[BY_1 + lane]) - (cos_a * c[AX_1 + lane] - sin_a * c[AY_1 + lane])
    y = (sin_b * c[BX_1 + lane] + cos_b * c[BY_1 + lane]) - (sin_a * c[AX_1 + lane] + cos_a * c[AY_1 + lane])
    c[GAP_1 + lane] = gap + c[BASE_1 + lane] + (x * nx + y * ny)
    x = (cos_b * c[BX_2 + lane] - sin_b * c[BY_2 + lane]) - (cos_a * c[AX_2 + lane] - sin_a * c[AY_2 + lane])
    y = (sin_b * c[BX_2 + lane] + cos_b * c[BY_2 + lane]) - (sin_a * c[AX_2 + lane] + cos_a * c[AY_2 + lane])
    c[GAP_2 + lane] = gap + c[BASE_2 + lane] + (x * nx + y * ny)


@inlined
def arms_of(x, y, radius, cosine, sine, start_nx, start_ny, nx, ny):
    """Return the moment arms [px] of a contact point on a rotated body: (for normal impulses, for tangential impulses).

    x, y [px]: the point relative to the centre of mass, before the rotation by (cosine, sine). radius [px]: radius of
    the rounded shape, negative for body B. (start_nx, start_ny), (nx, ny): normal before and after the rotation.
    """
    x -= radius * start_nx
    y -= radius * start_ny
    u = cosine * x - sine * y
    v = sine * x + cosine * y
    return u * ny - v * nx, u * nx + v * ny + radius


@inlined
def write_arms(lane, cos_a, sin_a, cos_b, sin_b, c_inout):
    """Write the moment arms of both points of a contact to its lane, after the bodies have rotated in the step.

    (cos_a, sin_a), (cos_b, sin_b): rotations of A and B since the start of the step. The surface follows the rotated
    core of its shape, see measure_gaps. lane: lane of the contact in the block c_inout.
    """
    c = c_inout
    nx = c[NX + lane]
    ny = c[NY + lane]
    x = c[START_NX + lane]
    y = c[START_NY + lane]
    ra = c[RADIUS_A + lane]
    rb = -c[RADIUS_B + lane]
    c[A_1 + lane], c[TANGENT_A_1 + lane] = arms_of(c[AX_1 + lane], c[AY_1 + lane], ra, cos_a, sin_a, x, y, nx, ny)
    c[B_1 + lane], c[TANGENT_B_1 + lane] = arms_of(c[BX_1 + lane], c[BY_1 + lane], rb, cos_b, sin_b, x, y, nx, ny)
    c[A_2 + lane], c[TANGENT_A_2 + lane] = arms_of(c[AX_2 + lane], c[AY_2 + lane], ra, cos_a, sin_a, x, y, nx, ny)
    c[B_2 + lane], c[TANGENT_B_2 + lane] = arms_of(c[BX_2 + lane], c[BY_2 + lane], rb, cos_b, sin_b, x, y, nx, ny)


@inlined
def write_masses(lane, c_inout):
    """Compute the effective masses and block-solver factors of a lane of c_inout from its present moment arms."""
    c = c_inout
    masses = c[IM_A + lane] + c[IM_B + lane]
    ii_a, ii_b = c[II_A + lane], c[II_B + lane]
    two = c[MASS_2 + lane] > 0.0
    a_1, b_1 = c[A_1 + lane], c[B_1 + lane]
    a_2, b_2 = c[A_2 + lane], c[B_2 + lane]
    k_1 = masses + ii_a * a_1 * a_1 + ii_b * b_1 * b_1
    k_2 = masses + ii_a * a_2 * a_2 + ii_b * b_2 * b_2
    k_12 = masses + ii_a * a_1 * a_2 + ii_b * b_1 * b_2
    c[MASS_1 + lane] = 1.0 / k_1 if k_1 > 0.0 else 0.0
    c[MASS_2 + lane] = 1.0 / k_2 if two & (k_2 > 0.0) else 0.0
    c[OFF_DIAGONAL_1 + lane] = c[MASS_1 + lane] * k_12 if two else 0.0
    c[OFF_DIAGONAL_2 + lane] = c[MASS_2 + lane] * k_12 if two else 0.0
    c[BLOCK_FACTOR + lane] = block_factor(c[OFF_DIAGONAL_1 + lane], c[OFF_DIAGONAL_2 + lane]) if two else 0.0
    a_1, b_1 = c[TANGENT_A_1 + lane], c[TANGENT_B_1 + lane]
    a_2, b_2 = c[TANGENT_A_2 + lane], c[TANGENT_B_2 + lane]
    k_1 = masses + ii_a * a_1 * a_1 + ii_b * b_1 * b_1
    k_2 = masses + ii_a * a_2 * a_2 + ii_b * b_2 * b_2
    c[TANGENT_MASS_1 + lane] = 1.0 / k_1 if k_1 > 0.0 else 0.0
    c[TANGENT_MASS_2 + lane] = 1.0 / k_2 if two & (k_2 > 0.0) else 0.0


@inlined
def clamp(impulse, limit):
    """Return an impulse clamped to the range from -limit to limit."""
    impulse = impulse if impulse < limit else limit
    return impulse if impulse > -limit else -limit


def make_friction(second: bool, rotation: bool, sums: bool) -> Any:
    """Return a function that applies friction at one of the two points of a contact.

    second: True for the second point; rotation: whether bodies rotate; sums: whether to add up the impulses of a step.
    """
    a_line, b_line = (TANGENT_A_2, TANGENT_B_2) if second else (TANGENT_A_1, TANGENT_B_1)
    mass_line, impulse_line = (TANGENT_MASS_2, TANGENT_2) if second else (TANGENT_MASS_1, TANGENT_1)
    total_line = TANGENT_TOTAL_2 if second else TANGENT_TOTAL_1

    @inlined
    def apply_friction(lane, vx, vy, wa, wb, normal_impulse, c_inout):
        """Apply Coulomb friction at the point. Return (x, y of the change of impulse on B, new wa, new wb).

        vx, vy [px/s]: velocity of B's centre relative to A's centre. wa, wb [rad/s]: angular velocities of A and B.
        normal_impulse: accumulated normal impulse of the point, which limits the friction. lane: lane of the contact in
        the block c_inout.
        """
        c = c_inout
        nx, ny = c[NX + lane], c[NY + lane]
        a, b = c[a_line + lane], c[b_line + lane]
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
    """Apply rolling resistance to the bodies of a contact. Return the new angular velocities (wa, wb) [rad/s].

    lane: lane of the contact in the block c_inout; normal_impulse: sum over both points, which limits the resistance.
    """
    c = c_inout
    old = c[ROLLING + lane]
    impulse = clamp(old - c[ROLLING_MASS + lane] * (wb - wa), c[ROLLING_LIMIT + lane] * normal_impulse)
    c[ROLLING + lane] = impulse
    return wa - c[II_A + lane] * (impulse - old), wb + c[II_B + lane] * (impulse - old)


# ---- impulses --------------------------------------------------------------------------------------------------------
# Relative velocities of two MOTION rows at a contact point, and impulses between them.


@subkernel
def relative_speed(c, lane, second, a, b):
    """Return the speed [px/s] of B relative to A along the normal, at a point of a contact; negative: they approach.

    c: fields of a block of contacts; lane: lane of the contact; second: True for the second point; a, b: MOTION rows.
    """
    speed = (b.vx - a.vx) * c[NX + lane] + (b.vy - a.vy) * c[NY + lane]
    speed += b.angular_velocity * c[(B_2 if second else B_1) + lane]
    return speed - a.angular_velocity * c[(A_2 if second else A_1) + lane]


@subkernel
def push_pair(c, lane, second, impulse, a_inout, b_inout):
    """Apply a normal impulse to B at a contact point, and the opposite to A. c, lane, second: see relative_speed."""
    x, y = impulse * c[NX + lane], impulse * c[NY + lane]
    a_inout.vx -= a_inout.inverse_mass * x
    a_inout.vy -= a_inout.inverse_mass * y
    a_inout.angular_velocity -= a_inout.inverse_inertia * impulse * c[(A_2 if second else A_1) + lane]
    b_inout.vx += b_inout.inverse_mass * x
    b_inout.vy += b_inout.inverse_mass * y
    b_inout.angular_velocity += b_inout.inverse_inertia * impulse * c[(B_2 if second else B_1) + lane]


@subkernel
def tangential_speed(c, lane, second, a, b):
    """Return B's speed [px/s] relative to A along the tangent, minus the surface speed. See relative_speed."""
    speed = (b.vy - a.vy) * c[NX + lane] - (b.vx - a.vx) * c[NY + lane] - c[SURFACE + lane]
    speed += b.angular_velocity * c[(TANGENT_B_2 if second else TANGENT_B_1) + lane]
    return speed - a.angular_velocity * c[(TANGENT_A_2 if second else TANGENT_A_1) + lane]


@subkernel
def push_along(c, lane, second, impulse, a_inout, b_inout):
    """Apply a tangential impulse to B at a contact point, and the opposite to A. See relative_speed."""
    x, y = -impulse * c[NY + lane], impulse * c[NX + lane]
    a_inout.vx -= a_inout.inverse_mass * x
    a_inout.vy -= a_inout.inverse_mass * y
    a_inout.angular_velocity -= a_inout.inverse_inertia * impulse * c[(TANGENT_A_2 if second else TANGENT_A_1) + lane]
    b_inout.vx += b_inout.inverse_mass * x
    b_inout.vy += b_inout.inverse_mass * y
    b_inout.angular_velocity += b_inout.inverse_inertia * impulse * c[(TANGENT_B_2 if second else TANGENT_B_1) + lane]


# ---- prepare ---------------------------------------------------------------------------------------------------------
# Contacts are written into lanes before the substeps.
#
# Source of the arms and effective masses: Catto, Box2D v3, contact_solver.c. A lane holds moment arms from the centres
# of mass at the start of the step. The separation is computed from the motion of both sides since then. If two faces
# stick, the arms of the detection are kept: arms that rotate with a leaning column give its load a torque, and the
# column buckles (Catto, Box2D v3: contact recycling).

BOTH = (False, True)
TURNING = 1e-5  # [rad] rotation in a step above which the arms of a round contact follow its bodies


@subkernel
def touches_slowly(separation, speed, limits):
    """Return whether a contact point is within the slop, and its normal speed at most limits.impact_speed."""
    return separation <= limits.slop and abs(speed) <= limits.impact_speed


@subkernel
def limit_impulses(count, motions, squeeze, degrees, h, blocks_inout):
    """Limit the normal impulses of contacts in islands that are squeezed between static or kinematic faces. O(lanes).

    A body that does not move bears as much as all contacts of the pressed body. Its limit is in MOST. squeeze:
    SQUEEZE row of each MOTION row; degrees: number of contacts of each; count: number of blocks; h [s]: substep.
    """
    for block in range(count):
        c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks_inout.contact, block)):
            row_a, row_b = blocks_inout.motion_a[block, lane], blocks_inout.motion_b[block, lane]
            a, b = squeeze[row_a], squeeze[row_b]
            speed = max(a.speed, b.speed)
            if speed == 0.0:
                continue
            if not (motions[row_a].moves and motions[row_b].moves):
                pressed = row_b if motions[row_a].inverse_mass == 0.0 else row_a
                speed += max(a.static_speed, b.static_speed) * degrees[pressed]
            most = speed * max(c[MASS_1 + lane], c[MASS_2 + lane]) + h * max(a.force, b.force)
            c[MOST + lane] = most
            c[NORMAL_1 + lane], c[NORMAL_2 + lane] = min(c[NORMAL_1 + lane], most), min(c[NORMAL_2 + lane], most)


@inlined
def sticks(a, b, contact, distance):
    """Return whether a contact between two faces sticks, so that the normal and moment arms of its detection are kept.

    A contact sticks if it carries a load, neither shape is round, and neither body has rotated by more than
    STICKING_TURN since detection. The relative displacement of the centres must also be at most `distance` [px]. An
    unloaded contact never sticks, because its overlap has to be removed. a, b: BODY rows; contact: CONTACT row.
    """
    c = contact
    x, y = b.center_x - a.center_x - c.apart_x, b.center_y - a.center_y - c.apart_y
    return (
        c.count == 2
        and c.tangential_offset == 0.0
        and (c.normal_force_1 > 0.0 or c.normal_force_2 > 0.0)
        and c.radius_a == 0.0
        and c.radius_b == 0.0
        and abs(a.angle - c.angle_a) <= STICKING_TURN
        and abs(b.angle - c.angle_b) <= STICKING_TURN
        and x * x + y * y <= distance * distance
    )


DRIFT_SLOPS = 0.1  # [slops] greatest drift that friction undoes
GRIPPING = 0.99  # fraction of the limit of friction below which a contact does not slip


@inlined
def tangential_drift(a, b, contact):
    """Return the displacement [px] of B along the tangent of a sticking contact since detection. a, b: BODY rows."""
    c = contact
    x, y = b.center_x - a.center_x - c.apart_x, b.center_y - a.center_y - c.apart_y
    on_a = c.held_ax_1 * c.held_nx + c.held_ay_1 * c.held_ny
    on_b = on_a - (c.apart_x * c.held_nx + c.apart_y * c.held_ny)
    turned = (b.angle - c.angle_b) * on_b - (a.angle - c.angle_a) * on_a
    return y * c.held_nx - x * c.held_ny + turned


@inlined
def slips(contact):
    """Return whether the friction of a CONTACT row reached 99 % of its limit in the last step."""
    c = contact
    tangent = abs(c.tangent_force_1) + abs(c.tangent_force_2)
    return tangent >= GRIPPING * c.friction * (c.normal_force_1 + c.normal_force_2)


@inlined
def speed_of_drift(a, b, rate, slop, contact_inout):
    """Return the surface speed [px/s] that undoes the tangential drift of a sticking contact since its last slip.

    The solver's passes leave a small tangential speed. Without this correction a light plank under a heavy load creeps.
    A drift of more than DRIFT_SLOPS · slop [px] counts as a slip, and is not undone. a, b: BODY rows; rate [1/s]:
    fraction of the drift that is undone per second; contact_inout: CONTACT row, in which a slip is recorded.
    """
    c = contact_inout
    drift = tangential_drift(a, b, c)
    # The contact may have slid in the step in which it came to rest.
    slipped = slips(c) or abs(drift - c.slipped) > DRIFT_SLOPS * slop
    if slipped or c.slips:
        c.slipped = drift
    c.slips = slipped
    return -rate * (drift - c.slipped)


@inlined
def how_it_turns(contact, a, b, dt, lane, c):
    """Return how the solver updates the normal and arms of a contact within a step: FIXED, ARMS or NORMAL_OF_….

    The result is FIXED if no shape is round, the bodies (MOTION rows a, b) hardly rotate in dt [s], or the impact is
    elastic. Restitution uses the arms at the start of the step. c, lane: see relative_speed.
    """
    m = contact
    elastic = m.restitution > 0.0 and (c[LOADED + lane] == 0.0 or c[BOUNCING + lane] > 0.0)
    turn = dt * max(abs(a.angular_velocity), abs(b.angular_velocity))
    if elastic or (m.radius_a == 0.0 and m.radius_b == 0.0) or turn <= TURNING:
        return FIXED
    if m.count == 2 or m.frame == UPRIGHT:
        return ARMS
    return NORMAL_OF_A if m.frame == WITH_A else (NORMAL_OF_B if m.frame == WITH_B else NORMAL_OF_CORES)


@inlined
def rocks(body):
    """Return whether a BODY row may be kept from rocking: it is static, or has rocked in place for ROCKING_TIME."""
    return body.kind == STATIC or (body.kind == DYNAMIC and body.rocking_time >= ROCKING_TIME)


@inlined
def rolling_limit(contact, p, q, limits):
    """Return the greatest rolling-resistance torque per normal force [px]. p, q: BODY rows of the contact."""
    is_round = contact.radius_a > 0.0 or contact.radius_b > 0.0
    still = is_round and contact.friction > 0.0 and rocks(p) and rocks(q)
    return max(contact.rolling_resistance, limits.rocking_resistance if still else 0.0)


@inlined
def write_softness(contact, sticking, a, b, degrees, context, lane, c_out):
    """Write the fields of a lane that determine how softly its contact is pushed apart.

    The fields are PUSH_OUT_SHARE, BIAS_RATE, IMPULSE_SCALE, STRIKE_LIMIT, STIFFNESS, RESTING, LOADED and BOUNCING.
    sticking: result of sticks; a, b: MOTION rows; degrees: numbers of contacts of A and of B; context: see StepContext.
    """
    m = contact
    limits = context.limits
    degree_a, degree_b = degrees
    against_static = a.inverse_mass == 0.0 or b.inverse_mass == 0.0
    # Each dynamic side has at most two contacts: one below and one above.
    sole_support = sticking and (a.inverse_mass == 0.0 or degree_a <= 2) and (b.inverse_mass == 0.0 or degree_b <= 2)
    crowd = max(degree_a if a.inverse_mass > 0.0 else 0, degree_b if b.inverse_mass > 0.0 else 0)
    share = CROWD / crowd if crowd > CROWD else 1.0
    two = m.count == 2
    approaching = m.speed_1 > limits.calm_speed or (two and m.speed_2 > limits.calm_speed)
    loaded = m.normal_force_1 > 0.0 or (two and m.normal_force_2 > 0.0)
    bouncing = m.speed_1 > limits.impact_speed or (two and m.speed_2 > limits.impact_speed)
    resting = touches_slowly(m.separation_1, m.speed_1, limits) or (
        two and touches_slowly(m.separation_2, m.speed_2, limits)
    )
    # The heavier the load, the slower a contact oscillates: its spring may be stiffer with the same damping. A new
    # contact carries no load yet, so it keeps the softer spring.
    stiffness = 1.0
    if loaded and not bouncing:
        stiffness = context.sole_support_stiffness if sole_support else context.loaded_stiffness
    spring = context.static_spring if against_static else context.spring
    impulses = context.h * m.normal_force_1 + (context.h * m.normal_force_2 if two else 0.0)
    c = c_out
    c[PUSH_OUT_SHARE + lane] = share if approaching else -share
    c[RESTING + lane] = 1.0 if resting else 0.0
    c[BIAS_RATE + lane] = spring.bias_rate
    c[IMPULSE_SCALE + lane] = 1.0 / (1.0 + stiffness * spring.grip)
    c[STRIKE_LIMIT + lane] = context.strike_factor * impulses if loaded and not against_static else math.inf
    c[STIFFNESS + lane] = -stiffness if sole_support else stiffness
    c[LOADED + lane] = 1.0 if loaded else 0.0
    c[BOUNCING + lane] = 1.0 if bouncing else 0.0


def make_write_point(second: bool) -> Callable:
    """Return the function that writes one point of a contact into its lane. second: True for the second point."""
    arm_lines = (AX_2, AY_2, BX_2, BY_2) if second else (AX_1, AY_1, BX_1, BY_1)
    ax_line, ay_line, bx_line, by_line = arm_lines
    base_line, gap_line = (BASE_2, GAP_2) if second else (BASE_1, GAP_1)
    normal_line, tangent_line = (NORMAL_2, TANGENT_2) if second else (NORMAL_1, TANGENT_1)
    total_line, tangent_total_line = (TOTAL_2, TANGENT_TOTAL_2) if second else (TOTAL_1, TANGENT_TOTAL_1)

    @inlined
    def write_point(contact, p, q, sticking, h, lane, c_out):
        """Write the position and separation of the point, and its cached impulses for a substep of h [s].

        contact: CONTACT row; p, q: BODY rows of A and B; sticking: result of sticks.
        """
        m = contact
        c = c_out
        nx, ny = c[NX + lane], c[NY + lane]
        x = m.x_2 if second else m.x_1
        y = m.y_2 if second else m.y_1
        ax, ay = x - p.center_x, y - p.center_y
        bx = x - q.center_x + m.tangential_offset * ny  # the present position of B's point
        by = y - q.center_y - m.tangential_offset * nx
        if sticking:
            ax = m.held_ax_2 if second else m.held_ax_1
            ay = m.held_ay_2 if second else m.held_ay_1
            bx, by = ax - m.apart_x, ay - m.apart_y
        separation = m.separation_2 if second else m.separation_1
        base = separation - ((bx - ax) * nx + (by - ay) * ny) - (m.radius_a + m.radius_b)
        c[ax_line + lane] = ax
        c[ay_line + lane] = ay
        c[bx_line + lane] = bx
        c[by_line + lane] = by
        c[base_line + lane] = base
        # The gap at the start of the substeps; afterwards the relaxing pass measures it.
        c[gap_line + lane] = m.radius_a + m.radius_b + base + ((bx - ax) * nx + (by - ay) * ny)
        c[normal_line + lane] = h * (m.normal_force_2 if second else m.normal_force_1)
        c[tangent_line + lane] = h * (m.tangent_force_2 if second else m.tangent_force_1)
        c[total_line + lane] = 0.0
        c[tangent_total_line + lane] = 0.0

    return write_point


write_first, write_second = make_write_point(False), make_write_point(True)


@inlined
def copy_first(lane, c_inout):
    """Copy the first point of a contact with one point to the second point of its lane, with impulses of 0."""
    c = c_inout
    c[AX_2 + lane] = c[AX_1 + lane]
    c[AY_2 + lane] = c[AY_1 + lane]
    c[BX_2 + lane] = c[BX_1 + lane]
    c[BY_2 + lane] = c[BY_1 + lane]
    c[BASE_2 + lane] = c[BASE_1 + lane]
    c[GAP_2 + lane] = c[GAP_1 + lane]
    c[NORMAL_2 + lane] = 0.0
    c[TANGENT_2 + lane] = 0.0
    c[TOTAL_2 + lane] = 0.0
    c[TANGENT_TOTAL_2 + lane] = 0.0


@subkernel
def write_all_masses(count, blocks_inout):
    """Write moment arms and effective masses to all lanes of `count` blocks, in a loop that can be vectorised."""
    for block in range(count):
        c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks_inout.contact, block)):
            write_arms(lane, 1.0, 0.0, 1.0, 0.0, c)
            write_masses(lane, c)
            turning = c[II_A + lane] + c[II_B + lane]
            c[ROLLING_MASS + lane] = 1.0 / turning if turning > 0.0 else 0.0


def make_prepare_lanes(friction: bool, conveyor: bool) -> Callable:
    """Return the kernel that writes contacts into lanes. friction, conveyor: effects that the world has."""

    @kernel
    def prepare_lanes(bodies, motions, plan, group, context, contacts_inout, blocks_out, work_inout):
        """Write the contacts of a group into lanes. A block holds contacts of one colour. Return the number of blocks.

        plan, group: see contact_lanes.Plan and Group. O(edges). Contacts are read in memory order, which the processor
        prefetches. The blocks being filled, one for each colour, fit into its cache.
        """
        starts = group.starts
        count = lay_out(starts, blocks_out)
        for edge in range(group.edges):
            place = plan.places[edge]
            if place < starts[0] or place >= starts[len(starts) - 1]:
                continue  # of another group
            row = plan.edges.rows[edge]
            row_a = plan.edges.nodes[edge, 0]
            row_b = plan.edges.nodes[edge, 1]
            block, lane = next_lane(plan.colors[edge] + 1, blocks_out)
            blocks_out.contact[block, lane] = row
            blocks_out.motion_a[block, lane] = row_a
            blocks_out.motion_b[block, lane] = row_b
            c = blocks_out.lines[block * SIZE : (block + 1) * SIZE]
            m = contacts_inout[row]
            m.color = plan.colors[edge]
            a, b = motions[row_a], motions[row_b]
            p, q = bodies[m.body_row_a], bodies[m.body_row_b]
            sticking = sticks(p, q, m, context.limits.sticking)
            c[NX + lane] = m.held_nx if sticking else m.normal_x
            c[NY + lane] = m.held_ny if sticking else m.normal_y
            c[START_NX + lane], c[START_NY + lane] = c[NX + lane], c[NY + lane]
            c[IM_A + lane] = a.inverse_mass
            c[II_A + lane] = a.inverse_inertia
            c[IM_B + lane] = b.inverse_mass
            c[II_B + lane] = b.inverse_inertia
            c[RADIUS_A + lane] = m.radius_a
            c[RADIUS_B + lane] = m.radius_b
            degrees = (plan.degrees[row_a], plan.degrees[row_b])
            write_softness(m, sticking, a, b, degrees, context, lane, c)
            write_first(m, p, q, sticking, context.h, lane, c)
            if m.count == 2:
                write_second(m, p, q, sticking, context.h, lane, c)
            else:
                copy_first(lane, c)
            c[MASS_2 + lane] = 1.0 if m.count == 2 else 0.0
            c[TURNS + lane] = how_it_turns(m, a, b, context.dt, lane, c)
            blocks_out.turns[block] = blocks_out.turns[block] or c[TURNS + lane] != FIXED
            c[MOST + lane] = math.inf
            c[ROLLING_LIMIT + lane] = rolling_limit(m, p, q, context.limits) if friction else 0.0
            c[ROLLING + lane] = context.h * m.rolling_force
            c[SURFACE + lane] = m.surface_speed if conveyor else 0.0
            if sticking and friction and m.surface_speed == 0.0:
                c[SURFACE + lane] = speed_of_drift(p, q, context.drift_rate, context.slop, m)
            c[FRICTION + lane] = m.friction if friction else 0.0
            c[RESTITUTION + lane] = m.restitution
            c[THRESHOLD + lane] = restitution_threshold(m, a, b, degrees, context)
            c[LISTED + lane] = 0.0
            work_inout[SOLVER_ROWS] += m.count
            if friction and m.friction > 0.0:
                work_inout[TANGENT_ROWS] += m.count
        write_all_masses(count, blocks_out)
        if plan.squeezed[0]:
            limit_impulses(count, motions, plan.squeeze, plan.degrees, context.h, blocks_out)
        return count

    return prepare_lanes


PREPARE = {(f, c): make_prepare_lanes(friction=f, conveyor=c) for f in BOTH for c in BOTH}
