"""Columns, towers, mass ratios and pyramids of boxes, 1 m each, on a floor at y = 0."""

import numpy as np

from tests.stability.study.scene import TURNS, Fall, Scene, Solid, box, floor

CROOKED = 0.02  # [m] either way
BOX = (box(1.0, 1.0),)


def tower(places, densities=None, **options):
    """Boxes above one another at these x [m], the lowest first."""
    densities = [1.0] * len(places) if densities is None else densities
    boxes = [Solid(BOX, x, -0.5 - k, density=d) for k, (x, d) in enumerate(zip(places, densities, strict=True))]
    return Scene((floor(), *boxes), **options)


def aligned(count):
    """A column of boxes exactly above one another."""
    return tower([0.0] * count, seconds=30.0, fall=Fall())


def crooked(count, seed):
    """A column of boxes, each off by up to 2 cm."""
    places = np.random.default_rng(seed).uniform(-CROOKED, CROOKED, count).tolist()
    return tower(places, seconds=20.0, fall=Fall())


def offset_places(count, share):
    """x of boxes [m] that are each further than the one below, by this share of the limit of such a tower.

    What lies above the lowest, count - 1 boxes, has its centre of mass count / 2 offsets from the lowest box's middle
    (their mean place is (1 + … + (count - 1)) / (count - 1)); it stands while that is within half a width: the limit
    is 1 / count. What lies above the others is less far out, and the whole tower by half an offset less over its foot.
    """
    return [share / count * k for k in range(count)]


def harmonic_places(count, share):
    """x of boxes [m] whose k-th from the top is this share of 1 / 2k further in than the one above it.

    With a share of 1 the centre of mass of the upper k lies over the edge of the box below, for every k: they reach as
    far as any tower of single boxes (the sum is half a harmonic number; Paterson and Zwick 2009, section 1). It is
    share / 2 from that box's middle, for every k: both the limit and how far it is missed are the same at all heights.
    """
    places = [0.0]
    for k in range(1, count):
        places.append(places[-1] - share * 0.5 / k)
    return [place - places[-1] for place in reversed(places)]


def standing(places, seconds=20.0):
    """Return the scene of a tower that must stand."""
    return tower(places, seconds=seconds, fall=Fall())


def turning(places, seconds):
    """Return the scene of a tower that must fall. It ends when a box has turned by 0.1 rad."""
    return tower(places, seconds=seconds, fall=TURNS)


def heavy_on(count, ratio, seconds):
    """Return a column of `count` boxes with a box of `ratio` times the mass on top."""
    return tower([0.0] * (count + 1), [1.0] * count + [float(ratio)], seconds=seconds, fall=Fall())


def heavy_taken_away():
    """Two boxes with one of a hundred times their mass on them, which is gone after three seconds."""
    return tower([0.0] * 3, [1.0, 1.0, 100.0], seconds=6.0, removals=((180, 3),))


def pyramid_solids(rows, spread=1.1):
    """Return boxes in rows, each one box shorter than the row below. spread: distance of neighbours [m]."""
    return [
        Solid(BOX, (column - 0.5 * (rows - 1 - row)) * spread, -0.5 - row)
        for row in range(rows)
        for column in range(rows - row)
    ]


def pyramid(rows, seconds=10.0, sleeping=False):
    return Scene((floor(), *pyramid_solids(rows)), seconds, sleeping=sleeping, fall=None if sleeping else Fall())


def dropped_on_pyramid(ratio):
    """Return a pyramid of ten rows without its top, and a box of `ratio` times the mass that falls two metres."""
    solids = pyramid_solids(10, spread=1.01)
    return Scene((floor(), *solids[:-1], Solid(BOX, 0.0, -11.5, density=float(ratio))), 10.0, fall=Fall())
