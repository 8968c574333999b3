"""The platformer's hero: parts drawn by hand in drawings/hero.txt, combined into frames.

Every frame is 24 x 24 px and faces right. The feet are on the bottom row, centred on column 12. So the game draws a
frame at (box centre x - 12, box bottom - 24). The scarf extends backwards and does not collide.
"""

import numpy as np

from assets import FOLDER
from assets.craft.atlas import Sheet
from assets.craft.drawn import lay, read_parts
from assets.craft.palette import OUTLINE, RAMPS, oklch, ramp
from assets.craft.shading import flashed

SIZE = 24  # [px] width and height of a frame
HEAD_X, HEAD_Y = 6, 2

SKIN = ramp(55, 0.10, 0.42, 0.95)
LETTERS = {
    "O": OUTLINE,
    "E": oklch(0.20, 0.03, 285),
    "H": RAMPS["wood"][2],
    "h": RAMPS["wood"][3],
    "D": RAMPS["wood"][1],  # leather helmet
    "G": RAMPS["gold"][4],
    "C": RAMPS["glass"][5],
    "c": RAMPS["glass"][2],  # goggles
    "S": SKIN[4],
    "s": SKIN[3],
    "R": RAMPS["red"][3],
    "r": RAMPS["red"][2],  # scarf
    "T": RAMPS["teal"][4],
    "t": RAMPS["teal"][3],
    "d": RAMPS["teal"][1],  # jacket
    "L": RAMPS["wood"][1],
    "Y": RAMPS["gold"][4],  # belt, buckle
    "P": RAMPS["blue"][3],
    "p": RAMPS["blue"][1],  # trousers: near leg, far leg
    "B": RAMPS["wood"][4],
    "b": RAMPS["wood"][2],  # boots
}

# frame: (body, (head, dx, dy), (scarf, x, y)); the head moves with the body, the scarf lies behind both.
FRAMES = {
    "idle_0": ("idle_0", ("head", 0, 0), ("scarf_hang_0", 2, 12)),
    "idle_1": ("idle_0", ("head", 0, 0), ("scarf_hang_1", 2, 12)),
    "idle_2": ("idle_1", ("head", 0, 1), ("scarf_hang_0", 2, 13)),
    "idle_3": ("idle_1", ("head_blink", 0, 1), ("scarf_hang_1", 2, 13)),
    "run_0": ("run_0", ("head", 1, 0), ("scarf_run_0", 1, 10)),
    "run_1": ("run_1", ("head", 1, 1), ("scarf_run_1", 1, 11)),
    "run_2": ("run_2", ("head", 1, 0), ("scarf_run_2", 1, 10)),
    "run_3": ("run_3", ("head", 1, 0), ("scarf_run_0", 1, 10)),
    "run_4": ("run_4", ("head", 1, 1), ("scarf_run_1", 1, 11)),
    "run_5": ("run_5", ("head", 1, 0), ("scarf_run_2", 1, 10)),
    "jump_0": ("jump_0", ("head_up", 1, 0), ("scarf_down_0", 3, 12)),
    "jump_1": ("jump_1", ("head", 1, 0), ("scarf_run_1", 1, 10)),
    "fall_0": ("fall_0", ("head", 1, 0), ("scarf_up_0", 3, 6)),
    "fall_1": ("fall_1", ("head", 1, 0), ("scarf_up_1", 3, 6)),
    "slide_0": ("slide_0", ("head", 1, 0), ("scarf_up_0", 3, 6)),
    "slide_1": ("slide_0", ("head_blink", 1, 0), ("scarf_up_1", 3, 6)),
    "hurt_0": ("hurt_0", ("head_hurt", 0, 0), ("scarf_up_1", 2, 6)),
    "win_0": ("win_0", ("head", 0, 0), ("scarf_hang_0", 2, 13)),
    "win_1": ("win_0", ("head_blink", 0, 1), ("scarf_hang_1", 2, 13)),
    "climb_0": ("climb_0", ("head_back", -1, 0), ("scarf_hang_0", 4, 13)),
    "climb_1": ("climb_1", ("head_back", 0, 1), ("scarf_hang_1", 4, 13)),
    "climb_2": ("climb_2", ("head_back", 1, 0), ("scarf_hang_0", 6, 13)),
    "climb_3": ("climb_1", ("head_back", 0, 1), ("scarf_hang_0", 4, 13)),
    "push_0": ("push_0", ("head", 2, 1), ("scarf_hang_0", 3, 12)),
    "push_1": ("push_1", ("head", 2, 2), ("scarf_hang_1", 3, 13)),
    "push_2": ("push_2", ("head", 2, 1), ("scarf_hang_0", 3, 12)),
    "push_3": ("push_3", ("head", 2, 2), ("scarf_hang_1", 3, 13)),
    "look_up_0": ("idle_0", ("head_up", 0, 0), ("scarf_hang_0", 2, 12)),
    "duck_0": ("duck_0", ("head", 0, 5), ("scarf_hang_1", 1, 15)),
}
ANIMATIONS = {
    # name: (frames, frames per second)
    "idle": (("idle_0", "idle_1", "idle_0", "idle_1", "idle_2", "idle_2", "idle_3", "idle_2"), 5),
    "run": (("run_0", "run_1", "run_2", "run_3", "run_4", "run_5"), 14),
    "jump": (("jump_0", "jump_1"), 5),
    "fall": (("fall_0", "fall_1"), 10),
    "slide": (("slide_0", "slide_0", "slide_0", "slide_1"), 6),
    "hurt": (("hurt_0",), 1),
    "win": (("win_0", "win_1"), 4),
    "climb": (("climb_0", "climb_1", "climb_2", "climb_3"), 8),
    "push": (("push_0", "push_1", "push_2", "push_3"), 8),
    "look_up": (("look_up_0",), 1),
    "duck": (("duck_0",), 1),
}


def compose(frame, parts):
    """Return the picture of one frame, (24, 24, 4) uint8.

    frame: key of FRAMES; parts: {name: picture}, read from the drawing.
    """
    body, (head, dx, dy), (scarf, scarf_x, scarf_y) = FRAMES[frame]
    out = np.zeros((SIZE, SIZE, 4), np.uint8)
    lay(out, parts[scarf], scarf_x, scarf_y)
    height, width = parts[body].shape[:2]
    lay(out, parts[body], (SIZE - width) // 2, SIZE - height)  # feet on the bottom row, in the middle
    lay(out, parts[head], HEAD_X + dx, HEAD_Y + dy)
    return out


def hero_files():
    """Return {path relative to assets/: bytes} of the sprite sheet "hero"."""
    path = FOLDER / "drawings" / "hero.txt"
    parts = read_parts(path.read_text(encoding="utf-8"), LETTERS, path.name)
    sheet = Sheet("hero")
    for frame in FRAMES:
        sheet.add(frame, compose(frame, parts))
    sheet.add("hero_flash", flashed(sheet.frames["hurt_0"]))
    for name, (frames, fps) in ANIMATIONS.items():
        sheet.animate(name, frames, fps)
    return sheet.files()
