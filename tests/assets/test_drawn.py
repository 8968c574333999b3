"""Drawings given as text: the pixels that are read, and the error message for each kind of mistake."""

import pytest

from assets.craft.drawn import read_parts

LETTERS = {"a": (10, 20, 30), "b": (200, 100, 0)}


def test_parts_are_pictures_with_clear_dots():
    parts = read_parts("; a comment\n= left\nab\n.a\n\n= right\nb\n", LETTERS, "x")
    assert list(parts) == ["left", "right"] and parts["left"].shape == (2, 2, 4)
    assert parts["left"][0].tolist() == [[10, 20, 30, 255], [200, 100, 0, 255]]
    assert parts["left"][1, 0].tolist() == [0, 0, 0, 0]


@pytest.mark.parametrize(
    "text, said",
    [
        ("ab\n", "rows before the first"),
        ("= one\nab\n= one\nab\n", "'one' is drawn twice"),
        ("= one\n= two\nab\n", "'one' has no rows"),
        ("= one\nab\n= last\n", "'last' has no rows"),
        ("= one\nab\na\n", "row 2: 1 pixels"),
        ("= one\naz\n", "'z'"),
    ],
)
def test_a_mistake_is_named_by_source_and_part(text, said):
    with pytest.raises(ValueError, match="hand.txt") as error:
        read_parts(text, LETTERS, "hand.txt")
    assert said in str(error.value)
