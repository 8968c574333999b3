"""Sprites from the atlas files of assets/images, and rotated sprites that show exactly the pixels that collide."""

import json
from dataclasses import dataclass
from functools import cache
from math import floor
from pathlib import Path
from typing import Any

import numpy as np
import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import Canvas
from game.errors import FileError
from game.places import CURE, IMAGES
from physics import PixelMask


@dataclass(frozen=True)
class Animation:
    """Images that are shown one after another at a constant rate. fps: images per second."""

    images: tuple
    names: tuple
    fps: float

    def index_at(self, seconds: float, loop: bool = True) -> int:
        """Return the index of the image that is shown `seconds` after the start.

        loop: True repeats the images; False continues to show the last one.
        """
        number = int(seconds * self.fps)
        return number % len(self.images) if loop else min(number, len(self.images) - 1)

    def at(self, seconds: float, loop: bool = True) -> pygame.Surface:
        """Return the image that is shown `seconds` after the start. loop: as in index_at()."""
        return self.images[self.index_at(seconds, loop)]

    @property
    def seconds(self) -> float:
        """Duration of one cycle [s]."""
        return len(self.images) / self.fps


class Atlas:
    """One sprite sheet: images by name, animations by name, and a PixelMask of each image, created at its first use."""

    def __init__(self, path: Path, images: dict[str, pygame.Surface], animations: dict[str, Animation]) -> None:
        self.path, self.images, self.animations = path, images, animations
        self.masks = {}

    def __getitem__(self, name):
        """Return the image `name`. For an unknown name, raise ValueError, which names the sprite sheet."""
        if name not in self.images:
            raise ValueError(f"{self.path} has no frame {name!r}; it has {', '.join(self.images)}")
        return self.images[name]

    def animation(self, name: str) -> Animation:
        """Return the Animation `name`. For an unknown name, raise ValueError, which names the sprite sheet."""
        if name not in self.animations:
            raise ValueError(f"{self.path} has no animation {name!r}; it has {', '.join(self.animations)}")
        return self.animations[name]

    def mask(self, name: str) -> PixelMask:
        """Return the PixelMask of the image `name`, with its origin in the centre.

        The mask is created at its first use.
        """
        if name not in self.masks:
            self.masks[name] = PixelMask.from_surface(self[name])
        return self.masks[name]


def load_image(path: Path) -> pygame.Surface:
    """Return the picture in a file, converted for fast blits if a display is open.

    Raises FileError for an unusable file.
    """
    try:
        image = pygame.image.load(str(path))
    except (OSError, pygame.error) as error:
        raise FileError(path, "picture", f"{error}; {CURE}") from error
    return image.convert_alpha() if pygame.display.get_surface() else image


@cache
def load_backdrop(name: str) -> pygame.Surface:
    """Return the picture in the file assets/images/<name>.png."""
    return load_image(IMAGES / f"{name}.png")


@cache
def load_atlas(name: str) -> Atlas:
    """Return the Atlas in the files assets/images/<name>.png and .json. Raises FileError if either file is damaged."""
    path = IMAGES / f"{name}.json"
    sheet = load_image(IMAGES / f"{name}.png")
    try:
        table = json.loads(path.read_text(encoding="utf-8"))
        images = {
            frame: sheet.subsurface((place["x"], place["y"], place["w"], place["h"])).copy()
            for frame, place in table["frames"].items()
        }
        animations = {
            title: Animation(tuple(images[f] for f in entry["frames"]), tuple(entry["frames"]), entry["fps"])
            for title, entry in table["animations"].items()
        }
    except (OSError, ValueError, KeyError) as error:
        raise FileError(path, "atlas", f"{error!r}; {CURE}") from error
    return Atlas(path, images, animations)


class RotatedSprites:
    """A sprite at any angle, drawn with exactly the solid pixels of its rotated collision mask."""

    def __init__(self, image: pygame.Surface, mask: PixelMask) -> None:
        self.image, self.mask = image, mask
        self.cache = {}

    def __deepcopy__(self, memo):
        """Return itself, so that a copy of a scene shares the cached pictures."""
        return self

    def draw(self, canvas: Canvas, camera: Camera, x: float, y: float, angle: float, alpha: float = 1.0) -> None:
        """Draw the sprite, rotated by `angle` [rad], with its mask's origin at the world point (x, y).

        The position is rounded in the same way as the physics rounds the mask to the pixel grid. alpha: position of the
        camera between the last two steps, 0..1.
        """
        image, origin = self.at(angle)
        left, top = camera.view(alpha)
        place_x = floor(x - origin[0] + 0.5) - left + camera.viewport.x
        place_y = floor(y - origin[1] + 0.5) - top + camera.viewport.y
        canvas.surface.blit(image, (place_x, place_y))

    def at(self, angle: float) -> tuple[pygame.Surface, tuple[float, float]]:
        """Return (image, (x, y) of the origin in the image [px]) at the cached angle nearest to `angle` [rad]."""
        bucket = self.mask.bucket_at(angle)
        if bucket not in self.cache:
            turned = self.mask.turned_to(bucket)
            self.cache[bucket] = (pick_pixels(self.image, turned), turned.origin)
        return self.cache[bucket]


def pick_pixels(image: pygame.Surface, turned: Any) -> pygame.Surface:
    """Return the picture of a rotated mask. Each solid pixel has the colour of its source pixel in `image`.

    turned: the rotated mask. Its arrays source_x and source_y contain, for each of its pixels, the position of the
    source pixel in `image`.
    """
    height, width = turned.solid.shape
    out = pygame.Surface((max(width, 1), max(height, 1)), pygame.SRCALPHA)
    rows, columns = np.nonzero(turned.solid)
    source = (turned.source_x[rows, columns], turned.source_y[rows, columns])
    colors = np.zeros((out.get_width(), out.get_height(), 3), dtype=np.uint8)
    colors[columns, rows] = pygame.surfarray.array3d(image)[source]
    pygame.surfarray.blit_array(out, colors)
    alpha = pygame.surfarray.pixels_alpha(out)
    alpha[:] = 0
    alpha[columns, rows] = 255
    del alpha  # unlocks the surface
    return out


def lit(image: pygame.Surface, amount: int = 110) -> pygame.Surface:
    """Return a brighter copy of an image, for the flash of a hit. amount: 0..255, added to each colour channel."""
    copy = image.copy()
    copy.fill((amount, amount, amount, 0), special_flags=pygame.BLEND_RGBA_ADD)
    return copy
