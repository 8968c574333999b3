"""Drawing of a world's bodies: shaded pictures in the game's style, or plain shapes where such a picture does not fit.

Shaded pictures are drawn on the canvas. Shapes of a few canvas pixels, and pixel masks, are drawn at window
resolution.
"""

from functools import lru_cache
from math import hypot

import numpy as np
import pygame

from game.drawing.colors import INK, PAPER, SKY, faded
from game.drawing.rotated import poses_between
from physics import PixelMask, TileGrid
from physics.shapes.values import Convex
from scenes.lab.pieces import RAMPS, hull, placed, scaled, turning

LEAST, MOST = 8.0, 120.0  # [canvas px] range of pieces; others are drawn plain
ORDER = ("wood", "gold", "teal", "coral", "violet")
ASLEEP = "steel"
STREAK = 12.0  # [canvas px] motion per step from which the path is drawn
GROUND, RIM = (66, 60, 92), (150, 146, 182)
NEAR = 100  # [canvas px] around the view


class Looks:
    """Renderer of the bodies of one world, through one camera."""

    def __init__(self, world, camera):
        self.world, self.camera = world, camera
        self.known = {}  # body id -> (shapes, ramp or None if static, whether it is a sensor)

    def _of(self, identity):
        if identity not in self.known:
            body = self.world.body(identity)
            still = body.kind == "static"
            ramp = None if still or body.sensor else "steel" if body.material.density > 1.0 else ORDER[identity % 2]
            if any(is_round(shape) for shape in body.shapes) and ramp not in (None, "steel"):
                ramp = ORDER[2 + identity % 3]
            self.known[identity] = (body.shapes, ramp, body.sensor)
        return self.known[identity]

    def draw(self, canvas, alpha):
        """Draw static shapes, sensors and the shapes that have a shaded picture.

        alpha: position (0..1) between the last two steps.
        """
        bodies, zoom = self.world.bodies, self.camera.zoom
        x, y, angle = poses_between(bodies, alpha)
        x, y = self.camera.to_canvas(x, y, alpha)
        view = self.camera.viewport
        canvas.surface.set_clip(view)
        near = view.inflate(NEAR, NEAR)
        columns = (each.tolist() for each in (bodies["id"], bodies["awake"], x, y, angle))
        for identity, awake, px, py, turn in zip(*columns, strict=True):
            shapes, ramp, sensor = self._of(identity)
            for shape in shapes:
                if ramp is None:
                    draw_ground(canvas.surface, shape, zoom, (px, py, turn), sensor)
                elif is_piece(shape, zoom) and near.collidepoint(px, py):
                    turning(scaled(shape, zoom), ramp if awake else ASLEEP).draw(canvas.surface, px, py, turn)
        canvas.surface.set_clip(None)

    def draw_on_frame(self, frame):
        """Draw the shapes without a shaded picture, in their poses of the last step, and the paths of fast bodies.

        These shapes are tiny or very large shapes, and pixel masks.
        """
        bodies, lens = self.world.bodies, frame.lens(self.camera)
        surface = frame.surface
        surface.set_clip(lens.clip)
        self._draw_ways(surface, lens, bodies)
        x, y = lens.points(bodies["x"], bodies["y"])
        for identity, px, py, turn in zip(
            bodies["id"].tolist(), x.tolist(), y.tolist(), bodies["angle"].tolist(), strict=True
        ):
            shapes, ramp, _ = self._of(identity)
            for shape in shapes:
                if isinstance(shape, PixelMask):
                    draw_mask(surface, shape, lens.scale, (px, py), ramp)
                elif ramp is not None and not is_piece(shape, self.camera.zoom):
                    draw_plain(surface, shape, lens.scale, (px, py, turn), RAMPS[ramp])
        surface.set_clip(None)

    def _draw_ways(self, surface, lens, bodies):
        far = np.hypot(bodies["x"] - bodies["previous_x"], bodies["y"] - bodies["previous_y"]) * self.camera.zoom
        for row in np.flatnonzero(far > STREAK).tolist():
            b = bodies[row]
            _, ramp, _ = self._of(int(b["id"]))
            if ramp is not None:
                ends = (lens.points(float(b[x]), float(b[y])) for x, y in (("previous_x", "previous_y"), ("x", "y")))
                pygame.draw.line(surface, RAMPS[ramp][1], *ends)


@lru_cache(maxsize=256)
def is_piece(shape, zoom):
    """Return whether a shape has the right size for a shaded picture on the canvas. zoom: canvas px per world px."""
    if not isinstance(shape, Convex):
        return False
    points, radius = hull(shape)
    sizes = (np.ptp(points, axis=0) + 2.0 * radius) * zoom
    return bool(sizes.min() >= LEAST and sizes.max() <= MOST)


def is_round(shape):
    """Return whether a shape is a disc."""
    return isinstance(shape, Convex) and len(shape.points) == 1


def draw_ground(surface, shape, zoom, pose, sensor):
    """Draw a shape of a static body or of a sensor on the canvas. Pixel masks are skipped.

    zoom: canvas px per world px; pose: (x, y, angle) on the canvas [px, rad]; sensor: True draws it in the colour of
    sensors.
    """
    if isinstance(shape, PixelMask):
        return
    if isinstance(shape, TileGrid):
        draw_tiles(surface, shape, zoom, pose)
        return
    points = placed(shape, zoom, pose)
    if not isinstance(shape, Convex):  # a chain
        pygame.draw.lines(surface, INK, False, [(x, y + 2) for x, y in points], 3)
        pygame.draw.lines(surface, RIM, False, points, 2)
        for x, y in points:
            surface.set_at((round(x), round(y)), PAPER)
    elif len(points) == 1:
        pygame.draw.circle(surface, RIM, points[0], max(2.0, shape.radius * zoom))
    elif len(points) == 2:
        draw_plain(surface, shape, zoom, pose, (RIM, RIM))
    else:
        pygame.draw.polygon(surface, faded(SKY, 0.3) if sensor else GROUND, points)
        pygame.draw.polygon(surface, SKY if sensor else RIM, points, 1)


def draw_tiles(surface, grid, zoom, pose):
    """Draw the solid tiles of a TileGrid, with a line around each.

    zoom: canvas px per world px; pose: (x, y, angle) of the grid on the canvas; the angle is ignored.
    """
    x, y, _ = pose
    size = grid.tile_size * zoom
    for row, column in np.argwhere(grid.solid).tolist():
        left, top = round(x + column * size), round(y + row * size)
        width, height = round(x + (column + 1) * size) - left, round(y + (row + 1) * size) - top
        surface.fill(GROUND, (left, top, width, height))
        pygame.draw.rect(surface, RIM, (left, top, width + 1, height + 1), 1)


def draw_plain(surface, shape, zoom, pose, ramp):
    """Draw a convex shape that is too small or too large for a shaded picture, in two colours.

    zoom: surface px per world px; pose: (x, y, angle) on the surface [px, rad]; ramp: colours, the first for the rim,
    the second for the inside.
    """
    rim, inside, *_ = ramp
    points = placed(shape, zoom, pose)
    if len(points) == 1:
        pygame.draw.circle(surface, inside, points[0], max(1.5, shape.radius * zoom))
        pygame.draw.circle(surface, rim, points[0], max(1.5, shape.radius * zoom), 1)
    elif len(points) == 2:
        radius = max(1.0, shape.radius * zoom)
        (ax, ay), (bx, by) = points
        nx, ny = by - ay, ax - bx
        share = radius / max(hypot(nx, ny), 1e-9)
        nx, ny = share * nx, share * ny
        sides = [(ax + nx, ay + ny), (bx + nx, by + ny), (bx - nx, by - ny), (ax - nx, ay - ny)]
        pygame.draw.polygon(surface, inside, sides)
        for end in points:
            pygame.draw.circle(surface, inside, end, radius)
    else:
        pygame.draw.polygon(surface, inside, points)
        pygame.draw.polygon(surface, rim, points, 1)


def draw_mask(surface, mask, zoom, place, ramp):
    """Draw the pixels of a mask that does not rotate.

    zoom: surface px per pixel of the mask; place: (x, y) of the mask's origin on the surface; ramp: name of its colours
    in RAMPS, or None for a static mask, which is drawn darker.
    """
    picture = mask_picture(mask, RIM if ramp is None else RAMPS[ramp][1])
    width, height = picture.get_size()
    size = (max(1, round(width * zoom)), max(1, round(height * zoom)))
    left, top = (at - origin * zoom for at, origin in zip(place, mask.origin, strict=True))
    surface.blit(pygame.transform.scale(picture, size), (round(left), round(top)))


@lru_cache(maxsize=32)
def mask_picture(mask, color):
    """Return a Surface with a mask's solid pixels in one colour, half transparent so that overlaps are visible."""
    solid = mask.solid
    picture = pygame.Surface((solid.shape[1], solid.shape[0]), pygame.SRCALPHA, 32)
    picture.fill((*color, 0))
    alpha = pygame.surfarray.pixels_alpha(picture)
    alpha[:] = np.where(solid.T, 190, 0)
    del alpha  # unlocks the surface
    return picture
