"""Write docs/sprites.png, a picture of all sprites and backdrops, and docs/moments.png, moments of the games.

python -m assets.publish.contact_sheet            both pictures; the bots play some minutes of game time
python -m assets.publish.contact_sheet sprites    only docs/sprites.png
"""

import json
import sys

import numpy as np

from assets import FOLDER
from assets.craft import png
from assets.craft.palette import OUTLINE, RAMPS, oklch
from assets.craft.shading import opaque
from assets.publish import moments
from assets.ui.font import write

SCALE = 3
WIDTH = 496  # [px] before scaling: the widest frame and its gaps
GAP, HEADING = 4, 16  # [px] around a frame, above a sheet for its name
SHEETS = ("ui", "planes", "effects", "hero", "things", "tiles", "lander", "lab")
BACKDROPS = (
    "sea",
    "coast",
    "storm",
    "clouds_low",
    "clouds_high",
    "clouds_storm",
    "sky_dusk",
    "clouds",
    "mountains_far",
    "mountains_mid",
    "keep_far",
    "mountains_near",
    "cave_far",
    "cave_near",
    "lander_sky",
    "lander_clouds",
    "lander_far",
    "lander_mid",
    "lander_near",
)
SHRUNK = 3  # a backdrop is shown at a third of its size, and at its own size after scaling
BACKGROUND = oklch(0.36, 0.045, 285)
PAPER = oklch(0.27, 0.045, 285)


def load_frames(name):
    """Return {name of a frame: picture (h, w, 4) uint8} of the sprite sheet `name` in assets/images."""
    picture = png.decode((FOLDER / "images" / f"{name}.png").read_bytes())
    table = json.loads((FOLDER / "images" / f"{name}.json").read_text(encoding="utf-8"))
    return {
        frame: picture[place["y"] : place["y"] + place["h"], place["x"] : place["x"] + place["w"]]
        for frame, place in table["frames"].items()
    }


def section(name, frames):
    """Return a picture of one sprite sheet's frames in rows under the sheet's name, (h, WIDTH, 3) uint8.

    frames: {name: (h, w, 4) uint8}.
    """
    rows, row, used = [], [], GAP
    for frame in frames.values():
        if used + frame.shape[1] + GAP > WIDTH and row:
            rows.append(row)
            row, used = [], GAP
        row.append(frame)
        used += frame.shape[1] + GAP
    rows.append(row)
    heights = [max(frame.shape[0] for frame in row) for row in rows]
    out = np.full((HEADING + sum(heights) + GAP * (len(rows) + 1), WIDTH, 3), BACKGROUND)
    out[:13] = PAPER
    write(out, f"{name}  {len(frames)} frames", GAP, 2, RAMPS["gold"][4])
    y = HEADING
    for row, height in zip(rows, heights, strict=True):
        x = GAP
        for frame in row:
            top = y + height - frame.shape[0]  # on one base line
            solid = frame[..., 3] > 0
            out[top : top + frame.shape[0], x : x + frame.shape[1]][solid] = frame[solid][:, :3]
            x += frame.shape[1] + GAP
        y += height + GAP
    out[-1] = OUTLINE
    return out


def shrunk(name):
    """Return a backdrop at a third of its size, (h, w, 4) uint8: every third pixel along x and along y."""
    picture = png.decode((FOLDER / "images" / f"{name}.png").read_bytes())[::SHRUNK, ::SHRUNK]
    return picture if picture.shape[2] == 4 else opaque(picture)


def sprites():
    """Return the picture of all sprites and backdrops, (h, w, 3) uint8."""
    sections = [section(name, load_frames(name)) for name in SHEETS]
    sections.append(section("backdrops", {name: shrunk(name) for name in BACKDROPS}))
    return np.concatenate(sections).repeat(SCALE, 0).repeat(SCALE, 1)


PICTURES = {"sprites": sprites, "moments": moments.sheet}


def main(arguments=None):
    """Write the pictures named in `arguments`, or all pictures. Return the exit code: 0 success, 2 an unknown name."""
    names = (sys.argv[1:] if arguments is None else arguments) or list(PICTURES)
    for name in names:
        if name not in PICTURES:
            sys.stderr.write(f"no picture {name!r}; choose from {', '.join(PICTURES)}\n")
            return 2
    for name in names:
        target = FOLDER.parent / "docs" / f"{name}.png"
        target.parent.mkdir(exist_ok=True)
        target.write_bytes(png.encode(np.ascontiguousarray(PICTURES[name]())))
        sys.stdout.write(f"{target.relative_to(FOLDER.parent)}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
