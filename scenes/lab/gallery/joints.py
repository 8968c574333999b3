"""Gallery pages about joints under load: a ball on a chain, a cantilever, a doll on stairs, a bridge that breaks.

Both sides have the same substeps. At the left joints are solved one after another, at the right all joints of a tree at
once. In all functions, `side` is a Side: one of the page's two worlds while it runs.
"""

from math import atan2, cos, degrees, dist, hypot, sin
from typing import Any

import numpy as np

from game.measure.moment import widest_gap
from physics import Circle, Effects, Filter, Polygon, Revolute, Weld
from scenes.lab.gallery.page import METER, MM, Page, Way
from scenes.lab.machines.doll import Doll

SUBSTEPS = {"substeps": 4}
ITERATIVE = Way('joint_solver="iterative"', SUBSTEPS, joint_solver="iterative")
DIRECT = Way('joint_solver="direct"', SUBSTEPS, joint_solver="direct")
JOINED = Effects(response=True, gravity=True, rotation=True, stacking=True, narrowphase=False, joints=True)
ALONE = Filter(1, 0)  # bodies that pass through each other
LINKS, RATIO, LINK = 12, 1000.0, 0.25 * METER  # of the chain; mass of the ball [links]; thickness of a link
RADIUS = 1.0 * METER  # of the ball
BEAMS, BEAM = 8, 0.25 * METER  # of the cantilever; their thickness
DIGITS = 9  # [decimals of mm] a place of 256 px has twelve
RUSH = 140.0  # [px/s] of the doll
PLANKS, LONG, THICK = 20, 0.5 * METER, 0.15 * METER  # of the bridge
SPAN = 9.5 * METER
BALL = 50.0  # [planks] weight of the ball that hangs in the middle
STRONGEST = 150.0  # [planks] the load that breaks the bridge, by statics
GROWTH = 0.4  # [planks] of the load per step


def along(distance, angle, x=0.0, y=0.0):
    """Return the point (x, y) at a distance from a start point.

    distance: the distance [px]; angle: direction from the start point, clockwise from the right [rad]; x, y: the start
    point.
    """
    return x + distance * cos(angle), y + distance * sin(angle)


def rod(side, start, end, thick):
    """Add a box that reaches from `start` (x, y) to `end` (x, y) [px], and return its body.

    The box collides with no other body. thick: its thickness [px]; side: one of the page's two worlds (page.Side).
    """
    (ax, ay), (bx, by) = start, end
    shape, middle = Polygon.box(dist(start, end), thick), ((ax + bx) / 2, (ay + by) / 2)
    return side.world.add_body(shape, position=middle, angle=atan2(by - ay, bx - ax), filter=ALONE)


def build_row(side, kind, count, thick, angle):
    """Build a straight row of rods of 1 m, and return the last rod's body.

    A joint connects the first rod to the world, and each other rod to the rod before it. kind: class of the joints;
    count: number of rods; thick: their thickness [px]; angle: angle of the row, clockwise from the right [rad]; side:
    one of the page's two worlds (page.Side).
    """
    last: Any = None
    for k in range(count):
        at = along(METER * k, angle)
        body = rod(side, at, along(METER * (k + 1), angle), thick)
        side.world.add_joint(kind(last, body, at=at))
        last = body
    return last


def build_chain(side, angle=0.0, ratio=RATIO):
    """Build a straight chain of 12 links, and at its end a ball that is `ratio` times as heavy as a link.

    angle: direction of the chain, clockwise from the right [rad]; side: one of the page's two worlds (page.Side).
    """
    last = build_row(side, Revolute, LINKS, LINK, angle)
    at = along(LINKS * METER, angle)
    ball = side.world.add_body(Circle(RADIUS), position=at, mass=ratio * last.mass, filter=ALONE)
    side.world.add_joint(Revolute(last, ball, at=at))


def gap(side):
    """Return the widest gap between the two anchors of a joint [mm]. side: one of the page's two worlds (page.Side)."""
    return MM * widest_gap(side.world)


def build_cantilever(side, angle=0.0):
    """Build a cantilever of eight beams of 1 m. A weld connects the first beam to the world, and each other to the beam
    before.

    angle: direction of the cantilever, clockwise from the right [rad]; side: one of the page's two worlds (page.Side).
    """
    last = build_row(side, Weld, BEAMS, BEAM, angle)
    side.kept.update(last=last, tip=along(BEAMS * METER, angle))


def sag(side):
    """Return the distance between the cantilever's tip and its starting position [mm].

    side: one of the page's two worlds (page.Side).
    """
    off = MM * dist(side.kept["last"].to_world((METER / 2, 0.0)), side.kept["tip"])
    return round(off, DIGITS)


def build_doll(side, speed=RUSH):
    """Build the stairs and the doll of lab/joints.

    speed: speed of the doll to the right [px/s]; side: one of the page's two worlds (page.Side).
    """
    doll = side.kept["doll"] = Doll(side.world)
    for part in doll.parts.values():
        part.velocity = (speed, 0.0)


def gap_of_doll(side):
    """Return the widest gap of the doll's joints [mm]. If it is beyond the limit, mark that joint.

    side: one of the page's two worlds (page.Side).
    """
    doll = side.kept["doll"]
    doll.note()
    found = MM * doll.recent
    if found > side.page.limit:
        joint = side.world.joint(int(side.world.joints["id"][np.argmax(side.world.joints["separation"])]))
        side.mark(joint.anchor_a, good=False)
    return found


def limits_text(side):
    """Return the greatest angle by which a hinge has exceeded its limits so far, as text.

    side: one of the page's two worlds (page.Side).
    """
    return f"limits exceeded by {degrees(side.kept['doll'].excess):.1f} deg"


def hanging(load):
    """Return (angles, pull) of the bridge at rest under a load, by statics.

    load: weight of the load in the middle [weights of a plank]; angles: angles of the planks of the left half [rad];
    pull: force on the bridge's ends, in the unit of the load. A plank points along the mean of the forces at its two
    ends. The horizontal part of these forces is the same in all planks. Bisection finds the horizontal part for which
    the bridge spans the gap.
    """
    upright = 0.5 * (PLANKS + load) - np.arange(PLANKS // 2) - 0.5  # mean of the vertical forces at a plank's ends
    low, high = 0.0, 100.0 * (PLANKS + load)
    for _ in range(100):
        level = 0.5 * (low + high)
        wide = 2.0 * LONG * (level / np.hypot(upright, level)).sum()
        low, high = (level, high) if wide < SPAN else (low, level)
    return np.arctan2(upright, level), hypot(level, 0.5 * (PLANKS + load))


def build_bridge(side, strongest=STRONGEST):
    """Build a bridge of planks with an iron ball at its centre, in the pose in which rigid planks hang.

    strongest: load at which the bridge breaks by statics [weights of a plank]; side: one of the page's two worlds
    (page.Side).
    """
    turns, _ = hanging(BALL)
    place, places = (-SPAN / 2, 0.0), [(-SPAN / 2, 0.0)]
    for turn in (*turns, *-turns[::-1]):
        place = along(LONG, turn, *place)
        places.append(place)
    planks = [rod(side, *ends, THICK) for ends in zip(places, places[1:], strict=False)]
    weight = planks[0].mass * side.world.gravity[1]
    ends = zip([None, *planks], [*planks, None], places, strict=True)
    for a, b, at in ends:
        side.world.add_joint(Revolute(a, b, at=at, breaks=(hanging(strongest)[1] * weight, None)))
    middle = PLANKS // 2
    ball = side.world.add_body(Circle(0.5 * METER), position=places[middle], mass=BALL * planks[0].mass, filter=ALONE)
    side.world.add_joint(Revolute(planks[middle], ball, at=places[middle]))
    for x in (-1.0, 1.0):
        bank = Polygon.box(4.0 * METER, 12.0 * METER)
        side.world.add_body(bank, position=(x * (SPAN / 2 + 2.0 * METER), 6.0 * METER), kind="static", filter=ALONE)
    side.kept.update(ball=ball, weight=weight, load=BALL, strongest=strongest, broken=False)


def load_bridge(side):
    """Increase the load on the bridge by GROWTH for this step, unless the bridge is broken.

    The load consists of the ball's weight and a force on the ball. side: one of the page's two worlds (page.Side).
    """
    kept = side.kept
    kept["broken"] |= len(side.world.events.broken) > 0
    if not kept["broken"]:
        kept["load"] += GROWTH
        kept["ball"].apply_force((0.0, (kept["load"] - BALL) * kept["weight"]))


def off_the_load(side):
    """Return the error of the load at which the bridge breaks [% of the breaking load by statics].

    While the bridge holds, the error is the amount by which the present load exceeds the breaking load. It is 0 below
    the breaking load. side: one of the page's two worlds (page.Side).
    """
    kept = side.kept
    excess = 100.0 * (kept["load"] / kept["strongest"] - 1.0)
    broken = kept["broken"] or len(side.world.events.broken) > 0
    return abs(excess) if broken else max(0.0, excess)


def load_text(side):
    """Return the load that the bridge holds, or the load at which it broke, as text.

    side: one of the page's two worlds (page.Side).
    """
    words = "broke at" if side.kept["broken"] else "holds"
    return f"{words} {side.kept['load']:.0f} planks' weight"


PAGES = (
    Page(
        "chain",
        "A ball on a chain, 1000 : 1",
        "A ball of a thousand links' mass swings: left the chain is torn apart, right it stays whole.",
        "One joint after another, a pull passes few links a pass; solved as a tree, all links share it at once.",
        ITERATIVE,
        DIRECT,
        JOINED,
        build_chain,
        gap,
        "mm widest gap",
        20.0,
        480,
        (0.0, 5.0 * METER, 28.0 * METER),
    ),
    Page(
        "cantilever",
        "A cantilever of welds",
        "Eight beams of one metre, welded: left the tip sags, right it stays in its place.",
        "The first weld bears a moment of all eight beams; welds solved in turn give way under it.",
        ITERATIVE,
        DIRECT,
        JOINED,
        build_cantilever,
        sag,
        "mm off at the tip",
        20.0,
        300,
        (4.0 * METER, 1.5 * METER, 10.0 * METER),
    ),
    Page(
        "stairs",
        "A doll falls down stairs",
        "Ten parts on nine hinges: left they part where a limb strikes a step, right they hold.",
        "A knock has to pass along the limbs within a step; red dots are gaps beyond the limit.",
        ITERATIVE,
        DIRECT,
        JOINED.with_(narrowphase=True, friction=True),
        build_doll,
        gap_of_doll,
        "mm widest gap",
        10.0,
        240,
        (-45.0, -94.0, 310.0),
        act=lambda side: side.kept["doll"].control(),
        also=limits_text,
    ),
    Page(
        "bridge",
        "A bridge breaks",
        "A load on a bridge grows: right it breaks at the load of statics, left it gapes and holds.",
        "Joints that gape let the bridge sag, and a deeper bridge is pulled less by the same load.",
        ITERATIVE,
        DIRECT,
        JOINED,
        build_bridge,
        off_the_load,
        "% off the load",
        2.0,
        420,
        (0.0, 3.0 * METER, 13.0 * METER),
        act=load_bridge,
        also=load_text,
    ),
)
