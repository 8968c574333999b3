"""The contact inspector: a click on a contact of a paused scene shows its pair through all stages, with correct
numbers.
"""

import numpy as np
import pygame
import pytest

from game.drawing.number_text import amount_text
from game.measure.contact_inspector import Touch, cost_of, explain, nearest, still_there
from game.run.session import Session
from game.run.sources import BotSource
from game.screens.play import Play
from physics import BROADPHASES, JIT, Circle, Effects, Filter, Material, PixelMask, Polygon, World
from scenes import SCENES
from tests.lockstep import make_scene


def pile(**effects):
    given = {"response": True, "gravity": True, "friction": True, "stacking": True, **effects}
    world = World(Effects(**given), gravity=(0.0, 320.0), substeps=4)
    rough = Material(friction=0.5)
    world.add_body(Polygon.box(80, 8), position=(0.0, 20.0), kind="static", material=rough)
    world.add_body(Polygon.box(8, 8), position=(0.0, 12.0), material=rough, filter=Filter(2, 0xFF))
    return world


def said(world, touch):
    return {part.stage: part.text for part in explain(world, touch)}


def test_the_way_of_a_box_at_rest_on_the_ground():
    world = pile()
    for _ in range(90):
        world.step()
    touch = nearest(world, 4.0, 16.0, 2.0)
    assert touch is not None and (touch.body_a, touch.body_b) == (0, 1) and touch.x == pytest.approx(4.0, abs=0.5)
    reported = said(world, touch)
    assert list(reported) == [
        "broad phase, hash",
        "filter",
        "narrow phase",
        "warm start",
        "solver, soft step, 4 substeps",
    ]
    assert "pair 1 of 1" in reported["broad phase, hash"]
    expected = (
        "A is in all categories, B meets categories 1, 2, 3, 4, 5, 6, 7, 8; B is in category 2, A meets all categories"
    )
    assert reported["filter"] == f"{expected}: they may meet"
    depth = -float(world.contacts["separation"].min())
    assert "2 points" in reported["narrow phase"] and "normal at -90 deg" in reported["narrow phase"]
    assert any(f"{abs(d):.3f} px" in reported["narrow phase"] for d in world.contacts["separation"]), depth
    assert "2 of 2 points known" in reported["warm start"]
    normal = float(world.contacts["normal_impulse"].sum())
    assert f"pushed by {amount_text(normal)} mass px/s along" in reported["solver, soft step, 4 substeps"]
    mass = world.body(1).mass
    assert normal == pytest.approx(mass * 320.0 / 60.0, rel=0.02), "what it bears in a step is its weight"


def test_what_has_just_come_is_new_and_what_is_not_declared_is_not_reported():
    world = World(Effects())
    world.add_body(PixelMask(np.ones((6, 6), bool)), kind="static")
    world.add_body(Circle(4.0), position=(6.0, 0.0))
    world.step()
    touch = nearest(world, 3.0, 0.0, 5.0)
    assert list(said(world, touch)) == ["broad phase, hash", "filter", "narrow phase"]
    fresh = pile()
    fresh.step()
    assert "all is new" in said(fresh, nearest(fresh, 0.0, 16.0, 6.0))["warm start"]


def test_who_is_out_of_reach_or_gone_is_not_explained():
    world = pile()
    world.step()
    assert nearest(world, 0.0, -50.0, 5.0) is None
    touch = nearest(world, 0.0, 16.0, 6.0)
    world.body(1).position = (0.0, -500.0)
    world.step()
    assert not still_there(world, touch)
    with pytest.raises(ValueError, match="a pair that touches"):
        explain(world, touch)
    assert nearest(World(Effects()), 0.0, 0.0, 5.0) is None


@pytest.mark.parametrize("name", BROADPHASES)
def test_every_strategy_can_be_asked(name):
    world = World(Effects(), BROADPHASES[name]())
    world.add_bodies(Circle(4.0), [(0.0, 0.0), (6.0, 0.0), (100.0, 0.0)])
    for _ in range(3):
        world.step()
        reported = said(world, nearest(world, 3.0, 0.0, 5.0))
        assert "pair 1 of 1" in reported[f"broad phase, {name}"]


def test_the_pair_alone_is_timed_on_a_thousand_of_it():
    world = pile()
    world.step()
    cost = cost_of(world, nearest(world, 0.0, 16.0, 6.0))
    assert cost.pieces >= 1000 and 0.0 < cost.least <= cost.median


@pytest.fixture
def frozen(drive):
    driver = drive(listing=SCENES)
    driver.app.screens.play("lab/pyramid")
    driver.turns(60 if JIT else 8)
    driver.key(pygame.K_p)
    play = driver.screen
    assert isinstance(play, Play) and play.clock.paused
    play.hint = None
    driver.turns(2)
    yield driver, play
    play.close()


def words(driver):
    return " ".join(text for _, text in driver.app.arcade.picture.presenter.frame.boxes)


def place_of_a_contact(play):
    world, lens = play.inspector.lenses[0]
    contact = world.contacts[len(world.contacts) // 2]
    x, y = lens.points(float(contact["point_x"]), float(contact["point_y"]))
    return round(x), round(y)


def test_a_click_on_a_contact_opens_its_card_and_another_one_closes_it(frozen):
    driver, play = frozen
    driver.post(pygame.MOUSEBUTTONDOWN, pos=place_of_a_contact(play), button=1)
    driver.turns(2)
    reported = words(driver)
    assert (
        "touch?" in reported
        and "narrow phase" in reported
        and "this pair alone" in reported
        and "warm start" in reported
    )
    frame = driver.app.arcade.picture.presenter.frame
    driver.post(pygame.MOUSEBUTTONDOWN, pos=(frame.area.x + 2, frame.area.y + 2), button=1)
    driver.turns(2)
    assert "touch?" not in words(driver)


def test_it_goes_when_time_goes_on(frozen):
    driver, play = frozen
    driver.post(pygame.MOUSEBUTTONDOWN, pos=place_of_a_contact(play), button=1)
    driver.turns(2)
    assert play.inspector.chosen is not None
    driver.key(pygame.K_p)
    driver.turns(2)
    assert play.inspector.chosen is None and "touch?" not in words(driver)


def test_a_running_scene_is_not_asked(frozen):
    driver, play = frozen
    driver.key(pygame.K_p)
    driver.turns(2)
    driver.post(pygame.MOUSEBUTTONDOWN, pos=place_of_a_contact(play), button=1)
    driver.turns(2)
    assert play.inspector.chosen is None


def test_a_mask_that_rests_by_its_parts_is_explained():
    """The inspector explains a contact of a mask that rests on its outline parts.

    The mask and the parts by which it touches have different ids. Such a contact once ended the program.
    """
    world = World(Effects.rigid_bodies(), gravity=(0.0, 320.0))
    table = np.ones((12, 40), bool)
    table[4:, 5:35] = False  # on two legs
    world.add_body(Polygon.box(80, 8), position=(0.0, 20.0), kind="static")
    world.add_body(PixelMask.from_array(table), position=(0.0, 10.0))
    for _ in range(20):
        world.step()
    assert len(world.contacts) >= 2 and not (world.contacts["shape_b"] == world.reported_rows()["shape_b"][0]).any()
    touch = nearest(world, 18.0, 16.0, 6.0)
    reported = said(world, touch)
    assert "pair 1 of 1" in reported["broad phase, hash"] and "4 points" in reported["narrow phase"]
    assert still_there(world, touch) and cost_of(world, touch).least > 0.0


@pytest.mark.parametrize("name", ["lander", "lab/mask_stack", "lab/carving", "lab/mask_sweep", "lab/effects"])
def test_every_contact_of_the_scenes_with_masks_is_explained(name):
    session, asked = Session(make_scene(name), BotSource()), 0
    for frame in range(120):
        session.step()
        for world, _ in session.scene.views() if frame % 20 == 19 else ():
            for row in world.contacts[["body_a", "body_b", "shape_a", "shape_b"]].tolist():
                assert explain(world, Touch(*row, 0.0, 0.0))
                asked += 1
    assert asked
