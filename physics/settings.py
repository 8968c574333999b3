"""The tolerances of the physics, each with unit and reason. Lengths are in metres; `pixels_per_meter` scales them.

Everything else is in pixels, seconds, radians; x right, y down. No tolerance is a bare number of pixels, so a world in
metres (`pixels_per_meter=1`) behaves as its copy in pixels.
"""

from dataclasses import dataclass
from typing import NamedTuple

PIXELS_PER_METER = 32.0  # a hero of 1.5 m is 48 px: the scale of most pixel art
STANDARD_GRAVITY = 9.8  # [m/s2]

LINEAR_SLOP = 0.005  # [m] overlap or gap at which a contact persists. Larger: visible sinking. Smaller: flicker
AABB_MARGIN = 0.05  # [m] margin of a fat AABB of the tree (Box2D v3), at most …
AABB_MARGIN_FRACTION = 0.125  # … this share of the box, so that small bodies stay tight
STEPS_AHEAD = 16.0  # steps of motion that the swept AABB of a flying body covers before it is updated again; …
AHEAD_FRACTION = 0.375  # … at most this share of its box. Larger: more candidates. Smaller: more searches
RESTITUTION_SPEED = 1.0  # [m/s] slower impacts do not bounce; otherwise a resting body would tremble for ever
HIT_SPEED = 1.0  # [m/s] slower contacts are not reported as hits: a resting crate makes no sound

# The stacking solvers. Values of the soft step: Box2D v3.2, constants.h, types.c, contact_solver.c.
SPECULATIVE_DISTANCE = (
    4.0 * LINEAR_SLOP
)  # [m] gap at which a contact is prepared. Larger: more rows. Smaller: late contacts
RECYCLE_DISTANCE = (
    0.25 * LINEAR_SLOP
)  # [m] a manifold is recycled while its points moved less. Larger: ghost collisions at corners
RECYCLE_MOVE = 4.0  # factor on RECYCLE_DISTANCE for two faces, …
RECYCLE_SHARE = (
    0.02  # … at most this share of the distance of the points. Both larger: a sliding body leaves an edge late
)
RECYCLE_WANDER = (
    2.0**-7
)  # precision of reported depths, in RECYCLE_DISTANCE. Larger: coarser. Smaller: fewer are recycled
STICKING_TURN = 0.01  # [rad] sticking faces keep moment arms and normal while neither body rotated more, …
# With a larger STICKING_TURN boxes tip late (Box2D has no bound, and a box tips at 35 degrees instead of 27), with a
# smaller one columns buckle like springs.
STICKING_SHARE = 0.5  # … and while their relative motion is below this share of SPECULATIVE_DISTANCE
CONTACT_HERTZ = 60.0  # [1/s] stiffness of a contact where the number of substeps is given
AUTO_SUBSTEPS = (4, 8, 16, 32, 64, 128)  # numbers of substeps of an island under "auto", chosen by ACCURACY
LOAD_SUBSTEPS = 32  # greatest of these numbers for a load alone: stiffer springs ring after an impact
ACCURACY = 0.001  # [m] greatest sag of a contact under its load with "auto". Smaller: stiffer piles at a higher cost
EASE_TIME = 0.25  # [s] for which fewer substeps must have been enough before an island takes fewer
LEAN = 20.0  # greatest divisor of the allowed sag where one end of a face carries more load than the other
HERTZ_SHARE = 0.125  # greatest contact frequency as a share of the substeps per second: stiffer springs ring
STALL = 4.0  # greatest weight of a long step in the cached contact forces, in steps of the length before it
CONTACT_DAMPING = 10.0  # damping ratio: far above 1, so that bodies separate without a bounce
FIRM = 1.5  # factor on the stiffness of a contact that was loaded before …
FIRM_ALONE = 3.0  # … and is the sole support of one side. Larger: columns of 80 tremble, piles sway
BLOW = 8.0  # factor on the load before the step above which such a contact counts as struck, and keeps less impulse …
BLOW_GIVE = 0.1  # … from substep to substep. 0: a heavy box dropped on a pyramid bounces, tilts and destroys it
STILL_STIFFNESS = 2.0  # factor on the stiffness of contacts with static and kinematic bodies
JOINT_STIFFNESS = 2.0  # factor on the stiffness of joints against that of contacts …
JOINT_DAMPING = 2.0  # … and their damping ratio (both Box2D v3)
PUSH_SPEED = 3.0  # [m/s] fastest push out of an overlap. Larger: a deep overlap explodes
CROWD = 8  # contacts of a body that separate at full speed; with more, each gets its share of eight, otherwise
# a hundred bodies in one place would explode
BAUMGARTE = 0.1  # share of an overlap that sequential impulses remove per step (Chipmunk). 0.2 topples a column of 15
PUSH_SHARE = 0.2  # share of the overlap of an unloaded contact that a solver step removes. Larger: crowds jostle
CALM_SHARE = 1e-5  # share of PUSH_SPEED below which an approach speed is rounding
PUSH_PASSES = 3  # passes of sequential impulses that remove overlaps; later steps remove the rest
ITERATIONS_PER_SUBSTEP = 2.5  # passes of sequential impulses at the cost of one substep of the soft step: 4 -> 10
COLORS = 62  # bits of an int64 that are safe to shift; constraints without a colour are solved first, in order
SLEEP_SPEED = 0.05  # [m/s] of the fastest point; a body that moves no faster on average falls asleep after …
SLEEP_TIME = 0.5  # [s] (both Box2D v3.2)
# A round body that rocks on another loses nothing, and would keep a heap awake for minutes. In a world with sleeping a
# body that rocks within …
ROCKING_RANGE = 0.3  # [m] … of a pose, by its fastest point, for …
ROCKING_TIME = 2.0  # [s] … gets a rolling resistance of …
ROCKING_RESISTANCE = 0.002  # [m] … so that it comes to rest: it moves by that much from its balance at most
PUSH_ROUNDS = 16  # greatest number of pushes by kinematic surfaces in the rest of a step; a corner needs two
IMPACT_ROUNDS = 64  # greatest number of searches for impacts after an impact stopped the partner of another

MAX_CORNERS = 16  # of a convex polygon: the size of its row. More: larger tables, slower collisions
MASK_ANGLE_BUCKETS = 128  # masks are rotated to multiples of 360/128 = 2.8 degrees: the edge of a 64 px sprite moves by
# at most 0.8 px within a bucket, below the pixel grid it is drawn on
DRAWN = 2.5  # [px] greatest distance of drawn pixels from the outline at the exact pose, besides the rotation of the
# bucket: rounding to the pixel grid, nearest pixels of a rotation, and the distance of the outline from them
SMOOTH = 0.5  # [px] default distance of a mask's outline from the pixels' edges: below it no pixel centre changes
# sides, and staircases become straight. Smaller: rolling and sliding bodies feel single pixels
MASK_TILE = 64  # [px] side of the tiles of a large mask's outline; carving rebuilds whole tiles. Smaller: more parts.
# Larger: slower carving
LARGE_MASK = 128  # [px] masks wider or higher than this are tiled; smaller ones are rebuilt as a whole as fast
PROJECTION_PASSES = 4  # passes over all contacts; a crate between two walls needs two
SPEED_LIMIT = 1e9  # [m/s] above it a double does not resolve a slop per step: the body is quarantined
MILLISECONDS = 4  # a length of time that is a whole number from here on is refused: clocks return milliseconds as ints
LONG_STEP = 100.0  # steps of more than this many world.dt, and of MILLISECONDS seconds and more, give a warning
SHORTEST_STEP = 1e-30  # [s] shorter steps count as 0: no clock resolves them, and powers of 1/dt overflow
POSITION_LIMIT = 2.0**52  # [px], [rad] above it a double does not resolve 1: bodies there are quarantined


class Limits(NamedTuple):
    """The thresholds at which a contact counts as resting, sticking or approaching."""

    calm_speed: float  # [px/s] slower approach speeds count as 0
    sticking: float  # [px] see lanes.sticks
    slop: float  # [px] see lanes.touches_slowly
    impact_speed: float  # [px/s] slower approaches are no impacts
    push_speed: float  # [px/s]
    deep: float  # [px] an island may be without room if its overlap is deeper, see energy.find_squeezed
    rocking_range: float  # [px] see ROCKING_RANGE
    rocking_resistance: float  # [px]


@dataclass(frozen=True)
class Tolerances:
    """The tolerances of one world in its own pixels, as world.tolerances holds them.

    pixels_per_meter: their scale.
    slop: overlap or gap at which a contact persists [px]; speculative: gap at which a contact is prepared [px].
    recycle: motion below which a manifold is recycled [px].
    push_speed: fastest push out of an overlap [px/s].
    sleep_speed: a body that moves no faster on average falls asleep [px/s].
    restitution_speed: slower impacts do not bounce [px/s]; hit_speed: slower contacts are not in events.hits [px/s].
    speed_limit: a faster body is quarantined [px/s].
    limits: the same as a tuple for kernels.
    """

    pixels_per_meter: float
    slop: float
    speculative: float
    recycle: float
    push_speed: float
    sleep_speed: float
    restitution_speed: float
    hit_speed: float
    speed_limit: float
    limits: Limits  # one tuple, as kernels take them


def tolerances(pixels_per_meter: float) -> Tolerances:
    """Return all tolerances scaled to the pixels per metre of a world."""
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
            PUSH_SPEED * scale,
            SPECULATIVE_DISTANCE * scale,
            ROCKING_RANGE * scale,
            ROCKING_RESISTANCE * scale,
        ),
    )
