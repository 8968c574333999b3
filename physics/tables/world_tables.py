"""WorldTables: what a world between steps and the StepState of a step both have."""

from typing import Any, Protocol

import numpy as np

from physics.settings import Tolerances


class WorldTables(Protocol):
    """For what is done to a world between steps, and in a step alike: falling asleep, waking, new rectangles.

    Any stands for what is defined in a folder to the right of this one.
    """

    manifolds: np.ndarray  # MANIFOLD rows
    anchors: np.ndarray  # ANCHOR rows beside them, in worlds that stack
    awake: Any  # dynamics.awake.Awake
    sleepers: Any  # dynamics.sleepers.Sleepers
    pairs: Any  # broadphase.pair_list.PairList
    touching: Any  # events.Pairs
    sensing: Any
    library: Any  # shapes.library.Library
    tolerances: Tolerances
    workspace: Any  # step.Workspace

    @property
    def bodies(self) -> np.ndarray:
        """BODY rows."""
        ...

    @property
    def shapes(self) -> np.ndarray:
        """SHAPE rows."""
        ...

    @property
    def effects(self) -> Any:
        """The declared Effects."""
        ...

    @property
    def stacks(self) -> bool:
        """Whether the solver is one whose contacts remember."""
        ...

    @property
    def gravity(self) -> tuple[float, float]:
        """[px/s2]."""
        ...

    @property
    def dt(self) -> float:
        """[s]."""
        ...
