"""Impulses between characters and the bodies of a world that stacks: shoving, landing, weight.

A character has a mass but no velocity that a solver could change: it is moved by the game. So it acts on bodies by
impulses of its own, and the solver leaves out what lies under its feet: to that it is a weight and no ceiling.
"""

from physics.character.ground import BLOCKED, STEEP
from physics.character.meet import meet, place_outline
from physics.character.solids import in_shape
from physics.jit import kernel, subkernel
from physics.tables.body import DYNAMIC, STATIC
from physics.tables.rows import row_of


@subkernel
def push_body(me, row, direction, speed, left, walk_inout):
    """Push one body in the way towards a speed [px/s], by at most the impulse left. Returns what is left of that."""
    c = walk_inout.characters[me]
    b = walk_inout.bodies[walk_inout.shapes[row].body_row]
    settings = walk_inout.settings
    count, radius = place_outline(walk_inout, me, c.left + direction, c.top)
    depth, nx, ny, x, y = meet(walk_inout, row, count, radius)
    arm = (x - b.center_x) * ny - (y - b.center_y) * nx
    turning = b.inverse_inertia if settings.rotation == 1 else 0.0
    now = b.vx * nx + b.vy * ny + settings.dt * b.inverse_mass * (b.force_x * nx + b.force_y * ny)
    if settings.rotation == 1:
        now += (b.angular_velocity + settings.dt * turning * b.torque) * arm
    weight = b.inverse_mass + turning * arm * arm
    if weight <= 0.0:
        return left
    impulse = min((speed * nx - now) / weight, left)
    if impulse <= 0.0 or settings.dt <= 0.0:
        return left
    b.force_x += impulse / settings.dt * nx
    b.force_y += impulse / settings.dt * ny
    b.torque += impulse / settings.dt * arm
    return left - impulse


@subkernel
def shove(me, direction, speed, walk_inout):
    """Push what is in the way sideways towards the speed [px/s] of a move, as far as the character's strength allows.

    As a force over the coming step, not as a jolt before it: friction that is strong enough then holds a body in place.
    """
    c = walk_inout.characters[me]
    speed += walk_inout.bodies[c.body_row].vx  # of what carries it
    left = c.mass * c.push * walk_inout.settings.dt
    for k in range(1, walk_inout.found[0] + 1):
        row = -1 - walk_inout.found[k]
        if row < 0:
            continue
        b = walk_inout.bodies[walk_inout.shapes[row].body_row]
        if b.kind != DYNAMIC or b.inverse_mass == 0.0:
            continue
        what, slope = in_shape(walk_inout, me, row, c.left + direction, c.top, direction, 0, 0.0)
        if what == BLOCKED or what == STEEP:
            left = push_body(me, row, direction, speed, left, walk_inout)


@subkernel
def foot_of(c, s):
    """The point [px] of a character's feet that stands on a shape: their middle, or the nearest to it that does."""
    return min(max(c.left + 0.5 * c.width, s.min_x), s.max_x), float(c.top + c.height)


@subkernel
def knock(me, row, direction, speed, walk_inout):
    """Pass on the momentum of a landing (direction 1), or of a head that hits (-1), as two lumps of clay do."""
    c = walk_inout.characters[me]
    x, y = foot_of(c, walk_inout.shapes[row])
    b = walk_inout.bodies[walk_inout.shapes[row].body_row]
    if b.inverse_mass == 0.0 or c.mass <= 0.0:
        return
    rotation = walk_inout.settings.rotation
    arm = (x - b.center_x) * direction
    turning = b.inverse_inertia if rotation == 1 else 0.0
    now = b.vy * direction + (b.angular_velocity * arm if rotation == 1 else 0.0)
    closing = (speed + walk_inout.bodies[c.body_row].vy) * direction - now
    if closing > 0.0:
        impulse = closing / (1.0 / c.mass + b.inverse_mass + turning * arm * arm)
        b.vy += impulse * b.inverse_mass * direction
        b.angular_velocity += impulse * turning * arm


@kernel
def press(
    # read
    shapes,
    gravity_x,
    gravity_y,
    slow,
    # write
    characters_inout,
    bodies_inout,
):
    """Let characters weigh on the awake bodies that they ride, and give their bodies the velocity of what carries them.

    gravity [px/s2]; slow [px/s]: what carries them by less is about to rest, and they must not keep it awake. Remembers
    the point under their feet [px]. O(characters · log shapes).
    """
    for me in range(len(characters_inout)):
        c = characters_inout[me]
        b = bodies_inout[c.body_row]
        if b.quarantined:
            continue
        b.vx = c.push_vx
        b.vy = c.push_vy
        row = row_of(shapes, c.riding_shape) if c.riding >= 0 else -1
        if row < 0:
            continue
        s = shapes[row]
        r = bodies_inout[s.body_row]
        c.foot_x, c.foot_y = foot_of(c, s)
        arm_x = c.foot_x - r.center_x
        arm_y = c.foot_y - r.center_y
        vx = r.vx - r.angular_velocity * arm_y
        vy = r.vy + r.angular_velocity * arm_x
        if r.kind != STATIC and abs(vx) + abs(vy) > slow:
            b.vx = vx
            b.vy = vy
        if r.kind == DYNAMIC and r.awake:
            r.force_x += c.mass * gravity_x
            r.force_y += c.mass * gravity_y
            r.torque += c.mass * (arm_x * gravity_y - arm_y * gravity_x)


@subkernel
def is_between(manifold, first, second):
    """Whether a manifold is between two bodies, by id."""
    m = manifold
    return (m.body_a == first and m.body_b == second) or (m.body_b == first and m.body_a == second)


@kernel
def tell_weight(
    # read
    characters,
    weight_rate,
    # write
    manifolds_inout,
):
    """Write the weight that characters have put on what they ride into the manifolds with it.

    weight_rate [px/s]: gravity times the step; the points between the two share it. O(characters · manifolds).
    """
    for me in range(len(characters)):
        c = characters[me]
        if c.riding < 0:
            continue
        points = 0
        for k in range(len(manifolds_inout)):
            if is_between(manifolds_inout[k], c.body, c.riding):
                points += manifolds_inout[k].count
        for k in range(len(manifolds_inout)):
            m = manifolds_inout[k]
            if points > 0 and is_between(m, c.body, c.riding):
                m.normal_impulse_1 = c.mass * weight_rate / points
                m.normal_impulse_2 = c.mass * weight_rate / points
