"""Five steel balls in a row, hit by one or two: do as many leave the other end?

In short: with a gap, only two balls collide at a time. Without it several meet in one step, and projection scatters its
row.

What to see: three channels with the same row, one per solver. With a small gap between the balls, each collision is one
of two balls, and momentum and energy allow one result: the last ball leaves with the whole speed. Without the gap
several balls meet in one step, and the result is open. Sequential impulse and soft step solve such hits together: as
many balls leave as came. Projection scatters its row.

Why it matters: A chain of hits in one step shows whether a solver passes impulses on, or mixes them.

To try: set the gap to 0, then take two strikers, and see which row loses its order.

Source: Hutzler, Delaney, Weaire, MacLeod, Rocking Newton's Cradle, American Journal of Physics, 2004.
"""

import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GREEN, ORANGE, PAPER, RED, SKY, faded
from game.drawing.headline import Headline
from game.drawing.number_text import error_text, plain_name, share_text
from game.drawing.rotated import Cast
from game.drawing.sprites import load_atlas
from game.input.inputs import InputFrame
from game.measurement_requests import MeasuredRun, RunRequest
from game.scene import STANDS, Goal, Scene, Slider
from physics import Circle, Effects, Material, Polygon
from scenes.lab.costs import cost_text
from scenes.lab.piles import SOLVERS, kinetic_energy
from scenes.lab.yard import HEAD, Yard, darken, plate

COLORS = {"projection": ORANGE, "sequential_impulse": SKY, "soft_step": GREEN}
ZOOM, RADIUS = 0.5, 28.0  # [px] drawn 28 px large
LANES = (16, 100, 184)  # [canvas px] top of each view
LANE_HEIGHT = 84
ROW = 5  # balls at rest
MIDDLE, LINE = 500.0, 72.0  # [px] middle of the row, height of the channel's axis
LEFT, RIGHT = 14.0, 946.0  # [px] faces of the end walls
FIRST = 60.0  # [px] of the first striker
SPEED = 300.0  # [px/s] 5 px a step, less than the gap: one collision at a time
GAP = 8  # [px] of the bot: one collision at a time
PERIOD = round(60 * 2 * (RIGHT - LEFT) / SPEED)  # steps of a single ball to and fro
SEEN = 1e-6  # of the strikers' speed: a greater error is shown as wrong
SCATTERED = 0.01  # of that speed: the row has lost its order
CLEAN = 1e-9  # of the striker's speed, momentum or energy
SWITCH_AT = 300  # the bot's step for two strikers


class Cradle(Scene):
    """Scene with three worlds, one for each solver. Each contains a channel with a row of balls."""

    name = "lab/cradle"
    title = "Cradle"
    question = STANDS
    about = "Newton's cradle in a channel: strike a row of five with one or two balls, under three solvers."
    effects = Effects(response=True, restitution=True, stacking=True)
    pieces = ("circles",)
    features = ("restitution of 1, a chain of collisions", "momentum and energy to nine digits")
    solvers = SOLVERS
    keeps = {"solver": "a channel for each solver, with the same balls: the first is projection's"}
    sliders = (Slider("strikers", 1, 3, 1), Slider("gap", 0, 16, 0, "px"))
    actions = (("Space", "again"), ("up down", "strikers"), ("left right", "gap"))
    draggable = True
    head = HEAD
    legend_at = (4, 20)

    def build(self):
        """Create the picture of the channels and the cameras, then call fill() to create the worlds with
        their balls.
        """
        self.yard = Yard((), 90)
        self.cameras = [Camera((0, top, 480, LANE_HEIGHT), ZOOM) for top in LANES]
        self.results = {}  # (solver, strikers, gap) -> greatest error of the first pass, up to the wall
        self.drift = {}  # the same -> greatest error of the energy, as a share
        self.fill()

    def fill(self):
        """Replace the scene's worlds by three new ones, one for each solver, with the same balls."""
        self.worlds, self.casts, self.balls = [], [], []
        strikers, pitch = int(self.values["strikers"]), 2 * RADIUS + self.values["gap"]
        ball = Material(density=1.0, friction=0.0, restitution=1.0)
        for name in SOLVERS:
            world, cast = self.add_world(solver=name, gravity=(0, 0)), Cast(load_atlas("lab"))
            for x in (LEFT - 40.0, RIGHT + 40.0):
                world.add_body(Polygon.box(80, 60), position=(x, LINE), kind="static", material=ball)
            row = []
            for number in range(strikers):
                body = world.add_body(
                    Circle(RADIUS), position=(FIRST + number * pitch, LINE), velocity=(SPEED, 0.0), material=ball
                )
                row.append(cast.add(body, "striker_ball"))
            for number in range(ROW):
                x = MIDDLE + (number - (ROW - 1) / 2) * pitch
                row.append(cast.add(world.add_body(Circle(RADIUS), position=(x, LINE), material=ball), "steel_ball"))
            self.casts.append(cast)
            self.balls.append(row)
        self.laid = [[body.position[0] for body in row[strikers:]] for row in self.balls]
        self.first_pass = [True] * len(SOLVERS)  # no ball has reached the right wall
        self.energy = [kinetic_energy(world) for world in self.worlds]
        self.momentum = [float((world.bodies["mass"] * world.bodies["vx"]).sum()) for world in self.worlds]
        self.touched = False  # a ball is dragged: measurements end

    def change_slider(self, name, value):
        """Set the slider `name` to `value`, then make the worlds and balls again."""
        super().change_slider(name, value)
        self.fill()

    def update(self, inputs):
        """Process keys, step all worlds, and update the measurements."""
        for name, forth, back in (("strikers", "up", "down"), ("gap", "right", "left")):
            way = inputs.pressed(forth) - inputs.pressed(back)
            if way:
                self.change_slider(name, self.values[name] + way)
        if inputs.pressed("fire"):
            self.fill()
        self.touched |= self.drag.holds
        for index, (name, world) in enumerate(zip(SOLVERS, self.worlds, strict=True)):
            world.step()
            if not self.touched:
                self._keep_books(index, name, world)
        if len(self.worlds[-1].events.hits):
            self.play("blip", None, 0.4)

    def _keep_books(self, index, name, world):
        off = abs(kinetic_energy(world) / self.energy[index] - 1.0)
        strikers = int(self.values["strikers"])
        key = (name, strikers, int(self.values["gap"]))
        self.drift[key] = max(self.drift.get(key, 0.0), off)
        row = self.balls[index]
        self.first_pass[index] &= row[-1].position[0] + RADIUS + SPEED / 60 < RIGHT
        if not self.first_pass[index] or not self.struck(index):
            return
        speeds = [body.velocity[0] / SPEED for body in row]
        found = (
            self.others(index),
            abs(sum(speeds) / strikers - 1.0),
            abs(sum(speed * speed for speed in speeds) / strikers - 1.0),
        )
        self.results[key] = tuple(max(pair) for pair in zip(found, self.results.get(key, found), strict=True))

    def measured(self):
        """Return a RunRequest: the runs that the measuring process times during the game, one for each channel.

        In a run, the channel is stepped for the time that a ball needs from one wall to the other and back.
        """
        worlds = dict(zip(SOLVERS, self.worlds, strict=True))
        return RunRequest(
            [(*self.chosen, name) for name in SOLVERS],
            lambda name: MeasuredRun([worlds[name[-1]].snapshot()], self.broadphase, PERIOD),
        )

    def struck(self, index):
        """Return whether a ball of the row in channel number `index` has left its starting position or has
        a velocity.
        """
        row = self.balls[index][-ROW:]
        return any(
            body.velocity[0] != 0.0 or body.position[0] != x for body, x in zip(row, self.laid[index], strict=True)
        )

    def others(self, index):
        """Return the error of channel number `index` against the ideal collision, as a share of the strikers' speed.

        In the ideal collision, as many balls as have struck move at the strikers' speed, and all others are at rest.
        The error is the greatest difference between a ball's speed and the nearer of these two speeds. It is 1 if the
        number of fast balls is wrong.
        """
        speeds = [abs(body.velocity[0]) / SPEED for body in self.balls[index]]
        fast = sum(speed > 0.5 for speed in speeds)
        if fast != int(self.values["strikers"]):
            return 1.0
        return max(min(speed, abs(speed - 1.0)) for speed in speeds)

    @property
    def offer(self):
        """Text that offers the player a new run once the balls of a channel have lost their order; "" otherwise."""
        return "lays them in anew" if any(self.others(index) > SCATTERED for index in range(len(SOLVERS))) else ""

    def views(self):
        """Return a list of (world, camera), one for the picture of each channel."""
        return list(zip(self.worlds, self.cameras, strict=True))

    def draw(self, canvas, alpha):
        """Draw the channels, the balls, and the measurements below each channel.

        alpha: position (0..1) between the last two steps.
        """
        self.yard.draw(canvas)
        for index, (name, camera, cast) in enumerate(zip(SOLVERS, self.cameras, self.casts, strict=True)):
            self._draw_channel(canvas, camera.viewport)
            cast.draw(canvas, camera, self.worlds[index], alpha)
            self._draw_words(canvas, index, name, camera.viewport)

    def _draw_channel(self, canvas, view):
        surface, y = canvas.surface, view.y + round(LINE * ZOOM)
        reach = round(RADIUS * ZOOM)
        darken(canvas, (0, y - reach - 2, 480, 2 * reach + 4), (20, 16, 32, 150))
        for edge, lit in ((y - reach - 3, (190, 196, 216)), (y + reach + 2, (92, 96, 124))):
            surface.fill((58, 60, 82), (0, edge - 1, 480, 3))
            surface.fill(lit, (0, edge - 1, 480, 1))
        for x, width in ((0, round(LEFT * ZOOM)), (round(RIGHT * ZOOM), 480)):
            surface.fill((92, 96, 124), (x, y - reach - 3, width, 2 * reach + 6))
            pygame.draw.rect(surface, (20, 16, 32), (x, y - reach - 3, width, 2 * reach + 6), 1)

    def _draw_words(self, canvas, index, name, view):
        y = view.y + 66
        canvas.text(plain_name(name), 8, view.y + 6, COLORS[name], outline=True)
        bodies = self.worlds[index].bodies
        energy = 100.0 * kinetic_energy(self.worlds[index]) / self.energy[index]
        momentum = 100.0 * float((bodies["mass"] * bodies["vx"]).sum()) / self.momentum[index]
        plate(canvas, (4, y - 3, 472, 12))
        canvas.text("momentum", 10, y, FOG, SMALL)
        canvas.text(f"{momentum:+.4f} %", 110, y, PAPER, SMALL, align="right")
        canvas.text("energy", 134, y, FOG, SMALL)
        canvas.text(f"{energy:.4f} %", 226, y, PAPER, SMALL, align="right")
        canvas.text("a step", 250, y, FOG, SMALL)
        canvas.text(cost_text(self, (*self.chosen, name)), 326, y, PAPER, SMALL, align="right")
        words, color = self.verdict(index)
        canvas.text(words, 470, y, color, SMALL, align="right")

    def verdict(self, index):
        """Return (text, colour): the result of channel number `index` in its current state."""
        if self.touched:
            return "dragged: nothing is promised", FOG
        if not self.struck(index):
            return "not struck yet", FOG
        others, strikers = self.others(index), int(self.values["strikers"])
        if others < SEEN:
            return "as many leave as came", GREEN
        fast = sum(abs(body.velocity[0]) > SPEED / 2 for body in self.balls[index])
        if fast != strikers:
            return f"{fast} fast ones instead of {strikers}", RED
        return f"others move too, by {100 * others:.1f} %", RED

    def draw_on_frame(self, frame):
        """Draw an arrow above every moving ball. Its length is proportional to the ball's speed."""
        for index, camera in enumerate(self.cameras):
            lens = frame.lens(camera)
            for body in self.balls[index]:
                way = body.velocity[0] / SPEED
                if abs(way) > 0.01:
                    x, y = lens.points(*body.position)
                    y -= 20 * frame.scale
                    end = x + way * 18 * frame.scale
                    tip = 3 * frame.scale * (1 if way > 0 else -1)
                    pygame.draw.line(frame.surface, faded(COLORS[SOLVERS[index]], 0.0), (x, y), (end, y), frame.scale)
                    pygame.draw.polygon(
                        frame.surface,
                        COLORS[SOLVERS[index]],
                        [(end + tip, y), (end, y - abs(tip)), (end, y + abs(tip))],
                    )

    def check(self):
        """Return the scene's goals, a list of Goal.

        With one and with two strikers, as many balls leave as have struck, and momentum and energy are conserved.
        """
        goals = []
        for name in SOLVERS:
            for strikers, due in ((1, 200), (2, SWITCH_AT + 200)):
                key, words = (name, strikers, GAP), plain_name(name)
                seen, (wrong, *kept) = key in self.results, self.results.get(key, (1.0, 1.0, 1.0))
                title = f"{words}: {strikers} in, {strikers} out"
                goals.append(Goal(title, due, wrong < CLEAN, error_text(wrong), seen))
                title = f"{words}, {strikers}: momentum and energy stay"
                goals.append(Goal(title, due, max(kept) < CLEAN, error_text(max(kept)), seen))
            key = (name, 1, GAP)
            drift, title = self.drift.get(key, 1.0), f"{words}: with one striker energy stays for good, walls and all"
            goals.append(Goal(title, SWITCH_AT, drift < CLEAN, error_text(drift), key in self.drift))
        return goals

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        strikers, gap = int(self.values["strikers"]), int(self.values["gap"])
        fast = sum(abs(body.velocity[0]) > SPEED / 2 for body in self.balls[0])
        number, good = f"{fast} of {strikers}", fast == strikers
        sentence = f"As many balls should leave as came; balls {gap} px apart confuse projection."
        struck = int(self.struck(0))
        headline = Headline(sentence, "right: a gap", number, "balls leave (top)", struck, 1, "strikes", good)
        return headline.asks(f"Do as many balls leave as came, with gaps of {gap} px?")

    def finding(self):
        """Return a sentence with the error of each channel's speeds before a ball reaches the right wall, and its step
        time.
        """
        strikers, parts = int(self.values["strikers"]), []
        for name in SOLVERS:
            found = self.results.get((name, strikers, int(self.values["gap"])))
            if found is None:
                return "not yet: each row has to be struck, and not dragged"
            parts.append(f"{plain_name(name)} {share_text(found[0])} ({cost_text(self, (*self.chosen, name))})")
        return f"{strikers} in, {strikers} out; speeds are off by {', '.join(parts)}"

    def bot(self):
        """Return the bot's input for the next step.

        The bot sets a gap between the balls. It uses one striker at first, and two later.
        """
        changes = (("slider:gap", GAP),) if self.frame == 0 else ()
        return InputFrame(frozenset(("up",)) if self.frame == SWITCH_AT else frozenset(), changes=changes)

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the measurements. The worlds are hashed
        separately.
        """
        found = [value for key in sorted(self.results) for value in (*key, *self.results[key])]
        drift = [value for key in sorted(self.drift) for value in (*key, self.drift[key])]
        return (self.frame, *self.values.values(), self.touched, *found, *drift)
