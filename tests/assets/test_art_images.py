"""Sheets name what the game asks for; silhouettes have notches; backdrops wrap and stay behind the bullets."""

import json

import numpy as np
import pytest

from assets import FOLDER, png

SHEETS = {
    "planes": ("player_left2 player_left1 player player_right1 player_right2 large_plane_a large_plane_b",
               {"dart": 2, "saucer": 2, "gunship": 2, "powerup": 2, "exhaust": 2}),
    "effects": ("side_bullet bullet_needle glow_small glow_large hitbox_dot",
                {"player_bullet": 2, "bullet_red": 2, "bullet_purple": 2, "bullet_orange": 2, "muzzle_flash": 3,
                 "explosion_small": 10, "explosion_large": 14, "spark": 4, "smoke": 4, "debris": 4}),
    "hero": ("hero_flash", {"idle": 2, "run": 6, "jump": 1, "fall": 1, "slide": 1, "hurt": 1, "win": 2}),
    "things": ("crate crate_large spikes sign platform checkpoint_off walker_squashed",
               {"coin": 4, "spring": 3, "walker": 4, "goal": 2, "checkpoint": 2, "sparkle": 4, "dust": 4}),
    "ui": ("logo panel panel_selected icon_heart icon_coin icon_life icon_cursor", {}),
}


def load(sheet):
    picture = png.decode((FOLDER / "images" / f"{sheet}.png").read_bytes())
    table = json.loads((FOLDER / "images" / f"{sheet}.json").read_text(encoding="utf-8"))
    frames = {}
    for name, place in table["frames"].items():
        frames[name] = picture[place["y"] : place["y"] + place["h"], place["x"] : place["x"] + place["w"]]
        assert frames[name].shape == (place["h"], place["w"], 4), f"{name} reaches past the sheet"
    return frames, table["animations"]


def backdrop(name):
    return png.decode((FOLDER / "images" / f"{name}.png").read_bytes())


@pytest.mark.parametrize("sheet", SHEETS)
def test_sheet_has_its_frames_and_animations(sheet):
    frames, animations = load(sheet)
    names, sequences = SHEETS[sheet]
    assert set(names.split()) <= set(frames)
    for name, count in sequences.items():
        assert len(animations[name]["frames"]) >= count and animations[name]["fps"] > 0
    for animation in animations.values():
        assert set(animation["frames"]) <= set(frames)
    assert all(frame[..., 3].any() for frame in frames.values()), "an empty frame"


@pytest.mark.parametrize("name", ["player", "dart_0", "saucer_0", "gunship_0", "large_plane_a", "large_plane_b"])
def test_plane_has_notches(name):
    """Boxes of planes overlap long before their pixels do, or the masks would decide nothing."""
    solid = load("planes")[0][name][..., 3] > 0
    rows, columns = np.flatnonzero(solid.any(1)), np.flatnonzero(solid.any(0))
    box = (rows[-1] - rows[0] + 1) * (columns[-1] - columns[0] + 1)
    assert solid.sum() <= 0.70 * box
    assert set(np.unique(load("planes")[0][name][..., 3])) <= {0, 255}


def test_player_in_level_flight_is_symmetric():
    solid = load("planes")[0]["player"][..., 3] > 0
    assert (solid == solid[:, ::-1]).all()


def test_hero_stands_on_the_bottom_row_in_the_middle():
    frames, _ = load("hero")
    for name in ("idle_0", "idle_2", "run_0", "run_1", "run_3", "run_4", "win_0"):
        feet = np.flatnonzero(frames[name][-1, :, 3])
        assert len(feet), f"{name} floats"
        assert abs((feet[0] + feet[-1]) / 2 - 11.5) <= 2.5, f"{name} stands off centre"


@pytest.mark.parametrize("name, axes", [
    ("sea", (0, 1)), ("clouds_low", (0, 1)), ("clouds_high", (0, 1)), ("mountains_far", (1,)), ("mountains_mid", (1,)),
    ("mountains_near", (1,)), ("clouds", (1,)),
])
def test_backdrop_is_seamless(name, axes):
    """Across the seam the picture changes no more than it does between any other two lines."""
    picture = backdrop(name).astype(int)
    for axis in axes:
        steps = abs(np.diff(picture, axis=axis)).mean(axis=tuple({0, 1, 2} - {axis}))
        first, last = np.take(picture, 0, axis), np.take(picture, -1, axis)
        assert abs(first - last).mean() <= max(steps.max(), 2.0)


def test_shooter_ground_is_dark_and_muted():
    """OKLab lightness at most 60 %, chroma at most 0.09: bullets must read on it."""
    rgb = backdrop("sea")[..., :3].reshape(-1, 3) / 255
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    cone = np.cbrt(linear @ np.array([[0.4122214708, 0.2119034982, 0.0883024619],
                                      [0.5363325363, 0.6806995451, 0.2817188376],
                                      [0.0514459929, 0.1073969566, 0.6299787005]]))
    lab = cone @ np.array([[0.2104542553, 1.9779984951, 0.0259040371],
                           [0.7936177850, -2.4285922050, 0.7827717662],
                           [-0.0040720468, 0.4505937099, -0.8086757660]])
    assert lab[:, 0].max() <= 0.605
    assert np.sqrt(lab[:, 1] ** 2 + lab[:, 2] ** 2).max() <= 0.09


@pytest.mark.parametrize("name, size", [("sky_dusk", (270, 480)), ("sea", (540, 480)), ("clouds_low", (540, 480))])
def test_backdrop_size(name, size):
    assert backdrop(name).shape[:2] == size
