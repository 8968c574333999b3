"""Sprites built from parts: each part is a distance field, shaded as a soft bulge and coloured by a ramp.

Parts are drawn back to front. Each part first darkens a thin band around itself on the parts below (contact shadow).
Then the slope of its bulge towards the light selects colours of its ramp. The rim light and the dark outline are drawn
last.
"""

import numpy as np

from assets.craft.fields import dither, grid, length
from assets.craft.palette import OUTLINE, RAMPS, WHITE, graded, mix

LIGHT = (-0.55, -0.80)  # direction towards the light: up and slightly left
RIM = np.array((255, 250, 236), np.uint8)
SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1))


def shifted(solid, dx, dy):
    """Return the mask `solid` (h, w) bool, moved by (dx, dy) px. Pixels that enter from outside are False."""
    height, width = solid.shape
    out = np.zeros_like(solid)
    out[max(0, dy) : height + min(0, dy), max(0, dx) : width + min(0, dx)] = solid[
        max(0, -dy) : height + min(0, -dy), max(0, -dx) : width + min(0, -dx)
    ]
    return out


class Sprite:
    """A picture while it is drawn: rgb (h, w, 3) uint8, and solid (h, w) bool, which is False for clear pixels.

    x, y (h, w): centres of the pixels [px]. Distance fields (assets/craft/fields.py) are computed at these positions.
    The drawing methods return the sprite, so that calls can be chained.
    """

    def __init__(self, width, height):
        self.rgb = np.zeros((height, width, 3), np.uint8)
        self.solid = np.zeros((height, width), bool)
        self.x, self.y = grid(width, height)

    def part(self, field, ramp, bulge=4.0, base=0.5, gain=0.42, grain=0.5, shadow=0.55):
        """Add a part that is shaded as a soft bulge.

        field: distance field of the part [px]; ramp: colours from dark to light; bulge: distance [px] from the edge to
        the top of the bulge; base: brightness 0..1 of a flat top; gain: effect of the slope on the brightness; grain:
        strength of the dither; shadow: brightness that remains in the contact shadow, 1 for none.
        """
        inside = field < 0
        height_map = np.sqrt(np.clip(-field / bulge, 0, 1)) * bulge
        slope_y, slope_x = np.gradient(height_map)
        facing = np.clip(-(slope_x * LIGHT[0] + slope_y * LIGHT[1]), -1, 1)
        level = (base + gain * facing) * (len(ramp) - 1) + 0.5 + dither(*field.shape) * 0.6 * grain
        if shadow < 1:
            below = (field >= 0) & (field < 1.3) & self.solid
            self.rgb[below] = (self.rgb[below] * shadow).astype(np.uint8)
        self.rgb[inside] = graded(ramp, level[inside])
        self.solid |= inside
        return self

    def flat(self, field, colour):
        """Fill the inside of a field with one colour, and make it solid."""
        inside = field < 0
        self.rgb[inside] = colour
        self.solid |= inside
        return self

    def paint(self, field, colour, share=1.0):
        """Mix a colour into the solid pixels inside a field, for markings, stripes and panel lines.

        share: 0..1, weight of the colour.
        """
        inside = (field < 0) & self.solid
        self.rgb[inside] = mix(self.rgb[inside], colour, share)
        return self

    def dot(self, x, y, colour):
        """Set the pixel (x, y) to a colour, and make it solid."""
        self.rgb[y, x] = colour
        self.solid[y, x] = True
        return self

    def stamp(self, rows, x, y, tones):
        """Set the pixels of a small drawing whose top left pixel is at (x, y).

        rows: texts with one letter for each pixel; tones: {letter: colour}; pixels with other letters do not change.
        """
        for down, row in enumerate(rows):
            for across, letter in enumerate(row):
                if letter in tones:
                    self.dot(x + across, y + down, tones[letter])
        return self

    def cut(self, field):
        """Clear everything inside a field."""
        self.solid &= ~(field < 0)
        return self

    def rim(self, colour=RIM, share=0.6):
        """Mix a colour into the pixels that have a clear neighbour above or on the left, towards the light.

        share: 0..1, weight of the colour.
        """
        edge = self.solid & ~(shifted(self.solid, 1, 0) & shifted(self.solid, 0, 1))
        self.rgb[edge] = mix(self.rgb[edge], colour, share)
        return self

    def outline(self):
        """Add a dark outline: each clear pixel with a solid neighbour above, below, left or right becomes dark and
        solid.
        """
        around = np.zeros_like(self.solid)
        for dx, dy in SIDES:
            around |= shifted(self.solid, dx, dy)
        around &= ~self.solid
        self.rgb[around] = OUTLINE
        self.solid |= around
        return self

    def pixels(self):
        """Return the picture, (h, w, 4) uint8, with alpha 0 or 255."""
        return cut_out(self.rgb, self.solid)


def opaque(rgb):
    """Return the picture `rgb` (h, w, 3) uint8 with an alpha of 255 everywhere, (h, w, 4) uint8."""
    return np.concatenate([rgb, np.full(rgb.shape[:2] + (1,), 255, np.uint8)], axis=2)


def cut_out(rgb, solid):
    """Return a picture (h, w, 4) uint8: `rgb` (h, w, 3), opaque where `solid` (h, w) is True, zeros elsewhere."""
    out = opaque(rgb)
    out[~solid] = 0
    return out


def flashed(pixels):
    """Return the white silhouette of a frame (h, w, 4), which is shown after a hit."""
    out = pixels.copy()
    out[..., :3][out[..., 3] > 0] = WHITE
    return out


def glow(size, ramp, brightest=0.70):
    """Return the picture of a disc of light, (size, size, 4) uint8, which the game adds to the colours below it.

    It is opaque, and black outside the disc, with a dithered falloff. size: in px; ramp: name of its colours;
    brightest: brightness of its centre, 0..1.
    """
    x, y = grid(size, size)
    fall = np.clip(1 - length(x - size / 2, y - size / 2) / (size / 2), 0, 1)
    level = np.clip(np.floor(fall * fall * 6 + 0.5 + dither(size, size) * 0.7), 0, 5).astype(int)
    tones = np.array(
        [mix((0, 0, 0), RAMPS[ramp][3], share * brightest / 0.70) for share in (0, 0.10, 0.22, 0.36, 0.52, 0.70)]
    )
    out = np.full((size, size, 4), 255, np.uint8)
    out[..., :3] = tones[level]
    return out
