"""Two rows of dominoes, the second four times as large: does its wave run twice as fast?

In short: gravity sets all times: at four times the size everything takes twice the time. A hidden length in the solver
would break this.

What to see: gravity sets all times here, so a row of four times the size takes twice the time (Froude's rule). A length
hidden in the solver (a slop, a margin, a fixed speed) would break this rule. So the second wave is half as fast on the
screen, and twice as fast over the ground.

Why it matters: A game that is made twice as large must play the same; hidden lengths in an engine break that.

To try: drag one domino out of each row before the wave comes.

Source: Efthimiou and Johnson, Domino Waves, SIAM Review, 2007.
"""

from math import degrees, radians, sqrt

import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GREEN, ORANGE, PAPER, RED, SKY, faded
from game.drawing.headline import Headline
from game.drawing.number_text import count_text
from game.drawing.rotated import Cast
from game.drawing.sprites import load_atlas
from game.input.inputs import InputFrame
from game.scene import STANDS, Goal, Scene, Slider
from physics import Effects, Material, Polygon
from scenes.lab.piles import SOLVERS
from scenes.lab.yard import HEAD, Yard, plate

KEEPING = SOLVERS[1:]  # those that can hold a row of dominoes
SCALES = (1.0, 4.0)  # of the two rows
HEIGHT, THICK = 32.0, 6.0  # [px] of a domino of the first row
DRAWN = 48.0  # [canvas px] of every domino
COLORS = (SKY, ORANGE)
FLOORS = (104, 222)  # [canvas px]
VIEWS = ((0, 16, 480, 104), (0, 136, 480, 102))
FIRST_X = 16.0  # [canvas px] of the first domino
ROOM = 424.0  # [canvas px] for the row
PUSH = 1.0  # [sqrt(g h)] speed given to the first one's top
FROUDE = sqrt(SCALES[1] / SCALES[0])  # ratio of the waves' speeds by Froude's rule
ALLOWED = 0.02  # of this ratio
ENOUGH = 4  # substeps with which the ratio is that of the rule
PUSHED_AT = 30  # step of the first push
FELL = radians(60.0)
PASSES = radians(12.0)  # lean of a domino that the wave has reached
SMOOTH, FLOOR = 0.05, 12.8  # friction of polished bone; of the table, which holds the feet: sqrt(a * b) = 0.8
STEADY = 4  # the first dominoes and the last two are not timed: the wave must reach a steady speed


class Dominoes(Scene):
    """Scene with two worlds that contain the same row of dominoes, small and four times as large."""

    name = "lab/dominoes"
    title = "Dominoes"
    question = STANDS
    about = "The same row of dominoes at two sizes. Four times as large, the wave should run twice as fast."
    effects = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True)
    pieces = ("boxes",)
    features = ("Froude's scaling measured: size x 4, speed x 2", "thin boxes that topple and come to rest leaning")
    solvers = KEEPING
    sliders = (
        Slider("spacing", 45, 80, 60, "% of height", step=5),
        Slider("substeps", 1, 8, 1),
        Slider("solver", 0, 1, 1, choices=KEEPING),
    )
    actions = (("Space", "push"), ("left right", "spacing"), ("up down", "substeps"))
    draggable = True
    head = HEAD
    legend_at = (190, 20)

    def build(self):
        """Create the picture of two tables, then call fill() to create the worlds and their rows."""
        self.yard = Yard(FLOORS, 50, table=True)
        if self.solver in KEEPING:  # named on the command line, or chosen before a restart
            self.values["solver"] = KEEPING.index(self.solver)
        self.fill()

    def fill(self):
        """Replace the scene's worlds by two new ones, with one row of dominoes each."""
        self.solver = KEEPING[int(self.values["solver"])]
        self.worlds, self.casts, self.rows, self.cameras = [], [], [], []
        spacing = HEIGHT * self.values["spacing"] / 100.0
        count, zoom = int(ROOM / spacing * HEIGHT / DRAWN) + 1, DRAWN / HEIGHT
        for scale, view, floor in zip(SCALES, VIEWS, FLOORS, strict=True):
            world, cast = self.add_world(substeps=int(self.values["substeps"])), Cast(load_atlas("lab"))
            world.add_body(
                Polygon.box(600 * scale, 64 * scale),
                position=(120 * scale, 32 * scale),
                kind="static",
                material=Material(friction=FLOOR),
            )
            shape = Polygon.box(THICK * scale, HEIGHT * scale)
            row = [
                world.add_body(
                    shape,
                    position=((FIRST_X / zoom + n * spacing) * scale, -HEIGHT * scale / 2),
                    material=Material(friction=SMOOTH),
                )
                for n in range(count)
            ]
            for number, body in enumerate(row):
                cast.add(body, f"domino_{number * 7 % 4}")
            self.cameras.append(Camera(view, zoom / scale, y=-(floor - view[1]) * scale / zoom))
            self.casts.append(cast)
            self.rows.append(row)
        self.since = 0
        self.pushed = None  # step of the push
        self.leaned = [[0.0] * count for _ in SCALES]  # angles a step ago [rad]
        self.passed = [[None] * count for _ in SCALES]  # [steps] time of the wave, between steps

    def change_slider(self, name, value):
        """Set the slider `name` to `value`, then build the rows again."""
        super().change_slider(name, value)
        self.fill()

    def update(self, inputs):
        """Process keys, step both worlds, and record when the wave reaches each domino."""
        for name, forth, back, notch in (("spacing", "right", "left", 5), ("substeps", "up", "down", 1)):
            way = inputs.pressed(forth) - inputs.pressed(back)
            if way:
                self.change_slider(name, self.values[name] + way * notch)
        if inputs.pressed("fire") or (self.pushed is None and self.since == PUSHED_AT):
            self._push()
        self.since += 1
        for index, world in enumerate(self.worlds):
            world.step()
            self._time(index)

    def _push(self):
        """Push the first domino of both rows. The speed is proportional to the square root of the domino's size
        (Froude).

        If the rows have already been pushed, they are built again first.
        """
        if self.pushed is not None:
            self.fill()
        self.pushed = self.since
        self.play("hit")
        for scale, world, row in zip(SCALES, self.worlds, self.rows, strict=True):
            first = row[0]
            x, y = first.position
            speed = PUSH * sqrt(world.gravity[1] * HEIGHT * scale)
            # At the top, (h/2)^2 / inertia divides the impulse between translation and rotation.
            gives = 1.0 / first.mass + (HEIGHT * scale / 2) ** 2 / first.inertia
            first.apply_impulse((speed / gives, 0.0), (x, y - HEIGHT * scale / 2))

    def _time(self, index):
        leaned, passed = self.leaned[index], self.passed[index]
        for number, body in enumerate(self.rows[index]):
            before, now = leaned[number], body.angle
            if passed[number] is None and now >= PASSES:
                passed[number] = self.since - 1 + (PASSES - before) / (now - before)
                if number:
                    self.play("blip", FIRST_X + number * DRAWN * self.values["spacing"] / 100.0, 0.25)
            leaned[number] = now

    def speed(self, index):
        """Return the speed of a row's wave over the ground [px/s], or None until the wave has passed the timed
        dominoes.

        index: 0 the small row, 1 the large row.
        """
        passed = self.passed[index]
        last = len(passed) - 3
        if passed[last] is None or passed[STEADY] is None:
            return None
        spacing = HEIGHT * SCALES[index] * self.values["spacing"] / 100.0
        return (last - STEADY) * spacing / ((passed[last] - passed[STEADY]) * self.worlds[index].dt)

    def ratio(self):
        """Return the speed of the large row's wave divided by the speed of the small row's wave.

        Return None while one of the two speeds is unknown.
        """
        small, large = self.speed(0), self.speed(1)
        return None if small is None or large is None else large / small

    def error(self):
        """Return how far the ratio of the waves' speeds is from Froude's rule, as a share of it; None while unknown."""
        ratio = self.ratio()
        return None if ratio is None else abs(ratio / FROUDE - 1.0)

    @property
    def offer(self):
        """Text that offers the player a new run once both waves have passed; "" otherwise."""
        through = all(at is not None for row in self.passed for at in row)
        return "sets them up again" if through else ""

    def views(self):
        """Return a list of (world, camera), one for the picture of each row."""
        return list(zip(self.worlds, self.cameras, strict=True))

    def draw(self, canvas, alpha):
        """Draw both tables with their rows. Write the size and wave speed above each row, and the ratio of
        the speeds.

        alpha: position (0..1) between the last two steps.
        """
        self.yard.draw(canvas)
        for index, (camera, cast) in enumerate(zip(self.cameras, self.casts, strict=True)):
            cast.draw(canvas, camera, self.worlds[index], alpha)
            self._draw_words(canvas, index)
        ratio, error = self.ratio(), self.error()
        plate(canvas, (352, 142, 124, 30))
        canvas.text("large : small", 358, 146, FOG, SMALL)
        right = error is None or error < ALLOWED
        canvas.text(f"{ratio:.3f}" if ratio else "-", 470, 146, GREEN if right else RED, align="right")
        canvas.text("Froude: sqrt(4) =", 358, 159, FOG, SMALL)
        canvas.text("2.000", 470, 158, PAPER, align="right")

    def _draw_words(self, canvas, index):
        color, scale, top = COLORS[index], SCALES[index], VIEWS[index][1] + 6
        plate(canvas, (4, top, 180, 30))
        canvas.surface.fill(color, (4, top, 2, 30))
        meter = self.worlds[index].tolerances.pixels_per_meter
        speed = self.speed(index)
        canvas.text(f"{HEIGHT * scale / meter:g} m high", 10, top + 4, color)
        canvas.text(f"{speed / meter:.2f} m/s" if speed else "- m/s", 178, top + 4, PAPER, align="right")
        bar = round(meter / scale * DRAWN / HEIGHT)
        canvas.surface.fill(PAPER, (10, top + 22, bar, 1))
        for x in (10, 9 + bar):
            canvas.surface.fill(PAPER, (x, top + 20, 1, 5))
        canvas.text("1 m", 14 + bar, top + 20, FOG, SMALL)
        fallen = sum(body.angle > FELL for body in self.rows[index])
        canvas.text(f"{fallen} of {len(self.rows[index])} down", 178, top + 20, FOG, SMALL, align="right")

    def draw_on_frame(self, frame):
        """Draw a mark under the last domino that the wave has reached, in each row that has not fallen completely."""
        for index, camera in enumerate(self.cameras):
            there = [body for body, at in zip(self.rows[index], self.passed[index], strict=True) if at is not None]
            if there and len(there) < len(self.rows[index]):
                lens = frame.lens(camera)
                x, y = lens.points(there[-1].position[0], 0.0)
                s = frame.scale
                mark = [(x, y + 2 * s), (x - 3 * s, y + 8 * s), (x + 3 * s, y + 8 * s)]
                pygame.draw.polygon(frame.surface, COLORS[index], mark)
                pygame.draw.line(frame.surface, faded(COLORS[index], 0.3), (x, y), (x, y - 52 * s))

    def check(self):
        """Return the scene's goals, a list of Goal.

        No domino falls before the push, all fall afterwards, and the large row's wave is twice as fast as the small
        row's.
        """
        error = self.error()
        angles = [[body.angle for body in row] for row in self.rows]
        least = min(min(row) for row in angles)
        return [
            Goal(
                "none falls before the push",
                PUSHED_AT,
                self.pushed is not None or least > -0.01,
                f"{degrees(least):.2f} deg",
            ),
            Goal("all are down by more than 60 degrees", 540, least > FELL, f"the least {degrees(least):.1f} deg"),
            Goal(
                "four times the size, twice the speed, within 2 %",
                540,
                error is not None and error < ALLOWED,
                "not there yet" if error is None else f"off by {100 * error:.1f} %",
            ),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        error, count = self.error(), sum(len(row) for row in self.passed)
        steps = count_text(int(self.values["substeps"]), "substep")
        fallen = sum(at is not None for row in self.passed for at in row)
        seen = count if error is not None else min(fallen, count - 1)
        number, scaled = "", True
        if error is not None:
            number, scaled = f"{100 * error:.1f} %", error < ALLOWED
        sentence = f"At {steps} a row four times as large misses twice the speed."
        unit = "off twice the small row's speed"
        headline = Headline(sentence, "up: more substeps", number, unit, seen, count, "dominoes", scaled)
        return headline.asks("Four times as large: does the row fall twice as fast?")

    def finding(self):
        """Return a sentence with the measured ratio of the waves' speeds, and the ratio by Froude's rule."""
        small, large = self.speed(0), self.speed(1)
        if small is None or large is None:
            return "not yet: both waves have to run through their rows"
        meter = self.world.tolerances.pixels_per_meter
        sentence = (
            f"{SCALES[1]:.0f} times as large, the wave runs {large / small:.3f} times as fast: {large / meter:.2f} m/s"
        )
        return f"{sentence}, not {small / meter:.2f}; Froude's rule says {FROUDE:.0f}"

    def bot(self):
        """Return the bot's input for the next step. The bot sets a sufficient number of substeps, and does nothing
        else.
        """
        return InputFrame(changes=(("slider:substeps", ENOUGH),) if self.frame == 0 else ())

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the times of the waves. The worlds are hashed
        separately.
        """
        return (self.frame, self.since, self.pushed, *self.values.values(), *(at for row in self.passed for at in row))
