"""Bounding motion rectangles: where each shape can be during the step. They are what the broad phase compares."""

import math

from physics.jit import kernel
from physics.math2d import length_of, turned
from physics.shapes.placement import aabb_at, raster_aabb, raster_at
from physics.tables.body import STATIC
from physics.tables.shape import BOUNDS, MASK


def make_rectangle_pass(rotation: bool):
    """The pass over the shapes; with rotation a rectangle also holds the arcs between the first and the last pose."""

    @kernel
    def update_rectangles(
        # read
        geometry,
        bodies,
        dt,
        margin,
        # write
        shapes_inout,
        proxies_inout,
        changed_out,
    ):
        """Write the motion rectangle of every shape that can move or was moved, and list the slots that changed.

        margin [px] is added around what is not static, so that contacts within it stay candidates; changed_out: slots.
        Returns the number of changed slots. O(shapes).
        """
        found = 0
        for row in range(len(shapes_inout)):
            s = shapes_inout[row]
            if s.proxy < 0:
                continue
            b = bodies[s.body_row]
            p = proxies_inout[s.proxy]
            fresh = p.row < 0
            p.row = row
            if (
                b.kind == STATIC
                and not fresh
                and not p.changed
                and (b.x == b.previous_x and b.y == b.previous_y and b.angle == b.previous_angle)
            ):
                continue
            raster = 0
            if s.kind == MASK:
                raster = raster_at(geometry, s.geometry, b.angle)
                lower_x, lower_y, upper_x, upper_y = raster_aabb(geometry, raster, b.x, b.y)
            else:
                lower_x, lower_y, upper_x, upper_y = aabb_at(geometry, shapes_inout, row, b.x, b.y, b.angle)
            if b.kind != STATIC:
                x = b.x + dt * b.vx
                y = b.y + dt * b.vy
                angle = b.angle
                bulge = margin
                if rotation and b.angular_velocity != 0.0:
                    angle += dt * b.angular_velocity
                    u, v = turned(b.local_center_x, b.local_center_y, math.cos(b.angle), math.sin(b.angle))
                    x += u
                    y += v
                    # No point is further from the centre of mass than the AABB's corners; its arc rises above the
                    # chord by no more than the sagitta.
                    reach = max(
                        length_of(lower_x - b.x - u, lower_y - b.y - v), length_of(upper_x - b.x - u, upper_y - b.y - v)
                    )
                    reach = max(reach, length_of(lower_x - b.x - u, upper_y - b.y - v))
                    reach = max(reach, length_of(upper_x - b.x - u, lower_y - b.y - v))
                    half_turn = min(0.5 * abs(dt * b.angular_velocity), math.pi)
                    bulge += reach * (1.0 - math.cos(half_turn))
                    u, v = turned(b.local_center_x, b.local_center_y, math.cos(angle), math.sin(angle))
                    x -= u
                    y -= v
                if not rotation and s.kind == MASK:
                    left, top, right, bottom = raster_aabb(geometry, raster, x, y)
                elif not rotation and (s.kind != BOUNDS or s.wrapped != MASK):
                    # Not turned and not on the pixel grid: the box moves as its body does.
                    left = lower_x + (x - b.x)
                    top = lower_y + (y - b.y)
                    right = upper_x + (x - b.x)
                    bottom = upper_y + (y - b.y)
                else:
                    left, top, right, bottom = aabb_at(geometry, shapes_inout, row, x, y, angle)
                lower_x = min(lower_x, left) - bulge
                lower_y = min(lower_y, top) - bulge
                upper_x = max(upper_x, right) + bulge
                upper_y = max(upper_y, bottom) + bulge
            if (
                fresh
                or p.changed
                or lower_x != p.lower_x
                or lower_y != p.lower_y
                or upper_x != p.upper_x
                or upper_y != p.upper_y
            ):
                p.lower_x = lower_x
                p.lower_y = lower_y
                p.upper_x = upper_x
                p.upper_y = upper_y
                p.changed = True
                changed_out[found] = s.proxy
                found += 1
        return found

    return update_rectangles


@kernel
def mark_settled(changed, proxies_inout):
    """Clear the changed flag of the listed slots. O(changed)."""
    for i in range(len(changed)):
        proxies_inout[changed[i]].changed = False
