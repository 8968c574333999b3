"""Two planes, four verdicts: circle, box, turned box and pixels. Which of them lie, and what does the truth cost?

What to see: drag one plane along the other. The three cheap shapes say HIT while there is sky between the
planes; the pixels say HIT when a pixel is shared. Beside each verdict stands what the test took.
"""

from math import hypot

import numpy as np
import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GOLD, GREEN, INK, ORANGE, PAPER, RED, SKY, SLATE, YELLOW, faded
from game.drawing.sprites import RotatedSprites, load_atlas, load_backdrop
from game.drawing.typical import Typical
from game.input.inputs import InputFrame
from game.scene import Goal, Scene
from physics import Effects, collide, debug
from scenes.lab.hands import Hands
from scenes.lab.yard import HEAD

SPRITES = ("large_plane_a", "large_plane_b")
ARENA = pygame.Rect(0, 16, 316, 254)
START = ((90.0, 150.0, 0.0), (226.0, 150.0, 0.6))
MARGIN = 20  # [px] that a plane's middle keeps from the arena's edge
COPIES = 24  # pairs off screen per tier: one pair alone would measure the call, not the test
SPREAD = 1000.0  # [px] between copies: far beyond the reach of a plane
COLORS = {"circle": ORANGE, "aabb": GREEN, "obb": SKY, "pixels": YELLOW}
NAMES = {"circle": "circle", "aabb": "box", "obb": "turned box", "pixels": "pixels"}
ROWS = ("circle", "aabb", "obb", "pixels")
TABLE_X, TABLE_Y, ROW_HEIGHT, BAR_WIDTH = 324, 34, 40, 148
WORDS = ("Drag a plane, turn it with the wheel.", "Cheap shapes say hit where sky", "is all that meets.")
WORDS_Y = 240
BOT_PATH = ((90, 150), (90, 60), (150, 84), (226, 150), (150, 216), (90, 150))
BOT_LEG = 50  # steps per leg of the bot's path


class Masks(Scene):
    """One world per tier with the two planes in it, and one per tier with copies, for the clock."""

    name = "lab/masks"
    title = "Masks"
    about = "Drag and turn two planes: circle, box, turned box and pixels give their verdicts side by side."
    effects = Effects()  # who meets whom; nobody is pushed, and how deep they are is asked of collide()
    pieces = ("masks", "boxes", "circles", "contacts")
    features = (
        "pixel masks by bitwise AND, as drawn, at any angle",
        "bounds, circle and turned box beside them",
        "what each verdict costs",
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
    legend_at = (324, 196)
    hides_pointer = False

    def build(self):
        """Eight worlds: four to look at, four to time."""
        atlas = load_atlas("planes")
        self.masks = [atlas.mask(name) for name in SPRITES]
        self.sprites = [RotatedSprites(atlas[name], mask) for name, mask in zip(SPRITES, self.masks, strict=True)]
        self.sky = load_backdrop("sky_dusk")
        self.hands = Hands(START, 0, ARENA.inflate(-2 * MARGIN, -2 * MARGIN))
        self.shown, self.timed = {}, {}
        for tier in ROWS:
            self.shown[tier] = self._world(tier, 1)
            self.timed[tier] = self._world(tier, COPIES)
        self.cost = {tier: Typical() for tier in ROWS}  # [us] of one test
        self.verdicts = dict.fromkeys(ROWS, False)
        self.lies = dict.fromkeys(ROWS, 0)  # steps in which a tier said hit and the pixels did not
        self.wrong = self.steps = self.apart = self.hits = 0

    def _world(self, tier, pairs):
        world = self.add_world()
        for _ in range(pairs):
            for mask in self.masks:
                world.add_body(mask, kind="kinematic", tier=tier)
        return world

    def update(self, inputs):
        """Move the planes, put them into every world, and ask all four tiers."""
        if inputs.pointer_pressed and ARENA.collidepoint(inputs.pointer):
            self._press(*inputs.pointer)
        self.hands.move(inputs)
        for worlds, pairs in ((self.shown, 1), (self.timed, COPIES)):
            for world in worlds.values():
                self._place(world, pairs)
                world.step()
        self._judge()

    def _press(self, x, y):
        near = [hypot(x - px, y - py) for px, py, _ in self.hands.poses]
        which = int(near[1] < near[0])
        if near[which] < reach(self.masks[which]):
            self.hands.take(which, x, y)

    def _place(self, world, pairs):
        bodies = world.bodies
        shift = np.arange(pairs) * SPREAD
        for which, (x, y, angle) in enumerate(self.hands.poses):
            bodies["x"][which::2] = x + shift
            bodies["y"][which::2] = y
            bodies["angle"][which::2] = angle

    def _judge(self):
        self.steps += 1
        for tier, world in self.shown.items():
            self.verdicts[tier] = len(world.contacts) > 0
        truth = self.verdicts["pixels"]
        self.wrong += truth != share_a_pixel(self.masks, self.hands.poses)
        for tier in ROWS:
            self.lies[tier] += self.verdicts[tier] and not truth
        self.hits += truth
        self.apart += not any(self.verdicts.values())

    def observe(self):
        """The clock: one pair's share of what the copies took."""
        for tier, world in self.timed.items():
            self.cost[tier].note(world.profile.stages["narrow_phase"] / COPIES * 1e6)

    def views(self):
        """The overlays show the world of the pixels."""
        return [(self.shown["pixels"], self.camera)]

    def draw(self, canvas, alpha):
        """The sky, the planes, and the table of verdicts."""
        canvas.surface.blit(self.sky, (0, 0))
        for sprite, (x, y, angle) in zip(self.sprites, self.hands.poses, strict=True):
            sprite.draw(canvas, self.camera, x, y, angle)
        canvas.surface.fill(INK, (ARENA.right, 0, 480 - ARENA.right, 270))
        canvas.surface.fill(INK, (0, 0, 480, ARENA.top))
        canvas.text("MASKS", 4, 4, GOLD)
        canvas.text("four verdicts on the same two planes", ARENA.right - 4, 6, FOG, SMALL, align="right")
        canvas.text("verdict", TABLE_X, TABLE_Y - 14, FOG, SMALL)
        canvas.text("one test", 474, TABLE_Y - 14, FOG, SMALL, align="right")
        for row, tier in enumerate(ROWS):
            self._draw_row(canvas, tier, TABLE_Y + row * ROW_HEIGHT)
        for number, line in enumerate(WORDS):
            canvas.text(line, TABLE_X, WORDS_Y + number * 8, FOG, SMALL)

    def _draw_row(self, canvas, tier, y):
        verdict, color = self.verdicts[tier], COLORS[tier]
        box = pygame.Rect(TABLE_X - 4, y - 4, 480 - TABLE_X, ROW_HEIGHT - 4)
        canvas.surface.fill(faded(color, 0.75) if verdict else faded(SLATE, 0.8), box)
        canvas.fix(box)
        canvas.surface.fill(color, (box.x, box.y, 2, box.height))
        canvas.text(NAMES[tier], TABLE_X + 2, y, color)
        canvas.text(
            "HIT" if verdict else "no", TABLE_X + 96, y, RED if verdict else FOG, align="center", outline=verdict
        )
        cost, dearest = self.cost[tier].value, max(each.value for each in self.cost.values()) or 1.0
        canvas.text(f"{cost:.2f} us" if cost < 100 else f"{cost:,.0f} us", 474, y, PAPER, align="right")
        canvas.text(self._remark(tier), TABLE_X + 2, y + 13, PAPER, SMALL)
        canvas.surface.fill(INK, (TABLE_X + 2, y + 24, BAR_WIDTH, 3))
        canvas.surface.fill(color, (TABLE_X + 2, y + 24, max(1, round(BAR_WIDTH * cost / dearest)), 3))

    def _remark(self, tier):
        if not self.verdicts[tier]:
            return "apart"
        if tier == "pixels":
            found = collide(self.masks[0], tuple(self.hands.poses[0]), self.masks[1], tuple(self.hands.poses[1]))
            depth = max(0.0, -min(found.separations.tolist(), default=0.0))
            return f"{int(found.area)} pixels shared, {depth:.1f} px deep"
        depth = max(0.0, -float(self.shown[tier].contacts["separation"].min()))
        says = "and so do the pixels" if self.verdicts["pixels"] else "but no pixel is shared"
        return f"{depth:.0f} px deep, {says}"

    def draw_on_frame(self, frame):
        """The three simple shapes as thin lines: bright where they say hit."""
        lens = frame.lens(self.camera)
        frame.surface.set_clip(frame.from_canvas(ARENA))
        width = max(1, frame.scale - 1)
        for tier in ("circle", "aabb", "obb"):
            color = COLORS[tier] if self.verdicts[tier] else faded(COLORS[tier], 0.45)
            for outline in debug.outlines(self.shown[tier]):
                self._draw_outline(frame.surface, lens, outline, color, width)
        frame.surface.set_clip(None)

    def _draw_outline(self, surface, lens, outline, color, width):
        if outline[0] == "circle":
            _, x, y, radius = outline
            pygame.draw.circle(surface, color, lens.points(x, y), radius * lens.scale, width)
        elif outline[0] == "polygon":
            x, y = lens.points(outline[1][:, 0], outline[1][:, 1])
            pygame.draw.lines(surface, color, True, np.column_stack((x, y)).tolist(), width)

    def check(self):
        """The pixels are right in every step, and each cheap shape was caught lying."""
        return [
            Goal(
                "the pixel verdict equals a slow count",
                60,
                self.steps > 0 and self.wrong == 0,
                f"{self.wrong} of {self.steps} steps differ",
            ),
            Goal("planes seen apart", 240, self.apart > 0, f"{self.apart} steps"),
            Goal("planes seen hitting", 240, self.hits > 0, f"{self.hits} steps"),
            *(
                Goal(
                    f"the {NAMES[tier]} says hit where no pixel is shared",
                    300,
                    self.lies[tier] > 0,
                    f"{self.lies[tier]} steps",
                )
                for tier in ("circle", "aabb", "obb")
            ),
        ]

    def bot(self):
        """Drag the first plane around and over the second, turning it now and then."""
        leg, step = divmod(self.frame, BOT_LEG)
        (ax, ay), (bx, by) = BOT_PATH[leg % len(BOT_PATH)], BOT_PATH[(leg + 1) % len(BOT_PATH)]
        share = step / BOT_LEG
        pointer = (round(ax + (bx - ax) * share), round(ay + (by - ay) * share))
        return InputFrame(frozenset(), pointer, self.frame > 0, 1 if self.frame % 10 == 0 else 0)

    def state(self):
        """The poses and the tallies."""
        poses = [value for pose in self.hands.poses for value in pose]
        return (self.frame, *poses, self.hands.chosen, self.wrong, self.hits, self.apart, *self.lies.values())


def reach(mask):
    """The farthest solid corner from the mask's origin [px]."""
    left, top, right, bottom = mask.bounds
    return max(hypot(x, y) for x in (left, right) for y in (top, bottom))


def share_a_pixel(masks, poses):
    """The slow truth: lay both turned pictures on one pixel grid and look for a pixel that is solid in both."""
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
