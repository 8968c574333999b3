"""A snapshot of a sleeping world is measured asleep, as long as no other solver is chosen.

Before the fix the world's own solver was set again, which woke all bodies.
"""

from game.measure.moment import Moment
from physics import Effects, Polygon, World


def test_a_moment_of_what_sleeps_is_measured_asleep():
    world = World(Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True, sleeping=True))
    world.add_body(Polygon.box(200.0, 20.0), position=(0.0, 10.0), kind="static")
    crate = world.add_body(Polygon.box(20.0, 20.0), position=(0.0, -10.0))
    for _ in range(60):
        world.step()
    assert not crate.awake
    moment = Moment(world.snapshot(), world.broadphase.name)
    other = moment.here._replace(solver="sequential_impulse")
    for setting, wakes in ((moment.here, False), (moment.here._replace(broadphase="brute"), False), (other, True)):
        again = moment.world(setting)
        assert again.solver == setting.solver and again.substeps == setting.substeps
        again.step()
        assert again.body(crate.id).awake == wakes, setting
