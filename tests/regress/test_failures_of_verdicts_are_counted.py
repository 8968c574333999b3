"""A comparison of verdicts counts the failures of all steps of a run, including disabled bodies."""

import numpy as np

from game.measure.errors import References
from game.measure.moment import Moment
from physics import Circle, Effects, World


def test_a_body_that_is_put_aside_in_the_first_step_is_told():
    world = World(Effects())
    world.add_body(Circle(5), position=(0.0, 0.0))
    world.add_body(Circle(5), position=(50.0, 0.0))
    world.bodies["vx"][1] = np.nan
    moment = Moment(world.snapshot(), "brute")
    error = References(moment).errors(moment.here)["verdict"]
    assert error.failures == {"disable_body": 1}
