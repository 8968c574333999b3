"""Contacts in lanes: blocks are filled from contacts, and their impulses stored.

A CONSTRAINT row exists only while its lane is filled: rows of ten thousand contacts, written and read again, exceed the
cache. Lanes with restitution, or with too much friction, become rows once more.
"""

from collections.abc import Callable

from physics.jit import kernel, subkernel
from physics.solver import lanes as at
from physics.solver.constraints import BOTH, PREPARE_ROW, ContactSet, Group, make_friction_limit
from physics.solver.lanes import LANES, SIZE, Blocks, lanes_of, lay_out, pack_row, repack_impulses, unpack_row
from physics.solver.motions import Motions
from physics.solver.restitution import restore_bounces
from physics.solver.step_context import Pace
from physics.tables.step_state import StepState


def make_prepare_lanes(friction: bool, conveyor: bool) -> Callable:
    """Return the pass from contacts to lanes for a world with these effects."""
    prepare_row = PREPARE_ROW[friction, conveyor]

    @kernel
    def prepare_lanes(
        # read
        bodies,
        motions,
        manifolds,
        plan,
        edges,
        starts,
        pace,
        limits,
        # write
        anchors_inout,
        constraints_inout,
        blocks_out,
        work_inout,
    ):
        """Write the contacts of a group, among so many edges, into blocks of one colour each. Return the number of
        blocks. O(edges).

        starts: see lay_out. constraints_inout: the first row is scratch. See prepare_row. Contacts are read in memory
        order, for the prefetcher of the processor; the open blocks of all colours fit into its cache.
        """
        count = lay_out(starts, blocks_out)
        r = constraints_inout[0]
        for edge in range(edges):
            place = plan.places[edge]
            if place < starts[0] or place >= starts[len(starts) - 1]:
                continue  # of another group
            slot = plan.colors[edge] + 1
            block = blocks_out.block_of[slot]
            lane = blocks_out.lane_of[slot]
            last = slot == 0 or lane == LANES - 1
            blocks_out.block_of[slot] = block + 1 if last else block
            blocks_out.lane_of[slot] = 0 if last else lane + 1
            prepare_row(bodies, motions, manifolds, plan, edge, pace.h, limits, anchors_inout, r, work_inout)
            blocks_out.manifold[block, lane] = r.manifold
            blocks_out.motion_a[block, lane] = r.motion_a
            blocks_out.motion_b[block, lane] = r.motion_b
            restitution = anchors_inout[r.manifold].restitution
            c = blocks_out.lines[block * SIZE : (block + 1) * SIZE]
            pack_row(r, motions[r.motion_a], motions[r.motion_b], restitution, pace, lane, c)
        return count

    return prepare_lanes


@subkernel
def take_out(blocks, block, lane, at_row, constraints_out):
    """Unpack a lane into a CONSTRAINT row, which stores the place of the lane."""
    r = constraints_out[at_row]
    r.manifold = blocks.manifold[block, lane]
    r.motion_a = blocks.motion_a[block, lane]
    r.motion_b = blocks.motion_b[block, lane]
    r.block = block
    r.lane = lane
    unpack_row(blocks.lines[block * SIZE : (block + 1) * SIZE], lane, r)


@subkernel
def take_elastic(blocks, count, constraints_out):
    """Unpack the lanes that may bounce and had an impulse in this step. Return their number. O(lanes)."""
    found = 0
    for block in range(count):
        c = blocks.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks.manifold, block)):
            if c[at.RESTITUTION + lane] > 0.0 and c[at.TOTAL_1 + lane] + c[at.TOTAL_2 + lane] > 0.0:
                take_out(blocks, block, lane, found, constraints_out)
                found += 1
    return found


@subkernel
def take_rubbed(blocks, count, constraints_out):
    """Unpack the lanes whose friction exceeds its share of the normal impulse. Return their number. O(lanes)."""
    found = 0
    for block in range(count):
        c = blocks.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks.manifold, block)):
            limit = c[at.FRICTION + lane]
            if (
                abs(c[at.TANGENT_TOTAL_1 + lane]) > limit * c[at.TOTAL_1 + lane]
                or abs(c[at.TANGENT_TOTAL_2 + lane]) > limit * c[at.TOTAL_2 + lane]
            ):
                take_out(blocks, block, lane, found, constraints_out)
                found += 1
    return found


@subkernel
def put_back(constraints, count, blocks_inout):
    """Write the impulses of unpacked rows back into their lanes."""
    for i in range(count):
        r = constraints[i]
        repack_impulses(r, r.lane, blocks_inout.lines[r.block * SIZE : (r.block + 1) * SIZE])


@subkernel
def store_lanes(
    # read
    blocks,
    count,
    inverse_h,
    share,
    # write
    manifolds_inout,
    anchors_inout,
):
    """Store the impulses of lanes, as constraints.store_impulses does of rows. O(lanes)."""
    rest = 1.0 - share
    for block in range(count):
        s = blocks.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(LANES):
            i = blocks.manifold[block, lane]
            if i < 0:
                continue
            m = manifolds_inout[i]
            c = anchors_inout[i]
            m.normal_impulse_1 = s[at.TOTAL_1 + lane]
            m.normal_impulse_2 = s[at.TOTAL_2 + lane]
            m.tangent_impulse_1 = s[at.TANGENT_TOTAL_1 + lane]
            m.tangent_impulse_2 = s[at.TANGENT_TOTAL_2 + lane]
            c.normal_force_1 = share * (inverse_h * s[at.NORMAL_1 + lane]) + rest * c.normal_force_1
            c.normal_force_2 = share * (inverse_h * s[at.NORMAL_2 + lane]) + rest * c.normal_force_2
            c.tangent_force_1 = share * (inverse_h * s[at.TANGENT_1 + lane]) + rest * c.tangent_force_1
            c.tangent_force_2 = share * (inverse_h * s[at.TANGENT_2 + lane]) + rest * c.tangent_force_2
            c.rolling_force = share * (inverse_h * s[at.ROLLING + lane]) + rest * c.rolling_force


def make_finish_lanes(restitution: bool, friction: bool, rotation: bool) -> Callable:
    """Return the pass after the last substep in a world with these effects."""
    limit_friction = make_friction_limit(rotation)

    @kernel
    def finish_lanes(
        # read
        count,
        threshold,
        dt,
        inverse_h,
        share,
        # write
        motions_inout,
        constraints_inout,
        blocks_inout,
        manifolds_inout,
        anchors_inout,
        work_inout,
    ):
        """Finish so many blocks, as constraints.finish_constraints does rows. O(lanes). constraints_inout: scratch."""
        if restitution:
            found = take_elastic(blocks_inout, count, constraints_inout)
            restore_bounces(
                manifolds_inout, anchors_inout, threshold, dt, found, motions_inout, constraints_inout, work_inout
            )
            put_back(constraints_inout, found, blocks_inout)
        if friction:
            found = take_rubbed(blocks_inout, count, constraints_inout)
            limit_friction(found, motions_inout, constraints_inout)
            put_back(constraints_inout, found, blocks_inout)
        store_lanes(blocks_inout, count, inverse_h, share, manifolds_inout, anchors_inout)

    return finish_lanes


PREPARE = {(f, c): make_prepare_lanes(friction=f, conveyor=c) for f in BOTH for c in BOTH}
FINISH = {(e, f, r): make_finish_lanes(restitution=e, friction=f, rotation=r) for e in BOTH for f in BOTH for r in BOTH}


def prepare(state: StepState, contacts: ContactSet, motions: Motions, group: Group, pace: Pace) -> tuple[Blocks, int]:
    """Fill the lanes of a group. Return them, and the number of blocks."""
    blocks = contacts.blocks(group)
    count = PREPARE[state.effects.friction, state.effects.conveyor](
        state.bodies,
        motions.used,
        state.contact_rows,
        contacts.selection.plan,
        contacts.selection.count,
        group.starts,
        pace,
        state.tolerances.limits,
        state.contact_rows,
        contacts.constraints,
        blocks,
        state.work,
    )
    return blocks, count


def store(state: StepState, contacts: ContactSet, motions: Motions, blocks: Blocks, count: int, h: float) -> None:
    """Apply restitution, limit friction, and write the impulses of so many blocks back."""
    effects, threshold = state.effects, state.tolerances.restitution_speed
    FINISH[effects.restitution, effects.friction, effects.rotation](
        count,
        threshold,
        state.dt,
        1.0 / h,
        state.dt / state.span,
        motions.used,
        contacts.constraints,
        blocks,
        state.contact_rows,
        state.contact_rows,
        state.work,
    )
