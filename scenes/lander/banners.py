"""Banners across the picture of the lander: title of an act, points of a landing, bonuses, and the final result."""

from math import inf

from game.drawing.canvas import CANVAS_SIZE, TEXT, whole
from game.drawing.colors import FOG, GOLD, PAPER, RED, SKY
from game.drawing.hud import banner
from game.drawing.number_text import clock, count_text, points_text
from scenes.lander.course import CHEER, CLEARED, FLYING, LANDED, LOST, TITLE, WON
from scenes.shooter.banners import band, eased, text_inside

ACTS = ("ACT I", "ACT II", "ACT III")
MEDAL = {"GOLD": GOLD, "SILVER": (206, 214, 230), "BRONZE": (226, 150, 92)}
TITLE_TOP, LANDED_TOP, CLEARED_TOP = 28, 28, 34
TITLE_HIGH, LANDED_HIGH = 80, 62  # [px] heights of the bands of these banners
ROW, COLUMN = 13, 78  # [px] distance of two lines, and of two columns
SMOKE = 40  # steps for which the last landing stays visible


def draw_banners(canvas, scene):
    """Draw the banner of the course's current mode, if this mode has one."""
    course = scene.course
    if course.mode == LOST:
        banner(canvas, "GAME OVER", _summary(scene), RED)
    elif course.mode == WON:
        banner(canvas, f"{scene.score.medal} MEDAL", _summary(scene), MEDAL[scene.score.medal])
    elif course.mode == CLEARED:
        _draw_bonuses(canvas, scene)
    elif course.mode == LANDED:
        _draw_landed(canvas, scene)
    elif scene.spectacle.act_since < TITLE:
        _draw_title(canvas, scene)


def covered(scene):
    """Return the rectangle (left, top, width, height) of the current banner [canvas px]; height 0 means no banner."""
    course = scene.course
    if course.mode == FLYING:
        high = TITLE_HIGH if scene.spectacle.act_since < TITLE else 0
        return (0, TITLE_TOP, CANVAS_SIZE[0], high)
    if course.mode == LANDED:
        return (0, LANDED_TOP, CANVAS_SIZE[0], LANDED_HIGH)
    return (0, 0, *CANVAS_SIZE)


def _draw_title(canvas, scene):
    """Draw the number of the act, the name of its landing site, and two lines of instructions.

    The texts slide in from both sides.
    """
    course = scene.course
    share = eased(scene.spectacle.act_since, TITLE)
    middle, width = canvas.rect.centerx, canvas.rect.width
    band(canvas, canvas.rect, TITLE_TOP, whole(TITLE_HIGH * share))
    if share < 0.4:
        return
    off = (1.0 - share) * width
    text_inside(canvas, canvas.rect, ACTS[course.act], middle - off, TITLE_TOP + 7, SKY, 1)
    text_inside(canvas, canvas.rect, course.site.title, middle + off, TITLE_TOP + 19, GOLD, 3)
    text_inside(canvas, canvas.rect, course.site.hint, middle - off, TITLE_TOP + 48, PAPER, 1)
    text_inside(canvas, canvas.rect, course.site.more, middle + off, TITLE_TOP + 62, FOG, 1)


def _draw_landed(canvas, scene):
    """Draw the points of a landing in columns, while the ship is refuelled."""
    course = scene.course
    share = eased(course.since, CHEER)
    band(canvas, canvas.rect, LANDED_TOP, whole(LANDED_HIGH * share))
    if share < 0.9:
        return
    canvas.text(f"{course.site.title} REACHED", canvas.rect.centerx, LANDED_TOP + 8, GOLD, TEXT, 2, "center", True)
    for number, (name, points) in enumerate(course.counted):
        x = canvas.rect.centerx + COLUMN * (number - (len(course.counted) - 1) / 2)
        canvas.text(name, x, LANDED_TOP + 31, PAPER, TEXT, align="center", outline=True)
        canvas.text(f"+{points:,}", x, LANDED_TOP + 43, SKY if points else PAPER, TEXT, align="center", outline=True)


def _draw_bonuses(canvas, scene):
    """Draw the bonuses that have been counted so far at the end of the course, one per line."""
    course = scene.course
    share = eased(course.since - SMOKE, inf)
    band(canvas, canvas.rect, CLEARED_TOP, whole(178 * share))
    if share < 0.9:
        return
    canvas.text("ALL SITES REACHED", canvas.rect.centerx, CLEARED_TOP + 8, GOLD, TEXT, 3, "center", True)
    _rows(canvas, course.counted, CLEARED_TOP + 40)


def _rows(canvas, rows, top):
    for number, (name, points) in enumerate(rows):
        y = top + ROW * number
        canvas.text(name, 150, y, PAPER, TEXT, outline=True)
        canvas.text(f"+{points:,}", 330, y, SKY if points else PAPER, TEXT, align="right", outline=True)


def _summary(scene):
    score = scene.score
    counts = (
        count_text(score.landings, "site"),
        f"cargo {score.delivered} of {scene.yard.in_all}",
        f"{count_text(score.lost, 'ship')} lost",
        clock(scene.course.clock / 60),
    )
    return [f"{points_text(score.points)} points", "   ".join(counts), "R: fly again"]
