"""Pictures of the lander's moon: its ground, its stations and loose things, and the sky behind it."""
