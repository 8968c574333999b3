"""The sprite sheet "things": coins, spring, crates, spikes, enemies, platforms, checkpoint, goal, sign and small
puffs.

Things that stand on the ground touch it with their bottom row. Enemies face left.
"""

from assets import FOLDER
from assets.craft.atlas import Sheet
from assets.craft.drawn import read_parts
from assets.craft.fields import box, capsule, circle, ellipse, polygon
from assets.craft.palette import OUTLINE, RAMPS, WHITE
from assets.craft.shading import Sprite, flashed, glow
from assets.platformer.blast_wall import add_blast_wall
from assets.platformer.rope_bridge import add_rope_bridge
from assets.platformer.stonework import add_stonework

LETTERS = {
    "O": OUTLINE,
    "E": OUTLINE,
    "W": WHITE,
    "V": RAMPS["purple"][4],
    "v": RAMPS["purple"][3],
    "x": RAMPS["purple"][1],
    "X": RAMPS["pink"][4],  # shell
    "L": RAMPS["gold"][4],
    "l": RAMPS["gold"][2],
    "M": RAMPS["wood"][2],  # face, feet
    "R": RAMPS["red"][4],
    "r": RAMPS["red"][3],
    "k": RAMPS["red"][1],
    "G": RAMPS["gold"][4],
    "g": RAMPS["gold"][2],
    "A": RAMPS["steel"][4],
    "a": RAMPS["steel"][3],
    "m": RAMPS["steel"][1],
    "D": RAMPS["wood"][1],
    "K": RAMPS["wood"][3],
    "n": RAMPS["wood"][2],
    "B": RAMPS["blue"][4],
    "b": RAMPS["blue"][3],
    "z": RAMPS["blue"][2],  # bat
}
COIN_WIDTHS = (5.0, 4.2, 2.6, 1.2, 2.6, 4.2)  # [px] half widths over a turn
FLAG_WAVE = (  # [px] offset of the cloth, along it, per frame
    (0, 0, 0, 1, 1, 1, 0, 0),
    (0, 0, 1, 1, 1, 0, 0, -1),
    (0, 1, 1, 1, 0, 0, -1, -1),
    (0, 1, 1, 0, 0, -1, -1, 0),
)


def coin(frame):
    """Return the picture of a spinning coin, 14 x 14 px. frame: 0..5."""
    sprite = Sprite(14, 14)
    x, y, half = sprite.x, sprite.y, COIN_WIDTHS[frame]
    gold = RAMPS["gold"]
    sprite.flat(ellipse(x, y, 7, 7, half + 0.3, 5.3), gold[4])
    sprite.paint(ellipse(x, y, 7.9, 8.0, half + 0.3, 5.3) * -1, gold[5])  # the lit rim: the rest of a shifted disc
    sprite.paint(ellipse(x, y, 6.1, 6.0, half + 0.3, 5.3) * -1, gold[2])  # and the rim in shadow
    if half > 2:
        sprite.paint(ellipse(x, y, 7, 7, half - 1.5, 3.6), gold[3])
        sprite.paint(ellipse(x, y, 7.6, 7.6, half - 1.8, 3.2), gold[4])
        sprite.paint(box(x, y, 7 - half * 0.2, 4.6, 7 + half * 0.2, 9.4), gold[2])
    if frame in (0, 1, 5):
        sprite.dot(int(7 - half * 0.55), 4, WHITE)
    return sprite.outline().pixels()


def sparkle(frame):
    """Return the picture of the sparkle of a taken coin, 14 x 14 px. frame: 0..3."""
    sprite = Sprite(14, 14)
    reach = (2.0, 4.0, 5.6, 6.4)[frame]
    for step_x, step_y in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        begin = max(0.4, reach - 2.8 + frame * 0.3)
        sprite.flat(
            capsule(
                sprite.x,
                sprite.y,
                (7 + step_x * begin, 7 + step_y * begin),
                (7 + step_x * reach, 7 + step_y * reach),
                0.8,
            ),
            RAMPS["gold"][5 - frame // 2],
        )
    if frame < 2:
        sprite.flat(circle(sprite.x, sprite.y, 7, 7, 1.8 - frame * 0.6), WHITE)
    return sprite.pixels()


def dust(frame):
    """Return the picture of a puff of dust at the feet, 16 x 10 px: two clouds that separate, rise and thin out.

    frame: 0..4.
    """
    sprite = Sprite(16, 10)
    x, y = sprite.x, sprite.y
    tones = (RAMPS["dirt"][4], RAMPS["dirt"][5], RAMPS["stone"][5])
    for side in (-1, 1):
        away, radius = 1.4 + frame * 1.15, (2.8, 2.9, 2.5, 1.8, 1.1)[frame]
        middle, height = 8 + side * away, 9.4 - radius - frame * 0.55
        sprite.flat(circle(x, y, middle, height + radius * 0.2, radius), tones[0])
        sprite.flat(circle(x, y, middle + side * radius * 0.9, height + radius * 0.5, radius * 0.6), tones[0])
        sprite.flat(circle(x, y, middle - 0.3, height - 0.3, radius * 0.75), tones[1])
        if frame < 3:
            sprite.flat(circle(x, y, middle - 0.7, height - 0.8, radius * 0.36), tones[2])
    return sprite.pixels()


def crate(size):
    """Return the picture of a wooden crate with a frame and a brace, size x size px."""
    sprite = Sprite(size, size)
    x, y, edge = sprite.x, sprite.y, max(3, size // 8)
    sprite.part(box(x, y, 1, 1, size - 1, size - 1, 1), RAMPS["wood"], bulge=2, base=0.36, gain=0.2)
    for line in range(edge + 4, size - edge, 5):
        sprite.paint(box(x, y, edge, line, size - edge, line + 1), RAMPS["wood"][0], 0.7)
    sprite.part(capsule(x, y, (edge, size - edge), (size - edge, edge), edge * 0.55), RAMPS["wood"], bulge=2, base=0.54)
    for left, top, right, bottom in (
        (1, 1, 1 + edge, size - 1),
        (size - 1 - edge, 1, size - 1, size - 1),
        (1, 1, size - 1, 1 + edge),
        (1, size - 1 - edge, size - 1, size - 1),
    ):
        sprite.part(box(x, y, left, top, right, bottom, 0.5), RAMPS["wood"], bulge=1.8, base=0.58, grain=0.6)
    corner = edge // 2 + 1
    for nail_x in (corner, size - 1 - corner):
        for nail_y in (corner, size - 1 - corner):
            sprite.dot(nail_x, nail_y, RAMPS["gunmetal"][1]).dot(nail_x - 1, nail_y - 1, RAMPS["steel"][5])
    sprite.rim(share=0.35)
    frame = (x < 1) | (x > size - 1) | (y < 1) | (y > size - 1)
    sprite.rgb[frame] = OUTLINE
    sprite.solid[:] = True
    return sprite.pixels()


def platform(width):
    """Return the picture of a moving platform, width x 16 px: stone slabs on brackets. Its top row is its
    upper side.
    """
    sprite = Sprite(width, 16)
    x, y = sprite.x, sprite.y
    sprite.part(box(x, y, 1, 1, width - 1, 9, 2), RAMPS["stone"], bulge=3, base=0.56)
    for seam in range(16, width - 4, 16):
        sprite.paint(box(x, y, seam - 0.5, 1, seam + 0.5, 9), RAMPS["stone"][1])
    sprite.paint(box(x, y, 2, 1, width - 2, 2.4), RAMPS["teal"][4])
    for middle in (width / 4, width * 3 / 4):
        sprite.part(
            polygon(x, y, [(middle - 6, 9.4), (middle + 6, 9.4), (middle + 2.5, 14.5), (middle - 2.5, 14.5)]),
            RAMPS["gunmetal"],
            bulge=3,
            base=0.5,
        )
        sprite.part(circle(x, y, middle, 11.4, 1.8), RAMPS["teal"], bulge=2, base=0.6, grain=0)
    return sprite.rim(share=0.3).outline().pixels()


def checkpoint(lit, frame):
    """Return the picture of a lamp post, 16 x 32 px. lit: whether the lamp glows; frame: 0..1 of its flicker."""
    sprite = Sprite(16, 32)
    x, y = sprite.x, sprite.y
    sprite.part(capsule(x, y, (8, 13), (8, 30), 1.4), RAMPS["wood"], bulge=1.5, base=0.5)
    sprite.part(box(x, y, 4, 28, 12, 31, 1), RAMPS["stone"], bulge=2, base=0.5)
    sprite.part(polygon(x, y, [(8, 1), (3, 5.4), (13, 5.4)]), RAMPS["gunmetal"], bulge=2, base=0.55)
    glass = RAMPS["gold"] if lit else RAMPS["gunmetal"]
    sprite.part(box(x, y, 4, 5, 12, 13, 2), glass, bulge=4, base=(0.72, 0.84)[frame] if lit else 0.4, grain=0)
    if lit:
        sprite.flat(ellipse(x, y, 8, 9.4 - frame * 0.5, 1.5, 2.4 + frame * 0.5), WHITE)
    return sprite.rim(share=0.35).outline().pixels()


def goal(frame):
    """Return the picture of a tall pole with a waving flag, 32 x 48 px. frame: 0..3.

    The pole is at x = 5 to 8 of the picture.
    """
    sprite = Sprite(32, 48)
    x, y = sprite.x, sprite.y
    cloth = FLAG_WAVE[frame]
    for i, column in enumerate(range(8, 30)):
        lift = cloth[i * len(cloth) // 22]
        top, bottom = 6 + lift + i * 0.18, 23 + lift - i * 0.22
        inside = (x > column) & (x < column + 1) & (y > top) & (y < bottom)
        checker = ((i // 4) + (y - top) // 4.4).astype(int) % 2 == 0
        shade = 1 if lift > 0 else 0
        for tone, where in ((RAMPS["red"][3 - shade], checker), (RAMPS["steel"][5 - shade], ~checker)):
            sprite.rgb[inside & where] = tone
        sprite.solid |= inside
    sprite.part(capsule(x, y, (6.5, 4), (6.5, 45), 1.3), RAMPS["steel"], bulge=1.4, base=0.6, grain=0)
    sprite.part(circle(x, y, 6.5, 3.6, 2.5), RAMPS["gold"], bulge=2.4, base=0.6, grain=0)
    sprite.part(box(x, y, 1.5, 43, 11.5, 47, 1.5), RAMPS["stone"], bulge=2, base=0.55)
    return sprite.outline().pixels()


def arrow(frame):
    """Return the picture of an arrow that points down as a hint and moves up and down, 11 x 12 px. frame: 0..1."""
    sprite = Sprite(11, 12)
    shape = ((4, 1), (7, 1), (7, 5), (9.8, 5), (5.5, 10), (1.2, 5), (4, 5))
    points = [(x, y + frame) for x, y in shape]
    sprite.part(polygon(sprite.x, sprite.y, points), RAMPS["gold"], bulge=2, base=0.68, grain=0)
    return sprite.outline().pixels()


def hedgehog(frame):
    """Return the picture of a hedgehog, an enemy covered with spines, facing left, 20 x 14 px. frame: 0..3."""
    sprite = Sprite(20, 14)
    x, y = sprite.x, sprite.y
    for i, foot in enumerate((6.2, 9.4, 13.0, 16.0)):  # near and far feet in turn
        step = ((-0.8, 0.0), (0.0, -1.0), (0.8, 0.0), (0.0, 0.0))[(frame + 2 * i) % 4]
        sprite.flat(
            box(x, y, foot - 1.4 + step[0], 10.6 + step[1], foot + 1.2 + step[0], 13 + step[1], 0.6),
            RAMPS["wood"][2 if i % 2 else 3],
        )
    sprite.part(ellipse(x, y, 11.4, 8.4, 7.4, 4.2), RAMPS["wood"], bulge=4, base=0.40, gain=0.4, grain=0)
    spines = (
        (5.4, 7.4, 3.8, 3.6),
        (8.0, 5.8, 6.8, 1.6),
        (11.0, 5.2, 10.8, 1.2),
        (14.0, 5.8, 15.0, 1.7),
        (16.2, 7.4, 18.0, 3.9),
        (17.0, 9.4, 18.4, 7.4),
    )
    for root_x, root_y, tip_x, tip_y in spines[::-1]:
        across_x, across_y = (root_y - tip_y) * 0.34, (tip_x - root_x) * 0.34
        corners = [
            (root_x - across_x, root_y - across_y),
            (tip_x, tip_y),
            (root_x + across_x, root_y + across_y),
            (11.4, 9.6),
        ]
        sprite.flat(polygon(x, y, corners) - 0.7, OUTLINE)
        sprite.flat(polygon(x, y, corners), RAMPS["steel"][2])
        sprite.paint(polygon(x, y, [corners[0], corners[1], (root_x, root_y)]), RAMPS["steel"][5])
    sprite.part(ellipse(x, y, 4.6, 9.6, 3.6, 2.7), RAMPS["gold"], bulge=3, base=0.60, gain=0.4, grain=0)
    sprite.part(ellipse(x, y, 11.0, 10.8, 6.4, 1.7), RAMPS["gold"], bulge=2, base=0.44, gain=0.3, grain=0, shadow=1)
    sprite.outline()
    sprite.dot(1, 9, OUTLINE).dot(1, 10, OUTLINE).dot(4, 8, OUTLINE).dot(4, 9, OUTLINE).dot(3, 8, WHITE)
    return sprite.pixels()


def things_files():
    """Return {path relative to assets/: bytes} of the sprite sheet "things"."""
    path = FOLDER / "drawings" / "things.txt"
    drawn = read_parts(path.read_text(encoding="utf-8"), LETTERS, path.name)
    sheet = Sheet("things")
    sheet.add_sequence("coin", [coin(i) for i in range(6)], 10)
    sheet.add_sequence("sparkle", [sparkle(i) for i in range(4)], 16)
    sheet.add_sequence("dust", [dust(i) for i in range(5)], 18)
    for name in ("spring_0", "spring_1", "spring_2"):
        sheet.add(name, drawn[name])
    sheet.animate("spring", ("spring_1", "spring_2", "spring_2", "spring_0"), 16)
    sheet.add_sequence("walker", [drawn[f"walker_{i}"] for i in (0, 1, 2, 1)], 8)
    sheet.add("walker_squashed", drawn["walker_squashed"])
    sheet.add("walker_flash", flashed(drawn["walker_0"]))
    sheet.add("crate", crate(16))
    sheet.add("crate_large", crate(32))
    sheet.add("platform", platform(48))
    sheet.add("spikes", drawn["spikes"])
    sheet.add("sign", drawn["sign"])
    sheet.add("checkpoint_off", checkpoint(False, 0))
    sheet.add_sequence("checkpoint", [checkpoint(True, i) for i in range(2)], 5)
    sheet.add_sequence("goal", [goal(i) for i in range(4)], 8)
    sheet.add_sequence("arrow", [arrow(i) for i in range(2)], 3)
    sheet.add("lantern_light", glow(64, "gold", 0.60))
    sheet.add_sequence("bat", [drawn[f"bat_{i}"] for i in (0, 1, 2, 1)], 10)
    sheet.add_sequence("hedgehog", [hedgehog(i) for i in range(4)], 8)
    add_stonework(sheet)
    add_blast_wall(sheet)
    add_rope_bridge(sheet)
    return sheet.files()
