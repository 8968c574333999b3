"""Contact colours are reused while the contact graph is unchanged.

They always equal those of a new colouring.
"""

import numpy as np
import pytest

from physics import Circle, Effects, Polygon, World
from physics.solver.contact_lanes import new_plan, order_in_one_group
from physics.solver.motions import KINEMATIC_RANK, STATIC_RANK

EFFECTS = Effects.rigid_bodies()
SUBSTEPS = [1, 4, "auto", "both"]


def pile(substeps, seed):
    """Return a world with 30 boxes and discs that fall on ground and on a slow kinematic body.

    substeps: "both" stands for 4.
    """
    world, rng = World(EFFECTS, substeps=4 if substeps == "both" else substeps), np.random.default_rng(seed)
    world.add_body(Polygon.box(600, 20), position=(0, 200), kind="static")
    world.add_body(Polygon.box(60, 10), position=(0, 160), kind="kinematic", velocity=(8, 0))
    for k in range(30):
        shape = Polygon.box(20, 20) if rng.random() < 0.6 else Circle(10)
        world.add_body(shape, position=(22 * (k % 6) - 55, 140 - 22 * (k // 6)), angle=float(rng.choice([0.0, 0.3])))
    return world


def edit(world, rng):
    """Make one random change to a world in about a quarter of the calls: remove or add a body, or change a velocity."""
    action = rng.integers(12)
    ids = world.bodies["id"][world.bodies["kind"] == 2] if action < 3 else ()
    if action == 0 and len(ids):
        world.remove_body(int(rng.choice(ids)))
    elif action == 1:
        world.add_body(Circle(8), position=(float(rng.uniform(-80, 80)), -40))
    elif action == 2 and len(ids):
        world.body(int(rng.choice(ids))).velocity = tuple(rng.uniform(-200, 200, 2))


@pytest.mark.parametrize("substeps", SUBSTEPS)
@pytest.mark.parametrize("seed", range(10))
def test_a_world_that_keeps_colors_is_one_that_colors_anew_in_each_step(substeps, seed):
    kept, anew = pile(substeps, seed), pile(substeps, seed)
    choices = [np.random.default_rng(seed), np.random.default_rng(seed)]
    reused = 0
    for step in range(150):
        for world, rng in zip((kept, anew), choices, strict=True):
            if step > 60:
                edit(world, rng)
            if substeps == "both":
                world.substeps = "auto" if rng.random() < 0.2 else 4
        anew.workspace.contacts.selection.plan.colored[:] = 0
        plan = kept.workspace.contacts.selection.plan
        before = plan.colored.copy(), plan.edges.nodes.copy()
        for world in (kept, anew):
            world.step()
        plan = kept.workspace.contacts.selection.plan
        count = plan.colored[0]
        reused += np.array_equal(before[0], plan.colored) and np.array_equal(
            before[1][:count], plan.edges.nodes[:count]
        )
        assert kept.digest() == anew.digest(), f"step {step}"
    assert reused > 0  # the comparison has something to compare


@pytest.mark.parametrize("field", ["rank", "has_finite_mass"])
@pytest.mark.parametrize("seed", range(10))
def test_colors_follow_the_rank_and_the_mass_of_each_body(field, seed):
    """Colours are recomputed if a body becomes kinematic or static, although the contact graph is unchanged.

    The body gets infinite mass and, in half of the cases, another rank.
    """
    world, rng = pile(4, seed), np.random.default_rng(seed)
    for _ in range(40):
        world.step()
    motions, contacts, rows = world.workspace.motions, world.contact_rows, world.awake.bodies
    motions.lists.motion_of[rows] = np.arange(1, len(rows) + 1)  # as within a step
    args = (contacts, world.bodies, world.dt, world.tolerances.limits, motions.used, motions.lists)
    plan = new_plan(len(contacts) + 8, len(motions.used) + 8, 0)
    order_in_one_group(*args, plan)
    touched = np.unique(np.concatenate([contacts["body_row_a"], contacts["body_row_b"]]))
    moving = [row for row in motions.lists.motion_of[touched] if motions.lists.has_finite_mass[row]]
    assert len(moving) > 10
    for row in rng.permutation(moving):
        motions.lists.has_finite_mass[row] = False
        if field == "rank":
            motions.lists.rank[row] = rng.choice([KINEMATIC_RANK, STATIC_RANK])
        new = new_plan(len(contacts) + 8, len(motions.used) + 8, 0)
        found = [order_in_one_group(*args, each) for each in (plan, new)]
        assert found[0] == found[1]
        for name in ("colors", "places", "degrees", "starts"):
            assert np.array_equal(getattr(plan, name), getattr(new, name)), name
