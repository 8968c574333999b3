"""The sentence and the number in the title line of every lab agree, and nothing is judged before it is measured."""

import re

import pytest

import physics
from game.drawing.headline import Headline
from game.input.inputs import InputFrame, InputState
from game.registry import Registry
from game.scene import Goal
from scenes import SCENES
from scenes.lab.disagreement import Disagreement
from scenes.lab.dominoes import ALLOWED
from scenes.lab.gallery.scene import interval
from scenes.lab.ghost_bumps import KEEPS
from scenes.lab.joints import FINE
from scenes.lab.pyramid import SUNK
from scenes.lab.queries import Queries
from tests.lockstep import make_scene

LABS = [name for name in SCENES if name.startswith("lab/")]
LOOKS = (5, 60, 300)  # steps
needs_speed = pytest.mark.skipif(not physics.JIT, reason="hundreds of frames")


def all_of(count, total):
    return count == total


def none_of(count, total=0):
    return count == 0


# What the number in the title line must be for a good result, of its one or two figures.
GOOD = {
    "lab/dominoes": lambda percent: percent <= 100 * ALLOWED,
    "lab/stacks": lambda percent: percent <= 9,
    "lab/pyramid": lambda crates: crates <= SUNK,
    "lab/conveyor": lambda percent: percent <= 2.0,
    "lab/joints": lambda pixels: pixels <= FINE,
    "lab/ghost_bumps": lambda percent: percent <= 100 * KEEPS["boxes"],
    "lab/queries": lambda looked: looked < 1200,
    "lab/cradle": all_of,
    "lab/filters": all_of,
    **dict.fromkeys(("lab/tunnelling", "lab/mask_sweep", "lab/card_house", "lab/sensors", "lab/masks"), none_of),
    **dict.fromkeys(("lab/disagreement", "lab/carving", "lab/sleeping"), none_of),
    "lab/one_way": lambda through, thrown: 2 * through > thrown,
    "lab/tumbler": lambda percent: percent <= 20,
    "lab/ladder": lambda percent: percent < 1,
}  # fmt: skip


def figures(number):
    return [float(each.replace(",", "")) for each in re.findall(r"\d[\d,]*(?:\.\d+)?", number)]


def run(scene, steps, taps=()):
    """Step a scene without input, except for the action taps[n] in step n."""
    inputs = InputState()
    for number in range(steps):
        inputs.set(InputFrame(frozenset(filter(None, taps[number : number + 1]))))
        scene.step(inputs)
    return scene


def test_a_sentence_states_the_fault_only_beside_a_number_that_shows_it():
    fault = Headline("It fails.", "Space: mend", "7 of 9", "went through", 9, 9, "shots")
    assert fault.asks("Does it fail?") == fault
    for other in (fault._replace(seen=3), fault._replace(good=True)):
        assert other.asks("Does it fail?").sentence == "Does it fail?"


@needs_speed
@pytest.mark.parametrize("name", LABS)
def test_sentence_and_number_agree(name):
    scene, steps = make_scene(name), 0
    for look in LOOKS:
        run(scene, look - steps)
        steps, headline = look, scene.headline()
        assert headline.sentence.endswith("?") == (headline.good or not headline.known), headline
        if headline.known and name in GOOD:
            assert GOOD[name](*figures(headline.number)) == headline.good, headline


@pytest.mark.parametrize("frame", (0, 299, 300, 9000))
def test_a_goal_that_is_not_measured_has_not_failed(frame):
    waiting = Goal("it stands after a nudge", 300, False, "0 steps", measured=False)
    assert waiting.waits(frame) and waiting.text == "it stands after a nudge: not yet"
    failed = Goal("it stands after a nudge", 300, False, "0 steps")
    assert failed.waits(frame) == (frame < 300) and failed.text == "it stands after a nudge: 0 steps"
    assert not Goal("it stands", 300, True).waits(0) and Goal("it stands", 300, True).text == "it stands"


@needs_speed
@pytest.mark.parametrize(
    "name, words, tap",
    [("lab/stacks", "after a nudge", "fire"), ("lab/masks", "sharing a pixel", None), ("lab/masks", "far apart", None)],
)
def test_a_goal_that_needs_the_player_waits_for_the_player(name, words, tap):
    scene = run(make_scene(name), 320)
    goal = next(each for each in scene.check() if words in each.name)
    assert goal.waits(scene.frame) and goal.text.endswith(": not yet")
    if tap:
        run(scene, 2, (tap,))
        assert next(each for each in scene.check() if words in each.name).met


@needs_speed
def test_brute_force_visits_each_shape_once_for_each_part_of_the_query():
    scene = run(Queries(3), 20)
    headline = scene.headline()
    (looked,), (whole,) = figures(headline.number), figures(headline.unit)
    bodies = len(scene.worlds[-1].bodies)
    assert looked == whole == bodies * len(scene.worlds[-1].queries.asked) and f"{bodies:,} shapes" in headline.sentence
    scene = run(scene, 20, ("down",))
    assert figures(scene.headline().number)[0] < whole / 2


@needs_speed
@pytest.mark.parametrize("seed", range(6))
def test_no_shape_drifts_over_the_start_of_the_rays(seed):
    scene = Queries(seed)
    scene.change("slider:bodies", 600)
    for _ in range(200):
        run(scene, 1)
        assert scene.worlds[0].query_point(scene.origin) == [] and all(row[5] > 0.0 for row in scene.answer)


@needs_speed
def test_shots_are_counted_and_their_share_has_an_interval():
    scene = run(make_scene("lab/gallery"), 100)
    headline, rate = scene.headline(), scene.page.rate(scene.sides[0])
    assert figures(headline.number) == [rate.count, rate.total] and interval(rate) in headline.unit
    assert f"{rate.count} of {rate.total} ({interval(rate)})" in scene.finding()


def test_two_counts_of_hits_in_one_picture_are_named():
    assert Registry(SCENES).scene_class("shooter").hits_of == "" and "your plane" in Disagreement.hits_of
    assert "all sprites" in make_scene("lab/disagreement").headline().unit


# Key that the title line names as the remedy -> how often it is pressed.
MENDS = {
    "lab/gallery": ("bomb", 1),
    "lab/masks": ("right", 40),
    "lab/ladder": ("down", 6),
    "lab/shapes": ("confirm", 2),
    "lab/queries": ("down", 1),
    "lab/filters": ("fire", 1),
    "lab/sensors": ("bomb", 1),
    "lab/stacks": ("bomb", 1),
    "lab/pyramid": ("bomb", 1),
    "lab/card_house": ("up", 8),
    "lab/dominoes": ("up", 3),
    "lab/tumbler": ("bomb", 1),
    "lab/sleeping": ("bomb", 1),
    "lab/mask_stack": ("bomb", 3),
    "lab/carving": ("bomb", 1),
    "lab/joints": ("up", 1),
    "lab/cradle": ("right", 8),
    "lab/billiards": ("bomb", 1),
    "lab/tunnelling": ("bomb", 3),
    "lab/mask_sweep": ("bomb", 1),
    "lab/conveyor": ("left", 6),
    "lab/one_way": ("bomb", 1),
    "lab/ghost_bumps": ("bomb", 1),
}
KEYS = {"bomb": "X", "confirm": "Enter", "fire": "Space"}
OTHERS = {"lab/disagreement", "lab/broadphases", "lab/effects"}  # with tests of their own


def test_every_lab_names_a_key_that_mends_it():
    assert set(LABS) == set(MENDS) | OTHERS


@needs_speed
@pytest.mark.parametrize("name", MENDS)
def test_a_lab_starts_in_its_failing_state_and_its_key_mends_it(name):
    key, count = MENDS[name]
    scene = run(make_scene(name), 300)
    headline = scene.headline()
    assert headline.known and not headline.good, headline
    assert headline.mend.startswith(f"{KEYS.get(key, key)}:"), headline.mend
    held = [key] * count if name == "lab/masks" else [key, ""] * count
    headline = run(scene, 600, held).headline()
    assert headline.known and headline.good and headline.sentence.endswith("?"), headline


@needs_speed
def test_the_shooters_traffic_shows_false_hits_of_the_box_and_the_wheel_chooses_a_better_shape():
    scene, inputs = run(make_scene("lab/disagreement"), 400), InputState()
    assert scene.headline().known and not scene.headline().good and "wheel" in scene.headline().mend
    inputs.set(InputFrame(wheel=3))
    scene.step(inputs)
    headline = run(scene, 300).headline()
    assert headline.known and headline.good, headline
