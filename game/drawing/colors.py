"""Colours of text, panels and overlays.

The default overlay hues are near the Okabe-Ito set; the settings offer others.
"""

Color = tuple[int, ...]  # red, green, blue and perhaps alpha, 0..255

INK = (20, 16, 32)  # text outlines, panel ground: the outline colour of the art, never pure black
NIGHT = (26, 22, 42)
DUSK = (44, 38, 66)
SLATE = (86, 82, 112)
FOG = (150, 150, 176)
PAPER = (236, 236, 244)
GOLD = (255, 206, 92)

ORANGE = (230, 159, 0)
SKY = (86, 180, 233)
GREEN = (0, 190, 140)  # lifted from #009E73: thin lines on a dusk sky must stay readable
YELLOW = (240, 228, 66)
BLUE = (70, 140, 230)  # lifted from #0072B2, as above
RED = (240, 96, 60)  # lifted from #D55E00, as above
PINK = (222, 140, 186)
WHITE = (255, 255, 255)

SERIES = (ORANGE, SKY, GREEN, PINK, YELLOW, BLUE, RED, WHITE)  # for curves and kinds, in this order

# The overlays' hues under the other palettes. "safe" is the Okabe-Ito set itself (jfly.uni-koeln.de/color): under every
# kind of colour blindness its two nearest hues are 1.5 times as far apart as the ones above. "contrast" is brighter,
# over a darkened picture (SHADE), and its hues are further apart still.
TONES = {
    "standard": {},
    "safe": {GREEN: (0, 158, 115), BLUE: (0, 114, 178), RED: (213, 94, 0), PINK: (204, 121, 167)},
    "contrast": {
        ORANGE: (255, 176, 0),
        SKY: (175, 182, 241),
        GREEN: (47, 226, 159),
        YELLOW: (255, 218, 118),
        BLUE: (8, 155, 255),
        RED: (228, 121, 46),
        PINK: (173, 141, 157),
        FOG: (200, 200, 214),
        SLATE: (140, 138, 160),
    },
}
SHADE = 96  # of 255: light of the picture that remains under overlays of the palette "contrast"
BRIGHTER = 0.3  # towards white: change of a mixed colour in "contrast"

BROADPHASE_COLORS = {"brute": RED, "sweep": YELLOW, "hash": SKY, "tree": GREEN}


def toned(color: Color, palette: str) -> Color:
    """Return the colour that replaces an overlay's `color` in a palette. The alpha value, if any, is unchanged.

    palette: a name in game.files.accessibility.PALETTES.
    """
    plain = tuple(color[:3])
    found = TONES[palette].get(plain)
    if found is None:
        found = plain if palette != "contrast" else tuple(round(c + (255 - c) * BRIGHTER) for c in plain)
    return (*found, *color[3:])


def faded(color: Color, amount: float) -> Color:
    """Return `color` mixed with the dark colour NIGHT. amount: 0 gives `color`, 1 gives NIGHT."""
    return tuple(round(c + (n - c) * amount) for c, n in zip(color[:3], NIGHT, strict=True))
