"""Integration of bodies, and the quarantine of bodies with numbers that are not finite."""
