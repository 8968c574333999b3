"""Pixel masks as they are tested, the pixels in which two masks overlap, and the outlines used for collision response.

Masks are drawn on the canvas before it is scaled. A mask pixel is a canvas pixel, so that the overlay matches the
sprite exactly. The outlines are drawn over the masks at window resolution, at the exact pose.
"""

from collections import OrderedDict

import numpy as np
import pygame

from game.drawing.blit import blit_many
from game.drawing.camera import Camera
from game.drawing.canvas import Canvas
from game.drawing.colors import BLUE, ORANGE, WHITE, YELLOW, faded, toned
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from game.overlays.mask_edges import mask_edges
from game.overlays.outlines import draw_lines
from physics import World, debug
from physics.tables.shape import PART

FILL = 96  # opacity of 255 of a mask's inside
EDGE = (150, 210, 255, 255)
HIT = (255, 250, 150, 255)
SEAM = faded(ORANGE, 0.25)
PART_BUDGET = 1200  # convex parts of outlines per picture; the note says how many there are
BLOCK = 160  # [px] larger masks are drawn in blocks of that size
CACHE_SIZE = 512  # number of cached images; a rotating sprite has one for each angle bucket


class Masks(Layer):
    """Masks in blue with a light edge. Pixels in which two masks overlap are yellow.

    With collision response, the outline of each mask is drawn in white, and the seams between its convex parts in
    orange.
    """

    name, title, key, color = "masks", "Masks, outlines", "5", BLUE
    on_canvas = on_frame = True

    def __init__(self) -> None:
        self.tinted = OrderedDict()
        self.begin()

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limit on outline parts is divided evenly among the views."""
        self.drawn = self.total = self.lit = self.parts = self.parts_in_all = 0
        self.room = PART_BUDGET // views

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the mask outlines of a world. lens: maps world to frame coordinates."""
        rows = np.flatnonzero(world.shapes["role"] == PART)
        self.parts_in_all += len(rows)
        if not len(rows):
            return
        rows = rows[lens.seen(debug.bounds(world)[rows])][: self.room]
        self.parts += len(rows)
        edges = mask_edges(world, rows, lens.scale)
        draw_lines(frame.surface, lens, edges.inner, frame.tone(SEAM))
        draw_lines(frame.surface, lens, edges.outer, WHITE, max(1, frame.scale - 1))

    def draw_on_canvas(self, canvas: Canvas, camera: Camera, world: World) -> None:
        """Draw the masks of a world on the canvas.

        Nothing is drawn if the camera is zoomed: canvas px are then not mask px.
        """
        if camera.zoom != 1.0:
            return
        left, top = camera.view()
        view = camera.viewport
        found = debug.drawn_masks(world)
        sizes = np.array([solid.shape[::-1] for solid in found.solids], int).reshape(-1, 2)[found.which]
        x, y = found.left.astype(int) - left + view.x, found.top.astype(int) - top + view.y
        seen = np.flatnonzero(
            (x < view.right) & (y < view.bottom) & (x + sizes[:, 0] > view.left) & (y + sizes[:, 1] > view.top)
        )
        self.total += len(x)
        self.drawn += len(seen)
        places = zip(found.which[seen].tolist(), x[seen].tolist(), y[seen].tolist(), strict=True)
        pairs = [pair for i, *at in places for pair in self._images(found.solids[i], at, view, canvas.palette)]
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

    def _images(self, solid, place, view, palette):
        """Yield (image, position) for the visible parts of the mask `solid`. A large mask has one image per block.

        place: (x, y) of the mask on the canvas; view: visible rectangle of the canvas; palette: name of the colour
        palette.
        """
        (height, width), (x, y) = solid.shape, place
        if height <= BLOCK and width <= BLOCK:
            yield self._tinted(solid, palette), (x, y)
            return
        for top in range(max(view.top - y, 0) // BLOCK * BLOCK, min(view.bottom - y, height), BLOCK):
            for left in range(max(view.left - x, 0) // BLOCK * BLOCK, min(view.right - x, width), BLOCK):
                image = self._block(solid, left, top, palette)
                if image is not None:
                    yield image, (x + left, y + top)

    def _block(self, solid, left, top, palette):
        """Return the image of a block of a large mask; None if the block is empty.

        left, top: first column and first row of the block in `solid`. Images are cached by position and pixels, since
        carving changes few blocks. palette: name of the colour palette.
        """
        # With a margin of one pixel, so that no edge is drawn at the border of the block.
        part = solid[max(top - 1, 0) : top + BLOCK + 1, max(left - 1, 0) : left + BLOCK + 1]
        pixels = part.tobytes()
        if True not in part:
            return None
        kept, image = self.tinted.get((solid.shape, left, top, palette), (None, None))
        if kept != pixels:
            cut = (min(left, 1), min(top, 1), *(min(BLOCK, n) for n in (solid.shape[1] - left, solid.shape[0] - top)))
            image = mask_image(part, palette).subsurface(cut)
            self._keep((solid.shape, left, top, palette), pixels, image)
        return image

    def _tinted(self, solid, palette):
        """Return the image of the mask `solid`, cached by the id of the array `solid`.

        The cache also holds the array, so that no other array can get the same id. palette: name of the colour palette.
        """
        kept, image = self.tinted.get((id(solid), palette), (None, None))
        if kept is not solid:
            image = mask_image(solid, palette)
            self._keep((id(solid), palette), solid, image)
        else:
            self.tinted.move_to_end((id(solid), palette))
        return image

    def _keep(self, key, of, image):
        self.tinted[key] = (of, image)
        if len(self.tinted) > CACHE_SIZE:
            self.tinted.popitem(last=False)

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        lines = [(self.color, f"masks {self.drawn} of {self.total}"), (YELLOW, f"shared pixels {self.lit}")]
        if self.parts_in_all:
            lines.append((WHITE, f"outlines, {self.parts} of {self.parts_in_all} parts"))
            lines.append((SEAM, "seams between parts, never felt"))
        return lines


def mask_image(solid: np.ndarray, palette: str = "standard") -> pygame.Surface:
    """Return a translucent image of a mask with light edge pixels.

    solid: (height, width) bool; palette: name of the palette.
    """
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
