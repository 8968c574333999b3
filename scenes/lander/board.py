"""Heads-up display of the lander: points, ships, landing site, instruments, wind, and a map of the moon."""

from functools import lru_cache
from math import hypot

import pygame

from game.drawing.canvas import CANVAS_SIZE, SMALL, TEXT, whole
from game.drawing.colors import GOLD, INK, PAPER, RED, SKY, SLATE
from game.drawing.hud import MARGIN, icons
from game.drawing.number_text import short_clock
from game.drawing.sprites import load_atlas
from scenes.lander.feel import FUEL, HARD, HULL, LOW_FUEL, SHELLS, SOFT, UPRIGHT
from scenes.lander.moon import the_moon

GOOD, FAIR = (120, 230, 150), (255, 214, 92)
PANEL = (MARGIN, 224, 118, 40)  # [canvas px] panel of fuel, hull, shells
DIALS = (MARGIN + 122, 224, 66, 40)  # [canvas px] panel of speeds and lean
CHART = (480 - MARGIN - 130, 230, 130, 34)
WIND = (480 - MARGIN - 130, 217, 130, 12)
GLASS = (14, 12, 26, 178)
BAR = 76  # [px]
NEWS = 252  # steps after the start of an act from which the site's name is shown at the top
FADE = 0.55  # [s] after which a rising word is written darker
HELD = ((0, 0, 130, 30), (350, 0, 130, 30), (0, 220, 200, 50), (340, 214, 140, 56), (130, 0, 220, 20))
SLOWEST_WIND = 8.0  # [px/s] wind below this is shown as calm
FULL_WIND = 190.0
EDGE = 18  # [px] from the picture's edge to the arrow towards a site out of sight


def draw_words(canvas, scene, view, covered):
    """Draw the short texts that rise from events in the world.

    view: world point (x, y) [px] at the picture's top left corner; covered: rectangle of a banner, where no text is
    drawn.
    """
    for rect in (*HELD, covered):
        canvas.reserve(rect)
    left, top = view
    for text, x, y, age, color in scene.spectacle.works.words:
        faded = tuple(c * 2 // 3 for c in color) if age > FADE else color
        canvas.text_if_free(text, x - left, y - top, faded, SMALL, align="center", outline=True)


def draw_board(canvas, scene, view):
    """Draw the heads-up display. view: world point (x, y) [px] at the picture's top left corner."""
    _draw_score(canvas, scene)
    _draw_ships(canvas, scene)
    _draw_site(canvas, scene, view)
    _draw_stock(canvas, scene)
    _draw_dials(canvas, scene)
    _draw_wind(canvas, scene)
    _draw_chart(canvas, scene, view)


def _draw_score(canvas, scene):
    pulse = scene.spectacle.pulse
    points = scene.score.points
    canvas.text(f"{points:08d}", MARGIN, MARGIN - whole(2 * pulse), GOLD if pulse > 0.4 else PAPER, TEXT, outline=True)
    if scene.best:
        canvas.text(f"BEST {max(scene.best, points):08d}", MARGIN, MARGIN + 11, PAPER, SMALL, outline=True)


def _draw_ships(canvas, scene):
    image, ship = load_atlas("lander")["icon_lander"], scene.ship
    right = canvas.rect.right - MARGIN
    spare = max(ship.lives - ship.here, 0)
    icons(canvas, image, spare, right - spare * (image.get_width() + 2) + 2, MARGIN - 1)
    canvas.text(short_clock(scene.course.clock / 60), right, MARGIN + 13, PAPER, SMALL, align="right", outline=True)
    cargo = load_atlas("lander")["icon_cargo"]
    text = canvas.text(
        f"{scene.score.delivered}/{scene.yard.in_all}",
        right - 26,
        MARGIN + 13,
        PAPER,
        SMALL,
        align="right",
        outline=True,
    )
    canvas.surface.blit(cargo, (text.left - cargo.get_width() - 1, MARGIN + 11))


def _draw_site(canvas, scene, view):
    """Draw the name and distance of the landing site at the top of the picture.

    While the site is outside the picture, also draw an arrow at the picture's edge that points to it.
    """
    course, ship = scene.course, scene.ship
    if course.over or scene.spectacle.act_since < NEWS:
        if not course.over:
            _draw_arrow(canvas, scene, view)
        return
    far = hypot(course.site.x - ship.x, course.site.y - ship.y)
    canvas.text(
        f"{course.act + 1}  {course.site.title}  {far / 4:.0f} m",
        canvas.rect.centerx,
        MARGIN,
        GOLD,
        TEXT,
        align="center",
        outline=True,
    )
    _draw_arrow(canvas, scene, view)


def _draw_arrow(canvas, scene, view):
    site = scene.course.site
    x, y = site.x - view[0], site.y - 20 - view[1]
    width, height = CANVAS_SIZE
    if 0 < x < width and 0 < y < height:
        return
    at_x, at_y = min(max(x, EDGE), width - EDGE), min(max(y, EDGE + 16), height - EDGE - 50)
    far = max(hypot(x - at_x, y - at_y), 1.0)
    dx, dy = (x - at_x) / far, (y - at_y) / far
    lift = 2.0 * abs((scene.spectacle.time * 1.6) % 2.0 - 1.0)
    at_x, at_y = at_x + dx * lift, at_y + dy * lift
    points = [(9, 0), (-5, -6), (-2, 0), (-5, 6)]
    turned = [(at_x + px * dx - py * dy, at_y + px * dy + py * dx) for px, py in points]
    pygame.draw.polygon(canvas.surface, GOLD, turned)
    pygame.draw.polygon(canvas.surface, INK, turned, 1)


def _draw_stock(canvas, scene):
    """Draw the panel with the levels of fuel and hull and the number of shells."""
    ship, atlas, gain = scene.ship, load_atlas("lander"), scene.spectacle.gain
    left, top, _, _ = PANEL
    canvas.surface.blit(glass(PANEL[2:]), PANEL[:2])
    canvas.fix(PANEL)
    low = ship.fuel < LOW_FUEL
    blink = low and scene.accessibility.flashing and int(scene.spectacle.time * 4) % 2
    rows = (
        ("icon_fuel", "FUEL", ship.fuel / FUEL, (255, 250, 200) if blink else RED if low else FAIR),
        ("icon_hull", "HULL", ship.hull / HULL, RED if scene.spectacle.battered else GOOD),
    )
    for number, (icon, _, share, color) in enumerate(rows):
        y = top + 4 + 12 * number
        image = atlas[icon]
        canvas.surface.blit(image, (left + 4, y + 4 - image.get_height() // 2))
        _bar(canvas.surface, (left + 16, y, BAR, 8), share, color, gain)
        canvas.text(f"{share * 100:3.0f}", left + 113, y + 2, PAPER, SMALL, align="right")
    y, image = top + 29, atlas["icon_shell"]
    for number in range(SHELLS):
        if number < ship.shells:
            canvas.surface.blit(image, (left + 15 + 8 * number, y - 1))
        else:
            canvas.surface.fill(SLATE, (left + 18 + 8 * number, y + 2, 2, 2))
    canvas.surface.blit(image, (left + 4, y - 1))


def _bar(surface, rect, share, color, gain):
    """Draw a bar with a tick at each quarter.

    rect: (left, top, width, height) on the surface; share: filled part, 0..1; gain: extra brightness, from 1 just
    after an increase to 0.
    """
    left, top, width, height = rect
    surface.fill(INK, rect)
    long = round((width - 2) * max(0.0, min(share, 1.0)))
    if gain > 0.0:
        color = tuple(whole(c + (255 - c) * 0.5 * gain) for c in color)
    surface.fill(color, (left + 1, top + 1, long, height - 2))
    surface.fill(tuple(min(c + 70, 255) for c in color), (left + 1, top + 1, long, 1))
    surface.fill(tuple(c * 2 // 3 for c in color), (left + 1, top + height - 2, long, 1))
    for quarter in (1, 2, 3):
        surface.fill(INK, (left + width * quarter // 4, top + 1, 1, height - 2))


def _draw_dials(canvas, scene):
    """Draw the panel with vertical speed, horizontal speed and lean. Values that are not safe for a landing are red."""
    ship = scene.ship
    left, top, _, _ = DIALS
    canvas.surface.blit(glass(DIALS[2:]), DIALS[:2])
    canvas.fix(DIALS)
    degrees = ship.angle * 57.29578
    rows = (
        ("\u2193" if ship.vy >= 0.0 else "\u2191", f"{abs(ship.vy):.0f}", judged(max(ship.vy, 0.0), SOFT, HARD)),
        ("\u2192" if ship.vx >= 0.0 else "\u2190", f"{abs(ship.vx):.0f}", judged(abs(ship.vx), SOFT * 0.7, HARD * 0.7)),
        ("LEAN", f"{abs(degrees):.0f}", judged(abs(ship.angle), 0.5 * UPRIGHT, UPRIGHT)),
    )
    for number, (name, value, color) in enumerate(rows):
        y = top + 4 + 12 * number
        canvas.text(name, left + 5, y, PAPER, TEXT if len(name) == 1 else SMALL)
        canvas.text(value, left + 50, y, color, TEXT, align="right")
        canvas.surface.fill(INK, (left + 54, y, 7, 7))
        canvas.surface.fill(color, (left + 55, y + 1, 5, 5))


def judged(value, good, fair):
    """Return the colour of a value: green up to the value `good`, gold up to `fair`, red beyond."""
    return GOOD if value <= good else FAIR if value <= fair else RED


def _draw_wind(canvas, scene):
    """Draw an arrow whose length shows the strength of the wind."""
    left, top, width, height = WIND
    canvas.surface.blit(glass((width, height)), (left, top))
    canvas.fix(WIND)
    wind = scene.weather.wind
    canvas.text("WIND", left + 4, top + 3, PAPER, SMALL)
    middle, y = left + 72, top + 6
    canvas.surface.fill(SLATE, (middle, y - 3, 1, 7))
    if abs(wind) < SLOWEST_WIND:
        canvas.text("calm", left + width - 4, top + 3, PAPER, SMALL, align="right")
        return
    way, long = (1 if wind > 0 else -1), min(abs(wind) / FULL_WIND, 1.0) * 32
    color = RED if abs(wind) > 0.6 * FULL_WIND else FAIR if abs(wind) > 0.3 * FULL_WIND else SKY
    tip = middle + whole(way * (long + 3))
    canvas.surface.fill(color, (min(middle, tip), y, abs(tip - middle), 1))
    for back in (1, 2, 3):
        canvas.surface.fill(color, (tip - way * back, y - back + 1, 1, 2 * back - 1))
    canvas.text(f"{abs(wind):.0f}", left + width - 4, top + 3, PAPER, SMALL, align="right")


def _draw_chart(canvas, scene, view):
    """Draw a map of the whole moon with pads, cargo, ship, and the rectangle of the current view.

    view: world point (x, y) [px] at the picture's top left corner.
    """
    left, top, width, height = CHART
    surface, moon = canvas.surface, scene.moon
    surface.blit(chart((width, height)), (left, top))
    canvas.fix(CHART)

    def at(x, y):
        return left + 1 + whole(x / moon.width * (width - 2)), top + 1 + whole(max(y, 0) / moon.height * (height - 2))

    seen_x, seen_y = at(view[0], view[1])
    pygame.draw.rect(
        surface,
        SLATE,
        (seen_x, seen_y, whole(480 / moon.width * (width - 2)), whole(270 / moon.height * (height - 2))),
        1,
    )
    for piece in scene.yard.cargo.values():
        surface.fill((255, 150, 60), (*at(*piece.body.position), 2, 2))
    for number, pad in enumerate(moon.pads):
        x, y = at(pad.x, pad.y)
        goal = pad is scene.course.site and not scene.course.over
        surface.fill(GOLD if goal else GOOD if number <= scene.score.landings else SLATE, (x - 2, y - 1, 5, 2))
        if goal and int(scene.spectacle.time * 3) % 2:
            surface.fill(GOLD, (x, y - 4, 1, 3))
    if scene.ship.here:
        x, y = at(scene.ship.x, scene.ship.y)
        surface.fill((255, 255, 255), (x - 1, y, 3, 1))
        surface.fill((255, 255, 255), (x, y - 1, 1, 3))


def chevron(surface, x, y):
    """Draw the mark above the pad that is the landing site. x, y: position of the mark [canvas px]."""
    for row in range(6):
        surface.fill(INK, (x - 7 + row, y + row - 1, 15 - 2 * row, 3))
    for row in range(5):
        surface.fill(GOLD, (x - 5 + row, y + row, 11 - 2 * row, 1))


def hook_mark(surface, x, y, inside):
    """Draw the mark above a piece of cargo at (x, y) [canvas px].

    inside: True if the line can reach the cargo; then the mark is green.
    """
    color = GOOD if inside else PAPER
    for row in range(5):
        surface.fill(INK, (x - 5 + row, y + row - 1, 11 - 2 * row, 3))
    for row in range(4):
        surface.fill(color, (x - 3 + row, y + row, 7 - 2 * row, 1))


@lru_cache(maxsize=8)
def glass(size):
    """Return a Surface of `size` (width, height) for the background of a panel: dark, half transparent, with a thin
    edge.
    """
    out = pygame.Surface(size, pygame.SRCALPHA)
    out.fill(GLASS)
    pygame.draw.rect(out, (*SLATE, 130), (0, 0, *size), 1)
    return out


@lru_cache(maxsize=2)
def chart(size):
    """Return a Surface of `size` (width, height) with a small picture of the moon's rock and caves, for the map."""
    moon = the_moon()
    out = glass(size).copy()
    width, height = size[0] - 2, size[1] - 2
    for picture, color in ((moon.wall, (64, 62, 96)), (moon.picture, (120, 124, 160))):
        silhouette = pygame.mask.from_surface(picture).to_surface(setcolor=(*color, 255), unsetcolor=(0, 0, 0, 0))
        out.blit(pygame.transform.smoothscale(silhouette, (width, height)), (1, 1))
    return out
