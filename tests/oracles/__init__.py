"""Slow reference implementations of fast code, simple enough to be obviously correct."""
