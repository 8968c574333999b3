"""Worlds edited in every way between steps raise no error and give equal digests with every broad phase."""

import numpy as np
import pytest

from physics import (
    DYNAMIC,
    JIT,
    BruteForce,
    Capsule,
    Character,
    Circle,
    DynamicTree,
    Effects,
    Filter,
    PixelMask,
    Polygon,
    SpatialHashGrid,
    SweepAndPrune,
    TileGrid,
    World,
)

ROUNDS = 60 if JIT else 15


def any_shape(rng):
    width, height = rng.uniform(6.0, 24.0, 2)
    made = (
        lambda: Circle(width / 2.0),
        lambda: Polygon.box(width, height),
        lambda: Polygon([(-width, 0), (0, -height), (width, 0)], radius=1.0),
        lambda: Capsule((-width / 2.0, 0), (width / 2.0, 0), 4.0),
        lambda: PixelMask(rng.random((int(height), int(width))) < 0.8),
    )
    return made[rng.integers(len(made))]()


class Editor:
    """A world with ground, a lift, a sensor zone and a character, to which random edits are applied."""

    def __init__(self, seed, broadphase):
        self.rng = np.random.default_rng(seed)
        effects = Effects.rigid_bodies().with_(one_way=bool(seed % 2), conveyor=seed % 3 == 0, sensors=True)
        self.world = world = World(effects, broadphase)
        world.add_body(Polygon.box(600, 20), position=(0, 110), kind="static")
        world.add_body(TileGrid(np.ones((2, 10), bool), 16.0), position=(-200, 90), kind="static")
        self.lift = world.add_body(Polygon.box(80, 8), position=(100, 60), kind="kinematic")
        world.add_body(Polygon.box(200, 80), position=(0, 80), kind="static", sensor=True)
        self.hero = Character(world, Circle(6) if seed % 2 else Polygon.box(10, 14), (-60, 60))
        self.kept = world.snapshot()
        self.edits = [getattr(self, name) for name in sorted(dir(self)) if name.startswith("edit_")]

    def edit(self):
        """Apply one random edit to a random body, then make 1 to 5 steps."""
        ids = [each for each in self.world.bodies["id"].tolist() if each != self.hero.body.id]
        self.edits[self.rng.integers(len(self.edits))](self.world.body(int(self.rng.choice(ids))), ids)
        for _ in range(self.rng.integers(1, 6)):
            self.world.step()
        assert np.isfinite(self.world.bodies["x"]).all()

    def place(self):
        return tuple(self.rng.uniform((-150.0, -210.0), (150.0, 90.0)))

    def edit_add(self, body, ids):
        self.world.add_body(any_shape(self.rng), position=self.place(), angle=float(self.rng.uniform(0.0, 3.0)))

    def edit_remove(self, body, ids):
        if len(ids) > 6:
            self.world.remove_body(body)

    def edit_place(self, body, ids):
        body.move_to(self.place())

    def edit_velocity(self, body, ids):
        if body.kind == "dynamic":
            body.velocity = tuple(self.rng.uniform(-300.0, 300.0, 2))

    def edit_kind(self, body, ids):
        if not any(isinstance(each, TileGrid) for each in body.shapes):
            body.set_kind(str(self.rng.choice(["static", "kinematic", "dynamic"])))

    def edit_shapes(self, body, ids):
        if not any(isinstance(each, TileGrid) for each in body.shapes):
            body.set_shapes(any_shape(self.rng))

    def edit_filter(self, body, ids):
        body.filter = Filter(int(self.rng.integers(1, 4)), int(self.rng.integers(1, 4)))

    def edit_touch(self, body, ids):
        self.world.touch(self.rng.choice(ids, min(3, len(ids)), replace=False).tolist())

    def edit_gravity(self, body, ids):
        self.world.gravity = (float(self.rng.uniform(-50.0, 50.0)), 313.6)

    def edit_lift(self, body, ids):
        if self.lift.id in ids and self.lift.kind == "kinematic":
            self.lift.velocity = (0.0, float(self.rng.uniform(-40.0, 40.0)))

    def edit_snapshot(self, body, ids):
        self.kept = self.world.snapshot()

    def edit_restore(self, body, ids):
        self.world.restore(self.kept)

    def edit_solver(self, body, ids):
        self.world.solver = str(self.rng.choice(["soft_step", "sequential_impulse", "projection"]))

    def edit_hero(self, body, ids):
        self.hero.move(float(self.rng.uniform(-4.0, 4.0)), float(self.rng.uniform(-3.0, 6.0)))

    def edit_spoil(self, body, ids):
        row = self.world.rows([body.id])[0]
        if body.kind != "static" and not self.world.bodies["quarantined"][row]:
            self.world.bodies["x"][row] = np.nan
            self.world.touch(body.id)

    def edit_nothing(self, body, ids):
        """Only query the world; no answer may change the later steps."""
        world = self.world
        assert all(0.0 <= hit.fraction <= 1.0 for hit in world.ray_cast_all((-200, 0), (400, 50)))
        touched = {int(each) for row in body.contacts for each in (row["shape_a"], row["shape_b"])}
        mine = set(world.shapes["id"][world.shapes["body"] == body.id].tolist())
        assert not touched or touched & mine
        assert len(world.query_aabb((-50, -50), (50, 50))) <= len(world.bodies)
        asleep = world.sleeping_contacts
        for side in ("body_a", "body_b"):
            rows = world.bodies[world.rows(asleep[side])]
            assert not (rows["awake"] & (rows["kind"] == DYNAMIC)).any()


@pytest.mark.parametrize(
    "seed", [*range(8 if JIT else 2), *(pytest.param(n, marks=pytest.mark.nightly) for n in range(8, 72))]
)
def test_no_edit_raises_and_every_broad_phase_comes_to_one_digest(seed):
    digests = {}
    for strategy in (BruteForce, SweepAndPrune, SpatialHashGrid, DynamicTree):
        editor = Editor(seed, strategy())
        for _ in range(ROUNDS):
            editor.edit()
        digests[strategy.__name__] = editor.world.digest()
    assert len(set(digests.values())) == 1, digests
