"""Two planes, tested with nine shapes, from circle to pixels. How often is each wrong, and what do pixels cost?

In short: boxes say HIT while there is sky between the planes. The table counts false hits of thousands of poses.

What to see: at the start, the box is wrong. Drag one plane along the other: the cheap shapes say HIT while there is sky
between the planes; the pixels say HIT only when a pixel is shared. Beside each verdict are its rates of false and of
missed hits over thousands of poses, and the times of one test that hits and one that misses.

Why it matters: Simple shapes are tested first as they are said to be cheap; here are their savings and errors.

To try: turn one plane with the wheel, and look for a pose in which only the exact pixels say no.

Source: masks as bits, ANDed word by word: Ekstrom's bitmask, as in pygame.mask.
"""

from math import hypot

import numpy as np
import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import BLUE, FOG, GOLD, GREEN, INK, ORANGE, PAPER, PINK, SKY, SLATE, WHITE, YELLOW, faded
from game.drawing.headline import Headline
from game.drawing.number_text import TIER_WORDS
from game.drawing.sprites import RotatedSprites, load_atlas, load_backdrop
from game.input.inputs import InputFrame
from game.measure.tiers import POSES
from game.measurement_requests import SpriteRequest
from game.overlays.outlines import draw_outline
from game.scene import FAIR, Goal, Scene
from physics import TIERS, Effects, World, collide, debug
from scenes.lab.hands import Hands
from scenes.lab.yard import HEAD

SPRITES = ("large_plane_a", "large_plane_b")
ARENA = pygame.Rect(0, 16, 316, 254)
START = ((124.0, 166.0, 0.0), (190.0, 120.0, 0.6))  # five simple shapes report a hit without a common pixel
MARGIN = 20  # [px] between a plane's middle and the arena's edge
COLORS = {
    "circle": ORANGE,
    "aabb": GREEN,
    "obb": SKY,
    "capsule": PINK,
    "hull": BLUE,
    "parts": PAPER,
    "outline": FOG,
    "pixels": YELLOW,
    "mask": WHITE,
}
NAMES = TIER_WORDS
DRAWN = ("circle", "aabb", "obb", "capsule", "hull")
LIARS = ("circle", "aabb", "obb")  # tiers that the bot catches
TABLE_X, TABLE_Y, ROW_HEIGHT = 324, 42, 22
HEADS = ("wrong", "missed", "hit", "miss")
COLUMNS = (376, 408, 442, 474)  # right ends of the figures
NOTE_Y = 246
BOT_PATH = ((124, 166), (60, 215), (60, 90), (150, 84), (190, 120), (150, 216), (124, 166))
BOT_LEG = 50  # steps per leg of the bot's path


class Masks(Scene):
    """Scene with one world per collision tier (kind of collision shape), each with the same two aircraft sprites."""

    name = "lab/masks"
    title = "Masks"
    question = FAIR
    about = "Drag and turn two planes: nine tiers, from circle to exact pixels, give their verdicts side by side."
    effects = Effects()  # there is no response; depths are those of collide()
    pieces = ("masks", "boxes", "circles", "contacts")
    features = (
        "pixel masks by bitwise AND, as drawn, and exactly, at any angle",
        "eight simpler shapes beside them",
        "how often each verdict is wrong, and what it costs",
    )
    actions = (
        ("mouse", "drag"),
        ("wheel", "turn"),
        ("arrows", "move"),
        ("Shift+arrows", "turn"),
        ("Space", "other plane"),
    )
    overlays = ("masks", "contacts")
    head = HEAD
    legend_at = (4, 246)
    hides_pointer = False

    def build(self):
        """Build one world for each collision tier (kind of collision shape), with both sprites in each."""
        atlas = load_atlas("planes")
        self.masks = [atlas.mask(name) for name in SPRITES]
        self.planes = [RotatedSprites(atlas[name], mask) for name, mask in zip(SPRITES, self.masks, strict=True)]
        self.sky = load_backdrop("sky_dusk")
        self.hands = Hands(START, 0, ARENA.inflate(-2 * MARGIN, -2 * MARGIN))
        self.shown: dict[str, World] = {tier: self._world(tier) for tier in TIERS}
        self.verdicts: dict[str, bool] = dict.fromkeys(TIERS, False)
        self.lies: dict[str, int] = dict.fromkeys(TIERS, 0)  # steps with a hit of the tier but not of the pixels
        self.wrong = self.steps = self.apart = self.hits = 0

    def measured(self):
        """Return the SpriteRequest that measures the two sprites against each other at every collision tier."""
        return SpriteRequest(self.masks[0], self.masks[1])

    def _world(self, tier):
        world = self.add_world()
        for mask in self.masks:
            world.add_body(mask, kind="kinematic", tier=tier)
        return world

    def update(self, inputs):
        """Move the two sprites by the input, copy their poses into every world, step the worlds, and record each
        tier's verdict.
        """
        if inputs.pointer_pressed and ARENA.collidepoint(inputs.pointer):
            self._press(*inputs.pointer)
        self.hands.move(inputs)
        for world in self.shown.values():
            for which, (x, y, angle) in enumerate(self.hands.poses):
                bodies = world.bodies
                bodies["x"][which], bodies["y"][which], bodies["angle"][which] = x, y, angle
            world.step()
        self._judge()

    def _press(self, x, y):
        near = [hypot(x - px, y - py) for px, py, _ in self.hands.poses]
        which = int(near[1] < near[0])
        if near[which] < self.masks[which].reach(0.0, 0.0):
            self.hands.take(which, x, y)

    def _judge(self):
        self.steps += 1
        for tier, world in self.shown.items():
            self.verdicts[tier] = len(world.contacts) > 0
        truth = self.verdicts["pixels"]
        self.wrong += truth != share_a_pixel(self.masks, self.hands.poses)
        for tier in TIERS:
            self.lies[tier] += self.verdicts[tier] and not truth
        self.hits += truth
        self.apart += not any(self.verdicts.values())

    def views(self):
        """Return [(world, camera)] for the overlays: the world with the exact pixels."""
        return [(self.shown["pixels"], self.camera)]

    def draw(self, canvas, alpha):
        """Draw the sky, the two aircraft sprites, and a table with the verdict of each collision tier.

        alpha: position (0..1) between the last two steps.
        """
        canvas.surface.blit(self.sky, (0, 0))
        for plane, (x, y, angle) in zip(self.planes, self.hands.poses, strict=True):
            plane.draw(canvas, self.camera, x, y, angle)
        canvas.surface.fill(INK, (ARENA.right, 0, 480 - ARENA.right, 270))
        canvas.text("of hits", COLUMNS[0], TABLE_Y - 20, FOG, SMALL, align="right")
        canvas.text("of true", COLUMNS[1], TABLE_Y - 20, FOG, SMALL, align="right")
        canvas.text("one test [ns]", COLUMNS[3], TABLE_Y - 20, FOG, SMALL, align="right")
        for name, right in zip(HEADS, COLUMNS, strict=True):
            canvas.text(name, right, TABLE_Y - 12, FOG, SMALL, align="right")
        for row, tier in enumerate(TIERS):
            self._draw_row(canvas, tier, TABLE_Y + row * ROW_HEIGHT)
        for number, line in enumerate(self._notes()):
            canvas.text(line, TABLE_X, NOTE_Y + number * 8, FOG, SMALL)

    def _draw_row(self, canvas, tier, y):
        verdict, color = self.verdicts[tier], COLORS[tier]
        lies = verdict and not self.verdicts["pixels"]
        box = pygame.Rect(TABLE_X - 4, y - 3, 480 - TABLE_X, ROW_HEIGHT - 2)
        canvas.surface.fill(faded(SLATE, 0.8), box)
        canvas.fix(box)
        canvas.surface.fill(color, (box.x, box.y, 3 if verdict else 1, box.height))
        canvas.text(NAMES.get(tier, tier), TABLE_X + 2, y - 1, PAPER)
        word = "FALSE HIT" if lies else "HIT" if verdict else "no"
        canvas.text(word, 474, y, GOLD if lies else PAPER, SMALL, align="right")
        figures = self.figures.get(tier)
        if figures is None:
            canvas.text("measuring", 474, y + 9, PAPER, SMALL, align="right")
            return
        texts = (
            f"{100 * figures.wrong.share:.1f} %",
            f"{100 * figures.missed.share:.1f} %",
            f"{1e9 * figures.hit.median:,.0f}",
            f"{1e9 * figures.miss.median:,.0f}",
        )
        for text, right in zip(texts, COLUMNS, strict=True):
            canvas.text(text, right, y + 9, PAPER, SMALL, align="right")

    def _notes(self):
        """Return two texts: the overlap of the two sprites (pixels, depth), and the numbers of measured poses and
        runs.
        """
        poses = [tuple(pose) for pose in self.hands.poses]
        found = collide(self.masks[0], poses[0], self.masks[1], poses[1])
        depth = max(0.0, -min(found.separations.tolist(), default=0.0))
        shared = f"{int(found.area)} pixels shared, {depth:.1f} px deep" if len(found) else "no pixel is shared"
        figures = self.figures.get("mask")
        if figures is None:
            return shared, "poses are being tested beside the game"
        hits = figures.missed.total
        return shared, f"{hits:,} hits, {POSES - hits:,} misses, {figures.hit.runs} runs"

    def draw_on_frame(self, frame):
        """Draw the outlines of the simple collision shapes as thin lines. A shape that reports a hit is bright."""
        lens = frame.lens(self.camera)
        frame.surface.set_clip(frame.from_canvas(ARENA))
        width = max(1, frame.scale - 1)
        for tier in DRAWN:
            color = COLORS[tier] if self.verdicts[tier] else faded(COLORS[tier], 0.45)
            for outline in debug.outlines(self.shown[tier]):
                draw_outline(frame.surface, lens, outline, color, width, frame.scale)
        frame.surface.set_clip(None)

    def check(self):
        """Return the scene's goals, a list of Goal.

        The verdict of the pixels is right in every step. Circle, box and turned box report a false hit at least once.
        """
        return [
            Goal(
                "the pixel verdict equals a slow count",
                60,
                self.steps > 0 and self.wrong == 0,
                f"{self.wrong} of {self.steps} steps differ",
            ),
            Goal(
                "planes so far apart that no shape says hit", 240, self.apart > 0, f"{self.apart} steps", self.apart > 0
            ),
            Goal("planes seen sharing a pixel", 240, self.hits > 0, f"{self.hits} steps", self.hits > 0),
            *(
                Goal(
                    f"the {NAMES.get(tier, tier)} says hit where no pixel is shared",
                    300,
                    self.lies[tier] > 0,
                    f"{self.lies[tier]} steps",
                )
                for tier in LIARS
            ),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        wrong = sum(hit and not self.verdicts["pixels"] for hit in self.verdicts.values())
        sentence = "No pixel is shared, yet simple shapes report a hit."
        unit, number = "shapes report a false hit", f"{wrong} of {len(TIERS)}"
        headline = Headline(sentence, "right: move", number, unit, self.steps, 1, "steps", not wrong)
        return headline.asks("Does any shape report a hit where no pixel is shared?")

    def finding(self):
        """Return a sentence with the share of the box's hits that are false, and two times of a test that hits.

        The times are those of the box and of the exact pixels.
        """
        box, exact = self.figures.get("aabb"), self.figures.get("mask")
        if box is None or exact is None:
            return f"not yet: {POSES:,} poses of the two planes have to be tested beside the game"
        wrong, times = 100 * box.wrong.share, [1e9 * each.hit.median for each in (box, exact)]
        return f"{wrong:.1f} % of the box's hits are none; it takes {times[0]:,.0f} ns a hit, the exact {times[1]:,.0f}"

    def bot(self):
        """Return the bot's input for the next step.

        The bot drags the first sprite around and over the second, and turns it.
        """
        leg, step = divmod(self.frame, BOT_LEG)
        (ax, ay), (bx, by) = BOT_PATH[leg % len(BOT_PATH)], BOT_PATH[(leg + 1) % len(BOT_PATH)]
        share = step / BOT_LEG
        pointer = (round(ax + (bx - ax) * share), round(ay + (by - ay) * share))
        return InputFrame(frozenset(), pointer, self.frame > 0, 1 if self.frame % 10 == 0 else 0)

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the poses and counts."""
        poses = [value for pose in self.hands.poses for value in pose]
        return (self.frame, *poses, self.hands.chosen, self.wrong, self.hits, self.apart, *self.lies.values())


def share_a_pixel(masks, poses):
    """Return whether two masks, at two poses (x, y, angle) [px, rad], share a solid pixel.

    This is the slow reference: it puts both masks on one pixel grid, and searches for a pixel that is solid in both.
    """
    boxes = []
    for mask, (x, y, angle) in zip(masks, poses, strict=True):
        turned = mask.turned(angle)
        left, top = (int(np.floor(v - o + 0.5)) for v, o in zip((x, y), turned.origin, strict=True))
        boxes.append((turned.solid, left, top))
    (a, ax, ay), (b, bx, by) = boxes
    left, top = max(ax, bx), max(ay, by)
    right, bottom = min(ax + a.shape[1], bx + b.shape[1]), min(ay + a.shape[0], by + b.shape[0])
    if left >= right or top >= bottom:
        return False
    part_a = a[top - ay : bottom - ay, left - ax : right - ax]
    part_b = b[top - by : bottom - by, left - bx : right - bx]
    return bool((part_a & part_b).any())
