"""Continuous collision detection: time of impact of moving shapes, so that fast bodies do not tunnel."""
