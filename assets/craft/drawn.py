"""Pictures drawn as text: one letter per pixel. A line "= name" begins a part, and ";" begins a comment."""

import numpy as np


def read_parts(text, letters, source):
    """Return {name: picture} of every part of a drawing; a picture is an array (h, w, 4) uint8.

    letters: {letter: (r, g, b)}; "." is clear. source: name of the drawing, for errors. Raises ValueError for an
    unknown letter, an uneven row, a name used twice or a part without rows. The message names the drawing, the part and
    the row.
    """
    parts, rows, name = {}, [], None
    for line in text.splitlines() + ["= "]:
        if line.startswith(";") or not line.strip():
            continue
        if line.startswith("="):
            if name is not None and not rows:
                raise ValueError(f"{source}: part {name!r} has no rows")
            if rows:
                parts[name] = _picture(rows, letters, f"{source}, part {name!r}")
            name, rows = line[1:].strip(), []
            if name in parts:
                raise ValueError(f"{source}: part {name!r} is drawn twice")
        elif name is None:
            raise ValueError(f"{source}: rows before the first '= name' line")
        else:
            rows.append(line.rstrip())
    return parts


def _picture(rows, letters, where):
    width = len(rows[0])
    out = np.zeros((len(rows), width, 4), np.uint8)
    for y, row in enumerate(rows):
        if len(row) != width:
            raise ValueError(f"{where}, row {y + 1}: {len(row)} pixels, the first row has {width}")
        for x, letter in enumerate(row):
            if letter == ".":
                continue
            if letter not in letters:
                raise ValueError(f"{where}, row {y + 1}: letter {letter!r} has no colour")
            out[y, x, :3] = letters[letter]
            out[y, x, 3] = 255
    return out


def lay(target, picture, x, y):
    """Copy the solid pixels of a picture onto another one. Both are (h, w, 4) uint8.

    x, y: position of the picture's top left corner in `target`. Pixels outside the target are left out.
    """
    left, top = max(0, x), max(0, y)
    right, bottom = min(target.shape[1], x + picture.shape[1]), min(target.shape[0], y + picture.shape[0])
    if right <= left or bottom <= top:
        return
    seen = picture[top - y : bottom - y, left - x : right - x]
    solid = seen[..., 3] > 0
    target[top:bottom, left:right][solid] = seen[solid]
