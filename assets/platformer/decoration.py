"""Tiles that do not collide: grass, flowers, bushes, trees in 16 px pieces, back walls. Also the spikes.

Decoration is behind the hero, so it is a step darker than the ground.
"""

import numpy as np

from assets import FOLDER
from assets.craft.drawn import lay, read_parts
from assets.craft.fields import circle, layered_noise, polygon
from assets.craft.palette import OUTLINE, RAMPS, WHITE, mix
from assets.craft.shading import Sprite, opaque
from assets.platformer.things import LETTERS as THING_LETTERS

TILE = 16  # [px] side of a tile
GRASS = RAMPS["grass"]
LETTERS = {
    "O": OUTLINE,
    "d": GRASS[1],
    "f": GRASS[2],
    "g": GRASS[3],
    "p": RAMPS["pink"][4],
    "y": RAMPS["gold"][4],
    "w": RAMPS["steel"][5],
    "r": RAMPS["red"][3],
    "k": RAMPS["red"][1],
    "s": RAMPS["steel"][3],
    "a": RAMPS["stone"][4],
    "b": RAMPS["stone"][3],
    "c": RAMPS["stone"][2],
    "n": RAMPS["wood"][3],
    "m": RAMPS["wood"][2],
}
# name: (width in tiles, height in tiles); the pieces are tiles <name>_<column>_<row>, row 0 on top
SCENERY = {"tree_green": (4, 5), "tree_autumn": (4, 5), "tree_small": (3, 4), "bush": (2, 1)}
CROWNS = {
    # crown balls: (x, y, radius) in px within the picture
    "tree_green": ((20, 30, 13), (44, 30, 13), (32, 18, 15), (25, 40, 10), (41, 40, 10), (32, 32, 14)),
    "tree_autumn": ((18, 34, 12), (46, 32, 12), (32, 16, 13), (22, 22, 11), (42, 21, 11), (33, 34, 13)),
    "tree_small": ((15, 24, 10), (33, 24, 10), (24, 14, 11), (24, 28, 10)),
    "bush": ((7, 11, 6), (16, 8, 7), (25, 11, 6)),
}
LEAVES = {"tree_green": "olive", "tree_autumn": "orange", "tree_small": "pink", "bush": "olive"}


def scenery(name):
    """Return the picture of a tree or bush in one piece, (16 * rows, 16 * columns, 4) uint8. name: key of SCENERY."""
    columns, rows = SCENERY[name]
    width, height = columns * TILE, rows * TILE
    sprite = Sprite(width, height)
    x, y, middle = sprite.x, sprite.y, width / 2
    if name != "bush":
        thick = width / 15
        sprite.part(
            polygon(
                x,
                y,
                [
                    (middle - thick, 24),
                    (middle + thick, 24),
                    (middle + thick, height - 7),
                    (middle + thick * 2.4, height + 1),
                    (middle - thick * 2.4, height + 1),
                    (middle - thick, height - 7),
                ],
            ),
            RAMPS["wood"],
            bulge=4,
            base=0.30,
            gain=0.3,
        )
        for side in (-1, 1):
            sprite.part(
                polygon(
                    x,
                    y,
                    [
                        (middle - 2, height * 0.62),
                        (middle + 2, height * 0.62),
                        (middle + side * 13, height * 0.40),
                        (middle + side * 10, height * 0.38),
                    ],
                ),
                RAMPS["wood"],
                bulge=3,
                base=0.30,
                gain=0.3,
            )
    ramp = np.array([mix(tone, OUTLINE, 0.18) for tone in RAMPS[LEAVES[name]]])[:5]
    rough = layered_noise(width, height, max(2, width // 5), max(2, height // 5), 2, 91 + len(name)) - 0.5
    for ball_x, ball_y, radius in CROWNS[name]:
        field = circle(x, y, ball_x, ball_y, radius) + rough * 5
        sprite.part(field, ramp, bulge=radius * 0.9, base=0.42, gain=0.5, grain=1.1, shadow=0.7)
    return sprite.outline().pixels()


def back_wall(variant):
    """Return the picture of dark masonry behind a shaft or cellar, 16 x 16 px. variant: 0..1."""
    ramp = [mix(RAMPS["stone"][i], (30, 22, 52), 0.62) for i in range(6)]
    picture = np.full((TILE, TILE, 3), ramp[1])
    for row, offset in ((0, 4), (8, 12)):
        picture[row] = ramp[2]
        picture[row + 7] = ramp[0]
        picture[row : row + 8, offset] = ramp[0]
    if variant:
        picture[2:5, 7:10] = ramp[2]
        picture[11:13, 2:6] = ramp[0]
    return opaque(picture)


def torch():
    """Return the picture of a wall torch on a piece of back wall, 16 x 16 px. The light that it casts is
    not included.
    """
    sprite = Sprite(TILE, TILE)
    sprite.part(polygon(sprite.x, sprite.y, [(5, 8), (11, 8), (9, 15), (7, 15)]), RAMPS["wood"], bulge=2, base=0.5)
    sprite.part(circle(sprite.x, sprite.y, 8, 5.4, 3.2), RAMPS["orange"], bulge=3, base=0.7, grain=0)
    sprite.part(circle(sprite.x, sprite.y, 8, 6, 1.7), RAMPS["gold"], bulge=2, base=0.9, grain=0, shadow=1)
    sprite.dot(8, 2, RAMPS["orange"][4]).dot(7, 6, WHITE).dot(8, 6, WHITE)
    picture = back_wall(0)
    warm = circle(sprite.x, sprite.y, 8, 6, 7.5) < 0
    picture[..., :3][warm] = mix(picture[..., :3][warm], RAMPS["orange"][2], 0.22)
    lay(picture, sprite.outline().pixels(), 0, 0)
    return picture


def decoration_tiles():
    """Return {name: (pixels, properties)} of spikes and all decoration, in the order of the tileset."""
    drawings = FOLDER / "drawings"
    things = read_parts((drawings / "things.txt").read_text(encoding="utf-8"), THING_LETTERS, "things.txt")
    decor = read_parts((drawings / "decor.txt").read_text(encoding="utf-8"), LETTERS, "decor.txt")
    table = {"spikes": (things["spikes"], {"kind": "spikes"})}
    for name, picture in decor.items():
        table[name] = (picture, {"kind": "decor"})
    for variant in range(2):
        table[f"back_wall_{variant}"] = (back_wall(variant), {"kind": "decor"})
    table["torch"] = (torch(), {"kind": "decor"})
    for name, (columns, rows) in SCENERY.items():
        picture = scenery(name)
        for row in range(rows):
            for column in range(columns):
                piece = picture[row * TILE : (row + 1) * TILE, column * TILE : (column + 1) * TILE]
                if piece[..., 3].any():
                    table[f"{name}_{column}_{row}"] = (piece.copy(), {"kind": "decor"})
    return table
