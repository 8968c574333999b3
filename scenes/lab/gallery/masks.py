"""Gallery pages about pixel masks: a ball in the hole of a ring, and squares that overlap by less than a pixel.

In all functions, `side` is a Side: one of the page's two worlds while it runs.
"""

from math import cos, hypot, sin

import numpy as np

from physics import Effects, PixelMask, fit
from scenes.lab.gallery.page import LAST, Page, Way

OUTER, INNER, BALL = 20.0, 16.0, 10.0  # [px] radii
CLEAR = 1.5  # [px] contacts this close are not counted: pixels are not circles
RINGS = tuple((-84.0 + 56.0 * column, -30.0 + 60.0 * row) for row in range(2) for column in range(4))
SIZE = 32
SQUARES = tuple((-150.0 + 100.0 * column, -100.0 + 100.0 * row) for row in range(3) for column in range(4))
SEEN = Effects()


def disc(radius, hole=0.0):
    """Return the PixelMask of a disc or ring with its origin at its centre.

    radius: outer radius [px]; hole: inner radius [px] of a ring, 0 for a full disc.
    """
    side = int(2 * radius)
    y, x = np.mgrid[0:side, 0:side] + 0.5 - radius
    far = np.hypot(x, y)
    return PixelMask.from_array((far < radius) & (far >= hole))


def build_rings(side, tier):
    """Build eight static rings, and a kinematic ball in each.

    tier: collision tier of rings and balls, as for physics.fit; "mask" for exact pixels. side: one of the page's two
    worlds (page.Side).
    """
    ring, ball = (disc(OUTER, INNER), disc(BALL))
    if tier != "mask":
        (ring,), (ball,) = fit(ring, tier), fit(ball, tier)
    side.kept.update(judged=0, wrong=0, balls=[])
    for place in RINGS:
        static = side.world.add_body(ring, position=place, kind="static")
        side.kept["balls"].append((static, side.world.add_body(ball, position=place, kind="kinematic")))


def swing(side):
    """Move each ball through the hole of its ring, over the ring's rim and back.

    side: one of the page's two worlds (page.Side).
    """
    for number, ((x, y), (_, ball)) in enumerate(zip(RINGS, side.kept["balls"], strict=True)):
        at = 0.031 * side.steps + 0.7 * number
        far = 17.0 + 17.0 * sin(1.7 * at)
        ball.move_to((x + far * cos(at), y + far * sin(at)), 0.0)


def wrong(side):
    """Return the percentage of wrong answers ("touching" or "apart") among all answers of the engine so far.

    By geometry, ring and ball touch if their centres are 6 to 30 px apart. Distances near these limits are not counted.
    side: one of the page's two worlds (page.Side).
    """
    met = {frozenset(pair) for pair in side.world.contacts[["body_a", "body_b"]].tolist()}
    for ring, ball in side.kept["balls"]:
        far = hypot(ball.position[0] - ring.position[0], ball.position[1] - ring.position[1])
        gap = max(INNER - BALL - far, far - OUTER - BALL)
        if abs(gap) > CLEAR:
            side.kept["judged"] += 1
            side.kept["wrong"] += (gap < 0.0) != (frozenset((ring.id, ball.id)) in met)
    return 100.0 * side.kept["wrong"] / max(1, side.kept["judged"])


def build_squares(side, snap):
    """Build pairs of square pixel masks of 32 px.

    snap: whether masks are tested at integer pixel positions (see PixelMask); side: one of the page's two worlds
    (page.Side).
    """
    square = PixelMask.from_array(np.ones((SIZE, SIZE), bool), snap=snap)
    side.kept.update(judged=0, missed=0, chance=np.random.default_rng(7), pairs=[])
    for place in SQUARES:
        one = side.world.add_body(square, position=place, kind="static")
        side.kept["pairs"].append((one, side.world.add_body(square, position=place, kind="kinematic")))


def scatter(side):
    """Move the second square of each pair to a random, fractional position at which it overlaps the first.

    side: one of the page's two worlds (page.Side).
    """
    offsets = side.kept["chance"].uniform(-SIZE, SIZE, (len(SQUARES), 2))
    for (x, y), (_, other), (dx, dy) in zip(SQUARES, side.kept["pairs"], offsets.tolist(), strict=True):
        other.move_to((x + dx, y + dy), 0.0)


def missed(side):
    """Return the percentage of overlaps that the engine did not report, among all overlaps so far.

    side: one of the page's two worlds (page.Side).
    """
    side.kept["judged"] += len(SQUARES)
    side.kept["missed"] += len(SQUARES) - len(side.world.contacts)
    return 100.0 * side.kept["missed"] / side.kept["judged"]


PAGES = (
    Page(
        "ring",
        "A ball in a ring",
        "Balls swing through the holes of rings: left they touch where nothing does.",
        "A hull has no hole. Pixels are compared by bitwise AND, 64 in a word, and cost hardly more.",
        Way("hulls", bodies={"tier": "hull"}),
        Way("every pixel", bodies={"tier": "mask"}),
        SEEN,
        lambda side: build_rings(side, **side.way.bodies),
        wrong,
        "% wrong verdicts",
        0.5,
        400,
        (0.0, 0.0, 234.0),
        act=swing,
        judged=LAST,
    ),
    Page(
        "squares",
        "Less than a pixel",
        "Squares of 32 px overlap by any amount: left 3 % of the overlaps are missed.",
        "On whole pixels 1 - (63/64)^2 = 3.1 % round to no overlap at all; exact squares stand where they are.",
        Way("snap=True: as drawn", bodies={"snap": True}),
        Way("snap=False: exact", bodies={"snap": False}),
        SEEN,
        lambda side: build_squares(side, **side.way.bodies),
        missed,
        "% missed",
        0.2,
        400,
        (0.0, 0.0, 468.0),
        act=scatter,
        judged=LAST,
    ),
)
