"""Compilation in the background while the program runs: first the kernels of the played scene, then all others.

While a game runs, one core is not used for compilation.
"""

import contextlib
from collections.abc import Iterator

import physics
from game.errors import UsageError
from game.registry import Registry
from game.run.warmup import jobs_of
from game.scene import Scene
from physics.background import Background
from physics.jit.workers import cores_here


class Beside:
    """The background compiler. Kernels run as plain Python until they are compiled, so that the game does not wait.

    Compilation begins with start() or with the first turn(), which is called after the title is shown.
    """

    def __init__(self, registry: Registry, cores: int | None = None) -> None:
        self.cores = cores_here() if cores is None else cores
        self.scenes = self._all_scenes(registry)
        self.background: Background | None = None

    def _all_scenes(self, registry) -> Iterator[type[Scene]]:
        """Yield the scene classes one by one. Each class is imported when it is requested.

        Scenes with errors are skipped.
        """
        for name in registry.names:
            with contextlib.suppress(UsageError):
                yield registry.scene_class(name)

    def start(self, plays: bool = False) -> None:
        """Start compilation in the background, if it has not started.

        plays: True leaves one core to a running scene.
        """
        if self.background is None and physics.JIT:
            self.background = physics.compile_in_background(self.cores)
        if self.background is not None:
            self.background.workers.limit = max(1, self.cores - plays)

    def turn(self, plays: bool) -> None:
        """Continue compilation. Call this once per iteration of the program's loop.

        plays: whether a scene is on the screen. If so, one core is left to the scene, and no other scene is imported.
        """
        self.start(plays)
        if self.background is not None and not plays and (scene_class := next(self.scenes, None)) is not None:
            self.background.expect(jobs_of(scene_class))

    @property
    def share(self) -> float:
        """Share (0..1) of compiled kernels among the kernels called so far."""
        return 1.0 if self.background is None else self.background.share

    def stop(self) -> None:
        """End the compiler's processes. Compiled kernels remain usable."""
        if self.background is not None:
            self.background.stop()
            self.background = None
