"""The sprite sheet "ui": the title's logo, window frames for menus, bars and small icons."""

import numpy as np

from assets import FOLDER
from assets.craft.atlas import Sheet
from assets.craft.drawn import read_parts
from assets.craft.fields import box
from assets.craft.palette import OUTLINE, RAMPS, WHITE, mix, oklch
from assets.craft.shading import Sprite
from assets.ui.logo import logo

LETTERS = {
    "O": OUTLINE,
    "k": OUTLINE,
    "W": WHITE,
    "w": RAMPS["steel"][5],
    "s": RAMPS["steel"][3],
    "m": RAMPS["gunmetal"][2],
    "r": RAMPS["red"][3],
    "R": RAMPS["red"][2],
    "y": RAMPS["gold"][4],
    "Y": RAMPS["gold"][3],
    "G": RAMPS["gold"][2],
    "b": RAMPS["blue"][4],
    "B": RAMPS["blue"][2],
    "c": RAMPS["glass"][3],
    "g": RAMPS["green"][4],
    "t": RAMPS["teal"][4],
    "u": RAMPS["teal"][3],
    "v": RAMPS["teal"][1],
}


def panel(light, body):
    """Return the picture of a window frame, 24 x 24 px. To enlarge it, the parts between its 8 px corners are
    stretched.

    light: colour of its edge; body: colour of its inside.
    """
    sprite = Sprite(24, 24)
    x, y = sprite.x, sprite.y
    sprite.flat(box(x, y, 0, 0, 24, 24, 3), OUTLINE)
    sprite.flat(box(x, y, 1, 1, 23, 23, 2), light)
    sprite.flat(box(x, y, 2, 2, 23, 23, 2), mix(light, OUTLINE, 0.55))
    sprite.flat(box(x, y, 2, 2, 22, 22, 1.5), body)
    return sprite.pixels()


def bar(ramp):
    """Return the picture of a piece of a filled bar, (8, 8, 4) uint8, which is repeated in x.

    ramp: name of its colours, a key of RAMPS.
    """
    out = np.zeros((8, 8, 4), np.uint8)
    out[..., 3] = 255
    for row, tone in enumerate((None, 5, 4, 4, 3, 3, 2, None)):
        out[row, :, :3] = OUTLINE if tone is None else RAMPS[ramp][tone]
    return out


def ui_files():
    """Return {path relative to assets/: bytes} of the sprite sheet "ui"."""
    sheet, path = Sheet("ui"), FOLDER / "drawings" / "icons.txt"
    sheet.add("logo", logo())
    sheet.add("panel", panel(RAMPS["steel"][3], oklch(0.22, 0.045, 283)))
    sheet.add("panel_selected", panel(RAMPS["gold"][4], oklch(0.30, 0.075, 290)))
    sheet.add("panel_dark", panel(RAMPS["gunmetal"][3], oklch(0.16, 0.030, 283)))
    for ramp in ("red", "gold", "green", "teal", "gunmetal"):
        sheet.add(f"bar_{ramp}", bar(ramp))
    for name, picture in read_parts(path.read_text(encoding="utf-8"), LETTERS, path.name).items():
        sheet.add(f"icon_{name}", picture)
    return sheet.files()
