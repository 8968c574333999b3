"""The same column of crates in three worlds, one per solver: which of them stands straight?

In short: projection's column falls. The other two solvers keep impulses from step to step, and their columns stand.

What to see: projection removes each overlap alone, without the weight above, so the column jitters apart. Sequential
impulse keeps its impulses from step to step. Soft step does too, and its contacts yield like stiff springs. Both
columns lose about a thousandth of their height; that of soft step comes to rest after a nudge.

Why it matters: All bodies that rest on others need this; in a column a solver's errors add up.

To try: lower the substeps, make the top crate heavy, drag one crate out: which column falls first?

Source: Catto, Iterative Dynamics with Temporal Coherence, 2005; Macklin and others, Small Steps, 2019.
"""

from math import hypot

import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GREEN, ORANGE, PAPER, RED, SKY, faded
from game.drawing.headline import Headline
from game.drawing.number_text import plain_name
from game.drawing.rotated import Cast
from game.drawing.sprites import load_atlas
from game.input.inputs import InputFrame
from game.measurement_requests import MeasuredRun, RunRequest
from game.scene import STANDS, Goal, Scene, Slider
from physics import Effects, Material, Polygon
from scenes.lab.costs import cost_text
from scenes.lab.piles import SOLVERS, deepest
from scenes.lab.yard import HEAD, Yard, plate

COLORS = {"projection": ORANGE, "sequential_impulse": SKY, "soft_step": GREEN}
SIZE, ZOOM = 32.0, 0.5  # [px] a crate of one metre, drawn 16 px large
VIEWS = ((4, 16, 154, 210), (163, 16, 154, 210), (322, 16, 154, 210))
FLOOR = 220  # [canvas px]
MIDDLE, GROUND = 154.0, (FLOOR - 16) / ZOOM  # [px] of each world
UNEVEN = (0.0, 1.5, -1.0, 0.5, -1.5, 1.0)  # [px] offsets of the crates in a column
NUDGE = 40.0  # [px/s] of the nudge to a top crate that is not heavy
WINDOW = 60  # steps over which the sway is measured
SETTLED = 120  # steps after which the sway is measured


class Stacks(Scene):
    """Scene with three worlds that contain the same column of crates, one for each solver."""

    name = "lab/stacks"
    title = "Stacks"
    question = STANDS
    about = "One column of crates under three solvers: height, sway and overlap, measured live."
    effects = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True)
    pieces = ("boxes",)
    features = ("projection, sequential impulse and soft step side by side", "sag, sway and overlap measured live")
    solvers = SOLVERS
    keeps = {"solver": "a column for each solver, side by side: the first is projection's, which falls"}
    sliders = (
        Slider("crates", 4, 12, 11),
        Slider("top crate", 1, 20, 1, "x as heavy"),
        Slider("substeps", 1, 8, 4),
        Slider("column", 0, len(SOLVERS) - 1, 0, choices=SOLVERS),  # the one that the title line is about
    )
    actions = (("X", "column"), ("Space", "nudge"), ("left right", "crates"), ("up down", "top crate"))
    draggable = True
    head = HEAD
    legend_at = (4, 20)

    def build(self):
        """Create the background and the cameras, then call fill() to create the three worlds."""
        self.yard = Yard(FLOOR)
        self.cameras = [Camera(view, ZOOM) for view in VIEWS]
        self.fill()

    def fill(self):
        """Replace the scene's worlds by three new ones with the same column of crates, one for each solver."""
        self.worlds, self.casts, self.tops = [], [], []
        self.since = self.nudged = 0
        self.touched = False
        self.track = {name: [] for name in SOLVERS}  # x of the top crate in the last steps
        self.sway = dict.fromkeys(SOLVERS, 0.0)
        self.sag = dict.fromkeys(SOLVERS, 0.0)
        self.calm_sway = dict.fromkeys(SOLVERS, 0.0)  # greatest sway before any drag
        self.depth = dict.fromkeys(SOLVERS, 0.0)  # greatest overlap after settling
        self.standing = dict.fromkeys(SOLVERS, 0)  # steps for which the top crate stayed near its place
        for name in SOLVERS:
            self._raise_column(name)

    def _raise_column(self, solver):
        world, cast = self.add_world(solver=solver, substeps=int(self.values["substeps"])), Cast(load_atlas("lab"))
        world.add_body(Polygon.box(8000, 64), position=(MIDDLE, GROUND + 32), kind="static")
        count = int(self.values["crates"])
        for number in range(count):
            heavy = self.values["top crate"] if number == count - 1 else 1.0
            place = (MIDDLE + UNEVEN[number % len(UNEVEN)], GROUND - (number + 0.5) * SIZE)
            body = world.add_body(Polygon.box(SIZE, SIZE), position=place, material=Material(density=float(heavy)))
            cast.add(body, "crate_16_2" if heavy > 1.0 else f"crate_16_{number % 2}")
        self.casts.append(cast)
        self.tops.append(body)

    def change_slider(self, name, value):
        """Set the slider `name` to `value`, then build the columns again. A new "column" leaves them as they are."""
        super().change_slider(name, value)
        if name != "column":
            self.fill()

    def update(self, inputs):
        """Process keys, step all worlds, and update the measurements."""
        for name, forth, back in (("crates", "right", "left"), ("top crate", "up", "down")):
            way = inputs.pressed(forth) - inputs.pressed(back)
            if way:
                self.change_slider(name, self.values[name] + way)
        if inputs.pressed("bomb"):
            self.change_slider("column", (self.values["column"] + 1) % len(SOLVERS))
        if inputs.pressed("fire"):
            self.nudged += 1
            self.touched = True
            self.play("hit")
            for top in self.tops:
                top.apply_impulse((NUDGE * SIZE * SIZE, 0.0))
        self.since += 1
        self.touched |= self.drag.holds
        for name, world, top in zip(SOLVERS, self.worlds, self.tops, strict=True):
            world.step()
            self._measure(name, world, top)

    def _measure(self, name, world, top):
        x, y = top.position
        count = int(self.values["crates"])
        self.sag[name] = y - (GROUND - (count - 0.5) * SIZE)
        if self.since > SETTLED:
            self.track[name] = [*self.track[name][-WINDOW + 1 :], x]
            self.sway[name] = max(self.track[name]) - min(self.track[name])
            if not self.touched:
                self.calm_sway[name] = max(self.calm_sway[name], self.sway[name])
            self.depth[name] = max(self.depth[name], deepest(world))
        self.standing[name] += hypot(x - MIDDLE, self.sag[name]) < SIZE

    def measured(self):
        """Return a RunRequest: one run for each column, timed by the measuring process during the game.

        A run starts from the column's current state. Return None until the columns have settled.
        """
        if self.since < SETTLED:
            return None
        worlds = dict(zip(SOLVERS, self.worlds, strict=True))
        return RunRequest(
            [(*self.chosen, name) for name in SOLVERS],
            lambda name: MeasuredRun([worlds[name[-1]].snapshot()], self.broadphase),
        )

    def stands(self, name):
        """Return whether the top crate under the solver `name` has never left its starting position by more than its
        size.
        """
        return self.standing[name] == self.since

    def stands_now(self, index):
        """Return whether the top crate of column number `index` is now within its size of its starting position."""
        x, y = self.tops[index].position
        return hypot(x - MIDDLE, y - (GROUND - (int(self.values["crates"]) - 0.5) * SIZE)) < SIZE

    @property
    def offer(self):
        """Text that offers the player a new run once all columns have fallen; "" otherwise."""
        fallen = not any(self.stands_now(index) for index in range(len(SOLVERS)))
        return "piles them up again" if fallen else ""

    def views(self):
        """Return a list of (world, camera), one for the picture of each solver."""
        return list(zip(self.worlds, self.cameras, strict=True))

    def draw(self, canvas, alpha):
        """Draw the columns, and the figures of each column below it.

        alpha: position (0..1) between the last two steps.
        """
        self.yard.draw(canvas)
        for index, (name, camera, cast) in enumerate(zip(SOLVERS, self.cameras, self.casts, strict=True)):
            cast.draw(canvas, camera, self.worlds[index], alpha)
            self._draw_words(canvas, index, name, camera.viewport)
        for x in (160, 319):
            pygame.draw.line(canvas.surface, faded(PAPER, 0.75), (x, 16), (x, 269))

    def _draw_words(self, canvas, index, name, view):
        box = pygame.Rect(view.x, 222, view.width, 46)
        plate(canvas, box)
        canvas.surface.fill(COLORS[name], (box.x, box.y, 2, box.height))
        canvas.text(plain_name(name), box.x + 6, box.y + 3, COLORS[name])
        stands = self.stands_now(index)
        canvas.text("stands" if stands else "fell", box.right - 4, box.y + 3, GREEN if stands else RED, align="right")
        tall = self.values["crates"] * SIZE
        rows = (
            ("sinks", self.sag[name] / tall),
            ("sways", self.sway[name] / SIZE if self.track[name] else None),  # no sway while it settles
            ("overlap", deepest(self.worlds[index]) / SIZE),
        )
        for row, (word, share) in enumerate(rows):
            y = box.y + 13 + row * 8
            canvas.text(word, box.x + 6, y, FOG, SMALL)
            canvas.surface.fill(faded(COLORS[name], 0.7), (box.x + 42, y, 56, 5))
            if share is None:
                canvas.text("-", box.right - 4, y, PAPER, SMALL, align="right")
                continue
            canvas.surface.fill(COLORS[name], (box.x + 42, y, round(56 * min(1.0, abs(share))), 5))
            canvas.text(f"{100 * share:z.1f} %", box.right - 4, y, PAPER, SMALL, align="right")
        canvas.text("a step", box.x + 6, box.y + 37, FOG, SMALL)
        canvas.text(cost_text(self, (*self.chosen, name)), box.right - 4, box.y + 37, PAPER, SMALL, align="right")

    def draw_on_frame(self, frame):
        """Draw a thin dashed line at the height of a column without overlap."""
        top = GROUND - self.values["crates"] * SIZE
        for camera in self.cameras:
            lens = frame.lens(camera)
            (left, y), (right, _) = lens.points(MIDDLE - 60.0, top), lens.points(MIDDLE + 60.0, top)
            for x in range(round(left), round(right), 6 * frame.scale):
                pygame.draw.line(frame.surface, PAPER, (x, y), (x + 3 * frame.scale, y))

    def check(self):
        """Return the scene's goals, a list of Goal.

        The columns of sequential impulse and soft step stand. The column of projection falls, or sinks three times as
        far.
        """
        pushed, kept, soft = SOLVERS
        tall = self.values["crates"] * SIZE
        return [
            Goal(
                "soft step stands, also after a nudge",
                300,
                self.stands(soft) and self.nudged > 0,
                f"{self.standing[soft]} of {self.since} steps",
                measured=self.nudged > 0,
            ),
            Goal(
                "left alone it sways by less than a fiftieth of a crate",
                240,
                self.calm_sway[soft] < SIZE / 50,
                f"{self.calm_sway[soft]:.3f} px",
            ),
            Goal(
                "it keeps its height to a hundredth",
                300,
                abs(self.sag[soft]) < tall / 100,
                f"sinks {self.sag[soft]:z.2f} px",
            ),
            Goal(
                "its crates overlap by less than a fiftieth",
                300,
                self.depth[soft] < SIZE / 50,
                f"{self.depth[soft]:.2f} px",
            ),
            Goal(
                "sequential impulse stands until the nudge",
                240,
                self.standing[kept] >= 240,
                f"sways {self.calm_sway[kept]:.2f} px",
            ),
            Goal(
                "projection falls, or sinks three times as far",
                300,
                not self.stands(pushed) or self.sag[pushed] > 3 * abs(self.sag[soft]),
                f"{'stands' if self.stands(pushed) else 'fell'}, sinks {self.sag[pushed]:z.2f} px",
            ),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        name = SOLVERS[int(self.values["column"])]
        lost = max(self.sag[name] / (self.values["crates"] * SIZE), 0.0)
        good = lost < 1.0 / self.values["crates"]  # less than a crate
        does = "only pushes overlaps apart" if name == "projection" else "keeps its impulses"
        words = f"{plain_name(name).capitalize()} {does}"
        number, unit = f"{100 * lost:.0f} %", "of its height lost"
        sentence = f"{words}: its column of crates falls."
        headline = Headline(sentence, "X: next solver", number, unit, self.since, SETTLED, "steps", good)
        return headline.asks(f"{words}: does its column of crates stand?")

    def finding(self):
        """Return a sentence with the sag and sway of each column, and the time of a step."""
        if self.since <= SETTLED:
            return "not yet: the columns have to settle for two seconds"
        parts = []
        for index, name in enumerate(SOLVERS):
            sinks, sways = self.sag[name] / (self.values["crates"] * SIZE), self.sway[name] / SIZE
            how = f"sinks {100 * sinks:.1f} %, sways {100 * sways:.1f} %" if self.stands_now(index) else "fell"
            parts.append(f"{plain_name(name)} {how} ({cost_text(self, (*self.chosen, name))})")
        return "; ".join(parts)

    def bot(self):
        """Return the bot's input for the next step. The bot nudges the columns once."""
        return InputFrame(frozenset(("fire",)) if self.frame == 240 else frozenset())

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the measurements. The worlds are hashed
        separately.
        """
        measured = (self.sag, self.sway, self.calm_sway, self.depth, self.standing)
        values = (row[name] for row in measured for name in SOLVERS)
        return (self.frame, self.since, self.nudged, *self.values.values(), *values)
