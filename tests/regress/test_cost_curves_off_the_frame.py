"""lab/broadphases builds the worlds of its cost curve in the measuring process, not during a frame.

On the frame it took 32 ms for each layout.
"""

from game.measure.surveyor import Surveyor
from game.measurement_requests import Recipe, RunRequest
from physics import Snapshot, World
from scenes.lab.broadphases import Broadphases
from scenes.lab.layouts import populate


def test_no_world_is_made_for_the_curve_where_it_is_asked_for(monkeypatch):
    scene = Broadphases(seed=3)
    made = []
    monkeypatch.setattr("scenes.lab.layouts.populate", lambda *given: made.append(given))
    request = scene.measured()
    measured_runs = {name: request.make(name) for name in request.names}
    assert not made and all(
        isinstance(each, Recipe) for measured_run in measured_runs.values() for each in measured_run.snapshots
    )
    monkeypatch.undo()
    layout, size, strategy = request.names[1]
    (recipe,) = measured_runs[layout, size, strategy].snapshots
    world = World(scene.effects)
    populate(world, layout, size, 3)
    again = World(scene.effects)
    again.restore(recipe.make())
    assert isinstance(recipe.make(), Snapshot) and again.digest() == world.digest()


def test_the_process_that_measures_makes_them():
    surveyor = Surveyor()
    try:
        scene = Broadphases(seed=3)
        names = scene.measured().names[:2]
        surveyor.measure_runs(RunRequest(names, scene.measured().make))
        surveyor.wait(60.0)
        assert not surveyor.trouble and all(surveyor.knows(name) for name in names)
        assert all(surveyor.figures[name].cost.least > 0.0 for name in names)
    finally:
        surveyor.stop()
