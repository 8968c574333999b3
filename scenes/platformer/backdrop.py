"""Background of the level: a sky and parallax layers for each act, with a cross-fade between acts."""

from typing import Any

import pygame

from game.drawing.canvas import CANVAS_SIZE, whole
from game.drawing.sprites import load_backdrop

FADE = 0.9  # [s] from one act's backdrop to the next
CLOUDS_TOP = 14  # [canvas px]
HORIZON = 62  # [canvas px] height of the mountains' foot above the lower edge, hidden by the ground
FEET = {"meadow": (26, 24, 48), "keep": (34, 26, 52)}  # colour below the nearest layer, visible from high up
# act -> layers from back to front: (picture, share of the camera's motion along x, along y, own drift [px/s], height
# above the horizon [px]; None: in the sky)
LAYERS = {
    "meadow": (
        ("clouds", 0.05, 0.02, 3.0, None),
        ("mountains_far", 0.10, 0.05, 0.0, 0),
        ("mountains_mid", 0.20, 0.10, 0.0, 0),
        ("mountains_near", 0.42, 0.18, 0.0, 0),
    ),
    "keep": (
        ("clouds", 0.04, 0.02, 4.0, None),
        ("mountains_far", 0.08, 0.04, 0.0, -8),
        ("mountains_mid", 0.16, 0.08, 0.0, -26),
        ("keep_far", 0.30, 0.14, 0.0, -30),
    ),
}
CAVE = (("cave_far", 0.15, 0.10), ("cave_near", 0.40, 0.25))


class Backdrops:
    """Renderer of the background of the current act and, during a cross-fade, of the previous act."""

    def __init__(self, level):
        self.sky = load_backdrop("sky_dusk")
        self.layers: dict[str, list[tuple[Any, ...]]] = {
            act: [(load_backdrop(name), *rest) for name, *rest in layers] for act, layers in LAYERS.items()
        }
        self.cave = [(load_backdrop(name), *rest) for name, *rest in CAVE]
        self.lowest = {act: lowest_view(level, act) for act in ("meadow", "cave", "keep")}
        self.scratch = pygame.Surface(CANVAS_SIZE)

    def draw(self, surface, look, left, top):
        """Draw the background for a view whose top left corner is the world point (left, top) [px].

        look: the scene's Look, which has the current act and the time since it began.
        """
        share = min(look.act_age / FADE, 1.0)
        if share < 1.0 and look.last_act != look.act:
            self._draw_act(surface, look.last_act, look.time, left, top)
            self._draw_act(self.scratch, look.act, look.time, left, top)
            self.scratch.set_alpha(whole(255 * share))
            surface.blit(self.scratch, (0, 0))
        else:
            self._draw_act(surface, look.act, look.time, left, top)

    def _draw_act(self, surface, act, time, left, top):
        if act == "cave":
            for picture, along, down in self.cave:
                y = whole(-(top - self.lowest["cave"]) * down * 0.5) + CANVAS_SIZE[1] - picture.get_height()
                tile_along(surface, picture, left * along, min(max(y, CANVAS_SIZE[1] - picture.get_height()), 0))
            return
        surface.blit(self.sky, (0, 0))
        raised = max(0, self.lowest[act] - top)
        for picture, along, down, drift, above in self.layers[act]:
            y = CLOUDS_TOP if above is None else CANVAS_SIZE[1] - HORIZON - picture.get_height() - above
            y += whole(raised * down)
            tile_along(surface, picture, left * along + time * drift, y)
        below = y + picture.get_height()
        surface.fill(FEET[act], (0, below, CANVAS_SIZE[0], max(CANVAS_SIZE[1] - below, 0)))


def lowest_view(level, act):
    """Return the y [px] of the view's top edge when the camera is at the lowest position in an act."""
    bottoms = [
        zone.y + zone.height for zone in level.zones if zone.properties["act"] == act and zone.width >= CANVAS_SIZE[0]
    ]
    return (max(bottoms) if bottoms else level.size[1]) - CANVAS_SIZE[1]


def tile_along(surface, picture, way, y):
    """Draw copies of a picture side by side across the whole canvas width, with their top edges at `y`.

    way: shift of the row of copies to the left [px].
    """
    width = picture.get_width()
    x = -whole(way) % width - width
    while x < CANVAS_SIZE[0]:
        surface.blit(picture, (x, y))
        x += width
