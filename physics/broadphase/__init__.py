"""The broad phases, which find the pairs of shapes whose AABBs overlap, and their selection by name."""

from typing import Any

from physics import checks
from physics.broadphase.brute_force import BruteForce
from physics.broadphase.dynamic_tree import DynamicTree
from physics.broadphase.proxies import Strategy
from physics.broadphase.spatial_hash import SpatialHashGrid
from physics.broadphase.sweep_and_prune import SweepAndPrune

STRATEGY_METHODS = ("find_pairs", "fresh", "update", "query")
BROADPHASES: dict[str, type[BruteForce | SweepAndPrune | SpatialHashGrid | DynamicTree]] = {
    "brute": BruteForce,
    "sweep": SweepAndPrune,
    "hash": SpatialHashGrid,
    "tree": DynamicTree,
}


def checked_broadphase(value: Any) -> Strategy:
    """Return a new, empty broad phase. value: a name in BROADPHASES, or a strategy object whose settings are copied.

    Raises TypeError for a class and for other values, ValueError for an unknown name.
    """
    if isinstance(value, str):
        return BROADPHASES[checks.choice("broadphase", value, tuple(BROADPHASES))]()
    if isinstance(value, type) or not all(hasattr(value, each) for each in STRATEGY_METHODS):
        hint = f": write {value.__name__}()" if isinstance(value, type) and value in BROADPHASES.values() else ""
        raise TypeError(
            f"broadphase must be one of {', '.join(BROADPHASES)}, or an instance of BruteForce, SweepAndPrune, "
            f"SpatialHashGrid or DynamicTree (got {checks.shown(value)}){hint}"
        )
    return value.fresh()
