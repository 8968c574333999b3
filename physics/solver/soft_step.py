"""Small substeps with soft contacts: each substep is solved once with a spring that pushes overlaps out, then relaxed.

Differs from `sequential_impulse` in that the step is cut into substeps of one pass each, and in that a loaded contact
gives way as a spring does. What bears nothing is let out of an overlap by speeds of its own, which are none of its
velocity. Cost per substep: three passes over the constraints, two over the bodies. Sources: Macklin et al., Small Steps
in Physics Simulation, SCA 2019; Catto, Soft Constraints, GDC 2011, and Solver2D, 2024: contacts as damped springs,
friction in the relaxing pass alone.
"""

from collections.abc import Callable, Mapping

from physics.jit import kernel
from physics.solver.contacts import ContactSet
from physics.solver.demand import ask_for_substeps
from physics.solver.lane_contacts import prepare, store
from physics.solver.motions import READS, SUBSTEP_POSITIONS, SUBSTEP_VELOCITIES, WRITES, move_driven, push_piles
from physics.solver.pace import pace_of
from physics.solver.soft_pass import PUSH_OUT, RELAX, WARM_LANES, forget_impulses, make_soft_pass
from physics.tables.step_state import StepState, stage

BOTH = (False, True)


def make_substeps(
    drag: bool, rotation: bool, friction: bool, iterations: int = 1, warm: bool = True, relaxed: bool = True
) -> Callable:
    """All substeps of a step in a world with these effects.

    What each part is worth is measured with others (studied.py): iterations: pushing passes in a substep; warm: each
    starts from the impulses of the one before; relaxed: not so, friction is in the pushing pass.
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
        """Advance the members by substeps under so many blocks of constraints, and what moves by hand beside them: rows
        of MOTION. O(substeps · (members + constraints)).

        pace: see Pace. One kernel for them all: with ten boxes five sixths of a substep were calls from Python.
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
    """Advance the motions by a step under the contacts, group by group. Returns the shortest substep [s]."""
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
    """Push and move the bodies of a world that stacks."""
    push_piles(state, solve)
