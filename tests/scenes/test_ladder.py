"""lab/ladder: its cells show the area that shapes cover, and a player's own pictures are used
or refused with a reason.
"""

import numpy as np
import pygame
import pytest

from game.errors import FileError
from game.input.inputs import InputFrame, InputState
from physics import TIERS, Bounds, Capsule, Circle, Effects, PixelMask, Polygon, World, fit, measure
from scenes.lab.coverage import covered
from scenes.lab.ladder import SPRITES, Ladder

pytestmark = pytest.mark.usefixtures("display")


@pytest.fixture
def display():
    """Set a display mode, which pygame needs to convert pictures."""
    pygame.display.init()
    pygame.display.set_mode((480, 270))


@pytest.mark.parametrize(
    "shape",
    [
        Circle(7.3, (1.0, -2.0)),
        Capsule((-5.0, 1.0), (4.0, 3.5), 3.2),
        Capsule((2.0, 1.0), (2.0, 6.0), 2.0),
        Polygon([(-6, -4), (5, -6), (7, 3), (-2, 6)]),
        Polygon([(-4, -3), (4, -5), (3, 5)], radius=2.5),
        Bounds(PixelMask(np.eye(9, dtype=bool), snap=False)),
        PixelMask(np.eye(9, dtype=bool), origin=(3, 2), snap=False),
    ],
    ids=lambda shape: type(shape).__name__,
)
def test_what_is_covered_is_what_a_point_query_finds(shape):
    world = World(Effects())
    world.add_body(shape, kind="static")
    x, y = np.meshgrid(np.arange(-12, 12) + 0.5031, np.arange(-12, 12) + 0.4977)
    found = covered((shape,), x, y)
    asked = [
        [bool(world.query_point((a, b))) for a, b in zip(xs, ys, strict=True)] for xs, ys in zip(x, y, strict=True)
    ]
    assert found.any() and not found.all() and (found == np.array(asked)).all()


def test_an_unknown_shape_is_refused():
    with pytest.raises(TypeError, match="shapes must be Circle"):
        covered(("disc",), np.zeros(1), np.zeros(1))


def test_the_counts_are_near_the_exact_areas():
    """The pixel counts of the ladder are close to the exact areas: they differ by less than the length of the boundary.

    A pixel counts by its centre.
    """
    scene = Ladder()
    for tier in TIERS:
        over, missed = scene.counts[tier]
        found = measure(scene.mask, fit(scene.mask, tier))
        edge = 4 * sum(scene.image.get_size())
        assert abs(over - found.over) < 0.25 * edge and abs(missed - found.missed) < 0.25 * edge
    assert scene.counts["circle"][0] > 300 and scene.counts["mask"] == (0, 0)


def test_left_and_right_go_through_all_sprites():
    scene, inputs = Ladder(), InputState()
    names = [scene.sprite_name]
    for _ in SPRITES:
        for held in (frozenset({"right"}), frozenset()):
            inputs.set(InputFrame(held))
            scene.step(inputs)
        names.append(scene.sprite_name)
    assert names[-1] == names[0] and len(set(names)) == len(SPRITES)
    assert len(scene.worlds) == len(TIERS), "no world of an earlier sprite is left"


def test_a_picture_of_ones_own_is_at_every_tier(tmp_path):
    picture = pygame.Surface((40, 30), pygame.SRCALPHA)
    pygame.draw.polygon(picture, (200, 80, 80, 255), [(2, 28), (20, 2), (38, 28)])
    pygame.image.save(picture, tmp_path / "roof.png")
    scene = Ladder(level=tmp_path / "roof.png")
    assert scene.sprite_name == "roof.png" and scene.mask.area == pygame.mask.from_surface(picture).count()
    assert scene.counts["aabb"][0] > scene.counts["hull"][0]
    assert scene.measured() == (scene.mask, scene.mask)


@pytest.mark.parametrize(
    "content, reason",
    [
        (b"no picture at all", "is no PNG file"),
        (pygame.Surface((8, 8), pygame.SRCALPHA), "has no solid pixel"),
        (pygame.Surface((300, 4)), "at most 256 go each way"),
    ],
    ids=("text", "empty", "large"),
)
def test_a_file_that_cannot_be_used_says_why(tmp_path, content, reason):
    path = tmp_path / "mine.png"
    if isinstance(content, bytes):
        path.write_bytes(content)
    else:
        pygame.image.save(content, path)
    with pytest.raises(FileError, match=reason):
        Ladder(level=path)
