"""The introduction to "What accuracy costs": a flight past near misses on a split screen, with boxes and with pixels.

Both halves show the same flight, each in its own world. With boxes, the plane dies although there is sky between the
sprites. With pixels, it survives. The numbers of deaths and the step times [us] are shown below. Enter opens the plot
in a real game.
"""

from functools import lru_cache
from math import pi, sin
from time import perf_counter
from typing import NamedTuple

import pygame

from game.drawing.backdrop import Backdrop
from game.drawing.canvas import SMALL, TEXT, Canvas
from game.drawing.colors import FOG, GOLD, GREEN, INK, ORANGE, PAPER, RED, SLATE
from game.drawing.sprites import load_atlas
from game.drawing.typical import Typical
from game.input.inputs import InputState
from game.measure.errors import pairs_of
from game.screens.screen import CanvasScreen
from physics import Effects, World
from physics.annotations import TierName

HALF, FIELD = 240, 196  # [canvas px] width of a half, height of its picture
COUNTS = pygame.Rect(0, FIELD, 2 * HALF, 54)  # [canvas px] the counts below the halves
SPEED = 66.0  # [px/s] of the planes that come down
GAP = 76.0  # [px] between two of them
WEAVE, SWING = 4.6, 42.0  # [s], [px]: the flight's swing to the left and right
PLANE_Y = 150.0  # [canvas px]
COMING = ("gunship_0", "saucer_0", "dart_0", "gunship_1", "hornet_0", "saucer_2", "gunship_2", "dart_1")
CLEAR = 2  # [px] of sky at least between the sprites
DRIFT = 20.0  # [px/s] of the backdrop
GONE = 0.6  # [s] after a death, while the plane explodes and cannot be hit
HITS = 5  # hits by boxes before the times are compared
SECOND = 60  # steps
KEPT = 12  # seconds whose times are compared


class Miss(NamedTuple):
    """An enemy plane that passes close to the player's plane without touching it."""

    sprite: str
    x: float  # [canvas px] within a half
    start: float  # [s] in the loop when it enters the picture


def flight_x(time: float) -> float:
    """Return the x [px] of the player's plane at a time [s].

    It is measured from the left edge of the plane's half of the split screen.
    """
    return HALF / 2 + SWING * sin(2 * pi * time / WEAVE)


def corner(image: pygame.Surface, x: float, y: float) -> tuple[int, int]:
    """Return the pixel (x, y) of an image's top left corner if the image is centred at (x, y)."""
    return round(x) - image.get_width() // 2, round(y) - image.get_height() // 2


@lru_cache
def outlined(sprite: str) -> pygame.Surface:
    """Return a picture of the outline of a sprite's pixels. It has the size of the sprite.

    Drawing this picture takes 2 us, drawing the outline itself 84 us.
    """
    image = load_atlas("planes")[sprite]
    found = pygame.Surface(image.get_size(), pygame.SRCALPHA)
    for place in pygame.mask.from_surface(image).outline():
        found.set_at(place, GREEN)
    return found


@lru_cache
def course(dt: float) -> tuple[list[Miss], float]:
    """Return (enemy planes, length of the loop [s]). dt: length of a step [s].

    Each enemy plane passes as close to the player's plane as possible, with at least CLEAR px of sky in every step.
    """
    planes = load_atlas("planes")
    player = pygame.mask.from_surface(planes["player"])
    grown = player.convolve(pygame.Mask((2 * CLEAR + 1,) * 2, fill=True))
    found = []
    for number, name in enumerate(COMING):
        start, side = number * GAP / SPEED, 1 if number % 2 else -1
        mask = pygame.mask.from_surface(planes[name])
        offset = 0
        while _touches(planes, grown, name, mask, start, side * offset, dt):
            offset += 1
        found.append(Miss(name, _passing_x(start) + side * offset, start))
    length = len(COMING) * GAP / SPEED
    return found, WEAVE * round(length / WEAVE)


def _passing_x(start):
    """Return the x of the player's plane at the time when an enemy plane that enters at `start` [s] is beside it."""
    return flight_x(start + (PLANE_Y + 40.0) / SPEED)


def _touches(planes, grown, name, mask, start, offset, dt):
    """Return whether an enemy plane comes closer than CLEAR px to the player's plane while it passes.

    grown: pygame mask of the player's plane, enlarged by CLEAR px; name, mask: name and pygame mask of the enemy plane,
    which enters at `start` [s]; offset: its sideways distance from the player's plane when it passes [px].
    """
    x, steps = _passing_x(start) + offset, int((FIELD + 80.0) / SPEED / dt)
    for step in range(steps):
        own = corner(planes["player"], flight_x(start + step * dt), PLANE_Y)
        other = corner(planes[name], x, -40.0 + SPEED * step * dt)
        if grown.overlap(mask, (other[0] - own[0] + CLEAR, other[1] - own[1] + CLEAR)):
            return True
    return False


class Flight:
    """One half of the split screen: a world in which all planes have the same collision tier (kind of collision shape).

    step() is called for each time of the loop, in order.
    """

    def __init__(self, tier: TierName, misses: list[Miss]) -> None:
        planes = load_atlas("planes")
        self.tier, self.misses = tier, misses
        self.world = World(Effects())
        self.plane = self.world.add_body(planes.mask("player"), tier=tier)
        self.others = [self.world.add_body(planes.mask(miss.sprite), tier=tier) for miss in misses]
        self.deaths, self.gone, self.touching = 0, 0.0, set()
        self.died_at = (0.0, 0.0)
        self.spent = Typical()
        self.seconds: list[float] = []  # median time of a step, second by second
        self.steps = 0

    def step(self, time: float, length: float, dt: float) -> None:
        """Move all planes to their positions at `time` [s] of the loop, step the world, and count new hits.

        length: length of the loop [s]; dt: length of the step [s].
        """
        places = [(round(flight_x(time)), PLANE_Y)]
        for miss in self.misses:
            since = (time - miss.start) % length
            places.append((round(miss.x), round(-40.0 + SPEED * since)))
        self.world.move([body.id for body in (self.plane, *self.others)], places)
        started = perf_counter()
        self.world.step(dt)
        self.spent.note(perf_counter() - started)
        self.steps += 1
        if self.steps % SECOND == 0:
            self.seconds = [*self.seconds, self.spent.value][-KEPT:]
        self.gone = max(0.0, self.gone - dt)
        hits = {pair for pair in pairs_of(self.world) if self.plane.id in pair}
        if hits - self.touching and self.gone == 0.0:
            self.deaths += 1
            self.gone, self.died_at = GONE, (self.plane.position.x, self.plane.position.y)
        self.touching = hits


class NearMisses(CanvasScreen):
    """Split screen of near misses: the same flight with boxes and with pixels as collision shapes.

    `outcome`, the request for the next screen, becomes ("plot",) for the plot in a game, or ("back",).
    """

    tune = "title"

    def __init__(self, dt: float = 1 / 60) -> None:
        super().__init__()
        self.misses, self.length = course(dt)
        self.flights = Flight("aabb", self.misses), Flight("pixels", self.misses)
        self.flights_in_turn = list(self.flights)
        self.backdrop, self.time, self.drift = Backdrop(), 0.0, 0.0

    def step(self, inputs: InputState, dt: float) -> None:
        """Process the player's input, and advance both worlds by a fixed step of `dt` [s]."""
        if inputs.pressed("cancel"):
            self.cues.append("back")
            self.outcome = ("back",)
        elif inputs.pressed("confirm") or inputs.pointer_pressed:
            self.cues.append("confirm")
            self.outcome = ("plot",)
        self.advance(dt)

    def advance(self, dt: float) -> None:
        """Advance both worlds by dt [s]."""
        self.time = (self.time + dt) % self.length
        self.drift += DRIFT * dt
        # The worlds take turns in being stepped first, because drawing has emptied the caches for the first one.
        self.flights_in_turn.reverse()
        for flight in self.flights_in_turn:
            flight.step(self.time, self.length, dt)

    def price(self) -> str:
        """Return text on the step time with pixels, as a multiple of the step time with boxes; "" before HITS deaths.

        Times are compared second by second. If neither half was faster in every second, the text says "the same time".
        """
        boxes, pixels = self.flights
        if boxes.deaths < HITS or len(boxes.seconds) < HITS:
            return ""
        ratios = [b / a for a, b in zip(boxes.seconds, pixels.seconds, strict=True)]
        if min(ratios) <= 1.0 <= max(ratios):
            return "for the same time"
        return f"for {sorted(ratios)[len(ratios) // 2]:.2f} x the time"

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw both halves of the split screen, and the counts below them."""
        self.backdrop.draw(canvas, self.drift)
        canvas.surface.blit(canvas.surface.subsurface((0, 0, HALF, FIELD)).copy(), (HALF, 0))
        canvas.surface.fill(INK, (0, FIELD, 2 * HALF, canvas.rect.height - FIELD))
        for number, flight in enumerate(self.flights):
            left = number * HALF
            canvas.surface.set_clip((left, 0, HALF, FIELD))
            self._draw_flight(canvas, flight, left, boxes=number == 0)
            canvas.surface.set_clip(None)
            self._draw_counts(canvas, flight, left)
        canvas.surface.fill(SLATE, (HALF - 1, 0, 2, FIELD + 40))
        boxes, pixels = self.flights
        price = self.price()
        if price:
            lived = f"{pixels.deaths} times" if pixels.deaths else "never"
            sentence = f"One flight: by boxes it died {boxes.deaths} times, by pixels {lived}, {price}."
            canvas.text(sentence, canvas.rect.centerx, 240, PAPER, TEXT, 1, "center")
        foot = "Enter: measured in a real game   Esc back"
        canvas.text(foot, canvas.rect.centerx, 256, FOG, SMALL, 1, "center")

    def _draw_flight(self, canvas, flight, left, boxes):
        planes, plane = load_atlas("planes"), flight.plane
        bodies = list(zip((miss.sprite for miss in self.misses), flight.others, strict=True))
        if flight.gone == 0.0:
            bodies.append(("player", plane))
        touched = {identity for pair in flight.touching for identity in pair}
        for name, body in bodies:
            image = planes[name]
            place = corner(image, left + body.position.x, body.position.y)
            canvas.surface.blit(image, place)
            if boxes:
                color = RED if body.id in touched else ORANGE
                pygame.draw.rect(canvas.surface, color, image.get_bounding_rect().move(place), 1)
            else:
                canvas.surface.blit(outlined(name), place)
        if flight.gone > 0.0:
            explosion = load_atlas("effects").animation("explosion_small").at(GONE - flight.gone, loop=False)
            x, y = flight.died_at
            canvas.surface.blit(explosion, corner(explosion, left + x, y))

    def _draw_counts(self, canvas, flight, left):
        ui = load_atlas("ui")
        name = "boxes" if flight.tier == "aabb" else "pixels"
        canvas.text(name, left + 12, FIELD + 8, ORANGE if name == "boxes" else GREEN, TEXT, 2)
        canvas.surface.blit(ui["icon_skull"], (left + 104, FIELD + 12))
        canvas.text(str(flight.deaths), left + 118, FIELD + 8, RED if flight.deaths else PAPER, TEXT, 2)
        micro = f"{1e6 * flight.spent.value:.0f} us" if flight.steps >= SECOND else "measuring"
        canvas.text(micro, left + HALF - 12, FIELD + 8, GOLD, TEXT, 2, "right")
