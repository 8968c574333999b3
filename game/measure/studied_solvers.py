"""Variants of the stacking solvers with a part repeated or left out, to measure the effect of each part.

A variant is a stage for staged.stages_of(), where it replaces the stage of the solver. A variant cannot be chosen by
name as World.solver.
"""

from collections.abc import Mapping
from functools import cache, partial

from physics.solver.motions import READS, WRITES, run_solver
from physics.solver.sequential_impulse import solve as solve_in_passes
from physics.solver.soft_step import BOTH, make_substeps
from physics.solver.soft_step import solve as solve_in_substeps
from physics.tables.step_state import Stage, StepState, stage


def sequential_impulse(passes: int, warm: bool = True) -> Stage:
    """Return a variant of sequential impulse with `passes` passes per step.

    warm: if False, each step starts from zero impulses.
    """
    solve = partial(solve_in_passes, passes=passes, warm=warm)

    @stage("sequential_impulse", reads=READS, writes=WRITES)
    def studied(state: StepState) -> None:
        run_solver(state, solve)

    return studied


def soft_step(iterations: int = 1, warm: bool = True, relaxed: bool = True) -> Stage:
    """Return a variant of soft step with `iterations` solve passes per substep.

    warm: if False, each substep starts from zero impulses. relaxed: if False, there is no relax pass, so the velocity
    that separates overlaps is kept, and friction is solved in the solve pass. Raises ValueError for relaxed=False with
    several iterations.
    """
    if iterations > 1 and not relaxed:
        raise ValueError(f"impulses are counted once: without relaxing there is one iteration (got {iterations})")
    solve = partial(solve_in_substeps, kernels=_kernels(iterations, warm, relaxed))

    @stage("soft_step", reads=READS, writes=WRITES)
    def studied(state: StepState) -> None:
        run_solver(state, solve)

    return studied


@cache
def _kernels(iterations: int, warm: bool, relaxed: bool) -> Mapping:
    return {
        (d, r, f, j): make_substeps(d, r, f, j, iterations, warm, relaxed)
        for d in BOTH
        for r in BOTH
        for f in BOTH
        for j in BOTH
    }
