"""Pixels: the canvas and its text, sprites, tiles and particles, and the way from the canvas to the window."""
