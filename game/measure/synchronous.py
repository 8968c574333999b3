"""Measurement of a scene's requests in this process, which waits for the results.

This module is used in runs without a player.
"""

from game.measure.effect_totals import EffectTotal, choices_of, measure_totals
from game.measure.measured_runs import RunFigures, measure_runs
from game.measure.moment import Moment
from game.measure.tiers import measure_tiers
from game.measure.timing import Cost
from game.measurement_requests import RunRequest, SpriteRequest
from game.scene import Scene


def measure_requests(scene: Scene) -> None:
    """Make the measurements that the scene requests and that have no results yet.

    The results are stored in scene.figures. If the scene measures its effects, their times and bytes are stored in
    scene.totals.
    """
    request = scene.measured()
    if isinstance(request, SpriteRequest) and not scene.figures:
        measure_tiers(*request, lambda figures: scene.figures.update({figures.tier: figures}))
    if isinstance(request, RunRequest):
        names = [name for name in request.names if name not in scene.figures]
        measured_runs, runs = [request.make(name) for name in names], {}

        def take(number, spent, *seen):
            runs.setdefault(number, []).append(spent)
            steps = measured_runs[number].steps * len(measured_runs[number].snapshots)
            scene.figures[names[number]] = RunFigures(Cost.of(runs[number], steps), *seen)

        measure_runs(measured_runs, take, lambda: True)
    if scene.weighs_effects and not scene.totals:
        world = scene.weighed_world

        def take_total(name, values):
            scene.totals[name] = scene.totals.get(name, EffectTotal(0))._replace(**values)

        moment = Moment(world.snapshot(), world.broadphase.name)
        measure_totals(moment, choices_of(moment), take_total, lambda: True)
