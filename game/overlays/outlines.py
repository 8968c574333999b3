"""Thin lines around shapes of every kind, made from the outlines of physics.debug.

Overlays and labs draw these lines.
"""

from collections.abc import Sequence
from itertools import pairwise
from math import atan2, ceil, cos, hypot, pi, sin

import numpy as np
import pygame
from numpy.typing import ArrayLike

from game.drawing.colors import Color
from game.drawing.presenter import Lens

Point = tuple[float, float]
Pose = tuple[float, float, float]

ARC_STEP = 2.5  # [frame px] length of a line segment of an arc
TICK_GAP, TICK_LENGTH = 7.0, 4.0  # [canvas px] hatching on the solid side of a chain
TICK_BUDGET = 400  # most ticks drawn for one chain


def ring(points: Sequence[Sequence[float]], radius: float, scale: float) -> list[Point]:
    """Return the outline of a convex shape that is rounded by `radius`, as a list of corners (x, y).

    points: (k, 2) corners of the shape, clockwise on the screen; scale: frame px per world px, which determines the
    number of segments per arc.
    """
    count = len(points)
    if count == 1:
        x, y = points[0]
        steps = _steps(2 * pi, radius, scale)
        return [(x + radius * cos(2 * pi * i / steps), y + radius * sin(2 * pi * i / steps)) for i in range(steps)]
    if radius <= 0.0:
        return [(x, y) for x, y in points]
    facing = []
    for i in range(count):
        (ax, ay), (bx, by) = points[i], points[(i + 1) % count]
        facing.append(atan2(-(bx - ax), by - ay))
    out = []
    for i, (x, y) in enumerate(points):
        start = facing[i - 1]
        turn = (facing[i] - start) % (2 * pi)
        steps = _steps(turn, radius, scale)
        out += [
            (x + radius * cos(start + turn * j / steps), y + radius * sin(start + turn * j / steps))
            for j in range(steps + 1)
        ]
    return out


def _steps(turn, radius, scale):
    return max(1 if turn < pi else 6, min(96, ceil(turn * radius * scale / ARC_STEP)))


def corners_of(outline: tuple, scale: float = 1.0) -> tuple[list[Point], bool] | None:
    """Return (corners, closed) of an outline of physics.debug; None for masks and tiles.

    corners: list of (x, y) in the world; closed: whether the outline is closed; scale: as in ring().
    """
    kind = outline[0]
    if kind == "circle":
        return ring([outline[1:3]], outline[3], scale), True
    if kind == "capsule":
        _, ax, ay, bx, by, radius = outline
        return ring([(ax, ay), (bx, by)], radius, scale), True
    if kind == "rounded":
        return ring(clockwise(outline[1]), outline[2], scale), True
    if kind == "polygon":
        return [tuple(point) for point in np.asarray(outline[1]).tolist()], True
    if kind in ("segment", "chain"):
        return [tuple(point) for point in np.asarray(outline[1]).tolist()], False
    return None


def clockwise(points: ArrayLike) -> list[list[float]]:
    """Return the corners of a polygon as a list, in clockwise order on the screen. Other orders are reversed."""
    points = np.asarray(points, float)
    x, y = points[:, 0], points[:, 1]
    area = float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))
    return (points if area >= 0.0 else points[::-1]).tolist()


def moved(outline: tuple, start: Pose, end: Pose) -> tuple:
    """Return an outline, moved with its body from the pose `start` to the pose `end`.

    outline: an outline of physics.debug, or ("lines", (2n, 2) points). A pose is (x, y, angle).
    """
    turn = end[2] - start[2]
    cosine, sine = cos(turn), sin(turn)

    def place(x, y):
        dx, dy = x - start[0], y - start[1]
        return end[0] + cosine * dx - sine * dy, end[1] + sine * dx + cosine * dy

    kind = outline[0]
    if kind == "circle":
        return ("circle", *place(*outline[1:3]), outline[3])
    if kind == "capsule":
        return ("capsule", *place(*outline[1:3]), *place(*outline[3:5]), outline[5])
    if kind in ("polygon", "segment", "chain", "rounded", "lines"):
        points = np.array([place(x, y) for x, y in np.asarray(outline[1]).tolist()])
        return (kind, points, *outline[2:])
    return outline


def draw_outline(
    surface: pygame.Surface, lens: Lens, outline: tuple, color: Color, width: int = 1, scale: int = 1
) -> None:
    """Draw an outline of physics.debug. A chain is also hatched on its solid side.

    lens: maps world to frame coordinates; width: line width [frame px]; scale: frame px per canvas px.
    """
    kind = outline[0]
    if kind == "lines":
        draw_lines(surface, lens, np.asarray(outline[1]).reshape(-1, 4), color, width)
        return
    if kind == "circle":
        center = lens.points(outline[1], outline[2])
        pygame.draw.circle(surface, color, center, max(outline[3] * lens.scale, 1.0), width)
        return
    found = corners_of(outline, lens.scale)
    if found is None:
        return
    corners, closed = found
    points = [lens.points(x, y) for x, y in corners]
    if len(points) > 1:
        pygame.draw.lines(surface, color, closed, points, width)
    if kind == "chain":
        _draw_ticks(surface, lens.clip, points, color, scale)


def draw_lines(surface: pygame.Surface, lens: Lens, lines: np.ndarray, color: Color, width: int = 1) -> None:
    """Draw separate lines.

    lines: (n, 4) in world coordinates, with columns ax, ay, bx, by; width: line width [frame px].
    """
    ax, ay = lens.points(lines[:, 0], lines[:, 1])
    bx, by = lens.points(lines[:, 2], lines[:, 3])
    draw = pygame.draw.line
    for x0, y0, x1, y1 in np.column_stack((ax, ay, bx, by)).tolist():
        draw(surface, color, (x0, y0), (x1, y1), width)


def _draw_ticks(surface, clip, points, color, scale):
    """Draw hatching on the solid side of a chain, which is the side opposite to its normals.

    points: corners of the chain [frame px]; scale: frame px per canvas px.
    """
    room = clip.inflate(8 * scale, 8 * scale)
    left = TICK_BUDGET
    for (ax, ay), (bx, by) in pairwise(points):
        length = hypot(bx - ax, by - ay)
        if length == 0.0 or not room.clipline((ax, ay), (bx, by)):
            continue
        dx, dy = (bx - ax) / length, (by - ay) / length
        # Normal (dy, -dx); the ticks lean back a little, like the ground symbol of engineering drawings.
        lean_x, lean_y = (-dy - 0.6 * dx) * TICK_LENGTH * scale, (dx - 0.6 * dy) * TICK_LENGTH * scale
        count = max(1, int(length / (TICK_GAP * scale)))
        for i in range(min(count, left)):
            x, y = ax + (bx - ax) * (i + 0.5) / count, ay + (by - ay) * (i + 0.5) / count
            pygame.draw.line(surface, color, (x, y), (x + lean_x, y + lean_y))
        left -= min(count, left)
