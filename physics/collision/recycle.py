"""Whether a manifold of the step before will do again: asked where a step ends, for the next one, and where that begins
of what was moved by hand in between.

Source: Catto, Box2D v3, contact recycling; Coumans, Bullet, persistent manifolds.
"""

from physics.collision.follow import follow_anchor
from physics.jit import inlined
from physics.settings import RECYCLE_MOVE, RECYCLE_SHARE
from physics.tables.shape import CIRCLE


@inlined
def is_sound(manifold):
    """Whether a manifold has numbers that are: what is finite is 0 less than itself."""
    m = manifold
    total = m.normal_x + m.normal_y + m.x_1 + m.y_1 + m.separation_1
    if m.count == 2:
        total += m.x_2 + m.y_2 + m.separation_2
    return total - total == 0.0


@inlined
def may_move(manifold, anchor, distance):
    """How far [px] points may move on each other: the distance, or RECYCLE_MOVE times that on a face that bears another
    and is not short itself: they follow it exactly.

    What bears nothing has to find its own way out of an overlap.
    """
    m = manifold
    c = anchor
    loaded = c.normal_force_1 > 0.0 or c.normal_force_2 > 0.0
    if m.count == 1 or not loaded or c.radius_a > 0.0 or c.radius_b > 0.0:
        return distance
    x = m.x_2 - m.x_1
    y = m.y_2 - m.y_1
    far = RECYCLE_MOVE * distance
    return far if far * far <= RECYCLE_SHARE * RECYCLE_SHARE * (x * x + y * y) else distance


@inlined
def serves_again(shapes, a, a_cosine, a_sine, b, b_cosine, b_sine, anchor, distance, wander, manifold_inout):
    """Carry a manifold to the present poses, and say whether that will do: no point moved on its partner by more than
    may_move of `distance` [px], neither side turned on the other by more than that, and what a face's end cuts off is
    right to within `wander` [px] without being carried along the edge.

    a, b: BODY rows of the sides, with cosine and sine of their angles; anchor: the ANCHOR row.
    """
    m = manifold_inout
    c = anchor
    moved, rolled, wandered = follow_anchor(a, a_cosine, a_sine, b, b_cosine, b_sine, c, wander, m)
    # The manifold lies within both: what a turn moves is no further out than the smaller side.
    reach = min(a.extent, b.extent) if min(a.extent, b.extent) > 0.0 else max(a.extent, b.extent)
    turn = abs((b.angle - c.angle_b) - (a.angle - c.angle_a)) * reach
    if turn > distance and (shapes[m.row_a].kind == CIRCLE or shapes[m.row_b].kind == CIRCLE):
        turn = 0.0  # as it likes
    near = max(rolled, turn) <= distance and moved <= may_move(m, c, distance) and not wandered
    return near and is_sound(m) and 0.0 <= c.share_1 <= 1.0 and 0.0 <= c.share_2 <= 1.0


@inlined
def is_settled(body):
    """Whether a body, a BODY row, is where its centre of mass was written last."""
    return body.x == body.settled_x and body.y == body.settled_y and body.angle == body.settled_angle


@inlined
def stands(body):
    """Whether a body, a BODY row, is where its contacts were carried to when the last step ended. Who moves it clears
    the flag; what is written into the table is seen by the pose."""
    return body.followed and is_settled(body)
