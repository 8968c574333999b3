"""Deliberate faults and their results: see table.py."""
