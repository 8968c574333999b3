"""The shooter's picture: texts do not overlap, bullets are visible, palettes and flashes follow the settings."""

from itertools import combinations

import numpy as np
import pygame
import pytest

from game.drawing.canvas import Canvas
from game.drawing.sprites import load_atlas
from game.files.accessibility import Accessibility
from game.places import SOUNDS
from scenes.shooter.bullets import HOSTILE_LOOKS, LOOKS
from scenes.shooter.cast import GROUND_SPEED
from scenes.shooter.director import READY
from scenes.shooter.ground import BORDER, coast_line, storm_share
from scenes.shooter.scene import Shooter
from scenes.shooter.view import CYCLES
from tests.scenes.shooter_stages import Sky, boss_stage


def picture(scene, alpha=1.0):
    """Return the canvas on which a scene is drawn."""
    canvas = Canvas()
    canvas.begin((0, 0, 0))
    scene.draw(canvas, alpha)
    return canvas


def check_text(scene):
    """Assert that no text leaves the picture or overlaps other text. Return the texts."""
    canvas = picture(scene)
    words = [text for _, text in canvas.boxes]
    for rect, text in canvas.boxes:
        assert canvas.rect.contains(rect), (text, rect)
    for (rect, text), (other, more) in combinations(canvas.boxes, 2):
        assert not rect.colliderect(other), (text, more, rect, other)
    return words


def test_texts_keep_clear_of_each_other_from_the_title_to_the_result(tmp_path):
    sky = Sky(quiet=False, level=boss_stage(tmp_path / "s.json", health=30))
    scene = sky.scene
    scene.best = 99_999_990
    scene.score.points, scene.score.chain, scene.score.grazes = 12_345_670, 999, 9999
    scene.plane.power = scene.plane.bombs = scene.plane.lives = 5
    scene.hits.count.update(core=999, hull=9999, box=9999)
    seen = set()
    sky.step(1, changes=[("assist:invincible", True)])
    for _ in range(3000):
        sky.step(1, ["fire"])
        if scene.frame % 7 == 0 or scene.freeze:
            seen.update(check_text(scene))
        if scene.result:
            break
    for _ in range(5):
        sky.step()
        seen.update(check_text(scene))
    assert {"WARNING", "STORM CITADEL", "PHASE BONUS", "STAGE CLEAR", "NO CONTINUE", "BROADSIDE", "MAX"} <= seen


def test_texts_of_the_start_the_countdown_and_the_end():
    scene = Shooter(seed=1)
    sky = Sky(quiet=False)
    sky.scene = scene
    seen = set()
    for _ in range(READY + 60):
        sky.step()
        seen.update(check_text(scene))
    assert {scene.director.stage.title, scene.director.stage.name, scene.director.wave} <= seen
    scene.plane.lives, scene.plane.away = 0, 0
    for body in scene.plane.lose_life():
        scene.gone.append(body)
    scene.plane.lives = scene.plane.away = 0
    sky.step(3)
    assert any(text.startswith("CONTINUE?") for text in check_text(scene))
    sky.step(620)
    assert "GAME OVER" in check_text(scene)


def luminance(color):
    """Return the relative luminance of an RGB colour (WCAG 2.2)."""
    channels = [c / 255 / 12.92 if c / 255 <= 0.04045 else ((c / 255 + 0.055) / 1.055) ** 2.4 for c in color[:3]]
    return 0.2126 * channels[0] + 0.7152 * channels[1] + 0.0722 * channels[2]


@pytest.mark.parametrize("look", HOSTILE_LOOKS)
@pytest.mark.parametrize("palette", ["", "safe_"])
def test_enemy_bullets_bring_their_own_contrast_to_every_backdrop(look, palette):
    image = load_atlas("effects")[palette + LOOKS[look][0]]
    solid = pygame.surfarray.array_alpha(image) > 127
    levels = [luminance(color) for color in pygame.surfarray.array3d(image)[solid].tolist()]
    assert (max(levels) + 0.05) / (min(levels) + 0.05) >= 4.5, "a dark ring around a bright core"


@pytest.mark.parametrize("look", CYCLES)
def test_the_safe_palette_has_other_colours_and_the_same_shapes(look):
    effects = load_atlas("effects")
    plain, safe = effects[LOOKS[look][0]], effects["safe_" + LOOKS[look][0]]
    assert (pygame.surfarray.array_alpha(plain) > 127).tolist() == (pygame.surfarray.array_alpha(safe) > 127).tolist()
    assert pygame.image.tobytes(plain, "RGB") != pygame.image.tobytes(safe, "RGB")


def test_palettes_change_the_picture_and_nothing_else():
    sky = Sky()
    for look in HOSTILE_LOOKS:
        sky.bullet(look, 60 + 50 * HOSTILE_LOOKS.index(look), 60)
    pictures = []
    for palette in ("standard", "safe", "contrast"):
        sky.scene.set_accessibility(Accessibility(palette=palette))
        pictures.append(pygame.surfarray.array3d(picture(sky.scene).surface).astype(int))
    assert (pictures[0] != pictures[1]).any()
    ground = np.s_[20:400, 200:230]
    assert pictures[2][ground].mean() < 0.75 * pictures[1][ground].mean(), "the ground is darker"


def test_a_ghost_blinks_or_is_outlined():
    sky = Sky()
    sky.scene.plane.shelter(100)
    for flashing in (True, False):
        sky.scene.set_accessibility(Accessibility(flashing=flashing))
        wings = []
        for safe in (60, 58):
            sky.scene.plane.safe = safe
            x, y = sky.scene.plane.body.position
            around = pygame.Rect(0, 0, 34, 20)
            around.center = (x, y - 4)
            wings.append(pygame.surfarray.array3d(picture(sky.scene).surface.subsurface(around)).astype(int))
        assert (wings[0] != wings[1]).any() == flashing, "the same picture at every moment where nothing may blink"


def test_two_stretches_meet_in_a_coast_that_scrolls_down():
    mask = pygame.surfarray.array_alpha(coast_line())
    assert mask.shape == (480, BORDER)
    assert (mask[:, 0] == 255).all() and (mask[:, -1] == 0).all()
    heights = (mask > 0).sum(axis=1)
    assert np.ptp(heights) > 30 and abs(int(heights[0]) - int(heights[-1])) < 16, "wavy, and no seam at the sides"
    grounds = [(-1e9, "coast"), (0.0, "storm")]
    assert storm_share(grounds[:1], 500.0) == 0.0
    assert 0.0 < storm_share(grounds, GROUND_SPEED) < storm_share(grounds, 3 * GROUND_SPEED) < 1.0
    assert storm_share(grounds, 1e4) == 1.0


def test_every_sound_that_is_asked_for_is_there(tmp_path):
    sky = Sky(quiet=False, level=boss_stage(tmp_path / "s.json", health=30))
    heard = set()
    for frame in range(2200):
        sky.step(1, ["fire", "bomb"] if frame % 300 == 290 else ["fire"])
        heard |= {name for name, _, _ in sky.scene.cues}
    assert {"laser", "warning", "bomb", "explosion", "big_explosion", "coin"} <= heard
    assert [name for name in heard if not (SOUNDS / f"{name}.wav").exists()] == []
