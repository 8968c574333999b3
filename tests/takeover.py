"""Comparison of two runs of one scene: compiled, and with plain kernels that are replaced at random steps.

The plain kernels are replaced by their compiled forms. No process or thread is started for this: a form is loaded or
compiled between two steps. Both runs share the kernels of the process, so the compiled scene runs first and its digests
are stored.
"""

import random
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from physics.jit import compiling, tiers
from physics.jit.kernels import registry
from tests.lockstep import Diverged, Run, make_scene

SHARE_LEFT = 0.01  # of the kernels called in the first frame that still run plain in the last one


@contextmanager
def beginning_plain() -> Iterator[None]:
    """Start every kernel as plain Python without automatic replacement, until the end of the with block."""
    assert not tiers.background and not tiers.wanted and not tiers.arrived
    kept = {kernel: dict(kernel.forms) for kernel in registry}
    tiers.forget()
    tiers.start(lambda: None)
    try:
        yield
    finally:
        tiers.arrived.clear()
        tiers.stop()
        tiers.forget()
        for kernel, forms in kept.items():
            for keys, form in forms.items():
                kernel.install(keys, form)


class TakeOvers:
    """Replacement of plain kernels by their compiled forms at random.

    Before each frame, each compiled form that a kernel waits for is delivered with the probability `chance`.
    """

    def __init__(self, seed: int, chance: float) -> None:
        self.random, self.chance = random.Random(seed), chance
        self.frames: dict[str, int] = {}  # kernel -> frame before which its compiled form took over

    def before(self, frame: int) -> None:
        """Deliver some of the wanted compiled forms; the next World.step uses them."""
        for kernel, keys in list(tiers.wanted):
            if self.random.random() < self.chance:
                tiers.arrived.append((kernel, keys, compiling.load_or_compile(kernel, keys)))
                self.frames[kernel.name] = frame


def digests_of(run: Run, frames: int, before: Callable[[int], object] = lambda frame: None) -> Iterator[tuple]:
    """Yield (digest, list of the worlds' digests) after every frame; before(frame) is called before each frame."""
    for frame in range(1, frames + 1):
        before(frame)
        yield run.step(), [world.digest() for world in run.scene.worlds]


def compare_take_overs(name: str, frames: int, seed: int = 1, make: Callable = make_scene) -> TakeOvers:
    """Play a scene compiled, then with replacements at random steps. Raises Diverged at the first frame that differs.

    Returns the TakeOvers, whose `frames` say when each kernel was replaced. make(name) returns the scene.
    """
    wanted = list(digests_of(Run("compiled", make(name)), frames))
    overs = TakeOvers(seed, 1.0 - SHARE_LEFT ** (1.0 / frames))
    with beginning_plain():
        found = digests_of(Run("plain at first", make(name)), frames, overs.before)
        for frame, (one, two) in enumerate(zip(wanted, found, strict=True), 1):
            if one != two:
                worlds = [number for number, pair in enumerate(zip(one[1], two[1], strict=True)) if pair[0] != pair[1]]
                late = sorted(name for name, since in overs.frames.items() if since >= frame - 1)
                raise Diverged(
                    f"{name} with take-overs (seed {seed}) differs since frame {frame} in "
                    f"{f'worlds {worlds}' if worlds else 'what is beside its worlds'}: digest {two[0]}, not {one[0]}. "
                    f"Still plain: {', '.join(kernel.name for kernel, _ in tiers.wanted) or 'nothing'}; "
                    f"newly compiled: {', '.join(late) or 'nothing'}"
                )
    return overs
