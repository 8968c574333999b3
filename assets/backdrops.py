"""Writes the backdrops: single pictures that scenes scroll at their own speeds.

Shooter, 480 x 540, seamless in both directions, to be scrolled downwards: sea, clouds_low with cloud_shadows, and
clouds_high. Platformer, 480 wide, seamless in x and drawn along the bottom of the screen: mountains_far, _mid, _near;
sky_dusk is the fixed screen behind them and clouds a bank for the upper half.
"""

from assets import png
from assets.clouds import from_above, shadow_of
from assets.skyline import backdrop_layers
from assets.terrain import ground

LOW_ALPHA, HIGH_ALPHA, SHADOW_ALPHA = 130, 90, 70   # clear enough that nothing behind a cloud can surprise


def backdrop_files(game):
    """Return {relative path: bytes}. game: "shooter" or "platformer"; ValueError for another."""
    if game == "shooter":
        low = from_above(901, 0.62, LOW_ALPHA, 5, 5)
        layers = {
            "sea": ground(),
            "clouds_low": low,
            "cloud_shadows": shadow_of(low, SHADOW_ALPHA),
            "clouds_high": from_above(903, 0.60, HIGH_ALPHA, 3, 4),
        }
    elif game == "platformer":
        layers = backdrop_layers()
    else:
        raise ValueError(f"no backdrops for {game!r}; choose shooter or platformer")
    return {f"images/{name}.png": png.encode(pixels) for name, pixels in layers.items()}
