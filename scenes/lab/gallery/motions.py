"""Gallery pages about motions with a known result: bounces, glancing collisions, a slope, seams of the ground.

In all functions, `side` is a Side: one of the page's two worlds while it runs.
"""

from math import cos, hypot, pi, radians, sin, sqrt, tan

import numpy as np

from physics import Capsule, Chain, Circle, Effects, Filter, Material, Polygon, TileGrid
from scenes.lab.gallery.page import LAST, METER, MM, PLAIN, PUSHED, SOFT, Page, floor

BALL, DROP, BOUNCES = 0.25 * METER, 0.5 * METER, 17
GRAVITY = 9.8 * METER
DISC = 0.5 * METER
SPEEDS = (2.5 * METER, 5.0 * METER, 20.0 * METER)
SLOPE = radians(30.0)
TILE, TILES = 16.0, 24  # [px]; number in a lane
OCTAGON = 8.0 / cos(pi / 8)  # [px] radius of the corners of one that stands 8 px high
SLIDERS = (  # shape, height of its middle [px]
    (Polygon.box(16.0, 16.0), 8.0),
    (Circle(8.0), 8.0),
    (Capsule((-5.0, 0.0), (5.0, 0.0), 8.0), 8.0),
    (Polygon([(OCTAGON * cos(pi * (k + 0.5) / 4), OCTAGON * sin(pi * (k + 0.5) / 4)) for k in range(8)]), 8.0),
)
GROUNDS = ("grids", "boxes", "chains")  # one lane each
LANE = 78.0  # [px] between two lanes
SLIDING = (60.0, 150.0, 120.0)  # [px/s] in each lane
APART = 28.0  # [px] between two sliders
LAP = 100  # steps, after which the sliders begin again
TRIPPED = 1.0  # [%] of the speed lost: a mark is drawn
SETTLED = 60  # steps after which a box has settled


def build_ball(side):
    """Build a ball above a floor, both with restitution 1. side: one of the page's two worlds (page.Side)."""
    elastic = Material(restitution=1.0)
    floor(side.world, material=elastic)
    side.kept["ball"] = side.world.add_body(Circle(BALL), position=(0.0, -BALL - DROP), material=elastic)
    side.kept["heights"], side.kept["bounces"] = [DROP], 0


def apex(side):
    """Return the difference between the bouncing ball's apex and the height of its first fall [% of that height].

    It is 0 in a step without an apex. The apex is computed from the parabola through the heights of three steps. Only
    the first seventeen apexes are measured. If apexes are missing, the error is 100 %. side: one of the page's two
    worlds (page.Side).
    """
    kept, found = side.kept, 0.0
    kept["heights"] = [*kept["heights"][-2:], -BALL - side.kept["ball"].position[1]]
    if len(kept["heights"]) == 3 and kept["bounces"] < BOUNCES:
        before, top, after = kept["heights"]
        if top > before and top >= after:
            kept["bounces"] += 1
            height = top - (after - before) ** 2 / (8.0 * (before - 2.0 * top + after))
            found = 100.0 * abs(height / DROP - 1.0)
    due = int(side.steps / 60 / (2.0 * sqrt(2.0 * DROP / GRAVITY)) - 0.75)
    return 100.0 if min(due, BOUNCES) > kept["bounces"] + 1 else found


def blows():
    """Return a list of (offset, speed, further), one for each of 24 glancing collisions.

    offset: distance of the resting disc from the path of the moving disc [diameters]; speed: speed of the moving disc
    [px/s]; further: random extra distance of the moving disc at the start [px], at most its motion in one step.
    """
    chance = np.random.default_rng(5)
    return [(0.1 + 0.8 * k / 7, v, float(chance.uniform()) * v / 60) for v in SPEEDS for k in range(8)]


def build_discs(side):
    """Build pairs of frictionless discs. In each pair, a moving disc hits a resting disc off-centre.

    side: one of the page's two worlds (page.Side).
    """
    side.kept["pairs"] = []
    for number, (offset, speed, further) in enumerate(blows()):
        x, y = 5.0 * METER * (number % 8), 4.0 * METER * (number // 8)
        alone = {"material": Material(friction=0.0, restitution=1.0), "filter": Filter(1 << number, 1 << number)}
        place = (x - 1.5 * METER - further, y)
        one = side.world.add_body(Circle(DISC), position=place, velocity=(speed, 0.0), **alone)
        side.world.add_body(Circle(DISC), position=(x, y + offset * 2.0 * DISC), **alone)
        side.kept["pairs"].append((one, offset, speed))


def glance(side):
    """Return the greatest error of a moving disc's velocity after its collision [% of its initial speed].

    The exact velocity follows from the line of centres at the first touch. side: one of the page's two worlds
    (page.Side).
    """
    worst = 0.0
    for disc, offset, speed in side.kept["pairs"]:
        nx, ny = sqrt(1.0 - offset * offset), offset
        vx, vy = disc.velocity
        if (vx, vy) != (speed, 0.0):
            worst = max(worst, 100.0 * hypot(vx - speed * (1.0 - nx * nx), vy + speed * nx * ny) / speed)
    return worst


def build_slope(side, share):
    """Build a box on a slope of 30 degrees.

    share: friction between box and slope, divided by the least friction that holds the box; side: one of the page's two
    worlds (page.Side).
    """
    material = Material(friction=share * tan(SLOPE))
    c, s = cos(SLOPE), sin(SLOPE)
    plank = Polygon.box(40.0 * METER, 2.0 * METER)
    side.world.add_body(plank, position=(-s * METER, c * METER), angle=SLOPE, kind="static", material=material)
    place = (0.5 * METER * s, -0.5 * METER * c)
    side.kept["box"] = side.world.add_body(Polygon.box(METER, METER), position=place, angle=SLOPE, material=material)
    side.kept["at"] = None


def creep(side):
    """Return the distance that the box has moved since the end of the first second [mm].

    side: one of the page's two worlds (page.Side).
    """
    x, y = side.kept["box"].position
    if side.steps == SETTLED:
        side.kept["at"] = x, y
    if side.kept["at"] is None:
        return 0.0
    return MM * hypot(x - side.kept["at"][0], y - side.kept["at"][1])


def pieces(ground):
    """Return the pieces of level ground with its surface at y = 0, a list of (x [px], shape).

    ground: kind of the pieces, "grids", "boxes" or "chains".
    """
    half, long = TILES // 2, 4
    return {
        "grids": [(TILE * half * k, TileGrid(np.ones((1, half), bool), TILE)) for k in range(2)],
        "boxes": [(TILE * k, Polygon.box(TILE, TILE, (TILE / 2, TILE / 2))) for k in range(TILES)],
        "chains": [(TILE * k, Chain([(TILE * link, 0.0) for link in range(long + 1)])) for k in range(0, TILES, long)],
    }[ground]


def build_seams(side, speeds=SLIDING):
    """Build three lanes of level ground in pieces, with four sliding bodies on each.

    speeds: speed of the sliding bodies in each lane [px/s]; side: one of the page's two worlds (page.Side).
    """
    smooth = Material(friction=0.0)
    side.kept.update(chance=np.random.default_rng(6), speeds=speeds, sliders=[], lost=0.0, hop=0.0)
    for lane, ground in enumerate(GROUNDS):
        for x, shape in pieces(ground):
            side.world.add_body(shape, position=(x, LANE * lane), kind="static", filter=Filter(1), material=smooth)
        for number, (shape, high) in enumerate(SLIDERS):
            place = (TILE + APART * number, LANE * lane - high)
            only_ground = Filter(2 << number, 1)
            slider = side.world.add_body(shape, position=place, material=smooth, filter=only_ground)
            side.kept["sliders"].append((slider, place, speeds[lane]))


def slide(side):
    """Every LAP steps, move the sliding bodies back to their starts, shifted at random by at most one step's motion.

    side: one of the page's two worlds (page.Side).
    """
    if side.steps % LAP == 0:
        side.kept["tripped"] = set()
        for slider, (x, y), speed in side.kept["sliders"]:
            slider.move_to((x + side.kept["chance"].uniform(0.0, speed / 60.0), y), 0.0)
            slider.velocity, slider.angular_velocity = (speed, 0.0), 0.0


def slowed(side):
    """Return the greatest change of a sliding body's horizontal speed [% of its speed at the start].

    Also mark each position at which a body has lost more than TRIPPED, and record the greatest height of a hop. side:
    one of the page's two worlds (page.Side).
    """
    kept, worst = side.kept, 0.0
    for slider, (_, y), speed in kept["sliders"]:
        lost = 100.0 * abs(slider.velocity[0] - speed) / speed
        worst, kept["hop"] = max(worst, lost), max(kept["hop"], y - slider.position[1])
        if lost > TRIPPED and slider.id not in kept["tripped"]:
            kept["tripped"].add(slider.id)
            side.mark(slider.position, good=False)
    return worst


def hop_text(side):
    """Return the greatest height to which a sliding body has hopped, as text.

    side: one of the page's two worlds (page.Side).
    """
    return f"hops of {side.kept['hop']:.2f} px at most"


PAGES = (
    Page(
        "bounce",
        "Seventeen bounces of e = 1",
        "Left each bounce is lower; right the ball comes back to where it fell from.",
        "Left is reflected where the step ends, pushed out of the floor; right meets the floor within the step.",
        PUSHED,
        SOFT,
        Effects(response=True, gravity=True, restitution=True, stacking=True),
        build_ball,
        apex,
        "% of the height",
        1.0,
        690,
        (0.0, -0.35 * METER, 3.0 * METER),
    ),
    Page(
        "discs",
        "Glancing blows",
        "Discs strike others off their middle: left some leave by a wrong angle.",
        "The normal is that of the moment when they touch, within the step, not of the overlap at its end.",
        PUSHED,
        SOFT,
        Effects(response=True, restitution=True, stacking=True),
        build_discs,
        glance,
        "% of the speed",
        3.0,
        90,
        (17.5 * METER, 3.0 * METER, 44.0 * METER),
        judged=LAST,
    ),
    Page(
        "slope",
        "A box just below its friction angle",
        "Friction is 1 % more than holds the box: left it creeps, right it stays.",
        "Each step lets the box fall a little before friction answers; kept forces answer before it has moved.",
        PUSHED,
        SOFT,
        Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True),
        lambda side: build_slope(side, 1.01),
        creep,
        "mm down the slope",
        0.05,
        300,
        (0.0, 0.0, 8.0 * METER),
    ),
    Page(
        "seams",
        "Level ground in pieces",
        "Two tile grids, 24 boxes, six chains, all level: left boxes trip at seams, right nothing does.",
        "Sunk in by a hair, a corner meets the side of the next piece; right such contacts at seams are dropped.",
        PLAIN,
        SOFT,
        Effects(response=True, gravity=True, rotation=True, stacking=True),
        build_seams,
        slowed,
        "% of the speed",
        0.1,
        3 * LAP,
        (TILE * TILES / 2, 0.95 * LANE, TILE * TILES),
        act=slide,
        also=hop_text,
    ),
)
