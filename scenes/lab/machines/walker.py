"""Theo Jansen's walker: a crank moves six legs of rods and plates. It is one of the machines of lab/joints."""

from math import atan2, cos, hypot, pi, sin

from physics import Circle, Distance, Drive, Filter, Material, Polygon, Revolute
from scenes.lab.machines.machine import CORAL, GOLDEN, GRAVITY, STEEL, TEAL, VIOLET, Machine

UNIT = 11.0  # [px] a unit of the measures below, which are those of Box2D's sample (y up)
KNEE, HIP, TIE, FOOT = (7.2, -1.2), (3.1, 0.8), (4.3, -1.9), (5.4, -6.1)
TOP, SIDE = (2.5, 3.7), (6.0, 1.5)
CRANK = 0.8  # [units] radius
AXLE = (0.0, 0.8)  # of the crank, above the body's middle
PHASES = (0.0, 2 * pi / 3, 4 * pi / 3)
SPEED = 2.6  # [rad/s] of the crank
HEIGHT = 6.6  # [units] of the body's middle above the floor at the start
START = -90.0
TURN_AT = 130.0  # [px] from the middle: there it walks back
LEGS = Filter(2, 1)  # legs touch the floor and not one another
PLATES = (TEAL, VIOLET, CORAL)


def circles(a, b, ra, rb, side):
    """Return the intersection point of two circles: radius `ra` around `a`, radius `rb` around `b`.

    side: 1 or -1, the side of the line from `a` to `b` on which the point is.
    """
    dx, dy = b[0] - a[0], b[1] - a[1]
    far = hypot(dx, dy)
    along = (ra * ra - rb * rb + far * far) / (2.0 * far)
    across = side * (ra * ra - along * along) ** 0.5
    return a[0] + (along * dx - across * dy) / far, a[1] + (along * dy + across * dx) / far


def apart(a, b):
    """Return the distance between two points (x, y)."""
    return hypot(b[0] - a[0], b[1] - a[1])


def pose_of(points, places):
    """Return the pose (x, y, angle) of a body that places its first two points at two given positions.

    points: two points (x, y) in the body's space; places: their two positions.
    """
    (ax, ay), (bx, by) = points
    (px, py), (qx, qy) = places
    angle = atan2(qy - py, qx - px) - atan2(by - ay, bx - ax)
    return px - cos(angle) * ax + sin(angle) * ay, py - sin(angle) * ax - cos(angle) * ay, angle


class Walker(Machine):
    """A body with a crank, and three pairs of legs with two plates and two rods each."""

    name = "walker"
    seen = "Theo Jansen's legs: one crank moves six, by 24 rods."
    starts = "turns the crank"
    breaks = "breaks a leg off"

    def build(self):
        """Build the body, the crank, and the legs. The position of a leg's crank pin determines the leg's pose."""
        self.origin = (START, -HEIGHT * UNIT)
        body = Polygon.box(4.6 * UNIT, 1.8 * UNIT)
        self.chassis = self.add(body, *self.origin, STEEL, filter=LEGS, material=Material(density=1.0))
        axle = self.place(AXLE)
        self.wheel = self.add(Circle(1.3 * UNIT), *axle, GOLDEN, filter=LEGS)
        self.crank = self.world.add_joint(Revolute(self.chassis, self.wheel, at=axle))
        self.weak, self.mass = [], 0.0
        for phase, paint in zip(PHASES, PLATES, strict=True):
            for side in (-1, 1):
                self._leg(side, phase, paint)
        self.mass = float(self.world.bodies["mass"][self.world.bodies["kind"] == 2].sum())
        self.way, self.walked, self.last = 1, 0.0, self.chassis.center.x
        self.tilt = 0.0

    def place(self, point):
        """Return the world position (x, y) [px] of a point of the body.

        point: (x, y) in units of UNIT px, with y up.
        """
        return self.origin[0] + UNIT * point[0], self.origin[1] - UNIT * point[1]

    def _leg(self, side, phase, paint):
        """Add a leg on one side of the body: -1 left, 1 right.

        phase: angle of the leg's crank pin [rad]; paint: name of the colours of its plates.
        """
        pin = AXLE[0] + CRANK * sin(phase), AXLE[1] - CRANK * cos(phase)
        plan = {n: (side * x, y) for n, (x, y) in
                dict(knee=KNEE, hip=HIP, tie=TIE, foot=FOOT, top=TOP, side=SIDE).items()}  # fmt: skip
        reach = AXLE[0], AXLE[1] - CRANK  # the pin's place in the plan
        top = circles(plan["hip"], pin, apart(plan["hip"], plan["top"]), apart(reach, plan["top"]), -side)
        upper = pose_of((plan["hip"], plan["top"]), (plan["hip"], top))
        corner = moved(upper, plan["side"])
        tie = circles(plan["hip"], pin, apart(plan["hip"], plan["tie"]), apart(reach, plan["tie"]), side)
        knee = circles(tie, corner, apart(plan["tie"], plan["knee"]), apart(plan["side"], plan["knee"]), -side)
        lower = pose_of((plan["tie"], plan["knee"]), (tie, knee))
        foot = self._plate([plan["foot"], plan["knee"], plan["tie"]], lower, paint)
        thigh = self._plate([plan["hip"], plan["side"], plan["top"]], upper, paint)
        add, at = self.world.add_joint, self.place
        rods = [
            add(Distance(foot, thigh, at_a=at(knee), at_b=at(corner))),
            add(Distance(foot, self.chassis, at_a=at(tie), at_b=at(plan["hip"]))),
            add(Distance(foot, self.wheel, at_a=at(tie), at_b=at(pin))),
            add(Distance(thigh, self.wheel, at_a=at(top), at_b=at(pin))),
        ]
        hip = add(Revolute(thigh, self.chassis, at=at(plan["hip"])))
        if not self.weak:
            self.weak = [rods[0], rods[1], rods[2], hip, rods[3]]

    def _plate(self, corners, pose, paint):
        """Add a triangular plate, and return its body.

        corners: corners of the plate in its own space [units, y up]; pose: (x, y, angle) of the plate relative to the
        walker's body [units, y up]; paint: name of its colours.
        """
        x, y = self.place(pose[:2])
        shape = Polygon([(UNIT * cx, -UNIT * cy) for cx, cy in corners])
        material = Material(density=0.4, friction=1.2)
        return self.add(shape, x, y, paint, angle=-pose[2], filter=LEGS, material=material)

    def drive(self):
        """Turn the crank, or hold it if the machine does not run.

        The torque can lift 1.5 times the walker's weight at the crank's radius.
        """
        torque = 1.5 * self.mass * GRAVITY * CRANK * UNIT
        self.crank.motor = Drive(self.way * SPEED if self.running else 0.0, max=torque)

    def control(self):
        """Reverse the walking direction when the walker reaches one of the two ends of its route."""
        if (self.chassis.center.x - 0.0) * self.heading > TURN_AT:
            self.way = -self.way
            self.drive()

    @property
    def heading(self):
        """Direction in which the walker walks: 1 to the right, -1 to the left."""
        return WALKS * self.way

    def measure(self):
        """Add the walker's motion in this step to the distance walked [px], and record the body's greatest
        tilt [rad].
        """
        x = self.chassis.center.x
        if not self.disturbed:
            self.walked += (x - self.last) * self.heading
            self.tilt = max(self.tilt, abs(self.chassis.angle))
        self.last = x

    def figure(self):
        """Return the distance walked as text."""
        return f"walked {self.walked:.0f} px"

    def figures(self):
        """Return (distance walked [px], greatest tilt of the body [rad])."""
        return self.walked, self.tilt

    def handle(self):
        """Return the centre (x, y) [px] of the walker's body, at which the bot drags the walker."""
        return tuple(self.chassis.center)

    @classmethod
    def goals(cls, iterative, direct):
        """Return the machine's goals, a list of (text, whether it is met, measured value as text).

        The walker walks upright, its pins hold, and a leg breaks off. iterative, direct: results (widest gap [px],
        broken joints, *figures()) with each joint solver, or None.
        """
        gap, broken, walked, tilt = direct or (9.0, 0, 0.0, 9.0)
        return [
            ("the walker walks", walked > 60.0, f"{walked:.0f} px"),
            ("upright", tilt < 0.35, f"{tilt:.2f} rad"),
            ("pins and rods hold", gap < 1.0, f"{gap:.4f} px"),
            ("a leg breaks off", broken >= 3, f"{broken} joints"),
        ]


WALKS = 1  # direction of its walk when the crank turns clockwise


def moved(pose, point):
    """Return a point of a plate, transformed by the plate's pose (x, y, angle): rotated by the angle, then
    translated.
    """
    x, y, angle = pose
    return x + cos(angle) * point[0] - sin(angle) * point[1], y + sin(angle) * point[0] + cos(angle) * point[1]
