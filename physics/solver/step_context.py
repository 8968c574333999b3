"""StepContext: the constants of the substeps of a group of islands (as b2StepContext)."""

import math
from functools import lru_cache
from typing import NamedTuple

from physics.jit import inlined
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
    Limits,
    Tolerances,
)

NO_PRESS = 1e-9  # share of an acceleration below which its part along a normal is rounding
DRIFT_SHARE = 0.02  # share of the drift of a sticking contact that friction takes back in a step

# ---- context ---------------------------------------------------------------------------------------------------------
# Constants of the substeps of a group of islands: their length, the softness of contacts, the push-out. Source of the
# springs: Catto, Soft Constraints, GDC 2011.


class Softness(NamedTuple):
    """A damped spring as a soft constraint over a substep."""

    bias_rate: float  # [1/s] separation speed per overlap
    grip: float  # weight of the relative velocity against the accumulated impulse: softness 1 / (1 + grip)


class StepContext(NamedTuple):
    """The constants of all substeps of a group of islands."""

    substeps: int
    dt: float  # [s] of the step …
    h: float  # [s] … and of a substep
    inverse_dt: float  # [1/s]
    inverse_h: float
    share: float  # weight of this step in the cached contact forces
    drag: float  # [1/s]
    restitution_speed: float  # [px/s] slower impacts do not bounce
    sleep_speed: float  # [px/s]
    push_speed: float  # [px/s]
    push_rate: float  # [1/s] rate for the overlap of an unloaded contact above …
    slop: float  # [px] … the overlap that may stay
    deep_rate: float  # [1/s] rate for a deep one, 0: no limit, above …
    shallow_speed: float  # [px/s] … the separation speed of a shallow one
    spring: Softness  # of contacts between dynamic bodies …
    static_spring: Softness  # … and with static or kinematic ones
    loaded_stiffness: float  # factor on the grip of a loaded contact …
    sole_support_stiffness: float  # … and of a sole support
    strike_factor: float  # factor on the load before the step above which it counts as struck, and yields
    drift_rate: float  # [1/s] at which friction takes back the drift of a sticking contact
    limits: Limits


def softness(hertz: float, damping: float, h: float) -> Softness:
    """Return the implicit spring of a frequency [1/s] and damping ratio over h [s] (Catto, Soft Constraints, 2011)."""
    omega = math.tau * hertz
    rate = 2.0 * damping + h * omega
    return Softness(omega / rate, h * omega * rate)


@lru_cache(maxsize=64)
def context_of(
    substeps: int, by_load: bool, dt: float, span: float, drag: float, tolerances: Tolerances
) -> StepContext:
    """Return the constants of so many substeps of a step of dt [s].

    by_load: whether the substeps follow from the loads. span [s]: at least dt, the step that springs are tuned for: in
    a shorter step they push no faster.
    """
    h = dt / substeps
    # With substeps by load, springs are as stiff as the substeps allow.
    hertz = HERTZ_SHARE / (span / substeps)
    hertz = hertz if by_load else min(CONTACT_HERTZ, hertz)
    spring = softness(hertz, CONTACT_DAMPING, h)
    slowest = span / AUTO_SUBSTEPS[0]
    return StepContext(
        substeps=substeps,
        dt=dt,
        h=h,
        inverse_dt=1.0 / dt,
        inverse_h=1.0 / h,
        share=dt / span,
        drag=drag,
        restitution_speed=tolerances.restitution_speed,
        sleep_speed=tolerances.sleep_speed,
        push_speed=tolerances.push_speed,
        # More substeps do not separate faster.
        push_rate=PUSH_SHARE * min(substeps, AUTO_SUBSTEPS[0]) / span,
        slop=tolerances.slop,
        deep_rate=softness(HERTZ_SHARE / slowest, CONTACT_DAMPING, slowest).bias_rate if by_load else 0.0,
        shallow_speed=spring.bias_rate * tolerances.speculative,
        spring=spring,
        static_spring=softness(STILL_STIFFNESS * hertz, CONTACT_DAMPING, h),
        loaded_stiffness=FIRM,
        sole_support_stiffness=FIRM_ALONE,
        strike_factor=BLOW if by_load else math.inf,
        drift_rate=DRIFT_SHARE / span,
        limits=tolerances.limits,
    )


# ---- overlaps --------------------------------------------------------------------------------------------------------
# Separation speed of unloaded contacts, which is a pseudo-velocity.


@inlined
def separation_speed(separation, inverse_h, slop, rate, push_speed):
    """Return the separation speed [px/s] of an overlapping point; negative: the speed at which a gap may still close.

    rate [1/s]: share of the overlap beyond half a slop. Shapes may overlap by a slop (Jolt's penetration slop): without
    it, unloaded contacts would creep. Deeper ones come to rest within it.
    """
    beyond = rate * (-separation - 0.5 * slop)
    beyond = beyond if beyond < push_speed else push_speed
    deep = -separation > slop * (1.0 + CALM_SHARE)
    return -separation * inverse_h if separation > 0.0 else (beyond if deep else 0.0)


# ---- restitution -----------------------------------------------------------------------------------------------------


@inlined
def restitution_threshold(contact, a, b, degrees, context):
    """Return the approach speed [px/s] up to which a contact does not bounce.

    A new contact bounces at any speed if no acceleration presses its sides together: otherwise a slow ball would stick
    to a wall in space. One that touched in the step before bounces only beyond what acceleration adds in two steps.
    a, b: MOTION rows of its sides, with their numbers of constraints. Two bodies with other constraints do not fall
    together.
    """
    m = contact
    on_a = a.acceleration_x * m.normal_x + a.acceleration_y * m.normal_y
    on_b = -(b.acceleration_x * m.normal_x + b.acceleration_y * m.normal_y)
    least = NO_PRESS * (abs(a.acceleration_x) + abs(a.acceleration_y) + abs(b.acceleration_x) + abs(b.acceleration_y))
    together = degrees[0] <= 1 and degrees[1] <= 1 and a.inverse_mass > 0.0 and b.inverse_mass > 0.0
    press = on_a + on_b if together else max(on_a, 0.0) + max(on_b, 0.0)
    if m.touched:
        return max(context.restitution_speed, 2.0 * context.dt * press)
    return context.restitution_speed if press > least else 0.0
