"""Overlay layers, which draw what the physics computes over a scene. Each has a key and a check box in the panel, works
in any scene, and changes nothing.
"""
