"""restore() also restores the settings of the world; a snapshot with another fixed setting is refused."""

import pytest

from physics import Circle, Effects, Polygon, Snapshot, World

SETTINGS = {
    "solver": "sequential_impulse",
    "dt": 1 / 240,
    "substeps": 7,
    "gravity": (3.0, 200.0),
    "drag": 0.25,
    "wind": (-40.0, 5.0),
}
WINDY = Effects.rigid_bodies().with_(wind=True, drag=True)


def filled(**settings):
    world = World(WINDY, **settings)
    world.add_body(Polygon.box(400, 20), position=(0, 100), kind="static")
    for k in range(6):
        world.add_body(Circle(8), position=(3 * k, 80 - 17 * k))
    for _ in range(20):
        world.step()
    return world


@pytest.mark.parametrize("through_a_file", [False, True])
def test_a_world_of_other_settings_goes_on_as_the_one_that_was_taken(tmp_path, through_a_file):
    first, other = filled(**SETTINGS), filled()
    taken, time = first.snapshot(), first.time
    if through_a_file:
        taken.save(tmp_path / "taken.npz")
        taken = Snapshot.load(tmp_path / "taken.npz")
    other.restore(taken)
    for name, value in SETTINGS.items():
        assert getattr(other, name) == value, name
    assert other.time == time
    for _ in range(60):
        first.step()
        other.step()
    assert other.digest() == first.digest() and other.bodies.tobytes() == first.bodies.tobytes()
    assert other.time == first.time


@pytest.mark.parametrize("name, value", SETTINGS.items())
def test_each_setting_that_was_changed_since_comes_back(name, value):
    world = filled()
    before, taken = getattr(world, name), world.snapshot()
    setattr(world, name, value)
    world.step()
    world.restore(taken)
    assert getattr(world, name) == before


def test_another_scale_is_refused_and_changes_nothing(tmp_path):
    metres, pixels = filled(pixels_per_meter=1.0), filled()
    before = pixels.digest(), pixels.bodies.tobytes(), pixels.gravity
    metres.snapshot().save(tmp_path / "metres.npz")
    for taken in (metres.snapshot(), Snapshot.load(tmp_path / "metres.npz")):
        with pytest.raises(ValueError, match=r"pixels_per_meter 1\.0 .*32\.0"):
            pixels.restore(taken)
    assert (pixels.digest(), pixels.bodies.tobytes(), pixels.gravity) == before


def test_a_snapshot_is_no_place_for_a_solver_that_its_effects_lack(tmp_path):
    world = World(Effects(response=True))
    taken = world.snapshot()
    taken.facts["solver"] = "soft_step"
    with pytest.raises(ValueError, match="solver"):
        world.restore(taken)
