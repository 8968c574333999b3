"""Overlay layers: each has a key and a check box in the panel, works in any scene, and only reads."""
