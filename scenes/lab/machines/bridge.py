"""A bridge of planks with an iron ball on it, one of the machines of lab/joints."""

from itertools import pairwise
from math import atan2, cos, pi, sin

from physics import Circle, Material, Polygon, Revolute
from scenes.lab.machines.machine import GOLDEN, GRAVITY, HALF, STEEL, WOOD, Machine

PLANKS, LONG, THICK = 14, 24.0, 6.0
BENT = 0.6  # [rad] half of the arc in which it hangs
DECK = -112.0  # [px] height of its ends
BEND = 0.5 * PLANKS * LONG / BENT  # [px] radius of the arc
GAP = 2.0 * BEND * sin(BENT)  # [px] between the banks
BANK = HALF - 0.5 * GAP
RADIUS = 17.0
PUSH, PERIOD = 0.1, 400  # [weights] greatest force on the ball; [steps] of its coming and going
HEAVY = 100.0  # planks: mass of the ball
STRENGTH, WORN = 60.0, 2.0  # balls' weights: breaking force of the five pins in the middle, and once worn
START = -80.0  # [px] from which the ball falls on the planks
DROP = 150.0  # [px/s] speed of the ball that smash() adds


class Bridge(Machine):
    """Planks on hinges between two banks, with an iron ball on them that has the mass of a hundred planks."""

    name = "bridge"
    seen = "A ball of a hundred planks' mass rolls on planks."
    starts = "rolls the ball"
    breaks = "drops a heavier ball on worn pins"

    def build(self):
        """Build the banks, the planks, and the ball on the left bank."""
        for side in (-1, 1):
            self.fixed(Polygon.box(BANK, -DECK), side * (HALF - BANK / 2), DECK / 2, material=Material(friction=0.9))
        turns = [BENT * (1.0 - 2.0 * k / PLANKS) for k in range(PLANKS + 1)]  # of the arc, from left to right
        places = [(-BEND * sin(turn), DECK + BEND * (cos(turn) - cos(BENT))) for turn in turns]
        self.planks = [
            self.add(Polygon.box(LONG - 2.0, THICK), (ax + bx) / 2, (ay + by) / 2, WOOD, angle=atan2(by - ay, bx - ax))
            for (ax, ay), (bx, by) in pairwise(places)
        ]
        ends = zip([None, *self.planks], [*self.planks, None], places, strict=True)
        pins = [self.world.add_joint(Revolute(a, b, at=place)) for a, b, place in ends]
        self.weak = pins[5:10]
        self.weight = self.planks[0].mass * HEAVY
        for pin in self.weak:
            pin.breaks = (STRENGTH * self.weight * GRAVITY, None)
        self.ball = self.add(Circle(RADIUS), START, DECK - RADIUS, STEEL, mass=self.weight)
        self.second = None
        self.lowest = DECK - RADIUS

    def control(self):
        """Push the ball alternately right and left, with a force of at most a tenth of its weight, while the machine
        runs.
        """
        if self.running:
            way = sin(2 * pi * self.steps / PERIOD)
            self.ball.apply_force((PUSH * self.weight * GRAVITY * way, 0.0))

    def smash(self):
        """Weaken the pins in the middle of the bridge, and drop a second ball of ten times the mass on them."""
        self.disturbed = True
        for pin in self.weak:
            if self.holds(pin):
                pin.breaks = (WORN * self.weight * GRAVITY, None)
        if self.second is None:
            self.second = self.add(Circle(RADIUS + 6), 0.0, -180.0, GOLDEN, mass=10 * self.weight, velocity=(0.0, DROP))

    def measure(self):
        """Record the lowest position of the ball."""
        self.lowest = max(self.lowest, self.ball.position.y)

    def figure(self):
        """Return the depth of the ball's lowest position below the bridge's ends as text."""
        return f"sag {self.lowest + RADIUS - DECK:.0f} px"

    def figures(self):
        """Return (y,): the y of the ball's lowest position [px]."""
        return (self.lowest,)

    def handle(self):
        """Return the centre (x, y) [px] of the plank at which the bot drags the bridge."""
        return tuple(self.planks[3].center)

    @classmethod
    def goals(cls, iterative, direct):
        """Return the machine's goals, a list of (text, whether it is met, measured value as text).

        Exact pins hold the ball, iterative pins come apart, and the heavier ball breaks pins. iterative, direct:
        results (widest gap [px], broken joints, *figures()) with each joint solver, or None.
        """
        gaps = (0.0 if each is None else each[0] for each in (iterative, direct))
        loose, tight = gaps
        broken = 0 if direct is None else direct[1]
        return [
            ("exact pins hold the ball", direct is not None and tight < 0.2, f"gap {tight:.4f} px"),
            ("iterative pins come apart", loose > 10 * tight > 0.0, f"gap {loose:.4f} px"),
            ("a heavier ball breaks it", broken > 0, f"{broken} pins"),
        ]
