"""Shapes as values, and the flat geometry of them that kernels read."""
