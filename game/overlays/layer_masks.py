"""Pixel masks as they are tested, and the pixels that the AND of two masks leaves.

Drawn on the canvas, before it is scaled: a mask pixel is a canvas pixel, so the overlay lies exactly on
the sprite.
"""

from collections import OrderedDict

import numpy as np
import pygame

from game.drawing.blit import blit_many
from game.drawing.camera import Camera
from game.drawing.canvas import Canvas
from game.drawing.colors import BLUE, YELLOW, toned
from game.overlays.layer import Layer, LegendLine
from physics import World, debug

FILL = 96  # opacity of 255 of a mask's inside
EDGE = (150, 210, 255, 255)
HIT = (255, 250, 150, 255)
CACHE_SIZE = 512  # tinted masks kept; a turning sprite has one per angle bucket


class Masks(Layer):
    """Every mask in blue with a light edge; pixels that two masks share in yellow."""

    name, title, key, color = "masks", "Masks, shared pixels", "5", BLUE
    on_canvas = True

    def __init__(self) -> None:
        self.tinted = OrderedDict()
        self.begin()

    def begin(self, views: int = 1) -> None:
        """Start a picture of so many views."""
        self.drawn = self.total = self.lit = 0

    def draw_on_canvas(self, canvas: Canvas, camera: Camera, world: World) -> None:
        """Draw one world on the canvas. A zoomed-out view is left out: its pixels are not the mask's."""
        if camera.zoom != 1.0:
            return
        left, top = camera.view()
        view = camera.viewport
        found = debug.drawn_masks(world)
        images = [self._tinted(solid, canvas.palette) for solid in found.solids]
        sizes = np.array([image.get_size() for image in images], int).reshape(-1, 2)[found.which]
        x, y = found.left.astype(int) - left + view.x, found.top.astype(int) - top + view.y
        seen = np.flatnonzero(
            (x < view.right) & (y < view.bottom) & (x + sizes[:, 0] > view.left) & (y + sizes[:, 1] > view.top)
        )
        self.total += len(x)
        self.drawn += len(seen)
        places = zip(x[seen].tolist(), y[seen].tolist(), strict=True)
        pairs = [(images[i], place) for i, place in zip(found.which[seen].tolist(), places, strict=True)]
        canvas.surface.set_clip(view)
        blit_many(canvas.surface, pairs)
        canvas.surface.set_clip(None)
        lit_x, lit_y = [], []
        for x, y, shared in debug.mask_hits(world):
            rows, columns = np.nonzero(shared)
            self.lit += len(rows)
            lit_x.append(columns + (int(x) - left + view.x))
            lit_y.append(rows + (int(y) - top + view.y))
        if lit_x:
            self._light(canvas.surface, np.concatenate(lit_x), np.concatenate(lit_y), view)

    def _light(self, surface, x, y, view):
        seen = (x >= view.left) & (x < view.right) & (y >= view.top) & (y < view.bottom)
        pixels = pygame.surfarray.pixels2d(surface)
        pixels[x[seen], y[seen]] = surface.map_rgb(HIT)
        del pixels  # unlocks the surface

    def _tinted(self, solid, palette):
        """Masks hand out the same array for the same angle; it is kept with its image, so its id stays its own."""
        kept, image = self.tinted.get((id(solid), palette), (None, None))
        if kept is not solid:
            image = mask_image(solid, palette)
            self.tinted[id(solid), palette] = (solid, image)
            if len(self.tinted) > CACHE_SIZE:
                self.tinted.popitem(last=False)
        else:
            self.tinted.move_to_end((id(solid), palette))
        return image

    def notes(self) -> list[LegendLine]:
        """(color, text) lines for the legend."""
        return [(self.color, f"masks {self.drawn} of {self.total}"), (YELLOW, f"shared pixels {self.lit}")]


def mask_image(solid: np.ndarray, palette: str = "standard") -> pygame.Surface:
    """A translucent image of a (h, w) bool mask with its edge pixels light."""
    fill = (*toned(BLUE, palette), FILL)
    padded = np.pad(solid, 1)
    inner = padded[:-2, 1:-1] & padded[2:, 1:-1] & padded[1:-1, :-2] & padded[1:-1, 2:]
    edge = solid & ~inner
    image = pygame.Surface((solid.shape[1], solid.shape[0]), pygame.SRCALPHA)
    colors = np.zeros((solid.shape[1], solid.shape[0], 3), dtype=np.uint8)
    alpha = np.zeros((solid.shape[1], solid.shape[0]), dtype=np.uint8)
    for part, color in ((solid & ~edge, fill), (edge, EDGE)):
        colors[part.T] = color[:3]
        alpha[part.T] = color[3]
    pygame.surfarray.blit_array(image, colors)
    view = pygame.surfarray.pixels_alpha(image)
    view[:] = alpha
    del view  # unlocks the surface
    return image
