"""A doll with limits at its joints, which tumbles down stairs; one of the machines of lab/joints."""

from math import degrees

import numpy as np

from physics import Capsule, Circle, Drive, Filter, Polygon, Revolute
from scenes.lab.machines.machine import CORAL, GOLDEN, HALF, TEAL, VIOLET, Machine

STEPS, WIDE, HIGH = 4, 52.0, 26.0  # of the stairs [px]
TOP = -STEPS * HIGH
START = -HALF + 70.0
SPEED = 190.0  # [px/s] with which it comes
KICK, KICK_EVERY = 9.0, 40  # [rad/s] speed of the limbs, [steps] in each direction
STRONG = 60.0  # torso's weights times METER: greatest torque of a limb's motor
APART = Filter(2, 1)  # its parts touch the stairs and not one another
# name, place of its hinge, its end, half of its width, limits [rad], the part that it hangs on, colours
LIMBS = (
    ("upper arm", (-1, -24), (0, 20), 4.5, (-2.6, 2.6), "torso", TEAL),
    ("forearm", (-1, -4), (0, 18), 4.0, (-2.2, 0.0), "upper arm", CORAL),
    ("thigh", (-1, 12), (0, 22), 5.5, (-1.6, 0.7), "torso", VIOLET),
    ("shin", (-1, 34), (0, 22), 4.5, (0.0, 2.2), "thigh", TEAL),
)


class Doll(Machine):
    """A torso, a head, two arms and two legs on hinges with limits."""

    name = "doll"
    seen = "Ten parts on nine hinges with limits tumble down stairs."
    starts = "kicks and waves"
    breaks = "tears off head and arms"
    needs_motor = False

    def build(self):
        """Build the stairs, and the doll on the top step."""
        for k in range(STEPS):
            high = HIGH * (STEPS - k)
            self.fixed(Polygon.box(WIDE, high), -HALF + 50 + WIDE * (k + 0.5), -high / 2)
        self.fixed(Polygon.box(50, -TOP), -HALF + 25, TOP / 2)
        x, y = START, TOP - 58.0
        self.parts = {"torso": self.add(Capsule((0, -20), (0, 10), 9), x, y, GOLDEN, filter=APART)}
        self.parts["head"] = self.add(Circle(10), x, y - 39, CORAL, filter=APART)
        torso = self.parts["torso"]
        self.neck = self.world.add_joint(Revolute(torso, self.parts["head"], at=(x, y - 29), limits=(-0.6, 0.6)))
        self.limbs, shoulders = [], []
        for side in ("left", "right"):
            for name, (_, hinge), end, radius, limits, parent, paint in LIMBS:
                at = x, y + hinge
                body = self.add(Capsule((0, 0), end, radius), *at, paint, filter=APART)
                self.parts[f"{side} {name}"] = body
                held = torso if parent == "torso" else self.parts[f"{side} {parent}"]
                joint = self.world.add_joint(Revolute(held, body, at=at, limits=limits))
                self.limbs.append(joint)
                shoulders += [joint] if name == "upper arm" else []
        self.weak = [self.neck, *shoulders]
        for body in self.parts.values():
            body.velocity = (SPEED, 0.0)
        self.strong = STRONG * torso.mass * 32.0 * 9.8
        self.excess = 0.0

    def drive(self):
        """Set the motors that swing the limbs to and fro, or switch them off if the machine does not run."""
        for number, joint in enumerate(self.limbs):
            if self.holds(joint):
                way = 1 if (self.steps // KICK_EVERY + number // 4) % 2 else -1
                joint.motor = Drive(way * KICK, max=self.strong) if self.running else None

    def control(self):
        """Reverse the motors of the limbs every KICK_EVERY steps."""
        if self.running and self.steps % KICK_EVERY == 0:
            self.drive()

    def measure(self):
        """Record the greatest angle by which a joint has exceeded its limits, until the doll is dragged or broken."""
        rows = self.world.joints
        rows = rows[rows["coordinate"] == 1]
        over = np.maximum(rows["lower"] - rows["angle"], rows["angle"] - rows["upper"])
        if not self.disturbed:
            self.excess = max(self.excess, float(over.max(initial=0.0)))

    def figure(self):
        """Return the greatest angle by which a joint has exceeded its limits, as text."""
        return f"{degrees(self.excess):.2f} deg over limits"

    def figures(self):
        """Return (angle,): the greatest angle by which a joint has exceeded its limits [rad]."""
        return (self.excess,)

    def handle(self):
        """Return the centre (x, y) [px] of the torso, at which the bot drags the doll."""
        return tuple(self.parts["torso"].center)

    @classmethod
    def goals(cls, iterative, direct):
        """Return the machine's goals, a list of (text, whether it is met, measured value as text).

        Limits and pins hold on the way down the stairs, and head and arms come off. iterative, direct: results (widest
        gap [px], broken joints, *figures()) with each joint solver, or None.
        """
        gap, broken, excess = direct or (9.0, 0, 9.0)
        return [
            ("limits hold to six degrees", degrees(excess) < 6.0, f"{degrees(excess):.3f} deg"),
            ("pins hold", gap < 0.2, f"{gap:.4f} px"),
            ("head and arms come off", broken >= 3, f"{broken} joints"),
        ]
