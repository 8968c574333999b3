"""Measurements made apart from the game: times of named work, errors against references, and advice on settings."""
