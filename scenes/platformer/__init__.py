"""The platformer: one level, a hero with ten kinds of forgiveness, and what is met on the way."""
