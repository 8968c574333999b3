"""Variants of the stacking solvers with one part repeated or omitted, to measure the effect of each part.

A variant is a stage to be passed to staged.stages_of(), where it replaces the stage of the solver. It cannot be chosen
as World.solver.
"""

from collections.abc import Mapping
from functools import cache, partial

from physics.solver.motions import READS, WRITES, run_solver
from physics.solver.sequential_impulse import solve as solve_in_passes
from physics.solver.soft_step import BOTH, make_substeps
from physics.solver.soft_step import solve as solve_in_substeps
from physics.tables.step_state import Stage, StepState, stage


def sequential_impulse(passes: int, warm: bool = True) -> Stage:
    """Return a variant of the sequential impulse solver with `passes` passes per step, as a stage.

    warm: False starts each step from zero impulses (no warm start).
    """
    solve = partial(solve_in_passes, passes=passes, warm=warm)

    @stage("sequential_impulse", reads=READS, writes=WRITES)
    def studied(state: StepState) -> None:
        run_solver(state, solve)

    return studied


def soft_step(iterations: int = 1, warm: bool = True, relaxed: bool = True) -> Stage:
    """Return a variant of the soft step solver with `iterations` solve passes per substep, as a stage.

    warm: False starts each substep from zero impulses (no warm start). relaxed: False omits the relax pass. The
    velocity that separates overlaps is then not removed, and friction is solved in the solve pass. Raises ValueError
    for relaxed=False with several iterations.
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
