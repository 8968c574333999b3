"""Measurements outside the game loop: times of named work, errors against references, and advice on settings."""
