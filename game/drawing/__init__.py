"""Drawing: the canvas and its text, sprites, tiles, particles, and the transfer of the canvas to the window."""
