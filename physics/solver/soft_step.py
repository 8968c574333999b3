"""Small substeps with soft contacts: the passes over lanes, and the solver made of them."""

from collections.abc import Callable, Mapping

from physics.jit import inlined, kernel, separate, subkernel
from physics.settings import BLOW_GIVE, CALM_SHARE
from physics.solver import lanes as at
from physics.solver.constraints import ContactSet
from physics.solver.contact_lanes import prepare, store
from physics.solver.lanes import (
    FREE,
    PRESSED,
    SIZE,
    gather_poses,
    gather_speeds,
    lanes_of,
    levers_of,
    measure_gaps,
    scatter_speeds,
)
from physics.solver.motions import READS, SUBSTEP_POSITIONS, SUBSTEP_VELOCITIES, WRITES, move_driven, push_piles
from physics.solver.restitution import solve_two
from physics.solver.step_context import pace_of, wanted_apart
from physics.solver.substeps import ask_for_substeps
from physics.tables.step_state import StepState, stage

# ---- soft pass -------------------------------------------------------------------------------------------------------
# Passes of the soft step over blocks of lanes; see lanes.py for the layout.
#
# The motions of a block are gathered, all of its lanes solved without a branch, and the motions scattered. Push-out by
# pseudo-velocity is rare and done lane by lane. Sources: see "soft step" below.

BOTH = (False, True)


@subkernel
def let_out_both(c, lane, pace, rotation, a_inout, b_inout):
    """Separate two bodies at the points of an unloaded lane, by pseudo-velocities.

    a_inout, b_inout: MOTION rows, with the velocities of the lane's solution.
    """
    nx = c[at.NX + lane]
    ny = c[at.NY + lane]
    a = a_inout
    b = b_inout
    a_1, b_1, a_2, b_2 = levers_of(c, lane)
    speed_1 = (b.vx - a.vx) * nx + (b.vy - a.vy) * ny
    speed_2 = speed_1
    k_12 = c[at.IM_A + lane] + c[at.IM_B + lane]
    if rotation:
        speed_1 += b.angular_velocity * b_1 - a.angular_velocity * a_1
        speed_2 += b.angular_velocity * b_2 - a.angular_velocity * a_2
        k_12 += c[at.II_A + lane] * a_1 * a_2 + c[at.II_B + lane] * b_1 * b_2
    pushed = (b.push_vx - a.push_vx) * nx + (b.push_vy - a.push_vy) * ny
    total = speed_1 + pushed
    if rotation:
        total += b.push_w * b_1 - a.push_w * a_1
    wanted = wanted_apart(c[at.GAP_1 + lane], pace.inverse_h, pace.slop, pace.push_rate, pace.push_speed)
    push_1 = max(c[at.MASS_1 + lane] * (wanted - total), 0.0)
    total = speed_2 + pushed + k_12 * push_1
    if rotation:
        total += b.push_w * b_2 - a.push_w * a_2
    wanted = wanted_apart(c[at.GAP_2 + lane], pace.inverse_h, pace.slop, pace.push_rate, pace.push_speed)
    push_2 = max(c[at.MASS_2 + lane] * (wanted - total), 0.0)
    if push_1 + push_2 > 0.0:
        x = (push_1 + push_2) * nx
        y = (push_1 + push_2) * ny
        a_inout.push_vx -= a.inverse_mass * x
        a_inout.push_vy -= a.inverse_mass * y
        b_inout.push_vx += b.inverse_mass * x
        b_inout.push_vy += b.inverse_mass * y
        if rotation:
            a_inout.push_w -= a.inverse_inertia * (push_1 * a_1 + push_2 * a_2)
            b_inout.push_w += b.inverse_inertia * (push_1 * b_1 + push_2 * b_2)


@inlined
def stopping(speed, gap, mass, inverse_h):
    """Return the change of an impulse that stops an approach; across a gap, that closes it exactly in this substep."""
    return -mass * (speed + gap * inverse_h if gap > 0.0 else speed)


@inlined
def springing(speed, gap, mass, old, bias_rate, give, most):
    """Return the change of an impulse of a soft contact without a dead zone.

    It separates at `most` [px/s] at most. bias_rate, give: see Softness.
    """
    grip = 1.0 - give
    bias = grip * bias_rate * gap
    bias = -most if bias < -most else bias
    return -mass * (grip * speed + bias) - give * old


@inlined
def most_of(c, lane, gap_1, gap_2, pace):
    """Return the greatest separation speed [px/s] of a lane.

    With many substeps a deep overlap separates as slowly as with the fewest; a shallow one may carry a load.
    """
    most = pace.push_speed * abs(c[at.SHARE + lane])
    deep = -gap_2 if gap_2 < gap_1 else -gap_1
    slow = pace.deep_rate * deep
    slow = slow if slow > pace.shallow_speed else pace.shallow_speed
    return slow if (pace.deep_rate > 0.0) & (slow < most) else most


@inlined
def within(impulse, limit):
    """Return an impulse clamped to ± limit."""
    impulse = impulse if impulse < limit else limit
    return impulse if impulse > -limit else -limit


def make_rub(second: bool, rotation: bool) -> Callable:
    """Return the friction at one point of a lane, in a world with this effect."""
    ax_line, ay_line, bx_line, by_line = (
        (at.AX_2, at.AY_2, at.BX_2, at.BY_2) if second else (at.AX_1, at.AY_1, at.BX_1, at.BY_1)
    )
    mass_line, impulse_line = (at.TANGENT_MASS_2, at.TANGENT_2) if second else (at.TANGENT_MASS_1, at.TANGENT_1)
    total_line = at.TANGENT_TOTAL_2 if second else at.TANGENT_TOTAL_1

    @inlined
    def rub(lane, vx, vy, wa, wb, normal_impulse, c_inout):
        """Apply friction under a normal impulse. Return the impulse x, y on B, and the angular velocities after it.

        vx, vy [px/s]: velocity of B's centre relative to A's. wa, wb [1/s]: angular velocities.
        """
        c = c_inout
        nx = c[at.NX + lane]
        ny = c[at.NY + lane]
        ax = c[ax_line + lane]
        ay = c[ay_line + lane]
        bx = c[bx_line + lane]
        by = c[by_line + lane]
        old = c[impulse_line + lane]
        speed = (vx + (wa * ay - wb * by)) * -ny + (vy + (wb * bx - wa * ax)) * nx - c[at.SURFACE + lane]
        impulse = within(old - c[mass_line + lane] * speed, c[at.FRICTION + lane] * normal_impulse)
        c[impulse_line + lane] = impulse
        c[total_line + lane] += impulse
        x = (impulse - old) * -ny
        y = (impulse - old) * nx
        if rotation:
            wa -= c[at.II_A + lane] * (ax * y - ay * x)
            wb += c[at.II_B + lane] * (bx * y - by * x)
        return x, y, wa, wb

    return rub


def make_warm_lanes(rotation: bool) -> Callable:
    """Return the pass over blocks that applies the impulses with which a substep starts."""

    @separate
    def warm_lanes(
        # read
        count,
        # write
        motions_inout,
        blocks_inout,
    ):
        """Apply the cached impulses of the lanes. O(count)."""
        s = blocks_inout.gathered
        for block in range(count):
            c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
            wide = lanes_of(blocks_inout.manifold, block)
            for lane in range(wide):
                gather_speeds(
                    motions_inout[blocks_inout.motion_a[block, lane]],
                    motions_inout[blocks_inout.motion_b[block, lane]],
                    lane,
                    s,
                )
            for lane in range(wide):
                nx = c[at.NX + lane]
                ny = c[at.NY + lane]
                x = c[at.NORMAL_1 + lane] * nx - c[at.TANGENT_1 + lane] * ny
                y = c[at.NORMAL_1 + lane] * ny + c[at.TANGENT_1 + lane] * nx
                u = c[at.NORMAL_2 + lane] * nx - c[at.TANGENT_2 + lane] * ny
                v = c[at.NORMAL_2 + lane] * ny + c[at.TANGENT_2 + lane] * nx
                if rotation:
                    a_turn = c[at.AX_1 + lane] * y - c[at.AY_1 + lane] * x + c[at.ROLLING + lane]
                    b_turn = c[at.BX_1 + lane] * y - c[at.BY_1 + lane] * x + c[at.ROLLING + lane]
                    a_turn += c[at.AX_2 + lane] * v - c[at.AY_2 + lane] * u
                    b_turn += c[at.BX_2 + lane] * v - c[at.BY_2 + lane] * u
                    s[at.W_A + lane] -= c[at.II_A + lane] * a_turn
                    s[at.W_B + lane] += c[at.II_B + lane] * b_turn
                s[at.VX_A + lane] -= c[at.IM_A + lane] * (x + u)
                s[at.VY_A + lane] -= c[at.IM_A + lane] * (y + v)
                s[at.VX_B + lane] += c[at.IM_B + lane] * (x + u)
                s[at.VY_B + lane] += c[at.IM_B + lane] * (y + v)
            for lane in range(wide):
                scatter_speeds(
                    s,
                    lane,
                    motions_inout[blocks_inout.motion_a[block, lane]],
                    motions_inout[blocks_inout.motion_b[block, lane]],
                )

    return warm_lanes


@subkernel
def forget_impulses(members, count, motions_inout, blocks_inout):
    """Start a substep without impulses, to measure the worth of warm starting. O(members + count)."""
    for i in range(len(members)):
        m = motions_inout[members[i]]
        m.free_vx = m.vx
        m.free_vy = m.vy
        m.free_w = m.angular_velocity
    for block in range(count):
        c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
        wide = lanes_of(blocks_inout.manifold, block)
        for lane in range(wide):
            c[at.NORMAL_1 + lane] = 0.0
            c[at.TANGENT_1 + lane] = 0.0
            c[at.NORMAL_2 + lane] = 0.0
            c[at.TANGENT_2 + lane] = 0.0
            c[at.ROLLING + lane] = 0.0


def make_soft_pass(biased: bool, rotation: bool, friction: bool, alone: bool = False) -> Callable:
    """Return one pass over blocks: with bias and without friction, or relaxing with friction where declared.

    alone: with bias, where no other pass relaxes, measures gaps, applies friction and sums impulses.
    """
    last = alone or not biased
    rubs = friction and last
    rub_1, rub_2 = make_rub(False, rotation), make_rub(True, rotation)

    @separate
    def solve_soft(
        # read, scalars
        count,
        pace,
        # write
        motions_inout,
        blocks_inout,
    ):
        """Solve every lane of so many blocks once. pace: see Pace. O(count)."""
        calm_speed = CALM_SHARE * pace.push_speed
        s = blocks_inout.gathered
        for block in range(count):
            c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
            wide = lanes_of(blocks_inout.manifold, block)
            for lane in range(wide):
                a = motions_inout[blocks_inout.motion_a[block, lane]]
                b = motions_inout[blocks_inout.motion_b[block, lane]]
                gather_speeds(a, b, lane, s)
                if last:
                    gather_poses(a, b, lane, s)
            for lane in range(wide):
                nx = c[at.NX + lane]
                ny = c[at.NY + lane]
                ii_a = c[at.II_A + lane]
                ii_b = c[at.II_B + lane]
                masses = c[at.IM_A + lane] + c[at.IM_B + lane]
                a_1, b_1, a_2, b_2 = levers_of(c, lane)
                if last:
                    measure_gaps(lane, s, c)
                gap_1 = c[at.GAP_1 + lane]
                gap_2 = c[at.GAP_2 + lane]
                wa = s[at.W_A + lane]
                wb = s[at.W_B + lane]
                vx = s[at.VX_B + lane] - s[at.VX_A + lane]
                vy = s[at.VY_B + lane] - s[at.VY_A + lane]
                speed_1 = vx * nx + vy * ny
                speed_2 = speed_1
                if rotation:
                    speed_1 += wb * b_1 - wa * a_1
                    speed_2 += wb * b_2 - wa * a_2
                old_1 = c[at.NORMAL_1 + lane]
                old_2 = c[at.NORMAL_2 + lane]
                mass_1 = c[at.MASS_1 + lane]
                mass_2 = c[at.MASS_2 + lane]
                change_1 = stopping(speed_1, gap_1, mass_1, pace.inverse_h)
                change_2 = stopping(speed_2, gap_2, mass_2, pace.inverse_h)
                free = False
                if biased:
                    # A soft contact would let a fast impact through, so a new contact is rigid first and soft
                    # afterwards.
                    bears = (old_1 > calm_speed * mass_1) | (old_2 > calm_speed * mass_2)
                    calm = (speed_1 >= -calm_speed) & (speed_2 >= -calm_speed)
                    rate = c[at.BIAS_RATE + lane]
                    give = c[at.GIVE + lane]
                    # An impact impulse that is kept whole from substep to substep returns as a bounce.
                    give = give + BLOW_GIVE if old_1 + old_2 > c[at.BLOW + lane] else give
                    most = most_of(c, lane, gap_1, gap_2, pace)
                    soft_1 = springing(speed_1, gap_1, mass_1, old_1, rate, give, most)
                    soft_2 = springing(speed_2, gap_2, mass_2, old_2, rate, give, most)
                    change_1 = soft_1 if (calm | bears) & (gap_1 <= 0.0) else change_1
                    change_2 = soft_2 if (calm | bears) & (gap_2 <= 0.0) else change_2
                    # An unloaded contact that is not new separates by pseudo-velocity, and gains no velocity.
                    free = calm & (not bears) & (c[at.SHARE + lane] < 0.0)
                else:
                    # A gap that closes is the task of the next substep.
                    borne = old_1 + old_2 + c[at.TOTAL_1 + lane] + c[at.TOTAL_2 + lane]
                    apart = (gap_1 > 0.0) & (gap_2 > 0.0) & (borne == 0.0)
                    change_1 = 0.0 if apart else change_1
                    change_2 = 0.0 if apart else change_2
                # Both points together, otherwise the first would rotate the body, and a box on its base would lean.
                impulse_1, impulse_2 = solve_two(
                    change_1, change_2, c[at.COUPLE_1 + lane], c[at.COUPLE_2 + lane], c[at.SPLIT + lane], old_1, old_2
                )
                impulse_1 = 0.0 if free else impulse_1
                impulse_2 = 0.0 if free else impulse_2
                c[at.NORMAL_1 + lane] = impulse_1
                c[at.NORMAL_2 + lane] = impulse_2
                if biased:
                    presses = (c[at.RESTS + lane] > 0.0) | (impulse_1 + impulse_2 > 0.0)
                    s[at.OUTCOME + lane] = (PRESSED if presses else 0.0) + (FREE if free else 0.0)
                if last:
                    c[at.TOTAL_1 + lane] += impulse_1
                    c[at.TOTAL_2 + lane] += impulse_2
                change = impulse_1 - old_1 + impulse_2 - old_2
                x = change * nx  # sums of the impulses on B
                y = change * ny
                vx += masses * x
                vy += masses * y
                if rotation:
                    wa -= ii_a * ((impulse_1 - old_1) * a_1 + (impulse_2 - old_2) * a_2)
                    wb += ii_b * ((impulse_1 - old_1) * b_1 + (impulse_2 - old_2) * b_2)
                # After the normal impulses: relaxing has removed the excess of the bias, which is no pressure.
                if rubs:
                    if rotation:
                        old = c[at.ROLLING + lane]
                        limit = c[at.ROLLING_LIMIT + lane] * (impulse_1 + impulse_2)
                        impulse = within(old - c[at.ROLLING_MASS + lane] * (wb - wa), limit)
                        c[at.ROLLING + lane] = impulse
                        wa -= ii_a * (impulse - old)
                        wb += ii_b * (impulse - old)
                    dx, dy, wa, wb = rub_1(lane, vx, vy, wa, wb, impulse_1, c)
                    vx += masses * dx
                    vy += masses * dy
                    dx_2, dy_2, wa, wb = rub_2(lane, vx, vy, wa, wb, impulse_2, c)
                    x = x + dx + dx_2
                    y = y + dy + dy_2
                s[at.VX_A + lane] -= c[at.IM_A + lane] * x
                s[at.VY_A + lane] -= c[at.IM_A + lane] * y
                s[at.VX_B + lane] += c[at.IM_B + lane] * x
                s[at.VY_B + lane] += c[at.IM_B + lane] * y
                if rotation:
                    s[at.W_A + lane] = wa
                    s[at.W_B + lane] = wb
            for lane in range(wide):
                a = motions_inout[blocks_inout.motion_a[block, lane]]
                b = motions_inout[blocks_inout.motion_b[block, lane]]
                if biased and s[at.OUTCOME + lane] > 0.0:
                    if s[at.OUTCOME + lane] >= FREE:
                        let_out_both(c, lane, pace, rotation, a, b)
                    if s[at.OUTCOME + lane] != FREE:
                        a.pressed = True
                        b.pressed = True
                scatter_speeds(s, lane, a, b)

    return solve_soft


PUSH_OUT = {r: make_soft_pass(biased=True, rotation=r, friction=False) for r in BOTH}
RELAX = {(r, f): make_soft_pass(biased=False, rotation=r, friction=f) for r in BOTH for f in BOTH}
WARM_LANES = {r: make_warm_lanes(rotation=r) for r in BOTH}


# ---- soft step -------------------------------------------------------------------------------------------------------
# Small substeps with soft contacts: each substep is solved once with a spring that separates overlaps, and then
# relaxed.
#
# It differs from `sequential_impulse` in that the step is cut into substeps of one pass each, and in that a loaded
# contact is a damped spring. Unloaded contacts separate by a pseudo-velocity. Cost per substep: three passes over the
# constraints, two over the bodies. Sources: Macklin et al., Small Steps in Physics Simulation, SCA 2019; Catto, Soft
# Constraints, GDC 2011, and Solver2D, 2024: contacts as damped springs, friction in the relaxing pass alone.


def make_substeps(
    drag: bool, rotation: bool, friction: bool, iterations: int = 1, warm: bool = True, relaxed: bool = True
) -> Callable:
    """Return all substeps of a step in a world with these effects.

    For measurements (studied_solvers.py): iterations: passes with bias in a substep; warm: whether each starts from the
    impulses of the one before; relaxed: whether a relaxing pass follows, otherwise friction is in the pass with bias.
    """
    velocities, positions = SUBSTEP_VELOCITIES[drag, rotation], SUBSTEP_POSITIONS[rotation]
    warm_start, push_out, relax = WARM_LANES[rotation], PUSH_OUT[rotation], RELAX[rotation, friction]
    if not relaxed:
        push_out = make_soft_pass(biased=True, rotation=rotation, friction=friction, alone=True)

    @kernel
    def run_substeps(
        # read
        members,
        driven,
        count,
        pace,
        # write
        motions_inout,
        blocks_inout,
    ):
        """Advance island bodies by substeps under so many blocks of constraints, and kinematic bodies beside them.

        pace: see Pace. Bodies are rows of MOTION. One kernel holds all substeps: with ten boxes five sixths of a
        substep were calls from Python. O(substeps · (members + constraints)).
        """
        h = pace.h
        move_driven(driven, 0.0, motions_inout)
        for n in range(pace.substeps):
            if not warm:
                forget_impulses(members, count, motions_inout, blocks_inout)
            velocities(members, h, pace.drag, motions_inout)
            if warm and n == 0:
                warm_start(count, motions_inout, blocks_inout)
            for _ in range(iterations):
                push_out(count, pace, motions_inout, blocks_inout)
            positions(members, h, pace.push_speed, motions_inout)
            move_driven(driven, (n + 1) * h, motions_inout)
            if relaxed:
                relax(count, pace, motions_inout, blocks_inout)

    return run_substeps


SUBSTEPS = {(d, r, f): make_substeps(drag=d, rotation=r, friction=f) for d in BOTH for r in BOTH for f in BOTH}


def solve(state: StepState, contacts: ContactSet, kernels: Mapping = SUBSTEPS) -> float:
    """Advance the motions by a step under the contacts, group by group. Return the shortest substep [s]."""
    effects, motions, tolerances, dt = state.effects, state.workspace.motions, state.tolerances, state.dt
    run, h = kernels[effects.drag, effects.rotation, effects.friction], dt
    asked = state.substeps == 0
    for group in contacts.choose(state, motions, state.substeps):
        pace = pace_of(
            group.substeps,
            asked,
            dt,
            state.span,
            state.drag,
            tolerances.push_speed,
            tolerances.slop,
            tolerances.speculative,
        )
        h = pace.h
        blocks, count = prepare(state, contacts, motions, group, pace)
        run(group.members, motions.driven, count, pace, motions.used, blocks)
        if asked:
            ask_for_substeps(state, motions, contacts.selection, group, blocks, count)
        store(state, contacts, motions, blocks, count, h)
    return h


@stage("soft_step", reads=READS, writes=WRITES)
def soft_step(state: StepState) -> None:
    """Solve the contacts and move the bodies of a world that stacks."""
    push_piles(state, solve)
