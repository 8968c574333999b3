"""The platformer: one level in three acts, a hero with ten kinds of forgiveness, enemies and things."""
