"""Each game declares exactly the effects that change it: removing a declared one matters, adding another does not.

The same recorded keys are played with one effect removed or added. An effect is removed with all effects that need it,
and added with those that it needs. A game that cannot be built without an effect needs it if the error names the
effect. The labs, and the cost of effects: see test_ledger.py.
"""

import re
from dataclasses import fields

import pytest

import physics
from game.registry import Registry
from game.run.digest import scene_digest
from game.run.session import Session
from game.run.sources import BotSource, ScriptSource
from physics import Effects
from physics.effects import NEEDS
from scenes import SCENES

pytestmark = pytest.mark.slow  # whichever test comes first plays a game for the others of this file
FRAMES = {"shooter": 2640, "platformer": 2400, "lander": 4200}
EFFECTS = [field.name for field in fields(Effects)]

# What becomes of an effect that is taken out of a game that declares it, or put into one that does not.
REFUSED = "the scene cannot be built, or played on, without it: the error names it"
DIFFERS = "something else happens"
NEUTRAL = "not used by anything: the same happens"
LEDGER = {
    "shooter": {
        "narrowphase": DIFFERS,
        "sensors": REFUSED,
        "carving": REFUSED,
        "rotation": REFUSED,
        "drag": DIFFERS,
        "wind": DIFFERS,
        # Put in: pushed bodies fly elsewhere and rub, nothing falls or rests. A shot is longer than its path in a step
        # and tunnels through no body, see test_shooter.py. Swept it would hit a step sooner and by its outline: it
        # would strike bodies that all drawn pixels miss.
        "response": DIFFERS,
        "gravity": NEUTRAL,
        "friction": DIFFERS,
        "restitution": NEUTRAL,
        "stacking": DIFFERS,
        "continuous": DIFFERS,
        "sleeping": DIFFERS,  # wreckage that hardly drifts is timed, and some would stay in the air
        "persist": NEUTRAL,
        "one_way": NEUTRAL,
        "conveyor": NEUTRAL,
        "joints": NEUTRAL,
    },
    "platformer": {
        "narrowphase": DIFFERS,
        "response": REFUSED,
        "gravity": DIFFERS,
        "rotation": REFUSED,
        "friction": DIFFERS,
        "stacking": REFUSED,
        "continuous": REFUSED,
        "sleeping": DIFFERS,
        "sensors": REFUSED,
        "one_way": DIFFERS,
        "conveyor": DIFFERS,
        "carving": REFUSED,
        # Put in: no material bounces, the world has neither drag nor wind, and the scene does not read persisting
        # contacts.
        "drag": NEUTRAL,
        "wind": NEUTRAL,
        "restitution": NEUTRAL,
        "persist": NEUTRAL,
        "joints": NEUTRAL,
    },
    "lander": {
        "narrowphase": DIFFERS,
        "response": DIFFERS,
        "gravity": DIFFERS,
        "drag": DIFFERS,
        "wind": DIFFERS,
        "rotation": REFUSED,
        "friction": DIFFERS,
        "restitution": DIFFERS,
        "stacking": DIFFERS,
        "continuous": DIFFERS,
        "sleeping": DIFFERS,
        "sensors": REFUSED,
        "joints": DIFFERS,  # without them the line catches nothing
        "carving": REFUSED,
        # Put in: the scene does not read persisting contacts, nothing is one-way or moves its surface.
        "persist": NEUTRAL,
        "one_way": NEUTRAL,
        "conveyor": NEUTRAL,
    },
}


class Noting:
    """Source of the bot's input that also stores the input of each step."""

    def __init__(self):
        self.bot, self.frames = BotSource(), []

    def next(self, scene):
        self.frames.append(self.bot.next(scene))
        return self.frames[-1]


def digests(scene_class, source):
    """Yield the digest after each frame of a scene played by a source of input."""
    scene = scene_class(seed=1)
    session = Session(scene, source)
    for _ in range(FRAMES[scene_class.name]):
        session.step()
        yield scene_digest(scene)


@pytest.fixture(scope="module")
def played():
    """Return played(name), which plays a game once with its bot and returns (scene class, inputs, digests)."""
    kept = {}

    def play(name):
        if name not in kept:
            source = Noting()
            scene_class = Registry(SCENES).scene_class(name)
            kept[name] = scene_class, source.frames, [*digests(scene_class, source)]
        return kept[name]

    return play


def with_effects(scene_class, names, wanted):
    """Return a scene class with these effects declared, or not declared if `wanted` is False."""
    effects = scene_class.effects.with_(**dict.fromkeys(names, wanted))
    return type(scene_class.__name__, (scene_class,), {"effects": effects})


def first_difference(one, other):
    """Return the first frame after which two lists of digests differ; None if they are equal."""
    return next((frame for frame, (a, b) in enumerate(zip(one, other, strict=True), 1) if a != b), None)


def test_the_ledger_names_every_effect():
    assert all(sorted(ledger) == sorted(EFFECTS) for ledger in LEDGER.values()) and set(LEDGER) == set(FRAMES)


def cases():
    """Return (game, effect) of all games and effects. Neutral effects are nightly tests."""
    return [
        pytest.param(name, effect, marks=pytest.mark.nightly if LEDGER[name][effect] == NEUTRAL else ())
        for name in FRAMES
        for effect in EFFECTS
    ]


@pytest.mark.skipif(not physics.JIT, reason="minutes of uncompiled physics")
@pytest.mark.parametrize("name", FRAMES)
def test_all_that_is_neutral_changes_nothing_together(played, name):
    """All neutral effects together change nothing in a game, either.

    Effects that need undeclared effects are left out, because these would change the game.
    """
    scene_class, keys, standard = played(name)
    neutral = [
        effect
        for effect, verdict in LEDGER[name].items()
        if verdict == NEUTRAL and all(getattr(scene_class.effects, each) for each in NEEDS.get(effect, ()))
    ]
    assert len(neutral) > 1
    found = digests(with_effects(scene_class, neutral, True), ScriptSource(keys))
    assert first_difference(found, standard) is None, f"one of {', '.join(neutral)} changes what happens in {name}"


@pytest.mark.skipif(not physics.JIT, reason="minutes of uncompiled physics")
@pytest.mark.parametrize("name, effect", cases())
def test_what_is_declared_matters_and_nothing_else_does(played, name, effect):
    scene_class, keys, standard = played(name)
    verdict = LEDGER[name][effect]
    if getattr(scene_class.effects, effect):
        assert verdict != NEUTRAL, f"{name} declares {effect} and does not call for it"
        changed = with_effects(
            scene_class, [effect, *(each for each in EFFECTS if effect in NEEDS.get(each, ()))], False
        )
    else:
        assert verdict != REFUSED, f"{name} does without {effect}"
        needed = [each for each in NEEDS.get(effect, ()) if not getattr(scene_class.effects, each)]
        if needed:
            with pytest.raises(ValueError, match=rf"effect {effect} needs \w+"):
                with_effects(scene_class, [effect], True)
            scene_class = with_effects(scene_class, needed, True)
            standard = digests(scene_class, ScriptSource(keys))
        changed = with_effects(scene_class, [effect], True)
    found = digests(changed, ScriptSource(keys))
    if verdict == REFUSED:
        with pytest.raises(ValueError, match=rf"\b{re.escape(effect)}\b"):
            list(found)
    elif verdict == NEUTRAL:
        assert first_difference(found, standard) is None, f"{effect} changes what happens in {name}"
    else:
        assert first_difference(found, standard) is not None, f"{effect} changes nothing in {name}"
