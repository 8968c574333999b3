"""Labs of piles and collisions: effects of sliders, keys and the mouse that their bots do not use."""

from math import hypot, pi

import pygame
import pytest

import physics
from game.drawing.rotated import RotatedPicture
from game.input.inputs import InputFrame
from game.run.outcome import judge
from game.run.session import Session
from game.run.sources import BotSource, ScriptSource
from scenes.lab.billiard_table import CLOTH, HEAD_SPOT, HOLES
from scenes.lab.billiards import Billiards
from scenes.lab.card_house import NEEDED, CardHouse
from scenes.lab.cradle import GAP, SPEED, Cradle
from scenes.lab.dominoes import PUSHED_AT, Dominoes
from scenes.lab.piles import SOLVERS, deepest, kinetic_energy
from scenes.lab.pyramid import Pyramid
from scenes.lab.stacks import Stacks
from scenes.lab.tumbler import INSIDE, MIDDLE, Tumbler, drum_boxes, places

compiled = pytest.mark.skipif(not physics.JIT, reason="takes long without compiled kernels")


def play(scene, frames=(), steps=None, source=None):
    session = Session(scene, source or ScriptSource([f if isinstance(f, InputFrame) else f.split() for f in frames]))
    for _ in range(len(frames) if steps is None else steps):
        session.step()
    return scene


# --- stacks, pyramid -------------------------------------------------------------------------------------------------


def test_three_columns_are_the_same_but_for_their_solver():
    scene = Stacks(seed=1)
    assert [world.solver for world in scene.worlds] == list(SOLVERS)
    first = scene.worlds[0].bodies[["x", "y", "mass"]].tolist()
    assert all(world.bodies[["x", "y", "mass"]].tolist() == first for world in scene.worlds)


@compiled
def test_a_heavier_top_presses_deeper():
    depths = []
    for heavy in (1, 10):
        scene = Stacks(seed=1)
        scene.change("slider:crates", 4)
        scene.change("slider:top crate", heavy)
        play(scene, steps=200)
        assert scene.stands("soft_step")
        depths.append(scene.depth["soft_step"])
    assert depths[1] > 1.5 * depths[0]


@pytest.mark.parametrize("rows, size", [(5, 24), (12, 16), (20, 11)])
def test_a_pyramid_of_any_size_fits_the_picture(rows, size):
    scene = Pyramid(seed=1)
    scene.change("slider:rows", rows)
    bodies = scene.world.bodies
    assert len(bodies) == 1 + rows * (rows + 1) // 2 and scene.drawn == size
    x, y = scene.camera.to_canvas(bodies["x"][1:], bodies["y"][1:])
    assert x.min() > size / 2 and x.max() < 480 - size / 2 and y.min() > 16 + size / 2 and y.max() < 270


def test_the_solver_changes_under_a_standing_pyramid():
    scene = play(Pyramid(seed=1), steps=10)
    before = scene.world
    for number, name in enumerate(SOLVERS):
        scene.change("slider:solver", number)
        play(scene, steps=2)
        assert scene.world is before and scene.world.solver == name
    assert Pyramid(seed=1, solver="sequential_impulse").world.solver == "sequential_impulse"


@compiled
@pytest.mark.parametrize("substeps, stands", [(2, False), (4, True), (8, True)])
def test_twenty_rows_stand_still_with_four_substeps_and_creep_with_two(substeps, stands):
    scene = Pyramid(seed=1)
    scene.change("slider:rows", 20)
    scene.change("slider:substeps", substeps)
    scene.change("slider:solver", SOLVERS.index("soft_step"))
    play(scene, steps=310)
    failed = [goal.name for goal in scene.check() if goal.due <= 300 and not goal.met]
    assert bool(failed) != stands, failed


# --- tumbler ---------------------------------------------------------------------------------------------------------


def test_the_drum_is_closed_and_the_load_starts_inside_without_overlap():
    assert len(drum_boxes()) == 15
    for x, y in places(160):
        assert hypot(x - MIDDLE[0], y - MIDDLE[1]) < INSIDE - 15
    scene = Tumbler(seed=1)
    scene.change("slider:bodies", 160)
    assert len(scene.world.bodies) == 161
    play(scene, steps=1)
    assert deepest(scene.world) < 6.0


@compiled
@pytest.mark.parametrize("speed", [-2.0, 2.0])
def test_none_gets_out_at_full_speed(speed):
    scene = Tumbler(seed=2)
    scene.change("slider:bodies", 160)
    scene.change("slider:speed", speed)
    play(scene, steps=600)
    assert scene.escaped == 0 and scene.drum.angular_velocity == speed


# --- dominoes --------------------------------------------------------------------------------------------------------


@compiled
def test_dominoes_stand_until_pushed_and_can_be_set_up_again():
    scene = play(Dominoes(seed=1), steps=PUSHED_AT)
    assert all(abs(body.angle) < 1e-3 for row in scene.rows for body in row)
    play(scene, steps=61)  # it pushes by itself
    assert scene.rows[0][0].angle > 0.5
    play(scene, ["fire"])
    assert scene.since == 1 and scene.pushed == 0 and abs(scene.rows[0][3].angle) < 0.01


@compiled
def test_on_the_screen_the_large_wave_lags_by_half():
    scene = play(Dominoes(seed=1), source=BotSource(), steps=500)
    small, large = (passed[10] - scene.pushed for passed in scene.passed)
    assert large / small == pytest.approx(2.0, rel=0.05)


# --- cradle ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("strikers", [1, 2, 3])
def test_as_many_leave_as_came(strikers):
    scene = Cradle(seed=1)
    scene.change("slider:strikers", strikers)
    scene.change("slider:gap", GAP)
    play(scene, steps=150)
    assert len(scene.results) == len(SOLVERS)
    for wrong, momentum, energy in scene.results.values():
        assert max(wrong, momentum, energy) < 1e-9


def test_without_a_gap_momentum_stays_and_energy_never_grows():
    scene = Cradle(seed=1)
    scene.change("slider:gap", 0)
    for _ in range(70):  # up to the first ball at the far wall
        play(scene, steps=1)
        for index, world in enumerate(scene.worlds):
            if max(body.position[0] for body in scene.balls[index]) < 900.0:
                momentum = float((world.bodies["mass"] * world.bodies["vx"]).sum())
                assert momentum == pytest.approx(scene.momentum[index], rel=1e-9)
                assert kinetic_energy(world) < scene.energy[index] * (1.0 + 1e-9)
    assert all(row[-1].velocity[0] > 0.1 * SPEED for row in scene.balls)


@pytest.mark.parametrize("gap", [0, 1, 3])
@pytest.mark.parametrize("strikers", [1, 2, 3])
def test_as_many_leave_a_row_that_touches_under_the_solvers_of_its_text(strikers, gap):
    scene = Cradle(seed=1)
    scene.change("slider:strikers", strikers)
    scene.change("slider:gap", gap)
    play(scene, steps=150)
    for name in ("sequential_impulse", "soft_step"):
        assert max(scene.results[name, strikers, gap]) < 1e-9, name
    assert (scene.results["projection", strikers, gap][0] > 0.1) == (gap == 0)


# --- billiards -------------------------------------------------------------------------------------------------------


def test_the_mouse_aims_swings_the_power_and_shoots_when_let_go():
    scene = Billiards(seed=1)
    place = (300, 180)
    swing = (
        [InputFrame(pointer=place)] + [InputFrame(pointer=place, pointer_down=True)] * 36 + [InputFrame(pointer=place)]
    )
    play(scene, swing)
    vx, vy = scene.cue.velocity
    assert scene.shots == 1 and 0.4 < scene.power < 0.6
    assert vy / vx == pytest.approx((180 - HEAD_SPOT[1]) / (300 - HEAD_SPOT[0]), rel=1e-9)


def test_a_ball_that_is_dragged_is_no_shot():
    scene = Billiards(seed=1)
    place = tuple(round(v) for v in scene.world.body(max(scene.ball_names)).position)
    hover, press = InputFrame(pointer=place), InputFrame(pointer=place, pointer_down=True)
    play(scene, [hover, *[press] * 5, hover])
    assert scene.shots == 0


def test_pockets_count_balls_and_give_the_cue_ball_back():
    scene = Billiards(seed=1)
    ball = next(identity for identity, number in scene.ball_names.items() if number == 7)
    scene.world.body(ball).move_to((HOLES[0][0] + 30, HOLES[0][1] + 30))
    scene.world.body(ball).velocity = (-200.0, -200.0)
    play(scene, steps=30)
    assert scene.potted == [7] and ball not in scene.ball_names
    scene.cue.move_to((HOLES[-1][0] - 30, HOLES[-1][1] - 30))
    scene.cue.velocity = (200.0, 200.0)
    play(scene, steps=30)
    assert scene.scratches == 1 and scene.cue.position == HEAD_SPOT and scene.potted == [7]


@compiled
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_game_of_a_minute_stays_on_the_table(seed):
    scene = play(Billiards(seed=seed), source=BotSource(), steps=3600)
    assert judge(scene, 3600)["ok"], judge(scene, 3600)
    assert scene.shots >= 3
    for identity in scene.ball_names:
        assert CLOTH.inflate(30, 30).collidepoint(scene.world.body(identity).position)


# --- house of cards --------------------------------------------------------------------------------------------------


def test_theory_is_the_tangent_of_the_lean_less_the_round_end():
    assert NEEDED == pytest.approx(0.223, abs=5e-4)  # tan(25 deg) / 2 = 0.233 for an end without a radius


@compiled
def test_the_house_falls_when_its_cards_get_slippery():
    scene = play(CardHouse(seed=1), source=BotSource(), steps=900)
    assert judge(scene, 900) == {"ok": True, "failures": [], "pending": []}


@compiled
def test_a_coin_knocks_the_house_down():
    scene = play(CardHouse(seed=1), ["", "fire"] + [""] * 200)
    assert not scene.stands(scene.cards)


# --- turned pictures -------------------------------------------------------------------------------------------------


def test_a_picture_turns_by_quarters_without_loss():
    image = pygame.Surface((5, 4), pygame.SRCALPHA, 32)
    for x in range(5):
        for y in range(4):
            image.set_at((x, y), (40 * x + 20, 50 * y + 20, 90, 255))
    turned = RotatedPicture(image)
    assert turned.at(0.0) is image and turned.at(2 * pi) is image
    half = turned.at(pi)
    left, top = (half.get_width() - 5) // 2, (half.get_height() - 4) // 2
    assert all(half.get_at((left + x, top + y)) == image.get_at((4 - x, 3 - y)) for x in range(5) for y in range(4))
    assert {half.get_at((x, y)).a for x in range(half.get_width()) for y in range(half.get_height())} == {0, 255}
