"""Overlay layers: each on a key and a panel check box, on in any scene, mid-game. They only read."""
