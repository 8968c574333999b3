"""Pictures of the lander's moon: its ground, its stations and loose things, the sky behind it."""
