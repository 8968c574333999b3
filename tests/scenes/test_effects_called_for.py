"""The ledger of the games: an effect that a scene declares changes what happens, one that it does not call for nothing.

The same recorded keys are played with one effect taken out, or put in. What cannot even be built without it is called
for.
"""

from dataclasses import fields

import pytest

import physics
from game.registry import Registry
from game.run.digest import scene_digest
from game.run.session import Session
from game.run.sources import BotSource, ScriptSource
from physics import Effects
from scenes import SCENES

FRAMES = {"shooter": 900, "platformer": 2400}
EFFECTS = [field.name for field in fields(Effects)]
# Not one that could be added unused: what falls, turns or is pushed at once is used as soon as it is there.
ADDED = ("drag", "wind", "restitution", "persist", "conveyor", "one_way", "friction")


class Noting:
    """The bot, and what it pressed."""

    def __init__(self):
        self.bot, self.frames = BotSource(), []

    def next(self, scene):
        self.frames.append(self.bot.next(scene))
        return self.frames[-1]


def play(scene_class, source, frames):
    scene = scene_class(seed=1)
    session = Session(scene, source)
    for _ in range(frames):
        session.step()
    return scene_digest(scene)


@pytest.fixture(scope="module", params=FRAMES)
def played(request):
    """(scene class, keys, digest) of a game by its bot."""
    scene_class = Registry(SCENES).scene_class(request.param)
    source = Noting()
    digest = play(scene_class, source, FRAMES[request.param])
    return scene_class, source.frames, digest


def with_effects(scene_class, **changes):
    return type(scene_class.__name__, (scene_class,), {"effects": scene_class.effects.with_(**changes)})


@pytest.mark.deep
@pytest.mark.skipif(not physics.JIT, reason="minutes of uncompiled physics")
@pytest.mark.parametrize("effect", EFFECTS)
def test_what_is_declared_matters_and_nothing_else_does(played, effect):
    scene_class, keys, digest = played
    if getattr(scene_class.effects, effect):
        try:
            found = play(with_effects(scene_class, **{effect: False}), ScriptSource(keys), len(keys))
        except ValueError as error:
            assert effect in str(error) or "needs" in str(error)
            return
        assert found != digest, f"{scene_class.name} declares {effect}, and does not call for it"
    elif effect in ADDED and (
        scene_class.effects.response or effect not in ("restitution", "conveyor", "one_way", "friction")
    ):
        found = play(with_effects(scene_class, **{effect: True}), ScriptSource(keys), len(keys))
        assert found == digest, f"{scene_class.name} does not declare {effect}; added, it changes what happens"
