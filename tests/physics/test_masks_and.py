"""Collisions of pixel masks by bitwise AND of words, compared with a simple double loop."""

import math

import numpy as np
import pytest

from physics import JIT, Effects, PixelMask, World, collide
from tests.oracles.masks import bounds, least_overlap, shared_pixels

WIDTHS = (1, 2, 31, 32, 33, 63, 64, 65, 127, 128, 129)


def at(mask, left, top):
    """Return the pose at which the top left corner of a mask is drawn at (left, top)."""
    return (left + mask.origin[0], top + mask.origin[1], 0.0)


def check_pair(a, a_left, a_top, b, b_left, b_top):
    """Compare all results of collide() for two bitmaps with a double loop. Return whether the bitmaps overlap."""
    mask_a, mask_b = PixelMask(a), PixelMask(b)
    shared = shared_pixels(a.tolist(), a_left, a_top, b.tolist(), b_left, b_top)
    found = collide(mask_a, at(mask_a, a_left, a_top), mask_b, at(mask_b, b_left, b_top))
    assert (len(found) > 0) == (len(shared) > 0)
    assert found.area == len(shared)
    if not shared:
        assert found.normal == (0.0, 0.0)
        return False
    x, y = shared[0]
    assert int(found.features[0]) == (y - a_top) * mask_a.size[0] + (x - a_left), "the first pixel in reading order"
    assert abs(math.hypot(*found.normal) - 1.0) <= 1e-12
    centroid = (sum(x for x, _ in shared) / len(shared) + 0.5, sum(y for _, y in shared) / len(shared) + 0.5)
    assert found.points[0].tolist() == pytest.approx(centroid, abs=1e-9)
    depth = -float(found.separations.min())
    assert 0.0 < depth <= least_overlap(bounds(a.tolist(), a_left, a_top), bounds(b.tolist(), b_left, b_top))
    x, y, angle = at(mask_b, b_left, b_top)
    out = collide(
        mask_a, at(mask_a, a_left, a_top), mask_b, (x + depth * found.normal[0], y + depth * found.normal[1], angle)
    )
    assert len(out) == 0, f"moving B by {depth} along {found.normal} does not end the overlap"
    return True


@pytest.mark.parametrize("seed", range(4))
def test_random_masks_hit_as_the_double_loop_says(seed):
    rng = np.random.default_rng(seed)
    hits = 0
    count = 250 if JIT else 12
    for _ in range(count):
        wa, ha, wb, hb = (
            int(rng.choice(WIDTHS[:7])) if rng.random() < 0.5 else int(rng.integers(1, 40)) for _ in range(4)
        )
        density = rng.choice([0.02, 0.2, 0.5, 0.9, 1.0], 2)
        a, b = rng.random((ha, wa)) < density[0], rng.random((hb, wb)) < density[1]
        hits += check_pair(a, 0, 0, b, int(rng.integers(-wb - 2, wa + 3)), int(rng.integers(-hb - 2, ha + 3)))
    assert 0.2 * count < hits < 0.9 * count


@pytest.mark.parametrize("seed", range(10, 20))
def test_thousands_of_random_masks_hit_as_the_double_loop_says(seed):
    rng = np.random.default_rng(seed)
    for _ in range(1000 if JIT else 20):
        wa, wb = (int(rng.choice(WIDTHS)) for _ in range(2))
        a, b = (rng.random((int(rng.integers(1, 9)), w)) < rng.random() for w in (wa, wb))
        check_pair(a, 0, 0, b, int(rng.integers(-wb - 1, wa + 2)), int(rng.integers(-9, 10)))


@pytest.mark.parametrize("width", WIDTHS)
def test_every_offset_across_a_word_border(width):
    row = np.zeros((1, width), bool)
    row[0, 0] = row[0, -1] = row[0, width // 2] = True
    other = np.zeros((1, 65), bool)
    other[0, 0] = other[0, 63] = other[0, 64] = True
    a, b = PixelMask(row), PixelMask(other)
    for offset in range(-67, width + 3):
        wanted = len(shared_pixels(row.tolist(), 0, 0, other.tolist(), offset, 0))
        assert collide(a, at(a, 0, 0), b, at(b, offset, 0)).area == wanted, offset
        assert collide(b, at(b, offset, 0), a, at(a, 0, 0)).area == wanted, offset


@pytest.mark.parametrize("width", WIDTHS)
def test_words_hold_bit_b_of_word_k_for_column_64k_plus_b(width):
    rng = np.random.default_rng(width)
    solid = rng.random((5, width)) < 0.5
    words = PixelMask(solid).words
    assert words.dtype == np.uint64 and words.shape == (5, -(-width // 64))
    for y in range(5):
        for k in range(words.shape[1]):
            bits = [int(words[y, k]) >> b & 1 for b in range(64)]
            assert bits == [int(64 * k + b < width and solid[y, min(64 * k + b, width - 1)]) for b in range(64)]


@pytest.mark.parametrize("shape", [(0, 0), (0, 5), (5, 0), (4, 4)])
def test_empty_masks_never_hit_and_have_no_centroid(shape):
    empty, full = PixelMask(np.zeros(shape, bool)), PixelMask(np.ones((9, 9), bool))
    assert (empty.area, empty.centroid, empty.bounds, empty.size) == (0, None, None, shape[::-1])
    assert len(collide(empty, (0, 0, 0), full, (0, 0, 0))) == len(collide(full, (0, 0, 0), empty, (0, 0, 0))) == 0
    world = World(Effects())
    world.add_body(empty, angle=0.3)
    world.add_body(full)
    world.step()
    assert len(world.contacts) == 0 and world.body(0).mass == 0.0
    assert world.ray_cast((-20, 0), (40, 0)).body.id == 1


def test_single_pixels_hit_where_they_are_drawn_on_the_same_place():
    dot = PixelMask(np.ones((1, 1), bool), origin=(0, 0))
    for i in range(-16, 17):
        for j in (-9, -8, -4, 0, 3, 4, 8):
            dx, dy = i / 8, j / 8
            same = math.floor(dx + 0.5) == 0 and math.floor(dy + 0.5) == 0
            assert (len(collide(dot, (0, 0, 0), dot, (dx, dy, 0))) > 0) == same, (dx, dy)


def test_touching_masks_share_no_pixel_and_do_not_hit():
    box = PixelMask(np.ones((4, 4), bool))
    for step in ((4, 0), (-4, 0), (0, 4), (0, -4), (4, 4)):
        assert len(collide(box, (0, 0, 0), box, (*step, 0))) == 0
        assert len(collide(box, (0, 0, 0), box, (step[0] * 0.75, step[1] * 0.75, 0))) > 0


def test_whole_pixel_tier_misses_its_known_share_of_true_overlaps():
    """Snapped masks of 32 px miss 1 - (63/64)^2 = 3.10 % of the overlaps at real positions, and report no false one.

    These overlaps share less than a whole pixel.
    """
    rng = np.random.default_rng(0)
    square = PixelMask(np.ones((32, 32), bool))
    n = 40_000 if JIT else 3_000
    positions = rng.uniform(-32, 32, (n, 2))
    probe = [bool(max(abs(math.floor(x + 0.5)), abs(math.floor(y + 0.5))) < 32) for x, y in positions]
    seen = [len(collide(square, (0, 0, 0), square, (x, y, 0))) > 0 for x, y in positions[: 300 if JIT else 100]]
    assert seen == probe[: len(seen)]
    missed = 1.0 - sum(probe) / n
    assert missed == pytest.approx(1 - (63 / 64) ** 2, abs=3.5 * math.sqrt(0.031 * 0.969 / n))


SYMMETRIC = {
    "plus": lambda: np.array([[abs(i - 5) < 2 or abs(j - 5) < 2 for i in range(11)] for j in range(11)]),
    "ring": lambda: np.array([[16 <= math.hypot(i - 20, j - 20) <= 20 for i in range(41)] for j in range(41)]),
    "checkerboard": lambda: np.indices((12, 12)).sum(axis=0) % 2 == 0,
    "full": lambda: np.ones((9, 7), bool),
}


@pytest.mark.parametrize("name", SYMMETRIC)
def test_symmetric_full_overlap_has_a_unit_normal_and_a_depth_that_parts(name):
    solid = SYMMETRIC[name]()
    mask = PixelMask(solid)
    found = collide(mask, (0, 0, 0), mask, (0, 0, 0))
    assert len(found) >= 1 and found.area == mask.area
    assert abs(math.hypot(*found.normal) - 1.0) <= 1e-12
    depth = -float(found.separations.min())
    assert 0 < depth <= min(mask.size)
    again = collide(mask, (0, 0, 0), mask, (depth * found.normal[0], depth * found.normal[1], 0))
    assert len(again) == 0


def test_ball_inside_the_hole_of_a_ring_does_not_hit():
    ring = PixelMask(SYMMETRIC["ring"]())
    ball = PixelMask(np.array([[math.hypot(i - 10, j - 10) <= 10 for i in range(21)] for j in range(21)]))
    for dx in range(-4, 5):
        assert len(collide(ring, (0, 0, 0), ball, (dx, 0, 0))) == 0
    assert len(collide(ring, (0, 0, 0), ball, (7, 0, 0))) > 0
    assert len(collide(ring, (0, 0, 0), PixelMask(np.ones((21, 21), bool)), (12, 0, 0))) > 0


@pytest.mark.skipif(not JIT, reason="large masks need compiled kernels")
def test_large_masks_count_and_weigh_without_overflow():
    big, small = PixelMask(np.ones((4096, 4096), bool)), PixelMask(np.ones((64, 64), bool))
    assert collide(big, at(big, 0, 0), small, at(small, 4095, 4095)).area == 1
    assert collide(big, at(big, 0, 0), big, at(big, 4095, 0)).area == 4096
    assert collide(big, at(big, 0, 0), big, at(big, 0, 0)).area == 4096 * 4096
    world = World(Effects())
    body = world.add_body(big)
    assert body.mass == 4096.0**2
    assert body.inertia == pytest.approx(4096.0**4 / 6.0, rel=1e-12)


def test_world_and_collide_find_the_same_mask_hits():
    rng = np.random.default_rng(9)
    masks = [PixelMask(rng.random((h, w)) < 0.4) for w, h in ((33, 20), (64, 9), (12, 65), (31, 31))]
    verdicts, pushed = World(Effects()), World(Effects(response=True), gravity=(0, 0))
    poses = []
    for k in range(40 if JIT else 16):
        x, y, angle = rng.uniform(0, 150), rng.uniform(0, 150), rng.uniform(0, 7)
        poses.append((masks[k % 4], (x, y, angle)))
        for world in (verdicts, pushed):
            world.add_body(masks[k % 4], position=(x, y), angle=angle, kind="kinematic")
    verdicts.step(), pushed.step()
    wanted = {(i, j): collide(*poses[i], *poses[j]) for i in range(len(poses)) for j in range(i)}
    hit = {pair: m for pair, m in wanted.items() if len(m)}
    found = {(int(c["body_b"]), int(c["body_a"])) for c in verdicts.contacts}
    assert found == hit.keys() and len(hit) > 5
    # Where masks push, outlines say what touches, and the area is still the pixels' verdict.
    contacts = {(int(c["body_b"]), int(c["body_a"])): c for c in pushed.contacts}
    assert len(contacts.keys() & hit.keys()) > 5
    for pair, contact in contacts.items():
        assert contact["area"] == (hit[pair].area if pair in hit else 0.0)
