"""A floor of boxes, one of tiles, one of a chain: do seams slow a sliding body?

In short: without friction a box, a disc and a capsule slide over three floors. Projection lets separate boxes slow
them; soft step does not.

What to see: a box, a disc and a capsule slide over 260 tile lengths of each floor, without friction. Tiles are merged,
and chain links store their neighbours. Separate boxes do not: if the surface under a body continues flush, a contact
with the side or corner of the next box is dropped. The speed stays the same on each floor.

Why it matters: Floors consist of many pieces, and a hero who trips over an invisible seam is a bug.

To try: turn up the speed, or drag a slider and drop it on a seam.

Source: Catto, Ghost Collisions, box2d.org, 2020.
"""

from collections import deque
from math import log10

import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GREEN, INK, NIGHT, PAPER, RED, SKY, SLATE
from game.drawing.headline import Headline
from game.drawing.number_text import plain_name, share_text
from game.drawing.rotated import Cast
from game.drawing.sprites import load_atlas, load_backdrop
from game.input.inputs import InputFrame
from game.measurement_requests import MeasuredRun, RunRequest
from game.scene import STANDS, Goal, Scene, Slider
from physics import Capsule, Chain, Circle, Effects, Filter, Polygon, TileGrid
from scenes.lab.costs import cost_text
from scenes.lab.pieces import piece
from scenes.lab.yard import HEAD

WAYS = ("projection", "soft_step")  # solvers
FLOORS = ("boxes", "tiles", "chain")
TITLES = {"boxes": "separate boxes", "tiles": "one grid of tiles", "chain": "one chain"}
COLORS = {"boxes": RED, "tiles": SKY, "chain": GREEN}
TILE, LENGTH = 16, 260  # [px] of a tile; tiles of a floor
FLOOR_Y = 54.0  # [px] the floor's surface in a view
KINDS = {
    "box": (Polygon.box(14, 14), "wood", 7.0),
    "disc": (Circle(7.0), "gold", 7.0),
    "capsule": (Capsule((-7, 0), (7, 0), 5.0), "teal", 5.0),
}  # shape, colours, height of the middle
START_X = {"box": 210.0, "disc": 130.0, "capsule": 50.0}  # [px] apart, so that they do not hide each other
GROUND = Filter(membership=1)
VIEWS = tuple((4, 32 + 80 * lane, 308, 70) for lane in range(len(FLOORS)))
LOST = 40.0  # [px] a slider this far from its place is put back
WANTED = 200  # tiles before the floors are judged
MANY = 60  # tiles before the loss is shown: it adds up
KEEPS = {"boxes": 1e-3, "tiles": 1e-9, "chain": 1e-9}  # greatest loss of a floor, as a share of the speed
HISTORY = 200  # steps in the curves
LEAST = 1e-16  # smaller errors are drawn at the bottom
PLOTS = (("speed error [log]", (318, 24, 158, 104)), ("height off the floor [px]", (318, 134, 158, 80)))
HEIGHT_TOP = 4.0  # [px] top of the lower curve


class GhostBumps(Scene):
    """Scene with three worlds: a floor of boxes, of tiles and of a chain. Three bodies slide over each floor."""

    name = "lab/ghost_bumps"
    title = "Ghost bumps"
    question = STANDS
    about = "Box, disc and capsule slide over boxes, tiles and a chain, and feel no seam."
    solvers = WAYS
    keeps = {"solver": "projection is the one that fails here, beside the solver that a World has by itself"}
    effects = Effects(response=True, gravity=True, rotation=True, stacking=True)
    pieces = ("boxes", "circles", "capsules", "tiles", "chains")
    features = ("tiles merged into runs", "chains with ghost neighbours", "speed and height as live curves")
    sliders = (Slider("speed", 60, 600, 360, "px/s", step=20), Slider("solver", 0, 1, 0, choices=WAYS))
    actions = (("X", "solver"), ("left right", "speed"))
    draggable = True
    filter_names = {1: "floor"} | {2 << number: kind for number, kind in enumerate(KINDS)}
    head = HEAD
    legend_at = (6, 34)

    def build(self):
        """Build three floors, and three sliding bodies on each."""
        if self.solver in WAYS:  # named on the command line, or chosen before a restart
            self.values["solver"] = WAYS.index(self.solver)
        self.solver = WAYS[int(self.values["solver"])]
        for floor in FLOORS:
            lay_floor(self.add_world(), floor)
        self.cameras = [Camera(view) for view in VIEWS]
        self.sky = load_backdrop("sky_dusk")
        self.mountains = load_backdrop("mountains_mid")
        self.tiles = load_atlas("tiles")
        pictures = {kind: piece(shape, ramp) for kind, (shape, ramp, _) in KINDS.items()}
        self.casts = [Cast(pictures) for _ in FLOORS]
        self.curves = {floor: deque(maxlen=HISTORY) for floor in FLOORS}  # (speed error, height), for drawing only
        self.sliding = [{} for _ in FLOORS]
        for index, world in enumerate(self.worlds):
            for number, (kind, (shape, _, _)) in enumerate(KINDS.items()):
                body = world.add_body(shape, filter=Filter(2 << number, 1), gravity_scale=1.0)
                self.casts[index].add(body, kind)
                self.sliding[index][kind] = body
        self.launch()

    def launch(self):
        """Move all sliding bodies to their starting positions, and clear the counts."""
        keys = [(floor, kind) for floor in FLOORS for kind in KINDS]
        self.slowed = dict.fromkeys(keys, 0.0)  # largest speed error, as a share
        self.raised = dict.fromkeys(keys, 0.0)  # largest height off the floor [px]
        self.aloft = dict.fromkeys(keys, 0)  # steps without a contact
        self.set_back = dict.fromkeys(keys, 0)
        self.free = dict.fromkeys(keys, False)  # dragged: no longer judged in this run
        self.run = 0
        self.nominal = 0.0  # [px] distance that a slider should have moved
        for index in range(len(FLOORS)):
            for kind in KINDS:
                self._put(index, kind)
        self._follow(jump=True)

    def _put(self, index, kind):
        body = self.sliding[index][kind]
        body.move_to((START_X[kind] + self.nominal, FLOOR_Y - KINDS[kind][2]), 0.0)
        body.velocity = (float(self.values["speed"]), 0.0)
        body.angular_velocity = 0.0

    def change_slider(self, name, value):
        """Set the slider `name` to `value`, and start the run again after a change."""
        before = self.values[name]
        super().change_slider(name, value)
        if self.values[name] == before:
            return
        if name == "solver":
            self.solver = WAYS[int(self.values["solver"])]
            for world in self.worlds:
                world.solver = self.solver
        self.launch()

    def update(self, inputs):
        """Process keys, step each world, and measure speeds and heights. At the end of a floor, start a new run."""
        turn = inputs.pressed("right") - inputs.pressed("left")
        if turn:
            self.change_slider("speed", self.values["speed"] + 20 * turn)
        if inputs.pressed("bomb"):
            self.change_slider("solver", 1 - self.values["solver"])
        if START_X["box"] + self.nominal > (LENGTH - 4) * TILE:
            done = self.run, self.slowed, self.raised, self.aloft, self.set_back
            self.launch()
            self.run, self.slowed, self.raised, self.aloft, self.set_back = done
        for world in self.worlds:
            world.step()
        self.nominal += self.values["speed"] / 60
        self.run = max(self.run, int(self.nominal // TILE))
        for index in range(len(FLOORS)):
            self._judge(index)
        self._follow()

    def _judge(self, index):
        floor, world = FLOORS[index], self.worlds[index]
        speed = float(self.values["speed"])
        error_now = height_now = 0.0
        contacts = world.contacts
        near = contacts["separation"] <= world.tolerances.slop
        touching = set(contacts["body_a"][near].tolist()) | set(contacts["body_b"][near].tolist())
        for kind, (_, _, half) in KINDS.items():
            body, key = self.sliding[index][kind], (floor, kind)
            hold = self.drag.hold
            if hold is not None and hold.body.id == body.id and hold.world is world:
                self.free[key] = True
            x, y = body.position
            error = abs(body.velocity[0] - speed) / speed
            height = FLOOR_Y - half - y
            if not self.free[key]:
                error_now, height_now = max(error_now, error), max(height_now, height)
                self.slowed[key] = max(self.slowed[key], error)
                self.raised[key] = max(self.raised[key], height)
                self.aloft[key] += body.id not in touching
            if not self.drag.holds and abs(x - START_X[kind] - self.nominal) + abs(y - FLOOR_Y + half) > LOST:
                self.set_back[key] += 1
                self._put(index, kind)
        self.curves[floor].append((error_now, height_now))

    def measured(self):
        """Return a RunRequest: the runs that the measuring process times during the game, one for each floor.

        Return None if the bodies have less than one more second of floor ahead, or have not passed a tile yet.
        """
        ahead = (LENGTH - 4) * TILE - START_X["box"] - self.nominal
        if self.run == 0 or ahead < self.values["speed"]:
            return None
        worlds = dict(zip(FLOORS, self.worlds, strict=True))
        return RunRequest(
            [(*self.chosen, floor) for floor in FLOORS],
            lambda name: MeasuredRun([worlds[name[-1]].snapshot()], self.broadphase),
        )

    def _follow(self, jump=False):
        for camera in self.cameras:
            x = START_X["disc"] + self.nominal - camera.viewport.width / 2 + 24
            camera.x, camera.y = x, 0.0
            if jump:
                camera.place(x, 0.0)

    def views(self):
        """Return a list of (world, camera), one for the picture of each floor."""
        return list(zip(self.worlds, self.cameras, strict=True))

    def draw(self, canvas, alpha):
        """Draw the floors in three strips. Write the greatest loss of speed of each sliding body above its floor.

        alpha: position (0..1) between the last two steps.
        """
        canvas.surface.fill(NIGHT)
        for index, floor in enumerate(FLOORS):
            camera = self.cameras[index]
            view = camera.viewport
            self._draw_strip(canvas, floor, camera, alpha)
            self.casts[index].draw(canvas, camera, self.worlds[index], alpha)
            pygame.draw.rect(canvas.surface, SLATE, view, 1)
            canvas.text(TITLES[floor], view.x + 2, view.y - 8, COLORS[floor], SMALL)
            words = "worst   " + "   ".join(f"{kind} {share_text(self.slowed[floor, kind])}" for kind in KINDS)
            canvas.text(words, view.right - 2, view.y - 8, PAPER, SMALL, align="right")
        for number, floor in enumerate(FLOORS):
            y = 222 + number * 14
            canvas.surface.fill(COLORS[floor], (320, y, 3, 5))
            stops = sum(self.set_back[floor, kind] for kind in KINDS)
            canvas.text(TITLES[floor], 326, y, COLORS[floor], SMALL)
            canvas.text(f"{stops} set back" if stops else "never set back", 474, y, FOG, SMALL, align="right")
            canvas.text("a step", 326, y + 7, FOG, SMALL)
            canvas.text(cost_text(self, (*self.chosen, floor)), 474, y + 7, PAPER, SMALL, align="right")

    def _draw_strip(self, canvas, floor, camera, alpha):
        view, surface = camera.viewport, canvas.surface
        left, _ = camera.view(alpha)
        surface.set_clip(view)
        surface.blit(self.sky, view, (60, 70, *view.size))
        width = self.mountains.get_width()
        x = view.x - round(left * 0.2) % width
        while x < view.right:
            surface.blit(self.mountains, (x, view.y + 6))
            x += width
        top = view.y + round(FLOOR_Y)
        first = int(left // TILE)
        for column in range(max(first, 0), min(first + view.width // TILE + 2, LENGTH)):
            place = (column * TILE - round(left) + view.x, top)
            if floor == "boxes":
                surface.blit(self.tiles["stone_0"], place)
            else:
                surface.blit(self.tiles["ground_68" if floor == "tiles" else "ground_deep_0"], place)
        if floor == "chain":
            surface.fill(INK, (view.x, top, view.width, 2))
            surface.fill(COLORS["chain"], (view.x, top, view.width, 1))
            for column in range(first, first + view.width // TILE + 2):
                x = column * TILE - round(left) + view.x
                pygame.draw.circle(surface, INK, (x, top), 2)
                surface.set_at((x, top), PAPER)
        surface.set_clip(None)

    def draw_on_frame(self, frame):
        """Draw two plots at window resolution: the error of speed, and the height above the floor, over time."""
        for number, (title, canvas_rect) in enumerate(PLOTS):
            rect = frame.from_canvas(canvas_rect)
            scale = frame.plot_scale
            frame.surface.fill(INK, rect)
            pygame.draw.rect(frame.surface, SLATE, rect, 1)
            frame.text(title, rect.x + 3 * scale, rect.y + 3 * scale, FOG, SMALL, scale)
            plot = pygame.Rect(rect.x + 2, rect.y + 12 * scale, rect.width - 4, rect.height - 15 * scale)
            marks = ((1e-4, "0.01 %"), (1e-8, ""), (1e-12, "")) if number == 0 else ((2.0, "2"), (4.0, "4"))
            for value, _ in marks:
                y = plot.bottom - plot.height * share(number, value)
                pygame.draw.line(frame.surface, (52, 46, 76), (plot.left, y), (plot.right, y))
            for floor in FLOORS:
                values = [each[number] for each in self.curves[floor]]
                if len(values) > 1:
                    step = plot.width / (HISTORY - 1)
                    x = plot.right - step * (len(values) - 1)
                    points = [
                        (x + i * step, plot.bottom - 1 - (plot.height - 2) * share(number, value))
                        for i, value in enumerate(values)
                    ]
                    pygame.draw.lines(frame.surface, COLORS[floor], False, points, max(1, frame.scale - 1))
            for value, text in marks:  # over the curves
                y = plot.bottom - plot.height * share(number, value)
                if text:
                    frame.text_if_free(text, plot.left + 2 * scale, y + scale, FOG, SMALL, scale, "left", True)
            frame.fix(rect)

    def check(self):
        """Return the scene's goals, a list of Goal. No body loses speed or leaves a floor at its seams."""
        goals = []
        for floor in FLOORS:
            worst = max(self.slowed[floor, kind] for kind in KINDS)
            aloft, raised = (max(tally[floor, kind] for kind in KINDS) for tally in (self.aloft, self.raised))
            goals += [
                Goal(
                    f"no speed is lost on the {floor}",
                    590,
                    self.run >= WANTED and worst <= KEEPS[floor],
                    f"{share_text(worst)} after {self.run} tiles",
                ),
                Goal(
                    f"nothing leaves the {floor}",
                    590,
                    self.run >= WANTED and aloft == 0 and raised < 0.1,
                    f"{aloft} steps aloft, {raised:.3f} px high",
                ),
            ]
        return goals

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        worst = max(self.slowed["boxes", kind] for kind in KINDS)
        good = worst <= KEEPS["boxes"]
        over = f"at {self.values['speed']} px/s over {self.run} separate boxes"
        name = plain_name(self.world.solver)
        number, unit = f"{100 * worst:.3f} %", "of the speed lost at seams"
        sentence = f"{name[:1].upper()}{name[1:]}, {over}: seams take speed."
        headline = Headline(sentence, "X: soft step", number, unit, self.run, MANY, "boxes", good)
        return headline.asks(f"{name[:1].upper()}{name[1:]}, {over}: do seams take speed?")

    def finding(self):
        """Return a sentence with the greatest relative loss of speed on each floor, and the time of a step."""
        if self.run == 0:
            return "not yet: the sliders have to come over some tiles"
        parts = (
            f"{TITLES[floor]} {share_text(max(self.slowed[floor, kind] for kind in KINDS))}"
            f" ({cost_text(self, (*self.chosen, floor))})"
            for floor in FLOORS
        )
        return f"of the speed was lost after {self.run} tiles: {', '.join(parts)}"

    def bot(self):
        """Return the bot's input for the next step. The bot chooses the solver of a World, then only watches."""
        return InputFrame(changes=(("slider:solver", WAYS.index("soft_step")),) if self.frame == 0 else ())

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the counts. The worlds are hashed separately."""
        tallies = (self.slowed, self.raised, self.aloft, self.set_back)
        return (
            self.frame,
            *self.values.values(),
            self.run,
            self.nominal,
            *(v for tally in tallies for v in tally.values()),
        )


def lay_floor(world, floor):
    """Add a static floor to a world, with its surface at y = FLOOR_Y. floor: its kind, one of FLOORS."""
    if floor == "boxes":
        middles = [((column + 0.5) * TILE, FLOOR_Y + TILE / 2) for column in range(LENGTH)]
        world.add_bodies(Polygon.box(TILE, TILE), middles, kind="static", filter=GROUND)
    elif floor == "tiles":
        world.add_body(TileGrid([[True] * LENGTH], TILE), position=(0.0, FLOOR_Y), kind="static", filter=GROUND)
    else:
        points = tuple((column * TILE, 0.0) for column in range(LENGTH + 1))
        world.add_body(Chain(points), position=(0.0, FLOOR_Y), kind="static", filter=GROUND)


def share(number, value):
    """Return the height at which plot `number` draws a value: from 0 (bottom) to 1 (top).

    Plot 0 (error of speed) has a logarithmic scale, plot 1 (height) a linear one.
    """
    if number == 1:
        return min(max(value / HEIGHT_TOP, 0.0), 1.0)
    return (log10(min(max(value, LEAST), 1.0)) - log10(LEAST)) / -log10(LEAST)
