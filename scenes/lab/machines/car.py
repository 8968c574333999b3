"""A car with a trailer, and a hill, one of the machines of lab/joints."""

from math import radians, tan

from physics import Circle, Drive, Material, Polygon, Revolute, Spring, Wheel
from scenes.lab.machines.machine import CORAL, GRAVITY, STEEL, TEAL, Machine

SLOPE = radians(30.0)
FOOT, CREST = 150.0, 18.0  # [px] from the middle: where the hill begins, and half of its flat top
HILL = (FOOT - CREST) * tan(SLOPE)
RADIUS = 11.0
START = -176.0
SPEED = 9.0  # [rad/s] of the wheels
TURN_AT = 196.0  # [px] from the middle: there it drives back
SUSPENSION = Spring(5.0, 0.7)
TYRE = Material(friction=1.6)
BODY = ((-34, 4), (-34, -8), (-10, -20), (16, -20), (36, -8), (36, 4))


class Car(Machine):
    """A car on sprung wheels with motors, and a trailer on a hinge."""

    name = "car"
    seen = "Sprung wheels with motors; the trailer hangs on a hinge."
    starts = "drives over the hill and back"
    breaks = "breaks the hitch"

    def build(self):
        """Build the hill, the car, and its trailer."""
        hill = Polygon([(-FOOT, 0), (-CREST, -HILL), (CREST, -HILL), (FOOT, 0)])
        self.fixed(hill, 0.0, 0.0, material=Material(friction=0.9))
        y = -RADIUS - 9.0
        self.chassis = self.add(Polygon(BODY), START, y, CORAL, material=Material(density=1.0))
        self.trailer = self.add(Polygon.box(40, 12), START - 66.0 + 8, y - 2, TEAL, material=Material(density=0.4))
        self.axles = [self._wheel(self.chassis, START + x) for x in (-22, 24)]
        self._wheel(self.trailer, START - 66.0 + 2)
        self.hitch = self.world.add_joint(Revolute(self.chassis, self.trailer, at=(START - 35, y + 2)))
        self.weak = [self.hitch]
        self.way, self.highest, self.mass = 1, 0.0, self.chassis.mass + self.trailer.mass
        self.crossed = 0

    def _wheel(self, frame, x):
        wheel = self.add(Circle(RADIUS), x, -RADIUS, STEEL, material=TYRE)
        return self.world.add_joint(Wheel(frame, wheel, at=(x, -RADIUS), spring=SUSPENSION, limits=(-6, 6)))

    def drive(self):
        """Drive in the current direction, or brake if the machine does not run.

        The torque of a wheel gives a force of twice the car's weight at its rim.
        """
        torque = 2.0 * self.mass * GRAVITY * RADIUS
        for axle in self.axles:
            if self.holds(axle):
                axle.motor = Drive(self.way * SPEED if self.running else 0.0, max=torque)

    def control(self):
        """Reverse the direction when the car reaches one of the two ends of its route."""
        x = self.chassis.center.x
        if (x > TURN_AT and self.way > 0) or (x < -TURN_AT + 56 and self.way < 0):
            self.way, self.crossed = -self.way, self.crossed + 1
            self.drive()

    def measure(self):
        """Record the greatest height of the chassis."""
        self.highest = max(self.highest, -self.chassis.center.y)

    def figure(self):
        """Return the current height of the chassis above its start, and the number of crossings, as text."""
        return f"up {max(0.0, -self.chassis.center.y - RADIUS - 9):.0f} px, crossed {self.crossed}x"

    def figures(self):
        """Return (greatest height of the chassis [px], number of crossings of the hill)."""
        return self.highest, self.crossed

    def handle(self):
        """Return the centre (x, y) [px] of the chassis, at which the bot drags the car."""
        return tuple(self.chassis.center)

    @classmethod
    def goals(cls, iterative, direct):
        """Return the machine's goals, a list of (text, whether it is met, measured value as text).

        The car climbs the hill of 30 degrees, the axles hold, and the hitch breaks. iterative, direct: results (widest
        gap [px], broken joints, *figures()) with each joint solver, or None.
        """
        gap, broken, highest, _ = direct or (9.0, 0, 0.0, 0)
        return [
            ("it climbs 30 degrees", highest > HILL, f"{highest:.0f} of {HILL:.0f} px"),
            ("axles and hitch hold", gap < 0.5, f"{gap:.4f} px"),
            ("the hitch breaks", broken == 1, f"{broken} joints"),
        ]
