"""Four broad phases on the same bodies: do they find the same pairs, and what does each cost?

In short: all four report the same pairs. Which one is cheapest depends on the layout, the number of bodies and their
speed.

What to see: where all bodies move, the hash is the cheapest at 300 bodies, the hash and the sweep at 1,000 and more,
and speed costs the sweep the least. Where one in twenty moves, the hash and the tree cannot be told apart up to 1,000
bodies; at 5,000 the hash is cheaper. Brute force tests each body that has left its margin with all others.

Why it matters: Without a broad phase, n bodies are n (n - 1) / 2 pairs a step, too many for any narrow phase.

To try: change the layout with left and right, wait for the exponents, and compare the order of the four.

Source: Baraff 1992 (sweep); Teschner 2003 (hash); Catto, Dynamic Bounding Volume Hierarchies, GDC 2019 (tree).
"""

import numpy as np
import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import BROADPHASE_COLORS, FOG, NIGHT, PAPER, RED, SLATE
from game.drawing.headline import Headline
from game.input.inputs import InputFrame
from game.measure.power_law import fit_power_law
from game.measurement_requests import MeasuredRun, Recipe, RunRequest
from game.scene import FAST, Goal, Scene, Slider
from physics import JIT, Effects
from scenes.lab import layouts
from scenes.lab.costs import cost_text
from scenes.lab.curves import Curves
from scenes.lab.growth import Series, draw_growth
from scenes.lab.layouts import GIANT, HEIGHT, LAYOUTS, RADIUS, WIDTH, populate
from scenes.lab.yard import HEAD

STRATEGIES = ("brute", "sweep", "hash", "tree")
ABOUT = {
    "even": "even: all of one size, all moving",
    "ground": "clustered along the ground, moving slowly",
    "still": "few movers among many still ones",
    "giant": "one giant among many small ones",
}
VIEW_WIDTH, VIEW_HEIGHT = 158, 108  # [canvas px] of each picture
ZOOM = VIEW_WIDTH / WIDTH
CORNERS = ((4, 30), (166, 30), (4, 153), (166, 153))
PLOTS = (("candidate pairs", 30), ("tests of boxes, nodes too [log]", 75))
PLOT_X, PLOT_WIDTH, PLOT_HEIGHT = 330, 146, 42
GROWTH = (330, 120, 146, 126)  # [canvas px] the plot of cost over number
LARGEST = 5000 if JIT else 500  # bodies measured beside the game; plain, a step of brute force takes seconds
SIZES = tuple(round(LARGEST / 10 ** (k / 4)) for k in range(7, -1, -1))
FITTED = 5  # of the largest sizes, a decade: below it the fixed cost of a step bends the line


class Broadphases(Scene):
    """Four worlds with the same bodies and motions, one per broad phase."""

    name = "lab/broadphases"
    title = "Broad phases"
    question = FAST
    about = "The same bodies in four worlds: what does each strategy pay to find the same pairs?"
    effects = Effects(narrowphase=False)
    pieces = ("circles", "boxes")
    features = (
        "brute force, sweep and prune, spatial hash, dynamic tree",
        "live curves of pairs and tests; cost over number, with its exponent",
        "four layouts, 10 to 5,000 bodies",
    )
    sliders = (Slider("bodies", 10, 5000, 600, step=10), Slider("layout", 0, 3, 0, choices=LAYOUTS))
    lighter = {"bodies": 60}
    actions = (("left right", "layout"), ("up down", "bodies"))
    overlays = ("structure", "pairs")
    switches_broadphase = False
    keeps = {"narrowphase": "pairs of boxes are what is found and compared; discs in them are not tested"}
    head = HEAD
    legend_at = (330, 248)

    def build(self):
        """Create the cameras, the curves and the counters, then call fill() to create the four worlds."""
        self.cameras = [Camera((*corner, VIEW_WIDTH, VIEW_HEIGHT), ZOOM) for corner in CORNERS]
        self.curves = [
            Curves(title, {"all four": PAPER} if i == 0 else BROADPHASE_COLORS) for i, (title, _) in enumerate(PLOTS)
        ]
        self.compared = self.disagreements = self.most_pairs = 0
        self.tests = dict.fromkeys(STRATEGIES, 0)
        self.shown = set()
        self.fill()

    @property
    def layout(self):
        """Name of the current layout."""
        return LAYOUTS[int(self.values["layout"])]

    def fill(self):
        """Replace the scene's worlds by four new ones that contain the same bodies.

        The layout, the number of bodies and the scene's seed determine the bodies.
        """
        self.worlds = []
        for strategy in STRATEGIES:
            populate(self.add_world(broadphase=strategy), self.layout, int(self.values["bodies"]), self.seed)

    def measured(self):
        """Return a RunRequest: the runs that the measuring process times during the game.

        In each run, one broad phase steps a world of the current layout. There is one run for each broad phase and
        each number of bodies: the numbers in SIZES, and the current number.
        """
        sizes = sorted({*SIZES, min(int(self.values["bodies"]), LARGEST)})
        names = [(self.layout, size, strategy) for size in sizes for strategy in STRATEGIES]
        return RunRequest(names, self._make)

    def _make(self, name):
        layout, size, strategy = name
        made = Recipe(f"{layouts.__name__}:snapshot_of", (self.effects.names(), self.seed, layout, size))
        return MeasuredRun([made], strategy, stage="broad_phase")

    def growth(self, strategy):
        """Return the Series of the broad phase `strategy` in the current layout, for the plot of cost over number of
        bodies.

        It contains the measured points (number of bodies, cost of a step), and the power law fitted to them. The law
        is None while points are missing.
        """
        known = [(size, self.figures.get((self.layout, size, strategy))) for size in SIZES]
        points = [(size, figures.cost) for size, figures in known if figures is not None]
        done = all(figures is not None and figures.sure for _, figures in known)
        law = fit_power_law([(size, cost.least) for size, cost in points[-FITTED:]]) if done else None
        return Series(BROADPHASE_COLORS[strategy], points, law, FITTED)

    def change_slider(self, name, value):
        """Set the slider `name` to `value`, then make the four worlds again.

        A new number of bodies also sets the counts of tests to zero.
        """
        super().change_slider(name, value)
        if name == "bodies":
            self.tests = dict.fromkeys(STRATEGIES, 0)  # among few bodies all need as many as brute force
        self.fill()

    def update(self, inputs):
        """Process keys, reflect bodies at the edges, step all four worlds, and compare their candidate pairs."""
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
        self.shown.add(self.layout)
        for strategy, world in zip(STRATEGIES, self.worlds, strict=True):
            self.tests[strategy] += tests_of(world)

    def observe(self):
        """Append the step's number of candidate pairs, and the number of box tests of each broad phase, to
        the curves.
        """
        by_name = dict(zip(STRATEGIES, self.worlds, strict=True))
        self.curves[0].note({"all four": len(self.worlds[0].candidates)})
        self.curves[1].note({name: tests_of(w) for name, w in by_name.items()})

    def views(self):
        """Return a list of (world, camera), one for the picture of each world."""
        return list(zip(self.worlds, self.cameras, strict=True))

    def draw(self, canvas, alpha):
        """Draw the heading and background of each view, and the bodies as dots.

        draw_on_frame() and the overlays draw the curves and structures at window resolution. alpha: position (0..1)
        between the last two steps.
        """
        canvas.surface.fill(NIGHT)
        for name, world, camera in zip(STRATEGIES, self.worlds, self.cameras, strict=True):
            view, color = camera.viewport, BROADPHASE_COLORS[name]
            canvas.surface.fill((16, 13, 27), view)
            pygame.draw.rect(canvas.surface, SLATE, view.inflate(2, 2), 1)
            canvas.text(name, view.x, view.y - 11, color)
            spent, tests = (self.layout, int(self.values["bodies"]), name), self.curves[1].typical(name)
            canvas.text(cost_text(self, spent), view.right, view.y - 9, color, SMALL, align="right")
            canvas.text(f"{tests:,.0f} tests", view.x + 36, view.y - 9, FOG, SMALL)
            draw_dots(canvas.surface, world, camera, color)

    def draw_on_frame(self, frame):
        """Draw the curves, and the plot of cost over number of bodies."""
        for curves, (_, y) in zip(self.curves, PLOTS, strict=True):
            curves.draw(frame, (PLOT_X, y, PLOT_WIDTH, PLOT_HEIGHT))
        series = {name: self.growth(name) for name in STRATEGIES}
        draw_growth(frame, GROWTH, "time of a step over bodies [log]", series, int(self.values["bodies"]))

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        tests = {name: tests_of(world) for name, world in zip(STRATEGIES, self.worlds, strict=True)}
        least = min(STRATEGIES[1:], key=tests.__getitem__)
        number = f"{tests['brute'] / max(tests[least], 1):,.1f} x"
        sentence = f"{len(self.world.bodies):,} bodies, {ABOUT[self.layout]}: brute force tests them all."
        return Headline(sentence, "down: fewer", number, f"the tests of the {least}", self.compared, 1, "steps")

    def finding(self):
        """Return a sentence with the exponent of each strategy's cost in this layout (cost of a step ~ n^exponent)."""
        laws = {name: self.growth(name).law for name in STRATEGIES}
        if None in laws.values():
            known = sum((self.layout, size, name) in self.figures for size in SIZES for name in STRATEGIES)
            return f"not yet: {known} of {len(SIZES) * len(STRATEGIES)} worlds of this layout were stepped for it"
        grown = ", ".join(f"{name} n^{law.exponent:.2f}" for name, law in laws.items() if law is not None)
        return f"{self.layout}, {SIZES[-FITTED]:,} to {LARGEST:,} bodies: a step costs {grown}"

    def check(self):
        """Return the scene's goals, a list of Goal.

        All four broad phases find the same pairs, and three of them make fewer tests than brute force.
        """
        cheaper = all(self.tests[name] < self.tests["brute"] for name in STRATEGIES[1:])
        return [
            Goal(
                "all four list the same pairs",
                60,
                self.compared > 0 and self.disagreements == 0,
                f"{self.disagreements} of {self.compared} steps differ",
            ),
            Goal("pairs are found", 60, self.most_pairs > 0, f"at most {self.most_pairs} in a step"),
            Goal(
                "three strategies test fewer boxes than brute force",
                60,
                cheaper,
                ", ".join(f"{name} {count:,}" for name, count in self.tests.items()),
            ),
            Goal("every layout is shown", 480, len(self.shown) == len(LAYOUTS), ", ".join(sorted(self.shown))),
        ]

    def bot(self):
        """Return the bot's input for the next step. The bot changes the layout every two seconds."""
        turn = self.frame > 0 and self.frame % 120 == 0
        return InputFrame(frozenset(("right",)) if turn else frozenset())

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the settings and results. The worlds are hashed
        separately.
        """
        return (
            self.frame,
            self.values["bodies"],
            self.values["layout"],
            self.compared,
            self.disagreements,
            self.most_pairs,
        )


def bounce(world):
    """Reflect the bodies that have left the picture: reverse the velocity component that leads them further away."""
    bodies = world.bodies
    for place, speed, low, high in (("x", "vx", 0.0, WIDTH), ("y", "vy", 0.0, HEIGHT)):
        position, velocity = bodies[place], bodies[speed]
        outwards = ((position < low) & (velocity < 0.0)) | ((position > high) & (velocity > 0.0))
        velocity[outwards] *= -1.0


def tests_of(world):
    """Return the number of box tests that the broad phase made in the last step.

    Tests of two shapes and tests of a shape with a tree node both count.
    """
    counters = world.profile.counters
    return counters["pairs_tested"] + counters["nodes_visited"]


def draw_dots(surface, world, camera, color):
    """Draw every body as one canvas pixel in `color`, or in red while it has a contact.

    A giant body, which only the layout "giant" has, is also drawn as a ring.
    """
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
