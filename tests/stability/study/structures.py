"""Scenes of a house of cards and an arch, whose parts hold each other up."""

import math

from tests.stability.study.scene import Fall, Scene, Solid, box, floor, polygon

LEAN = math.radians(25.0)
CARD_FRICTION = 0.7
# Corners of the inner and outer edge of half an arch [m], foot to crown, the parts between them its blocks:
# the arch of Box2D's and solver2d's samples at a quarter of its size, y up.
INNER = (
    (16, 0), (14.938037128, 5.13360105684), (13.7987174603, 10.2492806956),
    (12.5625296328, 15.3410701912), (11.2004098737, 20.3985654157), (9.6652121782, 25.4036989923),
    (7.87179930638, 30.3179337), (5.6351995582, 35.038207178), (2.40593795354, 39.0955410256),
)  # fmt: skip
OUTER = (
    (24, 0), (22.3361952822, 6.02299846206), (20.5493688897, 12.0096436121),
    (18.608546108, 17.9470321677), (16.4676927381, 23.8136793659), (14.0532502577, 29.5707935307),
    (11.2355104583, 35.1377581829), (7.75256816073, 40.3045067901), (3.0169315527, 44.288915938),
)  # fmt: skip
SCALE = 0.25


def card_house(levels, half_thickness=0.02, half_height=1.0):
    """Return a scene of a card house: pairs of cards lean on each other at 25 degrees from the vertical.

    A flat card is placed across every two neighbouring pairs. levels: number of storeys.
    """
    reach, rise = (
        half_thickness * math.cos(LEAN) + half_height * math.sin(LEAN),
        half_height * math.cos(LEAN) + half_thickness * math.sin(LEAN),
    )
    card, apart = (box(2 * half_thickness, 2 * half_height),), 1.8
    solids, left, foot = [floor(CARD_FRICTION)], 0.0, 0.0
    for pairs in range(levels, 0, -1):
        for k in range(pairs):
            x = left + apart * k
            # The left card of a pair leans to the right: clockwise.
            solids.append(Solid(card, x - reach, -foot - rise, angle=LEAN, friction=CARD_FRICTION))
            solids.append(Solid(card, x + reach, -foot - rise, angle=-LEAN, friction=CARD_FRICTION))
        top = foot + 2 * rise
        # Their ends lie within the edges that carry them: those of thin cards are near the middle of a pair.
        lying = (box(apart - half_thickness, 2 * half_thickness),)
        solids += [
            Solid(lying, left + apart * (k + 0.5), -top - half_thickness, friction=CARD_FRICTION)
            for k in range(pairs - 1)
        ]
        foot, left = top + 2 * half_thickness, left + apart / 2
    return Scene(tuple(solids), 15.0, fall=Fall())


def arch():
    """Return a scene of an arch of seventeen blocks, with four slabs on the keystone."""
    inner, outer = ([(SCALE * x, -SCALE * y) for x, y in edge] for edge in (INNER, OUTER))
    blocks = []
    for side in (1.0, -1.0):
        for k in range(len(inner) - 1):
            corners = (inner[k], outer[k], outer[k + 1], inner[k + 1])
            blocks.append([(side * x, y) for x, y in corners])
    (ix, iy), (ox, oy) = inner[-1], outer[-1]
    blocks.append([(ix, iy), (ox, oy), (-ox, oy), (-ix, iy)])
    solids = [floor()]
    for corners in blocks:
        x, y, part = polygon(corners)
        solids.append(Solid((part,), x, y))
    slab = (box(4.0, 1.0),)
    solids += [Solid(slab, 0.0, oy - 0.5 - k) for k in range(4)]
    return Scene(tuple(solids), 15.0, fall=Fall())
