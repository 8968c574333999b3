"""Outlines around pixels: contours, simple shapes, convex decomposition."""
