"""The sheets "planes" and "effects" and the shooter's grounds."""
