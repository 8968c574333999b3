"""The same sprites in five worlds, colliding by box, hull, parts, outline or every pixel: how well does each fit?

In short: boxes and hulls include air, so sprites hover. The outline fits within half a pixel, without bumps at its
seams.

What to see: boxes and hulls include the air beside a bracket or under an arm, so the drawn sprites hover. Separate
parts fit, but their inner edges cause bumps. The outline is within half a pixel, causes no bumps, and keeps round
sprites round. With the edge of every pixel, a disc has fifty corners to roll over. The cost is written under each pile.

Why it matters: The drawn shape and the colliding shape should agree, or sprites rest on visible air.

To try: throw the disc along each pile with the mouse, and see where it stops first.

Source: Rosenfeld and Kak, Digital Picture Processing, 1982; Hertel and Mehlhorn 1983 (parts).
"""

from math import isnan, nan

import numpy as np
import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GOLD, GREEN, ORANGE, PAPER, RED, SKY, YELLOW, faded
from game.drawing.headline import Headline
from game.drawing.rotated import Cast
from game.drawing.sprites import load_atlas
from game.input.inputs import InputFrame
from game.measurement_requests import MeasuredRun, RunRequest
from game.overlays.mask_edges import mask_edges
from game.overlays.outlines import draw_lines, draw_outline
from game.scene import STANDS, Goal, Scene, Slider
from physics import Effects, PixelMask, Polygon, debug, fit, measure
from physics.settings import SMOOTH
from physics.tables.shape import PART, WHOLE
from scenes.lab.costs import UNKNOWN, cost_text
from scenes.lab.piles import with_effects
from scenes.lab.yard import HEAD, Yard, plate

WAYS = ("box", "hull", "parts", "outline", "exact")
COLORS = {"box": RED, "hull": ORANGE, "parts": YELLOW, "outline": GREEN, "exact": SKY}
IN_FINDING = ("box", "outline", "exact")  # in the finding
PUSHED_AS_MASKS = ("outline", "exact")
SPRITES = {
    "crates": ("lab", "crate_24_0"),
    "brackets": ("lab", "bracket_teal"),
    "stars": ("lab", "star_gold"),
    "discs": ("lab", "disc_large"),
    "heroes": ("hero", "idle_0"),
}
CHOICES = ("mixed", *SPRITES)
WIDTH, VIEW_TOP, FLOOR = 96, 16, 190  # [px] of a column; [canvas px] top of a view and of its floor
TOWER, BESIDE, NOTCH = 28.0, 70.0, 33.0  # [px] middles of piles in a column, and of the bracket's notch
HIGH = 6.0  # [px] above a tower: start of the sprite that drops into the notch
NUDGE = 30.0  # [px/s]
WARM = 30  # steps after which sinking and swaying count
WINDOW = 60  # steps over which the sway is measured
EVERY = 4  # steps between two measurements of a sprite's fit
FITS_BY = 180  # steps after which all are measured
ALLOWED = 0.05  # air that the shapes hold, as a share of the sprites' pixels
WORDS = {"box": "boxes", "hull": "hulls", "outline": "outlines", "exact": "pixels"}
SLEPT_BY = 480
FALLEN = 8.0  # [px] sag of a pile's top that counts as a fall


class MaskStack(Scene):
    """Scene with one world per kind of collision shape (WAYS), with the same sprites on the same floor of pixels."""

    name = "lab/mask_stack"
    title = "Mask stack"
    question = STANDS
    about = (
        "The same sprites as box, hull, parts, outline and exact pixels: how they lie, sink, sway and what they cost."
    )
    effects = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True, sleeping=True)
    pieces = ("masks", "boxes", "circles")
    features = (
        "sprites pushed by their outlines, beside four other ways",
        "corners, pixels too many and too few",
        "sinking, swaying and sleep, live, and the cost of a step, measured beside the game",
    )
    sliders = (
        Slider("sprites", 0, len(CHOICES) - 1, 0, choices=CHOICES),
        Slider("high", 2, 5, 3),
        Slider("shape", 0, len(WAYS) - 1, 0, choices=WAYS),  # the one that the title line is about
    )
    lighter = {"high": 2, "substeps": 2}
    actions = (("X", "shape"), ("Space", "nudge"), ("left right", "sprites"), ("up down", "high"))
    draggable = True
    head = HEAD
    legend_at = (4, 20)

    def build(self):
        """Create the background and the cameras, then call fill() to create the five worlds."""
        self.fits = {}  # (sprite, way) -> (corners, pixels of air held, pixels missed)
        self.yard = Yard(270)
        self.cameras = [
            Camera((number * WIDTH, VIEW_TOP, WIDTH, FLOOR + 24 - VIEW_TOP), y=VIEW_TOP) for number in range(5)
        ]
        self.fill()

    def fill(self):
        """Replace the scene's worlds by five new ones with the same sprites, one for each kind of collision shape."""
        self.worlds, self.casts, self.tops = [], [], []
        self.laid = {way: [] for way in WAYS}  # (sprite, its mask, its collision shapes)
        self.since = 0
        self.nudged = 0
        self.starts = dict.fromkeys(WAYS, 0.0)  # first height of the top [px]
        self.sinks, self.sways = dict.fromkeys(WAYS, 0.0), dict.fromkeys(WAYS, 0.0)
        self.track = {way: [] for way in WAYS}
        self.asleep = dict.fromkeys(WAYS, False)
        self.changed = dict.fromkeys(WAYS, 0)  # step of the last change
        for way in WAYS:
            self._lay(way)

    def _lay(self, way):
        lab = load_atlas("lab")
        pictures = {"tray": lab["tray"]}
        world, cast = self.add_world(), Cast(pictures)
        floor = world.add_body(PixelMask.from_surface(lab["tray"]), position=(WIDTH / 2, FLOOR + 2.0), kind="static")
        for x in (-20.0, WIDTH + 18.0):  # keeps all sprites in their column
            world.add_body(Polygon.box(40, 2000), position=(x, 0.0), kind="static")
        cast.add(floor, "tray")
        top = None
        for kind, x, y in self._places():
            sheet, name = SPRITES[kind]
            pictures[name] = load_atlas(sheet)[name]
            mask, shapes = shapes_of(pictures[name], way)
            body = world.add_body(*(shapes if way not in PUSHED_AS_MASKS else (mask,)), position=(x, y))
            cast.add(body, name)
            self.laid[way].append((name, mask, shapes))
            if x == TOWER:
                top, self.starts[way] = body, y
        self.casts.append(cast)
        self.tops.append(top)

    def _places(self):
        """Return a list of (kind, x [px], y [px]), the starting position of each sprite.

        The bounding box of a sprite touches that of the sprite below it. The sprite that drops into the notch starts
        higher.
        """
        kinds = list(self._kinds())
        heights, found = {}, []
        for kind, x in kinds:
            sheet, name = SPRITES[kind]
            _, top, _, bottom = bounds_of(load_atlas(sheet).mask(name))
            below = heights[TOWER] - HIGH if x == NOTCH else heights.get(x, FLOOR + 0.0)
            found.append((kind, x, below - bottom))
            heights[x] = below - bottom + top
        return found

    def _kinds(self):
        """Return a tuple of (kind, x) for all sprites, from the bottom up. x: horizontal centre of the sprite's pile
        [px].
        """
        high, choice = int(self.values["high"]), CHOICES[int(self.values["sprites"])]
        if choice != "mixed":
            return ((choice, TOWER),) * high
        tower = (*(("crates", TOWER),) * (high - 1), ("brackets", TOWER), ("heroes", NOTCH))
        return (*tower, ("discs", BESIDE), ("stars", BESIDE))

    def change_slider(self, name, value):
        """Set the slider `name` to `value`, then build the piles again. The slider "shape" leaves them as they are."""
        super().change_slider(name, value)
        if name != "shape":
            self.fill()

    def update(self, inputs):
        """Process keys, step all worlds, and update the measurements."""
        for name, forth, back in (("sprites", "right", "left"), ("high", "up", "down")):
            way = inputs.pressed(forth) - inputs.pressed(back)
            if way:
                self.change_slider(name, self.values[name] + way)
        if inputs.pressed("fire"):
            self.nudged += 1
            self.play("hit", None, 0.5)
            for top in self.tops:
                top.wake()
                top.apply_impulse((NUDGE * top.mass, 0.0))
        if inputs.pressed("bomb"):
            self.change_slider("shape", (self.values["shape"] + 1) % len(WAYS))
        self.since += 1
        if self.since % EVERY == 0:
            self._measure_one_fit()
        for way, world, top in zip(WAYS, self.worlds, self.tops, strict=True):
            world.step()
            self._measure(way, world, top)

    def _measure_one_fit(self):
        """Measure how well the collision shapes of one sprite fit its pixels. It is the first sprite not yet measured.

        A call measures one sprite only, because all sprites together take seconds without numba.
        """
        for way in WAYS:
            for name, mask, shapes in self.laid[way]:
                if (name, way) not in self.fits:
                    fitted = measure(mask, shapes)
                    self.fits[name, way] = fitted.corners, fitted.over, fitted.missed
                    return

    def share(self, way):
        """Return (corners, air, missed), summed over the sprites of a pile; all nan until each sprite is measured.

        corners: number of corners; air: number of pixels that only the shapes cover; missed: number of pixels that
        only the sprite covers. way: kind of the pile's collision shapes, one of WAYS.
        """
        fits = [self.fits.get((name, way), (nan, nan, nan)) for name, _, _ in self.laid[way]]
        return tuple(float(sum(column)) for column in zip(*fits, strict=True))

    def _measure(self, way, world, top):
        x, y = top.position
        self.sinks[way] = y - self.starts[way]
        self.track[way] = [*self.track[way][-WINDOW + 1 :], x]
        self.sways[way] = max(self.track[way]) - min(self.track[way])
        bodies = world.bodies
        asleep = not bool(bodies["awake"][bodies["inverse_mass"] > 0.0].any())
        if asleep != self.asleep[way]:
            self.asleep[way], self.changed[way] = asleep, self.since

    def measured(self):
        """Return a RunRequest: one run for each pile, timed by the measuring process during the game.

        A run steps a pile in a world without sleeping, from the pile's current state. Return None in the first WARM
        steps.
        """
        if self.since < WARM:
            return None
        worlds = dict(zip(WAYS, self.worlds, strict=True))
        return RunRequest(
            [self._run_name(way) for way in WAYS],
            lambda name: MeasuredRun(
                [with_effects(worlds[name[-1]], self.effects.without("sleeping"))], self.broadphase
            ),
        )

    def _run_name(self, way):
        return *self.chosen, way

    def stands_now(self, way):
        """Return whether the top sprite of a pile is less than FALLEN px lower than at its start.

        way: kind of the pile's collision shapes, one of WAYS.
        """
        return self.sinks[way] < FALLEN

    @property
    def offer(self):
        """Text that offers the player a new run once all piles have fallen; "" otherwise."""
        return "" if any(self.stands_now(way) for way in WAYS) else "piles them up again"

    def views(self):
        """Return a list of (world, camera), one for the picture of each collision shape."""
        return list(zip(self.worlds, self.cameras, strict=True))

    def draw(self, canvas, alpha):
        """Draw the piles, and the figures of each pile below it. alpha: position (0..1) between the last two steps."""
        self.yard.draw(canvas)
        for number, (way, cast) in enumerate(zip(WAYS, self.casts, strict=True)):
            cast.draw(canvas, self.cameras[number], self.worlds[number], alpha)
            self._draw_figures(canvas, number, way)
        for number in range(1, 5):
            x = number * WIDTH - 1
            pygame.draw.line(canvas.surface, faded(PAPER, 0.75), (x, HEAD), (x, 269))

    def _draw_figures(self, canvas, number, way):
        box = pygame.Rect(number * WIDTH + 1, FLOOR + 14, WIDTH - 3, 270 - FLOOR - 15)
        plate(canvas, box)
        canvas.surface.fill(COLORS[way], (box.x, box.y, box.width, 2))
        canvas.text(way, box.x + 3, box.y + 5, COLORS[way])
        asleep, seconds = self.asleep[way], (self.since - self.changed[way]) / 60.0
        canvas.text(
            f"{'sleeps' if asleep else 'awake'} {seconds:.0f} s",
            *(box.right - 3, box.y + 7, GREEN if asleep else GOLD, SMALL),
            align="right",
        )
        corners, over, missed = self.share(way)
        rows = (
            ("corners", whole(corners)),
            ("air held", f"{whole(over)} px"),
            ("missed", f"{whole(missed)} px"),
            ("sinks", f"{self.sinks[way]:z.2f} px"),
            ("sways", f"{self.sways[way]:.2f} px"),
            ("step, awake", cost_text(self, self._run_name(way))),
        )
        for row, (word, value) in enumerate(rows):
            canvas.text(word, box.x + 3, box.y + 16 + row * 8, FOG, SMALL)
            canvas.text(value, box.right - 3, box.y + 16 + row * 8, PAPER, SMALL, align="right")

    def draw_on_frame(self, frame):
        """Draw the collision shapes of each sprite as thin lines."""
        width = max(1, frame.scale - 2)
        for way, world, camera in zip(WAYS, self.worlds, self.cameras, strict=True):
            lens = frame.lens(camera)
            frame.surface.set_clip(lens.clip)
            moving = world.bodies["inverse_mass"][world.shapes["body_row"]] > 0.0
            rows = np.flatnonzero(moving & (world.shapes["role"] == WHOLE))
            for outline in debug.outlines(world, rows.tolist()):
                draw_outline(frame.surface, lens, outline, COLORS[way], width, frame.scale)
            edges = mask_edges(world, np.flatnonzero(moving & (world.shapes["role"] == PART)), lens.scale)
            draw_lines(frame.surface, lens, edges.outer, COLORS[way], width)
            frame.surface.set_clip(None)

    def check(self):
        """Return the scene's goals, a list of Goal.

        The piles with outlines stand and fall asleep. Hulls hold more air than outlines, and boxes more than hulls.
        """
        corners, air, _ = (dict(zip(WAYS, column, strict=True)) for column in zip(*map(self.share, WAYS), strict=True))
        finite = all(np.isfinite(world.bodies[name]).all() for world in self.worlds for name in ("x", "y", "angle"))
        return [
            Goal("the outlines stand", SLEPT_BY, self.stands_now("outline"), f"sinks {self.sinks['outline']:z.2f} px"),
            Goal("the outlines sleep", SLEPT_BY, self.asleep["outline"], f"since step {self.changed['outline']}"),
            Goal(
                "an outline holds less air than hull and box",
                FITS_BY,
                air["outline"] < 0.5 * air["hull"] and air["hull"] < air["box"],
                ", ".join(f"{way} {whole(air[way])} px" for way in WAYS),
            ),
            Goal(
                "and has fewer corners than the pixels",
                FITS_BY,
                corners["outline"] < corners["exact"],
                f"{whole(corners['outline'])} and {whole(corners['exact'])}",
            ),
            Goal("everything is finite", 600, finite),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        way = WAYS[int(self.values["shape"])]
        laid = self.laid[way]
        seen = sum((name, way) in self.fits for name, _, _ in laid)
        air, area = (self.share(way)[1], sum(mask.area for _, mask, _ in laid)) if seen == len(laid) else (0.0, 1.0)
        sentence = f"By their {WORDS.get(way, way)} sprites rest on air, not on each other."
        number, unit = f"{air:.0f} px", f"of air held, of {area:,.0f} px of sprites"
        good = air < ALLOWED * area
        headline = Headline(sentence, "X: next shape", number, unit, seen, len(laid), "sprites", good)
        return headline.asks(f"By their {WORDS.get(way, way)}, do sprites rest on each other?")

    def finding(self):
        """Return a sentence with the air, the corners and the sag of the piles of boxes, outlines and exact pixels."""
        if self.since <= WARM:
            return "not yet: the piles have to settle for half a second"
        if any(isnan(corners) for corners, _, _ in map(self.share, WAYS)):
            return "not yet: how well the shapes fit is being measured"
        parts = []
        for way in IN_FINDING:
            corners, air, _ = self.share(way)
            stands = f"sinks {self.sinks[way]:z.2f} px" if self.stands_now(way) else "fell"
            parts.append(f"{way} {whole(air)} px of air, {whole(corners)} corners, {stands}")
        return "; ".join(parts)

    def bot(self):
        """Return the bot's input for the next step. The bot waits until the piles are at rest, then nudges once."""
        return InputFrame(frozenset(("fire",)) if self.frame == 240 else frozenset())

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the measurements. The worlds are hashed
        separately.
        """
        measured = (self.sinks, self.sways, self.asleep, self.changed)
        return (
            self.frame,
            self.since,
            self.nudged,
            *self.values.values(),
            *(row[way] for row in measured for way in WAYS),
        )


def whole(value):
    """Return a number as text without decimals, or UNKNOWN ("-") for nan."""
    return UNKNOWN if isnan(value) else f"{value:,.0f}"


def shapes_of(image, way):
    """Return (mask, shapes): the PixelMask of a sprite's image, and a tuple of its convex collision shapes.

    way: kind of the collision shapes, one of WAYS.
    """
    mask = PixelMask.from_surface(image, smooth=0.0 if way == "exact" else SMOOTH)
    if way == "box":
        left, top, right, bottom = bounds_of(mask)
        return mask, (Polygon.box(right - left, bottom - top, ((left + right) / 2, (top + bottom) / 2)),)
    return mask, mask.outline if way in PUSHED_AS_MASKS else fit(mask, way)


def bounds_of(mask):
    """Return (left, top, right, bottom) [px] of the solid pixels of a mask, relative to its origin; zeros if it is
    empty.
    """
    return mask.bounds or (0.0, 0.0, 0.0, 0.0)
