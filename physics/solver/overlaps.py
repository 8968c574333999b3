"""How fast overlaps that bear nothing are let out: by speeds of their own, which are none of a body's velocity."""

from physics.jit import inlined
from physics.settings import CALM_SHARE


@inlined
def wanted_apart(separation, inverse_h, slop, rate, push_speed):
    """Speed [px/s] that a point has to let an overlap out with, or, negative, may still close a gap with.

    rate [1/s]: of the overlap beyond half a slop. By a slop things may stay in each other (Jolt's penetration slop),
    and they do, or what nothing presses would creep; what is in further comes to rest within it.
    """
    beyond = rate * (-separation - 0.5 * slop)
    beyond = beyond if beyond < push_speed else push_speed
    deep = -separation > slop * (1.0 + CALM_SHARE)
    return -separation * inverse_h if separation > 0.0 else (beyond if deep else 0.0)
