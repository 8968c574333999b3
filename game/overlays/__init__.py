"""Overlay layers: each on a key and a panel check box, on in any scene, mid-game. They only read.

LAYER_NAMES is what --overlay takes. The layers' order is that of the panel: keys 1 to 9, then letters.
"""

LAYER_NAMES = (
    "bounds",
    "motion",
    "structure",
    "pairs",
    "masks",
    "contacts",
    "filters",
    "times",
    "impulses",
    "features",
    "islands",
    "colors",
    "centers",
    "ghosts",
    "outlines",
)
