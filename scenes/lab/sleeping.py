"""Heaps that fall asleep, and a ball that wakes one: which bodies wake, and what do sleeping bodies cost?

In short: at first no body may sleep, and all are stepped. X lets them: at rest they sleep, drawn darker, for almost no
time.

What to see: a heap that has been at rest for half a second falls asleep and is drawn darker. It keeps its contacts and
forces, and a step costs next to nothing. A knock wakes the island that it meets and no other. A falling column wakes
the next one, and so a wave of waking, lit up, runs along the columns. Then all fall asleep again.

Why it matters: Most of a level is at rest most of the time; a world that sleeps can be a hundred times as large.

To try: drag a body out of a sleeping heap, and see which bodies wake.

Source: Catto, Simulation Islands, box2d.org, 2023.
"""

from functools import lru_cache
from math import hypot

import numpy as np
import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GOLD, PAPER, SKY, SLATE, faded
from game.drawing.headline import Headline
from game.drawing.number_text import count_text
from game.drawing.rotated import RotatedPicture, poses_between
from game.input.inputs import InputFrame
from game.measurement_requests import MeasuredRun, RunRequest
from game.scene import FAST, Goal, Scene, Slider
from physics import Capsule, Circle, Effects, Material, Polygon, debug
from scenes.lab.costs import cost_of, cost_text, microseconds
from scenes.lab.curves import Curves
from scenes.lab.pieces import hull, piece, placed, scaled, turning
from scenes.lab.piles import step_seconds, with_effects
from scenes.lab.yard import HEAD, Yard, plate

METER, ZOOM = 32.0, 0.5  # [px]; a crate of a metre is drawn 16 px large
FLOOR = 198  # [canvas px]
WIDE = 480.0 / ZOOM  # [px] of the yard
CRATE = Polygon.box(0.9 * METER, 0.9 * METER)
STONES = (Circle(0.42 * METER), Polygon.box(0.8 * METER, 0.8 * METER), Capsule((-9.0, 0.0), (9.0, 0.0), 9.0))
ROWS, PYRAMID = 7, 3.5 * METER  # rows of the pyramid, x of its middle
COLUMNS, FIRST = 11, 8.6 * METER  # number of planks with three cubes on each; x of the first
PLANK = 0.55 * METER  # [px] thick
CUBE = Polygon.box(PLANK, PLANK)
BOWL, DEEP, STONE_COUNT = (23.4 * METER, 28.9 * METER), 4.8 * METER, 34  # x of its walls, their height
BALL, BALL_DENSITY, SPEED = 0.6 * METER, 4.0, 16.0 * METER  # radius, times a crate's density, [px/s]
MOUTH = (1.2 * METER, -10.8 * METER)  # start of balls
BALLS = 6  # the seventh replaces the first one
LIT = 26  # steps for which a woken body is lit
KNOCK = 250  # the bot's step
SETTLE = 240  # steps in which all have fallen asleep
RAMPS = ("wood", "teal", "coral", "violet", "gold")
DIM = (118, 112, 150)  # of 255: light of a sleeping body's picture
SLEEP = ("off", "on")
SLEPT = ("awake", "asleep")  # the measured states
PLOTS = (("bodies: awake, asleep [log]", (132, 206, 168, 60)), ("microseconds a step [log]", (306, 206, 168, 60)))
HISTORY = 600  # steps in the curves


class Sleeping(Scene):
    """Scene with one world: a pyramid, columns, a bowl of stones, and balls to throw at them."""

    name = "lab/sleeping"
    title = "Sleeping"
    question = FAST
    about = "Heaps fall asleep, a knock wakes one, and what falls wakes the next: who is awake, and what does it cost?"
    effects = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True, sleeping=True)
    other_effects = (effects.without("sleeping"),)
    pieces = ("boxes", "circles", "capsules")
    keeps = {"substeps": "by load: a player's six balls on one heap ask for more than the bot's one ball does"}
    features = (
        "islands that sleep and wake as one",
        "the wave of waking lit up",
        "bodies awake and microseconds as live curves",
    )
    sliders = (
        Slider("high", 3, 6, 4, "crates"),
        Slider("apart", 120, 200, 140, "cm", step=5),
        Slider("sleep", 0, 1, 0, choices=SLEEP),
    )
    lighter = {"apart": 200, "high": 3, "substeps": 2}
    actions = (("X", "sleep"), ("click or Space", "throw a ball"), ("left right", "aim"), ("up down", "crates"))
    hides_pointer = False
    head = HEAD
    legend_at = (4, 20)

    def build(self):
        """Create the background and the curves, then call fill() to create the world with its heaps."""
        self.yard = Yard(FLOOR)
        self.curves = [
            Curves(PLOTS[0][0], {"awake": GOLD, "asleep": FOG}, HISTORY),
            Curves(PLOTS[1][0], {"step": SKY}, HISTORY),
        ]
        self.fill()

    def fill(self):
        """Replace the scene's world by a new one with all heaps, and clear the measurements."""
        self.worlds = []
        self.camera = Camera(((0, HEAD), (480, 254)), ZOOM, y=-(FLOOR - HEAD) / ZOOM)
        world = self.add_world(self._chosen_effects())
        world.add_body(Polygon.box(2.0 * WIDE, 256.0), position=(WIDE / 2, 128.0), kind="static")
        for x in (-32.0, WIDE + 32.0):
            world.add_body(Polygon.box(64.0, 2000.0), position=(x, -1000.0), kind="static")
        for x in BOWL:
            world.add_body(Polygon.box(12.0, DEEP), position=(x, -DEEP / 2), kind="static")
        self._pile_up()
        self.heaped = len(world.bodies)
        self.shapes = {body.id: body.shapes[0] for body in world if body.kind == "dynamic"}
        self.known = {}  # body id -> (awake, island) after the last step
        self.lit = {}  # body id -> remaining steps of light
        self.balls = []
        self.aim = FIRST
        self.since = self.thrown = 0
        self.slept_at = self.slept_again = -1  # steps after which all were asleep: at first, after the first ball
        self.idle = 0  # bodies moved in steps that began with all asleep
        self.first_woken = 0  # islands woken by the first step of the wave
        self.waves = []  # (step, islands woken) since the first ball
        self.awake, self.asleep, self.islands = self._count(debug.islands(world))

    def _pile_up(self):
        world, size = self.world, 0.9 * METER
        for row in range(ROWS):
            for column in range(ROWS - row):
                x = PYRAMID + (column - (ROWS - row - 1) / 2) * 1.02 * size
                world.add_body(CRATE, position=(x, -(row + 0.5) * size))
        high = self.values["high"] * size
        plank = Polygon.box(PLANK, high)
        for number in range(COLUMNS):
            x = FIRST + number * self.values["apart"] / 100.0 * METER
            if x < BOWL[0] - size:
                world.add_body(plank, position=(x, -high / 2))
                for row in range(3):
                    world.add_body(CUBE, position=(x, -high - (row + 0.5) * PLANK))
        left, right = BOWL
        for number in range(STONE_COUNT):
            row, column = divmod(number, 5)
            x = left + (column + 0.75 + 0.25 * (row % 2)) * (right - left) / 6
            world.add_body(STONES[number % 3], position=(x, -(0.6 + 0.9 * row) * METER), angle=0.4 * (number % 4))

    def change_slider(self, name, value):
        """Set the slider `name` to `value`, then build the heaps again. The slider "sleep" leaves them as they are."""
        super().change_slider(name, value)
        if name == "sleep":
            self.world.set_effects(self._chosen_effects())
        else:
            self.fill()

    def _chosen_effects(self):
        return self.effects.with_(sleeping=self.effects.sleeping and bool(self.values["sleep"]))

    def update(self, inputs):
        """Process keys and the pointer, make one step, and record the islands that woke."""
        turn = inputs.pressed("up") - inputs.pressed("down")
        if turn:
            self.change_slider("high", self.values["high"] + turn)
        if inputs.pressed("bomb"):
            self.change_slider("sleep", 1 - self.values["sleep"])
        self.aim = min(max(self.aim + 6.0 * (inputs.held("right") - inputs.held("left")), 0.0), WIDE)
        if inputs.pressed("fire"):
            self._throw(self.aim, -self.values["high"] * 0.8 * METER)
        if inputs.pointer_pressed and HEAD < inputs.pointer[1] < FLOOR:
            self._throw(*self.camera.to_world(*inputs.pointer))
        before = self.awake
        self.world.step()
        self.since += 1
        islands = debug.islands(self.world)
        self._see_who_woke(islands)
        self.awake, self.asleep, self.islands = self._count(islands)
        if before == 0 and self.awake == 0:
            self.idle = max(self.idle, self.world.profile.counters["bodies_integrated"])
        if self.awake == 0 and self.thrown == 0 and self.slept_at < 0:
            self.slept_at = self.since
        if self.awake == 0 and self.waves and self.slept_again < 0:
            self.slept_again = self.since

    def _throw(self, x, y):
        """Throw a heavy ball from the upper left towards the point (x, y) [px].

        If there are already BALLS balls, the oldest is removed.
        """
        if len(self.balls) == BALLS:
            gone = self.balls.pop(0)
            self.world.remove_body(gone)
            for table in (self.shapes, self.known, self.lit):
                table.pop(gone, None)
        dx, dy = x - MOUTH[0], y - MOUTH[1]
        far = max(hypot(dx, dy), 1.0)
        shape = Circle(BALL)
        ball = self.world.add_body(
            shape,
            position=MOUTH,
            velocity=(SPEED * dx / far, SPEED * dy / far),
            material=Material(density=BALL_DENSITY),
        )
        self.shapes[ball.id] = shape
        self.balls.append(ball.id)
        self.thrown += 1
        self.play("land")

    def measured(self):
        """Return a RunRequest for two runs that the measuring process times during the game.

        One run steps the heaps while all bodies sleep. The other steps the same heaps in a world without sleeping.
        Return None until all bodies sleep, and after a ball has been thrown.
        """
        if self.awake or not self.asleep or self.thrown:
            return None
        return RunRequest([self._run_name(how) for how in SLEPT], self._make)

    def _run_name(self, how):
        return *self.chosen, how

    def _make(self, name):
        world, awake = self.world, name[-1] != "asleep"
        made = with_effects(world, self.effects.without("sleeping")) if awake else world.snapshot()
        return MeasuredRun([made], self.broadphase)

    def _count(self, islands):
        """Return (awake, asleep, islands): the numbers of awake and of sleeping dynamic bodies, and the number of
        islands.

        islands: for each body, the lowest body id in its island, or -1 without an island, as debug.islands() returns
        them.
        """
        bodies = self.world.bodies
        moves = bodies["inverse_mass"] > 0.0
        awake = int(np.count_nonzero(bodies["awake"] & moves))
        return awake, int(np.count_nonzero(moves)) - awake, len(np.unique(islands[islands >= 0]))

    def _see_who_woke(self, islands):
        bodies, woken = self.world.bodies, set()
        columns = (each.tolist() for each in (bodies["id"], bodies["awake"], islands))
        for identity, awake, island in zip(*columns, strict=True):
            if identity not in self.shapes:
                continue
            was_awake, was_in = self.known.get(identity, (True, -1))
            if awake and not was_awake:
                self.lit[identity] = LIT
                woken.add(was_in)
            self.known[identity] = awake, island if island >= 0 else was_in
        self.lit = {identity: left - 1 for identity, left in self.lit.items() if left > 0}
        if woken and self.thrown:
            if not self.waves:
                self.first_woken = len(woken)
                self.play("hit")
            self.waves.append((self.since, len(woken)))

    def observe(self):
        """Append the numbers of awake and sleeping bodies and the time of this step to the curves."""
        self.curves[0].note({"awake": self.awake, "asleep": self.asleep})
        self.curves[1].note({"step": step_seconds(self.world) * 1e6})

    def draw(self, canvas, alpha):
        """Draw the heaps in the colours of their islands, dark while they sleep, and a plate with the figures.

        alpha: position (0..1) between the last two steps.
        """
        self.yard.draw(canvas)
        surface, camera = canvas.surface, self.camera
        for x in BOWL:
            left, top = camera.to_canvas(x - 6.0, -DEEP)
            surface.fill(SLATE, (round(left), round(top), 6, FLOOR - round(top)))
            surface.fill(faded(PAPER, 0.4), (round(left), round(top), 6, 1))
        bodies = self.world.bodies
        x, y, angle = poses_between(bodies, alpha)
        x, y = camera.to_canvas(x, y, alpha)
        columns = (each.tolist() for each in (bodies["id"], bodies["awake"], x, y, angle))
        for identity, awake, px, py, turn in zip(*columns, strict=True):
            shape = self.shapes.get(identity)
            if shape is not None:
                ramp = (
                    "steel" if identity in self.balls else RAMPS[2 * max(self.known.get(identity, (True, 0))[1], 0) % 5]
                )
                small = scaled(shape, ZOOM)
                (turning(small, ramp) if awake else dimmed(small, ramp)).draw(surface, px, py, turn)
        self._draw_aim(surface)
        self._draw_figures(canvas)

    def _draw_aim(self, surface):
        """Draw the point from which balls are thrown, the start of the next ball's path, and its target."""
        (x, y), (to_x, to_y) = (
            self.camera.to_canvas(*place) for place in (MOUTH, (self.aim, -self.values["high"] * 0.8 * METER))
        )
        for share in (0.06, 0.1, 0.14, 0.18):
            surface.set_at((round(x + share * (to_x - x)), round(y + share * (to_y - y))), PAPER)
        pygame.draw.circle(surface, PAPER, (round(to_x), round(to_y)), 2, 1)
        pygame.draw.circle(surface, GOLD, (round(x), round(y)), 4, 1)

    def _draw_figures(self, canvas):
        plate(canvas, (4, 206, 122, 60))
        islands = sum(count for _, count in self.waves)
        rows = (
            ("awake", f"{self.awake}", GOLD),
            ("asleep", f"{self.asleep}", FOG),
            ("islands", f"{self.islands}", PAPER),
            ("islands woken by balls", f"{islands}", PAPER),
            ("a step, all awake", cost_text(self, self._run_name("awake")), SKY),
            ("a step, all asleep", cost_text(self, self._run_name("asleep")), SKY),
        )
        for number, (word, value, color) in enumerate(rows):
            canvas.text(word, 10, 210 + number * 9, FOG, SMALL)
            canvas.text(value, 120, 210 + number * 9, color, SMALL, align="right")

    def draw_on_frame(self, frame):
        """Draw bright outlines around bodies that have just woken, and the curves."""
        lens, bodies = frame.lens(self.camera), self.world.bodies
        frame.surface.set_clip(lens.clip)
        for identity, left in self.lit.items():
            body, shape = bodies[self.world.rows(identity)], self.shapes[identity]
            px, py = lens.points(float(body["x"]), float(body["y"]))
            points = placed(shape, lens.scale, (px, py, float(body["angle"])))
            color, thick = faded(PAPER, 0.7 * (1.0 - left / LIT)), max(1, frame.scale - 1)
            if len(points) > 2:
                pygame.draw.polygon(frame.surface, color, points, thick)
            else:
                for end in points:
                    pygame.draw.circle(frame.surface, color, end, hull(shape)[1] * lens.scale, thick)
        frame.surface.set_clip(None)
        for curves, (_, rect) in zip(self.curves, PLOTS, strict=True):
            curves.draw(frame, rect)

    def check(self):
        """Return the scene's goals, a list of Goal.

        All bodies fall asleep, and sleeping bodies are not integrated. A knock wakes first one island, then others. At
        last all sleep again.
        """
        woken = sum(count for _, count in self.waves)
        slept = f"after {self.slept_at} steps" if self.slept_at >= 0 else f"{self.awake} awake"
        return [
            Goal("all fall asleep by themselves", SETTLE, self.slept_at >= 0, slept),
            Goal("what sleeps is not moved", SETTLE, self.slept_at >= 0 and self.idle == 0, f"{self.idle} bodies"),
            Goal("the knock wakes one island at first", KNOCK + 90, self.first_woken == 1, f"{self.first_woken}"),
            Goal(
                "the wave comes to eight islands, one after the other",
                580,
                woken >= 8 and len(self.waves) >= 5,
                f"{woken} islands in {len(self.waves)} steps",
            ),
            Goal("all fall asleep again", 1500, self.slept_again >= 0, f"{self.awake} awake"),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        sentence = "Heaps at rest are stepped in every step, until they may sleep."
        number, unit = f"{self.awake} of {self.awake + self.asleep}", "bodies awake and stepped"
        headline = Headline(sentence, "X: sleep", number, unit, self.since, 1, "steps", not self.awake)
        return headline.asks("Does any body move, or cost time, while its heap sleeps?")

    def finding(self):
        """Return a sentence with the number of awake bodies, the times of a step asleep and awake, and the woken
        islands.
        """
        parts = [f"{self.awake} of {self.awake + self.asleep} bodies are awake"]
        awake, asleep = (cost_of(self, self._run_name(how)) for how in SLEPT)
        if awake is not None and asleep is not None:
            parts.append(f"a step takes {microseconds(asleep)} asleep, {awake / asleep:,.1f} x that without sleep")
        elif self.slept_at < 0 and not self.waves:
            return "not yet: all have to fall asleep"
        if self.waves:
            woken = sum(count for _, count in self.waves)
            parts.append(f"balls woke {count_text(woken, 'island')}, {self.first_woken} at first")
        return "; ".join(parts)

    def bot(self):
        """Return the bot's input for the next step.

        The bot lets the bodies sleep, waits until all do, then throws a ball at the top of the first column.
        """
        changes = (("slider:sleep", 1),) if self.frame == 0 else ()
        return InputFrame(frozenset(("fire",)) if self.frame == KNOCK else frozenset(), changes=changes)

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the counts. The worlds are hashed separately."""
        return (
            self.frame,
            *self.values.values(),
            self.aim,
            self.since,
            self.thrown,
            self.awake,
            self.asleep,
            self.islands,
            self.idle,
            self.first_woken,
            self.slept_at,
            self.slept_again,
            len(self.waves),
            sum(count for _, count in self.waves),
        )


@lru_cache(maxsize=64)
def dimmed(shape, ramp):
    """Return the RotatedPicture of a sleeping body's shape, in dimmed colours. ramp: name of the colours in RAMPS."""
    image = piece(shape, ramp)
    image.fill((*DIM, 255), special_flags=pygame.BLEND_RGBA_MULT)
    return RotatedPicture(image)
