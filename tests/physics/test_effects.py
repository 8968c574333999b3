"""Only declared effects have stages, counters, tables and compiled kernels."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from physics import JIT, Circle, Effects, Material, PixelMask, Polygon, TileGrid, World

ROOT = Path(__file__).resolve().parents[2]
NEEDED = {
    "gravity": "integrate_velocities",
    "drag": "integrate_velocities",
    "wind": "integrate_velocities",
    "continuous": "time_of_impact",
    "response": "projection",
}


def test_a_stage_that_no_effect_needs_is_absent():
    assert World(Effects()).stages == [
        "motion_rectangles",
        "broad_phase",
        "integrate_positions",
        "narrow_phase",
        "events",
    ]
    for effect, stage in NEEDED.items():
        assert stage in World(Effects(**{effect: True})).stages and stage not in World(Effects()).stages
    blocking = World(Effects(response=True), solver="blocking")
    assert "blocking" in blocking.stages and "projection" not in blocking.stages
    blocking.solver = "projection"
    assert "projection" in blocking.stages and "blocking" not in blocking.stages
    assert list(blocking.profile.stages) == blocking.stages


def crowd(effects, steps=30, **options):
    """Return a world of bodies without friction, bounce, rotation, fast motion or gravity, so
    most effects are unused.
    """
    world = World(effects, gravity=(0, 0), **options)
    rng = np.random.default_rng(3)
    smooth = Material(friction=0.0, restitution=0.0)
    world.add_bodies(
        Circle(6.0), rng.uniform(0, 90, (25, 2)), rng.uniform(-40, 40, (25, 2)), material=smooth, fixed_rotation=True
    )
    world.add_bodies(
        PixelMask(np.ones((6, 5), bool)),
        rng.uniform(0, 90, (8, 2)),
        rng.uniform(-40, 40, (8, 2)),
        material=smooth,
        fixed_rotation=True,
    )
    world.add_body(TileGrid(np.ones((1, 6), bool), 16), position=(0, 95), kind="static", material=smooth)
    digests = []
    for _ in range(steps if JIT else 8):
        world.step()
        digests.append(world.digest())
    return world, digests


@pytest.mark.parametrize("base", [Effects(), Effects(response=True)], ids=["detection", "response"])
@pytest.mark.parametrize(
    "unused",
    ["gravity", "drag", "wind", "rotation", "continuous", "sensors", "persist", "friction", "restitution", "one_way"],
)
def test_an_effect_that_is_declared_and_not_used_changes_no_bit(base, unused):
    if unused in ("friction", "restitution", "one_way") and not base.response:
        pytest.skip("needs response")
    _, plain = crowd(base)
    _, more = crowd(base.with_(**{unused: True}))
    assert plain == more


def test_response_without_contacts_changes_no_bit():
    worlds = [World(effects, gravity=(0, 0)) for effects in (Effects(), Effects(response=True))]
    for world in worlds:
        world.add_bodies(Circle(2.0), [(0, 0), (50, 0)], [(3, 5), (-4, 2)])
        for _ in range(30):
            world.step()
    assert worlds[0].digest() == worlds[1].digest()


def counters_of(effects, build, steps=2, **options):
    world = World(effects, **options)
    build(world)
    for _ in range(steps):
        world.step()
    return world.profile.counters


def two_circles(world):
    world.add_bodies(Circle(5.0), [(0, 0), (8, 0)], [(20, 0), (-20, 0)])


def test_counters_of_what_is_not_declared_are_zero():
    used = counters_of(Effects(), two_circles)
    for name in (
        "toi_calls",
        "solver_rows",
        "tangent_rows",
        "restitution_rows",
        "mask_tests",
        "sensor_tests",
        "gjk_iterations",
        "joints_solved",
        "islands",
        "carved_pixels",
        "cap_hits",
    ):
        assert used[name] == 0, name
    assert used["narrow_tests"] == used["candidates"] == used["contacts"] == 1 and used["bodies_integrated"] == 2


def test_counters_follow_use_and_not_declaration():
    rough = Effects(response=True, friction=True, restitution=True, continuous=True, sensors=True, rotation=True)
    smooth = Material(friction=0.0)
    plain = counters_of(rough, lambda w: w.add_bodies(Circle(5.0), [(0, 0), (8, 0)], material=smooth), gravity=(0, 0))
    assert plain["tangent_rows"] == plain["restitution_rows"] == plain["toi_calls"] == plain["sensor_tests"] == 0
    assert plain["solver_rows"] > 0 and plain["mask_tests"] == 0
    rubbing = counters_of(
        rough, lambda w: w.add_bodies(Circle(5.0), [(0, 0), (8, 0)], [(300, 0), (0, 0)]), steps=1, gravity=(0, 0)
    )
    assert rubbing["tangent_rows"] > 0
    watched = counters_of(rough, lambda w: w.add_bodies(Circle(5.0), [(0, 0), (8, 0)], sensor=True), gravity=(0, 0))
    assert watched["sensor_tests"] == 1 and watched["solver_rows"] == 0
    masks = counters_of(Effects(), lambda w: w.add_bodies(PixelMask(np.ones((4, 4), bool)), [(0, 0), (2, 0), (90, 0)]))
    assert masks["mask_tests"] == 1


def test_every_counter_is_always_there():
    names = {
        "bodies_integrated",
        "nodes_visited",
        "pairs_tested",
        "candidates",
        "filtered",
        "narrow_tests",
        "mask_tests",
        "contacts",
        "toi_calls",
        "solver_rows",
        "tangent_rows",
        "restitution_rows",
        "gjk_iterations",
        "cap_hits",
        "sensor_tests",
        "joints_solved",
        "islands",
        "carved_pixels",
    }
    for world in (World(Effects()), World()):
        assert names <= set(world.profile.counters)
        assert all(isinstance(v, int) and v == 0 for v in world.profile.counters.values())


def test_shooter_without_solver_sees_the_same_hits_as_with_all_effects():
    lists = []
    for effects in (Effects(), Effects(sensors=True, persist=True, continuous=True, rotation=True)):
        world = World(effects)
        rng = np.random.default_rng(5)
        mask = PixelMask(rng.random((16, 12)) < 0.6)
        world.add_bodies(mask, rng.uniform(0, 200, (20, 2)), rng.uniform(-90, 90, (20, 2)), rng.uniform(0, 6, 20))
        events = []
        for step in range(60 if JIT else 12):
            world.step()
            events += [(step, "+", int(e["shape_a"]), int(e["shape_b"])) for e in world.events.begin]
            events += [(step, "-", int(e["shape_a"]), int(e["shape_b"])) for e in world.events.end]
        lists.append(events)
    assert lists[0] == lists[1] and len(lists[0]) > (5 if JIT else 0)


def test_boxes_alone_are_all_reported_in_the_step_in_which_the_table_grows():
    world = World(Effects(narrowphase=False))
    world.add_bodies(Circle(5.0), [(6.0 * k, 0.0) for k in range(100)])
    for _ in range(2):  # two tables take turns
        world.step()
        assert len(world.contacts) == 99


def test_presets_and_names():
    assert Effects.detection() == Effects() and Effects().names() == ["narrowphase"]
    assert Effects.rigid_bodies().response and World().effects == Effects.rigid_bodies()
    assert Effects().with_(gravity=True).gravity and not Effects().gravity
    with pytest.raises(Exception, match="cannot be changed"):
        Effects().gravity = True


SCRIPT = """
import json, sys
import numpy as np
from physics import *
from physics import jit
from physics.jit.tiers import parts_of
effects, masks = json.loads(sys.argv[1]), sys.argv[2] == "masks"
world = World(Effects(**effects), BruteForce())
shape = PixelMask(np.ones((4, 4), bool)) if masks else Circle(5.0)
world.add_bodies(shape, [(0, 0), (3, 0)], [(1, 0), (0, 0)])
world.step(); world.step()
compiled = {part for kernel in jit.registry if kernel.signatures for part in parts_of(kernel)}
print(json.dumps(sorted({each.py_func.__name__ for each in compiled})))
"""


def compiled(effects, shapes="circles"):
    found = subprocess.run(
        [sys.executable, "-c", SCRIPT, json.dumps(effects), shapes],
        cwd=ROOT,
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        timeout=300,
    )
    assert found.returncode == 0, found.stderr
    return set(json.loads(found.stdout))


@pytest.mark.skipif(not JIT, reason="nothing is compiled")
def test_kernels_of_absent_stages_are_not_compiled():
    lean = compiled({})
    assert "find_all" in lean and "collide_circle_pair" in lean
    for name in (
        "integrate_velocities",
        "project",
        "find_impacts",
        "stop_at_impacts",
        "stay_behind",
        "carry_and_push",
        "walk",
        "collide_mask_pair",
        "collide_polygon_pair",
        "collide_grid_pair",
        "find_pairs_in_trees",
        "find_in_cells",
        "sweep_one",
        "cast_candidates",
    ):
        assert name not in lean, name
    full = compiled({"response": True, "gravity": True, "continuous": True}, "masks")
    assert {"integrate_velocities", "project", "find_impacts"} <= full
    assert "collide_circle_pair" not in full and "walk" not in full


def test_polygons_in_a_mask_scene_and_masks_in_a_box_scene_cost_nothing():
    world = World(Effects())
    world.add_bodies(Polygon.box(4, 4), [(0, 0), (3, 0)])
    world.step()
    assert world.profile.counters["mask_tests"] == 0 and len(world.library.masks) == 0
