"""Gallery pages about extreme cases: bodies at one point, an overfull room, great distance, a wrong scale, sleep.

In all functions, `side` is a Side: one of the page's two worlds while it runs.
"""

import numpy as np

from physics import Circle, Effects, Material, Polygon, World
from scenes.lab.gallery.page import LAST, METER, MM, PUSHED, Larger, Page, Way, auto, dynamic, floor
from scenes.lab.gallery.piles import CRATE, PILE

POINT = Effects(response=True, rotation=True, stacking=True)
LIVE, THOUSAND = 60, 1000  # bodies at the point: in a frame, and beside the game
FAR = 1e7  # [px]
ROWS = 8
CROWD, ROOM = 25, 0.79  # side of the crowd; its room, as a share of its area
WALL = 2.0 * METER
PILES, HIGH = 12, 10
APEX = 0.8**2 * 2.0  # [m] first apex of a ball after a fall of two metres


def build_point(side):
    """Build LIVE boxes, all at (0, 0). side: one of the page's two worlds (page.Side)."""
    fill_point(side.world, LIVE)


def fill_point(world, count):
    """Add `count` boxes of 8 px to a world, all with their centre at (0, 0)."""
    world.add_bodies(Polygon.box(8.0, 8.0), np.zeros((count, 2)))


def snapshot_of_thousand(settings):
    """Return a snapshot of a world with a thousand boxes at (0, 0). settings: keyword arguments of World."""
    world = World(POINT, **settings)
    fill_point(world, THOUSAND)
    return world.snapshot()


def fastest_move(side):
    """Return the greatest distance that a body moved in the last step, divided by the duration of the step [m/s].

    side: one of the page's two worlds (page.Side).
    """
    b = dynamic(side.world)
    way = np.hypot(b["x"] - b["previous_x"], b["y"] - b["previous_y"])
    return float(way.max()) / side.world.dt / METER


def farthest_move(figures):
    """Return the greatest distance that a body moved in one step, divided by the duration of the step [m/s].

    figures: RunFigures of the page "point" with a thousand boxes, which runs in the measuring process.
    """
    assert figures.farthest is not None  # set, because it was judged
    return figures.farthest * 60.0 / METER


def build_crowd(side):
    """Build 625 discs of 1 m diameter in a room with the area of 496 discs.

    side: one of the page's two worlds (page.Side).
    """
    wide = CROWD * ROOM * METER
    for x, y, width, height in (
        (0.0, 0.5 * (wide + WALL), wide + 2.0 * WALL, WALL),
        (0.0, -0.5 * (wide + WALL), wide + 2.0 * WALL, WALL),
        (-0.5 * (wide + WALL), 0.0, WALL, wide),
        (0.5 * (wide + WALL), 0.0, WALL, wide),
    ):
        side.world.add_body(Polygon.box(width, height), position=(x, y), kind="static")
    apart = wide / (CROWD + 0.3)
    middle = (CROWD - 1) / 2
    places = [((i - middle) * apart, (j - middle) * apart) for j in range(CROWD) for i in range(CROWD)]
    side.world.add_bodies(Circle(0.5 * METER), places)


def unrest(side):
    """Return the root mean square of the speeds of all dynamic bodies [m/s].

    side: one of the page's two worlds (page.Side).
    """
    b = dynamic(side.world)
    return float(np.sqrt((b["vx"] ** 2 + b["vy"] ** 2).mean())) / METER


def build_pyramid(side, origin):
    """Build a pyramid of eight rows of crates on a static floor.

    origin: x and y of the centre of the pyramid's base [px]; side: one of the page's two worlds (page.Side).
    """
    floor_at = (origin, origin + 2.0 * METER)
    side.world.add_body(Polygon.box(100.0 * METER, 4.0 * METER), position=floor_at, kind="static")
    places = [
        (origin + (column - (ROWS - row - 1) / 2) * 1.02 * METER, origin - (row + 0.5) * METER)
        for row in range(ROWS)
        for column in range(ROWS - row)
    ]
    side.world.add_bodies(CRATE, places)
    side.kept["origin"] = origin


def apart(side):
    """Return the greatest difference between a body's positions in the page's two worlds, along x or y [mm].

    Positions count from the origin of each world's pyramid. side: one of the page's two worlds (page.Side).
    """
    b, other = dynamic(side.world), dynamic(side.other.world)
    shift = side.kept["origin"] - side.other.kept["origin"]
    return MM * max(float(np.abs(b[axis] - other[axis] - shift).max()) for axis in ("x", "y"))


def build_metres(side):
    """Build a world with lengths in metres: a floor, and a ball of 0.5 m diameter 2 m above it.

    side: one of the page's two worlds (page.Side).
    """
    material = Material(restitution=0.8)
    shape = Polygon.box(40.0, 4.0)
    side.world.add_body(shape, position=(0.0, 2.0), kind="static", material=material)
    side.kept["ball"] = side.world.add_body(Circle(0.25), position=(0.0, -2.25), material=material)
    side.kept["top"], side.kept["fell"] = 0.0, False


def low(side):
    """Return the difference between the ball's first apex after the bounce and the ideal height [% of the ideal
    height].

    It is 0 while the ball falls and rises. side: one of the page's two worlds (page.Side).
    """
    ball, kept = side.kept["ball"], side.kept
    kept["fell"] |= ball.velocity[1] <= 0.0 and side.steps > 5
    if not kept["fell"]:
        return 0.0
    kept["top"] = max(kept["top"], -0.25 - ball.position[1])
    rising = ball.velocity[1] < -0.2
    return 0.0 if rising else 100.0 * abs(1.0 - kept["top"] / APEX)


def build_piles(side):
    """Build twelve columns of ten crates at rest. side: one of the page's two worlds (page.Side)."""
    floor(side.world)
    places = [
        ((column - (PILES - 1) / 2) * 2.0 * METER, -(row + 0.5) * METER)
        for column in range(PILES)
        for row in range(HIGH)
    ]
    side.world.add_bodies(CRATE, places)


def moved(side):
    """Return the number of bodies that the last step integrated. Sleeping bodies are not integrated.

    side: one of the page's two worlds (page.Side).
    """
    return float(side.world.profile.counters["bodies_integrated"])


PAGES = (
    Page(
        "point",
        "A thousand bodies at one point",
        "Sixty boxes start inside each other, a thousand beside the game: none is shot out.",
        "499,500 pairs of a thousand, none with a direction: each gets one, no push-out is faster than 3 m/s.",
        PUSHED,
        Way("soft step, four substeps", {"substeps": 4}),
        POINT,
        build_point,
        fastest_move,
        "m/s at most",
        3.01,
        20,
        (0.0, 0.0, 200.0),
        alike=True,
        glance=2,
        larger=Larger(f"{THOUSAND:,} boxes", f"{__name__}:snapshot_of_thousand", 4, farthest_move),
    ),
    Page(
        "crowd",
        "625 discs in room for 496",
        "They cannot fit. Left they boil and some get out; right they lie still.",
        "Pushed out of one they are in the next, for ever; springs find where all neighbours balance.",
        PUSHED,
        auto(50),
        PILE,
        build_crowd,
        unrest,
        "m/s on average",
        1.0,
        240,
        (0.0, 0.0, 37.0 * METER),
        judged=LAST,
    ),
    Page(
        "far",
        "10^7 px from the origin",
        "The same pyramid at the origin and far away: they stand alike.",
        "float64 keeps 2e-9 px out there, and contacts are worked out between bodies, not from the origin.",
        Way("at the origin", bodies={"origin": 0.0}),
        Way("10^7 px away", bodies={"origin": FAR}),
        PILE,
        lambda side: build_pyramid(side, **side.way.bodies),
        apart,
        "mm apart",
        1.0,
        300,
        (0.0, -3.5 * METER, 14.0 * METER),
        alike=True,
    ),
    Page(
        "scale",
        "Metres taken for pixels",
        "A ball of e = 0.8 falls two metres: left it does not bounce, right it does.",
        "Tolerances are in metres: at 32 px to the metre, an impact of 6 m/s counts as 0.2, too slow to bounce.",
        Way("pixels_per_meter=32, as it is", {"gravity": (0.0, 9.8)}),
        Way("pixels_per_meter=1", {"gravity": (0.0, 9.8), "pixels_per_meter": 1.0}),
        Effects(response=True, gravity=True, restitution=True, stacking=True),
        build_metres,
        low,
        "% too low",
        2.0,
        90,
        (0.0, -1.2, 5.0),
    ),
    Page(
        "asleep",
        "Sleep",
        "120 crates stand still: right they sleep, and a step costs next to nothing.",
        "An island at rest is put aside with its contacts and forces until something touches it.",
        Way("always awake", without=("sleeping",)),
        Way("sleeping"),
        PILE.with_(sleeping=True, friction=False),
        build_piles,
        moved,
        "bodies a step",
        0.5,
        150,
        (0.0, -4.6 * METER, 27.0 * METER),
        judged=LAST,
    ),
)
