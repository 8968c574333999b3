"""Drawing for lab/shapes: projections of two shapes on SAT's best axis, and their Minkowski difference."""

from math import cos, sin

import numpy as np
import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GREEN, PAPER, PINK, RED, SLATE, WHITE, YELLOW, faded
from game.overlays.layer_impulses import arrow
from game.overlays.outlines import clockwise, ring
from scenes.lab.pieces import hull

RULER = 12.0  # [px] from the shapes to the ruler with their projections
MARGIN = 12  # [canvas px] around the picture of the differences


def draw_shadows(frame, lens, placed, axes, colors):
    """Draw the tested axes as short strokes on their edges, and both projections on a ruler along the best axis.

    lens: transform of world points to frame points; placed: (corners, radius) of both shapes, as placed_hull() returns
    them; axes: AXIS rows of shape_traces.sat_axes, the best first; colors: colours of both shapes.
    """
    for row in axes[::-1]:
        points, radius = placed[int(row["owner"])]
        edge = int(row["edge"])
        if 0 <= edge < len(points) and len(points) > 1:
            (ax, ay), (bx, by) = points[edge], points[(edge + 1) % len(points)]
            sign = -1.0 if row["owner"] else 1.0
            nx, ny = float(row["normal_x"]) * sign, float(row["normal_y"]) * sign
            x, y = (ax + bx) / 2 + nx * radius, (ay + by) / 2 + ny * radius
            is_best = row["separation"] == axes[0]["separation"]
            pygame.draw.line(
                frame.surface,
                PAPER if is_best else SLATE,
                lens.points(x, y),
                lens.points(x + 7 * nx, y + 7 * ny),
                max(1, frame.scale - 1) if is_best else 1,
            )
    nx, ny = float(axes[0]["normal_x"]), float(axes[0]["normal_y"])
    ends = [
        (min(px * nx + py * ny for px, py in points) - radius, max(px * nx + py * ny for px, py in points) + radius)
        for points, radius in placed
    ]
    middle = (ends[0][1] + ends[1][0]) / 2
    # Below the shapes, or above them if there is no room below.
    sides = sorted(((-ny, nx), (ny, -nx)), key=lambda side: -side[1])
    for tx, ty in sides:
        aside = max(px * tx + py * ty + radius for points, radius in placed for px, py in points) + RULER
        if frame.surface.get_clip().collidepoint(
            lens.points(nx * middle + tx * (aside + RULER), ny * middle + ty * (aside + RULER))
        ):
            break

    def at(along, off=0.0):
        return lens.points(nx * along + tx * (aside + off), ny * along + ty * (aside + off))

    thick = max(1, frame.scale)
    pygame.draw.line(frame.surface, SLATE, at(min(ends[0][0], ends[1][0]) - 10), at(max(ends[0][1], ends[1][1]) + 10))
    for number, (low, high) in enumerate(ends):
        pygame.draw.line(
            frame.surface, colors[number], at(low, 2.5 * (2 * number - 1)), at(high, 2.5 * (2 * number - 1)), thick
        )
    low, high = ends[0][1], ends[1][0]
    pygame.draw.line(frame.surface, GREEN if high > low else RED, at(low), at(high), 2 * thick)
    x, y = at(middle, 8.0)
    frame.text_if_free(
        f"{high - low:.2f}",
        x,
        y - 2 * frame.text_scale,
        GREEN if high > low else RED,
        SMALL,
        frame.text_scale,
        "center",
        True,
    )


def draw_differences(frame, rect, placed, meets, step):
    """Draw the Minkowski difference of two shapes, without and with their rounding radii, and the origin.

    rect: rectangle of the frame; placed: (corners, radius) of both shapes, as placed_hull() returns them; meets:
    whether the shapes overlap; step: iteration of GJK or EPA whose simplex or polytope is drawn, or None.
    """
    core = difference(placed[0][0], placed[1][0])
    radius = placed[0][1] + placed[1][1]
    outer = np.array(ring(core, radius, 2.0))
    low = np.minimum(outer.min(axis=0), 0.0)
    high = np.maximum(outer.max(axis=0), 0.0)
    zoom = min(
        (rect.width - 2 * MARGIN * frame.scale) / (high - low)[0],
        (rect.height - 2 * MARGIN * frame.scale) / (high - low)[1],
    )
    shift = np.array(rect.center) - (low + high) / 2 * zoom

    def at(points):
        return (np.asarray(points, float).reshape(-1, 2) * zoom + shift).tolist()

    surface = frame.surface
    surface.set_clip(rect)
    if len(outer) > 2:
        pygame.draw.polygon(surface, (62, 34, 44) if meets else (30, 52, 60), at(outer))
    pygame.draw.lines(surface, FOG, True, at(outer), 1)
    if radius and len(core) > 1:
        pygame.draw.lines(surface, SLATE, len(core) > 2, at(core), 1)
    ((ox, oy),) = at((0.0, 0.0))
    pygame.draw.line(surface, faded(PAPER, 0.7), (rect.left, oy), (rect.right, oy))
    pygame.draw.line(surface, faded(PAPER, 0.7), (ox, rect.top), (ox, rect.bottom))
    if step is not None:
        is_epa = step["phase"] == "epa"
        color, points = (PINK, step["polytope"]) if is_epa else (YELLOW, step["simplex"])
        places = at(points) if len(points) else []
        if len(places) > 1:
            pygame.draw.lines(surface, color, len(places) > 2, places, max(1, frame.scale - 1))
        for place in places:
            pygame.draw.circle(surface, color, place, 1.6 * frame.scale)
        dx, dy = step["direction"]
        arrow(frame, ox, oy, dx * 14 * frame.scale, dy * 14 * frame.scale, color)
    pygame.draw.circle(surface, WHITE, (ox, oy), 1.6 * frame.scale)
    surface.set_clip(None)


def placed_hull(shape, pose):
    """Return (corners, radius) of a convex shape at a pose (x, y, angle) [px, rad].

    corners: list of (x, y), clockwise on the screen; radius: rounding radius [px].
    """
    points, radius = hull(shape)
    c, s = cos(pose[2]), sin(pose[2])
    placed = points @ np.array([[c, s], [-s, c]]) + pose[:2]
    return (clockwise(placed) if len(placed) > 2 else placed.tolist()), radius


def difference(a, b):
    """Return the corners of the Minkowski difference A - B of two lists of points: a list of [x, y], clockwise on the
    screen.
    """
    points = sorted({(round(ax - bx, 9), round(ay - by, 9)) for ax, ay in a for bx, by in b})
    if len(points) < 3:
        return [list(point) for point in points]
    halves = []
    for order in (points, points[::-1]):
        half = []
        for x, y in order:
            while (
                len(half) > 1
                and ((half[-1][0] - half[-2][0]) * (y - half[-2][1]) - (half[-1][1] - half[-2][1]) * (x - half[-2][0]))
                <= 1e-9
            ):
                half.pop()
            half.append((x, y))
        halves += half[:-1]
    return [list(point) for point in halves]
