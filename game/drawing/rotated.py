"""Pictures of rotating bodies: small pixel art at any angle with sharp edges.

A picture is enlarged eight times by Scale2x, which keeps edges sharp. It is then sampled at each pixel of the rotated
picture (the idea of RotSprite). Rotated pictures are cached. A Cast draws each body of a world with its picture.
"""

from collections.abc import Mapping
from math import ceil, cos, floor, hypot, pi, sin
from typing import TypeVar

import numpy as np
import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import Canvas
from game.drawing.sprites import Atlas
from physics import Body, World

BodyOrId = TypeVar("BodyOrId", Body, int)

BUCKETS = 192  # angles cached per picture: 1.9 degrees moves the edge of a 30 px piece by half a pixel
DOUBLINGS = 3  # of the picture before it is sampled
MARGIN = 80  # [canvas px] pieces up to this far outside the view may reach into it


class RotatedPicture:
    """One picture that is drawn at any angle, centred on the position of a body."""

    def __init__(self, image: pygame.Surface) -> None:
        self.image = image
        self.kept = {}
        self.large = None

    def draw(self, surface: pygame.Surface, x: float, y: float, angle: float) -> None:
        """Draw the picture, rotated by `angle` [rad], centred on the surface point (x, y)."""
        turned = self.at(angle)
        width, height = turned.get_size()
        surface.blit(turned, (floor(x - width / 2 + 0.5), floor(y - height / 2 + 0.5)))

    def at(self, angle: float) -> pygame.Surface:
        """Return the picture, rotated clockwise by the multiple of 2 pi / BUCKETS that is nearest to `angle` [rad].

        Rotated pictures are cached.
        """
        bucket = round(angle / (2 * pi) * BUCKETS) % BUCKETS
        if bucket not in self.kept:
            self.kept[bucket] = self.image if bucket == 0 else self._turn(2 * pi * bucket / BUCKETS)
        return self.kept[bucket]

    def _turn(self, angle):
        if self.large is None:
            large = pygame.Surface(self.image.get_size(), pygame.SRCALPHA, 32)
            large.blit(self.image, (0, 0))
            for _ in range(DOUBLINGS):
                large = pygame.transform.scale2x(large)
            self.large = np.dstack((pygame.surfarray.array3d(large), pygame.surfarray.array_alpha(large)))
        width, height = self.image.get_size()
        reach = ceil(hypot(width, height))
        # The same parity as the picture's, so that a piece does not jump by half a pixel when it starts to rotate.
        out_width, out_height = (reach + (reach - side) % 2 for side in (width, height))
        x = np.arange(out_width)[:, None] + 0.5 - out_width / 2
        y = np.arange(out_height)[None, :] + 0.5 - out_height / 2
        c, s, scale = cos(angle), sin(angle), 2**DOUBLINGS
        from_x = np.floor((c * x + s * y + width / 2) * scale).astype(np.int64)
        from_y = np.floor((c * y - s * x + height / 2) * scale).astype(np.int64)
        inside = (from_x >= 0) & (from_x < width * scale) & (from_y >= 0) & (from_y < height * scale)
        found = np.zeros((out_width, out_height, 4), np.uint8)
        found[inside] = self.large[from_x[inside], from_y[inside]]
        turned = pygame.Surface((out_width, out_height), pygame.SRCALPHA, 32)
        pygame.surfarray.blit_array(turned, found[:, :, :3])
        alpha = pygame.surfarray.pixels_alpha(turned)
        alpha[:] = np.where(found[:, :, 3] > 127, 255, 0)
        del alpha  # unlocks the surface
        return turned


def poses_between(bodies: np.ndarray, alpha: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (x, y, angle) of bodies, interpolated between the last two steps: three (n,) arrays [px, px, rad].

    bodies: BODY rows of the world; alpha: 0 for the step before the last one, 1 for the last step.
    """
    x, y, angle = (
        bodies["previous_" + name] + (bodies[name] - bodies["previous_" + name]) * alpha for name in ("x", "y", "angle")
    )
    return x, y, angle


class Cast:
    """Pictures assigned to the bodies of a world. They are drawn in the order of the body ids."""

    def __init__(self, atlas: Atlas | Mapping[str, pygame.Surface]) -> None:
        self.atlas = atlas
        self.turned = {}  # name -> RotatedPicture
        self.looks = {}  # body id -> name

    def add(self, body: BodyOrId, name: str) -> BodyOrId:
        """Assign the picture `name` to `body`, a Body or an id. Return `body`."""
        self.looks[getattr(body, "id", body)] = name
        return body

    def picture(self, name: str) -> RotatedPicture:
        """Return the RotatedPicture of the picture `name`, which is created at its first use."""
        if name not in self.turned:
            self.turned[name] = RotatedPicture(self.atlas[name])
        return self.turned[name]

    def draw(self, canvas: Canvas, camera: Camera, world: World, alpha: float) -> None:
        """Draw the bodies that have a picture, clipped to the camera's viewport.

        alpha: position between the last two steps, 0..1.
        """
        bodies, surface = world.bodies, canvas.surface
        x, y, angle = poses_between(bodies, alpha)
        x, y = camera.to_canvas(x, y, alpha)
        surface.set_clip(camera.viewport)
        near = camera.viewport.inflate(MARGIN, MARGIN)
        for identity, *pose in zip(bodies["id"].tolist(), x.tolist(), y.tolist(), angle.tolist(), strict=True):
            name = self.looks.get(identity)
            if name is not None and near.collidepoint(pose[:2]):
                self.picture(name).draw(surface, *pose)
        surface.set_clip(None)
