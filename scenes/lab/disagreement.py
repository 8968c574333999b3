"""The shooter's traffic, tested with nine tiers: how often does each report a hit without a shared pixel, or miss one?

In short: the game plays by exact pixels. Wrong answers of every tier are counted; you cannot die here.

What to see: the game uses the exact pixels. Ten times a second every tier tests the same moment, and its wrong answers
are counted. Choose a tier with the wheel: its wrong pairs in the last test are lit. The curves settle with the number
of hits; the bars are 95 % intervals of the rates. You cannot die here: fly into the traffic and count the hits of your
box.

Why it matters: Players forgive a false hit less than any other fault; a rate says how often a tier reports one.

To try: choose the box with the wheel, and fly so close past a plane that it is lit.

Source: Wilson, Probable Inference, 1927 (the bars around rates).
"""

from dataclasses import replace

import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import BLUE, DUSK, FOG, INK, NIGHT, PAPER, RED, SLATE, faded
from game.drawing.headline import Headline
from game.drawing.number_text import tier_name
from game.drawing.sprites import load_atlas
from game.measure.reference_tier import ReferenceTier
from game.overlays.outlines import draw_outline
from game.scene import FAIR, Goal
from physics import BROADPHASES, Circle, World
from scenes.lab.masks import COLORS, NAMES
from scenes.lab.yard import HEAD
from scenes.shooter.director import Director
from scenes.shooter.scene import Shooter

SIDE = pygame.Rect(328, HEAD, 152, 270 - HEAD)  # place of the figures
ROW, TOP = 16, 36
OPENS = 34.5  # [s] of the stage: a gunship, and its companions
MARGIN = 14  # [px] between the plane and the figures
BARS, FULL = 384, 48  # left end and width [px] of a bar of 100 %
CURVES = pygame.Rect(SIDE.x + 24, 184, SIDE.width - 30, 68)
MOST_POINTS = 200  # of a curve; then every second one is dropped
FIRST = "aabb"  # marked from the start
LIARS = ("circle", "aabb", "obb")  # tiers that the bot's flight must catch
HOLDING = ("circle", "obb", "capsule", "hull")  # tiers that contain all pixels of a sprite, at any angle


class Disagreement(Shooter):
    """The shooter game, extended by a comparison of eight collision tiers (kinds of shape) with the exact pixels."""

    name = "lab/disagreement"
    title = "Disagreement"
    question = FAIR
    about = "The shooter's traffic, judged by nine tiers: who says hit where no pixel is shared, and who misses one."
    features = (
        "nine tiers asked about the same moments of a real game",
        "wrong and missed hits apart, with the interval they lie in",
        "errors of the chosen tier are lit",
    )
    actions = (("arrows", "fly"), ("Space", "fire"), ("wheel", "which tier is lit"))
    tiers = ("pixels",)
    sliders = ()
    keeps = {"broadphase": "the shooter's own: over its whole stage, with a boss's 1,500 bullets, the two are level"}
    hits_of = "your plane's hits:"
    head = HEAD
    field = pygame.Rect(0, HEAD, SIDE.x, SIDE.height)
    ranked_by = None
    assists = ()
    takes_level = False
    music = "lab"
    hides_pointer = False

    def build(self):
        """Build the shooter with an invincible plane, and set all counts to zero."""
        super().build()
        self.plane.right = SIDE.x - MARGIN
        self.director = Director(from_then_on(self.director.stage, OPENS))
        self.director.mode = "run"
        rehearse(self.effects)
        self.reference = ReferenceTier(FIRST)
        self.curves: list[tuple[float, ...]] = []  # shares of wrong hits by tier, over a growing number of moments
        self.apart = 1  # moments between two of them

    @property
    def invincible(self):
        """True, even if the player has switched invincibility off in the settings."""
        return True

    @property
    def hit_stop(self):
        """False, even if the player has switched the pause at hits on in the settings."""
        return False

    @property
    def hurts(self):
        """Part of the plane that enemies can hit: its whole hull, instead of the shooter's small core."""
        return "hull"

    def update(self, inputs):
        """Step the game, then test one more collision tier against the last snapshot of the world."""
        super().update(inputs)
        reference = self.reference
        if inputs.wheel:
            reference.lit = reference.tiers[
                (reference.tiers.index(reference.lit) - inputs.wheel) % len(reference.tiers)
            ]
            reference.seen = []
        if not reference.ask(self.world) or reference.moments % self.apart:
            return
        self.curves.append(tuple(reference.wrong[tier].share for tier in reference.tiers))
        if len(self.curves) > MOST_POINTS:
            self.curves, self.apart = self.curves[1::2], 2 * self.apart

    def draw(self, canvas, alpha):
        """Draw the game, and beside it the rates of wrong and missed hits of all collision tiers.

        alpha: position (0..1) between the last two steps.
        """
        super().draw(canvas, alpha)
        canvas.surface.fill(NIGHT, SIDE)
        canvas.fix(SIDE)
        canvas.surface.fill(SLATE, (SIDE.x, SIDE.y, 1, SIDE.height))
        canvas.text("wrong hits", BARS, TOP - 12, FOG, SMALL)
        canvas.text("missed", SIDE.right - 4, TOP - 12, FOG, SMALL, align="right")
        for row, tier in enumerate(self.reference.tiers):
            self._draw_row(canvas, tier, TOP + row * ROW)
        self._draw_curves(canvas)
        hits = self.reference.missed[FIRST].total
        words = f"all sprites: {hits:,} true hits in {self.reference.moments:,} moments"
        canvas.text(words, SIDE.x + 6, 260, FOG, SMALL)

    def _draw_row(self, canvas, tier, y):
        """Draw the row of one collision tier: its wrong hits as a bar, and its missed hits.

        The bar shows the share of wrong hits among the reported hits, with its confidence interval.
        """
        wrong, missed, color = self.reference.wrong[tier], self.reference.missed[tier], COLORS[tier]
        if tier == self.reference.lit:
            canvas.surface.fill(DUSK, (SIDE.x + 2, y - 3, SIDE.width - 3, ROW - 1))
        canvas.surface.fill(color, (SIDE.x + 6, y, 2, 6))
        canvas.text(NAMES.get(tier, tier), SIDE.x + 10, y, PAPER, SMALL)
        if not wrong.total:
            canvas.text("no hit yet", BARS, y, FOG, SMALL)
            return
        low, high = (round(FULL * share) for share in wrong.interval)
        canvas.surface.fill(faded(color, 0.5), (BARS + low, y + 2, max(1, high - low), 2))
        canvas.surface.fill(color, (BARS + round(FULL * wrong.share), y, 1, 6))
        canvas.text(f"{100 * wrong.share:.0f} %", BARS + FULL + 22, y, PAPER, SMALL, align="right")
        canvas.text(f"{100 * missed.share:.0f} %", SIDE.right - 4, y, PAPER, SMALL, align="right")

    def _draw_curves(self, canvas):
        """Draw one curve for each collision tier over the tested moments.

        A curve shows the share of the tier's hits that are wrong.
        """
        area = CURVES
        canvas.surface.fill(INK, area)
        top = max([0.1, *(share for shares in self.curves[len(self.curves) // 8 :] for share in shares)])
        canvas.text(f"{100 * top:.0f} %", area.x - 2, area.y, FOG, SMALL, align="right")
        canvas.text("0", area.x - 2, area.bottom - 6, FOG, SMALL, align="right")
        canvas.text("share of wrong hits, as they add up", SIDE.x + 6, area.y - 9, FOG, SMALL)
        if len(self.curves) < 2:
            return
        for column, tier in enumerate(self.reference.tiers):
            points = [
                (
                    area.x + number * (area.width - 1) / (len(self.curves) - 1),
                    area.bottom - 1 - min(shares[column] / top, 1.0) * (area.height - 2),
                )
                for number, shares in enumerate(self.curves)
            ]
            pygame.draw.lines(canvas.surface, COLORS[tier], False, points)

    def draw_on_frame(self, frame):
        """Outline the pairs for which the chosen collision tier gave a wrong answer in the last test.

        False hits are red, missed hits are blue.
        """
        lens = frame.lens(self.camera)
        clip = frame.from_canvas(pygame.Rect(0, 0, SIDE.x, SIDE.height))
        frame.surface.set_clip(clip)
        width = max(1, frame.scale - 1)
        for false_hit, outlines in self.reference.seen:
            color = RED if false_hit else BLUE
            for outline in outlines:
                if outline[0] not in ("mask", "tiles"):
                    draw_outline(frame.surface, lens, outline, color, width, frame.scale)
        frame.surface.set_clip(None)

    def check(self):
        """Return the scene's goals, a list of Goal.

        Circles and boxes report wrong hits. Shapes that contain all pixels of a sprite miss no hit.
        """
        wrong, missed = self.reference.wrong, self.reference.missed
        caught = [tier_name(tier) for tier in LIARS if wrong[tier].count]
        all_caught = len(caught) == len(LIARS)
        holding = [tier_name(tier) for tier in HOLDING if missed[tier].count]
        return [
            Goal("true hits were seen", 1200, missed[FIRST].total > 0, f"{missed[FIRST].total}"),
            Goal("circle, box and turned box reported hits that are none", 1200, all_caught, ", ".join(caught)),
            Goal("what holds all pixels misses no hit", 1, not holding, ", ".join(holding)),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        lit = self.reference.lit
        wrong, name = self.reference.wrong[lit], NAMES.get(lit, lit)
        sentence = f"The {name} reports hits where no pixel is shared."
        number, unit = f"{wrong.count} of {wrong.total}", "hits among all sprites are false"
        headline = Headline(sentence, "wheel: shape", number, unit, wrong.total, 1, "hits", not wrong.count)
        return headline.asks(f"Does the {name} report hits where no pixel is shared?")

    def finding(self):
        """Return a sentence with the share of wrong hits of the chosen collision tier, with its confidence interval."""
        lit = self.reference.lit
        wrong, missed = self.reference.wrong[lit], self.reference.missed[lit]
        if not wrong.total:
            return f"not yet: the {NAMES.get(lit, lit)} has to report a hit"
        low, high = (100 * share for share in wrong.interval)
        sentence = f"{100 * wrong.share:.0f} % of {wrong.total:,} hits that the {NAMES.get(lit, lit)} reported are none"
        return f"{sentence} (95 %: {low:.0f} to {high:.0f} %); of {missed.total:,} true hits it missed {missed.count:,}"

    def bot(self):
        """Return the bot's input for the next step, which is the input that the shooter's own bot gives."""
        return super().bot()

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the state of the game and the counts of
        the tiers.
        """
        return (*super().state(), *self.reference.state(), self.reference.lit)


def rehearse(effects):
    """Test two aircraft and a disc once with each collision tier (kind of collision shape), to compile all kernels.

    The test runs in a separate world with these effects, before the game begins.
    """
    world, reference = World(effects, BROADPHASES["sweep"]()), ReferenceTier(FIRST)
    masks = [load_atlas("planes").mask(name) for name in ("player", "gunship_0")]
    for x, mask in zip((0.0, 9.0), masks, strict=True):
        world.add_body(mask, position=(x, 0.0), kind="kinematic", tier="pixels")
    world.add_body(Circle(2.0), position=(4.0, 0.0), kind="kinematic")
    world.step()
    while not reference.ask(world):
        pass


def from_then_on(stage, start):
    """Return a copy of a shooter stage that begins at time `start` [s].

    Earlier events are dropped, except changes of the backdrop and of the speed.
    """
    kept = [each for each in stage.events if each.at >= start or each.event in ("backdrop", "pace")]
    return replace(stage, events=tuple(replace(each, at=max(0.0, each.at - start)) for each in kept))
