"""Sprites of the games, as the report measures them."""

from game.drawing.sprites import load_atlas
from physics import PixelMask

SPRITES = (
    ("planes", "gunship_0"),
    ("planes", "player"),
    ("planes", "saucer_0"),
    ("planes", "boss_a_0"),
    ("planes", "large_plane_a"),
    ("hero", "run_1"),
    ("things", "walker_0"),
    ("things", "hedgehog_0"),
    ("lander", "ship"),
    ("lander", "rock_1"),
)
FEW = (SPRITES[1], SPRITES[2], SPRITES[5])


def mask_of(atlas: str, name: str) -> PixelMask:
    """Return the PixelMask of a sprite. atlas, name: as for load_atlas() and its mask()."""
    return load_atlas(atlas).mask(name)
