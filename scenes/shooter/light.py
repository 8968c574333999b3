"""Pictures of light: shock waves, the bomb's blast, the graze ring around the player."""

from functools import lru_cache

import pygame

from scenes.shooter.bomb import BURN, GROW
from scenes.shooter.fireworks import RING_LIFE

LINE = (150, 236, 255)
WAVE = (255, 214, 150)
SHADES = 8  # steps of brightness of a fading shock wave
ROUNDING = 4  # [px] step between the drawn radii, so that few pictures are cached
BLAST = 120  # [px] radius of the light of a blast
INSIDE = 12  # [px] by which the drawn ring may be smaller than the blast


def draw_rings(view, works):
    """Draw the shock waves of `works`, a Fireworks: thin circles of light that grow at a falling rate and fade.

    view: the scene's View.
    """
    for x, y, radius, age in works.rings:
        share = age / RING_LIFE
        grown = max(4, int(radius * (1.0 - (1.0 - share) ** 3)))
        bright = SHADES - int(share * SHADES)
        view.add_light(wave(grown // ROUNDING * ROUNDING + ROUNDING, bright), x, y)


def draw_bomb(view, scene):
    """Draw the bomb's blast: a growing ring filled with light. The blast fades after it has grown.

    view: the scene's View.
    """
    bomb = scene.bomb
    if bomb.body is None:
        return
    frames = view.effects.animation("bomb_ring").images
    image = next((each for each in frames if each.get_width() >= 2 * (bomb.radius - INSIDE)), frames[-1])
    half = image.get_width() // 2
    left = 1.0 - max(bomb.age - GROW, 0) / (BURN - GROW)
    if left < 1.0:
        image = faded(image, 255 * int(left * 10) // 10)
    view.add_light(blast(int(left * 10)), bomb.x, bomb.y)
    view.surface.blit(image, view.at(bomb.x, bomb.y, (half, half)))


@lru_cache(maxsize=600)
def wave(radius, bright):
    """Return a Surface with a circle of light. radius: its radius [px]; bright: brightness, 0..SHADES."""
    image = pygame.Surface((2 * radius + 2, 2 * radius + 2))
    color = [c * bright // SHADES // 2 for c in WAVE]
    pygame.draw.circle(image, color, (radius + 1, radius + 1), radius, max(1, min(3, radius // 12)))
    return image


@lru_cache(maxsize=12)
def blast(tenths):
    """Return a Surface with the light inside a bomb's blast, brightest at the centre. tenths: brightness, 0..10."""
    image = pygame.Surface((2 * BLAST, 2 * BLAST))
    for number, radius in enumerate(range(BLAST - 4, 10, -14)):
        level = (6 + 5 * number) * tenths // 10
        pygame.draw.circle(image, (level // 2, level * 3 // 4, level), (BLAST, BLAST), radius)
    return image


@lru_cache(maxsize=80)
def faded(image, alpha):
    """Return a copy of an image with its alpha scaled by `alpha` / 255."""
    copy = image.copy()
    copy.fill((255, 255, 255, alpha), special_flags=pygame.BLEND_RGBA_MULT)
    return copy


@lru_cache(maxsize=2)
def circle_line(radius):
    """Return a Surface with the graze ring, a thin circle. radius: its radius [px]."""
    image = pygame.Surface((2 * radius + 2, 2 * radius + 2), pygame.SRCALPHA)
    pygame.draw.circle(image, (*LINE, 110), (radius + 1, radius + 1), radius, 1)
    return image
