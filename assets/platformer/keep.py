"""The keep (castle) of the platformer in the distance: towers and walls at dusk, 480 x 150 px, seamless in x.

Like the mountains, it is drawn along the bottom of the screen. The light comes from the upper left, as in all
pictures.
"""

import numpy as np

from assets.craft.fields import dither, noise
from assets.craft.palette import mix, oklch, oklch_all

WIDTH, HEIGHT = 480, 150  # [px]
BODY, LIGHT, SHADE, EDGE = oklch_all((0.300, 0.070, 300), (0.355, 0.080, 312), (0.250, 0.062, 292), (0.50, 0.095, 350))
WINDOW, ROOF, ROOF_LIT = oklch_all((0.80, 0.120, 75), (0.265, 0.080, 330), (0.36, 0.095, 345))
FOG = oklch(0.44, 0.090, 335)
# x of the left edge, width, height, kind: "wall", "tower" with battlements, "spire" with a pointed roof; all px
PARTS = (
    (0, 480, 30, "wall"),
    (0, 120, 46, "wall"),
    (150, 130, 54, "wall"),
    (330, 150, 42, "wall"),
    (8, 26, 78, "tower"),
    (62, 20, 66, "spire"),
    (92, 34, 92, "tower"),
    (138, 16, 58, "tower"),
    (166, 24, 84, "spire"),
    (204, 44, 104, "tower"),
    (214, 22, 124, "spire"),
    (262, 18, 72, "tower"),
    (296, 22, 62, "spire"),
    (338, 30, 86, "tower"),
    (384, 18, 64, "tower"),
    (408, 26, 96, "spire"),
    (452, 22, 60, "tower"),
)


def keep():
    """Return the picture of the keep, (150, 480, 4) uint8."""
    out = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    stone = noise(WIDTH, HEIGHT, 80, 50, 920)
    for left, width, height, kind in PARTS:
        _part(out, stone, left, width, height, kind)
    _fog(out)
    return out


def _put(out, x, y, colour):
    if 0 <= y < HEIGHT:
        out[y, x % WIDTH] = (*colour, 255)


def _part(out, stone, left, width, height, kind):
    """Draw a wall or a tower into `out`, from its top down to the edge of the picture.

    left, width, height: in px; kind: "wall", "tower" with battlements, or "spire" with a pointed roof; stone: noise
    (HEIGHT, WIDTH).
    """
    top = HEIGHT - height
    for column in range(width):
        x = left + column
        merlon = 3 if kind != "spire" and column % 6 < 3 else 0
        for y in range(top - merlon, HEIGHT):
            tone = BODY
            if column >= width - max(3, width // 4):
                tone = SHADE
            elif column < max(2, width // 6) or stone[y, x % WIDTH] > 0.72:
                tone = LIGHT
            if y == top - merlon or column == 0:
                tone = EDGE
            elif kind != "wall" and y in (top + 7, top + 8):
                tone = SHADE if y == top + 7 else LIGHT
            _put(out, x, y, tone)
    if kind == "spire":
        _roof(out, left, width, top)
    if kind != "wall":
        for row in range(top + 16, HEIGHT - 24, 22):  # lit slits
            if (left + row) % 3:
                for dy in range(5):
                    _put(out, left + width // 2, row + dy, WINDOW)
                    _put(out, left + width // 2 - 1, row + dy, SHADE)


def _roof(out, left, width, top):
    """Draw a steep roof into `out`, on a tower whose top is at y = `top`.

    left, width: position and width of the tower [px]. The roof overhangs by two pixels, and its left side is lit.
    """
    reach = width + 4
    for i in range(reach + 6):
        half = (width / 2 + 2) * i / (reach + 6)
        middle = left + width / 2
        for x in range(int(np.floor(middle - half)), int(np.ceil(middle + half))):
            _put(
                out,
                x,
                top - reach - 6 + i,
                EDGE if x == int(np.floor(middle - half)) else ROOF_LIT if x < middle - half * 0.15 else ROOF,
            )


def _fog(out):
    """Fade the lower part of the picture `out` into the haze of the valley, by dithering."""
    y = np.mgrid[0:HEIGHT, 0:WIDTH][0]
    share = (y - HEIGHT * 0.62) / (HEIGHT * 0.38) + dither(HEIGHT, WIDTH) * 0.45
    for limit, strength in ((0.35, 0.3), (0.6, 0.55), (0.85, 0.8)):
        band = (share > limit) & (out[..., 3] > 0)
        out[band, :3] = mix(out[band, :3], FOG, strength)
