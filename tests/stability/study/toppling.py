"""When a tower of unit boxes must fall, and how long its rigid upper part takes to turn about its edge.

The part above each interface stands while its centre of mass lies over its support. The support is the stretch that the
two boxes of the interface share; at the floor it is the foot of the lowest box. Beyond it, the part turns about the end
of the stretch as a rigid body. No engine and no small angles are used. If several parts cannot stand, the first one to
turn counts. With contacts a hundred times as stiff for their load, soft_step falls within 2 % of that time.
"""

import math

from tests.stability.study.scene import GRAVITY

FINE = 1e-4  # [s] step of the integration


def overhangs(places, size=1.0):
    """Return (number of its boxes, distance, x of the edge) of each upper part, the whole tower first.

    places: x of the boxes [m], the lowest first. distance: distance of the part's centre of mass beyond the edge [m];
    below 0 the part stands.
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
    """Return the seconds that a rigid body takes from rest to turn by `turn` [rad] about an edge; inf if it does not
    turn.

    arm, height: place of its centre of mass beyond and above the edge [m]; inertia: about the edge, per mass [m2].
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
    """Return the seconds until an upper part that cannot stand has turned by `turn` [rad]; inf if all stand."""
    least = math.inf
    for count, beyond, edge in overhangs(places, size):
        upper = places[len(places) - count :]
        heights = [(k + 0.5) * size for k in range(count)]
        about = sum(size * size / 6 + (x - edge) ** 2 + y * y for x, y in zip(upper, heights, strict=True)) / count
        least = min(least, pendulum(beyond, 0.5 * count * size, about, turn))
    return least
