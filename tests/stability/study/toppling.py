"""Analytic limit at which a tower of unit boxes falls, and the time that its rigid upper part takes to turn about its
edge.

The part above an interface stands while its centre of mass is above its support. The support is the overlap of the two
boxes at the interface; at the floor it is the base of the lowest box. Otherwise the part turns as a rigid body about
the end of the support. No engine and no small-angle approximation is used. If several parts cannot stand, the first one
to turn counts. With contacts a hundred times as stiff for their load, soft_step falls within 2 % of this time.
"""

import math

from tests.stability.study.scene import GRAVITY

FINE = 1e-4  # [s] step of the integration


def overhangs(places, size=1.0):
    """Return (number of boxes, overhang, x of the edge) for each upper part of a tower, the whole tower first.

    places: x of the boxes [m], the lowest first. overhang: distance of the part's centre of mass beyond the edge [m];
    the part stands if it is not positive.
    """
    found = []
    for k in range(len(places)):
        below = places[max(0, k - 1)]
        low, high = max(places[k], below) - 0.5 * size, min(places[k], below) + 0.5 * size
        centre = sum(places[k:]) / (len(places) - k)
        beyond = max(centre - high, low - centre)
        found.append((len(places) - k, beyond, high if centre - high >= low - centre else low))
    return found


def stands(places):
    """Return whether every upper part has its centre of mass over its support."""
    return all(beyond <= 0.0 for _, beyond, _ in overhangs(places))


def pendulum(arm, height, inertia, turn, gravity=GRAVITY):
    """Return the time [s] in which a rigid body turns from rest by `turn` [rad] about an edge; inf if it does not turn.

    arm, height: horizontal distance of its centre of mass beyond the edge, and its height above the edge [m]. inertia:
    moment of inertia about the edge, per mass [m2].
    """
    angle = speed = time = 0.0
    if arm <= 0.0:
        return math.inf
    while angle < turn:  # leapfrog: the error of the angle is of the order of FINE squared
        speed += 0.5 * FINE * gravity * (arm * math.cos(angle) + height * math.sin(angle)) / inertia
        angle += FINE * speed
        speed += 0.5 * FINE * gravity * (arm * math.cos(angle) + height * math.sin(angle)) / inertia
        time += FINE
    return time


def fall_time(places, turn=0.1, size=1.0):
    """Return the time [s] until an upper part that cannot stand has turned by `turn` [rad]; inf if all parts stand."""
    least = math.inf
    for count, beyond, edge in overhangs(places, size):
        upper = places[len(places) - count :]
        heights = [(k + 0.5) * size for k in range(count)]
        about = sum(size * size / 6 + (x - edge) ** 2 + y * y for x, y in zip(upper, heights, strict=True)) / count
        least = min(least, pendulum(beyond, 0.5 * count * size, about, turn))
    return least
