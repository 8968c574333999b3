"""Every tolerance of the physics: value, unit, why. Lengths are in metres and scaled by `pixels_per_meter`.

Pixels, seconds, radians everywhere else; x right, y down. No tolerance is a bare number of pixels, so that a world
in metres (`pixels_per_meter=1`) behaves as its copy in pixels.
"""

from dataclasses import dataclass

PIXELS_PER_METER = 32.0      # a hero of 1.5 m is 48 px: the scale of most pixel art
STANDARD_GRAVITY = 9.8       # [m/s2]

LINEAR_SLOP = 0.005          # [m] overlap or gap in which a contact is kept. Larger: visible sinking. Smaller: flicker
AABB_MARGIN = 0.05           # [m] how far a fat AABB of the tree outgrows its box (Box2D v3), at most …
AABB_MARGIN_FRACTION = 0.125  # … this share of the box, so that tiny bodies stay tight
RESTITUTION_SPEED = 1.0      # [m/s] slower impacts do not bounce, or a resting body would tremble for ever
HIT_SPEED = 1.0              # [m/s] slower contacts are not reported as hits: no sound for a crate that rests

MASK_ANGLE_BUCKETS = 128     # masks are turned to multiples of 360/128 = 2.8 degrees: the edge of a 64 px sprite moves by
                             # at most 0.8 px within a bucket, below the pixel grid it is drawn on
PROJECTION_PASSES = 4        # how often the push-out sees every contact; a crate between two walls needs two
SPEED_LIMIT = 1e9            # [m/s] beyond, a double no longer resolves a slop per step: the body is quarantined
POSITION_LIMIT = 2.0 ** 52   # [px] beyond, a double no longer resolves a pixel: bodies there are quarantined


@dataclass(frozen=True)
class Tolerances:
    """The tolerances of one world in its own pixels."""
    pixels_per_meter: float
    slop: float
    restitution_speed: float
    hit_speed: float
    speed_limit: float


def tolerances(pixels_per_meter: float) -> Tolerances:
    """All tolerances scaled to a world's pixels per metre."""
    scale = pixels_per_meter
    return Tolerances(scale, LINEAR_SLOP * scale, RESTITUTION_SPEED * scale, HIT_SPEED * scale, SPEED_LIMIT * scale)
