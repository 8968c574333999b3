"""Fifteen balls, a cue ball and six pockets: does a break keep energy and momentum?

In short: balls that bounce at 96 % lose energy in every collision, but no momentum. At 100 % they keep both.

What to see: the table is seen from above, so there is no gravity, only the drag of the cloth. Until a ball meets a
cushion, the total momentum of all balls equals that of the cue ball, in size and direction. No collision of two balls
adds energy. Pockets are sensors: they push nothing and report each ball.

Why it matters: Billiard games depend on the break; a solver must not lose momentum there.

To try: break with the cue from other sides, and read the error of the momentum before the first cushion.

Source: Coriolis, Theorie mathematique du jeu de billard, 1835.
"""

from math import atan2, cos, hypot, sin
from random import Random

import numpy as np
import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GOLD, GREEN, PAPER, RED, SKY, SLATE
from game.drawing.headline import ENOUGH, Headline
from game.drawing.number_text import count_text, error_text, share_text
from game.drawing.rotated import Cast
from game.drawing.sprites import load_atlas
from game.input.inputs import InputFrame
from game.scene import STANDS, Goal, Scene, Slider
from physics import Circle, Effects, Material
from scenes.lab.billiard_table import BALL, CLOTH, HEAD_SPOT, HOLES, MOUTH, best_point, cushions, first_in_the_way, rack
from scenes.lab.piles import kinetic_energy
from scenes.lab.yard import HEAD, plate

TABLE = (4, 24)  # [canvas px] place of the table's picture
FASTEST = 1300.0  # [px/s] of a cue ball hit with full power
RESTS = 4.0  # [px/s] when no ball is faster, all stop
DRAG = 0.5  # [1/s]
PIXELS_PER_METER = 4.0  # so that balls still bounce at 4 px/s: this table is 86 m of slow motion
MOVED = 13  # of the fifteen balls, that a break moves at least
BOUNCES = (96, 100)  # [%] between which X switches
ALLOWED = 0.01  # loss of energy in a break that counts as none
OPENS = 60  # step at which a first break is made, unless the player has made one
SWING = 70  # steps from no power to full while the mouse is held
CALM = 30  # steps that the bot waits
SIDE = 396  # [canvas px] left of the score


class Billiards(Scene):
    """Scene with one world: a billiard table seen from above."""

    name = "lab/billiards"
    title = "Billiards"
    question = STANDS
    about = "Break fifteen balls and pot them: momentum until the first cushion, energy, and pockets that are sensors."
    effects = Effects(response=True, restitution=True, drag=True, continuous=True, sensors=True)
    pieces = ("circles", "capsules", "queries")
    features = ("a break that keeps its momentum", "fast balls swept against balls", "pockets as sensors")
    sliders = (Slider("bounce", 50, 100, 96, "%", step=2), Slider("drag", 0.1, 2.0, DRAG, "1/s", step=0.1))
    actions = (("X", "bounce"), ("mouse", "aim; hold, let go"), ("arrows", "aim, power"), ("Space", "shoot"))
    draggable = True
    head = HEAD
    legend_at = (SIDE, 150)

    def build(self):
        """Build table, cushions, pockets and balls."""
        atlas = load_atlas("lab")
        self.table, self.cast = atlas["table"], Cast(atlas)
        self.ball_names = {}  # body id -> number
        self.potted = []
        self.shots = self.scratches = self.calm = 0
        self.aim, self.power, self.held, self.last_pointer = 0.0, 0.9, -1, (0, 0)
        self.budget = None  # reference of a break: momentum and steps, until a cushion is hit
        self.kept = 0.0  # greatest error of momentum, as a share
        self.off = 0.0  # current error, if a break is measured
        self.grown = self.grown_by_three = 0.0  # greatest gain of energy per step, as a share; in triples
        self.compared = 0  # steps
        self.collisions = 0
        self.energy = self.given = 0.0  # kinetic energy now, and of the last shot
        self.left = 1.0  # share of that energy before the first cushion, apart from what the cloth takes
        self.fill()

    def fill(self):
        """Replace the scene's world by a new one with cushions, pockets and racked balls."""
        self.worlds = []
        bounce = self.values["bounce"] / 100.0
        world = self.add_world(drag=self.values["drag"], pixels_per_meter=PIXELS_PER_METER)
        self.material = Material(friction=0.0, restitution=bounce)
        rubber = Material(friction=0.0, restitution=bounce * 0.85)
        self.cushions = {world.add_body(shape, kind="static", material=rubber).id for shape in cushions()}
        self.holes = {world.add_body(Circle(MOUTH), position=hole, kind="static", sensor=True).id for hole in HOLES}
        self.ball_names.clear()
        self.potted.clear()
        self.cue = self._add_ball(0, HEAD_SPOT)
        for number, place in rack(Random(self.seed)):
            self._add_ball(number, place)
        self.racked = {identity: self.world.body(identity).position for identity in self.ball_names}
        self.budget = None

    def _add_ball(self, number, place):
        body = self.world.add_body(Circle(BALL), position=place, material=self.material, bullet=True)
        self.ball_names[body.id] = number
        self.cast.add(body, f"ball_{number}")
        return body

    def change_slider(self, name, value):
        """Set the slider `name` to `value`, then make a new world with racked balls. Momentum is compared anew."""
        super().change_slider(name, value)
        self.kept, self.compared = 0.0, 0
        self.fill()

    @property
    def resting(self):
        """True when every ball has stopped."""
        bodies = self.world.bodies
        return not ((bodies["vx"] != 0.0) | (bodies["vy"] != 0.0)).any()

    @property
    def offer(self):
        """Text that offers the player a new run once all object balls are potted; "" otherwise."""
        return "racks them again" if len(self.ball_names) == 1 else ""

    def update(self, inputs):
        """Process the player's aim and shot, step the world, then measure momentum and energy."""
        if inputs.pressed("bomb"):
            self.change_slider("bounce", BOUNCES[self.values["bounce"] < BOUNCES[1]])
            self.shoot()
        if self.resting and not self.drag.holds:
            self.calm += 1
            self._aim(inputs)
            if self.calm == OPENS and not self.shots:
                self.shoot()
        else:
            self.calm, self.held = 0, -1
        before = kinetic_energy(self.world)
        self.world.step()
        self._keep_books(before)
        self._pot()
        self._stop_the_slow()
        self.collisions += len(self.world.events.hits)
        for row in self.world.events.hits:
            self.play("blip", float(row["point_x"]), min(1.0, float(row["speed"]) / 500.0))

    def _aim(self, inputs):
        x, y = self.cue.position
        if inputs.pointer != self.last_pointer and CLOTH.inflate(40, 40).collidepoint(inputs.pointer):
            self.aim = atan2(inputs.pointer[1] - y, inputs.pointer[0] - x)
        self.last_pointer = inputs.pointer
        fine = 0.1 if inputs.held("focus") else 1.0
        self.aim += 0.012 * fine * (inputs.held("right") - inputs.held("left"))
        self.power += 0.01 * (inputs.held("up") - inputs.held("down")) + 0.05 * inputs.wheel
        self.power = min(max(self.power, 0.05), 1.0)
        if inputs.pointer_pressed and CLOTH.collidepoint(inputs.pointer):
            self.held = 0
        elif self.held >= 0 and inputs.pointer_down:
            self.held += 1
            swing = self.held / SWING % 2.0
            self.power = max(0.05, swing if swing <= 1.0 else 2.0 - swing)
        if inputs.pressed("fire") or (self.held >= 0 and not inputs.pointer_down):
            self.shoot()

    def shoot(self):
        """Shoot: set the cue ball's velocity along the aim, with a speed in proportion to the power."""
        speed = FASTEST * self.power
        velocity = (speed * cos(self.aim), speed * sin(self.aim))
        self.cue.velocity = velocity
        mass = self.cue.mass
        self.budget = (mass * velocity[0], mass * velocity[1], 0)
        self.shots += 1
        self.given, self.left = kinetic_energy(self.world), 1.0
        self.calm, self.held = 0, -1
        self.play("hit", self.cue.position[0], 0.4 + 0.6 * self.power)

    def _keep_books(self, before):
        """Update the errors of momentum and energy after a step. `before`: kinetic energy before the step.

        The total momentum is compared with the cue ball's momentum at the shot, until a ball hits a cushion. The
        kinetic energy is compared with the energy before the step. Both comparisons allow for the drag of the cloth.
        """
        keep = 1.0 / (1.0 + self.values["drag"] * self.world.dt)
        self.energy = kinetic_energy(self.world)
        if self.drag.holds:
            self.budget = None
            return
        if before > 0.0:
            grown = self.energy / (before * keep * keep) - 1.0
            if self._three_met():
                self.grown_by_three = max(self.grown_by_three, grown)
            else:
                self.grown = max(self.grown, grown)
        if self.budget is None:
            return
        px, py, steps = self.budget
        steps += 1
        bodies, begun = self.world.bodies, self.world.events.begin
        borne = self.world.contacts[self.world.contacts["normal_impulse"] > 0.0]  # also by a ball that lay at a cushion
        met = {each for rows in (begun, borne) for name in ("body_a", "body_b") for each in rows[name].tolist()}
        if met & self.cushions or len(self.world.events.sensor_begin):
            self.budget = None
            return
        left = keep**steps
        now_x, now_y = (float((bodies["mass"] * bodies[name]).sum()) for name in ("vx", "vy"))
        self.off = hypot(now_x - px * left, now_y - py * left) / (hypot(px, py) * left)
        self.kept = max(self.kept, self.off)
        self.compared += 1
        self.left = self.energy / (self.given * left * left)
        self.budget = (px, py, steps)

    def _three_met(self):
        """Return whether a body had two or more contacts in the last step.

        The laws of impact alone do not determine the result of such a collision.
        """
        contacts = self.world.contacts
        both = np.concatenate((contacts["body_a"], contacts["body_b"]))
        return len(np.unique(both)) < len(both)

    def _pot(self):
        begun = self.world.events.sensor_begin
        for first, second in zip(begun["body_a"].tolist(), begun["body_b"].tolist(), strict=True):
            ball = first if first in self.ball_names else second
            if ball not in self.ball_names:
                continue  # it reached the sensors of two pockets in one step
            if ball == self.cue.id:
                self.scratches += 1
                self.cue.velocity = (0.0, 0.0)
                self.cue.move_to(self._free_spot())
                self.play("hurt", None, 0.5)
                continue
            self.potted.append(self.ball_names.pop(ball))
            self.world.remove_body(ball)
            self.play("coin", None, 0.7)

    def _free_spot(self):
        """Return the head spot (x, y) [px], or the nearest position above or below it that no other ball covers."""
        for shift in range(0, CLOTH.height // 2 - 8, 2):
            for y in (HEAD_SPOT[1] + shift, HEAD_SPOT[1] - shift):
                if all(
                    body.id not in self.ball_names or body == self.cue
                    for body in self.world.overlap(Circle(BALL + 1.0), (HEAD_SPOT[0], y, 0.0))
                ):
                    return HEAD_SPOT[0], y
        return HEAD_SPOT

    def _others(self):
        """Return the positions (x, y) [px] of all balls on the table except the cue ball, in the order of their
        creation.
        """
        return [self.world.body(ball).position for ball in sorted(self.ball_names) if ball != self.cue.id]

    def _stop_the_slow(self):
        bodies = self.world.bodies
        if float((bodies["vx"] ** 2 + bodies["vy"] ** 2).max()) < RESTS * RESTS:
            bodies["vx"] = bodies["vy"] = 0.0

    def draw(self, canvas, alpha):
        """Draw the table, the balls, the cue and the score. alpha: position (0..1) between the last two steps."""
        canvas.surface.fill((30, 24, 46))
        canvas.surface.blit(self.table, TABLE)
        for identity in self.ball_names:
            x, y = self.world.body(identity).position
            canvas.surface.fill((0, 62, 72), (round(x) - 3, round(y) + 4, 8, 2))  # a shadow on the cloth
        self.cast.draw(canvas, self.camera, self.world, alpha)
        if self.resting:
            self._draw_stick(canvas.surface)
        self._draw_score(canvas)

    def _draw_stick(self, surface):
        x, y = self.cue.position
        c, s = cos(self.aim), sin(self.aim)
        near = BALL + 4.0 + 26.0 * self.power
        parts = (
            (0, 110, (20, 16, 32), 5),
            (0, 109, (198, 148, 92), 3),
            (70, 109, (110, 44, 40), 3),
            (0, 4, (150, 200, 236), 3),
        )  # its outline, the shaft, the grip, the chalked tip
        for start, end, color, width in ((near + part[0], near + part[1], *part[2:]) for part in parts):
            pygame.draw.line(surface, color, (x - c * start, y - s * start), (x - c * end, y - s * end), width)

    def _draw_score(self, canvas):
        canvas.text("potted", SIDE, 26, FOG, SMALL)
        canvas.text(f"{len(self.potted)}", 474, 24, GOLD, align="right")
        for index in range(15):
            place = (SIDE + 7 + index % 5 * 16, 42 + index // 5 * 14)
            if index < len(self.potted):
                self.cast.picture(f"ball_{self.potted[index]}").draw(canvas.surface, *place, 0.0)
            else:
                pygame.draw.circle(canvas.surface, SLATE, place, 5, 1)
        canvas.text("power", SIDE, 86, FOG, SMALL)
        canvas.surface.fill((20, 16, 32), (SIDE, 94, 78, 6))
        canvas.surface.fill(GOLD, (SIDE + 1, 95, round(76 * self.power), 4))
        measured = self.budget is not None and self.budget[2] > 0
        held = self.off < 1e-9
        momentum = (("kept", GREEN) if held else ("lost", RED)) if measured else ("-", FOG)
        rows = (
            ("shots", f"{self.shots}", PAPER),
            ("scratches", f"{self.scratches}", PAPER),
            ("energy", f"{self.energy / 1e6:.2f}", PAPER),
            ("momentum", *momentum),
            ("  off by", share_text(self.off) if measured else "-", PAPER if held else RED),
        )
        for number, (word, value, color) in enumerate(rows):
            canvas.text(word, SIDE, 106 + number * 9, FOG, SMALL)
            canvas.text(value, 474, 106 + number * 9, color, SMALL, align="right")
        plate(canvas, (4, 238, 384, 26), (20, 16, 32, 160))
        words = "aim with the mouse, hold the button for power, let go to shoot"
        words = words if self.resting else "the balls are running"
        canvas.text(words, 196, 248, FOG, SMALL, align="center")

    def draw_on_frame(self, frame):
        """Draw the cue ball's path up to the first ball or cushion, and the path of the ball that it will hit."""
        if not self.resting or self.drag.holds:
            return
        lens = frame.lens(self.camera)
        x, y = self.cue.position
        c, s = cos(self.aim), sin(self.aim)
        way, struck = first_in_the_way((x, y), (c, s), self._others())
        end = (x + c * way, y + s * way)
        pygame.draw.line(frame.surface, PAPER, lens.points(x + c * BALL, y + s * BALL), lens.points(*end))
        pygame.draw.circle(frame.surface, PAPER, lens.points(*end), BALL * lens.scale, 1)
        if struck is not None:
            dx, dy = struck[0] - end[0], struck[1] - end[1]
            far = (struck[0] + dx * 3.0, struck[1] + dy * 3.0)
            pygame.draw.line(frame.surface, SKY, lens.points(*struck), lens.points(*far), max(1, frame.scale - 1))

    def check(self):
        """Return the scene's goals, a list of Goal.

        Momentum is kept to nine digits until the first cushion, energy never grows, the rack scatters, and balls are
        potted.
        """
        places = [self.world.body(identity).position for identity in self.ball_names]
        moved = self._moved()
        there = all(CLOTH.inflate(30, 30).collidepoint(place) for place in places)
        return [
            Goal(
                "momentum stays until the first cushion",
                120,
                self.compared >= 10 and self.kept < 1e-9,
                f"{error_text(self.kept)} in {self.compared} steps",
                self.compared > 0,
            ),
            Goal(
                "no collision of two adds energy",
                300,
                self.shots > 0 and self.grown < 1e-9,
                share_text(self.grown),
                self.shots > 0,
            ),
            Goal(
                "none of three adds more than a twentieth",
                300,
                self.grown_by_three < 0.05,
                share_text(self.grown_by_three),
            ),
            Goal("the break moves nearly every ball", 300, moved >= MOVED, f"{moved} of 15"),
            Goal("no ball leaves the table", 300, there),
            Goal("a pocket counts a ball", 3600, len(self.potted) > 0, f"{len(self.potted)} in {self.shots} shots"),
        ]

    def _moved(self):
        """Return the number of object balls that are potted, or further than their radius from the rack."""
        places = {ball: self.world.body(ball).position for ball in self.ball_names if ball != self.cue.id}
        return len(self.potted) + sum(
            hypot(x - self.racked[ball][0], y - self.racked[ball][1]) > BALL for ball, (x, y) in places.items()
        )

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        bounce = int(self.values["bounce"])
        number, unit = f"{100 * self.left:.0f} %", f"of the energy, {100 * (1 - self.kept):.0f} % of the momentum"
        sentence = f"Balls that bounce at {bounce} % lose energy in a break, and no momentum."
        mend = f"X: bounce at {BOUNCES[bounce < BOUNCES[1]]} %"
        good = abs(self.left - 1.0) <= ALLOWED
        headline = Headline(sentence, mend, number, unit, self.compared, ENOUGH, "steps after a shot", good)
        return headline.asks(f"Do balls that bounce at {bounce} % keep their energy in a break?")

    def finding(self):
        """Return a sentence with the greatest error of momentum and the greatest gain of energy.

        The momentum is measured until a ball meets a cushion. The gain of energy is measured in collisions of two
        balls.
        """
        if not self.compared:
            return "not yet: a ball has to be hit and to run a step before it meets a cushion"
        sentence = f"in {count_text(self.compared, 'step')} before a cushion momentum was {share_text(self.kept)} off"
        sentence = f"{sentence}; of {count_text(self.collisions, 'collision')}"
        return f"{sentence} none of two added more than {share_text(max(self.grown, 0.0))} of the energy"

    def bot(self):
        """Return the bot's input for the next step. The bot breaks, then plays the straightest and shortest shot."""
        if self.calm == CALM and self.shots:
            return InputFrame(frozenset(), best_point(self.cue.position, self._others()))
        if self.calm == CALM + 1:
            return InputFrame(frozenset(("fire",)), self.last_pointer)
        return InputFrame(frozenset(), self.last_pointer)

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: score and measurements. The worlds are hashed
        separately.
        """
        budget = self.budget or (0.0, 0.0, -1)
        return (
            self.frame,
            *self.values.values(),
            self.shots,
            self.scratches,
            self.calm,
            self.aim,
            self.power,
            self.held,
            *self.potted,
            self.kept,
            self.left,
            self.grown,
            self.grown_by_three,
            self.compared,
            *budget,
        )
