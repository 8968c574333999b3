"""Rays, casts, overlaps, areas, the closest point among hundreds of shapes: which boxes do four broad phases visit?

In short: brute force visits all boxes, the tree, hash and sweep those near the query: about a third for a long ray.
All answer alike.

What to see: the same query runs in four worlds in every step, one per strategy. All give the same answer: hits with
their normals and fractions. The places that each one visits are drawn: boxes of the tree that were entered or rejected;
cells of the hash; the stretch of the sweep; all boxes of brute force. A long slanted ray is split into several query
boxes; the closest point uses larger and larger ones.

Why it matters: Sight, aim and steering query the world many times a step, so each query must be cheap.

To try: make the ray long and slanted, and count what the hash and the tree visit.

Source: Amanatides and Woo, A Fast Voxel Traversal Algorithm, 1987; Ericson, Real-Time Collision Detection, 2005.
"""

from math import cos, hypot, pi, sin
from random import Random

import numpy as np
import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import BROADPHASE_COLORS, FOG, GOLD, NIGHT, PAPER, SLATE, WHITE, YELLOW, faded
from game.drawing.headline import Headline
from game.drawing.sprites import load_backdrop
from game.drawing.typical import Typical
from game.input.inputs import InputFrame
from game.measurement_requests import Act, MeasuredRun, RunRequest
from game.overlays.layer_impulses import arrow
from game.overlays.outlines import draw_outline
from game.scene import FAIR, Goal, Scene, Slider
from physics import Capsule, Circle, Effects, PixelMask, Polygon, debug
from scenes.lab.costs import cost_of, cost_text, microseconds
from scenes.lab.curves import Curves
from scenes.lab.looks import Looks
from scenes.lab.query_calls import angle_of, ask, rows_of
from scenes.lab.yard import HEAD, darken

STRATEGIES = ("tree", "hash", "sweep", "brute")
QUERIES = ("ray", "all", "cast", "overlap", "closest", "area", "point")
ABOUT = {
    "ray": "a ray: the first shape it meets",
    "all": "a ray: all shapes on its way",
    "cast": "a disc is cast: what it touches first",
    "overlap": "a box: whose shapes does it overlap?",
    "closest": "the nearest point of any shape",
    "area": "an upright area: whose bounds are in it?",
    "point": "a point: whose shapes hold it?",
}
VIEW, ZOOM = (4, 18, 346, 248), 0.5
WIDTH, HEIGHT = VIEW[2] / ZOOM, VIEW[3] / ZOOM  # [px] of the world
SIDE_X, PLOT = 356, (354, 190, 122, 76)
SPEED = 24.0  # [px/s]
STILL_SHARE = 0.5  # of the bodies
DISC = np.hypot(*np.mgrid[-7.5:8, -7.5:8])
SHAPES = (
    Circle(8.0),
    Polygon.box(20.0, 12.0),
    Capsule((-9.0, 0.0), (9.0, 0.0), 4.0),
    Polygon([(-8.0, -6.0), (9.0, -2.0), (-1.0, 9.0)], 2.0),
)
RING = PixelMask.from_array((DISC < 8.0) & (DISC > 4.0))
RING_EVERY = 13  # shapes per ring of pixels
ORIGIN, CLEAR = (0.06 * WIDTH, 0.3 * HEIGHT), 60.0  # [px] start of rays, and the space around it that is empty at first
AWAY = 40.0  # [px] distance from the start of rays at which bodies turn back
SHOWN = 24  # hits that are drawn with normal and fraction
EACH = 84  # steps per query of the bot
PLACES = 200  # places per timed run: five runs make a thousand


class Queries(Scene):
    """Scene with four worlds that contain the same bodies, one for each broad phase. The same query runs in each
    world.
    """

    name = "lab/queries"
    title = "Queries"
    question = FAIR
    about = "Rays, casts, overlaps, the closest point among hundreds of shapes: what is looked at to find the answer?"
    effects = Effects(narrowphase=False)
    keeps = {"narrowphase": "it is asked, not stepped: rays, casts and overlaps judge the shapes themselves"}
    pieces = ("circles", "boxes", "capsules", "masks", "queries", "casts")
    features = (
        "rays, casts, overlaps, areas, points, closest point",
        "nodes and boxes visited, drawn and counted",
        "tree, hash, sweep and brute force side by side",
    )
    sliders = (
        Slider("query", 0, len(QUERIES) - 1, 0, choices=QUERIES),
        Slider("size", 4, 80, 16, "px", step=4),
        Slider("bodies", 60, 2000, 600, step=20),
    )
    lighter = {"bodies": 60}
    actions = (
        ("mouse", "where"),
        ("click", "from where"),
        ("left right", "query"),
        ("up down", "broad phase"),
        ("wheel", "size"),
    )
    switches_broadphase = False
    hides_pointer = False
    head = HEAD
    legend_at = (8, 22)

    def build(self):
        """Create the sky, the curves and the counts, then call fill() to create the four worlds."""
        self.sky = load_backdrop("sky_dusk")
        self.camera = Camera(VIEW, ZOOM)
        self.curves = Curves("boxes and nodes [log]", {name: BROADPHASE_COLORS[name] for name in STRATEGIES})
        self.shown = STRATEGIES.index("brute")  # in STRATEGIES: the one that looks at most
        self.origin, self.target = ORIGIN, (0.7 * WIDTH, 0.6 * HEIGHT)
        self.asked = self.disagreements = self.found = 0
        self.kinds = set()  # queries with a result
        self.fill()

    def fill(self):
        """Replace the scene's worlds by four new ones with the same bodies."""
        count = int(self.values["bodies"])
        random = Random(f"{self.seed} {count}")
        rows = [
            (
                self._place(random),
                random.uniform(0.0, pi),
                (random.uniform(-SPEED, SPEED), random.uniform(-SPEED, SPEED)),
                RING if number % RING_EVERY == 0 else SHAPES[number % len(SHAPES)],
                random.random() < STILL_SHARE,
            )
            for number in range(count)
        ]
        self.worlds = []
        # Boxes and nodes so far, with at least so many shapes: with few the hash visits more than brute force.
        self.looked = dict.fromkeys(STRATEGIES, 0)
        for strategy in STRATEGIES:
            world = self.add_world(broadphase=strategy)
            for place, angle, velocity, shape, still in rows:
                angle = 0.0 if shape is RING else angle
                if still:
                    world.add_body(shape, position=place, angle=angle, kind="static")
                else:
                    world.add_body(shape, position=place, angle=angle, velocity=velocity)
        self.looks = [Looks(world, self.camera) for world in self.worlds]
        self.answer = []  # (body id, x, y, normal x, normal y, fraction): see ask()
        self.work = {name: (0, 0) for name in STRATEGIES}  # nodes or cells, boxes compared
        self.parts = 1  # query boxes into which the query was cut: brute force compares each with every shape
        self._forget()

    def _forget(self):
        self.usual = {name: Typical() for name in STRATEGIES}  # boxes and nodes visited for this query

    def _place(self, random):
        while True:
            x, y = random.uniform(10.0, WIDTH - 10.0), random.uniform(10.0, HEIGHT - 10.0)
            if hypot(x - ORIGIN[0], y - ORIGIN[1]) > CLEAR:
                return x, y

    @property
    def query(self):
        """Name of the current kind of query, one of QUERIES."""
        return QUERIES[int(self.values["query"])]

    def change_slider(self, name, value):
        """Set the slider `name` to `value`, and clear the average counts. A new number of bodies makes the worlds
        again.
        """
        super().change_slider(name, value)
        self._forget()
        if name == "bodies":
            self.fill()

    def update(self, inputs):
        """Process keys and the pointer; step each world, run the query in it, and compare the four answers."""
        turn = inputs.pressed("right") - inputs.pressed("left")
        if turn:
            self.change_slider("query", (self.values["query"] + turn) % len(QUERIES))
        self.shown = (self.shown + inputs.pressed("down") - inputs.pressed("up")) % len(STRATEGIES)
        if inputs.wheel:
            self.change_slider("size", self.values["size"] + 4 * inputs.wheel)
        if self.camera.viewport.collidepoint(inputs.pointer):
            place = self.camera.to_world(*inputs.pointer)
            self.target = place
            if inputs.pointer_pressed:
                self.origin = place
        answers = []
        for strategy, world in zip(STRATEGIES, self.worlds, strict=True):
            bounce(world, self.origin)
            world.step()
            answers.append(rows_of(ask(world, self.query, self.origin, self.target, float(self.values["size"]))))
            counters = world.queries.counters
            self.work[strategy] = counters["nodes_visited"], counters["pairs_tested"]
            self.looked[strategy] += sum(self.work[strategy])
            self.usual[strategy].note(sum(self.work[strategy]))
        self.parts = max(1, len(self.worlds[-1].queries.asked))
        self.answer = answers[0]
        self.asked += 1
        self.found += len(self.answer)
        self.disagreements += any(each != self.answer for each in answers[1:])
        if self.answer:
            self.kinds.add(self.query)

    def observe(self):
        """Append the number of boxes and nodes that each broad phase visited in this step to the curves."""
        self.curves.note({name: sum(looked) for name, looked in self.work.items()})

    def measured(self):
        """Return a RunRequest: one run for each broad phase, timed by the measuring process during the game.

        A run makes the current kind of query at two hundred points of the picture.
        """
        made = []  # one snapshot for all unknown ones

        def make(name):
            if not made:
                made.append(self.worlds[0].snapshot())
            query, size, _, strategy = name
            act = Act(f"{__package__}.query_calls:asking", (query, ORIGIN, (WIDTH, HEIGHT), size))
            return MeasuredRun(made, strategy, PLACES, act=act)

        return RunRequest([self._run_name(strategy) for strategy in STRATEGIES], make)

    def _run_name(self, strategy):
        return self.query, float(self.values["size"]), int(self.values["bodies"]), strategy

    def views(self):
        """Return a list with the (world, camera) of the selected broad phase. The overlays show its structure."""
        return [(self.worlds[self.shown], self.camera)]

    def draw(self, canvas, alpha):
        """Draw the shapes in the world of the selected broad phase, and a list with the counts of each broad phase.

        alpha: position (0..1) between the last two steps.
        """
        canvas.surface.fill(NIGHT)
        view = self.camera.viewport
        canvas.surface.blit(self.sky, view, (20, 10, *view.size))
        darken(canvas, view, (*NIGHT, 190))
        self.looks[self.shown].draw(canvas, alpha)
        pygame.draw.rect(canvas.surface, SLATE, view.inflate(2, 2), 1)
        canvas.text(self.query, SIDE_X, 20, GOLD)
        canvas.text(self._said(), 474, 22, PAPER, SMALL, align="right")
        for number, name in enumerate(STRATEGIES):
            y, color = 34 + 38 * number, BROADPHASE_COLORS[name]
            if number == self.shown:
                pygame.draw.rect(canvas.surface, faded(color, 0.3), (SIDE_X - 2, y - 2, 122, 36), 1)
                canvas.surface.fill(color, (SIDE_X - 2, y - 2, 2, 36))
            canvas.text(name, SIDE_X + 3, y, color)
            canvas.text(cost_text(self, self._run_name(name)), 473, y + 1, color, SMALL, align="right")
            nodes, boxes = self.work[name]
            for row, (word, value) in enumerate(((PARTS[name], nodes), ("boxes compared", boxes))):
                canvas.text(word, SIDE_X + 3, y + 12 + 10 * row, FOG, SMALL)
                canvas.text(f"{value:,}", 473, y + 12 + 10 * row, PAPER, SMALL, align="right")

    def _said(self):
        """Return the answer to the query as short text: a distance, a fraction, or a number of results."""
        if self.query == "closest":
            return f"{self.answer[0][5]:.1f} px away" if self.answer else "none"
        if self.query in ("ray", "cast"):
            if not self.answer:
                return "nothing"
            share = self.answer[0][5]
            return f"after {100 * share:.0f} % of its way" if share > 0.0 else "it starts inside a shape"
        return f"{len(self.answer)} found"

    def draw_on_frame(self, frame):
        """Draw tiny shapes, visited boxes, the query itself, its hits with normal and fraction, and the curves."""
        world, lens = self.worlds[self.shown], frame.lens(self.camera)
        self.looks[self.shown].draw_on_frame(frame)
        frame.surface.set_clip(lens.clip)
        self._draw_visited(frame, lens, world)
        self._draw_found(frame, lens, world)
        self._draw_question(frame, lens)
        self._draw_hits(frame, lens)
        frame.surface.set_clip(None)
        self.curves.draw(frame, PLOT)

    def _draw_visited(self, frame, lens, world):
        """Draw the boxes that the query visited in the colour of the broad phase; boxes without overlap are darker.

        The query's own boxes are drawn in grey. lens: transform of world points to frame points.
        """
        found, color = debug.visited(world), BROADPHASE_COLORS[STRATEGIES[self.shown]]
        left, top = lens.points(found.rects[:, 0], found.rects[:, 1])
        right, bottom = lens.points(found.rects[:, 2], found.rects[:, 3])
        order = np.argsort(found.met, kind="stable")
        columns = (each[order].tolist() for each in (left, top, right - left, bottom - top, found.met))
        for x, y, width, height, met in zip(*columns, strict=True):
            rect = pygame.Rect(round(x), round(y), max(1, round(width)), max(1, round(height)))
            pygame.draw.rect(frame.surface, color if met else faded(color, 0.6), rect, 1)
        for x0, y0, x1, y1 in found.asked.tolist():
            x, y = lens.points(x0, y0)
            rect = pygame.Rect(round(x), round(y), round((x1 - x0) * lens.scale), round((y1 - y0) * lens.scale))
            pygame.draw.rect(frame.surface, faded(PAPER, 0.3), rect, 1)

    def _draw_found(self, frame, lens, world):
        """Draw white outlines around the shapes of the bodies that the query found. Pixel masks have no outline.

        lens: transform of world points to frame points.
        """
        ids = {each[0] for each in self.answer}
        rows = [row for row, body in enumerate(world.shapes["body"].tolist()) if body in ids]
        for outline in debug.outlines(world, rows) if rows else ():
            if outline[0] != "mask":
                draw_outline(frame.surface, lens, outline, WHITE, max(1, frame.scale - 1), frame.scale)

    def _draw_question(self, frame, lens):
        """Draw the shape of the query itself: its ray, cast, box or point.

        lens: transform of world points to frame points.
        """
        surface, size, thick = frame.surface, float(self.values["size"]), max(1, frame.scale - 1)
        start, end = lens.points(*self.origin), lens.points(*self.target)
        if self.query in ("ray", "all", "cast"):
            pygame.draw.line(surface, YELLOW, start, end, thick)
            pygame.draw.circle(surface, YELLOW, start, 2.0 * frame.scale)
        if self.query == "cast":
            for place in (start, end, *(lens.points(*self._cast_end()),)):
                pygame.draw.circle(surface, YELLOW, place, size * lens.scale, 1)
        elif self.query == "overlap":
            angle = self._angle()
            c, s = cos(angle), sin(angle)
            box = [(size * x, 0.6 * size * y) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            corners = [lens.points(self.target[0] + c * x - s * y, self.target[1] + s * x + c * y) for x, y in box]
            pygame.draw.polygon(surface, YELLOW, corners, thick)
        elif self.query == "area":
            half = size * lens.scale
            rect = pygame.Rect(round(end[0] - half), round(end[1] - half), round(2 * half), round(2 * half))
            pygame.draw.rect(surface, YELLOW, rect, thick)
        elif self.query in ("closest", "point"):
            pygame.draw.circle(surface, YELLOW, end, 2.0 * frame.scale)
            if self.query == "closest" and self.answer:
                pygame.draw.line(surface, YELLOW, end, lens.points(*self.answer[0][1:3]), thick)

    def _cast_end(self):
        """Return the position (x, y) [px] of the cast shape at its first hit, or at its target if it hits nothing."""
        share = self.answer[0][5] if self.answer else 1.0
        (x, y), (to_x, to_y) = self.origin, self.target
        return x + share * (to_x - x), y + share * (to_y - y)

    def _angle(self):
        return angle_of(self.origin, self.target)

    def _draw_hits(self, frame, lens):
        """Draw the points, normals and fractions (or distances) of the first hits.

        A text that would cover another text is omitted. lens: transform of world points to frame points.
        """
        if self.query in ("overlap", "area", "point"):
            return
        for _, x, y, nx, ny, fraction in self.answer[:SHOWN]:
            px, py = lens.points(x, y)
            pygame.draw.circle(frame.surface, WHITE, (px, py), 1.5 * frame.scale)
            if nx or ny:
                arrow(frame, px, py, nx * 10 * frame.scale, ny * 10 * frame.scale, GOLD)
            text = f"{fraction:.1f} px" if self.query == "closest" else f"{fraction:.3f}"
            scale = frame.plot_scale
            frame.text_if_free(text, px + 4 * scale, py + 3 * scale, WHITE, SMALL, scale, "left", True)

    def check(self):
        """Return the scene's goals, a list of Goal.

        All four broad phases give the same answers to every query, and tree, hash and sweep visit less than brute
        force.
        """
        cheaper = all(self.looked[name] < self.looked["brute"] for name in STRATEGIES[:-1])
        return [
            Goal(
                "all four give the same answers",
                60,
                self.asked > 0 and self.disagreements == 0,
                f"{self.disagreements} of {self.asked} differ",
            ),
            Goal("something is found", 60, self.found > 0, f"{self.found}"),
            Goal(
                "three strategies look at less than brute force",
                60,
                cheaper,
                ", ".join(f"{name} {count:,}" for name, count in self.looked.items()),
            ),
            Goal("every question finds something", 600, len(self.kinds) == len(QUERIES), ", ".join(sorted(self.kinds))),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        shown, bodies, parts = STRATEGIES[self.shown], int(self.values["bodies"]), self.parts
        looked, whole = sum(self.work[shown]), bodies * parts
        cut = "" if parts == 1 else f" in {parts} parts"
        by = "brute force" if shown == "brute" else f"the {shown}"
        asked = f"{self.query.capitalize()}{cut} among {bodies:,} shapes"
        sentence = f"{asked}: {by} visits them all."
        unit = f"boxes and nodes visited, of {whole:,} boxes"
        good = looked < whole
        headline = Headline(sentence, "down: the tree", f"{looked:,}", unit, self.asked, 1, "queries", good)
        return headline.asks(f"{asked}: does {by} visit them all?")

    def finding(self):
        """Return a sentence with the number of boxes and nodes that each broad phase visits for this query.

        It also gives the number of queries with different answers.
        """
        if not self.usual["tree"].last:
            return "not yet: something has to be asked"
        looks = ", ".join(f"the {name} at {self.usual[name].value:,.0f}" for name in STRATEGIES[:-1])
        among = f"{self.query} among {self.values['bodies']:,} shapes: {looks}, brute force at"
        sentence = f"{among} {self.usual['brute'].value:,.0f} boxes and nodes"
        costs = [cost for name in STRATEGIES if (cost := cost_of(self, self._run_name(name))) is not None]
        if len(costs) == len(STRATEGIES):
            sentence += f"; a query takes {1e6 * min(costs):,.0f} to {microseconds(max(costs))} in the four"
        return f"{sentence}; {self.disagreements} of {self.asked:,} answers differed"

    def bot(self):
        """Return the bot's input for the next step.

        The bot moves the pointer along a slow curve. It changes the query every EACH steps, and the shown broad phase
        every 21 steps.
        """
        at = self.frame / 40.0
        pointer = (
            round(VIEW[0] + VIEW[2] * (0.55 + 0.38 * sin(at))),
            round(VIEW[1] + VIEW[3] * (0.5 + 0.42 * cos(1.3 * at))),
        )
        taps = set()
        if self.frame and self.frame % EACH == 0:
            taps.add("right")
        if self.frame % 21 == 20:
            taps.add("down")
        return InputFrame(frozenset(taps), pointer)

    def state(self):
        """Return the scene's own state for the digest: the query and its answer.

        The answer must not depend on the broad phase.
        """
        return (
            self.frame,
            *self.values.values(),
            self.shown,
            *self.origin,
            *self.target,
            self.asked,
            self.found,
            self.disagreements,
            *(value for row in self.answer for value in row),
        )


PARTS = {"tree": "nodes visited", "hash": "cells visited", "sweep": "halvings", "brute": "nodes"}


def bounce(world, origin):
    """Reflect the bodies that have left the picture: reverse the velocity component that leads them further away.

    Bodies also turn back before they cover `origin` (x, y) [px], the start of rays and casts.
    """
    bodies = world.bodies
    dx, dy = bodies["x"] - origin[0], bodies["y"] - origin[1]
    towards = dx * bodies["vx"] + dy * bodies["vy"]
    near = (np.hypot(dx, dy) < AWAY) & (towards < 0.0)
    turn = 2.0 * towards[near] / np.maximum(dx[near] ** 2 + dy[near] ** 2, 1.0)
    bodies["vx"][near] -= turn * dx[near]
    bodies["vy"][near] -= turn * dy[near]
    for place, speed, high in (("x", "vx", WIDTH), ("y", "vy", HEIGHT)):
        outwards = ((bodies[place] < 0.0) & (bodies[speed] < 0.0)) | ((bodies[place] > high) & (bodies[speed] > 0.0))
        bodies[speed][outwards] *= -1.0
