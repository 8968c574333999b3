"""The lander's moon: its ground, what stands and lies on it, the sky behind it."""
