"""Distance, depth and contacts of random pairs, held between bounds that need no distance algorithm (hard_cases C13).

Golden values tell that something has changed, certificates that it is wrong: a line that parts two shapes bounds their
distance from below, a point on each from above, and two boxes an overlap's depth.
"""

from typing import NamedTuple

import numpy as np
import pytest

from physics import JIT, Effects, World, collide, distance
from tests.oracles import rounded_hulls
from tests.oracles.rounded_hulls import Hulls
from tests.stability.random_pairs import any_shape, draw_pairs, hulls_of

PAIRS = 100_000 if JIT else 2_000
AT_ONCE = 2_000  # pairs: what fits into the processor's cache
ROUNDING = 1e-12  # of the larger shape …
ULPS = 4.0  # … and of where the two are
CLIPPING = 1e-9  # of the larger shape: within it a contact keeps a face where two rounded corners are as near


class Chunk(NamedTuple):
    """Some pairs with what was told of them; points as seen from A's place [px]."""

    a: Hulls
    b: Hulls
    room: np.ndarray  # [px] for rounding
    distance: np.ndarray
    normal: np.ndarray
    point_a: np.ndarray
    point_b: np.ndarray
    touching: np.ndarray  # bool: collide has found points
    separation: np.ndarray  # of the deepest of them, NaN without any
    contact_normal: np.ndarray


def chunks(seed, count):
    """Ask distance and collide about random pairs."""
    pairs = draw_pairs(seed, count)
    places = [list(map(tuple, poses.tolist())) for poses in (pairs.poses_a, pairs.poses_b)]
    for start in range(0, count, AT_ONCE):
        part = slice(start, start + AT_ONCE)
        asked = list(zip(pairs.shapes_a[part], places[0][part], pairs.shapes_b[part], places[1][part], strict=True))
        gaps, met = [distance(*each) for each in asked], [collide(*each) for each in asked]
        origin = pairs.poses_a[part, :2]
        a, b = (Hulls(each.corners[part], each.radii[part]) for each in (pairs.a, pairs.b))
        far = np.abs(np.hstack([pairs.poses_a[part, :2], pairs.poses_b[part, :2]])).max(axis=1)
        yield Chunk(
            a,
            b,
            room_for(a, b) + ULPS * np.spacing(far),
            np.array([each.distance for each in gaps]),
            np.array([each.normal for each in gaps]),
            np.array([each.point_a for each in gaps]) - origin,
            np.array([each.point_b for each in gaps]) - origin,
            np.array([len(each) > 0 for each in met]),
            np.array([each.separations.min() if len(each) else np.nan for each in met]),
            np.array([each.normal for each in met]),
        )


def room_for(a, b):
    """(n,) roundings [px] of the larger of two hulls, with its way from the origin it is seen from."""
    return ROUNDING * np.maximum(*(np.abs(each.boxes()).max(axis=(0, 2)) for each in (a, b)))


def check_distance(found):
    """Parted by the normal by as much as is told, by no line more; the points on both surfaces, so far apart."""
    known, room = rounded_hulls.bounds(found.a, found.b), found.room
    assert (np.abs(np.hypot(*found.normal.T) - 1.0) <= 1e-15).all()
    assert (known.lower <= found.distance + room).all(), "some line parts them by more"
    assert (found.distance <= rounded_hulls.gap_along(found.a, found.b, found.normal) + room).all(), "not by its normal"
    overlap = found.distance <= 0.0
    assert (-found.distance <= -known.shadows + room)[overlap].all(), "no overlap is deeper than that of the boxes"
    across = ((found.point_b - found.point_a) * found.normal).sum(axis=1)
    apart = np.hypot(*(found.point_b - found.point_a).T)
    assert (np.abs(across - found.distance) <= room).all() and (np.abs(apart - np.abs(across)) <= room).all()
    for hulls, points in ((found.a, found.point_a), (found.b, found.point_b)):
        off = rounded_hulls.distance_to_core(hulls, points) - hulls.radii
        assert (np.abs(off) <= room).all(), "a point is not on its surface"


def check_contact(found):
    """Where and only where they overlap (U10), with a unit normal that parts them by the move that ends the overlap."""
    assert (found.touching == (found.distance <= 0.0)).all()
    met, room = found.touching, found.room * (CLIPPING / ROUNDING)
    assert (np.abs(np.hypot(*found.contact_normal[met].T) - 1.0) <= 1e-15).all()
    along = rounded_hulls.gap_along(found.a, found.b, found.contact_normal)
    for told in (found.distance, along):
        assert (np.abs(found.separation - told) <= room)[met].all()
        assert (np.abs(found.separation - told) <= found.room)[met].mean() > 0.999


def test_random_pairs_keep_their_certificates():
    hits = 0
    for found in chunks(1, PAIRS):
        check_distance(found)
        check_contact(found)
        hits += int(found.touching.sum())
    assert 0.3 < hits / PAIRS < 0.7, "a sample of hits alone, or of misses, says little"


@pytest.mark.deep
@pytest.mark.parametrize("seed", range(2, 8))
def test_more_random_pairs_keep_their_certificates(seed):
    for found in chunks(seed, PAIRS):
        check_distance(found)
        check_contact(found)


@pytest.mark.parametrize("place", [0.0, 1e7])
def test_crowd_has_the_contacts_that_its_shapes_have(place):
    """Every pair of a crowd, broad phase and narrow phase together: none is missed, none is made up."""
    rng, count = np.random.default_rng(3), 300 if JIT else 60
    world = World(Effects(rotation=True))
    shapes = [any_shape(rng) for _ in range(count)]
    reach = 60.0 * count**0.5  # [px] about every one overlaps another
    poses = np.column_stack([place + rng.uniform(-reach, reach, (count, 2)), rng.uniform(-7.0, 7.0, count)])
    for shape, (x, y, angle) in zip(shapes, poses.tolist(), strict=True):
        world.add_body(shape, position=(x, y), angle=angle, kind="kinematic")
    world.step(0.0)
    told = {}
    for row in world.contacts:
        pair = int(row["shape_a"]), int(row["shape_b"])
        told[pair] = min(float(row["separation"]), told.get(pair, np.inf))
    hulls, hits, steps = hulls_of(shapes), 0, np.array(np.triu_indices(count, 1))
    for start in range(0, steps.shape[1], AT_ONCE):
        one, two = steps[:, start : start + AT_ONCE]
        a, b = (
            Hulls(hulls.corners[k], hulls.radii[k]).placed(*(poses[k, :2] - poses[one, :2]).T, poses[k, 2])
            for k in (one, two)
        )
        lower = rounded_hulls.bounds(a, b).lower
        room = room_for(a, b) + ULPS * np.spacing(place)
        found = np.array([told.get((int(i), int(j)), np.nan) for i, j in zip(one, two, strict=True)])
        hits += int((lower < -room).sum())
        assert not (np.isnan(found) & (lower < -room)).any(), "an overlap was missed"
        assert not (~np.isnan(found) & (lower > room)).any(), "a contact was made up"
        assert not (np.abs(found - lower) > room).any()
    assert hits > count / 2, "a crowd"
