"""Random changes of worlds: candidates and events equal those of an independent brute-force model after every step.

Bodies are added, removed, moved and filtered. Five worlds, one per broad phase, get the same changes; their digests
must be equal.
"""

import math

import numpy as np
import pytest

from physics import JIT, BruteForce, Circle, DynamicTree, Effects, Filter, SpatialHashGrid, SweepAndPrune, World
from tests.oracles.boxes import agree

SLOP, DT = 0.16, 1 / 60
REACH = 3.0  # four times the three eighths of its width by which a disc's rectangle may hold later motion
FILTERS = [
    (1, 0xFFFFFFFF),
    (2, 0xFFFFFFFF),
    (4, 1),
    (4, 6),
    (0, 0xFFFFFFFF),
    (1 << 31, 1 << 31),
    (0xFFFFFFFF, 0xFFFFFFFF),
]
MAKERS = (BruteForce, SweepAndPrune, lambda: SweepAndPrune(axes="both"), SpatialHashGrid, DynamicTree)


class Twin:
    """Independent model of the expected state of a world, in plain lists."""

    def __init__(self):
        self.bodies = {}  # id -> [x, y, vx, vy, radius, kind, filter]
        self.touching = set()

    def rectangle(self, body, reach):
        x, y, vx, vy, radius, kind, _ = body
        margin = 0.0 if kind == "static" else SLOP + reach * radius
        return (
            min(x, x + DT * vx) - radius - margin,
            min(y, y + DT * vy) - radius - margin,
            max(x, x + DT * vx) + radius + margin,
            max(y, y + DT * vy) + radius + margin,
        )

    def candidates(self, reach=0.0):
        """Return the pairs whose swept boxes overlap.

        reach: how far the boxes of moving bodies are enlarged for later motion [radii].
        """
        found, items = [], [(i, b, self.rectangle(b, reach)) for i, b in sorted(self.bodies.items())]
        for at, (i, b, p) in enumerate(items):
            for j, c, q in items[at + 1 :]:
                if (
                    p[0] <= q[2]
                    and q[0] <= p[2]
                    and p[1] <= q[3]
                    and q[1] <= p[3]
                    and not (b[5] == c[5] == "static")
                    and agree(b[6], c[6])
                ):
                    found.append((i, j))
        return found

    def step(self):
        pairs, most = self.candidates(), self.candidates(REACH)
        for body in self.bodies.values():
            body[0] += DT * body[2]
            body[1] += DT * body[3]
        now = set()
        for i, j in pairs:
            a, b = self.bodies[i], self.bodies[j]
            gap = math.hypot(a[0] - b[0], a[1] - b[1]) - a[4] - b[4]
            if gap <= (SLOP if (i, j) in self.touching else 0.0):
                now.add((i, j))
        begun, ended = now - self.touching, self.touching - now
        self.touching = now
        return pairs, most, sorted(begun), sorted(ended)


def change(rng, twin, worlds, most):
    """Apply one random change to the model and to every world. most: greatest number of bodies."""
    choice, ids = rng.random(), sorted(twin.bodies)
    if (choice < 0.3 and len(ids) < most) or len(ids) < most // 2:
        kind = ("static", "kinematic", "dynamic")[rng.integers(3)]
        x, y = rng.uniform(-40, 40, 2).tolist()
        fast = 30000.0 if rng.random() < 0.1 else 200.0
        vx, vy = (0.0, 0.0) if kind == "static" or rng.random() < 0.3 else rng.uniform(-fast, fast, 2).tolist()
        radius, bits = float(rng.exponential(8.0) + 0.1), FILTERS[rng.integers(len(FILTERS))]
        for world in worlds:
            body = world.add_body(Circle(radius), position=(x, y), velocity=(vx, vy), kind=kind, filter=Filter(*bits))
        twin.bodies[body.id] = [x, y, vx, vy, radius, kind, bits]
        return
    identity = ids[rng.integers(len(ids))]
    body = twin.bodies[identity]
    if choice < 0.5:
        gone = {identity, ids[rng.integers(len(ids))]}
        for world in worlds:
            world.remove_bodies(sorted(gone))
        for each in gone:
            del twin.bodies[each]
    elif choice < 0.65:
        body[0], body[1] = rng.uniform(-40, 40, 2).tolist()
        for world in worlds:
            world.body(identity).move_to((body[0], body[1]))
    elif choice < 0.75:
        body[0], body[1] = rng.uniform(-40, 40, 2).tolist()
        for world in worlds:  # through the column
            row = world.rows([identity])[0]
            world.bodies["x"][row], world.bodies["y"][row] = body[:2]
    elif choice < 0.85:
        body[6] = FILTERS[rng.integers(len(FILTERS))]
        for world in worlds:
            world.body(identity).filter = Filter(*body[6])
    elif choice < 0.93:
        body[5] = ("static", "kinematic", "dynamic")[rng.integers(3)]
        if body[5] == "static":
            body[2] = body[3] = 0.0
        for world in worlds:
            world.body(identity).set_kind(body[5])
    elif choice < 0.96 and worlds:
        taken = [world.snapshot() for world in worlds]
        for world, snapshot in zip(worlds, taken, strict=True):
            world.restore(snapshot)
    elif choice < 0.98:
        for world, make in zip(worlds, MAKERS, strict=True):
            world.broadphase = make()
    elif choice < 0.982:
        twin.bodies.clear()
        for world in worlds:
            world.clear()


def churn(seed, steps, most):
    rng, twin = np.random.default_rng(seed), Twin()
    worlds = [World(Effects(), make()) for make in MAKERS]
    done, seen = 0, np.zeros(3, int)
    for step in range(steps):
        for _ in range(int(rng.integers(0, 4))):
            change(rng, twin, worlds, most)
            done += 1
        pairs, most_pairs, begun, ended = twin.step()
        seen += (len(pairs), len(begun), len(ended))
        for world in worlds:
            world.step()
        for world in worlds:
            name = f"{world.broadphase.name} at step {step} of seed {seed}"
            bodies_of = dict(zip(world.shapes["id"].tolist(), world.shapes["body"].tolist(), strict=True))
            told = [(bodies_of[a], bodies_of[b]) for a, b in world.candidates.tolist()]
            assert told == sorted(set(told)) and set(pairs) <= set(told) <= set(most_pairs), name
            for event, wanted in ((world.events.begin, begun), (world.events.end, ended)):
                assert list(zip(event["body_a"].tolist(), event["body_b"].tolist(), strict=True)) == wanted, name
        assert len({world.digest() for world in worlds}) == 1, f"step {step} of seed {seed}"
    assert seen.min() > steps // 6, "a history in which little happens proves little"
    return done


@pytest.mark.parametrize("seed", range(3))
def test_random_churn_agrees_with_brute_force_after_every_step(seed):
    churn(seed, 120 if JIT else 25, most=30)


@pytest.mark.parametrize("seed", range(100, 110))
def test_ten_thousand_random_churns_agree_with_brute_force_after_every_step(seed):
    assert churn(seed, 700 if JIT else 60, most=45) >= (950 if JIT else 60)
