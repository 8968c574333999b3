"""Bounding motion rectangles: where each shape can be during the step. They are what the broad phase compares.

They are kept while what the shape needs stays inside. In a world whose bodies tremble in piles they have room to spare
all round: a pile that rests costs the broad phase nothing. Elsewhere they reach ahead along the motion: what flies is
looked for once in some steps. More candidates, the same contacts: the narrow phase looks at the tight boxes.
Source: Catto, Box2D v3.2, constants.h (margin); Bullet, btDbvtBroadphase (boxes that reach ahead along the velocity).
"""

from typing import NamedTuple

import numpy as np

from physics.jit import kernel
from physics.math2d import length_of
from physics.settings import AABB_MARGIN, AABB_MARGIN_FRACTION, AHEAD_FRACTION, STEPS_AHEAD
from physics.shapes.placement import drawn_beyond, is_drawn_when_asked, refresh_boxes, snapped
from physics.shapes.rasters import add_missing_rasters
from physics.tables.body import DYNAMIC, STATIC
from physics.tables.shape import PIXELS
from physics.tables.step_state import StepState, stage
from physics.tables.world_tables import WorldTables


class Reach(NamedTuple):
    """How far a rectangle has to reach, and how much further it does."""

    gravity_x: float  # [px/s2]
    gravity_y: float
    dt: float  # [s]
    margin: float  # [px] contacts up to it are candidates
    spare: float  # [px] how far a rectangle outgrows its need, at most …
    share: float  # … that share of the box
    ahead: float  # of how many steps it holds the motion besides this one


@kernel
def update_rectangles(
    # read
    rows,
    geometry,
    bodies,
    reach,
    # write
    shapes_inout,
    proxies_inout,
    changed_out,
):
    """Write the boxes of these shape rows, and the motion rectangles that no longer fit, and list the slots that
    changed. Returns the number of slots. reach: see Reach. O(rows).
    """
    refresh_boxes(rows, geometry, bodies, shapes_inout)
    rasters = geometry.rasters
    dt = reach.dt
    margin = reach.margin
    ahead = reach.ahead
    found = 0
    for k in range(len(rows)):
        row = rows[k]
        s = shapes_inout[row]
        if s.proxy < 0:
            continue
        b = bodies[s.body_row]
        p = proxies_inout[s.proxy]
        fresh = p.row < 0
        p.row = row
        moved = b.x != b.previous_x or b.y != b.previous_y or b.angle != b.previous_angle
        if b.kind == STATIC and not (fresh or p.changed or moved):
            continue
        lower_x = s.min_x
        lower_y = s.min_y
        upper_x = s.max_x
        upper_y = s.max_y
        fat = 0.0
        ahead_x = 0.0
        ahead_y = 0.0
        if is_drawn_when_asked(s):
            beyond = drawn_beyond(b, s)
            lower_x -= beyond
            lower_y -= beyond
            upper_x += beyond
            upper_y += beyond
        if b.kind != STATIC:
            dx = dt * b.vx
            dy = dt * b.vy
            if b.kind == DYNAMIC:
                dx += dt * dt * (b.gravity_scale * reach.gravity_x + b.inverse_mass * b.force_x)
                dy += dt * dt * (b.gravity_scale * reach.gravity_y + b.inverse_mass * b.force_y)
            size = max(s.max_x - s.min_x, s.max_y - s.min_y)
            fat = min(reach.spare, reach.share * size)
            most = AHEAD_FRACTION * size
            steps = ahead
            if fresh and ahead > 0.0:
                steps = 1.0 + s.proxy % int(ahead)  # or all that came together would be looked for in the same step
            ahead_x = min(max(steps * dx, -most), most)
            ahead_y = min(max(steps * dy, -most), most)
            # A point turns by no more than its arc, or across the whole circle.
            arc = b.extent * min(abs(dt * b.angular_velocity), 2.0)
            if s.snap and s.role != PIXELS:
                # Drawn on the pixel grid at both ends; at another angle its edges are rounded anew.
                r = rasters[s.raster]
                dx = float(snapped(b.x + dx, r.origin_x) - s.left)
                dy = float(snapped(b.y + dy, r.origin_y) - s.top)
                if b.angular_velocity != 0.0:
                    arc += 1.0
            lower_x += min(dx, 0.0) - arc - margin
            lower_y += min(dy, 0.0) - arc - margin
            upper_x += max(dx, 0.0) + arc + margin
            upper_y += max(dy, 0.0) + arc + margin
        fits = p.lower_x <= lower_x and p.lower_y <= lower_y and p.upper_x >= upper_x and p.upper_y >= upper_y
        room = max(fat, abs(ahead_x), abs(ahead_y))
        if room > 0.0:
            # A rectangle left over from a fast step would be far too large.
            slack = 4.0 * room + length_of(upper_x - lower_x, upper_y - lower_y)
            fits = fits and length_of(p.upper_x - p.lower_x, p.upper_y - p.lower_y) <= slack
        else:
            fits = (
                fits and p.lower_x == lower_x and p.lower_y == lower_y and p.upper_x == upper_x and p.upper_y == upper_y
            )
        if fresh or p.changed or not fits:
            p.lower_x = lower_x - fat + min(ahead_x, 0.0)
            p.lower_y = lower_y - fat + min(ahead_y, 0.0)
            p.upper_x = upper_x + fat + max(ahead_x, 0.0)
            p.upper_y = upper_y + fat + max(ahead_y, 0.0)
            p.changed = True
            changed_out[found] = s.proxy
            found += 1
    return found


@kernel
def list_outside(
    # read
    rows,
    bodies,
    shapes,
    proxies,
    # write
    rows_out,
):
    """List those of the shape rows that reach, as they are drawn, out of their motion rectangle. Returns their number.

    O(rows).
    """
    found = 0
    for k in range(len(rows)):
        s = shapes[rows[k]]
        if s.proxy < 0:
            continue
        p = proxies[s.proxy]
        beyond = drawn_beyond(bodies[s.body_row], s)
        if (
            s.min_x - beyond < p.lower_x
            or s.max_x + beyond > p.upper_x
            or s.min_y - beyond < p.lower_y
            or s.max_y + beyond > p.upper_y
        ):
            rows_out[found] = rows[k]
            found += 1
    return found


def cover_final_poses(state: StepState, rows: np.ndarray) -> None:
    """Write new motion rectangles for those of the shape rows that were pushed out of theirs, and find their pairs: the
    candidates then hold all that overlaps at the final poses. The next step finds them in place."""
    outside = state.workspace.rows_for(len(rows))
    found = list_outside(rows, state.bodies, state.shapes, state.pairs.proxies, outside)
    if found:
        changed = write_rectangles(state, outside[:found])
        state.pairs.update(state.broadphase, state.shapes, changed, state.work)


@stage(
    "motion_rectangles",
    reads=("effects", "stacks", "tolerances", "gravity", "dt", "awake", "bodies", "shapes", "library", "pairs"),
    writes=(
        "pairs",
        "changed_count",
        "library",
        *(f"shapes.{name}" for name in ("min_x", "min_y", "max_x", "max_y", "raster", "left", "top")),
    ),
)
def motion_rectangles(state: StepState) -> None:
    """Bring the boxes, and the rectangles that no longer fit, up to date."""
    state.changed_count = write_rectangles(state, state.awake.shapes)


def write_rectangles(tables: WorldTables, rows: np.ndarray) -> int:
    """Bring the boxes and rectangles of these shape rows up to date.
    Returns how many slots changed, listed by the pairs.

    tables: a StepState, or a world whose shapes have just got places in the broad phase.
    """
    bodies, shapes, pairs, tolerances, dt = tables.bodies, tables.shapes, tables.pairs, tables.tolerances, tables.dt
    piles = tables.stacks
    add_missing_rasters(tables.library, rows, bodies, shapes, dt)
    # Where velocities were integrated before, gravity and forces are in them.
    gravity_x, gravity_y = tables.gravity if tables.effects.gravity and piles else (0.0, 0.0)
    reach = Reach(
        gravity_x,
        gravity_y,
        dt,
        tolerances.speculative if piles else tolerances.slop,
        AABB_MARGIN * tolerances.pixels_per_meter if piles else 0.0,
        AABB_MARGIN_FRACTION if piles else 0.0,
        0.0 if piles else STEPS_AHEAD,
    )
    changed = pairs.room_for(len(rows))
    return update_rectangles(rows, tables.library.tables, bodies, reach, shapes, pairs.proxies, changed)
