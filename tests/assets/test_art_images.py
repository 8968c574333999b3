"""Sheets have the frames that the game uses, silhouettes have notches, and backdrops wrap and
are darker than bullets.
"""

import numpy as np
import pytest

from assets.craft.palette import OUTLINE
from assets.platformer.hero import LETTERS as HERO_LETTERS
from assets.platformer.things import LETTERS as THING_LETTERS
from tests.assets.art_reading import backdrop, load, oklab, pieces

SHEETS = {
    "planes": (
        "player_left2 player_left1 player player_right1 player_right2 large_plane_a large_plane_b",
        {
            "dart": 2,
            "saucer": 2,
            "gunship": 2,
            "powerup": 2,
            "exhaust": 2,
            "hornet": 2,
            "turret": 2,
            "midboss": 2,
            "boss_a": 2,
            "boss_b": 2,
            "boss_c": 2,
            "core": 2,
            "bomb_item": 4,
            "life_item": 4,
        },
    ),
    "effects": (
        "side_bullet bullet_needle safe_bullet_needle glow_small glow_large hitbox_dot heavy_shot",
        {
            "player_bullet": 2,
            "bullet_red": 2,
            "bullet_purple": 2,
            "bullet_orange": 2,
            "muzzle_flash": 3,
            "explosion_small": 10,
            "explosion_large": 14,
            "spark": 4,
            "smoke": 4,
            "debris": 4,
            "bullet_small": 2,
            "bullet_big": 2,
            "bullet_ring": 2,
            "bomb_ring": 6,
            "graze_spark": 3,
        },
    ),
    "hero": (
        "hero_flash",
        {
            "idle": 2,
            "run": 6,
            "jump": 1,
            "fall": 1,
            "slide": 1,
            "hurt": 1,
            "win": 2,
            "climb": 4,
            "push": 4,
            "duck": 1,
            "look_up": 1,
        },
    ),
    "things": (
        "crate crate_large spikes sign platform checkpoint_off walker_squashed crumble_0 crumble_1 crumble_2 "
        "crumble_3 bridge bridge_ropes crumble_bit_0 crumble_bit_1 crumble_bit_2",
        {
            "coin": 4,
            "spring": 3,
            "walker": 4,
            "goal": 2,
            "checkpoint": 2,
            "sparkle": 4,
            "dust": 4,
            "bat": 4,
            "hedgehog": 4,
            "secret_gem": 4,
            "belt_left_end": 4,
            "belt_mid": 4,
            "belt_right_end": 4,
        },
    ),
    "tiles": ("ladder ladder_top rock_0 rock_255 rock_255_3 back_cave_0 stalactite crystal_1 banner window chain", {}),
    "lander": (
        "ship hook pad_base pad_canyon pad_cave pad_mesa crate drum rock_0 rock_1 rock_2 icon_lander icon_shell "
        "icon_fuel icon_hull icon_cargo glow_flame glow_lamp glow_goal glow_ship",
        {"flame": 4, "shell": 2, "mast": 2, "can": 4},
    ),
    "ui": (
        "logo panel panel_selected icon_heart icon_coin icon_life icon_cursor icon_bomb icon_core icon_hull icon_gem",
        {},
    ),
}
SIZES = {
    # sheet: {frame: (width, height)} of what rules are written for
    "planes": {
        "hornet_0": (22, 22),
        "turret_0": (36, 36),
        "midboss_0": (84, 56),
        "boss_a_0": (132, 84),
        "boss_c_1": (132, 84),
        "core_0": (6, 6),
        "bomb_item_0": (18, 18),
        "life_item_0": (18, 18),
    },
    "effects": {
        "bullet_small_0": (6, 6),
        "bullet_big_0": (14, 14),
        "bullet_ring_0": (10, 10),
        "bomb_ring_5": (240, 240),
    },
    "hero": {"climb_0": (24, 24), "push_0": (24, 24), "duck_0": (24, 24)},
    "things": {
        "bat_0": (20, 14),
        "hedgehog_0": (20, 14),
        "crumble_0": (32, 16),
        "secret_gem_0": (14, 14),
        "belt_mid_0": (16, 16),
        "bridge": (128, 20),
    },
    "tiles": {"ladder": (16, 16), "rock_0": (16, 16)},
    "lander": {"ship": (30, 32), "crate": (18, 18), "drum": (18, 18), "pad_cave": (96, 14)},
}
# Light, flames and flat parts of a larger picture have no outline of their own.
BARE = {
    "planes": ("exhaust", "flash"),
    "hero": ("flash",),
    "things": ("sparkle", "dust", "light", "flash", "belt", "blast"),
    "lander": ("flame", "glow", "hook", "icon"),
}
# One silhouette under all pictures of an animation: it collides as its first frame.
ONE_MASK = ("saucer", "gunship", "hornet", "turret", "midboss", "boss_a", "boss_b", "boss_c", "core", "powerup")


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
    """A plane fills at most 70 % of its box, so that masks and boxes give different hits."""
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


@pytest.mark.parametrize(
    "name, axes",
    [
        ("sea", (0, 1)),
        ("clouds_low", (0, 1)),
        ("clouds_high", (0, 1)),
        ("mountains_far", (1,)),
        ("mountains_mid", (1,)),
        ("mountains_near", (1,)),
        ("clouds", (1,)),
        ("coast", (0, 1)),
        ("storm", (0, 1)),
        ("clouds_storm", (0, 1)),
        ("cave_far", (1,)),
        ("cave_near", (1,)),
        ("keep_far", (1,)),
        ("lander_far", (1,)),
        ("lander_mid", (1,)),
        ("lander_near", (1,)),
        ("lander_clouds", (1,)),
    ],
)
def test_backdrop_is_seamless(name, axes):
    """A backdrop changes no more across its seam than between any other two lines."""
    picture = backdrop(name).astype(int)
    for axis in axes:
        steps = abs(np.diff(picture, axis=axis)).mean(axis=tuple({0, 1, 2} - {axis}))
        first, last = np.take(picture, 0, axis), np.take(picture, -1, axis)
        assert abs(first - last).mean() <= max(steps.max(), 2.0)


@pytest.mark.parametrize("ground", ["sea", "coast", "storm"])
def test_shooter_ground_is_dark_and_muted(ground):
    """A background of the shooter has an OKLab lightness of at most 60 % and a chroma of at most 0.09, so that bullets
    are visible.
    """
    lab = oklab(backdrop(ground)[..., :3].reshape(-1, 3))
    assert lab[:, 0].max() <= 0.605
    assert np.sqrt(lab[:, 1] ** 2 + lab[:, 2] ** 2).max() <= 0.09


@pytest.mark.parametrize(
    "name, size",
    [
        ("sky_dusk", (270, 480)),
        ("sea", (540, 480)),
        ("coast", (540, 480)),
        ("storm", (540, 480)),
        ("clouds_low", (540, 480)),
        ("clouds_storm", (540, 480)),
        ("cave_far", (270, 480)),
        ("cave_near", (270, 480)),
        ("keep_far", (150, 480)),
        ("lander_sky", (270, 480)),
        ("lander_ground", (1024, 4096)),
        ("lander_wall", (1024, 4096)),
    ],
)
def test_backdrop_size(name, size):
    assert backdrop(name).shape[:2] == size


@pytest.mark.parametrize("sheet", SIZES)
def test_frames_have_the_sizes_that_rules_are_written_for(sheet):
    frames, _ = load(sheet)
    for name, (width, height) in SIZES[sheet].items():
        assert frames[name].shape[:2] == (height, width), name


@pytest.mark.parametrize("sheet", BARE)
def test_every_sprite_has_the_one_outline(sheet):
    """Solid pixels next to transparent ones have the outline's colour, so no sprite is cut off at its edge."""
    for name, frame in load(sheet)[0].items():
        if any(word in name for word in BARE[sheet]):
            continue
        solid = np.pad(frame[..., 3] > 0, 1)
        inner = solid[:-2, 1:-1] & solid[2:, 1:-1] & solid[1:-1, :-2] & solid[1:-1, 2:]
        edge = solid[1:-1, 1:-1] & ~inner
        other = (frame[..., :3] != OUTLINE).any(-1) & edge
        assert other.sum() <= 0.03 * edge.sum() + 2, f"{name}: {other.sum()} of {edge.sum()} border pixels"


def test_hand_drawn_sprites_use_the_palette_alone():
    things = load("things")[0]
    drawn = {name: things[name] for name in things if name.startswith(("walker", "bat", "spring", "sign"))}
    for frames, letters in ((load("hero")[0], HERO_LETTERS), (drawn, THING_LETTERS)):
        known = {tuple(int(value) for value in colour) for colour in letters.values()}
        for name, frame in frames.items():
            if not name.endswith("_flash"):
                used = {tuple(colour) for colour in frame[frame[..., 3] > 0][:, :3].tolist()}
                assert used <= known, f"{name}: {sorted(used - known)}"


@pytest.mark.parametrize("sheet", ["planes", "things", "hero", "effects", "lander"])
def test_nothing_is_half_clear_or_pure_black(sheet):
    for name, frame in load(sheet)[0].items():
        assert set(np.unique(frame[..., 3])) <= {0, 255}, name
        if "glow" not in name and "light" not in name:
            assert not (frame[frame[..., 3] > 0][:, :3] == 0).all(-1).any(), f"{name} has pure black"


@pytest.mark.parametrize("name", ONE_MASK)
def test_all_pictures_of_what_collides_share_one_silhouette(name):
    frames, animations = load("planes")
    first, *others = (frames[frame][..., 3] > 0 for frame in animations[name]["frames"])
    assert all((first == other).all() for other in others)


def test_the_bosses_looks_differ_in_their_silhouettes():
    frames, _ = load("planes")
    a, b, c = (frames[f"boss_{look}_0"][..., 3] > 0 for look in "abc")
    assert (a & ~b).sum() > 30 and (b & ~c).sum() > 60, "each look has lost something"
    assert (b & ~a).sum() < 0.02 * a.sum(), "nothing grows back"


@pytest.mark.parametrize(
    "sheet, prefixes",
    [
        (
            "planes",
            (
                "player",
                "dart",
                "saucer",
                "gunship",
                "hornet",
                "turret",
                "midboss",
                "boss",
                "core",
                "powerup",
                "bomb_item",
                "life_item",
                "large",
            ),
        ),
        (
            "things",
            ("walker", "bat", "hedgehog", "crumble", "secret_gem", "coin", "spring", "checkpoint", "goal", "platform"),
        ),
        ("hero", ("climb", "push", "duck", "look_up", "jump")),
        ("lander", ("ship", "pad", "crate", "drum", "rock", "can", "mast", "shell")),
    ],
)
def test_bodies_are_in_one_piece(sheet, prefixes):
    for name, frame in load(sheet)[0].items():
        if name.startswith(prefixes):
            assert pieces(frame[..., 3] > 0) == 1, name


def test_belt_pieces_join_and_move():
    frames, _ = load("things")
    left, middle, right = (frames[f"belt_{part}_0"] for part in ("left_end", "mid", "right_end"))
    assert (left[:14, -1, 3] == middle[:14, 0, 3]).all() and (middle[:14, -1, 3] == right[:14, 0, 3]).all()
    assert (frames["belt_mid_0"][1:3] != frames["belt_mid_1"][1:3]).any()
    shifted = np.roll(frames["belt_mid_0"][1:3], 2, 1)
    assert (shifted == frames["belt_mid_1"][1:3]).all(), "the tread runs two pixels to the right"


@pytest.mark.parametrize("upper, lower", [("ladder", "ladder"), ("ladder_top", "ladder")])
def test_ladder_joins_downwards(upper, lower):
    frames, _ = load("tiles")
    assert (frames[upper][-1, :, 3] == frames[lower][0, :, 3]).all()
