"""What kinematic bodies run into stays in front of them for the rest of the step.

A body that was stopped on its way waits there for the next step; what moves by its script does not wait. So the rest of
the step is swept once more, piece by piece: wherever the scripted surface would go into the body, it takes it along.
"""

import math

from physics.ccd.paths import cut_path
from physics.ccd.rotational import BEFORE
from physics.ccd.rotational_pairs import sweep_rotational
from physics.jit import kernel
from physics.math2d import turned
from physics.tables.body import DYNAMIC, KINEMATIC
from physics.tables.shape import CHAIN, MASK, TILES

MEETINGS = 2  # parts of one pusher that are looked at in a round: the two sides of a corner


@kernel
def push_ahead(
    # read
    geometry,
    bodies,
    shapes,
    candidates,
    count,
    slack,
    one_way,
    paths,
    # write
    cuts_out,
    workspace,
    moves_inout,
    work_inout,
):
    """Lengthen the moves of stopped bodies so that nothing kinematic goes into them until the end of the step.

    paths (bodies, 6) from list_paths; slack [px]: see rotational.sweep_part; moves_inout (bodies, 2) [px]: how far each
    is taken along from where it was stopped, in its body's fraction of the step. Returns how many pushes were added: as
    each takes a body along a line, a corner needs two and the next look at it finds none. O(candidates).
    """
    found = 0
    for i in range(count):
        for side in range(2):
            mover = candidates[i, side]
            other = candidates[i, 1 - side]
            row = shapes[mover].body_row
            pusher = shapes[other].body_row
            b = bodies[row]
            if b.kind != DYNAMIC or bodies[pusher].kind != KINEMATIC or not b.fraction < 1.0:
                continue
            kind = shapes[mover].kind
            if kind == TILES or kind == CHAIN or kind == MASK or shapes[mover].sensor or shapes[other].sensor:
                continue
            cut_path(paths, pusher, b.fraction, 1.0, cuts_out)
            for k in range(0, 6, 3):
                share = 0.0 if k == 0 else 1.0
                cuts_out[row, k] = b.center_x + share * moves_inout[row, 0]
                cuts_out[row, k + 1] = b.center_y + share * moves_inout[row, 1]
                cuts_out[row, k + 2] = b.angle
            but = -1
            for _ in range(MEETINGS):
                fraction, nx, ny, feature = sweep_rotational(
                    geometry, bodies, shapes, cuts_out, mover, other, slack, one_way, but, workspace, work_inout
                )
                if fraction >= 1.0:
                    break
                # Where the point of the pusher that is now at the body's centre of mass will be, beyond its own move.
                left = 1.0 - fraction
                x = cuts_out[row, 0] + fraction * moves_inout[row, 0]
                y = cuts_out[row, 1] + fraction * moves_inout[row, 1]
                u = x - (cuts_out[pusher, 3] - left * (cuts_out[pusher, 3] - cuts_out[pusher, 0]))
                v = y - (cuts_out[pusher, 4] - left * (cuts_out[pusher, 4] - cuts_out[pusher, 1]))
                turn = left * (cuts_out[pusher, 5] - cuts_out[pusher, 2])
                w, z = turned(u, v, math.cos(turn), math.sin(turn))
                dx = cuts_out[pusher, 3] + w - x - left * moves_inout[row, 0]
                dy = cuts_out[pusher, 4] + z - y - left * moves_inout[row, 1]
                ahead = nx * dx + ny * dy
                if ahead > BEFORE * slack:
                    moves_inout[row, 0] += ahead * nx
                    moves_inout[row, 1] += ahead * ny
                    found += 1
                    break
                if feature < 0:
                    break
                but = feature  # what pushes no further hides what is met after it: the other side of a corner
    return found
