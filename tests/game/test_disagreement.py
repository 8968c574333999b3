"""The overlay of false hits of boxes shows exactly the pairs that a test of every pair finds."""

from itertools import combinations

import numpy as np
import pygame
import pytest

import physics
from game.input.inputs import InputState
from game.overlays.layer_disagreement import OWN, false_hits
from game.overlays.stack import Overlays
from game.registry import Registry
from game.run.picture import Picture
from game.run.session import Session
from game.run.sources import BotSource
from game.scene import Scene
from physics import Effects, Filter, PixelMask, World, collide
from scenes import SCENES

STEPS, LOOKED_AT = 2400, 20
needs_speed = pytest.mark.skipif(not physics.JIT, reason="hundreds of steps of whole games")


def corner(flipped=False):
    """Return an L-shaped mask of 8 x 8 px. flipped: True leaves the lower left quarter empty, False the upper right."""
    solid = np.ones((8, 8), bool)
    solid[:4, 4:] = False
    return PixelMask(solid[::-1, ::-1] if flipped else solid, origin=(4, 4))


def ids_of(world, rows):
    return {tuple(sorted(pair)) for pair in world.shapes["body"][rows].tolist()}


def test_two_corners_in_each_other_are_a_hit_by_their_boxes_alone():
    world = World(Effects())
    a, b = (
        world.add_body(corner(), kind="kinematic"),
        world.add_body(corner(True), position=(4.0, -4.0), kind="kinematic"),
    )
    world.step()
    hits, lies = false_hits(world)
    assert ids_of(world, hits) == ids_of(world, lies) == {(a.id, b.id)}
    b.position = (1.0, -1.0)
    world.step()
    hits, lies = false_hits(world)
    assert ids_of(world, hits) == {(a.id, b.id)} and not len(lies)
    b.position = (8.0, 0.0)
    world.step()
    assert not len(false_hits(world)[0]), "edges that only touch share nothing"


def test_who_is_not_to_meet_is_not_asked():
    world = World(Effects(sensors=True))
    world.add_body(corner(), kind="kinematic", filter=Filter(membership=1, mask=2))
    world.add_body(corner(True), position=(4.0, -4.0), kind="kinematic", filter=Filter(membership=1, mask=2))
    world.add_body(
        corner(True), position=(4.0, -4.0), kind="kinematic", filter=Filter(membership=2, mask=1), sensor=True
    )
    world.step()
    assert not len(false_hits(world)[0])


@pytest.fixture(scope="module")
def flown():
    """Play the shooter by its bot with the overlay on. Return (pairs, texts, overlays).

    pairs: for each compared step, (ids of the false hits by a test of every pair, ids by the overlay); texts: for each
    new mark, whether the picture has a text about it; overlays: the Overlays at the end.
    """
    scene = Registry(SCENES).scene_class("shooter")(seed=1)
    session, overlays = Session(scene, BotSource()), Overlays(["disagreement"])
    looks, said = [], []
    for step in range(STEPS):
        session.step()
        overlays.note(scene)
        if step % LOOKED_AT == 0:
            looks.append((slow_lies(scene.world), ids_of(scene.world, false_hits(scene.world)[1])))
        if overlays.disagreement.marks and overlays.disagreement.marks[-1][0] == 0:
            frame = Picture(pygame.Surface((960, 540))).draw_scene(scene, overlays)
            said.append(any(OWN in text for _, text in frame.boxes))
    return looks, said, overlays


def slow_lies(world):
    """Return the pairs of ids that are false hits of boxes, found by a test of every pair.

    The boxes of such a pair share area, but its exact shapes share none. At least one of the two shapes is a sprite's
    mask.
    """
    found = set()
    mask_of = {body.id: body.shapes[0] for body in world}
    filters = {body.id: body.filter for body in world}
    for a, b in combinations(world, 2):
        one, other = mask_of[a.id], mask_of[b.id]
        if not isinstance(one, PixelMask) and not isinstance(other, PixelMask):
            continue
        meet = filters[a.id].membership & filters[b.id].mask and filters[b.id].membership & filters[a.id].mask
        if not meet or a.sensor or b.sensor:
            continue
        (x0, y0, x1, y1), (u0, v0, u1, v1) = a.bounds, b.bounds
        if x0 < u1 and u0 < x1 and y0 < v1 and v0 < y1:
            poses = [(each.position.x, each.position.y, each.angle) for each in (a, b)]
            touch = collide(one, poses[0], other, poses[1])
            if not len(touch) or min(touch.separations.tolist()) > 0.0:
                found.add((a.id, b.id))
    return found


@needs_speed
def test_in_the_shooter_the_layer_shows_what_a_slow_look_finds(flown):
    looks, _, _ = flown
    assert any(slow for slow, _ in looks) and all(slow == shown for slow, shown in looks)


@needs_speed
def test_the_players_own_box_would_have_died(flown):
    _, said, overlays = flown
    assert said and any(said), "in forty seconds some bullet passes through the box and not through the plane"
    (_, note), (_, share) = overlays.disagreement.notes()
    assert note.startswith("box hits without") and "%" in share and "10 s" in share


class Visit(Scene):
    """Scene in which an L-shaped mask moves into the box of the player's, which has the same shape, and back.

    depth: number of steps in which it moves in, by 4 px each.
    """

    name, title, about, effects = "test/visit", "Visit", "", Effects()
    depth = 2

    def build(self):
        """Add the two corners."""
        world = self.add_world()
        self.mine = world.add_body(corner(), kind="kinematic")
        self.other = world.add_body(corner(True), position=(12.0, -12.0), kind="kinematic")

    def update(self, inputs):
        """Move the other mask into the box of the player's mask for `depth` steps, and then out again."""
        way = 1 if self.frame < self.depth else -1
        self.other.velocity = (-240.0 * way, 240.0 * way)
        self.world.step()

    @property
    def own_body(self):
        """Return the id of the player's body."""
        return self.mine.id

    def draw(self, canvas, alpha):
        """Draw nothing."""

    def check(self):
        """Return no goals."""
        return []

    def bot(self):
        """Return no keys."""
        return frozenset()

    def state(self):
        """Return an empty state."""
        return ()


@pytest.mark.parametrize("depth, marks", [(1, 0), (2, 1), (3, 0)], ids=["beside", "in the box", "hit"])
def test_what_came_into_the_box_and_left_without_a_hit_is_marked_once(depth, marks):
    scene = type("Visit", (Visit,), {"depth": depth})()
    overlays, state = Overlays(["disagreement"]), InputState()
    for _ in range(2 * depth + 2):
        scene.step(state)
        overlays.note(scene)
    assert [box.tolist() for _, box in overlays.disagreement.marks] == [[-4.0, -4.0, 4.0, 4.0]] * marks


def test_a_restart_is_counted_anew():
    scene = Registry(SCENES).scene_class("shooter")(seed=1)
    overlays, session = Overlays(["disagreement"]), Session(scene, BotSource())
    for _ in range(30):
        session.step()
        overlays.note(scene)
    assert len(overlays.disagreement.counts) == 30
    scene.restart()
    session.step()
    overlays.note(scene)
    assert len(overlays.disagreement.counts) == 1
