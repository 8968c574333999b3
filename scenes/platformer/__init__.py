"""The platformer: one level in three acts, a hero with ten kinds of forgiveness, and what is met on the way."""
