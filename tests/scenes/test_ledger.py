"""Effects of all scenes: each declared effect matters, and no other effect changes a digest when it is added.

Effects are added with neutral values. A failing test is a finding: remove the effect from the scene's declaration, or
add a reason for it.
"""

import math
import re
from types import SimpleNamespace

import pytest

import physics
from game.input.inputs import InputFrame
from game.measure.ledger import EFFECTS, NEUTRAL, NEVER_NEUTRAL, distances, entry, variant
from game.registry import Registry
from game.scene import Goal, Scene
from physics import Circle, Effects, Material, Polygon, World
from scenes import SCENES
from scenes.lab.gallery.scene import PAGES

GAMES = ("shooter", "platformer", "lander")
LABS = [name for name in SCENES if name not in GAMES]
FRAMES = 600
LONGEST = {"lab/broadphases": 60}  # steps within which an effect must have shown, where 600 take too long
IDLE_FRAMES = 240  # of a run in which an idle effect must change nothing
IDLE_LONGEST = {"lab/broadphases": 20}
# One that stacks, one that sweeps, one of masks; the others, each effect of which is compiled anew, at night.
IDLE_IN_CI = ("lab/stacks", "lab/tunnelling", "lab/mask_sweep")
needs_speed = pytest.mark.skipif(not physics.JIT, reason="minutes")
# Show when a gunship has been shot down.
SLOW = [("lab/disagreement", name) for name in ("drag", "wind", "rotation", "carving")]
ON_ITS_PAGE = ("lab/gallery", "sleeping")  # the bot comes to it after minutes: see below


def scene_class(name):
    return Registry(SCENES).scene_class(name)


def pairs(declared, names):
    """Return the pairs (scene, effect) in which the scene declares the effect, or does not if `declared` is False.

    names: names of the scenes.
    """
    return [
        pytest.param(name, effect, marks=needs_speed if (name, effect) in SLOW else ())
        for name in names
        for effect in EFFECTS
        if getattr(scene_class(name).effects, effect) == declared and (name, effect) != ON_ITS_PAGE
    ]


@pytest.mark.parametrize("name, effect", pairs(True, LABS))
def test_a_lab_declares_only_what_would_be_missed(name, effect):
    """If one of a lab's declared effects is removed, its bodies or events change, or it cannot be built or played."""
    found = entry(scene_class(name), effect, LONGEST.get(name, FRAMES), after=0)
    assert found.matters, f"{name} declares {effect} and does not call for it: {found}"
    if found.refused:
        assert any(re.search(rf"\b{re.escape(each)}\b", found.refused) for each in found.changed), found.refused


@needs_speed
def test_the_gallery_calls_for_sleep_on_its_last_page():
    class LastPage(scene_class("lab/gallery")):
        def bot(self):
            return InputFrame(changes=(("slider:page", len(PAGES) - 1),) if self.frame == 0 else ())

    found = entry(LastPage, "sleeping", 150, after=0)
    assert found.matters and PAGES[-1].name == "asleep", found


@needs_speed
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in IDLE_IN_CI else pytest.mark.nightly) for name in LABS]
)
def test_what_a_lab_does_not_declare_changes_nothing_when_it_is_idle(name):
    of_others = []
    for effect in EFFECTS:
        if getattr(scene_class(name).effects, effect):
            continue
        found = entry(scene_class(name), effect, IDLE_LONGEST.get(name, IDLE_FRAMES))
        assert not found.refused and math.isfinite(found.cost)
        if effect in NEVER_NEUTRAL:
            assert (found.parted is None) <= (found.apart == 0.0)
        elif found.parted is not None:
            of_others.append((effect, found.parted))
    assert not of_others, f"{name}: put in with nothing to do, these change what happens: {of_others}"


@needs_speed
@pytest.mark.parametrize("name", ["platformer", "lander"])
def test_a_game_that_lets_things_sleep_has_less_to_do(name):
    found = entry(scene_class(name), "sleeping", 1200, after=1200)
    assert found.matters and found.worked < 0.9 * found.worked_without, found


# --- the ledger itself -------------------------------------------------------------------------------------------


class Drop(Scene):
    """Scene with a bouncing ball that moves sideways, beside a heap at rest."""

    name = "drop"
    effects = Effects(response=True, gravity=True, restitution=True, stacking=True, sleeping=True, wind=True)

    def build(self):
        world = self.add_world()
        world.add_body(Polygon.box(600, 20), position=(0, 60), kind="static")
        self.ball = world.add_body(Circle(5), velocity=(30, 0), material=Material(friction=0.8, restitution=0.7))
        for x in (100, 120, 140):
            world.add_body(Polygon.box(16, 16), position=(x, 42))

    def update(self, inputs):
        for world in self.worlds:
            world.step()

    def draw(self, canvas, alpha):
        """Draw nothing."""

    def check(self):
        return [Goal("falls", 10, self.ball.position[1] > 0.0)]

    def bot(self):
        return frozenset()

    def state(self):
        return (self.frame,)


class Spins(Drop):
    """The scene Drop with a rotating second ball, so that it cannot be built without rotation."""

    effects = Drop.effects.with_(rotation=True)

    def build(self):
        super().build()
        self.world.add_body(Circle(5), position=(-90, 0), angular_velocity=3.0)


def test_an_effect_that_would_not_be_missed_is_found():
    found = entry(Drop, "wind", 90)
    assert not found.matters and found.moved is found.reported is found.parted is None and found.apart == 0.0
    assert found.declared and found.changed == ("wind",)


def test_what_is_missed_is_reported_in_pixels_and_frames():
    gravity = entry(Drop, "gravity", 90, after=90)
    assert gravity.matters and gravity.moved == 1
    # Half a second: of four bodies that move one falls 9.8 m/s2 / 2 * t2 until it meets the floor.
    assert gravity.reported is not None and 20 < gravity.reported < 40 and gravity.apart > 10.0
    bounce = entry(Drop, "restitution", 90)
    assert bounce.matters and bounce.moved is not None and bounce.moved > 20


def test_an_effect_goes_with_what_needs_it():
    found = entry(Drop, "stacking", 60)
    assert found.changed == ("stacking", "sleeping")


def test_sleep_is_missed_for_the_work_that_it_saves():
    found = entry(Drop, "sleeping", 120, after=120)
    assert found.matters and found.worked < found.worked_without and found.apart == 0.0
    assert not entry(Drop, "sleeping", 20).matters, "nothing has come to rest yet"


def test_what_cannot_be_built_without_an_effect_calls_for_it():
    found = entry(Spins, "rotation", 60)
    assert found.matters and "needs the effect rotation" in found.refused


@pytest.mark.parametrize("effect", ["friction", "drag", "conveyor", "continuous", "sensors", "persist", "one_way"])
def test_an_idle_effect_changes_nothing(effect):
    found = entry(Drop, effect, 60)
    assert not found.declared and found.parted is None and found.apart == 0.0 and not found.refused


def test_an_effect_that_is_not_idle_does():
    """An added effect changes the scene if the bodies have values that it uses.

    The ball's material has friction. With friction, the effect of rotation changes the scene, too.
    """
    rubs = variant(Drop, Drop.effects.with_(friction=True))
    assert entry(rubs, "friction", 90).matters and set(NEUTRAL) <= set(EFFECTS)
    turning = entry(variant(Drop, Drop.effects.with_(friction=True)), "rotation", 90)
    assert turning.parted is not None and not turning.declared


def test_what_it_needs_comes_in_both():
    class Bare(Drop):
        effects = Effects(gravity=True)

        def build(self):
            super().build()

    found = entry(Bare, "friction", 60)
    assert found.parted is None and found.changed == ("friction",)


@pytest.mark.parametrize(
    "moved, middle, p99, worst", [((0.0,) * 4, 0.0, 0.0, 0.0), ((0.0, 0.0, 3.0, 4.0), 2.5, 3.97, 4.0)]
)
def test_distances_are_given_by_the_mean_and_by_the_worst_body(moved, middle, p99, worst):
    """The root mean square hides a single body that is far astray; the 99th percentile and the worst body show it."""
    scenes = []
    for gaps in ((0.0,) * 4, moved):
        world = World(Effects(response=True))
        for number, gap in enumerate(gaps):
            world.add_body(Circle(1.0), position=(10.0 * number, gap))
        scenes.append(SimpleNamespace(worlds=[world]))
    assert distances(*scenes) == pytest.approx((middle, p99, worst))
