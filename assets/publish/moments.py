"""docs/moments.png: twelve pictures of remarkable events of each game, with captions, three in a row.

A bot plays the games while the pictures are taken.
"""

import json

import numpy as np

from assets.craft import png
from assets.craft.palette import OUTLINE, RAMPS, oklch
from assets.publish.films import filmed
from assets.ui.font import write

GAMES = ("shooter", "platformer", "lander")
COLUMNS, ROWS = 3, 4
FRAME = (480, 270)  # [px] of a picture
GAP, CAPTION, HEADING = 6, 13, 20  # [px] around a picture, below it for its words, above a game
PAPER = oklch(0.22, 0.045, 285)


def sheet():
    """Return one picture, (h, w, 3) uint8, with the screenshots of remarkable events (moments) of all GAMES."""
    return np.concatenate([game_moments(name) for name in GAMES])


def game_moments(name):
    """Return a picture, (h, w, 3) uint8, with screenshots of one game's remarkable events (moments) under the game's
    name.
    """
    files = filmed("moments", name)
    captions = json.loads(files.pop("captions.json"))
    return laid_out(name, captions, [png.decode(content) for content in files.values()])


def laid_out(name, captions, pictures):
    """Return a picture, (h, w, 3) uint8: the name as heading, and the given pictures in rows, each above its caption.

    captions: list of strings; pictures: list of (270, 480, 3) uint8. Raises ValueError unless there are COLUMNS * ROWS
    captions and as many pictures.
    """
    if not len(captions) == len(pictures) == COLUMNS * ROWS:
        raise ValueError(f"{name}: {COLUMNS * ROWS} moments must be there (got {len(captions)}, {len(pictures)})")
    cell_width, cell_height = FRAME[0] + GAP, FRAME[1] + CAPTION + GAP
    out = np.full((HEADING + ROWS * cell_height, COLUMNS * cell_width + GAP, 3), PAPER)
    write(out, name.upper(), GAP, 7, RAMPS["gold"][4])
    for i, (caption, picture) in enumerate(zip(captions, pictures, strict=True)):
        row, column = divmod(i, COLUMNS)
        left, top = GAP + column * cell_width, HEADING + row * cell_height
        out[top - 1 : top + FRAME[1] + 1, left - 1 : left + FRAME[0] + 1] = OUTLINE
        out[top : top + FRAME[1], left : left + FRAME[0]] = picture
        write(out, f"{i + 1}  {caption}", left + 1, top + FRAME[1] + 4, RAMPS["steel"][4])
    return out
