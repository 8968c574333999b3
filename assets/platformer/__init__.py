"""The hero, what he meets, the tiles, the level and what is behind it."""
