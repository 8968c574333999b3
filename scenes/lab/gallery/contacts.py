"""Gallery pages about contacts that must not add speed or energy: a gate, a bowl, an eccentric wheel.

In all functions, `side` is a Side: one of the page's two worlds while it runs.
"""

from math import cos, hypot, pi, sin

import numpy as np

from physics import Chain, Circle, Effects, Filter, Material, Polygon
from scenes.lab.gallery.page import METER, PLAIN, SOFT, Page, Way, floor
from scenes.lab.gallery.simulated import SEEN_ONLY, step_naively

CRATE, GATE_SIZE = 20.0, (16.0, 100.0)  # [px]
GATES = (-90.0, 0.0, 90.0)  # [px] middles
OFFSETS = (0.0, 3.0, 6.0)  # [px] of each crate from the middle of its gate
GATE_SPEED = 240.0  # [px/s]
HIGH, LOW = 80.0, 10.0  # [px] lower edge over the floor: open, closed on half a crate
PUSH_OUT = 3.0 * METER  # [px/s] fastest separation of overlapping bodies
FALL = 100.0  # [px/s] after a fall of 16 px
ROUND, OPENS = 100, 60  # steps between two starts of the gates; step of a round at which they open
RIM, LINKS = 400.0, 240  # [px] radius of the bowl; its links
GAP = 0.05  # [px] between the disc and the bowl
WHEEL, HEAVY, OUT, DENSE = 25.0, 5.0, 17.0, 60.0  # [px] radii of wheel and heavy part; distance; density
SUBSTEPS, SHARE = 4, 0.2  # of the simulated wheel; the share of Box2D Lite


def build_gates(side, speed=GATE_SPEED):
    """Build three gates and a crate under each.

    speed: speed of the gates [px/s]; side: one of the page's two worlds (page.Side).
    """
    floor(side.world)
    side.kept.update(chance=np.random.default_rng(4), speed=speed, gates=[], crates=[])
    for number, (x, offset) in enumerate(zip(GATES, OFFSETS, strict=True)):
        mine = Filter(2 << number, 1)  # a crate that is thrown passes the others
        gate = side.world.add_body(Polygon.box(*GATE_SIZE), position=(x, -HIGH - GATE_SIZE[1] / 2), kind="kinematic")
        crate = side.world.add_body(Polygon.box(CRATE, CRATE), position=(x + offset, -CRATE / 2), filter=mine)
        side.kept["gates"].append(gate)
        side.kept["crates"].append(crate)


def move_gates(side):
    """Set the velocities of the gates, which sink onto the crates and rise again once in each round of ROUND steps.

    At the start of a round, the gates and crates return to their starting positions. A random shift of the gates varies
    the time within a step at which they meet the crates. side: one of the page's two worlds (page.Side).
    """
    step, speed = side.steps % ROUND, side.kept["speed"]
    if step == 0:
        for number, (gate, crate) in enumerate(zip(side.kept["gates"], side.kept["crates"], strict=True)):
            above = side.kept["chance"].uniform(0.0, speed / 60.0)
            gate.move_to((GATES[number], -HIGH - GATE_SIZE[1] / 2 - above), 0.0)
            crate.move_to((GATES[number] + OFFSETS[number], -CRATE / 2), 0.0)
            crate.velocity, crate.angular_velocity = (0.0, 0.0), 0.0
    for gate in side.kept["gates"]:
        lower = -gate.position[1] - GATE_SIZE[1] / 2
        if step < OPENS:
            gate.velocity = (0.0, speed if lower > LOW else 0.0)
        else:
            gate.velocity = (0.0, -speed if lower < HIGH else 0.0)


def step_crates(side):
    """Step the crates with a naive solver.

    It removes the whole overlap in one step by a velocity, which the crates keep afterwards. side: one of the page's
    two worlds (page.Side).
    """
    step_naively(side, side.kept["crates"], 1, 1.0)


def thrown(side):
    """Return the speed of the fastest crate [px/s], and mark crates that are faster than the limit.

    side: one of the page's two worlds (page.Side).
    """
    speeds = [hypot(*crate.velocity) for crate in side.kept["crates"]]
    for crate, speed in zip(side.kept["crates"], speeds, strict=True):
        if speed > side.page.limit:
            side.mark(crate.position, good=False)
    return max(speeds)


def build_bowl(side, radius=20.0, turn=0.7):
    """Build a bowl, a chain of 240 links, and a disc at rest on the inside of the bowl.

    radius: radius of the disc [px]; turn: position of the disc on the half circle, from 0 (right end) to 1 (left end);
    side: one of the page's two worlds (page.Side).
    """
    corners = [(RIM * cos(at), RIM * sin(at)) for at in np.linspace(pi, 0.0, LINKS + 1)]
    side.world.add_body(Chain(corners), kind="static")
    reach = RIM - GAP - radius
    place = reach * cos(turn * pi), reach * sin(turn * pi)
    begin_energy(side, side.world.add_body(Circle(radius), position=place), RIM - radius)


def build_wheel(side, angle=1.3):
    """Build a wheel with a heavy part beside its centre, rotated by `angle` [rad] from its equilibrium.

    side: one of the page's two worlds (page.Side).
    """
    floor(side.world)
    heavy = Circle(HEAVY, (0.0, OUT)).with_(material=Material(density=DENSE))
    wheel = side.world.add_body(Circle(WHEEL), heavy, position=(0.0, -WHEEL), angle=angle)
    row = side.world.bodies[side.world.rows([wheel.id])[0]]
    out = hypot(row["center_x"] - row["x"], row["center_y"] - row["y"])
    begin_energy(side, wheel, -WHEEL + float(out))


def step_wheel(side):
    """Step the wheel with a naive solver, which removes a fifth of an overlap per step and uses four substeps.

    side: one of the page's two worlds (page.Side).
    """
    step_naively(side, [side.kept["body"]], SUBSTEPS, SHARE)


def begin_energy(side, body, bottom):
    """Select the body whose energy is measured, and record its energy at the start.

    bottom: greatest y [px] that its centre of mass can reach; side: one of the page's two worlds (page.Side).
    """
    side.kept.update(body=body, bottom=bottom, way=0.0, share=1.0, most=0.0)
    side.kept["start"] = energy(side)


def energy(side):
    """Return the kinetic and potential energy of the measured body [mass px2/s2]; 0 at rest in its lowest position.

    side: one of the page's two worlds (page.Side).
    """
    row = side.world.bodies[side.world.rows([side.kept["body"].id])[0]]
    moving = row["mass"] * (row["vx"] ** 2 + row["vy"] ** 2) + row["inertia"] * row["angular_velocity"] ** 2
    height = side.kept["bottom"] - row["center_y"]
    return float(0.5 * moving + row["mass"] * side.world.gravity[1] * height)


def share(side):
    """Return the energy of the measured body divided by its energy at the start.

    If the body reverses its direction, mark its position. side: one of the page's two worlds (page.Side).
    """
    kept = side.kept
    kept["share"] = energy(side) / kept["start"]
    kept["most"] = max(kept["most"], kept["share"])
    way = kept["body"].velocity[0]
    if way * kept["way"] < 0.0:
        side.mark(kept["body"].position, side.holds)
    kept["way"] = way
    return kept["share"]


def changed(side):
    """Return the difference between the measured body's energy and its energy at the start, as a positive percentage.

    side: one of the page's two worlds (page.Side).
    """
    return 100.0 * abs(share(side) - 1.0)


def gained(side):
    """Return the energy that the measured body has gained since the start [%], 0 if it has lost energy.

    side: one of the page's two worlds (page.Side).
    """
    return 100.0 * max(0.0, share(side) - 1.0)


def energy_text(side):
    """Return a text with the measured body's current energy and its greatest energy so far, as shares of the first
    energy.

    side: one of the page's two worlds (page.Side).
    """
    return f"energy {100.0 * side.kept['share']:.1f} %, most {100.0 * side.kept['most']:.1f} %"


def limit_text(side):
    """Return the three speeds whose sum is the limit of the page "gate", as text.

    side: one of the page's two worlds (page.Side).
    """
    return f"gate {GATE_SPEED:.0f}, push-out {PUSH_OUT:.0f}, fall {FALL:.0f}"


SMOOTH = Effects(response=True, gravity=True, stacking=True)
ROUGH = SMOOTH.with_(rotation=True, friction=True)
PAGES = (
    Page(
        "gate",
        "A gate comes down on a crate",
        "Gates close on crates at 240 px/s: left some shoot away, right none is faster than a gate.",
        "Left what undoes an overlap is speed, and stays; right it is a motion of that step alone.",
        Way("simulated: overlap made speed", {"solver": "projection"}, without=SEEN_ONLY, step=step_crates),
        SOFT,
        ROUGH,
        build_gates,
        thrown,
        "px/s at most",
        GATE_SPEED + PUSH_OUT + FALL,
        2 * ROUND,
        (0.0, -80.0, 300.0),
        act=move_gates,
        also=limit_text,
    ),
    Page(
        "bowl",
        "To and fro in a bowl",
        "A smooth disc in a bowl of 240 links: left it rises less each time, right as high as at first.",
        "Left a step ends inside the wall and is put right afterwards; right the disc is held before it is inside.",
        PLAIN,
        SOFT,
        SMOOTH,
        build_bowl,
        changed,
        "% of its energy",
        1.0,
        600,
        (0.0, 330.0, 520.0),
        also=energy_text,
    ),
    Page(
        "wheel",
        "An eccentric wheel",
        "A wheel with a heavy part rocks: left it rolls further each time, right it does not.",
        "The arm from the centre of mass to the floor turns within a step; held as it was, it adds energy.",
        Way("simulated: arms of the step's start", {"solver": "projection"}, without=SEEN_ONLY, step=step_wheel),
        SOFT,
        ROUGH,
        build_wheel,
        gained,
        "% energy gained",
        0.5,
        600,
        (0.0, -45.0, 210.0),
        also=energy_text,
    ),
)
