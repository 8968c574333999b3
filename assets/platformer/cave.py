"""The tiles of the cave and the keep: rock made of boulders, back walls, dripstone, crystals, and things on walls.

Rock is cold (violet in the shade, teal in the light), which distinguishes it from the warm ground above it.
"""

import numpy as np

from assets.craft.drawn import lay
from assets.craft.fields import box, capsule, circle, noise, polygon
from assets.craft.palette import OUTLINE, RAMPS, WHITE, mix
from assets.craft.shading import Sprite, opaque
from assets.platformer.decoration import TILE, back_wall

SEEDS = ((2, 3), (8, 1), (13, 5), (5, 9), (11, 11), (1, 13))  # middles of the boulders, px; they repeat with the tile
CLODS = ((3, 2), (11, 4), (6, 9), (14, 11), (2, 14), (9, 15))
WALL_DARK = (18, 17, 38)


def _cells(seeds):
    """Divide a tile into cells around points. Return (own, next, slope), three arrays (TILE, TILE).

    seeds: the points, (x, y) each [px]; own, next: distance of a pixel from the nearest and the second nearest point
    [px]; slope: how far the pixel faces the light [px], negative if it faces away.
    """
    y, x = np.mgrid[0:TILE, 0:TILE] + 0.5
    nearest, second, facing = np.full(x.shape, 99.0), np.full(x.shape, 99.0), np.zeros(x.shape)
    for seed_x, seed_y in seeds:
        dx = (x - seed_x + TILE / 2) % TILE - TILE / 2
        dy = (y - seed_y + TILE / 2) % TILE - TILE / 2
        distance = np.sqrt(dx * dx + dy * dy)
        closer = distance < nearest
        second = np.where(closer, nearest, np.minimum(second, distance))
        facing = np.where(closer, -(dx * 0.55 + dy * 0.80), facing)
        nearest = np.minimum(nearest, distance)
    return nearest, second, facing


def boulders(variant):
    """Return the picture of the inside of the rock, (16, 16, 3) uint8: boulders that fill the tile.

    variant: 0..3; all variants have the same layout of boulders, so they fit together.
    """
    ramp = RAMPS["rock"]
    nearest, second, facing = _cells(SEEDS)
    grain = noise(TILE, TILE, 8, 8, 510 + variant) - 0.5
    level = 1.25 + facing * 0.15 + grain * 0.9
    tones = np.array([ramp[0], mix(ramp[1], ramp[0], 0.4), ramp[1], mix(ramp[1], ramp[2], 0.5), ramp[2]])
    picture = tones[np.clip(np.floor(level + 0.8), 0, 4).astype(int)]
    edge = second - nearest
    picture[edge < 0.9] = ramp[0]
    lit = (edge >= 0.9) & (edge < 1.9) & (facing > 1.4)
    picture[lit] = mix(ramp[2], ramp[3], 0.6)
    if variant == 1:  # a vein
        for step, (column, row) in enumerate(((10, 2), (11, 3), (11, 4), (12, 5), (13, 6))):
            picture[row, column] = RAMPS["teal"][3 if step % 2 else 2]
    if variant == 2:  # a crack
        for column, row in ((4, 7), (5, 8), (5, 9), (6, 10), (7, 10)):
            picture[row, column] = OUTLINE
    if variant == 3:  # pebbles
        picture[12, 10:13] = ramp[3]
        picture[13, 10:13] = ramp[1]
        picture[3, 4:6] = ramp[3]
    return picture


def clods(ramp, seed):
    """Return the picture of packed earth, (16, 16, 3) uint8: clods shaped like boulders, but with little contrast.

    ramp: array of its colours; seed: seed of the random numbers.
    """
    nearest, second, facing = _cells(CLODS)
    grain = noise(TILE, TILE, 8, 8, seed) - 0.5
    level = 1.0 + facing * 0.10 + grain * 1.5
    tones = np.array(
        [
            mix(ramp[1], ramp[0], 0.12),
            mix(ramp[1], ramp[2], 0.22),
            mix(ramp[1], ramp[2], 0.48),
            mix(ramp[1], ramp[2], 0.72),
        ]
    )
    picture = tones[np.clip(np.floor(level + 0.5), 0, 3).astype(int)]
    edge = second - nearest
    picture[(edge < 0.8) & (grain < 0.12)] = mix(ramp[1], ramp[0], 0.42)
    return picture


def back_cave(variant):
    """Return the picture of the rough wall behind the cave, (16, 16, 4) uint8, opaque: boulders, darkened.

    variant: 0..1.
    """
    return opaque(mix(boulders(0 if variant == 0 else 2), WALL_DARK, 0.62))


def dripstone(hanging):
    """Return the picture of a stalactite (`hanging` is True) or of a stalagmite, 16 x 16 px.

    Its broad end touches the edge of the tile.
    """
    sprite = Sprite(TILE, TILE)
    ways = ([(2.6, -2), (7.6, -2), (5.4, 13.6)], [(8.4, -2), (13.4, -2), (11.2, 8.6)])
    for points in ways[::-1]:
        if not hanging:
            points = [(x, TILE - y) for x, y in points]
        sprite.part(polygon(sprite.x, sprite.y, points), RAMPS["rock"], bulge=2.4, base=0.42, gain=0.5, grain=0.3)
    rows = (3, 6, 9) if hanging else (7, 10, 13)
    for row in rows:
        sprite.paint(box(sprite.x, sprite.y, 0, row, TILE, row + 1), RAMPS["rock"][1], 0.35)
    return sprite.outline().pixels()


def crystal(variant):
    """Return the picture of a cluster of glowing crystals on the ground, 16 x 16 px. variant: 0..1."""
    sprite = Sprite(TILE, TILE)
    ramp = RAMPS["teal"]
    spears = (
        ((4, 15, 2.4, 7.2, 2.2), (11.4, 15, 13.6, 8, 2.0), (7.6, 15, 8.0, 2.6, 2.8)),
        ((5, 15, 3.4, 9.6, 2.0), (10, 15, 11.0, 5.2, 2.6)),
    )[variant]
    for foot_x, foot_y, tip_x, tip_y, half in spears:
        shoulder = tip_y + 2.6
        body = [
            (tip_x, tip_y),
            (tip_x + half, shoulder),
            (foot_x + half * 0.8, foot_y),
            (foot_x - half * 0.8, foot_y),
            (tip_x - half, shoulder),
        ]
        sprite.flat(polygon(sprite.x, sprite.y, body) - 0.9, OUTLINE)
        sprite.flat(polygon(sprite.x, sprite.y, body), ramp[3])
        sprite.paint(
            polygon(
                sprite.x,
                sprite.y,
                [body[0], body[4], body[3], (foot_x - half * 0.1, foot_y), (tip_x - half * 0.2, shoulder)],
            ),
            ramp[5],
        )
        sprite.paint(
            polygon(
                sprite.x, sprite.y, [(tip_x + half * 0.35, shoulder), body[1], body[2], (foot_x + half * 0.3, foot_y)]
            ),
            ramp[2],
        )
    sprite.flat(polygon(sprite.x, sprite.y, [(1, 16), (3, 13.4), (8, 14.4), (13, 13.2), (15, 16)]), RAMPS["rock"][1])
    return sprite.pixels()


def glowcap():
    """Return the picture of two glowing mushrooms, 16 x 16 px."""
    sprite = Sprite(TILE, TILE)
    x, y = sprite.x, sprite.y
    for middle, top, radius in ((10.6, 9.4, 3.2), (5.4, 6, 4.2)):
        sprite.part(
            capsule(x, y, (middle, top + 1), (middle, 14.6), 1.1), RAMPS["steel"], bulge=1.4, base=0.66, grain=0
        )
        cap = np.maximum(circle(x, y, middle, top + 0.6, radius), y - top - 1.4)
        sprite.part(cap, RAMPS["teal"], bulge=3, base=0.60, gain=0.4, grain=0)
        sprite.paint(box(x, y, middle - radius, top + 0.4, middle + radius, top + 1.4), RAMPS["teal"][5])
        sprite.dot(int(middle - radius * 0.4), int(top - radius * 0.3), WHITE)
    return sprite.outline().pixels()


def banner():
    """Return the picture of a long cloth on the back wall: red with a gold wing, cut into two points at
    its lower end.
    """
    picture = back_wall(0)
    sprite = Sprite(TILE, TILE)
    x, y = sprite.x, sprite.y
    cloth = polygon(x, y, [(3, 1), (13, 1), (13, 14.6), (8, 11.6), (3, 14.6)])
    sprite.part(cloth, mix(RAMPS["red"], OUTLINE, 0.2), bulge=3, base=0.44, gain=0.35, grain=0.2)
    for column in (5, 10):  # folds
        sprite.paint(box(x, y, column, 2, column + 1, 15), RAMPS["red"][1], 0.45)
    sprite.stamp(("#..##..#", ".#.##.#.", "..####..", "...##..."), 4, 5, {"#": RAMPS["gold"][3]})
    sprite.part(box(x, y, 2, 0.6, 14, 2.4), RAMPS["wood"], bulge=1.4, base=0.5, grain=0)
    lay(picture, sprite.outline().pixels(), 0, 0)
    return picture


def window():
    """Return the picture of an arrow slit in the back wall with warm light behind it."""
    picture = back_wall(1)
    sprite = Sprite(TILE, TILE)
    x, y = sprite.x, sprite.y
    sprite.flat(box(x, y, 4, 1, 12, 15, 3), mix(RAMPS["stone"][3], OUTLINE, 0.25))
    sprite.flat(box(x, y, 5, 2, 12, 15, 3), mix(RAMPS["stone"][1], OUTLINE, 0.2))
    sprite.flat(box(x, y, 6, 2.6, 10, 14, 2), RAMPS["orange"][3])
    sprite.paint(box(x, y, 6, 5, 10, 14), RAMPS["gold"][4])
    sprite.paint(box(x, y, 7, 7, 9, 13), RAMPS["gold"][5])
    sprite.paint(box(x, y, 6, 2, 7, 14), OUTLINE, 0.5)  # the wall's thickness
    lay(picture, sprite.pixels(), 0, 0)
    return picture


def chain():
    """Return the picture of a hanging iron chain, clear around it. It is seamless when it is repeated downwards."""
    sprite = Sprite(TILE, TILE)
    links = (
        "..ab..",
        ".a..b.",
        ".a..b.",
        "..ab..",
        "..ab..",
        "..ab..",
        "..ab..",
        "..ab..",
    )  # one open, one from its edge
    for top in (0, 8):
        sprite.stamp(links, 5, top, {"a": RAMPS["gunmetal"][4], "b": RAMPS["gunmetal"][2]})
    return sprite.outline().pixels()


def cave_tiles():
    """Return {name: (pixels, properties)} of the tiles of this module, which do not collide, in the order of the
    tileset.
    """
    table = {f"back_cave_{i}": back_cave(i) for i in range(2)}
    table |= {"stalactite": dripstone(True), "stalagmite": dripstone(False)}
    table |= {f"crystal_{i}": crystal(i) for i in range(2)}
    table |= {"glowcap": glowcap(), "banner": banner(), "window": window(), "chain": chain()}
    return {name: (pixels, {"kind": "decor"}) for name, pixels in table.items()}
