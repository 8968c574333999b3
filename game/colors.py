"""The shell's colours. Overlay hues are the Okabe-Ito set, which stays apart for colour-blind eyes."""

INK = (20, 16, 32)            # text outlines, panel ground: the art's outline colour, never pure black
NIGHT = (26, 22, 42)
DUSK = (44, 38, 66)
SLATE = (86, 82, 112)
FOG = (150, 150, 176)
PAPER = (236, 236, 244)
GOLD = (255, 206, 92)

ORANGE = (230, 159, 0)
SKY = (86, 180, 233)
GREEN = (0, 190, 140)         # lifted from #009E73: thin lines on a dusk sky must stay readable
YELLOW = (240, 228, 66)
BLUE = (70, 140, 230)         # lifted from #0072B2, as above
RED = (240, 96, 60)           # lifted from #D55E00, as above
PINK = (222, 140, 186)
WHITE = (255, 255, 255)

SERIES = (ORANGE, SKY, GREEN, PINK, YELLOW, BLUE, RED, WHITE)   # for curves and kinds, in this order

BROADPHASE_COLORS = {"brute": RED, "sweep": YELLOW, "hash": SKY, "tree": GREEN}


def faded(color, amount):
    """`color` mixed towards the night ground; amount 0 keeps it, 1 is the ground."""
    return tuple(round(c + (n - c) * amount) for c, n in zip(color[:3], NIGHT, strict=True))
