"""Sprites of the games that the report measures."""

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
    """Return the PixelMask of a sprite. atlas, name: name of the atlas, and name of the sprite in the atlas."""
    return load_atlas(atlas).mask(name)
