"""Queries between steps: rays, casts, overlaps, and pairs of shapes without a world."""
