"""Integration of bodies, and the check for numbers that are not finite."""
