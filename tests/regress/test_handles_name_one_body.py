"""A Body object always refers to the same body: its id and world cannot be written."""

import copy

import pytest

from physics import Circle, World


@pytest.mark.parametrize("name, value", [("id", 5), ("world", World())])
def test_neither_id_nor_world_can_be_written(name, value):
    world = World()
    body = world.add_body(Circle(4))
    kept = {body: "here"}
    with pytest.raises(AttributeError, match=name):
        setattr(body, name, value)
    assert kept[world.body(body.id)] == "here"
    assert copy.copy(body) == body
