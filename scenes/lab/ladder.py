"""The accuracy ladder: one sprite at every collision tier, from a circle to its pixels. What does each cost?

In short: red is covered but not drawn, blue is drawn but not covered. Closer shapes take more bytes.

What to see: red pixels are covered by the shape only, blue ones by the sprite only. Down the ladder, the shapes lie
closer to the pixels, and take more bytes and more time to build. The time of a test goes up, and down again at the
pixels.

Why it matters: A sprite's collision shape decides how fair a game is, and how long a frame takes.

To try: take another sprite with left and right or the wheel, or drop a picture of your own (PNG) on the window.

Source: Jaccard 1901 (IoU), Hausdorff 1914; fits: Welzl 1991, Freeman and Shapira 1975, O'Rourke 1981.
"""

from functools import cache
from math import ceil

import numpy as np
import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import BLUE, FOG, NIGHT, PAPER, RED, SLATE
from game.drawing.headline import Headline
from game.drawing.number_text import tier_name
from game.drawing.sprites import load_atlas
from game.errors import FileError
from game.files.pictures import png_size
from game.input.inputs import InputFrame
from game.measurement_requests import SpriteRequest
from game.overlays.outlines import draw_outline
from game.scene import FAIR, Goal, Scene, Slider
from physics import TIERS, Effects, PixelMask, debug, fit
from scenes.lab.coverage import covered
from scenes.lab.yard import HEAD

SPRITES = (
    ("gunship", "planes", "gunship_0"),
    ("player", "planes", "player"),
    ("saucer", "planes", "saucer_0"),
    ("boss", "planes", "boss_a_0"),
    ("large plane", "planes", "large_plane_a"),
    ("hero", "hero", "run_1"),
    ("walker", "things", "walker_0"),
    ("hedgehog", "things", "hedgehog_0"),
    ("lander", "lander", "ship"),
    ("rock", "lander", "rock_1"),
    ("crate", "lab", "crate_24_0"),
)
NAMES = {"aabb": "box", "obb": "turned box", "pixels": "pixels, as drawn", "mask": "pixels, exactly"}
IN_FINDING = ("aabb", "hull", "outline")  # tiers in the finding
HOLDING = ("circle", "aabb", "obb", "capsule", "hull")  # tiers that contain all pixels of a sprite
COLUMNS = 3
CELL = (160, 80)
LINE = 7  # [px] from one figure to the next
ROOM = 12  # letters of a figure beside a name of nine
VIEW = 70  # [px] width and height of a sprite's cell
MOST = 256  # [px] greatest width and height of the player's picture
BOT_LOOKS = 20  # steps at each sprite
LIT = {"px too many": RED, "px left out": BLUE}  # colours of the marked pixels
ALLOWED = 0.01  # empty share of a shape that counts as none
MIX = 0.6  # of red and blue over the picture


class Ladder(Scene):
    """Scene that shows one sprite at every collision tier (kind of collision shape).

    Each tier has its own world and its own cell of the picture.
    """

    name = "lab/ladder"
    title = "Ladder"
    question = FAIR
    about = "One sprite at nine tiers, from circle to exact pixels: what each covers wrongly, weighs and costs."
    effects = Effects(narrowphase=False)  # a sprite alone in its world has no contacts
    pieces = ("masks", "boxes", "circles", "contacts")
    features = (
        "eleven sprites, or a PNG of one's own",
        "over-covered and missed pixels lit",
        "IoU, Hausdorff distance, centre, inertia, bytes, times to make and to test",
    )
    sliders = (Slider("shape", 0, len(TIERS) - 1, TIERS.index("aabb"), choices=tuple(map(tier_name, TIERS))),)
    actions = (("left right wheel", "another sprite"), ("up down", "shape"))
    head = HEAD
    hides_pointer = False
    takes_level = True
    level_suffix = ".png"

    def build(self):
        """Show the first sprite: the player's own picture file if there is one, otherwise the first sprite of the
        game.
        """
        self.choices = [self.level_file.name] if self.level_file is not None else []
        self.choices += [name for name, _, _ in SPRITES]
        self.seen: dict[str, dict[str, tuple[int, int]]] = {}  # {sprite: {tier: pixels too many, left out}}
        for tier in TIERS:  # a large sprite is cut into tiles, whose kernels are compiled before the start
            fit(load_atlas("planes").mask("boss_a_0"), tier)
        self._show(0)

    def _show(self, choice):
        """Show sprite number `choice`: make a world for each collision tier, with the sprite in it."""
        self.choice, self.worlds = choice, []
        self.image, self.mask = self._sprite()
        self.shapes = {tier: fit(self.mask, tier) for tier in TIERS}
        worlds = {tier: self._world(tier) for tier in TIERS}
        boxes = np.array([next(iter(world)).bounds or (0.0,) * 4 for world in worlds.values()])
        low, high = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
        self.middle = tuple((low + high) / 2)
        self.reach = ceil((high - low).max() / 2 + 1.0)
        self.cells, self.counts = {}, {}
        for number, (tier, world) in enumerate(worlds.items()):
            x, y = number % COLUMNS * CELL[0], HEAD + number // COLUMNS * CELL[1]
            zoom = VIEW / (2 * self.reach)
            view = pygame.Rect(x + 4, y + (CELL[1] - VIEW) // 2, VIEW, VIEW)
            camera = Camera(view, zoom, x=self.middle[0] - self.reach, y=self.middle[1] - self.reach)
            self.cells[tier] = (world, camera, view)
        self.pictures = {tier: self._lit(tier) for tier in TIERS}
        self.seen[self.sprite_name] = self.counts

    def _world(self, tier):
        world = self.add_world()
        world.add_body(self.mask, kind="static", tier=tier)
        return world

    @property
    def sprite_name(self):
        """Name of the sprite."""
        return self.choices[self.choice]

    def _sprite(self):
        own = len(self.choices) - len(SPRITES)
        if self.choice < own:
            return own_picture(self.level_file)
        _, atlas, name = SPRITES[self.choice - own]
        return load_atlas(atlas)[name], load_atlas(atlas).mask(name)

    def _lit(self, tier):
        """Return (picture, (x, y)): the sprite with the errors of a tier, and the picture's upper left corner in body
        space [px].

        Surplus pixels are red, missing pixels are blue. Both numbers are stored in `counts`.
        """
        size, (ox, oy) = 2 * self.reach, self.mask.origin
        left, top = np.floor(self.middle[0] - self.reach), np.floor(self.middle[1] - self.reach)
        column, row = np.meshgrid(np.arange(size), np.arange(size))
        # Centres of the sprite's own pixels, in body space.
        shift_x, shift_y = -ox - np.floor(-ox), -oy - np.floor(-oy)
        x, y = left + column + shift_x + 0.5, top + row + shift_y + 0.5
        says, is_so = covered(self.shapes[tier], x, y), covered((self.mask,), x, y)
        over, missed = says & ~is_so, is_so & ~says
        self.counts[tier] = int(over.sum()), int(missed.sum())
        picture = pygame.Surface((size, size))
        picture.fill(NIGHT)
        picture.blit(self.image, (round(-ox - left - shift_x), round(-oy - top - shift_y)))
        pixels = pygame.surfarray.pixels3d(picture)
        for chosen, color in ((over, RED), (missed, BLUE)):
            pixels[chosen.T] = (1.0 - MIX) * pixels[chosen.T] + MIX * np.array(color)
        del pixels
        return picture, (left + shift_x, top + shift_y)

    def measured(self):
        """Return the SpriteRequest that measures the sprite against itself at every collision tier."""
        return SpriteRequest(self.mask, self.mask)

    def update(self, inputs):
        """Show the previous or next sprite if left, right or the wheel asks for it, then step all worlds."""
        way = inputs.pressed("right") - inputs.pressed("left") + inputs.wheel
        if way:
            self._show((self.choice + way) % len(self.choices))
        turn = inputs.pressed("down") - inputs.pressed("up")
        if turn:
            self.change_slider("shape", (self.values["shape"] + turn) % len(TIERS))
        for world in self.worlds:
            world.step()

    def views(self):
        """Return a list of (world, camera), one for each collision tier. Each world is drawn in its own cell."""
        return [(world, camera) for world, camera, _ in self.cells.values()]

    def draw(self, canvas, alpha):
        """Draw the names and figures of all cells. draw_on_frame() draws the pictures at window resolution.

        alpha: position (0..1) between the last two steps.
        """
        for number, tier in enumerate(TIERS):
            x, y = number % COLUMNS * CELL[0], HEAD + number // COLUMNS * CELL[1]
            canvas.surface.fill(NIGHT, (x + 1, y + 1, CELL[0] - 2, CELL[1] - 2))
            canvas.reserve(self.cells[tier][2])
            self._draw_figures(canvas, tier, x + VIEW + 8, y + 4)

    def _draw_figures(self, canvas, tier, x, y):
        canvas.text(NAMES.get(tier, tier), x, y, PAPER, SMALL)
        over, missed = self.counts[tier]
        lines = [("px too many", f"{over:,}"), ("px left out", f"{missed:,}")]
        figures = self.figures.get(tier)
        if figures is not None:
            found = figures.fit
            lines += [
                ("shared (IoU)", f"{100 * found.iou:.1f} %"),
                ("Hausdorff", f"{found.hausdorff:.1f} px"),
                ("centre off", f"{found.center_error:.2f} px"),
                ("inertia off", f"{100 * found.inertia_error:.1f} %"),
                ("bytes", f"{found.bytes:,}"),
                ("made in", f"{1e3 * figures.build.median:.2f} ms"),
                ("hit, miss", _times(figures.hit.median, figures.miss.median)),
            ]
        else:
            canvas.text("measuring the rest", x, y + 8 + LINE * len(lines), FOG, SMALL)
        for number, (name, value) in enumerate(lines):
            top = y + 8 + LINE * number
            canvas.text(name, x, top, LIT.get(name, FOG), SMALL)
            canvas.text(value, x + 78, top, PAPER, SMALL, align="right")

    def draw_on_frame(self, frame):
        """Draw the sprite with its marked errors in every cell, and the outline of the collision shape as
        a thin line.
        """
        for tier, (world, camera, view) in self.cells.items():
            rect, lens = frame.from_canvas(view), frame.lens(camera)
            frame.surface.set_clip(rect)
            picture, (left, top) = self.pictures[tier]
            size = ceil(picture.get_width() * lens.scale)
            at = lens.points(left, top)
            frame.surface.blit(pygame.transform.scale(picture, (size, size)), (round(at[0]), round(at[1])))
            if tier not in ("pixels", "mask"):
                for outline in debug.outlines(world):
                    draw_outline(frame.surface, lens, outline, PAPER, 1, frame.scale)
            frame.surface.set_clip(None)
            pygame.draw.rect(frame.surface, SLATE, rect, 1)

    def check(self):
        """Return the scene's goals, a list of Goal.

        Shapes that should contain the sprite leave no pixel out. Shapes made of the pixels have no errors. The outline
        is closer than the hull, and the hull closer than the box.
        """
        held = [tier for counts in self.seen.values() for tier in HOLDING if counts[tier][1]]
        exact = [tier for counts in self.seen.values() for tier in ("pixels", "mask") if any(counts[tier])]
        closer = all(
            sum(counts["outline"]) <= sum(counts["hull"]) <= sum(counts["aabb"]) for counts in self.seen.values()
        )
        return [
            Goal(
                "every sprite was looked at",
                BOT_LOOKS * len(SPRITES),
                len(self.seen) >= len(SPRITES),
                f"{len(self.seen)}",
            ),
            Goal("circle, boxes, capsule and hull leave no pixel out", 1, not held, ", ".join(held)),
            Goal("pixels stand for themselves", 1, not exact, ", ".join(exact)),
            Goal("the outline is closer than the hull, the hull than the box", 1, closer),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        tier = TIERS[int(self.values["shape"])]
        empty, name = self.counts[tier][0] / (self.mask.area + self._balance(tier)), tier_name(tier)
        sentence = f"By its {name}, the {self.sprite_name} is hit where nothing is drawn: red."
        number, unit = f"{100 * empty:.0f} %", f"of its {name} is empty"
        headline = Headline(sentence, "down: next shape", number, unit, 1, 1, "sprites", empty < ALLOWED)
        return headline.asks(f"By its {name}, is the {self.sprite_name} hit where nothing is drawn?")

    def finding(self):
        """Return a sentence on the sprite's box, hull and outline: how much of each is empty, and the time of a hit."""
        empty = [100 * self.counts[tier][0] / (self.mask.area + self._balance(tier)) for tier in IN_FINDING]
        names = [NAMES.get(tier, tier) for tier in IN_FINDING]
        shares = ", ".join(f"{share:.0f} % of its {name}" for name, share in zip(names, empty, strict=True))
        sentence = f"{self.sprite_name}: {shares} is empty"
        if not all(tier in self.figures for tier in IN_FINDING):
            return sentence
        times = ", ".join(f"{1e9 * self.figures[tier].hit.median:,.0f}" for tier in IN_FINDING)
        return f"{sentence}; a hit takes {times} ns"

    def _balance(self, tier):
        """Return the number of pixels that a collision tier covers in excess, minus the number that it leaves out."""
        over, missed = self.counts[tier]
        return over - missed

    def bot(self):
        """Return the bot's input for the next step. The bot shows one sprite after the other."""
        return InputFrame(frozenset({"right"}) if self.frame % BOT_LOOKS == BOT_LOOKS - 1 else frozenset())

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the sprite and its counts."""
        counts = (count for pair in self.counts.values() for count in pair)
        return (self.frame, self.choice, *self.values.values(), *counts)


def _times(hit, miss):
    """Return the times of a hit and of a miss [s] as text, both in the same unit."""
    sentence = f"{1e9 * hit:,.0f}, {1e9 * miss:,.0f} ns"
    return sentence if len(sentence) <= ROOM else f"{1e6 * hit:.3g}, {1e6 * miss:.2f} us"


@cache
def own_picture(path):
    """Return (image, mask) of a PNG file, a Surface and a PixelMask.

    Raises FileError if the file is not a PNG, has a side longer than MOST, or has no solid pixels.
    """
    png_size(path, MOST)  # checked before it is decoded
    try:
        image = pygame.image.load(path)
    except (pygame.error, OSError) as error:
        raise FileError(path, "picture", f"is no picture that can be read ({error})") from error
    image = image.convert_alpha()
    mask = PixelMask.from_surface(image)
    if not mask.area:
        raise FileError(path, "picture", "has no solid pixel: none with more than half of its alpha")
    return image, mask
