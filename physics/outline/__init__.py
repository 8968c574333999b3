"""Conversion of pixels to shapes: contours, smooth outlines, simple enclosing shapes, convex decomposition."""
