"""Every tolerance of the physics: value, unit, why. Lengths are in metres and scaled by `pixels_per_meter`.

Pixels, seconds, radians everywhere else; x right, y down. No tolerance is a bare number of pixels, so that a world
in metres (`pixels_per_meter=1`) behaves as its copy in pixels.
"""

from dataclasses import dataclass
from typing import NamedTuple

PIXELS_PER_METER = 32.0  # a hero of 1.5 m is 48 px: the scale of most pixel art
STANDARD_GRAVITY = 9.8  # [m/s2]

LINEAR_SLOP = 0.005  # [m] overlap or gap in which a contact is kept. Larger: visible sinking. Smaller: flicker
AABB_MARGIN = 0.05  # [m] how far a fat AABB of the tree outgrows its box (Box2D v3), at most …
AABB_MARGIN_FRACTION = 0.125  # … this share of the box, so that tiny bodies stay tight
STEPS_AHEAD = 16.0  # steps of its motion that the rectangle of what flies holds, to be looked for once in so many; …
AHEAD_FRACTION = 0.375  # … at most this share of its box. Larger: more candidates; smaller: more searching
RESTITUTION_SPEED = 1.0  # [m/s] slower impacts do not bounce, or a resting body would tremble for ever
HIT_SPEED = 1.0  # [m/s] slower contacts are not reported as hits: no sound for a crate that rests

# The stacking solvers. Values of the soft step: Box2D v3.2, constants.h, types.c, contact_solver.c.
SPECULATIVE_DISTANCE = (
    4.0 * LINEAR_SLOP
)  # [m] gap at which a contact is prepared. Larger: more rows. Smaller: late contacts
RECYCLE_DISTANCE = (
    0.25 * LINEAR_SLOP
)  # [m] a manifold is used again while its points moved less. Larger: ghosts on corners
RECYCLE_MOVE = 4.0  # times that, of a face that bears another, …
RECYCLE_SHARE = 0.02  # … if no more than this of the way between its points. Both larger: who slides off leaves late
RECYCLE_WANDER = 2.0**-7  # of RECYCLE_DISTANCE: so exactly depths are told. Larger: coarser. Smaller: more is asked
STICKING_TURN = 0.01  # [rad] two faces that stick keep their arms and normal while neither body turned more. Larger:
# boxes tip late (Box2D knows no bound and tips at 35 degrees instead of 27). Smaller: columns buckle as springs do
STICKING_SHARE = 0.5  # … and while they moved against each other by less than this share of SPECULATIVE_DISTANCE
CONTACT_HERTZ = 60.0  # [1/s] stiffness of a contact where the number of substeps is given
AUTO_SUBSTEPS = (4, 8, 16, 32, 64, 128)  # that an island may take, where they follow from …
LOAD_SUBSTEPS = 32  # no more than these for a load alone: stiffer springs ring under a blow
ACCURACY = 0.001  # [m] … what its contacts may sink under their loads. Smaller: stiffer piles that cost more
EASE_TIME = 0.25  # [s] for which fewer substeps would have done before an island takes fewer
LEAN = 20.0  # times less that it may sink, at most, where one end of a face bears more than the other
HERTZ_SHARE = 0.125  # of the substeps per second that a contact's frequency is at most: stiffer springs ring
STALL = 4.0  # times as long as the steps before it, at most, that a step counts as in what contacts remember
CONTACT_DAMPING = 10.0  # damping ratio: far above 1, so that overlap is let out without a bounce
FIRM = 1.5  # times less that a contact gives way which bore a load before …
FIRM_ALONE = 3.0  # … and where it alone bears the one side on the other. Larger: columns of 80 tremble, piles sway
BLOW = 8.0  # times what such a contact bore before the step, beyond which it is struck, and keeps less of an impulse …
BLOW_GIVE = 0.1  # … from substep to substep. 0: a heavy box dropped on a pyramid bounces, tilts and takes it down
STILL_STIFFNESS = 2.0  # contacts with what cannot be pushed are this much stiffer: the ground wins
PUSH_SPEED = 3.0  # [m/s] fastest push out of an overlap. Larger: a deep overlap explodes
CROWD = 8  # contacts of a body that are pushed out at full speed; with more each gets its share of eight, or
# a hundred bodies in one place would be shot apart
BAUMGARTE = (
    0.1  # share of an overlap that sequential impulses take out per step (Chipmunk). 0.2 rocks a column of 15 down
)
PUSH_SHARE = 0.2  # of an overlap that bears nothing, taken out per step of the solver. Larger: crowds jostle
CALM_SHARE = 1e-5  # of the push-out speed: who approaches no faster is still, however its speed was rounded
PUSH_PASSES = 3  # of sequential impulses that let overlaps out; what they leave is left to the next step
ITERATIONS_PER_SUBSTEP = 2.5  # passes of sequential impulses that cost what one substep of the soft step costs: 4 -> 10
COLORS = 62  # bits of an int64 that are safe to shift; what fits in none is solved first, in order
SLEEP_SPEED = 0.05  # [m/s] of the fastest point; whoever gets no further than with this falls asleep after …
SLEEP_TIME = 0.5  # [s] (both Box2D v3.2)
PUSH_ROUNDS = 16  # times that a body is pushed on by kinematic surfaces in the rest of a step: two in a corner
IMPACT_ROUNDS = 64  # times that impacts are looked for again after one stopped another's partner

MAX_CORNERS = 16  # of a convex polygon: what its row of the tables holds. More: larger tables, slower collisions
MASK_ANGLE_BUCKETS = 128  # masks are turned to multiples of 360/128 = 2.8 degrees: the edge of a 64 px sprite moves by
# at most 0.8 px within a bucket, below the pixel grid it is drawn on
DRAWN = 2.5  # [px] rounding to the pixel grid, nearest pixels of a turn, and an outline's distance from them: so far
# besides the bucket's turn may the pixels that are drawn lie from an outline at the exact pose
SMOOTH = 0.5  # [px] how far a mask's outline may leave the pixels' edges, unless the mask says otherwise: as far as no
# pixel's centre changes sides, which is what makes staircases straight. Smaller: what rolls or slides feels pixels
MASK_TILE = 64  # [px] side of the tiles that large masks' outlines are made of, and made anew by when carved. Smaller:
# more parts; larger: slower carving
LARGE_MASK = 128  # [px] masks wider or higher than this are made of tiles: below all of it is rebuilt as fast
PROJECTION_PASSES = 4  # how often the push-out sees every contact; a crate between two walls needs two
SPEED_LIMIT = 1e9  # [m/s] beyond, a double no longer resolves a slop per step: the body is quarantined
SHORTEST_STEP = 1e-30  # [s] shorter ones are none: no double of a clock tells them, and powers of 1/dt overflow
POSITION_LIMIT = 2.0**52  # [px], [rad] beyond, a double no longer resolves one: bodies there are quarantined


class Limits(NamedTuple):
    """By what a contact is told to be still, to stick or to rest."""

    calm_speed: float  # [px/s] what approaches no faster is still
    sticking: float  # [px] see rows.sticks
    slop: float  # [px] see rows.touches_slowly
    bounce_speed: float  # [px/s] slower impacts do not bounce


@dataclass(frozen=True)
class Tolerances:
    """The tolerances of one world in its own pixels."""

    pixels_per_meter: float
    slop: float
    speculative: float
    recycle: float
    push_speed: float
    sleep_speed: float
    restitution_speed: float
    hit_speed: float
    speed_limit: float
    limits: Limits  # in one tuple, as kernels are given them


def tolerances(pixels_per_meter: float) -> Tolerances:
    """All tolerances scaled to a world's pixels per metre."""
    scale = pixels_per_meter
    return Tolerances(
        scale,
        LINEAR_SLOP * scale,
        SPECULATIVE_DISTANCE * scale,
        RECYCLE_DISTANCE * scale,
        PUSH_SPEED * scale,
        SLEEP_SPEED * scale,
        RESTITUTION_SPEED * scale,
        HIT_SPEED * scale,
        SPEED_LIMIT * scale,
        Limits(
            CALM_SHARE * (PUSH_SPEED * scale),
            STICKING_SHARE * (SPECULATIVE_DISTANCE * scale),
            LINEAR_SLOP * scale,
            RESTITUTION_SPEED * scale,
        ),
    )
