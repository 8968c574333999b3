"""Scenes of columns, towers, heavy loads and pyramids, made of boxes of 1 m on a floor at y = 0."""

import numpy as np

from tests.stability.study.scene import TURNS, Fall, Scene, Solid, box, floor

CROOKED = 0.02  # [m] either way
BOX = (box(1.0, 1.0),)


def tower(places, densities=None, **options):
    """Return a scene with boxes above one another at these x [m], the lowest first. options: further arguments of
    Scene.
    """
    densities = [1.0] * len(places) if densities is None else densities
    boxes = [Solid(BOX, x, -0.5 - k, density=d) for k, (x, d) in enumerate(zip(places, densities, strict=True))]
    return Scene((floor(), *boxes), **options)


def aligned(count):
    """Return a scene with a column of boxes exactly above one another."""
    return tower([0.0] * count, seconds=30.0, fall=Fall())


def crooked(count, seed):
    """Return a scene with a column of boxes, each at a random x of up to 2 cm from 0."""
    places = np.random.default_rng(seed).uniform(-CROOKED, CROOKED, count).tolist()
    return tower(places, seconds=20.0, fall=Fall())


def offset_places(count, share):
    """Return the x [m] of the boxes of a tower in which each is shifted by the same offset from the one below.

    share: the offset divided by the largest one at which such a tower stands, 1 / count. The count - 1 boxes above the
    lowest have their centre of mass count / 2 offsets from its centre. They stand while this is at most half a width.
    The boxes above any other box overhang less.
    """
    return [share / count * k for k in range(count)]


def harmonic_places(count, share):
    """Return the x [m] of the boxes of a tower, the lowest first.

    The k-th box from the top is shifted by share / 2k from the one above it. With a share of 1 the centre of mass of
    the upper k boxes is above the edge of the box below, for every k. No tower of single boxes reaches farther (half a
    harmonic number; Paterson and Zwick 2009, section 1). With any share, this centre is share / 2 from the middle of
    the box below, so all heights reach the limit together.
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
    """Return a scene of two boxes under a box with a hundred times their mass, which is removed after three seconds."""
    return tower([0.0] * 3, [1.0, 1.0, 100.0], seconds=6.0, removals=((180, 3),))


def pyramid_solids(rows, spread=1.1):
    """Return the boxes of a pyramid; each row has one box fewer than the row below. spread:
    distance of neighbours [m].
    """
    return [
        Solid(BOX, (column - 0.5 * (rows - 1 - row)) * spread, -0.5 - row)
        for row in range(rows)
        for column in range(rows - row)
    ]


def pyramid(rows, seconds=10.0, sleeping=False):
    return Scene((floor(), *pyramid_solids(rows)), seconds, sleeping=sleeping, fall=None if sleeping else Fall())


def dropped_on_pyramid(ratio):
    """Return a scene in which a heavy box falls two metres onto a pyramid of ten rows without its top box.

    ratio: mass of the heavy box over that of another box.
    """
    solids = pyramid_solids(10, spread=1.01)
    return Scene((floor(), *solids[:-1], Solid(BOX, 0.0, -11.5, density=float(ratio))), 10.0, fall=Fall())
