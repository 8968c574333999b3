"""Drawing: the canvas with its text, sprites, tiles and particles, and the scaling of the canvas onto the window."""
