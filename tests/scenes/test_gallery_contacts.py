"""lab/gallery: the pages of gates, bowls, wheels and seams hold at other speeds, positions and sizes, too."""

from dataclasses import replace

import pytest

import physics
from physics import Effects, World
from scenes.lab.gallery.contacts import FALL, PUSH_OUT, ROUND, build_bowl, build_gates, build_wheel
from scenes.lab.gallery.motions import GROUNDS, LAP, build_seams
from scenes.lab.gallery.page import Side
from scenes.lab.gallery.pages import PAGES

needs_speed = pytest.mark.skipif(not physics.JIT, reason="hundreds of steps for each case")


def both(name, build, steps):
    """Step both sides of a page from another start than the page's own. Return (naive side, Hitbox side).

    name: name of the page; build: function that builds the start; steps: number of steps.
    """
    page = replace(next(page for page in PAGES if page.name == name), build=build)
    sides = []
    for way in (page.naive, page.ours):
        settings = dict(way.world)
        effects = page.effects.with_(**dict.fromkeys(way.without, False))
        sides.append(Side(page, way, World(effects, solver=settings.pop("solver", "soft_step"), **settings)))
    for side, other in zip(sides, reversed(sides), strict=True):
        side.begin(other)
    for _ in range(steps):
        for side in sides:
            side.step()
        for side in sides:
            side.measure()
    return sides


@needs_speed
@pytest.mark.parametrize("speed", [90.0, 120.0, 180.0, 240.0, 360.0, 480.0])
def test_a_gate_throws_a_crate_on_the_naive_side_alone(speed):
    """A gate throws a crate on the naive side only.

    Three gates make two rounds. Each meets its crate at another phase of the step.
    """
    naive, ours = both("gate", lambda side: build_gates(side, speed), 2 * ROUND)
    limit = speed + PUSH_OUT + FALL
    assert naive.worst > limit, f"{naive.worst:.0f} px/s"
    assert ours.worst <= limit, f"{ours.worst:.0f} px/s"


@needs_speed
@pytest.mark.parametrize("radius", [8.0, 20.0, 30.0])
@pytest.mark.parametrize("turn", [0.6, 0.7, 0.8, 0.2])
def test_a_disc_in_a_bowl_keeps_its_energy_and_loses_it_on_the_naive_side(radius, turn):
    naive, ours = both("bowl", lambda side: build_bowl(side, radius, turn), 600)
    assert naive.worst > 3.0, f"{naive.worst:.2f} %"
    assert ours.worst <= 1.5 and ours.kept["most"] <= 1.005, f"{ours.worst:.2f} %, {ours.kept['most']:.4f}"


@needs_speed
@pytest.mark.parametrize("angle", [-1.3, 0.4, 0.8, 1.3, 2.0, 2.5])
def test_an_eccentric_wheel_gains_energy_on_the_naive_side_alone(angle):
    naive, ours = both("wheel", lambda side: build_wheel(side, angle), 600)
    assert naive.worst > 2.0, f"{naive.worst:.2f} %"
    assert ours.kept["most"] <= 1.005 and ours.kept["share"] > 0.9, ours.kept


@needs_speed
@pytest.mark.parametrize("speed", [50.0, 60.0, 90.0, 120.0, 150.0])
def test_a_slider_trips_at_a_seam_on_the_naive_side_alone(speed):
    """A slider trips at a seam on the naive side only, in at least one of four laps at different phases of the step."""
    naive, ours = both("seams", lambda side: build_seams(side, (speed,) * len(GROUNDS)), 4 * LAP)
    assert naive.worst > 1.0, f"{naive.worst:.2f} %"
    assert ours.worst <= 0.1 and ours.kept["hop"] < 0.01, f"{ours.worst:.4f} %, {ours.kept['hop']:.4f} px"


@needs_speed
def test_the_simulated_side_is_right_without_its_fault():
    """The naive integrator throws no crate if it removes only a fifth of the overlap in a step.

    Its fault is therefore that it removes too large a share.
    """
    from scenes.lab.gallery.simulated import step_naively

    page = next(page for page in PAGES if page.name == "gate")
    gentle = replace(page.naive, step=lambda side: step_naively(side, side.kept["crates"], 1, 0.2))
    side = Side(page, gentle, World(Effects(rotation=True), solver="projection"))
    side.other = Side(page, page.ours, World(page.effects))
    page.build(side)
    for _ in range(page.steps):
        side.step()
        side.measure()
    assert 0.0 < side.worst <= page.limit, f"{side.worst:.0f} px/s"
