"""Hints for names that the package does not have, and for the beginnings of words that it has."""

import dataclasses
import re

import numpy as np
import pytest

import physics
from physics import Effects, PixelMask, World


@pytest.mark.parametrize("name", physics.hints.CLASSES)
def test_a_class_of_another_engine_names_what_to_write(name):
    with pytest.raises(AttributeError, match=re.escape(f"has no attribute '{name}': write ")):
        getattr(physics, name)
    words = re.findall(r"^[A-Z]\w+", physics.hints.CLASSES[name])
    assert all(word in physics.__all__ for word in words) and name not in physics.__all__


@pytest.mark.parametrize("given", ["soft", "sequential", "proj", "block"])
def test_the_beginning_of_a_word_is_enough_for_a_hint(given):
    with pytest.raises(ValueError, match=f'did you mean "{given}'):
        World(solver=given)


@pytest.mark.parametrize(("word", "tier"), physics.hints.SHAPE_WORDS.items())
def test_the_words_for_shapes_on_the_screen_lead_to_a_tier(word, tier):
    with pytest.raises(ValueError, match=f'did you mean "{tier}"'):
        World().add_body(PixelMask(np.ones((3, 3), bool)), tier=word)


@pytest.mark.parametrize("name", [field.name for field in dataclasses.fields(Effects)])
def test_the_effects_of_a_hint_can_be_written(name):
    with pytest.raises(TypeError) as raised:
        World(name)
    written = str(raised.value).partition("write ")[2]
    assert getattr(eval(written, {"Effects": Effects}), name)
