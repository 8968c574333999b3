"""A turning drum full of shapes that are carried up and fall: are they pressed into each other, or out?

In short: with one substep shapes overlap by a third of a brick; four keep them apart. No shape gets out.

What to see: the drum is one kinematic body of many boxes. In every step its walls move into the shapes that lie on
them, from every side, with the weight of the whole load above. A leak, a jitter or a gain of energy would show at once.

Why it matters: Bodies that are squeezed for minutes get out through any gap that a solver leaves.

To try: drag a shape against the turning wall and hold it there.

Source: Box2D's Tumbler, the classic load of many contacts.
"""

from math import cos, hypot, pi, sin
from random import Random

import numpy as np
import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GOLD, GREEN, INK, PAPER, RED
from game.drawing.headline import Headline
from game.drawing.number_text import count_text
from game.drawing.rotated import Cast
from game.drawing.sprites import load_atlas
from game.input.inputs import InputFrame
from game.measure.setting import SUBSTEPPED
from game.measurement_requests import MeasuredRun, RunRequest
from game.scene import FAST, Goal, Scene, Slider
from physics import Capsule, Circle, Effects, Polygon
from scenes.lab.costs import cost_of, cost_text, microseconds
from scenes.lab.piles import deepest, kinetic_energy, with_substeps
from scenes.lab.yard import HEAD, Yard, plate

ZOOM = 0.5
SIDES = 10
INSIDE = 208.0  # [px] from the middle to each wall
WALL = 20.0  # [px] thick
FIN = 44.0  # [px] the blades reach in
VIEW = ((120, 16), (360, 254))
MIDDLE = (360.0, 254.0)  # [px] of the world: the middle of the view
TOYS = ("red", "blue", "gold", "green", "purple", "teal")
SLACK = 8.0  # [px] distance beyond the wall's inner face from which a centre is out
SUBSTEPS = 4  # half the time of substeps by load, with overlaps of at most a fifteenth of a brick
SETTLED = 120  # steps after which the load is measured
STEEL = ((58, 60, 82), (92, 96, 124), (138, 144, 172), (190, 196, 216))


def ring(count, size, start):
    """Return the corners of a regular polygon around (0, 0), a list of (x, y) [px].

    count: number of corners; size: diameter of its circumscribed circle [px]; start: angle of the first corner [rad].
    """
    angles = start + np.arange(count) * 2 * pi / count
    return [(size / 2 * cos(a), size / 2 * sin(a)) for a in angles]


KINDS = (
    ("block", Polygon.box(20, 20)),
    ("disc", Circle(10)),
    ("brick", Polygon.box(28, 12)),
    ("pill", Capsule((-6, 0), (6, 0), 6)),
    ("hexagon", Polygon(tuple(ring(6, 24, 0.0)))),
    ("triangle", Polygon(tuple(ring(3, 28, -pi / 2)))),
)
THINNEST = 12.0  # [px] bricks and pills
ALLOWED = 0.2  # greatest overlap, on average, as a share of the thinnest shape


class Tumbler(Scene):
    """Scene with one world: a drum with shapes in it, the load."""

    name = "lab/tumbler"
    title = "Tumbler"
    question = FAST
    about = "A turning drum of boxes with up to 160 mixed shapes in it. Not one may get out."
    effects = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True)
    pieces = ("boxes", "circles", "capsules")
    features = ("one kinematic body of many boxes", "circles, capsules, boxes, triangles and hexagons mixed")
    sliders = (
        Slider("bodies", 20, 160, 130, step=10),
        Slider("speed", -2.0, 2.0, 0.6, "rad/s", step=0.1),
        Slider("substeps", 1, 8, 1),
    )
    lighter = {"bodies": 30}
    actions = (("X", "substeps"), ("left right", "drum's speed"), ("up down", "bodies"))
    draggable = True
    head = HEAD
    legend_at = (4, 138)

    def build(self):
        """Create the background and the camera, then call fill() to create the world with the drum and its load."""
        self.yard = Yard(262, 70)
        self.camera = Camera(VIEW, ZOOM)
        self.fill()

    def fill(self):
        """Replace the scene's world by a new one: the drum, and shapes in rows inside it."""
        self.worlds = []
        world, self.cast = self.add_world(substeps=int(self.values["substeps"])), Cast(load_atlas("lab"))
        self.drum = world.add_body(
            *drum_boxes(), position=MIDDLE, kind="kinematic", angular_velocity=float(self.values["speed"])
        )
        count = int(self.values["bodies"])
        random = Random(f"{self.seed} {count}")
        for number, place in enumerate(places(count)):
            name, shape = KINDS[number % len(KINDS)]
            body = world.add_body(shape, position=place, angle=0.0 if name == "brick" else random.uniform(-pi, pi))
            self.cast.add(body, f"{name}_{random.choice(TOYS)}")
        self.escaped = 0
        self._forget()

    def _forget(self):
        """Start the measurements of the load again."""
        self.highest = MIDDLE[1] + INSIDE  # y of the highest centre since the load settled
        self.most = self.energy = 0.0  # kinetic energy
        self.overlap = self.pressed = 0.0  # [px] greatest overlap, and mean over the steps of the greatest overlap
        self.since = 0

    def change_slider(self, name, value):
        """Set the slider `name` to `value`.

        A new number of bodies makes the drum and its load again. A new speed becomes the drum's angular velocity. A new
        number of substeps starts the measurements again.
        """
        super().change_slider(name, value)
        if name == "bodies":
            self.fill()
        elif name == "substeps":
            self.world.substeps = int(self.values["substeps"])
            self._forget()
        else:
            self.drum.angular_velocity = float(self.values["speed"])

    def update(self, inputs):
        """Process keys, make one step, and check that no shape has left the drum."""
        for name, forth, back, notch in (("speed", "right", "left", 0.1), ("bodies", "up", "down", 10)):
            way = inputs.pressed(forth) - inputs.pressed(back)
            if way:
                self.change_slider(name, self.values[name] + way * notch)
        if inputs.pressed("bomb"):
            self.change_slider("substeps", 1 if self.values["substeps"] >= SUBSTEPS else SUBSTEPS)
        self.world.step()
        self.since += 1
        self._look()

    def _look(self):
        bodies = self.world.bodies[1:]
        x, y = bodies["x"] - MIDDLE[0], bodies["y"] - MIDDLE[1]
        turned = self.drum.angle + np.arange(SIDES)[:, None] * 2 * pi / SIDES
        out = (x * np.cos(turned) + y * np.sin(turned)).max(axis=0) > INSIDE + SLACK
        self.escaped = max(self.escaped, int(out.sum()))
        self.energy = kinetic_energy(self.world)
        if self.since > SETTLED:
            self.highest = min(self.highest, float(bodies["y"].min()))
            self.most = max(self.most, self.energy)
            deep = deepest(self.world)
            self.overlap = max(self.overlap, deep)
            self.pressed += (deep - self.pressed) / (self.since - SETTLED)

    def ways(self):
        """Return {label: run name} of the runs to measure.

        There is a run with the current number of substeps, and one with another number. A solver without substeps has
        only one run.
        """
        now, solver = self.world.substeps, self.world.solver
        asked = (now, SUBSTEPS if now == "auto" else "auto") if solver in SUBSTEPPED else (None,)
        name = (int(self.values["bodies"]), round(float(self.values["speed"]), 1), solver, self.broadphase)
        words = {None: "a step", "auto": "by load", 1: "1 substep"}
        return {words.get(substeps, f"{substeps} substeps"): (*name, substeps) for substeps in asked}

    def measured(self):
        """Return a RunRequest for the runs of ways(), timed by the measuring process; None until the load
        has settled.
        """
        return RunRequest(list(self.ways().values()), self._make) if self.since > SETTLED else None

    def _make(self, name):
        return MeasuredRun([with_substeps(self.world, name[-1])], self.broadphase)

    def draw(self, canvas, alpha):
        """Draw the drum, its load, and the figures. alpha: position (0..1) between the last two steps."""
        self.yard.draw(canvas)
        angle = self.drum.angle - self.drum.angular_velocity / 60 * (1.0 - alpha)
        draw_drum(canvas.surface, self.camera, angle)
        self.cast.draw(canvas, self.camera, self.world, alpha)
        plate(canvas, (4, 22, 112, 102))
        out = self.escaped
        canvas.text(f"{out} got out" if out else "none got out", 10, 26, RED if out else GREEN)
        rows = (
            ("shapes", f"{len(self.world.bodies) - 1}"),
            ("turns", f"{self.drum.angle / (2 * pi):.2f}"),
            ("contacts", f"{len(self.world.contacts)}"),
            ("overlap", f"{deepest(self.world):.2f} px"),
            ("on average", f"{self.pressed:.2f} px"),
            ("speed", f"{self._rms_speed():.0f} px/s"),
            *((word, cost_text(self, name)) for word, name in self.ways().items()),
        )
        for number, (word, value) in enumerate(rows):
            canvas.text(word, 10, 40 + number * 10, FOG, SMALL)
            canvas.text(value, 110, 40 + number * 10, GOLD if word == "turns" else PAPER, SMALL, align="right")

    def _rms_speed(self):
        """Return the root mean square speed of the load, weighted by mass [px/s]."""
        mass = float(self.world.bodies["mass"][1:].sum())
        return (2.0 * self.energy / mass) ** 0.5 if mass else 0.0

    def check(self):
        """Return the scene's goals, a list of Goal.

        No shape gets out of the drum. The load is carried up, and it gains no energy.
        """
        fall = 2.0 * 9.8 * 32.0 * 2.0 * INSIDE  # [px2/s2] energy of a fall through the whole drum
        mass = float(self.world.bodies["mass"][1:].sum())
        return [
            Goal("none gets out", 300, self.escaped == 0, f"{self.escaped} of {len(self.world.bodies) - 1}"),
            Goal(
                "the load is carried above the middle",
                480,
                self.highest < MIDDLE[1],
                f"highest at {self.highest:.0f} px",
            ),
            Goal("a quarter of a turn", 300, abs(self.drum.angle) > pi / 2, f"{self.drum.angle:.2f} rad"),
            Goal(
                "no energy out of nothing",
                480,
                0.0 < 2.0 * self.most / mass < fall,
                f"{2.0 * self.most / mass:.0f} of at most {fall:.0f} px2/s2",
            ),
            Goal(
                "the deepest overlap is a fifth of the thinnest shape, on average",
                480,
                self.pressed < ALLOWED * THINNEST,
                f"{self.pressed:.2f} px, once {self.overlap:.2f} px",
            ),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        deep, seen = self.pressed / THINNEST, max(self.since - SETTLED, 0)
        steps = count_text(int(self.values["substeps"]), "substep")
        sentence = f"With {steps} the load is pressed into itself."
        number, unit = f"{100 * deep:.0f} %", "of a brick overlap"
        headline = Headline(sentence, "X: substeps", number, unit, seen, 60, "settled steps", deep < ALLOWED)
        return headline.asks(f"With {steps}, does the load keep its shapes apart?")

    def finding(self):
        """Return a sentence with the number of escaped shapes, the drum's turns, and the overlap in the load.

        It also gives the time of a step once it is measured.
        """
        if self.since < SETTLED + 60:
            return "not yet: the load has to settle for two seconds, and to be looked at for one"
        turns = abs(self.drum.angle) / (2 * pi)
        sentence = f"{self.escaped} of {len(self.world.bodies) - 1} shapes got out in {turns:.2f} turns"
        deep = f"{self.pressed:.2f} px, {self.pressed / THINNEST:.0%} of the thinnest"
        sentence = f"{sentence}; the deepest overlap is {deep}, on average over {(self.since - SETTLED) / 60:.0f} s"
        costs = {word: cost_of(self, name) for word, name in self.ways().items()}
        if None in costs.values():
            return sentence
        return f"{sentence}; a step takes {', '.join(f'{microseconds(cost)} ({word})' for word, cost in costs.items())}"

    def bot(self):
        """Return the bot's input for the next step. The bot sets enough substeps, then only watches."""
        return InputFrame(changes=(("slider:substeps", SUBSTEPS),) if self.frame == 0 else ())

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the measurements. The worlds are hashed
        separately.
        """
        return (
            self.frame,
            self.since,
            *self.values.values(),
            self.escaped,
            self.highest,
            self.energy,
            self.most,
            self.overlap,
            self.pressed,
        )


def drum_boxes():
    """Return the boxes of the drum, a list of Polygon: its walls and its blades.

    Each wall is slightly longer than a side of the drum, so that there is no gap at the corners.
    """
    side = 2.0 * (INSIDE + WALL) * np.tan(pi / SIDES)
    boxes = []
    for number in range(SIDES):
        angle = 2 * pi * number / SIDES
        boxes.append(Polygon.box(WALL, side, radial(INSIDE + WALL / 2, angle), angle))
        if number % 2 == 0:
            boxes.append(Polygon.box(FIN, WALL / 2, radial(INSIDE - FIN / 2, angle), angle))
    return boxes


def radial(distance, angle):
    """Return the point (x, y) [px], relative to the drum's centre, at `distance` [px] in the direction
    `angle` [rad].
    """
    return distance * cos(angle), distance * sin(angle)


def places(count):
    """Return the positions of `count` shapes inside the drum, in rows from the bottom up, a list of (x, y) [px]."""
    step, room = 24.0, INSIDE - 20.0
    across = [step * column for column in range(-int(room / step), int(room / step) + 1)]
    found = [(x, y) for y in reversed(across) for x in across if hypot(x, y) < room and not in_blade(x, y)]
    return [(MIDDLE[0] + x, MIDDLE[1] + y) for x, y in found[:count]]


def in_blade(x, y):
    """Return whether a shape at (x, y) [px] relative to the drum's centre would overlap a blade at the drum's first
    angle.
    """
    for number in range(0, SIDES, 2):
        c, s = radial(1.0, 2 * pi * number / SIDES)
        if c * x + s * y > INSIDE - FIN - 14.0 and abs(c * y - s * x) < WALL / 4 + 14.0:
            return True
    return False


def draw_drum(surface, camera, angle):
    """Draw the drum's walls, blades and rivets, lit from the upper left. angle: angle of the drum [rad]."""
    x, y = camera.to_canvas(*MIDDLE)

    def at(distance, turn):
        dx, dy = radial(distance * ZOOM, angle + turn)
        return x + dx, y + dy

    half = pi / SIDES
    inner, outer = INSIDE / cos(half), (INSIDE + WALL) / cos(half)
    ground = [at(outer, half + 2 * half * number) for number in range(SIDES)]
    pygame.draw.polygon(surface, (24, 20, 38), ground)
    for number in range(SIDES):
        turn = 2 * half * number
        quad = [at(inner, turn - half), at(outer, turn - half), at(outer, turn + half), at(inner, turn + half)]
        facing = -(cos(angle + turn) * -0.55 + sin(angle + turn) * -0.8)  # the inner face looks inwards
        pygame.draw.polygon(surface, STEEL[1 + round(1 + facing)], quad)
        pygame.draw.line(surface, STEEL[3], quad[0], quad[3])
        pygame.draw.polygon(surface, INK, quad, 1)
        for share in (-0.6, 0.6):
            dx, dy = at((INSIDE + WALL / 2), turn + half * share)
            surface.fill(INK, (round(dx) - 1, round(dy) - 1, 2, 2))
        if number % 2 == 0:
            spread = WALL / 4 / (INSIDE - FIN)
            root = WALL / 4 / INSIDE
            tip = INSIDE - FIN
            blade = [at(INSIDE, turn - root), at(tip, turn - spread), at(tip, turn + spread), at(INSIDE, turn + root)]
            pygame.draw.polygon(surface, STEEL[2], blade)
            pygame.draw.polygon(surface, INK, blade, 1)
