"""Shapes as immutable values, and their geometry in flat arrays, which kernels read."""
