"""Synchronous measurement of a scene's requests, for runs without a player."""

from game.measure.lanes import LaneFigures, measure_lanes
from game.measure.tiers import measure_tiers
from game.measure.timing import Cost
from game.scene import Scene
from game.wishes import Lanes, Sprites


def know(scene: Scene) -> None:
    """Measure the scene's requests that have no figures yet, and store the results in its `figures`."""
    wish = scene.measured()
    if isinstance(wish, Sprites) and not scene.figures:
        measure_tiers(*wish, lambda figures: scene.figures.update({figures.tier: figures}))
    if isinstance(wish, Lanes):
        names = [name for name in wish.names if name not in scene.figures]
        lanes, runs = [wish.make(name) for name in names], {}

        def take(number, spent, *seen):
            runs.setdefault(number, []).append(spent)
            steps = lanes[number].steps * len(lanes[number].snapshots)
            scene.figures[names[number]] = LaneFigures(Cost.of(runs[number], steps), *seen)

        measure_lanes(lanes, take, lambda: True)
