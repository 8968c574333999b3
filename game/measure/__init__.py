"""Measurements outside the frame: times of named work, errors against references, and the settings that follow."""
