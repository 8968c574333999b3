"""Planks that are open from below, and a lift: do crates and the hero pass and land alike?

In short: springs throw crates up through planks, and they come to rest on top. The lift carries a crate and a walker.

What to see: springs throw crates, balls and nuts up through the planks, and they come to rest on top. The hero jumps
through the same planks and stands on them. The lift carries a crate, which the solver moves, and a walker, which walks
in whole pixels: neither slips.

Why it matters: Most platformers have planks to jump up through; bodies and hero must use them alike.

To try: press down and jump on a plank, and be under the spring when a crate comes.

Source: Thorson, Celeste and TowerFall Physics, 2018.
"""

from math import cos, hypot, pi, sin

import pygame

from game.drawing.backdrop import Backdrop
from game.drawing.canvas import SMALL, whole
from game.drawing.colors import FOG, GREEN, INK, NIGHT, PAPER, RED
from game.drawing.headline import Headline
from game.drawing.rotated import Cast
from game.drawing.sprites import load_atlas
from game.input.inputs import InputFrame
from game.scene import FAIR, Goal, Scene, Slider
from physics import Character, Circle, Effects, Material, Polygon, TileGrid
from scenes.lab.pieces import piece
from scenes.lab.yard import HEAD

TILE, COLUMNS, ROWS = 16, 30, 17
FLOOR = 15  # row of the floor
PLANKS = {  # name: (row, first column, last column)
    "low": (11, 1, 5),
    "middle": (8, 3, 8),
    "high": (5, 1, 7),
    "tower": (11, 11, 18),
    "roof": (7, 12, 17),
}
SPRINGS = (192.0, 240.0, 288.0)  # [px] where bodies are thrown up
KINDS = {
    "crate": (Polygon.box(16, 16), None),
    "ball": (Circle(7.0), "gold"),
    "nut": (Polygon(tuple((8.5 * cos(k * pi / 3), 8.5 * sin(k * pi / 3)) for k in range(6))), "violet"),
}
BRAKED = Material(rolling_resistance=0.1)  # lets balls come to rest on a plank
THROWS = (238.0, 306.0)  # [px/s] up to the first plank, and up to the roof
MOST = 9  # bodies at once; the oldest leaves
REACH = 12.0  # [px] no body extends further from its centre: nearer to a plank's end it may tip over it
REST_SPEED, REST_STEPS = 8.0, 20  # slower than this for so many steps counts as landed
HERO_BOX = (10, 20)  # [px]
WALKER_BOX = (16, 13)
RUN, JUMP, HERO_GRAVITY, FALL = 110.0, 380.0, 900.0, 360.0  # [px/s], [px/s2]
LIFT_AT, LIFT_SIZE = (396.0, 178.0), (56, 16)
LIFT_WAY = (34.0, 34.0)  # [px] amplitude along x and y
RIDERS = (-15.0, 15.0)  # [px] crate and walker from the lift's middle
BOARD = 11  # [px] height of the line of counts below the title line
FLIGHT = 40  # steps after which a thrown body has come through a plank, or was stopped by it
ENOUGH = 4  # thrown bodies, one in half a second
SETTLED = 60  # steps until riders are measured
DUST = ((240, 226, 210), (180, 160, 150), (110, 96, 110))
BOT = (
    (20, 44, "jump"),
    (60, 84, "jump right"),
    (84, 110, "right"),
    (140, 150, "jump left"),
    (150, 172, "left jump"),
    (215, 218, "down jump"),
    (260, 262, "down jump"),
    (300, 330, "right"),
    (330, 352, "jump left"),
)


class OneWay(Scene):
    """Scene with one world of tiles: thrown bodies, a hero, and a lift with two riders."""

    name = "lab/one_way"
    title = "One-way platforms"
    question = FAIR
    about = "Crates and the hero pass the same planks from below, land on them, and ride the same lift."
    effects = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True, one_way=True)
    pieces = ("tiles", "boxes", "circles", "queries", "characters")
    features = (
        "one-way tiles for solver bodies and characters",
        "a kinematic lift carries both",
        "the hero pushes crates and stands on them",
    )
    sliders = (
        Slider("throw every", 20, 120, 35, "steps", step=5),
        Slider("lift", 0.0, 2.0, 1.0, step=0.25),
        Slider("planks", 0, 1, 0, choices=("solid", "one way")),
    )
    actions = (("X", "planks"), ("left right", "run"), ("Space", "jump"), ("down+Space", "drop"))
    draggable = True
    head = HEAD
    legend_at = (8, 28)

    def build(self):
        """Build the level, the lift, its riders and the hero. Bodies are thrown over time by update()."""
        self.add_world()
        self.backdrop = Backdrop()
        self.tiles, self.things, self.heroes = load_atlas("tiles"), load_atlas("things"), load_atlas("hero")
        pictures = {name: piece(shape, ramp) for name, (shape, ramp) in KINDS.items() if ramp}
        pictures["crate"] = self.things["crate"]
        self.cast = Cast(pictures)
        self.ground = self.world.add_body(self._level(), kind="static")
        self.hero = Character(self.world, Polygon.box(*HERO_BOX), (48.0, FLOOR * TILE - HERO_BOX[1] / 2), user="hero")
        self.vy, self.grounded, self.facing, self.run = 0.0, True, 1, 0.0
        self.clock = 0.0  # [steps] of the lift
        self.lift = self.world.add_body(Polygon.box(*LIFT_SIZE), position=lift_at(0.0), kind="kinematic")
        x, y = lift_at(0.0)
        top = y - LIFT_SIZE[1] / 2
        self.rider = self.world.add_body(KINDS["crate"][0], position=(x + RIDERS[0], top - 8.0))
        self.cast.add(self.rider, "crate")
        self.walker = Character(
            self.world, Polygon.box(*WALKER_BOX), (x + RIDERS[1], top - WALKER_BOX[1] / 2), user="walker"
        )
        self.walker_vy = 0.0
        self.thrown = {}  # body id -> [was below, steps at rest, planks landed on]
        self.flights = {}  # body id -> [steps since it was thrown, whether it came through a plank]
        self.through = self.flown = 0  # bodies thrown longer than FLIGHT steps ago that came through; all of them
        self.throws = 0
        self.passed = {"body": 0, "hero": 0}
        self.landed = {"body": 0, "hero": 0}
        self.leaked = 0  # bodies that came down through a plank
        self.hero_through = None  # the plank that he came through without landing on it yet
        self.offsets = None  # places of the riders after settling
        self.slip = {"crate": 0.0, "walker": 0.0}  # [px] greatest value, while no rider is dragged
        self.aside = {"crate": 0.0, "walker": 0.0}  # [px] now
        self.carried = 0.0  # [px] path of the lift since then
        self.disturbed = False  # a rider was dragged

    def change_slider(self, name, value):
        """Set the slider `name` to `value`.

        After a change of the lift, the slip of its riders is measured from their current positions on it. A change of
        the planks replaces the tiles, and removes the thrown bodies.
        """
        super().change_slider(name, value)
        if name == "lift":
            self.offsets = None
        if name == "planks":
            self.world.remove_body(self.ground)
            self.ground = self.world.add_body(self._level(), kind="static")
            for identity in list(self.thrown):
                self._vanish(identity)
            self.flights.clear()
            self.through = self.flown = 0

    def _level(self):
        return level(self.world.effects, bool(self.values["planks"]))

    def update(self, inputs):
        """Move the lift and the hero, throw bodies, make one step, and count passes through planks and landings."""
        if inputs.pressed("bomb"):
            self.change_slider("planks", 1 - self.values["planks"])
        if self.frame % max(1, int(self.values["throw every"])) == 10:
            self._throw()
        self._aim_lift()
        before = self._hero_bottom()
        self._move_hero(inputs)
        self._move_walker()
        self.world.step()
        self._watch_bodies()
        self._judge_flights()
        self._watch_hero(before)
        self._watch_riders()

    def _throw(self):
        kind = tuple(KINDS)[self.throws % len(KINDS)]
        x = SPRINGS[self.random.randrange(len(SPRINGS))]
        speed = THROWS[self.random.randrange(2)] + self.random.uniform(0.0, 14.0)
        self.throws += 1
        found = self.world.query_aabb((x - 12.0, FLOOR * TILE - 28.0), (x + 12.0, FLOOR * TILE - 2.0))
        if any(body.kind == "dynamic" for body in found):
            return  # the spring is occupied
        body = self.world.add_body(
            KINDS[kind][0],
            position=(x, FLOOR * TILE - 14.0),
            velocity=(self.random.uniform(-9.0, 9.0), -speed),
            angular_velocity=self.random.uniform(-1.5, 1.5),
            material=BRAKED,
        )
        self.cast.add(body, kind)
        self.flights[body.id] = [0, False]
        self.thrown[body.id] = [dict.fromkeys(PLANKS, True), 0, set()]
        self.play("spring", x, 0.25)
        self.particles.burst(x, FLOOR * TILE - 4, 8, DUST, speed=(20, 80), life=(0.15, 0.4), angle=-pi / 2, spread=1.6)
        if len(self.thrown) > MOST:
            self._vanish(next(iter(self.thrown)))

    def _vanish(self, identity):
        body = self.world.body(identity)
        self.particles.burst(*body.center, 12, DUST, speed=(10, 60), life=(0.2, 0.5))
        self.world.remove_body(body)
        del self.thrown[identity]
        self.flights.pop(identity, None)

    def _aim_lift(self):
        """Set the velocity with which the lift reaches its next position in this step."""
        x, y = self.lift.position
        self.clock += float(self.values["lift"])
        next_x, next_y = lift_at(self.clock)
        self.lift.velocity = ((next_x - x) * 60, (next_y - y) * 60)

    def _move_hero(self, inputs):
        way = inputs.held("right") - inputs.held("left")
        drops = inputs.held("down") and inputs.pressed("jump")
        if inputs.pressed("jump") and self.grounded and not drops:
            self.vy = -JUMP
            self.play("jump", self.hero.position[0], 0.4)
        if not inputs.held("jump") and self.vy < -0.4 * JUMP:
            self.vy = -0.4 * JUMP
        self.vy = min(self.vy + HERO_GRAVITY / 60, FALL)
        if drops:
            self.vy = 60.0
        moved = self.hero.move(way * RUN / 60, self.vy / 60, drop=drops)
        self.facing = way or self.facing
        self.run += abs(moved.x)
        if moved.grounded or (self.vy < 0.0 and moved.y == 0 and abs(self.vy) > 60.0):
            self.vy = 0.0
        self.grounded = moved.grounded

    def _move_walker(self):
        self.walker_vy = min(self.walker_vy + HERO_GRAVITY / 60, FALL)
        if self.walker.move(0.0, self.walker_vy / 60).grounded:
            self.walker_vy = 0.0

    def _hero_bottom(self):
        return self.hero.position[1] + HERO_BOX[1] / 2

    def _watch_bodies(self):
        shapes = self.world.shapes
        bottoms = dict(zip(shapes["body"].tolist(), shapes["max_y"].tolist(), strict=True))
        for identity, seen in list(self.thrown.items()):
            body = self.world.body(identity)
            x, y = body.center
            if not (0.0 < x < COLUMNS * TILE and y < ROWS * TILE):
                self._vanish(identity)
                continue
            bottom, (vx, vy) = bottoms[identity], body.velocity
            below, slow, landed = seen
            seen[1] = slow + 1 if hypot(vx, vy) < REST_SPEED else 0
            for name, (row, first, last) in PLANKS.items():
                top, inside = row * TILE, first * TILE < x < (last + 1) * TILE
                if below[name] and bottom < top - 0.5:
                    below[name] = False
                    self.passed["body"] += inside and vy < 0.0
                    if inside and identity in self.flights:
                        self.flights[identity][1] = True
                elif bottom > top + TILE:
                    falls = first * TILE + REACH < x < (last + 1) * TILE - REACH and self.drag.held != identity
                    self.leaked += falls and not below[name]
                    below[name] = True
                if inside and abs(bottom - top) < 1.0 and seen[1] == REST_STEPS and name not in landed:
                    landed.add(name)
                    self.landed["body"] += 1

    def _judge_flights(self):
        """Count the bodies that were thrown FLIGHT steps ago, and those of them that came through a plank."""
        for identity, flight in list(self.flights.items()):
            flight[0] += 1
            if flight[0] == FLIGHT:
                del self.flights[identity]
                self.flown += 1
                self.through += flight[1]

    def _watch_hero(self, before):
        bottom, x = self._hero_bottom(), self.hero.position[0]
        for name, (row, first, last) in PLANKS.items():
            top, inside = row * TILE, first * TILE < x < (last + 1) * TILE
            if inside and before > top >= bottom and self.vy < 0.0:
                self.passed["hero"] += 1
                self.hero_through = name
            if inside and self.grounded and bottom == top and self.hero_through == name:
                self.landed["hero"] += 1
                self.hero_through = None
                self.play("land", x, 0.4)
                self.particles.burst(x, bottom, 6, DUST, speed=(10, 50), life=(0.15, 0.35), angle=-pi / 2, spread=2.6)

    def _watch_riders(self):
        if self.frame < SETTLED or self.values["lift"] == 0.0:
            return
        x, y = self.lift.position
        crate, walker = self.rider.position, self.walker.position
        now = (crate[0] - x, crate[1] - y, walker[0] - x, walker[1] - y)
        if self.offsets is None:
            self.offsets = now
        cx, cy, wx, wy = (a - b for a, b in zip(now, self.offsets, strict=True))
        self.aside = {"crate": hypot(cx, cy), "walker": max(abs(wx), abs(wy))}
        self.disturbed |= self.drag.held == self.rider.id
        if not self.disturbed:
            self.carried += hypot(*self.lift.velocity) / 60
            self.slip = {name: max(self.slip[name], self.aside[name]) for name in self.slip}

    def draw(self, canvas, alpha):
        """Draw the sky, the level, the lift, the bodies, the hero, the walker and the counts.

        alpha: position (0..1) between the last two steps.
        """
        self.backdrop.draw(canvas, 40.0, dim=14)
        surface = canvas.surface
        for column in range(COLUMNS):
            for row in (FLOOR, FLOOR + 1):
                surface.blit(self.tiles["ground_124" if row == FLOOR else "ground_255"], (column * TILE, row * TILE))
        for row, first, last in PLANKS.values():
            for column in range(first, last + 1):
                name = "left" if column == first else "right" if column == last else "middle"
                surface.blit(self.tiles[f"plank_{name}"], (column * TILE, row * TILE))
        for x in SPRINGS:
            surface.blit(self.things["spring_0"], (round(x) - 8, FLOOR * TILE - 16))
        self._draw_lift(canvas, alpha)
        self.cast.draw(canvas, self.camera, self.world, alpha)
        self._draw_characters(canvas, alpha)
        self.particles.draw(canvas, self.camera, alpha)
        self._draw_board(canvas)

    def _draw_lift(self, canvas, alpha):
        row = self.world.bodies[self.world.rows([self.lift.id])[0]]
        x = row["previous_x"] + (row["x"] - row["previous_x"]) * alpha
        y = row["previous_y"] + (row["y"] - row["previous_y"]) * alpha
        left, top = whole(x - LIFT_SIZE[0] / 2), whole(y - LIFT_SIZE[1] / 2)
        image = self.things["platform"]
        canvas.surface.blit(image, (left, top), (0, 0, 28, 16))
        canvas.surface.blit(image, (left + LIFT_SIZE[0] - 28, top), (image.get_width() - 28, 0, 28, 16))

    def _draw_characters(self, canvas, alpha):
        px, py = self.hero.previous
        x, y = self.hero.position
        x, bottom = px + (x - px) * alpha, py + (y - py) * alpha + HERO_BOX[1] / 2
        if not self.grounded:
            name = "jump_0" if self.vy < -60.0 else "fall_0"
        else:
            run = self.heroes.animation("run" if self.run > 0.0 and self.facing and self._runs() else "idle")
            name = run.names[int(self.run / 13.0 if self._runs() else self.frame / 10) % len(run.names)]
        image = self.heroes[name]
        image = image if self.facing > 0 else pygame.transform.flip(image, True, False)
        canvas.surface.blit(image, (whole(x) - image.get_width() // 2, whole(bottom) - image.get_height()))
        px, py = self.walker.previous
        x, y = self.walker.position
        image = self.things.animation("walker").images[0]
        canvas.surface.blit(
            image, (whole(x) - image.get_width() // 2, whole(y + WALKER_BOX[1] / 2) - image.get_height())
        )

    def _runs(self):
        return abs(self.hero.position[0] - self.hero.previous[0]) > 0.4

    def _draw_board(self, canvas):
        canvas.surface.fill(NIGHT, (0, HEAD, 480, BOARD))
        canvas.surface.fill(INK, (0, HEAD + BOARD, 480, 1))
        x = 474
        aside = max(self.aside.values())
        for text, color in (
            (f"riders {aside:.1f} px aside", GREEN if aside < 2.0 else RED),
            (f"hero {self.passed['hero']} up {self.landed['hero']} landed", PAPER),
            (f"bodies {self.passed['body']} up {self.landed['body']} landed", FOG),
        ):
            x = canvas.text(text, x, HEAD + 3, color, SMALL, align="right").left - 12

    def check(self):
        """Return the scene's goals, a list of Goal.

        Bodies and hero both pass through planks from below, both land on planks, and both stay on the lift.
        """
        return [
            Goal("bodies come through from below", 600, self.passed["body"] >= 6, f"{self.passed['body']} times"),
            Goal("none falls back through a plank", 600, not self.leaked, f"{self.leaked} of {self.passed['body']}"),
            Goal("bodies land on planks", 600, self.landed["body"] >= 3, f"{self.landed['body']} times"),
            Goal("the hero comes through from below", 240, self.passed["hero"] >= 3, f"{self.passed['hero']} times"),
            Goal("the hero lands on planks", 240, self.landed["hero"] >= 3, f"{self.landed['hero']} times"),
            Goal(
                "the lift carries crate and walker",
                400,
                self.carried > 200.0 and max(self.slip.values()) < 2.0,
                f"{self.slip['crate']:.2f} px and {self.slip['walker']:.2f} px in {self.carried:.0f} px",
            ),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        planks = "One-way" if self.values["planks"] else "Solid"
        number, unit = f"{self.through} of {self.flown}", "thrown bodies came up through a plank"
        sentence = f"{planks} planks stop bodies that are thrown up from below."
        good = 2 * self.through > self.flown
        headline = Headline(sentence, "X: one-way planks", number, unit, self.flown, ENOUGH, "throws", good)
        return headline.asks(f"{planks} planks: do bodies that are thrown up come through?")

    def finding(self):
        """Return a sentence with the passes and landings of bodies and hero, and the distance that the lift's riders
        slipped.
        """
        if not all((*self.passed.values(), *self.landed.values())):
            return "not yet: a body and the hero have to come up through a plank, and to land on one"
        body, hero = (f"{self.passed[who]} times up, {self.landed[who]} landings" for who in ("body", "hero"))
        sentence = f"through the same planks: bodies {body}; the hero {hero}"
        slid = max(self.slip.values())
        return (
            f"{sentence}; in {self.carried:,.0f} px of lift its riders slid {slid:.2f} px" if self.carried else sentence
        )

    def bot(self):
        """Return the bot's input for the next step.

        The bot jumps up the left planks, drops through two, and jumps up again.
        """
        frame = self.frame % 400
        held = {action for start, end, actions in BOT if start <= frame < end for action in actions.split()}
        changes = (("slider:planks", 1),) if self.frame == 0 else ()
        return InputFrame(frozenset(held), changes=changes)

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the hero and the counts. The worlds are hashed
        separately.
        """
        return (
            self.frame,
            *self.values.values(),
            self.vy,
            self.grounded,
            self.walker_vy,
            self.clock,
            self.throws,
            *self.passed.values(),
            *self.landed.values(),
            self.leaked,
            self.through,
            self.flown,
            *self.slip.values(),
            self.carried,
        )


def level(effects, opens):
    """Return the TileGrid with the floor and the walls beside it.

    effects: the world's Effects; the grid has planks that open from below only if the effect `one_way` is on. opens:
    False for planks of solid tiles.
    """
    solid = [[row >= FLOOR for _ in range(COLUMNS)] for row in range(ROWS)]
    one_way = [[False] * COLUMNS for _ in range(ROWS)]
    for row, first, last in PLANKS.values() if effects.one_way or not opens else ():
        (one_way if opens else solid)[row][first : last + 1] = [True] * (last + 1 - first)
    return TileGrid(solid, TILE, one_way)


def lift_at(clock):
    """Return the centre (x, y) [px] of the lift at time `clock` [steps] of its path, which repeats after 240 steps."""
    turn = 2.0 * pi * clock / 240.0
    return LIFT_AT[0] + LIFT_WAY[0] * cos(turn), LIFT_AT[1] + LIFT_WAY[1] * sin(2.0 * turn + 0.5 * pi) * 0.5
