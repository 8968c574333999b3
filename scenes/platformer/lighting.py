"""Light of the platformer: glows that brighten the picture, and the darkness of the cave."""

from functools import lru_cache

import pygame

from game.drawing.canvas import CANVAS_SIZE, whole
from game.drawing.sprites import load_atlas

AMBIENT = (136, 132, 180)  # share of each colour left where the cave is darkest
STEPS = 12  # levels of darkness, each with light discs of its own
GRAIN = 2  # [px] step between the radii of a flickering light, so that few pictures are cached
BRIGHTEST = 0.62  # share of a light's colour in the middle of its disc
WARM = ("torch", "lantern", "window", "fuse")  # these keep their drawn colours, the others are cold
# name -> (share of the radius that flickers, speed of the flicker [rad/s], radius of the glow [px], radius of the
# light in the dark [px], colour)
SHINES = {
    "torch": (0.10, 11.0, 32, 92, (255, 206, 150)),
    "lantern": (0.05, 5.0, 32, 100, (255, 220, 170)),
    "crystal_0": (0.06, 1.6, 20, 60, (130, 235, 235)),
    "crystal_1": (0.06, 1.9, 20, 60, (130, 235, 235)),
    "glowcap": (0.08, 1.2, 16, 50, (150, 255, 190)),
    "window": (0.04, 6.0, 20, 60, (255, 206, 150)),
    "hero": (0.02, 1.0, 0, 104, (226, 222, 240)),
    "secret": (0.12, 2.0, 22, 62, (150, 255, 240)),
    "goal": (0.04, 2.0, 0, 80, (255, 230, 190)),
    "fuse": (0.30, 40.0, 14, 44, (255, 216, 150)),
    "blast": (0.0, 1.0, 0, 150, (255, 220, 170)),
    "coin": (0.0, 1.0, 0, 22, (210, 180, 110)),
}


class Lighting:
    """Renderer of light. It draws above the world and below the heads-up display."""

    def __init__(self):
        self.cover = pygame.Surface(CANVAS_SIZE)

    def draw(self, surface, lights, dark, time):
        """Darken the parts of the picture that no light reaches, and draw the glows of the lights.

        lights: list of (x [canvas px], y [canvas px], name); dark: darkness, 0..1; time: time [s], for the flicker.
        """
        level = whole(dark * STEPS)
        if level:
            self.cover.fill([whole(255 - (255 - part) * level / STEPS) for part in AMBIENT])
            for x, y, name in lights:
                flicker, speed, _, radius, color = SHINES[name]
                image = disc(flickering(radius, flicker, speed, time, x), color, level / STEPS)
                self.cover.blit(
                    image,
                    (whole(x) - image.get_width() // 2, whole(y) - image.get_height() // 2),
                    special_flags=pygame.BLEND_RGB_ADD,
                )
            surface.blit(self.cover, (0, 0), special_flags=pygame.BLEND_RGB_MULT)
        for x, y, name in lights:
            flicker, speed, radius, _, _ = SHINES[name]
            if radius:
                image = glow(flickering(radius, flicker, speed, time, x), name in WARM)
                surface.blit(
                    image,
                    (whole(x) - image.get_width() // 2, whole(y) - image.get_height() // 2),
                    special_flags=pygame.BLEND_RGB_ADD,
                )


def flickering(radius, share, speed, time, x):
    """Return the current radius [px] of a flickering light. radius: full radius of the light [px].

    share: part of the radius that flickers, 0..1; speed: angular frequency of the flicker [rad/s]; time: time [s]; x:
    position of the light [px], which shifts the phase of the flicker.
    """
    return GRAIN * whole(radius * (1.0 - share + share * wave(time * speed / 6.28 + x * 0.013)) / GRAIN)


@lru_cache(maxsize=128)
def glow(radius, warm):
    """Return a Surface with a glow of this radius [px]. warm: False exchanges red and blue, which makes a
    bluish glow.
    """
    image = pygame.transform.scale(load_atlas("things")["lantern_light"], (2 * radius, 2 * radius))
    if not warm:
        pixels = pygame.surfarray.pixels3d(image)
        pixels[:] = pixels[:, :, ::-1] // 2
        del pixels
    return image


@lru_cache(maxsize=128)
def disc(radius, color, share):
    """Return a Surface with a round light of this radius [px] and colour, in rings that darken outwards.

    share: strength of the light, 0..1, in proportion to the darkness around it.
    """
    image = pygame.Surface((2 * radius, 2 * radius))
    rings = max(radius // 5, 3)
    for ring in range(rings):
        part = (ring + 1) / rings
        pygame.draw.circle(
            image,
            [whole(c * share * BRIGHTEST * part * part) for c in color],
            (radius, radius),
            whole(radius * (1.0 - ring / rings)),
        )
    return image


def wave(turns):
    """Return an approximation of sin(2 pi turns) by two parabolas, which is faster than a sine."""
    part = turns % 1.0
    return 16.0 * part * (0.5 - part) if part < 0.5 else -16.0 * (part - 0.5) * (1.0 - part)
