"""Scenes that must stay numerically stable."""
