"""Background pictures of the shooter, 480 x 540 px, which scroll downwards and are seamless in both directions.

The backgrounds are sea, coast and storm. The cloud layers clouds_low, clouds_high and clouds_storm and the layer
cloud_shadows are drawn above them.
"""

from assets.craft import png
from assets.shooter.clouds import STORM, from_above, shadow_of
from assets.shooter.countryside import countryside
from assets.shooter.stronghold import stronghold
from assets.shooter.terrain import ground

# Alpha 0..255, low enough that everything behind a cloud is visible.
LOW_ALPHA, HIGH_ALPHA, STORM_ALPHA, SHADOW_ALPHA = 130, 90, 150, 70


def backdrop_files():
    """Return {path relative to assets/: bytes} of the pictures of all backgrounds, clouds and shadows."""
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
    return {f"images/{name}.png": png.encode(pixels) for name, pixels in layers.items()}
