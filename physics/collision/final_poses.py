"""What a step ends with in a world that stacks: boxes, pixels and contacts where the bodies are now.

Solvers, sweeps and characters move bodies one after the other. What is told, sensed and put to sleep is what there is
after all of them; contacts are carried there by their anchors, nothing is detected twice.
"""

from physics.collision.follow import follow_anchor
from physics.collision.recycle import is_settled, serves_again
from physics.jit import kernel, subkernel
from physics.math2d import heading
from physics.settings import RECYCLE_WANDER
from physics.shapes.placement import refresh_boxes
from physics.shapes.rasters import add_missing_rasters
from physics.tables.step_state import StepState, stage


@subkernel
def carry_all(
    # read
    shapes,
    anchors,
    distance,
    # write
    bodies_inout,
    manifolds_inout,
):
    """Carry points, normals and separations of all manifolds to where their bodies are, and note which will do again
    for the next step: see serves_again. O(manifolds)."""
    row_a = -1
    row_b = -1
    a_cosine = 1.0
    a_sine = 0.0
    b_cosine = 1.0
    b_sine = 0.0
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        a = bodies_inout[m.body_row_a]
        b = bodies_inout[m.body_row_b]
        # The manifolds of a pair, and often those of a body, stand together.
        if m.body_row_a != row_a:
            row_a = m.body_row_a
            a_cosine, a_sine = heading(a.angle)
            a.followed = is_settled(a)
        if m.body_row_b != row_b:
            row_b = m.body_row_b
            b_cosine, b_sine = heading(b.angle)
            b.followed = is_settled(b)
        c = anchors[i]
        fits = serves_again(shapes, a, a_cosine, a_sine, b, b_cosine, b_sine, c, distance, RECYCLE_WANDER * distance, m)
        if not fits:
            follow_anchor(a, a_cosine, a_sine, b, b_cosine, b_sine, c, 0.0, m)
        m.again = fits and not m.swept


@kernel
def settle(
    # read
    shape_rows,
    geometry,
    anchors,
    distance,
    # write
    bodies_inout,
    shapes_inout,
    manifolds_inout,
):
    """Write the boxes of these shapes, and carry all manifolds to where their bodies are; distance [px]: see
    serves_again. O(rows + manifolds)."""
    refresh_boxes(shape_rows, geometry, bodies_inout, shapes_inout)
    carry_all(shapes_inout, anchors, distance, bodies_inout, manifolds_inout)


@stage(
    "final_poses",
    reads=("tolerances", "awake", "bodies", "shapes", "library", "manifolds", "anchors"),
    writes=(
        "manifolds",
        "library",
        "bodies.followed",
        *(f"shapes.{name}" for name in ("min_x", "min_y", "max_x", "max_y", "raster", "left", "top")),
    ),
)
def settle_contacts(state: StepState) -> None:
    """Boxes, and the points, normals and separations of contacts, at the final poses."""
    rows, bodies, shapes = state.awake.shapes, state.bodies, state.shapes
    # What was pushed round may stand at an angle that was not foreseen.
    add_missing_rasters(state.library, rows, bodies, shapes, 0.0)
    distance = state.tolerances.recycle
    settle(rows, state.library.tables, state.anchors, distance, bodies, shapes, state.manifolds)
