"""The events of a scene do not depend on whether its contacts stay in their places or are copied each step."""

import pytest

from game.run.session import Session
from game.run.sources import BotSource
from physics import JIT
from physics.collision import narrow_phase
from tests.lockstep import make_scene

STEPS = 240
SCENES = ("platformer", "lab/effects", "lab/dominoes", "lab/one_way", "lab/tumbler", "lab/sleeping", "lab/card_house")


def played(name):
    session = Session(make_scene(name), BotSource())
    for _ in range(STEPS):
        session.step()
    return session.scene.world.digest()


@pytest.mark.skipif(not JIT, reason="thousands of steps of whole scenes")
@pytest.mark.parametrize("name", SCENES)
def test_a_scene_does_the_same_where_all_contacts_are_copied(monkeypatch, name):
    took = []

    def counting(*arguments):
        took.append(take_places(*arguments))
        return took[-1]

    take_places = narrow_phase.take_places
    monkeypatch.setattr(narrow_phase, "take_places", counting)
    in_place = played(name)
    assert any(took), "nothing was put in its place: the scene says nothing of it"
    monkeypatch.setattr(narrow_phase, "take_places", lambda *arguments: False)
    assert played(name) == in_place
