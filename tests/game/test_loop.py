"""FixedStep, the accumulator of time: it gives whole steps, loses no time and limits the steps of a frame."""

import gc
import weakref

import pytest

from game.run.loop import LONGEST_FRAME, SPEEDS, FixedStep
from game.scene import STEP_SECONDS, set_loaded_aside


def test_first_call_starts_the_clock():
    assert FixedStep().advance(1000.0) == 0


@pytest.mark.parametrize("rate", [30, 60, 144, 1000])
def test_steps_follow_time_at_any_frame_rate(rate):
    clock = FixedStep()
    steps = sum(clock.advance(i / rate) for i in range(10 * rate + 1))
    assert steps == pytest.approx(600, abs=1)
    assert 0.0 <= clock.alpha < 1.0


def test_a_stall_is_clamped():
    clock = FixedStep()
    clock.advance(0.0)
    assert clock.advance(30.0) == int(LONGEST_FRAME / STEP_SECONDS)


def test_time_running_backwards_makes_no_step():
    clock = FixedStep()
    clock.advance(5.0)
    assert clock.advance(4.0) == 0


def test_slow_motion_makes_fewer_steps():
    clock = FixedStep()
    clock.slower()
    steps = sum(clock.advance(i / 60) for i in range(121))
    assert clock.speed == SPEEDS[1] and steps == pytest.approx(60, abs=1)
    clock.faster()
    clock.faster()
    assert clock.speed == 1.0


def test_paused_steps_only_on_request():
    clock = FixedStep()
    clock.advance(0.0)
    clock.paused = True
    assert clock.advance(0.1) == 0
    clock.request_step()
    assert clock.advance(0.2) == 1
    assert clock.advance(0.3) == 0 and clock.alpha == 1.0


def test_game_speed_and_slow_motion_multiply():
    clock = FixedStep()
    clock.game_speed, clock.speed = 0.5, 0.5
    steps = sum(clock.advance(i / 60) for i in range(601))
    assert steps == pytest.approx(150, abs=1)


def test_a_rest_does_not_count():
    clock = FixedStep()
    clock.advance(0.0)
    clock.rest()
    assert clock.advance(100.0) == 0 and clock.advance(100.0 + 1.01 / 60) == 1


@pytest.mark.parametrize("slow", [0.03, 0.1, 0.3, 1.0])
@pytest.mark.parametrize("pictures", [1, 2, 5])
def test_where_the_first_steps_are_slow_there_is_one_a_picture(slow, pictures):
    """While the first steps are slow, each picture gets one step, however fast the pictures before them were."""
    clock, now = FixedStep(), 0.0
    clock.advance(now)
    for _ in range(pictures):
        clock.note(0.001)
    now += slow  # a scene is built
    assert clock.advance(now) == 1
    for _ in range(50):
        clock.note(slow)
        now += slow
        assert clock.advance(now) == 1 and clock.behind


def test_where_steps_are_quick_time_is_kept_from_the_first_second_on():
    clock, steps = FixedStep(), 0
    for frame in range(61):
        steps += clock.advance(frame / 60 + 1e-6)
        clock.note(0.005)
    assert steps >= 59


def test_a_single_long_frame_is_caught_up_with():
    clock, now = FixedStep(), 0.0
    clock.advance(now)
    for busy in [0.005] * 30 + [0.1]:
        now += max(busy, 1.001 / 60)
        clock.advance(now)
        clock.note(busy)
    assert clock.advance(now + 0.1) >= 5


def test_what_is_loaded_is_set_aside_and_a_later_call_still_frees_what_was():
    class Node:
        pass

    first = Node()
    first.itself, gone = first, weakref.ref(first)
    set_loaded_aside()
    assert gc.get_freeze_count() > 1000
    del first
    gc.collect()
    assert gone() is not None  # set aside: a collection does not even look at it
    set_loaded_aside()
    assert gone() is None
    gc.unfreeze()
