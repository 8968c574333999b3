"""Islands without room: faces of bodies of infinite mass oppose one another, and what they do is bounded.

Two sides that cannot give way would press a body with ever greater impulses, one of which is released when it escapes.
Instead of that the bodies stay overlapped, and leave at no more than the speed of the faces and that of push-out.
"""

from physics.islands.graph import find_roots
from physics.jit import subkernel
from physics.math2d import norm
from physics.solver import lanes as at

FACING = 0.5  # cosine between normals of faces below which one does not leave the room that the other needs
OPPOSITE = -0.5  # … below which they oppose each other


@subkernel
def note_faces(edges, count, lists, slop, parents, squeeze_out):
    """Write how deep the overlaps of each island are, and whether its faces oppose one another. parents: its roots."""
    for turn in range(2):
        for i in range(count):
            node = edges.nodes[i, 0] if lists.links_islands[edges.nodes[i, 0]] else edges.nodes[i, 1]
            root = squeeze_out[parents[node]]
            x = edges.faces[i, 0]
            y = edges.faces[i, 1]
            is_face = x != 0.0 or y != 0.0
            if turn == 1:
                if is_face:
                    differs = x * root.face_x + y * root.face_y < FACING
                    root.caught = root.caught or (differs and edges.overlaps[i] > slop)
                    root.pressed = root.pressed or x * root.push_x + y * root.push_y < OPPOSITE
                continue
            root.depth = max(root.depth, edges.overlaps[i])
            if not is_face:
                continue
            root.face_speed = max(root.face_speed, edges.face_speeds[i])
            if edges.face_speeds[i] > 0.0 and root.push_x == 0.0 and root.push_y == 0.0:
                root.push_x = x
                root.push_y = y
            if edges.overlaps[i] > slop:
                root.face_depth = max(root.face_depth, edges.overlaps[i])
                if root.face_x == 0.0 and root.face_y == 0.0:
                    root.face_x = x
                    root.face_y = y


@subkernel
def find_squeezed(edges, count, lists, motions, limits, parents_out, squeeze_out):
    """Write the bounds of islands without room, SQUEEZE rows. Return whether there are any. O(count + motions).

    Their overlaps are deep, and either those with faces that point in different directions, or between a face that
    moves and one opposite. See settings.Limits.
    """
    for i in range(len(motions)):
        s = squeeze_out[i]
        s.depth, s.face_depth, s.face_speed = 0.0, 0.0, 0.0
        s.face_x, s.face_y, s.push_x, s.push_y = 0.0, 0.0, 0.0, 0.0
        s.caught, s.pressed = False, False
        s.most, s.speed, s.static_speed, s.force = 0.0, 0.0, 0.0, 0.0
    find_roots(edges, count, lists.links_islands, parents_out)
    note_faces(edges, count, lists, limits.slop, parents_out, squeeze_out)
    found = False
    for i in range(len(motions)):
        root = squeeze_out[parents_out[i]]
        if not lists.links_islands[i]:
            continue
        is_caught = root.caught and root.face_depth > limits.deep
        if is_caught or (root.pressed and root.depth > limits.deep):
            found = True
            root.most = limits.push_speed + root.face_speed
            if is_caught:
                root.speed = root.most
                root.static_speed = root.most if root.face_speed > 0.0 else 0.0
                m = motions[i]
                if m.inverse_mass > 0.0:
                    root.force += norm(m.acceleration_x, m.acceleration_y) / m.inverse_mass
    for i in range(len(motions)):
        if found and lists.links_islands[i]:
            root = squeeze_out[parents_out[i]]
            squeeze_out[i].most = root.most
            squeeze_out[i].speed = root.speed
            squeeze_out[i].static_speed = root.static_speed
            squeeze_out[i].force = root.force
    return found


@subkernel
def limit_impulses(a, b, squeeze_a, squeeze_b, h, lane, c_inout):
    """Limit the normal impulses of a substep of h [s] at each point of a lane, and those from which it starts.

    a, b: MOTION rows of its sides, with their SQUEEZE rows.
    """
    c = c_inout
    speed = max(squeeze_a.speed, squeeze_b.speed)
    if speed == 0.0:
        return
    if not (a.moves and b.moves):
        speed += max(squeeze_a.static_speed, squeeze_b.static_speed)
    force = max(squeeze_a.force, squeeze_b.force)
    most = speed * max(c[at.MASS_1 + lane], c[at.MASS_2 + lane]) + h * force
    c[at.MOST + lane] = most
    c[at.NORMAL_1 + lane] = min(c[at.NORMAL_1 + lane], most)
    c[at.NORMAL_2 + lane] = min(c[at.NORMAL_2 + lane], most)
