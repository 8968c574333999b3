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
    JOINT_DAMPING,
    JOINT_STIFFNESS,
    PUSH_SHARE,
    PUSH_SPEED,
    STILL_STIFFNESS,
    Limits,
    Tolerances,
)

NO_PRESS = 1e-9  # share of the accelerations below which their component along a normal is a rounding error
# Gap of a joint of a tree above which pseudo-velocities close it, as a multiple of what the greatest push-out speed
# closes in a substep. Energy that the joint lost does not come back meanwhile. Larger: closing gaps add energy.
# Smaller: gaps of fast chains grow, because pseudo-velocities do not act on velocities.
WIDE_GAP = 2.4
DRIFT_SHARE = 0.02  # share of the tangential drift of a sticking contact that friction undoes in a step

# ---- context ---------------------------------------------------------------------------------------------------------
# Constants of the substeps of a group of islands: length of a substep, softness of contacts, push-out. Source of the
# springs: Catto, Soft Constraints, GDC 2011.


class Softness(NamedTuple):
    """The spring and damper of a soft contact, expressed as two constants for computing the impulse of a substep."""

    bias_rate: float  # [1/s] separation speed per px of overlap
    grip: float  # weight of the relative velocity against the accumulated impulse: softness 1 / (1 + grip)


class StepContext(NamedTuple):
    """The constants of all substeps of a group, which is a set of islands with the same number of substeps."""

    substeps: int
    dt: float  # [s] length of the step …
    h: float  # [s] … and of a substep
    inverse_dt: float  # [1/s]
    inverse_h: float
    share: float  # weight of this step in the cached contact forces
    drag: float  # [1/s]
    restitution_speed: float  # [px/s] slower impacts do not bounce
    sleep_speed: float  # [px/s]
    push_speed: float  # [px/s] greatest separation speed
    push_turn: float  # [rad/s] greatest angular speed that removes an error of an angle
    push_rate: float  # [1/s] separation speed of an unloaded contact per px of overlap beyond half a slop
    slop: float  # [px] overlap that is not removed
    wide_gap: float  # [px] gap of a joint above which no velocity closes it, see WIDE_GAP
    deep_rate: float  # [1/s] greatest separation speed of a loaded contact per px of overlap; 0: no limit
    shallow_speed: float  # [px/s] least value of the limit by deep_rate
    spring: Softness  # for contacts between dynamic bodies
    static_spring: Softness  # for contacts with static or kinematic bodies
    joint: Softness  # of the rigid parts of joints
    loaded_stiffness: float  # factor on the grip of a loaded contact …
    sole_support_stiffness: float  # … and of a sole support
    strike_factor: float  # a contact whose impulse exceeds this multiple of its load counts as struck, and is softer
    drift_rate: float  # [1/s] rate at which friction undoes the tangential drift of a sticking contact
    limits: Limits


def softness(hertz: float, damping: float, h: float) -> Softness:
    """Return the Softness of an implicit spring over a substep of h [s] (Catto, Soft Constraints, 2011).

    hertz [1/s]: frequency of the spring; damping: damping ratio.
    """
    omega = math.tau * hertz
    rate = 2.0 * damping + h * omega
    return Softness(omega / rate, h * omega * rate)


@lru_cache(maxsize=64)
def context_of(
    substeps: int, by_load: bool, dt: float, span: float, drag: float, tolerances: Tolerances
) -> StepContext:
    """Return the constants of a step of dt [s] that is divided into `substeps` substeps.

    by_load: whether the number of substeps was chosen from the loads on the contacts. span [s], at least dt: step
    length for which springs are tuned; a step shorter than `span` does not separate overlaps faster. drag [1/s]:
    damping rate of velocities; tolerances: see settings.Tolerances.
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
        push_turn=PUSH_SPEED,
        # More substeps do not separate faster.
        push_rate=PUSH_SHARE * min(substeps, AUTO_SUBSTEPS[0]) / span,
        slop=tolerances.slop,
        wide_gap=WIDE_GAP * tolerances.push_speed * min(h, slowest),
        deep_rate=softness(HERTZ_SHARE / slowest, CONTACT_DAMPING, slowest).bias_rate if by_load else 0.0,
        shallow_speed=spring.bias_rate * tolerances.speculative,
        spring=spring,
        static_spring=softness(STILL_STIFFNESS * hertz, CONTACT_DAMPING, h),
        joint=softness(JOINT_STIFFNESS * hertz, JOINT_DAMPING, h),
        loaded_stiffness=FIRM,
        sole_support_stiffness=FIRM_ALONE,
        strike_factor=BLOW if by_load else math.inf,
        drift_rate=DRIFT_SHARE / span,
        limits=tolerances.limits,
    )


# ---- overlaps --------------------------------------------------------------------------------------------------------
# Separation of unloaded contacts, by a pseudo-velocity.


@inlined
def separation_speed(separation, inverse_h, slop, rate, push_speed):
    """Return the speed [px/s] at which a point of an unloaded contact should separate.

    A negative result is the speed at which a gap may close within a substep. separation [px]: negative for an overlap;
    inverse_h [1/s]: inverse of a substep; rate [1/s]: speed per px of overlap beyond half a slop; push_speed [px/s]:
    greatest result. An overlap of up to a slop [px] is left in place (as Jolt's penetration slop), otherwise unloaded
    contacts would creep.
    """
    beyond = rate * (-separation - 0.5 * slop)
    beyond = beyond if beyond < push_speed else push_speed
    deep = -separation > slop * (1.0 + CALM_SHARE)
    return -separation * inverse_h if separation > 0.0 else (beyond if deep else 0.0)


# ---- restitution -----------------------------------------------------------------------------------------------------


@subkernel
def speed_of_impact(speed, separation, acceleration):
    """Return the approach speed [px/s] that two shapes will have when they touch, predicted from before the step.

    speed [px/s]: present approach speed; separation [px]: gap; acceleration [px/s2]: growth of the approach speed. The
    result is `speed` if the shapes already overlap, or if they move apart.
    """
    if speed <= 0.0 or separation <= 0.0:
        return speed
    return math.sqrt(max(speed * speed + 2.0 * acceleration * separation, 0.0))


@inlined
def restitution_threshold(contact, a, b, degrees, context):
    """Return the approach speed [px/s] up to which a contact does not bounce.

    The result is context.restitution_speed, with two exceptions. First, a new contact bounces at any speed if no
    acceleration presses its bodies together. Otherwise a slow ball would stick to a wall in space. Second, a contact
    that touched in the last step must exceed the speed that acceleration adds in two steps, if that speed is greater.

    Two bodies without other contacts fall together, so only the difference of their accelerations presses them.
    contact: CONTACT row; a, b: MOTION rows; degrees: numbers of contacts of A and of B; context: see StepContext.
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
