"""The stacking solvers with a part more often or left out, so that what each part is worth can be measured.

No world is set to any of these: a stage made here takes the place of the solver's own in a list of stages.
"""

from collections.abc import Mapping
from functools import cache, partial

from physics.solver.motions import READS, WRITES, push_piles
from physics.solver.sequential_impulse import solve as solve_in_passes
from physics.solver.soft_step import BOTH, make_substeps
from physics.solver.soft_step import solve as solve_in_substeps
from physics.tables.step_state import Stage, StepState, stage


def sequential_impulse(passes: int, warm: bool = True) -> Stage:
    """The stage with so many passes a step, which may start from no impulse (warm=False)."""
    solve = partial(solve_in_passes, passes=passes, warm=warm)

    @stage("sequential_impulse", reads=READS, writes=WRITES)
    def studied(state: StepState) -> None:
        push_piles(state, solve)

    return studied


def soft_step(iterations: int = 1, warm: bool = True, relaxed: bool = True) -> Stage:
    """The stage with so many pushing passes a substep; not warm: each substep starts from no impulse; not relaxed: what
    pushed overlaps out stays in the velocities, and friction is in the pushing pass. Raises ValueError for several
    passes that are not relaxed."""
    if iterations > 1 and not relaxed:
        raise ValueError(f"impulses are counted once: without relaxing there is one iteration (got {iterations})")
    solve = partial(solve_in_substeps, kernels=_kernels(iterations, warm, relaxed))

    @stage("soft_step", reads=READS, writes=WRITES)
    def studied(state: StepState) -> None:
        push_piles(state, solve)

    return studied


@cache
def _kernels(iterations: int, warm: bool, relaxed: bool) -> Mapping:
    return {(d, r, f): make_substeps(d, r, f, iterations, warm, relaxed) for d in BOTH for r in BOTH for f in BOTH}
