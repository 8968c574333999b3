"""The overlay "joints" draws anchors, axes, limits, forces and counts at the positions that geometry gives."""

from math import cos, inf, sin

import numpy as np
import pygame
import pytest

from game.drawing.colors import GREEN, ORANGE, RED, SKY, SLATE, YELLOW, toned
from game.files.accessibility import PALETTES, Accessibility
from game.input.inputs import InputState
from game.overlays.layer_joints import ARC, BAR, anchored
from game.overlays.stack import Overlays
from game.run.digest import scene_digest
from game.run.picture import Picture
from game.scene import Scene
from physics import (
    Angle,
    Circle,
    Distance,
    Effects,
    Gear,
    NoContact,
    Polygon,
    Prismatic,
    Pulley,
    Ratchet,
    Revolute,
    Target,
    Weld,
    Wheel,
)
from tests.game.plain_scene import Plain

JOINTED = Effects.rigid_bodies().with_(joints=True)
SCALE = 3  # frame px per canvas px
WEIGHT = 9.8 * 32.0  # [px/s2] gravity of a default world


class Workshop(Plain, Scene):
    """An empty scene in which each test adds its joints."""

    name = title = "workshop"
    effects = JOINTED

    def build(self):
        self.add_world()

    def stepped(self, count):
        for _ in range(count):
            self.step(InputState())
        return self


def drawn(scene, palette="standard", size=(480 * SCALE, 270 * SCALE)):
    """Return (pixels[x, y, rgb] of the picture, the layer)."""
    scene.set_accessibility(Accessibility(palette=palette))
    overlays = Overlays(["joints"])
    frame = Picture(pygame.Surface(size)).draw_scene(scene, overlays)
    return pygame.surfarray.array3d(frame.surface), next(each for each in overlays.layers if each.name == "joints")


def has(pixels, point, color, reach=1):
    """Return whether the colour is at a world point, or within `reach` frame pixels of it."""
    x, y = (round(SCALE * each) for each in point)
    part = pixels[x - reach : x + reach + 1, y - reach : y + reach + 1]
    return bool((part == np.array(color)).all(axis=-1).any())


def every_kind(scene):
    """Add a joint of each kind between floating bodies."""
    world = scene.world
    world.gravity = (0, 0)
    boxes = [world.add_body(Polygon.box(12, 12), position=(40 + 40 * k, 60 + 30 * (k % 4))) for k in range(11)]
    a, b, c, d, e, f, g, h, i, j, k = boxes
    hinges = [world.add_joint(Revolute(None, each, at=each.position)) for each in (a, b)]
    world.add_joint(Gear(*hinges, ratio=2))
    world.add_joint(Prismatic(None, c, at=c.position, limits=(-9, 9)))
    world.add_joint(Wheel(d, e, at=e.position))
    world.add_joint(Distance(e, f, at_a=e.position, at_b=f.position))
    world.add_joint(Weld(f, g, at=(260, 100)))
    world.add_joint(Angle(g, h, limits=(-1, 1)))
    world.add_joint(NoContact(h, i))
    world.add_joint(Pulley(i, j, at_a=i.position, at_b=j.position, ground_a=(360, 30), ground_b=(400, 30)))
    world.add_joint(Ratchet(None, j, ratchet=0.3))
    world.add_joint(Target(k, at=k.position, point=(450, 130)))
    return scene


@pytest.mark.parametrize("palette", PALETTES)
def test_every_kind_is_drawn_and_nothing_changes(palette):
    scene = every_kind(Workshop(seed=1)).stepped(3)
    before = scene_digest(scene)
    pixels, layer = drawn(scene, palette)
    assert scene_digest(scene) == before
    assert layer.drawn == layer.total == len(scene.world.joints) == 12
    for color in (SKY, GREEN, YELLOW):
        assert (pixels == np.array(toned(color, palette))).all(axis=-1).any(), color


@pytest.mark.parametrize("turn", [k * 0.7 for k in range(9)])
@pytest.mark.parametrize("limits", [(-0.4, 0.9), (0.3, 2.0), (-2.8, 2.8), (None, 0.6), (-1.1, None)])
def test_the_arc_of_a_hinge_turns_with_its_first_body(turn, limits):
    scene, at = Workshop(seed=1), (240.0, 120.0)
    scene.world.gravity = (0, 0)
    frame = scene.world.add_body(Circle(5), position=at, angle=turn, kind="kinematic")
    arm = scene.world.add_body(Polygon.box(40, 4), position=at, angle=turn + 0.2)
    scene.world.add_joint(Revolute(frame, arm, at=at, limits=limits))
    pixels, _ = drawn(scene.stepped(1))
    zero = turn + 0.2  # the direction of angle 0: the reference of the joint, turned with A
    for limit in limits:
        if limit is not None:
            end = at[0] + 0.85 * ARC * cos(zero + limit), at[1] + 0.85 * ARC * sin(zero + limit)
            assert has(pixels, end, YELLOW), limit
    if None not in limits:
        middle = zero + 0.5 * (limits[0] + limits[1])
        on_arc, opposite = [(at[0] + way * ARC * cos(middle), at[1] + way * ARC * sin(middle)) for way in (1, -1)]
        assert has(pixels, on_arc, YELLOW, 2)
        assert not has(pixels, opposite, YELLOW, 2)


@pytest.mark.parametrize("turn", [k * 0.8 for k in range(8)])
@pytest.mark.parametrize("limits", [(-30.0, 20.0), (-8.0, 45.0), (-12.0, None)])
def test_the_axis_of_a_slider_reaches_from_limit_to_limit(turn, limits):
    scene, at = Workshop(seed=1), (240.0, 120.0)
    scene.world.gravity = (0, 0)
    axis = cos(turn), sin(turn)
    box = scene.world.add_body(Polygon.box(10, 10), position=at)
    scene.world.add_joint(Prismatic(None, box, at=at, axis=axis, limits=limits))
    pixels, layer = drawn(scene.stepped(1))
    for limit in limits:
        if limit is not None:
            end = at[0] + axis[0] * limit, at[1] + axis[1] * limit
            assert has(pixels, end, YELLOW), limit
            beyond = at[0] + axis[0] * (limit * 1.3), at[1] + axis[1] * (limit * 1.3)
            assert not has(pixels, beyond, YELLOW), limit
    assert any(text == "0.0" for text, *_ in layer.labels)


@pytest.mark.parametrize("share", [0.1, 0.25, 0.5, 0.75, 0.79, 0.81, 0.95])
def test_the_bar_is_the_share_of_the_breaking_force(share):
    scene = Workshop(seed=1)
    box = scene.world.add_body(Polygon.box(20, 20), position=(240, 120))
    joint = scene.world.add_joint(Weld(None, box, at=(240, 120)))
    scene.stepped(30)
    joint.breaks = (joint.force / share, None)
    assert joint.force == pytest.approx(box.mass * WEIGHT, rel=1e-3)
    pixels, layer = drawn(scene)
    color, other = (RED, ORANGE) if share >= 0.8 else (ORANGE, RED)
    x0, y0 = (240 - BAR[0] / 2) * SCALE, (120 - 5 - BAR[1]) * SCALE
    bar = pixels[round(x0) : round(x0 + BAR[0] * SCALE), round(y0 + BAR[1] * SCALE / 2)]
    assert (bar == np.array(color)).all(axis=-1).sum() == pytest.approx(BAR[0] * SCALE * share, abs=1.0)
    assert not (bar == np.array(other)).all(axis=-1).any()
    assert (f"{100 * share:.0f} %",) in [text[:1] for text in layer.labels] and layer.breakable == 1


def test_sleepers_are_grey_and_have_no_force():
    scene = Workshop(seed=1)
    scene.world.add_body(Polygon.box(400, 20), position=(240, 200), kind="static")
    pair = [scene.world.add_body(Polygon.box(20, 20), position=(x, 180)) for x in (230, 250)]
    scene.world.add_joint(Weld(*pair, at=(240, 180)))
    awake = drawn(scene.stepped(5))[1]
    assert awake.asleep == 0
    pixels, layer = drawn(scene.stepped(300))
    assert not pair[0].awake and layer.asleep == 1
    assert has(pixels, (240, 180), SLATE) and not has(pixels, (240, 180), GREEN, 6)
    scene.world.joint(0).enabled = False
    assert drawn(scene.stepped(5))[1].asleep == 1


@pytest.mark.parametrize("tier", ["iterative", "direct"])
def test_the_tiers_have_their_colours(tier):
    scene = Workshop(seed=1)
    scene.world.joint_solver = tier
    balls = [scene.world.add_body(Circle(6), position=(200 + 20 * k, 60)) for k in range(4)]
    for first, second in zip([None, *balls], balls, strict=False):
        scene.world.add_joint(Revolute(first, second, at=(second.position[0] - 10, 60)))
    scene.stepped(10)
    pixels, layer = drawn(scene)
    assert layer.direct == (4 if tier == "direct" else 0)
    color, other = (GREEN, SKY) if tier == "direct" else (SKY, GREEN)
    at = scene.world.joint(0).anchor_b
    assert has(pixels, at, color) and not has(pixels, at, other, 3)
    assert any(text.endswith(f"{layer.direct} direct") for _, text in layer.notes())


def test_a_budget_is_never_silent(monkeypatch):
    monkeypatch.setattr("game.overlays.layer_joints.JOINT_BUDGET", 3)
    layer = drawn(every_kind(Workshop(seed=1)).stepped(2))[1]
    assert layer.drawn == 3 and layer.notes()[0][1].startswith("joints 3 of 12")


@pytest.mark.parametrize("place", [(-900, 0), (900, 0), (0, 900), (0, -900)])
def test_joints_outside_the_view_are_not_drawn(place):
    scene = every_kind(Workshop(seed=1))
    scene.camera.place(*place)
    assert drawn(scene)[1].drawn == 0


def test_a_world_without_the_effect_is_told_so():
    class Bare(Workshop):
        """The scene Workshop without the effect of joints."""

        effects = Effects.rigid_bodies()

    _, layer = drawn(Bare(seed=1))
    assert layer.notes() == [layer.notes()[0]] and "not declared" in layer.notes()[0][1]


def test_joints_without_anchors_are_at_their_bodies():
    scene = every_kind(Workshop(seed=1))
    rows, world = anchored(scene.world), scene.world
    for row in rows:
        assert np.isfinite([row["ax"], row["ay"], row["bx"], row["by"]]).all()
        if row["hold"] == 0 and row["coordinate"] != 3:  # an Angle, a NoContact
            assert (row["ax"], row["ay"]) == world.body(int(row["body_a"])).center
            assert (row["bx"], row["by"]) == world.body(int(row["body_b"])).center
        if row["lower"] > -inf and row["body_a"] == -1 and row["hold"] == 3:  # a Ratchet of the world
            assert (row["ax"], row["ay"]) == (row["bx"], row["by"]) == world.body(int(row["body_b"])).center
