"""Shapes as immutable values, and their geometry as flat arrays for kernels."""
