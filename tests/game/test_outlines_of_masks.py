"""Outlines of masks as overlays draw them: on the pixel edges, with the seams between parts in another style."""

from math import cos, pi, sin

import numpy as np
import pygame
import pytest

from game.drawing.sprites import load_atlas
from game.input.inputs import InputState
from game.overlays.layer_masks import BLOCK, SEAM
from game.overlays.mask_edges import mask_edges
from game.overlays.stack import Overlays, layer_names
from game.run.digest import scene_digest
from game.run.picture import Picture
from game.scene import Scene
from physics import Effects, PixelMask, Polygon, World, debug
from physics.tables.shape import PART, POLYGON
from tests.game.plain_scene import Plain

POSES = ((80.0, 60.0, 0.0), (200.3, 90.7, 0.8), (330.5, 60.2, 4.0))
SPRITES = (
    ("lab", "bracket_teal"),
    ("lab", "star_gold"),
    ("lab", "disc_large"),
    ("hero", "idle_0"),
    ("planes", "dart_0"),
)
NEAR = 0.71 + 0.01  # [px] greatest distance of an edge from the pixels': smooth + 0.21, plus rounding


def turned(points, pose):
    """Return world points converted to the body space of a pose."""
    x, y, angle = pose
    dx, dy = points[:, 0] - x, points[:, 1] - y
    return np.column_stack((cos(angle) * dx + sin(angle) * dy, cos(angle) * dy - sin(angle) * dx))


def is_solid(mask, points):
    """Return whether each point in body space lies in a solid pixel, from the mask's pixels only."""
    column = np.floor(points[:, 0] + mask.origin[0]).astype(int)
    row = np.floor(points[:, 1] + mask.origin[1]).astype(int)
    width, height = mask.size
    inside = (column >= 0) & (row >= 0) & (column < width) & (row < height)
    return inside & mask.solid[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)]


def around(mask, points, reach):
    """Return (any solid, all solid) of the pixels at each point and at distance `reach` from it
    in sixteen directions.
    """
    looks = [is_solid(mask, points)]
    for k in range(16):
        looks.append(is_solid(mask, points + reach * np.array((cos(k * pi / 8), sin(k * pi / 8)))))
    return np.any(looks, axis=0), np.all(looks, axis=0)


@pytest.mark.parametrize("sprite", SPRITES)
@pytest.mark.parametrize("pose", POSES)
def test_outer_lines_lie_on_the_edge_of_the_pixels_and_seams_inside(sprite, pose):
    mask = PixelMask.from_surface(load_atlas(sprite[0])[sprite[1]])
    world = World(Effects.rigid_bodies())
    world.add_body(mask, position=pose[:2], angle=pose[2])
    outer, inner = mask_edges(world, np.arange(len(world.shapes)), 3.0)
    middles = turned((outer[:, :2] + outer[:, 2:]) / 2.0, pose)
    touched, buried = around(mask, middles, NEAR + 0.1)
    assert len(outer) >= 8 and touched.all() and not buried.any()
    assert len(mask.outline) == 1 or len(inner), "a sprite in parts has seams"
    if len(inner):
        assert around(mask, turned((inner[:, :2] + inner[:, 2:]) / 2.0, pose), NEAR + 0.1)[0].all()


def test_parts_have_their_own_edges_and_meet_at_the_seam():
    solid = np.zeros((20, 20), bool)
    solid[:, :8] = solid[12:, :] = True
    world = World(Effects.rigid_bodies())
    world.add_body(Polygon.box(10, 10), position=(90, 0))
    world.add_body(PixelMask.from_array(solid, smooth=0.0), position=(40, 30))
    rows = np.flatnonzero((world.shapes["role"] == PART) & (world.shapes["kind"] == POLYGON))
    edges = debug.part_edges(world)
    assert len(rows) == 2 and set(edges["row"]) == set(rows.tolist())
    assert debug.part_edges(world, rows[:1])["row"].tolist() == [rows[0]] * int((edges["row"] == rows[0]).sum())
    lengths = np.hypot(edges["bx"] - edges["ax"], edges["by"] - edges["ay"])
    assert edges["inner"].sum() == 2, "one edge of each of the two parts"
    assert np.ptp(lengths[edges["inner"]]) < 1e-9
    assert lengths[~edges["inner"]].sum() == pytest.approx(80.0), "once around the L"
    for part in rows:
        mine = edges[edges["row"] == part]
        assert np.allclose(np.roll(mine["ax"], -1), mine["bx"]) and np.allclose(np.roll(mine["ay"], -1), mine["by"])


def test_worlds_without_response_have_no_outlines():
    world = World(Effects())
    world.add_body(PixelMask.from_array(np.ones((4, 6), bool)))
    assert len(debug.part_edges(world)) == 0
    assert [len(each) for each in mask_edges(world, np.arange(1))] == [0, 0]


def test_masks_are_shown_where_they_are_where_bodies_are_pushed():
    """In a world with response, a mask is drawn and hit at its pose.

    Such a world computes the rotated pixels of a mask only when they are needed. Until then, masks were once drawn at
    (0, 0).
    """
    world = World(Effects.rigid_bodies(), gravity=(0.0, 0.0))
    mask = PixelMask.from_array(np.ones((8, 30), bool))
    for x in (40.0, 66.0):
        world.add_body(mask, position=(x, 50.0))
    world.add_body(mask, position=(200.0, 50.0), angle=pi / 2)
    world.step()
    drawn = debug.drawn_masks(world)
    left, top = drawn.left.tolist(), drawn.top.tolist()
    bodies = world.bodies
    for k in range(3):
        height, width = drawn.solids[drawn.which[k]].shape
        assert left[k] == pytest.approx(bodies["x"][k] - width / 2, abs=0.51)
        assert top[k] == pytest.approx(bodies["y"][k] - height / 2, abs=0.51)
    assert drawn.solids[drawn.which[2]].shape == (30, 8)
    assert [shared.sum() for _, _, shared in debug.mask_hits(world)] == [max(0, 30 - (left[1] - left[0])) * 8]


class Sprites(Plain, Scene):
    """A bracket, a disc and a large ground mask without gravity; the bracket flies and rotates."""

    name = title = "sprites"
    effects = Effects(response=True, rotation=True, stacking=True)

    def build(self):
        world, atlas = self.add_world(), load_atlas("lab")
        ground = np.zeros((300, 900), bool)
        ground[240:] = True
        ground[100:, :20] = True
        world.add_body(PixelMask.from_array(ground, origin=(0, 0)), kind="static")
        self.flying = world.add_body(
            atlas.mask("bracket_teal"), position=(100.3, 90.2), velocity=(37.0, 11.0), angular_velocity=3.0
        )
        world.add_body(atlas.mask("disc_large"), position=(300.5, 90.5))


def stepped(steps):
    scene = Sprites(seed=1)
    for _ in range(steps):
        scene.step(InputState())
    return scene


@pytest.mark.parametrize("alpha", [1.0, 0.3])
@pytest.mark.parametrize("scale", [2, 3])
@pytest.mark.parametrize("layer", ["masks", "outlines"])
def test_lines_stand_at_the_steps_pose_in_every_window(layer, scale, alpha):
    """Outlines are drawn at the pose of the last step, at any scale and also between steps.

    Between steps, the sprites are drawn at this pose, too.
    """
    scene = stepped(12)
    before = scene_digest(scene)
    overlays = Overlays([layer])
    picture = Picture(pygame.Surface((480 * scale, 270 * scale)))
    frame = picture.draw_scene(scene, overlays, alpha)
    assert scene_digest(scene) == before
    mine = np.flatnonzero(scene.world.shapes["body"] == scene.flying.id)
    lines = mask_edges(scene.world, mine, float(scale)).outer
    wanted = (255, 255, 255) if layer == "masks" else overlays.layers[layer_names().index(layer)].color[:3]
    picture = pygame.surfarray.array3d(frame.surface)
    for x, y in middles(lines):
        column, row = round(x * scale), round(y * scale)
        beside = picture[column - 1 : column + 2, row - 1 : row + 2]  # a line of one pixel may lie half a pixel aside
        assert (beside == wanted).all(axis=2).any(), (x, y)
    assert len(lines) >= 8


def middles(lines):
    return ((lines[:, :2] + lines[:, 2:]) / 2.0).tolist()


def test_the_legend_names_outlines_and_seams_and_counts_what_is_left_out(monkeypatch):
    overlays = Overlays(["masks"])
    Picture().draw_scene(stepped(3), overlays)
    layer = next(each for each in overlays.layers if each.name == "masks")
    texts = [text for _, text in layer.notes()]
    assert any(text == f"outlines, {layer.parts} of {layer.parts_in_all} parts" for text in texts)
    assert (SEAM, "seams between parts, never felt") in layer.notes()
    assert 0 < layer.parts < layer.parts_in_all, "the ground reaches beyond the view"
    monkeypatch.setattr("game.overlays.layer_masks.PART_BUDGET", 2)
    Picture().draw_scene(stepped(3), overlays)
    assert layer.parts == 2


def test_a_large_mask_is_drawn_where_it_is_seen(monkeypatch):
    made = []
    import game.overlays.layer_masks as module

    whole = module.mask_image

    def noted(solid, palette="standard"):
        made.append(solid.shape)
        return whole(solid, palette)

    monkeypatch.setattr(module, "mask_image", noted)
    scene = stepped(2)
    scene.camera.place(311.0, 20.0)
    frame = Picture().draw_scene(scene, Overlays(["masks"]))
    assert made and max(max(shape) for shape in made) <= BLOCK + 2
    plain = Picture().draw_scene(scene, Overlays())
    y = (240 - 20) * 3
    sky, earth = (700, y - 30), (700, y + 30)
    assert frame.surface.get_at(sky) == plain.surface.get_at(sky)
    assert frame.surface.get_at(earth) != plain.surface.get_at(earth)
