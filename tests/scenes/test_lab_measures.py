"""Measuring functions of the labs, compared with values known by hand, and the input of lab/shapes."""

from math import pi

import numpy as np
import pygame
import pytest

from game.input.inputs import InputFrame, InputState
from game.registry import Registry
from physics import Capsule, Circle, Polygon
from scenes import SCENES
from scenes.lab.conveyor import BELTS, direction, on_belt
from scenes.lab.ghost_bumps import share
from scenes.lab.pieces import hull, piece, signed_distance
from scenes.lab.sensors import least_gap
from scenes.lab.shape_pictures import placed_hull
from scenes.lab.shapes import CHOICES, ICONS, NAMES
from scenes.lab.shots import PLATE_HALF, PLATE_X, ROD_HALF, ROD_RADIUS, rod_gap


def make(name):
    return Registry(SCENES).scene_class(name)(seed=1)


class Hands:
    """Source of input frames, one for each step."""

    def __init__(self, scene):
        self.scene, self.inputs = scene, InputState()

    def step(self, *actions, pointer=(0, 0), down=False, wheel=0, changes=()):
        self.inputs.set(InputFrame(frozenset(actions), pointer, down, wheel, changes))
        self.scene.step(self.inputs)


@pytest.mark.parametrize(
    "shape",
    [Circle(8.0), Capsule((-7, 0), (7, 3), 5.0), Polygon.box(15, 9), Polygon(Polygon.box(12, 6).points, radius=4.0)],
)
def test_a_piece_is_drawn_where_its_shape_is(shape):
    image = piece(shape, "teal")
    alpha = pygame.surfarray.array_alpha(image)
    middle = image.get_width() / 2
    points, radius = hull(shape)
    for column, row in np.ndindex(alpha.shape):
        gap = float(signed_distance(points, radius, column + 0.5 - middle, row + 0.5 - middle))
        assert abs(gap) < 1e-9 or (gap < 0.0) == (alpha[column, row] > 0)


def test_signed_distance_of_a_rounded_box():
    points = np.array([(-6.0, -3.0), (6.0, -3.0), (6.0, 3.0), (-6.0, 3.0)])
    known = {(0, 0): -7.0, (6, 0): -4.0, (12, 0): 2.0, (9, 7): 1.0, (0, -3): -4.0}
    for (x, y), wanted in known.items():
        assert float(signed_distance(points, 4.0, x, y)) == pytest.approx(wanted)


def test_belts_know_what_lies_on_them():
    (ax, ay), (bx, by) = BELTS["up"]
    tx, ty = direction((ax, ay), (bx, by))
    assert tx > 0.0 > ty, "up is towards smaller y"
    along, aside, length = on_belt(((ax + bx) / 2 + 8 * ty, (ay + by) / 2 - 8 * tx), (ax, ay), (bx, by))
    assert along == pytest.approx(0.5) and aside == pytest.approx(-8.0) and length > 90.0


def test_rods_by_geometry():
    still = dict(speed=3600.0, spin=0.0, plate=2.0)
    assert rod_gap(30.0, 0.0, angle=0.0, **still) < -1.0
    flat = rod_gap(30.0, PLATE_HALF + 5.0, angle=0.0, **still)
    assert flat == pytest.approx(5.0 - ROD_RADIUS, abs=0.1)
    upright = rod_gap(30.0, PLATE_HALF + ROD_HALF + 5.0, angle=pi / 2, **still)
    assert upright == pytest.approx(5.0 - ROD_RADIUS, abs=0.1)
    # Flat when it starts and upright at the plate: only the turn brings its end there.
    seconds = (PLATE_X - 30.0) / 3600.0
    turned = rod_gap(30.0, PLATE_HALF + ROD_HALF - 4.0, speed=3600.0, angle=0.0, spin=pi / 2 / seconds, plate=2.0)
    assert turned < 0.0 < rod_gap(30.0, PLATE_HALF + ROD_HALF - 4.0, angle=0.0, **still)


def test_gaps_of_crossings():
    half = np.array((0.5, 20.0))
    assert least_gap((0, 0), (100, 0), (50, 0), (50, 0), half) == pytest.approx(0.0, abs=0.2)
    assert least_gap((0, 25), (100, 25), (50, 0), (50, 0), half) == pytest.approx(5.0, abs=0.01)
    assert least_gap((50, 0), (50, 0), (0, 0), (100, 0), half) == pytest.approx(0.0, abs=0.2), "the zone moves"
    assert least_gap((0, 0), (10, 0), (300, 0), (300, 0), half) > 200.0


def test_errors_on_the_scale():
    assert share(0, 0.0) == 0.0 and share(0, 1.0) == 1.0 and share(0, 1e-8) == pytest.approx(0.5)


def test_shapes_are_chosen_dragged_turned_and_stepped_through():
    scene = make("lab/shapes")
    hands = Hands(scene)
    hands.step()
    hands.step(pointer=ICONS[len(NAMES) + 3].center, down=True)
    assert NAMES[int(scene.values["B"])] == NAMES[3] and scene.hands.chosen == 1
    hands.step()
    x, y = (round(v) for v in scene.hands.poses[0][:2])
    hands.step(pointer=(x, y), down=True)
    hands.step(pointer=(x + 9, y - 5), down=True, wheel=2)
    assert scene.hands.chosen == 0 and scene.hands.poses[0][2] > 0.3
    assert scene.hands.poses[0][0] == pytest.approx(128.0 + 9) and scene.hands.poses[0][1] == pytest.approx(112.0 - 5)
    hands.step("fire")
    assert scene.hands.chosen == 1
    seen = []
    for _ in range(len(scene.steps)):
        hands.step("confirm")
        hands.step()
        seen.append(int(scene.values["step"]))
    assert sorted(seen) == list(range(len(scene.steps))), "every step of GJK, then from the first again"


def test_the_picture_of_a_shape_is_the_shape():
    for name in NAMES:
        points, radius = placed_hull(CHOICES[name], (10.0, 20.0, 0.7))
        local, _ = hull(CHOICES[name])
        assert len(points) == len(local)
        assert np.allclose(sorted(np.hypot(*(np.array(points) - (10.0, 20.0)).T)), sorted(np.hypot(*local.T)))


def test_the_hero_drops_through_a_plank_and_stands_on_the_next():
    scene = make("lab/one_way")
    scene.change("slider:planks", 1)
    scene.hero.move_to((100.0, 8 * 16 - 10.0))
    hands = Hands(scene)
    for _ in range(5):
        hands.step()
    assert scene.grounded
    hands.step("down", "jump")
    for _ in range(40):
        hands.step()
    assert scene.grounded and scene.hero.position[1] > 8 * 16 + 20
