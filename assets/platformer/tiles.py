"""The sprite sheet "tiles": 16 px ground, stone, rock, slopes, planks, ladders and decoration, with collision kinds.

The picture of ground, stone and rock depends on which of the eight neighbours are solid. So a map made of one letter
gets its grass, edges and corners automatically. Such a tile is named `ground_<mask>`. The mask is the sum of the
neighbours present: N 1, NE 2, E 4, SE 8, S 16, SW 32, W 64, NW 128. A corner counts only if both its sides are present
(47 cases).
"""

import numpy as np

from assets.craft.atlas import Sheet
from assets.craft.fields import dither, grid, noise
from assets.craft.palette import OUTLINE, RAMPS, mix
from assets.craft.shading import opaque
from assets.platformer.cave import boulders, cave_tiles, clods
from assets.platformer.decoration import TILE, decoration_tiles

N, NE, E, SE, S, SW, W, NW = (1 << i for i in range(8))
CORNERS = ((NE, N, E), (SE, S, E), (SW, S, W), (NW, N, W))
DEPTHS = 4  # variations of the tile that has all eight neighbours
MATERIALS = {
    # name: (body ramp, cap ramp, grain seed)
    "ground": ("dirt", "grass", 300),
    "stone": ("stone", "stone", 400),
    "rock": ("rock", "rock", 500),
}
LATER = ("rock",)  # materials whose tiles come last, so that the older numbers stay
# name: (surface height at the left edge, at the right edge), as fractions of the tile above its bottom
SLOPES = {
    "slope_up": (0.0, 1.0),
    "slope_down": (1.0, 0.0),
    "slope_up_low": (0.0, 0.5),
    "slope_up_high": (0.5, 1.0),
    "slope_down_high": (1.0, 0.5),
    "slope_down_low": (0.5, 0.0),
}
DEEP_FINDS = {
    3: (("44.....", "4444...", ".34444.", "...3444", ".....33"), RAMPS["stone"]),
    4: (("..5....", ".454.4.", ".344.43", ".343243", "2332332"), RAMPS["teal"]),
}  # variant of deep ground: (rows of ramp indices, ramp)
BLEMISHES = (((9, 3), (13, 4)), ((3, 3), (7, 2)))  # column and row of pits in each course of worn stone
DEEP_SHADE = np.array((14, 11, 28), np.uint8)
DARKER = {"fading": 0.30, "deep": 0.56}  # shares of shade in stone and rock far from any surface
FRINGE = np.array([3, 4, 3, 5, 4, 3, 3, 4, 5, 4, 3, 4, 3, 3, 5, 4])  # [px] depth of the grass per column


def reduced(mask):
    """Return a mask of neighbours without the corners that do not count.

    A corner lies between two sides, for example NE between N and E. It counts only if both sides are present. mask: sum
    of the bits N, NE, E ... of the neighbours that are present.
    """
    for corner, first, second in CORNERS:
        if not (mask & first and mask & second):
            mask &= ~corner
    return mask


BLOBS = sorted({reduced(mask) for mask in range(256)})


def texture(material, variant=0):
    """Return the picture of the inside of a material, (16, 16, 3) uint8: plain, with a few clods, stones or cracks.

    material: key of MATERIALS; variant: 0..3. Tiles of all variants can be placed side by side.
    """
    body, _, seed = MATERIALS[material]
    ramp = RAMPS[body]
    if material == "rock":
        return boulders(variant)
    if material == "stone":
        grain = noise(TILE, TILE, 8, 8, seed) * 0.6 + noise(TILE, TILE, 4, 4, seed + variant) * 0.4
        tones = np.array([ramp[1], mix(ramp[1], ramp[2], 0.35), mix(ramp[1], ramp[2], 0.7)])
        return _bricks(tones[(grain > 0.48).astype(int) + (grain > 0.66)], ramp, variant)
    picture = clods(ramp, seed + variant)
    random = np.random.default_rng(seed + 10 + variant)
    for _ in range((0, 1, 2, 1)[variant]):  # pebbles: light on top, dark below
        column, row = (int(value) for value in random.integers(2, 12, 2))
        wide = 2 + int(random.integers(2))
        picture[row, column : column + wide] = ramp[4]
        picture[row + 1, column : column + wide] = ramp[3]
        picture[row + 2, column : column + wide] = ramp[0]
    return picture


def deep(variant):
    """Return the picture of ground far below the surface, (16, 16, 4) uint8: darker and plainer.

    variant: 0..2 plain, 3 with a bone, 4 with a crystal.
    """
    dark = mix(RAMPS["dirt"][1], OUTLINE, 0.42)
    light = mix(RAMPS["dirt"][1], OUTLINE, 0.18)
    grain = noise(TILE, TILE, 4, 4, 340) * 0.7 + noise(TILE, TILE, 8, 8, 341 + variant) * 0.3
    picture = np.array([dark, mix(dark, light, 0.6)])[(grain > 0.60).astype(int)]
    if variant == 2:
        picture[9, 5:8] = picture[10, 5:7] = mix(light, RAMPS["dirt"][3], 0.5)
    if variant in DEEP_FINDS:
        letters, tones = DEEP_FINDS[variant]
        for row, cells in enumerate(letters):
            for column, cell in enumerate(cells):
                if cell != ".":
                    picture[5 + row, 4 + column] = mix(tones[int(cell)], OUTLINE, 0.25)
    return opaque(picture)


def fading(variant):
    """Return the picture of the transition from ground to deep ground, (16, 16, 4) uint8: both in a dither pattern.

    variant: 0..1.
    """
    upper, lower = texture("ground", variant), deep(variant)[..., :3]
    return opaque(np.where((dither(TILE, TILE) > 0)[..., None], upper, lower))


def _bricks(picture, ramp, variant):
    """Draw two courses of blocks, offset by half a block, with lit upper and dark lower edges. Return the picture.

    picture: (16, 16, 3) uint8, changed in place; ramp: its colours; variant: 0 plain, 1 and 3 with a crack, 2 worn.
    """
    picture[:] = mix(picture, ramp[2], 0.6)
    for row, offset in ((0, 4), (8, 12)):
        picture[row] = ramp[3]
        picture[row + 7] = ramp[0]
        picture[row : row + 8, offset] = ramp[0]
        picture[row : row + 7, (offset + 1) % TILE] = ramp[3]
        picture[row + 6] = mix(picture[row + 6], ramp[1], 0.55)  # the blocks' lower and right edges turn from the light
        picture[row + 1 : row + 7, offset - 1] = mix(picture[row + 1 : row + 7, offset - 1], ramp[1], 0.45)
        picture[row + 6 : row + 8, offset] = picture[row + 7] = ramp[0]
        picture[row, offset] = ramp[1]
        if variant == 2:  # worn by weather
            for column, drop in BLEMISHES[row // 8]:
                picture[row + drop, column] = ramp[1]
                picture[row + drop + 1, column] = ramp[3]
    if variant in (1, 3):  # a crack
        for step, (column, row) in enumerate(((8, 9), (9, 10), (9, 11), (10, 12), (11, 12))):
            picture[row, column - variant] = ramp[0 if step % 2 else 1]
    return picture


def blob(material, mask, variant=0):
    """Return the picture of one tile of a material, (16, 16, 4) uint8, opaque.

    It has edges and corners where a neighbour is missing. material: key of MATERIALS; mask: sum of the bits N, NE, E
    ... of the solid neighbours; variant: 0..3, as in texture().
    """
    ramp, cap = RAMPS[MATERIALS[material][0]], RAMPS[MATERIALS[material][1]]
    picture = texture(material, variant)
    grass = material == "ground"
    if not mask & W:
        _side(picture, ramp, 0, 1, 3 if grass else 4)
    if not mask & E:
        _side(picture, ramp, 15, -1, 0)
    if not mask & S:
        picture[15] = OUTLINE
        picture[13:15] = mix(picture[13:15], ramp[0], 0.65)
    if not mask & N:
        _top(picture, cap, material)
    for corner, first, second in CORNERS:
        if mask & first and mask & second and not mask & corner:
            _inner_corner(picture, corner, cap, grass)
    for gone, row, column in ((N | W, 0, 0), (N | E, 0, 15), (S | W, 15, 0), (S | E, 15, 15)):
        if not mask & gone:  # both sides open: knock the corner off
            picture[row, column] = OUTLINE
    return opaque(picture)


def _side(picture, ramp, column, inward, light):
    picture[:, column] = OUTLINE
    picture[:, column + inward] = ramp[light]
    picture[::3, column + 2 * inward] = ramp[light]


def _top(picture, cap, material):
    """Draw the top of a tile into `picture`: ragged grass on ground, a worn edge on stone or rock. cap: its colours."""
    picture[0] = OUTLINE
    if material != "ground":
        picture[1] = cap[5]
        picture[2] = cap[4]
        if material == "rock":  # chipped: no lip is as deep as its neighbour
            for column in range(TILE):
                picture[3 : int(FRINGE[column]), column] = cap[3]
                picture[int(FRINGE[column]), column] = cap[1]
        return
    for column in range(TILE):
        deep = int(FRINGE[column])
        picture[1, column] = cap[5 if column % 5 < 2 else 4]
        picture[2, column] = cap[4]
        picture[3 : 1 + deep, column] = cap[3]
        picture[1 + deep, column] = cap[1]
        picture[2 + deep, column] = mix(picture[2 + deep, column], OUTLINE, 0.45)


def _inner_corner(picture, corner, cap, grass):
    """Draw the corner at which a tile has both side neighbours, but not the diagonal one, into `picture`.

    It consists of the outline and, for ground, the end of the grass beside it. corner: NE, SE, SW or NW; cap: colours
    of the top; grass: whether the material is ground.
    """
    column = 0 if corner in (NW, SW) else 15
    row = 0 if corner in (NW, NE) else 15
    picture[row, column] = OUTLINE
    if row == 0 and grass:
        inward = 1 if column == 0 else -1
        picture[1, column] = cap[3]
        picture[0, column + inward] = cap[3]
        picture[1, column + inward] = cap[1]
        picture[2, column] = cap[1]


def slope(name):
    """Return the picture of a slope with grass, (16, 16, 4) uint8, clear above the surface. name: key of SLOPES."""
    left, right = SLOPES[name]
    cap = RAMPS["grass"]
    picture = texture("ground", 1)
    x, y = grid(TILE, TILE)
    surface = TILE - (left + (right - left) * x / TILE) * TILE
    depth = np.floor(y - surface + 0.5).astype(int)
    fringe = FRINGE[None, :] + (1 if abs(left - right) == 1 else 0)  # steeper: deeper to look as thick
    for limit, tone in ((fringe + 3, None), (fringe + 2, cap[1]), (fringe + 1, cap[3]), (3, cap[4]), (2, cap[5])):
        band = depth < limit
        picture[band] = mix(picture[band], OUTLINE, 0.45) if tone is None else tone
    picture[depth < 1] = OUTLINE
    out = opaque(picture)
    out[depth < 0] = 0
    return out


def under_slope(name):
    """Return the picture of the ground tile below a slope, with the lower end of the slope's grass, (16, 16, 4) uint8.

    name: key of SLOPES.
    """
    left, right = SLOPES[name]
    picture = texture("ground", 0)
    cap = RAMPS["grass"]
    x, y = grid(TILE, TILE)
    depth = y + (left + (right - left) * x / TILE) * TILE  # px below the surface of the slope above
    for limit, tone in ((6, None), (5, cap[1]), (4, cap[3])):
        band = depth < limit
        picture[band] = mix(picture[band], OUTLINE, 0.4) if tone is None else tone
    return opaque(picture)


def plank(part):
    """Return the picture of a one-way plank, 16 x 16 px, with its boards in the top 6 rows.

    part: "left", "middle", "right" or "single".
    """
    wood = RAMPS["wood"]
    picture = np.zeros((TILE, TILE, 4), np.uint8)
    rows = (OUTLINE, wood[5], wood[4], wood[3], wood[2], OUTLINE)
    for row, colour in enumerate(rows):
        picture[row] = (*colour, 255)
    for column in (5, 11):
        picture[1:5, column] = (*wood[1], 255)
    if part in ("left", "single"):
        picture[:6, 0] = (*OUTLINE, 255)
        _bracket(picture, 2, 1)
    if part in ("right", "single"):
        picture[:6, 15] = (*OUTLINE, 255)
        _bracket(picture, 13, -1)
    return picture


def _bracket(picture, column, inward):
    """Draw a short strut under an end of a plank into `picture`.

    column: column of the strut; inward: 1 or -1, direction towards the plank's centre.
    """
    for i in range(5):
        for dx, colour in ((0, RAMPS["wood"][2]), (inward, RAMPS["wood"][1])):
            picture[6 + i, column + dx] = (*colour, 255)
        picture[6 + i, column - inward] = picture[6 + i, column + 2 * inward] = (*OUTLINE, 255)
    picture[11, column] = picture[11, column + inward] = (*OUTLINE, 255)


def ladder(top):
    """Return the picture of a piece of a wooden ladder, (16, 16, 4) uint8, seamless when it is repeated downwards.

    top: whether it is the top piece, which has planks to stand on.
    """
    wood = RAMPS["wood"]
    picture = np.zeros((TILE, TILE, 4), np.uint8)
    for left in (2, 11):
        for column, colour in enumerate((OUTLINE, wood[4], wood[2], OUTLINE)):
            picture[:, left - 1 + column] = (*colour, 255)
    for row in (2, 10):
        picture[row - 1, 5:10] = picture[row + 3, 5:10] = (*OUTLINE, 255)
        for step, colour in enumerate((wood[5], wood[3], wood[1])):
            picture[row + step, 4:11] = (*colour, 255)
        picture[row + 1, 2] = picture[row + 1, 12] = (*wood[0], 255)  # pegs
    if top:
        picture[:5] = 0
        for row, colour in enumerate((OUTLINE, wood[5], wood[3], OUTLINE)):
            picture[row] = (*colour, 255)
        picture[1:3, [0, 15]] = (*OUTLINE, 255)
        picture[1:3, 8] = (*wood[1], 255)
        picture[4, [1, 4, 10, 13]] = (*OUTLINE, 255)
        picture[4, [2, 3, 11, 12]] = (*wood[1], 255)
    return picture


def material_tiles(material):
    """Return the tiles of one material, {name: (pixels, properties)}.

    First comes one tile for each combination of solid neighbours, named <material>_<mask>. Then come more variants of
    the tile with all eight neighbours. material: key of MATERIALS; properties: as in tile_table().
    """
    table = {f"{material}_{mask}": (blob(material, mask), {"kind": "solid"}) for mask in BLOBS}
    for variant in range(1, DEPTHS):
        table[f"{material}_255_{variant}"] = (blob(material, 255, variant), {"kind": "solid"})
    return table


def tile_table():
    """Return {name: (pixels, properties)} of all tiles in the order of the tileset.

    properties: dict that the .tmj contains for the tile.
    """
    table = {}
    for material in MATERIALS:
        if material not in LATER:
            table.update(material_tiles(material))
    for variant in range(2):
        table[f"ground_fading_{variant}"] = (fading(variant), {"kind": "solid"})
    for variant in range(5):
        table[f"ground_deep_{variant}"] = (deep(variant), {"kind": "solid"})
    for name, (left, right) in SLOPES.items():
        table[name] = (slope(name), {"kind": "slope", "left": left, "right": right})
        table[f"under_{name}"] = (under_slope(name), {"kind": "solid"})
    for part in ("left", "middle", "right", "single"):
        table[f"plank_{part}"] = (plank(part), {"kind": "one_way"})
    table.update(decoration_tiles())
    # Later tiles are appended, so that the numbers above do not change.
    table["ladder"] = (ladder(False), {"kind": "decor"})
    table["ladder_top"] = (ladder(True), {"kind": "one_way"})
    for material in LATER:
        table.update(material_tiles(material))
    table.update(cave_tiles())
    for material in ("stone", "rock"):
        for name, share in DARKER.items():
            for variant in range(2):
                picture = mix(texture(material, variant * 2), DEEP_SHADE, share)
                table[f"{material}_{name}_{variant}"] = (opaque(picture), {"kind": "solid"})
    return table


def tiles_files():
    """Return {path relative to assets/: bytes} of the sprite sheet "tiles"."""
    sheet = Sheet("tiles", gap=0)
    for name, (pixels, _) in tile_table().items():
        sheet.add(name, pixels)
    return sheet.files()
