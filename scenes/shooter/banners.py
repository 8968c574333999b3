"""Banners across the field of the shooter: stage title, boss warning, bonuses, offer to continue, and result."""

from functools import lru_cache
from math import inf

import pygame

from game.drawing.canvas import TEXT, whole
from game.drawing.colors import GOLD, INK, PAPER, RED, SKY
from game.drawing.hud import banner
from game.drawing.number_text import count_text, points_text
from scenes.shooter.director import READY, WARNING
from scenes.shooter.ending import ASKING, CLEARED, LOST, WON
from scenes.shooter.spectacle import BONUS_SHOWN

SLIDE = 24  # steps of a banner's entry, and of its exit
STRIPE = 16  # [px] of the warning's slanted stripes
SMOKE = 50  # steps for which the boss's end stays visible
BLINK = 20  # steps: WARNING is bright and dark in turn, three times in two seconds
HALF = 28  # [px] from the top of a two-line band to its middle line, from which it grows
BONUS_HALF = 90  # [px] from the middle of the field to both ends of a line with a bonus
HURRY = 4  # the countdown is red below this digit


def draw_banners(canvas, scene):
    """Draw the banner of the current mode of the stage or of its ending, if this mode has one."""
    director, ending = scene.director, scene.ending
    if ending.mode == ASKING:
        _draw_continue(canvas, scene)
    elif ending.mode == LOST:
        banner(canvas, "GAME OVER", _summary(scene), RED, field=scene.field)
    elif ending.mode == WON:
        banner(canvas, "STAGE CLEAR", _summary(scene), GOLD, field=scene.field)
    elif ending.mode == CLEARED:
        _draw_bonuses(canvas, scene)
    elif director.mode == "ready":
        _draw_title(canvas, scene)
    elif director.mode == "warning":
        _draw_warning(canvas, scene)
    elif scene.spectacle.bonus[2]:
        _draw_bonus(canvas, scene)


def eased(step, whole_time):
    """Return how far a banner has slid in at step `step` of its `whole_time` steps: 0 outside, 1 in its final
    position.

    The banner slides in over the first SLIDE steps, and out over the last SLIDE steps, with easing.
    """
    share = min(step / SLIDE, (whole_time - step) / SLIDE, 1.0)
    return 1.0 - (1.0 - max(share, 0.0)) ** 3


def _draw_title(canvas, scene):
    """Draw the stage's title, which slides in from the left, and its name, which slides in from the right.

    At the end of the banner's time, both texts slide out again.
    """
    director, field = scene.director, scene.field
    share = eased(director.since, READY)
    middle, width = field.centerx, field.width
    band(canvas, field, 92, whole(58 * share))
    if share < 0.4:
        return
    off = (1.0 - share) * width
    text_inside(canvas, field, director.stage.title, middle - off, 104, GOLD, 3)
    text_inside(canvas, field, director.stage.name, middle + off, 134, PAPER, 1)


def _draw_warning(canvas, scene):
    """Draw the word WARNING and the name of the mid-boss or boss, between two rows of moving stripes."""
    since, field = scene.director.since, scene.field
    share = eased(since, WARNING)
    high = whole(56 * share)
    band(canvas, field, 100, high)
    shift = since * 2 % (2 * STRIPE)
    for y in (100 + HALF - high // 2 - 8, 100 + HALF + high // 2):
        canvas.surface.blit(stripes(field.width + 2 * STRIPE), (field.left, y), (2 * STRIPE - shift, 0, field.width, 8))
    if share < 0.6:
        return
    bright = not scene.accessibility.flashing or since % (2 * BLINK) < BLINK
    canvas.text("WARNING", field.centerx, 107, (255, 110, 100) if bright else (232, 96, 96), TEXT, 3, "center", True)
    canvas.text(scene.director.announced.name, field.centerx, 136, PAPER, TEXT, 1, "center", True)


def _draw_bonus(canvas, scene):
    title, points, left = scene.spectacle.bonus
    middle = scene.field.centerx
    y = 134 - whole(6 * eased(BONUS_SHOWN - left, BONUS_SHOWN + 1))
    canvas.text(title, middle, y, GOLD if points else PAPER, TEXT, 2, "center", True)
    if points:
        canvas.text(f"+{points:,}", middle, y + 20, PAPER, TEXT, 1, "center", True)


def _draw_bonuses(canvas, scene):
    """Draw the text STAGE CLEAR, and one line for each bonus that has been counted so far."""
    ending, field = scene.ending, scene.field
    share = eased(ending.since - SMOKE, inf)
    band(canvas, field, 70, whole(112 * share))
    if share < 0.9:
        return
    canvas.text("STAGE CLEAR", field.centerx, 82, GOLD, TEXT, 3, "center", True)
    for number, (name, points) in enumerate(ending.counted):
        y = 114 + 14 * number
        canvas.text(name, field.centerx - BONUS_HALF, y, PAPER, TEXT, outline=True)
        color = SKY if points else PAPER
        canvas.text(f"+{points:,}", field.centerx + BONUS_HALF, y, color, TEXT, align="right", outline=True)


def _draw_continue(canvas, scene):
    digit = scene.ending.digit
    banner(
        canvas,
        f"CONTINUE? {digit}",
        ("fire: go on, with the points begun anew", "bomb: hurry"),
        RED if digit < HURRY else GOLD,
        field=scene.field,
    )


def _summary(scene):
    score = scene.score
    counts = (
        f"{count_text(sum(score.kills.values()), 'plane')} shot down",
        count_text(score.grazes, "graze"),
        f"best chain {score.best_chain}",
    )
    return [f"{points_text(score.points)} points", "   ".join(counts), "fire: go on"]


def band(canvas, field, top, high):
    """Draw a dark band across the field, behind a banner's text.

    top: y of the band's upper edge at full height; high: current height [px]. The band grows in both directions from
    its middle line. Once it has room for two lines of text, it only grows downwards.
    """
    if high > 0:
        canvas.surface.blit(
            _shade(field.width, high), (field.left, top + HALF - high // 2 if high <= 2 * HALF + 2 else top)
        )


def text_inside(canvas, field, text, x, y, color, scale):
    """Draw a text of a sliding banner if it is completely inside the field.

    x, y: centre of the text's upper edge [px]; scale: factor on the size of the font.
    """
    rect = canvas.text_rect(text, x, y, TEXT, scale, "center")
    if field.contains(rect):
        canvas.text(text, x, y, color, TEXT, scale, "center", True)


@lru_cache(maxsize=128)
def _shade(width, high):
    shade = pygame.Surface((width, high), pygame.SRCALPHA)
    shade.fill((20, 16, 32, 165))
    return shade


@lru_cache(maxsize=2)
def stripes(width):
    """Return an image of the warning's slanted stripes, `width` x 8 px."""
    image = pygame.Surface((width, 8))
    image.fill(INK)
    for x in range(-STRIPE, width, 2 * STRIPE):
        pygame.draw.polygon(image, (226, 70, 76), [(x, 8), (x + 8, 0), (x + 8 + STRIPE, 0), (x + STRIPE, 8)])
    return image
