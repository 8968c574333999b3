"""Overlays that show the work of a solver, and the outlines of every kind of shape."""

from itertools import pairwise
from math import cos, hypot, sin

import numpy as np
import pygame
import pytest

from game.input.inputs import InputFrame, InputState
from game.overlays.layer_features import text_of
from game.overlays.layer_impulses import short, step_of
from game.overlays.layer_islands import hull_of
from game.overlays.outlines import corners_of, moved, ring
from game.overlays.stack import Overlays, layer_names
from game.run.digest import scene_digest
from game.run.picture import Picture
from game.scene import Scene
from physics import Capsule, Chain, Circle, Effects, Polygon, Segment, TileGrid, World, debug
from scenes.lab.shape_pictures import difference
from tests.game.plain_scene import Plain

SOLVED = ("contacts", "impulses", "features", "islands", "colors", "centers", "ghosts", "outlines")


class Pile(Plain, Scene):
    """Scene with every kind of shape on a chain, a grid and a segment, and a bullet that flies at a thin wall."""

    name = title = "pile"
    effects = Effects.rigid_bodies().with_(one_way=True)

    def build(self):
        world = self.add_world()
        world.add_body(Chain([(10, 200), (120, 205), (240, 200)]), kind="static")
        world.add_body(TileGrid([[True, False, True]], 16, [[False, True, False]]), position=(250, 200), kind="static")
        world.add_body(Segment((300, 200), (460, 200)), kind="static")
        world.add_body(Polygon.box(1, 60), position=(440, 60), kind="static")
        self.bullet = world.add_body(
            Circle(2.0), position=(20, 60), velocity=(14000.0, 0.0), gravity_scale=0.0, bullet=True
        )
        for x in (60, 180, 320):
            world.add_body(Polygon.box(24, 16), position=(x, 190))
            world.add_body(Capsule((-8, 0), (8, 0), 5.0), position=(x, 176))
            world.add_body(Polygon(Polygon.box(10, 10).points, radius=4.0), position=(x + 2, 160))
            world.add_body(Circle(7.0), Circle(4.0, center=(9, 0)), position=(x - 2, 140))


def stepped(steps):
    scene = Pile(seed=1)
    for _ in range(steps):
        state = InputState()
        state.set(InputFrame())
        scene.step(state)
    return scene


def picture_of(scene, layers):
    overlays = Overlays(layers)
    frame = Picture().draw_scene(scene, overlays)
    return pygame.surfarray.array2d(frame.surface), overlays


@pytest.mark.parametrize("layer", SOLVED)
def test_each_layer_draws_and_only_reads(layer):
    scene = stepped(2 if layer == "ghosts" else 40)
    before = scene_digest(scene)
    plain, _ = picture_of(scene, ())
    shown, overlays = picture_of(scene, (layer,))
    assert scene_digest(scene) == before
    assert (plain != shown).any() and overlays.legend()


def layer_after(scene, name):
    _, overlays = picture_of(scene, (name,))
    return next(each for each in overlays.layers if each.name == name)


def test_contacts_are_counted_by_state():
    scene = stepped(40)
    layer = layer_after(scene, "contacts")
    assert layer.states.sum() == layer.total == len(debug.contact_points(scene.world))
    assert any("persisted" in text for _, text in layer.notes())


def test_what_sleeps_is_distinguished():
    scene = stepped(400)
    assert layer_after(scene, "islands").asleep > 0
    awake = stepped(20)
    assert layer_after(awake, "islands").asleep == 0 < layer_after(awake, "islands").islands


def test_ghosts_stay_for_a_while_and_go():
    scene = stepped(1)
    overlays, picture = Overlays(["ghosts"]), Picture()
    layer = next(each for each in overlays.layers if each.name == "ghosts")
    seen = []
    for _ in range(60):
        scene.step(InputState())
        picture.draw_scene(scene, overlays)
        picture.draw_scene(scene, overlays)  # drawn twice, noted once
        seen.append(sum(len(kept) for kept, _, _ in layer.kept.values()))
    assert max(seen) > 0 and all(later - earlier <= 2 for earlier, later in pairwise(seen))
    scene.world.clear()
    for _ in range(60):
        scene.step(InputState())
        picture.draw_scene(scene, overlays)
    assert sum(len(kept) for kept, _, _ in layer.kept.values()) == 0


def test_every_layer_says_what_it_left_out(monkeypatch):
    for module, name in (
        ("contacts", "CONTACT"),
        ("impulses", "IMPULSE"),
        ("colors", "COLOR"),
        ("centers", "CENTER"),
        ("outlines", "OUTLINE"),
        ("islands", "BODY"),
    ):
        monkeypatch.setattr(f"game.overlays.layer_{module}.{name}_BUDGET", 2)
    scene = stepped(40)
    for name in ("contacts", "impulses", "colors", "centers", "outlines"):
        layer = layer_after(scene, name)
        assert layer.drawn == 2 < layer.total, name
        assert f"2 of {layer.total}" in layer.notes()[0][1], name
    layer = layer_after(scene, "islands")
    assert layer.drawn <= 2 < layer.total


def test_all_layers_on_an_empty_world():
    scene = stepped(3)
    scene.world.clear()
    scene.step(InputState())
    picture_of(scene, layer_names())


def test_a_legend_too_long_for_the_picture_says_so():
    scene = stepped(40)
    frame = Picture(pygame.Surface((480, 150))).draw_scene(scene, Overlays(layer_names()))
    assert any("more lines" in text for _, text in frame.boxes)


@pytest.mark.parametrize(
    "points, radius", [([(3, 4)], 5.0), ([(-6, 0), (8, 2)], 4.0), ([(-9, -5), (9, -5), (9, 5), (-9, 5)], 3.0)]
)
def test_a_ring_is_the_rounded_hull(points, radius):
    corners = ring(points, radius, 4.0)
    for x, y in corners:
        nearest = min(hypot(x - px, y - py) for px, py in on_edges(points))
        assert nearest == pytest.approx(radius, abs=0.02)
    turns = [
        (bx - ax) * (cy - by) - (by - ay) * (cx - bx)
        for (ax, ay), (bx, by), (cx, cy) in zip(
            corners, corners[1:] + corners[:1], corners[2:] + corners[:2], strict=True
        )
    ]
    assert min(turns) >= -1e-9, "convex, clockwise on the screen"


def on_edges(points):
    for (ax, ay), (bx, by) in zip(points, points[1:] + points[:1], strict=True):
        yield from ((ax + (bx - ax) * i / 500, ay + (by - ay) * i / 500) for i in range(501))


def test_outlines_move_with_their_body():
    start, end = (10.0, 20.0, 0.3), (40.0, -5.0, 1.9)

    def place(pose, x, y):
        return (pose[0] + cos(pose[2]) * x - sin(pose[2]) * y, pose[1] + sin(pose[2]) * x + cos(pose[2]) * y)

    for make in (
        lambda pose: ("circle", *place(pose, 3, 4), 2.0),
        lambda pose: ("capsule", *place(pose, -3, 1), *place(pose, 5, 2), 2.0),
        lambda pose: ("rounded", np.array([place(pose, *p) for p in ((0, 0), (8, 0), (4, 6))]), 1.5),
        lambda pose: ("chain", np.array([place(pose, *p) for p in ((0, 0), (8, 1), (9, 6), (20, 7))])),
    ):
        there, _ = corners_of(moved(make(start), start, end), 2.0)
        wanted, _ = corners_of(make(end), 2.0)
        assert np.allclose(there, wanted, atol=0.02)


def test_every_kind_of_outline_is_drawn():
    scene = stepped(1)
    kinds = {outline[0] for outline in debug.outlines(scene.world)}
    assert kinds == {"chain", "tiles", "segment", "polygon", "circle", "capsule", "rounded"}
    assert layer_after(scene, "outlines").drawn == len(scene.world.shapes)


def test_a_hull_holds_what_it_is_drawn_around():
    points = np.random.default_rng(1).normal(size=(300, 2)) * 40.0
    hull = np.array(hull_of(points))
    assert len(hull) == 32 and {tuple(p) for p in hull.tolist()} <= {tuple(p) for p in points.tolist()}


def test_scales_are_round_numbers():
    assert [step_of(v) for v in (0.0, 0.013, 1.0, 3.0, 51.0, 900.0)] == [0.0, 0.02, 1.0, 5.0, 100.0, 1000.0]
    assert [short(v) for v in (5.0, 2000.0, 1e6)] == ["5", "2k", "1M"]
    assert text_of(7) == "7" and text_of(3 * 4096 + 2) == "3:2"


def test_the_difference_of_two_boxes_is_a_box():
    box = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
    found = {tuple(p) for p in difference(box, [(x + 5.0, y) for x, y in box])}
    assert found == {(-7.0, -2.0), (-3.0, -2.0), (-3.0, 2.0), (-7.0, 2.0)}


def test_contacts_persist_in_worlds_that_remember_none():
    """In a world without stacking a contact is drawn as new in its first step and as persisting later."""
    world = World(Effects())
    for x in (0.0, 9.0):
        world.add_body(Circle(5.0), position=(x, 0.0))
    states = []
    for _ in range(3):
        world.step()
        states += debug.contact_points(world)["state"].tolist()
    assert states == [debug.NEW, debug.PERSISTED, debug.PERSISTED]


@pytest.mark.parametrize("size", [(480, 270), (960, 540), (1440, 810)])
def test_invariants_are_shown_whole_and_the_one_under_the_pointer_is_described(size):
    scene, overlays = stepped(8), Overlays(["invariants"])
    overlays.note(scene)
    assert scene.monitor is not None
    for _ in range(6):
        scene.step(InputState())
    frame = Picture(pygame.Surface(size)).draw_scene(scene, overlays)
    layer, texts = overlays.invariants, [text for _, text in frame.boxes]
    assert [status.id for _, status in layer.places] == [f"U{k}" for k in range(1, 12)]
    assert all(frame.rect.contains(place) for place, _ in layer.places)
    assert "U1 finite" in texts and any("hold, 0 broken" in text for text in texts)
    at, order = next((place, status) for place, status in layer.places if status.id == "U9")
    assert layer.message_at(at.center)[1] == order.sentence and "second world" in order.sentence
    overlays.toggle("invariants")
    overlays.note(scene)
    assert scene.monitor is None and all(world.watch is None for world in scene.worlds)


def test_a_broken_invariant_is_shown_with_its_frame():
    scene, overlays = stepped(8), Overlays(["invariants"])
    overlays.note(scene)
    scene.world.watch.before(scene.world)
    scene.world.bodies["vx"][2] = float("nan")
    scene.world.watch.after(scene.world)
    scene.monitor.note(77, scene.worlds)
    frame = Picture().draw_scene(scene, overlays)
    texts = [text for _, text in frame.boxes]
    assert "U1 finite 1" in texts and any(
        text.startswith("frame 77, U1: bodies 2: bodies.vx is not finite") for text in texts
    )
