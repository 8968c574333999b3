"""Heads-up display of the shooter: score, chain, lives, bombs, power, hits, and the boss's health.

All positions are relative to the scene's `field`, the part of the canvas that shows the game.
"""

import pygame

from game.drawing.canvas import SMALL, TEXT, whole
from game.drawing.colors import GOLD, INK, PAPER, RED, SKY
from game.drawing.hud import MARGIN, icons
from game.drawing.sprites import load_atlas
from scenes.shooter.boss import ALMOST
from scenes.shooter.plane import TOP_POWER
from scenes.shooter.score import HOLD, TOP_CHAIN
from scenes.shooter.spectacle import NEWS

HEALTH = ((230, 60, 70), (255, 190, 70), (120, 220, 120))  # by remaining health
FADE = 0.55  # [s] after which a rising word is written darker
HELD = {
    "topleft": (132, 36),
    "topright": (100, 44),
    "midtop": (226, 28),
    "bottomleft": (150, 16),
}  # sizes [px] of the heads-up display at these places of the field, where no rising word is drawn
BAR = (184, 7)  # [px] of the leader's health
CHAIN = (60, 4)
BELOW = 17  # [px] from the upper edge of the field to the bars
HEALTH_WIDTH = 36  # [px] of the bar at a damaged plane
PHASE_NAME = 150  # steps for which the name of a leader's phase is shown
SLIDE_IN, SLIDE_OUT = 12, 10  # steps in which the name of a wave comes and goes


def draw_words(canvas, scene, view):
    """Draw the short texts that rise from events, such as points.

    view: world point (x, y) [px] at the picture's top left corner.
    """
    for place, size in HELD.items():
        rect = pygame.Rect((0, 0), size)
        setattr(rect, place, getattr(scene.field, place))
        canvas.reserve(rect)
    left, top = view
    for text, x, y, age, color in scene.spectacle.works.words:
        faded = tuple(c * 2 // 3 for c in color) if age > FADE else color
        if scene.field.contains(canvas.text_rect(text, x - left, y - top, SMALL, align="center")):
            canvas.text_if_free(text, x - left, y - top, faded, SMALL, align="center", outline=True)


def draw_board(canvas, scene):
    """Draw the heads-up display: score, lives, bombs, power, hits, and either the boss's bar or the name of a new
    wave.
    """
    _draw_score(canvas, scene)
    _draw_stock(canvas, scene)
    _draw_hits(canvas, scene)
    leader = scene.fleet.leader
    if leader is not None and leader.mode in ("arrive", "fight", "change"):
        _draw_leader(canvas, scene, leader)
    elif scene.spectacle.news and scene.director.mode == "run":
        _draw_wave(canvas, scene)


def _draw_score(canvas, scene):
    score, pulse = scene.score, scene.spectacle.pulse
    x, top = scene.field.left + MARGIN, scene.field.top
    y = top + MARGIN - whole(2 * pulse)
    rect = canvas.text(f"{score.points:08d}", x, y, GOLD if pulse > 0.4 else PAPER, TEXT, outline=True)
    canvas.text(f"x{score.times}", rect.right + 6, y, SKY if score.times > 1 else PAPER, TEXT, outline=True)
    if scene.best:
        canvas.text(f"BEST {max(scene.best, score.points):08d}", x, top + 30, PAPER, SMALL, outline=True)
    bar = pygame.Rect((x, top + BELOW), CHAIN)
    canvas.surface.fill(INK, bar)
    if score.chain:
        color = GOLD if score.times == TOP_CHAIN else SKY
        canvas.surface.fill(color, (x + 1, bar.y + 1, round((bar.width - 2) * score.hold / HOLD), bar.height - 2))
    canvas.fix(bar)
    canvas.text(f"CHAIN {score.chain}  GRAZE {score.grazes}", x, top + 23, PAPER, SMALL, outline=True)


def _draw_stock(canvas, scene):
    """Draw lives, bombs and power as rows of icons at the right edge of the field."""
    ui, plane, gain = load_atlas("ui"), scene.plane, scene.spectacle.gain
    right, top = scene.field.right - MARGIN, scene.field.top + MARGIN
    rows = (("icon_life", max(plane.lives - plane.here, 0)), ("icon_bomb", plane.bombs), ("icon_power", plane.power))
    for row, (name, count) in enumerate(rows):
        image = ui[name]
        # The row of power icons jumps after a pick-up.
        lift = whole(3 * gain) if row == 2 else 0
        icons(canvas, image, count, right - count * (image.get_width() + 2) + 2, top + 12 * row - lift)
    if plane.power == TOP_POWER:
        canvas.text("MAX", right - TOP_POWER * 11 - 3, top + 26, GOLD, SMALL, align="right", outline=True)


def _draw_hits(canvas, scene):
    """Draw the numbers of hits on the player's core, hull and bounding box. The part that can be hurt is gold."""
    ui, y, x = load_atlas("ui"), scene.field.bottom - 14, scene.field.left + MARGIN
    counts = scene.own_hits
    if scene.hits_of:
        x = canvas.text(scene.hits_of, x, y + 2, PAPER, SMALL, outline=True).right + 7
    for part in ("core", "hull"):
        canvas.surface.blit(ui[f"icon_{part}"], (x, y))
        color = GOLD if part == scene.hurts else PAPER
        rect = canvas.text(f"{part} {counts[part]}", x + 12, y + 2, color, SMALL, outline=True)
        x = rect.right + 7
    canvas.text(f"box {counts['box']}", x, y + 2, PAPER, SMALL, outline=True)


def _draw_wave(canvas, scene):
    director, news = scene.director, scene.spectacle.news
    # The wave's name slides in from above and stays clear of the sky where planes fight.
    y = MARGIN - max(0, news - (NEWS - SLIDE_IN)) - max(0, SLIDE_OUT - news)
    if y >= 0:
        canvas.text(director.wave, scene.field.centerx, scene.field.top + y, GOLD, TEXT, align="center", outline=True)


def _draw_leader(canvas, scene, leader):
    """Draw the name and timer of the mid-boss or boss above its health bar, which has a section for each phase."""
    bar = pygame.Rect((0, scene.field.top + BELOW), BAR)
    bar.centerx = scene.field.centerx
    left, top, width, height = bar
    phases, above = len(leader.phases), scene.field.top + MARGIN
    canvas.text(leader.name, left, above, PAPER, TEXT, outline=True)
    if leader.mode == "fight":
        hurry = leader.seconds_left < ALMOST
        seconds = f"{leader.seconds_left:04.1f}" if hurry else f"{int(leader.seconds_left)}"
        canvas.text(seconds, left + width, above, RED if hurry else GOLD, TEXT, align="right", outline=True)
    canvas.surface.fill(INK, bar)
    # The section of the last phase is at the left: the bar empties from right to left.
    part = (width - 2) / phases
    behind = phases - 1 - leader.number
    for number in range(behind):
        canvas.surface.fill(HEALTH[2], (left + 1 + round(part * number), top + 1, round(part) - 1, height - 2))
    share = max(scene.spectacle.health, 0.0)
    color = health_color(share)
    start = left + 1 + round(part * behind)
    canvas.surface.fill(color, (start, top + 1, round((part - 1) * share), height - 2))
    canvas.surface.fill(tuple(min(c + 60, 255) for c in color), (start, top + 1, round((part - 1) * share), 1))
    for number in range(1, phases):
        canvas.surface.fill(PAPER, (left + round(part * number), top - 1, 1, height + 2))
    canvas.fix(bar)
    if leader.mode == "fight" and leader.since < PHASE_NAME:
        canvas.text(leader.phase.name, left, top + 12, SKY, SMALL, outline=True)


def draw_health(surface, place, share):
    """Draw the small health bar of a damaged plane. place: (x, y) [canvas px]; share: remaining health, 0..1."""
    surface.fill(INK, (*place, HEALTH_WIDTH, 4))
    surface.fill(health_color(share), (place[0] + 1, place[1] + 1, max(1, round((HEALTH_WIDTH - 2) * share)), 2))


def health_color(share):
    """Return the colour of a health bar: red, yellow or green. share: remaining health, 0..1."""
    return HEALTH[max(0, min(int(share * 3), 2))]
