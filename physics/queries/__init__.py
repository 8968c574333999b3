"""Queries between steps: ray casts, shape casts, overlaps, points, and queries of two shapes without a world."""
