"""The billiard table: geometry of cushions, pockets and rack, and functions that find a shot for the cue ball."""

from math import cos, hypot, pi

import pygame

from physics import Polygon

CLOTH = pygame.Rect(24, 44, 344, 168)  # [px] between the cushions; canvas and world have the same coordinates
BALL, MOUTH = 5.0, 5.0  # [px] radius of a ball and of the sensor in a pocket
HOLES = tuple((x, y) for x in (CLOTH.left, CLOTH.centerx, CLOTH.right) for y in (CLOTH.top, CLOTH.bottom))
CORNER_GAP, SIDE_GAP, JAW, DEEP = 14, 12, 6, 12  # [px] of the cushions: cut at corner and side, slant, depth
HEAD_SPOT = (CLOTH.left + CLOTH.width / 4, CLOTH.centery)
FOOT_SPOT = (CLOTH.left + CLOTH.width * 0.72, CLOTH.centery)
RACK_GAP = 0.4  # [px] between racked balls
RACK = (1, 9, 2, 10, 8, 3, 4, 11, 5, 12, 13, 6, 14, 7, 15)


def cushions():
    """Return a list of Polygon: the six cushions, and the four parts of the wooden frame behind the pockets."""
    left, top, right, bottom, middle = CLOTH.left, CLOTH.top, CLOTH.right, CLOTH.bottom, CLOTH.centerx
    shapes = []
    for y, way in ((top, -1), (bottom, 1)):
        for a, b in ((left + CORNER_GAP, middle - SIDE_GAP), (middle + SIDE_GAP, right - CORNER_GAP)):
            shapes.append(Polygon(((a, y), (b, y), (b + JAW, y + way * DEEP), (a - JAW, y + way * DEEP))))
    for x, way in ((left, -1), (right, 1)):
        a, b = top + CORNER_GAP, bottom - CORNER_GAP
        shapes.append(Polygon(((x, a), (x, b), (x + way * DEEP, b + JAW), (x + way * DEEP, a - JAW))))
    wide, high, deep = CLOTH.width + 2 * DEEP, CLOTH.height + 2 * DEEP, 40
    for x, y, width, height in (
        (CLOTH.centerx, top - DEEP - deep / 2, wide + 2 * deep, deep),
        (CLOTH.centerx, bottom + DEEP + deep / 2, wide + 2 * deep, deep),
        (left - DEEP - deep / 2, CLOTH.centery, deep, high),
        (right + DEEP + deep / 2, CLOTH.centery, deep, high),
    ):
        shapes.append(Polygon.box(width, height, (x, y)))
    return shapes


def rack(random):
    """Yield (number, (x, y) [px]) for each of the fifteen racked balls. `random` moves each ball slightly from its
    spot.
    """
    step_x, step_y = (2 * BALL + RACK_GAP) * cos(pi / 6), BALL + RACK_GAP / 2
    numbers = iter(RACK)
    for row in range(5):
        for column in range(row + 1):
            x = FOOT_SPOT[0] + row * step_x + random.uniform(-0.1, 0.1)
            y = FOOT_SPOT[1] + (2 * column - row) * step_y + random.uniform(-0.1, 0.1)
            yield next(numbers), (x, y)


def first_in_the_way(start, heading, balls):
    """Return (distance, position): how far [px] the cue ball moves from `start` until it meets a ball or cushion.

    position: centre of the ball that it meets, or None if a cushion comes first. `heading`: unit vector of the motion;
    `balls`: positions of the other balls [px].
    """
    (x, y), (c, s) = start, heading
    room = CLOTH.inflate(-2 * BALL, -2 * BALL)
    ends = [
        (edge - place) / way
        for edge, place, way in ((room.right if c > 0 else room.left, x, c), (room.bottom if s > 0 else room.top, y, s))
        if way
    ]
    free, struck = max(0.0, min(ends)), None
    for place in balls:
        along, beside = (place[0] - x) * c + (place[1] - y) * s, (place[1] - y) * c - (place[0] - x) * s
        if along > 0.0 and abs(beside) < 2 * BALL:
            reach = along - (4 * BALL * BALL - beside * beside) ** 0.5
            if reach < free:
                free, struck = max(reach, 0.0), place
    return free, struck


def best_point(cue, balls):
    """Return the point (x, y) [canvas px, integers] at which to aim the cue ball in order to pot a ball.

    The function chooses the ball and the pocket with the straightest and shortest shot. cue: position of the cue ball
    [px]; balls: positions of the other balls [px].
    """
    x, y = cue
    best = (-2.0, (round(x) + 40, round(y)))
    for bx, by in balls:
        for hx, hy in HOLES:
            far = hypot(hx - bx, hy - by)
            if far < 1.0:
                continue
            gx, gy = bx - (hx - bx) / far * 2 * BALL, by - (hy - by) / far * 2 * BALL
            near = hypot(gx - x, gy - y)
            straight = ((gx - x) * (hx - bx) + (gy - y) * (hy - by)) / (far * max(near, 1.0))
            best = max(best, (straight - (far + near) / 800.0, (round(gx), round(gy))))
    return best[1]
