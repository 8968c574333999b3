"""Islands without room: overlaps with bodies of infinite mass oppose one another, and impulses in them are bounded.

Two sides that cannot give way would press a body with ever greater impulses, one of which is released when it escapes.
Instead of that the body stays overlapped, and leaves at no more than the speed of push-out once there is room.
"""

import math

from physics.islands.graph import find_roots
from physics.jit import subkernel
from physics.math2d import norm
from physics.solver import lanes as at

FACING = 0.5  # cosine between normals of deep overlaps below which one does not leave the room that the other needs


@subkernel
def find_squeezed(edges, count, lists, motions, push_speed, deep, parents_out, squeeze_out):
    """Write the bounds of the impulses in islands without room, SQUEEZE rows. Return whether there are any.

    An island has none if deep overlaps, by more than `deep` [px] for one, point in different directions. push_speed:
    [px/s]. O(count + motions).
    """
    found = False
    for i in range(len(motions)):
        squeeze_out[i].depth = 0.0
        squeeze_out[i].normal_x = 0.0
        squeeze_out[i].normal_y = 0.0
        squeeze_out[i].speed = 0.0
        squeeze_out[i].static_speed = 0.0
        squeeze_out[i].force = 0.0
    find_roots(edges, count, lists.links_islands, parents_out)
    for i in range(count):
        x = edges.deep[i, 0]
        y = edges.deep[i, 1]
        if x == 0.0 and y == 0.0:
            continue
        node = edges.nodes[i, 0] if lists.links_islands[edges.nodes[i, 0]] else edges.nodes[i, 1]
        root = squeeze_out[parents_out[node]]
        root.depth = max(root.depth, edges.overlaps[i])
        if root.normal_x == 0.0 and root.normal_y == 0.0:
            root.normal_x = x
            root.normal_y = y
        elif x * root.normal_x + y * root.normal_y < FACING:
            root.speed = push_speed
            found = True
    if not found:
        return False
    for i in range(len(motions)):
        m = motions[i]
        root = squeeze_out[parents_out[i]]
        if not lists.links_islands[i]:
            continue
        if root.depth <= deep:
            root.speed = 0.0
        elif root.speed > 0.0 and m.inverse_mass > 0.0:
            root.force += norm(m.acceleration_x, m.acceleration_y) / m.inverse_mass
    for i in range(count):
        if edges.deep[i, 0] == 0.0 and edges.deep[i, 1] == 0.0:
            continue
        a_moves = lists.links_islands[edges.nodes[i, 0]]
        root = squeeze_out[parents_out[edges.nodes[i, 0] if a_moves else edges.nodes[i, 1]]]
        o = motions[edges.nodes[i, 1] if a_moves else edges.nodes[i, 0]]
        if root.speed > 0.0:
            root.speed = max(root.speed, push_speed + norm(o.vx, o.vy))
            if o.moves:
                root.static_speed = root.speed
    for i in range(len(motions)):
        if lists.links_islands[i]:
            root = squeeze_out[parents_out[i]]
            squeeze_out[i].speed = root.speed
            squeeze_out[i].force = root.force
            squeeze_out[i].static_speed = root.static_speed
    return True


@subkernel
def greatest_impulse(a, b, squeeze_a, squeeze_b, h, lane, c):
    """Return the greatest normal impulse of a substep of h [s] at one point of a lane; inf: no bound.

    a, b: MOTION rows of its sides, with their SQUEEZE rows.
    """
    speed = max(squeeze_a.speed, squeeze_b.speed)
    if speed == 0.0:
        return math.inf
    if not (a.moves and b.moves):
        speed += max(squeeze_a.static_speed, squeeze_b.static_speed)
    force = max(squeeze_a.force, squeeze_b.force)
    return speed * max(c[at.MASS_1 + lane], c[at.MASS_2 + lane]) + h * force
