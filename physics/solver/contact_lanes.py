"""Contacts as constraints in lanes: blocks are filled from CONTACT rows, and their impulses stored there.

Source of the arms and effective masses: Catto, Box2D v3, contact_solver.c. A lane holds arms from the centres of mass
at the start of the step, and a separation that follows from the motion of both sides since. Where two faces stick, the
arms stay as they were at detection: arms that rotate with a leaning column give its load a torque, and the column
buckles (Catto, Box2D v3: contact recycling).
"""

import math
from collections.abc import Callable

from physics.jit import inlined, kernel, subkernel
from physics.settings import CROWD, STICKING_TURN
from physics.solver import lanes as at
from physics.solver.lanes import (
    LANES,
    SIZE,
    Blocks,
    blocks_needed,
    clamp,
    lanes_of,
    lay_out,
    make_blocks,
    next_lane,
    write_arms,
    write_masses,
)
from physics.solver.motions import Motions
from physics.solver.restitution import restore_bounces
from physics.solver.selection import Group, Selection, touches_slowly
from physics.solver.simultaneous_impacts import make_impacts, push_along
from physics.solver.squeeze import limit_impulses
from physics.solver.step_context import StepContext
from physics.tables.step_state import SOLVER_ROWS, TANGENT_ROWS, StepState

BOTH = (False, True)
TURNING = 1e-3  # [rad] turn in a step from which the moment arms of a round contact follow it

# ---- prepare ---------------------------------------------------------------------------------------------------------
# From contacts to lanes.


@inlined
def sticks(a, b, contact, distance):
    """Return whether two faces stick: normal and moment arms may stay as they were when the contact was found.

    They stick if they carry a load, neither shape is round, neither body (BODY rows) rotated by more than
    STICKING_TURN, and their centres moved relative to each other by no more than distance [px]. An unloaded contact
    never sticks, because it has to leave its overlap.
    """
    c = contact
    x = b.center_x - a.center_x - c.apart_x
    y = b.center_y - a.center_y - c.apart_y
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


NO_PRESS = 1e-9  # share of an acceleration below which its part along a normal is rounding


DRIFT_SLOPS = 0.1  # greatest drift that is taken back, in slops
GRIPPING = 0.99  # share of the limit of friction up to which a contact does not slip


@inlined
def tangential_drift(a, b, contact):
    """Return how far [px] B's side has moved along a sticking contact since it was found. a, b: BODY rows."""
    c = contact
    x = b.center_x - a.center_x - c.apart_x
    y = b.center_y - a.center_y - c.apart_y
    on_a = c.held_ax_1 * c.held_nx + c.held_ay_1 * c.held_ny
    on_b = on_a - (c.apart_x * c.held_nx + c.apart_y * c.held_ny)
    turned = (b.angle - c.angle_b) * on_b - (a.angle - c.angle_a) * on_a
    return y * c.held_nx - x * c.held_ny + turned


@inlined
def slips(contact):
    """Return whether friction was at its limit in the last step, up to a hundredth."""
    c = contact
    tangent = abs(c.tangent_force_1) + abs(c.tangent_force_2)
    return tangent >= GRIPPING * c.friction * (c.normal_force_1 + c.normal_force_2)


@inlined
def speed_of_drift(a, b, rate, slop, contact_inout):
    """Return the surface speed [px/s] that takes back the drift of a sticking contact since it slipped last.

    Without it a light plank under a heavy load wanders, because the passes leave some speed. A push that moves it
    further than a part of the slop [px] has moved it. a, b: BODY rows; rate: [1/s].
    """
    c = contact_inout
    drift = tangential_drift(a, b, c)
    # It may have slid in the step in which it came to rest.
    slipped = slips(c) or abs(drift - c.slipped) > DRIFT_SLOPS * slop
    if slipped or c.slips:
        c.slipped = drift
    c.slips = slipped
    return -rate * (drift - c.slipped)


@inlined
def arms_turn(contact, a, b, dt):
    """Return whether the moment arms of a contact follow its bodies, MOTION rows: it is round, and they turn."""
    is_round = contact.radius_a > 0.0 or contact.radius_b > 0.0
    return is_round and dt * max(abs(a.angular_velocity), abs(b.angular_velocity)) > TURNING


@inlined
def restitution_threshold(contact, a, b, degree_a, degree_b, context):
    """Return the approach speed [px/s] up to which a contact does not bounce.

    A new contact bounces at any speed if no acceleration presses its sides together: otherwise a slow ball would stick
    to a wall in space. One that touched in the step before bounces only beyond what acceleration adds in two steps.
    a, b: MOTION rows of its sides, with their numbers of constraints. Two bodies with other constraints do not fall
    together.
    """
    m = contact
    on_a = a.acceleration_x * m.normal_x + a.acceleration_y * m.normal_y
    on_b = -(b.acceleration_x * m.normal_x + b.acceleration_y * m.normal_y)
    least = NO_PRESS * (abs(a.acceleration_x) + abs(a.acceleration_y) + abs(b.acceleration_x) + abs(b.acceleration_y))
    together = degree_a <= 1 and degree_b <= 1 and a.inverse_mass > 0.0 and b.inverse_mass > 0.0
    press = on_a + on_b if together else max(on_a, 0.0) + max(on_b, 0.0)
    if m.touched:
        return max(context.restitution_speed, 2.0 * context.dt * press)
    return context.restitution_speed if press > least else 0.0


@inlined
def write_softness(contact, sticking, a, b, degree_a, degree_b, context, lane, c_out):
    """Write how a lane separates: its push-out share, spring and stiffness, and whether it rests, is loaded or bounces.

    a, b: MOTION rows of its sides, with their numbers of constraints.
    """
    m = contact
    limits = context.limits
    against_static = a.inverse_mass == 0.0 or b.inverse_mass == 0.0
    # One contact below and one above.
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
    # A loaded contact oscillates as slowly as its load is heavy, so its spring may be stiffer with the same damping. A
    # new contact may not.
    stiffness = 1.0
    if loaded and not bouncing:
        stiffness = context.sole_support_stiffness if sole_support else context.loaded_stiffness
    spring = context.static_spring if against_static else context.spring
    impulses = context.h * m.normal_force_1 + (context.h * m.normal_force_2 if two else 0.0)
    c = c_out
    c[at.PUSH_OUT_SHARE + lane] = share if approaching else -share
    c[at.RESTING + lane] = 1.0 if resting else 0.0
    c[at.BIAS_RATE + lane] = spring.bias_rate
    c[at.IMPULSE_SCALE + lane] = 1.0 / (1.0 + stiffness * spring.grip)
    c[at.STRIKE_LIMIT + lane] = context.strike_factor * impulses if loaded and not against_static else math.inf
    c[at.STIFFNESS + lane] = -stiffness if sole_support else stiffness
    c[at.LOADED + lane] = 1.0 if loaded else 0.0
    c[at.BOUNCING + lane] = 1.0 if bouncing else 0.0


def make_write_point(second: bool) -> Callable:
    """Return the function that writes the first or second point of a contact into a lane."""
    arm_lines = (at.AX_2, at.AY_2, at.BX_2, at.BY_2) if second else (at.AX_1, at.AY_1, at.BX_1, at.BY_1)
    ax_line, ay_line, bx_line, by_line = arm_lines
    base_line, gap_line = (at.BASE_2, at.GAP_2) if second else (at.BASE_1, at.GAP_1)
    normal_line, tangent_line = (at.NORMAL_2, at.TANGENT_2) if second else (at.NORMAL_1, at.TANGENT_1)
    total_line, tangent_total_line = (at.TOTAL_2, at.TANGENT_TOTAL_2) if second else (at.TOTAL_1, at.TANGENT_TOTAL_1)

    @inlined
    def write_point(contact, p, q, sticking, h, lane, c_out):
        """Write point, separation and the cached impulses for a substep of h [s]. p, q: BODY rows of the sides."""
        m = contact
        c = c_out
        nx = c[at.NX + lane]
        ny = c[at.NY + lane]
        x = m.x_2 if second else m.x_1
        y = m.y_2 if second else m.y_1
        ax = x - p.center_x
        ay = y - p.center_y
        bx = x - q.center_x + m.tangential_offset * ny  # the present position of B's point
        by = y - q.center_y - m.tangential_offset * nx
        if sticking:
            ax = m.held_ax_2 if second else m.held_ax_1
            ay = m.held_ay_2 if second else m.held_ay_1
            bx = ax - m.apart_x
            by = ay - m.apart_y
        separation = m.separation_2 if second else m.separation_1
        base = separation - ((bx - ax) * nx + (by - ay) * ny) - (m.radius_a + m.radius_b)
        c[ax_line + lane] = ax
        c[ay_line + lane] = ay
        c[bx_line + lane] = bx
        c[by_line + lane] = by
        c[base_line + lane] = base
        # At the start of the substeps nothing has moved; afterwards the relaxing pass measures.
        c[gap_line + lane] = m.radius_a + m.radius_b + base + ((bx - ax) * nx + (by - ay) * ny)
        c[normal_line + lane] = h * (m.normal_force_2 if second else m.normal_force_1)
        c[tangent_line + lane] = h * (m.tangent_force_2 if second else m.tangent_force_1)
        c[total_line + lane] = 0.0
        c[tangent_total_line + lane] = 0.0

    return write_point


write_first, write_second = make_write_point(False), make_write_point(True)


@inlined
def copy_first(lane, c_inout):
    """Write the second point of a contact with one: a copy of the first without effective mass."""
    c = c_inout
    c[at.AX_2 + lane] = c[at.AX_1 + lane]
    c[at.AY_2 + lane] = c[at.AY_1 + lane]
    c[at.BX_2 + lane] = c[at.BX_1 + lane]
    c[at.BY_2 + lane] = c[at.BY_1 + lane]
    c[at.BASE_2 + lane] = c[at.BASE_1 + lane]
    c[at.GAP_2 + lane] = c[at.GAP_1 + lane]
    c[at.NORMAL_2 + lane] = 0.0
    c[at.TANGENT_2 + lane] = 0.0
    c[at.TOTAL_2 + lane] = 0.0
    c[at.TANGENT_TOTAL_2 + lane] = 0.0


def make_prepare_lanes(friction: bool, conveyor: bool) -> Callable:
    """Return the pass from contacts to lanes for a world with these effects."""

    @kernel
    def prepare_lanes(
        # read
        bodies,
        motions,
        plan,
        group,
        context,
        # write
        contacts_inout,
        blocks_out,
        work_inout,
    ):
        """Write the contacts of a group into blocks of one colour each. Return the number of blocks. O(edges).

        Contacts are read in memory order, for the prefetcher of the processor; the open blocks of all colours fit into
        its cache.
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
            a = motions[row_a]
            b = motions[row_b]
            p = bodies[m.body_row_a]
            q = bodies[m.body_row_b]
            sticking = sticks(p, q, m, context.limits.sticking)
            c[at.NX + lane] = m.held_nx if sticking else m.normal_x
            c[at.NY + lane] = m.held_ny if sticking else m.normal_y
            c[at.IM_A + lane] = a.inverse_mass
            c[at.II_A + lane] = a.inverse_inertia
            c[at.IM_B + lane] = b.inverse_mass
            c[at.II_B + lane] = b.inverse_inertia
            c[at.RADIUS_A + lane] = m.radius_a
            c[at.RADIUS_B + lane] = m.radius_b
            write_softness(m, sticking, a, b, plan.degrees[row_a], plan.degrees[row_b], context, lane, c)
            write_first(m, p, q, sticking, context.h, lane, c)
            if m.count == 2:
                write_second(m, p, q, sticking, context.h, lane, c)
            else:
                copy_first(lane, c)
            c[at.MASS_2 + lane] = 1.0 if m.count == 2 else 0.0
            write_arms(lane, 1.0, 0.0, 1.0, 0.0, c)
            write_masses(lane, c)
            turns = arms_turn(m, a, b, context.dt)
            c[at.TURNS + lane] = 1.0 if turns else 0.0
            blocks_out.turns[block] = blocks_out.turns[block] or turns
            turning = a.inverse_inertia + b.inverse_inertia
            c[at.MOST + lane] = math.inf
            if plan.squeezed[0]:
                limit_impulses(a, b, plan.squeeze[row_a], plan.squeeze[row_b], context.h, lane, c)
            c[at.ROLLING_LIMIT + lane] = m.rolling_resistance if friction else 0.0
            c[at.ROLLING_MASS + lane] = 1.0 / turning if turning > 0.0 else 0.0
            c[at.ROLLING + lane] = context.h * m.rolling_force
            c[at.SURFACE + lane] = m.surface_speed if conveyor else 0.0
            if sticking and friction and m.surface_speed == 0.0:
                c[at.SURFACE + lane] = speed_of_drift(p, q, context.drift_rate, context.slop, m)
            c[at.FRICTION + lane] = m.friction if friction else 0.0
            c[at.RESTITUTION + lane] = m.restitution
            c[at.THRESHOLD + lane] = restitution_threshold(m, a, b, plan.degrees[row_a], plan.degrees[row_b], context)
            c[at.LISTED + lane] = 0.0
            work_inout[SOLVER_ROWS] += m.count
            if friction and m.friction > 0.0:
                work_inout[TANGENT_ROWS] += m.count
        return count

    return prepare_lanes


# ---- store -----------------------------------------------------------------------------------------------------------
# From lanes to contacts: restitution, the limit of friction, and the impulses.


@subkernel
def limit_friction(count, motions_inout, blocks_inout):
    """Remove friction beyond its share of the final normal impulse, over the step, of so many blocks. O(lanes)."""
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
def store_lanes(
    # read
    blocks,
    count,
    inverse_h,
    share,
    # write
    contacts_inout,
):
    """Write the impulses of the step, and the cached forces for the next one, back to the contacts. O(lanes).

    share: weight of this step in the cached forces. A step of a thousandth of the last one's length says little about
    forces: an impulse that stops a small motion in it would count as a thousand times the force in a step of usual
    length.
    """
    rest = 1.0 - share
    for block in range(count):
        s = blocks.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(LANES):
            i = blocks.contact[block, lane]
            if i < 0:
                continue
            c = contacts_inout[i]
            c.normal_impulse_1 = s[at.TOTAL_1 + lane]
            c.normal_impulse_2 = s[at.TOTAL_2 + lane]
            c.tangent_impulse_1 = s[at.TANGENT_TOTAL_1 + lane]
            c.tangent_impulse_2 = s[at.TANGENT_TOTAL_2 + lane]
            c.normal_force_1 = share * (inverse_h * s[at.NORMAL_1 + lane]) + rest * c.normal_force_1
            c.normal_force_2 = share * (inverse_h * s[at.NORMAL_2 + lane]) + rest * c.normal_force_2
            c.tangent_force_1 = share * (inverse_h * s[at.TANGENT_1 + lane]) + rest * c.tangent_force_1
            c.tangent_force_2 = share * (inverse_h * s[at.TANGENT_2 + lane]) + rest * c.tangent_force_2
            c.rolling_force = share * (inverse_h * s[at.ROLLING + lane]) + rest * c.rolling_force


def make_finish_lanes(restitution: bool, friction: bool) -> Callable:
    """Return the pass after the last substep in a world with these effects."""

    @kernel
    def finish_lanes(
        # read
        count,
        context,
        # write
        impacts_inout,
        motions_inout,
        blocks_inout,
        contacts_inout,
        work_inout,
    ):
        """Apply restitution, limit friction, and write the impulses of so many blocks back. O(lanes).

        impacts_inout: scratch, as long as the contacts.
        """
        if restitution:
            # The speeds of impacts are those at the start of the step, and so are the arms.
            for block in range(count):
                if blocks_inout.turns[block]:
                    c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
                    for lane in range(lanes_of(blocks_inout.contact, block)):
                        write_arms(lane, 1.0, 0.0, 1.0, 0.0, c)
                        write_masses(lane, c)
            restore_bounces(contacts_inout, count, context, impacts_inout, motions_inout, blocks_inout, work_inout)
        if friction:
            limit_friction(count, motions_inout, blocks_inout)
        store_lanes(blocks_inout, count, context.inverse_h, context.share, contacts_inout)

    return finish_lanes


PREPARE = {(f, c): make_prepare_lanes(friction=f, conveyor=c) for f in BOTH for c in BOTH}
FINISH = {(e, f): make_finish_lanes(restitution=e, friction=f) for e in BOTH for f in BOTH}


class ContactLanes:
    """The contacts of one world as constraints in lanes; its arrays grow and are reused."""

    def __init__(self) -> None:
        self.selection = Selection()
        self.blocks = make_blocks(0)
        self.impacts = make_impacts(16)

    def choose(self, state: StepState, motions: Motions, substeps: int) -> list[Group]:
        """Group the islands by substeps; 0: as many as each needs."""
        return self.selection.choose(state, motions, substeps)

    def prepare(self, state: StepState, motions: Motions, group: Group, context: StepContext) -> tuple[Blocks, int]:
        """Fill the lanes of a group. Return them, and the number of blocks."""
        needed = blocks_needed(group.count, group.uncolored)
        if len(self.blocks.contact) < needed:
            self.blocks = make_blocks(2 * needed)
        prepare = PREPARE[state.effects.friction, state.effects.conveyor]
        plan, contacts, blocks = self.selection.plan, state.contact_rows, self.blocks
        return blocks, prepare(state.bodies, motions.used, plan, group, context, contacts, blocks, state.work)

    def store(self, state: StepState, motions: Motions, count: int, context: StepContext) -> None:
        """Apply restitution, limit friction, and write the impulses of so many blocks back."""
        if len(self.impacts) < len(state.contact_rows):
            self.impacts = make_impacts(2 * len(state.contact_rows))
        finish = FINISH[state.effects.restitution, state.effects.friction]
        finish(count, context, self.impacts, motions.used, self.blocks, state.contact_rows, state.work)
