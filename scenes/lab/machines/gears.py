"""A train of gears that lifts a rack with a load, one of the machines of lab/joints."""

from math import atan2, cos, hypot, pi, sin

import pygame

from game.drawing.colors import INK
from game.drawing.number_text import error_text
from game.drawing.rotated import poses_between
from physics import Circle, Drive, Gear, Material, Polygon, Prismatic, Revolute
from scenes.lab.machines.machine import GOLDEN, GRAVITY, STEEL, WOOD, Machine
from scenes.lab.pieces import RAMPS

PITCH = 2.5  # [px] of radius for each tooth
TOOTH = 2.5  # [px] half of its height
RADII = (20.0, 55.0, 35.0)
PLACES = ((-96.0, -128.0), (-33.0, -86.0), None)  # of the first two axles; the third is beside the second
PAINTS = ("gold", "steel", "coral")
RACK = (12.0, 112.0)
SPEED = 3.0  # [rad/s] of the motor
ROOM = 26.0  # [px] of the rack's motion up and down
SURE = 1e-3  # of the angle turned: greatest error of a ratio


class Gears(Machine):
    """Three gears and a rack that carries a crate. The first gear has a motor."""

    name = "gears"
    seen = "The small gear's motor lifts rack and crate."
    starts = "turns the small gear"
    breaks = "breaks the teeth of the last two gears"

    def build(self):
        """Build the gears on their axles, the rack on its rail, and the crate on the rack."""
        (ax, ay), (bx, by), _ = PLACES
        far = hypot(bx - ax, by - ay)
        bx, by = ax + (bx - ax) * (RADII[0] + RADII[1]) / far, ay + (by - ay) * (RADII[0] + RADII[1]) / far
        self.places = [(ax, ay), (bx, by), (bx + RADII[1] + RADII[2], by)]
        self.wheels = [
            self.world.add_body(Circle(radius - TOOTH), position=place)
            for radius, place in zip(RADII, self.places, strict=True)
        ]
        self.axles = [
            self.world.add_joint(Revolute(None, wheel, at=place))
            for wheel, place in zip(self.wheels, self.places, strict=True)
        ]
        x = self.places[2][0] + RADII[2] + RACK[0] / 2
        self.rack = self.add(Polygon.box(*RACK), x, by, STEEL, material=Material(density=0.5))
        self.rail = self.world.add_joint(Prismatic(None, self.rack, at=(x, by), axis=(0, 1)))
        self.crate = self.add(Polygon.box(26, 26), x, by - RACK[1] / 2 - 13, WOOD, material=Material(friction=0.8))
        pairs = zip(self.axles, self.axles[1:], RADII, RADII[1:], strict=False)
        self.gears = [self.world.add_joint(Gear(a, b, ratio=rb / ra)) for a, b, ra, rb in pairs]
        self.gears.append(self.world.add_joint(Gear(self.axles[2], self.rail, ratio=-1.0 / RADII[2])))
        self.weak = [self.gears[1]]
        self.way, self.turned, self.off = -1, 0.0, 0.0
        self.phases = self._meshed()

    def _meshed(self):
        """Return the angles [rad] at which the teeth of the gears mesh, one for each gear.

        An angle is that of one tooth in the space of the gear's body.
        """
        phases = [0.0]
        for k in (1, 2):
            (ax, ay), (bx, by) = self.places[k - 1], self.places[k]
            toward = atan2(by - ay, bx - ax)
            pitch_a, pitch_b = (2 * pi / count_of(RADII[j]) for j in (k - 1, k))
            share = (toward - phases[-1]) / pitch_a
            phases.append(toward + pi + (share + 0.5) * pitch_b)
        return phases

    def drive(self):
        """Turn the small gear with a torque of at most twice what the load needs, or hold it if the machine does not
        run.
        """
        load = (self.rack.mass + self.crate.mass) * GRAVITY * RADII[0]
        self.axles[0].motor = Drive(self.way * SPEED if self.running else 0.0, max=2.0 * load)

    def control(self):
        """Reverse the motor when the rack reaches an end of its range."""
        rise = self.rail.translation
        way = -1 if rise > ROOM else 1 if rise < -ROOM else self.way
        # The last of three gears rotates in the direction of the first, and lowers the rack by rotating to the right.
        if way != self.way:
            self.way = way
            self.drive()

    def measure(self):
        """Add the angle of this step to the angle turned, and record the greatest error of a gear ratio.

        The error is recorded until a joint is dragged or broken.
        """
        self.turned += abs(self.axles[0].speed) * self.world.dt
        if not self.broken and not self.disturbed:
            ratios = (RADII[1] / RADII[0], RADII[2] / RADII[1])
            pairs = zip(self.axles, self.axles[1:], ratios, strict=False)
            self.off = max(self.off, *(abs(a.angle + ratio * b.angle) for a, b, ratio in pairs))

    def figure(self):
        """Return the error of the gear ratios as text."""
        return f"ratios: {error_text(self.error)}"

    @property
    def error(self):
        """Greatest error of a gear ratio, as a share of the angle turned; 0 before any gear has turned."""
        return self.off / self.turned if self.turned > 0.0 else 0.0

    def figures(self):
        """Return (greatest error of a gear ratio as a share of the angle turned, angle turned by the first gear
        [rad]).
        """
        return self.error, self.turned

    def handle(self):
        """Return the centre (x, y) [px] of the crate, at which the bot drags the machine."""
        return tuple(self.crate.center)

    def draw(self, canvas, camera, alpha):
        """Draw the gears with their teeth, and the teeth of the rack.

        alpha: position (0..1) between the last two steps.
        """
        x, y, angle = poses_between(self.world.bodies, alpha)
        x, y = camera.to_canvas(x, y, alpha)
        rows = self.world.rows([wheel.id for wheel in self.wheels])
        for row, radius, phase, paint in zip(rows.tolist(), RADII, self.phases, PAINTS, strict=True):
            draw_gear(canvas.surface, (x[row], y[row]), radius, angle[row] + phase, RAMPS[paint])
        row = self.world.rows([self.rack.id])[0]
        pitch = 2 * pi * PITCH
        left, middle = float(x[row]) - RACK[0] / 2, float(y[row])
        # A tooth of the last gear points at the rack where its share is whole.
        share = self.phases[2] / (2 * pi / count_of(RADII[2]))
        first = -RACK[1] / 2 + (RACK[1] / 2 + (share + 0.5) * pitch) % pitch
        for k in range(int(RACK[1] / pitch)):
            at = middle + first + k * pitch
            points = [(left, at - 0.3 * pitch), (left - TOOTH, at - 0.12 * pitch)]
            points += [(left - TOOTH, at + 0.12 * pitch), (left, at + 0.3 * pitch)]
            pygame.draw.polygon(canvas.surface, RAMPS[STEEL][1], points)
            pygame.draw.lines(canvas.surface, INK, False, points)

    @classmethod
    def goals(cls, iterative, direct):
        """Return the machine's goals, a list of (text, whether it is met, measured value as text).

        The gears turn and keep their ratios, and a gear joint breaks. iterative, direct: results (widest gap [px],
        broken joints, *figures()) with each joint solver, or None.
        """
        _, broken, error, turned = direct or (9.0, 0, 9.0, 0.0)
        return [
            (
                "gears keep their ratio to a thousandth",
                turned > 6.0 and error < SURE,
                f"{error_text(error)} over {turned:.0f} rad",
            ),
            ("the teeth break", broken == 1, f"{broken} joints"),
        ]


def count_of(radius):
    """Return the number of teeth of a gear with this pitch radius [px]."""
    return round(radius / PITCH)


def draw_gear(surface, middle, radius, turn, ramp):
    """Draw a gear: a disc with teeth, a hub and spokes.

    middle: centre (x, y) on the surface; radius: pitch radius [px]; turn: angle of a tooth [rad]; ramp: colours of
    rim, inside, dithered inside and mark.
    """
    rim, inside, dark, mark = ramp
    pitch = 2 * pi / count_of(radius)
    points = []
    for k in range(count_of(radius)):
        for share, far in ((-0.3, -TOOTH), (-0.14, TOOTH), (0.14, TOOTH), (0.3, -TOOTH)):
            at = turn + (k + share) * pitch
            points.append((middle[0] + (radius + far) * cos(at), middle[1] + (radius + far) * sin(at)))
    pygame.draw.polygon(surface, inside, points)
    pygame.draw.polygon(surface, INK, points, 1)
    pygame.draw.circle(surface, rim, middle, radius - TOOTH - 2, 1)
    pygame.draw.circle(surface, dark, middle, 0.72 * radius)
    for k in range(5):
        at = turn + 2 * pi * k / 5
        end = (middle[0] + 0.74 * radius * cos(at), middle[1] + 0.74 * radius * sin(at))
        pygame.draw.line(surface, inside if k else GOLD_SPOKE, middle, end, max(2, round(radius / 9)))
    pygame.draw.circle(surface, inside, middle, 0.25 * radius)
    pygame.draw.circle(surface, mark, middle, 0.25 * radius, 1)


GOLD_SPOKE = RAMPS[GOLDEN][0]
