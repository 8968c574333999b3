"""Verdicts of labs follow the present state; they were once computed once and then stayed on the screen."""

import pytest

from game.drawing.canvas import SMALL, Canvas
from game.drawing.number_text import plain_name
from game.registry import Registry
from game.run.session import Session
from game.run.sources import BotSource, IdleSource
from scenes import SCENES
from scenes.lab.cradle import SPEED
from scenes.lab.ladder import _times
from scenes.lab.piles import SOLVERS


def after(name, frames, source=None, **values):
    """Return (scene, session) of a lab after some frames. values: {slider: value} to set before."""
    scene = Registry(SCENES).scene_class(name)(0)
    for slider, value in values.items():
        scene.change_slider(slider, value)
    session = Session(scene, source or IdleSource())
    for _ in range(frames):
        session.step()
    return scene, session


def words(scene):
    """Return every line of text in the picture of a scene."""
    canvas = Canvas()
    canvas.begin((0, 0, 0))
    scene.draw(canvas, 1.0)
    return [text for _, text in canvas.boxes]


@pytest.mark.parametrize("lane", range(len(SOLVERS)))
def test_a_channel_is_judged_as_it_is(lane):
    scene, session = after("lab/cradle", 5, gap=8)
    assert scene.verdict(lane)[0] == "not struck yet"
    for _ in range(95):
        session.step()
    assert [scene.verdict(each)[0] for each in range(len(SOLVERS))] == ["as many leave as came"] * len(SOLVERS)
    ball = scene.balls[lane][2]
    ball.velocity = (0.3 * SPEED, 0.0)
    assert scene.verdict(lane)[0] == "others move too, by 30.0 %" and scene.offer
    assert f"{scene.verdict(lane)[0]}" in words(scene)
    ball.velocity = (0.9 * SPEED, 0.0)
    assert scene.verdict(lane)[0] == "2 fast ones instead of 1"
    ball.velocity = (0.0, 0.0)
    assert scene.verdict(lane)[0] == "as many leave as came" and not scene.offer
    for body in scene.balls[lane]:
        body.velocity = (0.0, 0.0)
    assert scene.verdict(lane)[0] == "0 fast ones instead of 1"


@pytest.mark.parametrize("lane", range(len(SOLVERS)))
def test_the_check_of_the_cradle_covers_every_channel(lane):
    scene, session = after("lab/cradle", 60, gap=8)
    scene.balls[lane][3].velocity = (0.2 * SPEED, 0.0)
    for _ in range(60):
        session.step()
    failed = [goal.name for goal in scene.check() if plain_name(SOLVERS[lane]) in goal.name and not goal.met]
    assert any("1 in, 1 out" in name for name in failed) and any("energy" in name for name in failed)


def test_energy_goes_on_after_the_ball():
    scene, session = after("lab/pyramid", 20, rows=5)
    seen = []
    scene._drop()
    for _ in range(90):
        session.step()
        seen.append(scene.energy)
    assert len({round(each, 3) for each in seen[-40:]}) > 20, "a pile that falls has another energy in every step"
    shown = next(text for text in words(scene) if text.endswith("%") and text[0] in "+-")
    assert shown == f"{100.0 * (scene.energy - scene.start_energy) / abs(scene.start_energy):+.3f} %"


@pytest.mark.parametrize("lane", range(len(SOLVERS)))
def test_a_column_stands_or_has_fallen(lane):
    scene, _ = after("lab/stacks", 3)
    top = scene.tops[lane]
    x, y = top.position
    for place, stands in (((x, y), True), ((x + 90.0, y), False), ((x, y + 90.0), False), ((x, y), True)):
        top.move_to(place, 0.0)
        assert scene.stands_now(lane) == stands
        assert words(scene).count("fell") == (0 if stands else 1)


def test_belts_are_told_at_their_present_speed():
    scene, session = after("lab/conveyor", 300)
    assert "level" in scene.last
    scene.change_slider("speed", 100)
    session.step()
    assert not scene.last and "level" in words(scene)


def test_a_dragged_rider_is_told_aside():
    scene, session = after("lab/one_way", 80)
    scene.rider.move_to((scene.rider.position[0] + 6.0, scene.rider.position[1]), 0.0)
    session.step()
    assert scene.aside["crate"] > 4.0
    assert any(text.startswith("riders ") and text != "riders 0.0 px aside" for text in words(scene))


def test_momentum_is_told_where_it_is_measured():
    scene, _ = after("lab/billiards", 40, BotSource())
    assert scene.budget is not None and "kept" in words(scene)
    scene.off = 0.1
    assert "lost" in words(scene) and "kept" not in words(scene)
    scene.budget = None
    assert not {"kept", "lost"} & set(words(scene))


def test_nodes_of_the_tree_are_tests():
    scene, session = after("lab/broadphases", 3, bodies=300)
    tree = scene.worlds[-1].profile.counters
    assert tree["nodes_visited"] > 0
    before = scene.tests["tree"]
    session.step()
    found = scene.worlds[-1].profile.counters
    assert scene.tests["tree"] - before == found["pairs_tested"] + found["nodes_visited"]
    scene.observe()
    assert scene.curves[1].history["tree"][-1] == found["pairs_tested"] + found["nodes_visited"]


def test_a_column_that_settles_does_not_sway_by_nothing():
    """The lab of stacks shows no sway before the column has settled, after two seconds."""
    for frames, reported in ((60, False), (180, True)):
        said = words(after("lab/stacks", frames)[0])
        sways = [said[at + 1] for at, each in enumerate(said) if each == "sways"]
        assert len(sways) == len(SOLVERS)
        assert all((each != "-") == reported for each in sways)


def test_a_pair_of_cards_that_slides_does_not_stand():
    """A pair of cards that slides is shown as "slides" or "slid apart", not as "stands"."""
    for frames, word in ((60, "slides"), (200, "slid apart")):
        said = words(after("lab/card_house", frames)[0])
        assert word in said and said.count("stands") == 1, "the pair with friction enough"


@pytest.mark.parametrize("costs", [(1443e-9, 133e-9), (3711e-9, 54e-9), (18501e-9, 77e-9), (99999e-9, 999e-9)])
def test_times_of_the_ladder_do_not_run_into_their_name(costs):
    """The times in lab/ladder do not overlap their name, as in "hit, miss1,443, 133 ns"."""
    canvas = Canvas()
    name, reported = (canvas.measure(text, SMALL)[0] for text in ("hit, miss", _times(*costs)))
    assert name + reported < 78 - 2, "the width of a column of figures, and a gap"
