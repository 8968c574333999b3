"""Background layers of the platformer's level, 480 px wide. Layers that scroll are seamless in x.

mountains_far, mountains_mid, mountains_near and keep_far are drawn along the bottom of the screen. sky_dusk is the
fixed sky behind them. clouds is a bank of clouds for the upper half. Underground, cave_far (opaque) and cave_near fill
the screen.
"""

from assets.craft import png
from assets.platformer.dripstone import cave_layers
from assets.platformer.keep import keep
from assets.platformer.skyline import backdrop_layers


def backdrop_files():
    """Return {path relative to assets/: bytes} of the pictures of all layers."""
    layers = backdrop_layers() | cave_layers() | {"keep_far": keep()}
    return {f"images/{name}.png": png.encode(pixels) for name, pixels in layers.items()}
