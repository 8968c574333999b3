"""Any two convex shapes: how far apart are they, or how deep in each other, and do three methods agree?

In short: SAT, GJK and the contact agree, to rounding. GJK is wrong only if it is stopped early: it walks towards the
origin of all differences A - B.

What to see: drag and turn the shapes. Below them is the best axis of SAT, with both projections. At the right is the
set of all differences A - B of their points: the shapes overlap if it contains the origin. GJK moves towards the origin
with a simplex; EPA grows a polygon from inside to the edge. Enter shows the next iteration.

Why it matters: Contacts need a distance or a depth; where methods disagree, one of them is wrong.

To try: bring two corners almost together, and step through GJK with Enter.

Source: Gilbert, Johnson and Keerthi 1988 (GJK); van den Bergen 2001 (EPA); Gottschalk and others 1996 (SAT).
"""

from math import cos, hypot, pi, sin

import numpy as np
import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import DUSK, FOG, GOLD, GREEN, INK, NIGHT, ORANGE, PAPER, PINK, RED, SKY, SLATE, YELLOW, faded
from game.drawing.headline import ENOUGH, Headline
from game.drawing.number_text import count_text, gap_text
from game.input.inputs import InputFrame
from game.measure.shape_traces import gjk_steps, sat_axes
from game.overlays.layer_impulses import arrow
from game.overlays.outlines import ring
from game.scene import FAIR, Goal, Scene, Slider
from physics import Capsule, Circle, Effects, Polygon, Segment, collide, distance
from scenes.lab.hands import Hands
from scenes.lab.pieces import hull
from scenes.lab.shape_pictures import draw_differences, draw_shadows, placed_hull
from scenes.lab.yard import HEAD

CHOICES = {
    "circle": Circle(33.0),
    "capsule": Capsule((-27, 0), (27, 0), 17.0),
    "box": Polygon.box(72, 44),
    "triangle": Polygon(((40, 0), (-22, 35), (-22, -35))),
    "hexagon": Polygon(tuple((37 * cos(k * pi / 3), 37 * sin(k * pi / 3)) for k in range(6))),
    "rounded": Polygon(Polygon.box(46, 28).points, radius=12.0),
    "segment": Segment((-42, 0), (42, 0)),
    "shard": Polygon(((45, -5), (20, 25), (-17, 30), (-42, 8), (-35, -20), (5, -27))),
}
NAMES = tuple(CHOICES)
COLORS = (SKY, ORANGE)  # of A and B
ARENA = pygame.Rect(4, 18, 300, 212)
PICTURE = pygame.Rect(308, 18, 168, 130)  # of the differences
SIDE_X, SIDE_Y = 310, 154
ICON = 18
ICONS = tuple(
    pygame.Rect(22 + i * (ICON + 2), 233 + row * (ICON + 1), ICON, ICON) for row in range(2) for i in range(len(NAMES))
)
START = ((128.0, 112.0, 0.2), (232.0, 104.0, -0.4))
MARGIN = 36  # [px] between a shape's middle and the arena's edge
EXACT = 1e-9  # [px] tolerance between the methods, at this size
LEG = 25  # steps per pair of shapes of the bot
MOST_STEPS = 24


class Shapes(Scene):
    """Scene with two kinematic bodies in one world. All results follow from their shapes and poses."""

    name = "lab/shapes"
    title = "Shapes"
    question = FAIR
    about = "Drag any two convex shapes: SAT, GJK and EPA step by step, with distance and depth compared."
    pieces = ("circles", "boxes", "masks", "tiles", "chains", "capsules", "queries", "casts")
    effects = Effects()  # contacts are found and drawn; there is no response
    features = (
        "separating axes and shadows",
        "GJK simplex and EPA polytope, round by round",
        "collide, distance and SAT compared in every step",
    )
    sliders = (
        Slider("A", 0, len(NAMES) - 1, 2, choices=NAMES),
        Slider("B", 0, len(NAMES) - 1, 1, choices=NAMES),
        Slider("step", 0, MOST_STEPS, 0),
    )
    actions = (
        ("mouse", "drag"),
        ("wheel", "turn"),
        ("arrows", "move"),
        ("Shift+arrows", "turn"),
        ("Space", "other"),
        ("Enter", "next step"),
    )
    head = HEAD
    legend_at = (8, 22)
    hides_pointer = False

    def build(self):
        """Build both bodies, set the counts to zero, and compute the results for the starting poses."""
        self.add_world()
        self.hands = Hands(START, 1, ARENA.inflate(-2 * MARGIN, -2 * MARGIN))
        self.bodies = [
            self.world.add_body(shape, position=pose[:2], angle=pose[2], kind="kinematic")
            for shape, pose in zip(self.shapes, self.hands.poses, strict=True)
        ]
        self.compared = self.overlapping = self.apart = 0
        self.disagreed = self.mirrored = 0
        self.worst = {"gap": 0.0, "axis": 0.0}
        self.rounds = 0
        self.pairs = set()
        self._ask()

    @property
    def shapes(self):
        """The two selected shapes, a list [A, B]."""
        return [CHOICES[NAMES[int(self.values[side])]] for side in "AB"]

    @property
    def step_shown(self):
        """The iteration of GJK or EPA that is drawn; None if there is none.

        It is an element of the list that shape_traces.gjk_steps() returns.
        """
        return self.steps[min(int(self.values["step"]), len(self.steps) - 1)] if self.steps else None

    def change_slider(self, name, value):
        """Set the slider `name` to `value`. If it selects a shape, replace the shape of that body and keep the body's
        pose.
        """
        super().change_slider(name, value)
        if name in "AB":
            which = "AB".index(name)
            self.bodies[which].set_shapes(self.shapes[which])
            self.values["step"] = MOST_STEPS

    def update(self, inputs):
        """Process the input, move both shapes, make one step for the overlays, and compute all results."""
        if inputs.pointer_pressed:
            self._press(*inputs.pointer)
        self.hands.move(inputs)
        if inputs.pressed("confirm"):
            count = len(self.steps)
            self.values["step"] = (min(int(self.values["step"]), count - 1) + 1) % max(count, 1)
        for body, pose in zip(self.bodies, self.hands.poses, strict=True):
            body.move_to(tuple(pose[:2]), pose[2])
        self.world.step()
        self._ask()
        self._compare()

    def _press(self, x, y):
        for number, rect in enumerate(ICONS):
            if rect.collidepoint(x, y):
                self.hands.chosen = number // len(NAMES)
                self.change_slider("AB"[self.hands.chosen], number % len(NAMES))
        if ARENA.collidepoint(x, y):
            gaps = [
                distance(Circle(0.5), (x, y, 0.0), shape, tuple(pose)).distance
                for shape, pose in zip(self.shapes, self.hands.poses, strict=True)
            ]
            which = int(gaps[1] < gaps[0])
            if gaps[which] < 6.0:
                self.hands.take(which, x, y)

    def _ask(self):
        a, b = self.shapes
        pose_a, pose_b = (tuple(pose) for pose in self.hands.poses)
        self.gap = distance(a, pose_a, b, pose_b)
        self.manifold = collide(a, pose_a, b, pose_b)
        self.axes = sat_axes(a, pose_a, b, pose_b)
        self.steps = gjk_steps(a, pose_a, b, pose_b)

    def _compare(self):
        """Compare the overlap, distance and depth of the two shapes by SAT, GJK and collide(), and update the greatest
        errors.

        The distance is also computed in the opposite order of the shapes.
        """
        a, b = self.shapes
        pose_a, pose_b = (tuple(pose) for pose in self.hands.poses)
        gap, other = self.gap, distance(b, pose_b, a, pose_a)
        meets = len(self.manifold) > 0
        self.compared += 1
        self.pairs.add((int(self.values["A"]), int(self.values["B"])))
        self.overlapping += meets
        self.apart += not meets
        self.disagreed += meets != (gap.distance <= 0.0)
        self.mirrored += (other.distance, other.point_a, other.point_b) != (gap.distance, gap.point_b, gap.point_a)
        self.rounds = max(self.rounds, gap.iterations)
        if not meets:
            (ax, ay), (bx, by) = gap.point_a, gap.point_b
            self.worst["gap"] = max(self.worst["gap"], abs(hypot(bx - ax, by - ay) - gap.distance))
        # No gap between projections is wider than the gap itself, and one equals it; the least overlap of projections
        # is the depth.
        self.worst["axis"] = max(self.worst["axis"], abs(float(self.axes[0]["separation"]) - gap.distance))

    def draw(self, canvas, alpha):
        """Draw backgrounds, icons and numbers. draw_on_frame() draws the geometry.

        alpha: position (0..1) between the last two steps.
        """
        canvas.surface.fill(NIGHT)
        for rect in (ARENA, PICTURE):
            canvas.surface.fill(INK, rect)
            pygame.draw.rect(canvas.surface, SLATE, rect.inflate(2, 2), 1)
        canvas.text("all differences A - B", PICTURE.x + 3, PICTURE.y + 3, FOG, SMALL)
        for x in range(ARENA.left + 10, ARENA.right, 16):
            canvas.surface.fill(faded(DUSK, 0.4), (x, ARENA.top, 1, ARENA.height))
        for y in range(ARENA.top + 10, ARENA.bottom, 16):
            canvas.surface.fill(faded(DUSK, 0.4), (ARENA.left, y, ARENA.width, 1))
        for row, side in enumerate("AB"):
            canvas.text(side, 8, 239 + row * (ICON + 1), COLORS[row])
        for number, rect in enumerate(ICONS):
            row, index = divmod(number, len(NAMES))
            self._draw_icon(canvas.surface, rect, NAMES[index], COLORS[row], int(self.values["AB"[row]]) == index)
        canvas.text(f"{NAMES[int(self.values['A'])]} and {NAMES[int(self.values['B'])]}", 190, 240, PAPER, SMALL)
        canvas.text("click to choose", 190, 256, FOG, SMALL)
        self._draw_numbers(canvas)

    def _draw_icon(self, surface, rect, name, color, chosen):
        surface.fill(DUSK if chosen else INK, rect)
        pygame.draw.rect(surface, color if chosen else SLATE, rect, 1)
        points, radius = hull(CHOICES[name])
        corners = np.array(ring(points.tolist(), radius, 1.0)) * 0.165 + rect.center
        if len(corners) > 2:
            pygame.draw.polygon(surface, color if chosen else faded(color, 0.45), corners.tolist())
        else:
            start, end = corners.tolist()
            pygame.draw.line(surface, color if chosen else faded(color, 0.45), start, end, 2)

    def _draw_numbers(self, canvas):
        meets, gap = len(self.manifold) > 0, self.gap
        color = RED if meets else GREEN
        canvas.text("depth" if meets else "distance", SIDE_X, SIDE_Y + 3, color, SMALL)
        canvas.text(f"{abs(gap.distance):.3f}", 474, SIDE_Y, color, align="right")
        deepest = f"{float(np.min(self.manifold.separations)):.3f}" if meets else "no contact"
        best = f"{float(self.axes[0]['separation']):.3f} of {len(self.axes)} axes"
        rows = (
            ("collide", deepest, PAPER),
            ("best axis", best, PAPER),
            ("rounds", f"{gap.iterations}", PAPER),
            ("normal", f"{gap.normal[0]:.3f} {gap.normal[1]:.3f}", PAPER),
        )
        for line, (label, value, hue) in enumerate(rows):
            y = SIDE_Y + 14 + line * 9
            canvas.text(label, SIDE_X, y, FOG, SMALL)
            canvas.text(value, 474, y, hue, SMALL, align="right")
        y = SIDE_Y + 56
        if self.steps:
            index = min(int(self.values["step"]), len(self.steps) - 1)
            step = self.steps[index]
            what = f"{len(step['polytope'])} corners" if step["phase"] == "epa" else f"{len(step['simplex'])} points"
            hue = PINK if step["phase"] == "epa" else YELLOW
            canvas.text(f"{step['phase'].upper()} {what}", SIDE_X, y, hue, SMALL)
            canvas.text(f"step {index + 1} of {len(self.steps)}", 474, y, hue, SMALL, align="right")
            canvas.text("so far, of the cores", SIDE_X, y + 9, FOG, SMALL)
            canvas.text(f"{step['distance']:.3f}", 474, y + 9, PAPER, SMALL, align="right")
        wrong = self.disagreed + self.mirrored
        canvas.text("compared", SIDE_X, y + 27, FOG, SMALL)
        canvas.text(f"{self.compared} times, {len(self.pairs)} pairs", 474, y + 27, PAPER, SMALL, align="right")
        canvas.text("disagreements", SIDE_X, y + 36, FOG, SMALL)
        canvas.text(f"{wrong}", 474, y + 36, RED if wrong else GREEN, SMALL, align="right")

    def draw_on_frame(self, frame):
        """Draw the shapes, their projections and witness points, and the Minkowski difference, at window resolution."""
        lens = frame.lens(self.camera)
        width = max(1, frame.scale - 1)
        surface = frame.surface
        surface.set_clip(frame.from_canvas(ARENA))
        placed = [placed_hull(shape, pose) for shape, pose in zip(self.shapes, self.hands.poses, strict=True)]
        for index, ((points, radius), color) in enumerate(zip(placed, COLORS, strict=True)):
            corners = [lens.points(x, y) for x, y in ring(points, radius, lens.scale)]
            if len(corners) > 2:
                pygame.draw.polygon(surface, faded(color, 0.72 if index == self.hands.chosen else 0.8), corners)
            pygame.draw.lines(surface, color, True, corners, width + (index == self.hands.chosen))
            if radius and len(points) > 1:
                core = [lens.points(x, y) for x, y in points]
                pygame.draw.lines(surface, faded(color, 0.4), len(core) > 2, core, 1)
        draw_shadows(frame, lens, placed, self.axes, COLORS)
        self._draw_witness(frame, lens)
        for point in self.manifold.points.tolist():
            place = lens.points(*point)
            pygame.draw.circle(surface, PAPER, place, 1.5 * frame.scale)
            nx, ny = self.manifold.normal
            arrow(frame, *place, nx * 12 * frame.scale, ny * 12 * frame.scale, RED)
        surface.set_clip(None)
        draw_differences(frame, frame.from_canvas(PICTURE), placed, len(self.manifold) > 0, self.step_shown)
        for index, pose in enumerate(self.hands.poses):
            x, y = lens.points(pose[0], pose[1])
            frame.text_if_free(
                "AB"[index], x, y - 3 * frame.text_scale, COLORS[index], SMALL, frame.text_scale, "center", True
            )

    def _draw_witness(self, frame, lens):
        """Draw the nearest points of both shapes, and the witness points of the drawn GJK or EPA iteration.

        lens: transform of world points to frame points.
        """
        a, b = lens.points(*self.gap.point_a), lens.points(*self.gap.point_b)
        pygame.draw.line(frame.surface, GOLD, a, b, max(1, frame.scale - 1))
        for place in (a, b):
            pygame.draw.circle(frame.surface, GOLD, place, 1.2 * frame.scale)
        step = self.step_shown
        if step is not None:
            x, y = self.hands.poses[0][:2]
            places = [lens.points(x + px, y + py) for px, py in step["witness"]]
            color = PINK if step["phase"] == "epa" else YELLOW
            pygame.draw.line(frame.surface, faded(color, 0.3), *places)
            for place in places:
                pygame.draw.circle(frame.surface, color, place, 2 * frame.scale, 1)

    def check(self):
        """Return the scene's goals, a list of Goal. The methods agree for all shapes and poses of the bot."""
        return [
            Goal(
                "shapes seen apart and in each other",
                240,
                min(self.apart, self.overlapping) > 20,
                f"{self.apart} and {self.overlapping} steps",
            ),
            Goal(
                "collide and distance say the same",
                590,
                self.compared > 500 and self.disagreed == 0,
                f"{self.disagreed} of {self.compared} differ",
            ),
            Goal("in either order the same", 590, self.mirrored == 0, f"{self.mirrored} differ"),
            Goal(
                "nearest points are as far apart as said", 590, self.worst["gap"] <= EXACT, gap_text(self.worst["gap"])
            ),
            Goal(
                "the best axis is as wide as the distance, or the depth",
                590,
                self.worst["axis"] <= EXACT,
                gap_text(self.worst["axis"]),
            ),
            Goal("many pairs of shapes", 590, len(self.pairs) >= 20, f"{len(self.pairs)}"),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        wrong, step = self.disagreed + self.mirrored, self.step_shown
        off = 0.0 if step is None else abs(step["distance"] - self.steps[-1]["distance"])
        if step is not None and off > EXACT:
            index, count = min(int(self.values["step"]), len(self.steps) - 1), len(self.steps)
            sentence = (
                f"{step['phase'].upper()} stopped after round {index + 1} of {count} is wrong about the distance."
            )
            unit = "off the answer of the last round"
            headline = Headline(sentence, "Enter: next round", gap_text(off), unit, self.compared, 1, "answers")
            return headline.asks("How many rounds does GJK need to find the distance?")
        sentence = "SAT, GJK and the contact disagree about the same two shapes."
        unit = f"of {self.compared:,} answers differ"
        headline = Headline(sentence, "Enter: step", f"{wrong}", unit, self.compared, ENOUGH, "answers", not wrong)
        return headline.asks("SAT, GJK and the contact answer for the same two shapes: do they agree?")

    def finding(self):
        """Return a sentence with the number of compared poses, and the greatest difference between the methods."""
        if not self.compared:
            return "not yet: the shapes have to be compared"
        wrong = self.disagreed + self.mirrored
        seen = f"{count_text(self.compared, 'pose')} of {count_text(len(self.pairs), 'pair')}"
        sentence = f"in {seen} of shapes the methods disagreed {wrong} times"
        return f"{sentence}; SAT and GJK: {gap_text(self.worst['axis'])}, after {count_text(self.rounds, 'round')}"

    def bot(self):
        """Return the bot's input for the next step.

        Every 25 steps the bot selects another pair of shapes. It drags B into A and out again, and rotates B.
        """
        leg, step = divmod(self.frame, LEG)
        changes = ()
        if step == 0:
            changes = (("slider:A", leg % len(NAMES)), ("slider:B", (leg * 3 + leg // len(NAMES)) % len(NAMES)))
        if step == 0:  # release, so that the next press grabs B's middle
            return InputFrame(frozenset(), self._pointer(1), False, 0, changes)
        share = (step - 1) / (LEG - 2)
        reach = 112.0 * abs(2.0 * share - 1.0) + 6.0
        turn = 0.7 * leg + share
        target = (round(START[0][0] + 14 + reach * cos(turn)), round(START[0][1] + 8 + 0.8 * reach * sin(turn)))
        pointer = self._pointer(1) if step == 1 else target
        actions = frozenset({"confirm"}) if step in (8, 10, 12, 14) else frozenset()
        return InputFrame(actions, pointer, True, 1 if step % 3 == 0 else 0, changes)

    def _pointer(self, which):
        return round(self.hands.poses[which][0]), round(self.hands.poses[which][1])

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the poses and counts."""
        poses = [value for pose in self.hands.poses for value in pose]
        return (
            self.frame,
            *poses,
            *self.values.values(),
            self.hands.chosen,
            self.compared,
            self.overlapping,
            self.disagreed,
            self.mirrored,
            self.rounds,
        )
