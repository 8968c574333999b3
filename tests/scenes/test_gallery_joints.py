"""lab/gallery: the pages of joints hold at other angles, masses, speeds and loads, too."""

from math import degrees

import numpy as np
import pytest

from physics import Effects, World
from scenes.lab.gallery import joints
from scenes.lab.gallery.joints import LONG, PLANKS, SPAN, hanging
from scenes.lab.gallery.page import MM, Side
from scenes.lab.gallery.pages import PAGES
from scenes.lab.machines.doll import Doll
from tests.scenes.test_gallery_contacts import both, needs_speed
from tests.stability.jointed import Gaps

JOINTED = [page for page in PAGES if page.effects.joints]


def test_both_sides_of_a_page_of_joints_differ_in_the_solver_of_joints_alone():
    assert len(JOINTED) == 4
    for page in JOINTED:
        assert page.naive.world == page.ours.world == {"substeps": 4}
        for way in (page.naive, page.ours):
            side = Side(page, way, World(page.effects, **way.world))
            side.begin(side)
            assert side.world.joint_solver == way.joint_solver
        assert (page.naive.joint_solver, page.ours.joint_solver) == ("iterative", "direct")


@needs_speed
@pytest.mark.parametrize("ratio", [300.0, 1000.0, 3000.0])
@pytest.mark.parametrize("angle", [0.0, 0.3, 0.8, 1.2])
def test_a_chain_is_torn_apart_on_the_iterative_side_alone(angle, ratio):
    naive, ours = both("chain", lambda side: joints.build_chain(side, angle, ratio), 300)
    assert naive.worst > 0.2 * ratio, f"{naive.worst:.0f} mm"
    assert ours.worst <= 20.0, f"{ours.worst:.3f} mm"


@needs_speed
@pytest.mark.parametrize("angle", [-1.2, -0.6, 0.0, 0.5, 1.2])
def test_a_cantilever_sags_on_the_iterative_side_alone(angle):
    naive, ours = both("cantilever", lambda side: joints.build_cantilever(side, angle), 300)
    assert naive.worst > 400.0, f"{naive.worst:.0f} mm"
    assert ours.worst <= 1e-6, f"{ours.worst} mm"


@needs_speed
@pytest.mark.parametrize("speed", [60.0, 90.0, 120.0, 160.0, 190.0, 220.0, 250.0])
def test_a_doll_comes_apart_on_the_iterative_side_alone(speed):
    naive, ours = both("stairs", lambda side: joints.build_doll(side, speed), 300)
    assert naive.worst > 12.0, f"{naive.worst:.1f} mm"
    assert ours.worst <= 10.0 and degrees(ours.kept["doll"].excess) < 3.0, f"{ours.worst:.1f} mm"
    assert all(good is False for *_, good, _ in naive.marks)


@needs_speed
@pytest.mark.parametrize("strongest", [80.0, 110.0, 150.0, 180.0])
def test_a_bridge_breaks_at_its_load_on_the_direct_side_alone(strongest):
    naive, ours = both("bridge", lambda side: joints.build_bridge(side, strongest), 480)
    assert naive.worst > 10.0, f"{naive.worst:.1f} %"
    assert ours.kept["broken"] and ours.worst <= 2.0, f"{ours.worst:.2f} %"
    assert "broke at" in joints.load_text(ours)


@pytest.mark.parametrize("load", [0.0, 1.0, 50.0, 1000.0])
def test_each_plank_of_the_bridge_is_in_equilibrium_as_it_hangs(load):
    """Each plank of the hanging bridge is in equilibrium.

    About its left end, the moments of its weight and of the forces at its right end cancel.
    """
    turns, pull = hanging(load)
    assert len(turns) == PLANKS // 2 and (np.diff(turns) < 0.0).all() and turns[-1] > 0.0
    assert 2.0 * LONG * np.cos(turns).sum() == pytest.approx(SPAN)
    upright = 0.5 * (PLANKS + load)
    level = (pull**2 - upright**2) ** 0.5
    for number, turn in enumerate(turns, 1):
        right = upright - number  # vertical force at its right end
        moment = right * np.cos(turn) + 0.5 * np.cos(turn) - level * np.sin(turn)
        assert moment == pytest.approx(0.0, abs=1e-9 * pull)


def test_the_error_of_the_bridge_begins_when_it_holds_too_much_and_stays_when_it_is_broken():
    page = next(page for page in PAGES if page.name == "bridge")
    side = Side(page, page.ours, World(page.effects, **page.ours.world))
    side.begin(side)
    for load, broken, error in ((100.0, False, 0.0), (165.0, False, 10.0), (165.0, True, 10.0), (135.0, True, 10.0)):
        side.kept.update(load=load, broken=broken)
        assert page.error(side) == pytest.approx(error)


@needs_speed
def test_the_gap_of_a_doll_is_that_of_its_poses():
    page = next(page for page in PAGES if page.name == "stairs")
    side = Side(page, page.naive, World(page.effects, **page.naive.world))
    side.begin(side)
    poses = Gaps(side.world)
    for _ in range(120):
        side.step()
        side.measure()
        assert side.now == pytest.approx(MM * poses.worst(), abs=1e-9)


def test_a_caller_that_steps_the_world_itself_measures_a_machine_alike():
    effects = Effects.rigid_bodies().with_(joints=True)
    one, other = Doll(World(effects)), Doll(World(effects))
    for _ in range(5):
        one.step()
        other.control()
        other.world.step()
        other.note()
    assert (one.steps, one.worst, one.figures()) == (other.steps, other.worst, other.figures())
