"""Overlay layers: each on a key and a panel check box, on in any scene, mid-game. They only read.

LAYER_NAMES is what --overlay takes. The layers' order is their drawing order and their key: 1 to 8.
"""

LAYER_NAMES = ("bounds", "motion", "structure", "pairs", "masks", "contacts", "filters", "times")
