"""Light and lines: shock waves, the bomb's blast, the ring and the core of the player."""

from functools import lru_cache

import pygame

from game.drawing.sprites import load_atlas
from scenes.shooter.bomb import BURN, GROW
from scenes.shooter.fireworks import RING_LIFE

LINE = (150, 236, 255)
WAVE = (255, 214, 150)
SHADES = 8                   # of a fading shock wave


def draw_rings(view, works):
    """Shock waves: thin circles of light that grow quickly, then slowly, and fade."""
    for x, y, radius, age in works.rings:
        share = age / RING_LIFE
        grown = max(4, int(radius * (1.0 - (1.0 - share) ** 3)))
        bright = SHADES - int(share * SHADES)
        image = wave(grown // 4 * 4 + 4, bright)
        half = image.get_width() // 2
        view.surface.blit(image, view.at(x, y, (half, half)), special_flags=pygame.BLEND_RGB_ADD)


def draw_bomb(view, scene):
    """The blast: its ring as it grows, then a light that fades."""
    bomb = scene.bomb
    if bomb.body is None:
        return
    effects = load_atlas("effects")
    frames = effects.animation("bomb_ring").images
    image = next((each for each in frames if each.get_width() >= 2 * bomb.radius - 24), frames[-1])
    half = image.get_width() // 2
    left = 1.0 - max(bomb.age - GROW, 0) / (BURN - GROW)
    if left < 1.0:
        image = faded(image, int(left * 10))
    view.surface.blit(blast(int(left * 10)), view.at(bomb.x, bomb.y, (120, 120)), special_flags=pygame.BLEND_RGB_ADD)
    view.surface.blit(image, view.at(bomb.x, bomb.y, (half, half)))


@lru_cache(maxsize=600)
def wave(radius, bright):
    """A circle of light, `bright` of SHADES."""
    image = pygame.Surface((2 * radius + 2, 2 * radius + 2))
    color = [c * bright // SHADES // 2 for c in WAVE]
    pygame.draw.circle(image, color, (radius + 1, radius + 1), radius, max(1, min(3, radius // 12)))
    return image


@lru_cache(maxsize=12)
def blast(tenths):
    """The light inside a blast: bright in the middle, dithered rings outwards."""
    image = pygame.Surface((240, 240))
    for number, radius in enumerate(range(116, 10, -14)):
        level = (6 + 5 * number) * tenths // 10
        pygame.draw.circle(image, (level // 2, level * 3 // 4, level), (120, 120), radius)
    return image


@lru_cache(maxsize=80)
def faded(image, tenths):
    """A clearer copy."""
    copy = image.copy()
    copy.fill((255, 255, 255, 255 * tenths // 10), special_flags=pygame.BLEND_RGBA_MULT)
    return copy


@lru_cache(maxsize=4)
def faint(image):
    """The core while nobody looks for it."""
    copy = image.copy()
    copy.fill((255, 255, 255, 120), special_flags=pygame.BLEND_RGBA_MULT)
    return copy


@lru_cache(maxsize=2)
def circle_line(radius):
    """The ring that bullets graze."""
    image = pygame.Surface((2 * radius + 2, 2 * radius + 2), pygame.SRCALPHA)
    pygame.draw.circle(image, (*LINE, 110), (radius + 1, radius + 1), radius, 1)
    return image
