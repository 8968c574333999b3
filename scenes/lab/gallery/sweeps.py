"""Gallery pages about fast bodies: a thin wall, spinning rods, bullets that meet, a sensor one pixel wide.

In all functions, `side` is a Side: one of the page's two worlds while it runs.
"""

import numpy as np

from game.measure.rates import Rate
from physics import Capsule, Circle, Effects, Polygon
from scenes.lab.gallery.page import LAST, Page, Way

EVERY = 2  # steps between shots
REACH = 200.0  # [px] range of a shot
LANES = 9
LANE = 14.0  # [px]
RADIUS, WALL = 3.0, 2.0  # [px]
FAST = 3600.0  # [px/s]: 60 px a step
ROD, SPIN = 26.0, 44.0  # [px] half its length; [rad/s]: 0.7 rad per step
PEG = 2.0  # [px] radius
TURN = 6  # steps within which a rod must have met its peg
SEEN = Effects(narrowphase=False, sensors=True, continuous=True)  # sensors test shapes by themselves
PUSHED = Effects(response=True, stacking=True, continuous=True)


def chance(side):
    """Return the NumPy random generator of a side. Both sides have the same seed, so that they get the same numbers.

    side: one of the page's two worlds (page.Side).
    """
    return side.kept.setdefault("chance", np.random.default_rng(3))


def build_wall(side):
    """Reset the counts, and build one thin wall across all lanes. side: one of the page's two worlds (page.Side)."""
    side.kept.update(fired=0, through=0, flying={})
    height = LANES * LANE + 20.0
    side.world.add_body(Polygon.box(WALL, height), position=(0.0, 0.0), kind="static")


def shoot(side):
    """Shoot a ball at the wall every EVERY steps. Count and remove the balls that have been stopped or have passed.

    The start varies by the distance of one step, so that impacts occur at any time within a step. side: one of the
    page's two worlds (page.Side).
    """
    for identity in list(side.kept["flying"]):
        body = side.world.body(identity)
        x, _ = body.position
        if x > REACH / 2 or body.velocity[0] < 0.5 * FAST:
            count(side, body.position, x > 0.0)
            del side.kept["flying"][identity]
            side.world.remove_body(identity)
    if side.steps % EVERY == 0:
        number = side.steps // EVERY
        x = -REACH / 2 - chance(side).uniform(0.0, FAST / 60)
        y = (number % LANES - (LANES - 1) / 2) * LANE
        body = side.world.add_body(
            Circle(RADIUS), position=(x, y), velocity=(FAST, 0.0), continuous=side.way.bodies["continuous"]
        )
        side.kept["flying"][body.id] = number


def count(side, place, missed):
    """Count a shot that has ended at the position `place` (x, y) [px], and mark this position.

    missed: whether the shot missed a body that it had to hit; side: one of the page's two worlds (page.Side).
    """
    side.kept["fired"] += 1
    side.kept["through"] += missed
    side.mark(place, not missed)


def through(side):
    """Return the percentage of missed shots among all shots that have ended.

    A missed shot is one that did not hit a body that it had to hit. side: one of the page's two worlds (page.Side).
    """
    return 100.0 * side.kept["through"] / max(1, side.kept["fired"])


def shots(side):
    """Return the Rate of missed shots among all shots that have ended. side: one of the page's two worlds."""
    return Rate(side.kept["through"], side.kept["fired"])


def build_rods(side):
    """Reset the counts, and build the pegs, which the ends of the rods must strike. spin() adds the rods.

    side: one of the page's two worlds (page.Side).
    """
    side.kept.update(fired=0, through=0, flying={}, met=set())
    for lane in range(6):
        x, y = rod_place(lane)
        side.world.add_body(Circle(PEG), position=(x + 0.8 * ROD, y), kind="static")


def rod_place(lane):
    """Return the centre (x, y) [px] of the rod in lane number `lane`."""
    return (lane % 3 - 1) * 64.0, (lane // 3 - 0.5) * 64.0


def spin(side):
    """Replace all rods every TURN steps, and count those that missed their pegs.

    The new rods have random angles and rotate about their centres. side: one of the page's two worlds (page.Side).
    """
    side.kept["met"] |= {int(row[name]) for row in side.world.events.begin for name in ("body_a", "body_b")}
    if side.steps % TURN == 0:
        for identity in list(side.kept["flying"]):
            x, y = side.world.body(identity).position
            count(side, (x + 0.8 * ROD, y), identity not in side.kept["met"])
            side.world.remove_body(identity)
        side.kept["flying"].clear()
        side.kept["met"].clear()
        for lane in range(6):
            body = side.world.add_body(
                Capsule((-ROD, 0.0), (ROD, 0.0), 1.0),
                position=rod_place(lane),
                angle=-chance(side).uniform(0.25, 2.85),
                angular_velocity=SPIN,
                continuous=side.way.bodies["continuous"],
            )
            side.kept["flying"][body.id] = lane


def build_bullets(side):
    """Reset the counts. duel() adds the bullets. side: one of the page's two worlds (page.Side)."""
    side.kept.update(fired=0, through=0, flying={})


def duel(side):
    """Shoot two bullets at each other every EVERY steps, and count the pairs that met or missed.

    side: one of the page's two worlds (page.Side).
    """
    for one, other in list(side.kept["flying"].items()):
        a, b = side.world.body(one), side.world.body(other)
        met = a.velocity[0] < 0.5 * FAST
        if met or a.position[0] > REACH / 2:
            count(side, a.position if met else (0.0, a.position[1]), not met)
            del side.kept["flying"][one]
            side.world.remove_bodies([a, b])
    if side.steps % EVERY == 0:
        y = (side.steps // EVERY % LANES - (LANES - 1) / 2) * LANE
        ends = [REACH / 2 + chance(side).uniform(0.0, FAST / 60) for _ in range(2)]
        one, other = (
            side.world.add_body(
                Circle(RADIUS), position=(-way * end, y), velocity=(way * FAST, 0.0), bullet=side.way.bodies["bullet"]
            )
            for way, end in zip((1.0, -1.0), ends, strict=True)
        )
        side.kept["flying"][one.id] = other.id


def build_beam(side):
    """Reset the counts, and build a sensor one pixel wide. side: one of the page's two worlds (page.Side)."""
    side.kept.update(fired=0, through=0, flying={}, met=set())
    height = LANES * LANE + 20.0
    side.world.add_body(Polygon.box(1.0, height), kind="static", sensor=True, continuous=side.way.bodies["continuous"])


def cross(side):
    """Shoot a ball through the sensor every EVERY steps, and count the balls whose passage was not reported.

    side: one of the page's two worlds (page.Side).
    """
    side.kept["met"] |= {int(row[name]) for row in side.world.events.sensor_begin for name in ("body_a", "body_b")}
    for identity in list(side.kept["flying"]):
        x, y = side.world.body(identity).position
        if x > REACH / 2:
            count(side, (0.0, y), identity not in side.kept["met"])
            del side.kept["flying"][identity]
            side.world.remove_body(identity)
    if side.steps % EVERY == 0:
        x = -REACH / 2 - chance(side).uniform(0.0, FAST / 60)
        y = (side.steps // EVERY % LANES - (LANES - 1) / 2) * LANE
        body = side.world.add_body(
            Circle(RADIUS), position=(x, y), velocity=(FAST, 0.0), continuous=side.way.bodies["continuous"]
        )
        side.kept["flying"][body.id] = y


FIELD = (0.0, 0.0, 240.0)
PAGES = (
    Page(
        "wall",
        "A thin wall",
        "Balls of 6 px fly 60 px a step at a wall of 2 px: left most are through.",
        "Tested where it stands, 1 - (w + 2 r) / (v dt) = 87 % of the shots are never seen to touch; swept, each is.",
        Way("not swept", bodies={"continuous": "off"}),
        Way("time of impact", bodies={"continuous": "toi"}),
        PUSHED,
        build_wall,
        through,
        "% came through",
        0.5,
        300,
        FIELD,
        act=shoot,
        judged=LAST,
        rate=shots,
    ),
    Page(
        "rods",
        "Rods that spin past a peg",
        "Rods turn on the spot and must strike their pegs: left most go past unseen.",
        "Swept along its way alone, what only turns does not move at all; its ends do, 18 px a step.",
        Way("swept, not turning", bodies={"continuous": "swept"}),
        Way("time of impact, turning", bodies={"continuous": "toi"}),
        PUSHED.with_(rotation=True),
        build_rods,
        through,
        "% went past",
        0.5,
        300,
        FIELD,
        act=spin,
        judged=LAST,
        rate=shots,
    ),
    Page(
        "bullets",
        "Bullets that meet",
        "Bullets fly at each other, 120 px nearer a step: left most pass through.",
        "What is fast is swept against what stands; bullet=True sweeps it against what is fast as well.",
        Way("continuous alone", bodies={"bullet": False}),
        Way("bullet=True", bodies={"bullet": True}),
        PUSHED,
        build_bullets,
        through,
        "% passed",
        0.5,
        300,
        FIELD,
        act=duel,
        judged=LAST,
        rate=shots,
    ),
    Page(
        "beam",
        "A beam of one pixel",
        "Balls cross a sensor of 1 px at 60 px a step: left most are not reported.",
        "Left events come from where a step ends, right from the way between: each entry, with its exit.",
        Way("where it stands", bodies={"continuous": "off"}),
        Way("swept", bodies={"continuous": "swept"}),
        SEEN,
        build_beam,
        through,
        "% untold",
        0.5,
        300,
        FIELD,
        act=cross,
        judged=LAST,
        rate=shots,
    ),
)
