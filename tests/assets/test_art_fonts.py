"""Both fonts cover ASCII and the arrows, and their sheets have the glyphs at the positions in the JSON file."""

import json

import pytest

from assets import FOLDER
from assets.craft import png
from assets.ui.font import FONTS, load_glyphs, read_drawing

CHARACTERS = [chr(code) for code in range(32, 127)] + list("←→↑↓")


@pytest.mark.parametrize("name", FONTS)
def test_font_covers_its_characters(name):
    table = json.loads((FOLDER / "font" / f"{name}.json").read_text(encoding="utf-8"))
    sheet = png.decode((FOLDER / "font" / f"{name}.png").read_bytes())
    assert sorted(table["glyphs"]) == sorted(CHARACTERS)
    for character, place in table["glyphs"].items():
        cell = sheet[place["y"] : place["y"] + table["height"], place["x"] : place["x"] + place["w"]]
        assert cell.shape[:2] == (table["height"], place["w"])
        assert cell[..., 3].any() == (character != " ")
        assert not cell[:, -1, 3].any(), f"{character!r} has no clear column behind it"


@pytest.mark.parametrize("name", FONTS)
def test_glyphs_are_told_apart(name):
    seen = {}
    for character, ink in load_glyphs(name).items():
        key = (ink.shape, ink.tobytes())
        assert key not in seen, f"{character!r} looks like {seen.get(key)!r}"
        seen[key] = character


@pytest.mark.parametrize("name", FONTS)
def test_digits_share_one_width(name):
    glyphs = load_glyphs(name)
    assert len({glyphs[digit].shape[1] for digit in "0123456789"}) == 1


def test_bad_drawing_names_its_line():
    with pytest.raises(ValueError, match="line 1: glyph 'B'"):
        read_drawing("= A B\n### ##\n#.# ###\n", 7)
    with pytest.raises(ValueError, match="3 rows, at most 2"):
        read_drawing("= A\n#\n#\n#\n", 2)


@pytest.mark.parametrize("name", FONTS)
def test_a_small_f_is_no_capital(name):
    """A small f differs from a capital F, whose stem is its left edge: the f is a hook with a bar on both sides."""
    small, capital = load_glyphs(name)["f"], load_glyphs(name)["F"]
    assert capital[: FONTS[name]["baseline"], 0].all()
    assert small[:, 0].sum() <= 1, "only the bar reaches the left edge"
    bar = small.sum(axis=1).argmax()
    assert small[0].any() and not small[0, 0] and 0 < bar < FONTS[name]["baseline"] - 1
