"""Pictures of the platformer: the hero, his enemies and things, the tiles, the level and its background."""
