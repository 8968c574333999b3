"""Two bitmap fonts of this project, drawn as text in assets/drawings/*.txt.

A drawing consists of bands. A line "= A B C" names the glyphs, and the lines below it show these glyphs side by side,
with # for ink. The text is proportional: a glyph is as wide as it is drawn. All digits have the same width, so that
numbers in a column are aligned.

The JSON of a font is {"height", "baseline", "glyphs": {character: {"x", "y", "w"}}}. w is the distance [px] to the
next character, which includes one clear column.
"""

import numpy as np

from assets import FOLDER
from assets.craft import png
from assets.craft.atlas import to_json

FONTS = {
    "font5x7": {"height": 9, "baseline": 7, "space": 4},  # capitals 5x7, two rows for descenders
    "font3x5": {"height": 6, "baseline": 5, "space": 3},  # capitals 3x5, one row for descenders
}
SHEET_WIDTH = 128  # [px]


def read_drawing(text, height):
    """Return {character: (height, w) bool, True for ink} of a font's drawing.

    text: the drawing, in bands. A band is a line of "=" and characters, followed by lines with the glyphs of these
    characters side by side. height: height of every glyph [px]. Raises ValueError with the number of the line for an
    invalid band.
    """
    glyphs, names, rows, start = {}, [], [], 0
    for number, line in enumerate(text.splitlines() + ["="], 1):
        if line.startswith("="):
            if names:
                glyphs.update(_band(names, rows, height, start))
            names, rows, start = line[1:].split(), [], number
        elif line.strip():
            rows.append(line.split())
    return glyphs


def _band(names, rows, height, line):
    if len(rows) > height:
        raise ValueError(f"band at line {line}: {len(rows)} rows, at most {height}")
    glyphs = {}
    for i, name in enumerate(names):
        column = [row[i] for row in rows if len(row) == len(names)]
        if len(column) != len(rows) or len({len(cells) for cells in column}) != 1:
            raise ValueError(f"band at line {line}: glyph {name!r} is not a rectangle")
        ink = np.zeros((height, len(column[0])), bool)
        for y, cells in enumerate(column):
            ink[y] = [cell == "#" for cell in cells]
        glyphs[name] = ink
    return glyphs


def load_glyphs(name):
    """Return {character: (height, w) bool, True for ink} of one font, including the space. name: a key of FONTS."""
    shape = FONTS[name]
    text = (FOLDER / "drawings" / f"{name}.txt").read_text(encoding="utf-8")
    glyphs = read_drawing(text, shape["height"])
    glyphs[" "] = np.zeros((shape["height"], shape["space"] - 1), bool)
    return dict(sorted(glyphs.items()))


def write(target, text, x, y, colour):
    """Draw one line of text in the larger font into `target`, (h, w, 3) uint8.

    x, y: top left corner of the text [px]; colour: (r, g, b).
    """
    glyphs = load_glyphs("font5x7")
    for character in text:
        ink = glyphs[character]
        target[y : y + ink.shape[0], x : x + ink.shape[1]][ink] = colour
        x += ink.shape[1] + 1


def font_files(name):
    """Return {path relative to assets/: bytes} of one font's sheet (white on clear) and its JSON. name: a key of
    FONTS.
    """
    glyphs, height = load_glyphs(name), FONTS[name]["height"]
    places, x, y = {}, 0, 0
    for character, ink in glyphs.items():
        advance = ink.shape[1] + 1
        if x + advance > SHEET_WIDTH:
            x, y = 0, y + height + 1
        places[character] = {"x": x, "y": y, "w": advance}
        x += advance
    sheet = np.zeros((y + height, SHEET_WIDTH, 4), np.uint8)
    for character, place in places.items():
        ink = glyphs[character]
        cell = sheet[place["y"] : place["y"] + height, place["x"] : place["x"] + ink.shape[1]]
        cell[ink] = 255
    table = {"height": height, "baseline": FONTS[name]["baseline"], "glyphs": places}
    return {f"font/{name}.png": png.encode(sheet), f"font/{name}.json": to_json(table)}
