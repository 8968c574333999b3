"""Pictures of the shooter: the sheets "planes" and "effects", and the backgrounds."""
