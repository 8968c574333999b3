"""Sprite sheets: many frames in one picture, and a JSON file with the position of each frame.

The JSON: {"frames": {name: {"x", "y", "w", "h"}}, "animations": {name: {"frames": [names], "fps": n}}}, in pixels.
"""

import json

import numpy as np

from assets.craft import png

GAP = 1  # [px] clear pixels between frames, so that scaling or rotating one never picks up its neighbour
WIDTH = 256  # [px] sheets are this wide unless a frame is wider


class Sheet:
    """A sprite sheet: frames in the order in which they were added, and named animations made of them."""

    def __init__(self, name, gap=GAP):
        self.name = name
        self.gap = gap  # [px] 0 for a tile set, whose tiles are addressed by number
        self.frames = {}  # name -> (h, w, 4) uint8
        self.animations = {}  # name -> {"frames": [...], "fps": n}

    def add(self, name, pixels):
        """Add one frame. pixels: (h, w, 4) uint8. Raises ValueError if the name is already used."""
        if name in self.frames:
            raise ValueError(f"sheet {self.name!r} already has a frame {name!r}")
        self.frames[name] = pixels

    def animate(self, name, frames, fps):
        """Add an animation. frames: names of frames that were added before; fps: frames per second.

        Raises ValueError for an unknown frame.
        """
        missing = [frame for frame in frames if frame not in self.frames]
        if missing:
            raise ValueError(f"animation {name!r} of sheet {self.name!r} uses unknown frames {missing}")
        self.animations[name] = {"frames": list(frames), "fps": fps}

    def add_sequence(self, name, pictures, fps):
        """Add pictures as frames name_0, name_1, ..., and the animation `name` that shows them.

        pictures: (h, w, 4) uint8 each; fps: frames per second.
        """
        names = [f"{name}_{i}" for i in range(len(pictures))]
        for frame, picture in zip(names, pictures, strict=True):
            self.add(frame, picture)
        self.animate(name, names, fps)

    def files(self):
        """Return {path relative to assets/: bytes} of the sheet's picture and of its JSON file."""
        places, size = _shelves(self.frames, self.gap)
        picture = np.zeros((size[1], size[0], 4), np.uint8)
        for name, (x, y) in places.items():
            frame = self.frames[name]
            picture[y : y + frame.shape[0], x : x + frame.shape[1]] = frame
        table = {
            "frames": {
                name: {"x": x, "y": y, "w": self.frames[name].shape[1], "h": self.frames[name].shape[0]}
                for name, (x, y) in places.items()
            },
            "animations": self.animations,
        }
        return {f"images/{self.name}.png": png.encode(picture), f"images/{self.name}.json": to_json(table)}


def _shelves(frames, gap):
    """Pack the frames of a sprite sheet in rows (shelves) from left to right, tallest first.

    Return ({name: (x, y)}, (width, height)) [px]: the position of each frame, and the size of the sheet. frames:
    {name: pixels}; gap: clear pixels between frames.
    """
    width = max([WIDTH] + [frame.shape[1] + 2 * gap for frame in frames.values()])
    order = sorted(frames, key=lambda name: -frames[name].shape[0])  # stable: equal heights keep their order
    places, x, y, shelf = {}, gap, gap, 0
    for name in order:
        height, frame_width = frames[name].shape[:2]
        if x + frame_width + gap > width:
            x, y, shelf = gap, y + shelf + gap, 0
        places[name] = (x, y)
        x += frame_width + gap
        shelf = max(shelf, height)
    return {name: places[name] for name in frames}, (width, y + shelf + gap)


def to_json(table):
    """Return a dict as JSON bytes, with one entry per line at depth two, so that the file is small and its diffs
    readable.
    """
    lines = []
    for key, value in table.items():
        if isinstance(value, dict) and value:
            inner = ",\n".join(f"  {json.dumps(k, ensure_ascii=False)}: {_flat(v)}" for k, v in value.items())
            lines.append(f" {json.dumps(key)}: {{\n{inner}\n }}")
        else:
            lines.append(f" {json.dumps(key)}: {_flat(value)}")
    return ("{\n" + ",\n".join(lines) + "\n}\n").encode()


def _flat(value):
    return json.dumps(value, ensure_ascii=False)
