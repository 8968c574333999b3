"""The step inspector shows the results of each stage for joints, in words and as overlays, and its card fits."""

import pygame
import pytest

from game.drawing.colors import RED
from game.drawing.number_text import percent_text
from game.measure.joint_results import COLUMNS, joint_results
from game.run.digest import scene_digest
from game.run.picture import Picture
from game.run.sources import BotSource, ScriptSource
from game.run.step_inspector import TABLES, photographed
from game.screens.parts.step_inspector_view import compact
from physics import JIT, Circle, Effects, Polygon, Revolute, Weld, World
from physics.tables.joint import SCRATCH
from tests.game.reading import assert_text_is_apart
from tests.game.test_joint_inspector import MACHINES, SOLVERS, TIERS, bare_numbers, click, flown, jointed, words
from tests.game.test_layer_joints import has
from tests.game.test_step_inspector import key, screen
from tests.lockstep import make_scene

__all__ = ["flown"]  # a fixture
COUNTED = "direct iterative not at of motor".split()  # words after a number of joints or motors
SIZES = [(480, 270), (640, 360), (960, 540), (1280, 720), (1440, 810), (1100, 900)]


def inspected(machine=0, tier=0, frames=40 if JIT else 3, smash=False):
    """Return a Play of lab/joints that inspects the next step of a machine. smash: whether joints break in it."""
    scene = make_scene("lab/joints")
    scene.change("slider:machine", machine)
    scene.change("slider:joints", tier)
    play = screen(scene, ScriptSource([]), frames)
    for each in scene.machines if smash else ():
        each.smash()
    key(play, pygame.K_e)
    return play


def go(play, stage):
    """Move the inspection to the state after a stage, and return its Done."""
    step = play.step_inspector.step
    step.go([each.stage for each in step.stages].index(stage) + 1)
    return step.done


def test_the_columns_of_joints_are_all_but_scratch():
    names = set(World(Effects.rigid_bodies().with_(joints=True)).joints.dtype.names)
    assert set(COLUMNS) < names and not set(COLUMNS) & {name for name, _ in SCRATCH} and "joints" in TABLES


@pytest.mark.parametrize("share, text", [
    (0.0, "0 %"), (0.001, "less than 1 %"), (0.25, "25 %"), (1.0, "100 %"), (10.0, "1000 %"), (1e6, "over 1,000 %"),
])  # fmt: skip
def test_shares_in_percent(share, text):
    assert percent_text(share) == text


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("tier", TIERS)
def test_the_solver_counts_its_tiers_forces_limits_and_motors(tier, solver):
    world = jointed(solver, tier).world
    rows = world.joints
    text = joint_results(world, rows, rows, solver).solved
    direct = int((rows["awake"] & rows["direct"]).sum())
    iterative = int((rows["awake"] & ~rows["direct"]).sum())
    assert (f"{direct} direct" in text) == (direct > 0) == (tier != "iterative")
    assert f"{iterative} iterative" in text and "1 not solved" in text, "the NoContact"
    force = (rows["force_x"] ** 2 + rows["force_y"] ** 2) ** 0.5
    assert f"(joint {rows['id'][force.argmax()]})" in text and "what breaks it" not in text
    world.joint(0).breaks = (1e12, None)
    assert "less than 1 % of what breaks it (joint 0)" in joint_results(world, rows, rows, solver).solved
    for stage in (solver, "joints"):
        found = bare_numbers(str(joint_results(world, rows, rows, stage)))
        assert all(each.split()[-1] in COUNTED for each in found), found
    assert str(joint_results(world, rows, rows, "narrow_phase")) == ""


@pytest.mark.parametrize("tier", TIERS)
@pytest.mark.parametrize("stage", ["soft_step", "joints"])
def test_the_card_has_the_results_and_the_picture_the_overlay(stage, tier):
    play = inspected(5, TIERS.index(tier))
    done = go(play, stage)
    reported = words(play.draw(Picture(pygame.Surface((960, 540)))))
    assert done.joints.split()[0] in reported and "joints 12 of 12" in reported, "the legend of the overlay"
    assert any(table == "joints" for table, *_ in done.changed)
    assert "joints" not in play.overlays.on
    if stage == "joints":
        assert "widest gap" in done.joints and "none broken" in done.joints
        assert {"angle", "speed"} <= {name for table, _, names in done.changed for name in names if table == "joints"}
    else:
        tiers = "12 iterative" if tier == "iterative" else "12 direct"
        assert tiers in done.joints and "of 1 motor at its maximum" in done.joints
    play.close()


@pytest.mark.parametrize("tier", TIERS)
@pytest.mark.parametrize("machine, broken", [(1, 3), (5, 1)])
def test_broken_joints_are_named_and_crossed_before_they_are_removed(machine, broken, tier):
    play = inspected(machine, TIERS.index(tier), 40, smash=True)
    assert "of what breaks it" in go(play, "soft_step").joints
    done = go(play, "joints")
    world, rows = play.step_inspector.step.world, play.step_inspector.step.world.joints
    assert rows["broken"].sum() == broken
    ids = ", ".join(str(each) for each in rows["id"][rows["broken"]])
    assert f"{broken} broken, removed after the step: {ids}" in done.joints
    frame = play.draw(Picture(pygame.Surface((1440, 810))))
    pixels = pygame.surfarray.array3d(frame.surface)
    for joint in rows["id"][rows["broken"]]:
        at = play.scene.camera.to_canvas(*world.joint(int(joint)).anchor_b, 1.0)
        assert has(pixels, at, RED, 8)
    play.close()


def test_a_world_without_joints_has_no_line_and_no_overlay_of_them():
    play = screen(make_scene("lab/pyramid"), BotSource(), 5)
    key(play, pygame.K_e)
    assert go(play, "soft_step").joints == ""
    reported = words(play.draw(Picture(pygame.Surface((960, 540)))))
    assert "no joints" not in reported and "impulses" in reported
    play.close()


def test_joints_that_fall_asleep_are_counted():
    world = World(Effects.rigid_bodies().with_(joints=True), gravity=(0.0, 320.0))
    world.add_body(Polygon.box(400, 20), position=(0, 20), kind="static")
    pair = [world.add_body(Polygon.box(20, 20), position=(x, 0)) for x in (-10, 10)]
    world.add_joint(Weld(*pair, at=(0, 0)))
    before = world.joints.copy()
    for _ in range(300):
        before = world.joints.copy()
        world.step()
        if not world.joints["awake"].any():
            break
    assert joint_results(world, before, world.joints, "rest").asleep == "1 joint fell asleep"
    assert str(joint_results(world, world.joints, world.joints, "rest")) == ""


@pytest.mark.parametrize("columns, text", [
    ([], ""),
    (["x", "y", "angle", "vx"], "x y angle vx"),
    (["center_x", "center_y", "torque"], "center_x/y torque"),
    (["previous_x", "mass", "previous_y", "previous_angle"], "previous_x/y/angle mass"),
    (["normal_impulse_1", "normal_impulse_2"], "normal_impulse_1/2"),
])  # fmt: skip
def test_columns_of_one_quantity_share_its_name(columns, text):
    assert compact(columns) == text


def test_a_joint_can_be_asked_between_two_stages():
    play = inspected(0, 1)
    play.step_inspector.leave()
    before = scene_digest(play.scene)
    key(play, pygame.K_e)
    go(play, "soft_step")
    picture = Picture(pygame.Surface((960, 540)))
    play.draw(picture)
    assert click(play, 3)
    assert "Revolute 3" in words(play.draw(picture))
    key(play, pygame.K_e)
    assert not play.step_inspector.open and scene_digest(play.scene) == before
    play.close()


def assert_cards_fit(play, size):
    """Assert that the card of each stage is above the strip, in the picture, and overlaps no other text."""
    step = play.step_inspector.step
    for place in range(len(step.stages) + 1):
        step.go(place)
        frame = play.draw(Picture(pygame.Surface(size)))
        inside = frame.area.clip(frame.rect)
        assert_text_is_apart(frame.boxes, frame.rect)
        card = frame.fixed[-1]
        assert inside.contains(card) and card.bottom <= play.step_inspector.names[0][0].top
        text = " ".join(text for box, text in frame.boxes if card.contains(box))
        assert step.done is None or all(word in text for word in step.done.joints.split())


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("machine", range(MACHINES))
def test_the_cards_of_the_lab_fit_at_any_size(machine, size):
    play = inspected(machine, machine % len(TIERS), smash=True)
    assert_cards_fit(play, size)
    play.close()


@pytest.mark.skipif(not JIT, reason="900 steps of the lander")
@pytest.mark.parametrize("size", SIZES)
def test_the_cards_of_the_lander_with_its_line_fit_at_any_size(flown, size):  # noqa: F811
    play = screen(flown, BotSource(), 0)
    key(play, pygame.K_e)
    assert_cards_fit(play, size)
    assert "9 direct" in go(play, "soft_step").joints
    play.close()


def test_photographs_contain_the_joints():
    world = World(Effects.rigid_bodies().with_(joints=True))
    ball = world.add_body(Circle(5))
    world.add_joint(Revolute(None, ball, at=(0, 0)))
    taken = photographed(world)["joints"]
    world.step()
    assert len(taken) == 1 and not taken["awake"][0] and world.joints["awake"][0]
