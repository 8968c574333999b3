"""Slow twins of the fast code, obviously right, importing nothing from physics."""
