"""Overlay layers, which draw the data of the physics over a scene.

Each layer has a key and a check box in the panel, works in any scene, and changes nothing in the scene.
"""
