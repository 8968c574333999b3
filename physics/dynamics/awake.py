"""Which bodies can change anything in a step."""

from physics.jit import kernel, subkernel
from physics.tables.body import DYNAMIC


@subkernel
def is_active(body):
    """Whether a body can change a contact: awake and dynamic, or moved by hand, or about to move."""
    if body.kind == DYNAMIC:
        return body.awake
    return (
        body.vx != 0.0
        or body.vy != 0.0
        or body.angular_velocity != 0.0
        or body.x != body.previous_x
        or body.y != body.previous_y
        or body.angle != body.previous_angle
    )


@kernel
def is_anything_active(bodies):
    """Whether any body can change anything: else a step has nothing to do. O(bodies)."""
    for i in range(len(bodies)):
        if is_active(bodies[i]) and not bodies[i].quarantined:
            return True
    return False
