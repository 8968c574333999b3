"""time_of_impact equals the closed form for shapes of a million pixels that rotate by more than a whole turn."""

import math

import pytest

from physics import Circle, Polygon, time_of_impact

TURN = 7.0  # [rad]


def arm(length, half):
    return Polygon([(0, -half), (length, -half), (length, half), (0, half)])


def turned_to(x, y, half):
    """Return the fraction of the rotation at which the upper edge of an arm about the origin reaches the point (x, y).

    half: half of the arm's thickness.
    """
    angle = math.atan2(y, x) % math.tau
    return (angle - math.asin(half / math.hypot(x, y))) / TURN


@pytest.mark.parametrize("length", [1e2, 1e4, 1e6])
@pytest.mark.parametrize("direction", [0.5, 2.0, 4.0, 6.2])
def test_a_disc(length, direction):
    half, radius, far = 0.01 * length, 0.003 * length, 0.7 * length
    at = (far * math.cos(direction), far * math.sin(direction))
    hit = time_of_impact(arm(length, half), (0, 0, 0), (0, 0, TURN), Circle(radius), at, at)
    assert hit.fraction == pytest.approx(turned_to(*at, half + radius), abs=1e-12)


@pytest.mark.parametrize("length", [1e2, 1e4, 1e6])
@pytest.mark.parametrize("direction", [0.5, 2.0, 4.0, 6.1])
def test_a_corner(length, direction):
    half, far = 0.02 * length, 0.6 * length
    corners = [(0.01 * length, -0.004 * length), (-0.006 * length, 0.011 * length), (-0.003 * length, -0.012 * length)]
    x, y = far * math.cos(direction), far * math.sin(direction)
    hit = time_of_impact(arm(length, half), (0, 0, 0), (0, 0, TURN), Polygon(corners), (x, y, 0), (x, y, 0))
    assert hit.fraction == pytest.approx(min(turned_to(x + u, y + v, half) for u, v in corners), abs=1e-12)
