"""A pyramid of crates: does it stand still, and how long does a step take?

In short: its load grows with the rows. Fewer substeps save time, and crates overlap more: the plot shows both.

What to see: the number of crates grows with the square of the rows, and so does the weight on the lowest ones. With
fewer substeps or another solver, the overlap grows and the top starts to wander.

Why it matters: A pile at rest costs solver time; the plot shows each setting's error.

To try: turn down the substeps, take another solver, and find both in the plot. Then drop the ball.

Source: Macklin and others, Small Steps in Physics Simulation, 2019; Catto, Solver2D, 2024.
"""

import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GOLD, GREEN, ORANGE, PAPER, RED, SKY
from game.drawing.headline import Headline
from game.drawing.number_text import plain_name
from game.drawing.rotated import Cast
from game.drawing.sprites import load_atlas
from game.input.inputs import InputFrame
from game.measure.setting import SUBSTEPPED
from game.measurement_requests import MeasuredRun, RunRequest
from game.scene import STANDS, Goal, Scene, Slider
from physics import BROADPHASES, Circle, Effects, Material, Polygon, World
from scenes.lab.costs import cost_text
from scenes.lab.curves import Curves
from scenes.lab.piles import SOLVERS, deepest, fastest, height_energy, kinetic_energy
from scenes.lab.scatter import Dot, draw_scatter
from scenes.lab.yard import HEAD, Yard, plate

SIZE = 32.0  # [px] a crate of one metre
LOOKS = ((9, 24), (14, 16), (20, 11))  # up to so many rows, size of the drawn crates [canvas px]
FLOOR = 248  # [canvas px]
SUBSTEPS = (1, 2, 3, 4, 6, 8)  # measured ones; others once they were tried
MIDDLE = 300  # [canvas px] the pyramid's axis
GAP = 0.02  # of a crate, between neighbours in a row
BALL = 20  # [canvas px] radius of the ball's picture
BALL_FROM = (160, 26)  # [canvas px] in the view
BALL_DENSITY, BALL_SPEED = 6.0, 9.0  # times a crate's; [crates/s] of the throw
DROP_AT = 330  # the bot's step
JUDGED_AT = 300  # step at which the pyramid is judged
SUNK = 0.05  # crates: the top has left its place
ENERGY_SLACK = 0.001  # of the height energy
OVERLAP = "overlap, 1/1000 crate [log]"
OVERLAP_AT, SCATTER_AT = (4, 176, 130, 32), (4, 106, 130, 68)  # [canvas px]
COLORS = {"projection": ORANGE, "sequential_impulse": SKY, "soft_step": GREEN}


class Pyramid(Scene):
    """Scene with one world: a pyramid of crates, and a ball to throw at it."""

    name = "lab/pyramid"
    title = "Pyramid"
    question = STANDS
    about = "Up to 210 crates in a pyramid: overlap, speed, energy and milliseconds, and a ball to knock it down."
    effects = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True)
    pieces = ("boxes", "circles")
    features = (
        "soft step with substeps, against the other solvers",
        "overlap and energy live; error against time of every solver and number of substeps",
        "a heavy ball to knock it down",
    )
    solvers = SOLVERS
    sliders = (Slider("rows", 5, 20, 12), Slider("substeps", 1, 8, 4), Slider("solver", 0, 2, 0, choices=SOLVERS))
    lighter = {"rows": 7, "substeps": 2}
    actions = (("X", "solver"), ("Space", "drop the ball"), ("left right", "rows"), ("up down", "substeps"))
    draggable = True
    head = HEAD
    legend_at = (4, 212)

    def build(self):
        """Create the background and the curve, then call fill() to build the pyramid."""
        self.yard = Yard(FLOOR)
        self.overlap = Curves(OVERLAP, {OVERLAP: GOLD})
        self.tried = set()  # names of the runs made here, for drawing only
        if self.solver in SOLVERS:  # named on the command line, or chosen before a restart
            self.values["solver"] = SOLVERS.index(self.solver)
        self.balls = 0
        self.fill()

    def fill(self):
        """Replace the scene's world by a new one with the pyramid in it, and clear the measurements."""
        rows = int(self.values["rows"])
        self.drawn = next(size for most, size in LOOKS if rows <= most)
        zoom = self.drawn / SIZE
        self.worlds = []
        self.camera = Camera(((0, 16), (480, 254)), zoom, x=-MIDDLE / zoom, y=-(FLOOR - 16) / zoom)
        self.solver = SOLVERS[int(self.values["solver"])]
        world, self.cast = self.add_world(substeps=int(self.values["substeps"])), Cast(load_atlas("lab"))
        for crate, number in pile_up(world, rows):
            self.cast.add(crate, f"crate_{self.drawn}_{number % 2}")
        self.top = world.body(int(world.bodies["id"][-1]))
        self.crates = rows * (rows + 1) // 2
        self.since = 0
        self.thrown = None
        self.quiet = 0.0  # fastest crate in the second before it is judged [px/s]
        self.still = None  # place of the top when it was judged, or None
        self.deepest = 0.0  # overlap in that second [px]
        self.energy = self.start_energy = height_energy(world)
        self.most_energy = self.energy

    def change_slider(self, name, value):
        """Set the slider `name` to `value`.

        A change of the solver leaves the crates where they are. Other changes rebuild the pyramid.
        """
        super().change_slider(name, value)
        if name == "solver":
            self.solver = self.world.solver = SOLVERS[int(self.values["solver"])]
        else:
            self.fill()

    def update(self, inputs):
        """Process keys, make one step, and update the measurements."""
        for name, forth, back in (("rows", "right", "left"), ("substeps", "up", "down")):
            way = inputs.pressed(forth) - inputs.pressed(back)
            if way:
                self.change_slider(name, self.values[name] + way)
        if inputs.pressed("bomb"):
            self.change_slider("solver", (int(self.values["solver"]) + 1) % len(SOLVERS))
            if self._fallen() >= SUNK:  # the next solver begins with a whole pyramid
                self.fill()
        if inputs.pressed("fire"):
            self._drop()
        self.tried.add(self.run_name)
        self.world.step()
        self._sound()
        self.since += 1
        self.energy = self._energy()
        if self.thrown is None and not self.drag.holds:
            self.most_energy = max(self.most_energy, self.energy)
        if JUDGED_AT - 60 <= self.since <= JUDGED_AT and self.thrown is None:
            self.quiet = max(self.quiet, fastest(self.world))
            self.deepest = max(self.deepest, deepest(self.world))
            if self.since == JUDGED_AT:
                self.still = self.top.position

    @property
    def run_name(self):
        """Name of the run with the current setting: (rows, solver, substeps or None, broad phase)."""
        return self._run_name(self.world.solver, self.world.substeps)

    def _run_name(self, solver, substeps):
        return int(self.values["rows"]), solver, substeps if solver in SUBSTEPPED else None, self.broadphase

    def measured(self):
        """Return a RunRequest: one run for each setting of this pyramid, timed by the measuring process during the
        game.

        A setting is a solver and a number of substeps. A run begins with the new pyramid. Its step time and its errors
        are measured.
        """
        names = [self._run_name(solver, substeps) for substeps in SUBSTEPS for solver in SOLVERS]
        return RunRequest(
            list(dict.fromkeys([self.run_name, *names, *sorted(self._tried_here(), key=str)])), self._make
        )

    def _tried_here(self):
        return [name for name in self.tried if name[0] == self.values["rows"] and name[-1] == self.broadphase]

    def _make(self, name):
        rows, solver, substeps, _ = name
        more = {} if substeps is None else {"substeps": substeps}
        world = World(self.effects, BROADPHASES[self.broadphase](), solver, **more)
        pile_up(world, rows)
        return MeasuredRun([world.snapshot()], self.broadphase, judged=(JUDGED_AT - 60, JUDGED_AT))

    def dots(self):
        """Return {run name: Dot} for the measured runs of this pyramid.

        A Dot's cost is the time of a step [us]. Its error is the overlap [1/1000 of a crate].
        """
        found = {}
        for name, figures in self.figures.items():
            rows, solver, substeps, broadphase = name
            if (rows, broadphase) == (self.values["rows"], self.broadphase) and figures.sure:
                word = "" if substeps is None else str(substeps)
                cost, overlap = 1e6 * figures.cost.median, 1e3 * figures.overlap / SIZE
                found[name] = Dot(cost, overlap, COLORS[solver], word, name in self.tried)
        return found

    def _fallen(self):
        """Return how much lower the top crate is than it was built [crates]."""
        return max(self.top.position[1] - self._built_at()[1], 0.0) / SIZE

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        fallen = self._fallen()
        name = plain_name(SOLVERS[int(self.values["solver"])])
        name = name[:1].upper() + name[1:]
        unit, good = "crates lower than built", fallen < SUNK
        sentence = f"{name} does not hold a pyramid of {self.crates} crates: the top sinks."
        headline = Headline(sentence, "X: solver", f"{fallen:.2f}", unit, self.since, 60, "steps", good)
        return headline.asks(f"{name} has to hold {self.crates} crates: does the top sink?")

    def finding(self):
        """Return a sentence with the cost and error of the current setting.

        It also names the cheapest setting with no greater error, once all settings are measured.
        """
        dots = self.dots()
        if self.run_name not in dots:
            return "not yet: this pyramid has to be stepped beside the game"
        mine = dots[self.run_name]
        sentence = f"a step takes {mine.cost:,.0f} us and crates overlap by {mine.error:.1f} thousandths"
        as_good = [name for name, dot in dots.items() if dot.error <= mine.error]
        best = min(as_good, key=lambda name: dots[name].cost)
        if len(dots) < len(self.measured().names) or best == self.run_name:
            return sentence
        substeps = "" if best[2] is None else f", {best[2]} substeps"
        return f"{sentence}; {plain_name(best[1])}{substeps}: no more for {dots[best].cost:,.0f} us"

    def _energy(self):
        """Return the sum of the kinetic and potential energy of all crates, without the ball [mass px2/s2]."""
        ball = () if self.thrown is None else (self.thrown.id,)
        return kinetic_energy(self.world, ball) + height_energy(self.world, ball)

    @property
    def offer(self):
        """Text that offers the player a new run once the top crate has fallen; "" otherwise."""
        down = self.top.position[1] - self._built_at()[1] > SIZE
        return "piles them up again" if down else ""

    def _built_at(self):
        """Return the position (x, y) [px] at which the top crate was built."""
        return 0.0, -(int(self.values["rows"]) - 0.5) * SIZE

    def _drop(self):
        """Throw a new ball from the upper left, and remove the previous ball."""
        if self.thrown is not None:
            self.world.remove_body(self.thrown)
        radius = BALL / self.camera.zoom
        start = (self.camera.x + BALL_FROM[0] / self.camera.zoom, self.camera.y + BALL_FROM[1] / self.camera.zoom)
        material = Material(density=BALL_DENSITY, friction=0.6)
        self.thrown = self.world.add_body(
            Circle(radius), position=start, material=material, velocity=(BALL_SPEED * SIZE, 0.0)
        )
        self.cast.add(self.thrown, "iron_ball")
        self.balls += 1
        self.play("land")

    def _sound(self):
        hits = self.world.events.hits
        if self.thrown is not None and len(hits):
            mine = (hits["body_a"] == self.thrown.id) | (hits["body_b"] == self.thrown.id)
            if mine.any() and float(hits["speed"][mine].max()) > 4 * SIZE:
                self.play("hit", None, 0.6)
                self.camera.shake(0.25)

    def observe(self):
        """Append the overlap of this step to its curve."""
        self.overlap.note({OVERLAP: 1000.0 * deepest(self.world) / SIZE})

    def draw(self, canvas, alpha):
        """Draw the background, the pile, and a plate with the figures.

        alpha: position (0..1) between the last two steps.
        """
        self.yard.draw(canvas)
        self.cast.draw(canvas, self.camera, self.world, alpha)
        plate(canvas, (4, 22, 130, 80))
        solver = SOLVERS[int(self.values["solver"])]
        canvas.text(f"{self.crates} crates", 10, 26, GOLD)
        change = 100.0 * (self.energy - self.start_energy) / abs(self.start_energy)
        rows = (
            ("solver", plain_name(solver)),
            ("substeps", f"{self.values['substeps']}"),
            ("a step", cost_text(self, self.run_name)),
            ("contacts", f"{len(self.world.contacts)}"),
            ("overlap", f"{100 * deepest(self.world) / SIZE:.2f} %"),
            ("fastest", f"{fastest(self.world) / SIZE:.3f} m/s"),
            ("energy", f"{change:+.3f} %"),
        )
        for number, (word, value) in enumerate(rows):
            canvas.text(word, 10, 38 + number * 9, FOG, SMALL)
            canvas.text(value, 128, 38 + number * 9, PAPER, SMALL, align="right")

    def draw_on_frame(self, frame):
        """Draw the curve of the overlap, and the plot of error against time of all measured settings.

        A triangle marks the position at which the top crate was built. It is green while the pyramid is at rest there.
        """
        self.overlap.draw(frame, OVERLAP_AT)
        draw_scatter(frame, SCATTER_AT, "overlap over a step's time [log]", self.dots(), self.run_name)
        if self.thrown is None:
            (x, y), lens = self._built_at(), frame.lens(self.camera)
            aside = max(abs(self.top.position[0] - x), abs(self.top.position[1] - y))
            color = GREEN if aside < SIZE / 20 and fastest(self.world) < SIZE / 20 else RED
            x, y = lens.points(x, y - SIZE)
            wide, high = 3 * frame.scale, 5 * frame.scale
            pygame.draw.polygon(frame.surface, color, [(x, y), (x - wide, y - high), (x + wide, y - high)])

    def check(self):
        """Return the scene's goals, a list of Goal.

        The pyramid stands without creep, sag or gain of energy. Later the ball knocks it down.
        """
        rows = int(self.values["rows"])
        sunk = abs(self.still[1] + (rows - 0.5) * SIZE) / SIZE if self.still else 1.0
        aside = abs(self.still[0]) / SIZE if self.still else 1.0
        gained = (self.most_energy - self.start_energy) / abs(self.start_energy)
        moved = self.top.position[1] + (rows - 0.5) * SIZE if self.thrown else 0.0
        return [
            Goal(
                "nothing moves by more than a twentieth of a crate a second",
                JUDGED_AT,
                self.still is not None and self.quiet < SIZE / 20,
                f"{self.quiet / SIZE:.4f} crates/s",
            ),
            Goal(
                "the top is where it was built",
                JUDGED_AT,
                sunk < SUNK and aside < SUNK,
                f"{sunk:.4f} crates lower, {aside:.4f} aside",
            ),
            Goal(
                "no overlap beyond a fiftieth of a crate",
                JUDGED_AT,
                self.still is not None and self.deepest < SIZE / 50,
                f"{self.deepest / SIZE:.4f} crates",
            ),
            Goal("standing adds no energy", JUDGED_AT, gained < ENERGY_SLACK, f"{gained:+.6f}"),
            Goal(
                "the ball knocks the top down",
                560,
                self.thrown is not None and moved > 2 * SIZE,
                f"{moved / SIZE:.1f} crates",
            ),
        ]

    def bot(self):
        """Return the bot's input for the next step.

        The bot selects the soft step solver, lets the pyramid stand, then throws the ball.
        """
        changes = (("slider:solver", SOLVERS.index("soft_step")),) if self.frame == 0 else ()
        return InputFrame(frozenset(("fire",)) if self.frame == DROP_AT else frozenset(), changes=changes)

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the measurements. The worlds are hashed
        separately.
        """
        x, y = self.still or (0.0, 0.0)
        return (
            self.frame,
            self.since,
            *self.values.values(),
            self.balls,
            self.quiet,
            self.deepest,
            self.energy,
            self.most_energy,
            x,
            y,
        )


def pile_up(world, rows):
    """Add the ground and a pyramid of `rows` rows of crates to a world.

    Return a list of (crate, row + column), from the bottom up. row and column are the crate's numbers in the pyramid.
    """
    world.add_body(Polygon.box(200 * SIZE, 2 * SIZE), position=(0.0, SIZE), kind="static")
    shape, width, crates = Polygon.box(SIZE, SIZE), SIZE * (1.0 + GAP), []
    for row in range(rows):
        for column in range(rows - row):
            place = ((column - (rows - row - 1) / 2) * width, -(row + 0.5) * SIZE)
            crates.append((world.add_body(shape, position=place), row + column))
    return crates
