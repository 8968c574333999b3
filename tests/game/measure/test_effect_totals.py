"""A scene's effects compared with all effects and with the fewest: time, kernels, start, bytes, and the bars that show
them.
"""

import json

import numpy as np
import pygame
import pytest

import physics
from game.drawing.bar_table import bar_table_height, draw_bar_table
from game.drawing.canvas import Canvas
from game.input.devices import DeviceSource
from game.measure.effect_totals import (
    DECLARED,
    EVERYTHING,
    FIELDS,
    NAMES,
    NOTHING,
    EffectTotal,
    bars_of,
    bytes_of,
    choices_of,
    measure_starts,
    measure_totals,
    sentence_of,
)
from game.measure.ledger import EFFECTS
from game.measure.moment import Moment
from game.measure.surveyor import Surveyor
from game.measure.timing import RUNS, UNSURE_CELL, Cost
from game.run.picture import Picture
from game.screens.parts.effect_rows import effect_rows
from game.screens.play import Play
from physics import Character, Circle, Effects, Polygon, World
from scenes.lab.effects import EffectsLab
from tests.game.arena import Arena
from tests.game.measure.test_effect_costs import moment
from tests.game.reading import assert_text_is_apart
from tests.game.test_lab_card import Silent

MS = 1e-3


def totals_with(**times):
    """Return {name: EffectTotal} from the (least, median) time of a step [ms] for each name."""
    return {
        name: EffectTotal(number, Cost(least * MS, middle * MS, middle * MS, RUNS, 60), 10 * number, MS, 1000 * number)
        for number, (name, (least, middle)) in enumerate(times.items(), 3)
    }


def test_the_choices_are_what_is_declared_all_and_none():
    choices = choices_of(moment())
    assert list(choices) == list(NAMES)
    assert choices[DECLARED].effects == moment().effects
    assert set(choices[EVERYTHING].effects.names()) == set(EFFECTS)
    assert choices[NOTHING].effects.names() == []
    assert "wind" in choices[EVERYTHING].idle and "gravity" not in choices[EVERYTHING].idle, "what is added idles"


def test_what_a_world_cannot_be_without_stays():
    world = World(Effects(response=True, gravity=True))
    Character(world, Polygon.box(8, 12), position=(0.0, 0.0))
    assert choices_of(Moment(world.snapshot(), "hash"))[NOTHING].effects.names() == ["response"]


def test_totals_are_measured_in_rounds_and_without_effects_a_world_is_smaller():
    found = {}
    here = moment()
    choices = choices_of(here)
    measure_totals(here, choices, lambda name, values: found.setdefault(name, {}).update(values), lambda: True)
    assert list(found) == list(NAMES)
    assert all(each["time"].runs == RUNS for each in found.values())
    sizes = [found[name]["bytes"] for name in (NOTHING, DECLARED, EVERYTHING)]
    assert 10_000 < sizes[0] < sizes[1] <= sizes[2]
    calls = []
    measure_totals(here, choices, lambda name, values: calls.append(values), lambda: False)
    assert all("time" not in values for values in calls), "another order ends it"


def test_bytes_count_each_block_once():
    world = World()
    world.add_body(Circle(3))
    before = bytes_of(world)
    assert before > world.bodies.base.nbytes
    kept = np.zeros(1000)
    assert bytes_of({"world": world, "two": [kept, kept[:10]]}) == before + 8000


@pytest.mark.skipif(not physics.JIT, reason="three processes that run plain kernels")
def test_the_start_is_that_of_a_new_process(tmp_path):
    path = str(tmp_path / "moment.npz")
    here = moment()
    here.snapshot.save(path)
    order, found = {"snapshot": path, "broadphase": "hash"}, {}
    measure_starts(order, choices_of(here), lambda name, values: found.update({name: values}), lambda: True)
    assert list(found) == list(NAMES) and all(0.0 < each["start"] < 60.0 for each in found.values())


def test_a_difference_inside_the_noise_is_none():
    totals = totals_with(declared=(1.0, 1.1), everything=(1.15, 1.2), nothing=(0.5, 0.51))
    declared, every, none = (dict(zip(FIELDS, bar.cells, strict=True)) for bar in bars_of(totals))
    assert declared["time"][1] == "1,000" and every["time"][1] == "a tie" and none["time"][1] == "500"
    assert sentence_of(totals) == "Declaring all 4 effects: the time cannot be told apart from that of 3."
    totals = totals_with(declared=(1.0, 1.01), everything=(2.5, 2.51), nothing=(0.5, 0.51))
    assert sentence_of(totals) == "Declaring all 4 effects takes 2.5 x the time of 3."


def test_before_it_is_measured_there_is_no_number():
    assert sentence_of({}) == ""
    assert all(cell == (None, "...") for bar in bars_of({}) for cell in bar.cells)
    few = EffectTotal(3, Cost(1.0, 1.0, 1.0, RUNS - 1, 60))
    assert few.value("time") is None, "too few runs"


def test_results_arrive_one_by_one():
    surveyor = Surveyor()
    for values in ({"bytes": 5, "effects": 2}, {"time": [1.0, 2.0, 3.0, 5, 60]}, {"start": 0.25}):
        surveyor._take(json.loads(json.dumps({"moment": "effects", "total": DECLARED, "values": values})))
    assert surveyor.totals[DECLARED] == EffectTotal(2, Cost(1.0, 2.0, 3.0, 5, 60), None, 0.25, 5)


@pytest.mark.parametrize("widest", ["1,000", "9,999"])
def test_a_tie_is_no_wider_than_a_time(widest):
    """The text of a cell is not cut by the bar of the next column, see bars_of."""
    assert len(UNSURE_CELL) <= len(widest), "the letters of the font are as wide as its digits"


def test_bars_fit_their_table_and_the_longest_is_the_greatest():
    totals = totals_with(declared=(50.0, 50.1), everything=(99.999, 100.0), nothing=(0.5, 0.51))
    canvas = Canvas(pygame.Surface((182, 40)))
    rows = bars_of(totals)
    draw_bar_table(canvas, pygame.Rect(0, 0, 182, bar_table_height(len(rows))), list(FIELDS.values()), rows)
    assert_text_is_apart(canvas.boxes, canvas.rect)
    pixels = pygame.surfarray.array3d(canvas.surface)
    lengths = [int((pixels[42:77, 8 * row + 2] == row_.color).all(axis=-1).sum()) for row, row_ in enumerate(rows, 1)]
    assert lengths[1] == max(lengths) > lengths[0] > lengths[2] >= 1


@pytest.mark.usefixtures("nothing_is_measured")
@pytest.mark.parametrize("size", [(480, 270), (640, 360), (960, 540), (1440, 810)])
def test_the_step_inspector_and_the_lab_show_them(size):
    totals = totals_with(declared=(1.0, 1.01), everything=(2.5, 2.51), nothing=(0.5, 0.51))
    for play in (Play(Arena(), DeviceSource(), Silent()), Play(EffectsLab(1), DeviceSource(), Silent())):
        for _ in range(3):
            play.step()
        if isinstance(play.scene, Arena):
            play.toggle_step_inspector()
        play.measuring.ledger.totals = play.scene.totals = totals
        frame = play.draw(Picture(pygame.Surface(size)))
        words = [text for _, text in frame.boxes]
        assert {"everything", "2,500", *FIELDS.values()} <= set(words), words
        assert_text_is_apart(frame.boxes, frame.rect)
        rows = {row.label: row for row in effect_rows(play.measuring)}
        assert rows["everything"].cells == ("2,500", "40") and "4 kB" in rows["everything"].hint
        play.close()


@pytest.mark.usefixtures("nothing_is_measured")
def test_a_scene_is_weighed_once(monkeypatch):
    asked = []
    play = Play(Arena(), DeviceSource(), Silent())
    monkeypatch.setattr(play.measuring.ledger, "measure_effects", lambda *order, each=True: asked.append(each))
    play.step()
    for _ in range(3):
        play.toggle_step_inspector()
        play.toggle_step_inspector()
    assert asked == [False]
    play.close()


def test_the_ratio_is_that_of_the_numbers_beside_it():
    totals = totals_with(declared=(0.3334, 0.334), everything=(0.358, 0.4), nothing=(0.0486, 0.049))
    totals[DECLARED] = totals[DECLARED]._replace(effects=totals[EVERYTHING].effects)
    declared, _, nothing = (row.cells[0][1] for row in bars_of(totals))
    assert (declared, nothing) == ("333", "49")
    assert f"{333 / 49:.1f} x" in sentence_of(totals)
