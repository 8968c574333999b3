"""What is written over the sky: score, chain, lives, power, words that rise, waves, and the end."""

from game.colors import GOLD, INK, PAPER, RED, SKY
from game.draw import SMALL, TEXT, whole
from game.hud import MARGIN, banner, icons, label
from game.sprites import load_atlas
from scenes.shooter.score import CHAIN_STEP, TOP_CHAIN

HEALTH = ((230, 60, 70), (255, 190, 70), (120, 220, 120))      # by how much is left
FADE = 0.55                  # [s] after which a rising word is written darker


HELD = ((0, 0, 112, 32), (396, 0, 84, 34), (180, 0, 120, 28))  # [canvas px] where the fixed words stand


def draw_words(canvas, scene, view):
    """Words that rise from what happened; bullets are drawn over them. `view`: world point at the picture's top left."""
    for rect in HELD:
        canvas.reserve(rect)
    left, top = view
    for text, x, y, age, color in scene.spectacle.words:
        faded = tuple(c * 2 // 3 for c in color) if age > FADE else color
        canvas.text_if_free(text, x - left, y - top, faded, SMALL, align="center", outline=True)


def draw_board(canvas, scene):
    """The fixed words."""
    _draw_score(canvas, scene)
    _draw_lives(canvas, scene)
    if scene.over:
        _draw_end(canvas, scene)
    elif scene.spectacle.news and scene.director.number:
        _draw_wave(canvas, scene)


def _draw_score(canvas, scene):
    score = scene.score
    lift = whole(2 * scene.spectacle.pulse)
    rect = label(canvas, "SCORE", MARGIN, MARGIN - lift // 2, f"{score.points:07d}",
                 color=GOLD if scene.spectacle.pulse > 0.4 else PAPER)
    canvas.text(f"x{score.times}", rect.right + 6, rect.y, SKY if score.times > 1 else PAPER, TEXT, outline=True)
    if score.times < TOP_CHAIN:
        share = score.chain % CHAIN_STEP / CHAIN_STEP
        canvas.surface.fill(INK, (MARGIN, 16, 42, 3))
        canvas.surface.fill(SKY, (MARGIN + 1, 17, round(40 * share), 1))
        canvas.reserve((MARGIN, 16, 42, 3))
    if score.close:
        canvas.text(f"CLOSE {score.close}", MARGIN, 22, PAPER, SMALL, outline=True)


def _draw_lives(canvas, scene):
    ui, plane = load_atlas("ui"), scene.plane
    right = canvas.rect.right - MARGIN
    for row, (name, count) in enumerate((("icon_life", plane.lives), ("icon_power", plane.power))):
        image = ui[name]
        width = count * (image.get_width() + 2) - 2
        icons(canvas, image, count, right - width, MARGIN + 12 * row)


def _draw_wave(canvas, scene):
    director, news = scene.director, scene.spectacle.news
    # It slides in from above and stays clear of the sky where planes fight.
    y = MARGIN - max(0, news - 118) * 2
    canvas.text(f"WAVE {director.number}", canvas.rect.centerx, y, GOLD, TEXT, align="center", outline=True)
    canvas.text(director.wave.title, canvas.rect.centerx, y + 11, PAPER, SMALL, align="center", outline=True)


def _draw_end(canvas, scene):
    score = scene.score
    lines = [f"{score.points:,} points in {scene.director.number} waves",
             f"{sum(score.kills.values())} planes shot down   {score.close} near misses"]
    if scene.over > 72:
        lines.append("fire or Enter: fly again")
    banner(canvas, "GAME OVER", lines, RED)


def draw_health(surface, place, share):
    """A small bar under a damaged plane's nose."""
    color = HEALTH[min(int(share * 3), 2)]
    surface.fill(INK, (*place, 36, 4))
    surface.fill(color, (place[0] + 1, place[1] + 1, max(1, round(34 * share)), 2))
