"""Words and numbers over the picture: counters, signs that are read, the iris of a new life, the result."""

import pygame

from game.boxes import draw_box
from game.colors import FOG, GOLD, INK, PAPER
from game.draw import CANVAS_SIZE, SMALL, TEXT, whole, wrap
from game.hud import MARGIN
from game.sprites import load_atlas
from scenes.platformer.hero import steps

SIGN_REACH = (40, 44)        # [px] how near the hero must be to read a sign
SIGN_WIDTH = 260             # [canvas px] of its longest line
SIGN_BOTTOM = 10             # [canvas px] between its box and the picture's lower edge
LINE = 11                    # [canvas px] from line to line
IRIS = 0.32                  # [s] the picture closes around the hero, and opens again
WIDEST = 560                 # [canvas px] radius at which the iris is out of the picture
RESULT_AFTER = 0.9           # [s] from the goal to its result
PARTS = (0.5, 1.0, 1.5)      # [s] after that, each star appears
HOLE = (255, 0, 255)


def draw_board(canvas, scene, view):
    """All of it. view: world point at the canvas' top left."""
    opened = _opened(scene)
    if opened < 1.0:
        _draw_iris(canvas, scene, view, opened)
    _draw_counters(canvas, scene)
    if scene.phase == "playing" and opened >= 1.0:
        _draw_signs(canvas, scene)
    elif scene.phase == "won":
        _draw_result(canvas, scene)


def clock_text(ticks):
    """Steps as minutes, seconds and tenths."""
    tenths = ticks * 10 // 60
    return f"{tenths // 600}:{tenths // 10 % 60:02d}.{tenths % 10}"


def stars(scene):
    """(earned, what for) of the three stars."""
    return ((True, "the flag"), (scene.coins == scene.things.coins_in_all, "every coin"), (scene.deaths == 0, "no hurt"))


def _draw_counters(canvas, scene):
    icons = load_atlas("ui")
    y = MARGIN
    lift = whole(3 * scene.look.pulse)
    canvas.surface.blit(icons["icon_coin"], (MARGIN, y - 1 - lift))
    text = canvas.text(f"{scene.coins}", MARGIN + 13, y, GOLD if lift else PAPER, TEXT, outline=True)
    canvas.text(f"/{scene.things.coins_in_all}", text.right + 2, y, FOG, TEXT, outline=True)
    clock = canvas.text(clock_text(scene.clock), CANVAS_SIZE[0] // 2, y, PAPER, TEXT, 1, "center", True)
    canvas.surface.blit(icons["icon_clock"], (clock.left - 13, y - 1))
    hurts = canvas.text(f"{scene.deaths}", CANVAS_SIZE[0] - MARGIN, y, PAPER, TEXT, 1, "right", True)
    canvas.surface.blit(icons["icon_skull"], (hurts.left - 13, y - 1))


def _draw_signs(canvas, scene):
    """The text of the sign he stands at, below everything: it never hides him."""
    x, y = scene.hero.character.position
    for sign in scene.level.map.things_of("sign"):
        if abs(x - sign.x - sign.width / 2) < SIGN_REACH[0] and abs(y - sign.y) < SIGN_REACH[1]:
            icon = load_atlas("things")["sign"]
            lines = wrap(sign.properties.get("text", ""), SIGN_WIDTH)
            width = max(canvas.measure(line)[0] for line in lines) + icon.get_width() + 26
            height = max(LINE * len(lines) + 9, icon.get_height() + 10)
            left, top = (CANVAS_SIZE[0] - width) // 2, CANVAS_SIZE[1] - height - SIGN_BOTTOM
            draw_box(canvas, (left, top, width, height))
            canvas.reserve((left, top, width, height))
            canvas.surface.blit(icon, (left + 8, top + (height - icon.get_height()) // 2))
            first = top + (height - LINE * len(lines)) // 2 + 2
            for number, line in enumerate(lines):
                canvas.text(line, left + icon.get_width() + 16, first + LINE * number, PAPER, TEXT)
            return


def _opened(scene):
    """How far the iris is open, 0..1: it closes before a new life and opens with it."""
    if scene.phase == "won":
        return 1.0
    left = scene.since if scene.phase == "playing" else scene.life_after - scene.since
    return min(left / steps(IRIS), 1.0)


def _draw_iris(canvas, scene, view, opened):
    x, y = scene.hero.character.position
    cover = pygame.Surface(CANVAS_SIZE)
    cover.fill(INK)
    cover.set_colorkey(HOLE)
    pygame.draw.circle(cover, HOLE, (whole(x) - view[0], whole(y) - view[1]), whole(WIDEST * opened * opened))
    canvas.surface.blit(cover, (0, 0))


def _draw_result(canvas, scene):
    since = scene.since / 60.0 - RESULT_AFTER
    if since < 0.0:
        return
    middle, width, height = CANVAS_SIZE[0] // 2, 214, 134
    left, top = middle - width // 2, 62 + whole(max(0.0, 0.25 - since) ** 2 * 1600)
    draw_box(canvas, (left, top, width, height), "panel")
    canvas.reserve((left, top, width, height))
    canvas.text("THE FLAG!", middle, top + 10, GOLD, TEXT, 2, "center", True)
    icons = load_atlas("ui")
    for number, (earned, reason) in enumerate(stars(scene)):
        x = middle + (number - 1) * 62
        shown = earned and since > PARTS[number]
        _draw_star(canvas, icons["icon_star"], x, top + 46, shown, since - PARTS[number])
        canvas.text(reason, x, top + 64, PAPER if shown else FOG, SMALL, 1, "center")
    for row, (name, value) in enumerate((("time", clock_text(scene.clock)),
                                         ("coins", f"{scene.coins} of {scene.things.coins_in_all}"),
                                         ("hurt", f"{scene.deaths} times" if scene.deaths != 1 else "once"))):
        y = top + 78 + row * 12
        canvas.text(name, middle - 6, y, FOG, TEXT, 1, "right")
        canvas.text(value, middle + 6, y, PAPER, TEXT)
    if since % 1.2 < 0.8:
        canvas.text("JUMP: play again", middle, top + height - 17, GOLD, TEXT, 1, "center")


def _draw_star(canvas, image, x, y, shown, age):
    """A star that drops in, or its shadow."""
    size = 18 if age > 0.15 or not shown else 18 + whole((0.15 - age) * 120)
    star = pygame.transform.scale(image, (size, size))
    if not shown:
        star.fill((70, 64, 92, 255), special_flags=pygame.BLEND_RGBA_MULT)
    canvas.sprite(star, x, y)
