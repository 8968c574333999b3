"""The narrow phase caches transformed hulls for further pairs; the size of the cache changes no bit."""

import numpy as np
import pytest

from physics import Capsule, Circle, Effects, Material, Polygon, World
from physics.collision import narrow_phase
from physics.collision.hulls import edge_normal, write_normals

COUNTS = (1, 2, 16, narrow_phase.HULLS)  # of hulls kept; 1: all shapes share one place


def ring(count, radius):
    """Return the corners of a regular polygon [px]."""
    turns = np.arange(count) * 2 * np.pi / count
    return np.stack([radius * np.cos(turns), radius * np.sin(turns)], axis=1)


def crowd(substeps, seed):
    """Return a world of 60 rotated shapes that fall onto a floor and a step of boxes side by side."""
    rng = np.random.default_rng(seed)
    world = World(Effects.rigid_bodies(), gravity=(0, 640), substeps=substeps)
    world.add_body(Polygon.box(800, 40), position=(0, 300), kind="static")
    for k in range(10):
        world.add_body(Polygon.box(20, 20), position=(20 * k - 90, 270), kind="static")
    shapes = (
        Polygon.box(24, 12),
        Polygon(ring(5, 11)),
        Polygon(ring(8, 12)),
        Capsule((-9, 0), (9, 0), 5),
        Polygon(ring(3, 9), radius=4),
        Circle(9),
    )
    for k in range(60):
        world.add_body(
            shapes[k % len(shapes)],
            position=(30 * (k % 8) - 105 + rng.uniform(-4, 4), 230 - 34 * (k // 8)),
            angle=float(rng.uniform(0, 6)),
            velocity=rng.uniform(-200, 200, 2),
            material=Material(friction=0.5),
        )
    return world


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("substeps", ["auto", 4])
def test_the_number_of_kept_hulls_changes_no_bit(substeps, seed, monkeypatch):
    digests = []
    for count in COUNTS:
        monkeypatch.setattr(narrow_phase, "HULLS", count)
        world = crowd(substeps, seed)
        for _ in range(60):
            world.step()
        digests.append(world.digest())
        assert len(world.workspace.narrow.workspace.hull_rows) <= max(count, 1)
    assert len(set(digests)) == 1


@pytest.mark.parametrize("count", [2, 3, 4, 8, 16])
def test_normals_are_those_of_the_edges(count):
    rng = np.random.default_rng(count)
    for _ in range(20):
        corners = np.zeros((16, 4))
        turns = np.sort(rng.uniform(0, 2 * np.pi, count))
        corners[:count, 0], corners[:count, 1] = 9 * np.cos(turns), 9 * np.sin(turns)
        write_normals(count, corners)
        along = np.roll(corners[:count, :2], -1, axis=0) - corners[:count, :2]
        expected = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.hypot(*along.T)[:, None]
        np.testing.assert_allclose(corners[:count, 2:], expected, rtol=0, atol=1e-12)
        assert [tuple(each) for each in corners[:count, 2:]] == [edge_normal(corners, count, k) for k in range(count)]
