"""Worlds without a narrow phase treat sensors correctly; before the fix they reported sensors as solid bodies.

They also reported sleeping bodies as awake.
"""

import numpy as np
import pytest

from physics import Character, Circle, Effects, PixelMask, Polygon, World

PILES = Effects(narrowphase=False, response=True, stacking=True, sleeping=True, sensors=True)


def test_sensors_push_nobody_without_a_narrow_phase():
    """Without a narrow phase, a plank lifted into a sensor is reported by one sensor event and is not pushed."""
    world = World(PILES)
    world.add_body(Circle(20.0), PixelMask(np.ones((5, 24), bool)), position=(0.0, 32.0))
    zone = world.add_body(Circle(30.0), PixelMask(np.ones((2, 6), bool)), sensor=True)
    world.add_body(Polygon.box(117.0, 2.0), position=(0.0, 29.0))
    told = []
    for _ in range(12):
        world.step()
        assert zone.id not in (*world.contacts["body_a"], *world.events.begin["body_a"], *world.events.begin["body_b"])
        for row in world.events.sensor_begin:
            assert zone.id in (row["body_a"], row["body_b"])
            told.append((int(row["shape_a"]), int(row["shape_b"])))
    assert len(told) == len(set(told)) > 0


@pytest.mark.parametrize("narrowphase", [True, False])
def test_pair_that_falls_asleep_begins_once(narrowphase):
    """A pair that falls asleep has one begin event.

    The pair is a character and a plank on it. The character is awake but wakes no body, so the plank sleeps and is not
    reported again.
    """
    world = World(PILES.with_(narrowphase=narrowphase))
    plank = world.add_body(Polygon.box(172.0, 2.0))
    Character(world, Circle(7.0), (0.0, 0.0))
    began = 0
    for _ in range(60):
        world.step()
        began += len(world.events.begin)
    assert not plank.awake and began == 1
    assert len(world.contacts) == 0 and len(world.sleeping_contacts) == 1
