"""Writes docs/sprites.png: every sprite sheet of the game on one picture, three times as large.

    python -m assets.contact_sheet
"""

import json
import sys

import numpy as np

from assets import FOLDER, png
from assets.palette import OUTLINE, RAMPS, oklch

SCALE = 3
WIDTH = 496   # [px] before scaling: the widest frame and its gaps
GAP = 4   # [px] around a frame
SHEETS = ("ui", "planes", "effects", "hero", "things", "tiles", "lab")
BACKGROUND = np.array(oklch(0.36, 0.045, 285), np.uint8)
PAPER = np.array(oklch(0.27, 0.045, 285), np.uint8)


def load_frames(name):
    """Return {frame: (h, w, 4) uint8} of one sheet in assets/images."""
    picture = png.decode((FOLDER / "images" / f"{name}.png").read_bytes())
    table = json.loads((FOLDER / "images" / f"{name}.json").read_text(encoding="utf-8"))
    return {
        frame: picture[place["y"] : place["y"] + place["h"], place["x"] : place["x"] + place["w"]]
        for frame, place in table["frames"].items()
    }


def write_text(target, text, x, y, colour, font="font5x7"):
    """Write one line of text on target (h, w, 3) at (x, y)."""
    sheet = png.decode((FOLDER / "font" / f"{font}.png").read_bytes())
    table = json.loads((FOLDER / "font" / f"{font}.json").read_text(encoding="utf-8"))
    for character in text:
        glyph = table["glyphs"][character]
        cell = sheet[glyph["y"] : glyph["y"] + table["height"], glyph["x"] : glyph["x"] + glyph["w"], 3] > 0
        target[y : y + cell.shape[0], x : x + cell.shape[1]][cell] = colour
        x += glyph["w"]


def section(name, frames):
    """One sheet's frames in rows under its name, (h, WIDTH, 3) uint8."""
    rows, row, used = [], [], GAP
    for frame in frames.values():
        if used + frame.shape[1] + GAP > WIDTH and row:
            rows.append(row)
            row, used = [], GAP
        row.append(frame)
        used += frame.shape[1] + GAP
    rows.append(row)
    heights = [max(frame.shape[0] for frame in row) for row in rows]
    out = np.empty((16 + sum(heights) + GAP * (len(rows) + 1), WIDTH, 3), np.uint8)
    out[:] = BACKGROUND
    out[:13] = PAPER
    write_text(out, f"{name}  {len(frames)} frames", GAP, 2, RAMPS["gold"][4])
    y = 16
    for row, height in zip(rows, heights, strict=True):
        x = GAP
        for frame in row:
            top = y + height - frame.shape[0]   # on one base line
            solid = frame[..., 3] > 0
            out[top : top + frame.shape[0], x : x + frame.shape[1]][solid] = frame[solid][:, :3]
            x += frame.shape[1] + GAP
        y += height + GAP
    out[-1] = OUTLINE
    return out


def contact_sheet():
    """Return the whole picture, (h, w, 3) uint8."""
    sections = [section(name, load_frames(name)) for name in SHEETS]
    return np.concatenate(sections).repeat(SCALE, 0).repeat(SCALE, 1)


def main():
    """Write the picture. Returns the exit code."""
    target = FOLDER.parent / "docs" / "sprites.png"
    target.parent.mkdir(exist_ok=True)
    target.write_bytes(png.encode(np.ascontiguousarray(contact_sheet())))
    sys.stdout.write(f"{target.relative_to(FOLDER.parent)}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
