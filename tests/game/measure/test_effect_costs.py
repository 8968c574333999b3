"""Costs of effects at a moment: the time with and without each, the kernels that it needs, and
the table in the panel.
"""

import json
import subprocess
import sys
from time import monotonic

import numpy as np
import pygame
import pytest

import physics
from game.drawing.canvas import SMALL, shorten
from game.drawing.number_text import plain_name
from game.files.settings import Settings
from game.measure.effect_costs import EffectCost, Side, measure_effects, sides_of, time_side, world_under
from game.measure.ledger import EFFECTS
from game.measure.moment import Moment
from game.measure.timing import RUNS, Cost
from game.screens.parts.effect_rows import effect_rows, hint_of, price_text
from physics import BROADPHASES, Character, Circle, Effects, Material, Polygon, World
from scenes import SCENES

PILE = Effects(response=True, gravity=True, friction=True, stacking=True, sleeping=True)


def moment():
    world = World(PILE, BROADPHASES["hash"]())
    rough = Material(friction=0.7, restitution=0.5)
    world.add_body(Polygon.box(300, 20), position=(0, 10), kind="static", material=rough)
    for row in range(3):
        world.add_body(Polygon.box(16, 16), position=(0, -8 - 16 * row), material=rough)
    world.add_body(Circle(5), position=(60, -40), velocity=(20, 0), material=rough)
    for _ in range(60):
        world.step()
    return Moment(world.snapshot(), "hash")


def test_each_effect_has_two_sides():
    sides = sides_of(PILE)
    assert list(sides) == list(EFFECTS)
    assert sides["gravity"] == (Side(PILE), Side(PILE.without("gravity")))
    assert sides["stacking"][1].effects == PILE.with_(stacking=False, sleeping=False)
    assert sides["wind"] == (Side(PILE.with_(wind=True), ("wind",)), Side(PILE, ("wind",)))
    assert sides["sensors"] == (Side(PILE.with_(sensors=True)), Side(PILE))
    bare = sides_of(Effects())["sleeping"]
    assert bare[1].effects.names() == ["narrowphase", "response", "stacking"]


@pytest.mark.parametrize("effect", ["drag", "wind", "restitution", "conveyor", "continuous", "sensors", "persist"])
def test_put_in_idle_the_moment_goes_on_as_it_would(effect):
    one, other = (world_under(moment(), side) for side in sides_of(PILE)[effect])
    for _ in range(40 if physics.JIT else 12):
        one.step()
        other.step()
        assert one.digest() == other.digest()


def test_taken_out_it_does_not():
    one, other = (world_under(moment(), side) for side in sides_of(PILE)["gravity"])
    for _ in range(12):
        one.step()
        other.step()
    assert one.digest() != other.digest()
    assert time_side(moment(), Side(PILE), 2) > 0.0


def test_every_effect_is_reported_after_each_round_and_nothing_once_it_is_over(monkeypatch):
    monkeypatch.setattr("game.measure.effect_costs.STEPS", 1)
    reported, asked = [], []
    measure_effects(moment(), lambda *found: reported.append(found), lambda: True)
    assert [name for name, _, _ in reported] == RUNS * list(EFFECTS)
    assert {cost.runs for _, *both in reported[-len(EFFECTS) :] for cost in both} == {RUNS}
    reported.clear()
    measure_effects(moment(), lambda *found: reported.append(found), lambda: bool(asked.append(1)))
    assert not reported and len(asked) == 1


def test_of_what_a_world_cannot_be_without_nothing_is_reported(monkeypatch):
    monkeypatch.setattr("game.measure.effect_costs.STEPS", 1)
    world = World(PILE, BROADPHASES["hash"]())
    Character(world, Polygon.box(8, 16), (0, 0))
    world.step()
    reported = set()
    measure_effects(Moment(world.snapshot(), "hash"), lambda name, *_: reported.add(name), lambda: True)
    assert set(EFFECTS) - reported == {"response"}


def test_what_the_runs_scatter_by_is_no_cost():
    def known(one, other):
        costs = (Cost(1e-6 * each, 1e-6 * each + 1e-6, 1.0, 5, 60) for each in (one, other))
        return EffectCost("gravity", True, *costs)

    assert known(30, 20).price == pytest.approx(1e-5) and known(30, 20).noise == pytest.approx(2e-6)
    assert price_text(known(32, 20), busy=True) == "+12" and price_text(known(20, 24.5), busy=True) == "-4.5"
    assert price_text(known(21, 20), busy=True) == "0"
    assert price_text(EffectCost("gravity", True), busy=True) == "..."
    assert price_text(EffectCost("gravity", True), busy=False) == "-"
    assert hint_of(known(32, 20)) == "declared: +12 us, +-2.0"


@pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")
def test_kernels_are_counted_by_a_process_that_compiles_none():
    order = {"effects": ["narrowphase", "response", "gravity"], "broadphase": "hash", "pieces": ["circles"]}
    order["choices"] = {"few": ["narrowphase"], "all": list(EFFECTS)}
    run = subprocess.run(
        [sys.executable, "-m", "game.measure.kernel_counts"],
        input=json.dumps(order) + "\n",
        capture_output=True,
        text=True,
        check=True,
    )
    found = dict(json.loads(line) for line in run.stdout.splitlines() if line.startswith("["))
    assert list(found) == ["few", "all", *EFFECTS]
    assert 5 < found["few"] < found["all"] / 2
    assert found["gravity"] == 1, "one pass over velocities, with gravity in it"
    assert found["persist"] == 0 and found["stacking"] > 10 and found["response"] > 3


# --- the panel ---------------------------------------------------------------------------------------------------


@pytest.fixture
def driver(drive):
    drivers = []

    def start(**more):
        drivers.append(drive(listing=SCENES, **more))
        return drivers[-1]

    yield start
    for each in drivers:
        play = each.app.screens.played
        if play is not None:
            play.close()


def texts_in(frame, rect):
    return [(box, text) for box, text in frame.boxes if rect.contains(box)]


@pytest.mark.parametrize("size", [(960, 540), (1440, 810)])
@pytest.mark.parametrize("scene", ["lab/pyramid", "shooter"])
def test_the_table_is_whole_at_every_size(driver, size, scene):
    run = driver(settings=Settings(window_scale=size[0] // 480))
    run.app.screens.play(scene)
    run.turns(5)
    run.key(pygame.K_TAB)
    panel = run.screen.panel
    rows = panel.rows()
    long = EffectCost("conveyor", False, *[Cost(0.02, 0.0201, 1.0, 5, 60), Cost(0.01, 0.0101, 1.0, 5, 60)], kernels=123)
    run.screen.measuring.ledger.effects = {name: long._replace(effect=name) for name in EFFECTS}
    panel.mark = next(place for place, row in enumerate(rows) if row.label == "carving")
    run.turns(1)
    frame = run.app.arcade.picture.presenter.frame
    assert frame.surface.get_size() == size
    found = texts_in(frame, panel.rect)
    shown = [text for _, text in found]
    for name in EFFECTS[-8:]:
        assert plain_name(name) in shown, f"{name} is cut, or not there"
    assert "us a step" in shown and shown.count("123") >= 8 and "+10,000" in shown
    boxes = [box for box, _ in found]
    assert all(not a.colliderect(b) for place, a in enumerate(boxes) for b in boxes[:place])
    scale = frame.text_scale
    hint = hint_of(run.screen.measuring.ledger.effects["carving"])
    assert shorten(hint, panel.rect.width - 12 * scale, SMALL, scale) == hint


def test_what_each_effect_costs_is_measured_while_the_panel_is_open(driver):
    run = driver()
    run.app.screens.play("lab/conveyor")
    run.turns(20)
    ledger = run.screen.measuring.ledger
    run.key(pygame.K_TAB)
    run.turns(5)
    assert ledger.process is None, "who passes by starts no process"
    run.turns(40)
    assert ledger.process is not None and ledger.busy
    end = monotonic() + 240.0
    while ledger.busy and monotonic() < end:
        ledger.wait(0.2)
    assert not ledger.trouble and list(ledger.effects) == list(EFFECTS)
    known = ledger.effects.values()
    assert all(each.price is not None for each in known)
    assert all((each.kernels is not None) == physics.JIT for each in known)
    run.turns(1)
    assert ledger.process is None, "the process ends with its work"
    on = [row.label for row in effect_rows(run.screen.measuring) if row.on]
    choices, declared = on[:3], on[3:]
    assert choices == ["declared", "everything", "nothing"]
    assert declared == [plain_name(name) for name in run.screen.scene.effects.names()]


def test_the_measuring_ends_with_the_panel_and_with_the_scene(driver):
    run = driver()
    run.app.screens.play("lab/filters")
    for leave in (lambda: run.key(pygame.K_TAB), lambda: run.screen.close()):
        run.turns(2)
        run.key(pygame.K_TAB)
        run.turns(45)
        process = run.screen.measuring.ledger.process
        assert process is not None
        leave()
        assert process.poll() is not None


@pytest.mark.skipif(not physics.JIT, reason="there are no types")
def test_types_are_those_that_numba_says():
    from numba import njit

    from physics.jit.kernels import key_of, type_of

    dispatcher = njit(lambda x: x)
    table = np.zeros(6, [("a", "f8"), ("b", "i4")])
    sealed = np.zeros((3, 4))
    sealed.flags.writeable = False
    values = [table, table[::2], table[1:], np.zeros((3, 4)), np.zeros((3, 4)).T, sealed, np.zeros(3, np.int32)]
    values += [Cost(*values[:4], table), (table, 1), (table, 1.0), (), 3, 2**63, True, 1.5, None, np.uint8(3)]
    for value in [*values, *values]:
        assert type_of(key_of(value)) == dispatcher.typeof_pyval(value), value
    with pytest.raises(TypeError, match="str: 'word'"):
        key_of("word")
