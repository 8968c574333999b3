"""Writes the backdrops: single pictures that scenes scroll at their own speeds.

Shooter, 480 x 540, seamless in both directions, to be scrolled downwards: the grounds sea, coast and storm; clouds_low
with cloud_shadows, clouds_high and clouds_storm. Platformer, 480 wide, seamless in x and drawn along the bottom of the
screen: mountains_far, _mid, _near and keep_far; sky_dusk is the fixed screen behind them and clouds a bank for the upper
half. Underground cave_far (opaque) and cave_near fill the screen.
"""

from assets import png
from assets.clouds import STORM, from_above, shadow_of
from assets.countryside import countryside
from assets.dripstone import cave_layers
from assets.keep import keep
from assets.skyline import backdrop_layers
from assets.stronghold import stronghold
from assets.terrain import ground

LOW_ALPHA, HIGH_ALPHA, STORM_ALPHA, SHADOW_ALPHA = (
    130,
    90,
    150,
    70,
)  # clear enough that nothing behind a cloud can surprise


def backdrop_files(game):
    """Return {relative path: bytes}. game: "shooter" or "platformer"; ValueError for another."""
    if game == "shooter":
        low = from_above(901, 0.62, LOW_ALPHA, 5, 5)
        layers = {
            "sea": ground(),
            "coast": countryside(),
            "storm": stronghold(),
            "clouds_low": low,
            "cloud_shadows": shadow_of(low, SHADOW_ALPHA),
            "clouds_high": from_above(903, 0.60, HIGH_ALPHA, 3, 4),
            "clouds_storm": from_above(905, 0.54, STORM_ALPHA, 4, 4, STORM),
        }
    elif game == "platformer":
        layers = backdrop_layers() | cave_layers() | {"keep_far": keep()}
    else:
        raise ValueError(f"no backdrops for {game!r}; choose shooter or platformer")
    return {f"images/{name}.png": png.encode(pixels) for name, pixels in layers.items()}
