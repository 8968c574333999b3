"""Heads-up display of the platformer: counters, names of the acts, texts of signs, iris wipe, and result."""

from functools import lru_cache

import pygame

from game.drawing.canvas import CANVAS_SIZE, SMALL, TEXT, whole, wrap
from game.drawing.colors import FOG, GOLD, GREEN, INK, PAPER, RED
from game.drawing.hud import MARGIN
from game.drawing.nine_slice import draw_box
from game.drawing.sprites import load_atlas
from scenes.platformer.feel import steps

SIGN_REACH = (40, 44)  # [px] distance from which the hero reads a sign
SIGN_WIDTH = 260  # [canvas px] width at which a sign's text is wrapped
SIGN_BOTTOM = 10  # [canvas px] between a sign's box and the picture's lower edge
LINE = 11  # [canvas px] from line to line
IRIS = 0.32  # [s] in which the iris wipe closes around the hero, and opens again
WIDEST = 560  # [canvas px] radius at which the iris wipe hides nothing
RESULT_AFTER = 0.9  # [s] from the goal to its result
STARS_AFTER = (0.5, 1.0, 1.5)  # [s] from the result to each of its three stars
STAR, STAR_DROP, STAR_GROWTH = (
    18,
    0.15,
    120.0,
)  # size of a star [px]; time in which it drops in [s]; rate at which it shrinks meanwhile [px/s]
MOST_GEMS = 8  # greatest number of secrets that are shown
HOLE = (255, 0, 255)
TITLES = {"meadow": "THE MEADOW", "cave": "THE HOLLOW", "keep": "THE KEEP"}
TITLE_TIME, TITLE_FADE = 2.4, 0.35  # [s] duration of an act's name; of its fades
TITLE_Y = 58  # [canvas px]


def draw_board(canvas, scene, view):
    """Draw the heads-up display. view: world point (x, y) [px] at the top left corner of the canvas."""
    opened = _opened(scene)
    if opened < 1.0:
        _draw_iris(canvas, scene, view, opened)
    _draw_counters(canvas, scene)
    if scene.phase == "playing" and opened >= 1.0:
        _draw_title(canvas, scene.look)
        _draw_signs(canvas, scene)
    elif scene.phase == "won":
        _draw_result(canvas, scene)


def clock_text(ticks):
    """Return a time, given in steps of 1/60 s, as the text "minutes:seconds.tenths"."""
    tenths = ticks * 10 // 60
    return f"{tenths // 600}:{tenths // 10 % 60:02d}.{tenths % 10}"


def stars(scene):
    """Return a tuple of (earned, condition) for the three stars. earned: bool; condition: text for the player."""
    return (
        (True, "the flag"),
        (scene.secrets == scene.things.secrets_in_all, "all secrets"),
        (scene.deaths == 0, "no hurt"),
    )


def _draw_counters(canvas, scene):
    icons = load_atlas("ui")
    y = MARGIN
    lift = whole(3 * scene.look.pulse)
    canvas.surface.blit(icons["icon_coin"], (MARGIN, y - 1 - lift))
    text = canvas.text(f"{scene.coins}", MARGIN + 13, y, GOLD if lift else PAPER, TEXT, outline=True)
    text = canvas.text(f"/{scene.things.coins_in_all}", text.right + 2, y, FOG, TEXT, outline=True)
    _draw_gems(canvas, scene, text.right + 8)
    clock = canvas.text(clock_text(scene.clock), CANVAS_SIZE[0] // 2, y, PAPER, TEXT, 1, "center", True)
    canvas.surface.blit(icons["icon_clock"], (clock.left - 13, y - 1))
    hurts = canvas.text(f"{scene.deaths}", CANVAS_SIZE[0] - MARGIN, y, PAPER, TEXT, 1, "right", True)
    canvas.surface.blit(icons["icon_skull"], (hurts.left - 13, y - 1))
    if scene.look.split is not None:
        behind, _ = scene.look.split
        color = GREEN if behind <= 0.0 else RED
        text = f"{'+' if behind > 0.0 else '-'}{abs(behind):.1f}"
        canvas.text(text, CANVAS_SIZE[0] // 2, y + 11, color, TEXT, 1, "center", True)


def _draw_gems(canvas, scene, x):
    """Draw a gem for each secret that was found, and a silhouette for each other secret."""
    icon = load_atlas("ui")["icon_gem"]
    lift, places = whole(4 * scene.look.gem_pulse), min(scene.things.secrets_in_all, MOST_GEMS)
    for number in range(places):
        found = number < scene.secrets
        up = lift if number == scene.secrets - 1 else 0
        canvas.surface.blit(icon if found else _empty(icon), (x + 12 * number, MARGIN - 1 - up))
    canvas.fix((x, MARGIN - 1, 12 * places, 10))


@lru_cache(maxsize=4)
def _empty(icon):
    """Return a dark silhouette of an icon as a Surface. It is drawn for a secret that has not been found yet."""
    image = icon.copy()
    image.fill((60, 60, 96, 200), special_flags=pygame.BLEND_RGBA_MULT)
    return image


def _draw_title(canvas, look):
    """Draw the name of the act that the hero has entered. The name slides in and fades out.

    look: the scene's Look, which has the act and the time since it began.
    """
    age = look.act_age
    if age >= TITLE_TIME:
        return
    come = min(age / TITLE_FADE, 1.0, (TITLE_TIME - age) / TITLE_FADE)
    y = TITLE_Y - whole(14 * (1.0 - come) ** 2)
    width, height = canvas.measure(TITLES[look.act], TEXT, 2)
    half = whole((width / 2 + 26) * come)
    middle = CANVAS_SIZE[0] // 2
    for row in (y - 6, y + height + 4):
        canvas.surface.fill(GOLD, (middle - half, row, 2 * half, 1))
    if come > 0.5:
        canvas.text(TITLES[look.act], middle, y, PAPER, TEXT, 2, "center", True)


def _draw_signs(canvas, scene):
    """Draw the text of the sign at which the hero stands, at the bottom of the picture, where it does not cover him."""
    x, y = scene.hero.character.position
    for sign in scene.level.map.things_of("sign"):
        if abs(x - sign.x - sign.width / 2) < SIGN_REACH[0] and abs(y - sign.y) < SIGN_REACH[1]:
            icon = load_atlas("things")["sign"]
            lines = wrap(sign.properties.get("text", ""), SIGN_WIDTH)
            width = max(canvas.measure(line)[0] for line in lines) + icon.get_width() + 26
            height = max(LINE * len(lines) + 9, icon.get_height() + 10)
            left, top = (CANVAS_SIZE[0] - width) // 2, CANVAS_SIZE[1] - height - SIGN_BOTTOM
            draw_box(canvas, (left, top, width, height))
            canvas.fix((left, top, width, height))
            canvas.surface.blit(icon, (left + 8, top + (height - icon.get_height()) // 2))
            first = top + (height - LINE * len(lines)) // 2 + 2
            for number, line in enumerate(lines):
                canvas.text(line, left + icon.get_width() + 16, first + LINE * number, PAPER, TEXT)
            return


def _opened(scene):
    """Return how far the iris wipe is open, from 0 (closed) to 1 (fully open).

    The iris closes at the end of a life and opens at the start of the next one.
    """
    if scene.phase == "won" or (scene.phase == "playing" and not scene.deaths):
        return 1.0  # the first life begins with the iris open: a replay may be frozen at its first frame
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
    middle, width, height = CANVAS_SIZE[0] // 2, 214, 146
    left, top = middle - width // 2, 62 + whole(max(0.0, 0.25 - since) ** 2 * 1600)
    draw_box(canvas, (left, top, width, height), "panel")
    canvas.fix((left, top, width, height))
    canvas.text("THE FLAG!", middle, top + 10, GOLD, TEXT, 2, "center", True)
    icons = load_atlas("ui")
    for number, (earned, reason) in enumerate(stars(scene)):
        x = middle + (number - 1) * 62
        age = since - STARS_AFTER[number]
        shown = earned and age > 0.0
        _draw_star(canvas, icons["icon_star"], x, top + 46, shown, age)
        canvas.text(reason, x, top + 64, PAPER if shown else FOG, SMALL, 1, "center")
    for row, (name, value) in enumerate(
        (
            ("time", clock_text(scene.clock)),
            ("coins", f"{scene.coins} of {scene.things.coins_in_all}"),
            ("secrets", f"{scene.secrets} of {scene.things.secrets_in_all}"),
            ("hurt", f"{scene.deaths} times" if scene.deaths != 1 else "once"),
        )
    ):
        y = top + 78 + row * 12
        canvas.text(name, middle - 6, y, FOG, TEXT, 1, "right")
        canvas.text(value, middle + 6, y, PAPER, TEXT)
    if scene.result is not None and since % 1.2 < 0.8:
        canvas.text("JUMP: go on", middle, top + height - 17, GOLD, TEXT, 1, "center")


def _draw_star(canvas, image, x, y, shown, age):
    """Draw one star of the result, or its silhouette if `shown` is False.

    image: picture of the star; x, y: its centre on the canvas; age: time since the star began to drop in [s].
    """
    size = STAR + (whole((STAR_DROP - age) * STAR_GROWTH) if shown and age < STAR_DROP else 0)
    star = pygame.transform.scale(image, (size, size))
    if not shown:
        star.fill((70, 64, 92, 255), special_flags=pygame.BLEND_RGBA_MULT)
    canvas.sprite(star, x, y)
