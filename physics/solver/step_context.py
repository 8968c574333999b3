"""StepContext: the constants of the substeps of a group of islands (as b2StepContext)."""

import math
from functools import lru_cache
from typing import NamedTuple

from physics.jit import inlined, subkernel
from physics.settings import (
    AUTO_SUBSTEPS,
    BLOW,
    CALM_SHARE,
    CONTACT_DAMPING,
    CONTACT_HERTZ,
    FIRM,
    FIRM_ALONE,
    HERTZ_SHARE,
    PUSH_SHARE,
    STILL_STIFFNESS,
)

# ---- pace ------------------------------------------------------------------------------------------------------------
# What the substeps of a group of islands have in common: how long they are, how stiff contacts, how fast overlaps go.
#
# Source of the springs: Catto, Soft Constraints, GDC 2011.


class Softness(NamedTuple):
    """A damped spring as a constraint over a substep."""

    bias_rate: float  # [1/s] speed that it pushes out with, of the overlap
    grip: (
        float  # how many times its own speed counts more than the impulse it has given: it gives way by 1 / (1 + grip)
    )


class Pace(NamedTuple):
    """What all substeps of a group of islands have in common."""

    substeps: int
    h: float  # [s]
    inverse_h: float
    drag: float  # [1/s]
    push_speed: float  # [px/s]
    push_rate: float  # [1/s] of an overlap that bears nothing, beyond …
    slop: float  # [px] … what may stay
    deep_rate: float  # [1/s] of one that is deep, 0: as fast as it can, beyond …
    shallow_speed: float  # [px/s] … what a shallow one may come out with
    spring: Softness  # of a contact between bodies …
    still_spring: Softness  # … and of one with what cannot be pushed
    firm: float  # how many times the grip of what bears a load is greater …
    firm_alone: float  # … and of what alone bears the one side on the other
    blow: float  # how many times what it bore before the step is a blow, which it gives way to


def softness(hertz: float, damping: float, h: float) -> Softness:
    """The implicit spring of a frequency [1/s] and damping ratio over h [s] (Catto, Soft Constraints, 2011)."""
    omega = math.tau * hertz
    rate = 2.0 * damping + h * omega
    return Softness(omega / rate, h * omega * rate)


@subkernel
def firmness_of(r, pace):
    """How many times a CONSTRAINT row grips firmer, and gives way less, than a spring of its own.

    What bears a load swings as slowly as the load is heavy, so its springs may be stiffer for as much damping; what has
    just met is none of that.
    """
    if not r.loaded or r.meets:
        return 1.0
    return pace.firm_alone if r.alone else pace.firm


@lru_cache(maxsize=64)
def pace_of(
    substeps: int, asked: bool, dt: float, span: float, drag: float, push_speed: float, slop: float, speculative: float
) -> Pace:
    """What so many substeps of a step of dt [s] have in common; asked: they follow from the loads; span [s]: no less
    than dt, the length that springs are made for: in a short step they push no faster than in those before."""
    h = dt / substeps
    # Where the substeps follow from the loads, springs are as stiff as they allow.
    hertz = HERTZ_SHARE / (span / substeps)
    hertz = hertz if asked else min(CONTACT_HERTZ, hertz)
    spring = softness(hertz, CONTACT_DAMPING, h)
    slowest = span / AUTO_SUBSTEPS[0]
    return Pace(
        substeps=substeps,
        h=h,
        inverse_h=1.0 / h,
        drag=drag,
        push_speed=push_speed,
        # More substeps let nothing out faster.
        push_rate=PUSH_SHARE * min(substeps, AUTO_SUBSTEPS[0]) / span,
        slop=slop,
        deep_rate=softness(HERTZ_SHARE / slowest, CONTACT_DAMPING, slowest).bias_rate if asked else 0.0,
        shallow_speed=spring.bias_rate * speculative,
        spring=spring,
        still_spring=softness(STILL_STIFFNESS * hertz, CONTACT_DAMPING, h),
        firm=FIRM,
        firm_alone=FIRM_ALONE,
        blow=BLOW if asked else math.inf,
    )


# ---- overlaps --------------------------------------------------------------------------------------------------------
# How fast overlaps that bear nothing are let out: by speeds of their own, which are none of a body's velocity.


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
