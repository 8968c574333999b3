"""The lander: a ship whose pixels are its body, over a moon of pixels that craters are blown into."""
