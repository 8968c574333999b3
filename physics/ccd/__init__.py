"""Continuous collision detection: first time of impact of moving shapes."""
