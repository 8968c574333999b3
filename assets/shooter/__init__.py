"""The sheets "planes" and "effects" and the grounds the shooter flies over."""
