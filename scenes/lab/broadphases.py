"""Four broad phases on the same bodies: do they find the same pairs, and what does each pay for it?

What to see: in which layout which strategy is cheap. Even bodies of one size suit the hash; slow movers
along the ground suit the sweep; many still things and few movers suit the tree; brute force pays n squared.
"""

from random import Random

import numpy as np
import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import BROADPHASE_COLORS, FOG, GOLD, NIGHT, PAPER, RED, SLATE
from game.input.inputs import InputFrame
from game.scene import Goal, Scene, Slider
from physics import Circle, Effects
from scenes.lab.curves import Curves
from scenes.lab.yard import HEAD

STRATEGIES = ("brute", "sweep", "hash", "tree")
LAYOUTS = ("even", "ground", "still", "giant")
ABOUT = {
    "even": "even: all of one size, all moving",
    "ground": "clustered along the ground, moving slowly",
    "still": "few movers among many still ones",
    "giant": "one giant among many small ones",
}
VIEW_WIDTH, VIEW_HEIGHT, ZOOM = 158, 108, 0.1  # [canvas px] of each picture
WIDTH, HEIGHT = VIEW_WIDTH / ZOOM, VIEW_HEIGHT / ZOOM  # [px] of the world
CORNERS = ((4, 30), (166, 30), (4, 153), (166, 153))
RADIUS, GIANT = 7.0, 260.0
FAST, SLOW = 90.0, 20.0  # [px/s]
MOVING_SHARE = 0.05  # of the bodies in the "still" layout
PLOTS = (("candidate pairs", 30), ("tests of boxes, nodes too [log]", 103), ("microseconds [log]", 176))
PLOT_X, PLOT_WIDTH, PLOT_HEIGHT = 330, 146, 70


class Broadphases(Scene):
    """Four worlds fed the same motion, one per strategy."""

    name = "lab/broadphases"
    title = "Broad phases"
    about = "The same bodies in four worlds: what does each strategy pay to find the same pairs?"
    effects = Effects(narrowphase=False)
    pieces = ("circles", "boxes")
    features = (
        "brute force, sweep and prune, spatial hash, dynamic tree",
        "live curves of pairs, tests and time",
        "four layouts, 10 to 5,000 bodies",
    )
    sliders = (Slider("bodies", 10, 5000, 600, step=10), Slider("layout", 0, 3, 0, choices=LAYOUTS))
    actions = (("left right", "layout"), ("up down", "bodies"))
    overlays = ("structure", "pairs")
    switches_broadphase = False
    head = HEAD
    legend_at = (330, 248)

    def build(self):
        """Pictures, curves and tallies; fill() makes the four worlds."""
        self.cameras = [Camera((*corner, VIEW_WIDTH, VIEW_HEIGHT), ZOOM) for corner in CORNERS]
        self.curves = [
            Curves(title, {"all four": PAPER} if i == 0 else BROADPHASE_COLORS) for i, (title, _) in enumerate(PLOTS)
        ]
        self.compared = self.disagreements = self.most_pairs = 0
        self.tests = dict.fromkeys(STRATEGIES, 0)
        self.shown = set()
        self.fill()

    def fill(self):
        """Four new worlds with the same bodies, from a seed of their own per layout and number."""
        count, layout = int(self.values["bodies"]), LAYOUTS[int(self.values["layout"])]
        random = Random(f"{self.seed} {layout} {count}")
        positions = np.array([self._place(random, layout) for _ in range(count)])
        speed = SLOW if layout == "ground" else FAST
        velocities = np.array([(random.uniform(-speed, speed), random.uniform(-speed, speed)) for _ in range(count)])
        if layout == "ground":
            velocities[:, 1] = 0.0
        moving = count if layout != "still" else max(1, int(count * MOVING_SHARE))
        self.worlds = []
        for strategy in STRATEGIES:
            world = self.add_world(broadphase=strategy)
            if layout == "giant":
                world.add_body(Circle(GIANT), position=(WIDTH / 2, HEIGHT / 2), velocity=(SLOW, SLOW))
            world.add_bodies(Circle(RADIUS), positions[:moving], velocities[:moving])
            if moving < count:
                world.add_bodies(Circle(RADIUS), positions[moving:], kind="static")

    def _place(self, random, layout):
        x = random.uniform(RADIUS, WIDTH - RADIUS)
        if layout == "ground":
            return x, HEIGHT - RADIUS - min(abs(random.gauss(0.0, 60.0)), HEIGHT / 2)
        return x, random.uniform(RADIUS, HEIGHT - RADIUS)

    def change_slider(self, name, value):
        """Another number or layout: fill the worlds anew."""
        super().change_slider(name, value)
        self.fill()

    def update(self, inputs):
        """Keys turn the sliders; bodies bounce at the edges; all four step and are compared."""
        layout, bodies = self.values["layout"], self.values["bodies"]
        if inputs.pressed("left") or inputs.pressed("right"):
            way = 1 if inputs.pressed("right") else -1
            self.change_slider("layout", (layout + way) % len(LAYOUTS))
        if inputs.pressed("up") or inputs.pressed("down"):
            self.change_slider("bodies", bodies * 2 if inputs.pressed("up") else bodies // 2)
        for world in self.worlds:
            bounce(world)
            world.step()
        pairs = self.worlds[0].candidates
        self.compared += 1
        self.disagreements += any(not np.array_equal(pairs, world.candidates) for world in self.worlds[1:])
        self.most_pairs = max(self.most_pairs, len(pairs))
        self.shown.add(LAYOUTS[int(self.values["layout"])])
        for strategy, world in zip(STRATEGIES, self.worlds, strict=True):
            self.tests[strategy] += tests_of(world)

    def observe(self):
        """Feed the curves."""
        by_name = dict(zip(STRATEGIES, self.worlds, strict=True))
        self.curves[0].note({"all four": len(self.worlds[0].candidates)})
        self.curves[1].note({name: tests_of(w) for name, w in by_name.items()})
        self.curves[2].note({name: broad_phase_seconds(w) * 1e6 for name, w in by_name.items()})

    def views(self):
        """One picture per world."""
        return list(zip(self.worlds, self.cameras, strict=True))

    def draw(self, canvas, alpha):
        """Heads, grounds and bodies as dots; curves and structures come at window resolution."""
        canvas.surface.fill(NIGHT)
        layout = LAYOUTS[int(self.values["layout"])]
        canvas.text("BROAD PHASES", 4, 4, GOLD)
        canvas.text(f"{len(self.world.bodies):,} bodies", 474, 4, PAPER, align="right")
        canvas.text(ABOUT[layout], 96, 6, FOG, SMALL)
        for name, world, camera in zip(STRATEGIES, self.worlds, self.cameras, strict=True):
            view, color = camera.viewport, BROADPHASE_COLORS[name]
            canvas.surface.fill((16, 13, 27), view)
            pygame.draw.rect(canvas.surface, SLATE, view.inflate(2, 2), 1)
            canvas.text(name, view.x, view.y - 11, color)
            spent, tests = self.curves[2].typical(name), self.curves[1].typical(name)
            canvas.text(f"{spent:,.0f} us", view.right, view.y - 9, color, SMALL, align="right")
            canvas.text(f"{tests:,.0f} tests", view.x + 36, view.y - 9, FOG, SMALL)
            draw_dots(canvas.surface, world, camera, color)

    def draw_on_frame(self, frame):
        """The curves."""
        for curves, (_, y) in zip(self.curves, PLOTS, strict=True):
            curves.draw(frame, (PLOT_X, y, PLOT_WIDTH, PLOT_HEIGHT))

    def check(self):
        """The same pairs from all, and fewer tests than brute force from the three others."""
        cheaper = all(self.tests[name] < self.tests["brute"] for name in STRATEGIES[1:])
        return [
            Goal(
                "all four list the same pairs",
                60,
                self.compared > 0 and self.disagreements == 0,
                f"{self.disagreements} of {self.compared} steps differ",
            ),
            Goal("pairs are found", 60, self.most_pairs > 0, f"at most {self.most_pairs} in a step"),
            Goal("three strategies test fewer boxes than brute force", 60, cheaper, f"{self.tests}"),
            Goal("every layout is shown", 480, len(self.shown) == len(LAYOUTS), ", ".join(sorted(self.shown))),
        ]

    def bot(self):
        """Another layout every two seconds."""
        turn = self.frame > 0 and self.frame % 120 == 0
        return InputFrame(frozenset(("right",)) if turn else frozenset())

    def state(self):
        """What was chosen and what was found; the worlds hold the rest."""
        return (
            self.frame,
            self.values["bodies"],
            self.values["layout"],
            self.compared,
            self.disagreements,
            self.most_pairs,
        )


def bounce(world):
    """Turn velocities around at the edges of the world, all at once."""
    bodies = world.bodies
    for place, speed, low, high in (("x", "vx", 0.0, WIDTH), ("y", "vy", 0.0, HEIGHT)):
        position, velocity = bodies[place], bodies[speed]
        outwards = ((position < low) & (velocity < 0.0)) | ((position > high) & (velocity > 0.0))
        velocity[outwards] *= -1.0


def tests_of(world):
    """How often the last step's broad phase compared two boxes: of two shapes, or of a shape and a node of the tree."""
    counters = world.profile.counters
    return counters["pairs_tested"] + counters["nodes_visited"]


def broad_phase_seconds(world):
    """What the last step's broad phase took [s]."""
    return world.profile.stages["broad_phase"]


def draw_dots(surface, world, camera, color):
    """Every body as a canvas pixel, red while it is in a pair; the giant as a ring."""
    bodies, view = world.bodies, camera.viewport
    x, y = camera.to_canvas(bodies["x"], bodies["y"])
    paired = np.unique(np.concatenate((world.contacts["body_a"], world.contacts["body_b"])))
    hot = np.isin(bodies["id"], paired)
    x, y = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    seen = (x >= view.left) & (x < view.right) & (y >= view.top) & (y < view.bottom)
    pixels = pygame.surfarray.pixels2d(surface)
    for chosen, dot in ((seen & ~hot, color), (seen & hot, RED if color != RED else PAPER)):
        pixels[x[chosen], y[chosen]] = surface.map_rgb(dot)
    del pixels  # unlocks the surface
    for row in np.flatnonzero(bodies["mass"] > 100.0 * RADIUS * RADIUS * np.pi).tolist():
        surface.set_clip(view)
        pygame.draw.circle(surface, SLATE, (int(x[row]), int(y[row])), int(GIANT * camera.zoom), 1)
        surface.set_clip(None)
