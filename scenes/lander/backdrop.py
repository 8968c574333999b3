"""Background of the lander: a fixed sky, clouds, three mountain ranges with parallax, and snow in the wind."""

import numpy as np
import pygame

from game.drawing.canvas import CANVAS_SIZE, whole
from game.drawing.sprites import load_backdrop
from scenes.platformer.backdrop import tile_along

# back to front: (picture, share of the camera's motion along x, along y, height of its foot above the horizon [px])
LAYERS = (("lander_far", 0.06, 0.05, 44), ("lander_mid", 0.13, 0.11, 16), ("lander_near", 0.26, 0.22, -14))
LOWEST = 754  # [px] y of the top of the picture when the camera is lowest
STORM = (2650.0, 3250.0)  # [px] x from which the clouds come down, and at which they are lowest
CLOUDS = ((0.03, 0.10, 4), (0.08, 0.20, -40))  # (share of the camera's motion, of the wind's motion, top [px])
FLAKES = 70  # flakes in each of the two layers of snow
# (share of the camera's motion, of the wind's motion, fall [px/s], colour, thickness)
SNOW = ((0.5, 0.55, 16.0, (126, 146, 190), 1), (1.25, 1.3, 34.0, (214, 228, 250), 1))
STREAK = 0.028  # [s] exposure: a flake is drawn as the streak of its motion in this time


class Backdrop:
    """Renderer of the background, and of the snow in the foreground."""

    def __init__(self):
        self.sky = load_backdrop("lander_sky")
        self.layers = [(load_backdrop(name), *rest) for name, *rest in LAYERS]
        self.clouds = load_backdrop("lander_clouds")
        random = np.random.default_rng(8)
        self.flakes = [random.random((3, FLAKES)) for _ in SNOW]

    def draw(self, surface, look, left, top):
        """Draw the background for a view whose top left corner is the world point (left, top) [px].

        look: the scene's Spectacle, which has the time and the path of the wind.
        """
        surface.blit(self.sky, (0, 0))
        share = min(max((left + CANVAS_SIZE[0] / 2 - STORM[0]) / (STORM[1] - STORM[0]), 0.0), 1.0)
        if share:
            self._draw_clouds(surface, look, left, share)
        for picture, along, down, above in self.layers:
            y = CANVAS_SIZE[1] - picture.get_height() - above + whole((LOWEST - top) * down * 0.5)
            tile_along(surface, picture, left * along, y)
            foot = y + picture.get_height()
            if foot < CANVAS_SIZE[1]:
                # Below its picture, the range is filled with its lowest colour.
                color = picture.get_at((0, picture.get_height() - 1))
                surface.fill(color, (0, foot, CANVAS_SIZE[0], CANVAS_SIZE[1] - foot))

    def _draw_clouds(self, surface, look, left, share):
        """Draw banks of cloud that the wind moves.

        look: the scene's Spectacle; left: x of the view's left edge [px]; share: how far the clouds have come down for
        the storm, from 0 (above the picture) to 1 (lowest).
        """
        for along, carried, low in CLOUDS:
            y = whole(low * share - self.clouds.get_height() * (1.0 - share))
            tile_along(surface, self.clouds, left * along - look.gusted * carried - look.time * 7.0, y)

    def draw_snow(self, surface, layer, look, wind, left, top):
        """Draw one layer of snow, with more flakes in a strong wind and fewer in a cave.

        layer: index of the layer in SNOW; look: the scene's Spectacle; wind: speed of the wind [px/s]; left, top:
        world point at the view's top left corner [px].
        """
        share, carried, fall, color, thick = SNOW[layer]
        across, down, speed = self.flakes[layer]
        shown = whole(FLAKES * (1.0 - look.shelter) * (0.45 + min(abs(wind) / 160.0, 0.55)))
        width, height = CANVAS_SIZE[0] + 40, CANVAS_SIZE[1] + 20
        own = 0.7 + 0.6 * speed
        x = (across * width + look.gusted * carried * own - left * share) % width - 20
        y = (down * height + look.time * fall * own - top * share) % height - 10
        long_x, long_y = wind * carried * STREAK, fall * STREAK
        for number in range(shown):
            start = (x[number], y[number])
            end = (x[number] - long_x * own[number], y[number] - long_y)
            pygame.draw.line(surface, color, start, end, thick)
