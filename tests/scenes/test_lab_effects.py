"""lab/effects: two yards start from one state, switched effects add and remove their stages,
and each effect matters.
"""

import numpy as np
import pytest

import physics
from game.input.inputs import InputFrame, InputState
from game.measure.effect_totals import bytes_of
from game.measure.measured_runs import RunFigures
from game.measure.moment import Moment
from game.measure.timing import RUNS, Cost
from game.run.session import Session
from game.run.sources import BotSource
from physics import DYNAMIC, Effects
from scenes.lab.busy_yard import apart, rms
from scenes.lab.effects import AGAIN, ALL, BOT_NEXT, DARK, NAMES, SHOW, TURN, WINDOW, EffectsLab, Outcome, short

needs_speed = pytest.mark.skipif(not physics.JIT, reason="thousands of steps of two yards")
FEW = WINDOW if physics.JIT else 30


@pytest.fixture
def lab():
    return EffectsLab(1)


def play(scene, frames=1, *actions, changes=(), pointer=None):
    inputs = InputState()
    for number in range(frames):
        held = frozenset(actions if number == 0 else ())
        inputs.set(InputFrame(held, pointer or (0, 0), pointer is not None and number == 0, changes=changes))
        scene.step(inputs)
        scene.observe()
        changes = ()


def choose(scene, name):
    play(scene, changes=(("slider:effect", NAMES.index(name)),))


@pytest.mark.parametrize("name", NAMES)
def test_the_ghost_lives_without_the_effect_and_what_needs_it(lab, name):
    choose(lab, name)
    assert lab.worlds == [lab.real.world] and lab.real.world.effects == ALL
    assert lab.other.world.effects == ALL.without(name)
    ours, theirs = lab.stages()
    if name in ("sleeping", "continuous", "sensors", "stacking", "response"):
        assert ours and set(ours) <= set(lab.world.profile.stages)
    play(lab, 1, "fire")
    assert lab.worlds == [lab.other.world] and not set(ours) & set(lab.world.profile.stages)
    assert set(theirs) <= set(lab.world.profile.stages)
    play(lab, 1, "fire")
    assert lab.worlds == [lab.real.world]


def test_both_go_out_from_one_state(lab):
    play(lab, FEW)
    choose(lab, "persist")  # tells more, and moves nothing
    for _ in range(FEW):
        play(lab)
        numbers, gaps = apart(lab.real, lab.other)
        assert len(numbers) == len(lab.real.ids) == len(lab.other.ids) and not gaps.any()
    choose(lab, "gravity")
    before = rms(apart(lab.real, lab.other)[1])
    play(lab, 10)
    assert before < 1.0 < rms(apart(lab.real, lab.other)[1])


@needs_speed
def test_each_effect_is_missed_and_the_finding_is_what_was_measured(lab):
    session = Session(lab, BotSource())
    for _ in range(BOT_NEXT * len(NAMES)):
        session.step()
    assert [goal.name for goal in lab.check() if not goal.met] == []
    assert list(lab.found) == list(NAMES)
    assert lab.found["sensors"].apart == lab.found["persist"].apart == 0.0, "they only tell"
    assert lab.found["sleeping"].work < 0
    far = max(NAMES, key=lambda name: lab.found[name].apart)
    assert f"{far} moves most, {lab.found[far].apart:.0f} px" in lab.finding()


@needs_speed
def test_it_begins_anew_while_the_effect_is_on_and_not_while_it_is_off(lab):
    choose(lab, "gravity")
    play(lab, WINDOW)
    assert "gravity" in lab.found
    ghost = lab.other
    play(lab, AGAIN - WINDOW)
    assert lab.other is not ghost and lab.since <= 1
    play(lab, 1, "fire")
    ghost = lab.other
    play(lab, 2 * AGAIN)
    assert lab.other is ghost


def test_a_click_marks_an_effect_and_another_one_switches_it(lab):
    row = NAMES.index("friction")
    for on in (True, False, True):
        play(lab, 1, pointer=(20, 29 + 10 * row + 3))
        play(lab)
        assert lab.marked == "friction" and lab.is_on == on
    play(lab, 1, "down")
    assert lab.marked == NAMES[row + 1]


def test_settings_go_to_both_worlds(lab):
    play(lab, changes=(("substeps", 8), ("broadphase", "sweep"), ("narrowphase", False)))
    for yard in (lab.real, lab.other):
        world = yard.world
        assert (world.substeps, world.broadphase.name, world.effects.narrowphase) == (8, "sweep", False)
    assert len(lab.worlds) == 1
    with pytest.raises(ValueError, match="not possible here"):
        lab.change("solver", "projection")
    assert len(lab.worlds) == 1


def test_what_would_be_missed():
    assert Outcome(2.0, 0, 0, 0).shows("gravity") and not Outcome(0.5, 0, 0, 5).shows("gravity")
    assert Outcome(0.0, 0, 2, 0).shows("sensors"), "as many begin more as end less"
    assert Outcome(0.0, 9, 1, -1).shows("sleeping") and not Outcome(9.0, 9, 9, 1).shows("sleeping")
    assert short(Outcome(0.0, 0, 0, 0), "gravity") == "the same"


def test_a_yard_without_rotation_sensors_or_carving_can_be_built():
    class Plain(EffectsLab):
        effects = Effects(response=True, gravity=True)
        other_effects = ()

    scene = Plain(1)
    play(scene, 5)
    assert np.isfinite(scene.world.bodies["x"]).all()
    assert [goal.name.split()[1] for goal in scene.check()] == ["narrowphase", "response", "gravity"]


def test_a_price_is_measured_beside_the_game_on_the_yard_with_and_without(lab):
    play(lab, 2)
    choose(lab, "friction")
    request = lab.measured()
    assert [name[:2] for name in request.names] == [
        (how, n) for n in ("gravity", "friction") for how in ("with", "without")
    ]
    assert lab.price("friction") is None and lab.price("drag") is None
    for name in request.names:
        how, effect = name[:2]
        (snapshot,) = request.make(name).snapshots
        assert Effects.named(snapshot.facts["effects"]) == (ALL if how == "with" else ALL.without(effect))
        moving = snapshot.arrays["bodies"][snapshot.arrays["bodies"]["kind"] == DYNAMIC]
        assert moving["awake"].all() and np.array_equal(
            moving["x"], lab.real.world.bodies["x"][lab.real.world.bodies["kind"] == DYNAMIC]
        )
        lab.figures[name] = RunFigures(Cost.of([3e-4 if how == "with" else 1e-4] * RUNS, WINDOW))
    assert lab.price("friction").seconds == pytest.approx(2e-4)
    lab.change("broadphase", "sweep")
    assert lab.price("friction") is None, "other settings cost something else"


def price_all(lab, prices, spread):
    """Set made-up times of the runs with and without each effect in a lab.

    prices: {effect: cost [us]}; spread: median minus least time of each run [us].
    """
    lab.looked = list(NAMES)
    for name in NAMES:
        lab.found[name] = Outcome(1.0 + NAMES.index(name), 0, 0, 0)
        for on in (True, False):
            least = 1e-3 + (1e-6 * prices.get(name, 0.0) if on else 0.0)
            times = [least, *[least + 1e-6 * spread] * (RUNS - 1)]
            lab.figures[lab._run_name(name, on)] = RunFigures(Cost.of(times, WINDOW))


@pytest.mark.parametrize(
    ("prices", "spread", "said"),
    [
        ({}, 0.0, None),
        ({"friction": 40.0, "sleeping": -30.0}, 25.0, None),  # noise of 2 x 25 us
        ({"friction": 40.0}, 10.0, "friction costs most, 40 us"),
        ({"friction": 40.0, "drag": 30.0}, 1.0, "friction costs most, 40 us"),
        ({"friction": 40.0, "drag": 30.0}, 5.0, "friction or drag costs most, 30 to 40 us"),
        ({"friction": 40.0, "drag": 40.0, "wind": 39.0, "carving": 38.0}, 5.0, "or 2 more costs most, 38 to 40 us"),
        ({"sleeping": -300.0}, 10.0, "sleeping saves 300 us"),
        ({"friction": 40.0, "sleeping": -300.0}, 5.0, "friction costs most, 40 us; sleeping saves 300 us"),
    ],
)
def test_the_finding_names_only_what_exceeds_the_noise(lab, prices, spread, said):
    price_all(lab, prices, spread)
    finding = lab.finding()
    if said is None:
        assert "us" not in finding.split() and "costs" not in finding and "saves" not in finding
    else:
        assert said in finding and finding.count("costs most") == (max(prices.values()) > 0.0)


@pytest.mark.parametrize("spread", [0.0, 1.0, 10.0, 100.0])
def test_a_figure_within_the_noise_is_written_as_the_report_does(lab, spread):
    prices = {name: 7.0 * (number - 8) for number, name in enumerate(NAMES)}
    price_all(lab, prices, spread)
    for name, price in prices.items():
        within = abs(price) <= 2.0 * spread + 1e-6
        assert lab.price(name).text() == ("a tie" if within else f"{price:+,.0f}")


@needs_speed
def test_effects_go_dark_one_after_the_other_until_the_player_acts(lab):
    seen = []
    for _ in range(len(SHOW) * TURN):
        play(lab)
        if not lab.is_on and lab.marked not in seen:
            seen.append(lab.marked)
    assert tuple(seen) == SHOW and lab.guided
    play(lab, 1, "fire")
    marked, is_on = lab.marked, lab.is_on
    play(lab, 2 * TURN)
    assert not lab.guided and (lab.marked, lab.is_on) == (marked, is_on)


def test_the_first_effect_goes_dark_within_half_a_second_and_the_bars_follow(lab):
    play(lab, DARK)
    assert lab.is_on and lab._bars()[0].name == "declared"
    play(lab, 2)
    assert lab.marked == "gravity" and not lab.is_on and not lab.worlds[0].effects.gravity
    first = lab._bars()[0]
    assert first.name == "shown" and first.cells[-1][0] == pytest.approx(bytes_of(world_under(lab.worlds[0])), rel=0.25)


def world_under(world):
    """Return a plain World in the state of another one."""
    moment = Moment(world.snapshot(), world.broadphase.name)
    return moment.world(moment.here)


@pytest.mark.parametrize("off", ("response", "gravity", "joints"))
def test_the_declared_effects_are_measured_also_while_another_yard_is_visible(lab, off):
    choose(lab, off)
    play(lab, 1, "fire")
    assert not getattr(lab.worlds[0].effects, off) and lab.weighed_world.effects == ALL
