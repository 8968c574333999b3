"""Functions that read sprite sheets and backdrops for the tests of the art, and compute the lightness of colours."""

import json

import numpy as np

from assets import FOLDER
from assets.craft import png


def load(sheet):
    """Return ({frame: (h, w, 4) uint8}, {animation: entry}) of the sheet assets/images/<sheet>."""
    picture = png.decode((FOLDER / "images" / f"{sheet}.png").read_bytes())
    table = json.loads((FOLDER / "images" / f"{sheet}.json").read_text(encoding="utf-8"))
    frames = {}
    for name, place in table["frames"].items():
        frames[name] = picture[place["y"] : place["y"] + place["h"], place["x"] : place["x"] + place["w"]]
        assert frames[name].shape == (place["h"], place["w"], 4), f"{name} reaches past the sheet"
    return frames, table["animations"]


def backdrop(name):
    """Return the pixels of assets/images/<name>.png, (h, w, channels) uint8."""
    return png.decode((FOLDER / "images" / f"{name}.png").read_bytes())


def oklab(rgb):
    """Return the OKLab values (..., 3) of RGB colours (..., 3) 0..255: lightness 0..1, a and b (Ottosson 2020)."""
    share = np.asarray(rgb, float) / 255
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    cone = np.cbrt(
        linear
        @ np.array(
            [
                [0.4122214708, 0.2119034982, 0.0883024619],
                [0.5363325363, 0.6806995451, 0.2817188376],
                [0.0514459929, 0.1073969566, 0.6299787005],
            ]
        )
    )
    return cone @ np.array(
        [
            [0.2104542553, 1.9779984951, 0.0259040371],
            [0.7936177850, -2.4285922050, 0.7827717662],
            [-0.0040720468, 0.4505937099, -0.8086757660],
        ]
    )


def pieces(solid):
    """Return the number of 8-connected pieces of a mask (h, w) bool."""
    left, count = solid.copy(), 0
    while left.any():
        count += 1
        start = np.argwhere(left)[0]
        stack = [tuple(start)]
        left[tuple(start)] = False
        while stack:
            y, x = stack.pop()
            for row in range(max(0, y - 1), min(left.shape[0], y + 2)):
                for column in range(max(0, x - 1), min(left.shape[1], x + 2)):
                    if left[row, column]:
                        left[row, column] = False
                        stack.append((row, column))
    return count
